//! What a test of a whole box can find.

/// How a set of vectors lies to a set that is asked about.
///
/// Both certain answers are proofs, rounding included. [`Undecided`](Membership::Undecided) proves nothing: the box may
/// straddle the border, or the test may be too coarse to see on which side it is.
///
/// Source: seed 001, section 2.4; seed 002, section 3.5.3 (the inclusion test).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Membership {
    /// Every vector is in the set.
    Inside,
    /// No vector is in the set.
    Outside,
    /// Neither could be proved.
    Undecided,
}
