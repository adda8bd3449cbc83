//! The interval: what it is, how it is made, how it is measured.

use crate::error::IntervalError;
use crate::lanes;
use crate::rounding::{add_down, add_up};
use crate::set::larger;

/// A closed set of real numbers `{x : lower <= x <= upper}`, possibly empty, possibly unbounded.
///
/// The bounds are never NaN. An unbounded side has an infinite bound, which stands for "no bound" and is not itself a
/// member. The empty set is the one value [`Interval::EMPTY`].
///
/// ```
/// use shoal_interval::Interval;
///
/// let depth_m = Interval::new(10.0, 12.5)?;
/// assert!(depth_m.contains(11.0));
/// assert_eq!(depth_m.width(), 2.5);
/// assert_eq!(format!("{depth_m:.2}"), "[10.00, 12.50]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equation (2.2).
#[derive(Clone, Copy, PartialEq)]
pub struct Interval {
    lower: f64,
    /// Minus the upper bound, so that both are rounded down, by the same instructions (B. Lambov, *Interval arithmetic using
    /// SSE-2*, LNCS 5045, 2008).
    neg_upper: f64,
}

impl Interval {
    /// The empty set: no number satisfies everything that was asked. Its bounds are `(+inf, -inf)`.
    pub const EMPTY: Interval = Interval { lower: f64::INFINITY, neg_upper: f64::INFINITY };

    /// All real numbers: nothing is known.
    pub const ENTIRE: Interval = Interval { lower: f64::NEG_INFINITY, neg_upper: f64::NEG_INFINITY };

    /// The number zero.
    pub const ZERO: Interval = Interval { lower: 0.0, neg_upper: -0.0 };

    /// The number one.
    pub const ONE: Interval = Interval { lower: 1.0, neg_upper: -1.0 };

    /// All numbers from zero up.
    pub const NON_NEGATIVE: Interval = Interval { lower: 0.0, neg_upper: f64::NEG_INFINITY };

    /// The interval from `lower` to `upper`, both included; an infinite bound means no bound on that side.
    ///
    /// # Errors
    /// [`IntervalError`] when a bound is NaN, when they are inverted, or when no real number lies between them.
    pub fn new(lower: f64, upper: f64) -> Result<Interval, IntervalError> {
        if lower.is_nan() || upper.is_nan() {
            Err(IntervalError::NotANumber { lower, upper })
        } else if lower > upper {
            Err(IntervalError::Inverted { lower, upper })
        } else if lower == upper && lower.is_infinite() {
            Err(IntervalError::BeyondReals { bound: lower })
        } else {
            Ok(Interval { lower, neg_upper: -upper })
        }
    }

    /// The interval that holds exactly one number.
    ///
    /// # Errors
    /// [`IntervalError`] when `value` is NaN or infinite.
    pub fn point(value: f64) -> Result<Interval, IntervalError> {
        Interval::new(value, value)
    }

    /// The smallest interval that holds both numbers, in whichever order they come.
    ///
    /// Never fails and never loses anything: a NaN, of which nothing is known, gives [`Interval::ENTIRE`]; an infinity,
    /// which is what overflow leaves behind, gives everything beyond the largest finite number.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::spanning(3.0, -1.0), Interval::new(-1.0, 3.0)?);
    /// assert_eq!(Interval::spanning(3.0, f64::NAN), Interval::ENTIRE);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn spanning(one: f64, other: f64) -> Interval {
        if one.is_nan() || other.is_nan() {
            return Interval::ENTIRE;
        }
        Interval { lower: one.min(other).min(f64::MAX), neg_upper: -one.max(other).max(f64::MIN) }
    }

    /// All numbers within `radius` of `mid`, rounded outwards.
    ///
    /// A negative radius gives [`Interval::EMPTY`]. A NaN in either argument, or an infinite `mid`, gives
    /// [`Interval::ENTIRE`].
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// assert_eq!(Interval::centred(5.0, 0.5), Interval::new(4.5, 5.5)?);
    /// assert!(Interval::centred(5.0, -0.5).is_empty());
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn centred(mid: f64, radius: f64) -> Interval {
        match lanes::centred(mid, radius) {
            Some(interval) if radius >= 0.0 => interval,
            _ => centred_with_care(mid, radius),
        }
    }

    /// The interval with these bounds. The caller has made sure that they are not NaN and that at least one real number
    /// lies between them.
    #[inline]
    pub(crate) const fn from_bounds(lower: f64, upper: f64) -> Interval {
        debug_assert!(lower <= upper && lower < f64::INFINITY && upper > f64::NEG_INFINITY);
        Interval { lower, neg_upper: -upper }
    }

    /// [`from_bounds`](Interval::from_bounds) with minus the upper bound.
    #[inline]
    pub(crate) const fn from_lower_bounds(lower: f64, neg_upper: f64) -> Interval {
        Interval { lower, neg_upper }
    }

    /// The lower bound and minus the upper one.
    #[inline]
    pub(crate) const fn lower_bounds(self) -> [f64; 2] {
        [self.lower, self.neg_upper]
    }

    /// The lower bound; `-inf` when there is none, `+inf` for the empty set.
    #[inline]
    pub const fn lower(self) -> f64 {
        self.lower
    }

    /// The upper bound; `+inf` when there is none, `-inf` for the empty set.
    #[inline]
    pub const fn upper(self) -> f64 {
        -self.neg_upper
    }

    /// A number near the middle, always finite and inside the interval; NaN for the empty set, which has none.
    ///
    /// The middle of an interval without any bound is 0, of one with a single bound the largest finite number on the open
    /// side. Source: seed 001, equation (2.6).
    #[inline]
    pub fn mid(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        if self == Interval::ENTIRE {
            return 0.0;
        }
        let (lower, upper) = (self.lower(), self.upper());
        let sum = lower + upper;
        let middle = if sum.is_finite() { 0.5 * sum } else { 0.5 * lower + 0.5 * upper };
        middle.clamp(lower, upper).clamp(f64::MIN, f64::MAX)
    }

    /// The distance between the bounds, rounded up; `+inf` when unbounded, NaN for the empty set.
    ///
    /// Source: seed 001, equation (2.7).
    #[inline]
    pub fn width(self) -> f64 {
        if self.is_empty() { f64::NAN } else { -add_down(self.neg_upper, self.lower) }
    }

    /// The smallest radius that reaches all of the interval from [`mid`](Interval::mid), rounded up; `+inf` when unbounded,
    /// NaN for the empty set.
    ///
    /// The interval is a subset of `Interval::centred(x.mid(), x.radius())`. It is half of the width only if `mid` is exact.
    /// Source: IEEE 1788-2015, clause 12.12.8 (`rad`).
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let depth_m = Interval::new(10.0, 12.5)?;
    /// assert_eq!((depth_m.mid(), depth_m.radius()), (11.25, 1.25));
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn radius(self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        let middle = self.mid();
        larger(add_up(self.upper(), -middle), add_up(middle, -self.lower()))
    }

    /// The largest absolute value in the interval; NaN for the empty set.
    #[inline]
    pub fn magnitude(self) -> f64 {
        if self.is_empty() { f64::NAN } else { self.lower.abs().max(self.neg_upper.abs()) }
    }

    /// The smallest absolute value in the interval; NaN for the empty set.
    #[inline]
    pub fn mignitude(self) -> f64 {
        if self.is_empty() { f64::NAN } else { 0.0_f64.max(self.lower).max(self.neg_upper) }
    }

    /// Whether no number is in the set.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.lower > -self.neg_upper
    }

    /// Whether the set lies between two finite numbers. The empty set does.
    #[inline]
    pub const fn is_bounded(self) -> bool {
        self.is_empty() || (self.lower > f64::NEG_INFINITY && self.neg_upper > f64::NEG_INFINITY)
    }

    /// Whether the set holds exactly one number.
    #[inline]
    pub const fn is_point(self) -> bool {
        self.lower == -self.neg_upper
    }
}

