//! How well a function behaves on a whole box.

/// How well a function behaves on a set, from worst to best; of several, the smallest counts.
///
/// Source: IEEE 1788-2015, clause 11.2 (decorations `trv`, `def`, `dac`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Regularity {
    /// It may be undefined somewhere.
    Partial,
    /// It is defined everywhere, but it may jump.
    Defined,
    /// It is defined and continuous everywhere.
    Continuous,
}

impl Regularity {
    /// Continuous where `defined` holds, else partial.
    #[inline]
    pub(super) fn continuous_if(defined: bool) -> Regularity {
        if defined { Regularity::Continuous } else { Regularity::Partial }
    }
}
