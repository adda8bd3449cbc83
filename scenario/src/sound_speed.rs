//! The key `sound_speed` of `[environment.sea]`: the speed of sound over depth.

use crate::model::{NamedProfile, SoundSpeed, SoundSpeedFormula};
use crate::number::{Placed, Rule};
use crate::reader::{Table, TextOrTable};
use crate::sea::DEPTH_MAX_M;

/// No water carries sound more slowly: ice-cold fresh water has 1,402 m/s (and the formulas, extrapolated to all that a
/// scenario may say, stay above).
pub(crate) const SOUND_SPEED_MIN_M_S: f64 = 1300.0;
/// No water carries sound faster: warm brine at the bottom of the deepest trench has some 1,750 m/s.
pub(crate) const SOUND_SPEED_MAX_M_S: f64 = 1800.0;
const PLAUSIBLE: Rule = Rule::Within(SOUND_SPEED_MIN_M_S, SOUND_SPEED_MAX_M_S);

/// Depths that are closer together are one depth said twice, in metres.
const SPACING_MIN_M: f64 = 1e-3;
/// More than any cast needs after thinning; every layer costs time for every ray.
const DEPTHS_MAX: usize = 1000;

const PROFILES: &[(&str, SoundSpeed)] = &[
    ("uniform", SoundSpeed::Uniform),
    ("mixed-layer", SoundSpeed::Named(NamedProfile::MixedLayer)),
    ("summer-thermocline", SoundSpeed::Named(NamedProfile::SummerThermocline)),
    ("arctic", SoundSpeed::Named(NamedProfile::Arctic)),
    ("munk", SoundSpeed::Named(NamedProfile::Munk)),
];

const FORMULAS: &[(&str, SoundSpeedFormula)] = &[
    ("mackenzie", SoundSpeedFormula::Mackenzie),
    ("medwin", SoundSpeedFormula::Medwin),
    ("chen-millero", SoundSpeedFormula::ChenMillero),
    ("del-grosso", SoundSpeedFormula::DelGrosso),
];
/// The standard of UNESCO, and that with the widest range.
const FORMULA_DEFAULT: SoundSpeedFormula = SoundSpeedFormula::ChenMillero;

/// Reads the key `sound_speed` of `sea`, and what `sound_speed_m_s` of `environment` means beside it.
pub(crate) fn sound_speed(environment: &Table<'_>, sea: &Table<'_>) -> Option<SoundSpeed> {
    const KEY: &str = "sound_speed";
    let sound_speed = if sea.has(KEY) {
        match sea.text_or_table(KEY, "[environment.sea.sound_speed]")? {
            TextOrTable::Text(name) => sea.chosen(KEY, name, PROFILES)?,
            TextOrTable::Table(table) => {
                let read = profile(&table);
                table.finish();
                read?
            }
        }
    } else {
        sea.get(KEY);
        SoundSpeed::Uniform
    };
    if sound_speed != SoundSpeed::Uniform && environment.has("sound_speed_m_s") {
        environment.findings.add_related(
            environment.span("sound_speed_m_s"),
            "the speed of sound is said twice, at every depth the same and as a profile",
            "the same at every depth",
            Some((sea.span(KEY), "a profile".into())),
            "remove `sound_speed_m_s`, or write `sound_speed = \"uniform\"` to keep it",
        );
        return None;
    }
    Some(sound_speed)
}

/// A bound that no speed of the profile falls below, in m/s; `uniform_m_s` is that of the environment.
pub(crate) fn slowest_m_s(sound_speed: &SoundSpeed, uniform_m_s: f64) -> f64 {
    match sound_speed {
        SoundSpeed::Uniform => uniform_m_s,
        SoundSpeed::Speeds { speeds_m_s, .. } => speeds_m_s.iter().copied().fold(f64::INFINITY, f64::min),
        SoundSpeed::Named(_) | SoundSpeed::Water { .. } => SOUND_SPEED_MIN_M_S,
    }
}

