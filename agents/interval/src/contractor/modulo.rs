//! A set and its copies at equal distances.

use super::Contractor;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// A contractor for the union of a set and all its translates along one axis; made by [`Contractor::modulo`].
///
/// The result is the hull over all translates that meet the domain, so it is minimal, but for rounding, when the contractor
/// is. Which translates may meet the domain is known from what the contractor leaves of the whole space: its set must be
/// bounded on the periodic axis, or nothing is contracted.
///
/// When more than [`Modulo::MAX_TRANSLATES`] meet the domain, or they are more than 2⁴⁰ periods away, the periodic axis is
/// left as it is and the other axes are contracted over one full period. `period` encloses a positive number, `2π` for
/// instance; if it holds anything else, nothing is contracted.
///
/// ```
/// use shoal_interval::contractor::{Contractor, from_fn};
/// use shoal_interval::{Interval, IntervalBox};
///
/// // A lamp that is on for the first second of each minute.
/// let on = Interval::new(0.0, 1.0)?;
/// let lamp = from_fn(move |time_s: IntervalBox<1>| time_s & IntervalBox::from([on]));
/// let blinking = lamp.modulo(0, Interval::new(60.0, 60.0)?);
/// let seen_s = blinking.contract(IntervalBox::from([Interval::new(100.0, 200.0)?]));
/// assert_eq!(seen_s, IntervalBox::from([Interval::new(120.0, 181.0)?]));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 3.3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Modulo<C> {
    contractor: C,
    axis: usize,
    period: Interval,
    /// Where the set itself, not its copies, lies on the axis.
    original: Interval,
}

/// The translates `first..=last`, counted in periods.
struct Translates {
    first: f64,
    last: f64,
}

impl<C> Modulo<C> {
    /// The largest number of translates that are contracted one by one.
    pub const MAX_TRANSLATES: usize = 64;

    /// Further away than this the count of periods would not be exact.
    const FARTHEST: f64 = (1_u64 << 40) as f64;

    pub(super) fn new<const N: usize>(contractor: C, axis: usize, period: Interval) -> Modulo<C>
    where
        C: Contractor<N>,
    {
        assert!(axis < N, "there is no axis {axis} in a box of {N} dimensions");
        let everywhere = contractor.contract(IntervalBox::ENTIRE);
        let original = if everywhere.is_empty() { Interval::EMPTY } else { everywhere[axis] };
        Modulo { contractor, axis, period, original }
    }

    /// All translates that may meet `side`; `None` when they are too many or too far to be counted.
    fn translates(&self, side: Interval) -> Option<Translates> {
        let periods = (side - self.original) / self.period;
        let (first, last) = (periods.lower().ceil(), periods.upper().floor());
        let countable = periods.magnitude() <= Self::FARTHEST && last - first < Self::MAX_TRANSLATES as f64;
        countable.then_some(Translates { first, last })
    }
}

impl<const N: usize, C: Contractor<N>> Contractor<N> for Modulo<C> {
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        if domain.is_empty() || self.original.is_empty() {
            return IntervalBox::EMPTY;
        }
        if !self.original.is_bounded() || self.period.is_empty() || self.period.lower() <= 0.0 {
            return domain;
        }
        let axis = self.axis;
        let Some(translates) = self.translates(domain[axis]) else {
            let mut one_period = domain;
            one_period[axis] = self.original;
            let mut contracted = self.contractor.contract(one_period);
            if contracted.is_empty() {
                return IntervalBox::EMPTY;
            }
            contracted[axis] = domain[axis];
            return contracted;
        };
        let mut hull = IntervalBox::EMPTY;
        let mut count = translates.first;
        while count <= translates.last {
            let offset = self.period * count;
            let mut moved = domain;
            moved[axis] = domain[axis] - offset;
            let mut contracted = self.contractor.contract(moved);
            contracted[axis] += offset;
            hull = hull | (contracted & domain);
            count += 1.0;
        }
        hull
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contractor::{Ring, from_fn};
    use nalgebra::Vector2;
    use proptest::prelude::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    /// Circles of radius 1, one at each multiple of `10` on the x axis.
    fn row_of_circles() -> Modulo<Ring<2>> {
        Ring::new(IntervalBox::from([Interval::ZERO; 2]), Interval::ONE).modulo(0, over(10.0, 10.0))
    }

    #[test]
    fn only_the_translates_in_the_domain_count() {
        let x = |lower, upper| IntervalBox::from([over(lower, upper), Interval::ENTIRE]);
        assert_eq!(
            row_of_circles().contract(x(8.0, 33.0)),
            IntervalBox::from([over(9.0, 31.0), over(-1.0, 1.0)])
        );
        assert_eq!(row_of_circles().contract(x(-20.5, -20.5))[0], over(-20.5, -20.5));
        assert!(row_of_circles().contract(x(2.0, 8.0)).is_empty());
        let above = IntervalBox::from([over(0.0, 40.0), over(1.0, 2.0)]);
        assert_eq!(row_of_circles().contract(above), IntervalBox::from([over(0.0, 40.0), Interval::ONE]));
    }

    #[test]
    fn wide_and_far_domains_end() {
        for side in
            [Interval::ENTIRE, Interval::NON_NEGATIVE, over(-1e9, 1e9), over(1e300, 1e301), over(1e18, 1e18)]
        {
            let contracted = row_of_circles().contract(IntervalBox::from([side, Interval::ENTIRE]));
            assert_eq!(contracted, IntervalBox::from([side, over(-1.0, 1.0)]), "{side}");
            assert!(row_of_circles().contract(IntervalBox::from([side, over(1.5, 2.0)])).is_empty());
        }
    }

    #[test]
    fn what_has_no_copies_or_no_period_is_left_alone() {
        let domain = IntervalBox::from([over(0.0, 5.0)]);
        let nothing = from_fn(|_: IntervalBox<1>| IntervalBox::EMPTY);
        assert!(nothing.modulo(0, Interval::ONE).contract(domain).is_empty());
        let unbounded = from_fn(|x: IntervalBox<1>| x & IntervalBox::from([Interval::NON_NEGATIVE]));
        assert_eq!(unbounded.modulo(0, Interval::ONE).contract(domain), domain);
        let point = from_fn(|x: IntervalBox<1>| x & IntervalBox::from([Interval::ONE]));
        for period in [Interval::EMPTY, Interval::ZERO, over(-2.0, 1.0), over(-1.0, -1.0), Interval::ENTIRE] {
            assert_eq!(point.modulo(0, period).contract(domain), domain, "{period}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn no_copy_is_lost(count in -100_i32..100, angle in 0.0..6.2_f64, left in 0.0..90.0_f64, right in 0.0..90.0_f64) {
            let (sine, cosine) = pxfm::f_sincos(angle);
            let p = Vector2::new(10.0 * f64::from(count) + cosine, sine);
            // The point is on the circle to rounding only.
            let circles = Ring::new(IntervalBox::from([Interval::ZERO; 2]), Interval::centred(1.0, 1e-12)).modulo(0, over(10.0, 10.0));
            let domain = IntervalBox::from([over(p.x - left, p.x + right), over(p.y, p.y)]);
            let contracted = circles.contract(domain);
            prop_assert!(contracted.contains(&p) && contracted.is_subset_of(&domain));
        }
    }
}
