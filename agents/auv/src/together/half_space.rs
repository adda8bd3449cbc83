//! A ring between two parallel planes: what is linear about a ping.
//!
//! Position and clock are told relative to the middle of the box that is to be contracted: `q = (p - p_mid, S (o - o_mid))`, S scaling
//! seconds to something like metres. With d from the ring's centre to the receiver and any unit vector u, `u d <= |d|`, and
//! `|d| <= u d + k` as far as d is in a box on whose corners `|d| - u d`, which is convex, is at most k. So
//! `|d| = c (t - a)` lies between two planes, the closer the smaller the box is beside the range.
//!
//! Everything is computed to nearest and the bound moved outwards by more than all roundings together: none is above 2⁻⁵³ of
//! the sum of magnitudes, and there are fewer than 50.

use nalgebra::{Vector3, Vector4};
use shoal_interval::{Interval, IntervalBox};

use crate::rings::Ring;
use crate::state::{Sound, State};

/// Metres for a second, a power of two so that scaling is exact.
const SCALE_M_S: f64 = 1024.0;
/// More than what roundings can take away, as a part of the sum of magnitudes.
pub(super) const SLACK: f64 = 1e-14;

/// `normal q <= bound`.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    pub normal: Vector4<f64>,
    pub bound: f64,
    /// Which ring it comes from.
    pub ring: usize,
}

impl HalfSpace {
    /// All of space.
    pub const NONE: Self = Self { normal: Vector4::new(0.0, 0.0, 0.0, 0.0), bound: 0.0, ring: 0 };
}

/// The box that is contracted, around the origin of q.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    middle: Vector4<f64>,
    pub lower: Vector4<f64>,
    pub upper: Vector4<f64>,
}

impl Frame {
    pub fn new(state: &State) -> Self {
        let [x, y, z] = state.position_m.sides();
        let sides = IntervalBox::from([x, y, z, state.offset_s]);
        let middle = sides.mid();
        let [x, y, z, offset_s] = (sides - IntervalBox::from(middle)).sides();
        let offset_m = offset_s * SCALE_M_S;
        Self {
            middle,
            lower: Vector4::new(x.lower(), y.lower(), z.lower(), offset_m.lower()),
            upper: Vector4::new(x.upper(), y.upper(), z.upper(), offset_m.upper()),
        }
    }

    /// The side along an axis between two bounds of q.
    pub fn side(&self, axis: usize, lower: f64, upper: f64) -> Interval {
        Interval::spanning(lower, upper) * (1.0 / scale(axis)) + self.middle[axis]
    }

    /// The largest value of `normal q`, rounding aside.
    pub fn most(&self, normal: &Vector4<f64>) -> f64 {
        (0..4).map(|axis| (normal[axis] * self.lower[axis]).max(normal[axis] * self.upper[axis])).sum()
    }

    /// Whether a plane of a ring leaves out a part of the box.
    pub fn is_cut_by(&self, ring: &Ring, sound: &Sound) -> bool {
        self.planes(ring, 0, sound).iter().any(Option::is_some)
    }

    /// The planes of a ring that leave out a part of the box; none when its centre is the middle of the box.
    pub fn planes(&self, ring: &Ring, index: usize, sound: &Sound) -> [Option<HalfSpace>; 2] {
        let centre_m: IntervalBox<3> = ring.emitter_m + ring.since.displacement_m;
        let [x, y, z, _] = self.middle.into();
        let centre_m = (centre_m - IntervalBox::from(Vector3::new(x, y, z))).sides();
        // From emission to reception, if the clock is off by as much as in the middle of the box.
        let delay_s = ring.arrival_s - ring.since.offset_gain_s - ring.emission_s + self.middle[3];

        let from_m = centre_m.map(|side| -side.mid());
        let range_m = (from_m[0] * from_m[0] + from_m[1] * from_m[1] + from_m[2] * from_m[2]).sqrt();
        // Also false for what is not a number.
        let is_aimed = range_m > 1e-6 && range_m < 1e12;
        if !is_aimed {
            return [None; 2];
        }
        let unit = from_m.map(|side| side / range_m);

        let (mut least, mut most, mut magnitude) = (0.0, 0.0, 0.0);
        // Of `|d|²` and of `u d`, at both ends of each axis.
        let mut squares = [[0.0; 2]; 3];
        let mut along = [[0.0; 2]; 3];
        for axis in 0..3 {
            let side = centre_m[axis];
            let (one, other) = (unit[axis] * side.lower(), unit[axis] * side.upper());
            least += one.min(other);
            most += one.max(other);
            let ends = [self.lower[axis] - side.upper(), self.upper[axis] - side.lower()];
            squares[axis] = ends.map(|end| end * end);
            along[axis] = ends.map(|end| unit[axis] * end);
            magnitude += ends[0].abs().max(ends[1].abs()) + side.magnitude();
        }
        // A unit vector is longer than one by rounding: so is sound faster.
        let (slow, fast) = (sound.speed_m_s.lower(), sound.speed_m_s.upper() * (1.0 + 8.0 * f64::EPSILON));
        let slack_m = SLACK * (magnitude + fast * delay_s.magnitude());
        let [x, y, z] = unit;
        let near = HalfSpace {
            normal: Vector4::new(x, y, z, -fast / SCALE_M_S),
            bound: most + fast * delay_s.upper() + slack_m,
            ring: index,
        };
        let mut far = HalfSpace {
            normal: Vector4::new(-x, -y, -z, slow / SCALE_M_S),
            bound: -least - slow * delay_s.lower() + slack_m,
            ring: index,
        };
        let cuts = |plane: &HalfSpace| self.most(&plane.normal) > plane.bound;
        if !cuts(&far) {
            return [Some(near).filter(cuts), None];
        }
        let mut bends_m = [0.0; 8];
        for (corner, bend_m) in bends_m.iter_mut().enumerate() {
            let (x, y, z) = (corner & 1, corner >> 1 & 1, corner >> 2);
            let length_m = (squares[0][x] + squares[1][y] + squares[2][z]).sqrt();
            *bend_m = length_m - (along[0][x] + along[1][y] + along[2][z]);
        }
        let bend_m = bends_m.into_iter().fold(0.0, f64::max);

        far.bound += bend_m;
        [near, far].map(|plane| Some(plane).filter(cuts))
    }
}

fn scale(axis: usize) -> f64 {
    if axis == 3 { SCALE_M_S } else { 1.0 }
}
