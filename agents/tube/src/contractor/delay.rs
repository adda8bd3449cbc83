//! A trajectory that follows another after a known delay.

use super::asynchronous::{both_or_none, finite};
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

/// Contracts two tubes by `x(t) = y(t - tau)`, with a delay `tau` of any sign that is in `delay_s`, in seconds.
///
/// The interval is there for delays that are no `f64`, such as half of pi; it is not contracted. For a delay that is to be
/// found there is [`contract_uncertain_delay`](super::contract_uncertain_delay).
///
/// The tubes may be cut at any times: a slice keeps what the other tube says over the shifted times, all slices that these
/// touch. Nothing is removed from slices of which the shifted times are not all in the domain of the other tube. In
/// linear time. Minimal when the shift leads from borders to borders.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_delay;
/// use shoal_tube::{TimeDomain, Tube};
///
/// let time = TimeDomain::uniform(0.0, 0.5, 10)?;
/// let mut echo = Tube::constant(time.clone(), Interval::ENTIRE);
/// let mut call = Tube::from_function(time, |t| t.sqr());
/// contract_delay(&mut echo, &mut call, Interval::point(1.5)?)?;
/// assert_eq!(echo.at(3.5)?, Interval::point(4.0)?);
/// assert_eq!(echo.at(0.5)?, Interval::ENTIRE);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the delay is empty or unbounded.
///
/// Source: seed 001, proposition 3, equation (4.18).
pub fn contract_delay<T: Enclosure>(
    x: &mut Tube<T>,
    y: &mut Tube<T>,
    delay_s: Interval,
) -> Result<Contracted, TubeError> {
    let delay_s = finite(delay_s)?;
    let mut contracted = Contracted::Unchanged;
    if !x.is_empty() && !y.is_empty() {
        contracted = x.narrow_everywhere(Direction::Forward, |_, times_s| y.looked_over(times_s - delay_s));
        let of_y = y.narrow_everywhere(Direction::Forward, |_, times_s| x.looked_over(times_s + delay_s));
        contracted = together(contracted, of_y);
    }
    Ok(both_or_none(x, y, contracted, Constraint::Delay))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::{TimeDomain, exactly};

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn ramp() -> Tube<Interval> {
        Tube::from_function(TimeDomain::uniform(0.0, 1.0, 6).unwrap(), |time| time)
    }

    #[test]
    fn a_delay_between_borders_takes_in_two_slices() {
        let mut late = Tube::constant(TimeDomain::uniform(0.0, 1.0, 6).unwrap(), Interval::ENTIRE);
        contract_delay(&mut late, &mut ramp(), exactly(1.5)).unwrap();
        assert_eq!((late.slice(1), late.slice(2)), (Some(Interval::ENTIRE), Some(over(0.0, 2.0))));
        assert_eq!((late.gate(1), late.gate(2)), (Some(Interval::ENTIRE), Some(over(0.0, 1.0))));
        assert_eq!(late.last_gate(), over(4.0, 5.0));
    }

    #[test]
    fn a_negative_delay_is_an_advance() {
        let mut early = Tube::constant(TimeDomain::uniform(0.0, 1.0, 6).unwrap(), Interval::ENTIRE);
        contract_delay(&mut early, &mut ramp(), exactly(-2.0)).unwrap();
        assert_eq!((early.slice(0), early.slice(4)), (Some(over(2.0, 3.0)), Some(Interval::ENTIRE)));
    }

    #[test]
    fn contradictions_and_bad_delays() {
        let mut late = &ramp() + 1.0;
        assert!(contract_delay(&mut late, &mut ramp(), exactly(f64::NAN)).is_err());
        assert_eq!(contract_delay(&mut late, &mut ramp(), exactly(1e300)), Ok(Contracted::Unchanged));
        let mut call = ramp();
        assert_eq!(contract_delay(&mut late, &mut call, exactly(2.0)), Ok(Contracted::Empty));
        assert_eq!(
            late.emptied().unwrap().to_string(),
            "slice 2, from 2 s to 3 s, is empty: emptied by a delay"
        );
        assert!(call.is_empty());
    }
}
