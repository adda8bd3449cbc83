//! Tests of records with trajectories.

use std::io::Cursor;

use super::synthetic::{run, summary, write};
use crate::message::AuvId;
use crate::record::rows::{OfflineRow, Real};
use crate::record::{AppendError, Ending, RecordInfo, Row, Topic, append_offline, read_rows};
use crate::time::{LocalTime, SimTime};

const TOPICS: [Topic; 5] = [Topic::Ticks, Topic::Reports, Topic::Pings, Topic::Sensed, Topic::Offline];

fn rows(file: &[u8]) -> Vec<Row> {
    let mut rows = Vec::new();
    let ending = read_rows(Cursor::new(file), &TOPICS, &mut |row| rows.push(row)).unwrap();
    assert_eq!(ending, Ending::Complete);
    rows
}

fn offline(count: i64) -> Vec<OfflineRow> {
    let row = |index: i64| {
        let width = index as f64 / 3.0;
        OfflineRow {
            auv: AuvId(index as u32 % 5),
            tick: index as u64,
            t_ns: SimTime::from_ns(index * 37_000_000),
            local_ns: LocalTime::from_ns(index * 37_000_001),
            alone_position_m: [[Real(-width), Real(width)]; 3],
            alone_clock_offset_s: [Real(-1e-3), Real(1e-3)],
            position_m: [[Real(-0.5 * width), Real(0.1)]; 3],
            clock_offset_s: [Real(0.0), Real(1e-4)],
        }
    };
    (0..count).map(row).collect()
}

fn appended(file: &[u8], rows: &[OfflineRow]) -> (Vec<u8>, Ending) {
    let mut copy = Vec::new();
    let ending = append_offline(Cursor::new(file), &mut copy, rows).unwrap();
    (copy, ending)
}

#[test]
fn a_copy_holds_everything_and_the_trajectories() {
    let file = write(5, &run(5, 3), 130_000_000);
    let told = offline(70);
    let (copy, ending) = appended(&file, &told);
    assert_eq!(ending, Ending::Complete);
    let expected = rows(&file).into_iter().chain(told.iter().cloned().map(Row::Offline));
    assert!(rows(&copy).into_iter().eq(expected));
    let info = RecordInfo::read(Cursor::new(&copy)).unwrap();
    assert_eq!(info.digest, Some(summary(5).digest));
    assert_eq!(info.attachments, RecordInfo::read(Cursor::new(&file)).unwrap().attachments);
    // Another reconstruction takes the place of the first.
    assert!(appended(&copy, &told).0 == copy);
    let (other, _) = appended(&copy, &told[..7]);
    assert!(other == appended(&file, &told[..7]).0);
}

#[test]
fn a_record_that_was_cut_is_copied_as_far_as_it_goes() {
    let file = write(5, &run(5, 3), 130_000_000);
    let (copy, ending) = appended(&file[..file.len() / 2], &offline(3));
    assert!(matches!(ending, Ending::Truncated { .. }));
    let kept = rows(&copy);
    assert!(kept.len() > 100 && kept.len() < rows(&file).len());
    assert_eq!(RecordInfo::read(Cursor::new(&copy)).unwrap().digest, None);
    let headless = append_offline(Cursor::new(&file[..60]), Vec::new(), &[]);
    assert!(matches!(headless, Err(AppendError::Read(_) | AppendError::Headless)), "{headless:?}");
}
