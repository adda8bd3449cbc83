//! A figure as the text of an SVG file.

use std::fmt::Write as _;

use shoal_interval::figure::escaped;

use super::{Entry, Figure, Layer, Panel, Sample, Shape};

/// Height of panels that stand side by side, and of those in several rows.
const HEIGHT_PX: [f64; 2] = [420.0, 230.0];
const LEFT_PX: f64 = 70.0;
const TOP_PX: f64 = 60.0;
const BOTTOM_PX: f64 = 54.0;
const BETWEEN_PX: f64 = 84.0;
/// Between the axis of one row and the panels of the next.
const ROW_GAP_PX: f64 = 14.0;
const RIGHT_PX: f64 = 18.0;
/// From one line of the legend to the next.
const LINE_PX: f64 = 20.0;
/// Wide enough for the letters of any plain font.
const LETTER_PX: f64 = 6.9;

/// How figures look, for a page that holds some. Where a reader's screen is dark, so is the paper, and the colours are lighter.
pub const STYLE: &str = "svg text{font:12px sans-serif;fill:#222}svg .title{font-size:15px;font-weight:bold}svg .subtitle{fill:#555}\
.paper{fill:#fff}.frame{fill:none;stroke:#444}.grid{fill:none;stroke:#ececec}.line{fill:none;stroke-width:1.1;stroke-linejoin:round}\
.area{fill-opacity:.85}.filled{fill-opacity:.75}.drawn{fill:none;stroke-width:1.3}\
@media screen and (prefers-color-scheme:dark){svg text{fill:#ddd}svg .subtitle{fill:#aaa}.paper{fill:#15181c}.frame{stroke:#999}.grid{stroke:#2a2e34}\
[fill='#000000']{fill:#fff}[stroke='#000000']{stroke:#fff}[fill='#e4e4e4']{fill:#3a3f46}[stroke='#e4e4e4']{stroke:#3a3f46}\
[fill='#0072b2']{fill:#2f93d6}[stroke='#0072b2']{stroke:#2f93d6}[fill='#56b4e9']{fill:#8ed0f5}[stroke='#56b4e9']{stroke:#8ed0f5}}";

impl Figure {
    /// The text of an SVG file.
    pub fn to_svg(&self) -> String {
        self.written("", STYLE)
    }

    /// The figure as an element of a page that has [`STYLE`], beside other figures, whose prefixes must differ.
    pub fn to_element(&self, prefix: &str) -> String {
        self.written(prefix, "")
    }

    /// Panels in a row: an even number of panels above three stands in two columns, an odd one in three.
    fn columns(&self) -> usize {
        match self.panels.len() {
            count @ 0..=3 => count.max(1),
            count if count.is_multiple_of(2) => 2,
            _ => 3,
        }
    }

