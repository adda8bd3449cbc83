//! Expressions: a function written once, in ordinary Rust, and every enclosure and contractor that follows from it.
//!
//! The closure given to [`Expression::new`] is called once, with symbols for its variables. What it does with them is
//! recorded as a list of elementary operations, the *primary constraints* of the seeds. Afterwards the closure is not called
//! again, and nothing is allocated but one workspace for each thread, when it first needs one or a larger one.
//!
//! ```
//! use shoal_interval::contractor::Contractor;
//! use shoal_interval::expression::Expression;
//! use shoal_interval::{Interval, IntervalBox};
//!
//! let range_m = Expression::new(|[x, y]| ((x - 3.0).sqr() + (y - 3.0).sqr()).sqrt());
//!
//! let position = IntervalBox::from([Interval::new(0.0, 3.0)?, Interval::new(0.0, 3.0)?]);
//! assert_eq!(format!("{:.3}", range_m.natural(&position)), "[0.000, 4.243]");
//!
//! // Where are we, if we hear the beacon at 3.9 to 4.0 m?
//! let measured = range_m.contractor(Interval::new(3.9, 4.0)?);
//! assert_eq!(format!("{:.3}", measured.contract(position)), "[0.000, 0.509] x [0.000, 0.509]");
//! # Ok::<(), shoal_interval::IntervalError>(())
//! ```
//!
//! What encloses the values over a box:
//!
//! | form | costs | best when |
//! |---|---|---|
//! | [`natural`](Expression::natural) | one evaluation | each variable occurs once (then it is minimal), or the box is wide |
//! | [`centred`](Expression::centred) | two evaluations, and a gradient for each output | the box is narrow: the excess shrinks with the square of its width |
//! | [`monotone`](Expression::monotone) | one evaluation, and a gradient and two more for each output | the function rises or falls in its variables all over the box |
//! | [`affine`](Expression::affine) | about ten evaluations in two dimensions, more in more | variables occur often and cancel, on boxes of any size |
//!
//! All forms hold every value; each is inside the natural one. A function that is undefined somewhere, such as a root or a
//! quotient, is enclosed where it is defined; [`evaluate`](Expression::evaluate) tells whether it is so everywhere.
//!
//! What follows for set inversion, `{x : f(x) in [y]}`: an [`inclusion_test`](Expression::inclusion_test), a
//! [`contractor`](Expression::contractor), its complement and the [`separator`](Expression::separator) of both.
//!
//! Source: seed 001, sections 2.3.4 and 2.3.5; seed 002, sections 3.4.3 and 3.5.2; Benhamou et al., *Revising hull and box
//! consistency* (HC4-Revise), 1999.

mod affine;
mod binary;
mod forward_backward;
mod gradient;
mod recorder;
mod regularity;
mod symbol;
mod tape;
mod unary;

pub use forward_backward::{ForwardBackward, ForwardBackwardSeparator, InnerForwardBackward};
pub use symbol::{Operand, Symbol};

use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use recorder::Recorder;
use regularity::Regularity;
use std::sync::Arc;
use tape::{Tape, with_workspace};

/// A function from `N` real numbers to `M`, made of elementary operations; see [this module](self).
///
/// A clone shares the recorded operations.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression<const N: usize, const M: usize> {
    tape: Arc<Tape>,
}

/// What is known of the values of an expression over a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation<const M: usize> {
    /// Holds the values at all vectors of the box for which there is one; empty when there is none.
    pub range: IntervalBox<M>,
    /// Whether it is proved that there is a value at every vector of the box.
    pub defined: bool,
    /// Whether it is proved that the expression, restricted to the box, is also continuous.
    pub continuous: bool,
}

impl<const N: usize> Expression<N, 1> {
    /// The function that `formula` computes.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let f = Expression::new(|[x, y]| x * y + (x + y).cos() - (x + 2.0).sqrt());
    /// let domain = IntervalBox::from([Interval::new(0.0, 1.0)?, Interval::new(0.0, 0.5)?]);
    /// assert_eq!(format!("{:.3}", f.natural(&domain)), "[-1.662, 0.086]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Symbols of two expressions cannot be mixed:
    ///
    /// ```compile_fail
    /// use shoal_interval::expression::Expression;
    ///
    /// Expression::new(|[x]| {
    ///     Expression::new(|[y]| x + y);
    ///     x
    /// });
    /// ```
    ///
    /// Source: the example of seed 001, section 2.3.4.
    pub fn new<F>(formula: F) -> Expression<N, 1>
    where
        F: for<'tape> FnOnce([Symbol<'tape>; N]) -> Symbol<'tape>,
    {
        Expression::system(|variables| [formula(variables)])
    }
}

