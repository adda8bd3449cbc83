//! A true body: kinematic, limited in speed, acceleration, turn rate and pitch, pushed by current and state noise.
//!
//! The velocity through the water is linear in time between knots (of fixed true times, split only where a setpoint takes
//! effect), so the position is a parabola there: exact to evaluate, and the same whoever asks, and when. From one knot to the
//! next the current is that of the place where the body was at the knot, whatever setpoint takes effect in between.

use std::collections::VecDeque;
use std::f64::consts::PI;

use nalgebra::Vector3;
use pxfm::{f_atan2, f_sincos};
use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_scenario::model::{Kind, Noise};

use crate::current::Current;
use crate::draw::{Draws, Purpose};

/// Below this speed, in m/s, a velocity has no direction worth a name and the attitude is kept.
const STEERAGE_M_S: f64 = 1e-9;

/// Position in metres or velocity in m/s.
pub type Vec3 = Vector3<f64>;

/// Attitude and speed through the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// Counter-clockwise from east, in rad.
    pub heading_rad: f64,
    /// Positive nose up, in rad.
    pub pitch_rad: f64,
    /// Along the nose, in m/s.
    pub speed_m_s: f64,
}

impl Attitude {
    /// The velocity through the water that it stands for, in m/s.
    pub fn velocity_m_s(&self) -> Vec3 {
        let (sin_heading, cos_heading) = f_sincos(self.heading_rad);
        let (sin_pitch, cos_pitch) = f_sincos(self.pitch_rad);
        Vec3::new(cos_pitch * cos_heading, cos_pitch * sin_heading, sin_pitch) * self.speed_m_s
    }

    /// The attitude of a velocity; without speed, that of `fallback`.
    fn of(velocity_m_s: &Vec3, fallback: &Attitude) -> Self {
        let speed_m_s = velocity_m_s.norm();
        if speed_m_s < STEERAGE_M_S {
            return Self { speed_m_s, ..*fallback };
        }
        Self {
            heading_rad: f_atan2(velocity_m_s.y, velocity_m_s.x),
            pitch_rad: f_atan2(velocity_m_s.z, velocity_m_s.xy().norm()),
            speed_m_s,
        }
    }
}

/// A stretch of true time with linear velocity.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Where it begins.
    pub start: SimTime,
    /// Where it ends.
    pub end: SimTime,
    /// Position at `start`, in metres.
    pub position_m: Vec3,
    /// Velocity over ground at `start`, in m/s.
    pub ground_velocity_m_s: Vec3,
    /// Its constant rate of change, in m/s².
    pub acceleration_m_s2: Vec3,
    water_velocity_m_s: Vec3,
    attitude: Attitude,
    /// The next knot, unless a setpoint takes effect before.
    planned_end: SimTime,
}

impl Segment {
    /// Position `elapsed_s` seconds after the start, in metres.
    pub fn position_after(&self, elapsed_s: f64) -> Vec3 {
        self.position_m + (self.ground_velocity_m_s + self.acceleration_m_s2 * (0.5 * elapsed_s)) * elapsed_s
    }

    /// Seconds from the start to the next knot, whether or not a setpoint ends the stretch before.
    pub fn planned_length_s(&self) -> f64 {
        self.elapsed_s(self.planned_end)
    }

    fn elapsed_s(&self, t: SimTime) -> f64 {
        (t - self.start) as f64 * 1e-9
    }

    fn water_velocity_at(&self, t: SimTime) -> Vec3 {
        self.water_velocity_m_s + self.acceleration_m_s2 * self.elapsed_s(t)
    }
}

/// The whole truth about a body at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// In metres.
    pub position_m: Vec3,
    /// Through the water, in m/s.
    pub water_velocity_m_s: Vec3,
    /// Over ground, in m/s.
    pub ground_velocity_m_s: Vec3,
    /// Direction and speed of the former.
    pub attitude: Attitude,
}

