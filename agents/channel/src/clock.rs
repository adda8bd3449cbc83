//! A true clock: the strictly increasing function h from true time to one AUV's local time, in exact integers.
//!
//! Between knots the rate `1 + n_h` is constant, a multiple of 2⁻⁴⁰ with `|n_h| <= d` (seed 001, equation 5.2 v), so h is
//! piecewise linear and all its values are exact: no digest depends on rounding here.

use std::collections::VecDeque;

use shoal_bus::message::AuvId;
use shoal_bus::time::{LocalTime, SimTime};
use shoal_scenario::model::{Clock as ClockModel, Noise};

use crate::draw::{Draws, Purpose};

/// Fraction bits of local time and of the rate.
const FRACTION: u32 = 40;
const ONE: i128 = 1 << FRACTION;

/// Bound of the difference between a stamp and h at the stamped event: the stamp's own nanosecond, and that an action named
/// for a local time happens at a whole nanosecond of true time.
pub const STAMP_NS: i64 = 2;

/// One AUV's clock.
pub struct TrueClock {
    knot_ns: i64,
    drift_bound: f64,
    constant: f64,
    wander: f64,
    wander_bound: f64,
    draws: Draws,
    /// Index of the first remembered knot.
    first: i64,
    /// h at the knots, with `FRACTION` bits, and the rate after each, less one, with as many.
    knots: VecDeque<(i128, i64)>,
}

impl TrueClock {
    /// The clock of `auv`: at true time zero it reads an offset drawn inside its bound.
    pub fn new(model: &ClockModel, knot_ns: i64, seed: u64, auv: AuvId, noise: Noise) -> Self {
        let mut draws = Draws::new(seed, Purpose::Clock, auv, noise);
        let offset_ns = (draws.error(model.offset_bound_s) * 1e9) as i64;
        let constant = draws.error(model.drift_bound * (1.0 - model.wander_fraction));
        let mut clock = Self {
            knot_ns,
            drift_bound: model.drift_bound,
            constant,
            wander: 0.0,
            wander_bound: model.drift_bound * model.wander_fraction,
            draws,
            first: 0,
            knots: VecDeque::new(),
        };
        let rate = clock.next_rate();
        clock.knots.push_back((i128::from(offset_ns) * ONE, rate));
        clock
    }

    /// What the clock reads at `t`.
    pub fn read(&mut self, t: SimTime) -> LocalTime {
        LocalTime::from_ns((self.exact(t) >> FRACTION) as i64)
    }

    /// True time minus exact local time at `t`, in seconds, rounded to the nearest `f64`.
    pub fn offset_s(&mut self, t: SimTime) -> f64 {
        (i128::from(t.ns()) * ONE - self.exact(t)) as f64 / ONE as f64 / 1e9
    }

    /// The first whole nanosecond of true time, not before zero, at which the clock has reached `local`.
    pub fn reaches(&mut self, local: LocalTime) -> SimTime {
        let target = i128::from(local.ns()) * ONE;
        while self.knots.back().is_some_and(|&(value, _)| value < target) {
            self.extend();
        }
        let after = self.knots.partition_point(|&(value, _)| value < target);
        let Some(before) = after.checked_sub(1) else {
            return SimTime::from_ns(self.first * self.knot_ns);
        };
        let (value, rate) = self.knots[before];
        let slope = ONE + i128::from(rate);
        let ns = (target - value + slope - 1) / slope;
        SimTime::from_ns((self.first + before as i64) * self.knot_ns + ns as i64)
    }

    /// Forgets what lies before `t`; it will not be asked again.
    pub fn forget_before(&mut self, t: SimTime) {
        while self.knots.len() > 1 && (self.first + 1) * self.knot_ns <= t.ns() {
            self.knots.pop_front();
            self.first += 1;
        }
    }

    fn exact(&mut self, t: SimTime) -> i128 {
        let index = t.ns().div_euclid(self.knot_ns);
        while self.first + (self.knots.len() as i64) <= index {
            self.extend();
        }
        let (value, rate) = self.knots[(index - self.first) as usize];
        value + i128::from(t.ns() - index * self.knot_ns) * (ONE + i128::from(rate))
    }

