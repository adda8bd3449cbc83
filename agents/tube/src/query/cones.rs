//! One coordinate inside one slice: from each gate the derivative lets it go no further than a cone.

use crate::time_domain::exactly;
use shoal_interval::Interval;

/// What is known of one coordinate over one slice, and of its derivative.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cones {
    pub start_s: f64,
    pub end_s: f64,
    pub input: Interval,
    pub output: Interval,
    pub slice: Interval,
    pub slope: Interval,
}

impl Cones {
    /// The hull of the trajectory over some times of the slice.
    ///
    /// The two cones bound it by two lines above and two below. Cut about where each pair of lines crosses, the hull of
    /// the parts is the hull of the whole; wherever the cuts are, nothing is lost.
    pub fn over(&self, times_s: Interval) -> Interval {
        if times_s.is_empty() {
            return Interval::EMPTY;
        }
        let Cones { start_s, end_s, input, output, slope, .. } = *self;
        let crossing = |from: f64, up: f64, to: f64, down: f64| {
            let since_start_s = (to - from - down * (end_s - start_s)) / (up - down);
            let crossing_s = start_s + since_start_s;
            if crossing_s.is_nan() {
                times_s.lower()
            } else {
                crossing_s.clamp(times_s.lower(), times_s.upper())
            }
        };
        let peak_s = crossing(input.upper(), slope.upper(), output.upper(), slope.lower());
        let trough_s = crossing(input.lower(), slope.lower(), output.lower(), slope.upper());
        let (one_s, other_s) = (peak_s.min(trough_s), peak_s.max(trough_s));
        let parts = [(times_s.lower(), one_s), (one_s, other_s), (other_s, times_s.upper())];
        parts.into_iter().fold(Interval::EMPTY, |hull, (from_s, to_s)| {
            hull | self.in_both(Interval::spanning(from_s, to_s))
        })
    }

    /// The times of the slice at which both cones meet `values`. Each of the four lines lets through one side.
    pub fn times(&self, values: Interval) -> Interval {
        let Cones { input, output, slope, .. } = *self;
        let span_s = Interval::spanning(self.start_s, self.end_s);
        let values = values & self.slice;
        if values.is_empty() || input.is_empty() || output.is_empty() || slope.is_empty() {
            return Interval::EMPTY;
        }
        // Since the input gate: low + slope.lower() * s <= values.upper(), high + slope.upper() * s >= values.lower().
        let since_input_s = not_above(input.lower(), slope.lower(), values.upper())
            & not_above(-input.upper(), -slope.upper(), -values.lower());
        let until_output_s = not_above(output.lower(), -slope.upper(), values.upper())
            & not_above(-output.upper(), slope.lower(), -values.lower());
        let after_input = since_input_s + span_s.lower();
        let before_output = span_s.upper() - until_output_s;
        span_s & after_input & before_output
    }

    /// Where the slice and both cones are over some times.
    #[inline]
    fn in_both(&self, times_s: Interval) -> Interval {
        let after_input_s = (times_s - self.start_s) & Interval::NON_NEGATIVE;
        let before_output_s = (exactly(self.end_s) - times_s) & Interval::NON_NEGATIVE;
        self.slice & (self.input + self.slope * after_input_s) & (self.output - self.slope * before_output_s)
    }
}

/// All `s` for which `start + slope * s` may be at most `limit`. Lines that are not finite are no limit.
fn not_above(start: f64, slope: f64, limit: f64) -> Interval {
    if !start.is_finite() || !slope.is_finite() || !limit.is_finite() {
        return Interval::ENTIRE;
    }
    let room = exactly(limit) - start - Interval::NON_NEGATIVE;
    if slope == 0.0 {
        return if room.contains(0.0) { Interval::ENTIRE } else { Interval::EMPTY };
    }
    room / slope
}
