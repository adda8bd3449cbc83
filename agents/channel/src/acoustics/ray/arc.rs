//! One arc: what a ray does in a layer of one gradient.

use pxfm::{f_atan, f_atanh};

/// The part of a ray inside one layer, where it is an arc of a circle. It is fixed by the horizontal and vertical distance of its ends, the mean of the speeds at them
/// and the gradient.
///
/// With `K² = c̄² + (g r / 2)²` and the chord `d`, the travel time is `2 artanh(g d / 2K) / |g|`: the closed form
/// `acosh(1 + g² d² / (2 c1 c2)) / |g|`, rewritten so that nothing cancels for weak gradients and short arcs. It becomes `d / c̄`
/// as the gradient vanishes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// Horizontal distance of the ends, in metres.
    pub range_m: f64,
    /// Vertical distance of the ends, in metres.
    pub depth_m: f64,
    /// Mean of the speeds of sound at the ends, in m/s.
    pub mean_speed_m_s: f64,
    /// Gradient of the speed of sound, of any sign, in 1/s.
    pub gradient_1_s: f64,
}

impl Arc {
    /// How the ray from the upper to the lower end leaves and arrives. The ends must not be one point.
    pub fn ends(&self) -> Ends {
        let chord_m = (self.range_m * self.range_m + self.depth_m * self.depth_m).sqrt();
        let bend_m_s = 0.5 * self.gradient_1_s * self.range_m;
        let speed_m_s = (self.mean_speed_m_s * self.mean_speed_m_s + bend_m_s * bend_m_s).sqrt();
        let scale = 1.0 / (chord_m * speed_m_s);
        let (straight, bent) = (self.depth_m * self.mean_speed_m_s, bend_m_s * self.range_m);
        Ends {
            slowness_s_m: self.range_m * scale,
            first_down: (straight + bent) * scale,
            last_down: (straight - bent) * scale,
        }
    }

    /// Travel time in seconds and length in metres.
    #[inline]
    pub fn measure(&self) -> (f64, f64) {
        let chord_m2 = self.range_m * self.range_m + self.depth_m * self.depth_m;
        let bend_m_s = 0.5 * self.gradient_1_s * self.range_m;
        let speed_m2_s2 = self.mean_speed_m_s * self.mean_speed_m_s + bend_m_s * bend_m_s;
        let travel_s2 = chord_m2 / speed_m2_s2;
        let half_1_s = 0.5 * self.gradient_1_s;
        let turn = bend_m_s / self.mean_speed_m_s;
        (
            travel_s2.sqrt() * inverse_tangent_ratio(half_1_s * half_1_s * travel_s2),
            // Half the arc's angle has the tangent `turn`.
            (chord_m2 * (1.0 + turn * turn)).sqrt() * inverse_tangent_ratio(-turn * turn),
        )
    }
}

/// The ends of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    /// Horizontal slowness in s/m.
    pub slowness_s_m: f64,
    /// Sine of the grazing angle at the upper end, positive downwards.
    pub first_down: f64,
    /// Sine of the grazing angle at the lower end, positive downwards.
    pub last_down: f64,
}

/// `artanh(x) / x` with x² = `square` if that is positive, `arctan(x) / x` with x² = -`square` if it is negative: one smooth function.
#[inline]
fn inverse_tangent_ratio(square: f64) -> f64 {
    let u = square;
    if u.abs() < 1e-3 {
        // The term left out is below 1e-18 / 13.
        1.0 + u * (1.0 / 3.0 + u * (0.2 + u * (1.0 / 7.0 + u * (1.0 / 9.0 + u * (1.0 / 11.0)))))
    } else {
        far_inverse_tangent_ratio(square)
    }
}

#[cold]
fn far_inverse_tangent_ratio(square: f64) -> f64 {
    let x = square.abs().sqrt();
    if square > 0.0 { f_atanh(x) / x } else { f_atan(x) / x }
}
