//! The table `[environment.sea]`, drawn at random.

use std::fmt::Write;

use super::Dice;

/// What the rest of a scenario needs to know of its sea.
pub(super) struct SeaDrawn {
    /// No sound that the scenario states is slower, as far as its validation knows.
    pub slowest_m_s: f64,
    /// Makers' modems, in a sea as large as they reach, rather than our own.
    pub is_wide: bool,
    /// The draws of the modem that groups have in common, if they do.
    pub modem_number: u64,
    profile: Profile,
}

enum Profile {
    Uniform(f64),
    Named(&'static str),
    Speeds,
    Water,
}

impl SeaDrawn {
    pub fn draw(dice: &mut Dice) -> Self {
        let profile = match dice.whole(0, 3) {
            0 => Profile::Uniform(dice.between(1400.0, 1600.0)),
            1 => Profile::Named(dice.one_of(&[
                "uniform",
                "mixed-layer",
                "summer-thermocline",
                "arctic",
                "munk",
            ])),
            2 => Profile::Speeds,
            _ => Profile::Water,
        };
        Self {
            // Profiles of temperatures and by name are validated with the slowest sound of all water.
            slowest_m_s: if let Profile::Uniform(speed_m_s) = profile { speed_m_s } else { 1300.0 },
            is_wide: dice.chance(0.3),
            modem_number: dice.whole(0, 1 << 40),
            profile,
        }
    }
}

pub(super) fn write_sea(
    text: &mut String,
    dice: &mut Dice,
    sea: &SeaDrawn,
    area_depth_m: f64,
) -> std::fmt::Result {
    if let Profile::Uniform(speed_m_s) = sea.profile {
        writeln!(text, "sound_speed_m_s = {speed_m_s}")?;
    }
    writeln!(text, "level = \"sea\"\n[environment.sea]")?;
    match sea.profile {
        Profile::Uniform(_) => {}
        Profile::Named(name) => writeln!(text, "sound_speed = \"{name}\"")?,
        Profile::Speeds => {
            let depths_m = depths_m(dice);
            let mut speed_m_s = dice.between(1420.0, 1580.0);
            // Near 0.1 m/s per metre on average, up and down, and sometimes not at all.
            let speeds_m_s: Vec<f64> = depths_m
                .iter()
                .map(|_| {
                    let step_m_s = if dice.chance(0.2) { 0.0 } else { dice.between(-15.0, 15.0) };
                    speed_m_s = (speed_m_s + step_m_s).clamp(1400.0, 1600.0);
                    speed_m_s
                })
                .collect();
            writeln!(text, "sound_speed = {{ depths_m = {depths_m:?}, speeds_m_s = {speeds_m_s:?} }}")?;
        }
        Profile::Water => {
            let depths_m = depths_m(dice);
            let column = |dice: &mut Dice, least: f64, most: f64| -> Vec<f64> {
                depths_m.iter().map(|_| dice.between(least, most)).collect()
            };
            let (temperatures_c, salinities_psu) = (column(dice, 0.0, 28.0), column(dice, 30.0, 38.0));
            let formula = dice.one_of(&["mackenzie", "medwin", "chen-millero", "del-grosso"]);
            writeln!(
                text,
                "sound_speed = {{ depths_m = {depths_m:?}, temperatures_c = {temperatures_c:?}, salinities_psu = {salinities_psu:?}, formula = \"{formula}\" }}"
            )?;
        }
    }
    if dice.chance(0.6) {
        let deeper = if dice.chance(0.5) { 1.0 } else { dice.magnitude(1.0, 20.0) };
        writeln!(text, "bottom_depth_m = {}", area_depth_m * deeper.max(1.0))?;
    }
    let absorption = dice.one_of(&["francois-garrison", "ainslie-mccolm", "thorp-stojanovic", "thorp-jkps"]);
    writeln!(text, "absorption = \"{absorption}\"\ntemperature_c = {}", dice.between(-2.0, 30.0))?;
    writeln!(text, "salinity_psu = {}\nph = {}", dice.between(0.0, 40.0), dice.between(7.0, 8.5))?;
    writeln!(text, "spreading_exponent = {}", dice.between(1.0, 2.0))?;
    writeln!(text, "shipping = {}\nwind_m_s = {}", dice.unit(), dice.error(25.0))?;
    if dice.chance(0.3) {
        writeln!(text, "surface_loss_db = {}", dice.error(20.0))?;
    }
    writeln!(text, "bounces_max = {}", dice.whole(0, 4))?;
    match dice.chance(0.7) {
        true => writeln!(text, "bottom = \"{}\"", dice.one_of(&["clay", "silt", "sand", "gravel", "rock"]))?,
        false => writeln!(
            text,
            "bottom = {{ density_kg_m3 = {}, sound_speed_m_s = {}, attenuation_db_wavelength = {} }}",
            dice.between(1000.0, 3000.0),
            dice.between(1200.0, 5000.0),
            dice.error(2.0),
        )?,
    }
    let per = dice.one_of(&["packet", "bit"]);
    match dice.whole(0, 3) {
        0 => Ok(()),
        1 => writeln!(text, "fading = \"{}\"", dice.one_of(&["gaussian", "rayleigh", "rician"])),
        2 => writeln!(text, "fading = {{ kind = \"rayleigh\", per = \"{per}\" }}"),
        _ => writeln!(
            text,
            "fading = {{ kind = \"rician\", k_db = {}, per = \"{per}\" }}",
            dice.between(-20.0, 30.0)
        ),
    }
}

/// Depths of a profile, from the surface or below it, to anywhere.
fn depths_m(dice: &mut Dice) -> Vec<f64> {
    let mut depth_m = if dice.chance(0.7) { 0.0 } else { dice.magnitude(0.1, 50.0) };
    let count = dice.whole(2, 8);
    let mut depths_m = Vec::new();
    for _ in 0..count {
        depths_m.push(depth_m);
        depth_m += dice.magnitude(0.01, 100.0);
    }
    depths_m
}
