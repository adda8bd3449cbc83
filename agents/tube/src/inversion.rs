//! When: the times at which the trajectory may have given values.

use crate::enclosure::Enclosure;
use crate::summary::{Part, Step};
use crate::time_domain::exactly;
use crate::tube::Tube;
use shoal_interval::Interval;
use std::ops::{ControlFlow, Range};

impl<T: Enclosure> Tube<T> {
    /// All times, in seconds and as a hull, at which the trajectory may be in `values`; empty when it never is.
    ///
    /// Whole slices are returned: the trajectory may be there at any time of a slice that meets `values`. In logarithmic
    /// time for a trajectory without jumps. [`invert_with_derivative`](Tube::invert_with_derivative) is sharper.
    ///
    /// Source: seed 001, section 5.4.1, the inverse tube of a clock.
    pub fn invert(&self, values: T) -> Interval {
        self.invert_within(values, self.domain.span())
    }

    /// All times of `within`, in seconds and as a hull, at which the trajectory may be in `values`. Times outside the domain
    /// are not returned, because the tube says nothing of them.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let x_m = Tube::from_function(TimeDomain::uniform(0.0, 0.5, 20)?, |t| t.sqr());
    /// let soon_s = Interval::new(0.0, 2.25)?;
    /// assert_eq!(x_m.invert_within(Interval::new(3.5, 30.0)?, soon_s), Interval::new(1.5, 2.25)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn invert_within(&self, values: T, within: Interval) -> Interval {
        let within = within & self.domain.span();
        let Some(range) = self.slices_touched(within) else {
            return self.instant_meets(&values, within);
        };
        let (Some(first), Some(last)) =
            (self.first_meeting(range.clone(), &values), self.last_meeting(range, &values))
        else {
            return Interval::EMPTY;
        };
        (self.domain.span_at(first) | self.domain.span_at(last)) & within
    }

    /// All times, in seconds, at which the trajectory may be in `values`, as disjoint intervals in order: the runs of
    /// neighbouring slices that meet `values`.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let x_m = Tube::from_function(TimeDomain::uniform(0.0, 1.0, 6)?, |t| (t - 3.0).sqr());
    /// let four_m_away = x_m.invert_components(Interval::point(2.0)?);
    /// assert_eq!(four_m_away, [Interval::new(1.0, 2.0)?, Interval::new(4.0, 5.0)?]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn invert_components(&self, values: T) -> Vec<Interval> {
        self.invert_components_within(values, self.domain.span())
    }

    /// [`invert_components`](Tube::invert_components), of the times of `within` only.
    pub fn invert_components_within(&self, values: T, within: Interval) -> Vec<Interval> {
        let within = within & self.domain.span();
        let mut components = Components::default();
        let Some(range) = self.slices_touched(within) else {
            components.add(self.instant_meets(&values, within));
            return components.times_s;
        };
        let _ = self.summaries.walk::<()>(range, |part| match part {
            Part::Block(_, summary) if summary.hull.is_disjoint_from(&values) => Step::Past,
            Part::Block(range, summary) if values.meets_all(&summary.innermost) => {
                components.add(self.times_of(range) & within);
                Step::Past
            }
            Part::Block(..) => Step::Into,
            Part::Slices(range) => {
                for index in range {
                    if !self.slices[index].is_disjoint_from(&values) {
                        components.add(self.domain.span_at(index) & within);
                    }
                }
                Step::Past
            }
        });
        components.times_s
    }

    /// The slices that some times of the domain touch; `None` for no time or a single one.
    pub(crate) fn slices_touched(&self, within: Interval) -> Option<Range<usize>> {
        if within.is_empty() || within.is_point() {
            return None;
        }
        self.domain.slices_over(within).ok()
    }

    /// The instant itself, if the tube meets `values` there.
    pub(crate) fn instant_meets(&self, values: &T, instant: Interval) -> Interval {
        let meets =
            !instant.is_empty() && self.at(instant.lower()).is_ok_and(|set| !set.is_disjoint_from(values));
        if meets { instant } else { Interval::EMPTY }
    }

    /// The first slice of `range` that meets `values`.
    pub(crate) fn first_meeting(&self, range: Range<usize>, values: &T) -> Option<usize> {
        let found = self.summaries.walk(range, |part| match part {
            Part::Block(_, summary) if summary.hull.is_disjoint_from(values) => Step::Past,
            Part::Block(range, summary) if values.meets_all(&summary.innermost) => Step::Stop(range.start),
            Part::Block(..) => Step::Into,
            Part::Slices(mut range) => range
                .find(|&index| !self.slices[index].is_disjoint_from(values))
                .map_or(Step::Past, Step::Stop),
        });
        found_in(found)
    }

    /// The last slice of `range` that meets `values`.
    pub(crate) fn last_meeting(&self, range: Range<usize>, values: &T) -> Option<usize> {
        let found = self.summaries.walk_back(range, |part| match part {
            Part::Block(_, summary) if summary.hull.is_disjoint_from(values) => Step::Past,
            Part::Block(range, summary) if values.meets_all(&summary.innermost) => Step::Stop(range.end - 1),
            Part::Block(..) => Step::Into,
            Part::Slices(mut range) => range
                .rfind(|&index| !self.slices[index].is_disjoint_from(values))
                .map_or(Step::Past, Step::Stop),
        });
        found_in(found)
    }

    /// The times of some neighbouring slices, at least one.
    fn times_of(&self, range: Range<usize>) -> Interval {
        exactly(self.domain.border_at(range.start)) | exactly(self.domain.border_at(range.end))
    }
}

