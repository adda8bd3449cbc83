//! The water between surface and bottom, and the search for its rays.

use super::arc::Arc;
use super::route::{Route, Stretch, Turn};
use super::solve::{self, Found};
use super::{Boundary, SoundPath};
use super::{Direction, Ray};
use crate::acoustics::profile::{Level, Profile};

/// Ranges and depths beyond this, in metres, are no place in a sea: no ray goes there.
const FARTHEST_M: f64 = 1e8;
/// Ranges and depths below this, in metres, are zero: their squares would be.
const NEAREST_M: f64 = 1e-30;

/// Water between surface (depth 0) and a flat bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterColumn {
    profile: Profile,
    bottom_depth_m: f64,
    surface: Level,
    bottom: Level,
}

/// Emitter and receiver, sorted by depth: so that both ways are computed with the same operations.
struct Pair {
    upper: Level,
    lower: Level,
    range_m: f64,
    /// Whether the emitter is the upper one.
    goes_down: bool,
}

impl WaterColumn {
    /// Water of a profile above a bottom. Depths may be any: points above the surface or below the bottom see the profile go
    /// on there, and whichever is farther out, boundary or point, blocks their direct rays. A bottom at infinity is never met.
    pub fn new(profile: Profile, bottom_depth_m: f64) -> Self {
        let (surface, bottom) = (profile.level(0.0), profile.level(bottom_depth_m));
        Self { profile, bottom_depth_m, surface, bottom }
    }

    /// The profile.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Depth of the bottom in metres.
    pub fn bottom_depth_m(&self) -> f64 {
        self.bottom_depth_m
    }

    /// Speed of sound at a boundary, in m/s.
    pub fn speed_at_m_s(&self, boundary: Boundary) -> f64 {
        match boundary {
            Boundary::Surface => self.surface.speed_m_s,
            Boundary::Bottom => self.bottom.speed_m_s,
        }
    }

    /// The ray of a path: [`WaterColumn::direct`] or [`WaterColumn::bounced`].
    pub fn ray(
        &self,
        path: SoundPath,
        from_depth_m: f64,
        to_depth_m: f64,
        range_m: f64,
        guess: Option<&Ray>,
    ) -> Option<Ray> {
        match path {
            SoundPath::Direct => self.direct(from_depth_m, to_depth_m, range_m, guess),
            SoundPath::Bounced { first, bounces } => {
                self.bounced(first, bounces, from_depth_m, to_depth_m, range_m, guess)
            }
        }
    }

    /// The fastest ray between two depths at a horizontal distance that touches neither surface nor bottom and turns at most
    /// once. `None` in a shadow zone, and for places that are no numbers.
    ///
    /// `guess` is the ray between two points nearby, if one is known: it makes the search shorter.
    pub fn direct(
        &self,
        from_depth_m: f64,
        to_depth_m: f64,
        range_m: f64,
        guess: Option<&Ray>,
    ) -> Option<Ray> {
        let pair = self.pair(from_depth_m, to_depth_m, range_m)?;
        if pair.range_m == 0.0 && pair.upper.depth_m == pair.lower.depth_m {
            return Some(pair.met());
        }
        let mut fastest = None;
        if pair.shares_a_layer() {
            for layer in pair.lower.layer_above..=pair.upper.layer_below {
                faster(&mut fastest, self.within_layer(&pair, layer));
            }
        } else {
            faster(&mut fastest, self.across_layers(&pair, guess));
        }
        self.turned(&pair, Boundary::Surface, guess, &mut fastest);
        self.turned(&pair, Boundary::Bottom, guess, &mut fastest);
        fastest
    }

    /// The ray that bounces off surface and bottom in turn, `bounces` times in all, and runs from boundary to boundary without
    /// turning. `None` when even the flattest such ray falls short of the range, for points outside the water column, and for no bounces.
    ///
    /// `guess` is the ray of the same path between two points nearby, if one is known: it makes the search shorter.
    pub fn bounced(
        &self,
        first: Boundary,
        bounces: u8,
        from_depth_m: f64,
        to_depth_m: f64,
        range_m: f64,
        guess: Option<&Ray>,
    ) -> Option<Ray> {
        let pair = self.pair(from_depth_m, to_depth_m, range_m)?;
        if bounces == 0 || pair.upper.depth_m < 0.0 || pair.lower.depth_m > self.bottom_depth_m {
            return None;
        }
        let last = if bounces % 2 == 1 { first } else { first.other() };
        let crossings = f64::from(bounces - 1);
        let (upper_towards, lower_towards) = if pair.goes_down { (first, last) } else { (last, first) };
        // The leg of the upper point crosses what is above it or all below it, that of the lower one likewise.
        let count = |towards: Boundary, boundary: Boundary| if towards == boundary { 1.0 } else { 0.0 };
        let top =
            crossings + count(upper_towards, Boundary::Surface) + count(lower_towards, Boundary::Surface);
        let middle =
            crossings + count(upper_towards, Boundary::Bottom) + count(lower_towards, Boundary::Surface);
        let base =
            crossings + count(upper_towards, Boundary::Bottom) + count(lower_towards, Boundary::Bottom);
        if base > 0.0 && !is_place(self.bottom_depth_m) {
            return None;
        }
        let stretches = [
            Stretch::new(&self.profile, &self.surface, &pair.upper, top),
            Stretch::new(&self.profile, &pair.upper, &pair.lower, middle),
            Stretch::new(&self.profile, &pair.lower, &self.bottom, base),
        ];
        let (route, steep) = Route::along(&stretches);
        let guess = guess.map(|ray| route.tangent(ray.slowness_s_m));
        let found = solve::crossing(&route, steep, pair.range_m, guess)?;
        let down = |towards| if towards == Boundary::Bottom { 1.0 } else { -1.0 };
        // Seen from the upper point, sound comes to the lower one from where that one's leg goes.
        Some(pair.ray(&route, found, down(upper_towards), -down(lower_towards)))
    }

