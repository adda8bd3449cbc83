//! What stands in a line of the suite: intervals, numbers, words and texts.

use shoal_interval::Interval;

/// An operand or a result.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Interval(Interval),
    Number(f64),
    /// A truth value, the name of a relation, or a signal.
    Word(String),
    Text(String),
    /// Numbers in braces, which only reductions take.
    Numbers,
}

/// The values of a line, which spaces part.
pub fn parse_all(text: &str) -> Vec<Value> {
    let mut values = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let end = match first {
            '"' => rest[1..].find('"').map(|end| end + 2),
            '[' => rest.find(']').map(|end| end + 1),
            '{' => rest.find('}').map(|end| end + 1),
            _ => rest.find(' ').or(Some(rest.len())),
        };
        let (value, after) = rest.split_at(end.expect("a closing bracket"));
        values.push(parse(value));
        rest = after.trim_start();
    }
    values
}

fn parse(text: &str) -> Value {
    let inside = || &text[1..text.len() - 1];
    if text.starts_with('"') {
        Value::Text(inside().to_owned())
    } else if text.starts_with('{') {
        Value::Numbers
    } else if text.starts_with('[') {
        Value::Interval(parse_interval(inside()))
    } else {
        parse_number(text).map_or_else(|| Value::Word(text.to_owned()), Value::Number)
    }
}

fn parse_interval(inside: &str) -> Interval {
    match inside.split_once(',') {
        None if inside == "empty" => Interval::EMPTY,
        None if inside == "entire" => Interval::ENTIRE,
        None => panic!("an interval without bounds: {inside}"),
        Some((lower, upper)) => {
            let bound = |text| parse_number(text).expect("a number");
            Interval::new(bound(lower), bound(upper)).expect("bounds in order")
        }
    }
}

/// A decimal or hexadecimal number, an infinity or a NaN.
fn parse_number(text: &str) -> Option<f64> {
    let lowered = text.to_lowercase();
    let (sign, unsigned) = match lowered.strip_prefix('-') {
        Some(unsigned) => (-1.0, unsigned),
        None => (1.0, lowered.strip_prefix('+').unwrap_or(&lowered)),
    };
    let size = match unsigned.strip_prefix("0x") {
        Some(hexadecimal) => parse_hexadecimal(hexadecimal),
        None => unsigned.parse().ok(),
    };
    size.map(|size| sign * size)
}

/// Hexadecimal digits with a binary exponent. The number must be an `f64`, so that no rounding can hide a mistake.
fn parse_hexadecimal(text: &str) -> Option<f64> {
    let (digits, exponent) = text.split_once('p')?;
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let scaled = u64::from_str_radix(&format!("{whole}{fraction}"), 16).ok()?;
    let mut exponent = exponent.parse::<i32>().ok()? - 4 * i32::try_from(fraction.len()).ok()?;
    let mut number = scaled as f64;
    assert_eq!(number as u64, scaled, "more digits than an f64 has: {text}");
    while exponent != 0 {
        let step = exponent.signum();
        let next = if step > 0 { number * 2.0 } else { number / 2.0 };
        assert_eq!(if step > 0 { next / 2.0 } else { next * 2.0 }, number, "not an f64: {text}");
        (number, exponent) = (next, exponent - step);
    }
    Some(number)
}

#[test]
fn numbers_are_read_exactly() {
    let cases = [
        ("-0x1.8p+1", -3.0),
        ("0X0.0000000000001P-1022", f64::from_bits(1)),
        ("+0x1.FFFFFFFFFFFFFp1023", f64::MAX),
        ("0x10000000000001p0", ((1_u64 << 52) + 1) as f64),
        ("0.1", 0.1),
        ("-infinity", f64::NEG_INFINITY),
    ];
    for (text, expected) in cases {
        assert_eq!(parse_number(text), Some(expected), "{text}");
    }
    assert_eq!(parse_number("before"), None);
}
