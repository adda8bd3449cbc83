//! Regular sub-pavings: unions of boxes that come from one box by bisection, kept as binary trees.

use super::PavingError;
use super::{InclusionTest, Options};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;
use crate::membership::Membership;
use nalgebra::SVector;
use thiserror::Error;

/// A set made of some of the boxes that come from a root box by bisection, always of the widest side.
///
/// Kept as a binary tree, whose leaves are in the set or not, so that union, intersection and inclusion walk two trees
/// side by side and take time in proportion to their nodes. Siblings that are both in or both out are always
/// reunited: equal sets have equal trees. Boxes are closed; set operations are right but for common faces of boxes, which
/// count as in the set when a box of it has them.
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::paving::{Options, SubPaving};
/// use shoal_interval::separator::Ring;
/// use shoal_interval::{Interval, IntervalBox};
///
/// let root = IntervalBox::from([Interval::new(-4.0, 4.0)?; 2]);
/// let options = Options::new(0.25);
/// let near = SubPaving::outer(&Ring::disc(Vector2::new(0.0, 0.0), 1.0), root, &options)?;
/// let far = SubPaving::inner(&Ring::disc(Vector2::new(0.0, 0.0), 3.0), root, &options)?;
/// assert!(near.is_subset_of(&far)?);
/// assert_eq!(near.union(&far)?, far);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: seed 001, section 2.4.1; Jaulin et al., *Applied Interval Analysis*, 2001, chapter 3.
#[derive(Debug, Clone, PartialEq)]
pub struct SubPaving<const N: usize> {
    root: IntervalBox<N>,
    /// The nodes; a branch comes after both of its children, so the last is that of the root.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Node {
    Out,
    In,
    Branch(usize, usize),
}

/// Why two sub-pavings could not be combined.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SubPavingError {
    /// Their root boxes differ, so their boxes do not come from the same bisections.
    #[error("sub-pavings of different boxes cannot be combined: {first} and {second}")]
    Roots {
        /// The root of the first.
        first: String,
        /// The root of the second.
        second: String,
    },
}

impl<const N: usize> SubPaving<N> {
    /// No box at all of `root`.
    pub fn empty(root: IntervalBox<N>) -> SubPaving<N> {
        SubPaving { root, nodes: vec![Node::Out] }
    }

    /// All of `root`.
    pub fn full(root: IntervalBox<N>) -> SubPaving<N> {
        let node = if root.is_empty() { Node::Out } else { Node::In };
        SubPaving { root, nodes: vec![node] }
    }

    /// The boxes that the test proves to be inside a set: an inner approximation.
    ///
    /// # Errors
    /// [`PavingError`] when the root is unbounded or the precision is not a positive number.
    pub fn inner(
        test: &(impl InclusionTest<N> + ?Sized),
        root: IntervalBox<N>,
        options: &Options<N>,
    ) -> Result<SubPaving<N>, PavingError> {
        SubPaving::tested(test, root, options, Node::Out)
    }

    /// The boxes that the test does not prove to be outside of a set: an outer approximation.
    ///
    /// When the budget of boxes runs out, whatever is left is in it undivided.
    ///
    /// # Errors
    /// [`PavingError`] when the root is unbounded or the precision is not a positive number.
    pub fn outer(
        test: &(impl InclusionTest<N> + ?Sized),
        root: IntervalBox<N>,
        options: &Options<N>,
    ) -> Result<SubPaving<N>, PavingError> {
        SubPaving::tested(test, root, options, Node::In)
    }

    /// The smallest regular sub-paving, with boxes of the given precision, that holds everything of `boxes` that is in
    /// `root`.
    ///
    /// # Errors
    /// [`PavingError`] when the root is unbounded or the precision is not a positive number.
    pub fn covering(
        boxes: &[IntervalBox<N>],
        root: IntervalBox<N>,
        options: &Options<N>,
    ) -> Result<SubPaving<N>, PavingError> {
        let test = super::from_test_fn(|domain: &IntervalBox<N>| {
            // Sharing a face is not enough to be covered, unless the box has nothing but that face.
            let overlaps = |part: &IntervalBox<N>| {
                (0..N).all(|axis| {
                    let shared = domain[axis] & part[axis];
                    !shared.is_empty()
                        && (!shared.is_point() || part[axis].is_point() || domain[axis].is_point())
                })
            };
            if boxes.iter().any(|part| domain.is_subset_of(part)) {
                Membership::Inside
            } else if boxes.iter().any(overlaps) {
                Membership::Undecided
            } else {
                Membership::Outside
            }
        });
        SubPaving::outer(&test, root, options)
    }

