//! The `iceoryx2` transport: one process per AUV, shared memory in between.
//!
//! AUVs are in wake-up groups. A group has one service down, on which one sample per window holds the messages of all its
//! members, and one service up. A group that has nobody due sleeps through the window. In one that has, every member takes
//! the sample and acknowledges it; so no buffer is ever full, and sequence numbers prove that nothing was skipped.
//! Who sleeps is woken by a futex in the run's control block, one word per group.

mod arena;
mod control;
mod fleet;
mod late;
mod link;
mod members;

pub use fleet::{SharedMemoryFleet, wake_groups};
pub use link::SharedMemoryLink;
pub use members::InterruptHandle;

const BUS: &str = "iceoryx2";

/// How many AUVs a wake-up group should have at most: they share buffers and wake together.
pub const GROUP_MAX: usize = 32;

fn down_service(group: usize) -> String {
    format!("down/{group}")
}

fn up_service(group: usize) -> String {
    format!("up/{group}")
}
