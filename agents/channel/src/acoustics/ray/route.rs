//! Where a ray passes: stretches of depth, how often it crosses each, and where it turns.
//!
//! A ray of horizontal slowness `p` has the grazing sine `s = sqrt(1 - p² c²)` where the speed is `c`. Let `V` be the greatest speed on
//! its way that it has to pass, and `w` the tangent of its grazing angle there: `p = 1 / (V sqrt(1 + w²))`. All sums are
//! taken over `σ = s / (p V) = sqrt(w² + e)`, `e = (V² - c²) / V²`, which loses no digits however flat or steep the ray is. A layer of depth `h`
//! between the speeds `a` and `b` takes the horizontal distance `(a + b) h / (V (σ_a + σ_b))`: no gradient divides, so a
//! uniform layer is no special case.

use super::arc::Arc;
use crate::acoustics::profile::{Level, Node, Profile};

/// Stands for a grazing tangent of zero where zero itself would divide.
pub(super) const GRAZING: f64 = 1e-100;

/// Stands for an infinite grazing tangent.
const STEEPEST: f64 = 1e90;

/// A stretch of depth between two levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<'a> {
    top: Node,
    bottom: Node,
    nodes: &'a [Node],
    gradients_1_s: &'a [f64],
    /// How often the ray passes it.
    crossings: f64,
}

impl<'a> Stretch<'a> {
    pub fn new(profile: &'a Profile, top: &Level, bottom: &Level, crossings: f64) -> Self {
        let node = |level: &Level| Node { depth_m: level.depth_m, speed_m_s: level.speed_m_s };
        Self {
            top: node(top),
            bottom: node(bottom),
            nodes: profile.nodes_between(top, bottom),
            gradients_1_s: profile.gradients_between_1_s(top, bottom),
            crossings: if top.depth_m < bottom.depth_m { crossings } else { 0.0 },
        }
    }

    /// Calls `visit` with the end of each layer and the layer's gradient, downwards.
    #[inline(always)]
    fn descend(&self, mut visit: impl FnMut(&Node, f64)) {
        let ends = self.nodes.iter().chain(std::iter::once(&self.bottom));
        for (end, &gradient_1_s) in ends.zip(self.gradients_1_s) {
            visit(end, gradient_1_s);
        }
    }
}

/// A half turn at the far end of a route, inside one layer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Speed of sound where the ray enters the layer and leaves it again, in m/s.
    pub entry_m_s: f64,
    /// Absolute gradient of the layer, in 1/s.
    pub gradient_1_s: f64,
}

/// All that a ray passes between emitter and receiver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Route<'a> {
    stretches: &'a [Stretch<'a>],
    turn: Option<Turn>,
    /// V, in m/s.
    speed_m_s: f64,
}

/// What a ray does all the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Traced {
    pub range_m: f64,
    /// Derivative of the range with respect to `w`.
    pub slope_m: f64,
    pub travel_s: f64,
    pub length_m: f64,
}

/// The first terms of the range of steep rays: `range = reach / w (1 - bend / (4 w²) + ...)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steep {
    pub reach_m: f64,
    pub bend: f64,
}

