//! What questions to tubes and contractions of tubes cost, at 1,000, 10,000 and 100,000 slices. Beside each time stands how
//! many times that of a tenth of the slices it is, in the same run: these machines are shared, and growth travels better
//! than a time. A goal of the crate stands beside the number that it is for.
//!
//! `cargo bench -p shoal-tube --bench tubes [-- FILTER]`

use std::hint::black_box;
use std::time::Instant;

use shoal_interval::Interval;
use shoal_tube::contractor::{contract_delay, contract_order, contract_uncertain_delay};
use shoal_tube::{Direction, TimeDomain, Tube, TubeError};

/// The numbers of slices.
const COUNTS: [usize; 3] = [1_000, 10_000, 100_000];
/// The duration of every tube.
const END_S: f64 = 1_000.0;
/// How late the late tube is.
const LATE_S: f64 = 7.0;
/// Questions a pass asks: enough that no branch predictor learns them.
const QUESTIONS: usize = 512;

fn main() {
    // Without `--bench` this is `cargo test`, which only asks whether it runs.
    let is_bench = std::env::args().any(|argument| argument == "--bench");
    let bench =
        Bench { is_bench, filters: std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect() };
    bench.addition();
    bench.questions();
    bench.contractions();
    bench.between_times();
    bench.sinusoid();
    bench.memory();
}

struct Bench {
    is_bench: bool,
    filters: Vec<String>,
}

/// Which number is printed: of one question or of one slice.
#[derive(Clone, Copy)]
enum Per {
    Question,
    Slice,
    Call,
}

impl Bench {
    /// One addition of intervals, to hold the other times against on this machine.
    fn addition(&self) {
        let mut random = Random(4);
        let operands: Vec<Interval> =
            (0..QUESTIONS).map(|_| spanning(random.unit(), random.unit() - 1.0)).collect();
        let passes = if self.is_bench { 1_000 } else { 1 };
        let pass = |_| {
            let since = Instant::now();
            for &operand in &operands {
                black_box(black_box(operand) + operand);
            }
            elapsed_ns(since) / QUESTIONS as f64
        };
        let best_ns = (0..passes).map(pass).fold(f64::INFINITY, f64::min);
        println!(
            r#"{{"format":"shoal.bench/1","name":"tube/interval_addition","value":{best_ns:.1},"unit":"ns"}}"#
        );
    }

    fn questions(&self) {
        let mut random = Random(1);
        let times_s: Vec<f64> = (0..QUESTIONS).map(|_| END_S * random.unit()).collect();
        let windows_s: Vec<Interval> =
            (0..QUESTIONS).map(|_| spanning(END_S * random.unit(), END_S * random.unit())).collect();
        let values: Vec<Interval> =
            (0..QUESTIONS).map(|_| spanning(400.0 * random.unit(), 400.0 * random.unit())).collect();

        self.ask("at", "< 300 ns", &times_s, |world, &time_s| world.x_m.at(time_s));
        self.ask("at/irregular", "< 300 ns", &times_s, |world, &time_s| world.irregular_m.at(time_s));
        self.ask("over", "< 300 ns", &windows_s, |world, &window_s| world.x_m.over(window_s));
        self.ask("over/irregular", "< 300 ns", &windows_s, |world, &window_s| {
            world.irregular_m.over(window_s)
        });
        self.ask("invert", "", &values, |world, &value| world.x_m.invert(value));
        self.ask("integral", "", &windows_s, |world, window_s| {
            world.x_m.integral(window_s.lower(), window_s.upper())
        });
        self.ask("integral_between", "", &windows_s, |world, window_s| {
            let uncertain_s = |time_s: f64| Interval::centred(time_s, 1.0) & spanning(0.0, END_S);
            world.x_m.integral_between(uncertain_s(window_s.lower()), uncertain_s(window_s.upper()))
        });
        self.ask("append_and_drop", "", &[()], |world, ()| {
            let mut x_m = world.growing_m.borrow_mut();
            let end_s = x_m.domain().end_s();
            x_m.drop_front(1);
            x_m.append(end_s + 0.01, Interval::ONE, Interval::ONE)
        });
        self.ask("contract_slice", "", &times_s, |world, &time_s| {
            let mut x_m = world.growing_m.borrow_mut();
            let index = (time_s / END_S * x_m.slice_count() as f64) as usize;
            let slice = x_m.slice(index).unwrap_or(Interval::ENTIRE);
            let lower = slice.lower() + 1e-9 * slice.width();
            x_m.contract_slice(index, &spanning(lower, slice.upper()))
        });
    }

