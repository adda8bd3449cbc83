//! Fleets that wait for nobody, with real processes: one that is stopped is late, and nothing is lost.
#![cfg(all(feature = "iceoryx2", feature = "zenoh"))]

mod crew;

use std::time::{Duration, Instant};

use crew::{Crew, Echo, loss};
use proptest::prelude::*;
use rustix::process::Signal;
use shoal_bus::composite::{Composite, Part};
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Answers, Batch, Fleet, FleetError};
use shoal_bus::message::{AuvId, Sensed};
use shoal_bus::shared_memory::SharedMemoryFleet;
use shoal_bus::zenoh::ZenohFleet;

/// What starts [`an_auv`] in a child.
const AS_AUV: &[&str] = &["--exact", "an_auv", "--quiet"];

/// Not a test: what the processes of the other tests run.
#[test]
fn an_auv() {
    crew::be_an_auv_if_asked();
}

const WINDOW: Duration = Duration::from_millis(20);

/// A run without lockstep, and what became of it.
struct Free {
    fleet: Box<dyn Fleet>,
    waiting: Vec<Batch<Sensed>>,
    window: u64,
    /// Ticks answered, by AUV.
    answered: [Vec<u64>; 3],
    losses: Vec<shoal_bus::lockstep::Loss>,
}

impl Free {
    fn new(mut fleet: Box<dyn Fleet>) -> Self {
        assert_eq!(fleet.born(&crew::born(3)).unwrap(), []);
        Self { fleet, waiting: Vec::new(), window: 0, answered: Default::default(), losses: Vec::new() }
    }

    /// One tick for each of them; returns who answered anything.
    fn window(&mut self) -> Vec<u32> {
        for auv in crew::auvs(3) {
            let tick = crew::sensed(auv, self.window);
            match self.waiting.iter_mut().find(|batch| batch.auv == auv) {
                Some(batch) => batch.items.push(tick),
                None => self.waiting.push(Batch { auv, items: vec![tick] }),
            }
        }
        self.waiting.sort_by_key(|batch| batch.auv);
        self.window += 1;
        self.exchange()
    }

    fn exchange(&mut self) -> Vec<u32> {
        let mut calls = 0;
        let deadline = Instant::now() + WINDOW;
        let Answers { acted, losses } =
            self.fleet.exchange_until(&mut self.waiting, deadline, &mut || calls += 1).unwrap();
        assert_eq!(calls, 1);
        assert!(acted.is_sorted_by_key(|batch| batch.auv));
        for batch in &acted {
            self.answered[batch.auv.0 as usize].extend(batch.items.iter().map(|acted| acted.tick));
        }
        self.losses.extend(losses);
        acted.iter().map(|batch| batch.auv.0).collect()
    }

    /// Until nobody is late any more.
    fn catch_up(&mut self) {
        let since = Instant::now();
        let behind = |free: &Self| free.answered.iter().any(|ticks| ticks.len() < free.window as usize);
        while behind(self) {
            self.exchange();
            assert!(
                since.elapsed() < Duration::from_secs(60),
                "{:?}",
                self.answered.each_ref().map(Vec::len)
            );
        }
    }
}

/// Who are stopped are late, the others are not; later all is answered, in order. One that dies while it is late is lost.
fn stopped_ones_are_late_alone(crew: &mut Crew, fleet: Box<dyn Fleet>, stopped: &[u32]) {
    let mut free = Free::new(fleet);
    (0..5).for_each(|_| drop(free.window()));
    free.catch_up();
    stopped.iter().for_each(|auv| crew.signal(*auv, Signal::STOP));
    let before = free.answered.each_ref().map(Vec::len);
    (0..10).for_each(|_| drop(free.window()));
    // The machine may be busy, but the others had ten windows.
    for auv in 0..3 {
        let got = free.answered[auv as usize].len() - before[auv as usize];
        assert_eq!(got > 0, !stopped.contains(&auv), "AUV {auv} answered {got}");
    }
    let kept: usize = free
        .waiting
        .iter()
        .filter(|batch| stopped.contains(&batch.auv.0))
        .map(|batch| batch.items.len())
        .sum();
    assert_eq!(kept, 9 * stopped.len(), "all but the batch that each was sent");

    stopped.iter().for_each(|auv| crew.signal(*auv, Signal::CONT));
    free.catch_up();
    for ticks in &free.answered {
        assert!(ticks.iter().copied().eq(0..15), "{ticks:?}");
    }
    assert_eq!(free.losses, []);

    crew.signal(stopped[0], Signal::STOP);
    drop(free.window());
    crew.signal(stopped[0], Signal::KILL);
    let since = Instant::now();
    while free.losses.is_empty() {
        drop(free.window());
        assert!(since.elapsed() < Duration::from_secs(60));
    }
    assert_eq!(free.losses, [loss(stopped[0], "its process ended")]);
    drop(free.window());
    assert!(!free.waiting.iter().any(|batch| batch.auv.0 == stopped[0]), "nothing waits for the dead");
    free.fleet.end();
}

