//! A tube that grows at one end and is forgotten at the other, and what is learnt about it on the way.

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::tube::Tube;
use shoal_interval::contractor::Contracted;

impl<T: Enclosure> Tube<T> {
    /// Adds a slice that ends at `end_s` seconds, with the gate at its end.
    ///
    /// The gates on both of its sides keep only what is inside the slice.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::Tube;
    ///
    /// let mut x_m = Tube::starting_at(0.0, Interval::ZERO)?;
    /// x_m.append(0.5, Interval::new(-0.1, 1.1)?, Interval::new(0.9, 1.1)?)?;
    /// assert_eq!(x_m.at(0.5)?, Interval::new(0.9, 1.1)?);
    /// assert_eq!(x_m.at(0.2)?, Interval::new(-0.1, 1.1)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the time is not finite or not after the end of the tube; the tube is then unchanged.
    pub fn append(&mut self, end_s: f64, slice: T, output_gate: T) -> Result<(), TubeError> {
        self.domain.append(end_s)?;
        self.slices.push_back(slice);
        self.gates.push_back(output_gate);
        self.narrow_gates_of(self.slice_count() - 1);
        Ok(())
    }

    /// Forgets the `count` oldest slices with their input gates, or all if there are fewer; the last gate always stays. The
    /// slice that had index `count` has index 0 afterwards.
    pub fn drop_front(&mut self, count: usize) {
        let count = count.min(self.slice_count());
        self.domain.drop_front(count);
        self.slices.drain(..count);
        self.gates.drain(..count);
    }

    /// Forgets all slices that end at `time_s` seconds or before, and returns how many they were.
    pub fn drop_before(&mut self, time_s: f64) -> usize {
        let count = self.domain.borders_s().skip(1).take_while(|&end_s| end_s <= time_s).count();
        self.drop_front(count);
        count
    }

    /// Removes from gate `index` everything that is not in `value`. Other gates and slices wait for a contractor such as
    /// [`contract_derivative`](Tube::contract_derivative) to carry it on.
    ///
    /// # Errors
    /// When there is no such gate.
    pub fn contract_gate(&mut self, index: usize, value: &T) -> Result<Contracted, TubeError> {
        let count = self.gates.len();
        let gate = self.gates.get_mut(index).ok_or(TubeError::NoSuchGate { index, count })?;
        Ok(narrow(gate, *value))
    }

    /// Removes from slice `index`, and from the gates on both of its sides, everything that is not in `value`.
    ///
    /// # Errors
    /// When there is no such slice.
    pub fn contract_slice(&mut self, index: usize, value: &T) -> Result<Contracted, TubeError> {
        let count = self.slices.len();
        let slice = self.slices.get_mut(index).ok_or(TubeError::NoSuchSlice { index, count })?;
        let of_slice = narrow(slice, *value);
        let of_input = narrow(&mut self.gates[index], *value);
        let of_output = narrow(&mut self.gates[index + 1], *value);
        Ok(together(together(of_slice, of_input), of_output))
    }
}

/// Intersects a set with another in place.
pub(crate) fn narrow<T: Enclosure>(set: &mut T, other: T) -> Contracted {
    let before = *set;
    *set = before & other;
    if set.is_empty() {
        Contracted::Empty
    } else if *set == before {
        Contracted::Unchanged
    } else {
        Contracted::Narrowed
    }
}

/// What two contractions on the same tube did in all.
pub(crate) fn together(one: Contracted, other: Contracted) -> Contracted {
    match (one, other) {
        (Contracted::Empty, _) | (_, Contracted::Empty) => Contracted::Empty,
        (Contracted::Unchanged, Contracted::Unchanged) => Contracted::Unchanged,
        _ => Contracted::Narrowed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shoal_interval::Interval;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn three_slices() -> Tube<Interval> {
        let mut tube = Tube::starting_at(0.0, over(0.0, 1.0)).unwrap();
        for index in 0..3 {
            let start = f64::from(index);
            tube.append(start + 1.0, over(start, start + 2.0), over(start + 1.0, start + 2.0)).unwrap();
        }
        tube
    }

    #[test]
    fn gates_stay_inside_both_slices() {
        let mut tube = Tube::starting_at(0.0, over(0.0, 1.0)).unwrap();
        tube.append(1.0, over(0.5, 2.0), Interval::ENTIRE).unwrap();
        tube.append(2.0, over(1.0, 3.0), over(2.0, 9.0)).unwrap();
        assert_eq!(tube.input_gate(0), Some(over(0.5, 1.0)));
        assert_eq!(tube.output_gate(0), Some(over(1.0, 2.0)));
        assert_eq!(tube.last_gate(), over(2.0, 3.0));
        assert_eq!((tube.slice(2), tube.input_gate(2), tube.output_gate(2)), (None, None, None));
    }

    #[test]
    fn a_bad_slice_changes_nothing() {
        let mut tube = three_slices();
        let before = tube.clone();
        assert!(tube.append(3.0, Interval::ENTIRE, Interval::ENTIRE).is_err());
        assert!(tube.append(f64::NAN, Interval::ENTIRE, Interval::ENTIRE).is_err());
        assert!(tube.contract_gate(4, &Interval::ZERO).is_err());
        assert!(tube.contract_slice(3, &Interval::ZERO).is_err());
        assert_eq!(tube, before);
    }

    #[test]
    fn the_past_is_forgotten_whole_slices_at_a_time() {
        let mut tube = three_slices();
        assert_eq!(tube.drop_before(0.9), 0);
        assert_eq!(tube.drop_before(1.5), 1);
        assert_eq!((tube.domain().start_s(), tube.slice(0)), (1.0, Some(over(1.0, 3.0))));
        assert_eq!(tube.drop_before(99.0), 2);
        assert_eq!((tube.slice_count(), tube.last_gate()), (0, over(3.0, 4.0)));
        tube.append(4.0, over(3.0, 5.0), over(4.0, 5.0)).unwrap();
        assert_eq!(tube.at(3.5), Ok(over(3.0, 5.0)));
    }

    #[test]
    fn what_is_learnt_is_intersected() {
        let mut tube = three_slices();
        assert_eq!(tube.contract_gate(1, &over(1.5, 9.0)), Ok(Contracted::Narrowed));
        assert_eq!(tube.contract_gate(1, &over(1.5, 9.0)), Ok(Contracted::Unchanged));
        assert_eq!(tube.at(1.0), Ok(over(1.5, 2.0)));
        assert_eq!(tube.contract_slice(2, &over(2.0, 2.5)), Ok(Contracted::Empty));
        assert!(tube.is_empty() && tube.width().is_nan());
    }
}
