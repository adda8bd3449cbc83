//! The contractor for a ping: a distance that is travelled between emission and reception.

use super::{Contracted, contract_distance};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// Contracts everything that a ping links: `‖position - emitter‖ = sound_speed * (reception - emission)`.
///
/// `position` is where the receiver is at `reception`, `emitter` where the sender was at `emission`; metres, metres per
/// second and seconds of true time. One forward-backward pass, which loses no solution and, as each variable appears
/// once, is minimal. When nothing is left, all five sets are empty.
///
/// ```
/// use shoal_interval::contractor::{Contracted, contract_range};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let mut position = IntervalBox::from([Interval::new(0.0, 200.0)?, Interval::ZERO, Interval::ZERO]);
/// let mut emitter = IntervalBox::from([Interval::ZERO; 3]);
/// let mut sound_speed = Interval::point(1500.0)?;
/// let mut reception = Interval::new(10.0, 10.2)?;
/// let mut emission = Interval::point(9.9)?;
/// let contracted =
///     contract_range(&mut position, &mut emitter, &mut sound_speed, &mut reception, &mut emission);
/// assert_eq!(contracted, Contracted::Narrowed);
/// assert_eq!(format!("{:.3}", position[0]), "[149.999, 200.000]");
/// assert_eq!(format!("{reception:.3}"), "[10.000, 10.034]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equations (5.4) and (5.7).
#[inline]
pub fn contract_range<const N: usize>(
    position: &mut IntervalBox<N>,
    emitter: &mut IntervalBox<N>,
    sound_speed: &mut Interval,
    reception: &mut Interval,
    emission: &mut Interval,
) -> Contracted {
    let before = (*position, *emitter, *sound_speed, *reception, *emission);
    let delay = *reception - *emission;
    let travelled = *sound_speed * delay;
    let mut range = travelled;
    let mut empty = contract_distance(position, emitter, &mut range) == Contracted::Empty;

    // What the range has not lost cannot be missing from what it was computed of.
    if !empty && range != travelled {
        let possible_delay = sound_speed.mul_rev(range, delay);
        *sound_speed = delay.mul_rev(range, *sound_speed);
        if possible_delay != delay {
            let possible_reception = *reception & (*emission + possible_delay);
            *emission = *emission & (*reception - possible_delay);
            *reception = possible_reception;
        }
        empty = sound_speed.is_empty() || reception.is_empty() || emission.is_empty();
    }
    if empty {
        (*position, *emitter) = (IntervalBox::EMPTY, IntervalBox::EMPTY);
        (*sound_speed, *reception, *emission) = (Interval::EMPTY, Interval::EMPTY, Interval::EMPTY);
    }
    Contracted::from_flags(empty, (*position, *emitter, *sound_speed, *reception, *emission) != before)
}

#[cfg(test)]
mod tests;
