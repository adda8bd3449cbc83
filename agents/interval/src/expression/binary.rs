//! The functions of two variables that an expression is made of, each with all that the sweeps need to know of it.

use super::regularity::Regularity;
use crate::interval::Interval;

/// A function of two variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Binary {
    Sum,
    Difference,
    Product,
    Quotient,
    Minimum,
    Maximum,
    /// The angle of the vector `(b, a)`.
    Angle,
    /// `a` to the power of `b`, for `a` that is not negative.
    Power,
}

impl Binary {
    /// Whether the order of the operands is without meaning.
    pub(super) fn is_commutative(self) -> bool {
        matches!(self, Binary::Sum | Binary::Product | Binary::Minimum | Binary::Maximum)
    }

    /// The values over `a` and `b`.
    #[inline]
    pub(super) fn image(self, a: Interval, b: Interval) -> Interval {
        match self {
            Binary::Sum => a + b,
            Binary::Difference => a - b,
            Binary::Product => a * b,
            Binary::Quotient => a / b,
            Binary::Minimum => a.min(b),
            Binary::Maximum => a.max(b),
            Binary::Angle => a.atan2(b),
            Binary::Power => a.powf(b),
        }
    }

    /// How the function behaves on `a` and `b`.
    #[inline]
    pub(super) fn regularity(self, a: Interval, b: Interval) -> Regularity {
        match self {
            Binary::Quotient => Regularity::continuous_if(!b.contains(0.0)),
            Binary::Power => {
                Regularity::continuous_if(a.lower() > 0.0 || (a.lower() >= 0.0 && b.lower() > 0.0))
            }
            Binary::Angle if a.contains(0.0) && b.contains(0.0) => Regularity::Partial,
            // The angle jumps from -pi to pi where `a` changes sign and `b` is negative.
            Binary::Angle if a.lower() < 0.0 && a.upper() >= 0.0 && b.lower() < 0.0 => Regularity::Defined,
            _ => Regularity::Continuous,
        }
    }

    /// The members of `a` and `b` for which some member of the other gives a value in `image`.
    #[inline]
    pub(super) fn preimage(self, a: Interval, b: Interval, image: Interval) -> (Interval, Interval) {
        match self {
            Binary::Sum => both(a, b, image, Interval::add_rev, Interval::add_rev),
            Binary::Difference => both(a, b, image, Interval::sub_rev1, Interval::sub_rev2),
            Binary::Product => both(a, b, image, Interval::mul_rev, Interval::mul_rev),
            Binary::Quotient => both(a, b, image, Interval::div_rev1, Interval::div_rev2),
            Binary::Minimum => both(a, b, image, Interval::min_rev, Interval::min_rev),
            Binary::Maximum => both(a, b, image, Interval::max_rev, Interval::max_rev),
            Binary::Angle => both(a, b, image, Interval::atan2_rev1, Interval::atan2_rev2),
            Binary::Power => both(a, b, image, Interval::pow_rev1, Interval::pow_rev2),
        }
    }

    /// The partial derivatives over `a` and `b`, where the values are in `image`; at a kink, all slopes between those of
    /// both sides. Never empty.
    #[inline]
    pub(super) fn derivatives(self, a: Interval, b: Interval, image: Interval) -> (Interval, Interval) {
        if image.is_empty() || self.regularity(a, b) < Regularity::Continuous {
            return (Interval::ENTIRE, Interval::ENTIRE);
        }
        let (by_a, by_b) = match self {
            Binary::Sum => (Interval::ONE, Interval::ONE),
            Binary::Difference => (Interval::ONE, -Interval::ONE),
            Binary::Product => (b, a),
            Binary::Quotient => (1.0 / b, -image / b),
            Binary::Minimum => share_of_larger(-a, -b),
            Binary::Maximum => share_of_larger(a, b),
            Binary::Angle => {
                let square = a.sqr() + b.sqr();
                (b / square, -a / square)
            }
            // At zero the slope is infinite for an exponent below 1.
            Binary::Power if a.lower() <= 0.0 && b.lower() <= 1.0 => (Interval::ENTIRE, Interval::ENTIRE),
            Binary::Power => (b * a.powf(b - 1.0), image * a.ln()),
        };
        let known = |derivative: Interval| if derivative.is_empty() { Interval::ENTIRE } else { derivative };
        (known(by_a), known(by_b))
    }
}

/// Contracts the first operand by a reverse operation, then the second one by what is left of the first.
#[inline]
fn both(
    a: Interval,
    b: Interval,
    image: Interval,
    reverse_first: impl Fn(Interval, Interval, Interval) -> Interval,
    reverse_second: impl Fn(Interval, Interval, Interval) -> Interval,
) -> (Interval, Interval) {
    let a = reverse_first(b, image, a);
    (a, reverse_second(a, image, b))
}

/// The slopes of a maximum by its operands.
fn share_of_larger(a: Interval, b: Interval) -> (Interval, Interval) {
    if a.lower() > b.upper() {
        (Interval::ONE, Interval::ZERO)
    } else if b.lower() > a.upper() {
        (Interval::ZERO, Interval::ONE)
    } else {
        let share = Interval::from_bounds(0.0, 1.0);
        (share, share)
    }
}
