//! What finding a ray costs, in nanoseconds per ray, the best pass of many: the channel asks for one for every ping, receiver
//! and path. The places are those of AUVs in the water of a shelf sea; `beside` holds the share of them that a ray reaches. A goal
//! stands beside the number that it is for.
//!
//! `cargo bench -p shoal-channel --bench rays [-- FILTER]`

use std::hint::black_box;
use std::time::Instant;

use shoal_channel::acoustics::profile::{Node, Profile};
use shoal_channel::acoustics::ray::{Boundary, Ray, SoundPath, WaterColumn};

/// Rays in a pass: enough that no branch predictor learns them.
const RAYS: usize = 2_048;
const BOTTOM_M: f64 = 200.0;

/// Two points and their distance.
struct Pair {
    from_m: f64,
    to_m: f64,
    range_m: f64,
}

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let filters: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let passes = if is_bench { 300 } else { 1 };
    let linear = [Node { depth_m: 0.0, speed_m_s: 1500.0 }, Node { depth_m: 200.0, speed_m_s: 1503.2 }];
    let waters = [
        ("uniform", Profile::uniform(1500.0)),
        ("linear", Profile::new(&linear)),
        ("mixed_layer", Ok(Profile::mixed_layer(BOTTOM_M))),
        ("summer_thermocline", Ok(Profile::summer_thermocline(BOTTOM_M))),
        ("arctic", Ok(Profile::arctic(BOTTOM_M))),
    ];
    for (water_name, profile) in waters {
        let profile = profile.expect("fine nodes");
        let nodes = profile.nodes().len();
        let water = WaterColumn::new(profile, BOTTOM_M);
        let mut random = Random(7);
        let pairs: Vec<Pair> = (0..RAYS)
            .map(|_| Pair {
                from_m: 2.0 + 190.0 * random.unit(),
                to_m: 2.0 + 190.0 * random.unit(),
                range_m: 50.0 + 1_500.0 * random.unit(),
            })
            .collect();
        let bounced = |first, bounces| SoundPath::Bounced { first, bounces };
        for (path_name, path, cold_goal) in [
            ("direct", SoundPath::Direct, "< 250 ns"),
            ("surface", bounced(Boundary::Surface, 1), "< 400 ns"),
            ("bottom", bounced(Boundary::Bottom, 1), "< 400 ns"),
            ("bottom_surface_bottom", bounced(Boundary::Bottom, 3), "< 400 ns"),
        ] {
            let rays: Vec<Option<Ray>> = pairs
                .iter()
                .map(|pair| water.ray(path, pair.from_m, pair.to_m, pair.range_m, None))
                .collect();
            let reached = rays.iter().flatten().count() as f64 / RAYS as f64;
            for (kind, is_warm, goal) in [("cold", false, cold_goal), ("warm", true, "< 100 ns")] {
                let name = format!("channel/ray/{path_name}_{kind}/{water_name}");
                if !filters.iter().all(|filter| name.contains(filter.as_str())) {
                    continue;
                }
                let pass = |_| {
                    let since = Instant::now();
                    for (pair, ray) in pairs.iter().zip(&rays) {
                        let pair = black_box(pair);
                        // The receiver has gone on by a step of the search for the moment of reception.
                        let (moved_m, guess) = if is_warm { (0.01, ray.as_ref()) } else { (0.0, None) };
                        black_box(water.ray(path, pair.from_m, pair.to_m, pair.range_m + moved_m, guess));
                    }
                    since.elapsed().as_secs_f64() * 1e9 / RAYS as f64
                };
                let best_ns = (0..passes).map(pass).fold(f64::INFINITY, f64::min);
                println!(
                    r#"{{"format":"shoal.bench/1","name":"{name}","value":{best_ns:.1},"unit":"ns","beside":{{"goal":"{goal}","nodes":{nodes},"reached":{reached:.2}}}}}"#
                );
            }
        }
    }
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
