//! The same trajectory cut otherwise, shifted in time, or after another.

use crate::enclosure::Enclosure;
use crate::error::{Emptied, TubeError};
use crate::time_domain::{TimeDomain, exactly};
use crate::tube::Tube;
use shoal_interval::Interval;

impl<T: Enclosure> Tube<T> {
    /// The same tube on another domain within its own: slices are what the tube says [`over`](Tube::over) them, gates what
    /// it says [`at`](Tube::at) them. Nothing is lost, and nothing changes if the domain is
    /// [refined](TimeDomain::refined).
    ///
    /// # Errors
    /// When the new domain is not within that of the tube.
    pub fn resampled(&self, domain: &TimeDomain) -> Result<Tube<T>, TubeError> {
        let gates = domain.borders_s().map(|time_s| self.at(time_s)).collect::<Result<_, _>>()?;
        let slices = (0..domain.slice_count())
            .map(|index| self.over(domain.span_at(index)))
            .collect::<Result<_, _>>()?;
        Ok(Tube::assembled(domain.clone(), slices, gates))
    }

    /// Cuts the tube at `times_s` too, in any order, so that what is known at these times has a gate.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{Place, TimeDomain, Tube};
    ///
    /// let mut depth_m = Tube::constant(TimeDomain::uniform(0.0, 1.0, 9)?, Interval::new(0.0, 50.0)?);
    /// depth_m.refine([3.7])?;
    /// if let Place::Gate(index) = depth_m.domain().place_of(3.7)? {
    ///     depth_m.contract_gate(index, &Interval::new(20.0, 20.5)?)?;
    /// }
    /// assert_eq!(depth_m.at(3.7)?, Interval::new(20.0, 20.5)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When a time is not finite or outside the domain; the tube is then unchanged.
    pub fn refine(&mut self, times_s: impl IntoIterator<Item = f64>) -> Result<(), TubeError> {
        let domain = self.domain.refined(times_s)?;
        if domain.slice_count() > self.slice_count() {
            let constraint = self.emptied().and_then(|emptied| emptied.constraint);
            *self = self.resampled(&domain)?;
            self.first_emptied = self.first_empty().map(|emptied| Emptied { constraint, ..emptied });
        }
        Ok(())
    }

    /// The tube of the trajectory `delay_s` seconds later: what this tube says at `t` the new one says at `t + delay_s`.
    ///
    /// Each border moves to the `f64` nearest to its sum with the delay, the first and the last one inwards. Where that sum is
    /// exact, as for multiples of a common power of two, slices and gates are just moved. Where it is not, the new border
    /// is a little beside the old one, and a slice or gate holds what it was and the slice that it now reaches into; of a tube
    /// without slices nothing is known then.
    ///
    /// # Errors
    /// When the delay is not finite, or so large that borders fall together or out of the numbers.
    ///
    /// Source: seed 001, equation (4.8), with the sign of a delay.
    pub fn shifted(&self, delay_s: f64) -> Result<Tube<T>, TubeError> {
        if !delay_s.is_finite() {
            return Err(TubeError::NotATime { time_s: delay_s });
        }
        let last = self.slice_count();
        let moved_s = |index: usize| {
            let border_s = self.domain.border_at(index);
            let exact_s = exactly(border_s) + delay_s;
            match index {
                _ if exact_s.is_point() => exact_s.lower(),
                0 => exact_s.upper(),
                _ if index == last => exact_s.lower(),
                _ => border_s + delay_s,
            }
        };
        let domain = TimeDomain::new((0..last + 1).map(moved_s))?;
        // The times of this tube that a time of the new one stands for.
        let before = |times_s: Interval| (times_s - delay_s) & self.domain.span();
        let old_border_s = |index: usize| {
            let (border_s, moved_s) = (self.domain.border_at(index), domain.border_at(index));
            let exact = exactly(border_s) + delay_s == exactly(moved_s);
            if exact { exactly(border_s) } else { before(exactly(moved_s)) }
        };
        // One border alone cannot move inwards: it may stand for a time beside the only one that is known.
        let is_beside = last == 0 && exactly(self.domain.start_s()) + delay_s != exactly(domain.start_s());
        let gate = |index: usize| if is_beside { Ok(T::ENTIRE) } else { self.over(old_border_s(index)) };
        let gates = (0..last + 1).map(gate).collect::<Result<_, _>>()?;
        let slices = (0..last)
            .map(|index| self.over(old_border_s(index) | old_border_s(index + 1)))
            .collect::<Result<_, _>>()?;
        Ok(Tube::assembled(domain, slices, gates))
    }

