//! The ways that sound takes, and how they look in every figure.

use crate::figure::Colour;

/// A way from emitter to receiver, as far as figures tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// Through the water.
    Direct,
    /// Off the surface.
    Surface,
    /// Off the bottom.
    Bottom,
    /// Off both.
    Both,
}

impl Way {
    /// The way of a path as records name it; none is named where only the direct one is heard.
    pub fn of(path: Option<&str>) -> Self {
        match path {
            None | Some("direct") => Self::Direct,
            Some("surface") => Self::Surface,
            Some("bottom") => Self::Bottom,
            Some(_) => Self::Both,
        }
    }

    /// The way after one more bounce, off the surface or else off the bottom.
    pub fn bounced(self, is_surface: bool) -> Self {
        match self {
            Self::Direct if is_surface => Self::Surface,
            Self::Direct => Self::Bottom,
            _ => Self::Both,
        }
    }

    /// As legends say it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Surface => "off the surface",
            Self::Bottom => "off the bottom",
            Self::Both => "off surface and bottom",
        }
    }

    /// As figures show it.
    pub fn colour(self) -> Colour {
        match self {
            Self::Direct => Colour::Blue,
            Self::Surface => Colour::Vermillion,
            Self::Bottom => Colour::Green,
            Self::Both => Colour::Purple,
        }
    }
}
