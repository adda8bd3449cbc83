//! The current that an AUV meets: somewhere in the box it was told, and known better where it measures its way over ground.
//!
//! A Doppler velocity log sees the velocity over ground, a speed log that through the water: between them are the current and the
//! disturbance, `R(heading, pitch) (w - (v, 0, 0)) = current + disturbance`, with w over ground in the axes of the body. The
//! disturbance is noise that may jump anywhere in its box, so all of its box is taken off. What is left holds the current
//! at that moment.
//!
//! The current c that the moving body meets changes by at most `L dt + S` within `dt` true seconds, per axis; the step S is there
//! because the simulator's current is that of the last knot. Then there is a steady part g of slope L at most with
//! `|c - g| <= S / 2`, namely `g(t) = S / 2 + inf over r of (c(r) + L |t - r|)`: at most `c(t) + S / 2` by `r = t`, at least
//! `c(t) - S / 2` by the bound. So g is what is remembered: it widens with time by its slope, and the step is paid for once,
//! not at every tick.

use nalgebra::Vector3;
use shoal_bus::message::{BodyBounds, Measured};
use shoal_interval::IntervalBox;

use crate::bounds::{interval_box, measured};

/// What is known of the current at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Current {
    told_m_s: IntervalBox<3>,
    change_m_s2: Vector3<f64>,
    half_step_m_s: Vector3<f64>,
    disturbance_m_s: IntervalBox<3>,
    steady_m_s: IntervalBox<3>,
}

impl Current {
    /// What the AUV was told.
    pub fn new(body: &BodyBounds) -> Self {
        let told_m_s = interval_box(&body.current_m_s);
        let half_step_m_s = Vector3::from(body.current_step_m_s) * 0.5;
        Self {
            told_m_s,
            change_m_s2: Vector3::from(body.current_change_m_s2),
            half_step_m_s,
            disturbance_m_s: interval_box(&body.disturbance_m_s),
            steady_m_s: told_m_s.inflate_axes(&half_step_m_s),
        }
    }

    /// Encloses the current at any moment up to `elapsed_s` true seconds from this one, before or after, in m/s.
    pub fn within(&self, elapsed_s: f64) -> IntervalBox<3> {
        let steady_m_s = self.steady_m_s.inflate_axes(&self.change_m_s(elapsed_s));
        steady_m_s.inflate_axes(&self.half_step_m_s).intersection(&self.told_m_s)
    }

    /// The same, `elapsed_s` true seconds later at most.
    pub fn later(&self, elapsed_s: f64) -> Self {
        let steady_m_s = self.steady_m_s.inflate_axes(&self.change_m_s(elapsed_s));
        Self { steady_m_s: steady_m_s.intersection(&self.forgotten().steady_m_s), ..*self }
    }

    /// Contracts by current plus disturbance, in m/s. None if nothing is left.
    pub fn contracted(&self, drift_m_s: &IntervalBox<3>) -> Option<Self> {
        let current_m_s = self.within(0.0).intersection(&(*drift_m_s - self.disturbance_m_s));
        let steady_m_s = current_m_s.inflate_axes(&self.half_step_m_s).intersection(&self.steady_m_s);
        (!steady_m_s.is_empty()).then_some(Self { steady_m_s, ..*self })
    }

    /// Forgets all but what was told.
    pub fn forgotten(&self) -> Self {
        Self { steady_m_s: self.told_m_s.inflate_axes(&self.half_step_m_s), ..*self }
    }

    /// How far the steady part can have moved, at most; a product is rounded, so one step more.
    fn change_m_s(&self, elapsed_s: f64) -> Vector3<f64> {
        self.change_m_s2.map(|change_m_s2| (change_m_s2 * elapsed_s).next_up())
    }
}

/// Current plus disturbance at one moment in m/s: what a Doppler velocity log sees besides the velocity through the water, turned
/// from the axes of the body, forward `(cos p cos h, cos p sin h, sin p)`, port `(-sin h, cos h, 0)` and up = forward x port,
/// to those of the world.
pub fn drift(
    heading_rad: Measured,
    pitch_rad: Measured,
    speed_m_s: Measured,
    over_ground_m_s: &[Measured; 3],
) -> IntervalBox<3> {
    let (sin_heading, cos_heading) = measured(heading_rad).sin_cos();
    let (sin_pitch, cos_pitch) = measured(pitch_rad).sin_cos();
    let [forward, port, up] = over_ground_m_s.map(measured);
    // Before turning: the attitude's error then weighs on the small difference only.
    let forward = forward - measured(speed_m_s);
    let level = forward * cos_pitch - up * sin_pitch;
    IntervalBox::from([
        level * cos_heading - port * sin_heading,
        level * sin_heading + port * cos_heading,
        forward * sin_pitch + up * cos_pitch,
    ])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use shoal_bus::message::Bounds;

    use super::*;

    fn exactly(value: f64) -> Measured {
        Measured { value, error: 0.0 }
    }

    fn holds(of: &IntervalBox<3>, expected: [f64; 3]) -> bool {
        of.inflate(1e-12).contains(&Vector3::from(expected)) && of.width() < 1e-9
    }

    #[test]
    fn what_is_seen_besides_the_log_is_turned_to_the_world() {
        // 2 m/s through the water, 2.3 forward, 0.2 to port and 0.1 up over ground.
        let seen = [2.3, 0.2, 0.1].map(exactly);
        let turned =
            |heading_rad, pitch_rad| drift(exactly(heading_rad), exactly(pitch_rad), exactly(2.0), &seen);
        assert!(holds(&turned(0.0, 0.0), [0.3, 0.2, 0.1]));
        // Nose north: forward is north, port is west.
        assert!(holds(&turned(FRAC_PI_2, 0.0), [-0.2, 0.3, 0.1]));
        // Nose up, having looked east: up is where the tail came from.
        assert!(holds(&turned(0.0, FRAC_PI_2), [-0.1, 0.2, 0.3]));
    }

    #[test]
    fn what_is_known_fades_to_what_was_told() {
        let around = |middle: f64, error: f64| Bounds::new(middle - error, middle + error);
        let body = BodyBounds {
            speed_m_s: 2.0,
            acceleration_m_s2: 1.0,
            current_m_s: [around(0.0, 0.5); 3],
            current_change_m_s2: [0.01, 0.0, 0.0],
            current_step_m_s: [0.0, 0.0, 0.03],
            disturbance_m_s: [around(0.0, 0.02); 3],
        };
        let seen_m_s = interval_box(&[around(0.3, 0.01); 3]);
        let known = Current::new(&body).contracted(&seen_m_s).unwrap();
        // The disturbance is taken off, both ways.
        assert!((known.within(0.0)[0].width() - 0.06).abs() < 1e-9);
        let later = (0..100).fold(known, |known, _| known.later(0.1)).within(0.0);
        // A slope widens with time, a step once, however often it is looked at.
        for (axis, width_m_s) in [0.26, 0.06, 0.12].into_iter().enumerate() {
            assert!((later[axis].width() - width_m_s).abs() < 1e-9, "axis {axis}: {:?}", later[axis]);
        }
        assert_eq!(known.later(1e3).within(0.0)[0].upper(), 0.5);
        assert!(known.contracted(&interval_box(&[around(0.5, 0.01); 3])).is_none());
        assert_eq!(known.forgotten().within(0.0), interval_box(&body.current_m_s));
    }
}
