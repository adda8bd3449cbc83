use super::*;
use crate::strategies::number;
use nalgebra::{SVector, Vector2, Vector3};
use proptest::prelude::*;

fn unit() -> IntervalBox<2> {
    IntervalBox::from([Interval::new(0.0, 1.0).unwrap(); 2])
}

#[test]
fn one_empty_side_empties_the_box() {
    let mut flat = unit();
    flat[1] = Interval::EMPTY;
    assert!(flat.is_empty() && flat.width().is_nan() && flat.mid().iter().all(|x| x.is_nan()));
    assert_eq!(flat & unit(), IntervalBox::EMPTY);
    assert_eq!(flat | unit(), unit());
    assert_eq!(flat + unit(), IntervalBox::EMPTY);
    assert!(flat.is_subset_of(&unit()));
}

#[test]
fn sets_and_sums() {
    let moved = unit() + IntervalBox::centred(&Vector2::new(0.5, 2.0), 0.0);
    assert!((unit() & moved).is_empty());
    assert_eq!((unit() | moved).width(), 3.0);
    assert_eq!(moved.mid(), Vector2::new(1.0, 2.5));
    assert_eq!((unit() - unit()).width(), 2.0);
    assert_eq!((unit() * Interval::new(-1.0, 2.0).unwrap()).width(), 3.0);
    assert_eq!(format!("{:.1}", unit().inflate(0.5)), "[-0.5, 1.5] x [-0.5, 1.5]");
}

#[test]
fn a_box_is_cut_until_nothing_is_left_to_cut() {
    let x = IntervalBox::from([Interval::new(1.0, 2.0).unwrap(), Interval::new(-1.0, 3.0).unwrap()]);
    assert_eq!(x.widest_axis(), 1);
    let (low, high) = x.bisect().unwrap();
    assert_eq!((low[1].upper(), high[1].lower(), low[0], high[0]), (1.0, 1.0, x[0], x[0]));
    assert!(x.bisect_axis(2).is_none());
    let half_open = IntervalBox::from([Interval::ONE | Interval::ZERO, Interval::NON_NEGATIVE]);
    assert!(half_open.bisect().is_none() && half_open.bisect_axis(1).is_none());
    assert!(half_open.bisect_axis(0).is_some());
    let mut empty = unit();
    empty[1] = Interval::EMPTY;
    assert!(empty.bisect().is_none() && empty.bisect_axis(0).is_none());
    assert!(IntervalBox::<0>::from([]).bisect().is_none());
}

#[test]
fn a_long_side_without_numbers_inside_does_not_stop_the_cutting() {
    let neighbours = Interval::new(1e17, 1e17_f64.next_up()).unwrap();
    let mut x = IntervalBox::from([neighbours, Interval::new(0.0, 1.0).unwrap()]);
    let mut cuts = 0;
    while let Some((low, _)) = x.bisect() {
        x = low;
        cuts += 1;
    }
    assert_eq!(x[0], neighbours);
    assert_eq!((x[1].upper(), cuts), (f64::from_bits(1), 1074));
}

#[test]
fn volumes() {
    let x = IntervalBox::from([Interval::new(0.0, 0.1).unwrap(), Interval::new(-1.0, 2.0).unwrap()]);
    assert_eq!((x.volume(), x.volume_enclosure().upper()), (0.3_f64.next_up(), 0.3_f64.next_up()));
    assert!(x.volume_enclosure().contains(0.3));
    let flat = IntervalBox::from([Interval::ONE, Interval::ENTIRE]);
    assert_eq!((flat.volume(), flat.volume_enclosure(), flat.is_flat()), (0.0, Interval::ZERO, true));
    assert_eq!(IntervalBox::<2>::EMPTY.volume(), 0.0);
    assert_eq!(IntervalBox::<2>::ENTIRE.volume(), f64::INFINITY);
    assert!(IntervalBox::<2>::ENTIRE.volume_enclosure().lower() > 1e300);
    assert!(!IntervalBox::<2>::EMPTY.is_flat() && !IntervalBox::<2>::EMPTY.is_point());
    assert!(IntervalBox::from(Vector2::new(1.0, 2.0)).is_point());
}

#[test]
fn vectors_in_and_out() {
    let strange = IntervalBox::from(Vector3::new(1.0, f64::NAN, f64::INFINITY));
    assert_eq!((strange[0], strange[1], strange[2].lower()), (Interval::ONE, Interval::ENTIRE, f64::MAX));
    let sides: SVector<Interval, 3> = strange.into();
    assert_eq!(IntervalBox::from(sides), strange);
    let mut empty = unit();
    empty[0] = Interval::EMPTY;
    assert_eq!(empty.lower(), Vector2::repeat(f64::INFINITY));
    assert_eq!(empty.upper(), Vector2::repeat(f64::NEG_INFINITY));
    assert_eq!((empty.corners().count(), unit().corners().count()), (0, 4));
    assert_eq!(unit().corners().last(), Some(Vector2::new(1.0, 1.0)));
}

