//! The affine form: every value as a linear function of the variables, and a remainder.

mod bend;

use super::Expression;
use super::binary::Binary;
use super::regularity::Regularity;
use super::tape::{Operation, with_workspace};
use super::unary::Unary;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use bend::Bend;

impl<const N: usize, const M: usize> Expression<N, M> {
    /// Encloses the values over `domain` by affine arithmetic, met with the natural form operation by operation.
    ///
    /// Every value is enclosed by `c + t_1 (x_1 - m_1) + ... + t_N (x_N - m_N)` with `m` the middle of `domain`, so
    /// what occurs several times can cancel. Squares, roots, exponentials, logarithms and reciprocals are replaced by
    /// their best line (Chebyshev), products and the other smooth functions by a tangent; the slopes and the remainder
    /// are intervals, which hold all rounding. Holds the value at every vector of `domain` that has one.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let f = Expression::new(|[x, y]| (x + y).sqr() - (x - y).sqr() - 4.0 * x);
    /// let domain = IntervalBox::from([Interval::new(9.0, 11.0)?, Interval::new(0.9, 1.1)?]);
    /// assert!(f.natural(&domain).width() > 90.0);
    /// assert!(f.affine(&domain).width() < 14.0);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: J. Stolfi and L. de Figueiredo, *Self-Validated Numerical Methods and Applications*, chapter 3; E. Hansen, *A
    /// generalized interval arithmetic*, 1975, for interval slopes.
    pub fn affine(&self, domain: &IntervalBox<N>) -> IntervalBox<M> {
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        let from_middle = domain.sides().map(|side| side - middle_of(side));
        let tape = &self.tape;
        with_workspace(tape.slots() * Form::<N>::LENGTH, |forms| {
            for (axis, &side) in domain.iter().enumerate() {
                Form::<N>::variable(axis, side).store(forms, axis);
            }
            for (index, &constant) in tape.constants.iter().enumerate() {
                Form::<N>::remainder(constant).store(forms, N + index);
            }
            for (offset, &operation) in tape.operations.iter().enumerate() {
                let result = match operation {
                    Operation::Unary(function, x) => unary(function, &Form::load(forms, x)),
                    Operation::Binary(function, a, b) => {
                        binary(function, &Form::load(forms, a), &Form::load(forms, b))
                    }
                };
                result.narrowed(&from_middle).store(forms, tape.first_operation() + offset);
            }
            let range: [Interval; M] =
                std::array::from_fn(|output| Form::<N>::load(forms, tape.outputs[output]).range);
            let range = IntervalBox::from(range);
            if range.is_empty() { IntervalBox::EMPTY } else { range }
        })
    }
}

/// `constant + slopes . (x - middle)`, for some number of each; and the range that this and interval arithmetic leave.
#[derive(Clone, Copy)]
struct Form<const N: usize> {
    range: Interval,
    constant: Interval,
    slopes: [Interval; N],
}

impl<const N: usize> Form<N> {
    const LENGTH: usize = N + 2;

    fn variable(axis: usize, side: Interval) -> Form<N> {
        let mut form = Form::remainder(side);
        if side.is_bounded() {
            form.constant = middle_of(side);
            form.slopes[axis] = Interval::ONE;
        }
        form
    }

    /// The form that knows the range and no slope.
    fn remainder(range: Interval) -> Form<N> {
        Form { range, constant: range, slopes: [Interval::ZERO; N] }
    }

    fn load(forms: &[Interval], slot: usize) -> Form<N> {
        let from = &forms[slot * Self::LENGTH..];
        Form { range: from[0], constant: from[1], slopes: std::array::from_fn(|axis| from[2 + axis]) }
    }

    fn store(&self, forms: &mut [Interval], slot: usize) {
        let to = &mut forms[slot * Self::LENGTH..];
        (to[0], to[1]) = (self.range, self.constant);
        to[2..Self::LENGTH].copy_from_slice(&self.slopes);
    }

    /// The form with its range met with what its slopes give; the slopes are given up when they have no bound.
    fn narrowed(mut self, from_middle: &[Interval; N]) -> Form<N> {
        let is_usable = self.constant.is_bounded() && self.slopes.iter().all(|slope| slope.is_bounded());
        if !is_usable {
            return Form::remainder(self.range);
        }
        let linear = self
            .slopes
            .iter()
            .zip(from_middle)
            .fold(self.constant, |sum, (&slope, &step)| sum + slope * step);
        self.range = self.range & linear;
        self
    }

