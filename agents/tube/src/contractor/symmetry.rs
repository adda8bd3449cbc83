//! A trajectory that is its own mirror image.

use super::asynchronous::finite;
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::time_domain::Place;
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

impl<T: Enclosure> Tube<T> {
    /// Removes every trajectory that is not symmetric in time about an axis `tau` in `axis_s`, in seconds:
    /// `x(tau + t) = x(tau - t)`. With the axis zero the trajectory is even. The interval is there for axes that are no
    /// `f64`, such as pi.
    ///
    /// Times whose mirror image is outside the domain are left alone. Minimal when borders are mirrored to borders.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let mut x = Tube::constant(TimeDomain::uniform(-2.0, 0.5, 8)?, Interval::ENTIRE);
    /// x.contract_slice(7, &Interval::ONE)?;
    /// x.contract_axial_symmetry(Interval::ZERO)?;
    /// assert_eq!(x.slice(0), Some(Interval::ONE));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the axis is empty or unbounded.
    ///
    /// Source: seed 001, proposition 4, equation (4.19).
    pub fn contract_axial_symmetry(&mut self, axis_s: Interval) -> Result<Contracted, TubeError> {
        let twice_s = finite(axis_s)? + axis_s;
        let contracted =
            self.narrow_everywhere(Direction::Both, |tube, times_s| tube.looked_over(twice_s - times_s));
        Ok(self.blamed(contracted, Constraint::Symmetry))
    }

    /// Removes every trajectory that is not its own image through a point, `c` of `centre` at a time `tau` of `axis_s`:
    /// `x(tau + t) - c = c - x(tau - t)`, and so `x(tau) = c`. With both zero the trajectory is odd. The centre may be
    /// known only as a set.
    ///
    /// Times whose image is outside the domain are left alone.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let mut x = Tube::constant(TimeDomain::uniform(-2.0, 0.5, 8)?, Interval::ENTIRE);
    /// x.contract_slice(7, &Interval::new(2.0, 3.0)?)?;
    /// x.contract_central_symmetry(Interval::ZERO, Interval::ONE)?;
    /// assert_eq!(x.slice(0), Some(Interval::new(-1.0, 0.0)?));
    /// assert_eq!(x.gate(4), Some(Interval::ONE));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the axis is empty or unbounded.
    ///
    /// Source: seed 001, proposition 5, equation (4.21).
    pub fn contract_central_symmetry(
        &mut self,
        axis_s: Interval,
        centre: T,
    ) -> Result<Contracted, TubeError> {
        let twice_s = finite(axis_s)? + axis_s;
        let twice = centre * (Interval::ONE + 1.0);
        let at_axis = match self.domain.place_of(axis_s.lower()) {
            Ok(Place::Gate(index)) if axis_s.is_point() => self.narrow_gate(index, centre),
            _ if self.looked_over(axis_s).is_some_and(|known| known.is_disjoint_from(&centre)) => {
                self.empty_near(axis_s.mid(), Constraint::Symmetry);
                Contracted::Empty
            }
            _ => Contracted::Unchanged,
        };
        let mirrored = self.narrow_everywhere(Direction::Both, |tube, times_s| {
            Some(twice - tube.looked_over(twice_s - times_s)?)
        });
        Ok(self.blamed(together(at_axis, mirrored), Constraint::Symmetry))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::{TimeDomain, exactly};

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn only_times_with_an_image_are_contracted() {
        let mut x = Tube::from_function(TimeDomain::uniform(0.0, 1.0, 6).unwrap(), |time| time.inflate(3.0));
        x.contract_axial_symmetry(exactly(2.0)).unwrap();
        assert_eq!((x.slice(0), x.slice(3)), (Some(over(0.0, 4.0)), Some(over(0.0, 4.0))));
        assert_eq!(x.slice(4), Some(over(1.0, 8.0)));
        assert_eq!(x.contract_axial_symmetry(exactly(2.0)), Ok(Contracted::Unchanged));
        assert!(x.contract_axial_symmetry(Interval::ENTIRE).is_err());
        assert_eq!(x.contract_axial_symmetry(exactly(f64::MAX)), Ok(Contracted::Unchanged));
    }

    #[test]
    fn the_trajectory_passes_the_centre() {
        let time = TimeDomain::uniform(-2.0, 1.0, 4).unwrap();
        let mut x = Tube::constant(time, over(-1.0, 3.0));
        x.contract_slice(3, &over(1.0, 2.0)).unwrap();
        x.contract_central_symmetry(Interval::ZERO, Interval::ZERO).unwrap();
        assert_eq!((x.slice(0), x.gate(2)), (Some(over(-1.0, -1.0)), Some(Interval::ZERO)));
        assert_eq!(x.contract_central_symmetry(exactly(0.5), over(5.0, 6.0)), Ok(Contracted::Empty));
        let emptied = x.emptied().unwrap();
        assert_eq!((emptied.place, emptied.constraint), (Place::Slice(2), Some(Constraint::Symmetry)));
    }

    #[test]
    fn an_axis_between_two_numbers_loses_nothing() {
        let time = TimeDomain::uniform(0.0, 0.125, 48).unwrap();
        let mut sine = Tube::from_function(time, Interval::sin);
        let before = sine.clone();
        sine.contract_central_symmetry(Interval::PI, Interval::ZERO).unwrap();
        assert!(sine.contains(Interval::sin) == shoal_interval::Membership::Inside);
        assert!(sine.is_subset_of(&before).unwrap());
        let mut above = &sine + 0.5;
        assert_eq!(above.contract_central_symmetry(Interval::PI, Interval::ZERO), Ok(Contracted::Empty));
    }
}
