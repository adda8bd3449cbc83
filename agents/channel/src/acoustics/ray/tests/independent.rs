//! Other ways to the same answers: slow, simple, and with no formula in common with what they check.

use super::{Direction, WaterColumn};
use crate::acoustics::profile::Profile;

/// A ray under way.
#[derive(Clone, Copy, Debug)]
struct State {
    range_m: f64,
    depth_m: f64,
    /// Downward slowness in s/m.
    down_s_m: f64,
    travel_s: f64,
}

/// Where a ray is at a range, and when: the ray equations by Runge and Kutta's method, with steps that end at every node.
pub(super) fn landed(water: &WaterColumn, from_m: f64, departure: Direction, range_m: f64) -> (f64, f64) {
    let profile = water.profile();
    let across_s_m = departure.cos / profile.speed_m_s(from_m);
    let mut state = State {
        range_m: 0.0,
        depth_m: from_m,
        down_s_m: -departure.sin / profile.speed_m_s(from_m),
        travel_s: 0.0,
    };
    for _ in 0..1_000_000 {
        if state.range_m >= range_m - 1e-10 {
            break;
        }
        let going_down = state.down_s_m > 0.0
            || (state.down_s_m == 0.0 && gradient_1_s(profile, state.depth_m, true) < 0.0);
        let gradient = gradient_1_s(profile, state.depth_m, going_down);
        let speed_m_s = profile.speed_m_s(state.depth_m);
        let field = |depth_m: f64| speed_m_s + gradient * (depth_m - state.depth_m);
        let node_m = profile.nodes().iter().map(|node| node.depth_m).filter(|&node_m| {
            if going_down { node_m > state.depth_m + 1e-9 } else { node_m < state.depth_m - 1e-9 }
        });
        let node_m = if going_down { node_m.reduce(f64::min) } else { node_m.reduce(f64::max) };
        let mut step_m = 2.0;
        let mut next = stepped(&field, gradient, across_s_m, state, step_m);
        if let Some(node_m) = node_m {
            // Secant steps to the node, where the gradient changes.
            for _ in 0..60 {
                let over_m = next.depth_m - node_m;
                if (over_m > 0.0) != going_down || over_m.abs() < 1e-12 {
                    break;
                }
                step_m *= (node_m - state.depth_m) / (next.depth_m - state.depth_m);
                next = stepped(&field, gradient, across_s_m, state, step_m);
            }
        }
        for _ in 0..60 {
            let over_m = next.range_m - range_m;
            if over_m < 1e-12 {
                break;
            }
            step_m *= (range_m - state.range_m) / (next.range_m - state.range_m);
            next = stepped(&field, gradient, across_s_m, state, step_m);
        }
        state = next;
    }
    (state.depth_m, state.travel_s)
}

/// The gradient of the layer below or above a depth.
fn gradient_1_s(profile: &Profile, depth_m: f64, below: bool) -> f64 {
    let nodes = profile.nodes();
    let index = if below {
        nodes.iter().filter(|node| node.depth_m <= depth_m + 1e-9).count()
    } else {
        nodes.iter().filter(|node| node.depth_m < depth_m - 1e-9).count()
    };
    if index == 0 || index == nodes.len() {
        return 0.0;
    }
    (nodes[index].speed_m_s - nodes[index - 1].speed_m_s) / (nodes[index].depth_m - nodes[index - 1].depth_m)
}

fn stepped(
    field: &impl Fn(f64) -> f64,
    gradient_1_s: f64,
    across_s_m: f64,
    from: State,
    step_m: f64,
) -> State {
    let rate = |state: State| {
        let speed_m_s = field(state.depth_m);
        State {
            range_m: speed_m_s * across_s_m,
            depth_m: speed_m_s * state.down_s_m,
            down_s_m: -gradient_1_s / (speed_m_s * speed_m_s),
            travel_s: 1.0 / speed_m_s,
        }
    };
    let along = |rate: State, length_m: f64| State {
        range_m: from.range_m + rate.range_m * length_m,
        depth_m: from.depth_m + rate.depth_m * length_m,
        down_s_m: from.down_s_m + rate.down_s_m * length_m,
        travel_s: from.travel_s + rate.travel_s * length_m,
    };
    let first = rate(from);
    let second = rate(along(first, 0.5 * step_m));
    let third = rate(along(second, 0.5 * step_m));
    let fourth = rate(along(third, step_m));
    let mean = |part: fn(&State) -> f64| {
        (part(&first) + 2.0 * part(&second) + 2.0 * part(&third) + part(&fourth)) / 6.0
    };
    along(
        State {
            range_m: mean(|state| state.range_m),
            depth_m: mean(|state| state.depth_m),
            down_s_m: mean(|state| state.down_s_m),
            travel_s: mean(|state| state.travel_s),
        },
        step_m,
    )
}

