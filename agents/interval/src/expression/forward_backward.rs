//! Forward-backward contraction: the domain by the image, the image by the domain.

use super::Expression;
use super::regularity::Regularity;
use super::tape::with_workspace;
use crate::contractor::{Contracted, Contractor};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::separator::{Separation, Separator};

impl<const N: usize, const M: usize> Expression<N, M> {
    /// Contracts the two boxes linked by `image = f(domain)`, in one forward and one backward sweep (HC4-Revise).
    ///
    /// No pair of a vector and its value is ever lost. Minimal but for rounding when there is one output, each variable
    /// occurs once and all operations are continuous and monotone over the box.
    ///
    /// ```
    /// use shoal_interval::contractor::Contracted;
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let sum = Expression::new(|[x, y]| x + y);
    /// let at_most = |bound| Interval::new(f64::NEG_INFINITY, bound);
    /// let mut terms = IntervalBox::from([at_most(5.0)?, at_most(4.0)?]);
    /// let mut total = IntervalBox::from([Interval::new(6.0, f64::INFINITY)?]);
    ///
    /// assert_eq!(sum.contract(&mut terms, &mut total), Contracted::Narrowed);
    /// assert_eq!(terms.to_string(), "[2, 5] x [1, 4]");
    /// assert_eq!(total.to_string(), "[6, 9]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 003, section 6.2; seed 001, table 2.1; seed 002, algorithm 3.1.
    pub fn contract(&self, domain: &mut IntervalBox<N>, image: &mut IntervalBox<M>) -> Contracted {
        let before = (*domain, *image);
        (*domain, *image) = with_workspace(self.tape.slots(), |values| {
            if domain.is_empty() {
                return (IntervalBox::EMPTY, IntervalBox::EMPTY);
            }
            self.tape.forward(&domain.sides(), values);
            let image = self.outputs_of(values) & *image;
            (self.backward(values, &image), image)
        });
        if domain.is_empty() || image.is_empty() {
            (*domain, *image) = (IntervalBox::EMPTY, IntervalBox::EMPTY);
            Contracted::Empty
        } else if (*domain, *image) == before {
            Contracted::Unchanged
        } else {
            Contracted::Narrowed
        }
    }

    /// A contractor for the set `{x : f(x) is defined and in target}`; guarantees as for
    /// [`contract`](Expression::contract).
    ///
    /// For the equation `f(x) = 0` the target is [`Interval::ZERO`], or a box of zeros.
    ///
    /// ```
    /// use shoal_interval::contractor::Contractor;
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let balance = Expression::new(|[x, y, z]| x + y.sin() - x * z);
    /// let at_most_zero = balance.contractor(Interval::new(f64::NEG_INFINITY, 0.0)?);
    /// let domain = IntervalBox::from([Interval::new(0.5, 1.0)?, Interval::new(-1.0, 1.0)?, Interval::new(-1.0, 0.0)?]);
    /// assert_eq!(format!("{:.3}", at_most_zero.contract(domain)), "[0.500, 0.842] x [-1.000, -0.523] x [-0.683, 0.000]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 003, section 6.4; seed 001, section 2.3.5.
    pub fn contractor(&self, target: impl Into<IntervalBox<M>>) -> ForwardBackward<N, M> {
        ForwardBackward { expression: self.clone(), target: target.into() }
    }

    /// A contractor for what is not in the set `{x : f(x) is defined and in target}`.
    ///
    /// What it removes is proved to be in the set. Vectors where the function is undefined are not in the set, so a box
    /// where it may be undefined stays as it is.
    ///
    /// Source: seed 000, equation (2.33).
    pub fn inner_contractor(&self, target: impl Into<IntervalBox<M>>) -> InnerForwardBackward<N, M> {
        InnerForwardBackward { expression: self.clone(), target: target.into() }
    }

    /// A separator for the set `{x : f(x) is defined and in target}`: its [`contractor`](Expression::contractor) and its
    /// [`inner_contractor`](Expression::inner_contractor), which share one forward sweep.
    ///
    /// Where the expression has intervals as parameters, what is proved is proved for each of their values.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::separator::Separator;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let ring = Expression::new(|[x, y]| x.sqr() + y.sqr()).separator(Interval::new(1.0, 4.0)?);
    /// let cut = ring.separate(IntervalBox::from([Interval::new(0.0, 3.0)?, Interval::new(0.0, 0.5)?]));
    /// assert_eq!(format!("{:.2}", cut.outer), "[0.86, 2.00] x [0.00, 0.50]");
    /// assert_eq!(format!("{:.2}", cut.inner), "[0.00, 3.00] x [0.00, 0.50]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 000, equations (2.32) and (2.33).
    pub fn separator(&self, target: impl Into<IntervalBox<M>>) -> ForwardBackwardSeparator<N, M> {
        ForwardBackwardSeparator { expression: self.clone(), target: target.into() }
    }

