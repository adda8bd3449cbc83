use super::*;
use proptest::prelude::*;

#[test]
fn bad_times_are_refused() {
    assert_eq!(TimeDomain::new([]), Err(TubeError::NoBorder));
    assert!(matches!(TimeDomain::new([0.0, f64::NAN]), Err(TubeError::NotATime { .. })));
    assert!(matches!(TimeDomain::new([0.0, 1.0, 1.0]), Err(TubeError::Unsorted { .. })));
    assert!(matches!(TimeDomain::uniform(0.0, -1.0, 2), Err(TubeError::StepTooSmall { .. })));
    assert!(matches!(TimeDomain::uniform(1e18, 1.0, 2), Err(TubeError::StepTooSmall { .. })));
    assert!(matches!(TimeDomain::uniform(0.0, 1e-300, usize::MAX), Err(TubeError::StepTooSmall { .. })));
    assert!(matches!(TimeDomain::uniform(f64::MIN, f64::MAX, 2), Err(TubeError::NotATime { .. })));
    assert!(TimeDomain::uniform(0.0, f64::NAN, 2).is_err());
    assert!(TimeDomain::uniform(f64::INFINITY, 1.0, 2).is_err());
    let time = TimeDomain::starting_at(2.0).unwrap();
    assert_eq!(time.place_of(2.0), Ok(Place::Gate(0)));
    assert!(matches!(time.place_of(2.1), Err(TubeError::OutsideDomain { .. })));
    assert!(time.place_of(f64::INFINITY).is_err());
    assert!(time.refined([2.1]).is_err());
    let huge = TimeDomain::new([f64::MIN, 0.0, f64::MAX]).unwrap();
    assert_eq!(huge.place_of(1.0), Ok(Place::Slice(1)));
}

#[test]
fn dropping_keeps_the_end() {
    for mut time in
        [TimeDomain::uniform(0.0, 1.0, 4).unwrap(), TimeDomain::new([0.0, 1.0, 2.5, 3.0, 4.0]).unwrap()]
    {
        let whole = time.clone();
        time.drop_front(1);
        assert_eq!((time.start_s(), time.slice_count()), (1.0, 3));
        time.drop_front(100);
        assert_eq!((time.start_s(), time.end_s(), time.slice_count()), (4.0, 4.0, 0));
        assert_eq!(time.slice_span(0), None);
        assert_eq!(whole.slice_count(), 4, "clones are not touched");
    }
}

#[test]
fn steps_of_one_length_take_no_memory() {
    let mut time = TimeDomain::starting_at(3.0).unwrap();
    for index in 1..=100 {
        time.append(3.0 + f64::from(index) * 0.1).unwrap();
    }
    // The first border after the start gives the step, rounded; a quarter is exact.
    let mut quarters = TimeDomain::starting_at(3.0).unwrap();
    for index in 1..=100 {
        quarters.append(3.0 + f64::from(index) * 0.25).unwrap();
    }
    quarters.drop_front(60);
    assert_eq!((quarters.memory_bytes(), quarters.start_s(), quarters.slice_count()), (0, 18.0, 40));
    quarters.append(99.0).unwrap();
    assert_eq!((quarters.end_s(), quarters.slice_span(40)), (99.0, Some(Interval::spanning(28.0, 99.0))));
    assert!(quarters.memory_bytes() > 0);
    let listed = TimeDomain::new((0..=100).map(|index| 3.0 + f64::from(index) * 0.1)).unwrap();
    assert_eq!(time, listed);
}

prop_compose! {
    fn domain()(
        start in -3.0..3.0_f64,
        steps in prop_oneof![
            prop::collection::vec(prop_oneof![1.0e-9..1.0e-3_f64, 0.1..10.0_f64], 1..50),
            (0.001..10.0_f64, 1..50_usize).prop_map(|(step, count)| vec![step; count]),
        ],
        uniform in any::<bool>(),
        dropped in 0..60_usize,
    ) -> TimeDomain {
        let mut domain = if uniform {
            TimeDomain::uniform(start, steps[0], steps.len()).unwrap()
        } else {
            let ends = steps.iter().scan(start, |time, step| { *time += step; Some(*time) });
            TimeDomain::new([start].into_iter().chain(ends)).unwrap()
        };
        domain.drop_front(dropped);
        domain
    }
}

proptest! {
    #[test]
    fn every_time_is_found(time in domain(), share in 0.0..=1.0_f64) {
        let asked = (time.start_s() + share * (time.end_s() - time.start_s())).min(time.end_s());
        match time.place_of(asked).unwrap() {
            Place::Gate(index) => prop_assert_eq!(time.border_s(index), Some(asked)),
            Place::Slice(index) => {
                let span = time.slice_span(index).unwrap();
                prop_assert!(span.lower() < asked && asked < span.upper());
            }
        }
        for (index, border) in time.borders_s().enumerate() {
            prop_assert_eq!(time.place_of(border), Ok(Place::Gate(index)));
            for neighbour in [border.next_down(), border.next_up()] {
                if let Ok(place) = time.place_of(neighbour) {
                    let Place::Slice(slice) = place else { panic!("borders are far apart") };
                    let span = time.slice_span(slice).unwrap();
                    prop_assert!(span.contains(neighbour) && (slice == index || slice + 1 == index));
                }
            }
        }
    }

    /// The bounds on the length of a uniform domain's borders are those of a list of the same borders.
    #[test]
    fn uniform_is_what_a_list_of_its_borders_is(time in domain(), ends in prop::collection::vec(0.01..3.0_f64, 0..4)) {
        let mut listed = TimeDomain::new(time.borders_s()).unwrap();
        let mut time = time;
        for step in ends {
            time.append(time.end_s() + step).unwrap();
            listed.append(listed.end_s() + step).unwrap();
            prop_assert_eq!(&time, &listed);
        }
        prop_assert!(time.borders_s().is_sorted());
    }

    #[test]
    fn refining_adds_cuts(time in domain(), shares in prop::collection::vec(0.0..=1.0_f64, 0..5)) {
        let cuts: Vec<f64> = shares
            .iter()
            .map(|share| (time.start_s() + share * (time.end_s() - time.start_s())).min(time.end_s()))
            .collect();
        let refined = time.refined(cuts.iter().copied()).unwrap();
        for border in cuts.into_iter().chain(time.borders_s()) {
            prop_assert!(matches!(refined.place_of(border), Ok(Place::Gate(_))));
        }
        prop_assert!(refined.slice_count() <= time.slice_count() + shares.len());
    }
}

#[test]
fn the_short_way_to_a_duration_gives_the_same() {
    let times_s =
        [-3.0, -1.0, -5e-324, 0.0, 5e-324, 1.5e-323, 0.1, 0.3, 1.0, 1.9, 2.0, 1e9, 1e9 + 0.3, 1e300];
    for (index, &start_s) in times_s.iter().enumerate() {
        for &end_s in &times_s[index + 1..] {
            assert_eq!(duration_s(start_s, end_s), exactly(end_s) - start_s, "{start_s} to {end_s}");
        }
    }
}
