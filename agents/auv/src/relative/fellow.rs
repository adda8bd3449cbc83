//! How far a neighbour can have moved.

use shoal_bus::message::{BodyBounds, Bounds, ClockBounds};
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::interval_box;
use crate::motion::{Motion, Stretch};

/// The motion of a body of which no more than bounds, and now and then the velocity over ground, is known. True time.
///
/// The velocity over ground is that through the water, which changes by no more than the acceleration allows, plus current and
/// disturbance, which may change at once within their bounds. So it stays within `A t` and the width of the latter of what it was.
#[derive(Clone, Debug)]
pub struct Fellow {
    /// Motion of a body that has the velocity told as its velocity through the water.
    motion: Motion,
    /// By how much current and disturbance may differ between two moments.
    change_m_s: IntervalBox<3>,
    /// Any velocity over ground.
    ground_m_s: IntervalBox<3>,
    acceleration_m_s2: f64,
}

impl Fellow {
    /// A body that keeps these bounds.
    pub fn new(body: &BodyBounds) -> Self {
        let drift_m_s = interval_box(&body.current_m_s) + interval_box(&body.disturbance_m_s);
        #[expect(clippy::eq_op, reason = "two moments of one set are not one moment")]
        let change_m_s = drift_m_s - drift_m_s;
        let ground_m_s = drift_m_s + IntervalBox::from([Interval::centred(0.0, body.speed_m_s); 3]);
        let none = [Bounds::default(); 3];
        let fastest_m_s =
            (ground_m_s + change_m_s).iter().fold(0.0, |most: f64, side| most.max(side.magnitude()));
        let stand_in = BodyBounds {
            speed_m_s: fastest_m_s,
            acceleration_m_s2: body.acceleration_m_s2,
            current_m_s: none,
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: change_m_s.sides().map(crate::bounds::bounds),
        };
        let true_time = ClockBounds { drift: 0.0, offset_s: Bounds::default(), stamp_ns: 0 };
        let motion = Motion::new(&stand_in, &true_time);
        Self { motion, change_m_s, ground_m_s, acceleration_m_s2: body.acceleration_m_s2 }
    }

    /// Any velocity over ground, in m/s.
    pub fn any_velocity(&self) -> IntervalBox<3> {
        self.ground_m_s
    }

    /// Displacement east and north, in metres, within `elapsed_s` true seconds from a moment with this velocity over ground.
    pub fn since(&self, before_m_s: &IntervalBox<3>, elapsed_s: Interval) -> IntervalBox<2> {
        self.displacement(before_m_s, None, elapsed_s)
    }

    /// The same between two moments with these velocities.
    pub fn between(
        &self,
        before_m_s: &IntervalBox<3>,
        after_m_s: &IntervalBox<3>,
        elapsed_s: Interval,
    ) -> IntervalBox<2> {
        self.displacement(before_m_s, Some(after_m_s), elapsed_s)
    }

