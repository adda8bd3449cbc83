//! Every change of a record is found, and told where it is.

use std::io::Cursor;

use mcap::Attachment;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;

use super::synthetic::{run, summary, write};
use crate::record::write::options;
use crate::record::{Ending, RecordReadError, Topic, Verification, verify};

fn verified(file: &[u8]) -> Result<Verification, RecordReadError> {
    verify(Cursor::new(file), &mut |_| {})
}

fn assert_found(file: &[u8], at: usize) {
    let found = verified(file).unwrap_or_else(|error| panic!("byte {at}: {error}"));
    assert!(!found.faults.is_empty(), "byte {at} unnoticed");
    let at = at as u64;
    assert!(
        found.faults.iter().any(|fault| fault.from <= at && at < fault.to),
        "byte {at} is in none of {:?}",
        found.faults
    );
}

#[test]
fn a_good_record_has_no_faults() {
    for seconds in [1, 3] {
        let file = write(5, &run(5, seconds), 100_000_000);
        let found = verified(&file).unwrap();
        assert!(found.is_whole(), "{:?}", found.faults);
        assert_eq!((found.file_bytes, found.until_s), (file.len() as u64, Some(seconds as f64)));
    }
}

/// A record of two small chunks, with a record of every kind that a record has.
fn tiny() -> Vec<u8> {
    let mut mcap = options(None).create(NoSeek::new(Vec::new())).unwrap();
    let metadata = |name: &str, entries: &[(&str, &str)]| Metadata {
        name: name.into(),
        metadata: entries.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect(),
    };
    let run = [("scenario", "made-up"), ("seed", "11"), ("auvs", "1"), ("format", "1")];
    mcap.write_metadata(&metadata("shoal", &run)).unwrap();
    let (name, media_type) = ("scenario.toml".to_owned(), "application/toml".to_owned());
    mcap.attach(&Attachment { log_time: 0, create_time: 0, name, media_type, data: (&b"x = 1"[..]).into() })
        .unwrap();
    let auvs = br#"{"auvs":[{"name":"a","group":0,"group_name":"a","length_m":1.5}]}"#.to_vec();
    let messages = [(Topic::Auvs, auvs), (Topic::Summary, serde_json::to_vec(&summary(1)).unwrap())];
    for (index, (topic, data)) in messages.iter().enumerate() {
        let schema = mcap.add_schema(topic.schema_name(), "jsonschema", b"{}").unwrap();
        let channel_id = mcap.add_channel(schema, topic.name(), "json", &Default::default()).unwrap();
        let log_time = 3 * index as u64;
        let head = MessageHeader { channel_id, sequence: index as u32, log_time, publish_time: log_time };
        mcap.write_to_known_channel(&head, data).unwrap();
        mcap.flush().unwrap();
    }
    let outcome =
        [("digest", "blake3:00ff"), ("reproducible", "true"), ("checks", "42"), ("violations", "2")];
    mcap.write_metadata(&metadata("shoal.outcome", &outcome)).unwrap();
    mcap.finish().unwrap();
    mcap.into_inner().into_inner()
}

#[test]
fn every_bit_of_a_tiny_record_is_found() {
    let mut file = tiny();
    let found = verified(&file).unwrap();
    assert!(found.is_whole(), "{:?}", found.faults);
    for at in 0..file.len() {
        for bits in [1, 2, 4, 8, 16, 32, 64, 128, 255, file[at]].into_iter().filter(|bits| *bits != 0) {
            file[at] ^= bits;
            assert_found(&file, at);
            file[at] ^= bits;
        }
    }
}

#[test]
fn changed_bits_of_a_record_of_a_run_are_found() {
    let mut file = write(2, &run(2, 2), 100_000_000);
    for at in (0..file.len()).step_by(41).chain(file.len() - 600..file.len()) {
        let bits = 1 << (at % 8);
        file[at] ^= bits;
        assert_found(&file, at);
        file[at] ^= bits;
    }
}

#[test]
fn a_single_bit_is_named() {
    let mut file = write(3, &run(3, 2), 100_000_000);
    let mut named = 0;
    let places: Vec<usize> = (8..file.len()).step_by(file.len() / 200).collect();
    for &at in &places {
        file[at] ^= 4;
        let found = verified(&file).unwrap();
        let flips: Vec<_> = found.faults.iter().filter_map(|fault| fault.flip).collect();
        assert!(flips.iter().all(|flip| (flip.at, flip.bits) == (at as u64, 4)), "{at}: {flips:?}");
        named += usize::from(!flips.is_empty());
        file[at] ^= 4;
    }
    assert!(named * 10 >= places.len() * 9, "{named} of {}", places.len());
}

#[test]
fn a_cut_is_no_damage() {
    let file = write(2, &run(2, 2), 100_000_000);
    for length in (8..file.len()).step_by(97) {
        let found = verified(&file[..length]);
        let found = match found {
            Err(RecordReadError::NotARecord) if length < 200 => continue,
            found => found.unwrap(),
        };
        assert!(found.faults.is_empty(), "cut at {length}: {:?}", found.faults);
        assert!(matches!(found.ending, Ending::Truncated { .. }), "cut at {length}");
    }
}

#[test]
fn what_is_behind_the_end_is_found() {
    let mut file = write(2, &run(2, 1), 100_000_000);
    let end = file.len() as u64;
    file.extend(b"more");
    let found = verified(&file).unwrap();
    assert_eq!((found.faults[0].from, found.faults[0].to), (end, end + 4));
}