    fn written(&self, prefix: &str, style: &str) -> String {
        let letters = |entry: &Entry| entry.meaning.chars().count();
        let legend_px = match self.legend.iter().map(letters).max() {
            Some(most) => 40.0 + LETTER_PX * most as f64,
            None => 0.0,
        };
        let columns = self.columns();
        let rows: Vec<&[Panel]> = self.panels.chunks(columns).collect();
        let panel_px = HEIGHT_PX[usize::from(rows.len() > 1)];
        let row_px = panel_px + BOTTOM_PX + ROW_GAP_PX;
        let row_width = |row: &&[Panel]| {
            let gaps = BETWEEN_PX * row.len().saturating_sub(1) as f64;
            row.iter().map(|panel| panel.width_px).sum::<f64>() + gaps
        };
        let panels_px = rows.iter().map(row_width).fold(0.0, f64::max);
        let legend_left = LEFT_PX + panels_px + RIGHT_PX;
        let title_px = LEFT_PX + 9.0 * self.title.chars().count() as f64;
        let subtitle_px = LEFT_PX + LETTER_PX * self.subtitle.chars().count() as f64;
        let width = (legend_left + legend_px).max(title_px).max(subtitle_px).ceil();
        let legend_height = TOP_PX + LINE_PX * self.legend.len() as f64 + 10.0;
        let rows_height = TOP_PX + row_px * rows.len().max(1) as f64 - ROW_GAP_PX;
        let height = rows_height.max(legend_height).ceil();

        let mut svg = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">"#
        );
        let _ = writeln!(svg, "<title>{}</title>", escaped(&self.title));
        if !style.is_empty() {
            let _ = writeln!(svg, "<style>{style}</style>");
        }
        svg.push_str("<defs>\n");
        for shape in Shape::ALL {
            let _ = writeln!(svg, r#"<path id="{prefix}{}" d="{}"/>"#, shape.name(), shape.outline());
        }
        let _ = writeln!(svg, "</defs>\n<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>");
        let _ = writeln!(
            svg,
            r#"<text class="title" x="{LEFT_PX}" y="24">{}</text><text class="subtitle" x="{LEFT_PX}" y="44">{}</text>"#,
            escaped(&self.title),
            escaped(&self.subtitle)
        );
        let mut index = 0;
        for (row, panels) in rows.iter().enumerate() {
            let top = TOP_PX + row_px * row as f64;
            let mut left = LEFT_PX;
            for panel in *panels {
                let frame = Frame { left, top, width: panel.width_px, height: panel_px, prefix };
                panel.write(&mut svg, index, &frame);
                left += panel.width_px + BETWEEN_PX;
                index += 1;
            }
        }
        for (index, entry) in self.legend.iter().enumerate() {
            entry.write(&mut svg, legend_left, TOP_PX + 8.0 + LINE_PX * index as f64, prefix);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// Where a panel stands, in pixels.
struct Frame<'a> {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
    /// Of the names of elements.
    prefix: &'a str,
}

impl Entry {
    fn write(&self, svg: &mut String, left: f64, middle: f64, prefix: &str) {
        let at = left + 10.0;
        let _ = match self.sample {
            Some(Sample::Mark(mark)) => {
                let (attributes, name) = (mark.attributes(), mark.shape.name());
                writeln!(svg, r##"<g {attributes}><use href="#{prefix}{name}" x="{at}" y="{middle}"/></g>"##)
            }
            Some(Sample::Area(colour)) => writeln!(
                svg,
                r#"<rect class="area" x="{}" y="{}" width="12" height="12" fill="{}"/>"#,
                at - 6.0,
                middle - 6.0,
                colour.code()
            ),
            Some(Sample::Line(colour)) => writeln!(
                svg,
                r#"<path class="line" d="M{} {middle}h16" stroke="{}"/>"#,
                at - 8.0,
                colour.code()
            ),
            None => Ok(()),
        };
        let _ = writeln!(
            svg,
            r#"<text x="{}" y="{}">{}</text>"#,
            left + 24.0,
            middle + 4.0,
            escaped(&self.meaning)
        );
    }
}

impl super::Mark {
    fn attributes(&self) -> String {
        let code = self.colour.code();
        if self.shape.is_drawn() {
            format!(r#"class="drawn" stroke="{code}""#)
        } else {
            format!(r#"class="filled" fill="{code}""#)
        }
    }
}

impl Panel {
    fn write(&self, svg: &mut String, index: usize, frame: &Frame<'_>) {
        let Frame { left, top, width, height, prefix } = *frame;
        let (right, bottom) = (left + width, top + height);
        let _ = writeln!(
            svg,
            r#"<clipPath id="{prefix}panel{index}"><rect x="{left}" y="{top}" width="{width}" height="{height}"/></clipPath>"#
        );
        for (value, text) in self.x.ticks(width, 0) {
            let x = pixels(left + self.x.part(value) * width);
            let _ = writeln!(
                svg,
                r#"<path class="grid" d="M{x} {top}V{bottom}"/><path class="frame" d="M{x} {bottom}v5"/><text x="{x}" y="{}" text-anchor="middle">{text}</text>"#,
                bottom + 19.0
            );
        }
        for (value, text) in self.y.ticks(height, 1) {
            let y = pixels(bottom - self.y.part(value) * height);
            let _ = writeln!(
                svg,
                r#"<path class="grid" d="M{left} {y}H{right}"/><path class="frame" d="M{left} {y}h-5"/><text x="{}" y="{y}" dy="4" text-anchor="end">{text}</text>"#,
                left - 9.0
            );
        }
        let _ = writeln!(svg, r#"<g clip-path="url(#{prefix}panel{index})">"#);
        for layer in &self.layers {
            self.draw(svg, layer, frame);
        }
        let _ = writeln!(
            svg,
            r#"</g><rect class="frame" x="{left}" y="{top}" width="{width}" height="{height}"/>"#
        );
        let _ = writeln!(
            svg,
            r#"<text x="{}" y="{}" text-anchor="middle">{}</text>"#,
            left + 0.5 * width,
            bottom + 42.0,
            escaped(&self.x.label)
        );
        let _ = writeln!(
            svg,
            r#"<text transform="translate({} {}) rotate(-90)" text-anchor="middle">{}</text>"#,
            left - 54.0,
            top + 0.5 * height,
            escaped(&self.y.label)
        );
    }

    fn draw(&self, svg: &mut String, layer: &Layer, frame: &Frame<'_>) {
        let Frame { left, top, width, height, prefix } = *frame;
        let place = |[x, y]: [f64; 2]| [left + self.x.part(x) * width, top + (1.0 - self.y.part(y)) * height];
        let is_finite = |point: &&[f64; 2]| point.iter().all(|value| value.is_finite());
        let path = |points: &[[f64; 2]]| {
            let mut path = String::new();
            for (index, point) in points.iter().filter(is_finite).enumerate() {
                let [x, y] = place(*point).map(pixels);
                let _ = write!(path, "{}{x} {y}", if index == 0 { 'M' } else { 'L' });
            }
            path
        };
        let _ = match layer {
            Layer::Marks { mark, points } => {
                let _ = writeln!(svg, "<g {}>", mark.attributes());
                for point in points.iter().filter(is_finite) {
                    let [x, y] = place(*point).map(pixels);
                    let _ =
                        writeln!(svg, r##"<use href="#{prefix}{}" x="{x}" y="{y}"/>"##, mark.shape.name());
                }
                writeln!(svg, "</g>")
            }
            Layer::Bars { colour, bars } => {
                let _ = writeln!(svg, r#"<g class="area" fill="{}">"#, colour.code());
                for [x1, x2, y1, y2] in bars {
                    let [from_left, from_top] = place([x1.min(*x2), y1.max(*y2)]);
                    let [to_right, to_bottom] = place([x1.max(*x2), y1.min(*y2)]);
                    let _ = writeln!(
                        svg,
                        r#"<rect x="{}" y="{}" width="{}" height="{}"/>"#,
                        pixels(from_left),
                        pixels(from_top),
                        pixels(to_right - from_left),
                        pixels(to_bottom - from_top)
                    );
                }
                writeln!(svg, "</g>")
            }
            Layer::Boxes { colour, boxes } => {
                let mut path = String::new();
                for [x1, x2, y1, y2] in boxes.iter().filter(|sides| sides.iter().all(|side| side.is_finite()))
                {
                    let [[left, bottom], [right, top]] =
                        [[*x1, *y1], [*x2, *y2]].map(|corner| place(corner).map(pixels));
                    let _ = write!(path, "M{left} {bottom}H{right}V{top}H{left}z");
                }
                writeln!(svg, r#"<path class="line" stroke="{}" d="{path}"/>"#, colour.code())
            }
            Layer::Area { colour, corners } => {
                writeln!(svg, r#"<path class="area" fill="{}" d="{}z"/>"#, colour.code(), path(corners))
            }
            Layer::Line { colour, points } => {
                writeln!(svg, r#"<path class="line" stroke="{}" d="{}"/>"#, colour.code(), path(points))
            }
            Layer::Segments { colour, ends } => {
                let drawn: String = ends.iter().map(|ends| path(ends)).collect();
                writeln!(svg, r#"<path class="line" stroke="{}" d="{drawn}"/>"#, colour.code())
            }
            Layer::Arcs { colour, turns } => {
                let mut path = String::new();
                for (index, turn) in turns.iter().enumerate() {
                    let [x, y] = place(turn.at).map(pixels);
                    let _ = match index.checked_sub(1).and_then(|before| turns.get(before)) {
                        None => write!(path, "M{x} {y}"),
                        Some(before) => {
                            let [first, second] = before.controls(turn).map(|point| place(point).map(pixels));
                            write!(path, "C{} {} {} {} {x} {y}", first[0], first[1], second[0], second[1])
                        }
                    };
                }
                writeln!(svg, r#"<path class="line" stroke="{}" d="{path}"/>"#, colour.code())
            }
        };
    }
}

/// To a thousandth of a pixel: beyond that, digits are only noise.
fn pixels(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}