    fn pair(&self, from_depth_m: f64, to_depth_m: f64, range_m: f64) -> Option<Pair> {
        if !(is_place(from_depth_m) && is_place(to_depth_m) && is_place(range_m) && range_m >= 0.0) {
            return None;
        }
        let visible = |number: f64| if number.abs() < NEAREST_M { 0.0 } else { number };
        let (from_depth_m, to_depth_m) = (visible(from_depth_m), visible(to_depth_m));
        let range_m = visible(range_m);
        let goes_down = from_depth_m <= to_depth_m;
        let (upper_m, lower_m) =
            if goes_down { (from_depth_m, to_depth_m) } else { (to_depth_m, from_depth_m) };
        Some(Pair {
            upper: self.profile.level(upper_m),
            lower: self.profile.level(lower_m),
            range_m,
            goes_down,
        })
    }

    /// The ray between two points of one layer, if it stays in there and off the boundaries: one arc, in closed form.
    fn within_layer(&self, pair: &Pair, layer: usize) -> Option<Ray> {
        let gradient_1_s = self.profile.gradient_1_s(layer);
        let depth_m = pair.lower.depth_m - pair.upper.depth_m;
        let mean_speed_m_s = 0.5 * (pair.upper.speed_m_s + pair.lower.speed_m_s);
        let arc = Arc { range_m: pair.range_m, depth_m, mean_speed_m_s, gradient_1_s };
        let ends = arc.ends();
        // The slope of the ray falls along the way when sound is faster below, and grows when it is slower.
        let turns = if gradient_1_s > 0.0 { ends.last_down < 0.0 } else { ends.first_down < 0.0 };
        if turns {
            let far = if gradient_1_s > 0.0 {
                self.layer_end(layer, Boundary::Bottom, self.bottom_depth_m.max(pair.lower.depth_m))
            } else {
                self.layer_end(layer, Boundary::Surface, pair.upper.depth_m.min(0.0))
            };
            if ends.slowness_s_m * far?.speed_m_s < 1.0 {
                return None;
            }
        }
        let (travel_s, length_m) = arc.measure();
        Some(pair.oriented(travel_s, length_m, ends.slowness_s_m, ends.first_down, ends.last_down))
    }

    /// The ray between two points of different layers that keeps going down or up.
    fn across_layers(&self, pair: &Pair, guess: Option<&Ray>) -> Option<Ray> {
        let stretch = [Stretch::new(&self.profile, &pair.upper, &pair.lower, 1.0)];
        let (route, steep) = Route::along(&stretch);
        let guess = guess.filter(|ray| ray.keeps_going()).map(|ray| route.tangent(ray.slowness_s_m));
        let found = solve::crossing(&route, steep, pair.range_m, guess)?;
        Some(pair.ray(&route, found, 1.0, 1.0))
    }

