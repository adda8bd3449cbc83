//! Time division on a clock that drifts: the guard time is the own clock interval, no more and no less.
//!
//! Slots divide true time, which nobody reads. An AUV knows it within an interval `T(s)` that holds the true time of its
//! local time s, wherever in its interval the clock's offset is and whatever the clock drifts until s. It emits at the
//! first s whose `T(s)` lies after the beginning of its slot, if `T(s)` plus the packet and its way to the guard range ends
//! before the slot does, and keeps silent if not. So it does not speak outside its slot as long as its clock keeps its
//! bounds, and nobody else's packet is in the water within the guard range when everyone has an own slot.
//!
//! How often it is silent: a slot is left out when `T` is wider than `slot - packet - propagation` (less the local nanosecond to
//! which s is found), or when its first moments were over before they could be booked. Without fixes and pings that contract the
//! clock, an offset known to `w` seconds at the start and a drift bound d allow speech for about
//! `(slot - packet - propagation - w) / (2 d)`: with 1 s to spare and w = 1 ms, 2.8 hours at 50 ppm and 5.8 days at 1 ppm. From then on
//! every slot is silent, until the clock is known better.

use shoal_bus::time::{LocalTime, NS_PER_S};
use shoal_interval::Interval;

use super::{Booking, MediumAccess, Tick};

/// Pings once in each frame, surely inside the own slot of true time.
#[derive(Clone, Debug)]
pub struct Slotted {
    frame_ns: i64,
    slot_ns: i64,
    /// From the beginning of a frame to that of the own slot.
    start_ns: i64,
    occupied_s: Interval,
    /// The first frame whose slot is not decided yet; unknown before the first tick.
    frame: Option<i64>,
    silent: u64,
}

impl Slotted {
    /// Slot number `slot` of frames of `slots` slots, of `slot_ns` each, which a packet and its sound occupy for `occupied_ns`;
    /// all in nanoseconds of true time.
    pub fn new(slot_ns: i64, slots: u32, slot: u32, occupied_ns: i64) -> Self {
        let slot_ns = slot_ns.max(1);
        Self {
            frame_ns: slot_ns.saturating_mul(i64::from(slots.max(1))),
            slot_ns,
            start_ns: slot_ns.saturating_mul(i64::from(slot)),
            occupied_s: seconds(occupied_ns),
            frame: None,
            silent: 0,
        }
    }

    /// How many slots were left silent because the clock was not known well enough.
    pub fn silent(&self) -> u64 {
        self.silent
    }

    /// Beginning and end of the own slot in a frame, in seconds.
    fn slot_s(&self, frame: i64) -> (Interval, Interval) {
        let begins_ns = frame.saturating_mul(self.frame_ns).saturating_add(self.start_ns);
        (seconds(begins_ns), seconds(begins_ns.saturating_add(self.slot_ns)))
    }

    /// The first frame whose slot can still be going on at `from`.
    fn first_frame(&self, tick: &Tick<'_>) -> i64 {
        let earliest_ns = ((tick.true_time_s)(tick.from).lower() * NS_PER_S as f64) as i64;
        let since_first_end_ns = earliest_ns.saturating_sub(self.start_ns.saturating_add(self.slot_ns));
        (since_first_end_ns.div_euclid(self.frame_ns) + 1).max(0)
    }
}

impl MediumAccess for Slotted {
    fn book(&mut self, tick: &Tick<'_>, booked: &mut Vec<Booking>) {
        let possible = self.first_frame(tick);
        let mut frame = self.frame.unwrap_or(possible);
        if frame < possible {
            // A fix has shown that it is later than thought.
            self.silent += possible.abs_diff(frame);
            frame = possible;
        }
        loop {
            let (begins_s, ends_s) = self.slot_s(frame);
            // Where no moment that this tick may book is surely inside, a later tick decides, perhaps by a better clock.
            let Some(at) = first_surely_after(begins_s, tick) else { break };
            let over_s = (tick.true_time_s)(at) + self.occupied_s;
            if over_s.upper() <= ends_s.lower() {
                booked.push(Booking { at, listen_ns: 0 });
            } else {
                self.silent += 1;
            }
            frame = frame.saturating_add(1);
        }
        self.frame = Some(frame);
    }
}

/// The first local time of the tick's to book that is surely not before `begins_s`.
fn first_surely_after(begins_s: Interval, tick: &Tick<'_>) -> Option<LocalTime> {
    let surely = |at| (tick.true_time_s)(at).lower() >= begins_s.upper();
    let (mut before, mut after) = (tick.from, tick.until + -1);
    if !surely(after) {
        return None;
    }
    if surely(before) {
        return Some(before);
    }
    // `surely(after)` holds and `surely(before)` does not, whatever is in between.
    while after - before > 1 {
        let middle = before + (after - before) / 2;
        *(if surely(middle) { &mut after } else { &mut before }) = middle;
    }
    Some(after)
}

/// Encloses nanoseconds in seconds: a rounded integer and a rounded quotient are off by less than one ulp together.
fn seconds(ns: i64) -> Interval {
    let seconds = ns as f64 / NS_PER_S as f64;
    Interval::centred(seconds, seconds.abs() * f64::EPSILON)
}
