//! The state of an AUV as a set: its position, and the true time as one more coordinate.

use shoal_bus::message::{Culprit, Measured};
use shoal_bus::ping::Ping;
use shoal_interval::contractor::{Contracted, contract_range};
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::{interval, interval_box, measured};
use crate::motion::{Motion, Moved};

/// Encloses position and clock at one moment of local time.
///
/// The true time is enclosed by its difference from the own clock: t lies in `local + offset_s`, where `local` is the exact
/// local time of the moment, within the stamp's tolerance of its stamp.
#[derive(Clone, Copy, Debug)]
pub struct State {
    /// True minus local time, in seconds.
    pub offset_s: Interval,
    /// Position in metres.
    pub position_m: IntervalBox<3>,
}

/// A moment of local time at which something was measured.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Its stamp in seconds of local time.
    pub stamp_s: Interval,
    /// Local seconds by which it may differ from the moment of the state that is contracted.
    pub apart_s: f64,
}

/// What is certain about sound, whoever it comes from.
#[derive(Clone, Copy, Debug)]
pub struct Sound {
    /// Its speed in m/s.
    pub speed_m_s: Interval,
    /// What is heard comes from no farther than this, in metres.
    pub hearing_range_m: f64,
}

/// A measurement that leaves nothing of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction(pub Culprit);

impl State {
    /// No state at all.
    pub const EMPTY: Self = Self { offset_s: Interval::EMPTY, position_m: IntervalBox::EMPTY };

    /// As a box of (clock offset, x, y, z).
    pub fn as_box(&self) -> IntervalBox<4> {
        let [x, y, z] = self.position_m.sides();
        IntervalBox::from([self.offset_s, x, y, z])
    }

    /// The state of a box of (clock offset, x, y, z).
    pub fn of_box(of: &IntervalBox<4>) -> Self {
        let [offset_s, x, y, z] = of.sides();
        Self { offset_s, position_m: IntervalBox::from([x, y, z]) }
    }

    /// The state after `moved`.
    pub fn moved(&self, moved: &Moved) -> Self {
        Self {
            offset_s: self.offset_s + moved.offset_gain_s,
            position_m: self.position_m + moved.displacement_m,
        }
    }

    /// All states from this one to the one after `moved`, which was then contracted to `after`.
    pub fn swept(&self, moved: &Moved, after: &State) -> Self {
        Self {
            offset_s: (self.offset_s + moved.offset_within_s)
                .intersection(after.offset_s - moved.offset_within_s),
            position_m: (self.position_m + moved.within_m).intersection(&(after.position_m - moved.within_m)),
        }
    }

    /// All states during `moved`, which ended in this one.
    pub fn backwards(&self, moved: &Moved) -> Self {
        Self { offset_s: self.offset_s - moved.offset_within_s, position_m: self.position_m - moved.within_m }
    }

    /// The smallest state that holds both.
    pub fn hull(&self, other: &Self) -> Self {
        Self {
            offset_s: self.offset_s.hull(other.offset_s),
            position_m: self.position_m.hull(&other.position_m),
        }
    }

