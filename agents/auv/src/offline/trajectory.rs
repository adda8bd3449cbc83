//! One AUV's trajectory: a chain of states at moments of local time, with the odometry's ways in between.

use shoal_bus::message::{Born, Estimator as Orders, Sense, Sensed, TubeSettings};
use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use super::Recorded;
use super::exchange::{End, Event, Exchange, Place};
use crate::bounds::{interval, interval_box};
use crate::estimator::Estimator;
use crate::motion::{Motion, Stretch};
use crate::odometry::Way;
use crate::state::State;
use crate::travel::{local_s, seconds};
use crate::tube_estimator::TubeEstimator;

/// Nothing is known.
const ANYTHING: State = State { offset_s: Interval::ENTIRE, position_m: IntervalBox::ENTIRE };

/// What is known of an AUV at one of its ticks.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// Index of the tick.
    pub tick: u64,
    /// Local time of the tick.
    pub stamp: LocalTime,
    /// As the AUV would know it at once without any ping.
    pub alone: State,
    /// As the whole record tells it. Its offset is told against the exact local time, which may differ from the stamp by the
    /// stamp's tolerance.
    pub state: State,
}

/// One AUV's trajectory.
#[derive(Clone, Debug)]
pub struct Trajectory {
    motion: Motion,
    /// Birth, ticks, measurements, emissions and receptions, in order.
    stamps: Vec<LocalTime>,
    /// The state at each.
    states: Vec<State>,
    /// As its own log, depths and fixes tell it.
    own: Vec<State>,
    /// From each to the next.
    ways: Vec<Way>,
    ticks: Vec<OwnTick>,
    /// The ends of pings: at which moment, of which exchange.
    ends: Vec<(usize, usize, End)>,
    dropped: Vec<usize>,
    contradictions: u32,
    gain: f64,
}

#[derive(Clone, Copy, Debug)]
struct OwnTick {
    tick: u64,
    moment: usize,
    alone: State,
}

impl Trajectory {
    /// The trajectory that passes through ticks, measurements and `more` moments, with its ends of `exchanges`.
    pub(super) fn new(recorded: &Recorded, more: &[LocalTime], exchanges: &[Exchange]) -> Self {
        let Recorded { born, sensed, .. } = recorded;
        let stamps = moments(born, sensed, more);
        let at = |stamp: LocalTime| stamps.partition_point(|other| *other < stamp);
        let motion = Motion::new(&born.body, &born.clock);

        let mut alone = Alone::new(born);
        let mut ways = Vec::with_capacity(stamps.len());
        let mut ticks = Vec::with_capacity(sensed.len());
        let mut contradictions = 0;
        for sensed in sensed {
            let (state, is_contradictory) = alone.update(sensed);
            contradictions += u32::from(is_contradictory);
            ticks.push(OwnTick { tick: sensed.tick, moment: at(sensed.stamp), alone: state });
            if let Some((begun, stretch)) = alone.leg() {
                extend(&mut ways, &stamps, &motion, begun, &stretch, at(sensed.stamp));
            }
        }
        // What was booked at the last tick leaves after it.
        let begun = sensed.last().map_or(born.birth, |last| last.stamp);
        let end = stamps.last().map_or(begun, |end| begun.max(*end));
        let ahead = alone.estimator.stretch_ahead(seconds(end - begun));
        extend(&mut ways, &stamps, &motion, begun, &ahead, stamps.len());

        let mut trajectory = Self {
            motion,
            states: vec![ANYTHING; stamps.len()],
            own: Vec::new(),
            ways,
            ticks,
            ends: ends(born.auv.0 as usize, exchanges, at),
            dropped: Vec::new(),
            contradictions,
            gain: 0.0,
            stamps,
        };
        trajectory.measure(born, sensed);
        trajectory.backward();
        trajectory.own = trajectory.states.clone();
        trajectory
    }

    /// The states at its ticks.
    pub fn ticks(&self) -> impl ExactSizeIterator<Item = Tick> {
        self.ticks.iter().map(|own| Tick {
            tick: own.tick,
            stamp: self.stamps[own.moment],
            alone: own.alone,
            state: self.states[own.moment],
        })
    }

