//! What a bearing says about the coordinates that it is computed from.

use crate::interval::Interval;
use std::f64::consts::{FRAC_PI_2, PI};

impl Interval {
    /// The numbers `y` of `x` for which some `b` in `self` gives `atan2(y, b)` in `c`, in radians, as a hull: the first argument
    /// of `atan2`, the coordinate across the direction zero.
    ///
    /// Every bound is at most four units in the last place from the tightest.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// // North of the axis by a bearing between 0.4 and 0.5, three to five metres along it.
    /// let along_m = Interval::new(3.0, 5.0)?;
    /// let across_m = along_m.atan2_rev1(Interval::new(0.4, 0.5)?, Interval::ENTIRE);
    /// assert_eq!(format!("{across_m:.3}"), "[1.268, 2.732]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (atan2Rev1).
    pub fn atan2_rev1(self, c: Interval, x: Interval) -> Interval {
        let ahead = c.contains(0.0) && self.upper() > 0.0;
        let behind = holds_half_turn(c) && self.lower() < 0.0;
        let on_axis = if ahead || behind { x.intersection(Interval::ZERO) } else { Interval::EMPTY };
        let left = positive_across(self, c, x.above(0.0));
        let right = -positive_across(self, -c, (-x).above(0.0));
        on_axis.hull(left).hull(right)
    }

    /// The numbers of `x` for which some `a` in `self` gives `atan2(a, x)` in `c`, in radians, as a hull: the second argument
    /// of `atan2`, the coordinate along the direction zero. Guarantees as for [`Interval::atan2_rev1`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let across_m = Interval::new(3.0, 5.0)?;
    /// let along_m = across_m.atan2_rev2(Interval::new(1.0, 2.0)?, Interval::ENTIRE);
    /// assert_eq!(format!("{along_m:.3}"), "[-2.289, 3.211]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (atan2Rev2).
    pub fn atan2_rev2(self, c: Interval, x: Interval) -> Interval {
        let on_axis = self.contains(0.0);
        let ahead = if on_axis && c.contains(0.0) { x.above(0.0) } else { Interval::EMPTY };
        let behind = if on_axis && holds_half_turn(c) { x.below(0.0) } else { Interval::EMPTY };
        let left = along(self.above(0.0), c, x);
        let right = along((-self).above(0.0), -c, x);
        ahead.hull(behind).hull(left).hull(right)
    }
}

/// Whether the number pi is in the set.
fn holds_half_turn(angles: Interval) -> bool {
    angles.lower() <= PI && angles.upper() > PI
}

/// The numbers of `y`, all positive, that are across in a direction of `angles`, with `along` along.
fn positive_across(along: Interval, angles: Interval, y: Interval) -> Interval {
    let angles = angles.above(0.0).below(Interval::PI.upper());
    if angles.is_empty() || along.is_empty() {
        return Interval::EMPTY;
    }
    // No f64 is half of pi: what is not above the one that is next to it is below half of pi.
    let (from_ahead, from_left) = (angles.lower() <= FRAC_PI_2, angles.upper() > FRAC_PI_2);
    let mut across = Interval::EMPTY;
    if from_ahead {
        let steepest = if from_left { f64::INFINITY } else { slope(angles.upper()).upper() };
        let slopes = Interval::from_bounds(slope(angles.lower()).lower(), steepest);
        across = across.hull(y.intersection(along.above(0.0) * slopes));
    }
    if from_left {
        let steepest = if from_ahead { f64::INFINITY } else { slope(angles.lower()).upper() };
        let flattest = if angles.upper() > PI { 0.0 } else { slope(angles.upper()).lower() };
        let slopes = Interval::from_bounds(flattest, steepest);
        across = across.hull(y.intersection((-along).above(0.0) * slopes));
    }
    if from_ahead && from_left && along.contains(0.0) {
        across = across.hull(y);
    }
    across
}

/// The numbers of `x` that are along in a direction of `angles`, with `across`, all positive, across.
fn along(across: Interval, angles: Interval, x: Interval) -> Interval {
    let angles = angles.above(0.0).below(Interval::PI.upper());
    if angles.is_empty() || across.is_empty() {
        return Interval::EMPTY;
    }
    // The quotient shrinks as the angle grows.
    let quotients = |angle| across / Interval::from_bounds(angle, angle).tan();
    let lower = if angles.upper() > PI { f64::NEG_INFINITY } else { quotients(angles.upper()).lower() };
    let upper = if angles.lower() <= 0.0 { f64::INFINITY } else { quotients(angles.lower()).upper() };
    let side = if angles.upper() <= FRAC_PI_2 {
        x.above(0.0)
    } else if angles.lower() > FRAC_PI_2 {
        x.below(0.0)
    } else {
        x
    };
    side.intersection(Interval::from_bounds(lower, upper))
}

/// The size of the tangent of one angle between zero and pi.
fn slope(angle: f64) -> Interval {
    Interval::from_bounds(angle, angle).tan().abs()
}
