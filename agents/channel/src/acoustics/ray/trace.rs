//! Where a ray goes that leaves in a given direction: for figures, and as a check of the solver from the other side.

use super::{Boundary, Direction, WaterColumn};

/// A ray of more pieces than this is followed no further: a duct of very thin layers.
const WAYPOINTS_MAX: usize = 20_000;

/// A place on a ray: between two of them, the ray is one arc of a circle, or straight, and turns by less than a right angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint {
    /// Horizontal distance from the source, in metres.
    pub range_m: f64,
    /// Depth in metres, positive down.
    pub depth_m: f64,
    /// Direction there.
    pub direction: Direction,
}

impl WaterColumn {
    /// Follows a ray that leaves `from_depth_m` in a direction until it has come `range_m` far or bounced off surface and bottom
    /// `bounces_max` times in all.
    ///
    /// Waypoints lie where the ray leaves a layer, turns between down and up, or bounces: at a bounce there are two in the
    /// same place, with the directions before and after. Their places and directions are exact up to rounding: with the horizontal
    /// slowness `p` and the gradient `g`, the sine of the grazing angle falls by `p g` per metre of range (Jensen et al.,
    /// *Computational Ocean Acoustics*, section 3.3).
    ///
    /// Empty for a source outside of the water column, a direction that does not go forward (`cos` not positive), and for
    /// ranges and directions that are no numbers.
    ///
    /// ```
    /// use shoal_channel::acoustics::profile::{Node, Profile};
    /// use shoal_channel::acoustics::ray::{Direction, WaterColumn};
    ///
    /// let node = |depth_m: f64| Node { depth_m, speed_m_s: 1500.0 - 0.1 * depth_m };
    /// let water = WaterColumn::new(Profile::new(&[node(0.0), node(100.0)])?, 100.0);
    /// let ray = water.trace(10.0, Direction { cos: 1.0, sin: 0.0 }, 2_000.0, 0);
    /// // Where deeper water is slower, a ray bends down; here it ends at the bottom.
    /// assert_eq!(ray.last().map(|end| end.depth_m), Some(100.0));
    /// # Ok::<(), shoal_channel::acoustics::profile::ProfileError>(())
    /// ```
    pub fn trace(
        &self,
        from_depth_m: f64,
        departure: Direction,
        range_m: f64,
        bounces_max: u32,
    ) -> Vec<Waypoint> {
        let is_possible = (0.0..=self.bottom_depth_m()).contains(&from_depth_m)
            && departure.cos > 0.0
            && departure.cos <= 1.0
            && departure.sin.is_finite()
            && range_m > 0.0
            && range_m.is_finite();
        if !is_possible {
            return Vec::new();
        }
        let slowness_s_m = departure.cos / self.profile().speed_m_s(from_depth_m);
        let mut at = Waypoint { range_m: 0.0, depth_m: from_depth_m, direction: departure };
        let mut ray = vec![at];
        let mut bounces = 0;
        while at.range_m < range_m && ray.len() < WAYPOINTS_MAX {
            let is_going = |boundary| match boundary {
                Boundary::Surface => at.depth_m <= 0.0 && at.direction.sin > 0.0,
                Boundary::Bottom => at.depth_m >= self.bottom_depth_m() && at.direction.sin < 0.0,
            };
            if is_going(Boundary::Surface) || is_going(Boundary::Bottom) {
                if bounces == bounces_max {
                    break;
                }
                bounces += 1;
                at.direction.sin = -at.direction.sin;
            } else {
                let next = self.next(&at, slowness_s_m, range_m);
                if next == at {
                    break;
                }
                at = next;
            }
            ray.push(at);
        }
        ray
    }

    /// The end of the piece that begins at `at`.
    fn next(&self, at: &Waypoint, slowness_s_m: f64, range_m: f64) -> Waypoint {
        let level = self.profile().level(at.depth_m);
        let goes_down = at.direction.sin < 0.0 || at.direction.sin == 0.0 && at.depth_m <= 0.0;
        let mut layer = if goes_down { level.layer_below } else { level.layer_above };
        let mut gradient_1_s = self.profile().gradient_1_s(layer);
        if at.direction.sin == 0.0 {
            // A horizontal ray bends to where sound is slower; on a crest of speed it may go either way, and goes down.
            let below_1_s = self.profile().gradient_1_s(level.layer_below);
            let above_1_s = self.profile().gradient_1_s(level.layer_above);
            let falls = below_1_s < 0.0 && at.depth_m < self.bottom_depth_m();
            let rises = above_1_s > 0.0 && at.depth_m > 0.0;
            (layer, gradient_1_s) = match (falls, rises) {
                (true, _) => (level.layer_below, below_1_s),
                (false, true) => (level.layer_above, above_1_s),
                (false, false) => return at.horizontally_to(range_m),
            };
        }
        let down = -at.direction.sin;
        let is_bent_back = down * gradient_1_s > 0.0;
        let leaves_down = if down == 0.0 { gradient_1_s < 0.0 } else { down > 0.0 };
        let side = if leaves_down { Boundary::Bottom } else { Boundary::Surface };
        let limit_m = if leaves_down { self.bottom_depth_m() } else { 0.0 };
        let end = self.layer_end(layer, side, limit_m).unwrap_or_else(|| self.profile().level(limit_m));
        let end_cos = slowness_s_m * end.speed_m_s;
        let turns = is_bent_back && end_cos >= 1.0;
        let end_down = if turns { 0.0 } else { down_sine(end_cos, leaves_down) };
        let fall_1_m = slowness_s_m * gradient_1_s;
        let reached_m = if gradient_1_s == 0.0 {
            at.range_m + (end.depth_m - at.depth_m) / down * at.direction.cos
        } else {
            at.range_m + (down - end_down) / fall_1_m
        };
        let (range_m, end_down, depth_m) = if reached_m > range_m {
            let end_down = down - fall_1_m * (range_m - at.range_m);
            (range_m, end_down, at.depth_m + (range_m - at.range_m) * mean_slope(at, end_down))
        } else if turns {
            (reached_m, 0.0, at.depth_m + (reached_m - at.range_m) * mean_slope(at, 0.0))
        } else {
            (reached_m, end_down, end.depth_m)
        };
        let cos = ((1.0 - end_down) * (1.0 + end_down)).max(0.0).sqrt();
        Waypoint { range_m, depth_m, direction: Direction { cos, sin: -end_down } }
    }
}

