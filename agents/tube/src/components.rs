//! A tube of vectors as a tube of each coordinate, and back.

use crate::error::TubeError;
use crate::tube::Tube;
use shoal_interval::{Interval, IntervalBox};

impl<const N: usize> Tube<IntervalBox<N>> {
    /// The tube of one coordinate of the trajectory.
    ///
    /// # Panics
    /// Like any index, when there is no such axis.
    pub fn component(&self, axis: usize) -> Tube<Interval> {
        self.map(|set| set[axis])
    }

    /// The tubes of all coordinates of the trajectory, in the order of the axes; they share the domain.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let time = TimeDomain::uniform(0.0, 1.0, 5)?;
    /// let position_m = Tube::from_function(time, |t| IntervalBox::from([t, t.sqr()]));
    /// let [x_m, y_m] = position_m.components();
    /// assert_eq!(y_m.slice(1), Some(Interval::new(1.0, 4.0)?));
    /// assert_eq!(Tube::from_components([&x_m, &y_m])?, position_m);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn components(&self) -> [Tube<Interval>; N] {
        std::array::from_fn(|axis| self.component(axis))
    }

    /// The tube of the vectors with these coordinates. It is empty where a coordinate is.
    ///
    /// # Errors
    /// When the tubes are cut at different times, or there is none to take the times from (`N` is zero).
    pub fn from_components(components: [&Tube<Interval>; N]) -> Result<Tube<IntervalBox<N>>, TubeError> {
        let Some(first) = components.first() else {
            return Err(TubeError::NoBorder);
        };
        for other in components {
            first.check_same_domain(other)?;
        }
        let slice = |index: usize| IntervalBox::from(components.map(|component| component.slices[index]));
        let gate = |index: usize| IntervalBox::from(components.map(|component| component.gates[index]));
        let (slices, gates) = (first.slices.len(), first.gates.len());
        Ok(Tube::assembled(
            first.domain.clone(),
            (0..slices).map(slice).collect(),
            (0..gates).map(gate).collect(),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    #[test]
    fn one_empty_coordinate_empties_the_vector() {
        let time = TimeDomain::uniform(0.0, 1.0, 3).unwrap();
        let x = Tube::constant(time, Interval::ONE);
        let mut y = x.clone();
        y.contract_gate(2, &Interval::ZERO).unwrap();
        let both = Tube::from_components([&x, &y]).unwrap();
        assert_eq!(both.gate(2), Some(IntervalBox::EMPTY));
        assert_eq!(both.first_empty(), y.first_empty());
        let other = Tube::constant(TimeDomain::uniform(0.0, 1.5, 3).unwrap(), Interval::ONE);
        assert_eq!(Tube::from_components([&x, &other]), Err(TubeError::DifferentDomains));
        assert_eq!(Tube::from_components([]), Err(TubeError::NoBorder));
    }
}
