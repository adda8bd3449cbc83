//! Angles modulo a full turn.

use super::quarter_turns::QuarterTurns;
use super::turn_reduction::wrapped;
use crate::interval::Interval;
use std::f64::consts;

impl Interval {
    /// A quarter of pi, between two neighbouring `f64`.
    pub const QUARTER_PI: Interval = from_below(consts::FRAC_PI_4);

    /// Half of pi, between two neighbouring `f64`.
    pub const HALF_PI: Interval = from_below(consts::FRAC_PI_2);

    /// The number pi, between two neighbouring `f64`.
    pub const PI: Interval = from_below(consts::PI);

    /// Twice pi, a full turn in radians, between two neighbouring `f64`.
    pub const TWO_PI: Interval = from_below(consts::TAU);

    /// The smallest interval that holds `[-pi, pi]`.
    pub(crate) const HALF_TURNS: Interval =
        Interval::from_bounds(-Interval::PI.upper(), Interval::PI.upper());

    /// The angles in the set, in radians, moved by whole turns into `[-pi, pi]`, as a hull.
    ///
    /// Angles on both sides of the cut, an odd multiple of pi, give the whole of `[-pi, pi]`: see
    /// [`Interval::wrap_angle_to_pair`] for the two pieces. Angles that are between -pi and pi are not changed; the bounds
    /// of others are at most one unit in the last place from the tightest, however large the angles.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let heading_rad = Interval::new(6.0, 7.0)?.wrap_angle();
    /// assert_eq!(format!("{heading_rad:.3}"), "[-0.284, 0.717]");
    /// let across = Interval::new(3.0, 3.5)?.wrap_angle();
    /// assert_eq!(across, Interval::new(-Interval::PI.upper(), Interval::PI.upper())?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn wrap_angle(self) -> Interval {
        let [after, before] = self.wrap_angle_to_pair();
        after.hull(before)
    }

    /// The angles in the set, in radians, moved by whole turns into `[-pi, pi]`, as two pieces in ascending order.
    ///
    /// The second piece is empty unless the set crosses the cut, an odd multiple of pi, and does not go all around: then the
    /// first piece begins at -pi, and the second ends at pi. Angles that are between -pi and pi are not changed.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let [south_west, south_east] = Interval::new(3.0, 3.5)?.wrap_angle_to_pair();
    /// assert_eq!(format!("{south_west:.3} {south_east:.3}"), "[-3.142, -2.783] [3.000, 3.142]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn wrap_angle_to_pair(self) -> [Interval; 2] {
        if self.is_subset_of(Interval::from_bounds(-consts::PI, consts::PI)) {
            return [self, Interval::EMPTY];
        }
        if !self.is_bounded() {
            return [Interval::HALF_TURNS, Interval::EMPTY];
        }
        let turns = QuarterTurns::through(self);
        if turns.pass_more_than_a_turn() {
            return [Interval::HALF_TURNS, Interval::EMPTY];
        }
        let (first, last) = (wrapped(self.lower()), wrapped(self.upper()));
        if !turns.pass(2) {
            return [first.hull(last), Interval::EMPTY];
        }
        let before = Interval::from_bounds(first.lower(), Interval::PI.upper());
        let after = Interval::from_bounds(-Interval::PI.upper(), last.upper());
        if after.upper() >= before.lower() {
            return [Interval::HALF_TURNS, Interval::EMPTY];
        }
        [after, before]
    }
}

/// What `f64` gives for pi and its halves is below the exact number.
const fn from_below(nearest: f64) -> Interval {
    Interval::from_bounds(nearest, nearest.next_up())
}

#[cfg(test)]
mod tests;
