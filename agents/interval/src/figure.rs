//! Figures: pavings and what is around them as SVG, exact under zoom.
//!
//! A [`Figure`] shows a box of the plane, first axis to the right, second axis up. Coordinates are written with all their
//! digits in the units of the axes, so that two boxes that touch still touch when a reader zooms in; lines keep their
//! width. What a colour means is said in one place, [`Class`]. The same figure has the same bytes on every machine.
//!
//! ```
//! use nalgebra::Vector2;
//! use shoal_interval::figure::Figure;
//! use shoal_interval::paving::{Options, sivia};
//! use shoal_interval::separator::Ring;
//! use shoal_interval::{Interval, IntervalBox};
//!
//! let range_m = Interval::new(3.0, 4.0)?;
//! let initial = IntervalBox::from([Interval::new(-1.0, 7.0)?; 2]);
//! let paving = sivia(&Ring::new(Vector2::new(3.0, 3.0), range_m), initial, &Options::new(0.5))?;
//! let svg = Figure::new(initial)?
//!     .title("A range to a beacon")
//!     .paving(&paving)
//!     .ring(Vector2::new(3.0, 3.0), range_m)
//!     .point(Vector2::new(3.0, 3.0), "beacon")
//!     .axes("x (m)", "y (m)")
//!     .to_svg();
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axes;
mod class;
mod error;
mod shapes;

pub use axes::ticks;
pub use class::Class;
pub use error::FigureError;

use crate::interval_box::IntervalBox;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The longer side of what is shown, in pixels at natural size.
const LENGTH_PX: f64 = 640.0;

/// What a figure shows and how; see [the module](self).
///
/// Shapes are drawn in the order in which they are added. A shape with a coordinate that is not finite is left out, boxes
/// without bounds reach the edge of what is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    view: IntervalBox<2>,
    width_px: f64,
    height_px: f64,
    title: String,
    axis_labels: Option<[String; 2]>,
    legend: Vec<(Class, String)>,
    /// Shapes in the units of the axes, `y` up.
    shapes: String,
    labels: Vec<Label>,
}

/// Words, which unlike shapes must not be stretched.
#[derive(Debug, Clone, PartialEq)]
struct Label {
    /// Where they begin, in the units of the axes.
    at: [f64; 2],
    text: String,
    /// Whether a dot marks the place and the words stand beside it.
    dotted: bool,
}

impl Figure {
    /// An empty figure of `view`, with the same scale along both axes.
    ///
    /// # Errors
    /// [`FigureError::View`] when the view is empty, unbounded or has no area.
    pub fn new(view: IntervalBox<2>) -> Result<Figure, FigureError> {
        let (width, height) = (view[0].width(), view[1].width());
        let has_area =
            !view.is_empty() && width.is_finite() && height.is_finite() && width > 0.0 && height > 0.0;
        if !has_area {
            return Err(FigureError::View { view: view.to_string() });
        }
        let scale = LENGTH_PX / width.max(height);
        Ok(Figure {
            view,
            width_px: (width * scale).max(1.0),
            height_px: (height * scale).max(1.0),
            title: String::new(),
            axis_labels: None,
            legend: Vec::new(),
            shapes: String::new(),
            labels: Vec::new(),
        })
    }

    /// What the figure shows.
    pub fn view(&self) -> IntervalBox<2> {
        self.view
    }

    /// Gives the figure this size in pixels, with a scale of its own for each axis: for curves over time.
    pub fn stretched_to(mut self, width_px: u32, height_px: u32) -> Figure {
        (self.width_px, self.height_px) = (f64::from(width_px.max(1)), f64::from(height_px.max(1)));
        self
    }

    /// Writes `title` above the figure.
    pub fn title(mut self, title: &str) -> Figure {
        self.title = title.to_owned();
        self
    }

    /// Draws both axes with ticks and these names, which should say the units.
    pub fn axes(mut self, first: &str, second: &str) -> Figure {
        self.axis_labels = Some([first.to_owned(), second.to_owned()]);
        self
    }

    /// Says below the figure what a class of shapes stands for.
    pub fn legend(mut self, class: Class, meaning: &str) -> Figure {
        if !self.legend.iter().any(|(known, _)| *known == class) {
            self.legend.push((class, meaning.to_owned()));
        }
        self
    }

