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
pub(crate) const DEPTHS_MAX: usize = 1000;

pub(crate) const PROFILES: &[(&str, SoundSpeed)] = &[
    ("uniform", SoundSpeed::Uniform),
    ("mixed-layer", SoundSpeed::Named(NamedProfile::MixedLayer)),
    ("summer-thermocline", SoundSpeed::Named(NamedProfile::SummerThermocline)),
    ("arctic", SoundSpeed::Named(NamedProfile::Arctic)),
    ("munk", SoundSpeed::Named(NamedProfile::Munk)),
];

pub(crate) const FORMULAS: &[(&str, SoundSpeedFormula)] = &[
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
    let numbers_of = |column: &[Placed]| column.iter().map(|placed| placed.number).collect();
    if water.is_none() {
        let speeds_m_s = column(table, "speeds_m_s", PLAUSIBLE, depths.as_deref());
        // Known, so that errors list them.
        WATER.into_iter().for_each(|key| _ = table.get(key));
        return Some(SoundSpeed::Speeds {
            depths_m: numbers_of(&depths?),
            speeds_m_s: numbers_of(&speeds_m_s?),
        });
    }
    table.get("speeds_m_s");
    let temperatures_c = column(table, "temperatures_c", Rule::Within(-3.0, 45.0), depths.as_deref());
    let salinities_psu = column(table, "salinities_psu", Rule::Within(0.0, 45.0), depths.as_deref());
    let formula = table.choice("formula", FORMULAS, FORMULA_DEFAULT);
    let (depths, salinities_psu, formula) = (depths?, salinities_psu?, formula?);
    let within = within_reach(table, &depths, &salinities_psu, formula);
    within.then_some(SoundSpeed::Water {
        depths_m: numbers_of(&depths),
        temperatures_c: numbers_of(&temperatures_c?),
        salinities_psu: numbers_of(&salinities_psu),
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
fn column(
    table: &Table<'_>,
    key: &'static str,
    rule: Rule,
    depths: Option<&[Placed]>,
) -> Option<Vec<Placed>> {
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
    Some(values)
}

/// Whether the formula was made for such water. Temperatures are not looked at: the Arctic is colder than any of them, and the
/// error there is small.
fn within_reach(
    table: &Table<'_>,
    depths: &[Placed],
    salinities: &[Placed],
    formula: SoundSpeedFormula,
) -> bool {
    let (depth_max_m, salinity_min_psu) = match formula {
        SoundSpeedFormula::Medwin => (1000.0, 0.0),
        SoundSpeedFormula::Mackenzie => (8000.0, 0.0),
        SoundSpeedFormula::ChenMillero => (DEPTH_MAX_M, 0.0),
        // Fitted from 30 PSU on, and 500 m/s off in fresh water at great depth.
        SoundSpeedFormula::DelGrosso => (DEPTH_MAX_M, 25.0),
    };
    let deep = depths.iter().find(|depth| depth.number > depth_max_m);
    let fresh = salinities.iter().find(|salinity| salinity.number < salinity_min_psu);
    let beyond = [
        (deep, format!("the formula of this profile holds down to {depth_max_m} m"), "deeper than that"),
        (
            fresh,
            format!("the formula of this profile holds from {salinity_min_psu} PSU on"),
            "fresher than that",
        ),
    ];
    let mut within = true;
    for (place, cause, label) in beyond {
        let Some(place) = place else { continue };
        table.findings.add_related(
            place.span.clone(),
            cause,
            label,
            table.has("formula").then(|| (table.span("formula"), "this formula".into())),
            "write `formula = \"chen-millero\"`",
        );
        within = false;
    }
    within
}
