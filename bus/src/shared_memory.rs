//! The `iceoryx2` transport: AUVs in processes of their own, shared memory in between.
//!
//! Windows go through the run's arena, one file that everyone maps: each AUV has a slot with room for a message each way. The
//! channel writes what each AUV that is due is to know, then wakes exactly those processes with one futex call per wake-up group of 32; the
//! last of a group to answer wakes the channel, if it sleeps. In steady state an AUV makes one system call per window and touches a few
//! cache lines. Every message has a number, so nothing is skipped; what is too long for a slot goes through a file of the run.
//!
//! iceoryx2 itself carries the [tap](crate::tap): one publisher, observers who come and go. A port of it in each of a thousand AUVs took
//! a megabyte and four times the processor time of this.

mod arena;
mod fleet;
mod late;
mod link;
mod long;
mod members;

pub use fleet::SharedMemoryFleet;
pub use link::SharedMemoryLink;
pub use members::InterruptHandle;

const BUS: &str = "iceoryx2";
