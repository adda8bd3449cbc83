//! The key `controller` of a group: by name, or as a table with a `name`.

use toml::de::DeValue;

use crate::current::fastest_current_m_s;
use crate::environment::contains;
use crate::model::{Controller, Environment, Kind};
use crate::number::Rule;
use crate::reader::Table;

const FORGET_DEFAULT_NS: i64 = 5_000_000_000;

/// What the checks of a controller need to know.
pub(crate) struct Surroundings<'a> {
    pub(crate) kind: Option<&'a Kind>,
    pub(crate) environment: Option<&'a Environment>,
    pub(crate) group_names: &'a [&'a str],
}

const CONTROLLERS: [&str; 5] = ["hold", "station", "circle", "waypoints", "reynolds"];

pub(crate) fn controller(group: &Table<'_>, around: &Surroundings<'_>) -> Option<Controller> {
    if !group.has("controller") {
        group.get("controller");
        return Some(Controller::Hold);
    }
    let (name, table) = group.name_or_table("controller", "[group.controller]")?;
    if !CONTROLLERS.contains(&name) {
        let span = table.as_ref().map_or(group.span("controller"), |table| table.span("name"));
        group.unknown_name(span, "controller", name, CONTROLLERS.into_iter());
        return None;
    }
    let Some(table) = table else {
        if matches!(name, "circle" | "waypoints") {
            group.refuse(
                "controller",
                format!("the controller `{name}` needs more than its name"),
                "needs a table",
                match name {
                    "circle" => {
                        "write `controller = { name = \"circle\", centre_m = [0, 0, -5], radius_m = 50, rate_rad_s = 0.02 }`"
                    }
                    _ => "write `controller = { name = \"waypoints\", points_m = [[0, 0, -5], [100, 0, -5]] }`",
                },
            );
            return None;
        }
        let empty = toml::de::DeTable::new();
        let table = Table::new(&empty, group.span("controller"), "[group.controller]", group.findings);
        return match name {
            "hold" => Some(Controller::Hold),
            "station" => station(&table, around),
            _ => reynolds(&table, around),
        };
    };
    let read = match name {
        "station" => station(&table, around),
        "circle" => circle(&table, around),
        "waypoints" => waypoints(&table, around),
        "reynolds" => reynolds(&table, around),
        _ => Some(Controller::Hold),
    };
    table.finish();
    read
}

fn circle(table: &Table<'_>, around: &Surroundings<'_>) -> Option<Controller> {
    let centre_m = table.vec3("centre_m", None, Rule::Finite);
    let radius_m = table.number("radius_m", None, Rule::Positive);
    let rate_rad_s = table.number("rate_rad_s", None, Rule::Finite);
    let phase_rad = table.number("phase_rad", Some(0.0), Rule::Finite);
    let heave_m = table.number("heave_m", Some(0.0), Rule::NotNegative);
    let heave_phase_rad = table.number("heave_phase_rad", Some(0.0), Rule::Finite);
    let (centre, radius_m, rate, heave_m) = (centre_m?, radius_m?, rate_rad_s?, heave_m?);
    if rate == 0.0 {
        table.refuse(
            "rate_rad_s",
            "a circle needs a rate other than 0",
            "never gets round",
            "use the controller `hold`",
        );
        return None;
    }
    if let Some(kind) = around.kind {
        circle_suits(table, kind, around.environment, radius_m, rate, heave_m);
    }
    if let Some(environment) = around.environment {
        let reach = [radius_m, radius_m, heave_m];
        for (axis, name) in ["east", "north", "up"].into_iter().enumerate() {
            let [least, greatest] = environment.area_m[axis];
            let (low, high) = (centre[axis] - reach[axis], centre[axis] + reach[axis]);
            // Decimal centres and heaves may add up to the border only but for the rounding of binary numbers.
            let slack = 1e-9 * (1.0 + least.abs().max(greatest.abs()));
            if low < least - slack || high > greatest + slack {
                table.refuse(
                    "centre_m",
                    "the circle leaves the area",
                    format!("spans {low} to {high} m {name}, the area {least} to {greatest}"),
                    "move the centre, or make the circle smaller or `area_m` larger",
                );
                break;
            }
        }
    }
    Some(Controller::Circle {
        centre_m: centre,
        radius_m,
        rate_rad_s: rate,
        phase_rad: phase_rad?,
        heave_m,
        heave_phase_rad: heave_phase_rad?,
    })
}

/// Whether a body of this kind can follow the circle.
fn circle_suits(
    table: &Table<'_>,
    kind: &Kind,
    environment: Option<&Environment>,
    radius_m: f64,
    rate: f64,
    heave_m: f64,
) {
    let current_m_s = environment.map_or(0.0, fastest_current_m_s);
    let speed_m_s = (radius_m * radius_m + heave_m * heave_m).sqrt() * rate.abs() + current_m_s;
    if speed_m_s > kind.speed_max_m_s {
        let mut needs = format!("radius {radius_m} m at {} rad/s", rate.abs());
        if heave_m > 0.0 {
            needs.push_str(&format!(", heave {heave_m} m"));
        }
        if current_m_s > 0.0 {
            needs.push_str(&format!(", against a current of {current_m_s} m/s"));
        }
        table.refuse(
            "rate_rad_s",
            format!("the circle needs {speed_m_s:.3} m/s, the kind has at most {} m/s", kind.speed_max_m_s),
            needs,
            "lower `rate_rad_s` or `radius_m`, or raise the kind's `speed_max_m_s`",
        );
    }
    if rate.abs() > kind.turn_rate_max_rad_s {
        table.refuse(
            "rate_rad_s",
            format!(
                "the circle turns at {} rad/s, the kind at most at {} rad/s",
                rate.abs(),
                kind.turn_rate_max_rad_s
            ),
            "faster than the body turns",
            "lower `rate_rad_s`, or raise the kind's `turn_rate_max_rad_s`",
        );
    }
    let pitch_rad = pxfm::f_atan(heave_m / radius_m);
    if pitch_rad > kind.pitch_max_rad {
        table.refuse(
            "heave_m",
            format!(
                "the circle climbs at up to {pitch_rad:.3} rad, the kind at most at {} rad",
                kind.pitch_max_rad
            ),
            "steeper than the body climbs",
            "lower `heave_m`, or raise the kind's `pitch_max_rad`",
        );
    }
}

