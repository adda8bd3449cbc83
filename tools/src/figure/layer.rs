//! What is drawn between the axes of a panel.

use super::{Colour, Mark};

/// One kind of thing that is drawn. Coordinates are those of the axes; what has one that is not finite is left out.
#[derive(Clone, Debug, PartialEq)]
pub enum Layer {
    /// A mark at each point.
    Marks {
        /// How.
        mark: Mark,
        /// Where.
        points: Vec<[f64; 2]>,
    },
    /// Bars between two values of x and two of y.
    Bars {
        /// In which colour.
        colour: Colour,
        /// `[x1, x2, y1, y2]` of each.
        bars: Vec<[f64; 4]>,
    },
    /// Outlines between two values of x and two of y.
    Boxes {
        /// In which colour.
        colour: Colour,
        /// `[x1, x2, y1, y2]` of each.
        boxes: Vec<[f64; 4]>,
    },
    /// A polygon: a lower bound from left to right, and as many corners of an upper one back.
    Area {
        /// In which colour.
        colour: Colour,
        /// Its corners.
        corners: Vec<[f64; 2]>,
    },
    /// Straight lines from point to point.
    Line {
        /// In which colour.
        colour: Colour,
        /// The points.
        points: Vec<[f64; 2]>,
    },
    /// Straight lines between two points each.
    Segments {
        /// In which colour.
        colour: Colour,
        /// The two ends of each.
        ends: Vec<[[f64; 2]; 2]>,
    },
    /// Arcs from point to point, as of a ray.
    Arcs {
        /// In which colour.
        colour: Colour,
        /// The points, with the direction of the curve.
        turns: Vec<Turn>,
    },
}

/// A point of a curve of arcs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Where.
    pub at: [f64; 2],
    /// Direction of the curve, a vector of length one in the units of the axes, which must be the same.
    pub direction: [f64; 2],
}

impl Layer {
    /// A circle, for axes of the same units.
    pub fn circle(colour: Colour, centre: [f64; 2], radius: f64) -> Self {
        const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
        const DIRECTIONS: [[f64; 2]; 9] = [
            [1.0, 0.0],
            [HALF, HALF],
            [0.0, 1.0],
            [-HALF, HALF],
            [-1.0, 0.0],
            [-HALF, -HALF],
            [0.0, -1.0],
            [HALF, -HALF],
            [1.0, 0.0],
        ];
        let turn = |[x, y]: [f64; 2]| Turn {
            at: [centre[0] + radius * x, centre[1] + radius * y],
            direction: [-y, x],
        };
        Self::Arcs { colour, turns: DIRECTIONS.map(turn).to_vec() }
    }
}

impl Turn {
    /// The two points that control the cubic curve from here to `next`, as near to an arc of a circle as one can be: its
    /// error falls with the sixth power of the angle.
    pub fn controls(&self, next: &Self) -> [[f64; 2]; 2] {
        let chord: [f64; 2] = std::array::from_fn(|axis| next.at[axis] - self.at[axis]);
        let length = (chord[0] * chord[0] + chord[1] * chord[1]).sqrt();
        let cosine = (self.direction[0] * next.direction[0] + self.direction[1] * next.direction[1]).min(1.0);
        // For an arc of angle a and radius r the controls stand 4/3 tan(a/4) r off, the chord is 2 sin(a/2) r long.
        let half = (0.5 * (1.0 + cosine)).max(0.0).sqrt();
        let off = length / (1.5 * (1.0 + half));
        [
            std::array::from_fn(|axis| self.at[axis] + off * self.direction[axis]),
            std::array::from_fn(|axis| next.at[axis] - off * next.direction[axis]),
        ]
    }
}
