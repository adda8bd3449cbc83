//! The key `modem` of a group: a name, or the table `[group.modem]`.

use toml::de::{DeTable, DeValue};

use crate::medium_access::medium_access;
use crate::model::{DutyCycle, Environment, FalseArrivals, Level, Modem, Modulation, PhysicalLayer};
use crate::number::Rule;
use crate::packet::{FRAME_BYTES_MAX, PING_BYTES};
use crate::presets::{EVOLOGICS_18_34, IDEAL, MODEMS};
use crate::reader::Table;
use crate::sensing::PERIOD_MIN_NS;

/// What the checks of a modem need to know.
pub(crate) struct Surroundings<'a> {
    pub(crate) environment: Option<&'a Environment>,
    /// AUVs of the whole scenario.
    pub(crate) auvs: Option<u32>,
}

const PHYSICAL_KEYS: [&str; 9] = [
    "source_level_db",
    "centre_hz",
    "bandwidth_hz",
    "bit_rate_bit_s",
    "preamble_s",
    "modulation",
    "coding_gain_db",
    "detection_threshold_db",
    "capture_db",
];
pub(crate) const MODULATIONS: &[(&str, Modulation)] = &[("bpsk", Modulation::Bpsk), ("fsk", Modulation::Fsk)];
/// Sound of more than this would boil the water, and of less than none is none.
const SOURCE_LEVEL: Rule = Rule::Within(0.0, 260.0);
/// An error of more than half a turn says nothing of the direction.
const BEARING_ERROR: Rule = Rule::Within(0.0, std::f64::consts::PI);
/// What comes later than this is no echo of the same ping.
const OUTLIER_DELAY: Rule = Rule::Within(0.0, 10.0);
const CAPTURE_DEFAULT_DB: f64 = 6.0;

pub(crate) fn modem(group: &Table<'_>, around: &Surroundings<'_>) -> Option<Modem> {
    let empty = DeTable::new();
    let bare = || Table::new(&empty, group.span("modem"), "[group.modem]", group.findings);
    let (table, like) = match group.get("modem").map(|value| (value, value.get_ref())) {
        None => (bare(), Some(&IDEAL)),
        Some((_, DeValue::String(name))) => (bare(), preset(group, "modem", name)),
        Some((value, DeValue::Table(entries))) => {
            let table = Table::new(entries, value.span(), "[group.modem]", group.findings);
            let like = table.text("like", Some(IDEAL.name)).and_then(|name| preset(&table, "like", name));
            (table, like)
        }
        Some((value, _)) => {
            group.wrong_type("modem", value, "a name or a table");
            return None;
        }
    };
    // A wrong `like` is reported; what it would have filled in is no second error.
    let read = in_full(&table, like.unwrap_or(&EVOLOGICS_18_34), around);
    table.finish();
    like.and(read)
}

