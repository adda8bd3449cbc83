//! Numbers, vectors and times in a table, with the rules they must obey.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use toml::de::DeValue;

use crate::model::{Region, Vec3};
use crate::reader::{Table, Value};
use crate::time::ns_of_decimal;

/// What a number must be.
#[derive(Clone, Copy)]
pub(crate) enum Rule {
    /// Any finite number.
    Finite,
    /// At least zero.
    NotNegative,
    /// More than zero.
    Positive,
    /// From the first to the second.
    Within(f64, f64),
    /// From zero to a right angle.
    UpToRightAngle,
}

/// A number of a list, and where it stands.
pub(crate) struct Placed {
    pub(crate) number: f64,
    pub(crate) span: Range<usize>,
}

/// No length, speed or error that makes sense is larger, and arithmetic beyond would eat into the error bounds.
pub(crate) const MAGNITUDE_MAX: f64 = 1e7;

impl Rule {
    fn broken_by(self, value: f64) -> Option<String> {
        let kept = match self {
            Rule::Finite => true,
            Rule::NotNegative => value >= 0.0,
            Rule::Positive => value > 0.0,
            Rule::Within(least, greatest) => (least..=greatest).contains(&value),
            Rule::UpToRightAngle => (0.0..=FRAC_PI_2).contains(&value),
        };
        if !value.is_finite() {
            return Some("a finite number".into());
        }
        if value.abs() > MAGNITUDE_MAX {
            return Some("within 10,000,000 of zero".into());
        }
        (!kept).then(|| match self {
            Rule::Finite => "a finite number".into(),
            Rule::NotNegative => "0 or more".into(),
            Rule::Positive => "more than 0".into(),
            Rule::Within(least, greatest) => format!("from {least} to {greatest}"),
            Rule::UpToRightAngle => "from 0 to pi/2 rad (1.5707)".into(),
        })
    }
}

impl<'t> Table<'t> {
    /// The number under `key`; `None` after an error.
    pub(crate) fn number(&self, key: &'static str, default: Option<f64>, rule: Rule) -> Option<f64> {
        match self.get(key) {
            Some(value) => self.number_in(key, value, rule),
            None if default.is_some() => default,
            None => {
                self.missing(key);
                None
            }
        }
    }

