//! The laws that all contractors obey, on boxes of every size.

use super::*;
use crate::strategies::interval_with_members;
use nalgebra::{SVector, Vector2};
use proptest::prelude::*;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// The box, wider than rounding in another order can make it.
fn loosened<const N: usize>(domain: IntervalBox<N>) -> IntervalBox<N> {
    IntervalBox::from(domain.sides().map(|side| {
        if side.is_empty() { side } else { side.inflate(1e-12 * side.magnitude().clamp(1e-3, f64::MAX)) }
    }))
}

fn check_laws<const N: usize>(
    contractor: &dyn Contractor<N>,
    domain: IntervalBox<N>,
    part: IntervalBox<N>,
) -> Result<(), TestCaseError> {
    prop_assert!(contractor.contract(IntervalBox::EMPTY).is_empty());
    let contracted = contractor.contract(domain);
    prop_assert!(contracted.is_subset_of(&domain), "{} -> {}", domain, contracted);
    let contracted_part = contractor.contract(part);
    prop_assert!(
        contracted_part.is_subset_of(&loosened(contracted)),
        "{} -> {}, but its part {} -> {}",
        domain,
        contracted,
        part,
        contracted_part
    );
    for (side, old) in contracted.iter().zip(domain.iter()) {
        prop_assert!(side.is_empty() || side.lower() <= side.upper() && old.contains(side.mid()));
    }
    Ok(())
}

/// A box, a part of it that is a single point or reaches between two of its points, sides sometimes without bounds.
fn domain_and_part<const N: usize>() -> impl Strategy<Value = (IntervalBox<N>, IntervalBox<N>)> {
    let side = (interval_with_members(), 0_u8..6, any::<bool>());
    prop::collection::vec(side, N).prop_map(|sides| {
        let domain = std::array::from_fn(|axis| match (sides[axis].0.0, sides[axis].1) {
            (side, 0) => side | Interval::NON_NEGATIVE,
            (_, 1) => Interval::ENTIRE,
            (side, _) => side,
        });
        let part = std::array::from_fn(|axis| {
            let (_, one, other) = sides[axis].0;
            Interval::spanning(one, if sides[axis].2 { one } else { other })
        });
        (IntervalBox::from(domain), IntervalBox::from(part))
    })
}

fn planar() -> Vec<Box<dyn Contractor<2>>> {
    static WALLS: std::sync::LazyLock<[Wall; 3]> = std::sync::LazyLock::new(|| {
        let wall = |ax, ay, bx, by| Wall::new(Vector2::new(ax, ay), Vector2::new(bx, by));
        [wall(2.0, -1.0, 3.0, 1.0), wall(5.0, -4.0, 5.0, 9.0), wall(-1e200, 3.0, -1e200, -3.0)]
    });
    let centre = IntervalBox::from([over(-1.0, 0.5), over(2.0, 2.0)]);
    let ring = Ring::new(centre, over(1.0, 30.0));
    let sector = Sector::new(centre, over(6.0, 7.0));
    let seen = WallRange::new(&*WALLS, over(-0.1, 0.2), over(1.0, 2.0));
    vec![
        Box::new(ring),
        Box::new(ring.complement()),
        Box::new(sector),
        Box::new(sector.complement()),
        Box::new(Square),
        Box::new(seen),
        Box::new(seen.complement()),
        Box::new(NothingSeen::new(&*WALLS, over(-0.1, 0.2), 100.0)),
        Box::new(Silence::new(WALLS[1], over(-0.01, 0.01), over(1.0, 2.0), 0.1)),
        Box::new(q_intersection([ring, Ring::new(centre, over(50.0, 60.0))], 1)),
        Box::new(ring.modulo(0, over(100.0, 100.0))),
        Box::new(ring.transformed(Translation { offset: centre }).union(sector)),
        Box::new(ring.then(sector).intersection(Square)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn in_the_plane((domain, part) in domain_and_part::<2>()) {
        for (index, contractor) in planar().iter().enumerate() {
            check_laws(contractor, domain, part).map_err(|error| TestCaseError::fail(format!("{index}: {error}")))?;
        }
    }

    #[test]
    fn among_more_variables(
        (three, part_of_three) in domain_and_part::<3>(),
        (four, part_of_four) in domain_and_part::<4>(),
        (five, part_of_five) in domain_and_part::<5>(),
    ) {
        for contractor in [&Sum as &dyn Contractor<3>, &Product, &Atan2, &Atan2Seed, &Ring::new(IntervalBox::from([Interval::ONE; 3]), over(1.0, 9.0))] {
            check_laws(contractor, three, part_of_three)?;
        }
        check_laws(&Polar, four, part_of_four)?;
        let after = Rotation.contract(five);
        prop_assert!(after.is_subset_of(&five) && Rotation.contract(part_of_five).is_subset_of(&part_of_five));
    }

    #[test]
    fn a_fixpoint_only_goes_further((domain, _) in domain_and_part::<2>()) {
        let contractor = Ring::new(IntervalBox::from([Interval::ZERO; 2]), over(1.0, 2.0)).then(Square);
        prop_assert!(contractor.fixpoint(0.01).contract(domain).is_subset_of(&contractor.contract(domain)));
    }
}

#[test]
fn three_ranges_find_a_position() {
    let ring = |x: f64, y: f64, lower, upper| {
        Ring::new(IntervalBox::centred(&Vector2::new(x, y), 0.0), over(lower, upper))
    };
    // The three beacons of the benchmark problem.
    let system = ring(3.0, 3.0, 3.0, 4.0)
        .then(ring(-3.0, -1.0, 5.0, 6.0))
        .then(ring(-2.0, 2.0, 4.0, 5.0))
        .fixpoint(0.01);
    let found = system.contract(IntervalBox::from([over(-10.0, 10.0); 2]));
    let inside: SVector<f64, 2> = Vector2::new(2.3, -0.4);
    assert!(found.contains(&inside) && found.sides().iter().all(|side| side.width() < 4.0), "{found:.2}");
}
