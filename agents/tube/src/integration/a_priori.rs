//! Boxes that no solution leaves before the end of a step.

use super::evolution::Evolution;
use nalgebra::SVector;
use shoal_interval::{Interval, IntervalBox};

/// How often a guess is widened before the step is said to be too long.
const ATTEMPTS: usize = 8;

/// A box that holds every solution from `start` over all of `times_s`, if one is found. `within_s` holds the time from
/// the start to any time of the step, and is negative backward in time.
///
/// If `start + within f([B])` is in the interior of `[B]` a solution cannot come to the boundary of `[B]`: until it did, its
/// velocity would be in the closed and convex `f([B])`, and it would be in the interior. This holds for inclusions with
/// measurable inputs too.
pub(super) fn enclosure<const N: usize, E: Evolution<N> + ?Sized>(
    evolution: &E,
    times_s: Interval,
    within_s: Interval,
    start: &IntervalBox<N>,
) -> Option<IntervalBox<N>> {
    let reached = |states: &IntervalBox<N>| *start + evolution.velocity(times_s, states) * within_s;
    let mut guess = reached(start);
    for _ in 0..ATTEMPTS {
        let guessed = inflated(start, &guess);
        let image = reached(&guessed);
        if image.is_interior_of(&guessed) {
            return Some(image);
        }
        // What is unbounded at the start may stay so, what is not must not become it.
        if image.iter().zip(start).any(|(image, start)| start.is_bounded() && !image.is_bounded()) {
            return None;
        }
        guess = guess | image;
    }
    None
}

/// Wider than `guess` by a share of the way from `start`, and by something on every axis.
fn inflated<const N: usize>(start: &IntervalBox<N>, guess: &IntervalBox<N>) -> IntervalBox<N> {
    if guess.is_empty() {
        return *guess;
    }
    let radii = SVector::<f64, N>::from_fn(|axis, _| {
        let (from, to) = (start[axis], guess[axis]);
        if !to.is_bounded() {
            return 0.0;
        }
        let way = (from.lower() - to.lower()).abs().max((to.upper() - from.upper()).abs());
        0.1 * way + 1e-14 * to.magnitude() + f64::MIN_POSITIVE
    });
    guess.inflate_axes(&radii)
}