/// Travel time of sound along the polyline through places (range, depth), by many small pieces.
pub(super) fn polyline_s(profile: &Profile, places_m: &[(f64, f64)]) -> f64 {
    let piece_s = |pair: &[(f64, f64)]| {
        let ((x0, z0), (x1, z1)) = (pair[0], pair[1]);
        let length_m = ((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0)).sqrt();
        let pieces = 400;
        let slowness = |index: i32| {
            1.0 / profile.speed_m_s(z0 + (z1 - z0) * (f64::from(index) + 0.5) / f64::from(pieces))
        };
        length_m * (0..pieces).map(slowness).sum::<f64>() / f64::from(pieces)
    };
    places_m.windows(2).map(piece_s).sum()
}

/// Travel time of sound along the straight line.
pub(super) fn straight_s(profile: &Profile, from_m: f64, to_m: f64, range_m: f64) -> f64 {
    polyline_s(profile, &[(0.0, from_m), (range_m, to_m)])
}

/// The least travel time among a great many rays of every family, if some pair of them has the receiver between.
pub(super) fn brute_force_s(water: &WaterColumn, from_m: f64, to_m: f64, range_m: f64) -> Option<f64> {
    let (upper_m, lower_m) = (from_m.min(to_m), from_m.max(to_m));
    let profile = water.profile();
    let fastest = |a_m: f64, b_m: f64| profile.speed_bounds_m_s(a_m, b_m).1;
    let mut best: Option<f64> = None;
    let mut scan = |tries: &mut dyn Iterator<Item = (f64, Option<(f64, f64)>)>| {
        let mut before: Option<(f64, f64, f64)> = None;
        for (slowness, ray) in tries {
            if let (Some((p0, r0, t0)), Some((r1, _))) = (before, ray)
                && (r0 - range_m) * (r1 - range_m) <= 0.0
            {
                // The slowness is the slope of travel time over range.
                let share = if r1 == r0 { 0.0 } else { (range_m - r0) / (r1 - r0) };
                let mean_slowness = p0 + 0.5 * share * (slowness - p0);
                let travel_s = t0 + mean_slowness * (range_m - r0);
                best = Some(best.map_or(travel_s, |best| best.min(travel_s)));
            }
            before = ray.map(|(range_m, travel_s)| (slowness, range_m, travel_s));
        }
    };
    let v_m_s = fastest(upper_m, lower_m);
    scan(&mut (0..4_000).map(|index| {
        // Dense towards grazing.
        let w = 1e-7 + f64::from(index) / 4_000.0 * f64::from(index) / 4_000.0 * 30.0;
        let slowness = 1.0 / (v_m_s * (1.0 + w * w).sqrt());
        (slowness, Some(crossed(profile, upper_m, lower_m, slowness)))
    }));
    let (surface_m, bottom_m) = (upper_m.min(0.0), lower_m.max(water.bottom_depth_m()));
    for (near_m, limit_m) in [(lower_m, bottom_m), (upper_m, surface_m)] {
        scan(&mut (1..=8_000).map(|index| {
            let share = f64::from(index) / 8_000.0;
            let turn_m = near_m + (limit_m - near_m) * share * share;
            let speed_m_s = profile.speed_m_s(turn_m);
            let slowness = 1.0 / speed_m_s;
            let hair_m = (turn_m - near_m) * 1e-12;
            if fastest(upper_m.min(turn_m - hair_m), lower_m.max(turn_m - hair_m)) >= speed_m_s {
                return (slowness, None);
            }
            let (between_m, between_s) = crossed(profile, upper_m, lower_m, slowness);
            let (beyond_m, beyond_s) = crossed(profile, near_m.min(turn_m), near_m.max(turn_m), slowness);
            (slowness, Some((between_m + 2.0 * beyond_m, between_s + 2.0 * beyond_s)))
        }));
    }
    best
}

/// Range and travel time of a ray through all layers between two depths, by the textbook's formulas.
fn crossed(profile: &Profile, upper_m: f64, lower_m: f64, slowness: f64) -> (f64, f64) {
    let inner = profile.nodes().iter().map(|node| node.depth_m).filter(|&m| upper_m < m && m < lower_m);
    let depths_m: Vec<f64> = [upper_m].into_iter().chain(inner).chain([lower_m]).collect();
    let sine = |speed_m_s: f64| (1.0 - slowness * slowness * speed_m_s * speed_m_s).max(0.0).sqrt();
    let (mut range_m, mut travel_s) = (0.0, 0.0);
    for pair in depths_m.windows(2) {
        let (a, b) = (profile.speed_m_s(pair[0]), profile.speed_m_s(pair[1]));
        let gradient = (b - a) / (pair[1] - pair[0]);
        if (b - a).abs() < 1e-6 {
            let length_m = (pair[1] - pair[0]) / sine(0.5 * (a + b)).max(1e-300);
            range_m += length_m * slowness * a;
            travel_s += length_m / a;
        } else {
            range_m += (sine(a) - sine(b)) / (slowness * gradient);
            travel_s += pxfm::f_log(b * (1.0 + sine(a)) / (a * (1.0 + sine(b)))) / gradient;
        }
    }
    (range_m, travel_s)
}
