//! One step of the integration.

use super::a_priori;
use super::evolution::Evolution;
use super::orthonormal::row_sum_norm;
use super::parallelepiped::Parallelepiped;
use shoal_interval::{Interval, IntervalBox, IntervalMatrix};

/// The states that are possible at one time.
#[derive(Debug, Clone, Copy)]
pub(super) struct States<const N: usize> {
    /// A box that holds them.
    hull: IntervalBox<N>,
    /// A turned box that holds them too, if the evolution has a Jacobian.
    turned: Option<Parallelepiped<N>>,
}

impl<const N: usize> States<N> {
    pub(super) fn new(hull: IntervalBox<N>) -> States<N> {
        States { hull, turned: None }
    }

    pub(super) fn hull(&self) -> &IntervalBox<N> {
        &self.hull
    }

    /// Those that are in `others` too.
    pub(super) fn met_with(&self, others: &IntervalBox<N>) -> States<N> {
        let hull = self.hull & *others;
        if hull == self.hull {
            return *self;
        }
        States { hull, turned: self.turned.map(|turned| turned.met_with(&hull)) }
    }
}

/// The time that a step takes, either way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// All times of the step, in seconds.
    pub(super) times_s: Interval,
    /// Holds the time from the start to the end of the step, negative backward.
    pub(super) length_s: Interval,
}

impl Span {
    pub(super) fn new(start_s: f64, end_s: f64) -> Span {
        let start = Interval::spanning(start_s, start_s);
        Span {
            times_s: Interval::spanning(start_s, end_s),
            length_s: Interval::spanning(end_s, end_s) - start,
        }
    }

    fn within_s(&self) -> Interval {
        self.length_s | Interval::ZERO
    }

    fn start_s(&self) -> Interval {
        let start_s = if self.length_s.upper() > 0.0 { self.times_s.lower() } else { self.times_s.upper() };
        Interval::spanning(start_s, start_s)
    }
}

/// Where the solutions from `start` that stay in `known` are: over all of the step, and at its end. `None` if the step is
/// too long for an a-priori enclosure; with `known_will_do` only if `known`, which then takes its place, is unbounded too.
pub(super) fn step<const N: usize, E: Evolution<N> + ?Sized>(
    evolution: &E,
    span: Span,
    start: &States<N>,
    known: &IntervalBox<N>,
    known_will_do: bool,
) -> Option<(IntervalBox<N>, States<N>)> {
    let Span { times_s, length_s } = span;
    let within_s = span.within_s();
    let hull = start.hull;
    if hull.is_empty() {
        return Some((IntervalBox::EMPTY, States::new(IntervalBox::EMPTY)));
    }

    let mut over = match a_priori::enclosure(evolution, times_s, within_s, &hull) {
        Some(enclosure) => enclosure & *known,
        None if known_will_do && known.is_bounded() => *known,
        None => return None,
    };
    let velocity = evolution.velocity(times_s, &over);
    over = over & (hull + velocity * within_s);
    let mut end = over & (hull + velocity * length_s);

    let turned = || {
        let start = start.turned.or_else(|| hull.is_bounded().then(|| Parallelepiped::upright(&hull)))?;
        let flow = Flow::new(evolution, span, start.centre(), &hull, &over)?;
        Some((flow, start.image(&flow.centre_end, &flow.slopes)?, start))
    };
    if end.is_empty() {
        return Some((over, States::new(end)));
    }
    let turned = turned().map(|(flow, turned, start)| {
        let straight = flow.centre_end + flow.slopes * (hull - *start.centre());
        end = end & straight & turned.hull();
        turned.met_with(&end)
    });
    Some((over, States { hull: end, turned }))
}

/// What a step does to the centre of the states, and to their distance from it.
#[derive(Clone, Copy)]
struct Flow<const N: usize> {
    centre_end: IntervalBox<N>,
    /// For a solution `x` in the states and the solution `c` from the centre, with the same inputs, some matrix `m` of
    /// these gives `x(end) - c(end) = m (x(start) - c(start))`.
    slopes: IntervalMatrix<N, N>,
}

impl<const N: usize> Flow<N> {
    /// `None` if there is no bounded enclosure. `hull` holds the states at the start whose distance from the centre matters,
    /// `over` the solutions from them.
    fn new<E: Evolution<N> + ?Sized>(
        evolution: &E,
        span: Span,
        centre: &IntervalBox<N>,
        hull: &IntervalBox<N>,
        over: &IntervalBox<N>,
    ) -> Option<Flow<N>> {
        let Span { times_s, length_s } = span;
        // Asked first, because it is cheap to learn that there is none.
        evolution.jacobian(times_s, centre)?;
        let centre_over = a_priori::enclosure(evolution, times_s, span.within_s(), centre)?;
        if centre_over.is_empty() {
            return None;
        }
        let half_square = length_s.sqr() * 0.5;

        let both = *over | centre_over;
        let jacobian = evolution.jacobian(times_s, &both)?;
        if jacobian.is_empty() || !jacobian.is_bounded() {
            return None;
        }
        // The distance obeys m' = K m, K a mean of Jacobians between the two solutions, so the norm of m - I grows to at
        // most exp(h |K|) - 1. Integrated by parts, m = I + int K + h^2 / 2 K K m.
        let growth = ((row_sum_norm(&jacobian) * length_s.abs()).exp() - Interval::ONE).upper();
        let around = Interval::spanning(-growth, growth);
        let roughly = IntervalMatrix::identity() + IntervalMatrix::from_fn(|_, _| around);
        let mut integral = jacobian * length_s;
        if let Some(rate) = evolution.jacobian_rate(times_s, &both) {
            let at_start = evolution.jacobian(span.start_s(), &(*hull | *centre))?;
            integral = integral & (at_start * length_s + rate * half_square);
        }
        let slopes = IntervalMatrix::identity() + integral + (jacobian * (jacobian * roughly)) * half_square;

        let centre_end = centre_end(evolution, span, centre, &centre_over);
        let bounded = !centre_end.is_empty() && centre_end.is_bounded() && slopes.is_bounded();
        bounded.then_some(Flow { centre_end, slopes })
    }
}

/// Where the solution from the centre ends, which is in `over` on the way: Taylor's series, as long as its terms are known.
fn centre_end<const N: usize, E: Evolution<N> + ?Sized>(
    evolution: &E,
    span: Span,
    centre: &IntervalBox<N>,
    over: &IntervalBox<N>,
) -> IntervalBox<N> {
    let Span { times_s, length_s } = span;
    let velocity = evolution.velocity(times_s, over);
    let Some(acceleration) = evolution.acceleration(times_s, over) else {
        return *centre + velocity * length_s;
    };
    let half_square = length_s.sqr() * 0.5;
    let start_s = span.start_s();
    let straight = *centre + evolution.velocity(start_s, centre) * length_s;
    let jerk = || {
        let rate = evolution.jacobian_rate(times_s, over)?;
        let jacobian = evolution.jacobian(times_s, over)?;
        let at_start = evolution.acceleration(start_s, centre)?;
        // x'' = J f, if nothing else changes.
        Some((at_start, rate * velocity + jacobian * acceleration))
    };
    match jerk() {
        Some((at_start, jerk)) => straight + at_start * half_square + jerk * (length_s.powi(3) / 6.0),
        None => straight + acceleration * half_square,
    }
}
