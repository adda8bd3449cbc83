//! Derivatives by a backward sweep, and the enclosures that they give.

use super::Expression;
use super::regularity::Regularity;
use super::tape::{Operation, Tape, with_workspace};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::interval_matrix::IntervalMatrix;

impl<const N: usize, const M: usize> Expression<N, M> {
    /// Encloses the partial derivatives over `domain`: row `j` holds those of output `j` by each variable.
    ///
    /// Row `j` holds the gradient at every vector of `domain` at which all operations are differentiable. Where an
    /// absolute value, a minimum or a maximum has a kink it holds all slopes between those of both sides. An entry is
    /// [`Interval::ENTIRE`] where the function may be undefined, may jump, or where nothing better is known. The empty
    /// domain gives the empty matrix.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let f = Expression::system(|[x, y]| [x * y, (x - y).abs()]);
    /// let domain = IntervalBox::from([Interval::new(1.0, 2.0)?, Interval::new(1.5, 3.0)?]);
    /// assert_eq!(f.jacobian(&domain).to_string(), "[[1.5, 3], [1, 2]], [[-1, 1], [-1, 1]]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// One forward sweep and, for each output, one backward sweep (adjoint mode of automatic differentiation). Source: A.
    /// Griewank and A. Walther, *Evaluating Derivatives*, 2nd edition, chapter 3; F. Clarke, *Optimization and Nonsmooth
    /// Analysis*, chapter 2, for the kinks.
    pub fn jacobian(&self, domain: &IntervalBox<N>) -> IntervalMatrix<M, N> {
        if domain.is_empty() {
            return IntervalMatrix::EMPTY;
        }
        with_workspace(2 * self.tape.slots(), |workspace| {
            let (values, adjoints) = workspace.split_at_mut(self.tape.slots());
            self.tape.forward(&domain.sides(), values);
            self.jacobian_of(values, adjoints)
        })
    }

    /// The mean value form `f(m) + J (x - m)` with `m` in the middle, met with the natural form.
    ///
    /// Holds the value at every vector of `domain` that has one. Its excess shrinks with the square of the width of
    /// `domain` where the function is smooth. Where the function may be undefined or may jump, this is the natural form.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let f = Expression::new(|[x]| x * (1.0 - x));
    /// let narrow = IntervalBox::from([Interval::new(0.2, 0.21)?]);
    /// assert_eq!(format!("{:.4}", f.natural(&narrow)), "[0.1579, 0.1681]");
    /// assert_eq!(format!("{:.4}", f.centred(&narrow)), "[0.1599, 0.1660]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: R. Moore, R. Kearfott and M. Cloud, *Introduction to Interval Analysis*, section 6.3.
    pub fn centred(&self, domain: &IntervalBox<N>) -> IntervalBox<M> {
        let Some((natural, jacobian)) = self.range_and_jacobian(domain) else {
            return self.natural(domain);
        };
        let middle: [f64; N] = domain.mid().into();
        let middle: IntervalBox<N> =
            middle.map(|coordinate| Interval::spanning(coordinate, coordinate)).into();
        let at_middle = self.natural(&middle);
        natural & (at_middle + jacobian * (*domain - middle))
    }

    /// The natural form at the ends of the variables in which the function rises or falls all over `domain`.
    ///
    /// Holds the value at every vector of `domain` that has one, and is minimal but for rounding when the function is
    /// monotone in every variable. A variable whose partial derivative may have either sign stays an interval. Where the
    /// function may be undefined or may jump, this is the natural form.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let f = Expression::new(|[x]| x.sqr() - x);
    /// let domain = IntervalBox::from([Interval::new(1.0, 2.0)?]);
    /// assert_eq!(f.natural(&domain).to_string(), "[-1, 3]");
    /// assert_eq!(f.monotone(&domain).to_string(), "[0, 2]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: R. Moore, R. Kearfott and M. Cloud, *Introduction to Interval Analysis*, section 6.4.
    pub fn monotone(&self, domain: &IntervalBox<N>) -> IntervalBox<M> {
        let Some((natural, jacobian)) = self.range_and_jacobian(domain) else {
            return self.natural(domain);
        };
        let range: [Interval; M] = std::array::from_fn(|output| {
            let lowest =
                self.natural(&towards(domain, &jacobian.rows()[output], Interval::lower, Interval::upper))
                    [output];
            let highest =
                self.natural(&towards(domain, &jacobian.rows()[output], Interval::upper, Interval::lower))
                    [output];
            natural[output] & Interval::spanning(lowest.lower(), highest.upper())
        });
        range.into()
    }

