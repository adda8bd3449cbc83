//! How far an AUV can have moved: velocities between two looks at the log, integrated without losing any.
//!
//! The velocity through the water changes by at most `A` per true second. Known at the ends of a stretch of local time, it is
//! caught in between under two sloping lines from either end; the integral of that roof is exact and much smaller than that of
//! the highest velocity.

mod passage;

use shoal_bus::message::{BodyBounds, ClockBounds};
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::interval_box;

pub use self::passage::Passage;

/// What is certain about the own motion and clock.
#[derive(Clone, Debug)]
pub struct Motion {
    speed_m_s: Interval,
    /// Change of velocity per local second, at most, in m/s².
    slope: f64,
    /// The current anywhere.
    current_m_s: IntervalBox<3>,
    disturbance_m_s: IntervalBox<3>,
    /// Any velocity over ground, in m/s.
    ground_m_s: IntervalBox<3>,
    /// `dt/ds - 1`: true seconds gained per local second.
    gain: Interval,
    /// Bound of `dt/ds`.
    fastest: f64,
    stamp_s: f64,
}

/// A stretch of local time with what is known of the velocity through the water at its ends, and of the current.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// Velocity at its beginning, in m/s.
    pub before_m_s: IntervalBox<3>,
    /// Velocity at its end, in m/s; the entire space when nothing is known yet.
    pub after_m_s: IntervalBox<3>,
    /// The current met all along it, in m/s.
    pub current_m_s: IntervalBox<3>,
    /// Local seconds from beginning to end.
    pub length_s: f64,
}

/// What happened during a part of a stretch.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Displacement from the part's beginning to its end, in metres.
    pub displacement_m: IntervalBox<3>,
    /// Displacement between any two moments of the part, the earlier first, in metres.
    pub within_m: IntervalBox<3>,
    /// Change of true minus local time from the part's beginning to its end, in seconds.
    pub offset_gain_s: Interval,
    /// The same between any two moments of it, in seconds.
    pub offset_within_s: Interval,
}

impl Motion {
    /// The motion that these bounds allow.
    pub fn new(body: &BodyBounds, clock: &ClockBounds) -> Self {
        let one = Interval::ONE;
        let drift = Interval::centred(0.0, clock.drift);
        // 1 / (1 + n) - 1 for |n| <= drift.
        let gain = one / (one + drift) - one;
        let fastest = (one + gain).upper();
        let speed_m_s = Interval::centred(0.0, body.speed_m_s);
        let current_m_s = interval_box(&body.current_m_s);
        let disturbance_m_s = interval_box(&body.disturbance_m_s);
        Self {
            speed_m_s,
            slope: (body.acceleration_m_s2 * fastest).next_up(),
            current_m_s,
            disturbance_m_s,
            ground_m_s: IntervalBox::from([speed_m_s; 3]) + (current_m_s + disturbance_m_s),
            gain,
            fastest,
            stamp_s: clock.stamp_ns as f64 * 1e-9,
        }
    }

    /// Any velocity through the water that the body can have, in m/s.
    pub fn any_velocity(&self) -> IntervalBox<3> {
        IntervalBox::from([self.speed_m_s; 3])
    }

    /// The velocities through the water that are possible `elapsed_s` local seconds from a moment with velocity `known_m_s`.
    pub fn velocity_after(&self, known_m_s: &IntervalBox<3>, elapsed_s: f64) -> IntervalBox<3> {
        known_m_s.inflate(self.slope * self.longest(elapsed_s)).intersection(&self.any_velocity())
    }

    /// The current anywhere, in m/s.
    pub fn any_current(&self) -> IntervalBox<3> {
        self.current_m_s
    }

    /// Velocity over ground, in m/s, from that through the water and the current.
    pub fn over_ground(&self, velocity_m_s: &IntervalBox<3>, current_m_s: &IntervalBox<3>) -> IntervalBox<3> {
        *velocity_m_s + (*current_m_s + self.disturbance_m_s)
    }

    /// The most true seconds between two stamped moments that are `elapsed_s` apart by their stamps.
    pub fn true_s(&self, elapsed_s: f64) -> f64 {
        (self.longest(elapsed_s) * self.fastest).next_up()
    }

    /// Any displacement over ground within `elapsed_s` local seconds, forward or backward, in metres.
    pub fn anywhere_within(&self, elapsed_s: f64) -> IntervalBox<3> {
        self.ground_m_s * Interval::centred(0.0, self.longest(elapsed_s) * self.fastest)
    }

    /// Change of true minus local time within `elapsed_s` local seconds, in seconds.
    pub fn offset_gain(&self, elapsed_s: f64) -> Interval {
        self.gain * around(elapsed_s, self.stamp_s)
    }

    /// What bounds the motion along `stretch`, for many questions about it.
    pub fn along(&self, stretch: &Stretch) -> Passage {
        Passage::new(self, stretch)
    }

    /// What can have happened from `from_s` to `to_s` local seconds after the beginning of `stretch`.
    pub fn over(&self, stretch: &Stretch, from_s: f64, to_s: f64) -> Moved {
        self.along(stretch).over(from_s, to_s)
    }

