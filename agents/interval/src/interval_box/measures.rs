//! How long, how large, how thick a box is, and how it grows.

use super::IntervalBox;
use crate::interval::Interval;
use crate::rounding::mul_up;
use nalgebra::SVector;

impl<const N: usize> IntervalBox<N> {
    /// The longest side, rounded up; NaN for the empty box. Source: seed 001, equation (2.22).
    pub fn width(&self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        self.sides.iter().map(|side| side.width()).fold(0.0, f64::max)
    }

    /// The product of the widths of the sides (length, area, volume), rounded up; 0 for the empty box, `+inf` for an
    /// unbounded one. A box with a side of width zero has no volume, however long its other sides are.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let area_m = IntervalBox::from([Interval::new(1.0, 3.0)?, Interval::new(1.0, 2.5)?]);
    /// assert_eq!(area_m.volume(), 3.0);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn volume(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        self.sides.iter().fold(1.0, |volume, side| mul_up(volume, side.width()))
    }

    /// The volume with both of its bounds, rounded outwards: what a sum of inner and outer volumes needs.
    ///
    /// The upper bound for an unbounded box is infinite; an unbounded side counts as at least about the largest `f64`.
    #[inline]
    pub fn volume_enclosure(&self) -> Interval {
        if self.is_empty() {
            return Interval::ZERO;
        }
        self.sides.iter().fold(Interval::ONE, |volume, &side| {
            let (lower, upper) = (side.lower(), side.upper());
            volume * (Interval::spanning(upper, upper) - Interval::spanning(lower, lower))
        })
    }

    /// Whether some side holds exactly one number, so that the box has no volume. The empty box is not flat.
    #[inline]
    pub fn is_flat(&self) -> bool {
        !self.is_empty() && self.sides.iter().any(|side| side.is_point())
    }

    /// Whether the box holds exactly one vector.
    #[inline]
    pub fn is_point(&self) -> bool {
        self.sides.iter().all(|side| side.is_point())
    }

    /// Everything within `radius` of the box along each axis, by the rules of [`Interval::inflate`].
    #[inline]
    pub fn inflate(&self, radius: f64) -> IntervalBox<N> {
        *self + IntervalBox { sides: [Interval::centred(0.0, radius); N] }
    }

    /// Everything within `radii[axis]` of the box along each axis, by the rules of [`Interval::inflate`].
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use shoal_interval::{Interval, IntervalBox};
    ///
    /// let drifted_m = IntervalBox::<2>::from(Vector2::new(0.0, 0.0)).inflate_axes(&Vector2::new(1.0, 0.25));
    /// assert_eq!(drifted_m[1], Interval::new(-0.25, 0.25)?);
    /// # Ok::<(), shoal_interval::IntervalError>(())
    /// ```
    #[inline]
    pub fn inflate_axes(&self, radii: &SVector<f64, N>) -> IntervalBox<N> {
        let mut around = [Interval::ZERO; N];
        for (side, &radius) in around.iter_mut().zip(radii.iter()) {
            *side = Interval::centred(0.0, radius);
        }
        *self + IntervalBox { sides: around }
    }
}