    /// The natural range and the Jacobian, where the function is continuous on all of `domain`, which is not empty.
    fn range_and_jacobian(&self, domain: &IntervalBox<N>) -> Option<(IntervalBox<M>, IntervalMatrix<M, N>)> {
        if domain.is_empty() {
            return None;
        }
        with_workspace(2 * self.tape.slots(), |workspace| {
            let (values, adjoints) = workspace.split_at_mut(self.tape.slots());
            let regularity = self.tape.forward_with_regularity(&domain.sides(), values);
            (regularity == Regularity::Continuous)
                .then(|| (self.outputs_of(values), self.jacobian_of(values, adjoints)))
        })
    }

    fn jacobian_of(&self, values: &[Interval], adjoints: &mut [Interval]) -> IntervalMatrix<M, N> {
        let rows: [[Interval; N]; M] = std::array::from_fn(|output| {
            self.tape.differentiate(self.tape.outputs[output], values, adjoints);
            std::array::from_fn(
                |axis| if adjoints[axis].is_empty() { Interval::ZERO } else { adjoints[axis] },
            )
        });
        rows.into()
    }
}

/// The part of `domain` in which a function with these slopes takes its extreme values: at `rising` of the variables in
/// which it rises, at `falling` of those in which it falls. A bound that does not exist cannot be taken.
fn towards<const N: usize>(
    domain: &IntervalBox<N>,
    slopes: &[Interval; N],
    rising: fn(Interval) -> f64,
    falling: fn(Interval) -> f64,
) -> IntervalBox<N> {
    let sides: [Interval; N] = std::array::from_fn(|axis| {
        let (side, slope) = (domain[axis], slopes[axis]);
        let end = if slope.lower() >= 0.0 {
            rising(side)
        } else if slope.upper() <= 0.0 {
            falling(side)
        } else {
            return side;
        };
        if end.is_finite() { Interval::from_bounds(end, end) } else { side }
    });
    sides.into()
}

impl Tape {
    /// Fills `adjoints` with the derivatives of the value in slot `output` by every slot, over the enclosures in `values`.
    /// A slot that has no part in the output gets the empty set, which is not the same as a slope of zero.
    fn differentiate(&self, output: usize, values: &[Interval], adjoints: &mut [Interval]) {
        adjoints.fill(Interval::EMPTY);
        adjoints[output] = Interval::ONE;
        let first = self.first_operation();
        for (offset, &operation) in self.operations.iter().enumerate().rev() {
            let result = first + offset;
            let adjoint = adjoints[result];
            if adjoint.is_empty() {
                continue;
            }
            let mut contribute = |slot: usize, derivative: Interval| {
                let contribution = chain(adjoint, derivative);
                let known = adjoints[slot];
                adjoints[slot] = if known.is_empty() { contribution } else { known + contribution };
            };
            match operation {
                Operation::Unary(function, x) => {
                    contribute(x, function.derivative(values[x], values[result]))
                }
                Operation::Binary(function, a, b) => {
                    let (by_a, by_b) = function.derivatives(values[a], values[b], values[result]);
                    contribute(a, by_a);
                    contribute(b, by_b);
                }
            }
        }
    }
}

/// The chain rule. A slope without bound times one that may be zero can be anything: `sqrt(x^2)` at zero.
#[inline]
fn chain(outer: Interval, inner: Interval) -> Interval {
    let is_indeterminate =
        |unbounded: Interval, zero: Interval| !unbounded.is_bounded() && zero.contains(0.0);
    if is_indeterminate(outer, inner) || is_indeterminate(inner, outer) {
        Interval::ENTIRE
    } else {
        outer * inner
    }
}
