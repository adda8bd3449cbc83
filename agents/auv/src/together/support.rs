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
const CHANGES: usize = 16;
/// What is violated by less metres is not.
const TOLERANCE_M: f64 = 1e-3;
/// A side that moves by less than this part of the width of the box is not worth it.
const WORTH: f64 = 0.01;

/// What is proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reach {
    /// No point has a larger coordinate, by the sign given.
    AtMost(f64),
    /// There is no point at all: these planes contradict each other.
    Nothing([Option<usize>; 5]),
}

/// How far points go that are on the right side of all planes: there is nothing to be gained there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached {
    lower: Vector4<f64>,
    upper: Vector4<f64>,
    last: Vector4<f64>,
}

impl Reached {
    pub fn nowhere() -> Self {
        Self {
            lower: Vector4::repeat(f64::INFINITY),
            upper: Vector4::repeat(f64::NEG_INFINITY),
            last: Vector4::zeros(),
        }
    }

    fn add(&mut self, point: &Vector4<f64>) {
        self.last = *point;
        (self.lower, self.upper) = (self.lower.inf(point), self.upper.sup(point));
    }

    /// Whether a point was found so near the side of the box that moving that would not be worth it.
    pub fn is_near(&self, frame: &Frame, axis: usize, sign: f64) -> bool {
        let near = WORTH * (frame.upper[axis] - frame.lower[axis]);
        if sign > 0.0 {
            self.upper[axis] >= frame.upper[axis] - near
        } else {
            self.lower[axis] <= frame.lower[axis] + near
        }
    }
}

/// The largest `sign * q[axis]` of a point of the box on the right side of all planes.
pub(super) fn reach(
    planes: &[HalfSpace],
    frame: &Frame,
    axis: usize,
    sign: f64,
    reached: &mut Reached,
) -> Reach {
    let mut corner = Corner::of_box(frame, axis, sign, reached);
    for _ in 0..CHANGES {
        let Some(violated) = corner.most_violated(planes, frame) else {
            reached.add(&corner.point);
            break;
        };
        let weights = violated.entering.weights(&corner.edges, planes);
        if !corner.change(&violated, &weights) {
            // The four push against it; zero is at most something negative.
            let used = corner.sides.iter().zip(&weights).map(|(&side, &weight)| (side, -weight));
            let used = used.chain([(violated.entering, 1.0)]);
            if bound(planes, frame, &Vector4::zeros(), used) < 0.0 {
                return Reach::Nothing(corner.rings(&violated, planes));
            }
            break;
        }
    }
    let mut goal = Vector4::zeros();
    goal[axis] = sign;
    let used = corner.sides.iter().zip(&corner.multipliers).map(|(&side, &multiplier)| (side, multiplier));
    Reach::AtMost(bound(planes, frame, &goal, used))
}

/// One of the half-spaces: a plane by its index, or a side of the box.
#[derive(Clone, Copy, Debug)]
enum Side {
    Plane(usize),
    Box { axis: usize, sign: f64 },
}

impl Side {
    /// Its normal as a sum of the normals of four others, which `edges` is the inverse of.
    fn weights(self, edges: &Matrix4<f64>, planes: &[HalfSpace]) -> Vector4<f64> {
        match self {
            Self::Plane(index) => edges.tr_mul(&planes[index].normal),
            Self::Box { axis, sign } => edges.row(axis).transpose() * sign,
        }
    }
}

/// What a point is on the wrong side of.
struct Violated {
    entering: Side,
    /// By so much.
    excess_m: f64,
}

/// A point where four sides meet.
struct Corner {
    point: Vector4<f64>,
    /// The inverse of the matrix whose rows are the normals of the four.
    edges: Matrix4<f64>,
    sides: [Side; 4],
    multipliers: Vector4<f64>,
}

impl Corner {
    /// A corner of the box on the side sought, and on the sides that the last point was near.
    fn of_box(frame: &Frame, axis: usize, sign: f64, reached: &Reached) -> Self {
        let mut signs = (reached.last * 2.0 - frame.lower - frame.upper).map(f64::signum);
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
            sides: std::array::from_fn(|axis| Side::Box { axis, sign: signs[axis] }),
            multipliers,
        }
    }

    fn most_violated(&self, planes: &[HalfSpace], frame: &Frame) -> Option<Violated> {
        let mut worst = None;
        let mut excess_m = TOLERANCE_M;
        for (index, plane) in planes.iter().enumerate() {
            let beyond_m = plane.normal.dot(&self.point) - plane.bound;
            if beyond_m > excess_m {
                (worst, excess_m) = (Some(Side::Plane(index)), beyond_m);
            }
        }
        for axis in 0..4 {
            let above_m = self.point[axis] - frame.upper[axis];
            let below_m = frame.lower[axis] - self.point[axis];
            if above_m.max(below_m) > excess_m {
                let sign = if above_m > below_m { 1.0 } else { -1.0 };
                (worst, excess_m) = (Some(Side::Box { axis, sign }), above_m.max(below_m));
            }
        }
        worst.map(|entering| Violated { entering, excess_m })
    }

    /// Lets a side take the place of one of the four; false when there is none that it could take.
    fn change(&mut self, violated: &Violated, weights: &Vector4<f64>) -> bool {
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
            let along = self.edges.column(place) - edge * weights[place];
            self.edges.set_column(place, &along);
        }
        self.edges.set_column(leaving, &edge);
        self.point -= edge * violated.excess_m;
        self.multipliers -= weights * least;
        self.multipliers[leaving] = least;
        self.sides[leaving] = violated.entering;
        true
    }

    /// The rings whose planes meet here or are violated here.
    fn rings(&self, violated: &Violated, planes: &[HalfSpace]) -> [Option<usize>; 5] {
        let [one, two, three, four] = self.sides;
        [one, two, three, four, violated.entering].map(|side| match side {
            Side::Plane(index) => Some(planes[index].ring),
            Side::Box { .. } => None,
        })
    }
}

/// The largest `goal q` that multiples of some planes allow; a multiple that is not positive proves nothing and is left out, and
/// the sides of the box are accounted for by what the planes leave of the goal.
fn bound(
    planes: &[HalfSpace],
    frame: &Frame,
    goal: &Vector4<f64>,
    used: impl Iterator<Item = (Side, f64)>,
) -> f64 {
    let mut rest = *goal;
    let mut magnitudes = goal.abs();
    let (mut total, mut magnitude) = (0.0, 0.0);
    for (side, multiplier) in used {
        let Side::Plane(index) = side else { continue };
        if multiplier > 0.0 {
            let plane = &planes[index];
            rest -= plane.normal * multiplier;
            magnitudes += plane.normal.abs() * multiplier;
            total += plane.bound * multiplier;
            magnitude += plane.bound.abs() * multiplier;
        }
    }
    for axis in 0..4 {
        magnitude += magnitudes[axis] * frame.upper[axis].max(-frame.lower[axis]);
    }
    total + frame.most(&rest) + SLACK * magnitude
}
