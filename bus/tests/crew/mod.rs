//! A crew of real processes for tests and benchmarks: this executable, started again for each AUV.
#![allow(dead_code, reason = "every test uses its own part")]

use std::fmt::Display;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use shoal_bus::codec::encode;
use shoal_bus::lockstep::{Answers, Batch, Fleet, FleetError, Link, LinkError, Loss, Mind, ToProcess, live};
use shoal_bus::message::{
    Acted, AuvId, BodyBounds, Born, Bounds, ClockBounds, Controller, Estimator, Event, Measured,
    MediumAccess, ModemBounds, Orders, PlannedPing, Report, Sense, Sensed, Setpoint, Slice, Wake,
};
use shoal_bus::ping::Frame;
use shoal_bus::run_dir::RunDir;
use shoal_bus::shared_memory::{SharedMemoryFleet, SharedMemoryLink};
use shoal_bus::time::LocalTime;
use shoal_bus::zenoh::{ZenohFleet, ZenohLink};

const BUS: &str = "SHOAL_TEST_BUS";
const RUN: &str = "SHOAL_TEST_RUN";
const AUV: &str = "SHOAL_TEST_AUV";
const PARENT: &str = "SHOAL_TEST_PARENT";
const MANNERS: &str = "SHOAL_TEST_MANNERS";

/// Stands for the number of an AUV in the process of a channel.
const CHANNEL: &str = "channel";

/// Lives an AUV's life if this process was started for one. Call it first in whatever [`Crew::start`] starts.
pub fn be_an_auv_if_asked() -> bool {
    let read = |name: &str| std::env::var(name).ok();
    let (Some(bus), Some(run), Some(auv), Some(parent)) = (read(BUS), read(RUN), read(AUV), read(PARENT))
    else {
        return false;
    };
    if !shoal_bus::os::end_with_parent(parent.parse().unwrap()).unwrap() {
        return true;
    }
    let run = RunDir::open(run.as_ref()).unwrap();
    if auv == CHANNEL {
        be_a_channel(&bus, &run);
    }
    let auvs: Vec<AuvId> = auv.split(' ').map(|auv| AuvId(auv.parse().unwrap())).collect();
    let mut link: Box<dyn Link> = match bus.as_str() {
        "iceoryx2" => Box::new(SharedMemoryLink::join(&run, &auvs).unwrap()),
        _ => Box::new(ZenohLink::join(&ZenohFleet::local_endpoint(&run), run.id(), &auvs).unwrap()),
    };
    let lived = match read(MANNERS).as_deref() {
        Some("silent") => live_silently(link.as_mut()),
        Some("terse") => live_tersely(link.as_mut()),
        Some("mortal") => std::process::exit(7),
        _ => live(link.as_mut(), |born| Echo { auv: born.auv, steps: 0 }),
    };
    drop(link);
    if let Err(error) = lived {
        eprintln!("AUV {auv}: {error}");
        std::process::exit(3);
    }
    true
}

/// Runs three AUVs until it is killed.
fn be_a_channel(bus: &str, run: &RunDir) -> ! {
    let mut fleet: Box<dyn Fleet> = match bus {
        "iceoryx2" => Box::new(SharedMemoryFleet::create(run, &seats(3, 1)).unwrap()),
        _ => Box::new(ZenohFleet::create(&ZenohFleet::local_endpoint(run), run.id(), &auvs(3)).unwrap()),
    };
    std::fs::write(run.path().join(CHANNEL), "ready").unwrap();
    fleet.born(&born(3)).unwrap();
    for window in 0.. {
        exchange(fleet.as_mut(), 3, window).unwrap();
        std::fs::write(run.path().join(CHANNEL), "running").unwrap();
    }
    unreachable!("there is always a next window")
}

/// Takes its first batch and never answers.
fn live_silently(link: &mut dyn Link) -> Result<(), LinkError> {
    while !matches!(link.receive()?, ToProcess::Sensed(_)) {}
    std::thread::sleep(Duration::from_secs(600));
    Ok(())
}

