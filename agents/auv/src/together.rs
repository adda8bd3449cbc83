//! All rings at once: what the pings remembered say of the present state together.
//!
//! Ring after ring, until none makes the box much smaller.

use crate::rings::Ring;
use crate::state::{Contradiction, Sound, State};

/// No more rounds than this, whatever they gain.
const ROUNDS: usize = 4;

/// The states that all `rings` allow, or a box around them; `stopping_ratio` is the part of its width that a side must lose in a
/// round for another to follow.
///
/// # Errors
/// A ping, when nothing is left with it.
pub fn contract(
    rings: &[Ring],
    state: &State,
    sound: &Sound,
    stopping_ratio: f64,
) -> Result<State, Contradiction> {
    let mut state = *state;
    for _ in 0..ROUNDS {
        let before = state;
        for ring in rings.iter().rev() {
            state = ring.contract(&state, sound)?;
        }
        if !state.is_tighter_by(&before, stopping_ratio) {
            break;
        }
    }
    Ok(state)
}
