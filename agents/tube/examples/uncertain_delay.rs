//! How late does one instrument hear what another heard? The cosine follows the sine a quarter of a turn ahead; the
//! delay between them is found, with certainty, from two tubes and nothing else.
//!
//! The constraint is `x(t) = y(t - tau)` of seed 001, proposition 3, with `tau` in an interval that is contracted with the
//! tubes. As `sin(t) = cos(t - π / 2)`, what is left of `tau` must contain `π / 2`.
//!
//! Run with `cargo run --release -p shoal-tube --example uncertain_delay`.

use pxfm::{f_cos, f_sin};
use shoal_interval::Interval;
use shoal_interval::figure::{Class, figures_folder};
use shoal_tube::contractor::contract_uncertain_delay;
use shoal_tube::figure::{DrawTube, over_time};
use shoal_tube::{TimeDomain, Tube, TubeError};
use std::error::Error;

const STEP_S: f64 = 0.01;

/// The two signals, and what is known of the delay.
struct Signals {
    late: Tube<Interval>,
    early: Tube<Interval>,
    delay_s: Interval,
}

/// Two signals of which `error` is not known, the late one only for the first half of the time.
fn heard(error: f64) -> Result<Signals, TubeError> {
    let time = TimeDomain::uniform(0.0, STEP_S, 1_000)?;
    let late = Tube::from_function(time.clone(), |t| {
        if t.upper() < 5.0 { t.sin().inflate(error) } else { Interval::spanning(-2.0, 2.0) }
    });
    let early = Tube::from_function(time, |t| t.cos().inflate(error));
    Ok(Signals { late, early, delay_s: Interval::spanning(0.0, 3.0) })
}

fn main() -> Result<(), Box<dyn Error>> {
    for error in [0.0, 0.01, 0.05] {
        let before = heard(error)?;
        let mut after = heard(error)?;
        contract_uncertain_delay(&mut after.late, &mut after.early, &mut after.delay_s);
        let slices = after.delay_s.width() / STEP_S;
        println!("signals within {error}: the delay is {:.4} s, {slices:.1} slices wide", after.delay_s);
        if error == 0.05 {
            let span_s = before.late.domain().span();
            over_time(span_s, Interval::centred(0.0, 2.1))?
                .title("A delay, and what it teaches of the late signal")
                .tube(&before.late, Class::Outside)
                .tube(&after.late, Class::Level(3))
                .trajectory(span_s, f_sin)
                .trajectory(span_s, f_cos)
                .legend(Class::Outside, "late signal, before")
                .legend(Class::Level(3), "after")
                .legend(Class::Curve, "sine and cosine")
                .axes("t (s)", "x(t)")
                .save(figures_folder().join("uncertain_delay.svg"))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use shoal_interval::Membership;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_delay_contains_a_quarter_of_a_turn_and_is_narrow() {
        let mut exact = heard(0.0).unwrap();
        contract_uncertain_delay(&mut exact.late, &mut exact.early, &mut exact.delay_s);
        let quarter_turn = Interval::spanning(FRAC_PI_2, FRAC_PI_2.next_up());
        assert!(quarter_turn.is_subset_of(exact.delay_s));
        assert!(exact.delay_s.width() < 3.0 * STEP_S);
        assert_eq!(exact.late.contains(Interval::sin), Membership::Inside);
        assert_eq!(exact.early.contains(Interval::cos), Membership::Inside);
    }

    #[test]
    fn the_delay_tells_what_the_late_signal_was() {
        let before = heard(0.05).unwrap();
        let mut after = heard(0.05).unwrap();
        contract_uncertain_delay(&mut after.late, &mut after.early, &mut after.delay_s);
        assert!(after.delay_s.contains(FRAC_PI_2));
        assert!(after.late.slice(900).unwrap().width() < 0.1 * before.late.slice(900).unwrap().width());
        assert_eq!(after.late.contains(Interval::sin), Membership::Inside);
    }
}
