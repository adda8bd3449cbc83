//! Windows per second through a host, beside one zenoh session per AUV: idle minds, all of them due, in one run.
//!
//! `cargo bench -p shoal-bus --features iceoryx2,zenoh --bench hosts`

#[path = "../tests/crew/mod.rs"]
mod crew;

use std::net::TcpListener;
use std::time::{Duration, Instant};

use crew::Crew as Processes;
use shoal_bus::hosts::{Assignment, Crew, Decoding, Ending, Host, HostsFleet, Network, Offer, Relay, Terms};
use shoal_bus::lockstep::{Batch, Fleet, FleetError, Loss};
use shoal_bus::message::Sensed;

const MEASURED: Duration = Duration::from_secs(4);

fn main() {
    if crew::be_an_auv_if_asked() {
        return;
    }
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let count = if is_bench { 1000 } else { 3 };
    let hosts = through_a_host(count);
    let sessions = one_session_each(count);
    let line = serde_json::json!({
        "format": "shoal.bench/1",
        "name": format!("bus/hosts/{count}/windows"),
        "value": hosts,
        "unit": "1/s",
        "beside": {"name": format!("bus/zenoh/{count}/windows"), "ratio": hosts / sessions},
    });
    println!("{line}");
}

fn through_a_host(count: u32) -> f64 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("the loopback has free ports");
    let endpoint = format!("tcp/{}", listener.local_addr().expect("a bound socket has an address"));
    drop(listener);
    let network = Network::new(None).expect("the defaults are a configuration");
    let terms = Terms {
        name: "idle".into(),
        scenario: String::new(),
        auvs: crew::auvs(count),
        hosts: 1,
        auvs_per_process: 1,
        token: None,
        limit: Duration::from_secs(60),
        clock_limit: None,
    };
    let mut fleet = HostsFleet::listen(&endpoint, &network, terms, |_| {}).expect("the port is free");
    let offer = Offer {
        endpoint,
        name: "alpha".into(),
        slots: count,
        token: None,
        scenario: None,
        wait: Duration::from_secs(60),
    };
    let host = std::thread::spawn(move || {
        let host = Host::join(&offer, &network).expect("the launcher listens");
        host.serve(&mut Inside::default()).expect("the run is over")
    });
    fleet.gather().expect("a host joins");
    let rate = windows_per_s(&mut fleet, count);
    drop(fleet);
    assert_eq!(host.join().expect("a host does not panic"), Ending::Over);
    rate
}

fn one_session_each(count: u32) -> f64 {
    let mut crew = Processes::new();
    let mut fleet = crew.zenoh(count, &[], &[]);
    let rate = windows_per_s(&mut fleet, count);
    drop(fleet);
    crew.disband();
    rate
}

fn windows_per_s(fleet: &mut dyn Fleet, count: u32) -> f64 {
    assert_eq!(fleet.born(&crew::born(count)).expect("all are born"), []);
    let since = Instant::now();
    let mut windows = 0;
    while since.elapsed() < MEASURED {
        let one = |auv| Batch { auv, items: vec![crew::sensed(auv, windows)] };
        let batches: Vec<Batch<Sensed>> = crew::auvs(count).into_iter().map(one).collect();
        let answers = fleet.exchange(&batches, &mut || {}).expect("all answer");
        assert_eq!(answers.acted.len(), count as usize);
        windows += 1;
    }
    let rate = windows as f64 / since.elapsed().as_secs_f64();
    fleet.end();
    rate
}

/// A host's processes.
#[derive(Default)]
struct Inside {
    processes: Option<Processes>,
    count: u32,
}

impl Crew for Inside {
    fn start(&mut self, assignment: &Assignment) -> Result<Box<dyn Relay>, FleetError> {
        self.count = assignment.auvs.len() as u32;
        let fleet = self.processes.insert(Processes::new()).shared_memory(self.count, &[], &[]);
        let interrupt = fleet.interrupt_handle();
        Ok(Box::new(Decoding::new(fleet, move || interrupt.interrupt())))
    }

    fn processes(&self) -> u32 {
        self.count
    }

    fn explain(&mut self, _: &mut Loss) {}

    fn progress(&mut self, _: u64, _: usize) {}

    fn disband(&mut self) {
        if let Some(processes) = self.processes.take() {
            processes.disband();
        }
    }
}
