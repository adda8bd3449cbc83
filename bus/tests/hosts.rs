//! Hosts that join, carry AUVs, leave and are replaced, each in a thread of this process. `shoal-tests` has them as processes and across
//! networks.
#![cfg(all(feature = "iceoryx2", feature = "zenoh"))]

mod crew;

use std::net::TcpListener;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use crew::{Echo, digest, exchange, loss};
use shoal_bus::hosts::{
    Assignment, Crew, Decoding, Ending, Host, HostError, HostStopHandle, HostsError, HostsFleet, Network,
    Offer, Relay, Terms,
};
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Fleet, FleetError, Loss};
use shoal_bus::message::AuvId;

/// A port of the loopback that nobody listens on.
fn free_endpoint() -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    format!("tcp/{}", listener.local_addr().unwrap())
}

fn terms(auvs: u32, hosts: usize) -> Terms {
    Terms {
        name: "echo".into(),
        scenario: "blake3:aa".into(),
        auvs: crew::auvs(auvs),
        hosts,
        auvs_per_process: 1,
        token: None,
        limit: Duration::from_secs(5),
        clock_limit: None,
    }
}

fn offer(endpoint: &str, name: &str, slots: u32) -> Offer {
    Offer {
        endpoint: endpoint.into(),
        name: name.into(),
        slots,
        token: None,
        scenario: None,
        wait: Duration::from_secs(20),
    }
}

/// Echoes, in this program.
#[derive(Default)]
struct Echoes {
    carried: Vec<AuvId>,
}

impl Crew for Echoes {
    fn start(&mut self, assignment: &Assignment) -> Result<Box<dyn Relay>, FleetError> {
        self.carried.clone_from(&assignment.auvs);
        Ok(Box::new(Decoding::new(Local::new(Echo::new), || {})))
    }

    fn processes(&self) -> u32 {
        1
    }

    fn explain(&mut self, _: &mut Loss) {}

    fn progress(&mut self, _: u64, _: usize) {}

    fn disband(&mut self) {}
}

type Served = (Result<Ending, HostError>, Vec<AuvId>);

/// A host in a thread, and what makes it leave.
fn host(offer: Offer) -> (JoinHandle<Served>, Receiver<HostStopHandle>) {
    let (sender, handles) = channel();
    let thread = std::thread::spawn(move || {
        let host = match Host::join(&offer, &Network::new(None).unwrap()) {
            Ok(host) => host,
            Err(error) => return (Err(error), Vec::new()),
        };
        // Not every test wants it to leave.
        let _unwanted = sender.send(host.stop_handle());
        let mut echoes = Echoes::default();
        (host.serve(&mut echoes), echoes.carried)
    });
    (thread, handles)
}

/// A launcher with its news.
fn launcher(endpoint: &str, terms: Terms) -> (HostsFleet, Receiver<String>) {
    let (sender, news) = channel();
    let tell = move |news: &str| drop(sender.send(news.to_owned()));
    (HostsFleet::listen(endpoint, &Network::new(None).unwrap(), terms, tell).unwrap(), news)
}

#[test]
fn two_and_three_hosts_answer_as_one_program() {
    let expected = digest(&mut Local::new(Echo::new), 20, 40);
    for slots in [vec![10, 10], vec![20, 5, 15]] {
        let endpoint = free_endpoint();
        let (mut fleet, _) = launcher(&endpoint, terms(20, slots.len()));
        let hosts: Vec<_> = slots.iter().map(|&slots| host(offer(&endpoint, "alpha", slots))).collect();
        fleet.gather().unwrap();
        assert_eq!(digest(&mut fleet, 20, 40), expected);
        assert_eq!(fleet.processes().load(Ordering::Relaxed) as usize, slots.len());
        fleet.end();
        let mut carried = Vec::new();
        for (thread, _) in hosts {
            let (ending, auvs) = thread.join().unwrap();
            assert_eq!(ending.unwrap(), Ending::Over);
            carried.extend(auvs);
        }
        carried.sort_unstable();
        assert_eq!(carried, crew::auvs(20));
    }
}

