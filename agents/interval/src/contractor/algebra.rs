//! Intersection, union and composition of two contractors.
//!
//! Source: seed 001, section 3.3; seed 002, section 3.4.1.

use super::Contractor;
use crate::interval_box::IntervalBox;

/// Both constraints hold, each applied to the whole box; made by [`Contractor::intersection`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intersection<A, B> {
    one: A,
    other: B,
}

impl<A, B> Intersection<A, B> {
    pub(super) fn new(one: A, other: B) -> Intersection<A, B> {
        Intersection { one, other }
    }
}

impl<const N: usize, A: Contractor<N>, B: Contractor<N>> Contractor<N> for Intersection<A, B> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.one.contract(domain) & self.other.contract(domain)
    }
}

/// At least one of two constraints holds; made by [`Contractor::union`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Union<A, B> {
    one: A,
    other: B,
}

impl<A, B> Union<A, B> {
    pub(super) fn new(one: A, other: B) -> Union<A, B> {
        Union { one, other }
    }
}

impl<const N: usize, A: Contractor<N>, B: Contractor<N>> Contractor<N> for Union<A, B> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        self.one.contract(domain) | self.other.contract(domain)
    }
}

/// Both constraints hold, one applied after the other; made by [`Contractor::then`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Then<A, B> {
    first: A,
    second: B,
}

impl<A, B> Then<A, B> {
    pub(super) fn new(first: A, second: B) -> Then<A, B> {
        Then { first, second }
    }
}

impl<const N: usize, A: Contractor<N>, B: Contractor<N>> Contractor<N> for Then<A, B> {
    #[inline]
    fn contract(&self, domain: IntervalBox<N>) -> IntervalBox<N> {
        let left = self.first.contract(domain);
        if left.is_empty() { IntervalBox::EMPTY } else { self.second.contract(left) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contractor::Sum;
    use crate::contractor::{Ring, from_fn};
    use crate::interval::Interval;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    /// `y = a x + b` over the box of `x` and `y`.
    fn line(a: f64, b: f64) -> impl Contractor<2> {
        from_fn(move |domain: IntervalBox<2>| {
            let y = domain[1] & (domain[0] * a + b);
            IntervalBox::from([domain[0] & ((y - b) / a), y])
        })
    }

    #[test]
    fn composition_goes_further_than_intersection() {
        let domain = IntervalBox::from([over(0.0, 10.0), over(-100.0, 100.0)]);
        let together = line(1.0, 0.0).intersection(line(-1.0, 4.0)).contract(domain);
        let in_turn = line(1.0, 0.0).then(line(-1.0, 4.0)).contract(domain);
        assert_eq!(together, IntervalBox::from([over(0.0, 10.0), over(0.0, 4.0)]));
        assert_eq!(in_turn, IntervalBox::from([over(0.0, 4.0), over(0.0, 4.0)]));
    }

    #[test]
    fn a_union_is_the_hull_of_what_both_leave() {
        let at = |x: f64| Ring::new(IntervalBox::from([over(x, x), Interval::ZERO]), over(0.0, 1.0));
        let either = at(-5.0).union(at(5.0));
        assert_eq!(
            either.contract(IntervalBox::ENTIRE),
            IntervalBox::from([over(-6.0, 6.0), over(-1.0, 1.0)])
        );
        let right = IntervalBox::from([over(0.0, 9.0), over(-9.0, 9.0)]);
        assert_eq!(either.contract(right), IntervalBox::from([over(4.0, 6.0), over(-1.0, 1.0)]));
    }

    #[test]
    fn contradictions_and_empty_boxes_are_empty() {
        let nothing = Sum.then(from_fn(|_| IntervalBox::EMPTY));
        assert!(nothing.contract(IntervalBox::ENTIRE).is_empty());
        assert!(Sum.union(Sum).intersection(Sum).contract(IntervalBox::EMPTY).is_empty());
    }

    #[test]
    fn contractors_of_different_kinds_share_a_list() {
        let list: Vec<Box<dyn Contractor<2>>> =
            vec![Box::new(line(1.0, 0.0)), Box::new(line(1.0, 0.0).then(line(-1.0, 4.0)))];
        let domain = IntervalBox::from([over(0.0, 10.0), over(-100.0, 100.0)]);
        let all = list.iter().fold(domain, |left, contractor| contractor.contract(left));
        assert_eq!(all[0], over(0.0, 4.0));
    }
}
