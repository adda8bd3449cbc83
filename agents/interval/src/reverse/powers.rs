//! What a power says about its base or its exponent.

use crate::interval::Interval;
use crate::set::{larger, smaller};

const UP_TO_ONE: Interval = Interval::from_bounds(0.0, 1.0);
const FROM_ONE: Interval = Interval::from_bounds(1.0, f64::INFINITY);

impl Interval {
    /// The numbers of `x` whose power with a whole `exponent` is in `self`, as a hull. This reverses [`Interval::powi`].
    ///
    /// Each of the two roots of an even power is met with `x` before they are joined. Every bound is at most one unit in the
    /// last place from the tightest.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let cube = Interval::new(-8.0, 27.0)?;
    /// assert_eq!(cube.pown_rev(Interval::ENTIRE, 3), Interval::new(-2.0, 3.0)?);
    /// let reciprocal_square = Interval::new(0.25, 1.0)?;
    /// assert_eq!(reciprocal_square.pown_rev(Interval::NON_NEGATIVE, -2), Interval::new(1.0, 2.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (pownRev).
    pub fn pown_rev(self, x: Interval, exponent: i32) -> Interval {
        match exponent {
            0 if self.contains(1.0) => return x,
            0 => return Interval::EMPTY,
            1 => return x.intersection(self),
            2 => return self.sqr_rev(x),
            -1 => return self.recip_rev(x),
            _ => {}
        }
        let positive = positive_root(self, x, exponent);
        let negative = if exponent % 2 == 0 {
            -positive_root(self, -x, exponent)
        } else {
            -positive_root(-self, -x, exponent)
        };
        positive.hull(negative)
    }

    /// The numbers of `x` for which some `b` in `self` gives `x^b` in `c`, as a hull. This reverses [`Interval::powf`] for
    /// its base, which is never negative.
    ///
    /// Every bound below 1e307 is at most eight units in the last place from the tightest, and every bound is at most one unit
    /// from it where the reciprocals of the bounds of `self` are exact.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (exponent, power) = (Interval::new(0.5, 2.0)?, Interval::new(4.0, 9.0)?);
    /// assert_eq!(exponent.pow_rev1(power, Interval::ENTIRE), Interval::new(2.0, 81.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (powRev1); O. Heimlich, *The General Interval Power Function*, 2011, table B.1.
    pub fn pow_rev1(self, c: Interval, x: Interval) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        let mut bases = Interval::EMPTY;
        if self.upper() > 0.0 && c.contains(0.0) {
            bases = bases.hull(x.intersection(Interval::ZERO));
        }
        if c.contains(1.0) {
            let any = if self.contains(0.0) { x.above(0.0) } else { x.intersection(Interval::ONE) };
            bases = bases.hull(any);
        }
        for exponents in [self.above(0.0), self.below(0.0)] {
            if !exponents.is_empty() {
                bases = bases.hull(bases_below_one(exponents, c, x)).hull(bases_above_one(exponents, c, x));
            }
        }
        bases
    }

    /// The numbers of `x` for which some `a` in `self` gives `a^x` in `c`, as a hull. This reverses [`Interval::powf`] for
    /// its exponent.
    ///
    /// Every bound is at most eight units in the last place from the tightest, and exact where a power of two and its exponent
    /// decide it.
    ///
    /// ```
    /// use shoal_interval::Interval;
    ///
    /// let (base, power) = (Interval::new(2.0, 4.0)?, Interval::new(8.0, 16.0)?);
    /// assert_eq!(base.pow_rev2(power, Interval::ENTIRE), Interval::new(1.5, 4.0)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: IEEE 1788-2015, table 10.1 (powRev2); O. Heimlich, *The General Interval Power Function*, 2011, table B.2.
    pub fn pow_rev2(self, c: Interval, x: Interval) -> Interval {
        let mut exponents = Interval::EMPTY;
        if self.contains(0.0) && c.contains(0.0) {
            exponents = exponents.hull(x.above(0.0));
        }
        if self.upper() > 0.0 && c.contains(1.0) {
            let any = if self.contains(1.0) { x } else { x.intersection(Interval::ZERO) };
            exponents = exponents.hull(any);
        }
        // Exponents are positive when base and power are on the same side of one.
        let (small, large) = (SideOfOne::below(self), SideOfOne::above(self));
        let (small_power, large_power) = (SideOfOne::below(c), SideOfOne::above(c));
        for (base, power) in [(small, small_power), (large, large_power)] {
            exponents = exponents.hull(x.above(0.0).intersection(exponent_sizes(base, power)));
        }
        for (base, power) in [(small, large_power), (large, small_power)] {
            exponents = exponents.hull(x.below(0.0).intersection(-exponent_sizes(base, power)));
        }
        exponents
    }
}

