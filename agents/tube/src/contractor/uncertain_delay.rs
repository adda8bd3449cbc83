//! A trajectory that follows another after an uncertain delay, which is contracted too.

use super::asynchronous::{both_or_none, possible_times};
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::Constraint;
use crate::time_domain::exactly;
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

/// How often all gates are asked for the delay, at most.
const PASSES: usize = 8;
/// The share of its width that the delay must lose in a pass for another one.
const WORTHWHILE: f64 = 0.01;

/// Contracts two tubes and a delay by `x(t) = y(t - tau)`, with one unknown `tau` of `delay_s`, in seconds of any sign.
///
/// Each gate of one tube is looked for in the other, which leaves the delays between the first and the last time where it is
/// found; delays that lead out of the domain stay possible. Then slices and gates of each tube keep what the other tube
/// says over the times that the remaining delays lead to. All times are found by search, so the cost is that of
/// `n log n` for `n` slices. When nothing is left, delay and tubes are empty.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_uncertain_delay;
/// use shoal_tube::{TimeDomain, Tube};
///
/// // sin(t) = cos(t - pi / 2)
/// let time = TimeDomain::uniform(0.0, 0.01, 1000)?;
/// let mut x = Tube::from_function(time.clone(), Interval::sin);
/// let mut y = Tube::from_function(time, Interval::cos);
/// let mut delay_s = Interval::new(0.0, 3.0)?;
/// contract_uncertain_delay(&mut x, &mut y, &mut delay_s);
/// assert!(delay_s.contains(std::f64::consts::FRAC_PI_2) && delay_s.width() < 0.03);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: seed 001, proposition 3, equation (4.18), with the delay in an interval.
pub fn contract_uncertain_delay<T: Enclosure>(
    x: &mut Tube<T>,
    y: &mut Tube<T>,
    delay_s: &mut Interval,
) -> Contracted {
    let mut contracted = Contracted::Unchanged;
    if x.is_empty() || y.is_empty() {
        *delay_s = Interval::EMPTY;
    }
    for _ in 0..PASSES {
        let before_s = *delay_s;
        let refuted_s = contract_delay_alone(x, y, delay_s);
        if delay_s.is_empty() {
            x.empty_near(refuted_s.mid(), Constraint::Delay);
            contracted = Contracted::Empty;
            break;
        }
        if *delay_s != before_s {
            contracted = Contracted::Narrowed;
        }
        let left = delay_s.width() / before_s.width();
        if *delay_s == before_s || left > 1.0 - WORTHWHILE {
            break;
        }
    }
    if contracted != Contracted::Empty {
        let delay_s = *delay_s;
        let mut earlier = Sliding::new(y);
        let of_x = x.narrow_everywhere(Direction::Forward, |_, times_s| earlier.over(times_s - delay_s));
        let mut later = Sliding::new(x);
        let of_y = y.narrow_everywhere(Direction::Forward, |_, times_s| later.over(times_s + delay_s));
        contracted = together(contracted, together(of_x, of_y));
    }
    let contracted = both_or_none(x, y, contracted, Constraint::Delay);
    if contracted == Contracted::Empty {
        *delay_s = Interval::EMPTY;
    }
    contracted
}

/// Asks every gate of both tubes which delays are possible. Returns the time of the gate that leaves none, if one does.
fn contract_delay_alone<T: Enclosure>(x: &Tube<T>, y: &Tube<T>, delay_s: &mut Interval) -> Interval {
    for (index, &gate) in x.gates.iter().enumerate() {
        let time_s = exactly(x.domain.border_at(index));
        let passing_s = possible_times(y, gate, time_s - *delay_s);
        *delay_s = *delay_s & (time_s - passing_s);
        if delay_s.is_empty() {
            return time_s;
        }
    }
    for (index, &gate) in y.gates.iter().enumerate() {
        let time_s = exactly(y.domain.border_at(index));
        let passing_s = possible_times(x, gate, time_s + *delay_s);
        *delay_s = *delay_s & (passing_s - time_s);
        if delay_s.is_empty() {
            return time_s;
        }
    }
    Interval::EMPTY
}

/// What a tube says over times that move forward. Each slice is looked at twice, however long the times are.
struct Sliding<'a, T: Enclosure> {
    tube: &'a Tube<T>,
    /// The hulls of the slices from each to [`middle`](Sliding::middle), the longest last.
    older: Vec<T>,
    middle: usize,
    /// The hull of the slices from the middle to the end.
    newer: T,
    end: usize,
}

