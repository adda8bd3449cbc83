//! Ranges as anchored rings around one pose, of which at most q are wrong.
//!
//! A range measured at another pose says as much about this one once odometry has led there: the vehicle was `d` away from here, so
//! what is as far from the beacon as was measured is, seen from here, a ring around the beacon minus `d`, as wide as odometry may
//! be wrong. Of the rings of a window all but the outliers meet where the vehicle is.
//!
//! Source: seed 001, sections 2.4.4 and 2.4.5 and table 2.5; seed 004 (at most q outliers among the last m).

use std::ops::Range;

use shoal_interval::contractor::{Contractor, Ring, q_intersection};
use shoal_interval::{Interval, IntervalBox};

use super::course::Course;
use super::{Mission, TubeSettings};

/// More boxes than this are not looked at for one pose; what is then left counts as possible.
const MOST_BOXES: usize = 50_000;

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
    let with = |outliers: usize| hull(position_m, &rings, outliers, settings.precision_m);
    for outliers in 0..=settings.outliers {
        let found_m = with(outliers);
        if !found_m.is_empty() {
            return Some(if settings.margin == 0 { found_m } else { with(outliers + settings.margin) });
        }
    }
    None
}

/// A box that holds every place in `domain_m` that is in all `rings` but so many of them, no more than a few `precision_m` larger
/// than the smallest one.
///
/// Bisects like any paving, but what lies inside the hull of what was found already is not looked at, which leaves only the places
/// around the extremes.
fn hull(domain_m: IntervalBox<2>, rings: &[Ring<2>], outliers: usize, precision_m: f64) -> IntervalBox<2> {
    if outliers >= rings.len() {
        return domain_m;
    }
    let contractor = q_intersection(rings.iter().copied(), outliers);
    let mut found_m = IntervalBox::EMPTY;
    let mut undecided = vec![domain_m];
    let mut seen = 0;
    while let Some(place_m) = undecided.pop() {
        if place_m.is_subset_of(&found_m) {
            continue;
        }
        let place_m = contractor.contract(place_m);
        seen += 1;
        let halves = if place_m.width() > precision_m && seen < MOST_BOXES { place_m.bisect() } else { None };
        match halves {
            Some((low_m, high_m)) => undecided.extend([low_m, high_m]),
            None => found_m = found_m | place_m,
        }
    }
    found_m
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
