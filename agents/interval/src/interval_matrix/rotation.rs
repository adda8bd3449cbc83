//! Rotations by angles that are only known to lie in intervals.
//!
//! Angles are in radians. A rotation takes a vector from the frame of the vehicle to the outer one, its transpose takes
//! it back. An empty angle gives the empty matrix, an unbounded one every rotation about its axis.
//!
//! Source: seed 003, section 5.

use super::IntervalMatrix;
use crate::interval::Interval;

impl IntervalMatrix<2, 2> {
    /// The rotations of the plane by a heading, in radians, from the first axis to the second. Each entry is as tight as
    /// [`Interval::sin`] and [`Interval::cos`].
    #[inline]
    pub fn rotation_2d(heading: Interval) -> IntervalMatrix<2, 2> {
        let (sin, cos) = heading.sin_cos();
        IntervalMatrix { rows: [[cos, -sin], [sin, cos]] }
    }
}

impl IntervalMatrix<3, 3> {
    /// The rotations about the first axis by an angle in radians: `R(phi)` of a roll. As tight as sine and cosine.
    #[inline]
    pub fn rotation_x(angle: Interval) -> IntervalMatrix<3, 3> {
        let (sin, cos) = angle.sin_cos();
        let (zero, one) = (Interval::ZERO, Interval::ONE);
        IntervalMatrix { rows: [[one, zero, zero], [zero, cos, -sin], [zero, sin, cos]] }.or_empty()
    }

    /// The rotations about the second axis by an angle in radians: `R(theta)` of a pitch. As tight as sine and cosine.
    #[inline]
    pub fn rotation_y(angle: Interval) -> IntervalMatrix<3, 3> {
        let (sin, cos) = angle.sin_cos();
        let (zero, one) = (Interval::ZERO, Interval::ONE);
        IntervalMatrix { rows: [[cos, zero, sin], [zero, one, zero], [-sin, zero, cos]] }.or_empty()
    }

    /// The rotations about the third axis by an angle in radians: `R(psi)` of a yaw. As tight as sine and cosine.
    #[inline]
    pub fn rotation_z(angle: Interval) -> IntervalMatrix<3, 3> {
        let (sin, cos) = angle.sin_cos();
        let (zero, one) = (Interval::ZERO, Interval::ONE);
        IntervalMatrix { rows: [[cos, -sin, zero], [sin, cos, zero], [zero, zero, one]] }.or_empty()
    }

    /// The rotations `R(yaw) R(pitch) R(roll)`, `R(psi) R(theta) R(phi)`: from the frame of a vehicle to that of the world.
    ///
    /// No rotation is lost. The five entries that are single products are minimal up to rounding. The four others use
    /// angles twice; where one only rises or only falls with an angle, as it does for most narrow angles, the two
    /// bounds are taken at the ends of that angle, which makes them minimal up to rounding when this holds for all
    /// angles. The result is a subset of the product of the three matrices.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalMatrix};
    ///
    /// let about = |angle_rad: f64| Interval::centred(angle_rad, 0.01);
    /// let (yaw, pitch, roll) = (about(0.7), about(0.2), about(-0.1));
    /// let attitude = IntervalMatrix::rotation(yaw, pitch, roll);
    /// let product =
    ///     IntervalMatrix::rotation_z(yaw) * IntervalMatrix::rotation_y(pitch) * IntervalMatrix::rotation_x(roll);
    /// assert!(attitude.is_subset_of(&product));
    /// assert!(attitude[(0, 1)].width() < 0.9 * product[(0, 1)].width());
    /// ```
    pub fn rotation(yaw: Interval, pitch: Interval, roll: Interval) -> IntervalMatrix<3, 3> {
        if yaw.is_empty() || pitch.is_empty() || roll.is_empty() {
            return IntervalMatrix::EMPTY;
        }
        let angles = [yaw, pitch, roll].map(Angle::new);
        let [(sin_yaw, cos_yaw), (sin_pitch, cos_pitch), (sin_roll, cos_roll)] =
            angles.map(|angle| angle.whole);
        let natural = FullEntries::at(angles.map(|angle| angle.whole));
        // The slopes of these entries with yaw and roll are such entries again; those with pitch are products.
        let slopes = &natural;
        let (across, down) = (cos_pitch * sin_roll, cos_pitch * cos_roll);
        let tightened = |entry: fn(&FullEntries) -> Interval, slopes: [Interval; 3]| {
            let upper = FullEntries::at(at_extreme(&angles, slopes));
            let lower = FullEntries::at(at_extreme(&angles, slopes.map(|slope| -slope)));
            // The smallest value is not above the largest one, so neither are the bounds that enclose them.
            entry(&natural) & Interval::from_bounds(entry(&lower).lower(), entry(&upper).upper())
        };
        IntervalMatrix {
            rows: [
                [
                    cos_pitch * cos_yaw,
                    tightened(|full| full.top, [-slopes.bottom, across * cos_yaw, slopes.top_right]),
                    tightened(|full| full.top_right, [-slopes.bottom_right, down * cos_yaw, -slopes.top]),
                ],
                [
                    cos_pitch * sin_yaw,
                    tightened(|full| full.bottom, [slopes.top, across * sin_yaw, slopes.bottom_right]),
                    tightened(|full| full.bottom_right, [slopes.top_right, down * sin_yaw, -slopes.bottom]),
                ],
                [-sin_pitch, across, down],
            ],
        }
    }
}

/// Sine and cosine.
type SineCosine = (Interval, Interval);

/// Sine and cosine of all of an angle and of its ends; an end that is missing is all of the angle.
#[derive(Clone, Copy)]
struct Angle {
    whole: SineCosine,
    at_lower: SineCosine,
    at_upper: SineCosine,
}

impl Angle {
    fn new(angle: Interval) -> Angle {
        let whole = angle.sin_cos();
        let end = |end: f64| if end.is_finite() { Interval::spanning(end, end).sin_cos() } else { whole };
        Angle { whole, at_lower: end(angle.lower()), at_upper: end(angle.upper()) }
    }
}

/// Where an entry with these slopes along the three angles is largest: at an end of each angle along which the entry only
/// rises or only falls, anywhere in the others.
fn at_extreme(angles: &[Angle; 3], slopes: [Interval; 3]) -> [SineCosine; 3] {
    std::array::from_fn(|axis| {
        let (angle, slope) = (&angles[axis], slopes[axis]);
        if slope.lower() >= 0.0 {
            angle.at_upper
        } else if slope.upper() <= 0.0 {
            angle.at_lower
        } else {
            angle.whole
        }
    })
}

/// The entries of the Euler matrix that are sums of products: those of its first two rows and last two columns.
struct FullEntries {
    top: Interval,
    top_right: Interval,
    bottom: Interval,
    bottom_right: Interval,
}

impl FullEntries {
    /// The entries for the sine and cosine of yaw, pitch and roll.
    fn at([(sin_yaw, cos_yaw), (sin_pitch, _), (sin_roll, cos_roll)]: [SineCosine; 3]) -> FullEntries {
        // In the order of the product of the three matrices, so that the rounding is the same.
        let (ahead, aside) = (cos_yaw * sin_pitch, sin_yaw * sin_pitch);
        FullEntries {
            top: ahead * sin_roll - sin_yaw * cos_roll,
            top_right: ahead * cos_roll + sin_yaw * sin_roll,
            bottom: aside * sin_roll + cos_yaw * cos_roll,
            bottom_right: aside * cos_roll - cos_yaw * sin_roll,
        }
    }
}