/// Answers nothing to whatever it is asked.
fn live_tersely(link: &mut dyn Link) -> Result<(), LinkError> {
    loop {
        match link.receive()? {
            ToProcess::Born(_) => {}
            ToProcess::Sensed(Batch { auv, .. }) => link.answer(Batch { auv, items: Vec::new() })?,
            ToProcess::End => return Ok(()),
        }
    }
}

/// Answers with what it sensed, and with how often it was asked.
pub struct Echo {
    auv: AuvId,
    steps: u64,
}

impl Echo {
    pub fn new(born: &Born) -> Self {
        Self { auv: born.auv, steps: 0 }
    }
}

impl Mind for Echo {
    fn step(&mut self, sensed: &Sensed) -> Acted {
        self.steps += 1;
        let clock_offset_s = Bounds::new(0.0, self.steps as f64);
        let position_m = [Bounds::new(0.0, f64::from(self.auv.0)); 3];
        let heard = sensed.events.iter().filter_map(|event| match &event.sense {
            Sense::Heard { frame } => Some(PlannedPing { at: event.stamp, listen_ns: 0, frame: *frame }),
            _ => None,
        });
        Acted {
            tick: sensed.tick,
            setpoint: Setpoint { velocity_m_s: [self.steps as f64, sensed.events.len() as f64, 0.0] },
            pings: heard.collect(),
            report: Report {
                position_m,
                clock_offset_s,
                slice: Slice { position_m, clock_offset_s },
                emptied: None,
                neighbours: 0,
                contractions: sensed.events.len() as u16,
                rejected: 0,
                around: Vec::new(),
                components: 1,
                gaussian: None,
            },
        }
    }
}

/// Kills one process by its number.
pub fn kill_pid(pid: u32) {
    let pid = rustix::process::Pid::from_raw(pid as i32).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::KILL).unwrap();
}

pub fn auvs(count: u32) -> Vec<AuvId> {
    (0..count).map(AuvId).collect()
}

/// The AUVs of each process, `each` of them but for the last.
fn seats(count: u32, each: u32) -> Vec<Vec<AuvId>> {
    auvs(count).chunks(each as usize).map(<[AuvId]>::to_vec).collect()
}

pub fn born(count: u32) -> Vec<Born> {
    let side = [Bounds::new(-1.0, 1.0); 3];
    let one = |auv| Born {
        auv,
        group: 0,
        name: format!("green-{auv}"),
        wake: Wake { first_tick: LocalTime::ZERO, period_ns: 100_000_000, reaction_ns: 100_000_000 },
        clock: ClockBounds { drift: 0.0, offset_s: side[0], stamp_ns: 1 },
        birth: LocalTime::ZERO,
        prior_position_m: side,
        body: BodyBounds {
            speed_m_s: 2.0,
            acceleration_m_s2: 1.0,
            current_m_s: side,
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: side,
        },
        modem: ModemBounds {
            range_m: 500.0,
            hearing_range_m: 500.0,
            sound_speed_m_s: side[0],
            sound_speed_is_constant: false,
            timestamp_s: 0.0,
            frame_bytes: 32,
        },
        orders: Orders {
            estimator: Estimator::DeadReckoning,
            controller: Controller::Hold,
            access: MediumAccess::Silent,
            area_m: side,
            sabotage: None,
            relative: None,
        },
    };
    auvs(count).into_iter().map(one).collect()
}

/// The batch of one AUV: usually one tick, at times none or two, with some pings heard.
pub fn batch(auv: AuvId, window: u64) -> Option<Batch<Sensed>> {
    let ticks = match (u64::from(auv.0) * 7 + window * 3) % 11 {
        0 => return None,
        1 => 2,
        _ => 1,
    };
    Some(Batch { auv, items: (0..ticks).map(|tick| sensed(auv, 2 * window + tick)).collect() })
}

pub fn sensed(auv: AuvId, tick: u64) -> Sensed {
    sensed_with(auv, tick, (u64::from(auv.0) + tick) % 4)
}

/// A tick in which so many pings are heard.
pub fn sensed_with(auv: AuvId, tick: u64, pings: u64) -> Sensed {
    let stamp = LocalTime::from_ns(tick as i64 * 50_000_000);
    let depth_m = Measured { value: f64::from(auv.0), error: 0.1 };
    let mut events = vec![Event { stamp, sense: Sense::Depth { depth_m } }];
    for heard in 0..pings {
        let frame = Frame::new(&[(heard + tick) as u8; 32]).unwrap();
        events.push(Event { stamp, sense: Sense::Heard { frame } });
    }
    Sensed { tick, stamp, events }
}

