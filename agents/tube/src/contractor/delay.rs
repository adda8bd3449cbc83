//! A trajectory that follows another after a known delay.

use super::asynchronous::{both_or_none, finite};
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::contractor::Contracted;

/// Contracts two tubes by `x(t) = y(t - tau)`, with a delay `tau` of `delay_s` seconds of any sign.
///
/// The tubes may be cut at any times: a slice keeps what the other tube says over the shifted times, all slices that these
/// touch. Nothing is removed from slices of which the shifted times are not all in the domain of the other tube. In
/// linear time. Minimal when the shift leads from borders to borders.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_tube::contractor::contract_delay;
/// use shoal_tube::{TimeDomain, Tube};
///
/// let time = TimeDomain::uniform(0.0, 0.5, 10)?;
/// let mut echo = Tube::constant(time.clone(), Interval::ENTIRE);
/// let mut call = Tube::from_function(time, |t| t.sqr());
/// contract_delay(&mut echo, &mut call, 1.5)?;
/// assert_eq!(echo.at(3.5)?, Interval::point(4.0)?);
/// assert_eq!(echo.at(0.5)?, Interval::ENTIRE);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the delay is not finite.
///
/// Source: seed 001, proposition 3, equation (4.18).
pub fn contract_delay<T: Enclosure>(
    x: &mut Tube<T>,
    y: &mut Tube<T>,
    delay_s: f64,
) -> Result<Contracted, TubeError> {
    let delay_s = finite(delay_s)?;
    let mut contracted = Contracted::Unchanged;
    if !x.is_empty() && !y.is_empty() {
        contracted = x.narrow_everywhere(Direction::Forward, |_, times_s| y.looked_over(times_s - delay_s));
        let of_y = y.narrow_everywhere(Direction::Forward, |_, times_s| x.looked_over(times_s + delay_s));
        contracted = together(contracted, of_y);
    }
    Ok(both_or_none(x, y, contracted, Constraint::Delay))
}
