//! The functions of one variable that an expression is made of, each with all that the sweeps need to know of it.

use super::regularity::Regularity;
use crate::interval::Interval;

/// A function of one variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unary {
    Negative,
    Square,
    SquareRoot,
    Power(i32),
    Absolute,
    Exponential,
    Logarithm,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
    Floor,
    Sign,
}

impl Unary {
    /// The values over `x`.
    #[inline]
    pub(super) fn image(self, x: Interval) -> Interval {
        match self {
            Unary::Negative => -x,
            Unary::Square => x.sqr(),
            Unary::SquareRoot => x.sqrt(),
            Unary::Power(exponent) => x.powi(exponent),
            Unary::Absolute => x.abs(),
            Unary::Exponential => x.exp(),
            Unary::Logarithm => x.ln(),
            Unary::Sine => x.sin(),
            Unary::Cosine => x.cos(),
            Unary::Tangent => x.tan(),
            Unary::ArcSine => x.asin(),
            Unary::ArcCosine => x.acos(),
            Unary::ArcTangent => x.atan(),
            Unary::Floor => x.floor(),
            Unary::Sign => x.sign(),
        }
    }

    /// How the function behaves on `x`, where its values are in `image`.
    #[inline]
    pub(super) fn regularity(self, x: Interval, image: Interval) -> Regularity {
        match self {
            Unary::SquareRoot => Regularity::continuous_if(x.lower() >= 0.0),
            Unary::Logarithm => Regularity::continuous_if(x.lower() > 0.0),
            Unary::ArcSine | Unary::ArcCosine => Regularity::continuous_if(x.magnitude() <= 1.0),
            Unary::Power(exponent) if exponent < 0 => Regularity::continuous_if(!x.contains(0.0)),
            // Between two poles the tangent is bounded.
            Unary::Tangent => Regularity::continuous_if(image.is_bounded()),
            Unary::Floor | Unary::Sign if !image.is_point() => Regularity::Defined,
            _ => Regularity::Continuous,
        }
    }

    /// The members of `x` whose value may be in `image`.
    #[inline]
    pub(super) fn preimage(self, x: Interval, image: Interval) -> Interval {
        match self {
            Unary::Negative => x & -image,
            Unary::Square => image.sqr_rev(x),
            Unary::SquareRoot => image.sqrt_rev(x),
            Unary::Power(exponent) => image.pown_rev(x, exponent),
            Unary::Absolute => image.abs_rev(x),
            Unary::Exponential => image.exp_rev(x),
            Unary::Logarithm => image.ln_rev(x),
            Unary::Sine => image.sin_rev(x),
            Unary::Cosine => image.cos_rev(x),
            Unary::Tangent => image.tan_rev(x),
            Unary::ArcSine => image.asin_rev(x),
            Unary::ArcCosine => image.acos_rev(x),
            Unary::ArcTangent => image.atan_rev(x),
            Unary::Floor => image.floor_rev(x),
            Unary::Sign => image.sign_rev(x),
        }
    }

    /// The derivatives over `x`, where the values are in `image`; at a kink, all slopes between those of both sides.
    ///
    /// Never empty.
    #[inline]
    pub(super) fn derivative(self, x: Interval, image: Interval) -> Interval {
        if image.is_empty() || self.regularity(x, image) < Regularity::Continuous {
            return Interval::ENTIRE;
        }
        let derivative = match self {
            Unary::Negative => -Interval::ONE,
            Unary::Square => 2.0 * x,
            Unary::SquareRoot => 0.5 / image,
            Unary::Power(exponent) => power_derivative(x, exponent),
            Unary::Absolute => slope_of_absolute(x),
            Unary::Exponential => image,
            Unary::Logarithm => 1.0 / x,
            Unary::Sine => x.cos(),
            Unary::Cosine => -x.sin(),
            Unary::Tangent => 1.0 + image.sqr(),
            Unary::ArcSine => 1.0 / (1.0 - x.sqr()).sqrt(),
            Unary::ArcCosine => -1.0 / (1.0 - x.sqr()).sqrt(),
            Unary::ArcTangent => 1.0 / (1.0 + x.sqr()),
            // The edge of a step is in no closed set that is said to be flat.
            Unary::Floor if x.lower() == image.lower() => Interval::ENTIRE,
            Unary::Sign if x.contains(0.0) => Interval::ENTIRE,
            Unary::Floor | Unary::Sign => Interval::ZERO,
        };
        // Empty at an edge of the domain where the slope is infinite, such as that of the square root at zero.
        if derivative.is_empty() { Interval::ENTIRE } else { derivative }
    }
}

fn power_derivative(x: Interval, exponent: i32) -> Interval {
    match exponent.checked_sub(1) {
        Some(lower) => f64::from(exponent) * x.powi(lower),
        None => Interval::ENTIRE,
    }
}

fn slope_of_absolute(x: Interval) -> Interval {
    if x.lower() > 0.0 {
        Interval::ONE
    } else if x.upper() < 0.0 {
        -Interval::ONE
    } else {
        Interval::from_bounds(-1.0, 1.0)
    }
}
