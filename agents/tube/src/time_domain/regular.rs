//! Borders that are one step apart, and so need no memory.

use crate::error::TubeError;

/// Border `i` is `origin_s + (first + i) * step_s`, product and sum each rounded to nearest; all are finite and strictly increasing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Regular {
    origin_s: f64,
    step_s: f64,
    /// How many slices were dropped at the front.
    first: usize,
    count: usize,
}

impl Regular {
    /// One border and no slice; the step is settled by the first slice that is appended.
    pub(super) fn instant(time_s: f64) -> Regular {
        Regular { origin_s: time_s, step_s: 1.0, first: 0, count: 0 }
    }

    pub(super) fn new(origin_s: f64, step_s: f64, count: usize) -> Result<Regular, TubeError> {
        let length_s = count as f64 * step_s;
        let end_s = origin_s + length_s;
        if !end_s.is_finite() || !length_s.is_finite() {
            return Err(TubeError::NotATime { time_s: end_s });
        }
        // Two roundings of at most half an ulp move each of two neighbours, so a step of more than two ulps is enough.
        let largest_s = origin_s.abs().max(end_s.abs()).max(length_s.abs());
        if step_s <= 0.0 || count > 0 && step_s <= 4.0 * (largest_s.next_up() - largest_s) {
            return Err(TubeError::StepTooSmall { step_s, time_s: largest_s });
        }
        Ok(Regular { origin_s, step_s, first: 0, count })
    }

    #[inline]
    pub(super) fn slice_count(&self) -> usize {
        self.count
    }

    #[inline]
    pub(super) fn border_s(&self, index: usize) -> f64 {
        self.origin_s + (self.first + index) as f64 * self.step_s
    }

    /// Takes in a border after the last one, if it is where it should be.
    pub(super) fn append(&mut self, end_s: f64) -> bool {
        if self.border_s(self.count + 1) != end_s {
            if self.count > 0 {
                return false;
            }
            let start_s = self.border_s(0);
            let restarted = Regular { origin_s: start_s, step_s: end_s - start_s, first: 0, count: 0 };
            if restarted.border_s(1) != end_s {
                return false;
            }
            *self = restarted;
        }
        self.count += 1;
        true
    }

    pub(super) fn drop_front(&mut self, count: usize) {
        self.first += count;
        self.count -= count;
    }

    #[inline]
    pub(super) fn step_s(&self) -> f64 {
        self.step_s
    }

    /// What [`Regular::new`] was given, or would accept, if nothing was dropped since.
    #[cfg(feature = "serde")]
    pub(super) fn as_given(&self) -> Option<(f64, f64, usize)> {
        let given = (self.first == 0).then_some((self.origin_s, self.step_s, self.count))?;
        Regular::new(given.0, given.1, given.2).is_ok().then_some(given)
    }
}
