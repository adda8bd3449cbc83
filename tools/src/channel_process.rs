//! `shoal channel`: the process of the water.

use std::io::{self, BufRead, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc;
use std::time::Duration;

use shoal_bus::composite::{Composite, Part};
use shoal_bus::hosts::HostsFleet;
use shoal_bus::lockstep::{Fleet, FleetError};
use shoal_bus::message::AuvId;
use shoal_bus::run_dir::RunDir;
use shoal_bus::shared_memory::SharedMemoryFleet;
use shoal_bus::summary::{Memory, Summary};
use shoal_bus::zenoh::ZenohFleet;
use shoal_channel::channel::Channel;
use shoal_scenario::Scenario;

use crate::cli::Bus;
use crate::conduct::{Conducted, conduct};
use crate::drive::{Ending, Observer};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::launch::{Done, FromChannel, Order, ToChannel};
use crate::memory;
use crate::observers::{Progress, Recorder, Tapped};
use crate::seat::Seat;

/// Runs the water for the launcher at the other end of the pipes, in the folder `run`.
pub fn run(run: &RunDir) -> Result<Exit, Failure> {
    let orphaned = Arc::new(AtomicBool::new(false));
    let exit = match serve(run, &orphaned) {
        Ok(()) => Exit::Good,
        Err(failure) => {
            say(&FromChannel::Failed { message: failure.message });
            failure.exit
        }
    };
    if orphaned.load(Ordering::Acquire) {
        remove_traces(run);
    }
    Ok(exit)
}

/// The launcher is gone, so nobody else removes what is left of the run.
fn remove_traces(run: &RunDir) {
    for _ in 0..2 {
        if let Err(error) = run.remove() {
            eprintln!("error: what is left of run {} could not be removed: {error}", run.id());
        }
        // AUVs die with the launcher, but one that was just starting may have made something since.
        std::thread::sleep(Duration::from_millis(200));
    }
}

fn serve(run: &RunDir, orphaned: &Arc<AtomicBool>) -> Result<(), Failure> {
    let mut lines = io::stdin().lock();
    let order = match next(&mut lines).transpose()? {
        Some(ToChannel::Run(order)) => order,
        Some(_) => return Err(Failure::usage("`shoal channel` is started by `shoal run`")),
        None => {
            orphaned.store(true, Ordering::Release);
            return Err(Failure::failed("the launcher ended before it said what to run"));
        }
    };
    let scenario = order.scenario()?;
    let mut channel = Channel::new(&scenario).map_err(Failure::failed)?;
    let recorder = match &order.record {
        Some(path) => {
            channel.watch_flock();
            Some(Recorder::create(path, &scenario, &order.text, &channel.born())?)
        }
        None => None,
    };
    let seats = Seat::of_run(&order, &scenario);
    let (mut fleet, launched) = fleet(&order, &scenario, &channel, seats, run, lines, orphaned)?;
    let outcome = carry_out(&order, &scenario, &mut channel, fleet.as_mut(), recorder, &launched, run);
    fleet.end();
    drop(fleet);
    say(&outcome?);
    Ok(())
}

/// All AUVs of the run, once their processes have been started: the user's programs always speak zenoh.
fn fleet(
    order: &Order,
    scenario: &Scenario,
    channel: &Channel,
    seats: Vec<Seat>,
    run: &RunDir,
    lines: io::StdinLock<'static>,
    orphaned: &Arc<AtomicBool>,
) -> Result<(Box<dyn Fleet>, Launched), Failure> {
    let speaks_zenoh = |seat: &Seat| order.bus == Bus::Zenoh || seat.command.is_some();
    let (by_zenoh, in_memory): (Vec<Seat>, Vec<Seat>) = seats.iter().cloned().partition(speaks_zenoh);
    let ids = |seats: &[Seat]| -> Vec<AuvId> { seats.iter().flat_map(Seat::ids).collect() };
    let (over_network, in_memory_ids) = (ids(&by_zenoh), ids(&in_memory));

    let mut shared_memory = match in_memory.as_slice() {
        [] => None,
        seats => {
            let processes = Seat::in_wake_order(seats, &channel.wake_order());
            Some(SharedMemoryFleet::create(run, &processes).map_err(Failure::failed)?)
        }
    };
    let endpoint = order.endpoint.clone().unwrap_or_else(|| ZenohFleet::local_endpoint(run));
    let mut zenoh = match over_network.as_slice() {
        [] => None,
        auvs => Some(ZenohFleet::create(&endpoint, run.id(), auvs).map_err(Failure::failed)?),
    };
    let mut elsewhere = Vec::new();
    let mut hosts = match &order.hosts {
        None => None,
        Some(hosts) => {
            elsewhere = channel.wake_order();
            elsewhere.retain(|auv| over_network.binary_search(auv).is_err());
            let tell = |news: &str| say(&FromChannel::News(news.to_owned()));
            Some(hosts.listen(order, scenario, elsewhere.clone(), tell)?)
        }
    };
    let interrupts = (
        shared_memory.as_ref().map(SharedMemoryFleet::interrupt_handle),
        zenoh.as_ref().map(ZenohFleet::interrupt_handle),
        hosts.as_ref().map(HostsFleet::interrupt_handle),
    );
    let interrupt = move || {
        interrupts.2.iter().for_each(|handle| handle.interrupt());
        interrupts.0.iter().for_each(|handle| handle.interrupt());
        interrupts.1.iter().for_each(|handle| handle.interrupt());
    };
    let mut launched = Launched::wait(seats, lines, orphaned, interrupt)?;
    if let Some(fleet) = &mut hosts {
        fleet.gather().map_err(Failure::failed)?;
        launched.elsewhere = fleet.processes();
    }
    let processes = launched.processes();
    let of = |auvs: &[AuvId]| -> Vec<(AuvId, u32)> {
        processes.iter().copied().filter(|(auv, _)| auvs.binary_search(auv).is_ok()).collect()
    };
    if let Some(fleet) = &mut shared_memory {
        fleet.attach_processes(&of(&in_memory_ids)).map_err(Failure::failed)?;
    }
    if let Some(fleet) = &mut zenoh {
        fleet.attach_processes(&of(&over_network)).map_err(Failure::failed)?;
    }
    let zenoh = zenoh.map(|fleet| Part { auvs: over_network, fleet: Box::new(fleet) as Box<dyn Fleet> });
    let shared_memory =
        shared_memory.map(|fleet| Part { auvs: in_memory_ids, fleet: Box::new(fleet) as Box<dyn Fleet> });
    let hosts = hosts.map(|fleet| Part { auvs: elsewhere, fleet: Box::new(fleet) as Box<dyn Fleet> });
    let mut parts: Vec<Part> = hosts.into_iter().chain(zenoh).chain(shared_memory).collect();
    let fleet = match parts.pop() {
        Some(part) if parts.is_empty() => part.fleet,
        last => {
            parts.extend(last);
            Box::new(Composite::new(parts).map_err(Failure::failed)?)
        }
    };
    Ok((fleet, launched))
}

/// Births, windows, and the summing up.
fn carry_out(
    order: &Order,
    scenario: &Scenario,
    channel: &mut Channel,
    fleet: &mut dyn Fleet,
    mut recorder: Option<Recorder>,
    launched: &Launched,
    run: &RunDir,
) -> Result<FromChannel, Failure> {
    let (mut tapped, trouble) = Tapped::create(run, scenario, &order.text, channel.born());
    trouble.map(FromChannel::Note).iter().for_each(say);

    let is_born = match fleet.born(&channel.born()) {
        Ok(losses) => {
            channel.stillborn(losses);
            say(&FromChannel::Started);
            true
        }
        Err(FleetError::Interrupted) => false,
        Err(error) => return Err(Failure::failed(error)),
    };
    let processes: Vec<u32> = launched.seats.iter().map(|(_, pid)| *pid).collect();
    let conducted = if is_born {
        let mut progress = Progress::new(|sim_s| say(&FromChannel::Progress(sim_s)));
        let mut observers: Vec<&mut dyn Observer> = vec![&mut tapped, &mut progress];
        observers.extend(recorder.as_mut().map(|recorder| recorder as &mut dyn Observer));
        let interrupted = || launched.interrupted();
        conduct(order, scenario, channel, fleet, &mut observers, &interrupted, &processes)?
    } else {
        Conducted::nothing()
    };

    let simulated = conducted.complete(channel.summary());
    let incomplete_record = recorder.and_then(|recorder| recorder.finish(&simulated));
    incomplete_record.clone().map(FromChannel::Note).iter().for_each(say);
    tapped.end(&simulated);
    let is_alive = |seat: &Seat| seat.ids().into_iter().any(|auv| channel.is_alive(auv));
    let alive: Vec<(u32, usize)> = launched
        .seats
        .iter()
        .filter(|(seat, _)| is_alive(seat))
        .map(|(seat, pid)| (*pid, seat.auvs.len()))
        .collect();
    let summary = Summary {
        bus: Some(order.bus_name().to_owned()),
        processes: Some(launched.seats.len() as u32 + launched.elsewhere.load(Ordering::Relaxed) + 1),
        memory: Some(Memory {
            auv_pss_kib_median: memory::median_pss_kib(&alive),
            channel_rss_kib: memory::own_rss_kib(),
        }),
        ..conducted.with_wall_facts(simulated)
    };
    let aborted = match &conducted.ending {
        Ending::Aborted(loss) => {
            Some(format!("AUV {} ended ({}) and on_crash = \"abort\"", loss.auv, loss.reason))
        }
        _ => None,
    };
    let interrupted = conducted.ending == Ending::Interrupted;
    let record_incomplete = incomplete_record.is_some();
    Ok(FromChannel::Done(Box::new(Done { summary, interrupted, record_incomplete, aborted })))
}

/// The seats with their processes, and the launcher's later word.
struct Launched {
    seats: Vec<(Seat, u32)>,
    /// How many processes other hosts have started.
    elsewhere: Arc<AtomicU32>,
    stop: Arc<AtomicBool>,
}

impl Launched {
    /// Asks the launcher for the AUVs' processes and listens to it from then on. When it says stop, or is gone (`orphaned` is set),
    /// `interrupt` is called.
    fn wait(
        seats: Vec<Seat>,
        lines: io::StdinLock<'static>,
        orphaned: &Arc<AtomicBool>,
        interrupt: impl Fn() + Send + 'static,
    ) -> Result<Self, Failure> {
        say(&FromChannel::Ready);
        let stop = Arc::new(AtomicBool::new(false));
        let (sender, receiver) = mpsc::channel();
        let (stopping, orphaned) = (Arc::clone(&stop), Arc::clone(orphaned));
        drop(lines);
        let listen = move || {
            let mut lines = io::stdin().lock();
            while let Some(Ok(word)) = next(&mut lines) {
                match word {
                    ToChannel::Processes(pids) => {
                        // The receiver waits for exactly this.
                        let _told = sender.send(pids);
                    }
                    ToChannel::Stop => {
                        stopping.store(true, Ordering::Release);
                        interrupt();
                    }
                    ToChannel::Run(_) => {}
                }
            }
            orphaned.store(true, Ordering::Release);
            stopping.store(true, Ordering::Release);
            interrupt();
        };
        std::thread::Builder::new()
            .name("launcher".to_owned())
            .spawn(listen)
            .while_doing("start a thread")?;
        let pids = receiver.recv().map_err(|_| Failure::failed("the launcher ended before the run began"))?;
        Ok(Self { seats: seats.into_iter().zip(pids).collect(), elsewhere: Arc::default(), stop })
    }

    /// Which process is which AUV.
    fn processes(&self) -> Vec<(AuvId, u32)> {
        let of_seat = |(seat, pid): &(Seat, u32)| seat.ids().into_iter().zip(std::iter::repeat(*pid));
        self.seats.iter().flat_map(of_seat).collect()
    }

    fn interrupted(&self) -> bool {
        self.stop.load(Ordering::Acquire)
    }
}

/// The launcher's next word; `None` when it is gone.
fn next(lines: &mut dyn BufRead) -> Option<Result<ToChannel, Failure>> {
    let mut line = String::new();
    match lines.read_line(&mut line) {
        Ok(1..) => Some(serde_json::from_str(&line).while_doing("understand the launcher")),
        _ => None,
    }
}

fn say(word: &FromChannel) {
    let Ok(line) = serde_json::to_string(word) else { return };
    // A launcher that is gone is noticed by the end of our input.
    let mut out = io::stdout().lock();
    let _gone = writeln!(out, "{line}").and_then(|()| out.flush());
}
