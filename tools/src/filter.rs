//! Filter expressions: which messages to show.
//!
//! ```text
//! range_m > 400 and not (reason == noise or reason in (late, busy))
//! reception.sinr_db < 10 && from == 7
//! position_m.2 <= -50
//! message ~ "misses the truth"
//! ```
//!
//! | form | holds when |
//! |---|---|
//! | `FIELD` | the field is there, and neither `false` nor `null` |
//! | `FIELD == VALUE`, `!=` (or `=`) | it is there and is, or is not, the value |
//! | `FIELD < NUMBER`, `<=`, `>`, `>=` | it is there, a number, and compares so |
//! | `FIELD in (VALUE, VALUE, ...)` | it is one of them |
//! | `FIELD ~ TEXT` | it is a text that holds this one |
//! | `not X` (or `!`), `X and Y` (`&&`), `X or Y` (`\|\|`), `( )` | as they say; `not` binds closest, then `and` |
//!
//! A `FIELD` is the path of a value in a message's JSON, with dots; numbers count the elements of a list from 0, and without one any
//! element will do. Units are in the names; `t_s` is `t_ns` in seconds. A `VALUE` is a number, `true`, `false`, `null`, or a text: in
//! quotes, or a bare word. A field that is not there satisfies no comparison, not even `!=`.

mod error;
mod evaluate;
mod fields;
mod lexer;
mod parser;
#[cfg(test)]
mod tests;

use std::fmt;
use std::ops::Range;

use serde_json::Value;

pub use error::FilterError;
pub use evaluate::find;
pub use fields::{Fields, similar};

/// A filter expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    text: String,
    expression: Expression,
}

#[derive(Clone, Debug, PartialEq)]
enum Expression {
    Or(Box<Self>, Box<Self>),
    And(Box<Self>, Box<Self>),
    Not(Box<Self>),
    Has(Path),
    Compare(Path, Comparison, Literal),
    In(Path, Vec<Literal>),
}

/// Where a value stands in a message, and in the text of the filter.
#[derive(Clone, Debug)]
struct Path {
    name: String,
    span: Range<usize>,
}

impl PartialEq for Path {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Contains,
}

#[derive(Clone, Debug, PartialEq)]
enum Literal {
    Number(f64),
    Text(String),
    Bool(bool),
    Null,
}

impl Filter {
    /// Understands `text`.
    ///
    /// # Errors
    /// When it is no filter expression: with the place and a fix.
    pub fn parse(text: &str) -> Result<Self, FilterError> {
        Ok(Self { text: text.to_owned(), expression: parser::parse(text)? })
    }

    /// Checks that messages with `fields` can have what it asks for.
    ///
    /// # Errors
    /// When a name is none of them.
    pub fn check(&self, fields: &Fields) -> Result<(), FilterError> {
        self.expression.paths(&mut |path| {
            fields.check(&path.name).map_err(|(at, fix)| {
                let start = path.span.start + at.start;
                let span = start..path.span.start + at.end;
                FilterError::new(&self.text, span, "messages of this topic have no such field", fix)
            })
        })
    }

    /// Whether `message` is one to show.
    pub fn matches(&self, message: &Value) -> bool {
        self.expression.matches(message)
    }
}

impl Expression {
    fn paths(&self, visit: &mut dyn FnMut(&Path) -> Result<(), FilterError>) -> Result<(), FilterError> {
        match self {
            Self::Or(one, other) | Self::And(one, other) => {
                one.paths(visit)?;
                other.paths(visit)
            }
            Self::Not(inner) => inner.paths(visit),
            Self::Has(path) | Self::Compare(path, ..) | Self::In(path, _) => visit(path),
        }
    }
}

impl Comparison {
    const ALL: [(Self, &'static str); 7] = [
        (Self::Equal, "=="),
        (Self::NotEqual, "!="),
        (Self::LessOrEqual, "<="),
        (Self::GreaterOrEqual, ">="),
        (Self::Less, "<"),
        (Self::Greater, ">"),
        (Self::Contains, "~"),
    ];

    fn symbol(self) -> &'static str {
        Self::ALL.iter().find(|(comparison, _)| *comparison == self).map_or("==", |(_, symbol)| symbol)
    }
}

impl fmt::Display for Filter {
    /// As text that is understood as the same filter.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.expression.fmt(f)
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Or(one, other) => write!(f, "({one} or {other})"),
            Self::And(one, other) => write!(f, "({one} and {other})"),
            Self::Not(inner) => write!(f, "not {inner}"),
            Self::Has(path) => f.write_str(&path.name),
            Self::Compare(path, comparison, literal) => {
                write!(f, "{} {} {literal}", path.name, comparison.symbol())
            }
            Self::In(path, literals) => {
                let listed: Vec<String> = literals.iter().map(ToString::to_string).collect();
                write!(f, "{} in ({})", path.name, listed.join(", "))
            }
        }
    }
}

impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Text(text) => write!(f, "\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"")),
            Self::Bool(truth) => truth.fmt(f),
            Self::Null => f.write_str("null"),
        }
    }
}
