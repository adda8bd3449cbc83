//! Sharper answers inside slices, for a tube whose derivative is enclosed by another tube.
//!
//! From a gate the trajectory can only go as the derivative allows, so inside a slice it is in two cones, one from each
//! gate. At a time `t` of slice `i`, with `[v]` the derivative over it,
//! `x(t) ∈ slice ∩ (input gate + (t - t_i) [v]) ∩ (output gate - (t_{i+1} - t) [v])`.
//! Source: seed 001, equations (4.5) and (5.5), from both ends of a slice.

use super::cones::Cones;
use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::inversion::Components;
use crate::summary::{Part, Step};
use crate::time_domain::{Place, exactly};
use crate::tube::Tube;
use shoal_interval::Interval;
use std::ops::{ControlFlow, Range};

impl<T: Enclosure> Tube<T> {
    /// What holds the trajectory at `time_s` seconds if its derivative is in `derivative`: inside
    /// [`at`](Tube::at), and smaller between gates.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 1.0, 4)?, Interval::new(1.0, 2.0)?);
    /// let x_m = Tube::primitive(&speed_m_s, Interval::ZERO);
    /// assert_eq!(x_m.at(0.5)?, Interval::new(0.0, 2.0)?);
    /// assert_eq!(x_m.at_with_derivative(0.5, &speed_m_s)?, Interval::new(0.5, 1.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the time is not finite or outside the domain, or the two tubes are cut at different times.
    pub fn at_with_derivative(&self, time_s: f64, derivative: &Tube<T>) -> Result<T, TubeError> {
        self.check_same_domain(derivative)?;
        Ok(match self.domain.place_of(time_s)? {
            Place::Gate(index) => self.gates[index],
            Place::Slice(index) => self.in_cones(index, exactly(time_s), derivative.slices[index]),
        })
    }

    /// The hull of the trajectory over some times of a slice.
    pub(crate) fn hull_in_cones(&self, index: usize, times_s: Interval, slope: T) -> T {
        T::from_sides(|axis| self.cones(index, axis, slope).over(times_s))
    }

    /// The times of a slice at which both cones meet `values`, on all axes.
    pub(crate) fn times_in_cones(&self, index: usize, values: T, slope: T) -> Interval {
        (0..T::AXES).fold(self.domain.span_at(index), |times_s, axis| {
            times_s & self.cones(index, axis, slope).times(values.side(axis))
        })
    }

    #[inline]
    fn cones(&self, index: usize, axis: usize, slope: T) -> Cones {
        Cones {
            start_s: self.domain.border_at(index),
            end_s: self.domain.border_at(index + 1),
            input: self.gates[index].side(axis),
            output: self.gates[index + 1].side(axis),
            slice: self.slices[index].side(axis),
            slope: slope.side(axis),
        }
    }

    /// What holds the trajectory over some times of a slice: the slice and the two cones.
    #[inline]
    pub(crate) fn in_cones(&self, index: usize, times_s: Interval, slope: T) -> T {
        let after_input_s = (times_s - self.domain.border_at(index)) & Interval::NON_NEGATIVE;
        let before_output_s = (self.domain.border_at(index + 1) - times_s) & Interval::NON_NEGATIVE;
        self.slices[index]
            & (self.gates[index] + slope * after_input_s)
            & (self.gates[index + 1] - slope * before_output_s)
    }
}

impl Tube<Interval> {
    /// What holds the trajectory over all of `times_s`, in seconds, if its derivative is in `derivative`: inside
    /// [`over`](Tube::over), and smaller where `times_s` ends inside a slice. In logarithmic time.
    ///
    /// In the slices in which `times_s` ends it is the hull of the two cones, tightest but for rounding.
    ///
    /// # Errors
    /// When some of the times are outside the domain, or the two tubes are cut at different times.
    pub fn over_with_derivative(
        &self,
        times_s: Interval,
        derivative: &Tube<Interval>,
    ) -> Result<Interval, TubeError> {
        self.check_same_domain(derivative)?;
        if times_s.is_empty() {
            return Ok(Interval::EMPTY);
        }
        if times_s.is_point() {
            return self.at_with_derivative(times_s.lower(), derivative);
        }
        let range = self.domain.slices_over(times_s)?;
        let end = |index: usize| {
            self.hull_in_cones(index, self.domain.span_at(index) & times_s, derivative.slices[index])
        };
        let (first, last) = (range.start, range.end - 1);
        let between = if first + 1 < last { self.hull_of(first + 1..last) } else { Interval::EMPTY };
        Ok(end(first) | between | if first < last { end(last) } else { Interval::EMPTY })
    }