/// One AUV's body.
pub struct Body {
    kind: Kind,
    current: Current,
    knot_ns: i64,
    draws: Draws,
    drawn_knot: i64,
    /// State noise from the last knot on.
    disturbance_m_s: Vec3,
    /// Current at the last knot's place.
    current_m_s: Vec3,
    goal: Attitude,
    /// Setpoints that are decided but not yet in effect, in order of time.
    setpoints: VecDeque<(SimTime, Vec3)>,
    /// What is remembered, the last one reaching beyond what is integrated so far.
    segments: VecDeque<Segment>,
    /// Number of the knot at or before the start of the first of them.
    first_knot: i64,
    /// Attitude and velocity through the water at the end that is planned for the last one.
    planned: (Attitude, Vec3),
    shift: Option<SimTime>,
    /// When it will be carried elsewhere, and where to in metres, in order of time.
    leaps: VecDeque<(SimTime, Vec3)>,
    /// When it was carried elsewhere last, and how far in metres.
    leapt: Option<(SimTime, f64)>,
}

impl Body {
    /// A body at rest in its orders: it keeps `attitude` until the first setpoint takes effect.
    pub fn new(
        kind: &Kind,
        current: impl Into<Current>,
        knot_ns: i64,
        position_m: Vec3,
        attitude: Attitude,
        (seed, auv, noise): (u64, AuvId, Noise),
    ) -> Self {
        let mut body = Self {
            kind: kind.clone(),
            current: current.into(),
            knot_ns,
            draws: Draws::new(seed, Purpose::Disturbance, auv, noise),
            drawn_knot: -1,
            disturbance_m_s: Vec3::zeros(),
            current_m_s: Vec3::zeros(),
            goal: attitude,
            setpoints: VecDeque::new(),
            segments: VecDeque::new(),
            first_knot: 0,
            planned: (attitude, Vec3::zeros()),
            shift: None,
            leaps: VecDeque::new(),
            leapt: None,
        };
        body.begin(SimTime::ZERO, position_m, attitude, attitude.velocity_m_s());
        body
    }

    /// Bound of the change of its velocity through the water, in m/s²: speeding up, and turning in heading and in pitch, each
    /// at right angles to the others.
    pub fn acceleration_bound_m_s2(kind: &Kind) -> f64 {
        let along = kind.acceleration_max_m_s2;
        let across = kind.speed_max_m_s * kind.turn_rate_max_rad_s;
        (along * along + 2.0 * across * across).sqrt() * (1.0 + 1e-9) + 1e-9
    }

    /// Bound of its speed over ground, in m/s, wherever the current takes it.
    pub fn ground_speed_bound_m_s(kind: &Kind, current: &Current) -> f64 {
        kind.speed_max_m_s + current.speed_bound_m_s() + Vec3::from(kind.disturbance_m_s).norm()
    }

    /// Shifts the truth by a metre east at the first knot from `at` on, unaccounted for: a sabotage.
    pub fn shift_truth(&mut self, at: SimTime) {
        self.shift = Some(at);
    }

    /// Carries the body to `to_m` at the first knot from `at` on, its velocity unchanged: a kidnapping.
    pub fn kidnap(&mut self, at: SimTime, to_m: Vec3) {
        let place = self.leaps.partition_point(|&(earlier, _)| earlier <= at);
        self.leaps.insert(place, (at, to_m));
    }

    /// How far it was carried by kidnappers after `since`, in metres, as far as it is integrated; only the last time counts.
    pub fn leapt_since(&self, since: SimTime) -> f64 {
        self.leapt.filter(|&(at, _)| at >= since).map_or(0.0, |(_, leap_m)| leap_m)
    }

    /// Whether kidnappers carried it from `since` to `at`, as far as it is integrated; only the last time counts.
    pub fn leapt_between(&self, since: SimTime, at: SimTime) -> bool {
        self.leapt.is_some_and(|(leap, _)| since <= leap && leap <= at)
    }

