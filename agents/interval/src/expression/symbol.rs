//! Symbols: what the closure of an expression computes with, while every operation is recorded.

use super::binary::Binary;
use super::recorder::Recorder;
use super::tape::Operation;
use super::unary::Unary;
use crate::interval::Interval;
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that is not known yet: a variable of an [`Expression`](super::Expression), or what was computed from some.
///
/// Symbols are computed with like numbers, mixed with plain numbers and intervals on either side. A plain number stands for
/// itself exactly, NaN for any number. An interval is a parameter: one number that is known to be in it; every
/// mention of an interval is a parameter of its own.
///
/// What is computed twice from the same symbols is evaluated once, and `x * x` is the square of `x`. Functions of
/// constants alone are computed at once.
#[derive(Clone, Copy)]
pub struct Symbol<'tape> {
    recorder: &'tape Recorder,
    slot: usize,
    /// Keeps the symbols of two expressions apart: they have different lifetimes, which must be equal to meet.
    brand: PhantomData<fn(&'tape ()) -> &'tape ()>,
}

/// What a [`Symbol`] can be combined with: another symbol, a plain number or an interval.
pub trait Operand<'tape>: Copy + sealed::Recordable<'tape> {}

mod sealed {
    use super::{Recorder, Symbol};

    pub trait Recordable<'tape> {
        fn record(self, recorder: &'tape Recorder) -> Symbol<'tape>;
    }
}

use sealed::Recordable;

impl<'tape> Operand<'tape> for Symbol<'tape> {}
impl Operand<'_> for f64 {}
impl Operand<'_> for Interval {}

impl<'tape> Recordable<'tape> for Symbol<'tape> {
    fn record(self, _: &'tape Recorder) -> Symbol<'tape> {
        self
    }
}

impl<'tape> Recordable<'tape> for f64 {
    fn record(self, recorder: &'tape Recorder) -> Symbol<'tape> {
        recorder.constant(Interval::spanning(self, self))
    }
}

impl<'tape> Recordable<'tape> for Interval {
    fn record(self, recorder: &'tape Recorder) -> Symbol<'tape> {
        recorder.constant(self)
    }
}

impl<'tape> Symbol<'tape> {
    /// The square; tighter than a product of two enclosures.
    pub fn sqr(self) -> Symbol<'tape> {
        self.unary(Unary::Square)
    }

    /// The square root, undefined for negative numbers.
    pub fn sqrt(self) -> Symbol<'tape> {
        self.unary(Unary::SquareRoot)
    }

