//! The table `[group.modem]`.

use crate::model::{MediumAccess, Modem};
use crate::number::Rule;
use crate::reader::Table;

/// Bytes of a ping: sender, sequence, emission interval, position box and velocity box.
const PING_BYTES: u64 = 31;
/// Fastest that anything periodic on an AUV may happen.
pub(crate) const PERIOD_MIN_NS: i64 = 1_000_000;
/// Slowest that an AUV may wake.
pub(crate) const PERIOD_MAX_NS: i64 = 1_000_000_000_000;
const SECOND_NS: i64 = 1_000_000_000;

pub(crate) fn modem(group: &Table<'_>) -> Option<Modem> {
    if !group.has("modem") {
        group.get("modem");
        return Some(Modem {
            name: "ideal".to_string(),
            range_m: 500.0,
            access: MediumAccess::Periodic { period_ns: SECOND_NS, phase_ns: None },
            timestamp_error_s: 1e-5,
            frame_bytes: 64,
            physical: None,
            addresses: None,
            duty_cycle: None,
        });
    }
    let table = group.table("modem", "[group.modem]")?;
    let range_m = table.number("range_m", Some(500.0), Rule::Positive);
    let ping_period_ns = table.time_or_none_ns("ping_period_s", SECOND_NS, PERIOD_MIN_NS);
    let ping_phase_ns = match table.get("ping_phase_s") {
        None => Some(None),
        Some(value) => table.time_in("ping_phase_s", value, 0).map(Some),
    };
    let timestamp_error_s = table.number("timestamp_error_s", Some(1e-5), Rule::NotNegative);
    let frame_bytes = frame_bytes(&table);
    table.finish();
    Some(Modem {
        name: "ideal".to_string(),
        range_m: range_m?,
        access: ping_period_ns?.map_or(MediumAccess::Silent, |period_ns| MediumAccess::Periodic {
            period_ns,
            phase_ns: ping_phase_ns.flatten(),
        }),
        timestamp_error_s: timestamp_error_s?,
        frame_bytes: frame_bytes?,
        physical: None,
        addresses: None,
        duty_cycle: None,
    })
}

fn frame_bytes(table: &Table<'_>) -> Option<u16> {
    let bytes = table.whole("frame_bytes", Some(64), 0, u64::from(u16::MAX))?;
    if bytes < PING_BYTES {
        table.refuse(
            "frame_bytes",
            format!("a ping of {PING_BYTES} bytes does not fit into a frame of {bytes}"),
            "smaller than one ping",
            format!("write {PING_BYTES} or more"),
        );
        return None;
    }
    u16::try_from(bytes).ok()
}