    /// Takes a desired velocity through the water that takes effect at `at`, which lies in no window already integrated.
    pub fn steer(&mut self, at: SimTime, velocity_m_s: Vec3) {
        let place = self.setpoints.partition_point(|&(earlier, _)| earlier <= at);
        self.setpoints.insert(place, (at, velocity_m_s));
        if let Some(last) = self.segments.back_mut() {
            last.end = last.end.min(at);
        }
    }

    /// The time of the last setpoint that is decided but not yet in effect.
    pub fn last_setpoint(&self) -> Option<SimTime> {
        self.setpoints.back().map(|&(at, _)| at)
    }

    /// Integrates until the remembered motion reaches `to`.
    pub fn integrate(&mut self, to: SimTime) {
        while let Some(&last) = self.segments.back().filter(|last| last.end < to) {
            let mut position_m = last.position_after(last.elapsed_s(last.end));
            if self.shift.is_some_and(|at| at <= last.end) {
                self.shift = None;
                position_m.x += 1.0;
            }
            while let Some(&(_, to_m)) = self.leaps.front().filter(|(at, _)| *at <= last.end) {
                self.leaps.pop_front();
                self.leapt = Some((last.end, (to_m - position_m).norm()));
                position_m = to_m;
            }
            if last.end == last.planned_end {
                let (attitude, velocity_m_s) = self.planned;
                self.begin(last.end, position_m, attitude, velocity_m_s);
            } else {
                let pose = pose_at(&last, last.end);
                self.begin(last.end, position_m, pose.attitude, pose.water_velocity_m_s);
            }
        }
    }

    /// Forgets motion that ended before `t`; it will not be asked again.
    pub fn forget_before(&mut self, t: SimTime) {
        let mut forgotten = 0;
        while forgotten + 1 < self.segments.len() && self.segments[forgotten].end < t {
            forgotten += 1;
        }
        if forgotten > 0 {
            self.segments.drain(..forgotten);
            self.first_knot = self.segments[0].start.ns().div_euclid(self.knot_ns);
        }
    }

    /// The truth at `t`, which is integrated and not forgotten.
    pub fn at(&self, t: SimTime) -> Pose {
        pose_at(self.segment_at(t), t)
    }

    /// The position in metres at `t`, as in [`at`](Self::at), for less.
    pub fn position_at(&self, t: SimTime) -> Vec3 {
        let segment = self.segment_at(t);
        segment.position_after(segment.elapsed_s(t))
    }

    /// The velocity over ground in m/s at `t`, as in [`at`](Self::at), for less.
    pub fn ground_velocity_at(&self, t: SimTime) -> Vec3 {
        let segment = self.segment_at(t);
        segment.ground_velocity_m_s + segment.acceleration_m_s2 * segment.elapsed_s(t)
    }

    /// The stretch that holds `t` and all later ones, in order.
    pub fn segments_from(&self, t: SimTime) -> impl Iterator<Item = &Segment> {
        self.segments.range(self.index_at(t)..)
    }

    fn segment_at(&self, t: SimTime) -> &Segment {
        &self.segments[self.index_at(t)]
    }

    /// Found from the number of knots since the first stretch: every knot begins one, and setpoints begin few more.
    fn index_at(&self, t: SimTime) -> usize {
        let last = self.segments.len() - 1;
        let knots = t.ns().div_euclid(self.knot_ns) - self.first_knot;
        let mut index = last.min(knots.max(0) as usize);
        while index < last && self.segments[index].end <= t {
            index += 1;
        }
        index
    }

