//! The way behind: what the body did from any remembered moment until now.
//!
//! What is heard may be told seconds after it arrived, and not in the order of arrivals. It contracts the state that was, at the
//! moment that it belongs to, and what the body did since carries the outcome to the present: a position then plus the
//! displacement from then to now holds the position now. The displacement comes from log and clock alone and no measurement of
//! positions enters it, so it stays as narrow as the odometry is good, however wide the state is.

use std::collections::VecDeque;

use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use crate::motion::{Motion, Moved, Stretch};
use crate::state::State;
use crate::travel::seconds;

/// What happened between two moments, the earlier first.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Displacement, in metres.
    pub displacement_m: IntervalBox<3>,
    /// Change of true minus local time, in seconds.
    pub offset_gain_s: Interval,
}

impl Way {
    /// From a moment to itself.
    pub fn none() -> Self {
        Self { displacement_m: IntervalBox::from([Interval::ZERO; 3]), offset_gain_s: Interval::ZERO }
    }

    /// Between two moments that are at most `elapsed_s` local seconds apart, whichever is the earlier.
    pub fn within(motion: &Motion, elapsed_s: f64) -> Self {
        let offset_gain_s = motion.offset_gain(elapsed_s);
        Self {
            displacement_m: motion.anywhere_within(elapsed_s),
            offset_gain_s: offset_gain_s.hull(-offset_gain_s),
        }
    }

    /// This way, and then `next`.
    #[inline]
    pub fn then(&self, next: &Way) -> Self {
        // All four coordinates at once.
        let [x, y, z, offset_gain_s] = (self.as_box() + next.as_box()).sides();
        Self { displacement_m: IntervalBox::from([x, y, z]), offset_gain_s }
    }

    fn as_box(&self) -> IntervalBox<4> {
        let [x, y, z] = self.displacement_m.sides();
        IntervalBox::from([x, y, z, self.offset_gain_s])
    }

    /// The state at its end, from the one at its beginning.
    pub fn ahead(&self, state: &State) -> State {
        State {
            offset_s: state.offset_s + self.offset_gain_s,
            position_m: state.position_m + self.displacement_m,
        }
    }

    /// The state at its beginning, from the one at its end.
    pub fn back(&self, state: &State) -> State {
        State {
            offset_s: state.offset_s - self.offset_gain_s,
            position_m: state.position_m - self.displacement_m,
        }
    }
}

impl From<&Moved> for Way {
    fn from(moved: &Moved) -> Self {
        Self { displacement_m: moved.displacement_m, offset_gain_s: moved.offset_gain_s }
    }
}

/// From one tick to the next.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// The earlier tick.
    pub begun: LocalTime,
    /// The later tick.
    pub ended: LocalTime,
    /// What was known of the state at the earlier one.
    pub state: State,
    /// What was known of the velocity in between.
    pub stretch: Stretch,
    /// From tick to tick.
    pub way: Way,
}

/// The legs up to the last tick, as far back as the horizon.
#[derive(Debug)]
pub struct Odometry {
    horizon_ns: i64,
    legs: VecDeque<Leg>,
}

impl Odometry {
    /// Nothing to remember yet; later no more than `horizon_ns` local nanoseconds, and the leg that they begin in.
    pub fn new(horizon_ns: i64) -> Self {
        Self { horizon_ns, legs: VecDeque::new() }
    }

    /// Adds the leg that begins where the last one ended, and forgets those that ended beyond the horizon.
    ///
    /// # Panics
    /// When the leg does not end after it began: the channel's ticks are a period apart, so that is a bug, and no state may grow
    /// out of it.
    pub fn append(&mut self, leg: Leg) {
        assert!(leg.begun < leg.ended, "ticks come in order");
        let oldest = leg.ended + -self.horizon_ns;
        while self.legs.front().is_some_and(|leg| leg.ended < oldest) {
            self.legs.pop_front();
        }
        if self.legs.len() == self.legs.capacity() {
            // By a quarter and not to the double: what is unused stays small.
            self.legs.reserve_exact((self.legs.len() / 4).max(4));
        }
        self.legs.push_back(leg);
    }

    /// Forgets all of it.
    pub fn clear(&mut self) {
        self.legs.clear();
    }

    /// The leg that ended last.
    pub fn last(&self) -> Option<&Leg> {
        self.legs.back()
    }

    /// Bytes of heap in use.
    pub fn memory_bytes(&self) -> usize {
        self.legs.capacity() * size_of::<Leg>()
    }