fn found_in(found: ControlFlow<usize>) -> Option<usize> {
    match found {
        ControlFlow::Break(index) => Some(index),
        ControlFlow::Continue(()) => None,
    }
}

/// Disjoint intervals of time, made from ones that come in order of their start.
#[derive(Debug, Default)]
pub(crate) struct Components {
    pub times_s: Vec<Interval>,
}

impl Components {
    /// Takes in some more times, which may touch the last ones.
    pub(crate) fn add(&mut self, times_s: Interval) {
        if times_s.is_empty() {
            return;
        }
        match self.times_s.last_mut() {
            Some(last) if times_s.lower() <= last.upper() => *last = *last | times_s,
            _ => self.times_s.push(times_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    /// Rises by one each second, from zero, over four slices.
    fn ramp() -> Tube<Interval> {
        Tube::from_function(TimeDomain::uniform(0.0, 1.0, 4).unwrap(), |time| time)
    }

    #[test]
    fn inverses() {
        assert_eq!(ramp().invert(over(1.5, 2.5)), over(1.0, 3.0));
        assert_eq!(ramp().invert(over(2.0, 2.0)), over(1.0, 3.0));
        assert_eq!(ramp().invert(over(5.0, 6.0)), Interval::EMPTY);
        assert_eq!(ramp().invert(Interval::EMPTY), Interval::EMPTY);
        let instant = Tube::starting_at(3.0, Interval::ONE).unwrap();
        assert_eq!(instant.invert(over(0.0, 2.0)), over(3.0, 3.0));
        assert_eq!(instant.invert_components(over(0.0, 2.0)), [over(3.0, 3.0)]);
        assert_eq!(instant.invert(over(2.0, 3.0)), Interval::EMPTY);
    }

    #[test]
    fn inverses_within() {
        let x = ramp();
        assert_eq!(x.invert_within(over(1.5, 9.0), over(0.5, 2.5)), over(1.0, 2.5));
        assert_eq!(x.invert_within(over(1.5, 9.0), over(-7.0, 1.0)), Interval::EMPTY);
        assert_eq!(x.invert_within(over(1.0, 9.0), over(1.0, 1.0)), over(1.0, 1.0));
        assert_eq!(x.invert_within(over(1.0, 9.0), over(9.0, 10.0)), Interval::EMPTY);
        assert_eq!(x.invert_within(over(1.0, 9.0), Interval::ENTIRE), over(0.0, 4.0));
        assert!(x.invert_components_within(over(1.0, 9.0), Interval::EMPTY).is_empty());
    }

    #[test]
    fn an_empty_slice_meets_nothing() {
        let mut x = Tube::constant(TimeDomain::uniform(0.0, 1.0, 40).unwrap(), Interval::ONE);
        x.contract_slice(20, &Interval::ZERO).unwrap();
        assert_eq!(x.invert_components(Interval::ENTIRE), [over(0.0, 20.0), over(21.0, 40.0)]);
    }
}
