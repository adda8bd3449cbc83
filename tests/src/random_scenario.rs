//! Scenario files drawn at random: as far into the corners as a scenario may go.

mod modem;
mod sea;

use std::fmt::Write;

use self::modem::{Drawn, write_modem};
use self::sea::{SeaDrawn, write_sea};

/// A reproducible source of draws (SplitMix64).
#[derive(Clone, Debug)]
pub struct Dice(u64);

impl Dice {
    /// The source with this number.
    pub fn new(number: u64) -> Self {
        Self(number.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d)
    }

    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In `[least, greatest)`.
    pub fn between(&mut self, least: f64, greatest: f64) -> f64 {
        least + (greatest - least) * self.unit()
    }

    /// In `[least, greatest)`, every order of magnitude as likely as the next.
    pub fn magnitude(&mut self, least: f64, greatest: f64) -> f64 {
        let mut value = least;
        // As powers of two, so that no logarithm is needed.
        let mut doublings = 0.0;
        while value * 2.0 <= greatest {
            value *= 2.0;
            doublings += 1.0;
        }
        let whole = (self.unit() * (doublings + 1.0)) as i32;
        (0..whole).fold(least, |value, _| value * 2.0).min(greatest) * self.between(0.75, 1.0)
    }

    /// From `least` to `greatest`, both included.
    pub fn whole(&mut self, least: u64, greatest: u64) -> u64 {
        least + (self.unit() * (greatest - least + 1) as f64) as u64
    }