    /// The figure as the text of an SVG file.
    pub fn to_svg(&self) -> String {
        let has_axes = self.axis_labels.is_some();
        let (left, bottom) = if has_axes { (56.0, 46.0) } else { (8.0, 8.0) };
        let top = if self.title.is_empty() { 10.0 } else { 34.0 };
        let legend_px = if self.legend.is_empty() { 0.0 } else { 26.0 };
        let (width, height) = (left + self.width_px + 14.0, top + self.height_px + bottom + legend_px);
        let [x, y] = self.view.sides();
        let mut svg = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">"#
        );
        let pixel = ((x.upper() - x.lower()) / self.width_px).min((y.upper() - y.lower()) / self.height_px);
        let _ = writeln!(svg, "<style>{}</style>", class::style(pixel));
        let _ = writeln!(svg, r#"<rect class="paper" width="{width}" height="{height}"/>"#);
        let _ = writeln!(
            svg,
            r#"<svg x="{left}" y="{top}" width="{}" height="{}" viewBox="{} {} {} {}" preserveAspectRatio="none">"#,
            self.width_px,
            self.height_px,
            x.lower(),
            -y.upper(),
            x.upper() - x.lower(),
            y.upper() - y.lower(),
        );
        let _ = writeln!(svg, "<g class=\"shapes\" transform=\"scale(1 -1)\">\n{}</g>\n</svg>", self.shapes);
        let place = |[at_x, at_y]: [f64; 2]| {
            (
                left + (at_x - x.lower()) / (x.upper() - x.lower()) * self.width_px,
                top + (y.upper() - at_y) / (y.upper() - y.lower()) * self.height_px,
            )
        };
        for label in &self.labels {
            let (at_x, at_y) = place(label.at);
            let beside = if label.dotted { 6.0 } else { 0.0 };
            if label.dotted {
                let _ = writeln!(svg, r#"<circle class="dot" cx="{at_x:.2}" cy="{at_y:.2}" r="3"/>"#);
            }
            let (from_left, from_top) = (at_x + beside, at_y - beside);
            let text = escaped(&label.text);
            let _ =
                writeln!(svg, r#"<text class="label" x="{from_left:.2}" y="{from_top:.2}">{text}</text>"#);
        }
        if let Some(labels) = &self.axis_labels {
            axes::write(&mut svg, &self.view, [left, top, self.width_px, self.height_px], labels);
        }
        if !self.title.is_empty() {
            let middle = left + 0.5 * self.width_px;
            let _ = writeln!(
                svg,
                r#"<text class="title" x="{middle}" y="22" text-anchor="middle">{}</text>"#,
                escaped(&self.title)
            );
        }
        let mut at = left;
        for (class, meaning) in &self.legend {
            let from_top = height - 20.0;
            let _ = writeln!(
                svg,
                r#"<rect class="key {}" x="{at}" y="{from_top}" width="12" height="12"/><text x="{}" y="{}">{}</text>"#,
                class.name(),
                at + 17.0,
                from_top + 10.5,
                escaped(meaning)
            );
            // Wide enough for the letters of the font, whose width depends on the reader's machine.
            at += 36.0 + 6.6 * meaning.chars().count() as f64;
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// Writes the figure to an SVG file, and makes its folder if there is none.
    ///
    /// # Errors
    /// [`FigureError::Write`] when the folder or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), FigureError> {
        let path = path.as_ref();
        let failed = |source| FigureError::Write { path: path.to_owned(), source };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        std::fs::write(path, self.to_svg()).map_err(failed)
    }
}

/// Where the examples leave their figures: the folder `figures` of the build folder, which is `CARGO_TARGET_DIR` if that is
/// set, and otherwise `target` beside the nearest `Cargo.lock` above the current folder.
pub fn figures_folder() -> PathBuf {
    let build = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from).or_else(|| {
        let current = std::env::current_dir().ok()?;
        let workspace = current.ancestors().find(|folder| folder.join("Cargo.lock").is_file())?;
        Some(workspace.join("target"))
    });
    build.unwrap_or_else(|| PathBuf::from("target")).join("figures")
}

/// The text with the five characters replaced that mean something in XML.
///
/// ```
/// assert_eq!(shoal_interval::figure::escaped("a < b & c"), "a &lt; b &amp; c");
/// ```
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            _ => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests;
