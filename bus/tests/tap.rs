//! The tap, across processes' boundaries or not: the same shared memory.
#![cfg(all(feature = "iceoryx2", feature = "zenoh"))]

use std::time::Duration;

use shoal_bus::message::AuvId;
use shoal_bus::run_dir::RunDir;
use shoal_bus::tap::{LAG_MAX, TAPS_MAX, TapItem, TapPublisher, TapSubscriber};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

struct Run(RunDir);

impl Run {
    fn new() -> Self {
        Self(RunDir::create(&serde_json::Value::Null).unwrap())
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.0.remove().unwrap();
    }
}

fn traffic(window: u64, events: u32) -> Vec<Traffic> {
    let fate = Fate::lost(None, LossReason::Late, 0.0);
    let event = |from| Traffic {
        at: SimTime::from_ns(window as i64),
        from: AuvId(from),
        sequence: 0,
        fate: fate.clone(),
    };
    (0..events).map(event).collect()
}

#[test]
fn a_tap_sees_everything_from_when_it_attached() {
    let run = Run::new();
    let mut publisher = TapPublisher::create(&run.0).unwrap();
    publisher.publish(&traffic(0, 5)).unwrap();
    let mut tap = TapSubscriber::attach(&run.0).unwrap();
    let mut other = TapSubscriber::attach(&run.0).unwrap();
    assert_eq!(tap.next(Duration::ZERO).unwrap(), None);
    for window in 1..2000 {
        // Batches that outgrow the first memory.
        let sent = traffic(window, window as u32);
        publisher.publish(&sent).unwrap();
        for tap in [&mut tap, &mut other] {
            let Some(TapItem::Batch(batch)) = tap.next(Duration::from_secs(10)).unwrap() else { panic!() };
            assert_eq!((batch.sequence, batch.traffic), (window, sent.clone()));
        }
    }
    drop(other);
    assert_eq!(publisher.listeners(), 1);
    assert_eq!(tap.missed(), 0);
}

#[test]
fn a_slow_tap_counts_what_it_missed_and_sees_the_end() {
    let run = Run::new();
    let mut publisher = TapPublisher::create(&run.0).unwrap();
    let mut tap = TapSubscriber::attach(&run.0).unwrap();
    let windows = 3 * LAG_MAX as u64;
    publisher.publish(&traffic(0, 1)).unwrap();
    assert!(tap.next(Duration::from_secs(10)).unwrap().is_some());
    for window in 1..windows {
        publisher.publish(&traffic(window, 3)).unwrap();
    }
    publisher.end().unwrap();
    let (mut seen, mut last) = (1, None);
    while let Some(item) = tap.next(Duration::ZERO).unwrap() {
        if let TapItem::Batch(batch) = &item {
            seen += batch.traffic.len() as u64;
        }
        last = Some(item);
    }
    let events = 1 + 3 * (windows - 1);
    assert_eq!(last, Some(TapItem::End { events }));
    assert_eq!(seen + tap.missed(), events);
    assert!(tap.missed() > 0);
}

const RUN: &str = "SHOAL_TEST_TAPPED_RUN";

/// Not a test: an observer that is killed.
#[test]
fn an_observer() {
    if let Ok(run) = std::env::var(RUN) {
        let _tap = TapSubscriber::attach(&RunDir::open(run.as_ref()).unwrap()).unwrap();
        let this = rustix::process::getpid();
        rustix::process::kill_process(this, rustix::process::Signal::KILL).unwrap();
    }
}

#[test]
fn killed_taps_make_room_for_others() {
    let run = Run::new();
    let mut publisher = TapPublisher::create(&run.0).unwrap();
    for window in 0..=TAPS_MAX as u64 {
        let mut observer = std::process::Command::new(std::env::current_exe().unwrap());
        observer.args(["--exact", "an_observer", "--quiet"]).env(RUN, run.0.path());
        assert_eq!(observer.output().unwrap().status.code(), None);
        publisher.publish(&traffic(window, 1)).unwrap();
    }
    let _tap = TapSubscriber::attach(&run.0).unwrap();
    assert_eq!(publisher.listeners(), 1);
}
