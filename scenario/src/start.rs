//! The table `[group.start]`: where the AUVs of a group begin.

use toml::de::DeValue;

use crate::environment::contains;
use crate::model::{Controller, Environment, Kind, Place, Start};
use crate::number::Rule;
use crate::reader::Table;
use crate::steering::within_speed_max;

/// Width of the prior box in metres when the table does not say it.
const BOX_WIDTH_DEFAULT_M: f64 = 10.0;

pub(crate) fn start(
    group: &Table<'_>,
    environment: Option<&Environment>,
    kind: Option<&Kind>,
    controller: Option<&Controller>,
    count: Option<u32>,
) -> Option<Start> {
    let empty = toml::de::DeTable::new();
    if !group.has("start") {
        let table = Table::new(&empty, group.header(), "[group.start]", group.findings);
        group.get("start");
        return read(&table, environment, kind, controller, count);
    }
    let table = group.table("start", "[group.start]")?;
    let start = read(&table, environment, kind, controller, count);
    table.finish();
    start
}

fn read(
    table: &Table<'_>,
    environment: Option<&Environment>,
    kind: Option<&Kind>,
    controller: Option<&Controller>,
    count: Option<u32>,
) -> Option<Start> {
    let place = place(table, environment, controller, count);
    let box_width_m = match table.get("box_width_m") {
        None => Some([BOX_WIDTH_DEFAULT_M; 2]),
        Some(value) if matches!(value.get_ref(), DeValue::Array(_)) => {
            table.range_in("box_width_m", value, Rule::NotNegative)
        }
        Some(value) => table.number_in("box_width_m", value, Rule::NotNegative).map(|width| [width; 2]),
    };
    let known = table.boolean("known", true);
    if known == Some(false) && table.has("box_width_m") {
        table.refuse(
            "box_width_m",
            "an AUV that does not know where it begins is told no box but the area",
            "has no effect",
            "remove `box_width_m`, or write `known = true`",
        );
    }
    let heading_rad = match table.get("heading_rad") {
        None => Some(None),
        Some(value) => table.number_in("heading_rad", value, Rule::Finite).map(Some),
    };
    if let Some(Place::OnCircle) = place
        && table.has("heading_rad")
    {
        table.refuse(
            "heading_rad",
            "an AUV that begins on its circle heads along it",
            "has no effect",
            "remove `heading_rad`, or choose `points_m` instead of `place = \"on-circle\"`",
        );
    }
    let default = match controller {
        Some(Controller::Circle { radius_m, heave_m, rate_rad_s, .. }) => {
            (radius_m * radius_m + heave_m * heave_m).sqrt() * rate_rad_s.abs()
        }
        Some(Controller::Waypoints { speed_m_s, .. } | Controller::Reynolds { speed_m_s, .. }) => *speed_m_s,
        _ => 0.0,
    };
    let speed = table.number("speed_m_s", Some(default), Rule::NotNegative);
    // A default that is too fast is the controller's error, reported there.
    let speed = if table.has("speed_m_s") {
        speed.and_then(|speed| within_speed_max(table, speed, kind))
    } else {
        speed
    };
    Some(Start {
        place: place?,
        box_width_m: box_width_m?,
        known: known?,
        heading_rad: heading_rad?,
        speed_m_s: speed?,
    })
}

fn place(
    table: &Table<'_>,
    environment: Option<&Environment>,
    controller: Option<&Controller>,
    count: Option<u32>,
) -> Option<Place> {
    let given: Vec<&str> =
        ["region_m", "points_m", "place"].into_iter().filter(|key| table.has(key)).collect();
    let region = table.region("region_m");
    let points = if table.has("points_m") { table.points("points_m") } else { None };
    table.get("points_m");
    let on_circle = table.has("place").then(|| table.choice("place", &[("on-circle", ())], ())).flatten();
    table.get("place");
    match given.as_slice() {
        // Everywhere in the area; without one there is an error already.
        [] => environment.map(|environment| Place::Region(environment.area_m)),
        ["region_m"] => {
            let region = region?;
            let inside = environment.is_none_or(|environment| {
                contains(&environment.area_m, region.map(|range| range[0]))
                    && contains(&environment.area_m, region.map(|range| range[1]))
            });
            if !inside {
                table.refuse(
                    "region_m",
                    "the start region reaches outside the area",
                    "not inside `area_m`",
                    "make it smaller, or `area_m` of `[environment]` larger",
                );
            }
            Some(Place::Region(region))
        }
        ["points_m"] => {
            let points = points?;
            if let Some(count) = count
                && points.len() != count as usize
            {
                table.refuse(
                    "points_m",
                    format!("{} start points for {count} AUVs", points.len()),
                    format!("needs one point for each of the {count} AUVs"),
                    format!("give {count} points, or write `count = {}`", points.len()),
                );
            }
            if let Some(environment) = environment
                && let Some(outside) = points.iter().find(|point| !contains(&environment.area_m, **point))
            {
                table.refuse(
                    "points_m",
                    format!("the start point {outside:?} lies outside the area"),
                    "not inside `area_m`",
                    "move it inside, or make `area_m` larger; z is up and 0 at the surface",
                );
            }
            Some(Place::Points(points))
        }
        ["place"] => {
            on_circle?;
            match controller {
                Some(Controller::Circle { .. }) => Some(Place::OnCircle),
                Some(_) => {
                    table.refuse(
                        "place",
                        "`on-circle` needs the controller `circle`",
                        "this group has no circle",
                        "give `region_m` or `points_m`, or the group a controller `circle`",
                    );
                    None
                }
                None => None,
            }
        }
        [first, second, ..] => {
            table.findings.add_related(
                table.span(second),
                format!("a group begins at one place, not at `{first}` and `{second}`"),
                "second place",
                Some((table.span(first), "first place".into())),
                "keep one of `region_m`, `points_m` and `place`",
            );
            None
        }
        [_] => None,
    }
}
