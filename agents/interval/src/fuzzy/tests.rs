//! The tables of seed 000, scores, and cuts against membership point by point.

use super::*;
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::paving::{Options, pave};
use crate::separator::{InBox, Ring, Separator, q_intersection};
use nalgebra::Vector2;
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn grade(numerator: u32, denominator: u32) -> Grade {
    Grade::new(numerator, denominator).unwrap()
}

#[test]
fn cuts_of_four_weighted_intervals() {
    let granules = [over(0.0, 3.0), over(2.0, 5.0), over(4.0, 7.0), over(2.5, 2.75)];
    let score = ScoreFunction::weighted_mean(&[1, 2, 1, 1]).unwrap();
    let cut = |grade| contract_interval(&score, grade, &granules, over(-10.0, 10.0));
    assert_eq!(cut(grade(1, 5)), over(0.0, 7.0));
    for middle in [grade(2, 5), grade(1, 2), grade(3, 5)] {
        assert_eq!(cut(middle), over(2.0, 5.0));
    }
    assert_eq!(cut(grade(4, 5)), over(2.5, 2.75));
    assert_eq!(cut(Grade::ONE), Interval::EMPTY);
    assert_eq!(cut(Grade::ZERO), over(-10.0, 10.0));
    // A domain that begins or ends within granules gives its own bounds.
    assert_eq!(contract_interval(&score, grade(2, 5), &granules, over(2.6, 4.5)), over(2.6, 4.5));
    assert_eq!(contract_interval(&score, grade(1, 5), &granules, Interval::ENTIRE), over(0.0, 7.0));
    assert!(contract_interval(&score, grade(1, 5), &granules, Interval::EMPTY).is_empty());
}

#[test]
fn relaxed_intersections_of_three_boxes() {
    let boxes = [
        IntervalBox::from([over(0.0, 4.0), over(0.0, 4.0)]),
        IntervalBox::from([over(2.0, 6.0), over(2.0, 6.0)]),
        IntervalBox::from([over(5.0, 9.0), over(-2.0, 1.0)]),
    ];
    let initial = IntervalBox::from([over(-10.0, 10.0); 2]);
    let expected = [
        IntervalBox::EMPTY,
        IntervalBox::from([over(2.0, 6.0), over(0.0, 4.0)]),
        IntervalBox::from([over(0.0, 9.0), over(-2.0, 6.0)]),
        initial,
    ];
    let mean = ScoreFunction::weighted_mean(&[1, 1, 1]).unwrap();
    for (outliers, expected) in expected.into_iter().enumerate() {
        let relaxed = q_intersection(boxes.map(InBox::new), outliers);
        assert_eq!(relaxed.outer(initial), expected);
        assert_eq!(contract_box(&mean, grade(3 - outliers as u32, 3), &boxes, initial), expected);
    }
}

/// Table 5.2 and the Karnaugh table 5.3 of seed 000: all sixteen combinations.
#[test]
#[expect(clippy::nonminimal_bool, reason = "the disjunctive normal form stands as the seed prints it")]
fn scores_of_all_combinations() {
    let score = ScoreFunction::weighted_mean(&[1, 2, 1, 1]).unwrap();
    for combination in 0..16_u32 {
        let member = |granule: usize| combination >> granule & 1 == 1;
        let [z1, z2, z3, z4] = [0, 1, 2, 3].map(member);
        let fifths = [z1, z2, z2, z3, z4].into_iter().map(u32::from).sum();
        assert_eq!(score.of(member), grade(fifths, 5));
        let disjunctive = (z1 && z2) || (z2 && z3) || (z2 && z4) || (z1 && z3 && z4);
        let factored = (z2 && (z1 || z3 || z4)) || (z1 && z3 && z4);
        assert_eq!(score.of(member) >= grade(1, 2), disjunctive);
        assert_eq!(factored, disjunctive);
        // Example 5.2.2: the complement's score, in the complements, at the same grade.
        assert_eq!(score.of(|granule| !member(granule)) < grade(1, 2), disjunctive);
    }
}

#[test]
fn scores_are_built_or_checked() {
    use FuzzyError as E;
    assert_eq!(ScoreFunction::weighted_mean(&[0, 0]), Err(E::NoWeight));
    assert_eq!(ScoreFunction::weighted_mean(&[u32::MAX, 1]), Err(E::TooFine));
    assert_eq!(ScoreFunction::new(1, Score::granule(1)), Err(E::NoSuchGranule { granule: 1, granules: 1 }));
    assert_eq!(ScoreFunction::new(1, Score::least([])), Err(E::NoWeight));
    let nested = (0..40).fold(Score::granule(0), |part, _| Score::mean([(3, part), (1, Score::granule(1))]));
    assert_eq!(ScoreFunction::new(2, nested), Err(E::TooFine));
    assert!(matches!(Grade::new(2, 1), Err(E::Grade { .. })) && Grade::new(0, 0).is_err());

    let majority = |members: &[bool]| {
        let count = members.iter().filter(|&&member| member).count();
        if 2 * count > members.len() { Grade::ONE } else { Grade::ZERO }
    };
    assert!(ScoreFunction::from_fn(3, majority).is_ok());
    assert!(matches!(ScoreFunction::from_fn(17, majority), Err(E::TooManyGranules { .. })));
    let odd = |members: &[bool]| grade(members.iter().filter(|&&member| member).count() as u32 % 2, 1);
    assert!(matches!(ScoreFunction::from_fn(3, odd), Err(E::NotMonotone { .. })));
    assert!(matches!(ScoreFunction::from_fn(2, |_| Grade::ONE), Err(E::Ends { .. })));

    // Equation (5.7): the least of one granule and of the mean of all.
    let mean = Score::mean((0..3).map(|granule| (1, Score::granule(granule))));
    let score = ScoreFunction::new(3, Score::least([Score::granule(0), mean])).unwrap();
    assert_eq!(score.of(|granule| granule < 2), grade(2, 3));
    assert_eq!(score.of(|granule| granule > 0), Grade::ZERO);
    let cut = AlphaCut::new(score, Grade::ONE, vec![InBox::new(IntervalBox::<1>::ENTIRE)]);
    assert_eq!(cut.unwrap_err(), E::GranuleCount { expected: 3, given: 1 });
}

