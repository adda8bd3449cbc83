//! What is wrong with a scenario file: the place, the cause and the fix, shown the way rustc shows it.

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// No more errors than this are shown at once; the rest are only counted.
pub const SHOWN_ERRORS_MAX: usize = 20;

/// One error in a scenario file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong, in one sentence without a full stop.
    pub cause: String,
    /// Bytes of the text that are wrong.
    pub span: Range<usize>,
    /// Line of the first of them, from 1.
    pub line: usize,
    /// Column of the first of them in characters, from 1.
    pub column: usize,
    /// Short note under the marked text; may be empty.
    pub label: String,
    /// Another place that has to do with it, and how.
    pub related: Option<(Range<usize>, String)>,
    /// How to fix it.
    pub fix: String,
}

/// All errors of one scenario file, by position: at least one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct ScenarioErrors {
    /// Name of the file, or of the scenario in the library.
    pub source_name: String,
    /// Its text.
    pub text: String,
    /// The first errors, at most [`SHOWN_ERRORS_MAX`].
    pub errors: Vec<Diagnostic>,
    /// How many more there are.
    pub omitted: usize,
}

impl ScenarioErrors {
    /// The errors as a person reads them, with the marked source; `colour` adds ANSI colours.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let mut shown = String::new();
        for error in &self.errors {
            let mut snippet = Snippet::source(self.text.as_str())
                .path(self.source_name.as_str())
                .annotation(AnnotationKind::Primary.span(error.span.clone()).label(error.label.as_str()));
            if let Some((span, label)) = &error.related {
                snippet =
                    snippet.annotation(AnnotationKind::Context.span(span.clone()).label(label.as_str()));
            }
            let mut report = vec![Level::ERROR.primary_title(error.cause.as_str()).element(snippet)];
            if !error.fix.is_empty() {
                report.push(Group::with_title(Level::HELP.secondary_title(error.fix.as_str())));
            }
            shown.push_str(&renderer.render(&report));
            shown.push_str("\n\n");
        }
        let total = self.errors.len() + self.omitted;
        let found = if total == 1 { "1 error".to_string() } else { format!("{total} errors") };
        shown.push_str(&format!("{found} in {}", self.source_name));
        if self.omitted > 0 {
            shown.push_str(&format!(", the first {} shown", self.errors.len()));
        }
        shown.push('\n');
        shown
    }
}

impl fmt::Display for ScenarioErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.render(false))
    }
}

/// Collects errors while a text is read.
pub(crate) struct Findings<'t> {
    text: &'t str,
    found: RefCell<Vec<Diagnostic>>,
}

impl<'t> Findings<'t> {
    pub(crate) fn new(text: &'t str) -> Self {
        Self { text, found: RefCell::default() }
    }

    /// Adds an error at `span`.
    pub(crate) fn add(
        &self,
        span: Range<usize>,
        cause: impl Into<String>,
        label: impl Into<String>,
        fix: impl Into<String>,
    ) {
        self.add_related(span, cause, label, None, fix);
    }

    /// Adds an error at `span` that another place has to do with.
    pub(crate) fn add_related(
        &self,
        span: Range<usize>,
        cause: impl Into<String>,
        label: impl Into<String>,
        related: Option<(Range<usize>, String)>,
        fix: impl Into<String>,
    ) {
        let span = self.clamp(span);
        self.found.borrow_mut().push(Diagnostic {
            cause: cause.into(),
            line: 0,
            column: 0,
            label: label.into(),
            related: related.map(|(span, label)| (self.clamp(span), label)),
            fix: fix.into(),
            span,
        });
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.found.borrow().is_empty()
    }

    /// The errors, sorted by position.
    pub(crate) fn into_errors(self, source_name: &str) -> ScenarioErrors {
        let mut errors = self.found.take();
        errors.sort_by(|a, b| (a.span.start, &a.cause).cmp(&(b.span.start, &b.cause)));
        errors.dedup();
        let omitted = errors.len().saturating_sub(SHOWN_ERRORS_MAX);
        errors.truncate(SHOWN_ERRORS_MAX);
        // Only now: counting lines for each of very many errors would take long.
        for error in &mut errors {
            (error.line, error.column) = self.line_and_column(error.span.start);
        }
        ScenarioErrors { source_name: source_name.to_string(), text: self.text.to_string(), errors, omitted }
    }

    fn line_and_column(&self, offset: usize) -> (usize, usize) {
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// A span that lies inside the text, on character boundaries.
    fn clamp(&self, span: Range<usize>) -> Range<usize> {
        let start = self.text.floor_char_boundary(span.start.min(self.text.len()));
        let end = self.text.ceil_char_boundary(span.end.clamp(start, self.text.len()));
        start..end
    }
}
