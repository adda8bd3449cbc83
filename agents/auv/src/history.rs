//! What an AUV remembers: its state tube over local time, as far back as the horizon.

use shoal_bus::time::LocalTime;
use shoal_interval::IntervalBox;
use shoal_tube::Tube;

use crate::state::State;
use crate::tube_estimator::seconds;

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
        let tube = Tube::starting_at(0.0, as_box(state)).expect("zero is a time");
        Self { birth, tube, horizon_ns }
    }

    /// The state at the end of what is remembered.
    pub fn last(&self) -> State {
        as_state(&self.tube.last_gate())
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
        let slice = as_box(slice);
        self.tube.append(seconds(age_ns), slice, as_box(state)).expect("ticks come in order");
        self.tube.drop_before(seconds(age_ns.saturating_sub(self.horizon_ns)));
    }
}

fn as_box(state: &State) -> IntervalBox<4> {
    let [x, y, z] = state.position_m.sides();
    IntervalBox::from([state.offset_s, x, y, z])
}

fn as_state(of: &IntervalBox<4>) -> State {
    let [offset_s, x, y, z] = of.sides();
    State { offset_s, position_m: IntervalBox::from([x, y, z]) }
}