    /// A number that is the value of `key` or a part of it.
    pub(crate) fn number_in(&self, key: &str, value: &Value<'_>, rule: Rule) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
            DeValue::Integer(integer) => {
                i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64)
            }
            _ => {
                self.wrong_type(key, value, "a number");
                return None;
            }
        };
        let number = number.unwrap_or(f64::INFINITY);
        match rule.broken_by(number) {
            None => Some(number),
            Some(wanted) => {
                self.findings.add(
                    value.span(),
                    format!("`{key}` cannot be {number}"),
                    format!("must be {wanted}"),
                    format!("write for example `{}`", self.example(key)),
                );
                None
            }
        }
    }

    /// The whole number under `key`, from `least` to `greatest`.
    pub(crate) fn whole(
        &self,
        key: &'static str,
        default: Option<u64>,
        least: u64,
        greatest: u64,
    ) -> Option<u64> {
        let Some(value) = self.get(key) else {
            if default.is_none() {
                self.missing(key);
            }
            return default;
        };
        let DeValue::Integer(integer) = value.get_ref() else {
            self.wrong_type(key, value, "a whole number");
            return None;
        };
        let whole = i128::from_str_radix(integer.as_str(), integer.radix()).ok();
        let whole = whole.and_then(|whole| u64::try_from(whole).ok());
        let found = whole.filter(|whole| (least..=greatest).contains(whole));
        if found.is_none() {
            let wanted = format!("from {least} to {greatest}");
            self.refuse(
                key,
                format!("`{key}` must be a whole number in its range"),
                format!("must be {wanted}"),
                format!("write for example `{}`", self.example(key)),
            );
        }
        found
    }

    /// The time under `key` in nanoseconds: a key in seconds (`_s`) or milliseconds (`_ms`).
    pub(crate) fn time_ns(&self, key: &'static str, default: Option<i64>, least_ns: i64) -> Option<i64> {
        match self.get(key) {
            Some(value) => self.time_in(key, value, least_ns),
            None if default.is_some() => default,
            None => {
                self.missing(key);
                None
            }
        }
    }

    /// A time under `key`, or `false` for none.
    pub(crate) fn time_or_none_ns(
        &self,
        key: &'static str,
        default: i64,
        least_ns: i64,
    ) -> Option<Option<i64>> {
        match self.get(key) {
            Some(value) if matches!(value.get_ref(), DeValue::Boolean(false)) => Some(None),
            Some(value) if matches!(value.get_ref(), DeValue::Boolean(true)) => {
                self.wrong_type(key, value, "a number, or false for never");
                None
            }
            Some(value) => self.time_in(key, value, least_ns).map(Some),
            None => Some(Some(default)),
        }
    }

    /// A time that is the value of `key`.
    pub(crate) fn time_in(&self, key: &str, value: &Value<'_>, least_ns: i64) -> Option<i64> {
        let (unit, unit_exponent) = if key.ends_with("_ms") { ("ms", 6) } else { ("s", 9) };
        let text = match value.get_ref() {
            DeValue::Float(float) => float.as_str().to_string(),
            DeValue::Integer(integer) => match i128::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(integer) => integer.to_string(),
                Err(_) => String::new(),
            },
            _ => {
                self.wrong_type(key, value, "a number");
                return None;
            }
        };
        let Ok(ns) = ns_of_decimal(&text, unit_exponent) else {
            self.findings.add(
                value.span(),
                format!("`{key}` must be a whole number of nanoseconds"),
                "not a whole number of nanoseconds below 292 years",
                format!(
                    "write a time with at most {unit_exponent} decimals, such as `{}`",
                    self.example(key)
                ),
            );
            return None;
        };
        if ns < least_ns {
            let least = match least_ns {
                0 => format!("0 {unit} or more"),
                1 => format!("more than 0 {unit}"),
                _ if unit == "ms" => format!("{} ms or more", least_ns as f64 / 1e6),
                _ => format!("{} s or more", least_ns as f64 / 1e9),
            };
            self.findings.add(
                value.span(),
                format!("`{key}` cannot be {text}"),
                format!("must be {least}"),
                format!("write for example `{}`", self.example(key)),
            );
            return None;
        }
        Some(ns)
    }

    /// The vector under `key`.
    pub(crate) fn vec3(&self, key: &'static str, default: Option<Vec3>, rule: Rule) -> Option<Vec3> {
        match self.get(key) {
            Some(value) => self.vec3_in(key, value, rule),
            None if default.is_some() => default,
            None => {
                self.missing(key);
                None
            }
        }
    }

    /// A vector that is the value of `key` or a part of it.
    pub(crate) fn vec3_in(&self, key: &str, value: &Value<'_>, rule: Rule) -> Option<Vec3> {
        let parts = match value.get_ref() {
            DeValue::Array(parts) if parts.len() == 3 => parts,
            other => {
                let found = match other {
                    DeValue::Array(parts) => format!("{} values", parts.len()),
                    other => crate::reader::article(other.type_str()),
                };
                self.findings.add(
                    value.span(),
                    format!("`{key}` must be three numbers, not {found}"),
                    "expected three numbers: east, north, up",
                    format!("write for example `{}`", self.example(key)),
                );
                return None;
            }
        };
        let mut vector = [0.0; 3];
        let mut good = true;
        for (part, number) in parts.iter().zip(&mut vector) {
            match self.number_in(key, part, rule) {
                Some(read) => *number = read,
                None => good = false,
            }
        }
        good.then_some(vector)
    }

    /// The list of numbers under `key`, each with its place.
    pub(crate) fn numbers(&self, key: &'static str, rule: Rule) -> Option<Vec<Placed>> {
        let Some(value) = self.get(key) else {
            self.missing(key);
            return None;
        };
        let DeValue::Array(parts) = value.get_ref() else {
            self.wrong_type(key, value, "a list of numbers");
            return None;
        };
        let read = |part| Some(Placed { number: self.number_in(key, part, rule)?, span: part.span() });
        let numbers: Vec<_> = parts.iter().map(read).collect();
        numbers.into_iter().collect()
    }

    /// The points under `key`, at least one.
    pub(crate) fn points(&self, key: &'static str) -> Option<Vec<Vec3>> {
        let Some(value) = self.get(key) else {
            self.missing(key);
            return None;
        };
        let parts = match value.get_ref() {
            DeValue::Array(parts) if !parts.is_empty() => parts,
            _ => {
                self.refuse(
                    key,
                    format!("`{key}` must be a list of one or more points"),
                    "expected a list of points",
                    format!("write for example `{}`", self.example(key)),
                );
                return None;
            }
        };
        let points: Vec<_> = parts.iter().map(|part| self.vec3_in(key, part, Rule::Finite)).collect();
        points.into_iter().collect()
    }

    /// A range `[least, greatest]` that is the value of `key` or a part of it.
    pub(crate) fn range_in(&self, key: &str, value: &Value<'_>, rule: Rule) -> Option<[f64; 2]> {
        let (low, high) = match value.get_ref() {
            DeValue::Array(parts) if parts.len() == 2 => (parts.first()?, parts.get(1)?),
            _ => {
                self.findings.add(
                    value.span(),
                    format!("`{key}` needs ranges of two numbers"),
                    "expected [least, greatest]",
                    format!("write for example `{}`", self.example(key)),
                );
                return None;
            }
        };
        let (low, high) = (self.number_in(key, low, rule), self.number_in(key, high, rule));
        let (low, high) = (low?, high?);
        if low > high {
            self.findings.add(
                value.span(),
                format!("`{key}` has a range whose least value is above its greatest"),
                format!("{low} is more than {high}"),
                format!("write `[{high}, {low}]`"),
            );
            return None;
        }
        Some([low, high])
    }

    /// The region under `key`, a range for each of east, north and up; it must lie below the surface z = 0.
    pub(crate) fn region(&self, key: &'static str) -> Option<Region> {
        let value = self.get(key)?;
        let parts = match value.get_ref() {
            DeValue::Array(parts) if parts.len() == 3 => parts,
            _ => {
                self.refuse(
                    key,
                    format!("`{key}` must be three ranges"),
                    "expected a range for each of east, north and up",
                    format!("write for example `{}`", self.example(key)),
                );
                return None;
            }
        };
        let ranges: Vec<_> = parts.iter().map(|part| self.range_in(key, part, Rule::Finite)).collect();
        let mut region = [[0.0; 2]; 3];
        for (range, read) in region.iter_mut().zip(ranges) {
            *range = read?;
        }
        if region[2][1] > 0.0 {
            let z = parts.get(2).map_or(value.span(), |part| part.span());
            self.findings.add(
                z,
                format!("`{key}` reaches above the surface"),
                "z is up: the surface is 0, water is below it",
                format!("end the third range at 0, such as `[{}, 0]`", region[2][0].min(-10.0)),
            );
            return None;
        }
        Some(region)
    }
}
