//! What a tap sees is what a record holds.

use std::io::Cursor;
use std::time::Duration;

use super::*;
use crate::record::tests::synthetic;
use crate::record::{RecordWriter, read_rows};
use crate::run_dir::RunDir;

const AUVS: u32 = 7;
const ALL: [Topic; 7] =
    [Topic::Ticks, Topic::Reports, Topic::Pings, Topic::Sensed, Topic::Log, Topic::Flock, Topic::Poses];

/// The items that a tap on `topics` sees of a run of three seconds, in windows of `window_ns`.
fn tapped(topics: &[Topic], window_ns: i64) -> (Cast, Vec<TapItem>) {
    let run = RunDir::create(&serde_json::Value::Null).unwrap();
    let cast = Cast { header: synthetic::header(AUVS), born: vec![] };
    let mut publisher = TapPublisher::create(&run, cast.clone()).unwrap();
    let mut tap = TapSubscriber::attach(&run, topics).unwrap();
    let (mut items, mut border) = (Vec::new(), SimTime::ZERO);
    let entries = synthetic::run(AUVS, 3);
    let mut rest = entries.as_slice();
    while !rest.is_empty() {
        border = border + window_ns;
        let (window, later) = rest.split_at(rest.partition_point(|entry| entry.at < border));
        publisher.publish(border, window).unwrap();
        items.extend(tap.next(Duration::from_secs(10)).unwrap());
        rest = later;
    }
    publisher.end(Some(&synthetic::summary(AUVS))).unwrap();
    items.extend(tap.next(Duration::from_secs(10)).unwrap());
    assert_eq!((tap.missed(), tap.cast()), (0, Some(&cast)));
    run.remove().unwrap();
    (cast, items)
}

#[test]
fn a_tap_writes_the_record_byte_for_byte() {
    let expected = synthetic::write(AUVS, &synthetic::run(AUVS, 3), 90_000_000);
    for window_ns in [10_000_000, 90_000_000, 333_333_333] {
        let (cast, items) = tapped(&ALL, window_ns);
        let mut writer = RecordWriter::create(Vec::new(), &cast.header).unwrap();
        let mut written = None;
        for item in items {
            match item {
                TapItem::Window(TapWindow { to, rows, .. }) => {
                    writer.append_rows(&rows).unwrap();
                    writer.advance(to).unwrap();
                }
                TapItem::End { summary, .. } => {
                    let summary = summary.expect("the run has ended well");
                    written = Some(writer.finish(&summary).unwrap());
                    break;
                }
            }
        }
        assert!(written.expect("the run has ended") == expected, "{window_ns}");
    }
}

#[test]
fn every_topic_has_the_rows_of_the_record() {
    let record = synthetic::write(AUVS, &synthetic::run(AUVS, 3), 90_000_000);
    for topic in ALL {
        let mut expected = Vec::new();
        read_rows(Cursor::new(&record), &[topic], &mut |row| expected.push(row)).unwrap();
        let rows = tapped(&[topic], 90_000_000).1.into_iter().flat_map(|item| match item {
            TapItem::Window(window) => window.rows,
            TapItem::End { .. } => Vec::new(),
        });
        // What is not finite is `null` in the file and not equal to itself: the text is.
        let text = |row: &Row| serde_json::to_string(row).unwrap();
        let mut seen: Vec<String> = rows.map(|row| text(&row)).collect();
        let mut expected: Vec<String> = expected.iter().skip(1).map(text).collect();
        if topic == Topic::Poses {
            // The last batch ends with the run, which the tap does not see the end of.
            assert!((expected.len() - 1..=expected.len()).contains(&seen.len()), "{}", seen.len());
            expected.truncate(seen.len());
        }
        // Within a batch the file is in the order of its rows as well.
        seen.sort();
        expected.sort();
        assert!(seen.len() > 2 && seen == expected, "{topic:?}: {} {}", seen.len(), expected.len());
    }
}
