//! The contractor for the distance between two points.
//!
//! Every range measurement of every AUV ends here, so this is written on bounds: nothing is computed for a bound that
//! cannot move. Forward, a square root is taken only when the points bound the range; backward, only for an axis that the
//! range bounds.

use super::Contracted;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::lanes;
use crate::rounding::{mul_down, mul_up, sqrt_down, sqrt_up};
use crate::set::{larger, smaller};

/// Contracts two boxes and an interval linked by `‖a - b‖ = range`, the Euclidean norm, all in the same unit.
///
/// One forward-backward pass. No triple of points and number that satisfies the equation is ever lost; an axis is contracted
/// with what the other axes leave of the squared range, and stays on its own side when only one of the two roots is
/// possible. As each coordinate appears once in the equation, the one pass is minimal: a second one moves bounds by
/// rounding only.
///
/// ```
/// use shoal_interval::contractor::{Contracted, contract_distance};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let mut beacon = IntervalBox::from([Interval::ZERO, Interval::ZERO]);
/// let mut vehicle = IntervalBox::from([Interval::new(1.0, 9.0)?, Interval::new(-3.0, 3.0)?]);
/// let mut range_m = Interval::new(4.0, 5.0)?;
/// assert_eq!(contract_distance(&mut beacon, &mut vehicle, &mut range_m), Contracted::Narrowed);
/// assert_eq!(format!("{vehicle:.2}"), "[2.64, 5.00] x [-3.00, 3.00]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equation (2.33) and table 2.1.
#[inline]
pub fn contract_distance<const N: usize>(
    a: &mut IntervalBox<N>,
    b: &mut IntervalBox<N>,
    range: &mut Interval,
) -> Contracted {
    let contracted = contract(a, b, range);
    if let Some(narrowed) = contracted {
        return Contracted::from_flags(false, narrowed);
    }
    (*a, *b, *range) = (IntervalBox::EMPTY, IntervalBox::EMPTY, Interval::EMPTY);
    Contracted::Empty
}

/// Whether anything was removed; `None` when nothing is left, and then what is in the arguments has no meaning.
#[inline]
fn contract<const N: usize>(
    a: &mut IntervalBox<N>,
    b: &mut IntervalBox<N>,
    range: &mut Interval,
) -> Option<bool> {
    let range_is_empty = range.upper() < 0.0 || range.is_empty();
    if range_is_empty || a.is_empty() || b.is_empty() {
        return None;
    }
    let differences = (*a - *b).sides();
    let squares = lanes::squares(&differences).unwrap_or_else(|| differences.map(Interval::sqr));
    let (sum, others) = sums_of_others(&squares);

    let mut narrowed = false;
    let shortest = larger(range.lower(), 0.0);
    let (mut least, mut most) = (mul_down(shortest, shortest), mul_up(range.upper(), range.upper()));
    let (mut lower, mut upper) = (shortest, range.upper());
    if sum.lower() > least {
        least = sum.lower();
        lower = larger(lower, sqrt_down(sum.lower()));
    }
    if sum.upper() < most {
        most = sum.upper();
        upper = smaller(upper, sqrt_up(sum.upper()));
    }
    if least > most || lower > upper {
        return None;
    }
    if lower != range.lower() || upper != range.upper() {
        *range = Interval::from_bounds(lower, upper);
        narrowed = true;
    }

    let left = IntervalBox::from([Interval::from_bounds(least, most); N]) - IntervalBox::from(others);
    let mut part = differences;
    let mut cut = false;
    for axis in 0..N {
        let (known, wanted) = (Bounds::of(squares[axis]), Bounds::of(left[axis]));
        if wanted.lower > known.lower || wanted.upper < known.upper {
            part[axis] = Bounds::of(differences[axis]).with_square_in(known, wanted)?;
            cut |= part[axis] != differences[axis];
        }
    }
    if cut {
        // A side whose difference is still the whole one stays as it is: rounding outwards adds to that, and takes nothing away.
        let part = IntervalBox::from(part);
        let (new_a, new_b) = (*a & (*b + part), *b & (*a - part));
        if new_a.is_empty() || new_b.is_empty() {
            return None;
        }
        narrowed |= new_a != *a || new_b != *b;
        (*a, *b) = (new_a, new_b);
    }
    Some(narrowed)
}

/// The sum of all squares, and for each axis that of the others: to take its own from the sum of all would count its width twice.
#[inline(always)]
fn sums_of_others<const N: usize>(squares: &[Interval; N]) -> (Interval, [Interval; N]) {
    let mut others = [Interval::ZERO; N];
    let Some((&last, front)) = squares.split_last() else { return (Interval::ZERO, others) };
    // Of those behind each axis, and then of those before it, too.
    let mut after = last;
    for axis in (0..front.len()).rev() {
        others[axis] = after;
        after = front[axis] + after;
    }
    let mut before = squares[0];
    for axis in 1..N {
        others[axis] = if axis < front.len() { before + others[axis] } else { before };
        if axis < front.len() {
            before += squares[axis];
        }
    }
    (after, others)
}

/// An interval that is not empty, and need not be looked at for that again.
#[derive(Clone, Copy, PartialEq)]
struct Bounds {
    lower: f64,
    upper: f64,
}

impl Bounds {
    #[inline]
    fn of(interval: Interval) -> Bounds {
        Bounds { lower: interval.lower(), upper: interval.upper() }
    }

    /// The hull of the numbers whose square, already known to be in `known`, is in `wanted`.
    #[inline]
    fn with_square_in(self, known: Bounds, wanted: Bounds) -> Option<Interval> {
        let Bounds { mut lower, mut upper } = self;
        if wanted.upper < known.upper {
            if wanted.upper < 0.0 {
                return None;
            }
            let root = sqrt_up(wanted.upper);
            lower = larger(lower, -root);
            upper = smaller(upper, root);
        }
        if wanted.lower > known.lower {
            // The numbers between the two roots are too small: a bound that is there moves to the root on its far side.
            let root = sqrt_down(wanted.lower);
            let (below, above) = (lower <= -root, upper >= root);
            if !below {
                lower = larger(lower, root);
            }
            if !above {
                upper = smaller(upper, -root);
            }
        }
        (lower <= upper).then(|| Interval::from_bounds(lower, upper))
    }
}

#[cfg(test)]
mod tests;
