//! Times as people write them, in decimal seconds or milliseconds, become whole nanoseconds without rounding.

/// A text that is no whole number of nanoseconds, or further than 292 years from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotWhole;

/// Nanoseconds of a decimal number in a unit of `10^unit_exponent` ns: 9 for seconds, 6 for milliseconds.
///
/// Works on the digits, because 0.1 s is 100,000,000 ns while the binary double nearest to 0.1 is not.
pub(crate) fn ns_of_decimal(text: &str, unit_exponent: i64) -> Result<i64, NotWhole> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().map_err(|_| NotWhole)?),
        None => (text, 0),
    };
    let (negative, digits) = match mantissa.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, mantissa.strip_prefix('+').unwrap_or(mantissa)),
    };
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let fraction = fraction.trim_end_matches('0');
    if whole.is_empty() && fraction.is_empty() {
        return Err(NotWhole);
    }
    let mut value: i128 = 0;
    for digit in whole.bytes().chain(fraction.bytes()) {
        if !digit.is_ascii_digit() {
            return Err(NotWhole);
        }
        value = value
            .checked_mul(10)
            .and_then(|value| value.checked_add(i128::from(digit - b'0')))
            .ok_or(NotWhole)?;
    }
    let mut shift = exponent
        .checked_add(unit_exponent)
        .and_then(|shift| shift.checked_sub(i64::try_from(fraction.len()).ok()?))
        .ok_or(NotWhole)?;
    while shift > 0 && value != 0 {
        value = value.checked_mul(10).ok_or(NotWhole)?;
        shift -= 1;
    }
    while shift < 0 && value != 0 {
        if value % 10 != 0 {
            return Err(NotWhole);
        }
        value /= 10;
        shift += 1;
    }
    i64::try_from(if negative { -value } else { value }).map_err(|_| NotWhole)
}

/// Nanoseconds as a person writes milliseconds: the whole ones when there is one, else all digits.
pub(crate) fn ms_text(ns: i64) -> String {
    if ns >= 1_000_000 { (ns / 1_000_000).to_string() } else { (ns as f64 / 1e6).to_string() }
}

#[cfg(test)]
mod tests {
    use super::{NotWhole, ns_of_decimal};

    #[test]
    fn decimals_are_exact() {
        assert_eq!(ns_of_decimal("0.1", 9), Ok(100_000_000));
        assert_eq!(ns_of_decimal("1e-9", 9), Ok(1));
        assert_eq!(ns_of_decimal("-2.50", 6), Ok(-2_500_000));
        assert_eq!(ns_of_decimal("9223372036.854775807", 9), Ok(i64::MAX));
        assert_eq!(ns_of_decimal("0e999999999", 9), Ok(0));
    }

    #[test]
    fn what_is_not_whole_is_refused() {
        for text in
            ["1e-10", "0.0000000001", "9223372036.854775808", "1e999999999", "nan", "inf", "", ".", "1e"]
        {
            assert_eq!(ns_of_decimal(text, 9), Err(NotWhole), "{text}");
        }
    }
}
