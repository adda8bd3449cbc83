//! Constraints between values of one time, on trajectories: applied to every slice and to every gate.

use crate::contraction::together;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::time_domain::Place;
use crate::tube::Tube;
use shoal_interval::IntervalBox;
use shoal_interval::contractor::{Contracted, Contractor};

impl<const N: usize> Tube<IntervalBox<N>> {
    /// Removes what `contractor` removes, from every slice and from every gate: the constraint holds at all times.
    ///
    /// Minimal, slice by slice and gate by gate, when the contractor is.
    ///
    /// ```
    /// use shoal_interval::contractor::Ring;
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// // A vehicle on a 100 m tether.
    /// let quadrant = IntervalBox::from([Interval::NON_NEGATIVE; 2]);
    /// let mut position_m = Tube::constant(TimeDomain::uniform(0.0, 1.0, 9)?, quadrant);
    /// position_m.contract_with(&Ring::new(IntervalBox::from([Interval::ZERO; 2]), Interval::new(0.0, 100.0)?));
    /// assert_eq!(position_m.at(3.5)?[0].upper(), 100.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Source: seed 001, section 4.2.3, synchronous constraints.
    pub fn contract_with(&mut self, contractor: &impl Contractor<N>) -> Contracted {
        let contract = |[set]: &mut [IntervalBox<N>; 1]| *set = contractor.contract(*set);
        lifted([self], contract, Constraint::Algebraic)
    }
}

/// Contracts several tubes of one kind by a constraint between their values of one time. `contract` narrows, in place, what
/// holds the trajectories over the same times; what it adds is taken away again, and if one set becomes empty, all do.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::contract_product;
/// use shoal_tube::contractor::lift;
/// use shoal_tube::{TimeDomain, Tube};
///
/// // power = voltage * current
/// let time = TimeDomain::uniform(0.0, 1.0, 5)?;
/// let mut voltage_v = Tube::constant(time.clone(), Interval::new(16.0, 32.0)?);
/// let mut current_a = Tube::constant(time.clone(), Interval::NON_NEGATIVE);
/// let mut power_w = Tube::from_function(time, |t| t * 16.0);
/// lift([&mut voltage_v, &mut current_a, &mut power_w], |[voltage, current, power]| {
///     contract_product(voltage, current, power);
/// })?;
/// assert_eq!(current_a.at(2.0)?, Interval::new(1.0, 2.0)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tubes are not all cut at the same times.
///
/// Source: seed 001, section 4.2.3, synchronous constraints.
pub fn lift<T: Enclosure, const M: usize>(
    tubes: [&mut Tube<T>; M],
    contract: impl FnMut(&mut [T; M]),
) -> Result<Contracted, TubeError> {
    for index in 1..M {
        tubes[0].check_same_domain(&*tubes[index])?;
    }
    Ok(lifted(tubes, contract, Constraint::Algebraic))
}

/// Contracts two tubes of different kinds, such as boxes and numbers, by a constraint between their values of one time; as
/// [`lift`].
///
/// ```
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::contractor::lift_pair;
/// use shoal_tube::{TimeDomain, Tube};
///
/// let time = TimeDomain::uniform(0.0, 1.0, 5)?;
/// let mut position_m = Tube::constant(time.clone(), IntervalBox::<3>::ENTIRE);
/// let mut depth_m = Tube::constant(time, Interval::new(10.0, 10.5)?);
/// lift_pair(&mut position_m, &mut depth_m, |position, depth| {
///     *depth = *depth & -position[2];
///     position[2] = position[2] & -*depth;
/// })?;
/// assert_eq!(position_m.at(2.5)?[2], Interval::new(-10.5, -10.0)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the tubes are cut at different times.
pub fn lift_pair<T: Enclosure, U: Enclosure>(
    x: &mut Tube<T>,
    y: &mut Tube<U>,
    mut contract: impl FnMut(&mut T, &mut U),
) -> Result<Contracted, TubeError> {
    x.check_same_domain(y)?;
    let mut contracted = Contracted::Unchanged;
    for place in x.domain.places() {
        let (mut own, mut others) = (x.set_at(place), y.set_at(place));
        if !own.is_empty() && !others.is_empty() {
            contract(&mut own, &mut others);
        }
        if own.is_empty() || others.is_empty() {
            (own, others) = (T::EMPTY, U::EMPTY);
        }
        contracted = together(contracted, x.narrow_at(place, own));
        contracted = together(contracted, y.narrow_at(place, others));
    }
    if contracted != Contracted::Unchanged {
        x.refresh(0..x.slice_count());
        y.refresh(0..y.slice_count());
    }
    x.blamed(contracted, Constraint::Algebraic);
    Ok(y.blamed(contracted, Constraint::Algebraic))
}

