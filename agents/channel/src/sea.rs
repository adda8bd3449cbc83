//! Sound at level `sea`: every packet takes every path that is loud enough to every receiver, and meets there whatever else
//! is in the water.

mod crossing;
mod listener;

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Boundary, Fate, LossReason, SoundPath};
use shoal_scenario::model::{PhysicalLayer, Scenario, Sea as SeaModel};

use crate::acoustics::density::sea_water_density_kg_m3;
use crate::acoustics::ray::{Ray, WaterColumn};
use crate::acoustics::reflection::{FluidBottom, SurfaceLoss};
use crate::budget::Link;
use crate::grid::Grid;
use crate::medium::Recipient;
use crate::sound::{Flight, Told, Wavefront, Wavefronts};
use crate::vehicle::Vehicle;

pub use self::listener::Listener;

/// The sea, and every modem's way with every other.
pub struct Sea {
    water: SeaWater,
    /// `links[emitter's group][receiver's group]`.
    links: Vec<Vec<Option<Link>>>,
    /// How far the loudest modem matters, in metres.
    farthest_m: f64,
    layers: Vec<Option<PhysicalLayer>>,
    paths: Vec<SoundPath>,
}

/// What sound meets on its way, whoever sends it.
pub(crate) struct SeaWater {
    /// The layers, surface and bottom.
    pub(crate) column: WaterColumn,
    /// Least speed of sound anywhere, in m/s.
    pub(crate) slowest_m_s: f64,
    density_kg_m3: f64,
    bottom: FluidBottom,
    surface: SurfaceLoss,
}

impl SeaWater {
    /// The ray of a path and what its bounces cost at this frequency, in dB.
    fn ray(
        &self,
        path: SoundPath,
        depths_m: [f64; 2],
        range_m: f64,
        frequency_khz: f64,
    ) -> Option<(Ray, f64)> {
        let ray = self.column.ray(path, depths_m[0], depths_m[1], range_m, None)?;
        let mut loss_db = 0.0;
        for boundary in [Boundary::Surface, Boundary::Bottom] {
            let bounces = path.bounces_off(boundary);
            if bounces == 0 {
                continue;
            }
            let speed_m_s = self.column.speed_at_m_s(boundary);
            let grazing = ray.grazing(speed_m_s);
            let grazing_rad = pxfm::f_atan2(grazing.sin, grazing.cos);
            let bounce_db = match boundary {
                Boundary::Surface => self.surface.loss_db(frequency_khz, grazing_rad),
                Boundary::Bottom => self.bottom.loss_db(self.density_kg_m3, speed_m_s, grazing_rad),
            };
            loss_db += f64::from(bounces) * bounce_db;
        }
        Some((ray, loss_db))
    }

    /// No ray of this path is shorter than this, in metres: the straight line to the image of the receiver.
    fn shortest_m(&self, path: SoundPath, depths_m: [f64; 2], range_m: f64) -> f64 {
        let [from_m, to_m] = depths_m;
        let bottom_m = self.column.bottom_depth_m();
        let vertical_m = match path {
            SoundPath::Direct => from_m - to_m,
            SoundPath::Bounced { first, bounces } => {
                let leg_m = |boundary, depth_m: f64| match boundary {
                    Boundary::Surface => depth_m,
                    Boundary::Bottom => bottom_m - depth_m,
                };
                let last = if bounces % 2 == 1 { first } else { first.other() };
                leg_m(first, from_m) + f64::from(bounces.saturating_sub(1)) * bottom_m + leg_m(last, to_m)
            }
        };
        (range_m * range_m + vertical_m * vertical_m).sqrt()
    }
}

/// All paths with up to so many bounces, the direct one first.
fn paths(bounces_max: u8) -> Vec<SoundPath> {
    let bounced = (1..=bounces_max).flat_map(|bounces| {
        [Boundary::Surface, Boundary::Bottom].map(|first| SoundPath::Bounced { first, bounces })
    });
    std::iter::once(SoundPath::Direct).chain(bounced).collect()
}

/// A packet that, as is clear when it leaves, will never be decoded there.
fn lost(number: u64, wavefront: &Wavefront, to: AuvId, reason: LossReason, range_m: f64) -> Told {
    let fate = Fate::lost(Some(to), reason, range_m);
    Told { at: wavefront.emitted, wavefront: number, fate, stamp: None, incidence: None }
}

/// The link between two groups; none when either's modem has no physical layer.
fn link(sea: &SeaModel, emitter: Option<&PhysicalLayer>, receiver: Option<&PhysicalLayer>) -> Option<Link> {
    Some(Link::new(sea, emitter?, receiver?))
}

