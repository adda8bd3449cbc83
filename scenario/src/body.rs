//! What a group may name or spell out: what its body can do, how its clock runs, what it senses.

use std::collections::{BTreeMap, BTreeSet};

use toml::de::DeValue;

use crate::TABLES_MAX;
use crate::model::{Clock, Kind, Sensors};
use crate::number::Rule;
use crate::presets::{CLOCK_DEFAULT, CLOCKS, KIND_DEFAULT, KINDS};
use crate::reader::{Table, Value};

/// Something that a scenario may name or spell out.
pub(crate) trait Named: Clone + 'static {
    /// Key of the tables that define it.
    const KEY: &'static str;
    /// Name of the one taken when a group says nothing.
    const DEFAULT: &'static str;
    /// Those that come with Shoal.
    const PRESETS: &'static [(&'static str, Self)];
    /// Reads a table; what it does not say is as in `like`.
    fn read(table: &Table<'_>, like: Option<&Self>) -> Option<Self>;
}

/// Presets and the user's own, by name; `None` for those that have errors of their own.
pub(crate) struct Catalogue<T> {
    by_name: BTreeMap<String, Option<T>>,
}

/// All that a group may name.
pub(crate) struct Catalogues {
    pub(crate) kinds: Catalogue<Kind>,
    pub(crate) clocks: Catalogue<Clock>,
    pub(crate) sensors: Catalogue<Sensors>,
}

impl Catalogues {
    pub(crate) fn read(document: &Table<'_>) -> Self {
        Self {
            kinds: Catalogue::read(document),
            clocks: Catalogue::read(document),
            sensors: Catalogue::read(document),
        }
    }
}

impl<T: Named> Catalogue<T> {
    /// The presets and what the document defines in `[kind.NAME]`, `[clock.NAME]` or `[sensors.NAME]`.
    pub(crate) fn read(document: &Table<'_>) -> Self {
        let presets = T::PRESETS.iter().map(|(name, preset)| (name.to_string(), Some(preset.clone())));
        let mut catalogue = Self { by_name: presets.collect() };
        let Some(tables) = document.table(T::KEY, &format!("[{}]", T::KEY)) else { return catalogue };
        if tables.named().count() > TABLES_MAX {
            let cause = format!("more than {TABLES_MAX} tables in [{}]", T::KEY);
            tables.findings.add(tables.header(), cause, "too many", "remove those that no group uses");
            return catalogue;
        }
        let mut waiting: Vec<_> = Vec::new();
        for (name, span, value) in tables.named() {
            if T::PRESETS.iter().any(|(preset, _)| *preset == name) {
                tables.findings.add(
                    span,
                    format!("{} `{name}` comes with Shoal already", T::KEY),
                    "this name is taken",
                    format!("give it another name, such as `my-{name}`"),
                );
            } else if value.get_ref().is_table() {
                waiting.push((name, value));
            } else {
                tables.wrong_type_as(name, value, "a table", &format!("[{}.my-{}]", T::KEY, T::KEY));
                catalogue.by_name.insert(name.to_string(), None);
            }
        }
        // Whoever is like another one comes after it, in whatever order the file has them.
        while !waiting.is_empty() {
            let names: BTreeSet<&str> = waiting.iter().map(|(name, _)| *name).collect();
            let is_waiting = |value: &Value<'_>| like_of(value).is_some_and(|(like, _)| names.contains(like));
            let (later, ready): (Vec<_>, Vec<_>) =
                waiting.into_iter().partition(|(_, value)| is_waiting(value));
            if ready.is_empty() {
                for (name, value) in later {
                    let span = like_of(value).map_or(value.span(), |(_, span)| span);
                    tables.findings.add(
                        span,
                        format!("{} `{}` runs into a circle of `like`", T::KEY, name.escape_debug()),
                        "never ends at a complete one",
                        "remove one `like` of the circle, and write the keys it stands for",
                    );
                    catalogue.by_name.insert(name.to_string(), None);
                }
                break;
            }
            for (name, value) in ready {
                let title = format!("[{}.{}]", T::KEY, name.escape_debug());
                let read = catalogue.in_full(&tables, value, &title);
                catalogue.by_name.insert(name.to_string(), read);
            }
            waiting = later;
        }
        catalogue
    }

    /// What a group says under the key: a name, a table, or nothing.
    pub(crate) fn of_group(&self, group: &Table<'_>) -> Option<T> {
        match group.get(T::KEY).map(|value| (value, value.get_ref())) {
            None => self.by_name.get(T::DEFAULT).cloned().flatten(),
            Some((value, DeValue::String(name))) => self.named(group, T::KEY, value, name),
            Some((value, DeValue::Table(_))) => self.in_full(group, value, &format!("[group.{}]", T::KEY)),
            Some((value, _)) => {
                group.wrong_type(T::KEY, value, "a name or a table");
                None
            }
        }
    }

