//! Tests of the record as a whole.

mod append;
mod bytes;
mod damage;
mod outside;
mod read;
mod recover;
pub(crate) mod synthetic;
mod verify;

use super::rows::{PingRow, ReportRow, TruthRow};
use super::*;
use crate::chronicle::What;
use crate::codec;
use crate::message::{AuvId, Sensed};
use crate::summary::Summary;
use crate::time::SimTime;
use serde::de::DeserializeOwned;
use std::io::Cursor;
use synthetic::{header, run, summary, summary_with, write};

/// The elements of `key` in all messages of `topic`.
fn rows<T: DeserializeOwned>(file: &[u8], topic: Topic, key: &str) -> Vec<T> {
    let mut rows = Vec::new();
    let mut take = |data: &[u8]| {
        let mut message: serde_json::Value = serde_json::from_slice(data).unwrap();
        let serde_json::Value::Array(found) = message[key].take() else { panic!("no {key} in {topic:?}") };
        rows.extend(found.into_iter().map(|row| serde_json::from_value::<T>(row).unwrap()));
    };
    messages(file, topic, &mut |_, data| take(data));
    rows
}

/// Hands over time and bytes of all messages of `topic`.
fn messages(file: &[u8], topic: Topic, each: &mut dyn FnMut(SimTime, &[u8])) {
    let ending = scan(Cursor::new(file), &mut |item| {
        if let Item::Message { source, at, data } = item
            && source.topic == topic.name()
        {
            assert_eq!((&*source.schema, &*source.encoding), (topic.schema_name(), topic.message_encoding()));
            each(at, data);
        }
        Ok(())
    });
    assert_eq!(ending.unwrap(), Ending::Complete);
}

#[test]
fn what_happened_comes_back_with_the_same_bits() {
    let entries = run(7, 3);
    let file = write(7, &entries, 130_000_000);

    let truth = entries.iter().filter_map(|entry| match &entry.what {
        What::Truth(truth) => Some(TruthRow::new(entry.at, entry.auv, truth)),
        _ => None,
    });
    assert!(rows::<TruthRow>(&file, Topic::Ticks, "ticks").into_iter().eq(truth));

    let pings = entries.iter().filter_map(|entry| match &entry.what {
        What::Traffic(traffic) => Some(PingRow::new(traffic)),
        _ => None,
    });
    assert!(rows::<PingRow>(&file, Topic::Pings, "pings").into_iter().eq(pings));

    let reports: Vec<ReportRow> = rows(&file, Topic::Reports, "reports");
    let acted = entries.iter().filter_map(|entry| match &entry.what {
        What::Acted(acted) => Some((entry.at, entry.auv, acted)),
        _ => None,
    });
    for (row, (at, auv, acted)) in reports.iter().zip(acted.clone()) {
        assert!(row.local_ns.is_some());
        assert_eq!(*row, ReportRow::new(at, auv, row.local_ns, acted));
    }
    assert_eq!(reports.len(), acted.count());
    assert!(
        reports.iter().any(|row| row.emptied.is_some()) && reports.iter().any(|row| !row.booked.is_empty())
    );

    let mut told: Vec<(SimTime, AuvId, Sensed)> = Vec::new();
    messages(&file, Topic::Sensed, &mut |end, data| {
        let batch: Vec<(SimTime, AuvId, Sensed)> = codec::decode(data).unwrap();
        assert!(batch.iter().all(|row| end - row.0 >= 0 && end - row.0 < BATCH_NS));
        told.extend(batch);
    });
    let sensed = entries.iter().filter_map(|entry| match &entry.what {
        What::Sensed(sensed) => Some((entry.at, entry.auv, sensed.clone())),
        _ => None,
    });
    assert!(told.into_iter().eq(sensed));
}

