//! When a modem emits: `access`, `ping_period_s` and `ping_phase_s` of `[group.modem]`.

use toml::de::DeTable;

use crate::AUVS_MAX;
use crate::environment::norm;
use crate::model::{Environment, Level, MediumAccess, PhysicalLayer};
use crate::modem::{Surroundings, in_seconds, packet_arithmetic, packet_ns, rounded, rounded_up};
use crate::number::Rule;
use crate::packet::PING_BYTES;
use crate::reader::Table;
use crate::sensing::PERIOD_MIN_NS;
use crate::sound_speed::slowest_m_s;

/// A modem listens at most so long before it emits, in local nanoseconds: it remembers no more of what it heard.
pub const LISTEN_MAX_NS: i64 = 10_000_000_000;

/// So long must the medium have been quiet where packets take no time.
const QUIET_DEFAULT_NS: i64 = 100_000_000;
const NAMES: [&str; 4] = ["periodic", "aloha", "slotted", "csma"];

/// `packet` is the physical layer where packets take time.
pub(crate) fn medium_access(
    modem: &Table<'_>,
    like: &MediumAccess,
    packet: Option<&PhysicalLayer>,
    around: &Surroundings<'_>,
) -> Option<MediumAccess> {
    let default_ns = match *like {
        MediumAccess::Periodic { period_ns, .. } | MediumAccess::Csma { period_ns, .. } => period_ns,
        MediumAccess::Aloha { mean_period_ns } => mean_period_ns,
        MediumAccess::Silent | MediumAccess::Slotted { .. } => 1_000_000_000,
    };
    let period_ns = modem.time_or_none_ns("ping_period_s", default_ns, PERIOD_MIN_NS);
    let phase_ns = match modem.get("ping_phase_s") {
        None => Some(None),
        Some(value) => modem.time_in("ping_phase_s", value, 0).map(Some),
    };
    let (name, table) = match modem.has("access") {
        true => modem.name_or_table("access", "[group.modem.access]")?,
        false => {
            modem.get("access");
            ("periodic", None)
        }
    };
    if !NAMES.contains(&name) {
        let span = table.as_ref().map_or(modem.span("access"), |table| table.span("name"));
        modem.unknown_name(span, "access", name, NAMES.into_iter());
        return None;
    }
    let empty = DeTable::new();
    let table = table
        .unwrap_or_else(|| Table::new(&empty, modem.span("access"), "[group.modem.access]", modem.findings));
    if !matches!(name, "periodic") {
        has_no_phase(modem, name);
    }
    let written_ns = period_ns.flatten().filter(|_| modem.has("ping_period_s"));
    let slotted = (name == "slotted").then(|| slotted(&table, written_ns, packet, around));
    let packet_ns = packet.map_or(QUIET_DEFAULT_NS, packet_ns);
    let waits_ns = (name == "csma").then(|| {
        let listen_ns = listen(&table, packet_ns);
        (listen_ns, table.time_ns("backoff_s", Some(2 * packet_ns), 1))
    });
    table.finish();
    let Some(period_ns) = period_ns? else { return Some(MediumAccess::Silent) };
    if let Some(slotted) = slotted {
        return slotted;
    }
    outlasts_a_packet(modem, period_ns, packet);
    Some(match (name, waits_ns) {
        ("aloha", _) => MediumAccess::Aloha { mean_period_ns: period_ns },
        (_, Some((listen_ns, backoff_ns))) => {
            MediumAccess::Csma { period_ns, listen_ns: listen_ns?, backoff_ns: backoff_ns? }
        }
        _ => MediumAccess::Periodic { period_ns, phase_ns: phase_ns.flatten() },
    })
}

fn outlasts_a_packet(modem: &Table<'_>, period_ns: i64, packet: Option<&PhysicalLayer>) {
    if let Some(layer) = packet
        && period_ns < packet_ns(layer)
    {
        modem.refuse(
            "ping_period_s",
            format!(
                "a ping every {} s, but a packet takes {}",
                in_seconds(period_ns),
                packet_arithmetic(layer)
            ),
            if modem.has("ping_period_s") { "shorter than one packet" } else { "no `ping_period_s` here" },
            format!(
                "write `ping_period_s = {}` or more, or choose a faster modem",
                rounded_up(layer.packet_s(PING_BYTES))
            ),
        );
    }
}

/// How long the medium must have been quiet: one packet, unless the table says it.
fn listen(table: &Table<'_>, packet_ns: i64) -> Option<i64> {
    let listen_ns = table.time_ns("listen_s", Some(packet_ns.min(LISTEN_MAX_NS)), 1)?;
    if listen_ns > LISTEN_MAX_NS {
        let most_s = in_seconds(LISTEN_MAX_NS);
        table.refuse(
            "listen_s",
            format!("a modem remembers what it heard for {most_s} s, not for {} s", in_seconds(listen_ns)),
            format!("longer than {most_s} s"),
            format!("write `listen_s = {most_s}` or less; a busy band is better shared by `backoff_s`"),
        );
        return None;
    }
    Some(listen_ns)
}

