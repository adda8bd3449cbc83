//! The `zenoh` transport: the channel's session is a router, every AUV's a client of it. It reaches other hosts.
//!
//! Down go a sequence number and a [`ToAuv`](crate::lockstep::ToAuv), up a [`FromAuv`](crate::lockstep::FromAuv) behind a
//! short header. An AUV says hello until it is born, and acknowledges its birth: from then on its subscription is known to
//! be in place, nothing is dropped, and sequence numbers prove it.

mod fleet;
mod frame;
mod link;
mod member;

use std::time::Duration;

use zenoh::{Config, Session, Wait};

#[cfg(test)]
pub(crate) use frame::{Kind, Up, write_down};

pub use fleet::{ZenohFleet, ZenohInterruptHandle};
pub use link::ZenohLink;

const BUS: &str = "zenoh";

/// The environment variable, name and value, that holds zenoh to one runtime thread. Set it on every AUV's process before
/// it starts: by default each has six, and a run of many processes takes twice as long.
pub const RUNTIME_ENV: (&str, &str) = (
    "ZENOH_RUNTIME",
    "(app: (worker_threads: 1), rx: (handover: app), tx: (handover: app), acc: (handover: app), net: (handover: app))",
);

/// How many sessions one channel takes.
const SESSIONS_MAX: usize = 20_000;

/// A machine that starts a thousand processes answers none of them soon.
const PATIENCE: Duration = Duration::from_secs(60);

fn down_key(run: &str, auv: impl std::fmt::Display) -> String {
    format!("shoal/{run}/down/{auv}")
}

fn up_key(run: &str, auv: impl std::fmt::Display) -> String {
    format!("shoal/{run}/up/{auv}")
}

/// Opens a session of `mode` that listens on or connects to (`role`) `endpoint`, and talks to nobody else.
fn session(mode: &str, role: &str, endpoint: &str) -> Result<Session, String> {
    let patience_ms = PATIENCE.as_millis().to_string();
    let patience_us = PATIENCE.as_micros().to_string();
    let endpoint_key = format!("{role}/endpoints");
    let settings = [
        ("mode", format!("{mode:?}")),
        ("listen/endpoints", "[]".into()),
        ("connect/endpoints", "[]".into()),
        (&endpoint_key, format!("[{}]", serde_json::Value::from(endpoint))),
        ("connect/timeout_ms", patience_ms.clone()),
        ("connect/exit_on_failure", "true".into()),
        ("connect/retry", "{period_init_ms: 50, period_max_ms: 500, period_increase_factor: 2}".into()),
        ("scouting/multicast/enabled", "false".into()),
        ("scouting/gossip/enabled", "false".into()),
        ("timestamping/enabled", "false".into()),
        ("transport/unicast/open_timeout", patience_ms.clone()),
        ("transport/unicast/accept_timeout", patience_ms.clone()),
        ("transport/unicast/accept_pending", SESSIONS_MAX.to_string()),
        ("transport/unicast/max_sessions", SESSIONS_MAX.to_string()),
        // One queue: what is declared first is known first.
        ("transport/unicast/qos/enabled", "false".into()),
        ("transport/link/tx/lease", patience_ms),
        ("transport/link/tx/queue/congestion_control/block/wait_before_close", patience_us),
    ];
    let mut config = Config::default();
    for (key, value) in settings {
        config.insert_json5(key, &value).map_err(|error| format!("setting {key}: {error}"))?;
    }
    zenoh::open(config).wait().map_err(|error| format!("session on {endpoint}: {error}"))
}
