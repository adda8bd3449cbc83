//! Which ray of a family reaches a range.

use super::route::{GRAZING, Route, Steep};

/// A step of Newton's method that changes the tangent by less than this, relatively, leaves an error of its square.
const STEP: f64 = 4e-3;
/// A ray whose tangent is known this well is corrected at its end: what is left of the error of the travel time goes as the
/// third power.
const LAST_STEP: f64 = 3e-5;
/// Absolute companion of both: this close to grazing, in radians, neither range nor travel time feels the angle.
const GRAZING_STEP: f64 = 1e-9;
/// Ranges this close, relatively, are the same: rounding must not open a gap between two families of rays.
const SAME_RANGE: f64 = 1e-12;
/// Newton's method takes 2 to 6 steps; where halves of a bracket have to help, a few more.
const STEPS_MAX: usize = 80;
/// Beyond this tangent (a ray that leaves the vertical by less than 1e-8 rad) range times tangent is constant to the last bit.
const STEEP: f64 = 1e8;
/// How often a stretch of tangents is halved in search for rays: more pairs of rays than one in each of the smallest parts are not told apart.
const HALVINGS: u32 = 6;

/// A ray that comes as far as it should.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Tangent of its grazing angle where sound is fastest.
    pub w: f64,
    pub travel_s: f64,
    pub length_m: f64,
}

/// The ray of a route without a turn that comes `range_m` far: the only one, since flatter rays come farther. `None` when
/// even the grazing one does not.
///
/// The inverse range is a nearly linear function of the tangent, exactly linear in uniform water: Newton's method runs on that.
pub(super) fn crossing(route: &Route, steep: Steep, range_m: f64, guess: Option<f64>) -> Option<Found> {
    let mut most = steep.reach_m / range_m;
    if most.is_nan() || most <= 0.0 {
        // Nothing to cross: only equal points are joined, and those are no business of this function.
        return None;
    }
    if most > STEEP {
        let traced = route.trace(most);
        return Some(Found { w: most, travel_s: traced.travel_s, length_m: traced.length_m });
    }
    let mut w = most - steep.bend * range_m / (4.0 * steep.reach_m);
    if let Some(guess) = guess.filter(|guess| *guess > 0.0) {
        match landed(route, range_m, guess) {
            Ok(found) => return Some(found),
            Err(next) => w = next,
        }
    }
    let mut least = 0.0;
    let mut reaches = false;
    for _ in 0..STEPS_MAX {
        if !(w > least && w <= most) {
            if !reaches {
                let (grazing_m, _) = route.range_m(GRAZING);
                if grazing_m < range_m {
                    return (grazing_m >= range_m * (1.0 - SAME_RANGE)).then(|| {
                        landed(route, range_m, GRAZING).unwrap_or_else(|_| closest(route, range_m, GRAZING))
                    });
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
        if (next - w).abs() <= STEP * w + GRAZING_STEP && next > 0.0 {
            match landed(route, range_m, next) {
                Ok(found) => return Some(found),
                Err(next) => w = next,
            }
        } else {
            w = next;
        }
    }
    Some(closest(route, range_m, w.clamp(least, most).max(GRAZING)))
}

/// The ray that comes `range_m` far, if the one with `w` all but does; otherwise a better `w`.
#[inline]
fn landed(route: &Route, range_m: f64, w: f64) -> Result<Found, f64> {
    let traced = route.trace(w);
    let short_m = range_m - traced.range_m;
    let next = w + short_m * traced.range_m / (range_m * traced.slope_m);
    if !((next - w).abs() <= LAST_STEP * w + GRAZING_STEP && next > 0.0) {
        return Err(next);
    }
    // Slowness is the travel time's slope over range: its own slope gives the second order.
    let slowness_s_m = route.slowness_s_m(w);
    let bend_s_m2 = -slowness_s_m * w / ((1.0 + w * w) * traced.slope_m);
    Ok(Found {
        w: next,
        travel_s: traced.travel_s + short_m * (slowness_s_m + 0.5 * short_m * bend_s_m2),
        length_m: traced.length_m + short_m * route.cosine(w),
    })
}

/// The ray with `w`, which is as good as it gets.
fn closest(route: &Route, range_m: f64, w: f64) -> Found {
    let traced = route.trace(w);
    let travel_s = traced.travel_s + route.slowness_s_m(w) * (range_m - traced.range_m);
    Found { w, travel_s, length_m: traced.length_m }
}

/// Calls `found` with all rays of a route with a turn that come `range_m` far, with tangents between two.
pub(super) fn turning(
    route: &Route,
    (least, most): (f64, f64),
    range_m: f64,
    guess: f64,
    found: &mut impl FnMut(Found),
) {
    search(route, (least.max(GRAZING), most), range_m, guess, HALVINGS, found);
}

/// Halves the stretch of tangents until the range is known to grow or to fall along it, or not to be reached.
fn search(
    route: &Route,
    (least, most): (f64, f64),
    range_m: f64,
    guess: f64,
    halvings: u32,
    found: &mut impl FnMut(Found),
) {
    let bounds = route.bounds(least, most);
    let tolerance_m = SAME_RANGE * range_m;
    if range_m < bounds.range_m.0 - tolerance_m || range_m > bounds.range_m.1 + tolerance_m {
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
fn between(
    route: &Route,
    ((mut least, first_m), (mut most, last_m)): ((f64, f64), (f64, f64)),
    range_m: f64,
    guess: f64,
) -> Found {
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
            most = w;
        } else {
            least = w;
        }
        let next = w - over_m / slope_m;
        if (next - w).abs() <= LAST_STEP * w + GRAZING_STEP {
            w = next;
            break;
        }
        w = next;
    }
    let w = w.clamp(least.min(most), most).max(GRAZING);
    landed(route, range_m, w).unwrap_or_else(|_| closest(route, range_m, w))
}