impl<'a, T: Enclosure> Sliding<'a, T> {
    fn new(tube: &'a Tube<T>) -> Sliding<'a, T> {
        Sliding { tube, older: Vec::new(), middle: 0, newer: T::EMPTY, end: 0 }
    }

    /// [`over`](Tube::over); `None` outside the domain. Times that move back are allowed, but cost a look at each slice.
    fn over(&mut self, times_s: Interval) -> Option<T> {
        if times_s.is_empty() || times_s.is_point() {
            return self.tube.over(times_s).ok();
        }
        let range = self.tube.domain.slices_over(times_s).ok()?;
        let first = self.middle - self.older.len();
        if !(first..self.middle).contains(&range.start) || range.end < self.end {
            let mut hull = T::EMPTY;
            self.older.clear();
            self.older.extend(self.tube.slices.range(range.clone()).rev().map(|&slice| {
                hull = hull | slice;
                hull
            }));
            (self.middle, self.newer, self.end) = (range.end, T::EMPTY, range.end);
        }
        self.older.truncate(self.middle - range.start);
        for &slice in self.tube.slices.range(self.end..range.end) {
            self.newer = self.newer | slice;
        }
        self.end = range.end;
        self.older.last().map(|&older| older | self.newer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;
    use std::f64::consts::FRAC_PI_2;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn waves(count: usize) -> (Tube<Interval>, Tube<Interval>) {
        let time = TimeDomain::uniform(0.0, 10.0 / count as f64, count).unwrap();
        (Tube::from_function(time.clone(), Interval::sin), Tube::from_function(time, Interval::cos))
    }

    #[test]
    fn a_quarter_turn_is_found_to_three_slices() {
        for count in [100, 1_000, 10_000] {
            let (mut sin, mut cos) = waves(count);
            let mut delay_s = over(0.0, 3.0);
            assert_eq!(contract_uncertain_delay(&mut sin, &mut cos, &mut delay_s), Contracted::Narrowed);
            assert!(delay_s.contains(FRAC_PI_2) && delay_s.width() < 3.0 * 10.0 / count as f64, "{delay_s}");
        }
    }

    #[test]
    fn a_part_of_one_tube_is_learnt_from_the_other() {
        let (sin, mut cos) = waves(1_000);
        let mut late = Tube::constant(sin.domain().clone(), over(-1.0, 1.0));
        for index in 0..500 {
            late.contract_slice(index, &sin.slice(index).unwrap()).unwrap();
        }
        let mut delay_s = over(0.0, 3.0);
        contract_uncertain_delay(&mut late, &mut cos, &mut delay_s);
        assert!(delay_s.contains(FRAC_PI_2) && delay_s.width() < 0.03);
        assert!(late.slice(900).unwrap().width() < 0.1);
        assert!(!(late.slice(900).unwrap() & sin.slice(900).unwrap()).is_empty());
    }

    #[test]
    fn delays_out_of_the_domain_stay_possible() {
        let (mut sin, mut cos) = waves(100);
        let mut delay_s = over(-100.0, -9.0);
        contract_uncertain_delay(&mut sin, &mut cos, &mut delay_s);
        assert_eq!(delay_s.lower(), -100.0);
        assert!(!sin.is_empty());
        let mut unknown_s = Interval::ENTIRE;
        assert_eq!(contract_uncertain_delay(&mut sin, &mut cos, &mut unknown_s), Contracted::Unchanged);
    }

    #[test]
    fn a_contradiction_empties_all() {
        let (mut sin, mut cos) = waves(100);
        let mut delay_s = over(2.5, 2.6);
        assert_eq!(contract_uncertain_delay(&mut sin, &mut cos, &mut delay_s), Contracted::Empty);
        assert!(delay_s.is_empty() && cos.is_empty());
        assert_eq!(sin.emptied().and_then(|emptied| emptied.constraint), Some(Constraint::Delay));
        let (mut sin, mut cos) = waves(10);
        let mut no_delay = Interval::EMPTY;
        assert_eq!(contract_uncertain_delay(&mut sin, &mut cos, &mut no_delay), Contracted::Empty);
        assert!(sin.is_empty() && cos.is_empty());
    }

    #[test]
    fn sliding_times_are_asked_as_any_others() {
        let (sin, _) = waves(100);
        let mut sliding = Sliding::new(&sin);
        for width_s in [0.05, 0.1, 0.73, 4.0] {
            for step in 0..120 {
                let start_s = f64::from(step) * 0.09;
                let times_s = over(start_s, start_s + width_s);
                assert_eq!(sliding.over(times_s), sin.over(times_s).ok(), "{times_s}");
            }
        }
        assert_eq!(sliding.over(over(2.0, 2.0)), sin.over(over(2.0, 2.0)).ok());
    }
}
