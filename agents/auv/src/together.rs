//! All rings at once: what the pings remembered say of the present state together.
//!
//! First ring after ring, until none makes the box much smaller. What is left to gain is what several rings say together: two from
//! opposite sides tell of the clock, which each alone puts down to the position, and three pin down what each leaves free across
//! itself. Each ring lies between two planes in (x, y, z, clock offset), and how far their polyhedron reaches along each
//! axis is a linear program of four unknowns. A smaller box has flatter rings, so that is repeated as well.

mod half_space;
mod support;

use shoal_interval::IntervalBox;

use self::half_space::{Frame, HalfSpace};
use self::support::{Reach, Reached, reach};
use crate::rings::Ring;
use crate::state::{Contradiction, Sound, State};

/// No more rounds than this, whatever they gain.
const ROUNDS: usize = 4;
/// More planes than this are not looked at together: those of the newest rings are.
const PLANES: usize = 64;
/// As many as are usual: room for more takes time to clear.
const USUAL_PLANES: usize = 16;

/// Whether a ring says anything of a state's position and clock together, once it has been heard out on its own.
pub fn is_cut_by(state: &State, ring: &Ring, sound: &Sound) -> bool {
    Frame::new(state).is_cut_by(ring, sound)
}

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
        state = match 2 * rings.len() <= USUAL_PLANES {
            true => within_planes::<USUAL_PLANES>(rings, &state, sound)?,
            false => within_planes::<PLANES>(rings, &state, sound)?,
        };
        if !state.is_tighter_by(&before, stopping_ratio) {
            break;
        }
        // Each had been heard out on the box before.
        for ring in rings.iter().rev() {
            state = ring.contract(&state, sound)?;
        }
    }
    Ok(state)
}

/// The states between the planes of all rings, or of the newest that have `MOST` planes.
fn within_planes<const MOST: usize>(
    rings: &[Ring],
    state: &State,
    sound: &Sound,
) -> Result<State, Contradiction> {
    let mut frame = Frame::new(state);
    let mut planes = [HalfSpace::NONE; MOST];
    let mut count = 0;
    for (index, ring) in rings.iter().enumerate().rev() {
        for plane in frame.planes(ring, index, sound).into_iter().flatten() {
            if count < MOST {
                planes[count] = plane;
                count += 1;
            }
        }
    }
    // One alone has been heard out.
    if count < 2 {
        return Ok(*state);
    }
    let mut reached = Reached::nowhere();
    for axis in 0..4 {
        for sign in [1.0, -1.0] {
            if reached.is_near(&frame, axis, sign) {
                continue;
            }
            match reach(&planes[..count], &frame, axis, sign, &mut reached) {
                Reach::AtMost(most) if sign > 0.0 => frame.upper[axis] = frame.upper[axis].min(most),
                Reach::AtMost(most) => frame.lower[axis] = frame.lower[axis].max(-most),
                Reach::Nothing(guilty) => {
                    let newest = guilty.into_iter().flatten().max().unwrap_or(rings.len() - 1);
                    return Err(rings[newest].contradiction());
                }
            }
            if frame.lower[axis] > frame.upper[axis] {
                return Err(rings[rings.len() - 1].contradiction());
            }
        }
    }
    let [x, y, z, offset_s] =
        std::array::from_fn(|axis| frame.side(axis, frame.lower[axis], frame.upper[axis]));
    let contracted = State { offset_s, position_m: IntervalBox::from([x, y, z]) }.intersection(state);
    Ok(if contracted.is_empty() { *state } else { contracted })
}
