//! A series of points that stays short however many there are.

use crate::summary_text::grouped;

/// No series of a figure has more points.
const POINTS_MAX: usize = 10_000;

/// Points of which every n-th is kept, n a power of two that grows with their number. Which are kept depends on their order
/// alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinned {
    points: Vec<[f64; 2]>,
    every: u64,
    count: u64,
}

impl Default for Thinned {
    fn default() -> Self {
        Self { points: Vec::new(), every: 1, count: 0 }
    }
}

impl Thinned {
    /// One more point.
    pub fn push(&mut self, point: [f64; 2]) {
        if self.count.is_multiple_of(self.every) {
            if self.points.len() == POINTS_MAX {
                let mut index = 0_usize;
                self.points.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.every *= 2;
            }
            if self.count.is_multiple_of(self.every) {
                self.points.push(point);
            }
        }
        self.count += 1;
    }

    /// How many points there were.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The points that were kept.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// `name: COUNT`, and how many of them are drawn if not all are.
    pub fn legend(&self, name: &str) -> String {
        let sample = if self.every > 1 { format!(" (1 in {} drawn)", self.every) } else { String::new() };
        format!("{name}: {}{sample}", grouped(self.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_series_is_thinned_evenly() {
        let mut series = Thinned::default();
        (0..POINTS_MAX).for_each(|index| series.push([index as f64, 0.0]));
        assert_eq!((series.points().len(), series.legend("a")), (POINTS_MAX, "a: 10,000".to_owned()));
        (POINTS_MAX..5 * POINTS_MAX).for_each(|index| series.push([index as f64, 0.0]));
        assert_eq!(series.legend("a"), "a: 50,000 (1 in 8 drawn)");
        let expected = (0..5 * POINTS_MAX).step_by(8).map(|index| [index as f64, 0.0]);
        assert!(series.points().iter().copied().eq(expected));
    }
}
