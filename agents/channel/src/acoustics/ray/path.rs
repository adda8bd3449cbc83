//! Ways from emitter to receiver, by what the sound bounces off.

/// What sound bounces off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Boundary {
    /// The sea surface, depth 0.
    Surface,
    /// The sea bottom.
    Bottom,
}

impl Boundary {
    /// The other one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Surface => Self::Bottom,
            Self::Bottom => Self::Surface,
        }
    }
}

/// How sound gets from emitter to receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SoundPath {
    /// Through the water alone.
    Direct,
    /// Off surface and bottom in turn.
    Bounced {
        /// The boundary that is met first.
        first: Boundary,
        /// How many bounces in all.
        bounces: u8,
    },
}

impl SoundPath {
    /// How often the path meets a boundary.
    ///
    /// ```
    /// use shoal_channel::acoustics::ray::{Boundary, SoundPath};
    ///
    /// let path = SoundPath::Bounced { first: Boundary::Bottom, bounces: 3 };
    /// assert_eq!((path.bounces_off(Boundary::Bottom), path.bounces_off(Boundary::Surface)), (2, 1));
    /// ```
    pub fn bounces_off(self, boundary: Boundary) -> u8 {
        match self {
            Self::Direct => 0,
            Self::Bounced { first, bounces } if first == boundary => bounces.div_ceil(2),
            Self::Bounced { bounces, .. } => bounces / 2,
        }
    }
}
