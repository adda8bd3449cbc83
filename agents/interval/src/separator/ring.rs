//! The separator of a ring: a range to a point.

use super::{Separation, Separator};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use crate::paving::InclusionTest;
use crate::rounding::{add_down, add_up, mul_down, mul_up, sqrt_down, sqrt_up, sub_down, sub_up};
use crate::set::{larger, smaller};
use nalgebra::SVector;

/// The vectors whose Euclidean distance to a point is in an interval: a ring in two dimensions, a shell in three.
///
/// Both contractors are minimal up to rounding. For the outer one each coordinate occurs once in
/// `lower² <= Σ (x - centre)² <= upper²`, so one pass projects it exactly; the inner one is the hull of such passes for
/// the hole and for the outside. Everything is compared in squares: a root is taken only where a bound moves.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::separator::{Ring, Separator};
/// use shoal_interval::{Interval, IntervalBox};
///
/// let ring = Ring::new(Vector2::new(0.0, 0.0), Interval::new(3.0, 5.0)?);
/// let domain = IntervalBox::from([Interval::new(0.0, 4.0)?, Interval::new(3.0, 9.0)?]);
/// let separation = ring.separate(domain);
/// assert_eq!(separation.outer[1], Interval::new(3.0, 5.0)?);
/// assert_eq!(separation.inner, domain);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 000, equation (2.35); seed 001, figure 2.9.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring<const N: usize> {
    centre: SVector<f64, N>,
    /// The square of the lower range, between two numbers; below zero when every distance is long enough.
    near: (f64, f64),
    /// The square of the upper range, between two numbers.
    far: (f64, f64),
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Ring,
    Nothing,
    Unknown,
}

/// One coordinate's share of the squared distance to the centre, rounded outwards.
#[derive(Clone, Copy)]
struct Share {
    lower: f64,
    upper: f64,
}

impl<const N: usize> Ring<N> {
    /// The separator of what is at a distance of `range` from `centre`, in the unit of the axes.
    ///
    /// Negative distances in `range` mean nothing; an empty or negative `range` gives the empty set. A centre that is not
    /// finite is not known, and nothing is then removed from any box.
    pub fn new(centre: SVector<f64, N>, range: Interval) -> Ring<N> {
        let (lower, upper) = (range.lower(), range.upper());
        Ring::between_ranges(centre, (lower, lower), (upper, upper))
    }

    /// The separator of what is at least `lower` and at most `upper` from `centre`, where both numbers are only known to be
    /// in these intervals: what it proves holds for all of them.
    ///
    /// Bounds below zero count as zero. An interval that is empty is not known, like a centre that is not finite.
    pub fn with_uncertain_range(centre: SVector<f64, N>, lower: Interval, upper: Interval) -> Ring<N> {
        let ring =
            Ring::between_ranges(centre, (lower.lower(), lower.upper()), (upper.lower(), upper.upper()));
        if lower.is_empty() || upper.is_empty() { Ring { kind: Kind::Unknown, ..ring } } else { ring }
    }

    fn between_ranges(centre: SVector<f64, N>, lower: (f64, f64), upper: (f64, f64)) -> Ring<N> {
        let kind = if !centre.iter().all(|x| x.is_finite()) {
            Kind::Unknown
        } else if upper.1 < 0.0 || lower.0 > upper.1 {
            Kind::Nothing
        } else {
            Kind::Ring
        };
        let below = |x: f64| if x < 0.0 { -1.0 } else { mul_down(x, x) };
        let above = |x: f64| mul_up(larger(0.0, x), larger(0.0, x));
        // No distance is below zero, so nothing is near enough to be in the hole of a disc.
        let hole = if lower.1 > 0.0 { above(lower.1) } else { -1.0 };
        Ring { centre, near: (below(lower.0), hole), far: (below(upper.0), above(upper.1)), kind }
    }

    /// The separator of what is at most `radius` from `centre`: a disc, a ball.
    ///
    /// A negative radius gives the empty set; one that is NaN is not known, like a centre that is not finite.
    pub fn disc(centre: SVector<f64, N>, radius: f64) -> Ring<N> {
        let range = if radius < 0.0 { Interval::EMPTY } else { Interval::spanning(0.0, radius) };
        let ring = Ring::new(centre, range);
        if radius.is_nan() { Ring { kind: Kind::Unknown, ..ring } } else { ring }
    }

    #[inline]
    fn shares(&self, domain: &IntervalBox<N>) -> [Share; N] {
        std::array::from_fn(|axis| {
            let (below, above) = (
                sub_down(domain[axis].lower(), self.centre[axis]),
                sub_up(domain[axis].upper(), self.centre[axis]),
            );
            let nearest = larger(0.0, larger(below, -above));
            let farthest = larger(-below, above);
            Share { lower: mul_down(nearest, nearest), upper: mul_up(farthest, farthest) }
        })
    }

