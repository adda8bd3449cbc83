//! What a packet costs at its receiver, with none, ten and a hundred others sounding at any time.
//!
//! `cargo bench -p shoal-channel --bench reception [-- FILTER]`

use std::hint::black_box;
use std::time::Instant;

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::SoundPath;
use shoal_channel::draw::{Draws, Purpose};
use shoal_channel::reception::{Arrival, ArrivalKind, Ear, EarSettings};
use shoal_scenario::model::{Fading, FadingKind, FadingPer, Modulation, Noise, PhysicalLayer};

/// How many packets a pass receives.
const PACKETS: i64 = 2_000;
/// How long each is.
const LENGTH_NS: i64 = 306_000_000;
/// How far true time advances at once.
const WINDOW_NS: i64 = 50_000_000;

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let passes = if std::env::args().any(|argument| argument == "--bench") { 25 } else { 1 };
    let filters: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let kinds = [
        ("gaussian", Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet }),
        ("rayleigh", Fading { kind: FadingKind::Rayleigh, per: FadingPer::Packet }),
        ("rician_bit", Fading { kind: FadingKind::Rician { k_db: 6.0 }, per: FadingPer::Bit }),
    ];
    for (fading_name, fading) in kinds {
        let mut alone_ns = None;
        for others in [0, 10, 100] {
            let name = format!("reception/{fading_name}/{others}");
            if !filters.is_empty() && !filters.iter().any(|filter| name.contains(filter)) {
                continue;
            }
            let best_ns = (0..passes).map(|_| pass_ns(fading, others)).fold(f64::INFINITY, f64::min);
            let growth = best_ns / *alone_ns.get_or_insert(best_ns);
            println!(
                r#"{{"format":"shoal.bench/1","name":"{name}","value":{best_ns:.0},"unit":"ns","growth":{growth:.1}}}"#
            );
        }
    }
}

/// Nanoseconds per packet.
fn pass_ns(fading: Fading, others: i64) -> f64 {
    let physical = PhysicalLayer {
        source_level_db: 185.0,
        centre_hz: 25_000.0,
        bandwidth_hz: 4_000.0,
        bit_rate_bit_s: 1_000.0,
        preamble_s: 0.05,
        modulation: Modulation::Bpsk,
        coding_gain_db: 0.0,
        detection_threshold_db: 3.0,
        capture_db: 6.0,
    };
    let settings = EarSettings { noise_db: 75.0, physical, fading, sense_ns: 0 };
    let mut ear = Ear::new(settings, Draws::new(1, Purpose::Reception, AuvId(0), Noise::Uniform));
    let spacing_ns = LENGTH_NS / (others + 1);
    let arrivals: Vec<Arrival> = (0..PACKETS)
        .map(|index| {
            let start = SimTime::from_ns(index * spacing_ns);
            Arrival {
                from: AuvId((index % 200) as u32),
                sequence: (index / 200) as u32,
                path: SoundPath::Direct,
                start,
                end: start + LENGTH_NS,
                // From 2 to 41 dB above the noise, in no regular order.
                level_db: 77.0 + ((index * 7_919) % 40) as f64,
                doppler: 1.0,
                flight: index as u32,
                kind: ArrivalKind::Packet { copies: 1, bits: 256, asleep: false, known: true },
            }
        })
        .collect();
    let mut outcomes = Vec::with_capacity(PACKETS as usize);
    let since = Instant::now();
    let mut until = SimTime::ZERO;
    let mut told = 0;
    while outcomes.len() < PACKETS as usize {
        until = until + WINDOW_NS;
        while let Some(&arrival) = arrivals.get(told).filter(|arrival| arrival.start < until) {
            ear.expect(arrival);
            told += 1;
        }
        ear.settle(until, &mut outcomes);
    }
    black_box(&outcomes);
    since.elapsed().as_nanos() as f64 / PACKETS as f64
}