    fn tested(
        test: &(impl InclusionTest<N> + ?Sized),
        root: IntervalBox<N>,
        options: &Options<N>,
        undecided: Node,
    ) -> Result<SubPaving<N>, PavingError> {
        options.check(&root)?;
        let mut tree = SubPaving { root, nodes: Vec::new() };
        let mut budget = options.budget();
        if root.is_empty() {
            return Ok(SubPaving::empty(root));
        }
        tree.grow(test, root, options, undecided, &mut budget);
        Ok(tree)
    }

    /// Adds the nodes of `domain` and returns the last. The depth is limited by how often a box can be bisected.
    fn grow(
        &mut self,
        test: &(impl InclusionTest<N> + ?Sized),
        domain: IntervalBox<N>,
        options: &Options<N>,
        undecided: Node,
        budget: &mut usize,
    ) -> usize {
        if *budget == 0 {
            return self.leaf(undecided);
        }
        *budget -= 1;
        match test.test(&domain) {
            Membership::Inside => self.leaf(Node::In),
            Membership::Outside => self.leaf(Node::Out),
            Membership::Undecided => {
                let halves = if options.is_fine(&domain, &domain) { None } else { domain.bisect() };
                let Some((first, second)) = halves else {
                    return self.leaf(undecided);
                };
                let first = self.grow(test, first, options, undecided, budget);
                let second = self.grow(test, second, options, undecided, budget);
                self.branch(first, second)
            }
        }
    }