impl<const N: usize, const M: usize> Expression<N, M> {
    /// The function whose `M` outputs `formulas` computes; what they have in common is evaluated once.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let polar = Expression::system(|[x, y]| [(x.sqr() + y.sqr()).sqrt(), y / x]);
    /// let domain = IntervalBox::from([Interval::new(3.0, 4.0)?, Interval::new(4.0, 6.0)?]);
    /// assert_eq!(format!("{:.1}", polar.natural(&domain)), "[5.0, 7.3] x [1.0, 2.0]");
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    pub fn system<F>(formulas: F) -> Expression<N, M>
    where
        F: for<'tape> FnOnce([Symbol<'tape>; N]) -> [Symbol<'tape>; M],
    {
        let recorder = Recorder::new(N);
        let results = formulas(std::array::from_fn(|axis| recorder.variable(axis))).map(Symbol::slot);
        Expression { tape: Arc::new(recorder.into_tape(N, &results)) }
    }

    /// Encloses the values over `domain` by the natural inclusion function, and tells whether there are values everywhere.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let root = Expression::new(|[x]| x.sqrt());
    /// let evaluation = root.evaluate(&IntervalBox::from([Interval::new(-1.0, 4.0)?]));
    /// assert_eq!(evaluation.range[0], Interval::new(0.0, 2.0)?);
    /// assert!(!evaluation.defined);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// The empty domain gives the empty range, and nothing undefined. Source: IEEE 1788-2015, clause 11 (decorations).
    pub fn evaluate(&self, domain: &IntervalBox<N>) -> Evaluation<M> {
        if domain.is_empty() {
            return Evaluation { range: IntervalBox::EMPTY, defined: true, continuous: true };
        }
        with_workspace(self.tape.slots(), |values| {
            let regularity = self.tape.forward_with_regularity(&domain.sides(), values);
            Evaluation {
                range: self.outputs_of(values),
                defined: regularity >= Regularity::Defined,
                continuous: regularity == Regularity::Continuous,
            }
        })
    }

    /// The natural inclusion function: every operation is done with intervals.
    ///
    /// Holds the value at every vector of `domain` that has one. Inclusion monotonic; minimal but for rounding when each
    /// variable occurs once and the function is continuous; convergent when it is continuous.
    ///
    /// Source: seed 001, section 2.3.4.
    #[inline]
    pub fn natural(&self, domain: &IntervalBox<N>) -> IntervalBox<M> {
        if domain.is_empty() {
            return IntervalBox::EMPTY;
        }
        with_workspace(self.tape.slots(), |values| {
            self.tape.forward(&domain.sides(), values);
            self.outputs_of(values)
        })
    }

    /// How `domain` lies to the set `{x : f(x) is defined and in target}`.
    ///
    /// [`Membership::Inside`] is answered only when the function is proved to be defined on all of `domain`. The empty
    /// domain is outside.
    ///
    /// ```
    /// use shoal_interval::expression::Expression;
    /// use shoal_interval::{Interval, IntervalBox, Membership};
    ///
    /// let root = Expression::new(|[x]| x.sqrt());
    /// let below_two = Interval::new(0.0, 2.0)?;
    /// let test = |lower, upper| Ok(root.inclusion_test(&IntervalBox::from([Interval::new(lower, upper)?]), below_two));
    /// assert_eq!(test(0.0, 1.0)?, Membership::Inside);
    /// assert_eq!(test(5.0, 9.0)?, Membership::Outside);
    /// assert_eq!(test(-1.0, 1.0)?, Membership::Undecided);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    ///
    /// Source: seed 001, table 2.2; seed 002, section 3.5.
    pub fn inclusion_test(&self, domain: &IntervalBox<N>, target: impl Into<IntervalBox<M>>) -> Membership {
        let target = target.into();
        let evaluation = self.evaluate(domain);
        if (evaluation.range & target).is_empty() {
            Membership::Outside
        } else if evaluation.defined && evaluation.range.is_subset_of(&target) {
            Membership::Inside
        } else {
            Membership::Undecided
        }
    }

    fn outputs_of(&self, values: &[Interval]) -> IntervalBox<M> {
        let range: IntervalBox<M> = std::array::from_fn(|output| values[self.tape.outputs[output]]).into();
        if range.is_empty() { IntervalBox::EMPTY } else { range }
    }
}

#[cfg(test)]
mod tests;
