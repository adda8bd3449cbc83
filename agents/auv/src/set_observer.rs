//! The robust set observer: an estimator for an AUV that may hear something wrong, or does not know where it begins.
//!
//! Log, attitude, depth and satellites are believed; of the pings, some may be wrong, as many as the orders say. So no ping contracts the
//! state for good: the present is looked up anew at each ping in a [window](crate::relaxed) of the last ones (seed 004, section 3), as
//! [several hypotheses](crate::hypotheses) where it lies in several parts.
//!
//! When nothing is left, more went wrong than was assumed: the estimate says so, names the culprit, and goes on as the orders say.
//!
//! | policy | what is done | what it trusts |
//! |---|---|---|
//! | drop | the culprit is ignored | all that was known before |
//! | relax | as few remembered pings as possible are ignored; if that is no help, restart | what was known before them |
//! | restart | all is forgotten: anywhere that leads here from the area, with the clock that dead reckoning and satellites alone leave | the area, clock and body |
//!
//! Restart is what finds a kidnapped AUV again: seed 002, algorithm 4.2 (RTubeCSIVIA), shortens the past until something is left; here all
//! of it goes: older pings, which could mislead by chance, the way behind, and the current, which was another one where the body was. The
//! kidnapping may have been long ago, so the body may have left the area since; how far is known by the log.

use std::collections::BTreeMap;

use shoal_bus::message::{
    AuvId, Born, Culprit, Emptied, Event, Outliers, Recovery, Sense, Sensed, TubeSettings,
};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::{interval, interval_box};
use crate::estimator::{Estimate, Estimator, Prediction};
use crate::hypotheses::Hypotheses;
use crate::motion::Stretch;
use crate::odometry::{Leg, Odometry, Way};
use crate::relaxed::{Observed, Window};
use crate::rings::Ring;
use crate::state::{Contradiction, Sound, State};
use crate::travel::{Travel, local_s, seconds};

/// The window of an AUV whose orders keep no rings and assume no outliers.
const WINDOW_DEFAULT: u16 = 12;

/// Encloses the state by what most of the last pings allow.
pub struct SetObserver {
    travel: Travel,
    odometry: Odometry,
    sound: Sound,
    timestamp_s: f64,
    stamp_s: f64,
    area_m: IntervalBox<3>,
    /// Where the body can be if it was left in the area at any moment until now.
    anywhere_m: IntervalBox<3>,
    begins_again: bool,
    on_empty: Recovery,
    window: Window,
    states: Hypotheses,
    /// True minus local time by what was told at birth, drift and satellites alone: no ping can have spoiled it.
    certain_offset_s: Interval,
    trust: BTreeMap<AuvId, Trust>,
}

/// What a sender's pings were worth so far. Steers, and never enters an enclosure.
#[derive(Clone, Copy, Debug, Default)]
struct Trust {
    right: u32,
    heard: u32,
}

impl Trust {
    /// How likely the next one is right, by Laplace's rule of succession.
    fn weight(self) -> f64 {
        f64::from(self.right + 1) / f64::from(self.heard + 2)
    }
}

/// What one event did.
#[derive(Default)]
struct Told {
    contracted: bool,
    rejected: bool,
    emptied: Option<Culprit>,
}

impl SetObserver {
    /// The observer that begins with what the AUV was told at birth.
    pub fn new(born: &Born, settings: &TubeSettings) -> Self {
        let assumed = settings.outliers.unwrap_or(Outliers {
            window: if settings.rings > 0 { settings.rings } else { WINDOW_DEFAULT },
            tolerated: 0,
            margin: None,
        });
        let certain_offset_s = interval(born.clock.offset_s);
        let position_m = interval_box(&born.prior_position_m);
        let area_m = interval_box(&born.orders.area_m);
        Self {
            travel: Travel::new(born),
            odometry: Odometry::new(settings.horizon_ns),
            sound: Sound {
                speed_m_s: interval(born.modem.sound_speed_m_s),
                hearing_range_m: born.modem.hearing_range_m,
            },
            timestamp_s: born.modem.timestamp_s,
            stamp_s: born.clock.stamp_ns as f64 * 1e-9,
            area_m,
            anywhere_m: area_m,
            begins_again: false,
            on_empty: settings.on_empty,
            window: Window::new(assumed),
            states: Hypotheses::one(State { offset_s: certain_offset_s, position_m }),
            certain_offset_s,
            trust: BTreeMap::new(),
        }
    }

    /// Whether these orders need more than a tube that believes all it hears, and begins with a box.
    pub fn is_asked_for(born: &Born, settings: &TubeSettings) -> bool {
        settings.outliers.is_some()
            || settings.on_empty != Recovery::Drop
            || born.prior_position_m == born.orders.area_m
    }