    /// Of how many ticks log, depth or fix contradicted what was possible, so that it was ignored.
    pub fn contradictions(&self) -> u32 {
        self.contradictions
    }

    /// Where it is at the end of a ping. None when it does not reach there.
    pub(super) fn place(&self, event: &Event) -> Option<Place> {
        let index = self.stamps.binary_search(&event.stamp).ok()?;
        Some(self.place_of(&self.states[index], event))
    }

    /// Contracts by all pings and propagates, forward and backward.
    pub(super) fn sweep(&mut self, exchanges: &[Exchange]) {
        let before = self.states.clone();
        self.dropped.clear();
        let mut ends = std::mem::take(&mut self.ends).into_iter().peekable();
        let mut kept = Vec::with_capacity(ends.len());
        // The last ping that told something new.
        let mut suspect = None;
        for index in 0..self.states.len() {
            let here = self.states[index];
            let mut state =
                match index.checked_sub(1).and_then(|last| self.states.get(last).zip(self.ways.get(last))) {
                    Some((last, way)) => here.intersection(&way.ahead(last)),
                    None => here,
                };
            if state.is_empty() {
                // Nothing leads from what pings made of the past to what they made of the future.
                self.dropped.extend(suspect.take());
                state = here;
            }
            while let Some(end) = ends.next_if(|(moment, ..)| *moment == index) {
                kept.push(end);
                let (_, number, side) = end;
                let Some(exchange) = exchanges.get(number).filter(|exchange| !exchange.is_dropped) else {
                    continue;
                };
                match self.contracted(&state, exchange, side) {
                    Some(known) => {
                        if known.is_tighter_than(&state) {
                            suspect = Some(number);
                        }
                        state = known;
                    }
                    None => self.dropped.push(number),
                }
            }
            self.states[index] = state;
        }
        self.ends = kept;
        self.backward();
        self.gain =
            before.iter().zip(&self.states).map(|(before, after)| gain(before, after)).fold(0.0, f64::max);
    }

    /// Pings that left nothing in the last sweep.
    pub(super) fn dropped(&self) -> impl Iterator<Item = usize> {
        self.dropped.iter().copied()
    }

    /// The greatest part of a width that the last sweep took away.
    pub(super) fn gain(&self) -> f64 {
        self.gain
    }

    /// Forgets what pings told.
    pub(super) fn restart(&mut self) {
        self.states.clone_from(&self.own);
    }

    fn place_of(&self, state: &State, event: &Event) -> Place {
        let there = Way::within(&self.motion, event.apart_s).ahead(state);
        Place { position_m: there.position_m, time_s: there.true_time_s(event.stamp_s) }
    }

    /// The state contracted by one end of a ping; None when nothing is left.
    fn contracted(&self, state: &State, exchange: &Exchange, end: End) -> Option<State> {
        let event = match end {
            End::Emission => exchange.emission.as_ref()?,
            End::Reception => &exchange.reception,
        };
        let Place { position_m, time_s } = exchange.contract(end, &self.place_of(state, event))?;
        let there = State { offset_s: time_s - event.stamp_s, position_m };
        let state = state.intersection(&Way::within(&self.motion, event.apart_s).back(&there));
        (!state.is_empty()).then_some(state)
    }

    /// The first way forward: prior, depths and fixes.
    fn measure(&mut self, born: &Born, sensed: &[Sensed]) {
        let stamp_s = born.clock.stamp_ns as f64 * 1e-9;
        let mut state = State {
            offset_s: interval(born.clock.offset_s),
            position_m: interval_box(&born.prior_position_m),
        };
        let mut events =
            sensed.iter().flat_map(|sensed| &sensed.events).filter(|event| is_local(&event.sense)).peekable();
        for index in 0..self.states.len() {
            if let Some(way) = index.checked_sub(1).and_then(|last| self.ways.get(last)) {
                state = way.ahead(&state);
            }
            while let Some(event) = events.next_if(|event| event.stamp <= self.stamps[index]) {
                let known = match &event.sense {
                    Sense::Depth { depth_m } => state.with_depth(*depth_m),
                    Sense::Gnss { position_m, time_s } => state.with_fix(
                        &interval_box(position_m),
                        interval(*time_s),
                        local_s(event.stamp, stamp_s),
                    ),
                    _ => Ok(state),
                };
                // What contradicts the rest is ignored, and was counted as it came.
                state = known.unwrap_or(state);
            }
            self.states[index] = state;
        }
    }

