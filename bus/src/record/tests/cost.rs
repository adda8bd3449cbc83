//! What recording costs: prints figures, asserts none.
//!
//! `cargo test --release -p shoal-bus --features record -- --ignored --nocapture cost_of_recording`

use std::time::{Duration, Instant};

use super::synthetic::{header, one_second, summary};
use crate::record::{RecordInfo, RecordWriter};
use crate::time::{NS_PER_S, SimTime};

#[test]
#[ignore = "a measurement"]
fn cost_of_recording() {
    const AUVS: u32 = 300;
    const SECONDS: i64 = 30;
    let mut writer = RecordWriter::create(Vec::new(), &header(AUVS)).unwrap();
    let (mut entries, mut spent) = (0, Duration::ZERO);
    for second in 0..SECONDS {
        let window = one_second(AUVS, second);
        entries += window.len();
        let begin = Instant::now();
        writer.append(&window).unwrap();
        writer.advance(SimTime::from_ns((second + 1) * NS_PER_S)).unwrap();
        spent += begin.elapsed();
    }
    let begin = Instant::now();
    let file = writer.finish(&summary(AUVS)).unwrap();
    spent += begin.elapsed();
    let (per_s, per_entry) = (spent / SECONDS as u32, spent / entries as u32);
    println!(
        "{AUVS} AUVs, {SECONDS} s, {entries} entries: {per_s:?} a simulated second, {per_entry:?} an entry"
    );
    let begin = Instant::now();
    println!("{}", RecordInfo::read(std::io::Cursor::new(&file)).unwrap());
    println!("read and verified in {:?}", begin.elapsed());
}
