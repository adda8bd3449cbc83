//! What a sine, a cosine, a tangent or a wrapped angle says about the angle.
//!
//! The solutions are an inverse function's values, repeated for ever. Of these *branches* only the first that reaches beyond
//! the lower end of the angle, and the last before its upper end, are computed.

use crate::interval::Interval;
use crate::set::larger;
use std::f64::consts::{FRAC_1_PI, PI};

/// Angles beyond this size, where neighbouring `f64` are 0.25 apart, are left as they are.
const FOLLOWED_TO: f64 = (1_u64 << 50) as f64;

/// What the `f64` next to pi leaves over.
const BEYOND_PI: f64 = 1.224_646_799_147_353_2e-16;
const REST_OF_PI: Interval = Interval::from_bounds(BEYOND_PI.next_down(), BEYOND_PI);

/// No more than this many branches are between the one that a division points to and the one that counts.
const BRANCHES_TRIED: usize = 8;

const SINES: Interval = Interval::from_bounds(-1.0, 1.0);

impl Interval {
    /// The angles of `x`, in radians, whose sine is in `self`, as a hull.
    ///
    /// The bounds are the lowest and the highest solution in `x`, four units in the last place from the tightest at most;
    /// an end of `x` that is beyond 2^50 stays as it is.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let solutions = Interval::ZERO.sin_rev(Interval::new(1.0, 8.0)?);
    /// assert_eq!(format!("{solutions:.4}"), "[3.1415, 6.2832]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (sinRev).
    pub fn sin_rev(self, x: Interval) -> Interval {
        if SINES.is_subset_of(self) {
            return x;
        }
        let angle = self.asin();
        let branch =
            |angle: Interval| move |k: f64| from_half_turns(k, if is_even(k) { angle } else { -angle });
        solutions(angle, x, branch(angle), branch(-angle))
    }

    /// The angles of `x`, in radians, whose cosine is in `self`, as a hull. Guarantees as for [`Interval::sin_rev`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let solutions = Interval::ONE.cos_rev(Interval::new(-1.0, 8.0)?);
    /// assert_eq!(format!("{solutions:.4}"), "[0.0000, 6.2832]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (cosRev).
    pub fn cos_rev(self, x: Interval) -> Interval {
        if SINES.is_subset_of(self) {
            return x;
        }
        let angle = self.acos();
        let branch =
            |k: f64| if is_even(k) { from_half_turns(k, angle) } else { from_half_turns(k + 1.0, -angle) };
        solutions(angle, x, branch, branch)
    }

    /// The angles of `x`, in radians, whose tangent is in `self`, as a hull. Guarantees as for [`Interval::sin_rev`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let solutions = Interval::new(0.0, 1.0)?.tan_rev(Interval::new(1.0, 4.0)?);
    /// assert_eq!(format!("{solutions:.4}"), "[3.1415, 3.9270]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (tanRev).
    pub fn tan_rev(self, x: Interval) -> Interval {
        let angle = self.atan();
        solutions(angle, x, |k| from_half_turns(k, angle), |k| from_half_turns(k, -angle))
    }

    /// The angles of `x`, in radians, that whole turns move into `self` and into `[-pi, pi]`, as a hull. Guarantees as for
    /// [`Interval::sin_rev`].
    ///
    /// This reverses [`Interval::wrap_angle`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let heading_rad = Interval::new(-0.5, 0.5)?;
    /// let turned_rad = heading_rad.wrap_angle_rev(Interval::new(4.0, 9.0)?);
    /// assert_eq!(format!("{turned_rad:.4}"), "[5.7831, 6.7832]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn wrap_angle_rev(self, x: Interval) -> Interval {
        let angle = self.intersection(Interval::HALF_TURNS);
        // Between two whole turns nothing is added, so that a branch is repeated.
        let turn = |k: f64| 2.0 * (k / 2.0).floor();
        solutions(angle, x, |k| from_half_turns(turn(k), angle), |k| from_half_turns(turn(k), -angle))
    }
}

/// The angles of `x` that are in a branch. `branch` gives the one with a number, `mirrored` the one with that number when
/// all angles change sign; they come in ascending order, one every half turn. There is none when there is no `angle`.
fn solutions(
    angle: Interval,
    x: Interval,
    branch: impl Fn(f64) -> Interval,
    mirrored: impl Fn(f64) -> Interval,
) -> Interval {
    if angle.is_empty() || x.is_empty() {
        return Interval::EMPTY;
    }
    let lower = lowest_solution(x.lower(), branch);
    let upper = -lowest_solution(-x.upper(), mirrored);
    if lower <= upper { x.intersection(Interval::from_bounds(lower, upper)) } else { Interval::EMPTY }
}

/// No solution that is at least `from` is below this. All branches before the first that reaches `from` end before it, and
/// all after that one begin above it.
fn lowest_solution(from: f64, branch: impl Fn(f64) -> Interval) -> f64 {
    // Also true of a missing bound.
    if from.abs() > FOLLOWED_TO {
        return from;
    }
    // The division is wrong by less than one; branches reach half a turn to either side of where they are counted from,
    // and those of whole turns are counted twice.
    let first = (from * FRAC_1_PI).floor() - 2.0;
    for step in 0..BRANCHES_TRIED {
        let angles = branch(first + step as f64);
        if angles.upper() >= from {
            return larger(from, angles.lower());
        }
    }
    from
}

/// The angles, seen from `k` half turns on. `k` is a whole number below 2^51.
fn from_half_turns(k: f64, angles: Interval) -> Interval {
    let product = k * PI;
    let error = k.mul_add(PI, -product);
    angles + (REST_OF_PI * k + error) + product
}

fn is_even(k: f64) -> bool {
    (k / 2.0).floor() * 2.0 == k
}