    fn named(&self, table: &Table<'_>, key: &str, value: &Value<'_>, name: &str) -> Option<T> {
        match self.by_name.get(name) {
            Some(found) => found.clone(),
            None => {
                table.unknown_name(value.span(), key, name, self.by_name.keys().map(String::as_str));
                None
            }
        }
    }

    fn in_full(&self, parent: &Table<'_>, value: &Value<'_>, name: &str) -> Option<T> {
        let DeValue::Table(entries) = value.get_ref() else { return None };
        let table = Table::new(entries, value.span(), name, parent.findings);
        let like = match table.get("like").map(|value| (value, value.get_ref())) {
            None => Some(None),
            Some((value, DeValue::String(like))) => self.named(&table, "like", value, like).map(Some),
            Some((value, _)) => {
                table.wrong_type("like", value, "a name");
                None
            }
        };
        // A wrong `like` is reported; what it would have filled in is no second error.
        let stand_in = self.by_name.get(T::DEFAULT).cloned().flatten();
        let read = match &like {
            Some(like) => T::read(&table, like.as_ref()),
            None => T::read(&table, stand_in.as_ref()),
        };
        table.finish();
        like.and(read)
    }
}

/// What a table is like, and where it says so.
fn like_of<'t>(value: &'t Value<'_>) -> Option<(&'t str, std::ops::Range<usize>)> {
    let like = value.get_ref().as_table()?.get("like")?;
    Some((like.get_ref().as_str()?, like.span()))
}

impl Named for Kind {
    const KEY: &'static str = "kind";
    const DEFAULT: &'static str = KIND_DEFAULT;
    const PRESETS: &'static [(&'static str, Self)] = KINDS;

    fn read(table: &Table<'_>, like: Option<&Self>) -> Option<Self> {
        let own = |field: fn(&Kind) -> f64| like.map(field);
        let speed_max_m_s = table.number("speed_max_m_s", own(|kind| kind.speed_max_m_s), Rule::Positive);
        let acceleration_max_m_s2 =
            table.number("acceleration_max_m_s2", own(|kind| kind.acceleration_max_m_s2), Rule::Positive);
        let turn_rate_max_rad_s =
            table.number("turn_rate_max_rad_s", own(|kind| kind.turn_rate_max_rad_s), Rule::Positive);
        let pitch_max_rad = table.number(
            "pitch_max_rad",
            Some(like.map_or(0.5, |kind| kind.pitch_max_rad)),
            Rule::UpToRightAngle,
        );
        let disturbance_m_s = table.vec3(
            "disturbance_m_s",
            Some(like.map_or([0.0; 3], |kind| kind.disturbance_m_s)),
            Rule::NotNegative,
        );
        let length_m = table.number("length_m", Some(like.map_or(2.0, |kind| kind.length_m)), Rule::Positive);
        Some(Kind {
            speed_max_m_s: speed_max_m_s?,
            acceleration_max_m_s2: acceleration_max_m_s2?,
            turn_rate_max_rad_s: turn_rate_max_rad_s?,
            pitch_max_rad: pitch_max_rad?,
            disturbance_m_s: disturbance_m_s?,
            length_m: length_m?,
        })
    }
}

impl Named for Clock {
    const KEY: &'static str = "clock";
    const DEFAULT: &'static str = CLOCK_DEFAULT;
    const PRESETS: &'static [(&'static str, Self)] = CLOCKS;

    fn read(table: &Table<'_>, like: Option<&Self>) -> Option<Self> {
        let drift_bound = table.number("drift_bound", like.map(|clock| clock.drift_bound), Rule::NotNegative);
        let drift_bound = drift_bound.filter(|&drift_bound| {
            if drift_bound >= 1.0 {
                table.refuse(
                    "drift_bound",
                    "`drift_bound` must be below 1: a clock that can stand still tells no time",
                    "1 is 100 %: the clock's rate would be anywhere from 0 to 2",
                    "write the fraction, such as `5e-5` for 50 ppm",
                );
            }
            drift_bound < 1.0
        });
        let wander_fraction = table.number(
            "wander_fraction",
            Some(like.map_or(0.5, |clock| clock.wander_fraction)),
            Rule::Within(0.0, 1.0),
        );
        let offset_bound_s = table.number(
            "offset_bound_s",
            Some(like.map_or(0.0, |clock| clock.offset_bound_s)),
            Rule::Within(0.0, 1e9),
        );
        Some(Clock {
            drift_bound: drift_bound?,
            wander_fraction: wander_fraction?,
            offset_bound_s: offset_bound_s?,
        })
    }
}
