//! A stretch of local time, of which any part may be asked for: what does not depend on the part is worked out once.

use shoal_interval::{Interval, IntervalBox};

use super::{Motion, Moved, Stretch, around};

/// What bounds the motion along a stretch.
///
/// A velocity component is caught under the lesser of two lines and above the greater of two others. A bound from below is kept as
/// one of the opposite direction from above, so that there are six directions, two along each axis, and one way to treat them.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    roofs: [[Roof; 2]; 3],
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
        let roof = |before_m_s: f64, after_m_s: f64, limit_m_s: f64| {
            let rising = before_m_s + slope * slack_s;
            let falling = after_m_s + slope * (stretch.length_s + slack_s);
            Roof { rising, falling, ridge_s: (falling - rising) / (2.0 * slope), limit: limit_m_s }
        };
        let limit = motion.speed_m_s;
        let drift_m_s = stretch.current_m_s + motion.disturbance_m_s;
        let rate = Interval::ONE + motion.gain;
        Self {
            roofs: std::array::from_fn(|axis| {
                let (before, after) = (stretch.before_m_s[axis], stretch.after_m_s[axis]);
                [
                    roof(-before.lower(), -after.lower(), -limit.lower()),
                    roof(before.upper(), after.upper(), limit.upper()),
                ]
            }),
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
        let mut means = [[0.0; 2]; 3];
        let mut mosts = [[0.0; 2]; 3];
        for axis in 0..3 {
            for end in 0..2 {
                let roof = &self.roofs[axis][end];
                (means[axis][end], mosts[axis][end]) = roof.mean_and_most(self.slope, from_s, to_s);
            }
        }
        let spanning = |ends: [f64; 2]| Interval::spanning(-ends[0], ends[1]);
        (IntervalBox::from(means.map(spanning)), IntervalBox::from(mosts.map(spanning)))
    }
}

/// `min(rising + slope x, falling - slope x, limit)`: how large a velocity component can be x seconds into a stretch.
#[derive(Clone, Copy, Debug)]
struct Roof {
    rising: f64,
    falling: f64,
    limit: f64,
    /// Where the lines cross.
    ridge_s: f64,
}

impl Roof {
    /// Upper bounds of the mean and of the maximum over `[from, to]`.
    #[inline(always)]
    fn mean_and_most(&self, slope: f64, from: f64, to: f64) -> (f64, f64) {
        // The roof is concave: where the lines cross it is highest, and a tangent never lies below it.
        let ridge = self.ridge_s.clamp(from, to);
        let at = |x: f64| (self.rising + slope * x).min(self.falling - slope * x);
        let most = at(ridge).max(at(from)).max(at(to)).min(self.limit);
        let (left, right) = (ridge - from, to - ridge);
        let length = to - from;
        // Mid-points of linear pieces are exact means; a limit inside a piece only lowers the roof.
        let rising_mean = (self.rising + slope * (from + 0.5 * left)).min(self.limit);
        let falling_mean = (self.falling - slope * (to - 0.5 * right)).min(self.limit);
        let both = (rising_mean * left + falling_mean * right) / length;
        let one = if left > 0.0 { rising_mean } else { falling_mean };
        let mean = if (left > 0.0) & (right > 0.0) { both } else { one };
        let mean = if length > 0.0 { mean } else { most };
        (rounded_up(mean), rounded_up(most))
    }
}

/// More than the dozen roundings above can have taken away: each is below 2⁻⁵³ of quantities that no speed limit exceeds
/// a thousandfold.
fn rounded_up(velocity_m_s: f64) -> f64 {
    velocity_m_s + 1e-11 * (1.0 + velocity_m_s.abs())
}
