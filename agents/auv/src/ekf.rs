//! An extended Kalman filter: the honest opponent of the tube.
//!
//! It lives in the same local time and is told the same bounds; where the tube takes a bound `b` for certain, it takes an error to
//! be uniform in `[-b, b]`, with the variance `b²/3`, and to have nothing to do with any other. Its state is position, true minus
//! local time, the rate of that, and the current: an error of the current lasts, so it must be a state of its own and
//! cannot be noise, and neither can the part of a rate that lasts. Both walk at random, slowly, and never become less certain than
//! what was told at birth.
//!
//! | what | how |
//! |---|---|
//! | log and attitude | carry the mean on; each reading's error is independent noise for one tick |
//! | state noise | independent noise for each tick, or tenth of a second if ticks are shorter |
//! | speed-ups within a tick | independent noise for each tick |
//! | Doppler velocity log | with log and attitude, measures the current |
//! | depth, satellite fix | measured; never gated, they are the AUV's own |
//! | ping | one number, [`ranging`]: gated, and fused as ordered |
//!
//! Everything measured is applied at the next tick, to the state as it was at its stamp: the mean less what was travelled since
//! ([`trail`]). What odometry may have lost in between, fractions of a tick or the length of a packet, is neglected.
//!
//! What it takes for independent need not be: where errors keep to one side for a while, as worst-case noise does, it is
//! overconfident.

pub mod filter;
pub mod ranging;
pub mod trail;

use nalgebra::{Matrix3, Vector3};
use pxfm::f_sincos;
use shoal_bus::message::{BodyBounds, Born, EkfSettings, Event, Gaussian, Measured, Sense, Sensed};
use shoal_bus::ping::Payload;
use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use crate::estimator::{Estimate, Estimator, Prediction};
use crate::state::State;
use crate::travel::seconds;
use filter::{CURRENT, Filter, Matrix, Measurement, OFFSET, POSITION, RATE, Vector};
use ranging::{Arrival, Emitter, Sound, half_width_variance, uniform};
use trail::Trail;

/// Boxes reach so many standard deviations to either side.
const REACH_SIGMA: f64 = 3.0;
/// A change of the current keeps its sign so long: nobody tells, so this is a choice.
const MEMORY_S: f64 = 10.0;
/// A rate is partly constant and partly wanders, and nobody tells which part is which; so all of its bound counts for either. What wanders
/// keeps its sign so long ...
const WANDER_S: f64 = 2.0;
/// ... and what is constant may have become anything else in its bounds after so long.
const AGEING_S: f64 = 1_000.0;
/// The state noise stays the same so long at least: nobody tells either, and noise that changed at every tick would vanish for those
/// that tick fast.
const NOISE_S: f64 = 0.1;
/// So many local nanoseconds are remembered for pings told late; what is older is ignored. Longer than any packet of the presets.
const HORIZON_NS: i64 = 30_000_000_000;

/// Believes in a Gaussian.
pub struct Ekf {
    settings: EkfSettings,
    filter: Filter,
    told: Told,
    sound: Sound,
    now: LocalTime,
    log: Log,
    trail: Trail,
}

/// What was told at birth and holds at any time, as means and variances.
struct Told {
    /// Variance of the clock's rate.
    rate: f64,
    current_m_s: [(f64, f64); 3],
    current_change_m_s2: [f64; 3],
    current_step_m_s: [f64; 3],
    /// Variance of the state noise, in m²/s².
    disturbance: [f64; 3],
    speed_m_s: f64,
    acceleration_m_s2: f64,
}

/// A velocity through the water, in m/s.
#[derive(Clone, Copy)]
struct Log {
    velocity_m_s: Vector3<f64>,
    covariance: Matrix3<f64>,
}

