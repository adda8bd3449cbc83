//! What is learnt about a tube is intersected with it.
//!
//! The functions for use in other contractors of the crate, `narrow_slice` and `narrow_gate`, leave the summaries of the
//! tube as they are: whoever narrows slices with them calls [`Tube::refresh`] once at the end, on all that may have changed.

use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::time_domain::Place;
use crate::tube::Tube;
use shoal_interval::contractor::Contracted;

impl<T: Enclosure> Tube<T> {
    /// Removes from gate `index` everything that is not in `value`. Other gates and slices wait for a contractor such as
    /// [`contract_derivative`](Tube::contract_derivative) to carry it on.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{Contracted, TimeDomain, Tube};
    ///
    /// let mut depth_m = Tube::constant(TimeDomain::uniform(0.0, 1.0, 9)?, Interval::new(0.0, 50.0)?);
    /// assert_eq!(depth_m.contract_gate(3, &Interval::new(10.0, 90.0)?)?, Contracted::Narrowed);
    /// assert_eq!(depth_m.at(3.0)?, Interval::new(10.0, 50.0)?);
    /// // A sensor that answers NaN says nothing, and takes nothing away.
    /// let lost = Interval::spanning(f64::NAN, f64::NAN);
    /// assert_eq!(depth_m.contract_gate(3, &lost)?, Contracted::Unchanged);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When there is no such gate.
    pub fn contract_gate(&mut self, index: usize, value: &T) -> Result<Contracted, TubeError> {
        self.check_gate(index)?;
        let contracted = self.narrow_gate(index, *value);
        Ok(self.blamed(contracted, Constraint::Value))
    }

    /// Removes from slice `index`, and from the gates on both of its sides, everything that is not in `value`.
    ///
    /// # Errors
    /// When there is no such slice.
    pub fn contract_slice(&mut self, index: usize, value: &T) -> Result<Contracted, TubeError> {
        self.check_slice(index)?;
        let contracted = self.narrow_slice(index, *value);
        if contracted != Contracted::Unchanged {
            self.refresh(index..index + 1);
        }
        Ok(self.blamed(contracted, Constraint::Value))
    }

    /// Intersects a gate, which the caller knows to exist. No summary speaks of gates.
    #[inline]
    pub(crate) fn narrow_gate(&mut self, index: usize, value: T) -> Contracted {
        let before = self.gates[index];
        let after = before & value;
        self.gates[index] = after;
        self.told(Place::Gate(index), before, after)
    }

    /// Intersects a slice, which the caller knows to exist, and with it the gates beside. The summaries wait for
    /// [`refresh`](Tube::refresh).
    #[inline]
    pub(crate) fn narrow_slice(&mut self, index: usize, value: T) -> Contracted {
        let of_slice = self.narrow_slice_alone(index, value);
        let slice = self.slices[index];
        let of_input = self.narrow_gate(index, slice);
        let of_output = self.narrow_gate(index + 1, slice);
        debug_assert!(self.gates_are_inside(index));
        together(together(of_slice, of_input), of_output)
    }

    /// [`narrow_slice`](Tube::narrow_slice) for a caller that narrows the two gates to the slice itself.
    #[inline]
    pub(crate) fn narrow_slice_alone(&mut self, index: usize, value: T) -> Contracted {
        let before = self.slices[index];
        let after = before & value;
        self.slices[index] = after;
        self.told(Place::Slice(index), before, after)
    }

    /// What must always be true of a slice.
    pub(crate) fn gates_are_inside(&self, index: usize) -> bool {
        self.gates.range(index..index + 2).all(|gate| gate.is_subset_of(&self.slices[index]))
    }

    /// What the contraction of a slice or a gate did.
    #[inline]
    fn told(&mut self, place: Place, before: T, after: T) -> Contracted {
        if after.is_empty() {
            self.note_empty(place, before);
            Contracted::Empty
        } else if after == before {
            Contracted::Unchanged
        } else {
            Contracted::Narrowed
        }
    }

    /// Remembers which constraint emptied the tube, if that has just happened; returns `contracted`.
    #[inline]
    pub(crate) fn blamed(&mut self, contracted: Contracted, constraint: Constraint) -> Contracted {
        if contracted == Contracted::Empty
            && let Some(emptied) = &mut self.first_emptied
        {
            emptied.constraint.get_or_insert(constraint);
        }
        contracted
    }

    #[cold]
    fn note_empty(&mut self, place: Place, before: T) {
        if before.is_empty() {
            return;
        }
        if !self.is_empty() {
            self.first_emptied = Some(self.empty_at(place));
        }
        self.empty_count += 1;
    }
}

/// What two contractions on the same tube did in all.
#[inline]
pub(crate) fn together(one: Contracted, other: Contracted) -> Contracted {
    match (one, other) {
        (Contracted::Empty, _) | (_, Contracted::Empty) => Contracted::Empty,
        (Contracted::Unchanged, Contracted::Unchanged) => Contracted::Unchanged,
        _ => Contracted::Narrowed,
    }
}
