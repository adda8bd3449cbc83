//! Several transports in one run.
#![cfg(all(feature = "iceoryx2", feature = "zenoh"))]

mod crew;

use std::cell::RefCell;
use std::time::Duration;

use crew::{Crew, Echo, digest, exchange, loss};
use proptest::prelude::*;
use shoal_bus::composite::{Composite, Part};
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Answers, Batch, Fleet, FleetError, Loss};
use shoal_bus::message::{AuvId, Born, Sensed};
use shoal_bus::shared_memory::SharedMemoryFleet;
use shoal_bus::zenoh::ZenohFleet;

/// What starts [`an_auv`] in a child.
const AS_AUV: &[&str] = &["--exact", "an_auv", "--quiet"];

/// Not a test: what the processes of the other tests run.
#[test]
fn an_auv() {
    crew::be_an_auv_if_asked();
}

/// The AUVs whose place in `parts` is `part`.
fn carried(parts: &[usize], part: usize) -> Vec<AuvId> {
    (0..).map(AuvId).zip(parts).filter(|(_, place)| **place == part).map(|(auv, _)| auv).collect()
}

fn local(auvs: Vec<AuvId>) -> Part<'static> {
    Part { auvs, fleet: Box::new(Local::new(Echo::new)) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_partition_gives_the_same_answers(parts in prop::collection::vec(0..4_usize, 1..40)) {
        let count = parts.len() as u32;
        let expected = digest(&mut Local::new(Echo::new), count, 6);
        let mut fleet = Composite::new((0..4).map(|part| local(carried(&parts, part))).collect()).unwrap();
        prop_assert_eq!(digest(&mut fleet, count, 6), expected);
    }

    #[test]
    fn an_auv_that_no_part_carries_is_an_error(missing in 0..6_u32, split in 0..6_u32) {
        let present = |from, to| (from..to).filter(|auv| *auv != missing).map(AuvId).collect();
        let mut fleet = Composite::new(vec![local(present(0, split)), local(present(split, 6))]).unwrap();
        let expected = format!("no part carries AUV {missing}");
        let unborn = fleet.born(&crew::born(6)).unwrap_err();
        prop_assert!(unborn.to_string().contains(&expected), "{}", unborn);
        let batch = Batch { auv: AuvId(missing), items: vec![crew::sensed(AuvId(missing), 1)] };
        let unsent = fleet.exchange(&[batch], &mut || {}).unwrap_err();
        prop_assert!(unsent.to_string().contains(&expected), "{}", unsent);
    }

    /// Some of each part die, and some windows fail in one part.
    #[test]
    fn losses_and_errors_of_one_part_leave_the_others_as_they_are(
        parts in prop::collection::vec(0..3_usize, 2..20),
        doomed in prop::collection::btree_set(0..20_u32, 0..6),
        failing in prop::option::of(0..3_usize),
    ) {
        let count = parts.len() as u32;
        let log = RefCell::new(Vec::new());
        let made = (0..3).map(|part| {
            let auvs = carried(&parts, part);
            let doomed = doomed.iter().copied().map(AuvId).filter(|auv| auvs.contains(auv)).collect();
            let fails = failing == Some(part);
            let fleet = Mortal { part, inner: Local::new(Echo::new), doomed, fails, log: &log };
            Part { auvs, fleet: Box::new(fleet) }
        });
        let mut fleet = Composite::new(made.collect()).unwrap();
        fleet.born(&crew::born(count)).unwrap();
        let mut all = Local::new(Echo::new);
        all.born(&crew::born(count)).unwrap();
        let expected = exchange(&mut all, count, 1).unwrap();
        let found = exchange(&mut fleet, count, 1);
        // All are sent to before any is waited for.
        let expected_log = ["sent 0", "sent 1", "sent 2", "gathers 2", "gathers 1", "gathers 0"];
        drop(fleet);
        prop_assert_eq!(log.into_inner(), expected_log);
        match (found, failing) {
            (Err(FleetError::Stalled { waiting, .. }), Some(part)) => {
                let is_due = |auv: &AuvId| crew::batch(*auv, 1).is_some();
                prop_assert_eq!(waiting, carried(&parts, part).into_iter().filter(is_due).collect::<Vec<_>>());
            }
            (Ok(found), None) => {
                let dead: Vec<u32> = doomed.into_iter().filter(|auv| *auv < count).collect();
                let losses: Vec<_> = dead.iter().map(|auv| loss(*auv, "sank")).collect();
                prop_assert_eq!(found.losses, losses);
                let alive = expected.acted.into_iter().filter(|batch| !dead.contains(&batch.auv.0));
                prop_assert_eq!(found.acted, alive.collect::<Vec<_>>());
            }
            (found, failing) => prop_assert!(false, "{found:?} though {failing:?} fails"),
        }
    }
}