fn waypoints(table: &Table<'_>, around: &Surroundings<'_>) -> Option<Controller> {
    let points_m = table.points("points_m");
    if let (Some(points), Some(environment)) = (&points_m, around.environment)
        && let Some(outside) = points.iter().find(|point| !contains(&environment.area_m, **point))
    {
        table.refuse(
            "points_m",
            format!("the waypoint {outside:?} lies outside the area"),
            "outside `area_m`",
            "move it inside, or make `area_m` larger; z is up and 0 at the surface",
        );
    }
    let speed_m_s = cruise_speed(table, around.kind);
    let reach_m = table.number("reach_m", Some(5.0), Rule::Positive);
    let repeat = table.boolean("repeat", true);
    Some(Controller::Waypoints {
        points_m: points_m?,
        speed_m_s: speed_m_s?,
        reach_m: reach_m?,
        repeat: repeat?,
    })
}

fn station(table: &Table<'_>, around: &Surroundings<'_>) -> Option<Controller> {
    Some(Controller::Station { speed_m_s: cruise_speed(table, around.kind)? })
}

fn reynolds(table: &Table<'_>, around: &Surroundings<'_>) -> Option<Controller> {
    let speed_m_s = cruise_speed(table, around.kind);
    let separation = table.number("separation", Some(1.0), Rule::NotNegative);
    let cohesion = table.number("cohesion", Some(1.0), Rule::NotNegative);
    let alignment = table.number("alignment", Some(1.0), Rule::NotNegative);
    let margin_m = table.number("margin_m", Some(5.0), Rule::NotNegative);
    let forget_ns = table.time_ns("forget_s", Some(FORGET_DEFAULT_NS), 1);
    let trusts = trusts(table, around.group_names);
    Some(Controller::Reynolds {
        speed_m_s: speed_m_s?,
        separation: separation?,
        cohesion: cohesion?,
        alignment: alignment?,
        margin_m: margin_m?,
        forget_ns: forget_ns?,
        trusts: trusts?,
    })
}

/// The cruise speed: three quarters of the kind's greatest unless the table says it.
fn cruise_speed(table: &Table<'_>, kind: Option<&Kind>) -> Option<f64> {
    let default = kind.map_or(1.0, |kind| 0.75 * kind.speed_max_m_s);
    let speed = table.number("speed_m_s", Some(default), Rule::Positive)?;
    within_speed_max(table, speed, kind)
}

/// `speed_m_s` of the table, when the kind can go that fast.
pub(crate) fn within_speed_max(table: &Table<'_>, speed: f64, kind: Option<&Kind>) -> Option<f64> {
    if let Some(kind) = kind
        && speed > kind.speed_max_m_s
    {
        table.refuse(
            "speed_m_s",
            format!("`speed_m_s` is {speed}, the kind goes at most at {} m/s", kind.speed_max_m_s),
            "faster than the body",
            format!("write {} or less, or raise the kind's `speed_max_m_s`", kind.speed_max_m_s),
        );
        return None;
    }
    Some(speed)
}

/// Indices of the trusted groups: all of them unless the table says which.
fn trusts(table: &Table<'_>, group_names: &[&str]) -> Option<Vec<u16>> {
    let Some(value) = table.get("trusts") else {
        return (0..group_names.len()).map(|index| u16::try_from(index).ok()).collect();
    };
    let DeValue::Array(names) = value.get_ref() else {
        table.wrong_type("trusts", value, "a list of group names");
        return None;
    };
    let mut trusted = Vec::new();
    let mut good = true;
    for name in names.iter() {
        let found = match name.get_ref() {
            DeValue::String(text) => {
                let found = group_names.iter().position(|known| known == text);
                if found.is_none() {
                    table.findings.add(
                        name.span(),
                        format!(
                            "`trusts` names the group `{}`, which is not in this scenario",
                            text.escape_debug()
                        ),
                        "no such group",
                        match crate::reader::closest(text, group_names.iter().copied()) {
                            Some(similar) => format!("did you mean `{similar}`?"),
                            None => format!("the groups are {}", group_names.join(", ")),
                        },
                    );
                }
                found
            }
            _ => {
                table.wrong_type("trusts", name, "a list of group names");
                None
            }
        };
        match found.and_then(|index| u16::try_from(index).ok()) {
            Some(index) => trusted.push(index),
            None => good = false,
        }
    }
    trusted.sort_unstable();
    trusted.dedup();
    good.then_some(trusted)
}