#[test]
fn viewers_get_poses_and_people_get_a_log() {
    let file = write(7, &run(7, 3), 130_000_000);
    let mut poses = 0;
    messages(&file, Topic::Poses, &mut |at, data| {
        let message: serde_json::Value = serde_json::from_slice(data).unwrap();
        assert_eq!(message["timestamp"]["nsec"], at.ns() % 1_000_000_000);
        poses = message["poses"].as_array().unwrap().len();
    });
    assert_eq!(poses, 7);
    let mut log = Vec::new();
    messages(&file, Topic::Log, &mut |_, data| {
        let message: serde_json::Value = serde_json::from_slice(data).unwrap();
        let (level, name, text) = (&message["level"], &message["name"], &message["message"]);
        log.push(format!("{level} {} {}", name.as_str().unwrap(), text.as_str().unwrap()));
    });
    assert_eq!(
        log,
        [
            "4 a-2 containment violated: the report misses the truth in x by 0.25 m",
            "4 a-3 containment violated: the slice is empty or invalid",
            "3 a-4 the AUV is lost: its process was killed by signal 9",
        ]
    );
}

#[test]
fn a_number_that_is_not_finite_is_null_and_reads_as_nan() {
    let row: rows::Real =
        serde_json::from_str(&serde_json::to_string(&rows::Real(f64::INFINITY)).unwrap()).unwrap();
    assert!(row.0.is_nan());
}

#[test]
fn the_stored_summary_has_no_facts_of_the_machine() {
    let file = write(2, &run(2, 1), 100_000_000);
    let mut stored = Vec::new();
    messages(&file, Topic::Summary, &mut |_, data| stored = data.to_vec());
    let stored: Summary = serde_json::from_slice(&stored).unwrap();
    let expected = summary(2);
    assert!(expected.bus.is_some() && expected.memory.is_some());
    let bare = Summary {
        bus: None,
        processes: None,
        wall_s: None,
        startup_s: None,
        real_time_factor: None,
        memory: None,
        ..expected
    };
    assert_eq!(stored, bare);
}

#[test]
fn info_tells_what_a_record_holds() {
    let file = write(7, &run(7, 3), 130_000_000);
    let info = RecordInfo::read(Cursor::new(&file)).unwrap();
    let head = header(7);
    assert_eq!(info.scenario.as_deref(), Some(&*head.scenario_name));
    assert_eq!((info.seed, info.auvs, info.record_format), (Some(head.seed), Some(7), Some(RECORD_FORMAT)));
    assert_eq!((info.first_s, info.last_s), (Some(0.0), Some(3.0)));
    assert_eq!(info.attachments[0].bytes, head.scenario_text.len() as u64);
    assert_eq!(info.topics.len(), Topic::ALL.len());
    assert_eq!(info.containment, Some(Containment { checks: 42, violations: 2 }));
    assert_eq!(info.digest, Some(summary(7).digest));
    assert_eq!(info.truncated, None);
    assert!(info.chunks.compression_ratio.unwrap() > 1.5);
    let again: RecordInfo = serde_json::from_str(&serde_json::to_string(&info).unwrap()).unwrap();
    assert_eq!(again, info);
    let text = info.to_string();
    assert!(text.contains("seed         11\n") && text.contains("2 violations in 42 checks"), "{text}");
}

#[test]
fn a_summary_with_an_unbounded_width_is_no_damage() {
    let writer = RecordWriter::create(Vec::new(), &header(2)).unwrap();
    let file = writer.finish(&summary_with(2, f64::INFINITY)).unwrap();
    assert!(RecordInfo::read(Cursor::new(&file)).unwrap().digest.is_some());
}

#[test]
fn other_mcap_files_are_told_apart() {
    let mut file = Vec::new();
    mcap::Writer::new(Cursor::new(&mut file)).unwrap().finish().unwrap();
    let info = RecordInfo::read(Cursor::new(&file)).unwrap();
    assert_eq!((info.record_format, info.last_s), (None, None));
    assert!(info.to_string().starts_with("an MCAP file, but not a record"));
}

#[test]
fn faults_of_the_caller_are_errors() {
    let entries = run(3, 1);
    let mut writer = RecordWriter::create(Vec::new(), &header(3)).unwrap();
    writer.append(&entries).unwrap();
    assert!(matches!(writer.append(&entries[..1]), Err(RecordWriteError::OutOfOrder { .. })));
    let mut writer = RecordWriter::create(Vec::new(), &header(1)).unwrap();
    assert!(matches!(writer.append(&entries), Err(RecordWriteError::UnknownAuv { auvs: 1, .. })));
}
