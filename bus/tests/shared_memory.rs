//! The `iceoryx2` transport with real processes.
#![cfg(all(feature = "iceoryx2", feature = "zenoh"))]

mod crew;

use std::time::Duration;

use crew::{Crew, Echo, digest, exchange, loss};
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Batch, Fleet, FleetError};
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
    let mut fleet = crew.shared_memory(count, AS_AUV, &[]);
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
    equals_local(3, 200, 1);
}

#[test]
fn forty_answer_as_in_one_program() {
    equals_local(40, 60, 1);
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
    let mut fleet = crew.shared_memory(11, AS_AUV, &[(6, "silent")]);
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
    equals_local(300, 12, 1);
}

#[test]
fn an_idle_group_sleeps_and_is_still_in_step() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(40, AS_AUV, &[]);
    fleet.born(&crew::born(40)).unwrap();
    for window in 0..50 {
        let due = if window % 10 == 9 { 39 } else { 1 };
        let batch = Batch { auv: AuvId(due), items: vec![crew::sensed(AuvId(due), window)] };
        let answers = fleet.exchange(&[batch], &mut || {}).unwrap();
        assert_eq!((answers.acted.len(), answers.acted[0].auv), (1, AuvId(due)));
    }
    assert_eq!(fleet.exchange(&[], &mut || {}).unwrap(), shoal_bus::lockstep::Answers::default());
    drop(fleet);
    crew.disband();
}

#[test]
fn messages_of_any_length_cross() {
    let mut local = Local::new(Echo::new);
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(3, AS_AUV, &[]);
    for born in [local.born(&crew::born(3)), fleet.born(&crew::born(3))] {
        assert_eq!(born.unwrap(), []);
    }
    // Around what the near part of a slot holds, what all of it holds, and far beyond.
    for (tick, pings) in
        [0, 7, 8, 15, 16, 17, 18, 100, 180, 190, 350, 370, 400, 20_000, 3].into_iter().enumerate()
    {
        let batch = |auv, pings| Batch { auv, items: vec![crew::sensed_with(auv, tick as u64, pings)] };
        let batches = [batch(AuvId(0), pings), batch(AuvId(1), 1), batch(AuvId(2), pings / 2)];
        let answers = fleet.exchange(&batches, &mut || {}).unwrap();
        assert_eq!(answers.acted[0].items[0].pings.len() as u64, pings);
        assert_eq!(answers, local.exchange(&batches, &mut || {}).unwrap());
    }
    drop(fleet);
    crew.disband();
}

#[test]
fn a_killed_auv_is_reported_once_and_the_run_goes_on() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(40, AS_AUV, &[(11, "silent"), (30, "mortal")]);
    assert_eq!(fleet.born(&crew::born(40)).unwrap(), [loss(30, "its process ended")]);
    let (mut losses, mut dead) = (Vec::new(), vec![AuvId(30)]);
    for window in 0..60 {
        match window {
            // One that is in the middle of a batch, one between two, and one without the channel's knowing when.
            1 => {
                let pid = crew.pid(11);
                std::thread::spawn(move || {
                    std::thread::sleep(Duration::from_millis(100));
                    crew::kill_pid(pid);
                });
            }
            10 => {
                crew.kill(5);
                crew.await_end(5);
            }
            20 => crew.kill(36),
            _ => {}
        }
        let answers = exchange(&mut fleet, 40, window).unwrap();
        dead.extend(answers.losses.iter().map(|loss| loss.auv));
        let expected =
            (0..40).map(AuvId).filter(|auv| crew::batch(*auv, window).is_some() && !dead.contains(auv));
        assert!(expected.eq(answers.acted.iter().map(|batch| batch.auv)), "window {window}");
        losses.extend(answers.losses);
    }
    losses.sort_by_key(|loss| loss.auv);
    assert_eq!(losses, [5, 11, 36].map(|auv| loss(auv, "its process ended")));
    drop(fleet);
    crew.disband();
}

