//! Decimal digits of a number, rounded up or down.

/// An absolute value as `0.d1 d2 d3... * 10^exponent`, without zeros in front or at the end; zero has no digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Decimal {
    digits: Vec<u8>,
    exponent: i64,
}

/// No `f64` has more significant decimal digits.
const MOST_DIGITS: usize = 767;

impl Decimal {
    /// All digits of the absolute value of a finite number.
    pub fn exact(value: f64) -> Decimal {
        Decimal::from_scientific(&format!("{:.*e}", MOST_DIGITS - 1, value.abs()))
    }

    /// The fewest digits that no other number is nearer to.
    pub fn shortest(value: f64) -> Decimal {
        Decimal::from_scientific(&format!("{:e}", value.abs()))
    }

    /// Reads what the standard library writes: `d.ddde-7`.
    fn from_scientific(text: &str) -> Decimal {
        let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
        let digits = mantissa.bytes().filter(u8::is_ascii_digit).map(|digit| digit - b'0').collect();
        Decimal { digits, exponent: exponent.parse().map_or(0, |exponent: i64| exponent + 1) }.trimmed()
    }

    /// The first `count` digits; if there were more, the last one of them is raised by one if `away` from zero is asked.
    pub fn rounded(mut self, count: i64, away: bool) -> Decimal {
        let count = count.max(0) as usize;
        if self.digits.len() <= count {
            return self;
        }
        self.digits.truncate(count);
        if away {
            self.raise();
        }
        self.trimmed()
    }

    /// The digits up to the given one after the point.
    pub fn rounded_to_place(self, place: usize, away: bool) -> Decimal {
        let count = self.exponent.saturating_add(place as i64);
        if count >= 0 || self.digits.is_empty() {
            return self.rounded(count, away);
        }
        // All digits are behind that place: nothing, or one in it, is left.
        let digits = if away { vec![1] } else { Vec::new() };
        Decimal { digits, exponent: 1 - place as i64 }.trimmed()
    }

    /// Adds one to the last digit; without digits, one at the place before the first.
    fn raise(&mut self) {
        for digit in self.digits.iter_mut().rev() {
            *digit += 1;
            if *digit < 10 {
                return;
            }
            *digit = 0;
        }
        self.digits.insert(0, 1);
        self.exponent += 1;
    }

    fn trimmed(mut self) -> Decimal {
        let zeros = self.digits.iter().take_while(|&&digit| digit == 0).count();
        self.digits.drain(..zeros);
        self.exponent -= zeros as i64;
        while self.digits.last() == Some(&0) {
            self.digits.pop();
        }
        if self.digits.is_empty() {
            self.exponent = 0;
        }
        self
    }

    pub fn is_zero(&self) -> bool {
        self.digits.is_empty()
    }

    /// Whether the value is below that of `other`.
    pub fn is_below(&self, other: &Decimal) -> bool {
        if self.is_zero() || other.is_zero() {
            return !other.is_zero();
        }
        (self.exponent, &self.digits) < (other.exponent, &other.digits)
    }

    /// Digits around a point, `places` of them behind it; all of them if none are asked for.
    pub fn plain(&self, places: Option<usize>) -> String {
        let places = places.unwrap_or((self.digits.len() as i64 - self.exponent).max(0) as usize) as i64;
        let digit_at = |place: i64| {
            let index = usize::try_from(self.exponent + place).ok();
            char::from(b'0' + index.and_then(|index| self.digits.get(index)).copied().unwrap_or(0))
        };
        // Places are counted from the point: -1 is that of the ones, 0 the first behind the point.
        let mut text: String = (-self.exponent.max(1)..0).map(digit_at).collect();
        if places > 0 {
            text.push('.');
            text.extend((0..places).map(digit_at));
        }
        text
    }

    /// One digit before the point, the others behind it, and the power of ten.
    fn scientific(&self) -> String {
        let mut text = self.plain_mantissa();
        text.push_str(&format!("e{}", self.exponent - 1));
        text
    }

    fn plain_mantissa(&self) -> String {
        Decimal { digits: self.digits.clone(), exponent: 1 }.plain(None)
    }

    /// The shorter and more readable of the two ways to write all digits.
    pub fn readable(&self) -> String {
        if self.is_zero() || (-4..=16).contains(&self.exponent) {
            self.plain(None)
        } else {
            self.scientific()
        }
    }
}