    /// Exact local time of something stamped `stamp`, in seconds.
    fn local_s(&self, stamp: LocalTime) -> Interval {
        local_s(stamp, self.stamp_s)
    }

    /// Where the body can be at the end of a stretch if it was left in the area before its end.
    fn anywhere_since(&self, stretch: &Stretch, is_contradictory: bool) -> IntervalBox<3> {
        let motion = self.travel.motion();
        // The current may have been that of another place.
        let stretch = Stretch { current_m_s: motion.any_current(), ..*stretch };
        let within_m = match is_contradictory {
            true => motion.anywhere_within(stretch.length_s),
            false => motion.over(&stretch, 0.0, stretch.length_s).within_m,
        };
        self.anywhere_m.hull(&self.area_m) + within_m
    }

    fn carry(&mut self, way: &Way) {
        self.states.carry(way);
        self.window.carry(way);
        self.certain_offset_s += way.offset_gain_s;
    }

    /// Takes in an event that is stamped `lag_s` local seconds before now; `way` leads here from the last tick.
    fn inform(&mut self, way: &Way, event: &Event, lag_s: f64) -> Told {
        let stamp_s = self.local_s(event.stamp);
        match &event.sense {
            Sense::Inertial { .. } | Sense::Dvl { .. } | Sense::Bearing { .. } | Sense::Held => {
                Told::default()
            }
            Sense::Depth { depth_m } => self.believe(Culprit::Depth, |state| state.with_depth(*depth_m)),
            Sense::Gnss { position_m, time_s } => {
                let (position_m, time_s) = (interval_box(position_m), interval(*time_s));
                let offset_s = self.certain_offset_s.intersection(time_s - stamp_s);
                if !offset_s.is_empty() {
                    self.certain_offset_s = offset_s;
                }
                self.believe(Culprit::Gnss, |state| state.with_fix(&position_m, time_s, stamp_s))
            }
            Sense::Heard { frame } => {
                let heard = Ping::decode(frame).ok();
                let since = self.since(event.stamp, way, lag_s);
                let arrival_s = stamp_s.inflate(self.timestamp_s);
                let ring = heard.as_ref().zip(since).map(|(ping, since)| Ring::new(ping, arrival_s, since));
                self.hear(heard.map(|ping| ping.sender), ring)
            }
        }
    }

    /// What the body did since the arrival that is stamped `stamp`, with the tolerance of the stamp. None when that is forgotten.
    fn since(&self, stamp: LocalTime, way: &Way, lag_s: f64) -> Option<Way> {
        let motion = self.travel.motion();
        let apart_s = self.timestamp_s + 2.0 * self.stamp_s;
        // A stamp may precede the tick by its own error, which is nothing to go back for.
        let (since, apart_s) = if lag_s <= self.timestamp_s {
            (Way::none(), lag_s + apart_s)
        } else {
            let (_, since) = self.odometry.recall(stamp, motion)?;
            (since.then(way), apart_s)
        };
        Some(Way::within(motion, apart_s).then(&since))
    }

    /// A measurement that is beyond doubt contracts all that is remembered.
    fn believe(
        &mut self,
        culprit: Culprit,
        by: impl Fn(&State) -> Result<State, Contradiction> + Copy,
    ) -> Told {
        let before = self.states.hull();
        if let Ok(anywhere) = by(&self.anywhere()) {
            self.anywhere_m = anywhere.position_m;
        }
        let emptied = match self.states.contract(by) {
            Ok(()) => {
                self.window.believe(by);
                None
            }
            Err(_) => {
                self.recover_from_measurement(by);
                Some(culprit)
            }
        };
        let contracted = emptied.is_none() && self.states.hull().is_tighter_than(&before);
        Told { contracted, rejected: false, emptied }
    }

    fn recover_from_measurement(&mut self, by: impl Fn(&State) -> Result<State, Contradiction>) {
        match self.on_empty {
            Recovery::Drop => {}
            Recovery::Relax => {
                self.window.believe(&by);
                match self.window.relax(&self.sound) {
                    Some(observed) => self.states = observed.states,
                    None => self.restart(by),
                }
            }
            Recovery::Restart => self.restart(by),
        }
    }

    /// Begins again from anywhere, where the measurement allows it.
    fn restart(&mut self, by: impl Fn(&State) -> Result<State, Contradiction>) {
        self.begins_again = true;
        self.window.clear();
        let anywhere = self.anywhere();
        self.states = Hypotheses::one(by(&anywhere).unwrap_or(anywhere));
    }

    fn anywhere(&self) -> State {
        State { offset_s: self.certain_offset_s, position_m: self.anywhere_m }
    }

    /// At the end of a tick in which it began again: what else happened in it was carried by a log and a current that may be those of
    /// another place.
    fn forget_all(&mut self) {
        self.window.clear();
        self.odometry.clear();
        self.travel.forget_current();
        self.states = Hypotheses::one(self.anywhere());
    }

