//! Tests of the reader of rows.

use std::collections::BTreeMap;
use std::io::Cursor;

use super::synthetic::{header, run, write};
use crate::chronicle::What;
use crate::record::rows::{FlockRow, PingRow, TruthRow};
use crate::record::{Damage, Ending, RecordReadError, Row, Topic, read_rows};

fn read(file: &[u8], topics: &[Topic]) -> Result<(Vec<Row>, Ending), RecordReadError> {
    let mut rows = Vec::new();
    read_rows(Cursor::new(file), topics, &mut |row| rows.push(row)).map(|ending| (rows, ending))
}

#[test]
fn rows_are_those_that_were_written() {
    let entries = run(5, 2);
    let file = write(5, &entries, 130_000_000);
    let (rows, ending) = read(&file, &[Topic::Ticks, Topic::Pings]).unwrap();
    assert_eq!(ending, Ending::Complete);
    assert_eq!(rows[0], Row::Header(header(5)));
    let (mut truth, mut pings) = (Vec::new(), Vec::new());
    for row in &rows[1..] {
        match row {
            Row::Truth(row) => truth.push(row.clone()),
            Row::Ping(row) => pings.push(row.clone()),
            other => panic!("not asked for: {other:?}"),
        }
    }
    let told = entries.iter().filter_map(|entry| match &entry.what {
        What::Truth(truth) => Some(TruthRow::new(entry.at, entry.auv, truth)),
        _ => None,
    });
    assert!(truth.into_iter().eq(told));
    let crossed = entries.iter().filter_map(|entry| match &entry.what {
        What::Traffic(traffic) => Some(PingRow::new(traffic)),
        _ => None,
    });
    assert!(pings.into_iter().eq(crossed));
    let (flock, _) = read(&file, &[Topic::Flock]).unwrap();
    let watched = entries.iter().filter_map(|entry| match entry.what {
        What::Flock(flock) => Some(Row::Flock(FlockRow { t_ns: entry.at, flock })),
        _ => None,
    });
    assert!(flock[1..].iter().cloned().eq(watched) && flock.len() == 3);
    let (reports, _) = read(&file, &[Topic::Reports]).unwrap();
    assert!(reports[1..].iter().all(|row| matches!(row, Row::Report(_))));
    assert_eq!(
        reports.len() - 1,
        entries.iter().filter(|entry| matches!(entry.what, What::Acted(_))).count()
    );
}

#[test]
fn a_record_that_was_cut_gives_the_rows_before_the_cut() {
    let file = write(3, &run(3, 3), 130_000_000);
    let (all, _) = read(&file, &[Topic::Ticks]).unwrap();
    let (some, ending) = read(&file[..file.len() / 2], &[Topic::Ticks]).unwrap();
    assert!(matches!(ending, Ending::Truncated { .. }));
    assert!(some.len() > 1 && some.len() < all.len());
    assert_eq!(some, all[..some.len()]);
}

/// An MCAP file with the metadata record of a run and one message.
fn foreign(format: &str, topic: Topic, message: &str) -> Vec<u8> {
    let mut file = Vec::new();
    let mut writer = mcap::Writer::new(Cursor::new(&mut file)).unwrap();
    let metadata = [("format".to_owned(), format.to_owned())].into();
    writer.write_metadata(&mcap::records::Metadata { name: "shoal".into(), metadata }).unwrap();
    let schema = writer.add_schema(topic.schema_name(), "jsonschema", b"{}").unwrap();
    let channel_id = writer.add_channel(schema, topic.name(), "json", &BTreeMap::new()).unwrap();
    let head = mcap::records::MessageHeader { channel_id, sequence: 0, log_time: 0, publish_time: 0 };
    writer.write_to_known_channel(&head, message.as_bytes()).unwrap();
    writer.finish().unwrap();
    drop(writer);
    file
}

#[test]
fn other_files_are_refused() {
    let mut bare = Vec::new();
    mcap::Writer::new(Cursor::new(&mut bare)).unwrap().finish().unwrap();
    assert!(matches!(read(&bare, &[]), Err(RecordReadError::NotARecord)));
    let later = foreign("77", Topic::Ticks, "later versions know what this is");
    assert!(matches!(read(&later, &[Topic::Ticks]), Err(RecordReadError::UnknownFormat { found: 77 })));
    let malformed = foreign("1", Topic::Ticks, r#"{"ticks":[{"auv":"one"}]}"#);
    let error = read(&malformed, &[Topic::Ticks]).unwrap_err();
    let RecordReadError::Damaged { damage: Damage::Rows { topic: "/ticks", .. }, .. } = error else {
        panic!("{error}");
    };
    assert!(read(&malformed, &[Topic::Pings]).is_ok());
}