    fn contractions(&self) {
        self.change("contract_derivative", Per::Slice, "< 60 ns/slice", |world| {
            let mut x_m = world.unknown_m.clone();
            let since = Instant::now();
            black_box(x_m.contract_derivative(&world.speed_m_s, Direction::Both)).expect("one domain");
            elapsed_ns(since)
        });
        self.change("primitive", Per::Slice, "", |world| {
            let since = Instant::now();
            black_box(Tube::primitive(&world.speed_m_s, Interval::ZERO));
            elapsed_ns(since)
        });
        self.change("sum", Per::Slice, "", |world| {
            let since = Instant::now();
            black_box(world.x_m.sum(&world.speed_m_s)).expect("one domain");
            elapsed_ns(since)
        });
        self.change("sin", Per::Slice, "", |world| {
            let since = Instant::now();
            black_box(world.x_m.sin());
            elapsed_ns(since)
        });
    }

    fn between_times(&self) {
        // A window of 0.2 % of the time, in which the vehicle passes a place that is known to 0.1 m.
        let mut random = Random(3);
        let passages: Vec<_> = (0..QUESTIONS)
            .map(|_| {
                let time_s = 1.0 + (END_S - 2.0) * random.unit();
                (Interval::centred(time_s, 0.001 * END_S), position(spanning(time_s, time_s)))
            })
            .collect();
        self.change("evaluation", Per::Question, "< 50000 ns at 10000 slices", |world| {
            let mut x_m = world.x_m.clone();
            let since = Instant::now();
            for &(mut time_s, mut value_m) in &passages {
                black_box(x_m.contract_evaluation_with_derivative(
                    &world.speed_m_s,
                    &mut time_s,
                    &mut value_m,
                ))
                .expect("inside");
            }
            elapsed_ns(since) / QUESTIONS as f64
        });
        self.change("uncertain_delay", Per::Call, "growth < 15", |world| {
            let (mut late_m, mut early_m) = (world.late_m.clone(), world.x_m.clone());
            let mut delay_s = spanning(0.0, 20.0);
            let since = Instant::now();
            black_box(contract_uncertain_delay(&mut late_m, &mut early_m, &mut delay_s));
            assert!(delay_s.contains(LATE_S));
            elapsed_ns(since)
        });
    }

    /// The example `unknown_sinusoid`, beside the times that the seed prints for a processor of 3.2 GHz.
    fn sinusoid(&self) {
        if !self.is_asked("sinusoid") {
            return;
        }
        let runs = if self.is_bench { 20 } else { 1 };
        for (name, passes, seed_ms) in [("first_pass", 1, 7), ("fixpoint", 12, 55)] {
            let best_ms =
                (0..runs).map(|_| sinusoid_ms(passes).expect("one domain")).fold(f64::INFINITY, f64::min);
            println!(
                r#"{{"format":"shoal.bench/1","name":"tube/sinusoid/{name}","slices":2000,"value":{best_ms:.2},"unit":"ms","seed":{seed_ms}}}"#
            );
        }
    }

    fn memory(&self) {
        let mut smaller = None;
        for count in COUNTS {
            let world = World::new(count);
            let mut appended = Tube::starting_at(0.0, Interval::ZERO).expect("finite");
            for index in 0..count {
                // No two steps are quite the same, so every border is stored.
                let end_s = (index as f64 + 1.0) * 0.1 + 0.01 * f64::from((index % 7) as u8);
                appended.append(end_s, Interval::ONE, Interval::ONE).expect("increasing");
            }
            assert!(appended.domain().memory_bytes() >= 8 * count, "the borders take memory, too");
            let bytes = |tube: &Tube<Interval>| tube.memory_bytes() as f64 / count as f64;
            if self.is_asked("memory") {
                report(
                    "memory/uniform",
                    count,
                    bytes(&world.x_m),
                    "bytes/slice",
                    "< 64 bytes/slice",
                    &mut None,
                );
                report(
                    "memory/appended",
                    count,
                    bytes(&appended),
                    "bytes/slice",
                    "< 64 bytes/slice",
                    &mut smaller,
                );
            }
        }
    }

    /// Prints the time of one of many questions, the best pass of many.
    fn ask<Q, R>(&self, name: &str, goal: &str, questions: &[Q], ask: impl Fn(&World, &Q) -> R) {
        let repeats = QUESTIONS / questions.len();
        self.change(name, Per::Question, goal, |world| {
            let since = Instant::now();
            for _ in 0..repeats {
                for question in questions {
                    black_box(ask(world, black_box(question)));
                }
            }
            elapsed_ns(since) / (repeats * questions.len()) as f64
        });
    }