    /// True so often.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// One of the words.
    fn one_of(&mut self, words: &[&'static str]) -> &'static str {
        words[self.whole(0, words.len() as u64 - 1) as usize]
    }

    /// Zero, or else of any magnitude up to `greatest`.
    fn error(&mut self, greatest: f64) -> f64 {
        if self.chance(0.2) { 0.0 } else { self.magnitude(greatest * 1e-3, greatest) }
    }

    /// Whole milliseconds, in seconds.
    fn seconds(&mut self, least: f64, greatest: f64) -> String {
        format!("{:.3}", self.magnitude(least, greatest).max(least))
    }

    fn errors(&mut self, greatest: f64) -> String {
        let [x, y, z] = [self.error(greatest), self.error(greatest), self.error(greatest)];
        format!("[{x}, {y}, {z}]")
    }
}

/// The text of the scenario with this number at level `ideal`: 2 to 12 AUVs in up to three groups with bodies, clocks, sensors,
/// modems and controllers of any kind, for `duration_s` seconds.
pub fn random_scenario(number: u64, duration_s: f64) -> String {
    written(number, duration_s, |dice| Sound::Ideal { speed_m_s: dice.magnitude(60.0, 1600.0) })
}

/// As [`random_scenario`], at level `sea`: water, noise, boundaries and modems of any kind.
pub fn random_sea_scenario(number: u64, duration_s: f64) -> String {
    written(number, duration_s, |dice| Sound::Sea(SeaDrawn::draw(dice)))
}

fn written(number: u64, duration_s: f64, sound: fn(&mut Dice) -> Sound) -> String {
    let mut dice = Dice::new(number);
    let mut text = String::new();
    // Writing to a string does not fail.
    let _infallible = write_scenario(&mut text, &mut dice, sound, number, duration_s);
    text
}

/// What carries sound.
enum Sound {
    Ideal { speed_m_s: f64 },
    Sea(SeaDrawn),
}

/// What the groups need to know of the water.
struct Water {
    side_m: f64,
    depth_m: f64,
    /// Bound of the stated current anywhere.
    current_m_s: f64,
    groups: u64,
    fastest_m_s: f64,
    sound: Sound,
}

fn write_scenario(
    text: &mut String,
    dice: &mut Dice,
    sound: fn(&mut Dice) -> Sound,
    number: u64,
    duration_s: f64,
) -> std::fmt::Result {
    let groups = dice.whole(1, 3);
    let sound = sound(dice);
    let sound_speed_m_s = match &sound {
        Sound::Ideal { speed_m_s } => *speed_m_s,
        Sound::Sea(sea) => sea.slowest_m_s,
    };
    let uniform_m_s = if dice.chance(0.5) { 0.0 } else { dice.between(0.0, 0.4) };
    let (field, field_m_s) = current_field(dice);
    let water = Water {
        side_m: dice.magnitude(20.0, 2000.0),
        depth_m: dice.magnitude(5.0, 500.0),
        current_m_s: uniform_m_s + field_m_s,
        groups,
        fastest_m_s: (sound_speed_m_s / 4.0 - 2.0).min(12.0),
        sound,
    };
    let noise = if dice.chance(0.5) { "uniform" } else { "adversarial" };
    writeln!(
        text,
        "name = \"random-{number}\"\nseed = {number}\nduration_s = {duration_s}\nnoise = \"{noise}\""
    )?;
    if dice.chance(0.3) {
        writeln!(text, "knot_ms = {}", dice.whole(1, 50))?;
    }
    let Water { side_m, depth_m, .. } = water;
    writeln!(
        text,
        "[environment]\narea_m = [[-{side_m}, {side_m}], [-{side_m}, {side_m}], [-{depth_m}, 0]]"
    )?;
    writeln!(text, "sound_speed_error_m_s = {}", dice.error(0.02 * sound_speed_m_s))?;
    let [x, y] = [dice.between(-uniform_m_s, uniform_m_s), dice.between(-uniform_m_s, uniform_m_s)];
    writeln!(text, "current_m_s = [{}, {}, 0]", 0.7 * x, 0.7 * y)?;
    writeln!(text, "current_error_m_s = {}", dice.errors(0.3))?;
    text.push_str(&field);
    match &water.sound {
        Sound::Ideal { .. } => writeln!(text, "sound_speed_m_s = {sound_speed_m_s}")?,
        Sound::Sea(sea) => write_sea(text, dice, sea, depth_m)?,
    }
    let most = 12 / groups;
    let mut auvs = 0;
    let mut faults = String::new();
    for index in 0..groups {
        let count = dice.whole(if water.groups == 1 { 2 } else { 1 }, most);
        let may_be_kidnapped = write_group(text, dice, &water, index, count)?;
        if may_be_kidnapped && dice.chance(0.5) {
            let auv = auvs + dice.whole(0, count - 1);
            write_kidnapping(&mut faults, dice, &water, auv, duration_s)?;
        }
        auvs += count;
    }
    text.push_str(&faults);
    Ok(())
}

/// Only who begins again from the whole area, or promises nothing, gets over it.
fn write_kidnapping(
    text: &mut String,
    dice: &mut Dice,
    water: &Water,
    auv: u64,
    duration_s: f64,
) -> std::fmt::Result {
    let Water { side_m, depth_m, .. } = *water;
    let [x, y] = [dice.between(-side_m, side_m), dice.between(-side_m, side_m)];
    let to_m = [x, y, dice.between(-depth_m, 0.0)];
    let at_s = dice.between(0.0, 0.9 * duration_s);
    writeln!(text, "\n[[fault]]\nkind = \"kidnap\"\nauv = {auv}\nat_s = {at_s:.3}\nto_m = {to_m:?}")
}

/// A line for `[environment]` about how the current differs from place to place, and how fast it is anywhere, in m/s.
fn current_field(dice: &mut Dice) -> (String, f64) {
    match dice.whole(0, 3) {
        0 => {
            let mut end = || [dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), dice.between(-0.05, 0.05)];
            let (surface, deep) = (end(), end());
            let depth_m = dice.magnitude(0.5, 200.0);
            let line = format!(
                "current_field = {{ name = \"shear\", surface_m_s = {surface:?}, deep_m_s = {deep:?}, depth_m = {depth_m} }}\n"
            );
            (line, 0.43)
        }
        1 => {
            let (centre, speed_m_s) =
                ([dice.between(-500.0, 500.0), dice.between(-50.0, 50.0)], dice.between(-0.5, 0.5));
            let core_radius_m = dice.magnitude(0.5, 500.0);
            let line = format!(
                "current_field = {{ name = \"vortex\", centre_m = {centre:?}, core_radius_m = {core_radius_m}, speed_m_s = {speed_m_s} }}\n"
            );
            (line, speed_m_s.abs())
        }
        _ => (String::new(), 0.0),
    }
}

/// Writes a group; the answer is whether its AUVs get over a kidnapping, or promise nothing.
fn write_group(
    text: &mut String,
    dice: &mut Dice,
    water: &Water,
    index: u64,
    count: u64,
) -> Result<bool, std::fmt::Error> {
    writeln!(text, "\n[[group]]\nname = \"g{index}\"\ncount = {count}")?;
    let modem = Drawn::draw(dice, water)?;
    let control_period_s = dice.seconds(0.02, 0.5);
    writeln!(text, "control_period_s = {control_period_s}\nreaction_s = {}", dice.seconds(0.012, 0.5))?;
    // A packet is told at its end and belongs to its beginning, which must not be forgotten by then.
    let horizon_s = modem.packet_s + dice.magnitude(0.05, 60.0).max(0.05);
    let may_be_kidnapped = write_estimator(text, dice, horizon_s)?;
    let has_bearings = dice.chance(0.3);
    if dice.chance(0.4) {
        let measures =
            if has_bearings { dice.one_of(&["range-and-bearing", "bearing", "range"]) } else { "range" };
        let (exchanged, remembered) = (dice.chance(0.5), dice.magnitude(1.0, 64.0) as u64 + 1);
        writeln!(
            text,
            "relative = {{ measures = \"{measures}\", exchanged = {exchanged}, remembered = {remembered} }}"
        )?;
    }

    let is_suite = dice.chance(0.2);
    if is_suite {
        writeln!(text, "sensors = \"{}\"", dice.one_of(&["nominal", "mems-ahrs", "ahrs-dvl", "fog-ins"]))?;
    }
    let is_named_clock = dice.chance(0.35);
    if is_named_clock {
        writeln!(text, "clock = \"{}\"", dice.one_of(&["ideal", "quartz", "tcxo", "ocxo", "csac"]))?;
    }

    let speed_m_s = dice.magnitude(0.4, water.fastest_m_s);
    let turn_rate_rad_s = dice.magnitude(0.05, 1.6);
    let pitch_max_rad = if dice.chance(0.2) { 1.57 } else { dice.between(0.0, 1.5) };
    writeln!(
        text,
        "[group.kind]\nspeed_max_m_s = {speed_m_s}\nacceleration_max_m_s2 = {}\nturn_rate_max_rad_s = {turn_rate_rad_s}\n\
         pitch_max_rad = {pitch_max_rad}\ndisturbance_m_s = {}\nlength_m = 1",
        dice.magnitude(0.02, 4.0),
        dice.errors(0.5),
    )?;
    if !is_named_clock {
        write_clock(text, dice)?;
    }
    write_controller(text, dice, water, speed_m_s, turn_rate_rad_s)?;
    if !is_suite {
        write_sensors(text, dice, water)?;
    }
    write_modem(text, dice, water, &modem, has_bearings)?;
    Ok(may_be_kidnapped)
}

/// Writes how a group estimates; the answer is whether it gets over a kidnapping, or promises nothing.
fn write_estimator(text: &mut String, dice: &mut Dice, horizon_s: f64) -> Result<bool, std::fmt::Error> {
    match dice.whole(0, 14) {
        0 => {
            writeln!(text, "estimator = \"dead-reckoning\"")?;
            return Ok(false);
        }
        1 => {
            let fusion = dice.one_of(&["independent", "covariance-intersection"]);
            let gate = if dice.chance(0.3) { "false".to_owned() } else { dice.between(1.0, 6.0).to_string() };
            writeln!(text, "estimator = {{ name = \"ekf\", fusion = \"{fusion}\", gate_sigma = {gate} }}")?;
            return Ok(true);
        }
        _ => {}
    }
    write!(text, "estimator = {{ name = \"tube\", horizon_s = {horizon_s:.3}")?;
    if dice.chance(0.6) {
        write!(text, ", rings = {}", dice.whole(0, 64))?;
    }
    if dice.chance(0.5) {
        let ratio = if dice.chance(0.2) { 1.0 } else { dice.magnitude(0.0015, 1.0) };
        write!(text, ", stopping_ratio = {ratio}")?;
    }
    if dice.chance(0.4) {
        let window = dice.whole(1, 20);
        let tolerated = dice.whole(0, (window - 1).min(6));
        write!(text, ", outliers = {{ window = {window}, tolerated = {tolerated}")?;
        if dice.chance(0.3) {
            write!(text, ", margin = {}", dice.whole(0, tolerated + 1))?;
        }
        if dice.chance(0.3) {
            write!(text, ", inlier_probability = {}", dice.between(0.5, 1.0))?;
        }
        text.push_str(" }");
    }
    let on_empty = if dice.chance(0.5) { "drop" } else { dice.one_of(&["relax", "restart"]) };
    writeln!(text, ", on_empty = \"{on_empty}\" }}")?;
    Ok(on_empty == "restart")
}

fn write_clock(text: &mut String, dice: &mut Dice) -> std::fmt::Result {
    let drift = if dice.chance(0.3) { dice.between(0.0, 0.1) } else { dice.error(0.1) };
    let offset_s = if dice.chance(0.4) { 0.0 } else { dice.magnitude(1e-4, 1e4) };
    let wander = [0.0, 0.5, 1.0][dice.whole(0, 2) as usize];
    writeln!(
        text,
        "[group.clock]\ndrift_bound = {drift}\nwander_fraction = {wander}\noffset_bound_s = {offset_s}"
    )
}

fn write_sensors(text: &mut String, dice: &mut Dice, water: &Water) -> std::fmt::Result {
    writeln!(text, "[group.sensors]\nheading_error_rad = {}", dice.error(0.5))?;
    writeln!(text, "pitch_error_rad = {}\nspeed_error_m_s = {}", dice.error(0.5), dice.error(1.0))?;
    match dice.chance(0.3) {
        true => writeln!(text, "depth_error_m = false")?,
        false => writeln!(text, "depth_error_m = {}", dice.error(2.0))?,
    }
    if dice.chance(0.4) {
        let altitude_max_m = dice.magnitude(1.0, 2.0 * water.depth_m);
        writeln!(
            text,
            "dvl = {{ altitude_max_m = {altitude_max_m}, velocity_error_m_s = {} }}",
            dice.error(0.2)
        )?;
    }
    if dice.chance(0.4) {
        let (depth_max_m, period_s) = (dice.between(0.5, water.depth_m), dice.seconds(0.02, 3.0));
        writeln!(text, "[group.sensors.gnss]\ndepth_max_m = {depth_max_m}\nperiod_s = {period_s}")?;
        writeln!(text, "position_error_m = {}\ntime_error_s = {}", dice.errors(5.0), dice.error(1e-2))?;
    }
    Ok(())
}

fn write_controller(
    text: &mut String,
    dice: &mut Dice,
    water: &Water,
    speed_m_s: f64,
    turn_rate_rad_s: f64,
) -> std::fmt::Result {
    let Water { side_m, depth_m, current_m_s, .. } = *water;
    let cruise_m_s = speed_m_s * dice.between(0.1, 1.0);
    let box_width_m = if dice.chance(0.2) { 0.0 } else { dice.magnitude(0.01, 50.0) };
    let known = dice.chance(0.9);
    let mut start =
        if known { format!("box_width_m = [0, {box_width_m}]") } else { "known = false".to_owned() };
    match dice.whole(0, 3) {
        0 => writeln!(text, "[group.controller]\nname = \"hold\"")?,
        1 if speed_m_s > 2.0 * current_m_s => {
            let rate_rad_s = turn_rate_rad_s * dice.between(0.2, 0.9);
            let radius_m =
                ((speed_m_s - current_m_s) / rate_rad_s * dice.between(0.1, 0.9)).min(0.9 * side_m);
            let sign = if dice.chance(0.5) { "-" } else { "" };
            writeln!(
                text,
                "[group.controller]\nname = \"circle\"\ncentre_m = [0, 0, {}]\nradius_m = {radius_m}\nrate_rad_s = {sign}{rate_rad_s}\nphase_rad = {}",
                -0.5 * depth_m,
                dice.between(-3.0, 3.0),
            )?;
            if dice.chance(0.5) {
                start += "\nplace = \"on-circle\"";
            }
        }
        2 => {
            let mut point = || {
                let [x, y] = [dice.between(-side_m, side_m), dice.between(-side_m, side_m)];
                format!("[{x}, {y}, {}]", dice.between(-depth_m, 0.0))
            };
            let points = [point(), point(), point()].join(", ");
            writeln!(
                text,
                "[group.controller]\nname = \"waypoints\"\npoints_m = [{points}]\nspeed_m_s = {cruise_m_s}\nreach_m = {}",
                dice.between(0.5, 10.0),
            )?;
        }
        _ => writeln!(
            text,
            "[group.controller]\nname = \"reynolds\"\nspeed_m_s = {cruise_m_s}\nmargin_m = {}\nforget_s = {}",
            dice.between(0.0, 20.0),
            dice.seconds(0.5, 10.0),
        )?,
    }
    writeln!(text, "[group.start]\n{start}")
}
