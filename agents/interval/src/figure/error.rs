//! Why there is no figure.

use std::path::PathBuf;
use thiserror::Error;

/// Why a figure could not be begun or saved.
#[derive(Debug, Error)]
pub enum FigureError {
    /// The box to show is empty, unbounded or has no area.
    #[error("a figure of {view} has no area to show: give a bounded box with two sides that are not points")]
    View {
        /// The box that was asked for.
        view: String,
    },
    /// The file or its folder could not be written.
    #[error("cannot write the figure {}: {source}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
}
