//! What contractors between different times have in common.

use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::time_domain::Place;
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;

impl<T: Enclosure> Tube<T> {
    /// Narrows every slice and gate to what `known` says of the trajectory over its times, if it says anything. `known` is
    /// also given the tube, of which the slices are true but the summaries may lag behind.
    pub(super) fn narrow_everywhere(
        &mut self,
        direction: Direction,
        mut known: impl FnMut(&Tube<T>, Interval) -> Option<T>,
    ) -> Contracted {
        let count = self.slice_count();
        let mut contracted = Contracted::Unchanged;
        let mut sweep = |tube: &mut Tube<T>, place: Place| {
            let times_s = tube.domain.span_of(place);
            if let Some(value) = known(tube, times_s) {
                contracted = together(contracted, tube.narrow_at(place, value));
            }
        };
        if direction != Direction::Backward {
            (0..count).for_each(|index| sweep(self, Place::Slice(index)));
            (0..=count).for_each(|index| sweep(self, Place::Gate(index)));
        }
        if direction != Direction::Forward {
            (0..count).rev().for_each(|index| sweep(self, Place::Slice(index)));
            (0..=count).rev().for_each(|index| sweep(self, Place::Gate(index)));
        }
        if contracted != Contracted::Unchanged {
            self.refresh(0..count);
        }
        contracted
    }

    /// [`over`](Tube::over), by a look at each slice; `None` outside the domain. Needs no summaries, and is as fast for a
    /// few slices.
    pub(super) fn looked_over(&self, times_s: Interval) -> Option<T> {
        if times_s.is_empty() || times_s.is_point() {
            return self.over(times_s).ok();
        }
        let range = self.domain.slices_over(times_s).ok()?;
        Some(self.slices.range(range).fold(T::EMPTY, |hull, &slice| hull | slice))
    }

    /// Leaves no trajectory, because of a contradiction at about `time_s`.
    pub(super) fn empty_near(&mut self, time_s: f64, constraint: Constraint) {
        let within = |time_s: f64| time_s.clamp(self.domain.start_s(), self.domain.end_s());
        let place = if time_s.is_nan() { Ok(Place::Gate(0)) } else { self.domain.place_of(within(time_s)) };
        let contracted = match place {
            Ok(Place::Slice(index)) => {
                let contracted = self.narrow_slice(index, T::EMPTY);
                self.refresh(index..index + 1);
                contracted
            }
            Ok(Place::Gate(index)) => self.narrow_gate(index, T::EMPTY),
            Err(_) => self.narrow_gate(0, T::EMPTY),
        };
        self.blamed(contracted, constraint);
    }
}

/// What two tubes are left with that are linked by a constraint: when one is empty, so is the other.
pub(super) fn both_or_none<T: Enclosure, U: Enclosure>(
    x: &mut Tube<T>,
    y: &mut Tube<U>,
    contracted: Contracted,
    constraint: Constraint,
) -> Contracted {
    if !x.is_empty() && !y.is_empty() {
        return contracted;
    }
    x.blamed(Contracted::Empty, constraint);
    y.blamed(Contracted::Empty, constraint);
    if let Some(emptied) = y.emptied().filter(|_| !x.is_empty()) {
        x.empty_near(emptied.times_s.mid(), constraint);
    } else if let Some(emptied) = x.emptied().filter(|_| !y.is_empty()) {
        y.empty_near(emptied.times_s.mid(), constraint);
    }
    Contracted::Empty
}

/// The times at which a trajectory may be in `values`, as a hull: those in the domain that the tube allows, and all others.
pub(super) fn possible_times<T: Enclosure>(tube: &Tube<T>, values: T, times_s: Interval) -> Interval {
    let [earlier_s, later_s] = times_s.difference(tube.domain.span());
    tube.invert_within(values, times_s) | earlier_s | later_s
}

/// The delay, axis or period, if it is between finite numbers of seconds.
pub(super) fn finite(time_s: Interval) -> Result<Interval, TubeError> {
    if !time_s.is_empty() && time_s.is_bounded() {
        return Ok(time_s);
    }
    Err(TubeError::NotATime { time_s: if time_s.is_empty() { f64::NAN } else { time_s.width() } })
}
