//! `shoal localize`: finds out where AUVs were, after the run.
//!
//! | file | idea |
//! |---|---|
//! | `recorded.rs` | what a record holds for it |
//! | `offline.rs` | all trajectories of a record at once |
//! | `outcome.rs` | widths, containment: the table |

mod offline;
mod outcome;
mod recorded;

use crate::cli::LocalizeArgs;
use crate::exit::Exit;
use crate::failure::Failure;

/// Localizes, prints how well, and writes what was found.
pub fn localize(args: &LocalizeArgs) -> Result<Exit, Failure> {
    if !args.offline {
        return Err(Failure::usage(
            "say how to localize: add `--offline` for all trajectories of a record together",
        ));
    }
    offline::localize(args)
}
