//! The check: every enclosure that an AUV states is compared with the truth.

use shoal_bus::chronicle::{Coordinate, Enclosure, Violation};
use shoal_bus::message::{Bounds, BoundsBox};

use crate::body::Vec3;

const POSITION: [Coordinate; 3] = [Coordinate::X, Coordinate::Y, Coordinate::Z];
const VELOCITY: [Coordinate; 3] = [Coordinate::VelocityX, Coordinate::VelocityY, Coordinate::VelocityZ];

/// Compares one enclosure with the truth, coordinate by coordinate, and keeps the worst violation.
pub struct Check {
    enclosure: Enclosure,
    worst: Option<Violation>,
}

impl Check {
    /// A check of `enclosure`.
    pub fn of(enclosure: Enclosure) -> Self {
        Self { enclosure, worst: None }
    }

    /// Positions in metres.
    pub fn position(self, stated: &BoundsBox, truth_m: &Vec3) -> Self {
        self.all(&POSITION, stated, truth_m)
    }

    /// The horizontal part of a displacement, in metres.
    pub fn horizontal(self, stated: &[Bounds; 2], truth_m: &Vec3) -> Self {
        (0..2).fold(self, |check, axis| check.one(POSITION[axis], &stated[axis], truth_m[axis]))
    }

    /// Velocities over ground in m/s.
    pub fn velocity(self, stated: &BoundsBox, truth_m_s: &Vec3) -> Self {
        self.all(&VELOCITY, stated, truth_m_s)
    }

    /// A true time, or an offset from it, in seconds.
    pub fn time(self, stated: &Bounds, truth_s: f64) -> Self {
        self.one(Coordinate::Time, stated, truth_s)
    }

    /// The worst coordinate outside, if any is.
    pub fn violation(self) -> Option<Violation> {
        self.worst
    }

    fn all(self, coordinates: &[Coordinate; 3], stated: &BoundsBox, truth: &Vec3) -> Self {
        (0..3).fold(self, |check, axis| check.one(coordinates[axis], &stated[axis], truth[axis]))
    }

    fn one(mut self, coordinate: Coordinate, stated: &Bounds, truth: f64) -> Self {
        if stated.contains(truth) {
            return self;
        }
        let margin =
            if stated.is_valid() { (stated.lower - truth).max(truth - stated.upper) } else { f64::INFINITY };
        if self.worst.is_none_or(|worst| worst.margin < margin) {
            self.worst = Some(Violation { enclosure: self.enclosure, coordinate, margin });
        }
        self
    }
}

/// The violation of a set that holds nothing, or cannot be read.
pub fn nothing(enclosure: Enclosure) -> Violation {
    Violation { enclosure, coordinate: Coordinate::All, margin: f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_belong_to_the_set_and_the_worst_coordinate_is_named() {
        let unit = [Bounds::new(0.0, 1.0); 3];
        assert_eq!(Check::of(Enclosure::Report).position(&unit, &Vec3::new(0.0, 1.0, 0.5)).violation(), None);
        let worst = Check::of(Enclosure::Report).position(&unit, &Vec3::new(-0.25, 3.0, 0.5)).violation();
        let expected = Violation { enclosure: Enclosure::Report, coordinate: Coordinate::Y, margin: 2.0 };
        assert_eq!(worst, Some(expected));
    }

    #[test]
    fn an_inverted_or_undefined_interval_holds_nothing() {
        for stated in [Bounds::new(1.0, 0.0), Bounds::new(f64::NAN, 1.0)] {
            let found = Check::of(Enclosure::Ping).time(&stated, 0.5).violation().unwrap();
            assert_eq!(found.margin, f64::INFINITY);
        }
    }
}