    /// Prints the best of many passes; `pass` returns its nanoseconds.
    fn change(&self, name: &str, per: Per, goal: &str, pass: impl Fn(&World) -> f64) {
        if !self.is_asked(name) {
            return;
        }
        let mut smaller = None;
        for count in COUNTS {
            let world = World::new(count);
            let passes = match (self.is_bench, per) {
                (false, _) => 1,
                (true, Per::Question) => 100,
                (true, Per::Slice | Per::Call) => (1_000_000 / count).min(200),
            };
            let best_ns = (0..passes).map(|_| pass(&world)).fold(f64::INFINITY, f64::min);
            let (value, unit) = match per {
                Per::Question => (best_ns, "ns"),
                Per::Slice => (best_ns / count as f64, "ns/slice"),
                Per::Call => (best_ns / 1000.0, "us"),
            };
            report(name, count, value, unit, goal, &mut smaller);
        }
    }

    fn is_asked(&self, name: &str) -> bool {
        self.filters.iter().all(|filter| name.contains(filter.as_str()))
    }
}

/// The milliseconds of some passes of the contractors of seed 001, section 4.3.1.
fn sinusoid_ms(passes: usize) -> Result<f64, TubeError> {
    let time = TimeDomain::uniform(0.0, 0.01, 2_000)?;
    let stretch = spanning(Interval::HALF_PI.upper(), Interval::PI.lower());
    let line = |slope: f64, start: f64| {
        Tube::from_function(time.clone(), move |t| {
            if t.is_subset_of(stretch) { (t - Interval::HALF_PI) * slope + start } else { Interval::ENTIRE }
        })
    };
    let mut a = Tube::constant(time.clone(), spanning(-1.0, 1.0));
    let mut b = Tube::constant(time.clone(), Interval::ENTIRE);
    contract_order(&mut line(-0.7, 0.99), &mut a)?;
    contract_order(&mut a, &mut line(-0.1, 1.01))?;
    let since = Instant::now();
    for _ in 0..passes {
        a.contract_central_symmetry(Interval::PI, Interval::ZERO)?;
        a.contract_period(Interval::TWO_PI)?;
        contract_delay(&mut b, &mut a, -Interval::HALF_PI)?;
        a.contract_derivative(&b, Direction::Both)?;
    }
    Ok(elapsed_ns(since) / 1e6)
}

/// One line of JSON; `smaller` is the value at a tenth of the slices, and becomes this one.
fn report(name: &str, count: usize, value: f64, unit: &str, goal: &str, smaller: &mut Option<f64>) {
    let growth = smaller.map_or(String::new(), |smaller| format!(r#","growth":{:.2}"#, value / smaller));
    let goal = if goal.is_empty() { String::new() } else { format!(r#","goal":"{goal}""#) };
    println!(
        r#"{{"format":"shoal.bench/1","name":"tube/{name}","slices":{count},"value":{value:.1},"unit":"{unit}"{growth}{goal}}}"#
    );
    *smaller = Some(value);
}

/// The tubes that are asked.
struct World {
    /// A vehicle that goes to and fro and drifts away.
    x_m: Tube<Interval>,
    speed_m_s: Tube<Interval>,
    late_m: Tube<Interval>,
    /// The same trajectory, cut at irregular times.
    irregular_m: Tube<Interval>,
    /// Everywhere, but for one fix at the middle.
    unknown_m: Tube<Interval>,
    growing_m: std::cell::RefCell<Tube<Interval>>,
}

impl World {
    fn new(count: usize) -> World {
        let step_s = END_S / count as f64;
        let time = TimeDomain::uniform(0.0, step_s, count).expect("positive steps");
        let mut random = Random(2);
        let cuts_s = (1..count).map(|index| (index as f64 + 0.8 * random.unit() - 0.4) * step_s);
        let irregular = TimeDomain::new([0.0].into_iter().chain(cuts_s).chain([END_S])).expect("sorted");
        let x_m = Tube::from_function(time.clone(), position);
        let mut unknown_m = Tube::constant(time.clone(), Interval::ENTIRE);
        unknown_m.contract_gate(count / 2, &position(spanning(500.0, 500.0))).expect("a gate");
        World {
            growing_m: std::cell::RefCell::new(Tube::from_function(irregular.clone(), position)),
            late_m: Tube::from_function(time.clone(), |time_s| position(time_s - LATE_S)),
            irregular_m: Tube::from_function(irregular, position),
            speed_m_s: Tube::from_function(time, |time_s| ((time_s * 0.1).cos() * 3.0 + 0.3).inflate(0.01)),
            x_m,
            unknown_m,
        }
    }
}

fn position(time_s: Interval) -> Interval {
    ((time_s * 0.1).sin() * 30.0 + time_s * 0.3).inflate(0.1)
}

fn spanning(one: f64, other: f64) -> Interval {
    Interval::spanning(one, other)
}

fn elapsed_ns(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e9
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