/// [`Interval::centred`], whatever the arguments are.
#[cold]
fn centred_with_care(mid: f64, radius: f64) -> Interval {
    if !mid.is_finite() || radius.is_nan() {
        return Interval::ENTIRE;
    }
    if radius < 0.0 {
        return Interval::EMPTY;
    }
    Interval { lower: add_down(mid, -radius), neg_upper: add_down(-mid, -radius) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_bounds_are_refused() {
        assert!(matches!(Interval::new(f64::NAN, 1.0), Err(IntervalError::NotANumber { .. })));
        assert!(matches!(Interval::new(2.0, 1.0), Err(IntervalError::Inverted { .. })));
        assert!(matches!(
            Interval::new(f64::INFINITY, f64::INFINITY),
            Err(IntervalError::BeyondReals { .. })
        ));
        assert!(Interval::point(f64::NEG_INFINITY).is_err());
        assert!(Interval::new(f64::NEG_INFINITY, f64::INFINITY).is_ok());
    }

    #[test]
    fn spanning_and_centred_never_lose_what_they_were_given() {
        assert_eq!(Interval::spanning(f64::INFINITY, f64::INFINITY).lower(), f64::MAX);
        assert_eq!(Interval::spanning(f64::NEG_INFINITY, 1.0).upper(), 1.0);
        assert_eq!(Interval::centred(f64::NAN, 1.0), Interval::ENTIRE);
        assert_eq!(Interval::centred(f64::INFINITY, 1.0), Interval::ENTIRE);
        assert_eq!(Interval::centred(1.0, f64::INFINITY), Interval::ENTIRE);
        let narrow = Interval::centred(1.0, 1e-300);
        assert!(narrow.lower() < 1.0 && narrow.upper() > 1.0);
    }

    #[test]
    fn the_middle_is_inside_and_finite() {
        let huge = Interval::new(f64::MAX, f64::INFINITY).unwrap();
        assert_eq!(huge.mid(), f64::MAX);
        assert_eq!(Interval::new(f64::MIN, f64::MAX).unwrap().mid(), 0.0);
        assert_eq!(Interval::new(f64::MAX / 2.0, f64::MAX).unwrap().mid(), f64::MAX * 0.75);
        assert_eq!(Interval::ENTIRE.mid(), 0.0);
        assert!(Interval::EMPTY.mid().is_nan());
    }

    #[test]
    fn measures() {
        let x = Interval::new(-3.0, 2.0).unwrap();
        assert_eq!((x.width(), x.magnitude(), x.mignitude()), (5.0, 3.0, 0.0));
        assert_eq!(Interval::new(-3.0, -2.0).unwrap().mignitude(), 2.0);
        assert!(Interval::EMPTY.width().is_nan());
        assert!(!Interval::NON_NEGATIVE.is_bounded());
    }

    #[test]
    fn a_radius_reaches_both_bounds() {
        let neighbours = Interval::new(1.0, 1.0_f64.next_up()).unwrap();
        assert_eq!(neighbours.radius(), f64::EPSILON);
        assert_eq!(Interval::new(f64::MIN, f64::MAX).unwrap().radius(), f64::MAX);
        assert_eq!((Interval::ONE.radius(), Interval::NON_NEGATIVE.radius()), (0.0, f64::INFINITY));
        assert!(Interval::EMPTY.radius().is_nan());
    }
}
