//! What a record holds for localization: what every AUV was told and booked, the truth, and what it believed.

use std::io::{Read, Seek};

use shoal_auv::offline::{Booked, Recorded};
use shoal_bus::message::AuvId;
use shoal_bus::ping::Frame;
use shoal_bus::record::rows::{ReportRow, TruthRow};
use shoal_bus::record::{Ending, RecordHeader, Row, Topic, read_rows};
use shoal_bus::time::{LocalTime, SimTime};

use super::outcome::Enclosure;

/// A record, all of it.
pub struct Told {
    pub header: RecordHeader,
    /// By AUV.
    pub auvs: Vec<Recorded>,
    /// By AUV, then by tick.
    pub ticks: Vec<Vec<ToldTick>>,
    pub ending: Ending,
}

/// The truth at a tick, and what the AUV believed.
#[derive(Clone, Copy, Debug)]
pub struct ToldTick {
    pub tick: u64,
    pub at: SimTime,
    pub local: LocalTime,
    pub position_m: [f64; 3],
    /// Absent where the record was cut in between.
    pub online: Option<Enclosure>,
    /// Whether nothing was left of the AUV's own enclosure.
    pub emptied: bool,
}

/// Reads a record. A sentence says why it is of no use.
pub fn read(source: impl Read + Seek) -> Result<Told, String> {
    let mut header = None;
    let mut auvs: Vec<Recorded> = Vec::new();
    let mut ticks: Vec<Vec<ToldTick>> = Vec::new();
    let topics = [Topic::Born, Topic::Sensed, Topic::Ticks, Topic::Reports];
    let ending = read_rows(source, &topics, &mut |row| match row {
        Row::Header(found) => header = Some(found),
        Row::Born(born) => {
            auvs.push(Recorded { born: *born, sensed: Vec::new(), booked: Vec::new() });
            ticks.push(Vec::new());
        }
        Row::Truth(row) => {
            if let Some(ticks) = of(&mut ticks, row.auv) {
                ticks.push(tick(&row));
            }
        }
        Row::Report(row) => {
            if let Some(recorded) = of(&mut auvs, row.auv) {
                recorded.booked.extend(booked(&row));
            }
            // The truth at a tick comes before what was answered, and both in the order of ticks.
            if let Some(told) = of(&mut ticks, row.auv).and_then(|ticks| at_tick(ticks, row.tick)) {
                told.online = Some(Enclosure::of(&row.position_m, &row.clock_offset_s));
                told.emptied = row.emptied.is_some();
            }
        }
        Row::Sensed { auv, sensed, .. } => {
            if let Some(recorded) = of(&mut auvs, auv) {
                recorded.sensed.push(sensed);
            }
        }
        _ => {}
    })
    .map_err(|error| error.to_string())?;
    let header = header.ok_or("the record was cut before anything happened")?;
    let in_order = auvs.iter().enumerate().all(|(index, recorded)| recorded.born.auv.0 as usize == index);
    if auvs.len() != header.auvs.len() || !in_order {
        return Err("the record does not hold what its AUVs were told at birth: it was cut there, or an older version of shoal \
                    wrote it; run the scenario again with --record"
            .to_owned());
    }
    Ok(Told { header, auvs, ticks, ending })
}

fn at_tick(ticks: &mut [ToldTick], tick: u64) -> Option<&mut ToldTick> {
    let index = ticks.binary_search_by_key(&tick, |told| told.tick).ok()?;
    ticks.get_mut(index)
}

fn of<T>(all: &mut [T], auv: AuvId) -> Option<&mut T> {
    all.get_mut(auv.0 as usize)
}

fn tick(row: &TruthRow) -> ToldTick {
    ToldTick {
        tick: row.tick,
        at: row.t_ns,
        local: row.local_ns,
        position_m: row.position_m.map(|real| real.0),
        online: None,
        emptied: false,
    }
}

fn booked(row: &ReportRow) -> impl Iterator<Item = Booked> {
    row.booked
        .iter()
        .filter_map(|booked| Some(Booked { at: booked.at_local_ns, frame: Frame::new(&booked.bytes()?)? }))
}
