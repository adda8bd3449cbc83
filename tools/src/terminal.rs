//! What the terminal can show.

use std::io::IsTerminal;

/// Whether messages on stderr may be coloured: a terminal, and nobody said `NO_COLOR`.
pub fn stderr_has_colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// How many columns a line on stdout may have: what `COLUMNS` says, else the terminal's; `None` when it goes elsewhere.
pub fn stdout_columns() -> Option<usize> {
    let said =
        std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok()).filter(|columns| *columns > 0);
    let measured = || {
        let size = ratatui::crossterm::terminal::size();
        size.ok().filter(|_| std::io::stdout().is_terminal()).map(|(columns, _)| usize::from(columns))
    };
    said.or_else(measured)
}

/// Whether a whole screen can be drawn: a terminal at both ends that moves its cursor.
pub fn has_screen() -> bool {
    let is_dumb = std::env::var_os("TERM").is_none_or(|term| term == "dumb" || term.is_empty());
    std::io::stdout().is_terminal() && std::io::stdin().is_terminal() && !is_dumb
}

/// Whether stdout may be coloured: nobody said `NO_COLOR`.
pub fn stdout_has_colour() -> bool {
    std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
