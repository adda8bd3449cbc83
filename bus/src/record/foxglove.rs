//! The Foxglove messages, so that viewers open a record as it is.

use serde::{Deserialize, Serialize};

use super::batch::batch_end;
use super::rows::TruthRow;
use crate::chronicle::Truth;
use crate::time::{NS_PER_S, SimTime};

/// The one frame of a record: the local tangent plane, x east, y north, z up.
const FRAME_ID: &str = "water";

/// `foxglove.Time`: never negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Time {
    /// Whole seconds.
    pub sec: i64,
    /// Nanoseconds since then.
    pub nsec: i64,
}

impl Time {
    pub(super) fn new(at: SimTime) -> Self {
        let ns = at.ns().max(0);
        Self { sec: ns / NS_PER_S, nsec: ns % NS_PER_S }
    }

    /// The same as true time.
    pub fn sim_time(self) -> SimTime {
        SimTime::from_ns(self.sec.saturating_mul(NS_PER_S).saturating_add(self.nsec))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

/// `foxglove.Pose` of a body whose nose is its x axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
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

/// `foxglove.PosesInFrame`: where all AUVs truly are, for viewers. The message of `/truth`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PosesInFrame {
    /// When.
    pub timestamp: Time,
    frame_id: String,
    poses: Vec<Pose>,
}

impl PosesInFrame {
    pub(super) fn new(at: SimTime, poses: Vec<Pose>) -> Self {
        Self { timestamp: Time::new(at), frame_id: FRAME_ID.to_owned(), poses }
    }
}

/// The messages of `/truth`, batch by batch, from the rows of `/ticks`.
#[derive(Debug, Default)]
pub(crate) struct PoseBatches {
    latest: Vec<Option<Pose>>,
    /// End of the batch in which something has moved.
    end: Option<SimTime>,
}

impl PoseBatches {
    /// Takes in a row; what it returns is the message of the batch before.
    pub(crate) fn push(&mut self, truth: &TruthRow) -> Option<PosesInFrame> {
        let end = batch_end(truth.t_ns);
        let done = if self.end.is_some_and(|before| before < end) { self.take() } else { None };
        let index = truth.auv.0 as usize;
        if self.latest.len() <= index {
            self.latest.resize(index + 1, None);
        }
        if let Some(latest) = self.latest.get_mut(index) {
            *latest = Some(Pose::new(&truth.truth()));
        }
        self.end = Some(end);
        done
    }

    /// Tells that all rows before `to` were taken in; what it returns is the message of a batch that ended before.
    pub(crate) fn advance(&mut self, to: SimTime) -> Option<PosesInFrame> {
        if self.end.is_some_and(|end| end < to) { self.take() } else { None }
    }

    fn take(&mut self) -> Option<PosesInFrame> {
        let end = self.end.take()?;
        Some(PosesInFrame::new(end, self.latest.iter().flatten().copied().collect()))
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
