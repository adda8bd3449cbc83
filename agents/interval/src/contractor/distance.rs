//! The contractor for the distance between two points.
//!
//! Every range measurement of every AUV ends here, so this is written on bounds: nothing is computed for a bound that
//! cannot move. Forward, a square root is taken only when the points bound the range; backward, only for an axis that the
//! range bounds.

use super::Contracted;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::lanes;
use crate::rounding::{add_down, add_up, mul_down, mul_up, sqrt_down, sqrt_up, sub_down, sub_up};
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
    let squares = match lanes::squares(&differences) {
        Some(squares) => squares.map(Bounds::of),
        None => differences.map(|difference| Bounds::of(difference).square()),
    };
    let differences = differences.map(Bounds::of);

    // The squares before an axis and those after it; subtracting its own from the sum of all would count its width twice.
    let mut after = [Bounds::ZERO; N];
    for axis in (1..N).rev() {
        after[axis - 1] = if axis + 1 == N { squares[axis] } else { squares[axis].plus(after[axis]) };
    }
    let sum = if N == 0 {
        Bounds::ZERO
    } else if N == 1 {
        squares[0]
    } else {
        squares[0].plus(after[0])
    };

    let mut narrowed = false;
    let shortest = larger(range.lower(), 0.0);
    let mut square =
        Bounds { lower: mul_down(shortest, shortest), upper: mul_up(range.upper(), range.upper()) };
    let (mut lower, mut upper) = (shortest, range.upper());
    if sum.lower > square.lower {
        square.lower = sum.lower;
        lower = larger(lower, sqrt_down(sum.lower));
    }
    if sum.upper < square.upper {
        square.upper = sum.upper;
        upper = smaller(upper, sqrt_up(sum.upper));
    }
    if square.lower > square.upper || lower > upper {
        return None;
    }
    if lower != range.lower() || upper != range.upper() {
        *range = Interval::from_bounds(lower, upper);
        narrowed = true;
    }

    let mut before = Bounds::ZERO;
    for axis in 0..N {
        let others = if axis == 0 {
            after[0]
        } else if axis + 1 == N {
            before
        } else {
            before.plus(after[axis])
        };
        before = if axis == 0 { squares[0] } else { before.plus(squares[axis]) };
        let left =
            Bounds { lower: sub_down(square.lower, others.upper), upper: sub_up(square.upper, others.lower) };
        if left.lower <= squares[axis].lower && left.upper >= squares[axis].upper {
            continue;
        }
        let whole = differences[axis];
        let part = whole.with_square_in(squares[axis], left)?;
        narrowed |= contract_side(&mut a[axis], &mut b[axis], whole, part)?;
    }
    Some(narrowed)
}

/// Contracts `a` and `b` when `a - b`, known to be in `whole`, must be in `part`; whether that moved a bound.
#[inline]
fn contract_side(a: &mut Interval, b: &mut Interval, whole: Bounds, part: Bounds) -> Option<bool> {
    let (mut new_a, mut new_b) = (Bounds::of(*a), Bounds::of(*b));
    if part.lower > whole.lower {
        new_a.lower = larger(a.lower(), add_down(b.lower(), part.lower));
        new_b.upper = smaller(b.upper(), sub_up(a.upper(), part.lower));
    }
    if part.upper < whole.upper {
        new_a.upper = smaller(a.upper(), add_up(b.upper(), part.upper));
        new_b.lower = larger(b.lower(), sub_down(a.lower(), part.upper));
    }
    if new_a.lower > new_a.upper || new_b.lower > new_b.upper {
        return None;
    }
    let narrowed = new_a != Bounds::of(*a) || new_b != Bounds::of(*b);
    *a = Interval::from_bounds(new_a.lower, new_a.upper);
    *b = Interval::from_bounds(new_b.lower, new_b.upper);
    Some(narrowed)
}

/// An interval that is not empty, and need not be looked at for that again.
#[derive(Clone, Copy, PartialEq)]
struct Bounds {
    lower: f64,
    upper: f64,
}

impl Bounds {
    const ZERO: Bounds = Bounds { lower: 0.0, upper: 0.0 };

    #[inline]
    fn of(interval: Interval) -> Bounds {
        Bounds { lower: interval.lower(), upper: interval.upper() }
    }

    #[inline]
    fn plus(self, other: Bounds) -> Bounds {
        Bounds { lower: add_down(self.lower, other.lower), upper: add_up(self.upper, other.upper) }
    }

    #[inline]
    fn square(self) -> Bounds {
        let smallest = larger(0.0, larger(self.lower, -self.upper));
        let largest = larger(-self.lower, self.upper);
        Bounds { lower: mul_down(smallest, smallest), upper: mul_up(largest, largest) }
    }

    /// The hull of the numbers whose square, already known to be in `known`, is in `wanted`.
    #[inline]
    fn with_square_in(self, known: Bounds, wanted: Bounds) -> Option<Bounds> {
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
        (lower <= upper).then_some(Bounds { lower, upper })
    }
}

#[cfg(test)]
mod tests;
