//! The last pings, of which some may be wrong: the present as most of them allow it.
//!
//! With at most q outliers among the last m pings, the present state lies in what became of the set of m pings ago, and in all but q of the
//! m rings: the robust set observer of seed 004, section 3,
//!
//! ```text
//! X(k) = f(X(k-m))  ∩  q-relaxed intersection of the rings k-m+1 .. k.
//! ```
//!
//! No ping alone contracts anything for good: each time, what was known m pings ago is carried here by odometry, contracted anew, and a
//! wrong ping is out of it once it has left the window. With fewer than m pings heard, it is the start that is carried along.
//!
//! How many are wrong may be searched for instead of assumed: the fewest that leave something, and a margin (GOMNE; seed 001, section
//! 2.4.5).

use std::collections::VecDeque;

use shoal_bus::message::{AuvId, Outliers};
use shoal_interval::contractor::relaxed_intersection_of_boxes;
use shoal_interval::{Interval, IntervalBox};

use crate::hypotheses::{Hypotheses, Scale};
use crate::odometry::Way;
use crate::rings::Ring;
use crate::state::{Contradiction, Sound, State};

/// A box is contracted again while that makes it smaller by so much of its width, and at most so often.
const STOPPING_RATIO: f64 = 0.05;
const PASSES_MAX: usize = 6;
/// No ring is taken for thinner than this, in metres: what thinner boxes would say is not worth their number.
const GRAIN_M: f64 = 0.1;

/// The last m pings, with what was known before each.
#[derive(Debug)]
pub struct Window {
    assumed: Outliers,
    pings: VecDeque<Remembered>,
    scratch: Vec<IntervalBox<4>>,
}

/// One ping of the window.
#[derive(Debug)]
struct Remembered {
    sender: Option<AuvId>,
    /// None when it says nothing: it was dropped, came too late, or is no ping.
    ring: Option<Ring>,
    /// The possible states when it was told, not yet contracted by it.
    before: Hypotheses,
    /// From then to now.
    since: Way,
    /// What has become of their hull: carried along, and contracted by all that is beyond doubt.
    within: State,
}

/// What a window allows.
#[derive(Debug)]
pub struct Observed {
    /// The possible present states.
    pub states: Hypotheses,
    /// How many of the window's pings were allowed to be wrong.
    pub tolerated: u16,
}

impl Window {
    /// Nothing heard yet.
    pub fn new(assumed: Outliers) -> Self {
        Self { assumed, pings: VecDeque::new(), scratch: Vec::new() }
    }

    /// Goes along with the body.
    pub fn carry(&mut self, way: &Way) {
        for ping in &mut self.pings {
            if let Some(ring) = &mut ping.ring {
                ring.carry(way);
            }
            ping.since = ping.since.then(way);
            ping.within = way.ahead(&ping.within);
        }
    }

    /// Takes in a measurement that is beyond doubt: it contracts the past as well as the present.
    pub fn believe(&mut self, by: impl Fn(&State) -> Result<State, Contradiction>) {
        for ping in &mut self.pings {
            ping.within = by(&ping.within).unwrap_or(State::EMPTY);
        }
    }

    /// Adds a ping, told now, when `before` was possible. It counts even when it says nothing, because the assumption counts it.
    pub fn append(&mut self, sender: Option<AuvId>, ring: Option<Ring>, before: Hypotheses) {
        if self.pings.len() >= usize::from(self.assumed.window.max(1)) {
            self.pings.pop_front();
        }
        let within = before.hull();
        self.pings.push_back(Remembered { sender, ring, before, since: Way::none(), within });
    }

