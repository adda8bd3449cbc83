//! The sector of the points under a measured bearing, and what is not in it.

use super::{Contractor, contract_atan2};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// The points of the plane that are under a bearing in `bearing` from some point of `apex`; the apex itself is one of them.
/// Minimal for a single apex.
///
/// Radians from the `x` axis towards the `y` axis, modulo 2π.
///
/// ```
/// use shoal_interval::contractor::{Contractor, Sector};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let lighthouse = IntervalBox::from([Interval::ZERO, Interval::ZERO]);
/// let sector = Sector::new(lighthouse, Interval::new(0.2, 0.3)?);
/// let sea = IntervalBox::from([Interval::new(1.0, 10.0)?, Interval::new(-10.0, 10.0)?]);
/// assert_eq!(format!("{:.3}", sector.contract(sea)), "[1.000, 10.000] x [0.202, 3.094]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 3.5, equation (3.30).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sector {
    apex: IntervalBox<2>,
    bearing: Interval,
}

impl Sector {
    /// The points that `apex` sees under `bearing`.
    pub fn new(apex: IntervalBox<2>, bearing: Interval) -> Sector {
        Sector { apex, bearing }
    }

    /// The points that see `landmark` under `bearing`: the sector on the other side of the landmark.
    pub fn of_viewers(landmark: IntervalBox<2>, bearing: Interval) -> Sector {
        Sector { apex: landmark, bearing: bearing + Interval::PI }
    }

    /// The contractor for what is not in the sector.
    ///
    /// With an apex that is not a single point, it is what may be out of the sector of *some* apex.
    pub fn complement(self) -> SectorComplement {
        let bearing = if self.bearing.is_empty() {
            Interval::ENTIRE
        } else {
            let turned = Interval::spanning(self.bearing.lower(), self.bearing.lower()) + Interval::TWO_PI;
            Interval::new(self.bearing.upper(), turned.upper()).unwrap_or(Interval::EMPTY)
        };
        SectorComplement { rest: Sector { apex: self.apex, bearing } }
    }
}

impl Contractor<2> for Sector {
    #[inline]
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        let difference = domain - self.apex;
        let ([mut x, mut y], mut bearing) = (difference.sides(), self.bearing);
        contract_atan2(&mut x, &mut y, &mut bearing);
        let contracted = IntervalBox::from([x, y]);
        // What was not contracted is not to be widened by rounding; the intersection sees to that.
        (self.apex + contracted) & domain
    }
}

/// The points under no bearing of a sector, its boundary included: bearings in `[b⁺, b⁻ + 2π]`; made by
/// [`Sector::complement`]. Minimal for a single apex.
///
/// The complement of a sector of a full turn or more is empty.
///
/// ```
/// use shoal_interval::contractor::{Contractor, Sector};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let ahead = Sector::new(IntervalBox::from([Interval::ZERO; 2]), Interval::new(-1.0, 1.0)?);
/// let domain = IntervalBox::from([Interval::new(-2.0, 5.0)?, Interval::new(-0.5, 0.5)?]);
/// assert_eq!(format!("{:.2}", ahead.complement().contract(domain)), "[-2.00, 0.33] x [-0.50, 0.50]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectorComplement {
    rest: Sector,
}

impl Contractor<2> for SectorComplement {
    #[inline]
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        self.rest.contract(domain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;
    use proptest::prelude::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn a_sector_and_its_complement_cover_everything(
            (x, y) in (-9.0..9.0_f64, -9.0..9.0_f64), (bearing, width) in (-20.0..20.0_f64, 0.0..8.0_f64), radius in 0.0..3.0_f64,
        ) {
            let sector = Sector::new(IntervalBox::from([Interval::ONE; 2]), over(bearing, bearing + width));
            let point = Vector2::new(x, y);
            let domain = IntervalBox::centred(&point, radius);
            let (inside, outside) = (sector.contract(domain), sector.complement().contract(domain));
            prop_assert!(inside.contains(&point) || outside.contains(&point));
            prop_assert!(inside.is_subset_of(&domain) && outside.is_subset_of(&domain));
            let at_point = IntervalBox::centred(&point, 0.0);
            let (inside, outside) = (sector.contract(at_point), sector.complement().contract(at_point));
            let to_boundary = |boundary: f64| {
                let (sine, cosine) = pxfm::f_sincos(boundary);
                (sine * (x - 1.0) - cosine * (y - 1.0)).abs()
            };
            if to_boundary(bearing) > 1e-9 && to_boundary(bearing + width) > 1e-9 {
                prop_assert!(inside.is_empty() != outside.is_empty() || width > 6.2);
            }
        }

        #[test]
        fn a_viewer_sees_what_it_sees((x, y) in (-9.0..9.0_f64, -9.0..9.0_f64), radius in 0.0..20.0_f64) {
            let landmark = IntervalBox::from([Interval::ONE; 2]);
            let bearing = pxfm::f_atan2(1.0 - y, 1.0 - x);
            let viewers = Sector::of_viewers(landmark, Interval::centred(bearing, 1e-12));
            let point = Vector2::new(x, y);
            prop_assert!(viewers.contract(IntervalBox::centred(&point, radius)).contains(&point));
        }
    }

    #[test]
    fn nothing_and_everything() {
        let apex = IntervalBox::from([Interval::ZERO; 2]);
        let domain = IntervalBox::from([over(1.0, 2.0); 2]);
        assert!(Sector::new(apex, Interval::EMPTY).contract(domain).is_empty());
        assert_eq!(Sector::new(apex, Interval::EMPTY).complement().contract(domain), domain);
        assert_eq!(Sector::new(apex, Interval::ENTIRE).contract(domain), domain);
        assert!(Sector::new(apex, Interval::ENTIRE).complement().contract(domain).is_empty());
        assert!(Sector::new(apex, over(0.0, 6.5)).complement().contract(domain).is_empty());
        assert_eq!(Sector::new(apex, over(0.0, 0.1)).contract(apex), apex);
    }
}
