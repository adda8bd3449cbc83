//! The table `[environment.sea]`: what sound meets at level `sea`.

use toml::de::DeTable;

use crate::model::{Absorption, Bottom, Fading, FadingKind, FadingPer, Region, Sea};
use crate::number::Rule;
use crate::presets::BOTTOMS;
use crate::reader::{Table, TextOrTable};
use crate::sound_speed::{SOUND_SPEED_MAX_M_S, SOUND_SPEED_MIN_M_S, sound_speed};

/// No sea is deeper: the Challenger Deep has some 10,930 m.
pub(crate) const DEPTH_MAX_M: f64 = 12_000.0;
/// Paths with more bounces are too weak to matter, and each costs time for every ping.
pub(crate) const BOUNCES_MAX: u64 = 8;

pub(crate) const ABSORPTIONS: &[(&str, Absorption)] = &[
    ("francois-garrison", Absorption::FrancoisGarrison),
    ("ainslie-mccolm", Absorption::AinslieMcColm),
    ("thorp-stojanovic", Absorption::ThorpStojanovic),
    ("thorp-jkps", Absorption::ThorpJkps),
];

/// A steady part of four fifths of the power: surface and bottom bounces are paths of their own here, so that what fades
/// on each is only what is scattered around it.
const RICIAN_K_DEFAULT_DB: f64 = 6.0;
pub(crate) const FADING_KINDS: &[(&str, FadingKind)] = &[
    ("gaussian", FadingKind::Gaussian),
    ("rayleigh", FadingKind::Rayleigh),
    ("rician", FadingKind::Rician { k_db: RICIAN_K_DEFAULT_DB }),
];
pub(crate) const FADING_PERS: &[(&str, FadingPer)] =
    &[("packet", FadingPer::Packet), ("bit", FadingPer::Bit)];
/// A packet is over before the waves that scatter it have changed much.
const FADING_PER_DEFAULT: FadingPer = FadingPer::Packet;

/// The sea of an environment at level `sea`; its table may be missing.
pub(crate) fn sea(environment: &Table<'_>, area_m: Option<&Region>) -> Option<Sea> {
    let empty = DeTable::new();
    if !environment.has("sea") {
        environment.get("sea");
        let table = Table::new(&empty, environment.header(), "[environment.sea]", environment.findings);
        return read(environment, &table, area_m);
    }
    let table = environment.table("sea", "[environment.sea]")?;
    let sea = read(environment, &table, area_m);
    table.finish();
    sea
}

/// Refuses a table `sea` that would mean nothing.
pub(crate) fn no_sea(environment: &Table<'_>) {
    if environment.get("sea").is_some() {
        environment.refuse(
            "sea",
            "`[environment.sea]` means nothing at level `ideal`",
            "sound is ideal here",
            "write `level = \"sea\"` in `[environment]`, or remove `[environment.sea]`",
        );
    }
}

fn read(environment: &Table<'_>, table: &Table<'_>, area_m: Option<&Region>) -> Option<Sea> {
    let sound_speed = sound_speed(environment, table);
    let bottom_depth_m = bottom_depth(environment, table, area_m);
    let temperature_c = table.number("temperature_c", Some(10.0), Rule::Within(-3.0, 45.0));
    let salinity_psu = table.number("salinity_psu", Some(35.0), Rule::Within(0.0, 45.0));
    let ph = table.number("ph", Some(8.0), Rule::Within(6.5, 9.0));
    let absorption = table.choice("absorption", ABSORPTIONS, Absorption::FrancoisGarrison);
    let spreading_exponent = table.number("spreading_exponent", Some(1.5), Rule::Within(1.0, 2.0));
    let shipping = table.number("shipping", Some(0.5), Rule::Within(0.0, 1.0));
    let wind_m_s = table.number("wind_m_s", Some(5.0), Rule::Within(0.0, 100.0));
    let surface_loss_db = match table.get("surface_loss_db") {
        None => Some(None),
        Some(value) => table.number_in("surface_loss_db", value, Rule::Within(0.0, 100.0)).map(Some),
    };
    let bottom = bottom(table);
    let bounces_max = table.whole("bounces_max", Some(2), 0, BOUNCES_MAX);
    let fading = fading(table);
    Some(Sea {
        sound_speed: sound_speed?,
        bottom_depth_m: bottom_depth_m?,
        temperature_c: temperature_c?,
        salinity_psu: salinity_psu?,
        ph: ph?,
        absorption: absorption?,
        spreading_exponent: spreading_exponent?,
        shipping: shipping?,
        wind_m_s: wind_m_s?,
        surface_loss_db: surface_loss_db?,
        bottom: bottom?,
        bounces_max: u8::try_from(bounces_max?).ok()?,
        fading: fading?,
    })
}

