//! Figures for people: panels with axes, marks, lines and bars, and a legend, as SVG.
//!
//! A figure is vector graphics with places to a thousandth of a pixel, so that a reader can zoom in, and the same figure has the
//! same bytes on every machine. Colours are those of Okabe and Ito, which people with any kind of colour vision tell apart
//! (<https://jfly.uni-koeln.de/color/>); where colour says something, shape says it too. On a dark screen the paper is dark as well.

mod axis;
mod few;
mod layer;
mod mark;
mod write;

pub use axis::Axis;
pub use layer::{Layer, Turn};
pub use mark::{Colour, Mark, Shape};
pub use write::STYLE;

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What it shows, in one line.
    pub title: String,
    /// Of what: the run.
    pub subtitle: String,
    /// The panels, from left to right; more than three stand in rows.
    pub panels: Vec<Panel>,
    /// What marks and colours mean, from top to bottom.
    pub legend: Vec<Entry>,
}

impl Figure {
    /// Two figures of the same kind, with axes that hold what is in both, so that a reader can compare them.
    pub fn on_the_same_axes(mut first: Self, mut second: Self) -> [Self; 2] {
        for (left, right) in first.panels.iter_mut().zip(&mut second.panels) {
            if (&left.x.label, &left.y.label) == (&right.x.label, &right.y.label) {
                let (x, y) = (left.x.hull(&right.x), left.y.hull(&right.y));
                (left.x, left.y) = (x.clone(), y.clone());
                (right.x, right.y) = (x, y);
            }
        }
        [first, second]
    }
}

/// A pair of axes with what is drawn in between.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Width of what the axes enclose, in pixels.
    pub width_px: f64,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// What is drawn, in this order.
    pub layers: Vec<Layer>,
}

/// One line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What to look for; `None` for a remark.
    pub sample: Option<Sample>,
    /// What it means.
    pub meaning: String,
}

/// What a line of a legend explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sample {
    /// A mark.
    Mark(Mark),
    /// A bar or an area.
    Area(Colour),
    /// A line.
    Line(Colour),
}

impl Entry {
    /// A line of a legend that explains a sample.
    pub fn new(sample: Sample, meaning: impl Into<String>) -> Self {
        Self { sample: Some(sample), meaning: meaning.into() }
    }

    /// A line of a legend without a sample.
    pub fn remark(meaning: impl Into<String>) -> Self {
        Self { sample: None, meaning: meaning.into() }
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
pub use tests::assert_well_formed;