    /// Looks for faster rays that turn once, between the points and the boundary on one side.
    ///
    /// The layers are taken one after the other, away from the points. A ray can turn only where sound is faster than anywhere
    /// before. Where a ray is known that keeps going, with the slowness `p`, only a ray that turns where sound is faster than `1 / p`
    /// can be faster: a loop of slowness `q` takes at least `q` times its range, while the known ray gains at most `p` times that
    /// when the loop's range is taken off its own.
    fn turned(&self, pair: &Pair, side: Boundary, guess: Option<&Ray>, fastest: &mut Option<Ray>) {
        let (near, limit_m, downs) = match side {
            Boundary::Surface => (&pair.upper, pair.upper.depth_m.min(0.0), (-1.0, 1.0)),
            Boundary::Bottom => (&pair.lower, pair.lower.depth_m.max(self.bottom_depth_m), (1.0, -1.0)),
        };
        let (_, fastest_m_s) = self.profile.extremes_m_s();
        let known = fastest.filter(Ray::keeps_going);
        if known.is_some_and(|ray| ray.slowness_s_m * fastest_m_s < 1.0) {
            return;
        }
        let least_m_s = known.map_or(0.0, |ray| 1.0 / ray.slowness_s_m);
        let apart_m = pair.lower.depth_m - pair.upper.depth_m;
        let (mut slowest_m_s, mut record_m_s) =
            self.profile.speed_bounds_m_s(pair.upper.depth_m, pair.lower.depth_m);
        let mut entry = *near;
        while entry.depth_m != limit_m && record_m_s < fastest_m_s {
            let layer = if side == Boundary::Surface { entry.layer_above } else { entry.layer_below };
            let Some(exit) = self.layer_end(layer, side, limit_m) else { return };
            let is_done = pair.lower.layer_above <= layer && layer <= pair.upper.layer_below;
            if exit.speed_m_s > record_m_s.max(least_m_s) && !is_done {
                // Nowhere is the ray steeper than where sound is slowest, so it comes this far at the least.
                let crossed_m = apart_m + 2.0 * (entry.depth_m - near.depth_m).abs();
                if crossed_m <= pair.range_m * grazing_tangent(slowest_m_s, exit.speed_m_s) {
                    let between = Stretch::new(&self.profile, &pair.upper, &pair.lower, 1.0);
                    let beyond = match side {
                        Boundary::Surface => Stretch::new(&self.profile, &entry, near, 2.0),
                        Boundary::Bottom => Stretch::new(&self.profile, near, &entry, 2.0),
                    };
                    let gradient_1_s = self.profile.gradient_1_s(layer).abs();
                    let turn = Turn { entry_m_s: entry.speed_m_s, gradient_1_s };
                    let stretches = [between, beyond];
                    let route = Route::turning(&stretches, turn, record_m_s);
                    let least = grazing_tangent(record_m_s, least_m_s.max(record_m_s));
                    let most = grazing_tangent(record_m_s, exit.speed_m_s);
                    let guess = guess.map_or(f64::NAN, |ray| route.tangent(ray.slowness_s_m));
                    solve::turning(&route, (least, most), pair.range_m, guess, &mut |found| {
                        faster(fastest, Some(pair.ray(&route, found, downs.0, downs.1)));
                    });
                }
            }
            record_m_s = record_m_s.max(exit.speed_m_s);
            slowest_m_s = slowest_m_s.min(exit.speed_m_s);
            entry = exit;
        }
    }

    /// Where a layer ends on one side: at its node, or at `limit_m` if that is nearer.
    pub(super) fn layer_end(&self, layer: usize, side: Boundary, limit_m: f64) -> Option<Level> {
        match side {
            Boundary::Surface => {
                let node = self.profile.node_above(layer)?;
                Some(if node.depth_m < limit_m { self.profile.level(limit_m) } else { node })
            }
            Boundary::Bottom => {
                let node = self.profile.node_below(layer)?;
                Some(if node.depth_m > limit_m { self.profile.level(limit_m) } else { node })
            }
        }
    }
}

impl Pair {
    /// Whether both points lie in one layer: then every layer from `lower.layer_above` to `upper.layer_below` holds both.
    fn shares_a_layer(&self) -> bool {
        self.lower.layer_above <= self.upper.layer_below
    }

    /// The ray between equal points.
    fn met(&self) -> Ray {
        let horizontal = Direction { cos: 1.0, sin: 0.0 };
        Ray {
            travel_s: 0.0,
            length_m: 0.0,
            slowness_s_m: 1.0 / self.upper.speed_m_s,
            departure: horizontal,
            arrival: horizontal,
        }
    }

    /// The ray of a route that has been found; `upper_down` and `lower_down` are 1 where the ray from the upper to the lower
    /// point goes down and -1 where it goes up.
    fn ray(&self, route: &Route, found: Found, upper_down: f64, lower_down: f64) -> Ray {
        let first = upper_down * route.sine(found.w, self.upper.speed_m_s);
        let last = lower_down * route.sine(found.w, self.lower.speed_m_s);
        self.oriented(found.travel_s, found.length_m, route.slowness_s_m(found.w), first, last)
    }

    /// The ray from emitter to receiver, of a ray from the upper to the lower point with the downward sines at both.
    fn oriented(
        &self,
        travel_s: f64,
        length_m: f64,
        slowness_s_m: f64,
        first_down: f64,
        last_down: f64,
    ) -> Ray {
        let upper_cos = (slowness_s_m * self.upper.speed_m_s).min(1.0);
        let lower_cos = (slowness_s_m * self.lower.speed_m_s).min(1.0);
        let (departure, arrival) = if self.goes_down {
            (Direction { cos: upper_cos, sin: -first_down }, Direction { cos: lower_cos, sin: -last_down })
        } else {
            (Direction { cos: lower_cos, sin: last_down }, Direction { cos: upper_cos, sin: first_down })
        };
        Ray { travel_s, length_m, slowness_s_m, departure, arrival }
    }
}

fn is_place(number: f64) -> bool {
    number.abs() <= FARTHEST_M
}

/// Tangent of the grazing angle where the speed of sound is `slow_m_s` of a ray that turns where it is `fast_m_s`.
fn grazing_tangent(slow_m_s: f64, fast_m_s: f64) -> f64 {
    ((fast_m_s - slow_m_s) * (fast_m_s + slow_m_s)).sqrt() / slow_m_s
}

fn faster(fastest: &mut Option<Ray>, other: Option<Ray>) {
    if let Some(other) = other
        && fastest.is_none_or(|ray| other.travel_s < ray.travel_s)
    {
        *fastest = Some(other);
    }
}
