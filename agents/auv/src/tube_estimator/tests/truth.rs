//! A body, a clock and a current that do what their bounds allow, knot by knot, in closed form.

use nalgebra::Vector3;
use proptest::prelude::*;
use shoal_bus::message::{AuvId, Born, Bounds, Event, Measured, MediumAccess, Sense};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;

use crate::newborn::{PERIOD_NS, newborn};

/// Local nanoseconds between knots: twice a tick, the disturbance jumps between ticks too.
const KNOT_NS: i64 = PERIOD_NS / 2;
/// Bound of the disturbance per axis, in m/s.
pub const DISTURBANCE_M_S: f64 = 0.02;
/// Bound of the log's error, in m/s, and of the attitude's, in rad.
const LOG_ERROR: f64 = 0.01;
const ATTITUDE_ERROR_RAD: f64 = 0.02;
/// Bound of the Doppler velocity log's error, in m/s.
const DVL_ERROR_M_S: f64 = 0.01;
/// Added to stated bounds, for the rounding of this file.
const ROUNDING: f64 = 1e-9;

/// What is decided at random at each knot, in [-1, 1]: rate, acceleration, change of current, disturbance, errors, and
/// the current's step.
pub type Pushes = Vec<[f64; 19]>;

/// Any pushes for `ticks` ticks: somewhere within their bounds, or always at one.
pub fn pushes(ticks: usize) -> impl Strategy<Value = Pushes> {
    let anywhere = prop::collection::vec(prop::array::uniform19(-1.0..=1.0_f64), 2 * ticks);
    (anywhere, any::<bool>()).prop_map(|(pushes, at_bounds)| match at_bounds {
        true => pushes.into_iter().map(|push| push.map(f64::signum)).collect(),
        false => pushes,
    })
}

/// The truth at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    pub true_s: f64,
    pub position_m: Vector3<f64>,
    pub velocity_m_s: Vector3<f64>,
    pub current_m_s: Vector3<f64>,
    pub disturbance_m_s: Vector3<f64>,
}

/// From one knot to the next.
struct Knot {
    start: Moment,
    true_per_local: f64,
    acceleration_m_s2: Vector3<f64>,
    current_change_m_s2: Vector3<f64>,
    current_step_m_s: Vector3<f64>,
}

/// The whole truth of one AUV, from local time zero.
pub struct Truth {
    born: Born,
    knots: Vec<Knot>,
    pushes: Pushes,
}

impl Truth {
    /// The truth that these pushes make within the bounds told to `born`.
    pub fn new(born: &Born, pushes: &Pushes) -> Self {
        let body = &born.body;
        let steps_m_s = Vector3::from(body.current_step_m_s);
        // The current's steady part keeps half a step away from the bounds.
        let current_bounds: [Bounds; 3] = std::array::from_fn(|axis| {
            let Bounds { lower, upper } = body.current_m_s[axis];
            let half_m_s = 0.5 * steps_m_s[axis] + ROUNDING;
            Bounds::new(lower + half_m_s, upper - half_m_s)
        });
        let mut start = Moment {
            true_s: born.clock.offset_s.mid(),
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::new(1.0, 0.0, 0.0),
            current_m_s: Vector3::from(current_bounds.map(|side| side.mid() + 0.45 * side.width())),
            disturbance_m_s: Vector3::zeros(),
        };
        let mut knots = Vec::new();
        for push in pushes {
            let three = |from: usize| Vector3::new(push[from], push[from + 1], push[from + 2]);
            let true_per_local = 1.0 / (1.0 + born.clock.drift * push[0]);
            let length_s = KNOT_NS as f64 * 1e-9 * true_per_local;
            // Per axis, so that neither the norm of the acceleration nor that of the speed exceeds its bound.
            let (most_m_s2, most_m_s) = (body.acceleration_m_s2 / 1.75, body.speed_m_s / 1.75);
            let velocity_after = (start.velocity_m_s + three(1) * (most_m_s2 * length_s))
                .map(|component| component.clamp(-most_m_s, most_m_s));
            let current_after = Vector3::from_fn(|axis, _| {
                let change = body.current_change_m_s2[axis] * push[4 + axis] * length_s;
                let Bounds { lower, upper } = current_bounds[axis];
                (start.current_m_s[axis] + change).clamp(lower, upper)
            });
            start.disturbance_m_s = three(7) * DISTURBANCE_M_S;
            let knot = Knot {
                start,
                true_per_local,
                acceleration_m_s2: (velocity_after - start.velocity_m_s) / length_s,
                current_change_m_s2: (current_after - start.current_m_s) / length_s,
                current_step_m_s: three(16).component_mul(&steps_m_s) * 0.5,
            };
            start = Moment { current_m_s: current_after, ..knot.after(KNOT_NS as f64 * 1e-9) };
            knots.push(knot);
        }
        Self { born: born.clone(), knots, pushes: pushes.clone() }
    }

    /// The truth at a local time.
    pub fn at(&self, local_ns: i64) -> Moment {
        let index = ((local_ns / KNOT_NS) as usize).min(self.knots.len() - 1);
        self.knots[index].after((local_ns - index as i64 * KNOT_NS) as f64 * 1e-9)
    }

