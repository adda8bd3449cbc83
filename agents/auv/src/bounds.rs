//! Between the bounds of messages and the intervals of mathematics.

use shoal_bus::message::{Bounds, BoundsBox, Measured};
use shoal_interval::{Interval, IntervalBox};

/// The interval of these bounds; bounds that are inverted or not numbers hold nothing.
pub fn interval(bounds: Bounds) -> Interval {
    Interval::new(bounds.lower, bounds.upper).unwrap_or(Interval::EMPTY)
}

/// The box of these bounds.
pub fn interval_box(bounds: &BoundsBox) -> IntervalBox<3> {
    IntervalBox::from(bounds.map(interval))
}

/// All that a measurement allows.
pub fn measured(measured: Measured) -> Interval {
    Interval::centred(measured.value, measured.error)
}

/// The bounds of an interval, as they go into a message.
pub fn bounds(interval: Interval) -> Bounds {
    Bounds::new(interval.lower(), interval.upper())
}

/// The bounds of a box.
pub fn bounds_box(of: &IntervalBox<3>) -> BoundsBox {
    of.sides().map(bounds)
}
