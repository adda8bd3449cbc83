//! The Foxglove messages, so that viewers open a record as it is.

use serde::Serialize;

use crate::chronicle::Truth;
use crate::time::{NS_PER_S, SimTime};

/// The one frame of a record: the local tangent plane, x east, y north, z up.
const FRAME_ID: &str = "water";

/// `foxglove.Time`: never negative.
#[derive(Clone, Copy, Serialize)]
struct Time {
    sec: i64,
    nsec: i64,
}

impl Time {
    fn new(at: SimTime) -> Self {
        let ns = at.ns().max(0);
        Self { sec: ns / NS_PER_S, nsec: ns % NS_PER_S }
    }
}

#[derive(Clone, Copy, Serialize)]
struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Clone, Copy, Serialize)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

/// `foxglove.Pose` of a body whose nose is its x axis.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Pose {
    position: Vector3,
    orientation: Quaternion,
}

impl Pose {
    /// The pose, rounded to 1 mm and 1e-6: digits that no viewer shows would be half of the file.
    pub(super) fn new(truth: &Truth) -> Self {
        let [x, y, z] = truth.position_m.map(|metres| round(metres, 1e3));
        // Turn by the heading about z (up), then by the negative pitch about y (port): the nose rises with the pitch.
        let (sin_heading, cos_heading) = pxfm::f_sincos(0.5 * truth.heading_rad);
        let (sin_pitch, cos_pitch) = pxfm::f_sincos(0.5 * truth.pitch_rad);
        let [qx, qy, qz, qw] = [
            sin_heading * sin_pitch,
            -cos_heading * sin_pitch,
            sin_heading * cos_pitch,
            cos_heading * cos_pitch,
        ]
        .map(|component| round(component, 1e6));
        Self { position: Vector3 { x, y, z }, orientation: Quaternion { x: qx, y: qy, z: qz, w: qw } }
    }
}

/// The multiple of `1 / steps` nearest to `value`; zero has no sign.
fn round(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps + 0.0
}

/// `foxglove.PosesInFrame`.
#[derive(Serialize)]
pub(super) struct PosesInFrame {
    timestamp: Time,
    frame_id: &'static str,
    poses: Vec<Pose>,
}

impl PosesInFrame {
    pub(super) fn new(at: SimTime, poses: Vec<Pose>) -> Self {
        Self { timestamp: Time::new(at), frame_id: FRAME_ID, poses }
    }
}

/// `foxglove.LogLevel`, as far as a record needs it.
#[derive(Clone, Copy)]
pub(super) enum Level {
    Warning = 3,
    Error = 4,
}

/// `foxglove.Log`.
#[derive(Serialize)]
pub(super) struct Log<'a> {
    timestamp: Time,
    level: u8,
    message: String,
    name: &'a str,
    file: &'static str,
    line: u32,
}

impl<'a> Log<'a> {
    pub(super) fn new(at: SimTime, level: Level, name: &'a str, message: String) -> Self {
        Self { timestamp: Time::new(at), level: level as u8, message, name, file: "", line: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::LocalTime;

    #[test]
    fn the_nose_points_along_the_heading_and_rises_with_the_pitch() {
        let (heading_rad, pitch_rad) = (0.7, 0.3);
        let truth = Truth {
            tick: 0,
            local: LocalTime::ZERO,
            position_m: [1.000_4, -0.000_1, 2.0],
            velocity_m_s: [0.0; 3],
            heading_rad,
            pitch_rad,
        };
        let pose = Pose::new(&truth);
        assert_eq!((pose.position.x, pose.position.y.to_bits()), (1.0, 0));
        let Quaternion { x, y, z, w } = pose.orientation;
        // The x axis turned by the quaternion.
        let nose = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
        let (sin_h, cos_h) = pxfm::f_sincos(heading_rad);
        let (sin_p, cos_p) = pxfm::f_sincos(pitch_rad);
        for (found, expected) in nose.iter().zip([cos_p * cos_h, cos_p * sin_h, sin_p]) {
            assert!((found - expected).abs() < 1e-5, "{nose:?}");
        }
    }
}
