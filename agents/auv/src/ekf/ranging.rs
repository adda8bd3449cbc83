//! One-way ranging: what a ping says of the receiver's position and clock at once.
//!
//! Sound that left p_e at the true time t_e arrives at p when the own clock reads s, the true time being s + o:
//! `h = c (s + o - t_e) - |p - p_e|` is zero. That is one number measured, with the emitter's uncertainty, the speed of
//! sound and the timestamp for its error.
//!
//! A Gaussian as wide as the range is long does not see a straight line in `|p - p_e|`; the terms of second order that such a
//! filter needs, `tr(G) / 2` off the mean and `tr(G²) / 2` on the variance with `G = (I - u u') C / |p - p_e|`, are taken along
//! (Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 10.3.2).
//!
//! **Fusion.** What the emitter believes may come from what this AUV told before, or both from a third. `independent` ignores that.
//! `covariance-intersection` holds for any correlation: with `0 < w < 1` the receiver's covariance is taken as `P / w` and the
//! emitter's share of the measurement as `D / (1 - w)`, with the speed of sound, which is wrong for everyone alike;
//! beside these stands the share R that is certainly new (Julier and Uhlmann, A Non-divergent Estimation Algorithm in the Presence of
//! Unknown Correlations, 1997; the split form with R of the same authors' General Decentralized Data Fusion with Covariance
//! Intersection, 2001). All of P counts as perhaps shared. The w that leaves the least mean square error of position and clock, in
//! metres of sound, is searched for; where none leaves less than before, the ping says nothing.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use shoal_bus::message::{Bounds, Fusion};
use shoal_bus::ping::{GaussianPing, Payload, Ping};

use super::filter::{CURRENT, Filter, Measurement, OFFSET, POSITION, RATE, Vector};

/// The emitter at the emission.
#[derive(Clone, Copy, Debug)]
pub struct Emitter {
    position_m: Vector3<f64>,
    emission_s: f64,
    /// Of x, y, z in metres and the true time in seconds.
    covariance: Matrix4<f64>,
}

impl From<&GaussianPing> for Emitter {
    fn from(ping: &GaussianPing) -> Self {
        let [xx, xy, xz, xt, yy, yz, yt, zz, zt, tt] = ping.covariance;
        let covariance = Matrix4::new(xx, xy, xz, xt, xy, yy, yz, yt, xz, yz, zz, zt, xt, yt, zt, tt);
        Self { position_m: Vector3::from(ping.position_m), emission_s: ping.emission_s, covariance }
    }
}

impl From<&Ping> for Emitter {
    /// Intervals are taken as uniform and independent of each other.
    fn from(ping: &Ping) -> Self {
        let [x, y, z] = ping.position_m.map(uniform);
        let emission = uniform(ping.emission_s);
        Self {
            position_m: Vector3::new(x.0, y.0, z.0),
            emission_s: emission.0,
            covariance: Matrix4::from_diagonal(&Vector4::new(x.1, y.1, z.1, emission.1)),
        }
    }
}

impl From<&Payload> for Emitter {
    fn from(payload: &Payload) -> Self {
        match payload {
            Payload::Intervals(ping) => ping.into(),
            Payload::Gaussian(ping) => ping.into(),
        }
    }
}

/// Mean and variance of the uniform distribution within bounds: half a width is `b`, and the variance `b²/3`.
pub fn uniform(within: Bounds) -> (f64, f64) {
    (within.mid(), half_width_variance(0.5 * within.width()))
}

/// `b²/3`, the variance of the uniform distribution in `[-b, b]`.
pub fn half_width_variance(b: f64) -> f64 {
    b * b / 3.0
}

/// The receiver's side of a ping.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// Own clock's reading, in seconds.
    pub stamp_s: f64,
    /// How long ago that was, in local seconds.
    pub lag_s: f64,
    /// Displacement through the water since, in metres.
    pub since_m: Vector3<f64>,
}

/// What is believed of sound.
#[derive(Clone, Copy, Debug)]
pub struct Sound {
    /// Mean speed in m/s.
    pub speed_m_s: f64,
    /// Variance of the speed, in m²/s².
    pub speed_variance: f64,
    /// Variance of an arrival's stamp, in s².
    pub stamp_variance: f64,
}

/// A range as the filter sees it.
#[derive(Clone, Copy, Debug)]
struct Range {
    row: Vector,
    innovation: f64,
    /// Variance that may have been met before, in m²: of the emitter and of the speed of sound.
    shared: f64,
    /// Variance that is certainly new, in m².
    new: f64,
}