/// Runs `windows` windows and digests all answers; panics at any loss.
pub fn digest(fleet: &mut dyn Fleet, count: u32, windows: u64) -> u64 {
    assert_eq!(fleet.born(&born(count)).unwrap(), []);
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for window in 0..windows {
        let answers = exchange(fleet, count, window).unwrap();
        assert_eq!(answers.losses, []);
        for batch in &answers.acted {
            for byte in [encode(&batch.auv).unwrap(), encode(&batch.items).unwrap()].concat() {
                digest = (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    digest
}

pub fn exchange(fleet: &mut dyn Fleet, count: u32, window: u64) -> Result<Answers, FleetError> {
    let batches: Vec<Batch<Sensed>> = auvs(count).into_iter().filter_map(|auv| batch(auv, window)).collect();
    fleet.exchange(&batches, &mut || {})
}

pub fn loss(auv: u32, reason: &str) -> Loss {
    Loss { auv: AuvId(auv), reason: reason.to_owned() }
}

/// The processes of a run, and its folder: whatever happens, none of them stays.
pub struct Crew {
    pub run: RunDir,
    /// How many AUVs a process carries.
    pub each: u32,
    children: Vec<Child>,
}

impl Crew {
    pub fn new() -> Self {
        RunDir::sweep();
        let run = RunDir::create(&serde_json::json!({"scenario": "test"})).unwrap();
        Self { run, each: 1, children: Vec::new() }
    }

    /// Starts the processes of `count` AUVs, with `arguments` that make this executable call [`be_an_auv_if_asked`].
    pub fn start(
        &mut self,
        bus: &str,
        count: u32,
        arguments: &[&str],
        manners: &[(u32, &str)],
    ) -> Vec<(AuvId, u32)> {
        let manners_of =
            |auv: &AuvId| manners.iter().find(|(who, _)| *who == auv.0).map_or("", |(_, how)| how);
        let mut processes = Vec::new();
        for seat in seats(count, self.each) {
            let names: Vec<String> = seat.iter().map(AuvId::to_string).collect();
            let child = self.command(bus, names.join(" "), arguments, manners_of(&seat[0])).spawn().unwrap();
            processes.extend(seat.iter().map(|auv| (*auv, child.id())));
            self.children.push(child);
        }
        processes
    }

    /// Starts the AUVs of `count` that `bus_of` gives a bus to.
    pub fn start_each(
        &mut self,
        bus_of: &dyn Fn(AuvId) -> Option<&'static str>,
        count: u32,
        arguments: &[&str],
    ) -> Vec<(AuvId, u32)> {
        let started = auvs(count).into_iter().filter_map(|auv| Some((auv, bus_of(auv)?)));
        let started: Vec<(AuvId, Child)> =
            started.map(|(auv, bus)| (auv, self.command(bus, auv, arguments, "").spawn().unwrap())).collect();
        let processes = started.iter().map(|(auv, child)| (*auv, child.id())).collect();
        self.children = started.into_iter().map(|(_, child)| child).collect();
        processes
    }

    /// Starts a channel in a process of its own, and three AUVs; kills it in the middle of the run, and waits until they
    /// have ended as well.
    pub fn outlive_channel(&mut self, bus: &str, arguments: &[&str]) {
        let channel = self.command(bus, CHANNEL, arguments, "").spawn().unwrap();
        let until = |state: &str| {
            let since = Instant::now();
            while !std::fs::read_to_string(self.run.path().join(CHANNEL)).is_ok_and(|now| now == state) {
                assert!(since.elapsed() < Duration::from_secs(60), "the channel is not {state}");
                std::thread::sleep(Duration::from_millis(2));
            }
        };
        until("ready");
        let mut children: Vec<Child> =
            (0..3).map(|auv| self.command(bus, auv, arguments, "").spawn().unwrap()).collect();
        until("running");
        children.push(channel);
        self.children = children;
        self.kill(3);
        (0..3).for_each(|auv| assert_eq!(self.await_end(auv).code(), Some(3)));
    }

    /// Starts one AUV whose process has ended once more.
    pub fn start_again(&mut self, bus: &str, auv: u32, arguments: &[&str]) -> (AuvId, u32) {
        self.children[(auv / self.each) as usize] =
            self.command(bus, AuvId(auv), arguments, "").spawn().unwrap();
        (AuvId(auv), self.pid(auv))
    }

    fn command(&self, bus: &str, auv: impl Display, arguments: &[&str], manners: &str) -> Command {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(arguments).env(BUS, bus).env(RUN, self.run.path()).env(AUV, auv.to_string());
        command.env(PARENT, std::process::id().to_string()).env(MANNERS, manners);
        command.env(shoal_bus::zenoh::RUNTIME_ENV.0, shoal_bus::zenoh::RUNTIME_ENV.1);
        command.stdin(Stdio::null()).stdout(Stdio::null());
        command
    }

    pub fn pid(&self, auv: u32) -> u32 {
        self.children[(auv / self.each) as usize].id()
    }

    /// Sends a signal to one's process; a stop has come to all of its threads then.
    pub fn signal(&self, auv: u32, signal: rustix::process::Signal) {
        let pid = self.pid(auv);
        rustix::process::kill_process(rustix::process::Pid::from_raw(pid as i32).unwrap(), signal).unwrap();
        let since = Instant::now();
        while signal == rustix::process::Signal::STOP && !is_stopped(pid) {
            assert!(since.elapsed() < Duration::from_secs(60), "process {pid} does not stop");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    pub fn kill(&mut self, auv: u32) {
        self.children[(auv / self.each) as usize].kill().unwrap();
    }

    /// How AUV `auv` ended; panics if it does not.
    pub fn await_end(&mut self, auv: u32) -> ExitStatus {
        let since = Instant::now();
        loop {
            if let Some(status) = self.children[(auv / self.each) as usize].try_wait().unwrap() {
                return status;
            }
            assert!(since.elapsed() < Duration::from_secs(60), "AUV {auv} does not end");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Waits until all have ended by themselves, removes the run, and checks that nothing is left of it.
    pub fn disband(mut self) {
        for process in 0..self.children.len() {
            self.await_end(process as u32 * self.each);
        }
        self.run.remove().unwrap();
        let left = std::fs::read_dir("/dev/shm").unwrap().flatten().map(|entry| entry.file_name());
        let left: Vec<_> = left.filter(|name| name.to_string_lossy().contains(self.run.id())).collect();
        assert!(left.is_empty(), "{left:?} are left");
    }

    pub fn shared_memory(
        &mut self,
        count: u32,
        arguments: &[&str],
        manners: &[(u32, &str)],
    ) -> SharedMemoryFleet {
        let mut fleet = SharedMemoryFleet::create(&self.run, &seats(count, self.each)).unwrap();
        let processes = self.start("iceoryx2", count, arguments, manners);
        fleet.attach_processes(&processes).unwrap();
        fleet
    }

    pub fn zenoh(&mut self, count: u32, arguments: &[&str], manners: &[(u32, &str)]) -> ZenohFleet {
        let endpoint = ZenohFleet::local_endpoint(&self.run);
        let mut fleet = ZenohFleet::create(&endpoint, self.run.id(), &auvs(count)).unwrap();
        let processes = self.start("zenoh", count, arguments, manners);
        fleet.attach_processes(&processes).unwrap();
        fleet
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        for child in &mut self.children {
            // Those that have ended already are only reaped.
            let _killed = child.kill();
            let _status = child.wait();
        }
        let _removed = self.run.remove();
    }
}

/// Whether every thread of the process is stopped: each does so at its own next moment on a processor.
fn is_stopped(pid: u32) -> bool {
    let threads = std::fs::read_dir(format!("/proc/{pid}/task")).unwrap();
    threads.flatten().all(|thread| {
        let stat = std::fs::read_to_string(thread.path().join("stat")).unwrap_or_default();
        stat.rsplit_once(") ").is_none_or(|(_, rest)| rest.starts_with('T'))
    })
}
