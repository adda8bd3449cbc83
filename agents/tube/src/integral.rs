//! Integrals over times, known exactly or not.

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::summary::{Integral, Part, Step};
use crate::time_domain::exactly;
use crate::tube::Tube;
use shoal_interval::Interval;

impl<T: Enclosure> Tube<T> {
    /// The integral of the trajectory from `start_s` to `end_s` seconds, the negative one from `end_s` to `start_s` if that
    /// is the order.
    ///
    /// Holds the integral of every trajectory in the slices; no smaller set does but for rounding. Empty when a slice that
    /// is touched is empty. In logarithmic time.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 0.5, 20)?, Interval::new(1.0, 2.0)?);
    /// assert_eq!(speed_m_s.integral(0.25, 4.25)?, Interval::new(4.0, 8.0)?);
    /// assert_eq!(speed_m_s.integral(4.25, 0.25)?, Interval::new(-8.0, -4.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When a time is not finite or outside the domain.
    ///
    /// Source: seed 001, equations (4.4) to (4.6).
    pub fn integral(&self, start_s: f64, end_s: f64) -> Result<T, TubeError> {
        if start_s <= end_s {
            Ok(self.integral_over(start_s, end_s)?.whole)
        } else {
            Ok(-self.integral_over(end_s, start_s)?.whole)
        }
    }

    /// The integrals of the trajectory from any time of `start_s` to any of `end_s`, in seconds; empty if there is no time.
    ///
    /// As tight as [`integral`](Tube::integral) when the two intervals of time have at most one time in common. If they
    /// overlap, it is not used that the time of one end says something about the values on the way to the other.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 0.5, 20)?, Interval::new(1.0, 2.0)?);
    /// let travelled_m = speed_m_s.integral_between(Interval::new(0.0, 1.0)?, Interval::new(2.0, 3.0)?)?;
    /// assert_eq!(travelled_m, Interval::new(1.0, 6.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When some of the times are outside the domain.
    pub fn integral_between(&self, start_s: Interval, end_s: Interval) -> Result<T, TubeError> {
        if start_s.is_empty() || end_s.is_empty() {
            return Ok(T::EMPTY);
        }
        if start_s.upper() <= end_s.lower() {
            return self.integral_across(start_s, end_s);
        }
        if end_s.upper() <= start_s.lower() {
            return Ok(-self.integral_across(end_s, start_s)?);
        }
        // Cut at the ends of what they have in common: all parts but that one come one after the other.
        let common = start_s & end_s;
        let mut hull = self.integral_inside(common)?;
        let [starts, ends] = [start_s, end_s].map(|times_s| {
            let [before, after] = times_s.difference(common);
            [before, common, after]
        });
        for (place, &start_s) in starts.iter().enumerate() {
            for (other_place, &end_s) in ends.iter().enumerate() {
                if start_s.is_empty() || end_s.is_empty() || place == other_place {
                    continue;
                }
                hull = hull
                    | if place < other_place {
                        self.integral_across(start_s, end_s)?
                    } else {
                        -self.integral_across(end_s, start_s)?
                    };
            }
        }
        Ok(hull)
    }

    /// The integrals from any time of one interval to any of a later one; they may touch.
    fn integral_across(&self, start_s: Interval, end_s: Interval) -> Result<T, TubeError> {
        let before = self.integral_over(start_s.lower(), start_s.upper())?.to_end;
        let between = self.integral_over(start_s.upper(), end_s.lower())?.whole;
        let after = self.integral_over(end_s.lower(), end_s.upper())?.from_start;
        Ok(before + between + after)
    }

    /// The integrals between any two times of an interval, in both orders: both lie somewhere after its start.
    fn integral_inside(&self, times_s: Interval) -> Result<T, TubeError> {
        let to_end = self.integral_over(times_s.lower(), times_s.upper())?.from_start;
        let to_start = to_end;
        Ok(to_end - to_start)
    }

