//! Speed of sound over depth.
//!
//! ```
//! use shoal_channel::acoustics::profile::{Node, Profile};
//!
//! let node = |depth_m, speed_m_s| Node { depth_m, speed_m_s };
//! let profile = Profile::new(&[node(0.0, 1520.0), node(20.0, 1520.0), node(60.0, 1500.0)])?;
//! assert_eq!(profile.speed_m_s(40.0), 1510.0);
//! assert_eq!(profile.speed_m_s(500.0), 1500.0);
//! assert_eq!(profile.speed_bounds_m_s(0.0, 40.0), (1510.0, 1520.0));
//! # Ok::<(), shoal_channel::acoustics::profile::ProfileError>(())
//! ```

mod named;
#[cfg(test)]
mod tests;

use thiserror::Error;

/// Nodes closer to each other than this are one depth stated twice, in metres.
const LEAST_SPACING_M: f64 = 1e-3;
/// Deepest (and highest) node that is accepted, in metres: a thousand times deeper than any sea.
const GREATEST_DEPTH_M: f64 = 1e7;
/// Speeds of sound that are accepted, in m/s: far beyond all water, and no product of a few of them overflows.
const SPEEDS_M_S: std::ops::RangeInclusive<f64> = 1.0..=1e5;

/// The speed of sound at one depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Depth below the surface in metres.
    pub depth_m: f64,
    /// Speed of sound in m/s.
    pub speed_m_s: f64,
}

/// Speed of sound over depth: linear between nodes, constant above the first and below the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    nodes: Vec<Node>,
    /// Of the layer above each node, and of the layer below the last: one more than nodes, zero at both ends, in 1/s.
    gradients_1_s: Vec<f64>,
    slowest_m_s: f64,
    fastest_m_s: f64,
}

/// Why nodes are no profile.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ProfileError {
    /// There is no node.
    #[error("the sound speed profile has no nodes: give at least one depth and speed")]
    Empty,
    /// A depth is no number, or absurd.
    #[error("node {index} of the sound speed profile lies at a depth of {depth_m} m: give depths in metres")]
    Depth {
        /// Which node, from 0.
        index: usize,
        /// Its depth.
        depth_m: f64,
    },
    /// A depth does not exceed the one before by a millimetre.
    #[error(
        "node {index} of the sound speed profile lies at {depth_m} m, its predecessor at {previous_m} m: \
         depths must increase from node to node"
    )]
    Order {
        /// Which node, from 0.
        index: usize,
        /// Its depth.
        depth_m: f64,
        /// The depth of the node before.
        previous_m: f64,
    },
    /// A speed is no speed of sound.
    #[error(
        "node {index} of the sound speed profile has a speed of {speed_m_s} m/s: sound in water travels at \
         about 1,400 to 1,600 m/s"
    )]
    Speed {
        /// Which node, from 0.
        index: usize,
        /// Its speed.
        speed_m_s: f64,
    },
}

impl Profile {
    /// The profile through `nodes`.
    ///
    /// # Errors
    /// There must be nodes, each depth must exceed the one before (by a millimetre), each speed must be that of a sound
    /// (between 1 m/s and 100 km/s, so that no computation can fail).
    pub fn new(nodes: &[Node]) -> Result<Self, ProfileError> {
        if nodes.is_empty() {
            return Err(ProfileError::Empty);
        }
        for (index, &Node { depth_m, speed_m_s }) in nodes.iter().enumerate() {
            if depth_m.is_nan() || depth_m.abs() > GREATEST_DEPTH_M {
                return Err(ProfileError::Depth { index, depth_m });
            }
            if !SPEEDS_M_S.contains(&speed_m_s) {
                return Err(ProfileError::Speed { index, speed_m_s });
            }
        }
        for (before, pair) in nodes.windows(2).enumerate() {
            let (previous_m, depth_m) = (pair[0].depth_m, pair[1].depth_m);
            if depth_m - previous_m < LEAST_SPACING_M {
                return Err(ProfileError::Order { index: before + 1, depth_m, previous_m });
            }
        }
        Ok(Self::through(nodes.to_vec()))
    }

    /// The same speed at every depth.
    ///
    /// # Errors
    /// As for [`Profile::new`].
    pub fn uniform(speed_m_s: f64) -> Result<Self, ProfileError> {
        Self::new(&[Node { depth_m: 0.0, speed_m_s }])
    }

