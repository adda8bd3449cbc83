//! The table `[group.start]`: where the AUVs of a group begin.

use toml::de::DeValue;

use crate::AUVS_MAX;
use crate::environment::contains;
use crate::model::{Controller, Environment, Grid, Kind, Place, Start};
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
        ["region_m", "points_m", "grid", "place"].into_iter().filter(|key| table.has(key)).collect();
    let region = table.region("region_m");
    let points = if table.has("points_m") { table.points("points_m") } else { None };
    table.get("points_m");
    let grid = if table.has("grid") { grid(table, environment, count) } else { None };
    table.get("grid");
    let on_circle = table.has("place").then(|| table.choice("place", &[("on-circle", ())], ())).flatten();
    table.get("place");
    if matches!(controller, Some(Controller::Station { .. })) && !matches!(given[..], ["points_m"] | ["grid"])
    {
        table.findings.add(
            given.first().map_or(table.header(), |key| table.span(key)),
            "the controller `station` needs a point for each AUV",
            "no points of their own here",
            "write `grid = { first_m = [0, 0, -20], spacing_m = [100, 100, 0], columns = 10, rows = 10 }` or `points_m`",
        );
        return None;
    }
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
        ["grid"] => grid.map(Place::Grid),
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
                "keep one of `region_m`, `points_m`, `grid` and `place`",
            );
            None
        }
        [_] => None,
    }
}

/// The key `grid`.
fn grid(start: &Table<'_>, environment: Option<&Environment>, count: Option<u32>) -> Option<Grid> {
    let table = start.table("grid", "[group.start.grid]")?;
    let first_m = table.vec3("first_m", None, Rule::Finite);
    let spacing_m = table.vec3("spacing_m", None, Rule::NotNegative);
    let number = |key, default| {
        table.whole(key, default, 1, AUVS_MAX.into()).and_then(|count| u32::try_from(count).ok())
    };
    let (columns, rows, layers) =
        (number("columns", None), number("rows", Some(1)), number("layers", Some(1)));
    let scatter_m = table.number("scatter_m", Some(0.0), Rule::NotNegative);
    let read = || {
        let counts = [columns?, rows?, layers?];
        Some(Grid { first_m: first_m?, spacing_m: spacing_m?, counts, scatter_m: scatter_m? })
    };
    let grid = read();
    if let Some(grid) = &grid {
        fits(&table, grid, environment, count);
    }
    table.finish();
    grid
}

/// Whether a grid has a point inside the area for every AUV.
fn fits(table: &Table<'_>, grid: &Grid, environment: Option<&Environment>, count: Option<u32>) {
    if let Some(count) = count
        && grid.points() < u64::from(count)
    {
        let [columns, rows, layers] = grid.counts;
        table.refuse(
            "columns",
            format!(
                "{columns} columns, {rows} rows and {layers} layers are {} points for {count} AUVs",
                grid.points()
            ),
            format!("needs a point for each of the {count} AUVs"),
            "add columns, rows or layers",
        );
    }
    let directions = ["columns", "rows", "layers"].into_iter().enumerate();
    if let Some((_, direction)) =
        directions.clone().find(|&(axis, _)| grid.counts[axis] > 1 && grid.spacing_m[axis] == 0.0)
    {
        table.refuse(
            "spacing_m",
            format!("the {direction} of the grid are 0 m apart"),
            "AUVs on top of each other",
            "write a distance for each direction with more than one point: `[east, north, up]`",
        );
    }
    let Some(environment) = environment else { return };
    let reach = |side: f64| -> [f64; 3] {
        let scatter_m = [grid.scatter_m, grid.scatter_m, 0.0];
        std::array::from_fn(|axis| {
            let steps = if side > 0.0 { f64::from(grid.counts[axis] - 1) } else { 0.0 };
            grid.first_m[axis] + steps * grid.spacing_m[axis] + side * scatter_m[axis]
        })
    };
    let (least, greatest) = (reach(-1.0), reach(1.0));
    if !contains(&environment.area_m, least) || !contains(&environment.area_m, greatest) {
        table.refuse(
            "first_m",
            format!("the grid reaches from {least:?} to {greatest:?}, outside the area"),
            "not inside `area_m`",
            "move it, make it smaller, or make `area_m` larger; z is up and 0 at the surface",
        );
    }
}