impl<'a> Route<'a> {
    /// The route through `stretches` without a turn in the water, and the range of its steep rays.
    #[inline]
    pub fn along(stretches: &'a [Stretch<'a>]) -> (Self, Steep) {
        let (mut speed_m_s, mut area, mut squares) = (0.0_f64, 0.0, 0.0);
        for stretch in stretches.iter().filter(|stretch| stretch.crossings > 0.0) {
            let mut upper = stretch.top;
            speed_m_s = speed_m_s.max(upper.speed_m_s);
            stretch.descend(|lower, _| {
                let share =
                    stretch.crossings * (upper.speed_m_s + lower.speed_m_s) * (lower.depth_m - upper.depth_m);
                area += share;
                squares += share * (upper.speed_m_s * upper.speed_m_s + lower.speed_m_s * lower.speed_m_s);
                speed_m_s = speed_m_s.max(lower.speed_m_s);
                upper = *lower;
            });
        }
        let bend = (2.0 - squares / (speed_m_s * speed_m_s * area)).max(0.0);
        (Self { stretches, turn: None, speed_m_s }, Steep { reach_m: 0.5 * area / speed_m_s, bend })
    }

    /// The route through `stretches` to a turn and back; `speed_m_s` is the greatest speed before the turn.
    pub fn turning(stretches: &'a [Stretch<'a>], turn: Turn, speed_m_s: f64) -> Self {
        Self { stretches, turn: Some(turn), speed_m_s }
    }

    fn passed(&self) -> impl Iterator<Item = &Stretch<'a>> {
        self.stretches.iter().filter(|stretch| stretch.crossings > 0.0)
    }

    /// `e` at a speed.
    #[inline(always)]
    fn excess(&self, speed_m_s: f64) -> f64 {
        let v_m_s = self.speed_m_s;
        (v_m_s - speed_m_s) * (v_m_s + speed_m_s) / (v_m_s * v_m_s)
    }

    /// Horizontal slowness in s/m of the ray with the grazing tangent `w` at `V`.
    pub fn slowness_s_m(&self, w: f64) -> f64 {
        1.0 / (self.speed_m_s * (1.0 + w * w).sqrt())
    }

    /// Cosine of the grazing angle at `V`.
    pub fn cosine(&self, w: f64) -> f64 {
        1.0 / (1.0 + w * w).sqrt()
    }

    /// `w` of the ray with a horizontal slowness: zero for the grazing one, NaN for those that turn before.
    pub fn tangent(&self, slowness_s_m: f64) -> f64 {
        let flat = slowness_s_m * self.speed_m_s;
        ((1.0 - flat) * (1.0 + flat)).sqrt() / flat
    }

    /// Sine of the grazing angle where the speed is `speed_m_s`.
    pub fn sine(&self, w: f64, speed_m_s: f64) -> f64 {
        if w < 1.0 {
            ((w * w + self.excess(speed_m_s)) / (1.0 + w * w)).sqrt()
        } else {
            let flat = self.slowness_s_m(w) * speed_m_s;
            (1.0 - flat * flat).sqrt()
        }
    }

    /// Range in metres of the ray with `w`, not zero, and its derivative.
    #[inline]
    pub fn range_m(&self, w: f64) -> (f64, f64) {
        let square = w * w;
        let scale = 1.0 / (self.speed_m_s * self.speed_m_s);
        let sigma = |speed_m_s: f64| {
            (square + (self.speed_m_s - speed_m_s) * (self.speed_m_s + speed_m_s) * scale).sqrt()
        };
        let (mut range, mut slope) = (0.0, 0.0);
        for stretch in self.passed() {
            let mut upper = stretch.top;
            let mut upper_sigma = sigma(upper.speed_m_s);
            let (mut part, mut part_slope) = (0.0, 0.0);
            stretch.descend(|lower, _| {
                let lower_sigma = sigma(lower.speed_m_s);
                let product = upper_sigma * lower_sigma;
                let share = (upper.speed_m_s + lower.speed_m_s) * (lower.depth_m - upper.depth_m)
                    / ((upper_sigma + lower_sigma) * product);
                part += share * product;
                part_slope += share;
                (upper, upper_sigma) = (*lower, lower_sigma);
            });
            range += stretch.crossings * part;
            slope += stretch.crossings * part_slope;
        }
        let (mut range_m, mut slope_m) = (range / self.speed_m_s, -w * slope / self.speed_m_s);
        if let Some(turn) = &self.turn {
            let (radius_m, entry) = (self.speed_m_s / turn.gradient_1_s, sigma(turn.entry_m_s));
            range_m += 2.0 * radius_m * entry;
            slope_m += 2.0 * radius_m * w / entry;
        }
        (range_m, slope_m)
    }

    /// What the ends of a stretch of tangents tell about all rays in between.
    ///
    /// Over `u = w²`, what the layers contribute is a falling convex function, which lies above its tangents, and what the turn
    /// contributes is a growing concave one, which lies above its chord.
    pub fn bounds(&self, least: f64, most: f64) -> Bounds {
        let scale = 1.0 / (self.speed_m_s * self.speed_m_s);
        let (first_square, last_square) = (least * least, most * most);
        let both = |speed_m_s: f64| {
            let excess = (self.speed_m_s - speed_m_s) * (self.speed_m_s + speed_m_s) * scale;
            ((first_square + excess).sqrt(), (last_square + excess).sqrt())
        };
        // Range and derivative with respect to u, negative, at both ends; and how fast the range may fall with w.
        let (mut first, mut first_fall, mut last, mut last_fall) = (0.0, 0.0, 0.0, 0.0);
        let (mut steepest, mut mildest) = (0.0, 0.0);
        for stretch in self.passed() {
            let mut upper = stretch.top;
            let mut upper_sigma = both(upper.speed_m_s);
            stretch.descend(|lower, _| {
                let lower_sigma = both(lower.speed_m_s);
                let products = (upper_sigma.0 * lower_sigma.0, upper_sigma.1 * lower_sigma.1);
                let share =
                    stretch.crossings * (upper.speed_m_s + lower.speed_m_s) * (lower.depth_m - upper.depth_m);
                let first_share = share / ((upper_sigma.0 + lower_sigma.0) * products.0);
                let last_share = share / ((upper_sigma.1 + lower_sigma.1) * products.1);
                first += first_share * products.0;
                last += last_share * products.1;
                first_fall += first_share;
                last_fall += last_share;
                // w <= σ bounds w / σ where σ may vanish.
                steepest += first_share * most.min(upper_sigma.0.min(lower_sigma.0));
                // The derivative has one extreme, so it is least steep at an end.
                mildest += (least * first_share).min(most * last_share);
                (upper, upper_sigma) = (*lower, lower_sigma);
            });
        }
        let over_speed = 1.0 / self.speed_m_s;
        let (first_m, last_m) = (first * over_speed, last * over_speed);
        let (first_fall_m, last_fall_m) = (0.5 * first_fall * over_speed, 0.5 * last_fall * over_speed);
        let mut slopes_m = (-steepest * over_speed, -mildest * over_speed);
        let (mut first_turn_m, mut last_turn_m) = (0.0, 0.0);
        if let Some(turn) = &self.turn {
            let (diameter_m, entry) = (2.0 * self.speed_m_s / turn.gradient_1_s, both(turn.entry_m_s));
            (first_turn_m, last_turn_m) = (diameter_m * entry.0, diameter_m * entry.1);
            slopes_m.0 += diameter_m * least / entry.0;
            slopes_m.1 += diameter_m * most / entry.1;
        }
        let ends_m = (first_m + first_turn_m, last_m + last_turn_m);
        // Where the tangents at both ends meet.
        let width = last_square - first_square;
        let meeting =
            ((first_m - last_m - last_fall_m * width) / (first_fall_m - last_fall_m)).clamp(0.0, width);
        let met_m = last_m
            + last_fall_m * (width - meeting)
            + first_turn_m
            + (last_turn_m - first_turn_m) * meeting / width;
        let fall_m = (slopes_m.0 * (most - least)).min(0.0);
        let rise_m = (slopes_m.1 * (most - least)).max(0.0);
        Bounds {
            ends_m,
            range_m: (
                ends_m.0.min(ends_m.1).min(met_m).max(ends_m.0 + fall_m),
                (ends_m.0 + rise_m).min(first_m + last_turn_m),
            ),
            slope_m: slopes_m,
        }
    }

    /// Follows the ray with `w`, not zero.
    #[inline]
    pub fn trace(&self, w: f64) -> Traced {
        // The plumb line has an infinite tangent, which would multiply with zero.
        let w = w.min(STEEPEST);
        let square = w * w;
        let scale = 1.0 / (self.speed_m_s * self.speed_m_s);
        let sigma = |speed_m_s: f64| {
            (square + (self.speed_m_s - speed_m_s) * (self.speed_m_s + speed_m_s) * scale).sqrt()
        };
        let over_speed = 1.0 / self.speed_m_s;
        let mut traced = Traced { range_m: 0.0, slope_m: 0.0, travel_s: 0.0, length_m: 0.0 };
        for stretch in self.passed() {
            let mut upper = stretch.top;
            let mut upper_sigma = sigma(upper.speed_m_s);
            stretch.descend(|lower, gradient_1_s| {
                let lower_sigma = sigma(lower.speed_m_s);
                let product = upper_sigma * lower_sigma;
                let depth_m = lower.depth_m - upper.depth_m;
                let speeds_m_s = upper.speed_m_s + lower.speed_m_s;
                let share = over_speed * speeds_m_s * depth_m / ((upper_sigma + lower_sigma) * product);
                let arc =
                    Arc { range_m: share * product, depth_m, mean_speed_m_s: 0.5 * speeds_m_s, gradient_1_s };
                let (travel_s, length_m) = arc.measure();
                traced.range_m += stretch.crossings * arc.range_m;
                traced.slope_m -= stretch.crossings * w * share;
                traced.travel_s += stretch.crossings * travel_s;
                traced.length_m += stretch.crossings * length_m;
                (upper, upper_sigma) = (*lower, lower_sigma);
            });
        }
        if let Some(turn) = &self.turn {
            let (diameter_m, entry) = (2.0 * self.speed_m_s / turn.gradient_1_s, sigma(turn.entry_m_s));
            let arc = Arc {
                range_m: diameter_m * entry,
                depth_m: 0.0,
                mean_speed_m_s: turn.entry_m_s,
                gradient_1_s: turn.gradient_1_s,
            };
            let (travel_s, length_m) = arc.measure();
            traced.range_m += arc.range_m;
            traced.slope_m += diameter_m * w / entry;
            traced.travel_s += travel_s;
            traced.length_m += length_m;
        }
        traced
    }
}

/// What is known of the range of all rays between two grazing tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The ranges at the least and at the greatest tangent, in metres.
    pub ends_m: (f64, f64),
    /// No ray in between has less range, none more, in metres.
    pub range_m: (f64, f64),
    /// The derivative lies between these.
    pub slope_m: (f64, f64),
}
