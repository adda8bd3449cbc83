//! Anchored rings: every ping remembered is a ring for the *present* position.
//!
//! A ping heard at s then says `|p_i - p(s)| in [c] ([t](s) - [a])` (seed 001, equation 5.7). With the way w from s to now, `p(s) = p - w`, so the
//! present position lies as far from `p_i + w`: the ring's centre moves along with the body, as wide as the emitter's box and what
//! odometry may have lost since. Several rings at once pin down what one after the other, box by box, would not.

use shoal_bus::message::{AuvId, Culprit};
use shoal_bus::ping::Ping;
use shoal_interval::contractor::{Contracted, contract_range};
use shoal_interval::{Interval, IntervalBox};

use crate::bounds::{interval, interval_box};
use crate::odometry::Way;
use crate::state::{Contradiction, Sound, State};

/// A ping heard, as it bears on the present.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    /// Who sent it.
    pub sender: AuvId,
    /// Where the emitter was at the emission, in metres.
    pub emitter_m: IntervalBox<3>,
    /// True time of the emission, in seconds.
    pub emission_s: Interval,
    /// Exact local time of the arrival, with every tolerance of its stamp, in seconds.
    pub arrival_s: Interval,
    /// What the body and the clock did since, with every tolerance of the stamp.
    pub since: Way,
}

impl Ring {
    /// The ring of a ping that arrives now.
    pub fn new(ping: &Ping, arrival_s: Interval, since: Way) -> Self {
        Self {
            sender: ping.sender,
            emitter_m: interval_box(&ping.position_m),
            emission_s: interval(ping.emission_s),
            arrival_s,
            since,
        }
    }

    /// Goes along with the body.
    pub fn carry(&mut self, way: &Way) {
        self.since = self.since.then(way);
    }

    /// The present states that this ping allows.
    ///
    /// # Errors
    /// The ping, when it allows none.
    pub fn contract(&self, state: &State, sound: &Sound) -> Result<State, Contradiction> {
        self.contract_with_sound(state, sound).map(|(state, _)| state)
    }

    /// The present states that this ping allows, and the effective speeds of its sound.
    ///
    /// # Errors
    /// The ping, when it allows none.
    pub fn contract_with_sound(&self, state: &State, sound: &Sound) -> Result<(State, Sound), Contradiction> {
        let mut position_m = state.position_m;
        let mut centre_m = self.emitter_m + self.since.displacement_m;
        let mut speed_m_s = sound.speed_m_s;
        let mut emission_s = self.emission_s;
        let longest_delay_s = Interval::spanning(0.0, sound.hearing_range_m) / speed_m_s;
        let reception_s = state.offset_s - self.since.offset_gain_s + self.arrival_s;
        let mut reception_s = reception_s.intersection(emission_s + longest_delay_s);
        let contracted =
            contract_range(&mut position_m, &mut centre_m, &mut speed_m_s, &mut reception_s, &mut emission_s);
        let offset_s = state.offset_s.intersection(reception_s - self.arrival_s + self.since.offset_gain_s);
        if contracted == Contracted::Empty || offset_s.is_empty() {
            return Err(self.contradiction());
        }
        Ok((State { offset_s, position_m }, Sound { speed_m_s, ..*sound }))
    }

    /// That this ping leaves nothing.
    pub fn contradiction(&self) -> Contradiction {
        Contradiction(Culprit::Ping(self.sender))
    }
}

/// The last pings that were kept, the newest last, as far back as the horizon.
#[derive(Debug)]
pub struct Rings {
    most: usize,
    horizon_s: f64,
    rings: Vec<Ring>,
    /// What the body did that no ring was told of yet, so that a step in which nothing is heard costs the same whatever is remembered, and
    /// so that a ring which others displace in the same step never hears of it: of each ring, what was done from then on until
    /// the next one. It is for that ring and all before it.
    untold: Vec<Option<Way>>,
}

impl Rings {
    /// None heard yet; later no more than `most`, and none that arrived more than `horizon_s` local seconds ago.
    pub fn new(most: usize, horizon_s: f64) -> Self {
        Self { most, horizon_s, rings: Vec::with_capacity(most), untold: Vec::with_capacity(most) }
    }

    /// All of them, the oldest first, around the present.
    pub fn present(&mut self) -> &[Ring] {
        self.tell();
        &self.rings
    }

    /// Bytes of heap in use.
    pub fn memory_bytes(&self) -> usize {
        self.rings.capacity() * size_of::<Ring>() + self.untold.capacity() * size_of::<Option<Way>>()
    }

    /// Adds the newest. The oldest makes room for it.
    pub fn push(&mut self, ring: Ring) {
        if self.most == 0 {
            return;
        }
        if self.rings.len() == self.most {
            self.rings.remove(0);
            self.untold.remove(0);
        }
        self.rings.push(ring);
        self.untold.push(None);
    }

    /// All go along with the body.
    pub fn carry(&mut self, way: &Way) {
        if let Some(untold) = self.untold.last_mut() {
            *untold = Some(untold.map_or(*way, |untold| untold.then(way)));
        }
    }

    fn tell(&mut self) {
        for (index, untold) in self.untold.iter_mut().enumerate() {
            if let Some(way) = untold.take() {
                self.rings[..=index].iter_mut().for_each(|ring| ring.carry(&way));
            }
        }
    }

    /// Forgets those beyond the horizon of a local time.
    pub fn forget(&mut self, now_s: f64) {
        let oldest_s = now_s - self.horizon_s;
        let is_old = |ring: &Ring| ring.arrival_s.upper() < oldest_s;
        if self.rings.iter().any(is_old) {
            self.tell();
            self.rings.retain(|ring| !is_old(ring));
            self.untold.truncate(self.rings.len());
        }
    }

    /// Forgets so many of the newest.
    pub fn drop_newest(&mut self, count: usize) {
        self.tell();
        self.rings.truncate(self.rings.len().saturating_sub(count));
        self.untold.truncate(self.rings.len());
    }
}

#[cfg(test)]
mod tests;
