//! The direction from which a ping arrives, as an ultra-short baseline array in the nose measures it.

use pxfm::f_atan2;
use shoal_bus::message::{AuvId, Sense};
use shoal_scenario::model::Noise;

use crate::body::Vec3;
use crate::draw::{Draws, Purpose};
use crate::sensors::measured;

/// How sound truly comes in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// Towards where it comes from, in the axes of the world; of any length.
    pub towards: Vec3,
    /// The receiver's heading then, in rad.
    pub heading_rad: f64,
}

/// An ultra-short baseline array with a compass of its own.
pub struct BearingArray {
    draws: Draws,
    error_rad: f64,
    heading_error_rad: f64,
}

impl BearingArray {
    /// An array that measures directions to `error_rad` and its own heading to `heading_error_rad`.
    pub fn new(error_rad: f64, heading_error_rad: f64, (seed, auv, noise): (u64, AuvId, Noise)) -> Self {
        Self { draws: Draws::new(seed, Purpose::Bearing, auv, noise), error_rad, heading_error_rad }
    }

    /// What it says of a ping of `sender`.
    pub fn sense(&mut self, sender: AuvId, incidence: &Incidence) -> Sense {
        let Incidence { towards, heading_rad } = *incidence;
        let azimuth_rad = first_turn(f_atan2(towards.y, towards.x) - heading_rad);
        let elevation_rad = f_atan2(towards.z, (towards.x * towards.x + towards.y * towards.y).sqrt());
        Sense::Bearing {
            sender,
            azimuth_rad: measured(&mut self.draws, azimuth_rad, self.error_rad),
            elevation_rad: Some(measured(&mut self.draws, elevation_rad, self.error_rad)),
            heading_rad: measured(&mut self.draws, heading_rad, self.heading_error_rad),
        }
    }
}

/// The same direction in (-pi, pi].
fn first_turn(angle_rad: f64) -> f64 {
    let (sin, cos) = pxfm::f_sincos(angle_rad);
    f_atan2(sin, cos)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use shoal_bus::message::Measured;

    use super::*;

    fn sensed(array: &mut BearingArray, towards: [f64; 3], heading_rad: f64) -> [Measured; 3] {
        let incidence = Incidence { towards: Vec3::from(towards), heading_rad };
        match array.sense(AuvId(7), &incidence) {
            Sense::Bearing { sender, azimuth_rad, elevation_rad: Some(elevation_rad), heading_rad } => {
                assert_eq!(sender, AuvId(7));
                [azimuth_rad, elevation_rad, heading_rad]
            }
            other => panic!("no bearing: {other:?}"),
        }
    }

    #[test]
    fn azimuth_is_counted_counter_clockwise_from_the_nose_and_elevation_upwards() {
        let mut array = BearingArray::new(0.0, 0.0, (1, AuvId(0), Noise::Uniform));
        // North of a body that heads east is to port, of one that heads north is ahead, of one that heads south is astern.
        for (towards, heading_rad, azimuth_rad, elevation_rad) in [
            ([0.0, 2.0, 0.0], 0.0, FRAC_PI_2, 0.0),
            ([0.0, 2.0, 0.0], FRAC_PI_2, 0.0, 0.0),
            ([0.0, 2.0, 0.0], -FRAC_PI_2, PI, 0.0),
            ([1.0, 0.0, -1.0], FRAC_PI_2, -FRAC_PI_2, -FRAC_PI_4),
            ([1.0, 0.0, 1.0], 7.0 * PI, PI, FRAC_PI_4),
        ] {
            let [azimuth, elevation, heading] = sensed(&mut array, towards, heading_rad);
            let turned_rad = (azimuth.value - azimuth_rad).abs();
            assert!(turned_rad < 1e-14 || (turned_rad - 2.0 * PI).abs() < 1e-14, "{towards:?}: {azimuth:?}");
            assert!((elevation.value - elevation_rad).abs() < 1e-15, "{towards:?}: {elevation:?}");
            assert_eq!(heading.value, heading_rad);
        }
    }

    #[test]
    fn errors_reach_their_bound_but_not_beyond() {
        for noise in [Noise::Uniform, Noise::Adversarial] {
            let mut array = BearingArray::new(0.1, 0.02, (3, AuvId(2), noise));
            let mut farthest_rad = [0.0_f64; 3];
            for step in 0..1_000 {
                let (sin, cos) = pxfm::f_sincos(0.003 * f64::from(step));
                // Stays away from the half turn, where angles jump.
                let said = sensed(&mut array, [50.0 * cos, 50.0 * sin, -20.0], 0.3);
                let truth_rad = [0.003 * f64::from(step) - 0.3, f_atan2(-20.0, 50.0), 0.3];
                for axis in 0..3 {
                    let off_rad = (said[axis].value - truth_rad[axis]).abs();
                    assert!(off_rad <= said[axis].error, "{said:?} for {truth_rad:?}");
                    farthest_rad[axis] = farthest_rad[axis].max(off_rad);
                }
                assert!(said[0].error < 0.1 + 2e-8 && said[2].error < 0.02 + 2e-8);
            }
            assert!(farthest_rad[0] > 0.099 && farthest_rad[1] > 0.099 && farthest_rad[2] > 0.0199);
        }
    }
}
