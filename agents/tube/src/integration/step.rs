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
        let flow = Flow::new(evolution, span, start.centre(), &over)?;
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
    /// `None` if there is no bounded enclosure. `over` holds the solutions whose distance from the centre matters.
    fn new<E: Evolution<N> + ?Sized>(
        evolution: &E,
        span: Span,
        centre: &IntervalBox<N>,
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

        let jacobian = evolution.jacobian(times_s, &(*over | centre_over))?;
        if jacobian.is_empty() || !jacobian.is_bounded() {
            return None;
        }
        // The distance obeys m' = J m for some J in the Jacobian at each time, so the norm of m - I grows to at most
        // exp(h |J|) - 1. Once integrated by parts this is m = I + h J + h^2 / 2 J J m.
        let growth = ((row_sum_norm(&jacobian) * length_s.abs()).exp() - Interval::ONE).upper();
        let around = Interval::spanning(-growth, growth);
        let roughly = IntervalMatrix::identity() + IntervalMatrix::from_fn(|_, _| around);
        let slopes = IntervalMatrix::identity()
            + jacobian * length_s
            + (jacobian * (jacobian * roughly)) * half_square;

        let mut centre_end = *centre + evolution.velocity(times_s, &centre_over) * length_s;
        if let Some(acceleration) = evolution.acceleration(times_s, &centre_over) {
            let start_velocity = evolution.velocity(span.start_s(), centre);
            centre_end = centre_end & (*centre + start_velocity * length_s + acceleration * half_square);
        }
        let bounded = !centre_end.is_empty() && centre_end.is_bounded() && slopes.is_bounded();
        bounded.then_some(Flow { centre_end, slopes })
    }
}
