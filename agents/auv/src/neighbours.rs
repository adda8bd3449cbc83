//! Who is around, by the last ping heard from each.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use shoal_bus::message::{AuvId, Fleetmates, Sense, Sensed, box_width};
use shoal_bus::ping::Ping;
use shoal_bus::time::LocalTime;

/// One neighbour as its last ping showed it: middles of intervals, for steering, never for enclosures.
#[derive(Clone, Copy, Debug)]
struct Neighbour {
    heard: LocalTime,
    emission_s: f64,
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    box_width_m: f64,
}

/// Where a neighbour should be now.
#[derive(Clone, Copy, Debug)]
pub struct Predicted {
    /// Who.
    pub auv: AuvId,
    /// Middle of its position box, moved on with its velocity since its ping left, in metres.
    pub position_m: Vector3<f64>,
    /// Middle of its velocity box, in m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Width of its position box, in metres.
    pub box_width_m: f64,
}

/// The neighbours heard lately.
#[derive(Debug, Default)]
pub struct Neighbours {
    last: BTreeMap<AuvId, Neighbour>,
}

impl Neighbours {
    /// Takes in the pings of one tick and forgets who has been silent for `forget_ns` local nanoseconds.
    pub fn listen(&mut self, sensed: &Sensed, forget_ns: i64) {
        for event in &sensed.events {
            let Sense::Heard { frame } = &event.sense else { continue };
            let Ok(ping) = Ping::decode(frame) else { continue };
            let middle =
                |bounds: [shoal_bus::message::Bounds; 3]| Vector3::from(bounds.map(|side| side.mid()));
            let neighbour = Neighbour {
                heard: event.stamp,
                emission_s: ping.emission_s.mid(),
                position_m: middle(ping.position_m),
                velocity_m_s: middle(ping.velocity_m_s),
                box_width_m: box_width(&ping.position_m),
            };
            self.last.insert(ping.sender, neighbour);
        }
        self.last.retain(|_, neighbour| sensed.stamp - neighbour.heard <= forget_ns);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.last.len()
    }

    /// All neighbours as they should be at true time `time_s`, in the order of their ids.
    pub fn at(&self, time_s: f64) -> impl Iterator<Item = Predicted> {
        self.last.iter().map(move |(&auv, neighbour)| Predicted {
            auv,
            position_m: neighbour.position_m + neighbour.velocity_m_s * (time_s - neighbour.emission_s),
            velocity_m_s: neighbour.velocity_m_s,
            box_width_m: neighbour.box_width_m,
        })
    }
}

/// Whether one of these fleets has `auv`.
pub fn trusted(fleets: &[Fleetmates], auv: AuvId) -> bool {
    fleets.iter().any(|fleet| fleet.contains(auv))
}
