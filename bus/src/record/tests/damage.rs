//! Cut and damaged files are told from whole ones, wherever the fault is, without a panic.

use std::io::{Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use super::synthetic::{run, write};
use crate::record::{Damage, RecordInfo, RecordReadError};

/// Every place near both ends of `file`, and a sample of those in between.
fn places(file: &[u8]) -> impl Iterator<Item = usize> + use<> {
    let length = file.len();
    (0..length).filter(move |at| *at < 300 || length - at < 300 || at % 37 == 0)
}

#[test]
fn a_file_cut_anywhere_is_read_as_far_as_it_goes() {
    let file = write(2, &run(2, 2), 100_000_000);
    let mut until_s = None;
    for length in places(&file) {
        match RecordInfo::read(Cursor::new(&file[..length])) {
            Ok(info) => {
                let cut = info.truncated.unwrap_or_else(|| panic!("cut at {length} unnoticed"));
                assert!(cut.readable_bytes <= length as u64);
                assert!(cut.readable_until_s >= until_s, "less is readable at {length}");
                until_s = cut.readable_until_s;
            }
            Err(RecordReadError::NotMcap) if length < 8 => {}
            Err(error) => panic!("cut at {length}: {error}"),
        }
    }
    assert_eq!(until_s, Some(2.0));
    let half = RecordInfo::read(Cursor::new(&file[..file.len() / 2])).unwrap().to_string();
    assert!(half.contains("truncated    no footer, readable up to "), "{half}");
}

#[test]
fn one_flipped_bit_anywhere_is_damage() {
    let mut file = write(2, &run(2, 1), 100_000_000);
    for at in places(&file) {
        let bit = 1 << (at / 3 % 8);
        file[at] ^= bit;
        match RecordInfo::read(Cursor::new(&file)) {
            Err(RecordReadError::Damaged { from, to, .. }) => {
                assert!(from <= at as u64 && at as u64 <= to, "{at} is not in {from} to {to}");
            }
            Err(RecordReadError::NotMcap) if at < 8 => {}
            other => panic!("byte {at}: {other:?}"),
        }
        file[at] ^= bit;
    }
}

#[test]
fn no_bytes_whatever_make_it_panic() {
    let file = write(2, &run(2, 1), 100_000_000);
    let mut state = 1_u64;
    let mut draw = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for _ in 0..300 {
        let mut bad = file.clone();
        for _ in 0..16 {
            bad[draw(file.len())] = draw(256) as u8;
        }
        bad.truncate(file.len() - draw(2) * draw(file.len()));
        let _ = RecordInfo::read(Cursor::new(&bad));
    }
}

#[test]
fn a_damaged_chunk_is_named() {
    let mut file = write(7, &run(7, 3), 100_000_000);
    let middle = file.len() / 2;
    file[middle] ^= 16;
    let error = RecordInfo::read(Cursor::new(&file)).unwrap_err();
    assert!(error.to_string().starts_with("damaged between bytes "), "{error}");
    let RecordReadError::Damaged { from, to, damage } = error else { panic!("{error}") };
    assert!(from < middle as u64 && (middle as u64) < to && to < file.len() as u64);
    assert!(matches!(damage, Damage::Checksum { .. } | Damage::Structure(_)), "{damage}");
}

#[test]
fn what_is_no_record_is_refused() {
    for bytes in [&b""[..], b"\x89MCAP", b"PK\x03\x04 something else altogether"] {
        assert!(matches!(RecordInfo::read(Cursor::new(bytes)), Err(RecordReadError::NotMcap)));
    }
    let error = RecordInfo::open(Path::new("/nowhere/run.mcap")).unwrap_err().to_string();
    assert!(error.starts_with("/nowhere/run.mcap: cannot read at byte 0: "), "{error}");
}

/// A disk that fails behind its first bytes.
struct Failing(Cursor<Vec<u8>>);

impl Read for Failing {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        match self.0.position() {
            0 => self.0.read(into),
            position if position + 8 >= self.0.get_ref().len() as u64 => self.0.read(into),
            _ => Err(std::io::Error::other("bad sector")),
        }
    }
}

impl Seek for Failing {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn a_failing_disk_is_no_damage() {
    let file = write(7, &run(7, 3), 100_000_000);
    let error = RecordInfo::read(Failing(Cursor::new(file))).unwrap_err();
    assert!(matches!(error, RecordReadError::Io { offset: 65_536, .. }), "{error}");
}
