//! Marks and their colours.

/// A colour of Okabe and Ito's palette, or a grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Colour {
    /// Black.
    Black,
    /// Middle grey.
    Grey,
    /// Pale grey, for what is behind.
    Pale,
    /// Blue.
    Blue,
    /// Sky blue.
    Sky,
    /// Bluish green.
    Green,
    /// Yellow.
    Yellow,
    /// Orange.
    Orange,
    /// Vermillion.
    Vermillion,
    /// Reddish purple.
    Purple,
}

impl Colour {
    /// As SVG writes it.
    pub fn code(self) -> &'static str {
        match self {
            Self::Black => "#000000",
            Self::Grey => "#7f7f7f",
            Self::Pale => "#e4e4e4",
            Self::Blue => "#0072b2",
            Self::Sky => "#56b4e9",
            Self::Green => "#009e73",
            Self::Yellow => "#f0e442",
            Self::Orange => "#e69f00",
            Self::Vermillion => "#d55e00",
            Self::Purple => "#cc79a7",
        }
    }
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// A filled circle.
    Disc,
    /// An empty circle.
    Ring,
    /// A filled square.
    Square,
    /// A filled triangle that points up.
    Triangle,
    /// A filled diamond.
    Diamond,
    /// A diagonal cross.
    Cross,
    /// An upright cross.
    Plus,
}

impl Shape {
    /// All shapes.
    pub const ALL: [Self; 7] =
        [Self::Disc, Self::Ring, Self::Square, Self::Triangle, Self::Diamond, Self::Cross, Self::Plus];

    /// Its name inside a figure.
    pub fn name(self) -> &'static str {
        match self {
            Self::Disc => "disc",
            Self::Ring => "ring",
            Self::Square => "square",
            Self::Triangle => "triangle",
            Self::Diamond => "diamond",
            Self::Cross => "cross",
            Self::Plus => "plus",
        }
    }

    /// Its outline around the origin, in pixels.
    pub fn outline(self) -> &'static str {
        match self {
            Self::Disc => "M-2.6 0a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0 -5.2 0z",
            Self::Ring => "M-3.2 0a3.2 3.2 0 1 0 6.4 0a3.2 3.2 0 1 0 -6.4 0z",
            Self::Square => "M-2.4 -2.4h4.8v4.8h-4.8z",
            Self::Triangle => "M0 -3.4L3.1 2.2H-3.1z",
            Self::Diamond => "M0 -3.4L3.4 0L0 3.4L-3.4 0z",
            Self::Cross => "M-3 -3L3 3M-3 3L3 -3",
            Self::Plus => "M-3.6 0H3.6M0 -3.6V3.6",
        }
    }

    /// Whether it is drawn with lines rather than filled.
    pub fn is_drawn(self) -> bool {
        matches!(self, Self::Ring | Self::Cross | Self::Plus)
    }
}

/// How a point is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mark {
    /// Its shape.
    pub shape: Shape,
    /// Its colour.
    pub colour: Colour,
}

impl Mark {
    /// A mark of a shape and a colour.
    pub const fn new(shape: Shape, colour: Colour) -> Self {
        Self { shape, colour }
    }
}
