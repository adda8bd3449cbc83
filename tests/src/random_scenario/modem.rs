//! The table `[group.modem]`, drawn at random.

use std::fmt::Write;

use shoal_scenario::PING_BYTES;
use shoal_scenario::presets::MODEMS;

use super::{Dice, Sound, Water};

/// A modem as far as its packets go.
pub(super) struct Drawn {
    lines: String,
    /// Length of a ping.
    pub(super) packet_s: f64,
}

impl Drawn {
    pub(super) fn draw(dice: &mut Dice, water: &Water) -> Result<Self, std::fmt::Error> {
        match &water.sound {
            Sound::Ideal { .. } => Ok(Self {
                lines: format!("range_m = {}\n", dice.magnitude(5.0, 4.0 * water.side_m + 5.0)),
                packet_s: 0.0,
            }),
            Sound::Sea(sea) => {
                let number = if dice.chance(0.6) { sea.modem_number } else { dice.whole(0, 1 << 40) };
                physical(&mut Dice::new(number), sea.is_wide)
            }
        }
    }
}

pub(super) fn write_modem(
    text: &mut String,
    dice: &mut Dice,
    water: &Water,
    drawn: &Drawn,
    has_bearings: bool,
) -> std::fmt::Result {
    writeln!(text, "[group.modem]\n{}timestamp_error_s = {}", drawn.lines, dice.error(1e-3))?;
    if has_bearings {
        writeln!(text, "bearing_error_rad = {}", dice.error(3.1))?;
    }
    if dice.chance(0.25) {
        let (rate, delay_s) = (dice.magnitude(0.01, 0.4), dice.magnitude(1e-4, 2.0));
        writeln!(text, "outlier_rate = {rate}\noutlier_delay_s = {delay_s}")?;
    }
    write_access(text, dice, water, drawn.packet_s)?;
    if drawn.packet_s > 0.0 && dice.chance(0.25) {
        let awake_s = drawn.packet_s * dice.between(1.0, 8.0) + 0.001;
        let period_s = awake_s * dice.between(1.0, 3.0) + 0.001;
        writeln!(text, "duty_cycle = {{ period_s = {period_s:.3}, awake_s = {awake_s:.3} }}")?;
    }
    Ok(())
}

/// A maker's modem, or one of our own with packets of 15 to 500 ms, as loud or faint as can be.
fn physical(dice: &mut Dice, is_wide: bool) -> Result<Drawn, std::fmt::Error> {
    let mut lines = String::new();
    let faint_db = dice.between(90.0, 190.0);
    if is_wide {
        let at_sea: Vec<_> =
            MODEMS.iter().filter_map(|(_, modem)| Some((modem.name, modem.physical?))).collect();
        let (name, layer) = at_sea[dice.whole(0, at_sea.len() as u64 - 1) as usize];
        writeln!(lines, "like = \"{name}\"")?;
        if dice.chance(0.6) {
            writeln!(lines, "source_level_db = {faint_db}")?;
        }
        return Ok(Drawn { lines, packet_s: layer.packet_s(PING_BYTES) });
    }
    let centre_hz = dice.magnitude(1_000.0, 60_000.0);
    let bandwidth_hz = centre_hz * dice.between(0.05, 1.5);
    let (bit_rate_bit_s, preamble_s) = (dice.magnitude(500.0, 20_000.0), dice.error(0.2));
    writeln!(lines, "source_level_db = {faint_db}\ncentre_hz = {centre_hz}\nbandwidth_hz = {bandwidth_hz}")?;
    writeln!(lines, "bit_rate_bit_s = {bit_rate_bit_s}\npreamble_s = {preamble_s}")?;
    writeln!(lines, "modulation = \"{}\"", dice.one_of(&["bpsk", "fsk"]))?;
    writeln!(lines, "coding_gain_db = {}\ncapture_db = {}", dice.error(6.0), dice.error(20.0))?;
    writeln!(lines, "detection_threshold_db = {}", dice.between(-15.0, 15.0))?;
    Ok(Drawn { lines, packet_s: preamble_s + 8.0 * f64::from(PING_BYTES) / bit_rate_bit_s })
}

fn write_access(text: &mut String, dice: &mut Dice, water: &Water, packet_s: f64) -> std::fmt::Result {
    if dice.chance(0.1) {
        return writeln!(text, "ping_period_s = false");
    }
    // Half a millisecond more for the rounding to milliseconds.
    let shortest_s = packet_s + 6e-4;
    let period_s = shortest_s * dice.between(1.0, 4.0) + dice.magnitude(0.05, 3.0);
    let kinds = if packet_s > 0.0 { 7 } else { 15 };
    match dice.whole(0, kinds) {
        0 => {
            let slowest_m_s = match &water.sound {
                Sound::Ideal { speed_m_s } => *speed_m_s,
                Sound::Sea(sea) => sea.slowest_m_s,
            };
            // The speed of sound is wrong by two hundredths at most.
            let guard_range_m = dice.error(2.0 * water.side_m);
            let slot_s = shortest_s + guard_range_m / (0.97 * slowest_m_s) + dice.error(0.5);
            let slots = dice.whole(1, 14);
            writeln!(
                text,
                "access = {{ name = \"slotted\", slot_s = {slot_s:.3}, slots = {slots}, guard_range_m = {guard_range_m} }}"
            )
        }
        1 => writeln!(text, "ping_period_s = {period_s:.3}\naccess = \"aloha\""),
        2 | 3 => {
            let (listen_s, backoff_s) = (dice.seconds(0.001, 2.0), dice.seconds(0.001, 2.0));
            writeln!(
                text,
                "ping_period_s = {period_s:.3}\naccess = {{ name = \"csma\", listen_s = {listen_s}, backoff_s = {backoff_s} }}"
            )
        }
        _ => writeln!(text, "ping_period_s = {period_s:.3}"),
    }
}