    /// The tube of `x(h(t))`, with `x` in this tube and `h` in `inner`; its times are those of `inner`.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let depth_m = Tube::from_function(TimeDomain::uniform(0.0, 0.5, 20)?, |t| t * 2.0);
    /// // A clock that runs at 0.9 to 1.1 of the true rate, read over four seconds.
    /// let true_s = Tube::from_function(TimeDomain::uniform(0.0, 1.0, 4)?, |s| s * Interval::spanning(0.9, 1.1));
    /// assert_eq!(depth_m.composed_with(&true_s)?.slice(1), Some(Interval::new(1.0, 5.0)?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When `inner` leads out of the domain of this tube, where nothing is known of `x`.
    ///
    /// Source: seed 001, equation (4.8).
    pub fn composed_with(&self, inner: &Tube<Interval>) -> Result<Tube<T>, TubeError> {
        let slices = inner.slices.iter().map(|&times_s| self.over(times_s)).collect::<Result<_, _>>()?;
        let gates = inner.gates.iter().map(|&times_s| self.over(times_s)).collect::<Result<_, _>>()?;
        Ok(Tube::assembled(inner.domain.clone(), slices, gates))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn ramp() -> Tube<Interval> {
        Tube::from_function(TimeDomain::uniform(0.0, 1.0, 4).unwrap(), |time| time)
    }

    #[test]
    fn an_exact_shift_moves_everything() {
        let late = ramp().shifted(2.5).unwrap();
        assert_eq!(late.domain(), &TimeDomain::uniform(2.5, 1.0, 4).unwrap());
        assert!(late.slices().eq(ramp().slices()) && late.gates().eq(ramp().gates()));
        assert_eq!(late.shifted(-2.5), Ok(ramp()));
    }

    #[test]
    fn an_inexact_shift_keeps_the_truth_and_the_inside_of_slices() {
        let late = ramp().shifted(0.1).unwrap();
        assert_eq!((late.domain().start_s(), late.slice_count()), (0.1, 4));
        for (index, border_s) in late.domain().borders_s().enumerate() {
            assert!((border_s - 0.1 - index as f64).abs() < 1e-15);
            let before = exactly(border_s) - 0.1;
            assert!(!(late.gate(index).unwrap() & before).is_empty());
            // Beside the old border only the slices are known.
            let exact = (exactly(index as f64) + 0.1).is_point();
            assert_eq!(late.gate(index).unwrap().is_point(), exact);
        }
        assert!(late.domain().end_s() <= 4.1 && late.last_gate().is_subset_of(over(3.0, 4.0)));
        assert!(ramp().shifted(1e17).is_err() && ramp().shifted(f64::NAN).is_err());
        assert!(ramp().shifted(f64::MAX).is_err());
    }

    #[test]
    fn a_clock_that_leaves_the_domain_is_refused() {
        let inner = Tube::constant(TimeDomain::uniform(0.0, 1.0, 2).unwrap(), over(3.0, 4.5));
        assert!(matches!(ramp().composed_with(&inner), Err(TubeError::OutsideDomain { .. })));
        let mut inner = &inner - 0.5;
        assert_eq!(ramp().composed_with(&inner).unwrap().slice(0), Some(over(2.0, 4.0)));
        inner.contract_slice(1, &Interval::ZERO).unwrap();
        let composed = ramp().composed_with(&inner).unwrap();
        assert_eq!(composed.first_empty(), inner.first_empty());
    }

    #[test]
    fn cuts_change_nothing() {
        let mut x = ramp();
        x.refine([0.25, 3.5, 2.0]).unwrap();
        assert_eq!((x.slice_count(), x.gate(1), x.slice(0)), (6, Some(over(0.0, 1.0)), Some(over(0.0, 1.0))));
        assert_eq!(x.resampled(ramp().domain()), Ok(ramp()));
        assert!(x.refine([4.5]).is_err() && x.refine([f64::NAN]).is_err());
    }
}
