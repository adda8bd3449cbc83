//! Ranges as anchored rings around one pose, of which at most q are wrong.
//!
//! A range measured at another pose says as much about this one once odometry has led there: the vehicle was `d` away from here, so
//! what is as far from the beacon as was measured is, seen from here, a ring around the beacon minus `d`, as wide as odometry may
//! be wrong. Of the rings of a window all but the outliers meet where the vehicle is.
//!
//! Source: seed 001, sections 2.4.4 and 2.4.5 and table 2.5; seed 004 (at most q outliers among the last m).

use std::ops::Range;

use shoal_interval::contractor::{Contractor, QIntersection, Ring, q_intersection};
use shoal_interval::{Interval, IntervalBox};

use super::course::Course;
use super::{Mission, TubeSettings};

/// More boxes than this are not looked at for one side of a pose, which then stays where it was.
const MOST_BOXES: usize = 10_000;

/// Which ranges say something about a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// The last ones that were measured.
    Past,
    /// As many before it as after it.
    Around,
}

/// The part of `position_m` at a pose that the ranges of its window agree on, when no more than the least number that explains them
/// and a margin are wrong: the smallest box that holds it, but for the settings' precision. `None` when more of them must be wrong
/// than the settings allow.
pub(super) fn agreed(
    position_m: IntervalBox<2>,
    pose: usize,
    reach: Reach,
    mission: &Mission,
    course: &Course,
    settings: &TubeSettings,
) -> Option<IntervalBox<2>> {
    let rings = rings(pose, reach, mission, course, settings);
    (0..=settings.outliers).find_map(|outliers| {
        // Whether there may be a place is cheap to ask of one side; all sides together may show that there is none.
        Relaxed::new(&rings, outliers, settings).bound(position_m, Side::ALL[0])?;
        let left_m =
            Relaxed::new(&rings, outliers.saturating_add(settings.margin), settings).hull(position_m);
        (!left_m.is_empty()).then_some(left_m)
    })
}

/// The places that are in all rings but a number of them.
struct Relaxed {
    /// Nothing, when so many rings may be wrong that the others say nothing.
    contractor: Option<QIntersection<Ring<2>>>,
    precision_m: f64,
}

impl Relaxed {
    fn new(rings: &[Ring<2>], outliers: usize, settings: &TubeSettings) -> Self {
        let says_something = outliers < rings.len();
        let contractor = says_something.then(|| q_intersection(rings.iter().copied(), outliers));
        Self { contractor, precision_m: settings.precision_m }
    }

    /// A box that holds every such place in `domain_m`, each side no more than about a precision beyond the farthest of them.
    fn hull(&self, domain_m: IntervalBox<2>) -> IntervalBox<2> {
        Side::ALL.iter().fold(domain_m, |left_m, side| match self.bound(left_m, *side) {
            Some(bound_m) => side.cut(left_m, bound_m),
            None => IntervalBox::EMPTY,
        })
    }

    /// How far such places in `domain_m` can reach towards a side; `None` when there are none.
    ///
    /// Contracts and bisects what reaches farthest, until that is too small to bisect: what is not at the rim is never looked at.
    fn bound(&self, domain_m: IntervalBox<2>, side: Side) -> Option<f64> {
        let Some(contractor) = &self.contractor else {
            return (!domain_m.is_empty()).then(|| side.of(&domain_m));
        };
        let mut undecided = vec![contractor.contract(domain_m)];
        undecided.retain(|place_m| !place_m.is_empty());
        for _ in 0..MOST_BOXES {
            let reach = |place_m: &IntervalBox<2>| side.outwards(side.of(place_m));
            let farthest = (0..undecided.len())
                .max_by(|&one, &other| reach(&undecided[one]).total_cmp(&reach(&undecided[other])))?;
            let place_m = undecided.swap_remove(farthest);
            let halves = if place_m.width() > self.precision_m { place_m.bisect() } else { None };
            let Some((low_m, high_m)) = halves else { return Some(side.of(&place_m)) };
            let halves = [low_m, high_m].map(|half_m| contractor.contract(half_m));
            undecided.extend(halves.into_iter().filter(|half_m| !half_m.is_empty()));
        }
        Some(side.of(&domain_m))
    }
}

