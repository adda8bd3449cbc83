//! Several hypotheses: the set of possible present states as a bounded number of boxes, in as many separate parts as need be.
//!
//! A sub-paving that lives: odometry carries every box along, a measurement contracts each, and a box is cut in two where that pays, until
//! one part is left (seed 002, chapter 4: set inversion over the tube, here with the horizon's rings at hand as constraints on the present).

use shoal_interval::Interval;

use crate::odometry::Way;
use crate::state::{Contradiction, State};

/// A set of states has at most so many boxes.
pub const BOXES_MAX: usize = 64;
/// At most so many boxes are cut for one ping: a bound of the time that it takes.
const CUTS_MAX: usize = 4 * BOXES_MAX;

/// The possible states, as boxes that may overlap. Never without one.
#[derive(Clone, Debug)]
pub struct Hypotheses {
    boxes: Vec<State>,
}

/// What makes one metre of a coordinate worth as much as of another.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// A box smaller than this is not cut, in metres: no ring is thinner.
    pub grain_m: f64,
    /// What a second of the clock's offset is worth, in metres.
    pub metres_per_s: f64,
}

impl Hypotheses {
    /// A single box.
    pub fn one(state: State) -> Self {
        Self { boxes: vec![state] }
    }

    /// The boxes, in a fixed order.
    pub fn boxes(&self) -> &[State] {
        &self.boxes
    }

    /// The smallest state that holds them all.
    pub fn hull(&self) -> State {
        hull(self.boxes.iter())
    }

    /// Goes along with the body.
    pub fn carry(&mut self, way: &Way) {
        for state in &mut self.boxes {
            *state = way.ahead(state);
        }
    }

    /// Contracts every box, and drops those that hold nothing any more.
    ///
    /// # Errors
    /// What the last box says, when none would be left; then they are as before.
    pub fn contract(
        &mut self,
        mut by: impl FnMut(&State) -> Result<State, Contradiction>,
    ) -> Result<(), Contradiction> {
        let mut left = Vec::with_capacity(self.boxes.len());
        let mut contradiction = None;
        for state in &self.boxes {
            match by(state) {
                Ok(contracted) => left.push(contracted),
                Err(found) => contradiction = Some(found),
            }
        }
        match contradiction {
            Some(contradiction) if left.is_empty() => Err(contradiction),
            _ => {
                self.boxes = left;
                Ok(())
            }
        }
    }

    /// The states in `of` that `contract` leaves: boxes are contracted, cut in two, the largest first, and put together again where that
    /// costs nothing. None when nothing is left.
    ///
    /// `contract` may not lose a state that it should keep; then neither does this.
    pub fn refined(
        of: impl Iterator<Item = State>,
        scale: &Scale,
        mut contract: impl FnMut(&State) -> Option<State>,
    ) -> Option<Self> {
        let mut boxes: Vec<State> = of.filter_map(|state| contract(&state)).collect();
        merge(&mut boxes, scale);
        for _ in 0..CUTS_MAX {
            if boxes.len() >= BOXES_MAX {
                break;
            }
            let sizes = boxes.iter().map(|state| scale.widest(state).1).enumerate();
            let Some((index, width_m)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))) else {
                break;
            };
            // Also ends for an unbounded box, which has no middle.
            let Some((low, high)) = cut(&boxes[index], scale).filter(|_| width_m > scale.grain_m) else {
                break;
            };
            boxes.swap_remove(index);
            boxes.extend([low, high].iter().filter_map(&mut contract));
        }
        merge(&mut boxes, scale);
        (!boxes.is_empty()).then_some(Self { boxes })
    }

    /// The separate parts: boxes that touch belong together. The hull of each, in the order of their first boxes.
    pub fn components(&self) -> Vec<State> {
        let mut part_of: Vec<usize> = (0..self.boxes.len()).collect();
        for (index, state) in self.boxes.iter().enumerate() {
            for earlier in 0..index {
                let (one, other) = (part_of[earlier], part_of[index]);
                if one != other && !state.intersection(&self.boxes[earlier]).is_empty() {
                    let (kept, lost) = (one.min(other), one.max(other));
                    part_of.iter_mut().filter(|part| **part == lost).for_each(|part| *part = kept);
                }
            }
        }
        // A part is called by the index of its first box.
        let parts = (0..self.boxes.len()).filter(|&part| part_of[part] == part);
        parts
            .map(|part| {
                let members = self.boxes.iter().zip(&part_of).filter(|(_, of)| **of == part);
                hull(members.map(|(state, _)| state))
            })
            .collect()
    }
}

impl Scale {
    /// The coordinate in which a state is widest (0 for the clock, then x, y, z), and that width in metres.
    fn widest(&self, state: &State) -> (usize, f64) {
        let widths = self.widths_m(state).into_iter().enumerate();
        widths.fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
    }

    fn widths_m(&self, state: &State) -> [f64; 4] {
        let [x, y, z] = state.position_m.sides();
        [state.offset_s.width() * self.metres_per_s, x.width(), y.width(), z.width()]
    }

    /// How much room a state takes, a grain wider on every side so that flat ones count too.
    fn room(&self, state: &State) -> f64 {
        self.widths_m(state).iter().fold(1.0, |room, width_m| room * (width_m + self.grain_m))
    }
}

/// The smallest state that holds all of these, of which there is at least one.
fn hull<'a>(of: impl Iterator<Item = &'a State>) -> State {
    of.copied().reduce(|hull, state| hull.hull(&state)).unwrap_or(State::EMPTY)
}

/// The halves of a state, cut where it is widest; none when it cannot be cut.
fn cut(state: &State, scale: &Scale) -> Option<(State, State)> {
    let (coordinate, _) = scale.widest(state);
    let with_offset = |offset_s: Interval| State { offset_s, ..*state };
    match coordinate.checked_sub(1) {
        None => state.offset_s.bisect().map(|(low, high)| (with_offset(low), with_offset(high))),
        Some(axis) => {
            let (low, high) = state.position_m.bisect_axis(axis)?;
            Some((State { position_m: low, ..*state }, State { position_m: high, ..*state }))
        }
    }
}

/// Puts two boxes together wherever their hull takes no more room than both.
fn merge(boxes: &mut Vec<State>, scale: &Scale) {
    let mut index = 0;
    while index < boxes.len() {
        let state = boxes[index];
        let own = scale.room(&state);
        let partner = (0..index).find(|&earlier| {
            let other = &boxes[earlier];
            scale.room(&state.hull(other)) <= own + scale.room(other)
        });
        match partner {
            Some(earlier) => {
                boxes[earlier] = boxes[earlier].hull(&state);
                boxes.swap_remove(index);
                // The larger box may now take in what comes before it.
                index = earlier;
            }
            None => index += 1,
        }
    }
}

#[cfg(test)]
mod tests;