    fn displacement(
        &self,
        before_m_s: &IntervalBox<3>,
        after_m_s: Option<&IntervalBox<3>>,
        elapsed_s: Interval,
    ) -> IntervalBox<2> {
        let elapsed_s = elapsed_s.intersection(Interval::NON_NEGATIVE);
        let at_any_m = self.ground_m_s.map(|side| side * elapsed_s);
        let length_s = elapsed_s.lower();
        // The rest, of which only bounds are known.
        let rest_s = (elapsed_s - length_s).intersection(Interval::NON_NEGATIVE);
        let by_then = (Interval::centred(0.0, self.acceleration_m_s2) * rest_s).magnitude();
        let stretch = Stretch {
            before_m_s: *before_m_s,
            after_m_s: after_m_s
                .map_or(IntervalBox::ENTIRE, |after_m_s| (*after_m_s + self.change_m_s).inflate(by_then)),
            current_m_s: IntervalBox::from([Interval::ZERO; 3]),
            length_s,
        };
        let moved_m = self.motion.over(&stretch, 0.0, length_s).displacement_m;
        let [x, y, _] = (moved_m + self.ground_m_s.map(|side| side * rest_s)).intersection(&at_any_m).sides();
        IntervalBox::from([x, y])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ACCELERATION_M_S2: f64 = 0.5;
    const SPEED_M_S: f64 = 2.0;
    const CURRENT_M_S: [f64; 2] = [0.1, 0.4];
    const DISTURBANCE_M_S: f64 = 0.2;

    fn fellow() -> Fellow {
        let none = Bounds::default();
        Fellow::new(&BodyBounds {
            speed_m_s: SPEED_M_S,
            acceleration_m_s2: ACCELERATION_M_S2,
            current_m_s: [Bounds::new(CURRENT_M_S[0], CURRENT_M_S[1]), none, none],
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: [Bounds::new(-DISTURBANCE_M_S, DISTURBANCE_M_S); 3],
        })
    }

    fn eastward(velocity_m_s: f64) -> IntervalBox<3> {
        IntervalBox::from([Interval::centred(velocity_m_s, 1e-9), Interval::ZERO, Interval::ZERO])
    }

    proptest! {
        /// Velocities told at both ends, and in between whatever acceleration, current and disturbance allow: mostly at a bound.
        #[test]
        fn no_admissible_motion_escapes(
            first_m_s in -2.0..2.0_f64,
            pushes in prop::collection::vec(prop::array::uniform3(-4.0..4.0_f64), 1..40),
            step_s in 0.01..0.5_f64,
            uncertain_s in (0.0..0.3_f64, 0.0..0.3_f64),
        ) {
            let (mut through_m_s, mut moved_m) = (first_m_s, 0.0);
            let drift_m_s = |push: &[f64; 3]| {
                let share = 0.5 + 0.5 * push[1].clamp(-1.0, 1.0);
                let current_m_s = CURRENT_M_S[0] + share * (CURRENT_M_S[1] - CURRENT_M_S[0]);
                current_m_s + DISTURBANCE_M_S * push[2].clamp(-1.0, 1.0)
            };
            let before = eastward(through_m_s + drift_m_s(&pushes[0]));
            for push in &pushes {
                let change_m_s = ACCELERATION_M_S2 * push[0].clamp(-1.0, 1.0) * step_s;
                let next_m_s = (through_m_s + change_m_s).clamp(-SPEED_M_S, SPEED_M_S);
                moved_m += (0.5 * (through_m_s + next_m_s) + drift_m_s(push)) * step_s;
                through_m_s = next_m_s;
            }
            // At a knot, whichever side of it: the drift of the last stretch, or any other.
            let after = eastward(through_m_s + drift_m_s(&pushes[pushes.len() / 2]));
            let length_s = step_s * pushes.len() as f64;
            let elapsed_s = Interval::spanning(length_s - uncertain_s.0, length_s + uncertain_s.1);
            let slack_m = 1e-7;
            let since_m = fellow().since(&before, elapsed_s);
            prop_assert!(since_m[0].inflate(slack_m).contains(moved_m), "{moved_m} in {}", since_m[0]);
            let between_m = fellow().between(&before, &after, elapsed_s);
            prop_assert!(between_m[0].inflate(slack_m).contains(moved_m), "{moved_m} in {}", between_m[0]);
            prop_assert!(between_m[0].width() <= since_m[0].width() + slack_m);
        }
    }

    #[test]
    fn a_drift_that_turns_at_once_is_inside() {
        // Told 1 m/s with all drift ahead, 0.6 m/s; from then on 0.1 m/s less the disturbance, so 0.7 m/s slower.
        let length_s = 0.4;
        let moved_m = fellow().since(&eastward(1.0), Interval::centred(length_s, 0.0));
        let slowest_m = (1.0 - 0.7) * length_s - 0.5 * ACCELERATION_M_S2 * length_s * length_s;
        assert!((moved_m[0].lower() - slowest_m).abs() < 1e-6, "{} for {slowest_m}", moved_m[0]);
    }
}