    /// The integral over `[start_s, end_s]`, and over all parts of it that begin at its start or end at its end.
    pub(crate) fn integral_over(&self, start_s: f64, end_s: f64) -> Result<Integral<T>, TubeError> {
        let range = self.domain.slices_over(Interval::spanning(start_s, end_s))?;
        let mut integral = Integral::zero();
        if start_s == end_s {
            return Ok(integral);
        }
        let area = |index: usize, times_s: Interval| {
            self.slices[index] * (exactly(times_s.upper()) - times_s.lower())
        };
        let times_s = Interval::spanning(start_s, end_s);
        // The first and the last slice may be cut; all between are whole.
        let mut whole = range.clone();
        let first = (self.domain.border_at(range.start) < start_s).then_some(range.start);
        whole.start += usize::from(first.is_some());
        let last =
            (end_s < self.domain.border_at(range.end) && whole.start < range.end).then(|| range.end - 1);
        whole.end -= usize::from(last.is_some());
        if let Some(index) = first {
            integral = integral.and_slice(area(index, self.domain.span_at(index) & times_s));
        }
        let _ = self.summaries.walk::<()>(whole, |part| {
            match part {
                Part::Block(_, summary) => {
                    integral = integral.followed_by(&summary.integral);
                }
                Part::Slices(range) => {
                    for index in range {
                        integral = integral.and_slice(area(index, self.domain.span_at(index)));
                    }
                }
            }
            Step::Past
        });
        if let Some(index) = last {
            integral = integral.and_slice(area(index, self.domain.span_at(index) & times_s));
        }
        if integral.whole.is_empty() {
            return Ok(Integral { whole: T::EMPTY, from_start: T::EMPTY, to_end: T::EMPTY });
        }
        Ok(integral)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    /// Forwards for three seconds, backwards for three more.
    fn there_and_back() -> Tube<Interval> {
        let time = TimeDomain::uniform(0.0, 1.0, 6).unwrap();
        Tube::from_function(time, |time| if time.mid() < 3.0 { over(1.0, 2.0) } else { over(-2.0, -1.0) })
    }

    #[test]
    fn between_exact_times() {
        let v = there_and_back();
        assert_eq!(v.integral(0.0, 6.0), Ok(over(-3.0, 3.0)));
        assert_eq!(v.integral(0.5, 0.75), Ok(over(0.25, 0.5)));
        assert_eq!(v.integral(2.5, 3.5), Ok(over(-0.5, 0.5)));
        assert_eq!(v.integral(4.5, 4.5), Ok(Interval::ZERO));
        assert!(matches!(v.integral(-1.0, 2.0), Err(TubeError::OutsideDomain { .. })));
        assert!(matches!(v.integral(0.0, f64::NAN), Err(TubeError::NotATime { .. })));
        assert!(matches!(v.integral(7.0, 7.0), Err(TubeError::OutsideDomain { .. })));
    }

    #[test]
    fn between_uncertain_times() {
        let v = there_and_back();
        assert_eq!(v.integral_between(Interval::ZERO, over(0.0, 6.0)), Ok(over(-3.0, 6.0)));
        assert_eq!(v.integral_between(Interval::ZERO, over(2.0, 4.0)), Ok(over(1.0, 6.0)));
        assert_eq!(v.integral_between(over(2.0, 4.0), Interval::ZERO), Ok(over(-6.0, -1.0)));
        assert_eq!(v.integral_between(over(0.0, 1.0), over(0.5, 2.0)), Ok(over(-1.0, 4.0)));
        assert_eq!(v.integral_between(over(0.0, 1.0), Interval::EMPTY), Ok(Interval::EMPTY));
        assert!(v.integral_between(over(0.0, 1.0), Interval::ENTIRE).is_err());
    }

    #[test]
    fn nothing_flows_through_an_empty_slice() {
        let mut v = there_and_back();
        v.contract_slice(1, &over(5.0, 6.0)).unwrap();
        assert_eq!(v.integral(0.0, 1.0), Ok(over(1.0, 2.0)));
        assert_eq!(v.integral(0.0, 1.5), Ok(Interval::EMPTY));
        assert_eq!(v.integral_between(Interval::ZERO, over(0.5, 3.0)), Ok(Interval::EMPTY));
    }
}
