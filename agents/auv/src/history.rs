//! What an AUV remembers: its state tube over local time, as far back as the horizon.

use shoal_bus::time::LocalTime;
use shoal_interval::IntervalBox;
use shoal_tube::Tube;

use crate::state::State;
use crate::travel::seconds;

/// The tube of (clock offset, x, y, z) over the local time since birth, a slice a tick.
#[derive(Debug)]
pub struct History {
    birth: LocalTime,
    tube: Tube<IntervalBox<4>>,
    horizon_ns: i64,
}

impl History {
    /// The tube that begins at birth.
    pub fn new(birth: LocalTime, state: &State, horizon_ns: i64) -> Self {
        // Zero is finite, the only thing that a tube asks of its start.
        let tube = Tube::starting_at(0.0, state.as_box()).expect("zero is a time");
        Self { birth, tube, horizon_ns }
    }

    /// The state at the end of what is remembered.
    pub fn last(&self) -> State {
        State::of_box(&self.tube.last_gate())
    }

    /// Bytes of heap in use.
    pub fn memory_bytes(&self) -> usize {
        self.tube.memory_bytes()
    }

    /// Adds the time since the end, up to `stamp`: everywhere it was in `slice`, at the end in `state`. Forgets what lies
    /// beyond the horizon, so memory is bounded by it.
    ///
    /// # Panics
    /// When `stamp` is not after the end: the channel's ticks are a period apart, so that is a bug, and no state may grow
    /// out of it.
    pub fn append(&mut self, stamp: LocalTime, slice: &State, state: &State) {
        // Since birth, because the clock itself may read so much that nanoseconds vanish in a double.
        let age_ns = stamp - self.birth;
        let slice = slice.as_box();
        self.tube.append(seconds(age_ns), slice, state.as_box()).expect("ticks come in order");
        self.tube.drop_before(seconds(age_ns.saturating_sub(self.horizon_ns)));
    }
}
