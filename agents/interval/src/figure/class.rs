//! What a colour means.

/// What a shape stands for, and with it its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Proved to be in the set: red, as in the seeds.
    Inner,
    /// Undecided: yellow.
    Boundary,
    /// Proved to be outside: blue.
    Outside,
    /// One of several nested sets, from the largest (0, green) to the smallest (4, red); larger numbers look like 4.
    Level(u8),
    /// A line that says where something is: a wall, a circle of equal range, a true shape.
    Line,
    /// A curve of interest.
    Curve,
}

/// Every colour of a figure.
const COLOURS: &str = "\
text{font:12px sans-serif;fill:#222}.title{font-size:15px}\
.label{font-weight:bold;paint-order:stroke;stroke:#fff;stroke-width:3px}\
.paper{fill:#fff}.dot{fill:#111;stroke:#fff}.frame{fill:none;stroke:#444}\
.inner,.boundary,.outside,.level0,.level1,.level2,.level3,.level4{stroke:#333;stroke-opacity:.55}\
.inner{fill:#d7263d}.boundary{fill:#ffd23f}.outside{fill:#a9d6f5}\
.level0{fill:#8ac47f}.level1{fill:#cfdc6c}.level2{fill:#ffd23f}.level3{fill:#f08a3c}.level4{fill:#d7263d}\
.line{fill:none;stroke:#111}.curve{fill:none;stroke:#5a2a83}.union{stroke:none}";

/// The widths of lines between boxes, of lines and of curves, in pixels.
const WIDTHS_PX: [f64; 3] = [0.4, 0.8, 1.6];

/// The style sheet of a figure in which a pixel is `pixel` units of the axes wide.
///
/// Lines keep their width in pixels under zoom. A reader that cannot do that draws them with the width that they have at natural
/// size.
pub(super) fn style(pixel: f64) -> String {
    let [thin, line, curve] = WIDTHS_PX.map(|width| width * pixel);
    let [thin_px, line_px, curve_px] = WIDTHS_PX;
    format!(
        "{COLOURS}.key{{stroke-width:{curve_px}}}.shapes{{stroke-width:{thin}}}.shapes .line{{stroke-width:{line}}}.shapes .curve{{stroke-width:{curve}}}\
         @supports (vector-effect:non-scaling-stroke){{.shapes *{{vector-effect:non-scaling-stroke;\
         stroke-width:{thin_px}px}}.shapes .line{{stroke-width:{line_px}px}}.shapes .curve{{stroke-width:{curve_px}px}}}}"
    )
}

impl Class {
    /// The name of the class in the style sheet.
    pub(super) fn name(self) -> &'static str {
        match self {
            Class::Inner => "inner",
            Class::Boundary => "boundary",
            Class::Outside => "outside",
            Class::Level(0) => "level0",
            Class::Level(1) => "level1",
            Class::Level(2) => "level2",
            Class::Level(3) => "level3",
            Class::Level(_) => "level4",
            Class::Line => "line",
            Class::Curve => "curve",
        }
    }
}
