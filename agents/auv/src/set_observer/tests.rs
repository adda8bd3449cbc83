use proptest::prelude::*;
use shoal_bus::message::{Bounds, Estimator as Orders};

use super::*;
use crate::newborn::PERIOD_NS;
use crate::tube_estimator::tests::truth::{Truth, told};
use crate::tube_estimator::tests::{TICKS, enclosed_by, heard, lives, steady};

fn settings(outliers: Option<Outliers>, on_empty: Recovery) -> TubeSettings {
    TubeSettings { outliers, on_empty, ..TubeSettings::forward(40 * PERIOD_NS) }
}

fn newborn(drift: f64, settings: &TubeSettings, is_known: bool) -> Born {
    let mut born = told(drift, 0.05);
    born.orders.area_m = [Bounds::new(-500.0, 500.0); 3];
    if !is_known {
        born.prior_position_m = born.orders.area_m;
    }
    born.orders.estimator = Orders::Tube(*settings);
    born
}

/// Of so many pings in a row, in the order in which they are told, makes so many wrong: their beacon says that it is elsewhere, or the ping
/// came the long way round.
fn falsify(told: &mut [Vec<Event>], window: u16, wrong: u16, by_m: f64) {
    let mut count = 0;
    for events in told {
        events.sort_by_key(|event| event.stamp);
        for event in events {
            let Sense::Heard { frame } = &mut event.sense else { continue };
            let mut ping = Ping::decode(frame).unwrap();
            if count % window < wrong {
                match count % 2 {
                    0 => ping.position_m[0] = Bounds::new(by_m, by_m + 1.0),
                    _ => {
                        let Bounds { lower, upper } = ping.emission_s;
                        let longer_s = by_m.abs() / 1_500.0;
                        ping.emission_s = Bounds::new(lower - longer_s, upper - longer_s);
                    }
                }
                *frame = ping.encode().unwrap();
            }
            count += 1;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// As long as no more pings are wrong than assumed, the truth is never lost: whether they come late, and whatever is known at first.
    #[test]
    fn outliers_within_the_assumption_never_cost_the_truth(
        pushes in lives(),
        drift in prop_oneof![Just(0.0), 1e-6..0.02_f64],
        (window, wrong, margin) in (1..12_u16, 0..4_u16, prop_oneof![Just(None), (0..3_u16).prop_map(Some)]),
        by_m in prop_oneof![-300.0..300.0_f64, -5.0..5.0_f64],
        is_known in any::<bool>(),
        arrivals in prop::collection::vec(
            (0..TICKS as i64 * PERIOD_NS, prop_oneof![Just(0), 0..5_000_000_000_i64]), 0..30),
    ) {
        let wrong = wrong.min(window - 1);
        // The fewest that leave something may be fewer than are wrong: the margin has to make up for that.
        let margin = margin.map(|margin| margin.max(wrong));
        let assumed = Outliers { window, tolerated: wrong, margin };
        let settings = settings(Some(assumed), Recovery::Drop);
        let born = newborn(drift, &settings, is_known);
        let truth = Truth::new(&born, &pushes);
        let mut told = heard(&truth, &arrivals, TICKS);
        falsify(&mut told, window, wrong, by_m);
        enclosed_by(&mut SetObserver::new(&born, &settings), &truth, &told)?;
    }
}

#[test]
fn one_wrong_ping_too_many_is_told_and_the_set_begins_again() {
    let told_by = |on_empty: Recovery| {
        let settings = settings(Some(Outliers { window: 5, tolerated: 1, margin: None }), on_empty);
        let born = newborn(1e-6, &settings, true);
        let truth = Truth::new(&born, &steady());
        let arrivals: Vec<_> = (1..40).map(|index| (index * PERIOD_NS + PERIOD_NS / 2, 0)).collect();
        let mut told = heard(&truth, &arrivals, 50);
        for events in &mut told[30..32] {
            falsify(std::slice::from_mut(events), 1, 1, 400.0);
        }
        let mut observer = SetObserver::new(&born, &settings);
        let emptied = told.iter().enumerate().filter_map(|(tick, events)| {
            let stamp = LocalTime::from_ns((tick as i64 + 1) * PERIOD_NS);
            let mut events = events.clone();
            events.push(truth.inertial(stamp.ns()));
            events.sort_by_key(|event| event.stamp);
            let estimate = observer.update(&Sensed { tick: tick as u64, stamp, events });
            estimate.emptied.map(|emptied| (tick, emptied.by, estimate.state.position_m.width()))
        });
        let emptied: Vec<_> = emptied.collect();
        let (tick, culprit, width_m) = emptied[0];
        assert_eq!((tick, culprit), (31, Culprit::Ping(AuvId(9))));
        (emptied.len(), width_m)
    };
    let (times, width_m) = told_by(Recovery::Drop);
    assert!(times == 1 && width_m < 10.0, "{times}, {width_m} m");
    // Both wrong ones are remembered, and told of again until the first leaves the window.
    let (times, width_m) = told_by(Recovery::Relax);
    assert!(times == 4 && width_m < 10.0, "{times}, {width_m} m");
    // It begins again from the whole area, with a single ping, which is wrong, and one of one may be.
    let (times, width_m) = told_by(Recovery::Restart);
    assert!(times == 1 && width_m >= 1_000.0, "{times}, {width_m} m");
}

#[test]
fn an_impossible_current_is_a_kidnapping_too() {
    let after = |on_empty: Recovery| {
        let settings = settings(None, on_empty);
        let born = newborn(1e-6, &settings, true);
        let truth = Truth::new(&born, &steady());
        let mut observer = SetObserver::new(&born, &settings);
        let stamp = LocalTime::from_ns(PERIOD_NS);
        let mut dvl = truth.dvl(stamp.ns());
        if let Sense::Dvl { velocity_m_s } = &mut dvl.sense {
            velocity_m_s[1].value += 3.0;
        }
        let estimate =
            observer.update(&Sensed { tick: 0, stamp, events: vec![truth.inertial(stamp.ns()), dvl] });
        assert_eq!(estimate.emptied.map(|emptied| emptied.by), Some(Culprit::Dvl));
        (estimate.state.position_m, estimate.slice.position_m, interval_box(&born.orders.area_m))
    };
    let (state, slice, area) = after(Recovery::Restart);
    assert!(area.is_subset_of(&state) && state.is_subset_of(&area.inflate(1.0)) && slice == state);
    assert!(after(Recovery::Drop).0.width() < 3.0);
}

/// An observer that begins again, after a steady life with a Doppler velocity log in an area around its start so small that it has left
/// it by then; with the truth, and the local time of the tick.
fn begun_again() -> (SetObserver, Estimate, Truth, i64) {
    let settings = settings(Some(Outliers { window: 5, tolerated: 1, margin: None }), Recovery::Restart);
    let mut born = newborn(1e-6, &settings, true);
    let start_m = Truth::new(&born, &steady()).at(0).position_m;
    born.orders.area_m = std::array::from_fn(|axis| Bounds::new(start_m[axis] - 0.1, start_m[axis] + 0.1));
    let truth = Truth::new(&born, &steady());
    let arrivals: Vec<_> = (1..40).map(|index| (index * PERIOD_NS + PERIOD_NS / 2, 0)).collect();
    let mut told = heard(&truth, &arrivals, 50);
    for events in &mut told[30..32] {
        falsify(std::slice::from_mut(events), 1, 1, 400.0);
    }
    let mut observer = SetObserver::new(&born, &settings);
    for (tick, events) in told.iter().enumerate() {
        let local_ns = (tick as i64 + 1) * PERIOD_NS;
        let mut events = events.clone();
        events.extend([truth.inertial(local_ns), truth.dvl(local_ns)]);
        events.sort_by_key(|event| event.stamp);
        let stamp = LocalTime::from_ns(local_ns);
        let estimate = observer.update(&Sensed { tick: tick as u64, stamp, events });
        if estimate.emptied.is_some() {
            return (observer, estimate, truth, local_ns);
        }
    }
    panic!("it never noticed");
}

#[test]
fn who_has_left_the_area_is_found_again() {
    let (observer, estimate, truth, local_ns) = begun_again();
    let position_m = truth.at(local_ns).position_m;
    assert!(!observer.area_m.contains(&position_m));
    assert!(estimate.state.position_m.contains(&position_m), "{position_m} in {:?}", estimate.state);
}

#[test]
fn the_current_and_the_way_of_another_place_are_forgotten() {
    let (observer, _, _, local_ns) = begun_again();
    let stamp = LocalTime::from_ns(local_ns);
    assert_eq!(observer.predict(stamp).current_m_s, observer.travel.motion().any_current());
    assert!(observer.since(LocalTime::from_ns(local_ns - PERIOD_NS), &Way::none(), 1.0).is_none());
}