    /// One of the errors drawn for a local time, in [-1, 1].
    fn error(&self, local_ns: i64, which: usize) -> f64 {
        self.pushes[(local_ns / KNOT_NS) as usize % self.pushes.len()][10 + which % 6]
    }

    fn measured(&self, truth: f64, bound: f64, local_ns: i64, which: usize) -> Measured {
        let error = bound + ROUNDING;
        Measured { value: truth + bound * self.error(local_ns, which), error }
    }

    /// What log and attitude sensor say.
    pub fn inertial(&self, local_ns: i64) -> Event {
        let (heading_rad, pitch_rad, speed_m_s) = attitude(&self.at(local_ns).velocity_m_s);
        let sense = Sense::Inertial {
            heading_rad: self.measured(heading_rad, ATTITUDE_ERROR_RAD, local_ns, 0),
            pitch_rad: self.measured(pitch_rad, ATTITUDE_ERROR_RAD, local_ns, 1),
            speed_m_s: self.measured(speed_m_s, LOG_ERROR, local_ns, 2),
        };
        Event { stamp: LocalTime::from_ns(local_ns), sense }
    }

    /// What a Doppler velocity log says: the velocity over ground on the axes of the body.
    pub fn dvl(&self, local_ns: i64) -> Event {
        let moment = self.at(local_ns);
        let (heading_rad, pitch_rad, _) = attitude(&moment.velocity_m_s);
        let (sin_heading, cos_heading) = pxfm::f_sincos(heading_rad);
        let (sin_pitch, cos_pitch) = pxfm::f_sincos(pitch_rad);
        let forward = Vector3::new(cos_pitch * cos_heading, cos_pitch * sin_heading, sin_pitch);
        let port = Vector3::new(-sin_heading, cos_heading, 0.0);
        let ground_m_s = moment.velocity_m_s + moment.current_m_s + moment.disturbance_m_s;
        let along = [forward, port, forward.cross(&port)].map(|axis| axis.dot(&ground_m_s));
        let velocity_m_s =
            std::array::from_fn(|axis| self.measured(along[axis], DVL_ERROR_M_S, local_ns, 3 + axis));
        Event { stamp: LocalTime::from_ns(local_ns), sense: Sense::Dvl { velocity_m_s } }
    }

    /// The ping of a beacon at `beacon_m`, as it is heard at a local time.
    pub fn heard(&self, beacon_m: Vector3<f64>, local_ns: i64) -> Event {
        let moment = self.at(local_ns);
        let emission_s =
            moment.true_s - (moment.position_m - beacon_m).norm() / self.born.modem.sound_speed_m_s.mid();
        let around = |value: f64| Bounds::new(value - ROUNDING, value + ROUNDING);
        let ping = Ping {
            sender: AuvId(9),
            sequence: 0,
            emission_s: around(emission_s),
            position_m: std::array::from_fn(|axis| around(beacon_m[axis])),
            velocity_m_s: [Bounds::default(); 3],
        };
        let error_ns = (self.error(local_ns, 4) * 0.99e9 * self.born.modem.timestamp_s) as i64;
        let sense = Sense::Heard { frame: ping.encode().unwrap() };
        Event { stamp: LocalTime::from_ns(local_ns + error_ns), sense }
    }
}

impl Knot {
    fn after(&self, local_s: f64) -> Moment {
        let elapsed_s = local_s * self.true_per_local;
        let Moment { true_s, position_m, velocity_m_s, disturbance_m_s, .. } = self.start;
        let current_m_s = self.start.current_m_s + self.current_step_m_s;
        let change_m_s2 = self.acceleration_m_s2 + self.current_change_m_s2;
        let ground_m_s = velocity_m_s + current_m_s + disturbance_m_s;
        Moment {
            true_s: true_s + elapsed_s,
            position_m: position_m + (ground_m_s + change_m_s2 * (0.5 * elapsed_s)) * elapsed_s,
            velocity_m_s: velocity_m_s + self.acceleration_m_s2 * elapsed_s,
            current_m_s: current_m_s + self.current_change_m_s2 * elapsed_s,
            disturbance_m_s,
        }
    }
}

/// Heading, pitch and speed of a velocity.
fn attitude(velocity_m_s: &Vector3<f64>) -> (f64, f64, f64) {
    let horizontal_m_s = (velocity_m_s.x * velocity_m_s.x + velocity_m_s.y * velocity_m_s.y).sqrt();
    let heading_rad = pxfm::f_atan2(velocity_m_s.y, velocity_m_s.x);
    (heading_rad, pxfm::f_atan2(velocity_m_s.z, horizontal_m_s), velocity_m_s.norm())
}

/// An AUV in a current known to `current_error_m_s`, with a clock that drifts by `drift`.
pub fn told(drift: f64, current_error_m_s: f64) -> Born {
    let mut born = newborn(MediumAccess::Silent);
    let around = |value: f64, error: f64| Bounds::new(value - error, value + error);
    born.clock.drift = drift;
    born.clock.offset_s = around(0.2, 1e-5);
    born.prior_position_m = [around(0.3, 1.0); 3];
    born.body.current_m_s = [0.2, -0.1, 0.0].map(|middle| around(middle, current_error_m_s + ROUNDING));
    born.body.disturbance_m_s = [around(0.0, DISTURBANCE_M_S + ROUNDING); 3];
    born
}