/// Takes in a ping; false when the gate rejects it. A ping that says nothing passes.
pub fn listen(
    filter: &mut Filter,
    emitter: &Emitter,
    arrival: &Arrival,
    sound: &Sound,
    (gate_sigma, fusion): (f64, Fusion),
) -> bool {
    let Some(range) = Range::new(filter, emitter, arrival, sound, fusion) else { return true };
    let own = filter.variance_along(&range.row).max(0.0);
    // Errors with an unknown correlation add up to no more than the square of the sum of their deviations: the least over w of what
    // covariance intersection takes them for.
    let expected = match fusion {
        Fusion::Independent => own + range.shared,
        Fusion::CovarianceIntersection => own + range.shared + 2.0 * (own * range.shared).sqrt(),
    } + range.new;
    if range.innovation * range.innovation > gate_sigma * gate_sigma * expected {
        return false;
    }
    let (weight, shared) = match fusion {
        Fusion::Independent => (1.0, range.shared),
        Fusion::CovarianceIntersection => match best_weight(filter, &range, sound.speed_m_s) {
            Some(weight) => (weight, range.shared / (1.0 - weight)),
            None => return true,
        },
    };
    filter.covariance /= weight;
    let variance = shared + range.new;
    filter.update(&Measurement { row: range.row, innovation: range.innovation, variance });
    true
}

impl Range {
    /// None where emitter and receiver are believed to be in one place, which has no direction.
    fn new(
        filter: &Filter,
        emitter: &Emitter,
        arrival: &Arrival,
        sound: &Sound,
        fusion: Fusion,
    ) -> Option<Self> {
        let Arrival { stamp_s, lag_s, since_m } = *arrival;
        let mean = &filter.mean;
        // The state then, from the state now; what odometry may have lost in between is neglected.
        let now_m = mean.fixed_rows::<3>(POSITION).into_owned();
        let position_m = now_m - since_m - mean.fixed_rows::<3>(CURRENT) * lag_s;
        let offset_s = mean[OFFSET] - mean[RATE] * lag_s;

        let apart_m = position_m - emitter.position_m;
        let distance_m = apart_m.norm();
        if distance_m.is_nan() || distance_m <= 1e-6 {
            return None;
        }
        let ray = apart_m / distance_m;
        let travel_s = stamp_s + offset_s - emitter.emission_s;
        let speed_m_s = sound.speed_m_s;

        let mut row = Vector::zeros();
        row.fixed_rows_mut::<3>(POSITION).copy_from(&-ray);
        row.fixed_rows_mut::<3>(CURRENT).copy_from(&(ray * lag_s));
        row[OFFSET] = speed_m_s;
        row[RATE] = -speed_m_s * lag_s;

        let own_m2 = filter.covariance.fixed_view::<3, 3>(POSITION, POSITION);
        // Whatever their correlation, two errors together have no more than twice the sum of their covariances.
        let together = if fusion == Fusion::Independent { 1.0 } else { 2.0 };
        let relative_m2 = (own_m2 + emitter.covariance.fixed_view::<3, 3>(0, 0)) * together;
        let curved = (Matrix3::identity() - ray * ray.transpose()) * relative_m2 / distance_m;

        let seen = Vector4::new(ray.x, ray.y, ray.z, -speed_m_s);
        Some(Self {
            row,
            innovation: distance_m + 0.5 * curved.trace() - speed_m_s * travel_s,
            shared: seen.dot(&(emitter.covariance * seen)).max(0.0)
                + sound.speed_variance * travel_s * travel_s,
            new: speed_m_s * speed_m_s * sound.stamp_variance + 0.5 * (curved * curved).trace().max(0.0),
        })
    }
}

/// The weight w of the receiver that leaves the least mean square error of position and clock; none when no weight leaves less than
/// there is.
fn best_weight(filter: &Filter, range: &Range, speed_m_s: f64) -> Option<f64> {
    let spread = filter.covariance * range.row;
    let seen = range.row.dot(&spread);
    let metric = [1.0, 1.0, 1.0, speed_m_s * speed_m_s];
    let before: f64 = (0..4).map(|axis| metric[axis] * filter.covariance[(axis, axis)]).sum();
    let gained: f64 = (0..4).map(|axis| metric[axis] * spread[axis] * spread[axis]).sum();
    let left = |weight: f64| {
        let expected = seen / weight + range.shared / (1.0 - weight) + range.new;
        before / weight - gained / (weight * weight * expected)
    };
    const PARTS: u32 = 64;
    let part = 1.0 / f64::from(PARTS);
    let mut best = part;
    for step in 2..PARTS {
        let weight = part * f64::from(step);
        if left(weight) < left(best) {
            best = weight;
        }
    }
    // Between its neighbours, thirds are cut off: twenty times leave a thousandth of one part.
    let (mut least, mut greatest) = ((best - part).max(0.25 * part), (best + part).min(1.0 - 0.25 * part));
    for _ in 0..20 {
        let third = (greatest - least) / 3.0;
        if left(least + third) < left(greatest - third) { greatest -= third } else { least += third }
    }
    let best = 0.5 * (least + greatest);
    (left(best) < before).then_some(best)
}