impl Sea {
    /// The sea of a run. Every group's modem has a physical layer.
    pub fn new(scenario: &Scenario, sea: &SeaModel, column: &WaterColumn) -> Self {
        // A validated scenario has a physical layer for every group at level `sea`; a group without one would be mute and deaf.
        let layers: Vec<_> = scenario.groups.iter().map(|group| group.modem.physical).collect();
        let links: Vec<Vec<Option<Link>>> = layers
            .iter()
            .map(|emitter| {
                layers.iter().map(|receiver| link(sea, emitter.as_ref(), receiver.as_ref())).collect()
            })
            .collect();
        let farthest_m = links.iter().flatten().flatten().fold(0.0, |far: f64, link| far.max(link.floor_m));
        let (slowest_m_s, _) = column.profile().speed_bounds_m_s(f64::NEG_INFINITY, f64::INFINITY);
        Self {
            water: SeaWater {
                slowest_m_s,
                density_kg_m3: sea_water_density_kg_m3(sea.temperature_c, sea.salinity_psu),
                bottom: FluidBottom {
                    density_kg_m3: sea.bottom.density_kg_m3,
                    sound_speed_m_s: sea.bottom.sound_speed_m_s,
                    attenuation_db_per_wavelength: sea.bottom.attenuation_db_wavelength,
                },
                surface: match sea.surface_loss_db {
                    Some(loss_db) => SurfaceLoss::Constant { loss_db },
                    None => SurfaceLoss::Wind { wind_m_s: sea.wind_m_s },
                },
                column: column.clone(),
            },
            links,
            farthest_m,
            layers,
            paths: paths(sea.bounces_max),
        }
    }

    /// Length of a packet of so many bytes from an AUV of this group, in nanoseconds.
    pub fn packet_ns(&self, group: u16, bytes: u16) -> i64 {
        let layer = self.layers.get(usize::from(group)).copied().flatten();
        layer.map_or(0, |layer| (layer.packet_s(bytes) * 1e9).ceil() as i64)
    }

    /// How far away from an emission anyone may be who is touched by it, in metres.
    pub fn farthest_m(&self) -> f64 {
        self.farthest_m
    }

    /// Adds all others whom a wavefront may touch to `recipients`: not all of them will ever notice it.
    ///
    /// `grid` holds all vehicles where they were at some moment since which none moved farther than `moved_m`.
    pub fn spread(
        &self,
        number: u64,
        wavefront: &Wavefront,
        (grid, moved_m): (&Grid, f64),
        recipients: &mut Vec<Recipient>,
    ) {
        let flight = Flight { wavefront: number, earliest: wavefront.emitted, is_sure: false };
        let near = grid.near(wavefront.origin_m, self.farthest_m + moved_m);
        let all = near.map(|(index, _)| Recipient { to: AuvId(index as u32), flight });
        recipients.extend(all.filter(|recipient| recipient.to != wavefront.from));
    }

    /// What a wavefront is to a receiver who was `distance_m` away when it left, and how their modems are linked.
    fn touch(&self, wavefront: &Wavefront, receiver: &Vehicle, distance_m: f64) -> Option<(&Link, Touch)> {
        let links = &self.links[usize::from(wavefront.group)];
        let link = links[usize::from(receiver.born.group)].as_ref()?;
        if distance_m > link.floor_m {
            let nominal_m = links[usize::from(wavefront.group)].as_ref().map_or(0.0, |own| own.reach_m);
            return (!link.known && distance_m <= nominal_m).then_some((link, Touch::OtherBand));
        }
        let touch = if distance_m > link.reach_m { Touch::Disturbs } else { Touch::Reaches };
        Some((link, touch))
    }

    /// Lets one receiver take up the wavefronts that left for it, and settles what can be settled before `horizon`.
    pub fn listen(
        &self,
        left: &mut Vec<Flight>,
        listener: &mut Listener,
        vehicle: &mut Vehicle,
        wavefronts: &Wavefronts,
        horizon: SimTime,
    ) {
        for Flight { wavefront: number, .. } in left.drain(..) {
            self.take_up(number, wavefronts.get(number), listener, vehicle);
        }
        listener.listen(horizon, vehicle, &self.water, wavefronts);
    }

    fn take_up(&self, number: u64, wavefront: &Wavefront, listener: &mut Listener, receiver: &Vehicle) {
        let to = receiver.born.auv;
        let place_m = receiver.body.position_at(wavefront.emitted);
        let distance_m = (place_m - wavefront.origin_m).norm();
        let Some((link, touch)) = self.touch(wavefront, receiver, distance_m) else {
            return listener.beyond.push(number);
        };
        let reason = match touch {
            Touch::Disturbs => {
                listener.beyond.push(number);
                let level_db = link.level_db(distance_m, 0.0);
                return listener.disturb(wavefront, level_db, distance_m, &self.water);
            }
            Touch::OtherBand => LossReason::Band,
            Touch::Reaches => {
                let speed_ratio = receiver.ground_speed_m_s / self.water.slowest_m_s;
                let (paths, water) = (&self.paths, &self.water);
                let packet = (number, wavefront);
                if listener.await_packet(packet, paths, link, water, speed_ratio, place_m) {
                    return;
                }
                LossReason::Shadow
            }
        };
        listener.told.push(lost(number, wavefront, to, reason, distance_m));
    }
}

/// What a wavefront may be to a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Touch {
    /// Too faint to be noticed, but energy that others have to stand out from.
    Disturbs,
    /// Near enough, but not in the receiver's band.
    OtherBand,
    /// Near enough to be noticed, if a path leads there.
    Reaches,
}