    /// All times of `within`, in seconds and as a hull, at which the trajectory may be in `values` if its derivative is in
    /// `derivative`. Sharper than [`invert_within`](Tube::invert_within): slices are cut by the two cones.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 1.0, 9)?, Interval::new(1.0, 2.0)?);
    /// let x_m = Tube::primitive(&speed_m_s, Interval::ZERO);
    /// let at_three_m = Interval::point(3.0)?;
    /// assert_eq!(x_m.invert(at_three_m), Interval::new(1.0, 4.0)?);
    /// let sharper = x_m.invert_with_derivative(at_three_m, &speed_m_s, Interval::ENTIRE)?;
    /// assert_eq!(sharper, Interval::new(1.5, 3.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn invert_with_derivative(
        &self,
        values: Interval,
        derivative: &Tube<Interval>,
        within: Interval,
    ) -> Result<Interval, TubeError> {
        self.check_same_domain(derivative)?;
        let within = within & self.domain.span();
        let Some(mut range) = self.slices_touched(within) else {
            return Ok(self.instant_with_derivative(values, derivative, within));
        };
        let times_in = |index: usize| self.times_in_cones(index, values, derivative.slices[index]) & within;
        let mut first_s = Interval::EMPTY;
        while let Some(index) = self.first_meeting(range.clone(), &values) {
            range.start = index + 1;
            first_s = times_in(index);
            if !first_s.is_empty() {
                break;
            }
        }
        let mut last_s = Interval::EMPTY;
        while let Some(index) = self.last_meeting(range.clone(), &values) {
            range.end = index;
            last_s = times_in(index);
            if !last_s.is_empty() {
                break;
            }
        }
        Ok(first_s | last_s)
    }

    /// [`invert_with_derivative`](Tube::invert_with_derivative) as disjoint intervals in order.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn invert_components_with_derivative(
        &self,
        values: Interval,
        derivative: &Tube<Interval>,
        within: Interval,
    ) -> Result<Vec<Interval>, TubeError> {
        self.check_same_domain(derivative)?;
        let within = within & self.domain.span();
        let mut components = Components::default();
        match self.slices_touched(within) {
            Some(range) => self.each_meeting(range, values, |index| {
                components.add(self.times_in_cones(index, values, derivative.slices[index]) & within);
            }),
            None => components.add(self.instant_with_derivative(values, derivative, within)),
        }
        Ok(components.times_s)
    }

    fn instant_with_derivative(
        &self,
        values: Interval,
        derivative: &Tube<Interval>,
        instant: Interval,
    ) -> Interval {
        let meets = !instant.is_empty()
            && self
                .at_with_derivative(instant.lower(), derivative)
                .is_ok_and(|set| !set.is_disjoint_from(values));
        if meets { instant } else { Interval::EMPTY }
    }

    fn each_meeting(&self, range: Range<usize>, values: Interval, mut visit: impl FnMut(usize)) {
        let walked: ControlFlow<()> = self.summaries.walk(range, |part| match part {
            Part::Block(_, summary) if summary.hull.is_disjoint_from(values) => Step::Past,
            Part::Block(..) => Step::Into,
            Part::Slices(range) => {
                range.filter(|&index| !self.slices[index].is_disjoint_from(values)).for_each(&mut visit);
                Step::Past
            }
        });
        debug_assert!(walked.is_continue());
    }
}