    /// `factor * self + remainder`, with values known to be in `range`.
    fn scaled(&self, factor: Interval, remainder: Interval, range: Interval) -> Form<N> {
        Form {
            range,
            constant: factor * self.constant + remainder,
            slopes: self.slopes.map(|slope| factor * slope),
        }
    }
}

/// `by_a * a + by_b * b + remainder`, with values known to be in `range`.
fn combined<const N: usize>(
    (by_a, a): (Interval, &Form<N>),
    (by_b, b): (Interval, &Form<N>),
    remainder: Interval,
    range: Interval,
) -> Form<N> {
    Form {
        range,
        constant: by_a * a.constant + by_b * b.constant + remainder,
        slopes: std::array::from_fn(|axis| by_a * a.slopes[axis] + by_b * b.slopes[axis]),
    }
}

fn unary<const N: usize>(function: Unary, x: &Form<N>) -> Form<N> {
    let range = function.image(x.range);
    if function == Unary::Negative {
        return x.scaled(-Interval::ONE, Interval::ZERO, range);
    }
    if !x.range.is_bounded()
        || !range.is_bounded()
        || range.is_empty()
        || function.regularity(x.range, range) < Regularity::Continuous
    {
        return Form::remainder(range);
    }
    if let Some(bend) = Bend::of(function) {
        return bend.linearise(
            x,
            range,
            |x| function.image(x),
            |x| function.derivative(x, function.image(x)),
        );
    }
    let middle = middle_of(x.range);
    let slopes = function.derivative(x.range, range);
    if !slopes.is_bounded() {
        return Form::remainder(range);
    }
    let slope = middle_of(slopes);
    let remainder = function.image(middle) - slope * middle + (slopes - slope) * (x.range - middle);
    x.scaled(slope, remainder, range)
}

fn binary<const N: usize>(function: Binary, a: &Form<N>, b: &Form<N>) -> Form<N> {
    let range = function.image(a.range, b.range);
    match function {
        Binary::Sum => return combined((Interval::ONE, a), (Interval::ONE, b), Interval::ZERO, range),
        Binary::Difference => {
            return combined((Interval::ONE, a), (-Interval::ONE, b), Interval::ZERO, range);
        }
        _ => (),
    }
    if !a.range.is_bounded()
        || !b.range.is_bounded()
        || !range.is_bounded()
        || range.is_empty()
        || function.regularity(a.range, b.range) < Regularity::Continuous
    {
        return Form::remainder(range);
    }
    match function {
        Binary::Product => product(a, b, range),
        Binary::Quotient => {
            let reciprocal = Interval::ONE / b.range;
            let inverse = Bend::Reciprocal.linearise(b, reciprocal, |x| 1.0 / x, |x| -1.0 / x.sqr());
            product(a, &inverse, range)
        }
        _ => tangent(function, a, b, range),
    }
}

/// `a b = a0 b + b0 a - a0 b0 + (a - a0) (b - b0)`, with `a0` and `b0` in the middle.
fn product<const N: usize>(a: &Form<N>, b: &Form<N>, range: Interval) -> Form<N> {
    let (middle_a, middle_b) = (middle_of(a.range), middle_of(b.range));
    let remainder = (a.range - middle_a) * (b.range - middle_b) - middle_a * middle_b;
    combined((middle_b, a), (middle_a, b), remainder, range)
}

/// A function of two variables by the mean value theorem around the middle of its operands.
fn tangent<const N: usize>(function: Binary, a: &Form<N>, b: &Form<N>, range: Interval) -> Form<N> {
    let (middle_a, middle_b) = (middle_of(a.range), middle_of(b.range));
    let (slopes_a, slopes_b) = function.derivatives(a.range, b.range, range);
    if !slopes_a.is_bounded() || !slopes_b.is_bounded() {
        return Form::remainder(range);
    }
    let (by_a, by_b) = (middle_of(slopes_a), middle_of(slopes_b));
    let remainder = function.image(middle_a, middle_b) - by_a * middle_a - by_b * middle_b
        + (slopes_a - by_a) * (a.range - middle_a)
        + (slopes_b - by_b) * (b.range - middle_b);
    combined((by_a, a), (by_b, b), remainder, range)
}

/// A number near the middle of a set that is not empty.
fn middle_of(set: Interval) -> Interval {
    let middle = set.mid();
    Interval::spanning(middle, middle)
}

#[cfg(test)]
mod tests;
