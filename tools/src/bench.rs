//! `shoal bench`: figures of this machine, each a ratio within one call.

mod scale;

pub use scale::{ScaleArgs, scale};