/// One of the four sides of a box.
#[derive(Clone, Copy)]
struct Side {
    axis: usize,
    is_upper: bool,
}

impl Side {
    const ALL: [Self; 4] = [
        Self { axis: 0, is_upper: false },
        Self { axis: 0, is_upper: true },
        Self { axis: 1, is_upper: false },
        Self { axis: 1, is_upper: true },
    ];

    /// Where a box has this side.
    fn of(self, place_m: &IntervalBox<2>) -> f64 {
        let along = place_m[self.axis];
        if self.is_upper { along.upper() } else { along.lower() }
    }

    /// Greater the farther out.
    fn outwards(self, bound_m: f64) -> f64 {
        if self.is_upper { bound_m } else { -bound_m }
    }

    /// What of a box does not reach beyond `bound_m`, which is inside of it.
    fn cut(self, mut place_m: IntervalBox<2>, bound_m: f64) -> IntervalBox<2> {
        let along = place_m[self.axis];
        place_m[self.axis] = if self.is_upper {
            Interval::spanning(along.lower(), bound_m)
        } else {
            Interval::spanning(bound_m, along.upper())
        };
        place_m
    }
}

/// Which of a pose's own ranges cannot be right when the vehicle is in `position_m`.
pub(super) fn contradicting(
    position_m: IntervalBox<2>,
    pose: usize,
    mission: &Mission,
    settings: &TubeSettings,
) -> impl Iterator<Item = usize> {
    mission.ranges_at(pose).filter(move |&index| {
        let range = &mission.ranges()[index];
        let beacon_m = IntervalBox::centred(&mission.beacons_m()[range.beacon], 0.0);
        Ring::new(beacon_m, Interval::centred(range.range_m, settings.range_m))
            .contract(position_m)
            .is_empty()
    })
}

fn rings(
    pose: usize,
    reach: Reach,
    mission: &Mission,
    course: &Course,
    settings: &TubeSettings,
) -> Vec<Ring<2>> {
    let window = window(pose, reach, mission, settings.window);
    let ring = |index: usize, way_m: &IntervalBox<2>| {
        let range = &mission.ranges()[index];
        let beacon_m = IntervalBox::centred(&mission.beacons_m()[range.beacon], 0.0);
        Ring::new(beacon_m - *way_m, Interval::centred(range.range_m, settings.range_m))
    };
    let Some(last) = window.clone().next_back().map(|index| mission.ranges()[index].pose) else {
        return Vec::new();
    };
    let first = mission.ranges()[window.start].pose;
    let within = |at: usize| mission.ranges_at(at).filter(|index| window.contains(index));
    let nowhere = IntervalBox::from([Interval::ZERO; 2]);
    let mut rings: Vec<_> = within(pose).map(|index| ring(index, &nowhere)).collect();
    for (at, way_m) in course.behind(pose).take_while(|(at, _)| *at >= first) {
        rings.extend(within(at).map(|index| ring(index, &way_m)));
    }
    for (at, way_m) in course.ahead(pose).take_while(|(at, _)| *at <= last) {
        rings.extend(within(at).map(|index| ring(index, &way_m)));
    }
    rings
}

/// The numbers of the ranges of a window, no more than `most`.
fn window(pose: usize, reach: Reach, mission: &Mission, most: usize) -> Range<usize> {
    let own = mission.ranges_at(pose);
    match reach {
        Reach::Past => own.end.saturating_sub(most)..own.end,
        Reach::Around => {
            let middle = usize::midpoint(own.start, own.end);
            let end = middle.saturating_add(most.div_ceil(2)).max(most).min(mission.ranges().len());
            end.saturating_sub(most)..end
        }
    }
}