    fn backward(&mut self) {
        for index in (0..self.ways.len()).rev() {
            let back = self.ways[index].back(&self.states[index + 1]);
            let known = self.states[index].intersection(&back);
            // Each state leads to the next, so nothing is left only where they touch, for want of digits.
            if !known.is_empty() {
                self.states[index] = known;
            }
        }
    }
}

/// The AUV as it would know itself without any ping.
struct Alone {
    estimator: TubeEstimator,
    heard_nothing: Sensed,
}

impl Alone {
    fn new(born: &Born) -> Self {
        let mut born = born.clone();
        born.orders.estimator = Orders::Tube(TubeSettings::forward(0));
        let heard_nothing = Sensed { tick: 0, stamp: born.birth, events: Vec::new() };
        Self { estimator: TubeEstimator::new(&born), heard_nothing }
    }

    /// The state at the tick, and whether something contradicted it.
    fn update(&mut self, sensed: &Sensed) -> (State, bool) {
        let told = &mut self.heard_nothing;
        (told.tick, told.stamp) = (sensed.tick, sensed.stamp);
        told.events.clear();
        let is_told = |sense: &Sense| !matches!(sense, Sense::Heard { .. } | Sense::Held);
        told.events.extend(sensed.events.iter().filter(|event| is_told(&event.sense)).cloned());
        let estimate = self.estimator.update(told);
        (estimate.state, estimate.emptied.is_some())
    }

    /// When the last leg began, and what is known of the velocity in it.
    fn leg(&self) -> Option<(LocalTime, Stretch)> {
        self.estimator.last_leg().map(|leg| (leg.begun, leg.stretch))
    }
}

/// Whether it says where and when the AUV is, without another.
fn is_local(sense: &Sense) -> bool {
    matches!(sense, Sense::Depth { .. } | Sense::Gnss { .. })
}

/// Birth, ticks, local measurements and `more`, in order.
fn moments(born: &Born, sensed: &[Sensed], more: &[LocalTime]) -> Vec<LocalTime> {
    let mut stamps = vec![born.birth];
    for sensed in sensed {
        stamps.push(sensed.stamp);
        stamps.extend(sensed.events.iter().filter(|event| is_local(&event.sense)).map(|event| event.stamp));
    }
    stamps.extend(more);
    stamps.retain(|stamp| *stamp >= born.birth);
    stamps.sort_unstable();
    stamps.dedup();
    stamps
}

/// The ways from where `ways` ends to moment `until`, all within one stretch.
fn extend(
    ways: &mut Vec<Way>,
    stamps: &[LocalTime],
    motion: &Motion,
    begun: LocalTime,
    stretch: &Stretch,
    until: usize,
) {
    for pair in stamps.windows(2).take(until).skip(ways.len()) {
        let [from_s, to_s] = [pair[0], pair[1]].map(|stamp| seconds(stamp - begun));
        ways.push(Way::from(&motion.over(stretch, from_s, to_s)));
    }
}

/// The ends of pings of `auv`, sorted by moment.
fn ends(auv: usize, exchanges: &[Exchange], at: impl Fn(LocalTime) -> usize) -> Vec<(usize, usize, End)> {
    let mut ends = Vec::new();
    for (number, exchange) in exchanges.iter().enumerate() {
        let emission = exchange.emission.as_ref().map(|event| (event, End::Emission));
        for (event, end) in emission.into_iter().chain([(&exchange.reception, End::Reception)]) {
            if event.auv == auv {
                ends.push((at(event.stamp), number, end));
            }
        }
    }
    ends.sort_unstable();
    ends
}

/// The greatest part of a width that was taken away.
fn gain(before: &State, after: &State) -> f64 {
    let part = |before: Interval, after: Interval| {
        let width = before.width();
        if width.is_finite() && width > 0.0 { 1.0 - after.width() / width } else { 0.0 }
    };
    (0..3)
        .map(|axis| part(before.position_m[axis], after.position_m[axis]))
        .fold(part(before.offset_s, after.offset_s), f64::max)
}
