//! Which ray of a family reaches a range.

use super::route::{GRAZING, Route};

/// A step of Newton's method that changes the tangent by less than this leaves an error of its square.
const STEP_RELATIVE: f64 = 1e-5;
/// Absolute companion of [`STEP_RELATIVE`]: at 1e-7 rad from grazing, the travel time no longer feels the angle.
const STEP: f64 = 1e-8;
/// Ranges this close, relatively, are the same: rounding must not open a gap between two families of rays.
const SAME_RANGE: f64 = 1e-12;
/// Newton's method takes 2 to 6 steps; where halves of a bracket have to help, a few more.
const STEPS_MAX: usize = 80;
/// Beyond this tangent (a ray that leaves the vertical by less than 1e-8 rad) range times tangent is constant to the last bit.
const STEEP: f64 = 1e8;
/// How often a stretch of tangents is halved in search for rays: more pairs of rays than one in each of the smallest parts are not told apart.
const HALVINGS: u32 = 6;

/// The grazing tangent with which a ray of a route without a turn comes `range_m` far: the only one, since flatter rays come
/// farther. `None` when even the grazing one does not.
///
/// The inverse range is a nearly linear function of the tangent, exactly linear in uniform water: Newton's method runs on that.
pub(super) fn crossing<const N: usize>(route: &Route<N>, range_m: f64, guess: Option<f64>) -> Option<f64> {
    let steep = route.steep();
    let mut most = steep.reach_m / range_m;
    if !(most > 0.0) {
        // Nothing to cross: only equal points are joined, and those are no business of this function.
        return None;
    }
    if most > STEEP {
        return Some(most);
    }
    let mut least = 0.0;
    let expanded = most - steep.bend.max(0.0) * range_m / (4.0 * steep.reach_m);
    let mut w = guess.filter(|w| *w > 0.0 && *w <= most).unwrap_or(expanded);
    let mut reaches = false;
    for _ in 0..STEPS_MAX {
        if !(w > least && w <= most) {
            if !reaches {
                let (grazing_m, _) = route.range_m(GRAZING);
                if grazing_m < range_m {
                    return (grazing_m >= range_m * (1.0 - SAME_RANGE)).then_some(GRAZING);
                }
                reaches = true;
            }
            w = 0.5 * (least + most);
        }
        let (reached_m, slope_m) = route.range_m(w);
        let over_m = reached_m - range_m;
        if over_m >= 0.0 {
            (least, reaches) = (w, true);
        } else {
            most = w;
        }
        let next = w - over_m * reached_m / (range_m * slope_m);
        let step = next - w;
        if step.abs() <= STEP_RELATIVE * w + STEP && next > 0.0 {
            return Some(next);
        }
        w = next;
    }
    Some(w.clamp(least, most).max(GRAZING))
}

/// Calls `found` with the tangents up to `most` of all rays of a route with a turn that come `range_m` far.
pub(super) fn turning<const N: usize>(
    route: &Route<N>,
    most: f64,
    range_m: f64,
    guess: f64,
    found: &mut impl FnMut(f64),
) {
    search(route, (GRAZING, most), range_m, guess, HALVINGS, found);
}

/// Halves the stretch of tangents until the range is known to grow or to fall along it, or not to be reached.
fn search<const N: usize>(
    route: &Route<N>,
    (least, most): (f64, f64),
    range_m: f64,
    guess: f64,
    halvings: u32,
    found: &mut impl FnMut(f64),
) {
    let bounds = route.bounds(least, most);
    let width = most - least;
    let falls_to_m = bounds.ends_m.0 + (bounds.slope_m.0 * width).min(0.0);
    let rises_to_m = bounds.ends_m.0 + (bounds.slope_m.1 * width).max(0.0);
    let tolerance_m = SAME_RANGE * range_m;
    if range_m < falls_to_m.max(bounds.range_m.0) - tolerance_m
        || range_m > rises_to_m.min(bounds.range_m.1) + tolerance_m
    {
        return;
    }
    let is_monotone = bounds.slope_m.0 >= 0.0 || bounds.slope_m.1 <= 0.0;
    if !is_monotone && halvings > 0 {
        let middle = 0.5 * (least + most);
        search(route, (least, middle), range_m, guess, halvings - 1, found);
        search(route, (middle, most), range_m, guess, halvings - 1, found);
        return;
    }
    let (first_m, last_m) = bounds.ends_m;
    let (shortest_m, longest_m) = (first_m.min(last_m), first_m.max(last_m));
    if range_m < shortest_m - tolerance_m || range_m > longest_m + tolerance_m {
        return;
    }
    let ends = ((least, first_m - range_m), (most, last_m - range_m));
    found(between(route, ends, range_m, guess));
}

/// The ray between two tangents, given with what their rays come too far.
fn between<const N: usize>(
    route: &Route<N>,
    ((mut least, first_m), (mut most, last_m)): ((f64, f64), (f64, f64)),
    range_m: f64,
    guess: f64,
) -> f64 {
    let grows = last_m > first_m;
    let secant = least + (most - least) * first_m / (first_m - last_m);
    let mut w = if (least..=most).contains(&guess) { guess } else { secant };
    for _ in 0..STEPS_MAX {
        if !(w >= least && w <= most) {
            w = 0.5 * (least + most);
        }
        let (reached_m, slope_m) = route.range_m(w);
        let over_m = reached_m - range_m;
        if (over_m >= 0.0) == grows {
            most = w
        } else {
            least = w
        }
        let next = w - over_m / slope_m;
        let step = next - w;
        if step.abs() <= STEP_RELATIVE * w + STEP {
            return next.clamp(least.min(w), most.max(w)).max(GRAZING);
        }
        w = next;
    }
    w.clamp(least, most)
}