#[test]
fn a_fuzzy_range_is_enclosed_by_its_steps() {
    let fuzzy = FuzzyRing::new(Vector2::new(0.0, 0.0), over(1.0, 4.0), over(2.0, 3.0)).unwrap();
    assert!(FuzzyRing::new(Vector2::zeros(), over(2.0, 3.0), over(1.0, 4.0)).is_err());
    let initial = IntervalBox::from([over(-5.0, 5.0); 2]);
    let area = |upper: f64, lower: f64| std::f64::consts::PI * (upper * upper - lower * lower);
    for (numerator, (lower, upper)) in
        [(1.0, 4.0), (1.25, 3.75), (1.5, 3.5), (1.75, 3.25), (2.0, 3.0)].iter().enumerate()
    {
        let cut = pave(&fuzzy.cut(grade(numerator as u32, 4)), initial, &Options::new(0.2)).unwrap();
        assert!(cut.inner_volume().upper() <= area(*upper, *lower));
        assert!(cut.outer_volume().lower() >= area(*upper, *lower));
        let steps = fuzzy.steps(4);
        let score = ScoreFunction::weighted_mean(&[1; 4]).unwrap();
        let stairs = AlphaCut::new(score, grade(numerator as u32, 4), steps).unwrap();
        let paving = pave(&stairs, initial, &Options::new(0.2)).unwrap();
        assert!(paving.inner_volume().upper() <= area(*upper, *lower) || numerator == 0);
        assert!(paving.outer_volume().lower() >= area(*upper, *lower));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn cuts_agree_with_memberships(
        granules in prop::collection::vec((-5_i32..5, 0_i32..6), 1..6),
        weights in prop::collection::vec(0_u32..4, 6),
        fifths in 1_u32..=5,
        start in -8_i32..8,
        length in 0_i32..10,
        halves in prop::collection::vec(-20_i32..20, 12),
    ) {
        let granules: Vec<Interval> =
            granules.into_iter().map(|(lower, width)| over(f64::from(lower), f64::from(lower + width))).collect();
        let Ok(score) = ScoreFunction::weighted_mean(&weights[..granules.len()]) else { return Ok(()) };
        let domain = over(f64::from(start), f64::from(start + length));
        let cut = contract_interval(&score, grade(fifths, 5), &granules, domain);
        prop_assert!(cut.is_subset_of(domain));
        let boxes: Vec<InBox<1>> = granules.iter().map(|&granule| InBox::new(IntervalBox::from([granule]))).collect();
        let separator = AlphaCut::new(score.clone(), grade(fifths, 5), boxes).unwrap();
        let separation = separator.separate(IntervalBox::from([domain]));
        prop_assert_eq!(separation.outer[0], cut);
        for x in halves.into_iter().map(|half| 0.5 * f64::from(half)).filter(|&x| domain.contains(x)) {
            let reached = score.of(|granule| granules[granule].contains(x)) >= grade(fifths, 5);
            prop_assert!(cut.contains(x) || !reached);
            prop_assert!(separation.inner[0].contains(x) || reached);
        }
        // Minimal: both bounds reach the grade themselves.
        if !cut.is_empty() {
            for bound in [cut.lower(), cut.upper()] {
                prop_assert!(score.of(|granule| granules[granule].contains(bound)) >= grade(fifths, 5));
            }
        }
    }

    #[test]
    fn rings_of_unequal_worth(x in -5.0..5.0_f64, y in -5.0..5.0_f64, width in 0.0..4.0_f64, thirds in 1_u32..=3) {
        let centres = [Vector2::new(0.0, 0.0), Vector2::new(2.0, 1.0), Vector2::new(-1.0, 2.0)];
        let rings = centres.map(|centre| Ring::new(centre, over(1.0, 3.0)));
        let score = ScoreFunction::weighted_mean(&[1, 1, 1]).unwrap();
        let cut = AlphaCut::new(score, grade(thirds, 3), rings.to_vec()).unwrap();
        let point = Vector2::new(x, y);
        let domain = IntervalBox::from([over(x - width, x + 0.3 * width), over(y - 0.5 * width, y + width)]);
        let count = centres.iter().filter(|centre| (1.0..=3.0).contains(&(point - **centre).norm())).count();
        let separation = cut.separate(domain);
        prop_assert!(separation.outer.contains(&point) || count < thirds as usize);
        prop_assert!(separation.inner.contains(&point) || count >= thirds as usize);
        let relaxed = q_intersection(rings, 3 - thirds as usize).separate(domain);
        prop_assert_eq!(relaxed, separation);
    }
}
