//! A filter expression's words.

use std::ops::Range;

use super::{Comparison, FilterError};

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    And,
    Or,
    Not,
    In,
    Open,
    Close,
    Comma,
    Comparison(Comparison),
    Number(f64),
    /// In quotes.
    Text(String),
    /// A field, or a text without quotes.
    Word(String),
}

/// The tokens of `text` with their places in bytes.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Range<usize>)>, FilterError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let first = rest.chars().next().unwrap_or(' ');
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (token, length) = match first {
            '"' | '\'' => quoted(text, at, first)?,
            c if is_of_word(c) || c == '+' => word(text, at)?,
            _ => symbol(text, at, first)?,
        };
        tokens.push((token, at..at + length));
        at += length;
    }
    Ok(tokens)
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '.' | '-' | '/')
}

fn symbol(text: &str, at: usize, first: char) -> Result<(Token, usize), FilterError> {
    let rest = text.get(at..).unwrap_or_default();
    let found = Comparison::ALL.iter().find(|(_, symbol)| rest.starts_with(symbol));
    let others = [
        ("&&", Token::And),
        ("||", Token::Or),
        ("!", Token::Not),
        ("(", Token::Open),
        (")", Token::Close),
        (",", Token::Comma),
        ("=", Token::Comparison(Comparison::Equal)),
    ];
    if let Some((comparison, symbol)) = found {
        return Ok((Token::Comparison(*comparison), symbol.len()));
    }
    others
        .into_iter()
        .find(|(symbol, _)| rest.starts_with(symbol))
        .map(|(symbol, token)| (token, symbol.len()))
        .ok_or_else(|| {
            let fix = match first {
                '&' => "write `and`".to_owned(),
                '|' => "write `or`".to_owned(),
                _ => "put texts in quotes, such as `name == \"green 1\"`".to_owned(),
            };
            FilterError::new(
                text,
                at..at + first.len_utf8(),
                format!("`{}` means nothing here", first.escape_debug()),
                fix,
            )
        })
}

/// A text in quotes; `\` takes the special meaning from the character behind it.
fn quoted(text: &str, at: usize, quote: char) -> Result<(Token, usize), FilterError> {
    let mut content = String::new();
    let mut is_escaped = false;
    for (index, c) in text.get(at..).unwrap_or_default().char_indices().skip(1) {
        match c {
            _ if is_escaped => {
                content.push(c);
                is_escaped = false;
            }
            '\\' => is_escaped = true,
            _ if c == quote => return Ok((Token::Text(content), index + 1)),
            _ => content.push(c),
        }
    }
    Err(FilterError::new(text, at..text.len(), "this text does not end", format!("close it with {quote}")))
}

/// A word or a number: all characters up to the next that is of neither.
fn word(text: &str, at: usize) -> Result<(Token, usize), FilterError> {
    let rest = text.get(at..).unwrap_or_default();
    let mut before = ' ';
    let is_number = rest.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'));
    let is_end = |c: char| {
        let is_sign = c == '+' && (before == ' ' || is_number && matches!(before, 'e' | 'E'));
        before = c;
        !is_of_word(c) && !is_sign
    };
    let length = rest.find(is_end).unwrap_or(rest.len());
    let found = rest.get(..length).unwrap_or_default();
    let token = match found {
        "and" => Token::And,
        "or" => Token::Or,
        "not" => Token::Not,
        "in" => Token::In,
        _ if is_number => match found.parse() {
            Ok(number) => Token::Number(number),
            Err(_) => {
                let fix =
                    "write numbers like `12`, `-0.5` or `1e3`, without a unit: it is in the field's name";
                return Err(FilterError::new(
                    text,
                    at..at + length,
                    format!("`{found}` is not a number"),
                    fix,
                ));
            }
        },
        _ => Token::Word(found.to_owned()),
    };
    Ok((token, length))
}
