//! What goes wrong, as a sentence for the user and an exit code.

use std::fmt;

use crate::exit::Exit;

/// A sentence that says what failed, where and what to do, with the exit code it deserves.
#[derive(Debug)]
pub struct Failure {
    /// How to exit.
    pub exit: Exit,
    /// What to say on stderr.
    pub message: String,
}

impl Failure {
    /// Something went wrong on the way.
    pub fn failed(message: impl fmt::Display) -> Self {
        Self { exit: Exit::Failed, message: format!("error: {message}") }
    }

    /// The user asked for something that cannot be.
    pub fn usage(message: impl fmt::Display) -> Self {
        Self { exit: Exit::Usage, message: format!("error: {message}") }
    }

    /// As [`usage`](Self::usage), for a message that begins with its own `error:`.
    pub fn rendered(message: String) -> Self {
        Self { exit: Exit::Usage, message }
    }
}

/// Turns an error into a failure that begins with what was being done.
pub trait While<T> {
    /// `doing` completes "could not ...".
    fn while_doing(self, doing: &str) -> Result<T, Failure>;
}

impl<T, E: fmt::Display> While<T> for Result<T, E> {
    fn while_doing(self, doing: &str) -> Result<T, Failure> {
        self.map_err(|error| Failure::failed(format!("could not {doing}: {error}")))
    }
}