/// The numbers of `x` that are not negative and whose power is in `powers`; an `exponent` below zero leaves out zero.
fn positive_root(powers: Interval, x: Interval, exponent: i32) -> Interval {
    let powers = powers.intersection(Interval::NON_NEGATIVE);
    if powers.is_empty() {
        return Interval::EMPTY;
    }
    if exponent > 0 {
        let roots = Interval::from_bounds(
            whole_root(powers.lower(), exponent).lower(),
            whole_root(powers.upper(), exponent).upper(),
        );
        return x.intersection(roots);
    }
    if powers.upper() == 0.0 {
        return Interval::EMPTY;
    }
    let roots = Interval::from_bounds(
        whole_root(powers.upper(), exponent).lower(),
        whole_root(powers.lower(), exponent).upper(),
    );
    x.above(0.0).intersection(roots)
}

/// The positive number whose power is `power`, which is not negative: a real root first, then narrowed by powers of what is
/// in it. For zero and infinity, the limit beyond all numbers or at zero.
fn whole_root(power: f64, exponent: i32) -> Interval {
    if power == 0.0 || power.is_infinite() {
        let is_zero = (power == 0.0) == (exponent > 0);
        return if is_zero { Interval::ZERO } else { Interval::from_bounds(f64::MAX, f64::INFINITY) };
    }
    let root = real_root(power, f64::from(exponent));
    let power_of =
        |bits: u64| Interval::from_bounds(f64::from_bits(bits), f64::from_bits(bits)).powi(exponent);
    let is_not_above = |bits: u64| {
        if exponent > 0 { power_of(bits).upper() <= power } else { power_of(bits).lower() >= power }
    };
    let is_not_below = |bits: u64| {
        if exponent > 0 { power_of(bits).lower() >= power } else { power_of(bits).upper() <= power }
    };
    // The bits of positive numbers are in the order of the numbers.
    let (lowest, highest) = (root.lower().to_bits(), smaller(root.upper(), f64::MAX).to_bits());
    let (mut lower, mut upper) = (lowest, highest);
    let mut unknown = highest;
    while unknown - lower > 1 {
        let middle = lower + (unknown - lower) / 2;
        if is_not_above(middle) { lower = middle } else { unknown = middle }
    }
    let mut unknown = lower;
    while upper - unknown > 1 {
        let middle = unknown + (upper - unknown) / 2;
        if is_not_below(middle) { upper = middle } else { unknown = middle }
    }
    if is_not_above(upper) && upper != highest {
        lower = upper;
    }
    if is_not_below(lower) {
        upper = lower;
    }
    let upper = if upper == highest { root.upper() } else { f64::from_bits(upper) };
    Interval::from_bounds(f64::from_bits(lower), upper)
}

/// `power^(1/exponent)` for a positive finite `power` and an `exponent` that is not zero.
fn real_root(power: f64, exponent: f64) -> Interval {
    let base = Interval::from_bounds(power, power);
    let reciprocal = Interval::from_bounds(exponent, exponent).recip();
    let root = base.powf(reciprocal);
    if reciprocal.is_point() || !(1e-300..=1e300).contains(&exponent.abs()) {
        return root;
    }
    // What rounding takes from the exponent is a factor of nearly one.
    let nearest = 1.0 / exponent;
    let rest = (-nearest).mul_add(exponent, 1.0) / Interval::from_bounds(exponent, exponent);
    let factor = (base.ln() * rest).exp();
    root.intersection(base.powf(Interval::from_bounds(nearest, nearest)) * factor)
}

/// `power^(1/exponent)` with its limits: of roots that are on one side of one, zero and infinity are the farthest.
fn root_with_limits(power: f64, exponent: f64, farthest: f64) -> (f64, f64) {
    if power == 1.0 || exponent.is_infinite() {
        (1.0, 1.0)
    } else if power == 0.0 || power.is_infinite() || exponent == 0.0 {
        (farthest, farthest)
    } else {
        let root = real_root(power, exponent);
        (root.lower(), root.upper())
    }
}

