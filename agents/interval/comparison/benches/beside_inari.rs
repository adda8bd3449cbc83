//! Each operation of `shoal-interval` beside the same one of `inari`, both in one run and on the same operands.
//!
//! `cargo bench --manifest-path agents/interval/comparison/Cargo.toml [-- FILTER]`

use std::hint::black_box;
use std::time::Instant;

use inari::Interval as Theirs;
use shoal_interval::Interval as Ours;

/// Operands a pass goes through: small enough for the first cache, enough that no branch predictor learns them.
const OPERANDS: usize = 512;

fn main() {
    let operands = Operands::new();
    for (name, wanted, ours, theirs) in operations() {
        if !std::env::args().skip(1).all(|filter| filter.starts_with('-') || name.contains(&filter)) {
            continue;
        }
        let (ours_ns, theirs_ns) = operands.time(ours, theirs);
        println!(
            r#"{{"schema":"shoal.bench/1","name":"interval/{name}","shoal_ns":{ours_ns:.1},"inari_ns":{theirs_ns:.1},"times_as_fast":{:.2},"wanted":{wanted}}}"#,
            theirs_ns / ours_ns
        );
    }
}

type OursOf = fn(Ours, Ours) -> Ours;
type TheirsOf = fn(Theirs, Theirs) -> Theirs;

/// Name, how many times as fast we mean to be, and both.
fn operations() -> [(&'static str, f64, OursOf, TheirsOf); 14] {
    [
        ("add", 1.0, |x, y| x + y, |x, y| x + y),
        ("sub", 1.0, |x, y| x - y, |x, y| x - y),
        ("mul", 1.0, |x, y| x * y, |x, y| x * y),
        ("div", 1.0, |x, y| x / y, |x, y| x / y),
        ("sqr", 1.0, |x, _| x.sqr(), |x, _| x.sqr()),
        ("sqrt", 1.0, |x, _| x.sqrt(), |x, _| x.sqrt()),
        ("sin", 30.0, |x, _| x.sin(), |x, _| x.sin()),
        ("cos", 30.0, |x, _| x.cos(), |x, _| x.cos()),
        ("atan2", 30.0, |x, y| y.atan2(x), |x, y| y.atan2(x)),
        ("tan", 1.0, |x, _| x.tan(), |x, _| x.tan()),
        ("atan", 1.0, |x, _| x.atan(), |x, _| x.atan()),
        ("exp", 1.0, |x, _| x.exp(), |x, _| x.exp()),
        ("ln", 1.0, |x, _| x.ln(), |x, _| x.ln()),
        ("powi", 1.0, |x, _| x.powi(5), |x, _| x.powi(5)),
    ]
}

struct Operands {
    ours: Vec<(Ours, Ours)>,
    theirs: Vec<(Theirs, Theirs)>,
}

impl Operands {
    /// Intervals of every sign, wide and narrow, within a kilometre.
    fn new() -> Operands {
        let mut state = 1_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut bounds = move || {
            let (mid, radius) = (2000.0 * random() - 1000.0, 10.0_f64.powi((6.0 * random()) as i32 - 3) * random());
            (mid - radius, mid + radius)
        };
        let pairs: Vec<_> = (0..OPERANDS).map(|_| (bounds(), bounds())).collect();
        let our = |(a, b)| Ours::new(a, b).expect("ordered");
        let their = |(a, b)| inari::interval!(a, b).expect("ordered");
        Operands {
            ours: pairs.iter().map(|&(x, y)| (our(x), our(y))).collect(),
            theirs: pairs.iter().map(|&(x, y)| (their(x), their(y))).collect(),
        }
    }

    /// Nanoseconds an operation, the best of many short passes that take turns.
    fn time(&self, ours: OursOf, theirs: TheirsOf) -> (f64, f64) {
        let (mut best_of_ours, mut best_of_theirs) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..200 {
            best_of_ours = best_of_ours.min(pass(&self.ours, ours));
            best_of_theirs = best_of_theirs.min(pass(&self.theirs, theirs));
        }
        (best_of_ours, best_of_theirs)
    }
}

fn pass<T: Copy>(operands: &[(T, T)], operation: impl Fn(T, T) -> T) -> f64 {
    let since = Instant::now();
    for &(x, y) in operands {
        black_box(operation(black_box(x), black_box(y)));
    }
    since.elapsed().as_secs_f64() * 1e9 / operands.len() as f64
}
