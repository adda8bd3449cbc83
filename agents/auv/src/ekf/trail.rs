//! The way behind, as a Kalman filter remembers it: its own displacement through the water, tick by tick.

use std::collections::VecDeque;

use nalgebra::Vector3;
use shoal_bus::time::LocalTime;

use crate::travel::seconds;

/// Displacement through the water since birth, at the ticks of the last while.
#[derive(Debug)]
pub struct Trail {
    horizon_ns: i64,
    ticks: VecDeque<(LocalTime, Vector3<f64>)>,
}

impl Trail {
    /// Begins at birth and remembers so many local nanoseconds.
    pub fn new(birth: LocalTime, horizon_ns: i64) -> Self {
        Self { horizon_ns, ticks: VecDeque::from([(birth, Vector3::zeros())]) }
    }

    /// Goes on to the tick at `stamp`, by `moved_m` metres through the water.
    pub fn append(&mut self, stamp: LocalTime, moved_m: Vector3<f64>) {
        let travelled_m = self.ticks.back().map_or_else(Vector3::zeros, |&(_, last_m)| last_m);
        self.ticks.push_back((stamp, travelled_m + moved_m));
        let oldest = stamp + -self.horizon_ns;
        // The last one before the horizon is the beginning of a leg that ends within.
        while self.ticks.get(1).is_some_and(|&(stamp, _)| stamp < oldest) {
            self.ticks.pop_front();
        }
    }

    /// Metres through the water from `stamp` to the last tick, as if each leg between ticks were straight and even. None for what
    /// is not remembered.
    pub fn since(&self, stamp: LocalTime) -> Option<Vector3<f64>> {
        let &(_, now_m) = self.ticks.back()?;
        let after = self.ticks.partition_point(|&(tick, _)| tick < stamp);
        let &(end, end_m) = self.ticks.get(after)?;
        if end == stamp {
            return Some(now_m - end_m);
        }
        let &(begin, begin_m) = self.ticks.get(after.checked_sub(1)?)?;
        let part = seconds(stamp - begin) / seconds(end - begin);
        Some(now_m - (begin_m + (end_m - begin_m) * part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_since_is_what_was_gone_since() {
        let tick = |index: i64| LocalTime::from_ns(index * 100);
        let mut trail = Trail::new(tick(0), 300);
        for index in 1..=6 {
            trail.append(tick(index), Vector3::new(index as f64, 0.0, -1.0));
        }
        assert_eq!(trail.since(tick(6)), Some(Vector3::zeros()));
        assert_eq!(trail.since(tick(4)), Some(Vector3::new(5.0 + 6.0, 0.0, -2.0)));
        assert_eq!(trail.since(LocalTime::from_ns(425)), Some(Vector3::new(0.75 * 5.0 + 6.0, 0.0, -1.75)));
        assert!(trail.since(LocalTime::from_ns(299)).is_some());
        assert_eq!(trail.since(LocalTime::from_ns(199)), None);
        assert_eq!(trail.since(LocalTime::from_ns(601)), None);
        assert!(trail.ticks.len() <= 5);
    }
}