#[test]
fn many_die_at_any_moment_and_each_is_reported_once() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(40, AS_AUV, &[]);
    fleet.born(&crew::born(40)).unwrap();
    let doomed: Vec<u32> = (0..35).map(|step| step * 17 % 40).collect();
    let pids: Vec<u32> = doomed.iter().map(|auv| crew.pid(*auv)).collect();
    let killer = std::thread::spawn(move || {
        for (step, pid) in pids.into_iter().enumerate() {
            std::thread::sleep(Duration::from_micros(500 + 377 * (step as u64 % 7)));
            crew::kill_pid(pid);
        }
    });
    let mut lost = Vec::new();
    for window in 0.. {
        lost.extend(exchange(&mut fleet, 40, window).unwrap().losses.into_iter().map(|loss| loss.auv.0));
        if lost.len() >= doomed.len() {
            break;
        }
    }
    killer.join().unwrap();
    assert_eq!(
        exchange(&mut fleet, 40, 1).unwrap().acted.len(),
        (0..40).filter(|auv| { !doomed.contains(auv) && crew::batch(AuvId(*auv), 1).is_some() }).count()
    );
    lost.sort_unstable();
    let mut doomed = doomed;
    doomed.sort_unstable();
    assert_eq!(lost, doomed);
    drop(fleet);
    crew.disband();
}

#[test]
fn those_that_die_while_they_join_are_losses_and_the_others_are_born() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(40, AS_AUV, &[]);
    for auv in (0..40).step_by(4) {
        // The last have just been started, the first are somewhere on their way.
        crew.kill(39 - auv);
    }
    let doomed = |auv: &AuvId| (39 - auv.0).is_multiple_of(4);
    let born_dead = fleet.born(&crew::born(40)).unwrap();
    assert!(born_dead.iter().map(|loss| loss.auv).eq((0..40).map(AuvId).filter(doomed)), "{born_dead:?}");
    for window in 0..20 {
        assert_eq!(exchange(&mut fleet, 40, window).unwrap().losses, []);
    }
    drop(fleet);
    crew.disband();
}

#[test]
fn one_that_answers_wrongly_is_lost_and_ends() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(3, AS_AUV, &[(1, "terse")]);
    fleet.born(&crew::born(3)).unwrap();
    let answers = exchange(&mut fleet, 3, 1).unwrap();
    assert_eq!(answers.losses, [loss(1, "answered 0 of 1 ticks")]);
    assert_eq!(answers.acted.len(), 2);
    assert_eq!(exchange(&mut fleet, 3, 2).unwrap().losses, []);
    assert_eq!(crew.await_end(1).code(), Some(3));
    drop(fleet);
    crew.disband();
}

#[test]
fn silence_ends_in_a_stall_that_names_the_silent() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(3, AS_AUV, &[(2, "silent")]);
    fleet.set_stall_limit(Duration::from_secs(1));
    fleet.born(&crew::born(3)).unwrap();
    let stalled = exchange(&mut fleet, 3, 1).unwrap_err();
    assert!(matches!(&stalled, FleetError::Stalled { waiting, .. } if *waiting == [AuvId(2)]), "{stalled}");
    let handle = fleet.interrupt_handle();
    handle.interrupt();
    assert!(matches!(exchange(&mut fleet, 3, 2), Err(FleetError::Interrupted)));
    drop(fleet);
    crew.kill(2);
    crew.disband();
}

#[test]
fn one_that_starts_again_is_born_again() {
    let mut crew = Crew::new();
    let mut fleet = crew.shared_memory(3, AS_AUV, &[]);
    fleet.born(&crew::born(3)).unwrap();
    exchange(&mut fleet, 3, 1).unwrap();
    crew.kill(1);
    crew.await_end(1);
    std::thread::sleep(Duration::from_millis(50));
    assert_eq!(exchange(&mut fleet, 3, 2).unwrap().losses, [loss(1, "its process ended")]);
    let again = crew.start_again("iceoryx2", 1, AS_AUV);
    fleet.attach_processes(&[again]).unwrap();
    assert_eq!(fleet.born(&crew::born(3)[1..2]).unwrap(), []);
    for window in 3..20 {
        let answers = exchange(&mut fleet, 3, window).unwrap();
        assert_eq!(answers.losses, []);
        assert_eq!(
            answers.acted.len(),
            (0..3).filter(|auv| crew::batch(AuvId(*auv), window).is_some()).count()
        );
    }
    drop(fleet);
    crew.disband();
}

#[test]
fn auvs_end_soon_after_their_channel() {
    let mut crew = Crew::new();
    crew.outlive_channel("iceoryx2", AS_AUV);
    crew.disband();
}
