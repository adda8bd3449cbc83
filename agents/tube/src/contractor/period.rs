//! A trajectory that repeats itself.

use super::asynchronous::finite;
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

impl<T: Enclosure> Tube<T> {
    /// Removes every trajectory that does not repeat itself after a period `tau` in `period_s`, in seconds: `x(t) = x(t - tau)`
    /// for all `t` for which both times are in the domain. The interval is there for periods that are no `f64`, such as
    /// twice pi.
    ///
    /// What is known of one period is known of all: the tube is gone through forward, which gathers the past, and then
    /// backward, in linear time. Minimal when the period leads from borders to borders.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let mut tide_m = Tube::constant(TimeDomain::uniform(0.0, 0.5, 20)?, Interval::ENTIRE);
    /// tide_m.contract_slice(11, &Interval::new(-1.0, 2.0)?)?;
    /// tide_m.contract_period(Interval::point(2.0)?)?;
    /// assert_eq!(tide_m.slice(3), Some(Interval::new(-1.0, 2.0)?));
    /// assert_eq!(tide_m.slice(19), Some(Interval::new(-1.0, 2.0)?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the period is empty or unbounded.
    ///
    /// Source: seed 001, proposition 3, special case.
    pub fn contract_period(&mut self, period_s: Interval) -> Result<Contracted, TubeError> {
        let period_s = finite(period_s)?.abs();
        let forward =
            self.narrow_everywhere(Direction::Forward, |tube, times_s| tube.looked_over(times_s - period_s));
        let backward =
            self.narrow_everywhere(Direction::Backward, |tube, times_s| tube.looked_over(times_s + period_s));
        Ok(self.blamed(together(forward, backward), Constraint::Periodicity))
    }
}
