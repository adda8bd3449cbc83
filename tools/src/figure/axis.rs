//! An axis: from values to pixels.

use shoal_interval::Interval;
use shoal_interval::figure::ticks;

/// Ticks are at least this far apart along x and y, in pixels.
const TICK_SPACING_PX: [f64; 2] = [45.0, 36.0];

/// Room beside the outermost value, as a part of the axis.
const MARGIN: f64 = 0.04;

/// What one direction of a panel means.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it says, with the unit.
    pub label: String,
    /// Value at the beginning: to the left, or below.
    pub first: f64,
    /// Value at the end: to the right, or above; less than `first` on an axis that runs the other way.
    pub last: f64,
}

impl Axis {
    /// An axis from one value to another.
    pub fn new(label: impl Into<String>, first: f64, last: f64) -> Self {
        Self { label: label.into(), first, last }
    }

    /// An axis on which `least` and `greatest` have some room beside them; `0..1` around nothing.
    pub fn around(label: impl Into<String>, least: f64, greatest: f64) -> Self {
        let label = label.into();
        let length = greatest - least;
        if !length.is_finite() {
            return Self::new(label, 0.0, 1.0);
        }
        // A single value gets an axis of its own size, and zero one of unit length.
        let room = if length > 0.0 { length * MARGIN } else { (greatest.abs() * MARGIN).max(0.5) };
        Self::new(label, least - room, greatest + room)
    }

    /// As [`around`](Self::around), for values that cannot be negative: begins at zero.
    pub fn from_zero(label: impl Into<String>, greatest: f64) -> Self {
        let last = if greatest > 0.0 && greatest.is_finite() { greatest * (1.0 + MARGIN) } else { 1.0 };
        Self::new(label, 0.0, last)
    }

    /// The same axis, running the other way.
    pub fn reversed(self) -> Self {
        Self { first: self.last, last: self.first, ..self }
    }

    /// An axis that runs the same way and holds what both hold.
    pub fn hull(&self, other: &Self) -> Self {
        let is_reversed = self.first > self.last;
        let ends = [self.first, self.last, other.first, other.last];
        let (least, greatest) = (
            ends.into_iter().fold(f64::INFINITY, f64::min),
            ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
        );
        let axis = Self::new(self.label.clone(), least, greatest);
        if is_reversed { axis.reversed() } else { axis }
    }

    /// Both axes of a map in a panel of this width and height: the same scale along both, with everything between `least` and
    /// `greatest`.
    pub fn map(labels: [&str; 2], least: [f64; 2], greatest: [f64; 2], size_px: [f64; 2]) -> [Self; 2] {
        let around = |axis: usize| Self::around(labels[axis], least[axis], greatest[axis]);
        let axes = [around(0), around(1)];
        let units = |axis: usize| (axes[axis].last - axes[axis].first) / size_px[axis];
        let scale = units(0).max(units(1));
        let [x, y] = axes;
        [(x, size_px[0]), (y, size_px[1])].map(|(axis, length_px)| {
            let (middle, half) = (0.5 * axis.first + 0.5 * axis.last, 0.5 * scale * length_px);
            Self::new(axis.label, middle - half, middle + half)
        })
    }

    /// Where `value` lies: 0 at the beginning, 1 at the end.
    pub fn part(&self, value: f64) -> f64 {
        (value - self.first) / (self.last - self.first)
    }

    /// Round values with their texts; `direction` is 0 along x and 1 along y.
    pub fn ticks(&self, length_px: f64, direction: usize) -> Vec<(f64, String)> {
        let most = (length_px / TICK_SPACING_PX[direction.min(1)]).floor().max(2.0) as usize;
        let side = Interval::new(self.first.min(self.last), self.first.max(self.last));
        side.map_or_else(|_| Vec::new(), |side| ticks(side, most))
    }
}
