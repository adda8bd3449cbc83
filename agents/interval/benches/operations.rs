//! What interval operations, contractors and set inversion cost, each also as a multiple of one interval addition in the same
//! run: these machines are shared, and a ratio travels better than a time.
//!
//! `cargo bench -p shoal-interval --bench operations [-- FILTER]`; beside the `inari` crate: `agents/interval/comparison`.

use std::hint::black_box;
use std::time::Instant;

use nalgebra::Vector2;
use shoal_interval::contractor::{
    Contractor, contract_atan2, contract_distance, contract_polar, contract_range,
};
use shoal_interval::expression::Expression;
use shoal_interval::paving::{Options, pave};
use shoal_interval::separator::{Ring, Separator};
use shoal_interval::{Interval, IntervalBox};

/// Operands a pass goes through: small enough for the first cache, enough that no branch predictor learns them.
const OPERANDS: usize = 512;

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let passes = if std::env::args().any(|argument| argument == "--bench") { 300 } else { 1 };
    let bench = Bench { passes, filters: std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect() };
    let mut random = Random(1);
    let pairs: Vec<_> = (0..OPERANDS).map(|_| (random.interval(), random.interval())).collect();
    let add_ns = bench.time(&pairs, |(x, y)| x + y);

    bench.operations(&pairs, add_ns);
    bench.contractors(&mut random, add_ns);
    bench.set_inversion(add_ns);
}

struct Bench {
    passes: usize,
    filters: Vec<String>,
}

impl Bench {
    fn operations(&self, pairs: &[(Interval, Interval)], add_ns: f64) {
        self.report("add", add_ns, pairs, |(x, y)| x + y);
        self.report("mul", add_ns, pairs, |(x, y)| x * y);
        self.report("div", add_ns, pairs, |(x, y)| x / y);
        self.report("sqr", add_ns, pairs, |(x, _)| x.sqr());
        self.report("sqrt", add_ns, pairs, |(x, _)| x.sqrt());
        self.report("mul_add", add_ns, pairs, |(x, y)| x.mul_add(y, x));
        self.report("exp", add_ns, pairs, |(x, _)| x.exp());
        self.report("ln", add_ns, pairs, |(x, _)| x.ln());
        self.report("sin", add_ns, pairs, |(x, _)| x.sin());
        self.report("cos", add_ns, pairs, |(x, _)| x.cos());
        self.report("tan", add_ns, pairs, |(x, _)| x.tan());
        self.report("atan", add_ns, pairs, |(x, _)| x.atan());
        self.report("atan2", add_ns, pairs, |(x, y)| y.atan2(x));
        self.report("sqr_rev", add_ns, pairs, |(x, y)| x.sqr_rev(y));
        self.report("mul_rev", add_ns, pairs, |(x, y)| x.mul_rev(y, Interval::ENTIRE));
        self.report("sin_rev", add_ns, pairs, |(x, y)| (x / 1000.0).sin_rev(y));
    }

    fn contractors(&self, random: &mut Random, add_ns: f64) {
        let plane: Vec<_> = (0..OPERANDS).map(|_| (random.boxed::<2>(), random.boxed::<2>())).collect();
        let space: Vec<_> = (0..OPERANDS).map(|_| (random.boxed::<3>(), random.boxed::<3>())).collect();
        let range = Interval::new(0.0, 2000.0).expect("ordered");
        self.report("contract_distance/2", add_ns, &plane, |(mut a, mut b)| {
            let mut range = range;
            (contract_distance(&mut a, &mut b, &mut range), a, b, range)
        });
        self.report("contract_distance/3", add_ns, &space, |(mut a, mut b)| {
            let mut range = range;
            (contract_distance(&mut a, &mut b, &mut range), a, b, range)
        });
        self.report("contract_range/3", add_ns, &space, |(mut position, mut emitter)| {
            let mut sound_speed = Interval::new(1480.0, 1520.0).expect("ordered");
            let mut reception = Interval::new(1.0, 1.1).expect("ordered");
            let mut emission = Interval::new(0.1, 0.2).expect("ordered");
            let kept =
                contract_range(&mut position, &mut emitter, &mut sound_speed, &mut reception, &mut emission);
            (kept, position, emitter, sound_speed, reception, emission)
        });
        let polar: Vec<_> = (0..OPERANDS).map(|_| random.polar()).collect();
        self.report("contract_polar", add_ns, &polar, |[mut x, mut y, mut range, mut bearing]| {
            (contract_polar(&mut x, &mut y, &mut range, &mut bearing), x, y, range, bearing)
        });
        self.report("contract_atan2", add_ns, &polar, |[mut x, mut y, _, mut bearing]| {
            (contract_atan2(&mut x, &mut y, &mut bearing), x, y, bearing)
        });
        let written = Expression::new(|[x, y]| ((x - 3.0).sqr() + (y - 3.0).sqr()).sqrt()).contractor(range);
        self.report("expression/distance/2", add_ns, &plane, |(position, _)| written.contract(position));
    }

