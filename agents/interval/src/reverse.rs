//! Reverse operations: what an operation's result says about its argument.
//!
//! `c.f_rev(x)` is the hull of the numbers of `x` whose `f` is in `c`. For an operation of two arguments, the known argument
//! is the receiver, `b.f_rev(c, x)`, and a number of `x` stays when *some* number of `b` goes with it; the digit in a name
//! says which argument is sought. These are the backward steps of a forward-backward contractor.
//!
//! No solution is ever lost, nothing is ever added to `x`, and branches are respected: of a periodic function, the lowest
//! and the highest solution in `x` decide. A limit that is not reached is not a solution: no number of `[-1, 0]` has a
//! positive logarithm's exponential, although the hull of those begins at zero. Where there is no solution, or where an
//! operand is empty, the result is empty. Pass [`Interval::ENTIRE`] for `x` when nothing is known about it.
//!
//! Source: IEEE 1788-2015, clauses 10.5.4 and 10.6.2; seed 001, section 2.3.5; Benhamou et al., *Revising hull and box
//! consistency* (HC4-Revise), 1999.

mod atan2;
mod exponential;
mod inverse_trigonometry;
mod order;
mod powers;
mod product;
mod square;
mod sum;
mod trigonometry;

use crate::interval::Interval;

impl Interval {
    /// The numbers of the set that are above `bound`, which itself only closes the hull.
    #[inline]
    fn above(self, bound: f64) -> Interval {
        if self.upper() > bound {
            self.intersection(Interval::from_bounds(bound, f64::INFINITY))
        } else {
            Interval::EMPTY
        }
    }

    /// The numbers of the set that are below `bound`, which itself only closes the hull.
    #[inline]
    fn below(self, bound: f64) -> Interval {
        -(-self).above(-bound)
    }
}

#[cfg(test)]
mod tests;
