//! What is whole of a record comes back.

use std::io::Cursor;

use super::synthetic::{run, write};
use crate::record::{Ending, Found, RecordReader, RecoverError, Recovery, recover, verify};

fn recovered(file: &[u8]) -> Result<(Vec<u8>, Recovery), RecoverError> {
    let mut copy = Vec::new();
    let recovery = recover(Cursor::new(file), &mut copy)?;
    let found = verify(Cursor::new(&copy), &mut |_| {}).unwrap();
    assert!(found.is_whole(), "{:?}", found.faults);
    Ok((copy, recovery))
}

/// All messages, as (sequence, bytes).
fn messages(file: &[u8]) -> Vec<(u32, Vec<u8>)> {
    let mut reader = RecordReader::new(Cursor::new(file)).unwrap();
    let mut messages = Vec::new();
    while let Some(found) = reader.next().unwrap() {
        if let Found::Message(message) = found {
            messages.push((message.sequence, message.data.to_vec()));
        }
    }
    messages
}

/// A reproducible sequence of numbers.
struct Dice(u64);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }
}

#[test]
fn the_copy_of_a_good_record_is_that_record() {
    let file = write(5, &run(5, 3), 130_000_000);
    let (copy, recovery) = recovered(&file).unwrap();
    assert!(copy == file);
    assert!(recovery.is_complete() && recovery.in_words().is_none());
    // What has been recovered once is recovered to itself.
    let (cut, _) = recovered(&file[..file.len() / 2]).unwrap();
    assert!(recovered(&cut).unwrap().0 == cut);
}

#[test]
fn what_was_flushed_before_a_cut_comes_back() {
    let file = write(3, &run(3, 4), 100_000_000);
    let all = messages(&file);
    // Where each chunk ends, and how many messages there are by then.
    let ends = chunk_ends(&file);
    let mut dice = Dice(1);
    for _ in 0..200 {
        let length = dice.below(file.len());
        let result = recovered(&file[..length]);
        let flushed = ends.iter().take_while(|(end, _)| *end <= length).last().map_or(0, |(_, count)| *count);
        match result {
            Ok((copy, recovery)) => {
                assert!(messages(&copy) == all[..flushed], "cut at {length}");
                assert_eq!(recovery.messages, flushed as u64);
                assert!(matches!(recovery.ending, Ending::Truncated { .. }) || flushed == all.len());
                assert!(recovery.lost.is_empty());
            }
            Err(error) => assert!(flushed == 0 && length < 300, "cut at {length}: {error}"),
        }
    }
}

/// The byte after each chunk, and how many messages have come by then.
fn chunk_ends(file: &[u8]) -> Vec<(usize, usize)> {
    let (mut at, mut count, mut ends) = (8, 0, Vec::new());
    while at + 9 < file.len() {
        let length = u64::from_le_bytes(file[at + 1..at + 9].try_into().unwrap()) as usize;
        let end = at + 9 + length;
        if file[at] == 6 {
            let mcap::records::Record::Chunk { header, data } =
                mcap::parse_record(6, &file[at + 9..end]).unwrap()
            else {
                panic!("no chunk")
            };
            count += mcap::read::ChunkReader::new(header, &data)
                .unwrap()
                .filter(|record| matches!(record, Ok(mcap::records::Record::Message { .. })))
                .count();
            ends.push((end, count));
        }
        at = end;
    }
    ends
}

#[test]
fn one_flipped_bit_costs_nothing() {
    let file = write(3, &run(3, 4), 100_000_000);
    let mut dice = Dice(2);
    for _ in 0..200 {
        let mut bad = file.clone();
        let at = dice.below(bad.len());
        bad[at] ^= 1 << dice.below(8);
        let (copy, recovery) = recovered(&bad).unwrap_or_else(|error| panic!("byte {at}: {error}"));
        assert!(copy == file, "byte {at}: {recovery:?}");
        assert!(recovery.is_complete());
    }
}

#[test]
fn larger_damage_costs_the_chunk_it_is_in() {
    let file = write(3, &run(3, 4), 100_000_000);
    let all = messages(&file);
    let ends = chunk_ends(&file);
    let mut dice = Dice(3);
    for _ in 0..60 {
        let mut bad = file.clone();
        let at = 400 + dice.below(bad.len() - 4_000);
        bad[at..at + 200].iter_mut().for_each(|byte| *byte = byte.wrapping_mul(5).wrapping_add(77));
        let (copy, recovery) = recovered(&bad).unwrap();
        let kept = messages(&copy);
        // A damage of 200 bytes touches two chunks at most.
        let hit: Vec<usize> = (0..ends.len())
            .filter(|index| {
                let begin = index.checked_sub(1).map_or(0, |before| ends[before].0);
                begin < at + 200 && at < ends[*index].0
            })
            .collect();
        let of_chunk = |index: usize| index.checked_sub(1).map_or(0, |before| ends[before].1)..ends[index].1;
        let expected: Vec<_> = (0..ends.len())
            .filter(|index| !hit.contains(index))
            .flat_map(|index| all[of_chunk(index)].iter().cloned())
            .collect();
        assert!(expected.iter().all(|message| kept.contains(message)), "{at}");
        assert!(kept.iter().all(|message| all.contains(message)), "{at}");
        assert_eq!(recovery.messages as usize, kept.len(), "{at}");
        assert!(!recovery.is_complete() || kept == all, "{at}");
    }
}

#[test]
fn what_has_no_beginning_is_refused() {
    let file = write(2, &run(2, 1), 100_000_000);
    assert!(matches!(recovered(&file[..100]), Err(RecoverError::Nothing)));
    assert!(matches!(recovered(&file[..20]), Err(RecoverError::Nothing)));
    assert!(matches!(recovered(b"not a record"), Err(RecoverError::Read(_))));
}

#[test]
fn no_bytes_whatever_make_it_panic() {
    let file = write(2, &run(2, 1), 100_000_000);
    let mut dice = Dice(4);
    for _ in 0..200 {
        let mut bad = file.clone();
        for _ in 0..8 {
            let at = dice.below(bad.len());
            bad[at] = dice.below(256) as u8;
        }
        bad.truncate(file.len() - dice.below(2) * dice.below(file.len()));
        let _ = recover(Cursor::new(&bad), std::io::sink());
        let _ = verify(Cursor::new(&bad), &mut |_| {});
    }
}
