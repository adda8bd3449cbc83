//! The ring of the points at a measured distance from a centre, and what is not in it.

use super::{Contractor, contract_distance};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// The points at a distance in `range` of some point of `centre`: a disc, a circle or a ring in the plane, a shell in
/// space. Minimal.
///
/// ```
/// use shoal_interval::contractor::{Contractor, Ring};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let beacon = IntervalBox::from([Interval::ZERO, Interval::ZERO]);
/// let ring = Ring::new(beacon, Interval::new(4.0, 5.0)?);
/// let right = IntervalBox::from([Interval::new(0.0, 9.0)?, Interval::new(-3.0, 0.0)?]);
/// assert_eq!(format!("{:.2}", ring.contract(right)), "[2.64, 5.00] x [-3.00, 0.00]");
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, table 2.1; seed 000, equation (2.35).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring<const N: usize> {
    centre: IntervalBox<N>,
    range: Interval,
}

impl<const N: usize> Ring<N> {
    /// The ring around `centre`; a negative part of `range` is ignored.
    pub fn new(centre: IntervalBox<N>, range: Interval) -> Ring<N> {
        Ring { centre, range }
    }

    /// The contractor for what is not in the ring.
    ///
    /// With a centre that is not a single point, it is what may be out of the ring of *some* centre.
    pub fn complement(self) -> RingComplement<N> {
        let (inside, outside) = if self.range.upper() < 0.0 || self.range.is_empty() {
            (Interval::NON_NEGATIVE, Interval::EMPTY)
        } else {
            let beyond = |bound: f64| match Interval::new(bound, f64::INFINITY) {
                Ok(interval) => interval,
                // The ring reaches to infinity: nothing is beyond.
                Err(_) => Interval::EMPTY,
            };
            let below = Interval::new(0.0, self.range.lower()).unwrap_or(Interval::EMPTY);
            (if self.range.lower() > 0.0 { below } else { Interval::EMPTY }, beyond(self.range.upper()))
        };
        RingComplement {
            inside: Ring { centre: self.centre, range: inside },
            outside: Ring { centre: self.centre, range: outside },
        }
    }
}

impl<const N: usize> Contractor<N> for Ring<N> {
    #[inline]
    fn contract(&self, mut domain: IntervalBox<N>) -> IntervalBox<N> {
        let (mut centre, mut range) = (self.centre, self.range);
        contract_distance(&mut domain, &mut centre, &mut range);
        domain
    }
}

/// The points nearer than a ring or farther away: distances in `[0, d⁻]` or `[d⁺, ∞)`, the boundaries included; made by
/// [`Ring::complement`]. Minimal.
///
/// A ring that begins at distance zero has no inside, and its centre is not in the complement.
///
/// ```
/// use shoal_interval::contractor::{Contractor, Ring};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let outside = Ring::new(IntervalBox::from([Interval::ZERO; 2]), Interval::new(1.0, 5.0)?).complement();
/// let domain = IntervalBox::from([Interval::new(1.0, 9.0)?, Interval::new(-3.0, 3.0)?]);
/// assert_eq!(outside.contract(domain), domain); // (1, 0) is on the inner boundary
/// let domain = IntervalBox::from([Interval::new(2.0, 9.0)?, Interval::new(-3.0, 3.0)?]);
/// assert_eq!(outside.contract(domain)[0], Interval::new(4.0, 9.0)?);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingComplement<const N: usize> {
    inside: Ring<N>,
    outside: Ring<N>,
}

impl<const N: usize> Contractor<N> for RingComplement<N> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.inside.contract(domain) | self.outside.contract(domain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn rings_and_their_complements_cover_everything() {
        let centre = IntervalBox::from([over(1.0, 1.0), over(2.0, 2.0)]);
        let ranges = [
            over(0.0, 0.0),
            over(0.0, 3.0),
            over(2.0, 3.0),
            over(3.0, f64::INFINITY),
            over(-1.0, 2.0),
            Interval::EMPTY,
            over(-2.0, -1.0),
            Interval::ENTIRE,
        ];
        for range in ranges {
            let ring = Ring::new(centre, range);
            let complement = ring.complement();
            for tick in 0..41 {
                let x = f64::from(tick) * 0.25 - 4.0;
                let point = IntervalBox::from([over(x, x), over(2.0, 2.0)]);
                let distance = (x - 1.0).abs();
                let (inside, outside) = (ring.contract(point), complement.contract(point));
                assert_eq!(!inside.is_empty(), range.contains(distance), "{range} {x}");
                let strictly_inside = range.lower().max(f64::MIN) < distance && distance < range.upper();
                if strictly_inside {
                    assert!(outside.is_empty(), "{range} {x}");
                }
                assert!(!(inside.is_empty() && outside.is_empty()), "{range} {x}");
            }
        }
        assert!(Ring::new(centre, over(0.0, 3.0)).complement().contract(centre).is_empty());
    }
}
