//! Figures: tubes, the truth and measurements over time, and traces of boxes in the plane.
//!
//! [`DrawTube`] adds tubes to a [`Figure`] of `shoal-interval`, which brings the axes, the title, the legend and the file. What
//! is drawn of a tube encloses it, whatever the number of its slices, and the same tube gives the same bytes on every
//! machine.
//!
//! ```
//! use shoal_interval::Interval;
//! use shoal_interval::figure::Class;
//! use shoal_tube::figure::{DrawTube, over_time};
//! use shoal_tube::{TimeDomain, Tube};
//!
//! let time = TimeDomain::uniform(0.0, 0.1, 60)?;
//! let speed_m_s = Tube::from_function(time, |t| (t.cos() * 0.5).inflate(0.05));
//! let x_m = Tube::primitive(&speed_m_s, Interval::ZERO);
//! let svg = over_time(x_m.domain().span(), Interval::new(-1.0, 1.0)?)?
//!     .title("Dead reckoning")
//!     .tube(&x_m, Class::Level(0))
//!     .trajectory(x_m.domain().span(), |t_s| 0.5 * pxfm::f_sin(t_s))
//!     .measurement(Interval::new(2.9, 3.1)?, Interval::new(0.0, 0.1)?)
//!     .legend(Class::Level(0), "tube")
//!     .legend(Class::Curve, "truth")
//!     .axes("t (s)", "x (m)")
//!     .to_svg();
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::tube::Tube;
use nalgebra::Vector2;
use shoal_interval::figure::{Class, Figure, FigureError};
use shoal_interval::{Interval, IntervalBox};

/// The size of a figure over time, in pixels.
const SIZE_PX: [u32; 2] = [900, 320];

/// Tubes of more slices are drawn with several slices as one, so that files stay small; at [`SIZE_PX`] a part is then less than
/// half a pixel wide.
const MOST_PARTS: usize = 2_000;

/// The points of a curve.
const CURVE_POINTS: u32 = 1_000;

/// An empty figure of `values` over `times_s`, in seconds, wider than high and with a scale of its own for each axis.
///
/// # Errors
/// [`FigureError::View`] when one of the two is empty, unbounded or a point.
pub fn over_time(times_s: Interval, values: Interval) -> Result<Figure, FigureError> {
    let [width_px, height_px] = SIZE_PX;
    Ok(Figure::new(IntervalBox::from([times_s, values]))?.stretched_to(width_px, height_px))
}

/// What can be drawn of tubes. Layers are drawn in the order in which they are added: the widest tube first.
pub trait DrawTube: Sized {
    /// Adds a tube over time, in seconds, as one area without lines inside it. Tubes of more than 2,000 slices are drawn
    /// with several slices as their hull. Nothing is drawn where the tube is empty.
    fn tube(self, tube: &Tube<Interval>, class: Class) -> Self;

    /// Adds the gates of a tube as upright lines; for tubes of few slices.
    fn gates(self, tube: &Tube<Interval>) -> Self;

    /// Adds a trajectory over `times_s` as a curve through 1,001 of its points: the truth, not a proof.
    fn trajectory(self, times_s: Interval, value: impl Fn(f64) -> f64) -> Self;

    /// Adds what was measured, and when, as the outline of a box.
    fn measurement(self, times_s: Interval, value: Interval) -> Self;

    /// Adds two axes of a tube of boxes as a trace in the plane: what the boxes of all slices cover. Nothing is drawn of an
    /// axis that the boxes do not have.
    fn trace<const N: usize>(self, tube: &Tube<IntervalBox<N>>, axes: [usize; 2], class: Class) -> Self;

    /// Adds a path in the plane over `times_s` as a curve through 1,001 of its points.
    fn path(self, times_s: Interval, position: impl Fn(f64) -> Vector2<f64>) -> Self;
}

impl DrawTube for Figure {
    fn tube(mut self, tube: &Tube<Interval>, class: Class) -> Figure {
        let values = around(self.view()[1]);
        let mut corners = Outline::default();
        for (times_s, slice) in parts(tube) {
            let shown = slice & values;
            if shown.is_empty() {
                self = self.area(&corners.take(), class);
            } else {
                corners.add(times_s, shown);
            }
        }
        self.area(&corners.take(), class)
    }

    fn gates(mut self, tube: &Tube<Interval>) -> Figure {
        let values = around(self.view()[1]);
        for (time_s, gate) in tube.domain().borders_s().zip(tube.gates()) {
            let shown = gate & values;
            if !shown.is_empty() {
                self = self.segment(Vector2::new(time_s, shown.lower()), Vector2::new(time_s, shown.upper()));
            }
        }
        self
    }

    fn trajectory(self, times_s: Interval, value: impl Fn(f64) -> f64) -> Figure {
        self.path(times_s, |time_s| Vector2::new(time_s, value(time_s)))
    }

    fn measurement(self, times_s: Interval, value: Interval) -> Figure {
        self.boxes(&[IntervalBox::from([times_s, value])], Class::Line)
    }

    fn trace<const N: usize>(self, tube: &Tube<IntervalBox<N>>, axes: [usize; 2], class: Class) -> Figure {
        let [first, second] = axes;
        if first >= N || second >= N {
            return self;
        }
        let boxes: Vec<_> =
            tube.slices().map(|slice| IntervalBox::from([slice[first], slice[second]])).collect();
        self.union(&boxes, class)
    }