/// Refuses a speed of sound that no sea has.
pub(crate) fn sound_of_a_sea(environment: &Table<'_>, sound_speed_m_s: f64) -> Option<f64> {
    let plausible = (SOUND_SPEED_MIN_M_S..=SOUND_SPEED_MAX_M_S).contains(&sound_speed_m_s);
    if !plausible {
        environment.refuse(
            "sound_speed_m_s",
            format!("sound in a sea does not travel at {sound_speed_m_s} m/s"),
            format!("must be from {SOUND_SPEED_MIN_M_S} to {SOUND_SPEED_MAX_M_S} at level `sea`"),
            "write for example `sound_speed_m_s = 1500`; level `ideal` takes any speed",
        );
    }
    plausible.then_some(sound_speed_m_s)
}

/// Depth of the sea floor: below the whole area, and so below every place to begin, all of which lie in it.
fn bottom_depth(environment: &Table<'_>, table: &Table<'_>, area_m: Option<&Region>) -> Option<f64> {
    const KEY: &str = "bottom_depth_m";
    let area_depth_m = area_m.map(|area| -area[2][0]);
    if !table.has(KEY) {
        table.get(KEY);
        let depth_m = area_depth_m?;
        if depth_m > DEPTH_MAX_M {
            environment.refuse(
                "area_m",
                "no sea is as deep as the area",
                format!("{depth_m} m deep; a sea has at most {DEPTH_MAX_M} m"),
                format!("end `area_m` at -{DEPTH_MAX_M} m or above"),
            );
            return None;
        }
        return Some(depth_m);
    }
    let depth_m = table.number(KEY, None, Rule::Positive)?;
    if depth_m > DEPTH_MAX_M {
        table.refuse(
            KEY,
            "no sea is that deep",
            format!("deeper than {DEPTH_MAX_M} m"),
            format!("write {DEPTH_MAX_M} or less; depths are positive down"),
        );
        return None;
    }
    if let Some(area_depth_m) = area_depth_m
        && area_depth_m > depth_m
    {
        table.findings.add_related(
            table.span(KEY),
            format!("the area reaches {area_depth_m} m deep, below the sea floor at {depth_m} m"),
            "the sea floor is here",
            Some((environment.span("area_m"), "the area is deeper".into())),
            format!("write `{KEY} = {area_depth_m}` or more, or end `area_m` at {} m", -depth_m),
        );
        return None;
    }
    Some(depth_m)
}

/// What the sea floor is made of.
fn bottom(sea: &Table<'_>) -> Option<Bottom> {
    const KEY: &str = "bottom";
    if !sea.has(KEY) {
        sea.get(KEY);
        // Sand covers most of the continental shelves.
        return BOTTOMS.iter().find(|(name, _)| *name == "sand").map(|(_, sand)| *sand);
    }
    match sea.text_or_table(KEY, "[environment.sea.bottom]")? {
        TextOrTable::Text(name) => sea.chosen(KEY, name, BOTTOMS),
        TextOrTable::Table(table) => {
            let density_kg_m3 = table.number("density_kg_m3", None, Rule::Within(1000.0, 5000.0));
            let sound_speed_m_s = table.number("sound_speed_m_s", None, Rule::Within(1000.0, 8000.0));
            let attenuation_db_wavelength =
                table.number("attenuation_db_wavelength", None, Rule::Within(0.0, 10.0));
            table.finish();
            Some(Bottom {
                density_kg_m3: density_kg_m3?,
                sound_speed_m_s: sound_speed_m_s?,
                attenuation_db_wavelength: attenuation_db_wavelength?,
            })
        }
    }
}

fn fading(sea: &Table<'_>) -> Option<Fading> {
    const KEY: &str = "fading";
    let default = FadingKind::Rician { k_db: RICIAN_K_DEFAULT_DB };
    if !sea.has(KEY) {
        sea.get(KEY);
        return Some(Fading { kind: default, per: FADING_PER_DEFAULT });
    }
    match sea.text_or_table(KEY, "[environment.sea.fading]")? {
        TextOrTable::Text(name) => {
            Some(Fading { kind: sea.chosen(KEY, name, FADING_KINDS)?, per: FADING_PER_DEFAULT })
        }
        TextOrTable::Table(table) => {
            if !table.has("kind") {
                table.missing("kind");
            }
            let kind = table.choice("kind", FADING_KINDS, default);
            let kind = match (kind, table.get("k_db")) {
                (Some(FadingKind::Rician { .. }), Some(value)) => {
                    let k_db = table.number_in("k_db", value, Rule::Within(-40.0, 40.0));
                    k_db.map(|k_db| FadingKind::Rician { k_db })
                }
                (Some(_), Some(_)) => {
                    table.refuse(
                        "k_db",
                        "only `rician` fading has a steady part",
                        "has no effect",
                        "remove `k_db`, or write `kind = \"rician\"`",
                    );
                    None
                }
                (kind, _) => kind,
            };
            let per = table.choice("per", FADING_PERS, FADING_PER_DEFAULT);
            table.finish();
            Some(Fading { kind: kind?, per: per? })
        }
    }
}
