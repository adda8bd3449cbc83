//! The best line for a function that bends one way only.

use super::Form;
use crate::expression::unary::Unary;
use crate::interval::Interval;

/// The functions that bend one way only, for which the best line is known: parallel to the chord, half-way to the tangent.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Bend {
    Square,
    SquareRoot,
    Exponential,
    Logarithm,
    Absolute,
    /// On one side of zero.
    Reciprocal,
}

impl Bend {
    /// How the function bends, when it is one of these.
    pub(super) fn of(function: Unary) -> Option<Bend> {
        match function {
            Unary::Square => Some(Bend::Square),
            Unary::SquareRoot => Some(Bend::SquareRoot),
            Unary::Exponential => Some(Bend::Exponential),
            Unary::Logarithm => Some(Bend::Logarithm),
            Unary::Absolute => Some(Bend::Absolute),
            _ => None,
        }
    }

    /// Encloses the function between two lines that are parallel to its chord over the range of `x`.
    ///
    /// The slope and the point of contact are computed without care: any slope gives an enclosure, and any tangent
    /// line is below a convex function and above a concave one. Only the distance between the lines has to be safe.
    pub(super) fn linearise<const N: usize>(
        self,
        x: &Form<N>,
        range: Interval,
        image: impl Fn(Interval) -> Interval,
        derivative: impl Fn(Interval) -> Interval,
    ) -> Form<N> {
        let point = |value: f64| Interval::spanning(value, value);
        let (from, to) = (x.range.lower(), x.range.upper());
        let (at_from, at_to) = (image(point(from)), image(point(to)));
        let chord = (at_to.mid() - at_from.mid()) / (to - from);
        let contact = point(self.contact(chord, x.range).clamp(from, to));
        let slope = point(chord);
        let at_ends = (at_from - slope * from) | (at_to - slope * to);
        // At the kink of an absolute value, the line itself is a tangent.
        let tangents = derivative(contact);
        let tangent = if self == Bend::Absolute && slope.is_subset_of(tangents) { slope } else { tangents };
        let at_contact = image(contact) - tangent * contact + (tangent - slope) * x.range;
        if !chord.is_finite() || !at_ends.is_bounded() || !at_contact.is_bounded() {
            return Form::remainder(range);
        }
        let (lower, upper) = if self.is_convex(x.range) {
            (at_contact.lower(), at_ends.upper())
        } else {
            (at_ends.lower(), at_contact.upper())
        };
        let Ok(remainder) = Interval::new(lower, upper) else {
            return Form::remainder(range);
        };
        x.scaled(slope, remainder, range)
    }

    fn is_convex(self, x: Interval) -> bool {
        match self {
            Bend::Square | Bend::Exponential | Bend::Absolute => true,
            Bend::SquareRoot | Bend::Logarithm => false,
            Bend::Reciprocal => x.lower() > 0.0,
        }
    }

    /// About where in `x` the function has this slope.
    fn contact(self, slope: f64, x: Interval) -> f64 {
        match self {
            Bend::Square => slope / 2.0,
            Bend::SquareRoot => 0.25 / (slope * slope),
            Bend::Exponential => pxfm::f_log(slope),
            Bend::Logarithm => 1.0 / slope,
            Bend::Absolute => 0.0,
            Bend::Reciprocal => (-1.0 / slope).sqrt().copysign(x.lower()),
        }
    }
}