    fn leaf(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Adds the parent of two nodes; if both are leaves of one kind, they give way to one such leaf.
    fn branch(&mut self, first: usize, second: usize) -> usize {
        let (one, other) = (self.nodes[first], self.nodes[second]);
        if one == other && !matches!(one, Node::Branch(..)) {
            // Two leaves in a row are the last two nodes.
            self.nodes.truncate(first);
            return self.leaf(one);
        }
        self.leaf(Node::Branch(first, second))
    }

    /// The box whose bisections the boxes come from.
    pub fn root(&self) -> IntervalBox<N> {
        self.root
    }

    /// The boxes of the set, from the lower to the upper end of the axis that each bisection cut.
    pub fn boxes(&self) -> Vec<IntervalBox<N>> {
        let mut boxes = Vec::new();
        self.visit(self.top(), self.root, &mut |domain| boxes.push(domain));
        boxes
    }

    /// The volume of the set, rounded outwards.
    pub fn volume(&self) -> Interval {
        let mut volume = Interval::ZERO;
        self.visit(self.top(), self.root, &mut |domain| volume += domain.volume_enclosure());
        volume
    }

    /// Whether no box is in the set.
    pub fn is_empty(&self) -> bool {
        self.nodes[self.top()] == Node::Out
    }

    /// How many nodes the tree has.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Whether `point` is in a box of the set.
    pub fn contains(&self, point: &SVector<f64, N>) -> bool {
        let at = IntervalBox::from(std::array::from_fn(|axis| Interval::spanning(point[axis], point[axis])));
        self.root.contains(point) && self.any(self.top(), self.root, &at)
    }

    /// Whether all of `part` is in the set.
    pub fn contains_box(&self, part: &IntervalBox<N>) -> bool {
        part.is_subset_of(&self.root) && self.covers(self.top(), self.root, part)
    }

    /// Everything that is in one of the sets.
    ///
    /// # Errors
    /// [`SubPavingError`] when the roots differ.
    pub fn union(&self, other: &SubPaving<N>) -> Result<SubPaving<N>, SubPavingError> {
        self.combined(other, |one, other| one || other)
    }

    /// Everything that is in a box of both sets.
    ///
    /// # Errors
    /// [`SubPavingError`] when the roots differ.
    pub fn intersection(&self, other: &SubPaving<N>) -> Result<SubPaving<N>, SubPavingError> {
        self.combined(other, |one, other| one && other)
    }

    /// The boxes of this set that are not in the other.
    ///
    /// # Errors
    /// [`SubPavingError`] when the roots differ.
    pub fn difference(&self, other: &SubPaving<N>) -> Result<SubPaving<N>, SubPavingError> {
        self.combined(other, |one, other| one && !other)
    }

    /// Whether every box of this set is in the other.
    ///
    /// # Errors
    /// [`SubPavingError`] when the roots differ.
    pub fn is_subset_of(&self, other: &SubPaving<N>) -> Result<bool, SubPavingError> {
        Ok(self.difference(other)?.is_empty())
    }

    fn combined(
        &self,
        other: &SubPaving<N>,
        keep: impl Fn(bool, bool) -> bool + Copy,
    ) -> Result<SubPaving<N>, SubPavingError> {
        if self.root != other.root && !(self.root.is_empty() && other.root.is_empty()) {
            return Err(SubPavingError::Roots {
                first: self.root.to_string(),
                second: other.root.to_string(),
            });
        }
        let mut tree = SubPaving { root: self.root, nodes: Vec::new() };
        tree.merge((self, self.top()), (other, other.top()), keep);
        Ok(tree)
    }

    fn merge(
        &mut self,
        (one, at): (&SubPaving<N>, usize),
        (other, other_at): (&SubPaving<N>, usize),
        keep: impl Fn(bool, bool) -> bool + Copy,
    ) -> usize {
        // A leaf is as good as a branch whose children are both that leaf.
        let children = |node: Node, at: usize| match node {
            Node::Branch(first, second) => (first, second),
            _ => (at, at),
        };
        let (node, other_node) = (one.nodes[at], other.nodes[other_at]);
        if let (Node::In | Node::Out, Node::In | Node::Out) = (node, other_node) {
            let kept = keep(node == Node::In, other_node == Node::In);
            return self.leaf(if kept { Node::In } else { Node::Out });
        }
        let (first, second) = children(node, at);
        let (other_first, other_second) = children(other_node, other_at);
        let first = self.merge((one, first), (other, other_first), keep);
        let second = self.merge((one, second), (other, other_second), keep);
        self.branch(first, second)
    }

    fn top(&self) -> usize {
        // Every constructor adds a node.
        self.nodes.len() - 1
    }

    fn visit(&self, at: usize, domain: IntervalBox<N>, visitor: &mut impl FnMut(IntervalBox<N>)) {
        match self.nodes[at] {
            Node::Out => {}
            Node::In => visitor(domain),
            Node::Branch(first, second) => {
                // A branch stands for a box that was bisected, so it can be again.
                if let Some((low, high)) = domain.bisect() {
                    self.visit(first, low, visitor);
                    self.visit(second, high, visitor);
                }
            }
        }
    }

    /// Whether a box of the set meets `part`, which is in the root.
    fn any(&self, at: usize, domain: IntervalBox<N>, part: &IntervalBox<N>) -> bool {
        match self.nodes[at] {
            _ if (domain & *part).is_empty() => false,
            Node::Out => false,
            Node::In => true,
            Node::Branch(first, second) => domain
                .bisect()
                .is_some_and(|(low, high)| self.any(first, low, part) || self.any(second, high, part)),
        }
    }

    /// Whether the set holds all of `part` that is in `domain`.
    fn covers(&self, at: usize, domain: IntervalBox<N>, part: &IntervalBox<N>) -> bool {
        let shared = domain & *part;
        match self.nodes[at] {
            _ if shared.is_empty() => true,
            Node::In => true,
            // Only a common face: what is behind it, or the neighbour that it belongs to as well, decides.
            Node::Out => (0..N).any(|axis| shared[axis].is_point() && !part[axis].is_point()),
            Node::Branch(first, second) => domain.bisect().is_some_and(|(low, high)| {
                let (in_first, in_second) = (self.covers(first, low, part), self.covers(second, high, part));
                // What lies in the common face of both halves is there as soon as one half holds it.
                if shared == low & shared && shared == high & shared {
                    in_first || in_second
                } else {
                    in_first && in_second
                }
            }),
        }
    }
}
