//! What an AUV remembers: its state tube over local time, as far back as the horizon.

use shoal_bus::time::LocalTime;
use shoal_interval::IntervalBox;
use shoal_tube::Tube;

use crate::state::State;

/// The tube of (clock offset, x, y, z) over local time, a slice a tick.
#[derive(Debug)]
pub struct History {
    tube: Tube<IntervalBox<4>>,
    horizon_ns: i64,
}

impl History {
    /// The tube that begins at birth.
    pub fn new(birth: LocalTime, state: &State, horizon_ns: i64) -> Self {
        let tube = Tube::starting_at(birth.as_s(), as_box(state));
        // Whole nanoseconds are finite seconds, the only thing that a tube asks of its start.
        Self { tube: tube.expect("a local time is finite"), horizon_ns }
    }

    /// The state at the end of what is remembered.
    pub fn last(&self) -> State {
        as_state(&self.tube.last_gate())
    }

    /// Adds the time since the end, up to `stamp`: everywhere it was in `slice`, at the end in `state`. Forgets what lies
    /// beyond the horizon, so memory is bounded by it.
    ///
    /// # Panics
    /// When `stamp` is not after the end: the channel's ticks are a period apart, so that is a bug, and no state may grow
    /// out of it.
    pub fn append(&mut self, stamp: LocalTime, slice: &State, state: &State) {
        self.tube.append(stamp.as_s(), as_box(slice), as_box(state)).expect("ticks come in order");
        self.tube.drop_before((stamp + -self.horizon_ns).as_s());
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
