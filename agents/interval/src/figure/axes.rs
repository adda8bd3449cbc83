//! Axes: a frame, ticks at round numbers, names.

use super::escaped;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use std::fmt::Write as _;

/// No more ticks than this on an axis.
const MOST_TICKS: usize = 10;

/// Writes the frame around what is shown, whose place is `[left, top, width, height]` in pixels.
pub(super) fn write(svg: &mut String, view: &IntervalBox<2>, place: [f64; 4], labels: &[String; 2]) {
    let [left, top, width, height] = place;
    let bottom = top + height;
    let _ = writeln!(svg, r#"<rect class="frame" x="{left}" y="{top}" width="{width}" height="{height}"/>"#);
    for (value, text) in ticks(view[0], MOST_TICKS) {
        let x = left + (value - view[0].lower()) / (view[0].upper() - view[0].lower()) * width;
        let _ = writeln!(
            svg,
            r#"<path class="frame" d="M{x:.2} {bottom}v5"/><text x="{x:.2}" y="{}" text-anchor="middle">{text}</text>"#,
            bottom + 18.0
        );
    }
    for (value, text) in ticks(view[1], MOST_TICKS) {
        let y = top + (view[1].upper() - value) / (view[1].upper() - view[1].lower()) * height;
        let _ = writeln!(
            svg,
            r#"<path class="frame" d="M{left} {y:.2}h-5"/><text x="{}" y="{:.2}" text-anchor="end">{text}</text>"#,
            left - 8.0,
            y + 4.0
        );
    }
    let (middle_x, middle_y) = (left + 0.5 * width, top + 0.5 * height);
    let _ = writeln!(
        svg,
        r#"<text x="{middle_x}" y="{}" text-anchor="middle">{}</text>"#,
        bottom + 36.0,
        escaped(&labels[0])
    );
    let _ = writeln!(
        svg,
        r#"<text transform="translate(14 {middle_y}) rotate(-90)" text-anchor="middle">{}</text>"#,
        escaped(&labels[1])
    );
}

/// Round numbers along an axis with their texts, to place ticks at: multiples of 1, 2 or 5 times a power of ten, `most` or
/// fewer. None along an axis that is empty, unbounded or a point.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::figure::ticks;
/// let texts = |ticks: Vec<(f64, String)>| ticks.into_iter().map(|(_, text)| text).collect::<Vec<_>>();
/// assert_eq!(texts(ticks(Interval::new(-0.3, 1.1)?, 4)), ["0.0", "0.5", "1.0"]);
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
pub fn ticks(side: Interval, most: usize) -> Vec<(f64, String)> {
    let length = side.upper() - side.lower();
    if !(length > 0.0 && length.is_finite() && most > 0) {
        return Vec::new();
    }
    let (step, decimals) = step(length, most as f64);
    let (first, last) = ((side.lower() / step).ceil(), (side.upper() / step).floor());
    let mut ticks = Vec::new();
    let mut multiple = first;
    // Far from zero a step may vanish in rounding; the limit ends the loop then.
    while multiple <= last && ticks.len() <= most {
        // Adding zero turns a negative zero into a plain one.
        let value = multiple * step + 0.0;
        ticks.push((value, format!("{value:.decimals$}")));
        multiple += 1.0;
    }
    ticks
}

/// The smallest round step with few enough ticks over `length`, and how many decimals it takes to write.
fn step(length: f64, most: f64) -> (f64, usize) {
    let mut decimals = 0;
    let mut power = 1.0;
    while power * most > length && decimals < 300 {
        power /= 10.0;
        decimals += 1;
    }
    loop {
        for factor in [1.0, 2.0, 5.0] {
            if factor * power * most >= length {
                return (factor * power, decimals);
            }
        }
        power *= 10.0;
        decimals = decimals.saturating_sub(1);
    }
}
