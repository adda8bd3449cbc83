//! What a figure is made of: boxes, circles, lines, points.

use super::{Class, Figure, Label};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::paving::Paving;
use nalgebra::Vector2;
use std::fmt::Write as _;

impl Figure {
    /// Adds a paving: outside boxes first, then boundary and inner ones, with their legend.
    pub fn paving(self, paving: &Paving<2>) -> Figure {
        self.boxes(paving.outside(), Class::Outside)
            .boxes(paving.boundary(), Class::Boundary)
            .boxes(paving.inner(), Class::Inner)
            .legend(Class::Inner, "inside")
            .legend(Class::Boundary, "boundary")
            .legend(Class::Outside, "outside")
    }

    /// Adds boxes of one class, all in one path. Empty boxes are left out.
    pub fn boxes<'a>(self, boxes: impl IntoIterator<Item = &'a IntervalBox<2>>, class: Class) -> Figure {
        self.path_of_boxes(boxes, class.name())
    }

    /// Adds what many boxes cover together, without the lines around each.
    pub fn union<'a>(self, boxes: impl IntoIterator<Item = &'a IntervalBox<2>>, class: Class) -> Figure {
        self.path_of_boxes(boxes, &format!("{} union", class.name()))
    }

    fn path_of_boxes<'a>(
        mut self,
        boxes: impl IntoIterator<Item = &'a IntervalBox<2>>,
        class: &str,
    ) -> Figure {
        let mut path = String::new();
        for shown in boxes {
            // Nothing is drawn far outside of the view, where a reader's numbers could overflow.
            let [x, y] = (*shown & self.margin()).sides();
            if !(x.is_empty() || y.is_empty()) {
                let _ =
                    write!(path, "M{} {}H{}V{}H{}z", x.lower(), y.lower(), x.upper(), y.upper(), x.lower());
            }
        }
        if !path.is_empty() {
            let _ = writeln!(self.shapes, r#"<path class="{class}" d="{path}"/>"#);
        }
        self
    }

    /// Adds a circle.
    pub fn circle(mut self, centre: Vector2<f64>, radius: f64) -> Figure {
        if is_finite(&centre) && radius.is_finite() && radius >= 0.0 {
            let (x, y) = (centre.x, centre.y);
            let class = Class::Line.name();
            let _ = writeln!(self.shapes, r#"<circle class="{class}" cx="{x}" cy="{y}" r="{radius}"/>"#);
        }
        self
    }

    /// Adds the two circles of a range to a point.
    pub fn ring(self, centre: Vector2<f64>, range: Interval) -> Figure {
        self.circle(centre, range.lower()).circle(centre, range.upper())
    }

    /// Adds a dot with a label beside it; the label may be empty.
    pub fn point(mut self, at: Vector2<f64>, label: &str) -> Figure {
        if is_finite(&at) {
            self.labels.push(Label { at: [at.x, at.y], text: label.to_owned(), dotted: true });
        }
        self
    }

    /// Adds words that begin at a point.
    pub fn text(mut self, at: Vector2<f64>, words: &str) -> Figure {
        if is_finite(&at) {
            self.labels.push(Label { at: [at.x, at.y], text: words.to_owned(), dotted: false });
        }
        self
    }

    /// Adds a line from one point to another.
    pub fn segment(self, from: Vector2<f64>, to: Vector2<f64>) -> Figure {
        self.line(&[from, to], Class::Line, "")
    }

    /// Adds the border of a polygon.
    pub fn polygon(self, corners: &[Vector2<f64>]) -> Figure {
        self.line(corners, Class::Line, "z")
    }

    /// Adds a polygon of one class with what is inside it.
    pub fn area(self, corners: &[Vector2<f64>], class: Class) -> Figure {
        self.line(corners, class, "z")
    }

    /// Adds a curve through points.
    pub fn curve(self, points: &[Vector2<f64>]) -> Figure {
        self.line(points, Class::Curve, "")
    }

    fn line(mut self, points: &[Vector2<f64>], class: Class, end: &str) -> Figure {
        if points.len() < 2 || !points.iter().all(is_finite) {
            return self;
        }
        let mut path = String::new();
        for (index, point) in points.iter().enumerate() {
            let _ = write!(path, "{}{} {}", if index == 0 { 'M' } else { 'L' }, point.x, point.y);
        }
        let _ = writeln!(self.shapes, r#"<path class="{}" d="{path}{end}"/>"#, class.name());
        self
    }

    /// The view and as much again on every side.
    fn margin(&self) -> IntervalBox<2> {
        self.view.inflate(self.view.width())
    }
}

fn is_finite(point: &Vector2<f64>) -> bool {
    point.x.is_finite() && point.y.is_finite()
}
