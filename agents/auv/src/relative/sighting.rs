//! One ping as it bears on where its sender is now.

use shoal_interval::contractor::{Contractor, contract_polar};
use shoal_interval::{Interval, IntervalBox};

/// A neighbour seen once: from where the receiver was at the reception to where the emitter was at the emission.
///
/// That vector p is known by its length, its direction or both. With w, what the neighbour moved since the emission less what the
/// body moved since the reception, the neighbour is now at `r = p + w`: a sighting stays useful as long as w is narrow.
///
/// As a [`Contractor`] it stands for the relative positions that it allows now. Minimal for a w that is exactly known.
///
/// ```
/// use shoal_auv::relative::Sighting;
/// use shoal_interval::contractor::Contractor;
/// use shoal_interval::{Interval, IntervalBox};
///
/// // Seen 100 m to the north; since then the neighbour went 10 m to the east.
/// let mut seen = Sighting::new(Interval::centred(100.0, 5.0), Interval::centred(1.5708, 0.1));
/// seen.carry(&IntervalBox::from([Interval::spanning(10.0, 10.0), Interval::ZERO]));
/// let now_m = seen.contract(IntervalBox::from([Interval::spanning(-500.0, 500.0); 2]));
/// assert_eq!(format!("{now_m:.1}"), "[-0.5, 20.5] x [94.5, 105.0]");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sighting {
    range_m: Interval,
    bearing_rad: Interval,
    since_m: IntervalBox<2>,
}

impl Sighting {
    /// A neighbour seen just now at a horizontal distance, in metres, and in a direction counter-clockwise from east, in rad; either is
    /// [`Interval::ENTIRE`] when it was not measured.
    pub fn new(range_m: Interval, bearing_rad: Interval) -> Self {
        Self { range_m, bearing_rad, since_m: IntervalBox::from([Interval::ZERO; 2]) }
    }

    /// The neighbour moved by `moved_m` more than the body, in metres east and north.
    pub fn carry(&mut self, moved_m: &IntervalBox<2>) {
        self.since_m += *moved_m;
    }
}

impl Contractor<2> for Sighting {
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        let ([mut x, mut y], mut range_m, mut bearing_rad) =
            ((domain - self.since_m).sides(), self.range_m, self.bearing_rad);
        contract_polar(&mut x, &mut y, &mut range_m, &mut bearing_rad);
        // What was not contracted is not to be widened; the intersection sees to that.
        (IntervalBox::from([x, y]) + self.since_m) & domain
    }
}

/// The horizontal distance, in metres, of two points at a distance in `range_m` one of which is by `vertical_m` above the other;
/// empty when there are none.
///
/// ```
/// use shoal_auv::relative::horizontal_m;
/// use shoal_interval::Interval;
///
/// let range_m = horizontal_m(Interval::spanning(5.0, 13.0), Interval::spanning(-3.0, 0.0));
/// assert_eq!(format!("{range_m:.6}"), "[4.000000, 13.000000]");
/// ```
pub fn horizontal_m(range_m: Interval, vertical_m: Interval) -> Interval {
    let range_m = range_m.intersection(Interval::NON_NEGATIVE);
    (range_m.sqr() - vertical_m.sqr()).intersection(Interval::NON_NEGATIVE).sqrt()
}
