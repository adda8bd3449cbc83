//! Where at this time, where over these times.

mod cones;
mod with_derivative;

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::time_domain::Place;
use crate::tube::Tube;
use shoal_interval::Interval;

impl<T: Enclosure> Tube<T> {
    /// What holds the trajectory at `time_s` seconds: the gate on a border, the slice between two.
    ///
    /// # Errors
    /// When the time is not finite or outside the domain.
    pub fn at(&self, time_s: f64) -> Result<T, TubeError> {
        Ok(match self.domain.place_of(time_s)? {
            Place::Gate(index) => self.gates[index],
            Place::Slice(index) => self.slices[index],
        })
    }

    /// What holds the trajectory over all of `times_s`, in seconds: the hull of the slices that are touched, or the gate
    /// when `times_s` is one border. Nothing is asked of the empty set of times, and nothing is in the answer.
    ///
    /// # Errors
    /// When some of the times are outside the domain, where nothing is known.
    ///
    /// Source: seed 001, equation (4.2).
    pub fn over(&self, times_s: Interval) -> Result<T, TubeError> {
        if times_s.is_empty() {
            return Ok(T::EMPTY);
        }
        if times_s.is_point() {
            return self.at(times_s.lower());
        }
        Ok(self.hull_of(self.domain.slices_over(times_s)?))
    }

    /// Whether `value` is where the tube says the trajectory is at `time_s` seconds. For holding a tube against the truth.
    ///
    /// # Errors
    /// When the time is not finite or outside the domain.
    pub fn holds(&self, time_s: f64, value: &T::Point) -> Result<bool, TubeError> {
        Ok(self.at(time_s)?.contains(value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    /// Rises by one each second, from zero, over four slices.
    fn ramp() -> Tube<Interval> {
        Tube::from_function(TimeDomain::uniform(0.0, 1.0, 4).unwrap(), |time| time)
    }

    #[test]
    fn gates_on_borders_slices_between() {
        assert_eq!(ramp().at(2.0), Ok(over(2.0, 2.0)));
        assert_eq!(ramp().at(2.5), Ok(over(2.0, 3.0)));
        assert_eq!(ramp().over(over(1.0, 2.0)), Ok(over(1.0, 2.0)));
        assert_eq!(ramp().over(over(1.0, 1.0)), Ok(over(1.0, 1.0)));
        assert_eq!(ramp().over(over(0.9, 2.1)), Ok(over(0.0, 3.0)));
        assert_eq!(ramp().over(over(1.2, 1.3)), Ok(over(1.0, 2.0)));
        assert_eq!(ramp().over(Interval::EMPTY), Ok(Interval::EMPTY));
        assert_eq!(ramp().holds(1.5, &1.5), Ok(true));
    }

    #[test]
    fn nothing_is_known_outside() {
        assert!(matches!(ramp().at(-0.1), Err(TubeError::OutsideDomain { .. })));
        assert!(matches!(ramp().over(over(3.0, 4.1)), Err(TubeError::OutsideDomain { .. })));
        assert!(matches!(ramp().over(Interval::ENTIRE), Err(TubeError::NotATime { .. })));
    }
}
