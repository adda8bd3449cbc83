//! The grammar of interval literals.

use super::error::ParseIntervalError;
use super::exact::Exact;
use super::natural::Natural;
use crate::error::IntervalError;
use crate::interval::Interval;

/// Exponents are cut off here: far beyond all `f64`, far from overflow.
const LARGEST_EXPONENT: i64 = 1 << 40;

pub(super) fn read(text: &str) -> Result<Interval, ParseIntervalError> {
    if text.len() > ParseIntervalError::LONGEST {
        return Err(ParseIntervalError::TooLong { length: text.len() });
    }
    let mut reader = Reader { text, at: 0 };
    reader.skip_blanks();
    let interval = if reader.takes("[") {
        reader.bracketed()?
    } else if reader.takes("empty") {
        Interval::EMPTY
    } else if reader.takes("entire") {
        Interval::ENTIRE
    } else {
        reader.number_or_uncertain()?
    };
    reader.skip_blanks();
    if reader.at < text.len() { Err(reader.unexpected("the end of the text")) } else { Ok(interval) }
}

/// A place in the text.
struct Reader<'text> {
    text: &'text str,
    at: usize,
}

/// The digits before and after the point of a number.
struct Digits<'text> {
    whole: &'text [u8],
    fraction: &'text [u8],
}

impl Digits<'_> {
    fn value(&self, radix: u32) -> Natural {
        let digits = self.whole.iter().chain(self.fraction);
        let values = digits.map(|&digit| char::from(digit).to_digit(radix).unwrap_or(0) as u8);
        Natural::from_digits(values, u64::from(radix))
    }
}

/// A bound of an interval: none, or a number.
enum Bound {
    NegativeInfinity,
    PositiveInfinity,
    Number(Exact),
}

impl<'text> Reader<'text> {
    /// What follows `[`.
    fn bracketed(&mut self) -> Result<Interval, ParseIntervalError> {
        self.skip_blanks();
        let interval = if self.peek() == Some(b']') || self.takes("empty") {
            Interval::EMPTY
        } else if self.takes("entire") {
            Interval::ENTIRE
        } else {
            self.bounds()?
        };
        self.skip_blanks();
        self.expect("]", "`]`")?;
        Ok(interval)
    }

    fn bounds(&mut self) -> Result<Interval, ParseIntervalError> {
        let first = if self.peek() == Some(b',') { Bound::NegativeInfinity } else { self.bound()? };
        self.skip_blanks();
        if !self.takes(",") {
            return match first {
                Bound::Number(number) => Ok(number.enclosure()),
                Bound::NegativeInfinity => {
                    Err(IntervalError::BeyondReals { bound: f64::NEG_INFINITY }.into())
                }
                Bound::PositiveInfinity => Err(IntervalError::BeyondReals { bound: f64::INFINITY }.into()),
            };
        }
        self.skip_blanks();
        let second = if self.peek() == Some(b']') { Bound::PositiveInfinity } else { self.bound()? };
        let lower = match first {
            Bound::NegativeInfinity => f64::NEG_INFINITY,
            Bound::PositiveInfinity => f64::INFINITY,
            Bound::Number(number) => number.enclosure().lower(),
        };
        let upper = match second {
            Bound::NegativeInfinity => f64::NEG_INFINITY,
            Bound::PositiveInfinity => f64::INFINITY,
            Bound::Number(number) => number.enclosure().upper(),
        };
        Ok(Interval::new(lower, upper)?)
    }

    fn bound(&mut self) -> Result<Bound, ParseIntervalError> {
        let negative = self.sign();
        if self.takes("infinity") || self.takes("inf") {
            return Ok(if negative { Bound::NegativeInfinity } else { Bound::PositiveInfinity });
        }
        Ok(Bound::Number(self.number(negative)?))
    }

    /// A number without brackets, of which only the first digits may be certain.
    fn number_or_uncertain(&mut self) -> Result<Interval, ParseIntervalError> {
        let start = self.at;
        let negative = self.sign();
        if !self.starts_with("0x") {
            let digits = self.digits(10)?;
            if self.takes("?") {
                return self.uncertain(negative, &digits);
            }
        }
        self.at = start;
        let negative = self.sign();
        Ok(self.number(negative)?.enclosure())
    }

    /// A number after its sign.
    fn number(&mut self, negative: bool) -> Result<Exact, ParseIntervalError> {
        if self.takes("0x") {
            let digits = self.digits(16)?;
            let exponent = if self.takes("p") { self.exponent()? } else { 0 };
            return Ok(Exact {
                negative,
                numerator: digits.value(16),
                denominator: Natural::from(1),
                exponent_of_ten: 0,
                exponent_of_two: exponent - 4 * digits.fraction.len() as i64,
            });
        }
        let start = self.at;
        let digits = self.digits(10)?;
        let is_whole = self.text[start..self.at].bytes().all(|byte| byte.is_ascii_digit());
        let mut number = Exact {
            negative,
            numerator: digits.value(10),
            denominator: Natural::from(1),
            exponent_of_ten: -(digits.fraction.len() as i64),
            exponent_of_two: 0,
        };
        if is_whole && self.takes("/") {
            let denominator = Digits { whole: self.run_of_digits(10), fraction: &[] };
            if denominator.whole.is_empty() {
                return Err(self.unexpected("a digit"));
            }
            number.denominator = denominator.value(10);
            if number.denominator.is_zero() {
                return Err(ParseIntervalError::ZeroDenominator { character: self.character() });
            }
        } else if self.takes("e") {
            number.exponent_of_ten += self.exponent()?;
        }
        Ok(number)
    }

