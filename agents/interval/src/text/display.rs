//! Intervals written for people, outwards, and exactly.

use super::decimal::Decimal;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use std::fmt;

/// Which way a bound may be moved.
#[derive(Clone, Copy, PartialEq)]
enum Direction {
    Down,
    Up,
}

/// Writes `[lower, upper]`, or `empty`, rounded outwards: what is written holds every number of the set.
///
/// A precision (`{:.2}`) is the number of digits behind the point. Without one each bound has the fewest digits that
/// tell it from all other `f64`, if these are on the outer side, or else 17 significant digits rounded outwards; reading
/// that text moves a bound by at most one unit in the last place.
///
/// ```
/// use shoal_interval::Interval;
///
/// let depth_m = Interval::new(1.239, 12.5)?;
/// assert_eq!(format!("{depth_m:.2}"), "[1.23, 12.50]");
/// let tenth = Interval::point(0.1)?;
/// assert_eq!(tenth.to_string(), "[0.1, 0.10000000000000001]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
impl fmt::Display for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return formatter.write_str("empty");
        }
        let places = formatter.precision();
        let lower = bound(self.lower(), Direction::Down, places);
        let upper = bound(self.upper(), Direction::Up, places);
        write!(formatter, "[{lower}, {upper}]")
    }
}

/// Writes the bounds exactly, as hexadecimal numbers that read back as the same interval, or `empty`.
///
/// ```
/// use shoal_interval::Interval;
///
/// let x = Interval::new(-0.75, 0.1)?;
/// assert_eq!(format!("{x:x}"), "[-0x1.8p-1, 0x1.999999999999ap-4]");
/// assert_eq!(format!("{x:x}").parse(), Ok(x));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
impl fmt::LowerHex for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return formatter.write_str("empty");
        }
        write!(formatter, "[{}, {}]", hexadecimal(self.lower()), hexadecimal(self.upper()))
    }
}

/// Writes the sides joined by `x`, or `empty`; a precision is passed on to the sides.
impl<const N: usize> fmt::Display for IntervalBox<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_sides(self, formatter, fmt::Display::fmt)
    }
}

/// Writes the bounds as they are, as `f64` are written: `[0.1, 0.30000000000000004]`.
impl fmt::Debug for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return formatter.write_str("empty");
        }
        write!(formatter, "[{:?}, {:?}]", self.lower(), self.upper())
    }
}

/// Writes the sides joined by `x` with their bounds as `f64` are written, or `empty`.
impl<const N: usize> fmt::Debug for IntervalBox<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_sides(self, formatter, fmt::Debug::fmt)
    }
}

/// Writes the sides joined by `x`, exactly, or `empty`.
impl<const N: usize> fmt::LowerHex for IntervalBox<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_sides(self, formatter, fmt::LowerHex::fmt)
    }
}

fn write_sides<const N: usize>(
    sides: &IntervalBox<N>,
    formatter: &mut fmt::Formatter<'_>,
    write: impl Fn(&Interval, &mut fmt::Formatter<'_>) -> fmt::Result,
) -> fmt::Result {
    if sides.is_empty() {
        return formatter.write_str("empty");
    }
    for (axis, side) in sides.iter().enumerate() {
        if axis > 0 {
            formatter.write_str(" x ")?;
        }
        write(side, formatter)?;
    }
    Ok(())
}

fn bound(value: f64, direction: Direction, places: Option<usize>) -> String {
    if value.is_infinite() {
        return infinity(value).to_owned();
    }
    let away_from_zero = (value < 0.0) == (direction == Direction::Down);
    let exact = Decimal::exact(value);
    let (digits, text) = match places {
        Some(places) => {
            let rounded = exact.rounded_to_place(places, away_from_zero);
            let text = rounded.plain(Some(places));
            (rounded, text)
        }
        None => {
            let digits = outward(value, exact, away_from_zero);
            let text = digits.readable();
            (digits, text)
        }
    };
    if value < 0.0 && !digits.is_zero() { format!("-{text}") } else { text }
}

fn outward(value: f64, exact: Decimal, away_from_zero: bool) -> Decimal {
    let shortest = Decimal::shortest(value);
    let lost = if away_from_zero { shortest.is_below(&exact) } else { exact.is_below(&shortest) };
    // Seventeen digits are enough to tell every number from its neighbours.
    if lost { exact.rounded(17, away_from_zero) } else { shortest }
}

fn hexadecimal(value: f64) -> String {
    if value.is_infinite() {
        return infinity(value).to_owned();
    }
    let sign = if value < 0.0 { "-" } else { "" };
    let bits = value.abs().to_bits();
    if bits == 0 {
        return "0x0p0".to_owned();
    }
    let (exponent, fraction) = (bits >> 52, bits & ((1 << 52) - 1));
    let (leading, exponent) = if exponent == 0 { (0, -1022) } else { (1, exponent as i64 - 1023) };
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    format!("{sign}0x{leading}{point}{digits}p{exponent}")
}

fn infinity(value: f64) -> &'static str {
    if value < 0.0 { "-inf" } else { "inf" }
}
