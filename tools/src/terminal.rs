//! What the terminal can show.

use std::io::IsTerminal;

/// Whether messages on stderr may be coloured: a terminal, and nobody said `NO_COLOR`.
pub fn stderr_has_colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
