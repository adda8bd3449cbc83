//! Contraction by a derivative over a part of time only.

use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::Interval;
use shoal_interval::contractor::Contracted;
use std::ops::Range;

impl<T: Enclosure> Tube<T> {
    /// [`contract_derivative`](Tube::contract_derivative) over the slices that the times of `window` touch, and no others.
    /// The time that it takes grows with the number of these slices, if the domains are uniform or clones of one.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{Direction, TimeDomain, Tube};
    ///
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 1.0, 100)?, Interval::new(1.0, 2.0)?);
    /// let mut x_m = Tube::constant(speed_m_s.domain().clone(), Interval::ENTIRE);
    /// x_m.contract_gate(50, &Interval::ZERO)?;
    /// x_m.contract_derivative_within(&speed_m_s, Interval::new(50.0, 53.0)?, Direction::Both)?;
    /// assert_eq!(x_m.gate(53), Some(Interval::new(3.0, 6.0)?));
    /// assert_eq!(x_m.gate(54), Some(Interval::ENTIRE));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the two tubes are cut at different times. Times of the window outside the domain touch no slice.
    pub fn contract_derivative_within(
        &mut self,
        derivative: &Tube<T>,
        window_s: Interval,
        direction: Direction,
    ) -> Result<Contracted, TubeError> {
        self.check_same_domain(derivative)?;
        let range = self.slices_beside(window_s);
        let mut contracted = Contracted::Unchanged;
        if direction != Direction::Backward {
            for index in range.clone() {
                contracted = together(contracted, self.carry_forward(index, derivative.slices[index]));
            }
        }
        if direction != Direction::Forward {
            for index in range.clone().rev() {
                contracted = together(contracted, self.carry_backward(index, derivative.slices[index]));
            }
        }
        if contracted != Contracted::Unchanged {
            self.refresh(range);
        }
        Ok(self.blamed(contracted, Constraint::Derivative))
    }

    /// Carries on what was learnt over the times of `window`: contracts by the derivative there and then to both sides, as
    /// far as it removes anything. The time that it takes grows with the number of slices that it narrows.
    ///
    /// Contracts as much as [`contract_derivative`](Tube::contract_derivative) both ways, but for rounding, if nothing was
    /// learnt outside of the window since that was last done.
    ///
    /// # Errors
    /// When the two tubes are cut at different times. Times of the window outside the domain touch no slice.
    pub fn contract_derivative_around(
        &mut self,
        derivative: &Tube<T>,
        window_s: Interval,
    ) -> Result<Contracted, TubeError> {
        let mut contracted = self.contract_derivative_within(derivative, window_s, Direction::Both)?;
        let Range { mut start, mut end } = self.slices_beside(window_s);
        if start == end {
            return Ok(contracted);
        }
        let (first, last) = (start, end);
        while end < self.slice_count() {
            let narrowed = self.carry_both_ways(end, derivative.slices[end]);
            contracted = together(contracted, narrowed);
            end += 1;
            if narrowed != Contracted::Narrowed {
                break;
            }
        }
        while start > 0 {
            let narrowed = self.carry_both_ways(start - 1, derivative.slices[start - 1]);
            contracted = together(contracted, narrowed);
            start -= 1;
            if narrowed != Contracted::Narrowed {
                break;
            }
        }
        self.refresh(start..first);
        self.refresh(last..end);
        Ok(self.blamed(contracted, Constraint::Derivative))
    }

    fn carry_both_ways(&mut self, index: usize, derivative: T) -> Contracted {
        let forward = self.carry_forward(index, derivative);
        together(forward, self.carry_backward(index, derivative))
    }

    /// The slices that some times of the domain touch; on both sides of a single border.
    pub(super) fn slices_beside(&self, times_s: Interval) -> Range<usize> {
        let times_s = times_s & self.domain.span();
        if times_s.is_empty() {
            return 0..0;
        }
        if times_s.is_point() {
            return self.domain.place_of(times_s.lower()).map_or(0..0, |place| self.domain.slices_at(place));
        }
        self.domain.slices_over(times_s).unwrap_or(0..0)
    }
}