    /// Starts a stretch at `start`, up to the next knot or setpoint.
    fn begin(&mut self, start: SimTime, position_m: Vec3, attitude: Attitude, water_velocity_m_s: Vec3) {
        while let Some(&(at, velocity_m_s)) = self.setpoints.front().filter(|(at, _)| *at <= start) {
            debug_assert_eq!(at, start, "a setpoint took effect inside a stretch");
            self.goal = self.feasible(&velocity_m_s);
            self.setpoints.pop_front();
        }
        let knot = start.ns().div_euclid(self.knot_ns);
        // Every knot begins a stretch, so none is passed over and `start` is its time.
        while self.drawn_knot < knot {
            self.drawn_knot += 1;
            self.disturbance_m_s = Vec3::from(self.kind.disturbance_m_s).map(|bound| self.draws.error(bound));
            self.current_m_s = self.current.at(&position_m);
        }
        let planned_end = SimTime::from_ns((knot + 1) * self.knot_ns);
        let seconds = (planned_end - start) as f64 * 1e-9;
        let next = self.turn_towards_goal(&attitude, seconds);
        let next_velocity_m_s = if next == attitude { water_velocity_m_s } else { next.velocity_m_s() };
        let acceleration_m_s2 = (next_velocity_m_s - water_velocity_m_s) / seconds;
        let end = self.setpoints.front().map_or(planned_end, |&(at, _)| at.min(planned_end));
        self.segments.push_back(Segment {
            start,
            end,
            position_m,
            ground_velocity_m_s: water_velocity_m_s + self.current_m_s + self.disturbance_m_s,
            acceleration_m_s2,
            water_velocity_m_s,
            attitude,
            planned_end,
        });
        self.planned = (next, next_velocity_m_s);
    }

    /// The attitude that a desired velocity asks for, within what the kind can hold.
    fn feasible(&self, velocity_m_s: &Vec3) -> Attitude {
        let wish = Attitude::of(velocity_m_s, &self.goal);
        let pitch_max_rad = self.kind.pitch_max_rad;
        Attitude {
            heading_rad: wish.heading_rad,
            pitch_rad: wish.pitch_rad.clamp(-pitch_max_rad, pitch_max_rad),
            speed_m_s: wish.speed_m_s.min(self.kind.speed_max_m_s),
        }
    }

    fn turn_towards_goal(&self, from: &Attitude, seconds: f64) -> Attitude {
        let turn_rad = self.kind.turn_rate_max_rad_s * seconds;
        let change_m_s = self.kind.acceleration_max_m_s2 * seconds;
        let heading_error_rad = wrapped(self.goal.heading_rad - from.heading_rad);
        let pitch_error_rad = self.goal.pitch_rad - from.pitch_rad;
        let speed_error_m_s = self.goal.speed_m_s - from.speed_m_s;
        Attitude {
            heading_rad: wrapped(from.heading_rad + heading_error_rad.clamp(-turn_rad, turn_rad)),
            pitch_rad: from.pitch_rad + pitch_error_rad.clamp(-turn_rad, turn_rad),
            speed_m_s: from.speed_m_s + speed_error_m_s.clamp(-change_m_s, change_m_s),
        }
    }
}

fn pose_at(segment: &Segment, t: SimTime) -> Pose {
    let elapsed_s = segment.elapsed_s(t);
    let water_velocity_m_s = segment.water_velocity_at(t);
    let attitude = if t == segment.start {
        segment.attitude
    } else {
        Attitude::of(&water_velocity_m_s, &segment.attitude)
    };
    Pose {
        position_m: segment.position_after(elapsed_s),
        water_velocity_m_s,
        ground_velocity_m_s: segment.ground_velocity_m_s + segment.acceleration_m_s2 * elapsed_s,
        attitude,
    }
}

/// The same direction in (-pi, pi].
fn wrapped(angle_rad: f64) -> f64 {
    // The remainder is exact, so one that is the angle itself need not be worked out.
    let angle_rad = if angle_rad.abs() < 2.0 * PI { angle_rad } else { angle_rad % (2.0 * PI) };
    if angle_rad > PI {
        angle_rad - 2.0 * PI
    } else if angle_rad <= -PI {
        angle_rad + 2.0 * PI
    } else {
        angle_rad
    }
}

#[cfg(test)]
mod tests;
