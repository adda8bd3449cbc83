//! Contractors for the distance between two points, and for a ping that travels it.

use super::Contracted;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// Contracts two boxes and an interval linked by `‖a - b‖ = range`, the Euclidean norm, all in the same unit.
///
/// One forward-backward pass. No triple of points and number that satisfies the equation is ever lost; an axis is contracted
/// with what the other axes leave of the squared range, and stays on its own side when only one of the two roots is
/// possible.
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
pub fn contract_distance<const N: usize>(
    a: &mut IntervalBox<N>,
    b: &mut IntervalBox<N>,
    range: &mut Interval,
) -> Contracted {
    let before = (*a, *b, *range);

    let mut difference = *a - *b;
    let mut squares: [Interval; N] = std::array::from_fn(|axis| difference[axis].sqr());
    *range = *range & sum(&squares).sqrt() & Interval::NON_NEGATIVE;
    let square_of_range = range.sqr();
    for axis in 0..N {
        let others = sum_without(&squares, axis);
        squares[axis] = squares[axis] & (square_of_range - others);
        difference[axis] = difference[axis].with_square_in(squares[axis]);
        a[axis] = a[axis] & (b[axis] + difference[axis]);
        b[axis] = b[axis] & (a[axis] - difference[axis]);
    }

    if a.is_empty() || b.is_empty() || range.is_empty() {
        (*a, *b, *range) = (IntervalBox::EMPTY, IntervalBox::EMPTY, Interval::EMPTY);
        Contracted::Empty
    } else if (*a, *b, *range) == before {
        Contracted::Unchanged
    } else {
        Contracted::Narrowed
    }
}

/// Contracts everything that a ping links: `‖position - emitter‖ = sound_speed * (reception - emission)`.
///
/// `position` is where the receiver is at `reception`, `emitter` where the sender was at `emission`; metres, metres per
/// second and seconds of true time. One forward-backward pass, which loses no solution. Returns whether anything is
/// left; when nothing is, all five sets are empty.
///
/// ```
/// use shoal_interval::contractor::contract_range;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let mut position = IntervalBox::from([Interval::new(0.0, 200.0)?, Interval::ZERO, Interval::ZERO]);
/// let mut emitter = IntervalBox::from([Interval::ZERO; 3]);
/// let mut sound_speed = Interval::point(1500.0)?;
/// let mut reception = Interval::new(10.0, 10.2)?;
/// let mut emission = Interval::point(9.9)?;
/// assert!(contract_range(&mut position, &mut emitter, &mut sound_speed, &mut reception, &mut emission));
/// assert_eq!(format!("{:.3}", position[0]), "[149.999, 200.000]");
/// assert_eq!(format!("{reception:.3}"), "[10.000, 10.034]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equations (5.4) and (5.7).
#[must_use = "an empty result says that the sets contradict each other"]
pub fn contract_range<const N: usize>(
    position: &mut IntervalBox<N>,
    emitter: &mut IntervalBox<N>,
    sound_speed: &mut Interval,
    reception: &mut Interval,
    emission: &mut Interval,
) -> bool {
    let mut delay = *reception - *emission;
    let mut range = *sound_speed * delay;
    let contracted = contract_distance(position, emitter, &mut range);

    delay = delay.with_product_in(*sound_speed, range);
    *sound_speed = sound_speed.with_product_in(delay, range);
    *reception = *reception & (*emission + delay);
    *emission = *emission & (*reception - delay);

    let empty = contracted == Contracted::Empty
        || [*sound_speed, *reception, *emission].into_iter().any(Interval::is_empty);
    if empty {
        (*position, *emitter) = (IntervalBox::EMPTY, IntervalBox::EMPTY);
        (*sound_speed, *reception, *emission) = (Interval::EMPTY, Interval::EMPTY, Interval::EMPTY);
    }
    !empty
}

fn sum(terms: &[Interval]) -> Interval {
    terms.iter().fold(Interval::ZERO, |total, &term| total + term)
}

/// The sum of all terms but one. Subtracting that one from the full sum would count its width twice.
fn sum_without(terms: &[Interval], left_out: usize) -> Interval {
    sum(&terms[..left_out]) + sum(&terms[left_out + 1..])
}

#[cfg(test)]
mod tests;