/// A wake-up group for each.
fn alone(auvs: &[u32]) -> Vec<Vec<AuvId>> {
    auvs.iter().map(|auv| vec![AuvId(*auv)]).collect()
}

#[test]
fn a_stopped_auv_is_late_alone_in_shared_memory() {
    let mut crew = Crew::new();
    let mut fleet = SharedMemoryFleet::create(&crew.run, &alone(&[0, 1, 2])).unwrap();
    let processes = crew.start_each(&|_| Some("iceoryx2"), 3, AS_AUV);
    fleet.attach_processes(&processes).unwrap();
    stopped_ones_are_late_alone(&mut crew, Box::new(fleet), &[1]);
    crew.disband();
}

#[test]
fn stopped_auvs_are_late_alone_over_zenoh() {
    let mut crew = Crew::new();
    let endpoint = ZenohFleet::local_endpoint(&crew.run);
    let mut fleet = ZenohFleet::create(&endpoint, crew.run.id(), &crew::auvs(3)).unwrap();
    let processes = crew.start_each(&|_| Some("zenoh"), 3, AS_AUV);
    fleet.attach_processes(&processes).unwrap();
    stopped_ones_are_late_alone(&mut crew, Box::new(fleet), &[0, 2]);
    crew.disband();
}

#[test]
fn a_stopped_auv_of_one_transport_does_not_delay_another() {
    let mut crew = Crew::new();
    let endpoint = ZenohFleet::local_endpoint(&crew.run);
    let mut zenoh = ZenohFleet::create(&endpoint, crew.run.id(), &[AuvId(1)]).unwrap();
    let mut memory = SharedMemoryFleet::create(&crew.run, &alone(&[0])).unwrap();
    let bus_of = |auv: AuvId| [Some("iceoryx2"), Some("zenoh"), None][auv.0 as usize];
    let processes = crew.start_each(&bus_of, 3, AS_AUV);
    memory.attach_processes(&processes[..1]).unwrap();
    zenoh.attach_processes(&processes[1..]).unwrap();
    let fleet = Composite::new(vec![
        Part { auvs: vec![AuvId(1)], fleet: Box::new(zenoh) },
        Part { auvs: vec![AuvId(0)], fleet: Box::new(memory) },
        Part { auvs: vec![AuvId(2)], fleet: Box::new(Local::new(Echo::new)) },
    ]);
    stopped_ones_are_late_alone(&mut crew, Box::new(fleet.unwrap()), &[0]);
    crew.disband();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Some parts are never late, in any order of parts: the answers are those of lockstep.
    #[test]
    fn whoever_is_in_time_answers_as_in_lockstep(parts in prop::collection::vec(0..3_usize, 1..30)) {
        let count = parts.len() as u32;
        let carried = |part: usize| (0..).map(AuvId).zip(&parts).filter(move |(_, of)| **of == part).map(|(auv, _)| auv);
        let part = |part: usize| Part { auvs: carried(part).collect(), fleet: Box::new(Local::new(Echo::new)) };
        let mut fleet = Composite::new((0..3).map(part).collect()).unwrap();
        let mut lockstep = Local::new(Echo::new);
        fleet.born(&crew::born(count)).unwrap();
        lockstep.born(&crew::born(count)).unwrap();
        for window in 0..5 {
            let mut sensed: Vec<_> = crew::auvs(count).into_iter().filter_map(|auv| crew::batch(auv, window)).collect();
            let expected = lockstep.exchange(&sensed, &mut || {}).unwrap();
            let found = fleet.exchange_until(&mut sensed, Instant::now(), &mut || {}).unwrap();
            prop_assert_eq!(found, expected);
            prop_assert!(sensed.is_empty());
        }
    }
}

/// Knows only lockstep.
struct Patient;

impl Fleet for Patient {
    fn born(&mut self, _: &[shoal_bus::message::Born]) -> Result<Vec<shoal_bus::lockstep::Loss>, FleetError> {
        Ok(Vec::new())
    }

    fn exchange(&mut self, _: &[Batch<Sensed>], meanwhile: &mut dyn FnMut()) -> Result<Answers, FleetError> {
        meanwhile();
        Ok(Answers::default())
    }

    fn end(&mut self) {}
}

#[test]
fn who_can_only_wait_says_so() {
    let refused = Patient.exchange_until(&mut Vec::new(), Instant::now(), &mut || {}).unwrap_err();
    assert!(matches!(refused, FleetError::NoDeadlines), "{refused}");
}