    /// The three beacons of seed 001, figure 2.10, at the precision of 0.05 m.
    fn set_inversion(&self, add_ns: f64) {
        let over = |lower, upper| Interval::new(lower, upper).expect("ordered");
        let ring = |x, y, lower, upper| Ring::new(Vector2::new(x, y), over(lower, upper));
        let seen = ring(3.0, 3.0, 3.0, 4.0)
            .intersection(ring(-3.0, -1.0, 5.0, 6.0))
            .intersection(ring(-2.0, 2.0, 4.0, 5.0));
        let initial = IntervalBox::from([over(-10.0, 10.0); 2]);
        let paved = || pave(&seen, initial, &Options::new(0.05)).expect("a bounded box");
        let separations = paved().statistics().boxes as f64;
        let name = "three_beacons/separation";
        self.report_as(name, add_ns, separations, &[()], |()| paved());
    }

    fn report<T: Copy, R>(&self, name: &str, add_ns: f64, operands: &[T], operation: impl Fn(T) -> R) {
        self.report_as(name, add_ns, 1.0, operands, operation);
    }

    fn report_as<T: Copy, R>(
        &self,
        name: &str,
        add_ns: f64,
        parts: f64,
        operands: &[T],
        operation: impl Fn(T) -> R,
    ) {
        if self.filters.iter().all(|filter| name.contains(filter.as_str())) {
            let ns = self.time(operands, operation) / parts;
            println!(
                r#"{{"format":"shoal.bench/1","name":"interval/{name}","value":{ns:.1},"unit":"ns","additions":{:.1}}}"#,
                ns / add_ns
            );
        }
    }

    /// Nanoseconds an operation: the best of many short passes.
    fn time<T: Copy, R>(&self, operands: &[T], operation: impl Fn(T) -> R) -> f64 {
        let mut best = f64::INFINITY;
        for _ in 0..self.passes {
            let since = Instant::now();
            for &operand in operands {
                black_box(operation(black_box(operand)));
            }
            best = best.min(since.elapsed().as_secs_f64() * 1e9 / operands.len() as f64);
        }
        best
    }
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of every sign, wide and narrow, within a kilometre.
    fn interval(&mut self) -> Interval {
        let widths = [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0];
        let radius = widths[(6.0 * self.unit()) as usize] * self.unit();
        Interval::centred(2000.0 * self.unit() - 1000.0, radius)
    }

    fn boxed<const N: usize>(&mut self) -> IntervalBox<N> {
        IntervalBox::from(std::array::from_fn(|_| self.interval()))
    }

    /// A contact of a sonar: a position box in one quadrant, range and bearing that meet it.
    fn polar(&mut self) -> [Interval; 4] {
        let (x, y) = (10.0 + 90.0 * self.unit(), 10.0 + 90.0 * self.unit());
        let range = (x * x + y * y).sqrt();
        let bearing = Interval::spanning(y, y).atan2(Interval::spanning(x, x)).inflate(0.05);
        [
            Interval::centred(x, 5.0),
            Interval::centred(y, 5.0),
            Interval::centred(range + self.unit() - 0.5, 1.0),
            bearing,
        ]
    }
}