fn preset(table: &Table<'_>, key: &str, name: &str) -> Option<&'static Modem> {
    let found = MODEMS.iter().find(|(known, _)| *known == name).map(|(_, modem)| modem);
    if found.is_none() {
        table.unknown_name(table.span(key), key, name, MODEMS.iter().map(|(known, _)| *known));
    }
    found
}

fn in_full(table: &Table<'_>, like: &Modem, around: &Surroundings<'_>) -> Option<Modem> {
    let range_m = table.number("range_m", Some(like.range_m), Rule::Positive);
    let timestamp_error_s =
        table.number("timestamp_error_s", Some(like.timestamp_error_s), Rule::NotNegative);
    let bearing_error_rad = match table.get("bearing_error_rad") {
        None => Some(like.bearing_error_rad),
        Some(value) if matches!(value.get_ref(), DeValue::Boolean(false)) => Some(None),
        Some(value) => table.number_in("bearing_error_rad", value, BEARING_ERROR).map(Some),
    };
    let outlier_rate = table.number("outlier_rate", Some(like.outliers.rate), Rule::Within(0.0, 1.0));
    let outlier_delay_s = table.number("outlier_delay_s", Some(like.outliers.delay_s), OUTLIER_DELAY);
    let frame_bytes = frame_bytes(table, like);
    let addresses = match table.get("addresses") {
        None => Some(like.addresses),
        Some(_) => table
            .whole("addresses", None, 1, u64::from(u32::MAX))
            .and_then(|addresses| u32::try_from(addresses).ok())
            .map(Some),
    };
    let physical = physical(table, like.physical.as_ref());
    // At level `ideal` a packet takes no time, so that anything is long enough for it.
    let at_sea = around.environment.is_some_and(|environment| environment.level != Level::Ideal);
    if at_sea {
        fits_the_sea(table, like.name, physical.as_ref());
    }
    let packet = physical.flatten().filter(|_| at_sea);
    let duty_cycle = duty_cycle(table, like.duty_cycle, packet.as_ref());
    let access = medium_access(table, &like.access, packet.as_ref(), around);
    Some(Modem {
        name: like.name,
        range_m: range_m?,
        access: access?,
        timestamp_error_s: timestamp_error_s?,
        bearing_error_rad: bearing_error_rad?,
        outliers: FalseArrivals { rate: outlier_rate?, delay_s: outlier_delay_s? },
        frame_bytes: frame_bytes?,
        physical: physical?,
        addresses: addresses?,
        duty_cycle: duty_cycle?,
    })
}

fn frame_bytes(table: &Table<'_>, like: &Modem) -> Option<u16> {
    let bytes = table.whole("frame_bytes", Some(like.frame_bytes.into()), 0, u16::MAX.into())?;
    let bytes = u16::try_from(bytes).ok()?;
    if bytes < PING_BYTES {
        table.refuse(
            "frame_bytes",
            format!("a ping of {PING_BYTES} bytes does not fit into a frame of {bytes}"),
            "smaller than one ping",
            format!("write {PING_BYTES} or more"),
        );
        return None;
    }
    if bytes > FRAME_BYTES_MAX {
        table.refuse(
            "frame_bytes",
            format!("frames of {bytes} bytes; the longest that can be sent has {FRAME_BYTES_MAX}"),
            "longer than any frame",
            format!(
                "write {FRAME_BYTES_MAX} or less: a ping has {PING_BYTES} bytes, and nothing else is sent"
            ),
        );
        return None;
    }
    Some(bytes)
}

/// The physical layer: that of `like`, changed by what the table says, or in full; none when neither has one.
fn physical(table: &Table<'_>, like: Option<&PhysicalLayer>) -> Option<Option<PhysicalLayer>> {
    if like.is_none() && !PHYSICAL_KEYS.iter().any(|key| table.has(key)) {
        for key in PHYSICAL_KEYS {
            table.get(key);
        }
        return Some(None);
    }
    let own = |field: fn(&PhysicalLayer) -> f64| like.map(field);
    let or = |field: fn(&PhysicalLayer) -> f64, default: f64| Some(like.map_or(default, field));
    let source_level_db = table.number("source_level_db", own(|layer| layer.source_level_db), SOURCE_LEVEL);
    let centre_hz = table.number("centre_hz", own(|layer| layer.centre_hz), Rule::Positive);
    let bandwidth_hz = table.number("bandwidth_hz", own(|layer| layer.bandwidth_hz), Rule::Positive);
    let bit_rate_bit_s = table.number("bit_rate_bit_s", own(|layer| layer.bit_rate_bit_s), Rule::Positive);
    let preamble_s = table.number("preamble_s", or(|layer| layer.preamble_s, 0.0), Rule::NotNegative);
    let modulation =
        table.choice("modulation", MODULATIONS, like.map_or(Modulation::Bpsk, |layer| layer.modulation));
    let coding_gain_db =
        table.number("coding_gain_db", or(|layer| layer.coding_gain_db, 0.0), Rule::NotNegative);
    let detection_threshold_db =
        table.number("detection_threshold_db", or(|layer| layer.detection_threshold_db, 0.0), Rule::Finite);
    let capture_db =
        table.number("capture_db", or(|layer| layer.capture_db, CAPTURE_DEFAULT_DB), Rule::NotNegative);
    let layer = PhysicalLayer {
        source_level_db: source_level_db?,
        centre_hz: centre_hz?,
        bandwidth_hz: bandwidth_hz?,
        bit_rate_bit_s: bit_rate_bit_s?,
        preamble_s: preamble_s?,
        modulation: modulation?,
        coding_gain_db: coding_gain_db?,
        detection_threshold_db: detection_threshold_db?,
        capture_db: capture_db?,
    };
    band_is_above_zero(table, &layer).then_some(Some(layer))
}

fn band_is_above_zero(table: &Table<'_>, layer: &PhysicalLayer) -> bool {
    let (centre_hz, bandwidth_hz) = (layer.centre_hz, layer.bandwidth_hz);
    let lowest_hz = centre_hz - 0.5 * bandwidth_hz;
    if lowest_hz < 0.0 {
        table.refuse(
            if table.has("bandwidth_hz") { "bandwidth_hz" } else { "centre_hz" },
            format!("the band begins below 0 Hz: {centre_hz} Hz - {bandwidth_hz} Hz / 2 = {lowest_hz} Hz"),
            "half of the band reaches below zero",
            format!(
                "write `bandwidth_hz = {}` or less, or `centre_hz = {}` or more",
                2.0 * centre_hz,
                0.5 * bandwidth_hz
            ),
        );
    }
    lowest_hz >= 0.0
}

/// What only level `sea` asks of a modem.
fn fits_the_sea(table: &Table<'_>, name: &str, physical: Option<&Option<PhysicalLayer>>) {
    if let Some(None) = physical {
        table.findings.add(
            table.header(),
            format!("the modem `{name}` has no physical layer, without which nobody hears it at level `sea`"),
            format!("`{name}` unless another is named"),
            "choose one such as `modem = \"micromodem-psk\"`, or write `source_level_db`, `centre_hz`, `bandwidth_hz` \
             and `bit_rate_bit_s`",
        );
    }
    if table.has("range_m") {
        let fix = match physical {
            Some(Some(layer)) => format!(
                "remove `range_m`; to be heard farther or less far, change `source_level_db`, which is {}",
                layer.source_level_db
            ),
            _ => "remove `range_m`, and write `source_level_db`".to_string(),
        };
        table.refuse(
            "range_m",
            "a range without a level: at level `sea` the range follows from source level, losses and noise",
            "only for level `ideal`",
            fix,
        );
    }
}

/// When the modem listens; `packet` is the physical layer where packets take time.
fn duty_cycle(
    modem: &Table<'_>,
    like: Option<DutyCycle>,
    packet: Option<&PhysicalLayer>,
) -> Option<Option<DutyCycle>> {
    if !modem.has("duty_cycle") {
        modem.get("duty_cycle");
        return Some(like);
    }
    let table = modem.table("duty_cycle", "[group.modem.duty_cycle]")?;
    let period_ns = table.time_ns("period_s", None, PERIOD_MIN_NS);
    let awake_ns = table.time_ns("awake_s", None, PERIOD_MIN_NS);
    table.report_missing();
    if let (Some(period_ns), Some(awake_ns)) = (period_ns, awake_ns)
        && awake_ns > period_ns
    {
        table.refuse(
            "awake_s",
            format!("awake for {} s of every {} s", in_seconds(awake_ns), in_seconds(period_ns)),
            "longer than `period_s`",
            format!("write `awake_s = {}` or less", in_seconds(period_ns)),
        );
    }
    if let (Some(layer), Some(awake_ns)) = (packet, awake_ns)
        && awake_ns < packet_ns(layer)
    {
        table.refuse(
            "awake_s",
            format!(
                "awake for {} s at a time, but a packet takes {}",
                in_seconds(awake_ns),
                packet_arithmetic(layer)
            ),
            "shorter than one packet",
            format!("write `awake_s = {}` or more", rounded_up(layer.packet_s(PING_BYTES))),
        );
    }
    table.finish();
    Some(Some(DutyCycle { period_ns: period_ns?, awake_ns: awake_ns? }))
}

/// Length of a ping in nanoseconds.
pub(crate) fn packet_ns(layer: &PhysicalLayer) -> i64 {
    (layer.packet_s(PING_BYTES) * 1e9).round() as i64
}

/// How the length of a ping comes about, such as `1 s + 248 bit / (80 bit/s) = 4.1 s`.
pub(crate) fn packet_arithmetic(layer: &PhysicalLayer) -> String {
    format!(
        "{} s + {} bit / ({} bit/s) = {} s",
        layer.preamble_s,
        8 * PING_BYTES,
        layer.bit_rate_bit_s,
        rounded(layer.packet_s(PING_BYTES), 4)
    )
}

/// Nanoseconds as a person writes seconds.
pub(crate) fn in_seconds(ns: i64) -> f64 {
    ns as f64 / 1e9
}

/// Seconds with four decimals, rounded up but for what binary numbers add.
pub(crate) fn rounded_up(seconds: f64) -> f64 {
    (seconds * 1e4 - 1e-6).ceil() / 1e4
}

/// The number with at most so many decimals, and no zeros at its end.
pub(crate) fn rounded(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}
