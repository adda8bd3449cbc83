//! What is wrong with a filter expression, and where.

use std::fmt;
use std::ops::Range;

/// Why a filter expression is refused. Shown as a sentence, the text with carets under the place, and a fix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilterError {
    text: String,
    /// In bytes of the text.
    span: Range<usize>,
    message: String,
    fix: String,
}

impl FilterError {
    pub(super) fn new(
        text: &str,
        span: Range<usize>,
        message: impl Into<String>,
        fix: impl Into<String>,
    ) -> Self {
        Self { text: text.to_owned(), span, message: message.into(), fix: fix.into() }
    }

    /// Where, in bytes of the text; on borders of characters, and empty at its end.
    #[cfg(test)]
    pub(super) fn span(&self) -> Range<usize> {
        self.span.clone()
    }
}

impl fmt::Display for FilterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // What moves the cursor would move the carets.
        let shown = |part: &str| part.replace(|c: char| c.is_control(), " ");
        let part = |range: Range<usize>| shown(self.text.get(range).unwrap_or_default());
        let before = part(0..self.span.start).chars().count();
        let under = part(self.span.clone()).chars().count().max(1);
        writeln!(f, "--filter: {}", self.message)?;
        writeln!(f, "  | {}", shown(&self.text))?;
        writeln!(f, "  | {}{}", " ".repeat(before), "^".repeat(under))?;
        write!(f, "  = help: {}", self.fix)
    }
}

impl std::error::Error for FilterError {}