#[test]
fn products_of_vectors() {
    let x = IntervalBox::from([Interval::new(-1.0, 1.0).unwrap(), Interval::new(3.0, 4.0).unwrap()]);
    assert_eq!(x.dot(&x), Interval::new(8.0, 17.0).unwrap());
    assert_eq!(x.norm().lower(), 3.0);
    assert_eq!(2.0 * x, x + x);
    assert_eq!(x * Interval::ZERO, IntervalBox::from(Vector2::new(0.0, 0.0)));
    let mut half_empty = x;
    half_empty[0] = Interval::EMPTY;
    assert!(half_empty.dot(&x).is_empty() && half_empty.norm().is_empty());
    assert_eq!(half_empty * 2.0, IntervalBox::EMPTY);
    assert_eq!(half_empty.map(|_| Interval::ONE), IntervalBox::EMPTY);
}

#[test]
fn inner_and_outer_tests() {
    let touching = unit() + IntervalBox::from(Vector2::new(1.0, 0.0));
    assert!(unit().overlaps(&touching));
    assert!(!unit().is_interior_of(&unit()) && unit().is_interior_of(&unit().inflate(0.1)));
    assert!(IntervalBox::<2>::ENTIRE.is_interior_of(&IntervalBox::ENTIRE));
    let mut empty = unit();
    empty[1] = Interval::EMPTY;
    assert!(empty.is_interior_of(&IntervalBox::EMPTY) && !unit().is_interior_of(&IntervalBox::EMPTY));
    assert!(empty.is_disjoint_from(&unit()) && unit().is_disjoint_from(&empty));
    assert!(!unit().overlaps(&(touching + IntervalBox::from(Vector2::new(1e-9, 0.0)))));
}

#[test]
fn a_face_in_common_takes_nothing_away() {
    let beside = IntervalBox::from([Interval::new(1.0, 2.0).unwrap(), Interval::new(0.25, 0.5).unwrap()]);
    assert_eq!(unit().difference(&beside).collect::<Vec<_>>(), [unit()]);
    let line = IntervalBox::from([Interval::new(0.5, 0.5).unwrap(), Interval::ENTIRE]);
    assert_eq!(unit().difference(&line).map(|piece| piece.volume()).sum::<f64>(), 1.0);
    assert_eq!(IntervalBox::<2>::ENTIRE.difference(&unit()).count(), 4);
    assert_eq!(unit().difference(&IntervalBox::ENTIRE).count(), 0);
    assert_eq!(IntervalBox::EMPTY.difference(&unit()).count(), 0);
    assert_eq!(unit().difference(&IntervalBox::EMPTY).collect::<Vec<_>>(), [unit()]);
}

fn small_box() -> impl Strategy<Value = IntervalBox<3>> {
    let bound = (0..6_i32).prop_map(f64::from);
    prop::array::uniform3((bound.clone(), bound))
        .prop_map(|sides| IntervalBox::from(sides.map(|(one, other)| Interval::spanning(one, other))))
}

proptest! {
    /// On a grid of half steps each cell of `self` is in exactly one piece or in `other`, and each vector of `self` is
    /// in a piece unless `other` covers all that surrounds it.
    #[test]
    fn the_difference_is_all_that_is_left_and_no_more(x in small_box(), y in small_box()) {
        let pieces: Vec<_> = x.difference(&y).collect();
        prop_assert!(pieces.len() <= 6);
        prop_assert!(pieces.iter().all(|piece| piece.is_subset_of(&x) && !piece.is_empty()));
        let shared = (x & y).volume();
        prop_assert_eq!(pieces.iter().map(|piece| piece.volume()).sum::<f64>() + shared, x.volume());
        for (index, piece) in pieces.iter().enumerate() {
            prop_assert!(!(*piece & y).sides().iter().zip(piece.sides()).all(|(side, all)| *side == all));
            prop_assert!(pieces[..index].iter().all(|other| (*other & *piece).volume() == 0.0));
        }
        for corner in 0..1000_u32 {
            let coordinate = |place: u32| f64::from(corner / 10_u32.pow(place) % 10) * 0.5 + 0.25;
            let vector = Vector3::new(coordinate(0), coordinate(1), coordinate(2));
            let left = x.contains(&vector) && !y.contains(&vector);
            prop_assert_eq!(left, pieces.iter().any(|piece| piece.contains(&vector)));
        }
    }

    #[test]
    fn halves_are_the_whole(bounds in prop::array::uniform3((number(), number()))) {
        let x = IntervalBox::from(bounds.map(|(one, other)| Interval::spanning(one, other)));
        if let Some((low, high)) = x.bisect() {
            let axis = (0..3).find(|&axis| low[axis] != x[axis]).unwrap();
            prop_assert_eq!(low | high, x);
            prop_assert!((low & high)[axis].is_point());
        } else {
            prop_assert!(x.iter().all(|side| side.lower().next_up() >= side.upper()));
        }
    }

    #[test]
    fn lengths_and_products_hold_those_of_members(
        bounds in prop::array::uniform2((number(), number())), at in prop::array::uniform2(number()),
    ) {
        let x = IntervalBox::from(bounds.map(|(one, other)| Interval::spanning(one, other)));
        let member = Vector2::from_fn(|axis, _| at[axis].clamp(x[axis].lower(), x[axis].upper()));
        let point = IntervalBox::from(member);
        prop_assert!(point.norm().is_subset_of(x.norm()));
        prop_assert!(point.dot(&point).is_subset_of(x.dot(&x)));
        prop_assert!(point.is_subset_of(&x) && point.volume_enclosure() == Interval::ZERO);
    }
}
