//! Sound at level `sea`: every packet takes every path that is loud enough to every receiver, and meets there whatever else
//! is in the water.

mod crossing;
mod listener;

use std::sync::Arc;

use shoal_bus::message::AuvId;
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Boundary, Fate, LossReason, SoundPath};
use shoal_scenario::LISTEN_MAX_NS;
use shoal_scenario::model::{MediumAccess, PhysicalLayer, Scenario, Sea as SeaModel};

use crate::acoustics::density::sea_water_density_kg_m3;
use crate::acoustics::ray::{Ray, WaterColumn};
use crate::acoustics::reflection::{FluidBottom, SurfaceLoss};
use crate::budget::{self, Link};
use crate::draw::{Draws, Purpose};
use crate::grid::Grid;
use crate::reception::{Ear, EarSettings};
use crate::sound::{Told, Wavefront};
use crate::vehicle::Vehicle;

use self::listener::Listener;

/// All sound in the sea.
pub struct Sea {
    water: SeaWater,
    /// `links[emitter's group][receiver's group]`.
    links: Vec<Vec<Option<Link>>>,
    /// How far the loudest modem matters, in metres.
    farthest_m: f64,
    layers: Vec<Option<PhysicalLayer>>,
    paths: Vec<SoundPath>,
    listeners: Vec<Listener>,
    told: Vec<Told>,
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
fn lost(wavefront: &Arc<Wavefront>, to: AuvId, reason: LossReason, range_m: f64) -> Told {
    let fate = Fate::lost(Some(to), reason, range_m);
    Told { at: wavefront.emitted, to, wavefront: Arc::clone(wavefront), fate, stamp: None, incidence: None }
}

/// The link between two groups; none when either's modem has no physical layer.
fn link(sea: &SeaModel, emitter: Option<&PhysicalLayer>, receiver: Option<&PhysicalLayer>) -> Option<Link> {
    Some(Link::new(sea, emitter?, receiver?))
}

impl Sea {
    /// The sea of a run; `vehicles` are all of its AUVs, newborn. Every group's modem has a physical layer.
    pub fn new(scenario: &Scenario, sea: &SeaModel, column: &WaterColumn, vehicles: &[Vehicle]) -> Self {
        // A validated scenario has a physical layer for every group at level `sea`; a group without one would be mute and deaf.
        let layers: Vec<_> = scenario.groups.iter().map(|group| group.modem.physical).collect();
        let links: Vec<Vec<Option<Link>>> = layers
            .iter()
            .map(|emitter| {
                layers.iter().map(|receiver| link(sea, emitter.as_ref(), receiver.as_ref())).collect()
            })
            .collect();
        let farthest_m = links.iter().flatten().flatten().fold(0.0, |far: f64, link| far.max(link.floor_m));
        let listener = |vehicle: &Vehicle| {
            let group = &scenario.groups[usize::from(vehicle.born.group)];
            let ear = group.modem.physical.map(|physical| {
                let listens = matches!(group.modem.access, MediumAccess::Csma { .. });
                let settings = EarSettings {
                    noise_db: budget::noise_db(sea, &physical),
                    physical,
                    fading: sea.fading,
                    sense_ns: if listens { LISTEN_MAX_NS } else { 0 },
                };
                let auv = vehicle.born.auv;
                Ear::new(settings, Draws::new(scenario.seed, Purpose::Reception, auv, scenario.noise))
            });
            Listener::new(vehicle.born.auv, ear, group.modem.duty_cycle, vehicle.born.modem.sound_speed_m_s)
        };
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
            listeners: vehicles.iter().map(listener).collect(),
            told: Vec::new(),
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

    /// Sends a wavefront to all whom it may touch; returns how many are too far away to ever notice it.
    pub fn emit(
        &mut self,
        wavefront: &Arc<Wavefront>,
        vehicles: &mut [Vehicle],
        grid: &Grid,
        moved_m: f64,
    ) -> u32 {
        let emitter_group = usize::from(vehicles[wavefront.from.0 as usize].born.group);
        if let Some(ear) = &mut self.listeners[wavefront.from.0 as usize].ear {
            ear.emit(wavefront.emitted, wavefront.emitted + wavefront.packet_ns);
        }
        let mut within = 0;
        for (index, _) in grid.near(wavefront.origin_m, self.farthest_m + moved_m) {
            let receiver = &vehicles[index];
            if receiver.born.auv == wavefront.from {
                continue;
            }
            let Some(link) = &self.links[emitter_group][usize::from(receiver.born.group)] else { continue };
            let place_m = receiver.body.position_at(wavefront.emitted);
            let distance_m = (place_m - wavefront.origin_m).norm();
            if distance_m > link.floor_m {
                let nominal_m =
                    self.links[emitter_group][emitter_group].as_ref().map_or(0.0, |own| own.reach_m);
                if !link.known && distance_m <= nominal_m {
                    within += 1;
                    self.told.push(lost(wavefront, receiver.born.auv, LossReason::Band, distance_m));
                }
                continue;
            }
            let listener = &mut self.listeners[index];
            if distance_m > link.reach_m {
                listener.disturb(wavefront, link.level_db(distance_m, 0.0), distance_m, &self.water);
                continue;
            }
            within += 1;
            let speed_ratio = receiver.ground_speed_m_s / self.water.slowest_m_s;
            if !listener.await_packet(wavefront, &self.paths, link, &self.water, speed_ratio, place_m) {
                self.told.push(lost(wavefront, receiver.born.auv, LossReason::Shadow, distance_m));
            }
        }
        vehicles.len() as u32 - 1 - within
    }

    /// Whether the modem of `auv` has heard nothing, and not emitted, between `since` and `now`.
    pub fn is_quiet(&mut self, auv: AuvId, since: SimTime, now: SimTime, vehicles: &mut [Vehicle]) -> bool {
        let index = auv.0 as usize;
        let listener = &mut self.listeners[index];
        listener.listen(now, &mut vehicles[index], &self.water, &mut self.told);
        listener.ear.as_ref().is_none_or(|ear| !ear.busy(since, now))
    }

    /// Adds all that is settled before `to` to `told`, in no particular order.
    pub fn arrive(&mut self, to: SimTime, vehicles: &mut [Vehicle], told: &mut Vec<Told>) {
        told.append(&mut self.told);
        for (listener, vehicle) in self.listeners.iter_mut().zip(vehicles) {
            listener.listen(to, vehicle, &self.water, told);
        }
    }

    /// Packets that are not settled, counted once for each receiver.
    pub fn in_flight(&self) -> u64 {
        self.listeners.iter().map(|listener| listener.unsettled() as u64).sum::<u64>()
            + self.told.len() as u64
    }
}
