//! Whole numbers of any size, as far as reading text needs them.

use std::cmp::Ordering;

/// A whole number that is not negative: 64-bit digits, least first, the last of them not zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Natural {
    digits: Vec<u64>,
}

impl From<u64> for Natural {
    fn from(value: u64) -> Natural {
        Natural { digits: if value == 0 { Vec::new() } else { vec![value] } }
    }
}

impl Natural {
    /// The number that these digits of base `radix` write, most significant first.
    pub fn from_digits(digits: impl IntoIterator<Item = u8>, radix: u64) -> Natural {
        let mut value = Natural::from(0);
        let (mut chunk, mut scale) = (0_u64, 1_u64);
        for digit in digits {
            chunk = chunk * radix + u64::from(digit);
            scale *= radix;
            if scale > u64::MAX / radix / radix {
                value.multiply_add(scale, chunk);
                (chunk, scale) = (0, 1);
            }
        }
        value.multiply_add(scale, chunk);
        value
    }

    /// `self * factor + term`
    pub fn multiply_add(&mut self, factor: u64, term: u64) {
        let mut carry = u128::from(term);
        for digit in &mut self.digits {
            carry += u128::from(*digit) * u128::from(factor);
            *digit = carry as u64;
            carry >>= 64;
        }
        if carry > 0 {
            self.digits.push(carry as u64);
        }
    }

    pub fn times_power_of_ten(mut self, exponent: u64) -> Natural {
        const LARGEST: u64 = 19;
        for _ in 0..exponent / LARGEST {
            self.multiply_add(10_u64.pow(LARGEST as u32), 0);
        }
        self.multiply_add(10_u64.pow((exponent % LARGEST) as u32), 0);
        self
    }

    pub fn times_power_of_two(mut self, exponent: u64) -> Natural {
        if self.is_zero() {
            return self;
        }
        self.multiply_add(1 << (exponent % 64), 0);
        self.digits.splice(0..0, std::iter::repeat_n(0, (exponent / 64) as usize));
        self
    }

    pub fn plus(mut self, other: &Natural) -> Natural {
        let length = self.digits.len().max(other.digits.len());
        self.digits.resize(length, 0);
        let mut carry = 0_u128;
        for (index, digit) in self.digits.iter_mut().enumerate() {
            carry += u128::from(*digit) + u128::from(other.digits.get(index).copied().unwrap_or(0));
            *digit = carry as u64;
            carry >>= 64;
        }
        if carry > 0 {
            self.digits.push(carry as u64);
        }
        self
    }

    /// The distance between the two numbers.
    pub fn distance(self, other: Natural) -> Natural {
        let (mut larger, smaller) = if self >= other { (self, other) } else { (other, self) };
        let mut borrow = false;
        for (index, digit) in larger.digits.iter_mut().enumerate() {
            let (less, first) = digit.overflowing_sub(smaller.digits.get(index).copied().unwrap_or(0));
            let (less, second) = less.overflowing_sub(u64::from(borrow));
            *digit = less;
            borrow = first || second;
        }
        while larger.digits.last() == Some(&0) {
            larger.digits.pop();
        }
        larger
    }

    pub fn is_zero(&self) -> bool {
        self.digits.is_empty()
    }

    /// The number is below two to this power, and if it is not zero not below half of that.
    pub fn bits(&self) -> u64 {
        self.digits.last().map_or(0, |last| 64 * self.digits.len() as u64 - u64::from(last.leading_zeros()))
    }
}

impl PartialOrd for Natural {
    fn partial_cmp(&self, other: &Natural) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Natural {
    fn cmp(&self, other: &Natural) -> Ordering {
        let by_length = self.digits.len().cmp(&other.digits.len());
        by_length.then_with(|| self.digits.iter().rev().cmp(other.digits.iter().rev()))
    }
}