impl Waypoint {
    fn horizontally_to(&self, range_m: f64) -> Self {
        Self { range_m, ..*self }
    }
}

/// The sine of the grazing angle, positive downwards, of a ray with this cosine.
fn down_sine(cos: f64, is_down: bool) -> f64 {
    let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
    if is_down { sin } else { -sin }
}

/// Depth gained per metre of range on the arc from a place to where the downward sine is `end_down`: the tangent of the mean
/// angle, `(s1 + s2) / (c1 + c2)`.
fn mean_slope(at: &Waypoint, end_down: f64) -> f64 {
    let end_cos = ((1.0 - end_down) * (1.0 + end_down)).max(0.0).sqrt();
    (-at.direction.sin + end_down) / (at.direction.cos + end_cos)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::acoustics::profile::Profile;

    fn waters() -> [WaterColumn; 5] {
        [
            WaterColumn::new(Profile::mixed_layer(300.0), 300.0),
            WaterColumn::new(Profile::summer_thermocline(200.0), 200.0),
            WaterColumn::new(Profile::arctic(500.0), 500.0),
            WaterColumn::new(Profile::munk(4000.0), 4000.0),
            WaterColumn::new(Profile::uniform(1500.0).unwrap(), 100.0),
        ]
    }

    proptest! {
        #[test]
        fn a_ray_that_was_found_leads_there(
            water in 0_usize..5, from in 0.0..1.0, to in 0.0..1.0, range_m in 1.0..8_000.0,
            first in prop::sample::select(vec![Boundary::Surface, Boundary::Bottom]), bounces in 0_u8..4,
        ) {
            let water = &waters()[water];
            let [from_m, to_m] = [from, to].map(|part: f64| part * water.bottom_depth_m());
            let found = match bounces {
                0 => water.direct(from_m, to_m, range_m, None),
                _ => water.bounced(first, bounces, from_m, to_m, range_m, None),
            };
            if let Some(found) = found {
                let ray = water.trace(from_m, found.departure, range_m, bounces.into());
                let end = ray.last().unwrap();
                // A ray near grazing feels the last bits of its direction.
                let tolerance_m = 1e-5 * range_m;
                prop_assert!((end.range_m - range_m).abs() < tolerance_m, "{found:?} {end:?}");
                prop_assert!((end.depth_m - to_m).abs() < tolerance_m, "{found:?} {end:?} {to_m}");
            }
        }

        #[test]
        fn a_ray_keeps_its_slowness_and_its_water(
            water in 0_usize..5, from in 0.0..1.0, sin in -0.99_f64..0.99, range_m in 1.0..20_000.0,
        ) {
            let water = &waters()[water];
            let from_m = from * water.bottom_depth_m();
            let departure = Direction { cos: (1.0 - sin * sin).sqrt(), sin };
            let ray = water.trace(from_m, departure, range_m, 8);
            let slowness = |at: &Waypoint| at.direction.cos / water.profile().speed_m_s(at.depth_m);
            prop_assert!(ray.len() >= 2);
            for pair in ray.windows(2) {
                prop_assert!(pair[1].range_m >= pair[0].range_m);
                prop_assert!((slowness(&pair[1]) / slowness(&ray[0]) - 1.0).abs() < 1e-9, "{pair:?}");
                prop_assert!((-1e-6..=water.bottom_depth_m() + 1e-6).contains(&pair[1].depth_m), "{pair:?}");
            }
        }
    }

    #[test]
    fn a_horizontal_ray_bends_to_slow_water() {
        let [_, thermocline, arctic, _, uniform] = waters();
        let horizontal = Direction { cos: 1.0, sin: 0.0 };
        let end =
            |water: &WaterColumn, depth_m| water.trace(depth_m, horizontal, 500.0, 0).last().unwrap().depth_m;
        assert!(end(&thermocline, 30.0) > 31.0);
        assert!(end(&arctic, 150.0) < 149.0);
        assert_eq!(end(&uniform, 50.0), 50.0);
    }

    #[test]
    fn what_is_no_ray_is_empty() {
        let [water, ..] = waters();
        let trace = |depth_m, cos, sin, range_m| water.trace(depth_m, Direction { cos, sin }, range_m, 3);
        assert!(!trace(10.0, 1.0, 0.0, 100.0).is_empty());
        for ray in [
            trace(-1.0, 1.0, 0.0, 100.0),
            trace(301.0, 1.0, 0.0, 100.0),
            trace(10.0, 0.0, 1.0, 100.0),
            trace(10.0, 1.0, 0.0, f64::INFINITY),
            trace(10.0, f64::NAN, 0.0, 100.0),
            trace(f64::NAN, 1.0, 0.0, 100.0),
        ] {
            assert!(ray.is_empty());
        }
    }
}
