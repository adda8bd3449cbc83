//! What is read is what was written, rounded outwards.

use proptest::prelude::*;

use super::super::{Payload, Ping};
use super::*;
use crate::message::Bounds;

fn ping(covariance: [f64; 10]) -> GaussianPing {
    GaussianPing {
        sender: AuvId(513),
        sequence: 255,
        emission_s: 1.25,
        position_m: [1.0, -2.0, 3.0],
        covariance,
        velocity_m_s: [0.5, -1.5, 0.0],
    }
}

/// Whether a symmetric matrix, given by its upper triangle, has no negative eigenvalue: all pivots of its elimination are positive.
fn is_positive(triangle: &[f64; 10]) -> bool {
    let mut of: [[f64; 4]; 4] =
        std::array::from_fn(|i| std::array::from_fn(|j| triangle[ROWS[i.min(j)] + i.max(j) - i.min(j)]));
    for pivot in 0..4 {
        if of[pivot][pivot] <= 0.0 {
            return false;
        }
        for row in pivot + 1..4 {
            let part = of[row][pivot] / of[pivot][pivot];
            let above = of[pivot];
            of[row].iter_mut().zip(above).for_each(|(entry, above)| *entry -= part * above);
        }
    }
    true
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    /// Covariances `G G'` of all sizes, some almost singular, with means and velocities of all sizes.
    #[test]
    fn the_covariance_is_rounded_outwards_and_the_rest_to_the_nearest(
        of in prop::array::uniform16(-1.0..1.0_f64),
        octaves in prop::array::uniform4(-8.0..8.0_f64),
        position_m in prop::array::uniform3(-9_000.0..9_000.0_f64),
        velocity_m_s in prop::array::uniform3(-12.0..12.0_f64),
        emission_s in -1e6..1e6_f64,
    ) {
        let scale = |axis: usize| {
            let unit = if axis == 3 { 1e-3 } else { 1.0 };
            power_of_two(octaves[axis] as i32) * unit
        };
        let entry = |(i, j): (usize, usize)| {
            (0..4).map(|k| of[4 * i + k] * of[4 * j + k]).sum::<f64>() * scale(i) * scale(j)
        };
        let mut covariance = [0.0; 10];
        (0..4).for_each(|i| (i..4).for_each(|j| covariance[ROWS[i] + j - i] = entry((i, j))));
        let original = GaussianPing { emission_s, position_m, velocity_m_s, ..ping(covariance) };
        let heard = GaussianPing::decode(&original.encode().unwrap()).unwrap();
        prop_assert_eq!((heard.sender, heard.sequence), (original.sender, original.sequence));
        prop_assert!((heard.emission_s - emission_s).abs() <= power_of_two(-21));
        let (error_m, error_m_s) = (9_000.0 / power_of_two(23), 12.0 / power_of_two(7));
        for axis in 0..3 {
            prop_assert!((heard.position_m[axis] - position_m[axis]).abs() <= error_m);
            prop_assert!((heard.velocity_m_s[axis] - velocity_m_s[axis]).abs() <= error_m_s);
        }
        let more: [f64; 10] = std::array::from_fn(|entry| heard.covariance[entry] - covariance[entry]);
        prop_assert!(is_positive(&more), "{covariance:?} became {:?}", heard.covariance);
        for (axis, least) in [2e-3, 2e-3, 2e-3, 1e-6].into_iter().enumerate() {
            let (sent, read) = (covariance[ROWS[axis]].sqrt(), heard.covariance[ROWS[axis]].sqrt());
            prop_assert!(read <= 1.15 * (sent + least), "{read} of {sent}");
        }
    }
}

#[test]
fn a_frame_is_read_as_what_it_is() {
    let certain = ping([0.0; 10]).encode().unwrap();
    assert_eq!(certain.bytes().len(), FRAME_BYTES);
    assert_eq!(Ping::decode(&certain), Err(FrameError::Kind(3)));
    let Payload::Gaussian(heard) = Payload::decode(&certain).unwrap() else { panic!("it is a Gaussian") };
    assert_eq!((heard.position_m, heard.velocity_m_s), ([1.0, -2.0, 3.0], [0.5, -1.5, 0.0]));
    assert!(heard.covariance[0].sqrt() < 1e-3 && heard.covariance[9].sqrt() < 1e-6);

    let moment = Bounds::new(0.0, 1.0);
    let intervals = Ping {
        sender: AuvId(1),
        sequence: 0,
        emission_s: moment,
        position_m: [moment; 3],
        velocity_m_s: [moment; 3],
    };
    let frame = intervals.encode().unwrap();
    assert_eq!(GaussianPing::decode(&frame), Err(FrameError::Kind(2)));
    assert_eq!(Payload::decode(&frame), Ok(Payload::Intervals(intervals)));
    assert_eq!(Payload::decode(&Frame::new(&[0xff; 31]).unwrap()), Err(FrameError::Kind(7)));
}

#[test]
fn what_does_not_fit_is_refused() {
    let refused = |ping: GaussianPing| matches!(ping.encode(), Err(FrameError::TooLarge { .. }));
    let mut negative = [0.0; 10];
    negative[4] = -1.0;
    assert!(refused(ping(negative)) && refused(ping([f64::NAN; 10])) && refused(ping([1e30; 10])));
    assert!(refused(GaussianPing { emission_s: f64::INFINITY, ..ping([0.0; 10]) }));
    assert!(refused(GaussianPing { position_m: [f64::NAN; 3], ..ping([0.0; 10]) }));
    assert!(refused(GaussianPing { velocity_m_s: [1e9; 3], ..ping([0.0; 10]) }));
    let crowd = GaussianPing { sender: AuvId(70_000), ..ping([0.0; 10]) };
    assert_eq!(crowd.encode(), Err(FrameError::Sender(AuvId(70_000))));
}