fn profile(table: &Table<'_>) -> Option<SoundSpeed> {
    const WATER: [&str; 3] = ["temperatures_c", "salinities_psu", "formula"];
    let water = WATER.into_iter().find(|key| table.has(key));
    if let (Some(key), true) = (water, table.has("speeds_m_s")) {
        for known in ["depths_m", "speeds_m_s"].into_iter().chain(WATER) {
            table.get(known);
        }
        table.findings.add_related(
            table.span(key),
            format!(
                "a profile has `speeds_m_s` or `temperatures_c` and `salinities_psu`: `{key}` is too much"
            ),
            "not together with `speeds_m_s`",
            Some((table.span("speeds_m_s"), "the speeds are here".into())),
            format!("remove `{key}`, or `speeds_m_s`"),
        );
        return None;
    }
    let depths = depths(table);
    let number_of = |depths: &[Placed]| depths.iter().map(|depth| depth.number).collect();
    if water.is_none() {
        let speeds_m_s = column(table, "speeds_m_s", PLAUSIBLE, depths.as_deref());
        // Known, so that errors list them.
        WATER.into_iter().for_each(|key| _ = table.get(key));
        return Some(SoundSpeed::Speeds { depths_m: number_of(&depths?), speeds_m_s: speeds_m_s? });
    }
    table.get("speeds_m_s");
    let temperatures_c = column(table, "temperatures_c", Rule::Within(-3.0, 45.0), depths.as_deref());
    let salinities_psu = column(table, "salinities_psu", Rule::Within(0.0, 45.0), depths.as_deref());
    let formula = table.choice("formula", FORMULAS, FORMULA_DEFAULT);
    let (depths, formula) = (depths?, formula?);
    within_reach(table, &depths, formula)?;
    Some(SoundSpeed::Water {
        depths_m: number_of(&depths),
        temperatures_c: temperatures_c?,
        salinities_psu: salinities_psu?,
        formula,
    })
}

/// The depths, each below the one before.
fn depths(table: &Table<'_>) -> Option<Vec<Placed>> {
    let depths = table.numbers("depths_m", Rule::Within(0.0, DEPTH_MAX_M))?;
    if !(2..=DEPTHS_MAX).contains(&depths.len()) {
        table.refuse(
            "depths_m",
            format!("a profile has 2 to {DEPTHS_MAX} depths, not {}", depths.len()),
            match depths.len() {
                0 => "no depth",
                1 => "one depth",
                _ => "too many",
            },
            match depths.len() {
                0 | 1 => "for one speed at every depth write `sound_speed = \"uniform\"`",
                _ => "keep the depths between which the speed is nearly linear",
            },
        );
        return None;
    }
    let mut good = true;
    for (above, below) in depths.iter().zip(depths.iter().skip(1)) {
        let step_m = below.number - above.number;
        if step_m < SPACING_MIN_M {
            let (cause, label) = if step_m > -SPACING_MIN_M {
                ("a profile has each depth once", format!("{} m is repeated", below.number))
            } else {
                (
                    "the depths of a profile must increase",
                    format!("{} m is above {} m", below.number, above.number),
                )
            };
            table.findings.add_related(
                below.span.clone(),
                cause,
                label,
                Some((above.span.clone(), "the depth before".into())),
                "write every depth once, from the surface down, a millimetre or more apart",
            );
            good = false;
        }
    }
    good.then_some(depths)
}

/// The values under `key`, one for each depth.
fn column(table: &Table<'_>, key: &'static str, rule: Rule, depths: Option<&[Placed]>) -> Option<Vec<f64>> {
    let values = table.numbers(key, rule)?;
    let wanted = depths?.len();
    if values.len() != wanted {
        table.findings.add_related(
            table.span(key),
            format!("`{key}` has {} values for {wanted} depths", values.len()),
            format!("{} values", values.len()),
            Some((table.span("depths_m"), format!("{wanted} depths"))),
            "give one value for each depth",
        );
        return None;
    }
    Some(values.into_iter().map(|value| value.number).collect())
}

/// Whether the formula was made for these depths.
fn within_reach(table: &Table<'_>, depths: &[Placed], formula: SoundSpeedFormula) -> Option<()> {
    let reach_m = match formula {
        SoundSpeedFormula::Medwin => 1000.0,
        SoundSpeedFormula::Mackenzie => 8000.0,
        SoundSpeedFormula::ChenMillero | SoundSpeedFormula::DelGrosso => return Some(()),
    };
    let Some(deepest) = depths.last().filter(|deepest| deepest.number > reach_m) else { return Some(()) };
    table.findings.add_related(
        deepest.span.clone(),
        format!("the formula of this profile holds down to {reach_m} m"),
        "deeper than that",
        table.has("formula").then(|| (table.span("formula"), "this formula".into())),
        "write `formula = \"chen-millero\"`, or end the profile there",
    );
    None
}