impl Ekf {
    /// The filter that begins with what the AUV was told at birth.
    pub fn new(born: &Born, settings: EkfSettings) -> Self {
        let told = Told::new(&born.body, born.clock.drift);
        let mut filter = Filter { mean: Vector::zeros(), covariance: Matrix::zeros() };
        let mut begin = |index: usize, (mean, variance): (f64, f64)| {
            filter.mean[index] = mean;
            filter.covariance[(index, index)] = variance;
        };
        for axis in 0..3 {
            begin(POSITION + axis, uniform(born.prior_position_m[axis]));
            begin(CURRENT + axis, told.current_m_s[axis]);
        }
        begin(OFFSET, uniform(born.clock.offset_s));
        begin(RATE, (0.0, told.rate));
        let (speed_m_s, speed_variance) = uniform(born.modem.sound_speed_m_s);
        let stamp_s = born.modem.timestamp_s + born.clock.stamp_ns as f64 * 1e-9;
        let unknown = half_width_variance(told.speed_m_s);
        Self {
            settings,
            filter,
            sound: Sound { speed_m_s, speed_variance, stamp_variance: half_width_variance(stamp_s) },
            now: born.birth,
            log: Log { velocity_m_s: Vector3::zeros(), covariance: Matrix3::from_diagonal_element(unknown) },
            trail: Trail::new(born.birth, HORIZON_NS),
            told,
        }
    }

    /// The velocity through the water at the tick: what the log says, or what it said last, worn by time.
    fn look_at_log(&self, sensed: &Sensed) -> Log {
        let mut logs = sensed.events.iter().filter_map(|event| match event.sense {
            Sense::Inertial { heading_rad, pitch_rad, speed_m_s } => {
                Some(Log::new(heading_rad, pitch_rad, speed_m_s))
            }
            _ => None,
        });
        logs.next_back().unwrap_or_else(|| self.log.worn(&self.told, seconds(sensed.stamp - self.now)))
    }

    /// The filter `length_s` local seconds on, at the mean velocity `through_water_m_s`.
    fn moved(&self, through_water_m_s: &Vector3<f64>, noise: &Matrix, length_s: f64) -> Filter {
        let mut filter = self.filter.clone();
        let rate = filter.mean[RATE];
        let ground_m_s = through_water_m_s + filter.mean.fixed_rows::<3>(CURRENT);
        let mut mean = filter.mean;
        let mut transition = Matrix::identity();
        for axis in 0..3 {
            // dp = (v + current) dt with dt = (1 + rate) ds.
            mean[POSITION + axis] += ground_m_s[axis] * (1.0 + rate) * length_s;
            transition[(POSITION + axis, CURRENT + axis)] = (1.0 + rate) * length_s;
            transition[(POSITION + axis, RATE)] = ground_m_s[axis] * length_s;
        }
        mean[OFFSET] += rate * length_s;
        transition[(OFFSET, RATE)] = length_s;
        // True time that the clock missed is time in which the body moved, too.
        let mut noise = *noise;
        let missed = noise[(OFFSET, OFFSET)];
        for axis in 0..3 {
            let moved = ground_m_s[axis] * missed;
            noise[(POSITION + axis, OFFSET)] = moved;
            noise[(OFFSET, POSITION + axis)] = moved;
            for other in 0..3 {
                noise[(POSITION + axis, POSITION + other)] += moved * ground_m_s[other];
            }
        }
        filter.predict(mean, &transition, &noise);
        self.told.limit(&mut filter);
        filter
    }

