//! The state of an AUV as a set: its position, and the true time as one more coordinate.

use shoal_bus::message::{Culprit, Measured};
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::measured;
use crate::motion::Moved;

/// Encloses position and clock at one moment of local time.
///
/// The true time is enclosed by its difference from the own clock: t lies in `local + offset_s`, where `local` is the exact
/// local time of the moment, within the stamp's tolerance of its stamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// True minus local time, in seconds.
    pub offset_s: Interval,
    /// Position in metres.
    pub position_m: IntervalBox<3>,
}

/// What is certain about sound, whoever it comes from.
#[derive(Clone, Copy, Debug)]
pub struct Sound {
    /// Its speed in m/s.
    pub speed_m_s: Interval,
    /// What is heard comes from no farther than this, in metres.
    pub hearing_range_m: f64,
}

/// A measurement that leaves nothing of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction(pub Culprit);

impl State {
    /// No state at all.
    pub const EMPTY: Self = Self { offset_s: Interval::EMPTY, position_m: IntervalBox::EMPTY };

    /// As a box of (clock offset, x, y, z).
    pub fn as_box(&self) -> IntervalBox<4> {
        let [x, y, z] = self.position_m.sides();
        IntervalBox::from([self.offset_s, x, y, z])
    }

    /// The state of a box of (clock offset, x, y, z).
    pub fn of_box(of: &IntervalBox<4>) -> Self {
        let [offset_s, x, y, z] = of.sides();
        Self { offset_s, position_m: IntervalBox::from([x, y, z]) }
    }

    /// The state after `moved`.
    pub fn moved(&self, moved: &Moved) -> Self {
        Self {
            offset_s: self.offset_s + moved.offset_gain_s,
            position_m: self.position_m + moved.displacement_m,
        }
    }

    /// All states from this one to the one after `moved`, which was then contracted to `after`.
    pub fn swept(&self, moved: &Moved, after: &State) -> Self {
        Self {
            offset_s: (self.offset_s + moved.offset_within_s)
                .intersection(after.offset_s - moved.offset_within_s),
            position_m: (self.position_m + moved.within_m).intersection(&(after.position_m - moved.within_m)),
        }
    }

    /// All states during `moved`, which ended in this one.
    pub fn backwards(&self, moved: &Moved) -> Self {
        Self { offset_s: self.offset_s - moved.offset_within_s, position_m: self.position_m - moved.within_m }
    }

    /// The smallest state that holds both.
    pub fn hull(&self, other: &Self) -> Self {
        Self {
            offset_s: self.offset_s.hull(other.offset_s),
            position_m: self.position_m.hull(&other.position_m),
        }
    }

    /// The states that both hold.
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            offset_s: self.offset_s.intersection(other.offset_s),
            position_m: self.position_m.intersection(&other.position_m),
        }
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.offset_s.is_empty() || self.position_m.is_empty()
    }

    /// True time at `stamp_s`, in seconds.
    pub fn true_time_s(&self, stamp_s: Interval) -> Interval {
        self.offset_s + stamp_s
    }

    /// Contracts by a depth.
    pub fn with_depth(&self, depth_m: Measured) -> Result<Self, Contradiction> {
        let [x, y, z] = self.position_m.sides();
        let z = z.intersection(-measured(depth_m));
        Self { position_m: IntervalBox::from([x, y, z]), ..*self }.unless_empty(Culprit::Depth)
    }

    /// Contracts by a satellite fix: a position box and a true-time interval that hold at the moment.
    pub fn with_fix(
        &self,
        position_m: &IntervalBox<3>,
        time_s: Interval,
        stamp_s: Interval,
    ) -> Result<Self, Contradiction> {
        Self {
            offset_s: self.offset_s.intersection(time_s - stamp_s),
            position_m: self.position_m.intersection(position_m),
        }
        .unless_empty(Culprit::Gnss)
    }

    /// Whether this state is smaller than `before` in some coordinate, by more than rounding.
    pub fn is_tighter_than(&self, before: &Self) -> bool {
        self.is_tighter_by(before, 1e-9)
    }

    /// Whether this state is smaller than `before` in some coordinate, by more than this part of its width.
    pub fn is_tighter_by(&self, before: &Self, ratio: f64) -> bool {
        // So it is with most of what is heard.
        if self == before {
            return false;
        }
        let shrunk = |now: Interval, then: Interval| now.width() < then.width() * (1.0 - ratio);
        shrunk(self.offset_s, before.offset_s)
            || (0..3).any(|axis| shrunk(self.position_m[axis], before.position_m[axis]))
    }

    fn unless_empty(self, culprit: Culprit) -> Result<Self, Contradiction> {
        if self.is_empty() { Err(Contradiction(culprit)) } else { Ok(self) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contradiction_names_its_culprit() {
        let state = State { offset_s: Interval::ZERO, position_m: IntervalBox::from([Interval::ZERO; 3]) };
        let deep = Measured { value: 7.0, error: 0.5 };
        assert_eq!(state.with_depth(deep).unwrap_err(), Contradiction(Culprit::Depth));
    }
}