    /// The states that both hold.
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            offset_s: self.offset_s.intersection(other.offset_s),
            position_m: self.position_m.intersection(&other.position_m),
        }
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.offset_s.is_empty() || self.position_m.is_empty()
    }

    /// True time at `stamp_s`, in seconds.
    pub fn true_time_s(&self, stamp_s: Interval) -> Interval {
        self.offset_s + stamp_s
    }

    /// Contracts by a depth.
    pub fn with_depth(&self, depth_m: Measured) -> Result<Self, Contradiction> {
        let [x, y, z] = self.position_m.sides();
        let z = z.intersection(-measured(depth_m));
        Self { position_m: IntervalBox::from([x, y, z]), ..*self }.unless_empty(Culprit::Depth)
    }

    /// Contracts by a satellite fix: a position box and a true-time interval that hold at the moment.
    pub fn with_fix(
        &self,
        position_m: &IntervalBox<3>,
        time_s: Interval,
        stamp_s: Interval,
    ) -> Result<Self, Contradiction> {
        Self {
            offset_s: self.offset_s.intersection(time_s - stamp_s),
            position_m: self.position_m.intersection(position_m),
        }
        .unless_empty(Culprit::Gnss)
    }

    /// Contracts by a ping: the receiver at arrival lies as far from the emitter at emission as sound travels in between,
    /// `|p_i - p(s)| in [c] ([t](s) - [a])` (seed 001, equation 5.7), and no farther than sound is heard.
    pub fn with_ping(
        &self,
        ping: &Ping,
        sound: &Sound,
        arrival: &Moment,
        motion: &Motion,
    ) -> Result<Self, Contradiction> {
        let nearby_m = motion.anywhere_within(arrival.apart_s);
        let offset_gain_s = motion.offset_gain(arrival.apart_s);
        let offset_gain_s = offset_gain_s.hull(-offset_gain_s);
        let mut position_m = self.position_m + nearby_m;
        let mut emitter_m = interval_box(&ping.position_m);
        let mut sound_speed_m_s = sound.speed_m_s;
        let mut emission_s = interval(ping.emission_s);
        let longest_delay_s = Interval::spanning(0.0, sound.hearing_range_m) / sound_speed_m_s;
        let mut reception_s =
            (self.true_time_s(arrival.stamp_s) + offset_gain_s).intersection(emission_s + longest_delay_s);
        let contracted = contract_range(
            &mut position_m,
            &mut emitter_m,
            &mut sound_speed_m_s,
            &mut reception_s,
            &mut emission_s,
        );
        if contracted == Contracted::Empty {
            return Err(Contradiction(Culprit::Ping(ping.sender)));
        }
        Self {
            offset_s: self.offset_s.intersection(reception_s - arrival.stamp_s + offset_gain_s),
            position_m: self.position_m.intersection(&(position_m + nearby_m)),
        }
        .unless_empty(Culprit::Ping(ping.sender))
    }

    /// Whether this state is smaller than `before` in some coordinate, by more than rounding.
    pub fn is_tighter_than(&self, before: &Self) -> bool {
        let shrunk = |now: Interval, then: Interval| now.width() < then.width() * (1.0 - 1e-9);
        shrunk(self.offset_s, before.offset_s)
            || (0..3).any(|axis| shrunk(self.position_m[axis], before.position_m[axis]))
    }

    fn unless_empty(self, culprit: Culprit) -> Result<Self, Contradiction> {
        if self.is_empty() { Err(Contradiction(culprit)) } else { Ok(self) }
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::message::{AuvId, BodyBounds, Bounds, ClockBounds};

    use super::*;

    fn motion() -> Motion {
        let body = BodyBounds {
            speed_m_s: 2.0,
            acceleration_m_s2: 1.0,
            current_m_s: [Bounds::default(); 3],
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: [Bounds::default(); 3],
        };
        Motion::new(&body, &ClockBounds { drift: 1e-4, offset_s: Bounds::default(), stamp_ns: 2 })
    }

    fn side(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    /// A ping that left the origin at true time 10 s.
    fn ping() -> Ping {
        let moment = Bounds::new(10.0, 10.0);
        Ping {
            sender: AuvId(3),
            sequence: 0,
            emission_s: moment,
            position_m: [Bounds::default(); 3],
            velocity_m_s: [Bounds::default(); 3],
        }
    }

    const SOUND: Sound = Sound { speed_m_s: Interval::ONE, hearing_range_m: f64::INFINITY };

    fn heard(state: &State, sound: &Sound, at_s: f64) -> Result<State, Contradiction> {
        let arrival = Moment { stamp_s: Interval::point(at_s).unwrap(), apart_s: 0.0 };
        state.with_ping(&ping(), sound, &arrival, &motion())
    }

    #[test]
    fn a_ping_contracts_position_and_clock_at_once() {
        // Between 30 and 50 m east; the clock is off by up to 10 s; sound goes at 1 m/s; heard at 45 s of the own clock.
        let state = State {
            offset_s: side(-10.0, 10.0),
            position_m: IntervalBox::from([side(30.0, 50.0), Interval::ZERO, Interval::ZERO]),
        };
        let known = heard(&state, &SOUND, 45.0).unwrap();
        // Travel time is 25 to 45 s, and 30 to 50 m at 1 m/s: 30 to 45 of both.
        assert!(
            (known.position_m[0].lower() - 30.0).abs() < 1e-6
                && (known.position_m[0].upper() - 45.0).abs() < 1e-6
        );
        assert!((known.offset_s.lower() + 5.0).abs() < 1e-6 && (known.offset_s.upper() - 10.0).abs() < 1e-6);
        assert!(known.is_tighter_than(&state));
    }

    #[test]
    fn what_is_heard_is_near() {
        let anywhere =
            State { offset_s: side(-1e3, 1e3), position_m: IntervalBox::from([side(-1e4, 1e4); 3]) };
        let sound = Sound { hearing_range_m: 5.0, ..SOUND };
        let known = heard(&anywhere, &sound, 45.0).unwrap();
        assert!(known.position_m.width() < 10.001 && known.offset_s.width() < 5.001);
    }

    #[test]
    fn a_contradiction_names_its_culprit() {
        let state = State {
            offset_s: Interval::ZERO,
            position_m: IntervalBox::from([side(300.0, 301.0), Interval::ZERO, Interval::ZERO]),
        };
        assert_eq!(heard(&state, &SOUND, 45.0).unwrap_err(), Contradiction(Culprit::Ping(AuvId(3))));
        let deep = Measured { value: 7.0, error: 0.5 };
        assert_eq!(state.with_depth(deep).unwrap_err(), Contradiction(Culprit::Depth));
    }
}