fn has_no_phase(modem: &Table<'_>, name: &str) {
    if modem.has("ping_phase_s") {
        modem.refuse(
            "ping_phase_s",
            format!("the access `{name}` has no phase"),
            "only for `periodic`",
            "remove `ping_phase_s`, or write `access = \"periodic\"`",
        );
    }
}

/// Slots: of the stated length, or as long as the stated period shared among them allows.
fn slotted(
    table: &Table<'_>,
    period_ns: Option<i64>,
    packet: Option<&PhysicalLayer>,
    around: &Surroundings<'_>,
) -> Option<MediumAccess> {
    // Wrong counts are reported where they are; no AUV is no number of slots.
    let auvs = around.auvs.unwrap_or(1).max(1);
    let slots = table
        .whole("slots", Some(auvs.into()), 1, AUVS_MAX.into())
        .and_then(|slots| u32::try_from(slots).ok());
    let shared_ns = period_ns.zip(slots).map(|(period_ns, slots)| (period_ns / i64::from(slots)).max(1));
    let slot_ns = table.time_ns("slot_s", shared_ns, PERIOD_MIN_NS);
    let diagonal_m = around
        .environment
        .map_or(0.0, |environment| norm(environment.area_m.map(|[least, greatest]| greatest - least)));
    let guard_range_m = table.number("guard_range_m", Some(diagonal_m), Rule::NotNegative);
    let (slot_ns, slots, guard_range_m) = (slot_ns?, slots?, guard_range_m?);
    if let Some(environment) = around.environment {
        holds_a_packet(table, (slot_ns, slots), guard_range_m, packet, environment);
    }
    let frame_ns = slot_ns.checked_mul(slots.into());
    if let (Some(period_ns), Some(frame_ns), true) = (period_ns, frame_ns, table.has("slot_s"))
        && period_ns != frame_ns
    {
        table.refuse(
            "slot_s",
            format!(
                "{slots} slots of {} s are {} s, but `ping_period_s` is {} s",
                in_seconds(slot_ns),
                in_seconds(frame_ns),
                in_seconds(period_ns)
            ),
            "with slots, an AUV pings once in each frame",
            "remove `ping_period_s` or `slot_s`: either follows from the other",
        );
    }
    if frame_ns.is_none() {
        table.refuse(
            "slot_s",
            format!("a frame of {slots} slots of {} s never ends", in_seconds(slot_ns)),
            "longer than 292 years in all",
            "write a shorter `slot_s`",
        );
    }
    Some(MediumAccess::Slotted { slot_ns, slots, guard_range_m })
}

fn holds_a_packet(
    table: &Table<'_>,
    (slot_ns, slots): (i64, u32),
    guard_range_m: f64,
    packet: Option<&PhysicalLayer>,
    environment: &Environment,
) {
    let slowest_m_s = slowest_sound_m_s(environment);
    // Sound slower than bodies is refused elsewhere.
    if slowest_m_s <= 0.0 {
        return;
    }
    let needed_s = packet.map_or(0.0, |layer| layer.packet_s(PING_BYTES)) + guard_range_m / slowest_m_s;
    if slot_ns >= (needed_s * 1e9).round() as i64 {
        return;
    }
    let way = format!("{} m / ({slowest_m_s} m/s)", rounded(guard_range_m, 2));
    let arithmetic = match packet {
        Some(layer) => format!("{} s + {way}", rounded(layer.packet_s(PING_BYTES), 4)),
        None => way,
    };
    let what = if packet.is_some() { "a packet and its way" } else { "the way of sound" };
    table.refuse(
        "slot_s",
        format!(
            "a slot of {} s is shorter than {what} to the guard range: {arithmetic} = {} s",
            in_seconds(slot_ns),
            rounded(needed_s, 4)
        ),
        "runs into the next slot",
        match table.has("slot_s") {
            true => {
                format!("write `slot_s = {}` or more, or a shorter `guard_range_m`", rounded_up(needed_s))
            }
            false => format!(
                "write `ping_period_s = {}` or more, or a shorter `guard_range_m`",
                rounded_up(needed_s * f64::from(slots))
            ),
        },
    );
}

/// No sound in this water is slower, in m/s.
fn slowest_sound_m_s(environment: &Environment) -> f64 {
    let uniform_m_s = environment.sound_speed_m_s;
    let stated_m_s = match &environment.level {
        Level::Ideal => uniform_m_s,
        Level::Sea(sea) => slowest_m_s(&sea.sound_speed, uniform_m_s),
    };
    stated_m_s - environment.sound_speed_error_m_s
}
