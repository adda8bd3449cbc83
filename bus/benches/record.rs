//! What recording costs, and reading back with every checksum verified.
//!
//! `cargo bench -p shoal-bus --features record --bench record`

// The made-up run of the record's tests names these as its own crate's modules.
use shoal_bus::{chronicle, message, ping, record, summary, time, traffic};

#[allow(dead_code)]
#[path = "../src/record/tests/synthetic.rs"]
mod synthetic;

use std::time::{Duration, Instant};

use record::{RecordInfo, RecordWriter};
use time::{NS_PER_S, SimTime};

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let (auvs, seconds) = if is_bench { (300, 30) } else { (3, 2) };
    let mut writer = RecordWriter::create(Vec::new(), &synthetic::header(auvs)).expect("memory takes bytes");
    let (mut entries, mut spent) = (0, Duration::ZERO);
    for second in 0..seconds {
        let window = synthetic::one_second(auvs, second);
        entries += window.len();
        let since = Instant::now();
        writer.append(&window).expect("memory takes bytes");
        writer.advance(SimTime::from_ns((second + 1) * NS_PER_S)).expect("memory takes bytes");
        spent += since.elapsed();
    }
    let since = Instant::now();
    let file = writer.finish(&synthetic::summary(auvs)).expect("memory takes bytes");
    spent += since.elapsed();

    let since = Instant::now();
    RecordInfo::read(std::io::Cursor::new(&file)).expect("it was just written");
    let read_ms = since.elapsed().as_secs_f64() * 1e3;
    let written_ms = spent.as_secs_f64() * 1e3;
    print(&format!("record/{auvs}/entry"), written_ms * 1e3 / entries as f64, "us");
    print(&format!("record/{auvs}/second"), written_ms / seconds as f64, "ms");
    print(&format!("record/{auvs}/size"), file.len() as f64 / seconds as f64 / 1024.0, "KiB/s");
    let line = serde_json::json!({
        "format": "shoal.bench/1",
        "name": format!("record/{auvs}/read"),
        "value": read_ms,
        "unit": "ms",
        "beside": { "name": "writing the same", "ratio": read_ms / written_ms },
    });
    println!("{line}");
}

fn print(name: &str, value: f64, unit: &str) {
    let line = serde_json::json!({"format": "shoal.bench/1", "name": name, "value": value, "unit": unit});
    println!("{line}");
}
