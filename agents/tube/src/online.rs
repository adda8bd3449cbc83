//! A tube that grows at one end and is forgotten at the other.

use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::storage::push_sparingly;
use crate::summary::Slices;
use crate::time_domain::Place;
use crate::tube::{Tube, settled};

/// Room for this many slices is not given back when slices are dropped.
const FORGOTTEN_ROOM: usize = 1024;

impl<T: Enclosure> Tube<T> {
    /// Adds a slice that ends at `end_s` seconds, with the gate at its end. In constant time, on average.
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
        let slice = settled(slice);
        let output_gate = settled(output_gate) & slice;
        let contracted = self.narrow_gate(self.gates.len() - 1, slice);
        self.blamed(contracted, Constraint::Value);
        push_sparingly(&mut self.slices, slice);
        push_sparingly(&mut self.gates, output_gate);
        self.empty_count += usize::from(slice.is_empty()) + usize::from(output_gate.is_empty());
        self.summaries.append(Slices { domain: &self.domain, values: &self.slices });
        debug_assert!(self.gates_are_inside(self.slice_count() - 1));
        Ok(())
    }

    /// Forgets the `count` oldest slices with their input gates, or all if there are fewer; the last gate always stays. The
    /// slice that had index `count` has index 0 afterwards. When the slices go that had made the tube empty, so does the
    /// contradiction: an observer that must not forget it asks [`emptied`](Tube::emptied) first.
    pub fn drop_front(&mut self, count: usize) {
        let count = count.min(self.slice_count());
        self.domain.drop_front(count);
        let slices = self.slices.drain(..count).filter(T::is_empty).count();
        let gates = self.gates.drain(..count).filter(T::is_empty).count();
        self.empty_count -= slices + gates;
        self.first_emptied = self.first_emptied.and_then(|emptied| emptied.without_front(count));
        self.summaries.drop_front(count);
        if self.slices.capacity() > FORGOTTEN_ROOM.max(4 * self.slices.len()) {
            self.slices.shrink_to(2 * self.slices.len());
            self.gates.shrink_to(2 * self.gates.len());
        }
    }

    /// Forgets all slices that end at `time_s` seconds or before, and returns how many they were; a NaN is before all.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let mut x_m = Tube::constant(TimeDomain::uniform(0.0, 0.5, 10)?, Interval::ZERO);
    /// assert_eq!(x_m.drop_before(1.7), 3);
    /// assert_eq!(x_m.domain().start_s(), 1.5);
    /// # Ok::<(), shoal_tube::TubeError>(())
    /// ```
    pub fn drop_before(&mut self, time_s: f64) -> usize {
        let count = match self.domain.place_of(time_s) {
            Ok(Place::Gate(index) | Place::Slice(index)) => index,
            Err(_) if time_s > self.domain.end_s() => self.slice_count(),
            Err(_) => 0,
        };
        self.drop_front(count);
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shoal_interval::Interval;
    use shoal_interval::contractor::Contracted;

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

    #[test]
    fn what_emptied_the_tube_moves_with_its_slice_and_goes_with_it() {
        let mut tube = three_slices();
        tube.contract_slice(1, &Interval::EMPTY).unwrap();
        let emptied = tube.emptied().unwrap();
        assert_eq!((emptied.place, emptied.constraint), (Place::Slice(1), Some(Constraint::Value)));
        tube.drop_front(1);
        assert_eq!(tube.emptied().map(|emptied| emptied.place), Some(Place::Slice(0)));
        tube.drop_front(1);
        // The gate at the end of the slice is still empty.
        assert_eq!(tube.emptied(), tube.first_empty());
        assert_eq!(tube.emptied().map(|emptied| emptied.place), Some(Place::Gate(0)));
    }
}