    fn path(self, times_s: Interval, position: impl Fn(f64) -> Vector2<f64>) -> Figure {
        let (start_s, duration_s) = (times_s.lower(), times_s.upper() - times_s.lower());
        let points: Vec<_> = (0..=CURVE_POINTS)
            .map(|point| position(start_s + duration_s * f64::from(point) / f64::from(CURVE_POINTS)))
            .collect();
        self.curve(&points)
    }
}

/// The slices of a tube with their times, or, of many, the hulls of several.
fn parts(tube: &Tube<Interval>) -> impl Iterator<Item = (Interval, Interval)> + '_ {
    let count = tube.slice_count();
    let step = count.div_ceil(MOST_PARTS).max(1);
    (0..count).step_by(step).map(move |start| {
        let end = (start + step).min(count);
        let times_s = Interval::spanning(tube.domain().border_at(start), tube.domain().border_at(end));
        let has_empty = (start..end).any(|index| tube.slices[index].is_empty());
        (times_s, if has_empty { Interval::EMPTY } else { tube.hull_of(start..end) })
    })
}

/// The values that are shown and as many again on both sides: what is drawn of a slice without bounds.
fn around(shown: Interval) -> Interval {
    shown.inflate(shown.width())
}

/// The outline of some slices in a row.
#[derive(Default)]
struct Outline {
    /// Along the upper bounds, forward in time.
    above: Vec<Vector2<f64>>,
    /// Along the lower bounds, forward in time as well.
    below: Vec<Vector2<f64>>,
}

impl Outline {
    fn add(&mut self, times_s: Interval, slice: Interval) {
        for (side, value) in [(&mut self.above, slice.upper()), (&mut self.below, slice.lower())] {
            // A bound that stays where it was needs no corner.
            if side.last().is_some_and(|last| last.y == value) {
                side.pop();
            } else {
                side.push(Vector2::new(times_s.lower(), value));
            }
            side.push(Vector2::new(times_s.upper(), value));
        }
    }

    /// The corners all around; the outline is empty afterwards.
    fn take(&mut self) -> Vec<Vector2<f64>> {
        let mut corners = std::mem::take(&mut self.above);
        corners.extend(std::mem::take(&mut self.below).into_iter().rev());
        corners
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn steps(values: [Interval; 3]) -> Tube<Interval> {
        let time = TimeDomain::uniform(0.0, 1.0, 3).unwrap();
        Tube::from_parts(time, values, [Interval::ENTIRE; 4]).unwrap()
    }

    fn figure() -> Figure {
        over_time(over(0.0, 3.0), over(0.0, 10.0)).unwrap()
    }

    #[test]
    fn a_tube_is_one_outline() {
        let svg =
            figure().tube(&steps([over(1.0, 2.0), over(1.0, 3.0), over(2.0, 3.0)]), Class::Level(0)).to_svg();
        assert!(svg.contains(r#"<path class="level0" d="M0 2L1 2L1 3L3 3L3 2L2 2L2 1L0 1z"/>"#), "{svg}");
    }

    #[test]
    fn empty_slices_leave_a_gap_and_unbounded_ones_stay_near() {
        let svg =
            figure().tube(&steps([over(1.0, 2.0), Interval::EMPTY, Interval::ENTIRE]), Class::Inner).to_svg();
        assert!(svg.contains(r#"d="M0 2L1 2L1 1L0 1z""#), "{svg}");
        assert!(svg.contains(r#"d="M2 20L3 20L3 -10L2 -10z""#), "{svg}");
        assert!(!svg.contains("inf"));
        let nothing = figure().tube(&steps([Interval::EMPTY; 3]), Class::Inner);
        assert_eq!(nothing, figure());
    }

    #[test]
    fn many_slices_become_few_parts_that_enclose_them() {
        let time = TimeDomain::uniform(0.0, 3e-4, 10_000).unwrap();
        let tube = Tube::from_function(time, |t| t.sqr().inflate(0.01));
        assert_eq!(parts(&tube).count(), 2_000);
        for (times_s, values) in parts(&tube) {
            assert_eq!(values, tube.over(times_s).unwrap());
        }
        assert!(figure().tube(&tube, Class::Level(0)).to_svg().len() < 400_000);
    }

    #[test]
    fn gates_measurements_and_traces() {
        let tube = steps([over(1.0, 2.0), over(1.0, 3.0), over(2.0, 3.0)]);
        let svg = figure().gates(&tube).measurement(over(0.5, 0.6), over(1.0, 4.0)).to_svg();
        assert_eq!(svg.matches(r#"<path class="line""#).count(), 5);
        assert!(svg.contains("M1 1L1 2") && svg.contains("M0.5 1H0.6V4H0.5z"), "{svg}");
        let plane = Tube::from_components([&tube, &tube]).unwrap();
        let svg = figure().trace(&plane, [0, 1], Class::Level(1)).to_svg();
        assert!(svg.contains("M1 1H2V2H1zM1 1H3V3H1zM2 2H3V3H2z"), "{svg}");
        assert_eq!(figure().trace(&plane, [0, 2], Class::Level(1)), figure());
        assert!(over_time(Interval::ZERO, over(0.0, 1.0)).is_err());
    }
}