    /// The power with a whole exponent; with a negative one it is undefined for zero.
    pub fn powi(self, exponent: i32) -> Symbol<'tape> {
        match exponent {
            1 => self,
            2 => self.sqr(),
            _ => self.unary(Unary::Power(exponent)),
        }
    }

    /// The power with a real exponent, undefined for negative numbers, and for zero unless the exponent is positive.
    pub fn powf(self, exponent: impl Operand<'tape>) -> Symbol<'tape> {
        self.binary(Binary::Power, exponent)
    }

    /// The absolute value.
    pub fn abs(self) -> Symbol<'tape> {
        self.unary(Unary::Absolute)
    }

    /// The exponential.
    pub fn exp(self) -> Symbol<'tape> {
        self.unary(Unary::Exponential)
    }

    /// The natural logarithm, defined for positive numbers.
    pub fn ln(self) -> Symbol<'tape> {
        self.unary(Unary::Logarithm)
    }

    /// The sine of an angle in radians.
    pub fn sin(self) -> Symbol<'tape> {
        self.unary(Unary::Sine)
    }

    /// The cosine of an angle in radians.
    pub fn cos(self) -> Symbol<'tape> {
        self.unary(Unary::Cosine)
    }

    /// The tangent of an angle in radians, undefined at its poles.
    pub fn tan(self) -> Symbol<'tape> {
        self.unary(Unary::Tangent)
    }

    /// The angle in `[-pi/2, pi/2]`, in radians, with this sine; defined on `[-1, 1]`.
    pub fn asin(self) -> Symbol<'tape> {
        self.unary(Unary::ArcSine)
    }

    /// The angle in `[0, pi]`, in radians, with this cosine; defined on `[-1, 1]`.
    pub fn acos(self) -> Symbol<'tape> {
        self.unary(Unary::ArcCosine)
    }

    /// The angle between `-pi/2` and `pi/2`, in radians, with this tangent.
    pub fn atan(self) -> Symbol<'tape> {
        self.unary(Unary::ArcTangent)
    }

    /// The angle in `]-pi, pi]`, in radians, of the vector `(x, self)`, which must not be zero.
    pub fn atan2(self, x: impl Operand<'tape>) -> Symbol<'tape> {
        self.binary(Binary::Angle, x)
    }

    /// The smaller of the two.
    pub fn min(self, other: impl Operand<'tape>) -> Symbol<'tape> {
        self.binary(Binary::Minimum, other)
    }

    /// The larger of the two.
    pub fn max(self, other: impl Operand<'tape>) -> Symbol<'tape> {
        self.binary(Binary::Maximum, other)
    }

    /// The largest whole number that is not above.
    pub fn floor(self) -> Symbol<'tape> {
        self.unary(Unary::Floor)
    }

    /// The smallest whole number that is not below.
    pub fn ceil(self) -> Symbol<'tape> {
        -(-self).floor()
    }

    /// -1, 0 or 1, by the sign.
    pub fn sign(self) -> Symbol<'tape> {
        self.unary(Unary::Sign)
    }

    /// Where the recorder keeps the symbol.
    pub(super) fn slot(self) -> usize {
        self.slot
    }

    /// The symbol of what `recorder` keeps in `slot`.
    pub(super) fn new(recorder: &'tape Recorder, slot: usize) -> Symbol<'tape> {
        Symbol { recorder, slot, brand: PhantomData }
    }

    fn unary(self, function: Unary) -> Symbol<'tape> {
        self.recorder.operation(Operation::Unary(function, self.slot))
    }

    fn binary(self, function: Binary, other: impl Operand<'tape>) -> Symbol<'tape> {
        let other = other.record(self.recorder);
        if self.slot == other.slot {
            match function {
                Binary::Sum => return self * 2.0,
                Binary::Product => return self.sqr(),
                Binary::Minimum | Binary::Maximum => return self,
                _ => (),
            }
        }
        let swap = function.is_commutative() && other.slot < self.slot;
        let (a, b) = if swap { (other.slot, self.slot) } else { (self.slot, other.slot) };
        self.recorder.operation(Operation::Binary(function, a, b))
    }
}

impl fmt::Debug for Symbol<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Symbol({})", self.slot)
    }
}

impl<'tape> Neg for Symbol<'tape> {
    type Output = Symbol<'tape>;

    fn neg(self) -> Symbol<'tape> {
        self.unary(Unary::Negative)
    }
}

macro_rules! operators {
    ($($operator:ident :: $method:ident => $function:ident),*) => {$(
        impl<'tape, T: Operand<'tape>> $operator<T> for Symbol<'tape> {
            type Output = Symbol<'tape>;

            fn $method(self, other: T) -> Symbol<'tape> {
                self.binary(Binary::$function, other)
            }
        }

        impl<'tape> $operator<Symbol<'tape>> for f64 {
            type Output = Symbol<'tape>;

            fn $method(self, other: Symbol<'tape>) -> Symbol<'tape> {
                self.record(other.recorder).binary(Binary::$function, other)
            }
        }

        impl<'tape> $operator<Symbol<'tape>> for Interval {
            type Output = Symbol<'tape>;

            fn $method(self, other: Symbol<'tape>) -> Symbol<'tape> {
                self.record(other.recorder).binary(Binary::$function, other)
            }
        }
    )*};
}

operators!(Add::add => Sum, Sub::sub => Difference, Mul::mul => Product, Div::div => Quotient);