    /// The hull of the vectors of `domain` whose squared distance is between two numbers.
    #[inline]
    fn between(
        &self,
        domain: &IntervalBox<N>,
        shares: &[Share; N],
        at_least: f64,
        at_most: f64,
    ) -> IntervalBox<N> {
        let mut left = *domain;
        for axis in 0..N {
            let (mut others_lower, mut others_upper) = (0.0, 0.0);
            for (other, share) in shares.iter().enumerate() {
                if other != axis {
                    others_lower = add_down(others_lower, share.lower);
                    others_upper = add_up(others_upper, share.upper);
                }
            }
            let least = sub_down(at_least, others_upper);
            let most = sub_up(at_most, others_lower);
            let Some(side) = within(domain[axis], self.centre[axis], shares[axis], least, most) else {
                return IntervalBox::EMPTY;
            };
            left[axis] = side;
        }
        left
    }

    #[inline]
    fn inner_of(&self, domain: &IntervalBox<N>, shares: &[Share; N]) -> IntervalBox<N> {
        let outside = if self.far.0 == f64::INFINITY {
            IntervalBox::EMPTY
        } else {
            self.between(domain, shares, self.far.0, f64::INFINITY)
        };
        if self.near.1 < 0.0 || outside == *domain {
            return outside;
        }
        outside | self.between(domain, shares, f64::NEG_INFINITY, self.near.1)
    }

    #[inline]
    fn outer_of(&self, domain: &IntervalBox<N>, shares: &[Share; N]) -> IntervalBox<N> {
        self.between(domain, shares, self.near.0, self.far.1)
    }
}

/// The hull of the numbers `x` of `domain` with `least <= (x - centre)² <= most`, where the share of all of `domain` is
/// known; nothing if there is none.
#[inline]
fn within(domain: Interval, centre: f64, share: Share, least: f64, most: f64) -> Option<Interval> {
    let (mut lower, mut upper) = (domain.lower(), domain.upper());
    if most < share.lower || least > share.upper {
        return None;
    }
    if most < share.upper {
        let radius = sqrt_up(most);
        lower = larger(lower, sub_down(centre, radius));
        upper = smaller(upper, add_up(centre, radius));
    }
    if least > share.lower {
        let radius = sqrt_down(least);
        let (hole_starts, hole_ends) = (sub_up(centre, radius), add_down(centre, radius));
        let in_hole = |x: f64| hole_starts < x && x < hole_ends;
        (lower, upper) = (
            if in_hole(lower) { hole_ends } else { lower },
            if in_hole(upper) { hole_starts } else { upper },
        );
    }
    (lower <= upper).then(|| Interval::from_bounds(lower, upper))
}

impl<const N: usize> Separator<N> for Ring<N> {
    #[inline]
    fn inner(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        if self.kind != Kind::Ring || domain.is_empty() {
            return domain;
        }
        self.inner_of(&domain, &self.shares(&domain))
    }

    #[inline]
    fn outer(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        match self.kind {
            Kind::Ring if !domain.is_empty() => self.outer_of(&domain, &self.shares(&domain)),
            Kind::Nothing => IntervalBox::EMPTY,
            _ => domain,
        }
    }

    #[inline]
    fn separate(&self, domain: IntervalBox<N>) -> Separation<N> {
        if self.kind != Kind::Ring || domain.is_empty() {
            return Separation { inner: self.inner(domain), outer: self.outer(domain) };
        }
        let shares = self.shares(&domain);
        Separation { inner: self.inner_of(&domain, &shares), outer: self.outer_of(&domain, &shares) }
    }
}

impl<const N: usize> InclusionTest<N> for Ring<N> {
    fn test(&self, domain: &IntervalBox<N>) -> Membership {
        match self.kind {
            _ if domain.is_empty() => Membership::Outside,
            Kind::Nothing => Membership::Outside,
            Kind::Unknown => Membership::Undecided,
            Kind::Ring => {
                let shares = self.shares(domain);
                let nearest = shares.iter().fold(0.0, |sum, share| add_down(sum, share.lower));
                let farthest = shares.iter().fold(0.0, |sum, share| add_up(sum, share.upper));
                if nearest > self.far.1 || farthest < self.near.0 {
                    Membership::Outside
                } else if nearest >= self.near.1 && farthest <= self.far.0 {
                    Membership::Inside
                } else {
                    Membership::Undecided
                }
            }
        }
    }
}
