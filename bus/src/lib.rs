//! What crosses between the processes of a run: messages, their codec, lockstep, transports and the record.
//!
//! Without features this crate is only messages and the lockstep traits: what the pure state machines may see.

pub mod chronicle;
pub mod codec;
pub mod composite;
#[cfg(feature = "zenoh")]
pub mod hosts;
#[cfg(feature = "iceoryx2")]
mod iceoryx;
pub mod local;
pub mod lockstep;
pub mod message;
#[cfg(any(feature = "iceoryx2", feature = "zenoh"))]
pub mod os;
pub mod ping;
#[cfg(feature = "zenoh")]
pub mod protocol;
#[cfg(feature = "record")]
pub mod record;
#[cfg(any(feature = "iceoryx2", feature = "zenoh"))]
pub mod run_dir;
#[cfg(feature = "iceoryx2")]
pub mod shared_memory;
pub mod summary;
#[cfg(all(feature = "iceoryx2", feature = "record"))]
pub mod tap;
pub mod time;
pub mod traffic;
#[cfg(any(feature = "iceoryx2", feature = "zenoh"))]
mod watch;
#[cfg(any(feature = "iceoryx2", feature = "zenoh"))]
mod wire;
#[cfg(feature = "zenoh")]
pub mod zenoh;