    /// The profile through nodes that are known to be fine.
    fn through(nodes: Vec<Node>) -> Self {
        let slope =
            |pair: &[Node]| (pair[1].speed_m_s - pair[0].speed_m_s) / (pair[1].depth_m - pair[0].depth_m);
        let gradients_1_s = [0.0].into_iter().chain(nodes.windows(2).map(slope)).chain([0.0]).collect();
        let speeds = || nodes.iter().map(|node| node.speed_m_s);
        let slowest_m_s = speeds().fold(f64::INFINITY, f64::min);
        let fastest_m_s = speeds().fold(0.0, f64::max);
        Self { nodes, gradients_1_s, slowest_m_s, fastest_m_s }
    }

    /// The same water, faster by `by_m_s` at every depth: what a speed known within bounds settles to, or a bound of it.
    ///
    /// # Errors
    /// [`ProfileError::Speed`] when a speed would no longer be that of a sound.
    pub fn shifted_m_s(&self, by_m_s: f64) -> Result<Self, ProfileError> {
        let shifted: Vec<Node> = self
            .nodes
            .iter()
            .map(|node| Node { depth_m: node.depth_m, speed_m_s: node.speed_m_s + by_m_s })
            .collect();
        Self::new(&shifted)
    }

    /// The nodes, from the highest to the deepest.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Speed of sound at a depth, in m/s. Exactly a node's at the node.
    pub fn speed_m_s(&self, depth_m: f64) -> f64 {
        self.level(depth_m).speed_m_s
    }

    /// Least and greatest speed of sound between two depths, in m/s.
    pub fn speed_bounds_m_s(&self, shallowest_m: f64, deepest_m: f64) -> (f64, f64) {
        let (top, bottom) =
            (self.level(shallowest_m.min(deepest_m)), self.level(deepest_m.max(shallowest_m)));
        let ends = (top.speed_m_s.min(bottom.speed_m_s), top.speed_m_s.max(bottom.speed_m_s));
        self.nodes_between(&top, &bottom)
            .iter()
            .fold(ends, |(least, greatest), node| (least.min(node.speed_m_s), greatest.max(node.speed_m_s)))
    }

    /// Least and greatest speed of sound anywhere, in m/s.
    pub(super) fn extremes_m_s(&self) -> (f64, f64) {
        (self.slowest_m_s, self.fastest_m_s)
    }

    /// A depth, the speed there, and the layers it belongs to.
    #[inline]
    pub(super) fn level(&self, depth_m: f64) -> Level {
        let mut layer_below = 0;
        for node in &self.nodes {
            if node.depth_m > depth_m {
                break;
            }
            layer_below += 1;
        }
        // A profile has nodes, so the indices of both are in range.
        let base = self.nodes[layer_below.max(1) - 1];
        let gradient_1_s = self.gradients_1_s[layer_below];
        // The constant water above and below is infinite, and zero times infinity no speed.
        let rise_m_s = if gradient_1_s == 0.0 { 0.0 } else { gradient_1_s * (depth_m - base.depth_m) };
        let speed_m_s = base.speed_m_s + rise_m_s;
        let layer_above = if base.depth_m == depth_m { layer_below - 1 } else { layer_below };
        Level { depth_m, speed_m_s, layer_above, layer_below }
    }

    /// The level of the node that bounds `layer` from below, if there is one.
    pub(super) fn node_below(&self, layer: usize) -> Option<Level> {
        let &Node { depth_m, speed_m_s } = self.nodes.get(layer)?;
        Some(Level { depth_m, speed_m_s, layer_above: layer, layer_below: layer + 1 })
    }

    /// The level of the node that bounds `layer` from above, if there is one.
    pub(super) fn node_above(&self, layer: usize) -> Option<Level> {
        self.node_below(layer.checked_sub(1)?)
    }

    /// The nodes strictly between two levels.
    #[inline]
    pub(super) fn nodes_between(&self, top: &Level, bottom: &Level) -> &[Node] {
        self.nodes.get(top.layer_below..bottom.layer_above).unwrap_or(&[])
    }

    /// The gradients of the layers between two levels, one more than nodes between them, in 1/s.
    #[inline]
    pub(super) fn gradients_between_1_s(&self, top: &Level, bottom: &Level) -> &[f64] {
        self.gradients_1_s.get(top.layer_below..=bottom.layer_above).unwrap_or(&[])
    }

    /// The gradient of a layer, in 1/s.
    #[inline]
    pub(super) fn gradient_1_s(&self, layer: usize) -> f64 {
        self.gradients_1_s.get(layer).copied().unwrap_or(0.0)
    }
}

/// A depth in a profile. Layer `i` lies above node `i`; a level at a node has two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::acoustics) struct Level {
    pub(super) depth_m: f64,
    pub(super) speed_m_s: f64,
    pub(super) layer_above: usize,
    pub(super) layer_below: usize,
}