    /// Takes in one event that lies in the past of the tick at `now`: whether the gate let it pass, and whether it said something.
    fn take_in(&mut self, event: &Event, sensed: &Sensed) -> Taken {
        let lag_s = seconds(self.now - event.stamp);
        let Some(since_m) = self.trail.since(event.stamp) else { return Taken::Ignored };
        match &event.sense {
            Sense::Depth { depth_m } => {
                let measured = (-depth_m.value, half_width_variance(depth_m.error));
                self.fix(2, measured, &since_m, lag_s)
            }
            Sense::Gnss { position_m, time_s } => {
                for (axis, side) in position_m.iter().enumerate() {
                    self.fix(axis, uniform(*side), &since_m, lag_s);
                }
                self.set_clock(uniform(*time_s), event.stamp, lag_s)
            }
            Sense::Dvl { velocity_m_s } => self.look_at_ground(event.stamp, velocity_m_s, sensed),
            Sense::Heard { frame } => {
                // Bytes that are no ping say nothing.
                let Ok(payload) = Payload::decode(frame) else { return Taken::Ignored };
                let arrival = Arrival { stamp_s: event.stamp.as_s(), lag_s, since_m };
                let EkfSettings { gate_sigma, fusion } = self.settings;
                let emitter = Emitter::from(&payload);
                let passed =
                    ranging::listen(&mut self.filter, &emitter, &arrival, &self.sound, (gate_sigma, fusion));
                if passed { Taken::Used } else { Taken::Rejected }
            }
            Sense::Inertial { .. } | Sense::Bearing { .. } | Sense::Held => Taken::Ignored,
        }
    }

    /// One coordinate of the position was measured `lag_s` local seconds ago.
    fn fix(
        &mut self,
        axis: usize,
        (value, variance): (f64, f64),
        since_m: &Vector3<f64>,
        lag_s: f64,
    ) -> Taken {
        let mut row = Vector::zeros();
        row[POSITION + axis] = 1.0;
        row[CURRENT + axis] = -lag_s;
        let innovation = value + since_m[axis] - row.dot(&self.filter.mean);
        self.filter.update(&Measurement { row, innovation, variance });
        Taken::Used
    }

    /// The true time was measured at `stamp`.
    fn set_clock(&mut self, (time_s, variance): (f64, f64), stamp: LocalTime, lag_s: f64) -> Taken {
        let mut row = Vector::zeros();
        row[OFFSET] = 1.0;
        row[RATE] = -lag_s;
        let innovation = time_s - stamp.as_s() - row.dot(&self.filter.mean);
        self.filter.update(&Measurement { row, innovation, variance });
        Taken::Used
    }

    /// Velocity over ground less that through the water is the current, and the state noise. That the same reading of the log
    /// carries the position on is neglected: one reading weighs little in the current.
    fn look_at_ground(
        &mut self,
        stamp: LocalTime,
        over_ground_m_s: &[Measured; 3],
        sensed: &Sensed,
    ) -> Taken {
        let attitude = sensed.events.iter().filter(|event| event.stamp == stamp).find_map(|event| {
            let Sense::Inertial { heading_rad, pitch_rad, speed_m_s } = event.sense else { return None };
            Some((heading_rad, pitch_rad, speed_m_s))
        });
        let Some((heading_rad, pitch_rad, speed_m_s)) = attitude else { return Taken::Ignored };
        let axes = body_axes(heading_rad.value, pitch_rad.value);
        let through_water = Log::new(heading_rad, pitch_rad, speed_m_s);
        let ground_m_s = axes * Vector3::from(over_ground_m_s.map(|along| along.value));
        let errors = over_ground_m_s.map(|along| half_width_variance(along.error));
        let seen = axes * Matrix3::from_diagonal(&Vector3::from(errors)) * axes.transpose();
        for axis in 0..3 {
            let mut row = Vector::zeros();
            row[CURRENT + axis] = 1.0;
            let current_m_s = ground_m_s[axis] - through_water.velocity_m_s[axis];
            self.filter.update(&Measurement {
                row,
                innovation: current_m_s - self.filter.mean[CURRENT + axis],
                variance: seen[(axis, axis)]
                    + through_water.covariance[(axis, axis)]
                    + self.told.disturbance[axis],
            });
        }
        Taken::Used
    }
}

/// What became of an event.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Taken {
    Used,
    Rejected,
    Ignored,
}

