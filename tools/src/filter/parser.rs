//! From words to an expression, by recursive descent: `or` of `and` of `not` of comparisons.

use std::ops::Range;

use super::lexer::{Token, tokens};
use super::{Comparison, Expression, FilterError, Literal, Path};

/// Parentheses and negations may be nested so deep, and as many terms chained: evaluation needs a stack.
const DEPTH_MAX: usize = 64;
const TERMS_MAX: usize = 512;

pub(super) fn parse(text: &str) -> Result<Expression, FilterError> {
    let mut parser = Parser { text, tokens: tokens(text)?, at: 0, depth: 0 };
    if let Some((_, span)) = parser.tokens.get(TERMS_MAX) {
        return Err(FilterError::new(text, span.clone(), "this filter is too long", "use several commands"));
    }
    let expression = parser.or()?;
    match parser.tokens.get(parser.at) {
        None => Ok(expression),
        Some((Token::Close, _)) => Err(parser.wrong("there is no `(` for this", "take it away")),
        Some(_) => Err(parser
            .wrong("expected `and` or `or` here", "join conditions, such as `from == 7 and range_m > 400`")),
    }
}

struct Parser<'t> {
    text: &'t str,
    tokens: Vec<(Token, Range<usize>)>,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn or(&mut self) -> Result<Expression, FilterError> {
        let mut expression = self.and()?;
        while self.takes(&Token::Or) {
            expression = Expression::Or(Box::new(expression), Box::new(self.and()?));
        }
        Ok(expression)
    }

    fn and(&mut self) -> Result<Expression, FilterError> {
        let mut expression = self.not()?;
        while self.takes(&Token::And) {
            expression = Expression::And(Box::new(expression), Box::new(self.not()?));
        }
        Ok(expression)
    }

    fn not(&mut self) -> Result<Expression, FilterError> {
        if self.depth >= DEPTH_MAX {
            return Err(self.wrong("this is nested too deeply", "use fewer parentheses"));
        }
        self.depth += 1;
        let expression = if self.takes(&Token::Not) {
            Expression::Not(Box::new(self.not()?))
        } else if self.takes(&Token::Open) {
            let inner = self.or()?;
            self.expect(&Token::Close, "expected `)` here", "close the parenthesis")?;
            inner
        } else {
            self.condition()?
        };
        self.depth -= 1;
        Ok(expression)
    }

    fn condition(&mut self) -> Result<Expression, FilterError> {
        let Some((Token::Word(name), span)) = self.tokens.get(self.at).cloned() else {
            return Err(self.wrong("expected a field here", "begin with a field, such as `range_m > 400`"));
        };
        self.at += 1;
        let path = Path { name, span };
        if self.takes(&Token::In) {
            return Ok(Expression::In(path, self.list()?));
        }
        let Some((Token::Comparison(comparison), _)) = self.tokens.get(self.at) else {
            return Ok(Expression::Has(path));
        };
        let comparison = *comparison;
        self.at += 1;
        let literal = self.literal()?;
        let (fits, fix) = match comparison {
            Comparison::Equal | Comparison::NotEqual => (true, ""),
            Comparison::Contains => {
                (matches!(literal, Literal::Text(_)), "`~` looks for a text: put it in quotes")
            }
            _ => (matches!(literal, Literal::Number(_)), "compare with a number, or use `==` or `!=`"),
        };
        if !fits {
            self.at -= 1;
            return Err(self.wrong(format!("`{}` cannot compare with this", comparison.symbol()), fix));
        }
        Ok(Expression::Compare(path, comparison, literal))
    }

    fn list(&mut self) -> Result<Vec<Literal>, FilterError> {
        let fix = "give the values, such as `reason in (late, busy)`";
        self.expect(&Token::Open, "expected `(` here", fix)?;
        let mut literals = vec![self.literal()?];
        while self.takes(&Token::Comma) {
            literals.push(self.literal()?);
        }
        self.expect(&Token::Close, "expected `,` or `)` here", fix)?;
        Ok(literals)
    }

    fn literal(&mut self) -> Result<Literal, FilterError> {
        let literal = match self.tokens.get(self.at) {
            Some((Token::Number(number), _)) => Literal::Number(*number),
            Some((Token::Text(text), _)) => Literal::Text(text.clone()),
            Some((Token::Word(word), _)) => match word.as_str() {
                "true" => Literal::Bool(true),
                "false" => Literal::Bool(false),
                "null" => Literal::Null,
                _ => Literal::Text(word.clone()),
            },
            _ => {
                let fix = "compare with a value, such as `range_m > 400` or `reason == noise`";
                return Err(self.wrong("expected a number or a text here", fix));
            }
        };
        self.at += 1;
        Ok(literal)
    }

    fn takes(&mut self, token: &Token) -> bool {
        let is_next = self.tokens.get(self.at).is_some_and(|(next, _)| next == token);
        self.at += usize::from(is_next);
        is_next
    }

    fn expect(&mut self, token: &Token, message: &str, fix: &str) -> Result<(), FilterError> {
        if self.takes(token) { Ok(()) } else { Err(self.wrong(message, fix)) }
    }

    /// An error at the next token, or at the end.
    fn wrong(&self, message: impl Into<String>, fix: impl Into<String>) -> FilterError {
        let end = self.text.len();
        let span = self.tokens.get(self.at).map_or(end..end, |(_, span)| span.clone());
        FilterError::new(self.text, span, message, fix)
    }
}