    fn longest(&self, elapsed_s: f64) -> f64 {
        around(elapsed_s.abs(), self.stamp_s).upper()
    }
}

/// Local seconds between two stamped moments that are `elapsed_s` apart by their stamps, each of which is off by `stamp_s` at most.
fn around(elapsed_s: f64, stamp_s: f64) -> Interval {
    Interval::centred(elapsed_s, 2.0 * stamp_s + elapsed_s.abs() * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use shoal_bus::message::Bounds;

    use super::*;

    const ACCELERATION_M_S2: f64 = 3.0;
    const DRIFT: f64 = 0.05;

    fn motion() -> Motion {
        let none = [Bounds::new(0.0, 0.0); 3];
        let body = BodyBounds {
            speed_m_s: 4.0,
            acceleration_m_s2: ACCELERATION_M_S2,
            current_m_s: [Bounds::new(0.2, 0.3), none[1], none[2]],
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: [Bounds::new(-0.1, 0.1); 3],
        };
        let clock = ClockBounds { drift: DRIFT, offset_s: none[0], stamp_ns: 2 };
        Motion::new(&body, &clock)
    }

    fn around(value: f64, error: f64) -> IntervalBox<3> {
        IntervalBox::from([Interval::centred(value, error), Interval::ZERO, Interval::ZERO])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        /// A body speeds up and slows down as its bounds allow, on a clock that runs fast and slow as its bounds allow: where
        /// it gets to, and the time it takes, are enclosed over any part of the stretch.
        #[test]
        fn no_admissible_motion_escapes(
            first in -3.0..3.0_f64,
            pushes in prop::collection::vec((-1.0..=1.0_f64, -1.0..=1.0_f64, -1.0..=1.0_f64), 64),
            errors in (0.0..0.2_f64, 0.0..0.2_f64),
            ends in (0usize..64, 0usize..64),
            step_s in 0.0005..0.02_f64,
        ) {
            let (from, to) = (ends.0.min(ends.1), ends.0.max(ends.1) + 1);
            let (mut velocity, mut moved_m, mut gained_s) = (first, 0.0, 0.0);
            let mut part_m = 0.0;
            let mut part_gain_s = 0.0;
            for (index, &(push, rate, noise)) in pushes.iter().enumerate() {
                // dt = ds / (1 + n)
                let true_s = step_s / (1.0 + DRIFT * rate);
                let change = (ACCELERATION_M_S2 * push * true_s).clamp(-4.0 - velocity, 4.0 - velocity);
                let drift = 0.25 + 0.05 * rate + 0.1 * noise;
                let step_m = (velocity + 0.5 * change + drift) * true_s;
                if (from..to).contains(&index) {
                    part_m += step_m;
                    part_gain_s += true_s - step_s;
                }
                velocity += change;
                moved_m += step_m;
                gained_s += true_s - step_s;
            }
            let stretch = Stretch {
                before_m_s: around(first, errors.0),
                after_m_s: around(velocity, errors.1),
                current_m_s: motion().current_m_s,
                length_s: 64.0 * step_s,
            };
            let motion = motion();
            let whole = motion.over(&stretch, 0.0, 64.0 * step_s);
            prop_assert!(whole.displacement_m[0].contains(moved_m), "{moved_m} in {}", whole.displacement_m[0]);
            prop_assert!(whole.offset_gain_s.contains(gained_s));
            let part = motion.over(&stretch, from as f64 * step_s, to as f64 * step_s);
            prop_assert!(part.displacement_m[0].contains(part_m), "{part_m} in {}", part.displacement_m[0]);
            prop_assert!(part.within_m[0].contains(part_m) && part.within_m[0].contains(0.0));
            prop_assert!(part.offset_gain_s.contains(part_gain_s));
            let unknown_end = Stretch { after_m_s: IntervalBox::ENTIRE, ..stretch };
            prop_assert!(motion.over(&unknown_end, 0.0, 64.0 * step_s).displacement_m[0].contains(moved_m));
            prop_assert!(motion.velocity_after(&stretch.before_m_s, 64.0 * step_s)[0].contains(velocity));
        }
    }

    #[test]
    fn the_roof_is_worth_its_price() {
        // Known 2 m/s at both ends of 0.2 s: the mean cannot be off by more than a quarter of acceleration times length.
        let (known_m_s, current_m_s) = (around(2.0, 0.0), motion().current_m_s);
        let stretch = Stretch { before_m_s: known_m_s, after_m_s: known_m_s, current_m_s, length_s: 0.2 };
        let steady = Motion { gain: Interval::ZERO, fastest: 1.0, slope: ACCELERATION_M_S2, ..motion() };
        let moved = steady.over(&stretch, 0.0, 0.2);
        let without_drift = moved.displacement_m[0].width() - 0.2 * (0.1 + 0.2);
        assert!((without_drift - 2.0 * 0.25 * ACCELERATION_M_S2 * 0.2 * 0.2).abs() < 1e-6, "{without_drift}");
    }
}