impl Told {
    fn new(body: &BodyBounds, drift: f64) -> Self {
        let noise = body.disturbance_m_s.map(uniform);
        // Were the state noise not centred, its mean would be one more current.
        let current_m_s = std::array::from_fn(|axis| {
            let (mean, variance) = uniform(body.current_m_s[axis]);
            (mean + noise[axis].0, variance)
        });
        Self {
            rate: half_width_variance(drift),
            current_m_s,
            current_change_m_s2: body.current_change_m_s2,
            current_step_m_s: body.current_step_m_s,
            disturbance: noise.map(|(_, variance)| variance),
            speed_m_s: body.speed_m_s,
            acceleration_m_s2: body.acceleration_m_s2,
        }
    }

    /// Covariance of what a stretch adds: `log` is that of the log's reading, `bend_m` the bound of what speeding up may add.
    fn noise(&self, log: &Matrix3<f64>, bend_m: f64, length_s: f64) -> Matrix {
        let mut noise = Matrix::zeros();
        let position_m2 = log * (length_s * length_s);
        noise.fixed_view_mut::<3, 3>(POSITION, POSITION).copy_from(&position_m2);
        // Whoever keeps its sign for T adds up, later on, to `2 T t` times its variance.
        noise[(OFFSET, OFFSET)] = 2.0 * self.rate * WANDER_S * length_s;
        noise[(RATE, RATE)] = 2.0 * self.rate * length_s / AGEING_S;
        for axis in 0..3 {
            noise[(POSITION + axis, POSITION + axis)] +=
                self.disturbance[axis] * length_s * length_s.max(NOISE_S) + half_width_variance(bend_m);
            let changed_m_s = self.current_change_m_s2[axis] * MEMORY_S + self.current_step_m_s[axis];
            noise[(CURRENT + axis, CURRENT + axis)] =
                half_width_variance(changed_m_s) * (length_s / MEMORY_S).min(1.0);
        }
        noise
    }

    /// What was told of rate and current holds at any time.
    fn limit(&self, filter: &mut Filter) {
        filter.limit(RATE, self.rate);
        for (axis, &(_, variance)) in self.current_m_s.iter().enumerate() {
            filter.limit(CURRENT + axis, variance);
        }
    }
}

impl Log {
    /// `R(heading, pitch) (speed, 0, 0)`, with the errors of all three to first order.
    fn new(heading_rad: Measured, pitch_rad: Measured, speed_m_s: Measured) -> Self {
        let axes = body_axes(heading_rad.value, pitch_rad.value);
        let speed = speed_m_s.value;
        let (_, cos_pitch) = f_sincos(pitch_rad.value);
        // A turn of the heading moves the velocity to port, by its level part; one of the pitch, up.
        let errors = Vector3::new(
            half_width_variance(speed_m_s.error),
            half_width_variance(heading_rad.error * speed * cos_pitch),
            half_width_variance(pitch_rad.error * speed),
        );
        Self {
            velocity_m_s: axes.column(0) * speed,
            covariance: axes * Matrix3::from_diagonal(&errors) * axes.transpose(),
        }
    }

    /// The same, `elapsed_s` local seconds later.
    fn worn(&self, told: &Told, elapsed_s: f64) -> Self {
        let more = half_width_variance(told.acceleration_m_s2 * elapsed_s);
        Self { covariance: self.covariance + Matrix3::from_diagonal_element(more), ..*self }
    }
}

/// Forward, port and up, as columns.
fn body_axes(heading_rad: f64, pitch_rad: f64) -> Matrix3<f64> {
    let (sin_heading, cos_heading) = f_sincos(heading_rad);
    let (sin_pitch, cos_pitch) = f_sincos(pitch_rad);
    Matrix3::from_columns(&[
        Vector3::new(cos_pitch * cos_heading, cos_pitch * sin_heading, sin_pitch),
        Vector3::new(-sin_heading, cos_heading, 0.0),
        Vector3::new(-sin_pitch * cos_heading, -sin_pitch * sin_heading, cos_pitch),
    ])
}