/// [`lift`] on tubes that are cut at the same times.
pub(super) fn lifted<T: Enclosure, const M: usize>(
    tubes: [&mut Tube<T>; M],
    mut contract: impl FnMut(&mut [T; M]),
    constraint: Constraint,
) -> Contracted {
    let mut contracted = Contracted::Unchanged;
    let Some(places) = tubes.first().map(|tube| tube.domain.places()) else {
        return contracted;
    };
    for place in places {
        let mut sets: [T; M] = std::array::from_fn(|index| tubes[index].set_at(place));
        if !sets.iter().any(T::is_empty) {
            contract(&mut sets);
        }
        if sets.iter().any(T::is_empty) {
            sets = [T::EMPTY; M];
        }
        for index in 0..M {
            contracted = together(contracted, tubes[index].narrow_at(place, sets[index]));
        }
    }
    for tube in tubes {
        if contracted != Contracted::Unchanged {
            tube.refresh(0..tube.slice_count());
        }
        tube.blamed(contracted, constraint);
    }
    contracted
}

impl<T: Enclosure> Tube<T> {
    #[inline]
    pub(super) fn set_at(&self, place: Place) -> T {
        match place {
            Place::Slice(index) => self.slices[index],
            Place::Gate(index) => self.gates[index],
        }
    }

    #[inline]
    pub(super) fn narrow_at(&mut self, place: Place, value: T) -> Contracted {
        match place {
            Place::Slice(index) => self.narrow_slice(index, value),
            Place::Gate(index) => self.narrow_gate(index, value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;
    use shoal_interval::Interval;
    use shoal_interval::contractor::contract_sum;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn what_a_closure_adds_is_taken_away() {
        let mut x = Tube::constant(TimeDomain::uniform(0.0, 1.0, 3).unwrap(), over(0.0, 1.0));
        let widen = |[set]: &mut [Interval; 1]| *set = set.inflate(1.0);
        assert_eq!(lift([&mut x], widen), Ok(Contracted::Unchanged));
    }

    #[test]
    fn one_empty_slice_empties_all_there() {
        let time = TimeDomain::uniform(0.0, 1.0, 3).unwrap();
        let mut x = Tube::from_function(time.clone(), |t| t);
        let mut y = Tube::constant(time.clone(), over(0.0, 1.0));
        let mut sum = Tube::constant(time, over(0.0, 2.5));
        let add = |[x, y, z]: &mut [Interval; 3]| {
            contract_sum(x, y, z);
        };
        assert_eq!(lift([&mut x, &mut y, &mut sum], add), Ok(Contracted::Empty));
        let emptied = y.emptied().unwrap();
        assert_eq!((emptied.place, emptied.constraint), (Place::Gate(3), Some(Constraint::Algebraic)));
        assert_eq!((x.emptied(), sum.emptied()), (Some(emptied), Some(emptied)));
        let mut other = Tube::constant(TimeDomain::uniform(0.0, 1.0, 4).unwrap(), Interval::ONE);
        assert_eq!(lift([&mut x, &mut other], |_| {}), Err(TubeError::DifferentDomains));
    }
}
