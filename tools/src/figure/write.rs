//! A figure as the text of an SVG file.

use std::fmt::Write as _;

use shoal_interval::figure::escaped;

use super::{Entry, Figure, Layer, Panel, Sample, Shape};

const HEIGHT_PX: f64 = 420.0;
const LEFT_PX: f64 = 70.0;
const TOP_PX: f64 = 60.0;
const BOTTOM_PX: f64 = 54.0;
const BETWEEN_PX: f64 = 84.0;
const RIGHT_PX: f64 = 18.0;
/// From one line of the legend to the next.
const LINE_PX: f64 = 20.0;
/// Wide enough for the letters of any plain font.
const LETTER_PX: f64 = 6.9;

const STYLE: &str = "text{font:12px sans-serif;fill:#222}.title{font-size:15px;font-weight:bold}.subtitle{fill:#555}\
.frame{fill:none;stroke:#444}.grid{fill:none;stroke:#ececec}.line{fill:none;stroke-width:1.1;stroke-linejoin:round}\
.area{fill-opacity:.85}.filled{fill-opacity:.75}.drawn{fill:none;stroke-width:1.3}";

impl Figure {
    /// The text of an SVG file.
    pub fn to_svg(&self) -> String {
        let letters = |entry: &Entry| entry.meaning.chars().count();
        let legend_px = match self.legend.iter().map(letters).max() {
            Some(most) => 40.0 + LETTER_PX * most as f64,
            None => 0.0,
        };
        let panels_px: f64 = self.panels.iter().map(|panel| panel.width_px).sum();
        let gaps_px = BETWEEN_PX * self.panels.len().saturating_sub(1) as f64;
        let legend_left = LEFT_PX + panels_px + gaps_px + RIGHT_PX;
        let title_px = LEFT_PX + 9.0 * self.title.chars().count() as f64;
        let width = (legend_left + legend_px).max(title_px).ceil();
        let legend_height = TOP_PX + LINE_PX * self.legend.len() as f64 + 10.0;
        let height = (TOP_PX + HEIGHT_PX + BOTTOM_PX).max(legend_height).ceil();

        let mut svg = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">"#
        );
        let _ = writeln!(svg, "<title>{}</title>\n<style>{STYLE}</style>\n<defs>", escaped(&self.title));
        for shape in Shape::ALL {
            let _ = writeln!(svg, r#"<path id="{}" d="{}"/>"#, shape.name(), shape.outline());
        }
        let _ = writeln!(svg, "</defs>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
        let _ = writeln!(
            svg,
            r#"<text class="title" x="{LEFT_PX}" y="24">{}</text><text class="subtitle" x="{LEFT_PX}" y="44">{}</text>"#,
            escaped(&self.title),
            escaped(&self.subtitle)
        );
        let mut left = LEFT_PX;
        for (index, panel) in self.panels.iter().enumerate() {
            panel.write(&mut svg, index, left);
            left += panel.width_px + BETWEEN_PX;
        }
        for (index, entry) in self.legend.iter().enumerate() {
            entry.write(&mut svg, legend_left, TOP_PX + 8.0 + LINE_PX * index as f64);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

impl Entry {
    fn write(&self, svg: &mut String, left: f64, middle: f64) {
        let at = left + 10.0;
        let _ = match self.sample {
            Some(Sample::Mark(mark)) => {
                let (attributes, name) = (mark.attributes(), mark.shape.name());
                writeln!(svg, r##"<g {attributes}><use href="#{name}" x="{at}" y="{middle}"/></g>"##)
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
    fn write(&self, svg: &mut String, index: usize, left: f64) {
        let width = self.width_px;
        let (right, bottom) = (left + width, TOP_PX + HEIGHT_PX);
        let _ = writeln!(
            svg,
            r#"<clipPath id="panel{index}"><rect x="{left}" y="{TOP_PX}" width="{width}" height="{HEIGHT_PX}"/></clipPath>"#
        );
        for (value, text) in self.x.ticks(width, 0) {
            let x = pixels(left + self.x.part(value) * width);
            let _ = writeln!(
                svg,
                r#"<path class="grid" d="M{x} {TOP_PX}V{bottom}"/><path class="frame" d="M{x} {bottom}v5"/><text x="{x}" y="{}" text-anchor="middle">{text}</text>"#,
                bottom + 19.0
            );
        }
        for (value, text) in self.y.ticks(HEIGHT_PX, 1) {
            let y = pixels(bottom - self.y.part(value) * HEIGHT_PX);
            let _ = writeln!(
                svg,
                r#"<path class="grid" d="M{left} {y}H{right}"/><path class="frame" d="M{left} {y}h-5"/><text x="{}" y="{y}" dy="4" text-anchor="end">{text}</text>"#,
                left - 9.0
            );
        }
        let _ = writeln!(svg, r#"<g clip-path="url(#panel{index})">"#);
        for layer in &self.layers {
            self.draw(svg, layer, left);
        }
        let _ = writeln!(
            svg,
            r#"</g><rect class="frame" x="{left}" y="{TOP_PX}" width="{width}" height="{HEIGHT_PX}"/>"#
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
            TOP_PX + 0.5 * HEIGHT_PX,
            escaped(&self.y.label)
        );
    }

    fn draw(&self, svg: &mut String, layer: &Layer, left: f64) {
        let place = |[x, y]: [f64; 2]| {
            [left + self.x.part(x) * self.width_px, TOP_PX + (1.0 - self.y.part(y)) * HEIGHT_PX]
        };
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
                    let _ = writeln!(svg, r##"<use href="#{}" x="{x}" y="{y}"/>"##, mark.shape.name());
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
            Layer::Area { colour, corners } => {
                writeln!(svg, r#"<path class="area" fill="{}" d="{}z"/>"#, colour.code(), path(corners))
            }
            Layer::Line { colour, points } => {
                writeln!(svg, r#"<path class="line" stroke="{}" d="{}"/>"#, colour.code(), path(points))
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