    fn extend(&mut self) {
        let rate_after = self.next_rate();
        if let Some(&(value, rate)) = self.knots.back() {
            let next = value + i128::from(self.knot_ns) * (ONE + i128::from(rate));
            self.knots.push_back((next, rate_after));
        }
    }

    /// The rate of the next knot, less one: the constant part plus a bounded random walk.
    fn next_rate(&mut self) -> i64 {
        let step = self.draws.error(0.05 * self.wander_bound);
        self.wander = (self.wander + step).clamp(-self.wander_bound, self.wander_bound);
        let limit = (self.drift_bound * ONE as f64).floor() as i64;
        (((self.constant + self.wander) * ONE as f64) as i64).clamp(-limit, limit)
    }
}

#[cfg(test)]
mod tests {
    use shoal_scenario::presets;

    use super::*;

    fn clock(drift_bound: f64, noise: Noise, auv: u32) -> TrueClock {
        let model = ClockModel { drift_bound, wander_fraction: 0.5, offset_bound_s: 0.25 };
        TrueClock::new(&model, 10_000_000, 11, AuvId(auv), noise)
    }

    #[test]
    fn rate_keeps_its_bound_and_reading_inverts_reaching() {
        for (auv, noise) in (0..8).zip([Noise::Uniform, Noise::Adversarial].into_iter().cycle()) {
            let mut clock = clock(0.1, noise, auv);
            let mut previous = clock.exact(SimTime::ZERO);
            for step in 1..3_000i64 {
                let t = SimTime::from_ns(step * 3_333_333);
                let now = clock.exact(t);
                let advance = (now - previous) as f64 / ONE as f64 / 3_333_333.0;
                assert!((0.9..=1.1).contains(&advance), "{advance}");
                previous = now;
                let local = clock.read(t);
                let reached = clock.reaches(local);
                assert!(reached <= t && t - reached <= 1, "{t} {reached}");
                assert!(clock.read(reached) >= local && clock.read(reached + -1) < local);
            }
        }
    }

    #[test]
    fn forgetting_changes_nothing_later() {
        let (mut whole, mut forgetful) = (clock(1e-4, Noise::Uniform, 5), clock(1e-4, Noise::Uniform, 5));
        for step in 0..2_000i64 {
            let t = SimTime::from_ns(step * 7_000_001);
            forgetful.forget_before(t);
            assert_eq!(whole.read(t), forgetful.read(t));
            let local = whole.read(t);
            assert_eq!(whole.reaches(local), forgetful.reaches(local));
        }
        assert!(forgetful.knots.len() < 5);
    }

    #[test]
    fn clocks_of_scenarios_keep_their_bounds_and_no_more() {
        let custom = ClockModel { drift_bound: 2e-3, wander_fraction: 1.0, offset_bound_s: 3.0 };
        let named = presets::CLOCKS.iter().map(|(name, model)| (*name, model.clone()));
        let mut names = Vec::new();
        for (name, model) in named.chain([("custom", custom)]) {
            let mut fastest = 0.0_f64;
            for auv in 0..20 {
                let mut clock = TrueClock::new(&model, 10_000_000, 4, AuvId(auv), Noise::Adversarial);
                let start_s = clock.offset_s(SimTime::ZERO);
                assert!(start_s.abs() <= model.offset_bound_s, "{name} starts {start_s} s off");
                let (mut last_t, mut last) = (SimTime::ZERO, clock.exact(SimTime::ZERO));
                for step in 1..=100i64 {
                    let t = SimTime::from_ns(step * 987_654_321);
                    let now = clock.exact(t);
                    // Exact integers, so that even the drift of an atomic clock is not lost in rounding.
                    let gained = (now - last) - i128::from(t - last_t) * ONE;
                    let drift = gained as f64 / ONE as f64 / (t - last_t) as f64;
                    assert!(drift.abs() <= model.drift_bound, "{name} drifts by {drift}");
                    fastest = fastest.max(drift.abs());
                    (last_t, last) = (t, now);
                    clock.forget_before(t);
                }
            }
            assert!(fastest >= 0.5 * model.drift_bound, "{name} never drifts faster than {fastest}");
            names.push(name);
        }
        assert_eq!(names, ["ideal", "quartz", "tcxo", "ocxo", "csac", "custom"]);
    }
}
