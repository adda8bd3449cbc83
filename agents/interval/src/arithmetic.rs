//! Sum, difference, product and quotient, rounded outwards.
//!
//! Each gives the smallest interval with `f64` bounds that holds every result for numbers taken from the operands: the
//! tightest, in the words of IEEE Std 1788-2015, table 9.1. An operand that is empty gives the empty set. A plain number as
//! operand stands for itself; NaN stands for any number.
//!
//! Source: seed 001, equations (2.8) to (2.14).

use crate::interval::Interval;
use crate::lanes;
use crate::rounding::{add_down, add_up, div_down, div_up, mul_down, mul_up};
use crate::set::{larger, smaller};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

impl Neg for Interval {
    type Output = Interval;

    #[inline]
    fn neg(self) -> Interval {
        let [lower, neg_upper] = self.lower_bounds();
        Interval::from_lower_bounds(neg_upper, lower)
    }
}

impl Add for Interval {
    type Output = Interval;

    #[inline]
    fn add(self, other: Interval) -> Interval {
        match lanes::sums(&[self], &[other]) {
            Some([sum]) => sum,
            None => add_with_care(self, other),
        }
    }
}

impl Sub for Interval {
    type Output = Interval;

    #[inline]
    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Interval;

    #[inline]
    fn mul(self, other: Interval) -> Interval {
        match lanes::products(&[self], other) {
            Some([product]) => product,
            None => multiply_with_care(self, other),
        }
    }
}

impl Div for Interval {
    type Output = Interval;

    /// The hull of `x / y` over the `y` that are not zero; empty when zero is the only one.
    #[inline]
    fn div(self, other: Interval) -> Interval {
        if self.is_empty() || other.is_empty() {
            return Interval::EMPTY;
        }
        if other.upper() < 0.0 {
            return (-self) / (-other);
        }
        if !other.contains(0.0) {
            return divide_by_positive(self, other);
        }
        divide_across_zero(self, other)
    }
}

/// The sum, whatever the bounds are.
#[cold]
fn add_with_care(x: Interval, y: Interval) -> Interval {
    if x.is_empty() || y.is_empty() {
        return Interval::EMPTY;
    }
    Interval::from_bounds(add_down(x.lower(), y.lower()), add_up(x.upper(), y.upper()))
}

/// The product, whatever the bounds are. Two products of numbers are enough when a factor does not change sign; only when both do
/// are four needed.
#[cold]
fn multiply_with_care(x: Interval, y: Interval) -> Interval {
    if x.is_empty() || y.is_empty() {
        return Interval::EMPTY;
    }
    let (a, b) = (x.lower(), x.upper());
    let (c, d) = (y.lower(), y.upper());
    let (lower, upper) = if a >= 0.0 {
        if c >= 0.0 {
            (mul_down(a, c), mul_up(b, d))
        } else if d <= 0.0 {
            (mul_down(b, c), mul_up(a, d))
        } else {
            (mul_down(b, c), mul_up(b, d))
        }
    } else if b <= 0.0 {
        if c >= 0.0 {
            (mul_down(a, d), mul_up(b, c))
        } else if d <= 0.0 {
            (mul_down(b, d), mul_up(a, c))
        } else {
            (mul_down(a, d), mul_up(a, c))
        }
    } else if c >= 0.0 {
        (mul_down(a, d), mul_up(b, d))
    } else if d <= 0.0 {
        (mul_down(b, c), mul_up(a, c))
    } else {
        (smaller(mul_down(a, d), mul_down(b, c)), larger(mul_up(a, c), mul_up(b, d)))
    };
    Interval::from_bounds(lower, upper)
}

#[inline]
fn divide_by_positive(x: Interval, y: Interval) -> Interval {
    let (a, b) = (x.lower(), x.upper());
    let (c, d) = (y.lower(), y.upper());
    let lower = div_down(a, if a >= 0.0 { d } else { c });
    let upper = div_up(b, if b >= 0.0 { c } else { d });
    Interval::from_bounds(lower, upper)
}

fn divide_across_zero(x: Interval, y: Interval) -> Interval {
    let (c, d) = (y.lower(), y.upper());
    if c == 0.0 && d == 0.0 {
        Interval::EMPTY
    } else if x == Interval::ZERO {
        Interval::ZERO
    } else if x.lower() < 0.0 && x.upper() > 0.0 || c < 0.0 && d > 0.0 {
        Interval::ENTIRE
    } else {
        // Neither changes sign: the quotients are one ray, away from zero.
        let (smallest_x, largest_y) = (x.mignitude(), y.magnitude());
        let nearest = div_down(smallest_x, largest_y);
        let ray = Interval::from_bounds(nearest, f64::INFINITY);
        if (x.upper() > 0.0) == (d > 0.0) { ray } else { -ray }
    }
}

/// Writes the operators between an interval and a plain number, on either side, as operators between intervals.
macro_rules! with_plain_numbers {
    ($($operator:ident :: $method:ident),*) => {$(
        impl $operator<f64> for Interval {
            type Output = Interval;

            #[inline]
            fn $method(self, other: f64) -> Interval {
                $operator::$method(self, Interval::spanning(other, other))
            }
        }

        impl $operator<Interval> for f64 {
            type Output = Interval;

            #[inline]
            fn $method(self, other: Interval) -> Interval {
                $operator::$method(Interval::spanning(self, self), other)
            }
        }
    )*};
}

with_plain_numbers!(Add::add, Sub::sub, Mul::mul, Div::div);

impl AddAssign for Interval {
    #[inline]
    fn add_assign(&mut self, other: Interval) {
        *self = *self + other;
    }
}

impl SubAssign for Interval {
    #[inline]
    fn sub_assign(&mut self, other: Interval) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests;