    /// The state at `stamp` as it was known then, and the way from there to the last tick. None when `stamp` is not
    /// remembered: beyond the horizon, before birth, or after the last tick.
    ///
    /// The cost is that of an addition for each leg since.
    pub fn recall(&self, stamp: LocalTime, motion: &Motion) -> Option<(State, Way)> {
        let index = self.legs.partition_point(|leg| leg.ended < stamp);
        let leg = self.legs.get(index).filter(|leg| leg.begun <= stamp)?;
        let split_s = seconds(stamp - leg.begun);
        let passage = motion.along(&leg.stretch);
        let before = passage.over(0.0, split_s);
        let after = passage.over(split_s, leg.stretch.length_s);
        let since = self.legs.range(index + 1..);
        let way = since.fold(Way::from(&after), |way, leg| way.then(&leg.way));
        Some((leg.state.moved(&before), way))
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::message::{BodyBounds, Bounds, ClockBounds};

    use super::*;

    const TICK_NS: i64 = 100_000_000;

    fn motion() -> Motion {
        let none = [Bounds::default(); 3];
        let body = BodyBounds {
            speed_m_s: 2.0,
            acceleration_m_s2: 1.0,
            current_m_s: none,
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: none,
        };
        Motion::new(&body, &ClockBounds { drift: 1e-4, offset_s: none[0], stamp_ns: 2 })
    }

    /// East at 1 m/s for `ticks` ticks from local time zero and the origin, known exactly; a state is as wide as its tick's number
    /// in millimetres.
    fn eastbound(ticks: i64, horizon_ns: i64) -> Odometry {
        let mut odometry = Odometry::new(horizon_ns);
        let east_m_s = IntervalBox::from([Interval::ONE, Interval::ZERO, Interval::ZERO]);
        let current_m_s = IntervalBox::from([Interval::ZERO; 3]);
        let stretch = Stretch { before_m_s: east_m_s, after_m_s: east_m_s, current_m_s, length_s: 0.1 };
        for tick in 0..ticks {
            let begun = LocalTime::from_ns(tick * TICK_NS);
            let x = Interval::centred(0.1 * tick as f64, 0.5e-3 * tick as f64);
            let position_m = IntervalBox::from([x, Interval::ZERO, Interval::ZERO]);
            odometry.append(Leg {
                begun,
                ended: begun + TICK_NS,
                state: State { offset_s: Interval::ZERO, position_m },
                stretch,
                way: Way::from(&motion().over(&stretch, 0.0, 0.1)),
            });
        }
        odometry
    }

    #[test]
    fn the_way_back_leads_here() {
        let odometry = eastbound(50, 100 * TICK_NS);
        for stamp_ns in [0, 1, 123_456_789, TICK_NS, 30 * TICK_NS + 1, 49 * TICK_NS, 50 * TICK_NS] {
            let (state, way) = odometry.recall(LocalTime::from_ns(stamp_ns), &motion()).unwrap();
            let then_m = stamp_ns as f64 * 1e-9;
            assert!(state.position_m[0].contains(then_m), "{stamp_ns}: {then_m} in {:?}", state.position_m);
            assert!(way.displacement_m[0].contains(5.0 - then_m), "{stamp_ns}: {:?}", way.displacement_m);
            assert!(way.ahead(&state).position_m[0].contains(5.0));
            assert!(way.back(&way.ahead(&state)).position_m[0].contains(then_m));
            // A velocity that is known at both ends of a tick leaves a quarter of its change either way, 2.5 mm a tick, and the
            // clock's drift 0.1 mm/s either way.
            let elapsed_s = 5.0 - then_m;
            assert!(way.displacement_m[0].width() < elapsed_s * (5.0e-2 + 4e-4) + 6e-3);
            assert!(
                way.offset_gain_s.contains(0.0) && way.offset_gain_s.width() <= 2.1e-4 * elapsed_s + 1e-9
            );
        }
    }

    #[test]
    fn only_the_remembered_is_recalled() {
        let odometry = eastbound(50, 10 * TICK_NS);
        let recall = |stamp_ns| odometry.recall(LocalTime::from_ns(stamp_ns), &motion());
        assert!(recall(39 * TICK_NS - 1).is_none() && recall(40 * TICK_NS).is_some());
        assert!(recall(50 * TICK_NS).is_some() && recall(50 * TICK_NS + 1).is_none());
        assert!(odometry.legs.len() <= 11);
        assert!(Odometry::new(TICK_NS).recall(LocalTime::ZERO, &motion()).is_none());
    }
}
