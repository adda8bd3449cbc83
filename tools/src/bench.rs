//! `shoal bench`: figures of this machine, each a ratio within one call.

mod scale;
mod tap;

pub use scale::{ScaleArgs, scale};
pub use tap::{TapBenchArgs, tap};