impl Estimator for Ekf {
    fn update(&mut self, sensed: &Sensed) -> Estimate {
        let before = box_of(&self.filter);
        let log = self.look_at_log(sensed);
        let length_s = seconds(sensed.stamp - self.now);
        let mean_m_s = (self.log.velocity_m_s + log.velocity_m_s) * 0.5;
        // A reading carries on half of the stretch before it and half of the one after, so all of it counts once. Between two readings
        // the body departs from a straight change by a quarter of acceleration times length squared at most.
        let bend_m = 0.25 * self.told.acceleration_m_s2 * length_s * length_s;
        let noise = self.told.noise(&log.covariance, bend_m, length_s);
        self.trail.append(sensed.stamp, mean_m_s * (1.0 + self.filter.mean[RATE]) * length_s);
        self.filter = self.moved(&mean_m_s, &noise, length_s);
        self.now = sensed.stamp;
        self.log = log;

        let (mut contractions, mut rejected) = (0, 0);
        for event in &sensed.events {
            match self.take_in(event, sensed) {
                Taken::Used => contractions += 1,
                Taken::Rejected => rejected += 1,
                Taken::Ignored => {}
            }
        }
        self.told.limit(&mut self.filter);
        let state = box_of(&self.filter);
        let slice = before.hull(&state);
        let gaussian = Some(gaussian(&self.filter, 0.0));
        Estimate { state, slice, emptied: None, contractions, rejected, components: 1, gaussian }
    }

    fn predict(&self, at: LocalTime) -> Prediction {
        let length_s = seconds(at - self.now).max(0.0);
        let bend_m = 0.5 * self.told.acceleration_m_s2 * length_s * length_s;
        let noise = self.told.noise(&self.log.covariance, bend_m, length_s);
        let filter = self.moved(&self.log.velocity_m_s, &noise, length_s);
        let state = box_of(&filter);
        let log = self.log.worn(&self.told, length_s);
        let current =
            |axis: usize| (filter.mean[CURRENT + axis], filter.covariance[(CURRENT + axis, CURRENT + axis)]);
        let over_ground = |axis: usize| {
            let (mean, variance) = current(axis);
            let variance = variance + self.told.disturbance[axis] + log.covariance[(axis, axis)];
            (mean + log.velocity_m_s[axis], variance)
        };
        Prediction {
            time_s: state.offset_s + Interval::centred(at.as_s(), 0.0),
            position_m: state.position_m,
            velocity_m_s: IntervalBox::from(std::array::from_fn(|axis| reach(over_ground(axis)))),
            current_m_s: IntervalBox::from(std::array::from_fn(|axis| reach(current(axis)))),
            gaussian: Some(gaussian(&filter, at.as_s())),
        }
    }
}

/// Three standard deviations to either side of the mean.
fn reach((mean, variance): (f64, f64)) -> Interval {
    Interval::centred(mean, REACH_SIGMA * variance.max(0.0).sqrt())
}

/// The box of a filter's position and clock.
fn box_of(filter: &Filter) -> State {
    let side = |index: usize| reach((filter.mean[index], filter.covariance[(index, index)]));
    State {
        offset_s: side(OFFSET),
        position_m: IntervalBox::from(std::array::from_fn(|axis| side(POSITION + axis))),
    }
}

/// What is reported and sent: position, and true minus local time with `local_s` added.
fn gaussian(filter: &Filter, local_s: f64) -> Gaussian {
    let mut mean: [f64; 4] = std::array::from_fn(|index| filter.mean[index]);
    mean[OFFSET] += local_s;
    let mut covariance = [0.0; 10];
    let pairs = (0..4).flat_map(|row| (row..4).map(move |column| (row, column)));
    for (entry, pair) in covariance.iter_mut().zip(pairs) {
        *entry = filter.covariance[pair];
    }
    Gaussian { mean, covariance }
}

#[cfg(test)]
mod tests;