/// The bases in `x` between zero and one. The exponents have one sign, and zero only closes them.
fn bases_below_one(exponents: Interval, powers: Interval, x: Interval) -> Interval {
    let Some((near, far)) = nearest_and_farthest(exponents, powers, exponents.upper() <= 0.0) else {
        return Interval::EMPTY;
    };
    let nearest = smaller(root_with_limits(near.0, near.1, 0.0).1, 1.0);
    let farthest = root_with_limits(far.0, far.1, 0.0).0;
    x.above(0.0).below(1.0).intersection(Interval::from_bounds(farthest, nearest))
}

/// The bases in `x` above one, as [`bases_below_one`].
fn bases_above_one(exponents: Interval, powers: Interval, x: Interval) -> Interval {
    let Some((near, far)) = nearest_and_farthest(exponents, powers, exponents.lower() >= 0.0) else {
        return Interval::EMPTY;
    };
    let nearest = larger(root_with_limits(near.0, near.1, f64::INFINITY).0, 1.0);
    let farthest = root_with_limits(far.0, far.1, f64::INFINITY).1;
    x.above(1.0).intersection(Interval::from_bounds(nearest, farthest))
}

/// Power and exponent for the base that is nearest to one and for the one that is farthest from it, among the powers that are
/// above one, or below it.
fn nearest_and_farthest(
    exponents: Interval,
    powers: Interval,
    above_one: bool,
) -> Option<((f64, f64), (f64, f64))> {
    let side = if above_one { SideOfOne::above(powers) } else { SideOfOne::below(powers) }?;
    let (small, large) = if exponents.lower() >= 0.0 {
        (exponents.lower(), exponents.upper())
    } else {
        (exponents.upper(), exponents.lower())
    };
    Some(((side.nearest, large), (side.farthest, small)))
}

/// The positive numbers of a set that are above one, or those below it.
#[derive(Clone, Copy)]
struct SideOfOne {
    nearest: f64,
    farthest: f64,
}

impl SideOfOne {
    fn above(set: Interval) -> Option<SideOfOne> {
        let side = set.above(1.0).intersection(FROM_ONE);
        (!side.is_empty()).then_some(SideOfOne { nearest: side.lower(), farthest: side.upper() })
    }

    fn below(set: Interval) -> Option<SideOfOne> {
        let side = set.above(0.0).below(1.0).intersection(UP_TO_ONE);
        (!side.is_empty()).then_some(SideOfOne { nearest: side.upper(), farthest: side.lower() })
    }
}

/// The sizes of the exponents that take a base of one side to a power of one side.
fn exponent_sizes(base: Option<SideOfOne>, power: Option<SideOfOne>) -> Interval {
    let (Some(base), Some(power)) = (base, power) else {
        return Interval::EMPTY;
    };
    let is_limit = |x: f64| x == 0.0 || x.is_infinite();
    let lower = if power.nearest == 1.0 || is_limit(base.farthest) {
        0.0
    } else {
        ratio_of_logarithms(power.nearest, base.farthest).lower()
    };
    let upper = if base.nearest == 1.0 || is_limit(power.farthest) {
        f64::INFINITY
    } else {
        ratio_of_logarithms(power.farthest, base.nearest).upper()
    };
    Interval::from_bounds(lower, upper)
}

/// The size of `ln power / ln base`, of positive finite numbers that are not one.
fn ratio_of_logarithms(power: f64, base: f64) -> Interval {
    let ratio = match (exponent_of_two(power), exponent_of_two(base)) {
        (Some(power), Some(base)) => Interval::from_bounds(power, power) / base,
        _ => Interval::from_bounds(power, power).ln() / Interval::from_bounds(base, base).ln(),
    };
    ratio.abs()
}

/// The exponent of a normal number that is a power of two.
fn exponent_of_two(x: f64) -> Option<f64> {
    const FRACTION_BITS: u64 = (1 << 52) - 1;
    let exponent = (x.to_bits() >> 52) as i32;
    (x.is_normal() && x.to_bits() & FRACTION_BITS == 0).then(|| f64::from(exponent - 1023))
}
