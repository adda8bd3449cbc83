//! Relative localization: vehicles that sweep an area enclose each other by pings alone, as in seed 002, chapter 5.
//!
//! Two vehicles, and then sixteen, sweep 300 m by 200 m, half of them along and half across, as surveys do to check themselves;
//! parallel lanes alone would leave the range-only case its mirror image for ever. Each pings every 10 s; whoever hears it
//! measures its range (±5 m), its bearing (±0.1 rad, and ±0.01 rad of compass) or both. Compared are: the last ping alone and the last
//! sixteen together; with the neighbour's commands and without, when all that is known of it is its speed. Every half second every
//! enclosure is held against the truth, and the example fails if one misses it.
//!
//! Deviations from the seed, which prints no more than the noise: area, speed, ping period and compass are ours; positions at
//! emission and reception are taken at one moment, as in equations (5.7) and (5.8), where a run has the travel time of sound.
//!
//! Run with `cargo run --release -p shoal-auv --example relative_localization`; figures as in the seed's 5.6 to 5.9 are left in the
//! folder that it names.

mod follow;
mod sweep;

use std::error::Error;

use follow::{Followers, Measures, PRECISION_M, Way, ping};
use nalgebra::Vector2;
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::{Interval, IntervalBox};
use sweep::{Dice, STEP_S, Vehicle, step};

/// The area, east and north, in metres.
const CORNER_M: [f64; 2] = [300.0, 200.0];
const LANES_APART_M: f64 = 25.0;
const PING_PERIOD_S: f64 = 10.0;
const DURATION_S: f64 = 600.0;
/// Widths count from here on: by then everybody has heard everybody a few times.
const SETTLED_S: f64 = 100.0;
/// How fine the figures are, in metres: what a person can see.
const DRAWN_M: f64 = 4.0;
/// What the figures show.
const SHOWN_S: f64 = 400.0;

/// What a run leaves.
struct Sweep {
    /// At the moment that the figures show.
    shown: Shown,
    ways: Vec<Way>,
    /// For each way, the widths of all boxes at each moment that counts, in metres.
    widths_m: Vec<Vec<f64>>,
    /// For each way, what 0 knows of 1 at each of its pings that count, as an area in square metres.
    areas_m2: Vec<Vec<f64>>,
    /// For each way, its median width over time: seconds, metres.
    medians_m: Vec<Vec<Vector2<f64>>>,
}

/// One moment.
struct Shown {
    vehicles: Vec<Vehicle>,
    followers: Vec<Followers>,
    /// True paths so far, in metres.
    paths_m: Vec<Vec<Vector2<f64>>>,
}

/// Every other vehicle sweeps along x, each its own strip.
fn begin(count: usize) -> Shown {
    let corner_m = Vector2::from(CORNER_M);
    let vehicles = (0..count).map(|index| {
        let along_x = index % 2 == 0;
        let width_m = if along_x { corner_m.y } else { corner_m.x } / count.div_ceil(2) as f64;
        Vehicle::sweeping(along_x, corner_m, [(index / 2) as f64 * width_m, width_m], LANES_APART_M)
    });
    let followers = Way::all().into_iter().map(|way| Followers::new(way, count));
    Shown { vehicles: vehicles.collect(), followers: followers.collect(), paths_m: vec![Vec::new(); count] }
}

fn run(count: usize) -> Result<Sweep, Box<dyn Error>> {
    let mut dice = Dice(count as u64);
    let mut now = begin(count);
    let mut shown = begin(count);
    let ways: Vec<Way> = now.followers.iter().map(|followers| followers.way).collect();
    let (mut widths_m, mut areas_m2) = (vec![Vec::new(); ways.len()], vec![Vec::new(); ways.len()]);
    let mut medians_m = vec![Vec::new(); ways.len()];
    let steps_per_ping = (PING_PERIOD_S / STEP_S) as usize;
    for number in 1..=(DURATION_S / STEP_S) as usize {
        let steps = step(&mut now.vehicles, &mut dice);
        now.followers.iter_mut().for_each(|followers| followers.carry(&steps));
        for emitter in (0..count).filter(|emitter| (number + emitter) % steps_per_ping == 0) {
            ping(emitter, &now.vehicles, &mut now.followers, &mut dice);
        }
        for (path_m, vehicle) in now.paths_m.iter_mut().zip(&now.vehicles) {
            path_m.push(vehicle.at_m);
        }
        let now_s = number as f64 * STEP_S;
        for (way, followers) in now.followers.iter().enumerate() {
            let now_m: Vec<f64> = followers.checked(&now.vehicles).map(|box_m| box_m.width()).collect();
            medians_m[way].push(Vector2::new(now_s, median(now_m.clone())));
            if now_s >= SETTLED_S {
                widths_m[way].extend(now_m);
            }
            if now_s >= SETTLED_S && (number + 1) % steps_per_ping == 0 {
                areas_m2[way].push(followers.tracks[0][1].paving(PRECISION_M)?.outer_volume().upper());
            }
        }
        if now_s == SHOWN_S {
            let Shown { vehicles, followers, paths_m } = &now;
            (shown.vehicles, shown.followers, shown.paths_m) =
                (vehicles.clone(), followers.clone(), paths_m.clone());
        }
    }
    Ok(Sweep { shown, ways, widths_m, areas_m2, medians_m })
}

/// The middle one of some numbers, of which there are some.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

