//! A trajectory after another: `y(t) = x(h(t))`.

use super::asynchronous::{both_or_none, possible_times};
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

/// Contracts three tubes by `y(t) = x(h(t))`: what `x` was at the time that the clock `h` showed at `t`.
///
/// At each `t`, `h` keeps the times at which `x` may be in `y`, and `y` what `x` says over them; times outside the domain of
/// `x` stay possible. `x` is contracted where `h` certainly leads, because it is continuous: between the lowest and the
/// highest gate that it must reach. By search, the cost is that of `n log n` for `n` slices. When nothing is left, all
/// three are empty.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_composition;
/// use shoal_tube::{TimeDomain, Tube};
///
/// // What was logged by a clock that may be 0.1 s off shows how deep the vehicle was.
/// let time = TimeDomain::uniform(0.0, 0.125, 80)?;
/// let mut depth_m = Tube::constant(time.clone(), Interval::new(0.0, 100.0)?);
/// let mut clock_s = Tube::from_function(time.clone(), |t| t.inflate(0.1));
/// let mut logged_m = Tube::from_function(time, |t| (t * 2.0).inflate(0.5));
/// contract_composition(&mut depth_m, &mut clock_s, &mut logged_m)?;
/// assert!(depth_m.at(5.0)?.contains(10.0) && depth_m.at(5.0)?.width() < 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When `h` and `y` are cut at different times.
///
/// Source: seed 001, equation (4.8) and section 5.3.
pub fn contract_composition<T: Enclosure>(
    x: &mut Tube<T>,
    h: &mut Tube<Interval>,
    y: &mut Tube<T>,
) -> Result<Contracted, TubeError> {
    h.check_same_domain(y)?;
    let mut contracted = Contracted::Unchanged;
    for place in h.domain.places() {
        let (of_h, of_y) = (h.set_at(place), y.set_at(place));
        let times_s = of_h & possible_times(x, of_y, of_h);
        // Outside the domain of `x`, nothing is known.
        let values = x.over(times_s).unwrap_or(T::ENTIRE);
        contracted = together(contracted, h.narrow_at(place, times_s));
        contracted = together(contracted, y.narrow_at(place, values));
    }
    if contracted != Contracted::Unchanged {
        h.refresh(0..h.slice_count());
        y.refresh(0..y.slice_count());
    }
    if contracted != Contracted::Empty {
        let reached_s = certainly_reached(h);
        let of_x = x.narrow_everywhere(Direction::Forward, |_, times_s| {
            times_s.is_subset_of(reached_s).then(|| y.over(h.invert(times_s)).ok())?
        });
        contracted = together(contracted, of_x);
    }
    // Twice, because `x` may be the one that is empty.
    contracted = both_or_none(h, y, contracted, Constraint::Composition);
    contracted = both_or_none(x, h, contracted, Constraint::Composition);
    Ok(both_or_none(h, y, contracted, Constraint::Composition))
}

/// The values that every continuous trajectory of a tube takes: between any two gates it takes all values in between.
fn certainly_reached(tube: &Tube<Interval>) -> Interval {
    let lowest = tube.gates.iter().map(|gate| gate.upper()).fold(f64::INFINITY, f64::min);
    let highest = tube.gates.iter().map(|gate| gate.lower()).fold(f64::NEG_INFINITY, f64::max);
    if lowest <= highest { Interval::spanning(lowest, highest) } else { Interval::EMPTY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn time() -> TimeDomain {
        TimeDomain::uniform(0.0, 1.0, 8).unwrap()
    }

    #[test]
    fn a_clock_at_half_speed() {
        let mut x = Tube::constant(time(), Interval::ENTIRE);
        let mut h = Tube::from_function(time(), |t| t * 0.5);
        let mut y = Tube::from_function(time(), |t| t);
        contract_composition(&mut x, &mut h, &mut y).unwrap();
        // Gates are asked for in whole slices, one to each side.
        assert_eq!((x.gate(2), x.slice(2)), (Some(over(3.0, 5.0)), Some(over(3.0, 7.0))));
        // It never leads further than 4 s.
        assert_eq!((x.slice(4), x.gate(5)), (Some(Interval::ENTIRE), Some(Interval::ENTIRE)));
    }

    #[test]
    fn the_clock_is_read_from_what_it_shows() {
        let mut x = Tube::from_function(time(), |t| t);
        let mut h = Tube::constant(time(), over(-1.0, 20.0));
        let mut y = Tube::constant(time(), over(2.25, 2.5));
        contract_composition(&mut x, &mut h, &mut y).unwrap();
        // Times outside the domain are as possible as before.
        assert_eq!(h.slice(3), Some(over(-1.0, 20.0)));
        let mut h = Tube::constant(time(), over(0.0, 8.0));
        contract_composition(&mut x, &mut h, &mut y).unwrap();
        assert_eq!(h.slice(3), Some(over(2.0, 3.0)));
    }

    #[test]
    fn a_contradiction_empties_all_three() {
        let mut x = Tube::from_function(time(), |t| t);
        let mut h = Tube::constant(time(), over(0.0, 8.0));
        let mut y = Tube::constant(time(), over(9.0, 10.0));
        assert_eq!(contract_composition(&mut x, &mut h, &mut y), Ok(Contracted::Empty));
        assert!(x.is_empty() && h.is_empty() && y.is_empty());
        for emptied in [x.emptied(), h.emptied(), y.emptied()] {
            assert_eq!(emptied.unwrap().constraint, Some(Constraint::Composition));
        }
    }
}
