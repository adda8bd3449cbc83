//! The tap, across processes' boundaries or not: the same shared memory.
#![cfg(all(feature = "iceoryx2", feature = "record", feature = "zenoh"))]

use std::time::Duration;

use shoal_bus::chronicle::{Entry, What};
use shoal_bus::message::AuvId;
use shoal_bus::record::{RecordHeader, RecordedAuv, Row, Topic};
use shoal_bus::run_dir::RunDir;
use shoal_bus::tap::{
    Cast, LAG_MAX, LiveTopic, SAMPLE_BYTES, TAPS_MAX, TapError, TapItem, TapPublisher, TapSubscriber,
    TapWindow,
};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

const SOON: Duration = Duration::from_secs(10);

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

fn cast() -> Cast {
    let auv = RecordedAuv { name: "green-0".into(), group: 0, group_name: "green".into(), length_m: 1.6 };
    let (scenario_name, scenario_text) = ("three".to_owned(), "name = \"three\"\n".to_owned());
    Cast { header: RecordHeader { scenario_name, seed: 7, scenario_text, auvs: vec![auv] }, born: vec![] }
}

fn publisher(run: &Run) -> TapPublisher {
    TapPublisher::create(&run.0, cast()).unwrap()
}

fn pings(run: &Run) -> TapSubscriber {
    TapSubscriber::attach(&run.0, &[Topic::Pings]).unwrap()
}

fn window(at: u64) -> SimTime {
    SimTime::from_ns(at as i64 * 90_000_000)
}

/// What happens in window `at`: so many pings that never left, and an AUV that ends.
fn entries(at: u64, pings: u32) -> Vec<Entry> {
    let at = window(at);
    let event = |from| {
        let fate = Fate::lost(None, LossReason::Late, 0.0);
        let traffic = Traffic { at, from: AuvId(from), sequence: 0, fate };
        Entry { at, auv: AuvId(from), what: What::Traffic(traffic) }
    };
    let ended = Entry { at, auv: AuvId(0), what: What::Ended("it sank".into()) };
    std::iter::once(ended).chain((0..pings).map(event)).collect()
}

fn next_window(tap: &mut TapSubscriber) -> TapWindow {
    match tap.next(SOON).unwrap() {
        Some(TapItem::Window(window)) => window,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_tap_sees_everything_from_when_it_attached() {
    let run = Run::new();
    let mut publisher = publisher(&run);
    publisher.publish(window(0), &entries(0, 5)).unwrap();
    let (mut tap, mut other) = (pings(&run), pings(&run));
    assert_eq!(tap.next(Duration::ZERO).unwrap(), None);
    let mut counted = 5;
    for at in 1..2000 {
        // Windows that outgrow one sample.
        publisher.publish(window(at), &entries(at, at as u32)).unwrap();
        counted += at;
        for tap in [&mut tap, &mut other] {
            let TapWindow { to, counts, rows, .. } = next_window(tap);
            assert_eq!((to, rows.len() as u64), (window(at), at));
            assert!(rows.iter().all(|row| row.topic() == Topic::Pings && row.at() == to));
            assert_eq!((counts.of(LiveTopic::Pings), counts.of(LiveTopic::Log)), (counted, at + 1));
        }
    }
    assert!(size_of::<Entry>() * 2000 > SAMPLE_BYTES);
    assert_eq!(tap.cast(), Some(&cast()));
    drop(other);
    assert_eq!(publisher.listeners(), 1);
    assert_eq!(tap.missed(), 0);
}

#[test]
fn only_what_is_asked_for_is_told_and_names_are_known() {
    let run = Run::new();
    let mut publisher = publisher(&run);
    let mut tap = TapSubscriber::attach(&run.0, &[Topic::Log, Topic::Flock]).unwrap();
    assert_eq!(
        LiveTopic::ALL.map(|topic| publisher.is_heard(topic)),
        [false, false, false, false, true, true]
    );
    publisher.publish(window(1), &entries(1, 3)).unwrap();
    let rows = next_window(&mut tap).rows;
    let [Row::Log(log)] = rows.as_slice() else { panic!("{rows:?}") };
    assert_eq!((log.name.as_str(), log.message.as_str()), ("green-0", "the AUV is lost: it sank"));
    // Nothing at all will do: time and counts.
    let mut clock = TapSubscriber::attach(&run.0, &[Topic::Auvs]).unwrap();
    publisher.publish(window(2), &entries(2, 3)).unwrap();
    let TapWindow { counts, rows, .. } = next_window(&mut clock);
    assert_eq!((rows, counts.of(LiveTopic::Pings)), (vec![], 6));
    let offline = TapSubscriber::attach(&run.0, &[Topic::Offline]).err();
    assert!(matches!(offline, Some(TapError::NotLive(Topic::Offline))), "{offline:?}");
}

#[test]
fn a_slow_tap_counts_what_it_missed_and_sees_the_end() {
    let run = Run::new();
    let mut publisher = publisher(&run);
    let mut tap = pings(&run);
    let windows = 3 * LAG_MAX as u64;
    publisher.publish(window(0), &entries(0, 1)).unwrap();
    let mut seen = next_window(&mut tap).rows.len() as u64;
    for at in 1..windows {
        publisher.publish(window(at), &entries(at, 3)).unwrap();
    }
    publisher.end(None).unwrap();
    let mut last = None;
    while let Some(item) = tap.next(Duration::ZERO).unwrap() {
        if let TapItem::Window(window) = &item {
            seen += window.rows.len() as u64;
        }
        last = Some(item);
    }
    let events = 1 + 3 * (windows - 1);
    let Some(TapItem::End { counts, summary: None }) = last else { panic!("{last:?}") };
    assert_eq!(counts.of(LiveTopic::Pings), events);
    assert_eq!(seen + tap.missed(), events);
    assert!(tap.missed() > 0);
    assert_eq!(tap.missed_of().collect::<Vec<_>>(), [(Topic::Pings, tap.missed())]);
}

const RUN: &str = "SHOAL_TEST_TAPPED_RUN";

/// Not a test: an observer that is killed.
#[test]
fn an_observer() {
    if let Ok(run) = std::env::var(RUN) {
        let run = RunDir::open(run.as_ref()).unwrap();
        let _tap = TapSubscriber::attach(&run, &[Topic::Pings]).unwrap();
        let this = rustix::process::getpid();
        rustix::process::kill_process(this, rustix::process::Signal::KILL).unwrap();
    }
}

#[test]
fn killed_taps_make_room_for_others() {
    let run = Run::new();
    let mut publisher = publisher(&run);
    for at in 0..=TAPS_MAX as u64 {
        let mut observer = std::process::Command::new(std::env::current_exe().unwrap());
        observer.args(["--exact", "an_observer", "--quiet"]).env(RUN, run.0.path());
        assert_eq!(observer.output().unwrap().status.code(), None);
        publisher.publish(window(at), &entries(at, 1)).unwrap();
    }
    let _tap = pings(&run);
    assert_eq!(publisher.listeners(), 1);
}
