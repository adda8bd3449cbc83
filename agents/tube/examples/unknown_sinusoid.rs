//! A signal of which only a few properties are known turns out to be the sine: seed 001, section 4.3.1.
//!
//! Known are the range (4.24), two lines between which it is for a quarter of a turn (4.25), that it is symmetric about
//! `(π, 0)` (4.26), that it repeats itself after `2π` (4.27), and that its derivative is itself a quarter of a turn later (4.28), (4.29).
//! Each is a contractor; applied again and again they leave a thin tube around the sine, over 20 s in 2,000 slices.
//!
//! Run with `cargo run --release -p shoal-tube --example unknown_sinusoid`; the figures are those of 4.5.

use pxfm::f_sin;
use shoal_interval::Interval;
use shoal_interval::figure::{Class, figures_folder};
use shoal_tube::contractor::{contract_delay, contract_order};
use shoal_tube::figure::{DrawTube, over_time};
use shoal_tube::{Direction, TimeDomain, Tube, TubeError};
use std::error::Error;
use std::time::Instant;

/// The signal and its derivative.
#[derive(Clone)]
struct Signal {
    a: Tube<Interval>,
    b: Tube<Interval>,
}

impl Signal {
    /// What (4.24) and (4.25) say, by the contractor of order.
    fn new() -> Result<Signal, TubeError> {
        let time = TimeDomain::uniform(0.0, 0.01, 2_000)?;
        let mut a = Tube::constant(time.clone(), Interval::ENTIRE);
        let b = a.clone();
        // The lines hold from pi / 2 to pi: for no slice that is partly outside.
        let stretch = Interval::spanning(Interval::HALF_PI.upper(), Interval::PI.lower());
        let line = |slope: f64, start: f64| {
            Tube::from_function(time.clone(), move |t| {
                if t.is_subset_of(stretch) {
                    (t - Interval::HALF_PI) * slope + start
                } else {
                    Interval::ENTIRE
                }
            })
        };
        let constant = |value| Tube::constant(time.clone(), Interval::spanning(value, value));
        contract_order(&mut constant(-1.0), &mut a)?;
        contract_order(&mut a, &mut constant(1.0))?;
        contract_order(&mut line(-0.7, 0.99), &mut a)?;
        contract_order(&mut a, &mut line(-0.1, 1.01))?;
        Ok(Signal { a, b })
    }

    fn contract_symmetry_and_period(&mut self) -> Result<(), TubeError> {
        self.a.contract_central_symmetry(Interval::PI, Interval::ZERO)?;
        self.a.contract_period(Interval::TWO_PI)?;
        Ok(())
    }

    /// Applies every contractor once.
    fn contract(&mut self) -> Result<(), TubeError> {
        self.contract_symmetry_and_period()?;
        contract_delay(&mut self.b, &mut self.a, -Interval::HALF_PI)?;
        self.a.contract_derivative(&self.b, Direction::Both)?;
        Ok(())
    }

    /// Applies every contractor until nothing worth mentioning changes, and says how often that was.
    fn contract_to_fixpoint(&mut self) -> Result<usize, TubeError> {
        let mut passes = 0;
        loop {
            let before = self.a.volume();
            self.contract()?;
            passes += 1;
            // True of an empty tube too.
            if self.a.volume() >= 0.9999 * before {
                return Ok(passes);
            }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let known = Signal::new()?;
    let mut repeated = known.clone();
    repeated.contract_symmetry_and_period()?;

    let since = Instant::now();
    let mut once = known.clone();
    once.contract()?;
    println!("first pass: {:.1} ms (the seed: 7 ms)", since.elapsed().as_secs_f64() * 1e3);
    let since = Instant::now();
    let mut fixpoint = known.clone();
    let passes = fixpoint.contract_to_fixpoint()?;
    println!("fixpoint, {passes} passes: {:.1} ms (the seed: 55 ms)", since.elapsed().as_secs_f64() * 1e3);

    for (name, signal) in
        [("known", &known), ("repeated", &repeated), ("once", &once), ("fixpoint", &fixpoint)]
    {
        let (width, area) = (signal.a.width(), signal.a.volume());
        println!("{name}: widest {width:.3}, area {area:.3}, {} kB", signal.a.memory_bytes() / 1000);
    }

    let span_s = known.a.domain().span();
    over_time(span_s, Interval::centred(0.0, 1.1))?
        .title("What is left of an unknown signal")
        .tube(&known.a, Class::Outside)
        .tube(&repeated.a, Class::Level(0))
        .tube(&once.a, Class::Level(2))
        .tube(&fixpoint.a, Class::Level(3))
        .trajectory(span_s, f_sin)
        .legend(Class::Outside, "known")
        .legend(Class::Level(0), "symmetric and periodic")
        .legend(Class::Level(2), "after one pass")
        .legend(Class::Level(3), "at the fixpoint")
        .legend(Class::Curve, "sine")
        .axes("t (s)", "a(t)")
        .save(figures_folder().join("001_4_5_unknown_sinusoid.svg"))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use shoal_interval::Membership;

    #[test]
    fn the_sine_is_all_that_is_left() {
        let mut signal = Signal::new().unwrap();
        let known = signal.clone();
        assert_eq!(signal.a.contains(Interval::sin), Membership::Inside);
        signal.contract().unwrap();
        let once = signal.clone();
        assert_eq!(once.a.contains(Interval::sin), Membership::Inside);
        signal.contract_to_fixpoint().unwrap();
        assert_eq!(signal.a.contains(Interval::sin), Membership::Inside);
        assert_eq!(signal.b.contains(Interval::cos), Membership::Inside);
        assert!(signal.a.is_subset_of(&once.a).unwrap() && once.a.is_subset_of(&known.a).unwrap());
        assert!(once.a.volume() < 0.5 * known.a.volume());
        // As measured; the seed prints no width.
        assert!(signal.a.width() < 0.33 && signal.a.volume() < 0.11 * known.a.volume());
    }
}
