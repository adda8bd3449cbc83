//! Exact rays in horizontally layered water.
//!
//! Where the speed of sound changes linearly with depth, a ray is an arc of a circle, and its travel time has a closed form
//! (Jensen et al., *Computational Ocean Acoustics*, section 3.3). A ray keeps its horizontal slowness `p = cos(grazing angle) / c` through all layers and
//! bounces (Snell's law), so finding the ray between two points is finding `p`. Nothing here is integrated numerically: what is left is
//! rounding, below 0.01 ns for points up to 10 km apart.
//!
//! # What is found
//! The direct ray is the fastest one that touches neither surface nor bottom and turns at most once between up and down. A ray
//! of a bounced path runs from boundary to boundary without turning in between. Left out are rays that turn in the water more than once (a duct's
//! after several cycles), bounced ones that turn on the way, and what diffraction brings into a shadow zone.
//!
//! # Guarantees
//! - Reciprocity: emitter and receiver exchanged, the same travel time and length to the last bit, the directions exchanged. (With
//!   a guess, both are the same but for rounding; the length then to a millionth.)
//! - A ray is never faster than the straight line at the greatest speed of its water. A direct one that keeps going down or up is
//!   never slower than sound along the straight line, nor along any other way between the two depths. (One that turns may be,
//!   where the straight line runs through a layer of fast water that lets no ray along.)
//! - The travel time grows by the horizontal slowness per metre of range, and by `sin / c` of the arrival per metre that the receiver
//!   moves against or along it: it is differentiable but where the fastest ray changes.
//! - A guess changes the cost and the last bits, not which ray is found. No input makes a panic or a NaN.
//!
//! ```
//! use shoal_channel::acoustics::profile::{Node, Profile};
//! use shoal_channel::acoustics::ray::{Boundary, WaterColumn};
//!
//! // 1500 m/s at the surface and 0.017 m/s more with every metre.
//! let node = |depth_m: f64| Node { depth_m, speed_m_s: 1500.0 + 0.017 * depth_m };
//! let water = WaterColumn::new(Profile::new(&[node(0.0), node(200.0)])?, 200.0);
//!
//! let direct = water.direct(20.0, 200.0, 2_000.0, None).expect("no shadow here");
//! assert!((direct.travel_s - 1.337027492).abs() < 1e-9);
//! let echo = water.bounced(Boundary::Surface, 1, 20.0, 200.0, 2_000.0, None).expect("not too far");
//! assert!(echo.travel_s > direct.travel_s && echo.departure.sin > 0.0);
//! # Ok::<(), shoal_channel::acoustics::profile::ProfileError>(())
//! ```

mod arc;
mod column;
mod route;
mod solve;
#[cfg(test)]
mod tests;
mod trace;

pub use self::column::WaterColumn;
pub use self::trace::Waypoint;
pub use shoal_bus::traffic::{Boundary, SoundPath};

/// The direction of a ray at a point: the direction in which sound travels, seen from the side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// Cosine of the grazing angle, its horizontal part: not negative.
    pub cos: f64,
    /// Sine of the grazing angle, its vertical part: positive upwards.
    pub sin: f64,
}

/// A ray from emitter to receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Travel time in seconds.
    pub travel_s: f64,
    /// Length along the ray in metres.
    pub length_m: f64,
    /// Horizontal slowness in s/m, the same all along the ray: the travel time's derivative with respect to range.
    pub slowness_s_m: f64,
    /// Direction at the emitter.
    pub departure: Direction,
    /// Direction at the receiver.
    pub arrival: Direction,
}

impl Ray {
    /// The direction of the ray, but for up or down, where the speed of sound is `speed_m_s`: at a boundary, what its
    /// reflection loss depends on. `sin` is zero for speeds that the ray turns before.
    pub fn grazing(&self, speed_m_s: f64) -> Direction {
        let cos = self.slowness_s_m * speed_m_s;
        let square = (1.0 - cos) * (1.0 + cos);
        Direction { cos: cos.min(1.0), sin: square.max(0.0).sqrt() }
    }

    /// Whether it keeps going down or up, as far as its ends tell.
    fn keeps_going(&self) -> bool {
        self.departure.sin * self.arrival.sin > 0.0
    }
}
