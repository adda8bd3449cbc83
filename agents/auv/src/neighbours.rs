//! Who is around, by the last ping heard from each.

use nalgebra::Vector3;
use shoal_bus::message::{AuvId, BoundsBox, Fleetmates, Sense, Sensed, box_width};
use shoal_bus::ping::{Frame, GaussianPing, Ping};
use shoal_bus::time::LocalTime;

/// One neighbour as its last ping showed it: middles of intervals or means, for steering, never for enclosures.
#[derive(Clone, Copy, Debug)]
struct Neighbour {
    auv: AuvId,
    heard: LocalTime,
    emission_s: f64,
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    box_width_m: f64,
}

impl Neighbour {
    /// The one that a frame shows, if it shows any: most say intervals, and only their middles count.
    fn heard(frame: &Frame, heard: LocalTime) -> Option<Self> {
        let Ok(ping) = Ping::decode(frame) else {
            return GaussianPing::decode(frame).ok().map(|ping| Self {
                auv: ping.sender,
                heard,
                emission_s: ping.emission_s,
                position_m: ping.position_m.into(),
                velocity_m_s: ping.velocity_m_s.into(),
                box_width_m: box_width(&ping.position_box_m()),
            });
        };
        let middle = |sides: BoundsBox| Vector3::from(sides.map(|side| side.mid()));
        Some(Self {
            auv: ping.sender,
            heard,
            emission_s: ping.emission_s.mid(),
            position_m: middle(ping.position_m),
            velocity_m_s: middle(ping.velocity_m_s),
            box_width_m: box_width(&ping.position_m),
        })
    }
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
    /// In the order of their ids.
    last: Vec<Neighbour>,
}

impl Neighbours {
    /// Takes in the pings of one tick and forgets who has been silent for `forget_ns` local nanoseconds. A ping that arrived before
    /// the last one known of its sender, and is told after it, says nothing new.
    pub fn listen(&mut self, sensed: &Sensed, forget_ns: i64) {
        for event in &sensed.events {
            let Sense::Heard { frame } = &event.sense else { continue };
            let Some(neighbour) = Neighbour::heard(frame, event.stamp) else { continue };
            match self.last.binary_search_by_key(&neighbour.auv, |last| last.auv) {
                Ok(known) if self.last[known].heard <= neighbour.heard => self.last[known] = neighbour,
                Ok(_) => {}
                Err(place) => self.last.insert(place, neighbour),
            }
        }
        self.last.retain(|neighbour| sensed.stamp - neighbour.heard <= forget_ns);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.last.len()
    }

    /// All neighbours as they should be at true time `time_s`, in the order of their ids.
    pub fn at(&self, time_s: f64) -> impl Iterator<Item = Predicted> {
        self.last.iter().map(move |neighbour| Predicted {
            auv: neighbour.auv,
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

#[cfg(test)]
mod tests {
    use shoal_bus::message::{Bounds, Event};

    use super::*;

    #[test]
    fn the_last_ping_is_the_one_that_arrived_last() {
        let mut neighbours = Neighbours::default();
        let mut hear = |stamp_ns: i64, east_m: f64| {
            let ping = Ping {
                sender: AuvId(4),
                sequence: 0,
                emission_s: Bounds::default(),
                position_m: [Bounds::new(east_m, east_m), Bounds::default(), Bounds::default()],
                velocity_m_s: [Bounds::default(); 3],
            };
            let sense = Sense::Heard { frame: ping.encode().unwrap() };
            let events = vec![Event { stamp: LocalTime::from_ns(stamp_ns), sense }];
            neighbours.listen(&Sensed { tick: 0, stamp: LocalTime::from_ns(1_000), events }, 500);
            neighbours.at(0.0).next().map(|neighbour| neighbour.position_m.x)
        };
        assert_eq!(hear(700, 1.0), Some(1.0));
        // A long packet that began to arrive earlier is told later.
        assert_eq!(hear(600, 2.0), Some(1.0));
        assert_eq!(hear(800, 3.0), Some(3.0));
        assert_eq!(hear(800, 4.0), Some(4.0));
    }

    #[test]
    fn a_believer_in_gaussians_is_a_neighbour_like_any_other() {
        let ping = GaussianPing {
            sender: AuvId(4),
            sequence: 0,
            emission_s: 10.0,
            position_m: [100.0, 0.0, -8.0],
            covariance: [4.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1e-6],
            velocity_m_s: [1.5, 0.0, 0.0],
        };
        let events =
            vec![Event { stamp: LocalTime::ZERO, sense: Sense::Heard { frame: ping.encode().unwrap() } }];
        let mut neighbours = Neighbours::default();
        neighbours.listen(&Sensed { tick: 0, stamp: LocalTime::ZERO, events }, 500);
        let there = neighbours.at(12.0).next().unwrap();
        assert_eq!((there.auv, there.position_m), (AuvId(4), Vector3::new(103.0, 0.0, -8.0)));
        // Three standard deviations to either side, and what rounding outwards adds.
        assert!((12.0..14.0).contains(&there.box_width_m), "{}", there.box_width_m);
    }

    #[test]
    fn silence_is_counted_from_the_arrival() {
        let mut neighbours = Neighbours::default();
        let listen = |neighbours: &mut Neighbours, stamp_ns: i64, events: Vec<Event>| {
            neighbours.listen(&Sensed { tick: 0, stamp: LocalTime::from_ns(stamp_ns), events }, 500);
            neighbours.count()
        };
        let ping = Ping {
            sender: AuvId(4),
            sequence: 0,
            emission_s: Bounds::default(),
            position_m: [Bounds::default(); 3],
            velocity_m_s: [Bounds::default(); 3],
        };
        let sense = Sense::Heard { frame: ping.encode().unwrap() };
        let heard = Event { stamp: LocalTime::from_ns(400), sense };
        // A packet so long that its beginning is already forgotten says nothing of the present.
        assert_eq!(listen(&mut neighbours, 1_000, vec![heard.clone()]), 0);
        assert_eq!(listen(&mut neighbours, 900, vec![heard]), 1);
        assert_eq!(listen(&mut neighbours, 901, Vec::new()), 0);
    }
}
