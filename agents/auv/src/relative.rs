//! Relative localization: where the neighbours are, seen from here, without anyone's position (seed 002, chapter 5).
//!
//! Every ping tells a distance (by the clocks at both ends), a direction (by an ultra-short baseline array) or both, so it is a ring, a
//! sector or a piece of a ring around the place of its reception: equation (5.8). From then on the body moves, known by its own log
//! and compass, and so does the neighbour, known by its commands or velocities when it tells them and else only by its greatest speed:
//! equation (5.7). All sightings of a horizon, carried to the present, are contracted together ([`Track`]); the last one alone is what a
//! swarm without memory has.
//!
//! # The frame
//! East and north from the body, as long as it has a compass: only moved along with the body, never turned, so no turn of the body
//! widens what is known. The error of the compass enters with each bearing. [`ahead_and_port_m`] turns a box into the axes of the body.
//!
//! # In a run
//! A mind whose [orders](shoal_bus::message::Orders::relative) say so keeps a [`Neighbourhood`], and the channel holds what it reports
//! against the truth.
//!
//! # What is guaranteed
//! The relative position is inside, as long as every interval given holds its truth. Sightings that contradict each other are no
//! silent loss: [`Track::see`] says so and begins again from the last one.

mod fellow;
mod neighbourhood;
mod sighting;
#[cfg(test)]
mod tests;
mod track;

use shoal_interval::{Interval, IntervalBox};

pub use fellow::Fellow;
pub use neighbourhood::Neighbourhood;
pub use sighting::{Sighting, horizontal_m};
pub use track::Track;

/// A relative position in the axes of a body with this heading, in rad: metres ahead, and metres to port.
///
/// ```
/// use shoal_auv::relative::ahead_and_port_m;
/// use shoal_interval::{Interval, IntervalBox};
///
/// // 10 m to the north of a body that heads north.
/// let north_m = IntervalBox::from([Interval::ZERO, Interval::spanning(10.0, 10.0)]);
/// let seen_m = ahead_and_port_m(&north_m, Interval::HALF_PI);
/// assert!(seen_m[0].contains(10.0) && seen_m[1].contains(0.0) && seen_m.width() < 1e-12);
/// ```
pub fn ahead_and_port_m(position_m: &IntervalBox<2>, heading_rad: Interval) -> IntervalBox<2> {
    let (sin, cos) = heading_rad.sin_cos();
    let [east_m, north_m] = position_m.sides();
    IntervalBox::from([east_m * cos + north_m * sin, north_m * cos - east_m * sin])
}