fn print(sweep: &Sweep) {
    println!("\n{} vehicles, from {SETTLED_S} s to {DURATION_S} s", sweep.shown.vehicles.len());
    println!("{:<46} {:>12} {:>12} {:>16}", "", "width (m)", "at most (m)", "area 0-1 (m²)");
    for (index, way) in sweep.ways.iter().enumerate() {
        let widths_m = &sweep.widths_m[index];
        let (median_m, most_m) = (median(widths_m.clone()), widths_m.iter().copied().fold(0.0, f64::max));
        let area_m2 = median(sweep.areas_m2[index].clone());
        println!("{:<46} {median_m:>12.1} {most_m:>12.1} {area_m2:>16.0}", way.words());
    }
}

/// The paths, as in figure 5.6 of the seed.
fn draw_paths(shown: &Shown) -> Result<Figure, Box<dyn Error>> {
    let view = IntervalBox::from(CORNER_M.map(|side_m| Interval::spanning(-20.0, side_m + 20.0)));
    let title = format!("{} vehicles sweep an area", shown.vehicles.len());
    let mut figure = Figure::new(view)?.title(&title).axes("east (m)", "north (m)");
    for (index, path_m) in shown.paths_m.iter().enumerate() {
        figure = figure.curve(path_m).point(shown.vehicles[index].at_m, &format!("{index}"));
    }
    Ok(figure)
}

/// What vehicle 0 knows of the others in one way, as in figures 5.7 to 5.9.
fn draw_known(shown: &Shown, followers: &Followers) -> Result<Figure, Box<dyn Error>> {
    let view = IntervalBox::from([Interval::spanning(-320.0, 320.0); 2]);
    let mut figure = Figure::new(view)?
        .title(&format!("Seen from vehicle 0: {}", followers.way.words()))
        .axes("east of vehicle 0 (m)", "north (m)")
        .legend(Class::Boundary, "where a neighbour may be");
    let own_m = shown.vehicles[0].at_m;
    for (index, vehicle) in shown.vehicles.iter().enumerate().skip(1) {
        let paving = followers.tracks[0][index].paving(DRAWN_M)?;
        let truth_m = vehicle.at_m - own_m;
        assert!(paving.outer().any(|part| part.contains(&truth_m)), "the paving lost vehicle {index}");
        let parts: Vec<IntervalBox<2>> = paving.outer().copied().collect();
        figure = figure.union(&parts, Class::Boundary);
    }
    for (index, vehicle) in shown.vehicles.iter().enumerate() {
        figure = figure.point(vehicle.at_m - own_m, &format!("{index}"));
    }
    Ok(figure)
}

/// Median widths over time of one kind of measurement, each way in a colour of its own.
fn draw_widths(sweep: &Sweep, measures: Measures) -> Result<Figure, Box<dyn Error>> {
    let settled = |medians_m: &&Vec<Vector2<f64>>| {
        medians_m.iter().filter(|at| at[0] > SETTLED_S).map(|at| at[1]).fold(0.0, f64::max)
    };
    let ways = || sweep.ways.iter().zip(&sweep.medians_m).filter(|(way, _)| way.measures == measures);
    let most_m = ways().map(|(_, medians_m)| settled(&medians_m)).fold(0.0, f64::max);
    let view = IntervalBox::from([Interval::new(0.0, DURATION_S)?, Interval::new(0.0, 1.1 * most_m)?]);
    let mut figure = Figure::new(view)?.stretched_to(800, 400).axes("time (s)", "width (m)");
    let classes = [Class::Inner, Class::Boundary, Class::Outside, Class::Level(0)];
    for ((way, medians_m), class) in ways().zip(classes) {
        // From each value to the next, as stairs with a line's thickness.
        let columns: Result<Vec<_>, Box<dyn Error>> = medians_m
            .windows(2)
            .map(|pair| {
                let [low_m, high_m] = [pair[0][1].min(pair[1][1]), pair[0][1].max(pair[1][1])];
                let thick_m = 0.004 * most_m;
                let time_s = Interval::new(pair[0][0], pair[1][0])?;
                Ok(IntervalBox::from([time_s, Interval::new(low_m - thick_m, high_m + thick_m)?]))
            })
            .collect();
        let words = way.words();
        let (measured, rest) = words.split_once(", ").unwrap_or((&words, ""));
        figure = figure
            .title(&format!("Median width of what everybody knows of everybody, by {measured}"))
            .union(&columns?, class)
            .legend(class, rest);
    }
    Ok(figure)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = figures_folder();
    for count in [2, 16] {
        let sweep = run(count)?;
        print(&sweep);
        let file = |what: &str| folder.join(format!("relative-{count}-{what}.svg"));
        draw_paths(&sweep.shown)?.save(file("paths"))?;
        for followers in sweep.shown.followers.iter().filter(|followers| followers.way.exchanged) {
            let name = followers.way.words().replace(", commands, ", "-").replace(' ', "-");
            draw_known(&sweep.shown, followers)?.save(file(&name))?;
        }
        let measures =
            [(Measures::RangeAndBearing, "both"), (Measures::Bearing, "bearing"), (Measures::Range, "range")];
        for (measures, name) in measures {
            draw_widths(&sweep, measures)?.save(file(&format!("widths-{name}")))?;
        }
    }
    println!("\nfigures in {}", folder.display());
    Ok(())
}