#[test]
fn who_leaves_is_lost_and_replaced_by_who_joins() {
    let endpoint = free_endpoint();
    let (mut fleet, news) = launcher(&endpoint, terms(6, 2));
    let (leaver, handle) = host(offer(&endpoint, "alpha", 3));
    let (stayer, _) = host(offer(&endpoint, "beta", 3));
    fleet.gather().unwrap();
    assert_eq!(fleet.born(&crew::born(6)).unwrap(), []);
    assert!(exchange(&mut fleet, 6, 1).unwrap().losses.is_empty());
    handle.recv().unwrap().stop();
    let (ending, auvs) = leaver.join().unwrap();
    assert_eq!(ending.unwrap(), Ending::Stopped);
    let answers = exchange(&mut fleet, 6, 2).unwrap();
    let mut lost = auvs;
    lost.sort_unstable();
    let expected: Vec<Loss> =
        lost.iter().map(|auv| loss(auv.0, "host alpha said goodbye: interrupted")).collect();
    assert_eq!(answers.losses, expected);
    assert_eq!(fleet.vacancies(), []);

    let (spare, _) = host(offer(&endpoint, "gamma", 7));
    let mut window = 3;
    let vacancies = loop {
        assert!(exchange(&mut fleet, 6, window).unwrap().losses.is_empty());
        window += 1;
        match fleet.vacancies() {
            none if none.is_empty() => std::thread::sleep(Duration::from_millis(10)),
            some => break some,
        }
    };
    assert_eq!(vacancies, lost);
    let born: Vec<_> = crew::born(6).into_iter().filter(|born| lost.contains(&born.auv)).collect();
    assert_eq!(fleet.born(&born).unwrap(), []);
    let all = crew::auvs(6).into_iter().filter(|auv| crew::batch(*auv, 100).is_some());
    let answered = exchange(&mut fleet, 6, 100).unwrap().acted;
    assert!(all.eq(answered.iter().map(|batch| batch.auv)));
    fleet.end();
    for thread in [stayer, spare] {
        assert_eq!(thread.join().unwrap().0.unwrap(), Ending::Over);
    }
    let news: Vec<String> = news.try_iter().collect();
    for said in [
        "host alpha said goodbye: interrupted: AUVs",
        "gamma joined with 7 slots, as a spare",
        "gamma carries",
    ] {
        assert!(news.iter().any(|news| news.contains(said)), "{said}: {news:?}");
    }
}

#[test]
fn who_does_not_fit_is_refused_on_both_sides() {
    let endpoint = free_endpoint();
    let (mut fleet, news) = launcher(&endpoint, Terms { token: Some("sesame".into()), ..terms(4, 1) });
    let token = |token: &str| Some(token.to_owned());
    let refused = [
        (offer(&endpoint, "naked", 4), "shows no token"),
        (Offer { token: token("barley"), ..offer(&endpoint, "forger", 4) }, "another one"),
        (
            Offer { scenario: Some("blake3:bb".into()), ..offer(&endpoint, "other", 4) },
            "insists on a scenario",
        ),
        (offer(&endpoint, "full", 0), "--slots"),
    ];
    let joining = std::thread::spawn(move || {
        for (offer, said) in refused {
            let error = host(offer).0.join().unwrap().0.unwrap_err().to_string();
            assert!(error.starts_with("the launcher refuses this host: ") && error.contains(said), "{error}");
        }
        let small = Offer { token: token("sesame"), ..offer(&endpoint, "small", 3) };
        host(small).0.join().unwrap().0.unwrap()
    });
    let error = fleet.gather().unwrap_err();
    assert!(matches!(&error, HostsError::Slots { missing: 1, .. }), "{error}");
    assert!(
        error.to_string().contains("1 of 4 AUVs have no place on the hosts that joined (small: 3 slots)")
    );
    assert_eq!(joining.join().unwrap(), Ending::Failed(error.to_string()));
    let news: Vec<String> = news.try_iter().collect();
    for name in ["naked", "forger", "other", "full"] {
        assert!(news.iter().any(|news| news.starts_with(&format!("host {name} was refused: "))), "{news:?}");
    }
}

#[test]
fn nobody_there_and_nowhere_to_listen_are_told() {
    let endpoint = free_endpoint();
    let wait = Duration::from_secs(1);
    let (thread, _) = host(Offer { wait, ..offer(&endpoint, "lonely", 1) });
    let error = thread.join().unwrap().0.unwrap_err().to_string();
    assert!(error.contains("nobody could be reached at tcp/127.0.0.1:"), "{error}");

    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let endpoint = format!("tcp/{}", taken.local_addr().unwrap());
    let made = HostsFleet::listen(&endpoint, &Network::new(None).unwrap(), terms(1, 1), |_| {});
    let error = made.err().unwrap().to_string();
    assert!(error.contains("cannot listen on tcp/127.0.0.1:") && error.contains("in use"), "{error}");
    drop(taken);
}

#[test]
fn an_interrupted_wait_for_hosts_ends() {
    let (mut fleet, _) = launcher(&free_endpoint(), terms(1, 1));
    let handle = fleet.interrupt_handle();
    let interrupting = std::thread::spawn(move || handle.interrupt());
    assert!(matches!(fleet.gather(), Err(HostsError::Interrupted)));
    interrupting.join().unwrap();
}