    /// Makes the last ping say nothing.
    pub fn ignore_last(&mut self) {
        if let Some(last) = self.pings.back_mut() {
            last.ring = None;
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.pings.clear();
    }

    /// The present states that the pings allow if no more than the assumed number of them is wrong: q, or the fewest that leave something
    /// and the margin, but never more than q. None when that leaves nothing, or when there is no ping.
    pub fn observe(&mut self, sound: &Sound) -> Option<Observed> {
        let most = self.assumed.tolerated;
        match self.assumed.margin {
            None => self.with(most, sound),
            Some(margin) => self.fewest(0, most, margin, sound).or_else(|| self.with(most, sound)),
        }
    }

    /// The same with more wrong pings than assumed: the fewest that leave something, and the margin. None when nothing is left even of
    /// what was known before them.
    pub fn relax(&mut self, sound: &Sound) -> Option<Observed> {
        let all = self.pings.len() as u16;
        self.fewest(self.assumed.tolerated.saturating_add(1), all, self.assumed.margin.unwrap_or(0), sound)
    }

    /// How well the pings of each sender agree with `state`: those that do, and all that say something.
    pub fn agreeing(&self, state: &State, sound: &Sound) -> impl Iterator<Item = (AuvId, bool)> {
        self.pings.iter().filter_map(|ping| {
            let ring = ping.ring.as_ref()?;
            Some((ping.sender?, ring.contract(state, sound).is_ok()))
        })
    }

    /// GOMNE from `least` to `most` outliers. A number is enough when the middle of some box is proved to be in all rings but so many: that
    /// boxes are left is no proof, as they are larger than the set.
    fn fewest(&mut self, least: u16, most: u16, margin: u16, sound: &Sound) -> Option<Observed> {
        for tolerated in least..=most {
            let Some(observed) = self.with(tolerated, sound) else { continue };
            if !observed.states.boxes().iter().any(|state| self.wrong_at(&middle(state), sound) <= tolerated)
            {
                continue;
            }
            let wider = tolerated.saturating_add(margin).min(most);
            return if wider > tolerated { self.with(wider, sound) } else { Some(observed) };
        }
        None
    }

    /// The present states in all rings but `tolerated`.
    fn with(&mut self, tolerated: u16, sound: &Sound) -> Option<Observed> {
        let oldest = self.pings.front()?;
        let (since, within) = (oldest.since, oldest.within);
        let base = oldest.before.boxes().iter().map(|state| since.ahead(state).intersection(&within));
        let base = base.filter(|state| !state.is_empty());
        let scale = Scale { grain_m: self.grain_m(sound), metres_per_s: sound.speed_m_s.upper() };
        let (pings, scratch) = (&self.pings, &mut self.scratch);
        let states =
            Hypotheses::refined(base, &scale, |state| contracted(pings, state, tolerated, sound, scratch))?;
        Some(Observed { states, tolerated })
    }

    /// How many rings do not hold `state`.
    fn wrong_at(&self, state: &State, sound: &Sound) -> u16 {
        let rings = self.pings.iter().filter_map(|ping| ping.ring.as_ref());
        rings.filter(|ring| ring.contract(state, sound).is_err()).count() as u16
    }

    /// The thinnest ring's thickness in metres, or less.
    fn grain_m(&self, sound: &Sound) -> f64 {
        let thickness_m = |ring: &Ring| {
            let apart_s = ring.emission_s.width() + ring.arrival_s.width() + ring.since.offset_gain_s.width();
            (ring.emitter_m + ring.since.displacement_m).width() + sound.speed_m_s.upper() * apart_s
        };
        let rings = self.pings.iter().filter_map(|ping| ping.ring.as_ref());
        rings.map(thickness_m).fold(f64::INFINITY, f64::min).max(GRAIN_M)
    }
}

/// What of `state` is in all rings but `tolerated`.
fn contracted(
    pings: &VecDeque<Remembered>,
    state: &State,
    tolerated: u16,
    sound: &Sound,
    scratch: &mut Vec<IntervalBox<4>>,
) -> Option<State> {
    let mut state = *state;
    if usize::from(tolerated) >= pings.len() {
        return Some(state);
    }
    for _ in 0..PASSES_MAX {
        let all = state.as_box();
        scratch.clear();
        scratch.extend(pings.iter().map(|ping| match &ping.ring {
            None => all,
            Some(ring) => ring.contract(&state, sound).map_or(IntervalBox::EMPTY, |left| left.as_box()),
        }));
        let left = relaxed_intersection_of_boxes(scratch, usize::from(tolerated)).intersection(&all);
        if left.is_empty() {
            return None;
        }
        state = State::of_box(&left);
        let shrunk = |axis: usize| left[axis].width() < (1.0 - STOPPING_RATIO) * all[axis].width();
        if !(0..4).any(shrunk) {
            break;
        }
    }
    Some(state)
}

/// The middle of a box, as a state.
fn middle(state: &State) -> State {
    State::of_box(&state.as_box().map(|side| Interval::point(side.mid()).unwrap_or(side)))
}

#[cfg(test)]
mod tests;