    /// The domain that is left when the outputs, after a forward sweep, are contracted to `image`.
    #[inline]
    fn backward(&self, values: &mut [Interval], image: &IntervalBox<M>) -> IntervalBox<N> {
        for (&slot, &side) in self.tape.outputs.iter().zip(image) {
            // Two outputs may share a slot, and an output may be a variable.
            values[slot] = values[slot] & side;
            if values[slot].is_empty() {
                return IntervalBox::EMPTY;
            }
        }
        if self.tape.backward(values) { self.variables_of(values) } else { IntervalBox::EMPTY }
    }

    /// What is left of a box when the outputs are in `target`.
    #[inline]
    fn outer_part(&self, domain: IntervalBox<N>, target: &IntervalBox<M>) -> IntervalBox<N> {
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        let tape = &self.tape;
        with_workspace(tape.slots(), |values| {
            tape.forward(&domain.sides(), values);
            self.backward(values, target)
        })
    }

    /// What is left of a box when some output is outside of `target`: all of it where the function may be undefined.
    fn inner_part(&self, domain: IntervalBox<N>, target: &IntervalBox<M>) -> IntervalBox<N> {
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        let tape = &self.tape;
        with_workspace(2 * tape.slots(), |workspace| {
            let (forward, values) = workspace.split_at_mut(tape.slots());
            if tape.forward_with_regularity(&domain.sides(), forward) == Regularity::Partial {
                return domain;
            }
            self.backward_beyond(forward, values, target)
        })
    }

    /// The hull of what is left when one output, after the forward sweep in `forward`, is beyond one bound of `target`.
    fn backward_beyond(
        &self,
        forward: &[Interval],
        values: &mut [Interval],
        target: &IntervalBox<M>,
    ) -> IntervalBox<N> {
        if target.is_empty() {
            return self.variables_of(forward);
        }
        let mut kept = IntervalBox::EMPTY;
        for (&slot, side) in self.tape.outputs.iter().zip(target) {
            for beyond in [at_most(side.lower()), at_least(side.upper())] {
                let image = forward[slot] & beyond;
                if image.is_empty() {
                    continue;
                }
                values.copy_from_slice(forward);
                values[slot] = image;
                if self.tape.backward(values) {
                    kept = kept | self.variables_of(values);
                }
            }
        }
        kept
    }

    fn variables_of(&self, values: &[Interval]) -> IntervalBox<N> {
        std::array::from_fn(|axis| values[axis]).into()
    }
}

fn at_most(bound: f64) -> Interval {
    if bound == f64::NEG_INFINITY { Interval::EMPTY } else { Interval::from_bounds(f64::NEG_INFINITY, bound) }
}

fn at_least(bound: f64) -> Interval {
    -at_most(-bound)
}

/// The contractor of [`Expression::contractor`].
#[derive(Debug, Clone, PartialEq)]
pub struct ForwardBackward<const N: usize, const M: usize> {
    expression: Expression<N, M>,
    target: IntervalBox<M>,
}

impl<const N: usize, const M: usize> Contractor<N> for ForwardBackward<N, M> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.expression.outer_part(domain, &self.target)
    }
}

/// The contractor of [`Expression::inner_contractor`].
#[derive(Debug, Clone, PartialEq)]
pub struct InnerForwardBackward<const N: usize, const M: usize> {
    expression: Expression<N, M>,
    target: IntervalBox<M>,
}

impl<const N: usize, const M: usize> Contractor<N> for InnerForwardBackward<N, M> {
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.expression.inner_part(domain, &self.target)
    }
}

/// The separator of [`Expression::separator`].
#[derive(Debug, Clone, PartialEq)]
pub struct ForwardBackwardSeparator<const N: usize, const M: usize> {
    expression: Expression<N, M>,
    target: IntervalBox<M>,
}

impl<const N: usize, const M: usize> Separator<N> for ForwardBackwardSeparator<N, M> {
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.expression.inner_part(domain, &self.target)
    }

    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.expression.outer_part(domain, &self.target)
    }

    fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
        if domain.is_empty() {
            return Separation { inner: IntervalBox::EMPTY, outer: IntervalBox::EMPTY };
        }
        let tape = &self.expression.tape;
        with_workspace(2 * tape.slots(), |workspace| {
            let (forward, values) = workspace.split_at_mut(tape.slots());
            let regularity = tape.forward_with_regularity(&domain.sides(), forward);
            let inner = if regularity == Regularity::Partial {
                domain
            } else {
                self.expression.backward_beyond(forward, values, &self.target)
            };
            let outer = self.expression.backward(forward, &self.target);
            Separation { inner, outer }
        })
    }
}
