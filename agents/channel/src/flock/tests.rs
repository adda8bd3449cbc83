//! Tests of the figures of flocks, against what is known of small ones.

use nalgebra::DMatrix;
use proptest::prelude::*;

use super::*;

#[test]
fn separation_is_the_closest_pair_and_a_touch_counts_once() {
    let mut flock = Flock::default();
    let far = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(5.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
    flock.sample(&far, &[1.0; 3]);
    let lately = |flock: &mut Flock| flock.figures_lately(&Flying::default());
    assert_eq!(lately(&mut flock).min_separation_m, Some(4.0));
    let near = [far[0], Vec3::new(0.5, 0.0, 0.0), far[2]];
    flock.sample(&near, &[1.0; 3]);
    flock.sample(&near, &[1.0; 3]);
    flock.sample(&far, &[1.0; 3]);
    let figures = lately(&mut flock);
    assert_eq!((figures.min_separation_m, figures.collisions), (Some(0.5), 1));
    // The first stands for the time since it was asked for, the other for the run.
    flock.sample(&far, &[1.0; 3]);
    assert_eq!(lately(&mut flock).min_separation_m, Some(4.0));
    assert_eq!(flock.figures(&Flying::default()).min_separation_m, Some(0.5));
}

#[test]
fn alignment_and_connectivity_of_known_flocks() {
    let north = Vec3::new(0.0, 2.0, 0.0);
    assert_eq!(polarization(&[north, north * 3.0]), 1.0);
    assert_eq!(polarization(&[north, -north]), 0.0);
    // One hears the other, who does not hear it: half of all pairs, but no link.
    let links = Links::between(&[Vec3::zeros(), Vec3::new(10.0, 0.0, 0.0)], &[10.0, 5.0]);
    assert_eq!((links.fraction(), links.components(), links.largest_component()), (0.5, 2, 1));
    assert_eq!(algebraic_connectivity(&links), Some(0.0));
    let alone = Flock::default().figures(&[(north, north, 9.0)].into_iter().collect());
    assert_eq!((alone.components, alone.largest_component, alone.algebraic_connectivity), (1, 1, Some(0.0)));
    let nobody = Flock::default().figures(&Flying::default());
    assert_eq!(
        (nobody.components, nobody.largest_component, nobody.algebraic_connectivity),
        (0, 0, Some(0.0))
    );
}

#[test]
fn sampling_times_do_not_depend_on_windows() {
    let at = |from, to| Flock::samples(SimTime::from_ns(from), SimTime::from_ns(to)).collect::<Vec<_>>();
    let whole = at(0, 1_000_000_000);
    let split: Vec<_> = (0..100).flat_map(|i| at(i * 10_000_000, (i + 1) * 10_000_000)).collect();
    assert_eq!(whole, split);
    assert_eq!(whole.len(), 10);
    assert_eq!(whole.iter().filter(|&&at| Flock::is_second(at)).count(), 1);
}

/// Graphs whose algebraic connectivity is known in closed form (Fiedler 1973, 3.2 to 3.4).
#[test]
fn algebraic_connectivity_of_known_graphs() {
    let found = |places_m: &[Vec3], range_m: f64| {
        algebraic_connectivity(&Links::between(places_m, &vec![range_m; places_m.len()])).unwrap()
    };
    let close = |found: f64, expected: f64| (found - expected).abs() <= 2e-6 * expected;
    let turn = |part: f64| pxfm::f_cos(2.0 * std::f64::consts::PI * part);
    for count in [2_u32, 3, 4, 7, 20, 60, 200] {
        let n = f64::from(count);
        let line: Vec<Vec3> = (0..count).map(|i| Vec3::new(f64::from(i), 0.0, 0.0)).collect();
        let path = found(&line, 1.2);
        assert!(close(path, 2.0 * (1.0 - turn(0.5 / n))), "path of {count}: {path}");
        let complete = found(&line, n);
        assert!(close(complete, n), "complete graph of {count}: {complete}");
        if count > 2 {
            let ring: Vec<Vec3> = (0..count)
                .map(|i| {
                    let (sin, cos) = pxfm::f_sincos(2.0 * std::f64::consts::PI * f64::from(i) / n);
                    Vec3::new(cos, sin, 0.0)
                })
                .collect();
            let neighbours_m = (ring[0] - ring[1]).norm();
            let cycle = found(&ring, 1.01 * neighbours_m);
            assert!(close(cycle, 2.0 * (1.0 - turn(1.0 / n))), "cycle of {count}: {cycle}");
        }
    }
    // Six arms, none of which reaches another.
    let arm = |axis: usize, side: f64| Vec3::from_fn(|i, _| if i == axis { side } else { 0.0 });
    let ends = (0..3).flat_map(|axis| [arm(axis, 1.0), arm(axis, -1.0)]);
    let star: Vec<Vec3> = std::iter::once(Vec3::zeros()).chain(ends).collect();
    assert!(close(found(&star, 1.1), 1.0));
    let apart: Vec<Vec3> = star.iter().map(|place| place + Vec3::repeat(100.0)).chain(star.clone()).collect();
    let two = Links::between(&apart, &vec![1.1; apart.len()]);
    assert_eq!((two.components(), two.largest_component(), algebraic_connectivity(&two)), (2, 7, Some(0.0)));
}

#[test]
fn a_survey_grid_is_as_connected_as_theory_says() {
    // A product of two paths: the least of both (Fiedler 1973, 3.4).
    let grid: Vec<Vec3> = (0..3_000).map(|i| Vec3::new(f64::from(i % 60), f64::from(i / 60), 0.0)).collect();
    let found = algebraic_connectivity(&Links::between(&grid, &vec![1.2; grid.len()])).unwrap();
    let expected = 2.0 * (1.0 - pxfm::f_cos(std::f64::consts::PI / 60.0));
    assert!((found - expected).abs() <= 1e-5 * expected, "{found} for {expected}");
}

/// The Laplacian as a whole.
fn dense(graph: &Graph) -> DMatrix<f64> {
    let count = graph.vertices();
    let mut matrix = DMatrix::zeros(count, count);
    for column in 0..count {
        let unit: Vec<f64> = (0..count).map(|row| f64::from(row == column)).collect();
        let mut product = vec![0.0; count];
        graph.laplacian(&unit, &mut product);
        product.iter().enumerate().for_each(|(row, value)| matrix[(row, column)] = *value);
    }
    matrix
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Components and algebraic connectivity of random swarms are what the eigenvalues of the whole matrix say.
    #[test]
    fn random_swarms_are_as_connected_as_their_eigenvalues_say(
        places in prop::collection::vec([0.0..100.0_f64, 0.0..100.0, 0.0..30.0], 2..40),
        range_m in 15.0..80.0_f64,
    ) {
        let places_m: Vec<Vec3> = places.into_iter().map(Vec3::from).collect();
        let range_m: Vec<f64> = (0..places_m.len()).map(|i| range_m + (i % 3) as f64 * 5.0).collect();
        let links = Links::between(&places_m, &range_m);
        let pairs = || (0..places_m.len()).flat_map(|a| (0..places_m.len()).map(move |b| (a, b)));
        let reached = pairs().filter(|&(a, b)| a != b && (places_m[a] - places_m[b]).norm() <= range_m[a]);
        let all = places_m.len() * (places_m.len() - 1);
        prop_assert_eq!(links.fraction(), reached.count() as f64 / all as f64);
        let mut eigenvalues: Vec<f64> = dense(links.graph().unwrap()).symmetric_eigenvalues().iter().copied().collect();
        eigenvalues.sort_by(f64::total_cmp);
        let zeros = eigenvalues.iter().filter(|value| value.abs() < 1e-9).count();
        prop_assert_eq!(links.components() as usize, zeros);
        let found = algebraic_connectivity(&links).unwrap();
        prop_assert!((found - eigenvalues[1].max(0.0)).abs() <= 1e-5 * found + 1e-9, "{found} {eigenvalues:?}");
    }
}
