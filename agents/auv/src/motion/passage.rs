//! A stretch of local time, of which any part may be asked for: what does not depend on the part is worked out once.

use nalgebra::Vector3;
use shoal_interval::{Interval, IntervalBox};

use super::{Motion, Moved, Stretch, around};

/// What bounds the motion along a stretch.
///
/// A velocity component is caught under the lesser of two lines and above the greater of two others. A bound from below is kept as
/// one of the opposite direction from above, so that there are six directions, two along each axis, and one way to treat them.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    roofs: Roofs,
    /// Change of velocity per local second, at most, in m/s².
    slope: f64,
    /// Current and disturbance, in m/s.
    drift_m_s: IntervalBox<3>,
    /// The same in metres per local second.
    local_drift_m_s: IntervalBox<3>,
    /// True seconds gained per local second.
    gain: Interval,
    /// True seconds per local second.
    rate: Interval,
    stamp_s: f64,
}

impl Passage {
    pub(super) fn new(motion: &Motion, stretch: &Stretch) -> Self {
        let slope = motion.slope;
        let slack_s = 2.0 * motion.stamp_s;
        let mut roofs = Roofs { rising: [0.0; 8], falling: [0.0; 8], ridge_s: [0.0; 8], limit: [0.0; 8] };
        let mut roof = |direction: usize, before_m_s: f64, after_m_s: f64, limit_m_s: f64| {
            roofs.rising[direction] = before_m_s + slope * slack_s;
            roofs.falling[direction] = after_m_s + slope * (stretch.length_s + slack_s);
            roofs.ridge_s[direction] = (roofs.falling[direction] - roofs.rising[direction]) / (2.0 * slope);
            roofs.limit[direction] = limit_m_s;
        };
        let limit = motion.speed_m_s;
        for axis in 0..3 {
            let (before, after) = (stretch.before_m_s[axis], stretch.after_m_s[axis]);
            roof(2 * axis, -before.lower(), -after.lower(), -limit.lower());
            roof(2 * axis + 1, before.upper(), after.upper(), limit.upper());
        }
        let drift_m_s = stretch.current_m_s + motion.disturbance_m_s;
        let rate = Interval::ONE + motion.gain;
        Self {
            roofs,
            slope,
            drift_m_s,
            local_drift_m_s: drift_m_s * rate,
            gain: motion.gain,
            rate,
            stamp_s: motion.stamp_s,
        }
    }

    /// What can have happened from `from_s` to `to_s` local seconds after the beginning.
    pub fn over(&self, from_s: f64, to_s: f64) -> Moved {
        let elapsed_s = around(to_s - from_s, self.stamp_s);
        let so_far_s = Interval::ZERO.hull(elapsed_s);
        let (mean_m_s, reached_m_s) = self.velocity(from_s, to_s);
        let within_m = (reached_m_s + self.drift_m_s) * self.rate * so_far_s;
        // dt = (1 + gain) ds: the mean for the 1, every velocity reached for the gain. Where the clock is bad and the velocity
        // nearly known, the gain of each velocity is worth more than the mean.
        let by_mean_m_s = mean_m_s + reached_m_s * self.gain + self.local_drift_m_s;
        Moved {
            displacement_m: (by_mean_m_s * elapsed_s).intersection(&within_m),
            within_m,
            offset_gain_s: self.gain * elapsed_s,
            offset_within_s: self.gain * so_far_s,
        }
    }

    /// The mean velocities, and all velocities reached, between two moments given in local seconds from the beginning.
    fn velocity(&self, from_s: f64, to_s: f64) -> (IntervalBox<3>, IntervalBox<3>) {
        let (means, mosts) = self.roofs.means_and_mosts(self.slope, from_s, to_s);
        let spanning = |[west, east, south, north, down, up, _, _]: [f64; 8]| {
            IntervalBox::spanning(&-Vector3::new(west, south, down), &Vector3::new(east, north, up))
        };
        (spanning(means), spanning(mosts))
    }
}

/// `min(rising + slope x, falling - slope x, limit)` in each direction: how large a velocity component can be x seconds into a
/// stretch: each axis backwards and forwards, and two places that mean nothing, so that there are whole vectors for the processor.
#[derive(Clone, Copy, Debug)]
struct Roofs {
    rising: [f64; 8],
    falling: [f64; 8],
    /// Where the lines cross.
    ridge_s: [f64; 8],
    limit: [f64; 8],
}

impl Roofs {
    /// Upper bounds of the means and of the maxima over `[from, to]`.
    fn means_and_mosts(&self, slope: f64, from: f64, to: f64) -> ([f64; 8], [f64; 8]) {
        let length = to - from;
        let (mut means, mut mosts) = ([0.0; 8], [0.0; 8]);
        for direction in 0..8 {
            let (rising, falling) = (self.rising[direction], self.falling[direction]);
            let limit = self.limit[direction];
            // The roof is concave: where the lines cross it is highest, and a tangent never lies below it.
            let ridge = self.ridge_s[direction].clamp(from, to);
            let at = |x: f64| (rising + slope * x).min(falling - slope * x);
            let most = at(ridge).max(at(from)).max(at(to)).min(limit);
            let (left, right) = (ridge - from, to - ridge);
            // Mid-points of linear pieces are exact means; a limit inside a piece only lowers the roof.
            let rising_mean = (rising + slope * (from + 0.5 * left)).min(limit);
            let falling_mean = (falling - slope * (to - 0.5 * right)).min(limit);
            let both = (rising_mean * left + falling_mean * right) / length;
            let one = if left > 0.0 { rising_mean } else { falling_mean };
            let mean = if (left > 0.0) & (right > 0.0) { both } else { one };
            let mean = if length > 0.0 { mean } else { most };
            (means[direction], mosts[direction]) = (rounded_up(mean), rounded_up(most));
        }
        (means, mosts)
    }
}

/// More than the dozen roundings above can have taken away: each is below 2⁻⁵³ of quantities that no speed limit exceeds
/// a thousandfold.
fn rounded_up(velocity_m_s: f64) -> f64 {
    velocity_m_s + 1e-11 * (1.0 + velocity_m_s.abs())
}