/// A fleet some of which die in the first window, and that perhaps stalls.
struct Mortal<'a, F> {
    part: usize,
    inner: F,
    doomed: Vec<AuvId>,
    fails: bool,
    log: &'a RefCell<Vec<String>>,
}

impl<F: Fleet> Fleet for Mortal<'_, F> {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        self.inner.born(born)
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        self.log.borrow_mut().push(format!("sent {}", self.part));
        let mut answers = self.inner.exchange(sensed, meanwhile)?;
        self.log.borrow_mut().push(format!("gathers {}", self.part));
        if self.fails {
            let waiting = sensed.iter().map(|batch| batch.auv).collect();
            return Err(FleetError::Stalled { waiting, limit_s: 1 });
        }
        answers.acted.retain(|batch| !self.doomed.contains(&batch.auv));
        answers.losses = self.doomed.drain(..).map(|auv| loss(auv.0, "sank")).collect();
        Ok(answers)
    }

    fn end(&mut self) {
        self.inner.end();
    }
}

/// AUV by AUV: shared memory, zenoh, in this program.
#[test]
fn three_transports_in_one_run_answer_as_one_program() {
    const COUNT: u32 = 12;
    let expected = digest(&mut Local::new(Echo::new), COUNT, 40);
    let parts: Vec<usize> = (0..COUNT as usize).map(|auv| auv % 3).collect();
    let mut crew = Crew::new();
    let processes: Vec<Vec<AuvId>> = carried(&parts, 0).into_iter().map(|auv| vec![auv]).collect();
    let mut memory = SharedMemoryFleet::create(&crew.run, &processes).unwrap();
    let endpoint = ZenohFleet::local_endpoint(&crew.run);
    let mut zenoh = ZenohFleet::create(&endpoint, crew.run.id(), &carried(&parts, 1)).unwrap();
    let bus_of = |auv: AuvId| [Some("iceoryx2"), Some("zenoh"), None][parts[auv.0 as usize]];
    let processes = crew.start_each(&bus_of, COUNT, AS_AUV);
    let of = |part: usize| processes.iter().copied().filter(move |(auv, _)| auv.0 as usize % 3 == part);
    memory.attach_processes(&of(0).collect::<Vec<_>>()).unwrap();
    zenoh.attach_processes(&of(1).collect::<Vec<_>>()).unwrap();
    let mut fleet = Composite::new(vec![
        Part { auvs: carried(&parts, 0), fleet: Box::new(memory) },
        Part { auvs: carried(&parts, 1), fleet: Box::new(zenoh) },
        local(carried(&parts, 2)),
    ])
    .unwrap();
    assert_eq!(digest(&mut fleet, COUNT, 40), expected);
    // One of each transport that has processes dies.
    for auv in [3, 4] {
        crew::kill_pid(processes.iter().find(|(who, _)| who.0 == auv).unwrap().1);
    }
    let mut losses = Vec::new();
    let mut window = 0;
    while losses.len() < 2 {
        losses.extend(exchange(&mut fleet, COUNT, window).unwrap().losses);
        window += 1;
        std::thread::sleep(Duration::from_millis(1));
    }
    losses.sort_by_key(|loss| loss.auv);
    assert_eq!(losses, [3, 4].map(|auv| loss(auv, "its process ended")));
    fleet.end();
    drop(fleet);
    crew.disband();
}