    /// Adds a ping to the window and looks up the present in it.
    fn hear(&mut self, sender: Option<AuvId>, ring: Option<Ring>) -> Told {
        let before = self.states.hull();
        self.window.append(sender, ring, self.states.clone());
        let mut emptied = None;
        if let Some(Observed { states, .. }) = self.window.observe(&self.sound) {
            self.states = states;
        } else {
            emptied = sender.map(Culprit::Ping);
            self.recover_from_ping();
        }
        let after = self.states.hull();
        let agrees = ring.map(|ring| ring.contract(&after, &self.sound).is_ok());
        if let Some((sender, agrees)) = sender.zip(agrees) {
            let trust = self.trust.entry(sender).or_default();
            trust.heard = trust.heard.saturating_add(1);
            trust.right = trust.right.saturating_add(u32::from(agrees));
        }
        Told { contracted: after.is_tighter_than(&before), rejected: agrees == Some(false), emptied }
    }

    fn recover_from_ping(&mut self) {
        match self.on_empty {
            Recovery::Drop => self.window.ignore_last(),
            Recovery::Relax => match self.window.relax(&self.sound) {
                Some(observed) => self.states = observed.states,
                None => self.restart(|state| Ok(*state)),
            },
            Recovery::Restart => self.restart(|state| Ok(*state)),
        }
    }

    /// The part of the set that the most trustworthy senders agree on.
    fn likeliest_part(&self) -> State {
        let parts = self.states.components();
        let score = |part: &State| -> f64 {
            let agreeing = self.window.agreeing(part, &self.sound).filter(|(_, agrees)| *agrees);
            let weight = |sender| self.trust.get(&sender).copied().unwrap_or_default().weight();
            agreeing.map(|(sender, _)| weight(sender)).sum()
        };
        let scored = parts.into_iter().map(|part| (score(&part), part));
        // The first of equals.
        let best = scored.reduce(|best, next| if next.0 > best.0 { next } else { best });
        best.map_or_else(|| self.states.hull(), |(_, part)| part)
    }
}

impl Estimator for SetObserver {
    fn update(&mut self, sensed: &Sensed) -> Estimate {
        let mut emptied = None;
        let (mut contractions, mut rejected) = (0, 0);
        let begun = self.travel.now();
        let stretch = self.travel.advance(sensed, &mut emptied);
        let passage = self.travel.motion().along(&stretch);
        // What the log contradicts is no bound of where the body went since the last tick.
        self.begins_again = emptied.is_some() && self.on_empty == Recovery::Restart;
        self.anywhere_m = self.anywhere_since(&stretch, self.begins_again);
        let start = self.states.hull();
        let mut since = begun;
        let mut slice: Option<State> = None;
        let mut way = Way::none();

        let mut events = sensed.events.iter().peekable();
        loop {
            // All events up to the next moment are told before the set moves on to it.
            let next = events.peek().map_or(sensed.stamp, |event| event.stamp.clamp(since, sensed.stamp));
            let moved = passage.over(seconds(since - begun), seconds(next - begun));
            let before = self.states.hull();
            let step = Way::from(&moved);
            self.carry(&step);
            way = way.then(&step);
            let mut told = false;
            while let Some(event) = events.next_if(|event| event.stamp <= next) {
                told = true;
                let did = self.inform(&way, event, seconds(next - event.stamp));
                contractions += u16::from(did.contracted);
                rejected += u16::from(did.rejected);
                if let Some(by) = did.emptied {
                    emptied.get_or_insert(Emptied { stamp: event.stamp, by });
                }
            }
            let after = self.states.hull();
            let swept = before.swept(&moved, &after);
            // What was known before is wrong when it contradicts what is known now.
            let swept = if emptied.is_some() || swept.is_empty() { after.backwards(&moved) } else { swept };
            slice = Some(slice.map_or(swept, |slice| slice.hull(&swept)));
            since = next;
            if next == sensed.stamp && (!told || events.peek().is_none()) {
                break;
            }
        }

        let leg = Leg { begun, ended: sensed.stamp, state: start, stretch, way };
        if self.begins_again {
            self.forget_all();
            slice = None;
        } else {
            self.odometry.append(leg);
        }
        let state = self.states.hull();
        let slice = slice.unwrap_or(state);
        let components = u16::try_from(self.states.components().len()).unwrap_or(u16::MAX);
        Estimate { state, slice, emptied, contractions, rejected, components, gaussian: None }
    }

    fn predict(&self, at: LocalTime) -> Prediction {
        self.travel.predict(&self.states.hull(), at, self.local_s(at))
    }

    fn likeliest(&self) -> Option<State> {
        Some(self.likeliest_part())
    }
}

#[cfg(test)]
mod tests;