    /// What follows `?`: the radius in units of the last place, the direction, the exponent.
    fn uncertain(&mut self, negative: bool, digits: &Digits) -> Result<Interval, ParseIntervalError> {
        let unknown = self.takes("?");
        // In halves of the last place, of which one is the radius if none is written.
        let mut radius = Natural::from(1);
        let written = if unknown { &[] } else { self.run_of_digits(10) };
        if !written.is_empty() {
            radius = Digits { whole: written, fraction: &[] }.value(10).times_power_of_two(1);
        }
        let upwards = self.takes("u");
        let downwards = !upwards && self.takes("d");
        let exponent = if self.takes("e") { self.exponent()? } else { 0 } - digits.fraction.len() as i64;

        let middle = digits.value(10).times_power_of_two(1);
        let at = |negative: bool, halves: Natural| {
            let denominator = Natural::from(2);
            let number = Exact {
                negative,
                numerator: halves,
                denominator,
                exponent_of_ten: exponent,
                exponent_of_two: 0,
            };
            number.enclosure()
        };
        let centre = at(negative, middle.clone());
        let further = at(negative, middle.clone().plus(&radius));
        let crosses_zero = radius > middle;
        let nearer = at(negative != crosses_zero, middle.distance(radius));
        let (below, above) = if negative { (further, nearer) } else { (nearer, further) };
        let lower = if upwards {
            centre.lower()
        } else if unknown {
            f64::NEG_INFINITY
        } else {
            below.lower()
        };
        let upper = if downwards {
            centre.upper()
        } else if unknown {
            f64::INFINITY
        } else {
            above.upper()
        };
        Ok(Interval::new(lower, upper)?)
    }

    /// Digits with a point before, among or after them, or none; at least one digit.
    fn digits(&mut self, radix: u32) -> Result<Digits<'text>, ParseIntervalError> {
        let whole = self.run_of_digits(radix);
        let fraction = if self.takes(".") { self.run_of_digits(radix) } else { &[] };
        if whole.is_empty() && fraction.is_empty() {
            return Err(self.unexpected(if self.at == 0 { "an interval or a number" } else { "a number" }));
        }
        Ok(Digits { whole, fraction })
    }

    /// A whole number with or without a sign.
    fn exponent(&mut self) -> Result<i64, ParseIntervalError> {
        let negative = self.sign();
        let digits = self.run_of_digits(10);
        if digits.is_empty() {
            return Err(self.unexpected("an exponent"));
        }
        let size = digits
            .iter()
            .fold(0_i64, |size, digit| (size * 10 + i64::from(digit - b'0')).min(LARGEST_EXPONENT));
        Ok(if negative { -size } else { size })
    }

    fn run_of_digits(&mut self, radix: u32) -> &'text [u8] {
        let rest = &self.text.as_bytes()[self.at..];
        let length = rest.iter().take_while(|&&byte| char::from(byte).is_digit(radix)).count();
        self.at += length;
        &rest[..length]
    }

    /// Takes a sign if there is one, and tells whether it is a minus.
    fn sign(&mut self) -> bool {
        let negative = self.takes("-");
        if !negative {
            self.takes("+");
        }
        negative
    }

    fn skip_blanks(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn starts_with(&self, token: &str) -> bool {
        let rest = &self.text.as_bytes()[self.at..];
        rest.get(..token.len()).is_some_and(|start| start.eq_ignore_ascii_case(token.as_bytes()))
    }

    /// Whether `token`, in whatever case, comes next; it is then behind us.
    fn takes(&mut self, token: &str) -> bool {
        let taken = self.starts_with(token);
        if taken {
            self.at += token.len();
        }
        taken
    }

    fn expect(&mut self, token: &str, name: &'static str) -> Result<(), ParseIntervalError> {
        if self.takes(token) { Ok(()) } else { Err(self.unexpected(name)) }
    }

    fn unexpected(&self, expected: &'static str) -> ParseIntervalError {
        // Only whole ASCII characters are ever taken, so the place is between two characters.
        match self.text.get(self.at..).and_then(|rest| rest.chars().next()) {
            Some(found) => ParseIntervalError::Unexpected { expected, found, character: self.character() },
            None => ParseIntervalError::Incomplete { expected },
        }
    }

    /// The number of the next character, from 1.
    fn character(&self) -> usize {
        self.text.get(..self.at).map_or(self.at, |before| before.chars().count()) + 1
    }
}
