//! The `zenoh` transport with real processes.
#![cfg(all(feature = "iceoryx2", feature = "zenoh"))]

mod crew;

use std::time::Duration;

use crew::{Crew, Echo, digest, exchange, loss};
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Fleet, FleetError};
use shoal_bus::message::AuvId;

/// What starts [`an_auv`] in a child.
const AS_AUV: &[&str] = &["--exact", "an_auv", "--quiet"];

/// Not a test: what the processes of the other tests run.
#[test]
fn an_auv() {
    crew::be_an_auv_if_asked();
}

fn equals_local(count: u32, windows: u64, each: u32) {
    let expected = digest(&mut Local::new(Echo::new), count, windows);
    let mut crew = Crew::new();
    crew.each = each;
    let mut fleet = crew.zenoh(count, AS_AUV, &[]);
    assert_eq!(digest(&mut fleet, count, windows), expected);
    fleet.end();
    for auv in (0..count).step_by(each as usize) {
        assert!(crew.await_end(auv).success());
    }
    drop(fleet);
    crew.disband();
}

#[test]
fn three_answer_as_in_one_program() {
    equals_local(3, 60, 1);
}

#[test]
fn forty_answer_as_in_one_program() {
    equals_local(40, 20, 1);
}

#[test]
fn several_of_one_process_answer_as_in_one_program() {
    for (count, each) in [(40, 7), (64, 32), (80, 80)] {
        equals_local(count, 20, each);
    }
}

#[test]
fn a_killed_process_is_the_loss_of_all_its_auvs() {
    let mut crew = Crew::new();
    crew.each = 3;
    let mut fleet = crew.zenoh(11, AS_AUV, &[(6, "silent")]);
    fleet.born(&crew::born(11)).unwrap();
    let pid = crew.pid(6);
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(100));
        crew::kill_pid(pid);
    });
    let ended = |auvs: [u32; 3]| auvs.map(|auv| loss(auv, "its process ended"));
    assert_eq!(exchange(&mut fleet, 11, 1).unwrap().losses, ended([6, 7, 8]));
    crew.kill(1);
    crew.await_end(0);
    std::thread::sleep(Duration::from_millis(50));
    let answers = exchange(&mut fleet, 11, 2).unwrap();
    assert_eq!(answers.losses, ended([0, 1, 2]));
    assert!(answers.acted.iter().all(|batch| [3, 4, 5, 9, 10].contains(&batch.auv.0)));
    assert!(answers.acted.len() >= 4);
    drop(fleet);
    crew.disband();
}

#[test]
fn three_hundred_answer_as_in_one_program() {
    equals_local(300, 5, 1);
}

#[test]
fn a_killed_auv_is_reported_once_and_the_run_goes_on() {
    let mut crew = Crew::new();
    let mut fleet = crew.zenoh(12, AS_AUV, &[(7, "silent"), (10, "mortal")]);
    assert_eq!(fleet.born(&crew::born(12)).unwrap(), [loss(10, "its process ended")]);
    let (mut losses, mut dead) = (Vec::new(), vec![AuvId(10)]);
    let silent = crew.pid(7);
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(300));
        crew::kill_pid(silent);
    });
    for window in 0..30 {
        if window == 10 {
            crew.kill(5);
        }
        let answers = exchange(&mut fleet, 12, window).unwrap();
        dead.extend(answers.losses.iter().map(|loss| loss.auv));
        let expected =
            (0..12).map(AuvId).filter(|auv| crew::batch(*auv, window).is_some() && !dead.contains(auv));
        assert!(expected.eq(answers.acted.iter().map(|batch| batch.auv)), "window {window}");
        losses.extend(answers.losses);
    }
    losses.sort_by_key(|loss| loss.auv);
    assert_eq!(losses, [5, 7].map(|auv| loss(auv, "its process ended")));
    drop(fleet);
    crew.disband();
}

#[test]
fn what_goes_wrong_is_told() {
    let mut crew = Crew::new();
    let mut fleet = crew.zenoh(3, AS_AUV, &[(1, "terse"), (2, "silent")]);
    fleet.set_stall_limit(Duration::from_secs(60));
    fleet.born(&crew::born(3)).unwrap();
    fleet.set_stall_limit(Duration::from_secs(1));
    let stalled = exchange(&mut fleet, 3, 1).unwrap_err();
    assert!(matches!(&stalled, FleetError::Stalled { waiting, .. } if *waiting == [AuvId(2)]), "{stalled}");
    fleet.interrupt_handle().interrupt();
    assert!(matches!(exchange(&mut fleet, 3, 2), Err(FleetError::Interrupted)));
    drop(fleet);
    crew.kill(2);
    crew.disband();
}

#[test]
fn one_that_answers_wrongly_is_lost() {
    let mut crew = Crew::new();
    let mut fleet = crew.zenoh(3, AS_AUV, &[(1, "terse")]);
    fleet.born(&crew::born(3)).unwrap();
    let answers = exchange(&mut fleet, 3, 1).unwrap();
    assert_eq!(answers.losses, [loss(1, "answered 0 of 1 ticks")]);
    assert_eq!(exchange(&mut fleet, 3, 2).unwrap().acted.len(), 2);
    drop(fleet);
    crew.disband();
}

#[test]
fn auvs_end_soon_after_their_channel() {
    let mut crew = Crew::new();
    crew.outlive_channel("zenoh", AS_AUV);
    crew.disband();
}
