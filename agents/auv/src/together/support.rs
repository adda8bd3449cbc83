//! How far a polyhedron in a box reaches along an axis, at most.
//!
//! By the dual simplex method: from a corner of the box, the plane that is violated most takes the place of one of the four that
//! meet in the corner. Whatever is done in plain floating point, the multipliers y >= 0 that it ends with prove a bound:
//! `g q = y A q + (g - y A) q <= y b + max over the box of (g - y A) q`
//! (A. Neumaier and O. Shcherbina, *Safe bounds in linear and mixed-integer linear programming*, Mathematical Programming 99,
//! 2004, section 2).

use nalgebra::{Matrix4, Vector4};

use super::half_space::{Frame, HalfSpace, SLACK};

/// More changes of a plane than are ever worth it.
const CHANGES: usize = 12;
/// What is violated by less metres is not.
const TOLERANCE_M: f64 = 1e-3;
const NO_PLANE: usize = usize::MAX;

/// What is proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reach {
    /// No point has a larger coordinate, by the sign given.
    AtMost(f64),
    /// There is no point at all: these planes contradict each other.
    Nothing([Option<usize>; 5]),
}

/// The largest `sign * q[axis]` of a point of the box on the right side of all planes.
pub(super) fn reach(planes: &[HalfSpace], frame: &Frame, axis: usize, sign: f64) -> Reach {
    let mut goal = Vector4::zeros();
    goal[axis] = sign;
    let mut corner = Corner::of_box(frame, axis, sign);
    for _ in 0..CHANGES {
        let Some((entering, excess)) = corner.most_violated(planes) else { break };
        if !corner.change(planes, entering, excess) {
            return corner.nothing(planes, frame, entering).unwrap_or(corner.proved(planes, frame, &goal));
        }
    }
    corner.proved(planes, frame, &goal)
}

/// A point where four planes meet, some of them sides of the box.
struct Corner {
    point: Vector4<f64>,
    /// The inverse of the matrix whose rows are the normals of the four.
    edges: Matrix4<f64>,
    /// Which planes they are.
    planes: [usize; 4],
    multipliers: Vector4<f64>,
}

impl Corner {
    fn of_box(frame: &Frame, axis: usize, sign: f64) -> Self {
        let mut signs = Vector4::repeat(-1.0);
        signs[axis] = sign;
        let mut multipliers = Vector4::zeros();
        multipliers[axis] = 1.0;
        Self {
            point: Vector4::from_fn(
                |axis, _| {
                    if signs[axis] > 0.0 { frame.upper[axis] } else { frame.lower[axis] }
                },
            ),
            edges: Matrix4::from_diagonal(&signs),
            planes: [NO_PLANE; 4],
            multipliers,
        }
    }

    fn most_violated(&self, planes: &[HalfSpace]) -> Option<(usize, f64)> {
        let mut worst = (NO_PLANE, TOLERANCE_M);
        for (index, plane) in planes.iter().enumerate() {
            let excess = plane.normal.dot(&self.point) - plane.bound;
            if excess > worst.1 {
                worst = (index, excess);
            }
        }
        (worst.0 != NO_PLANE).then_some(worst)
    }

    /// Lets a plane take the place of one of the four; false when there is none that it could take.
    fn change(&mut self, planes: &[HalfSpace], entering: usize, excess: f64) -> bool {
        let weights = self.edges.tr_mul(&planes[entering].normal);
        let mut leaving = None;
        let mut least = f64::INFINITY;
        for place in 0..4 {
            let ratio = self.multipliers[place] / weights[place];
            if weights[place] > 1e-9 && ratio < least {
                (leaving, least) = (Some(place), ratio);
            }
        }
        let Some(leaving) = leaving else { return false };
        let edge = self.edges.column(leaving) / weights[leaving];
        for place in 0..4 {
            if place == leaving {
                self.edges.set_column(place, &edge);
            } else {
                let along = self.edges.column(place) - edge * weights[place];
                self.edges.set_column(place, &along);
            }
        }
        self.point -= edge * excess;
        self.multipliers -= weights * least;
        self.multipliers[leaving] = least;
        self.planes[leaving] = entering;
        true
    }

    /// The bound that the multipliers prove.
    fn proved(&self, planes: &[HalfSpace], frame: &Frame, goal: &Vector4<f64>) -> Reach {
        let used = self.planes.iter().zip(&self.multipliers).map(|(&plane, &multiplier)| (plane, multiplier));
        Reach::AtMost(bound(planes, frame, goal, used))
    }

    /// The proof that there is no point, when `entering` pushes the corner away from all four planes.
    fn nothing(&self, planes: &[HalfSpace], frame: &Frame, entering: usize) -> Option<Reach> {
        let weights = self.edges.tr_mul(&planes[entering].normal);
        let used = self.planes.iter().zip(&weights).map(|(&plane, &weight)| (plane, -weight));
        let used = used.chain([(entering, 1.0)]);
        // Zero is at most something negative.
        if bound(planes, frame, &Vector4::zeros(), used) >= 0.0 {
            return None;
        }
        let mut guilty = [None; 5];
        guilty[0] = Some(planes[entering].ring);
        for (place, &plane) in self.planes.iter().enumerate() {
            guilty[place + 1] = planes.get(plane).map(|plane| plane.ring);
        }
        Some(Reach::Nothing(guilty))
    }
}

/// The largest `goal q` that multiples of some planes allow; a multiple that is not positive proves nothing and is left out.
fn bound(
    planes: &[HalfSpace],
    frame: &Frame,
    goal: &Vector4<f64>,
    used: impl Iterator<Item = (usize, f64)>,
) -> f64 {
    let mut rest = *goal;
    let mut magnitudes = goal.abs();
    let (mut total, mut magnitude) = (0.0, 0.0);
    for (plane, multiplier) in used {
        // A side of the box has no index, and is accounted for by the rest.
        let Some(plane) = planes.get(plane).filter(|_| multiplier > 0.0) else { continue };
        rest -= plane.normal * multiplier;
        magnitudes += plane.normal.abs() * multiplier;
        total += plane.bound * multiplier;
        magnitude += plane.bound.abs() * multiplier;
    }
    for axis in 0..4 {
        magnitude += magnitudes[axis] * frame.upper[axis].max(-frame.lower[axis]);
    }
    total + frame.most(&rest) + SLACK * magnitude
}
