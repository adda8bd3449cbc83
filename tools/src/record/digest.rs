//! The digest of a run, counted again from the rows of its record.

use std::collections::BTreeMap;

use shoal_bus::chronicle::{Entry, Truth, What};
use shoal_bus::message::{
    Acted, Around, AuvId, Bounds, Culprit, Emptied, Gaussian, MediumAccess, PlannedPing, Report, Setpoint,
    Slice,
};
use shoal_bus::ping::Frame;
use shoal_bus::record::Row;
use shoal_bus::record::rows::{EmptiedRow, Pair, PingRow, ReceptionRow, ReportRow, TruthRow};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Boundary, Fate, Reception, SoundPath, Traffic};
use shoal_channel::digest::Digest;

/// Whether a digest is that of the events.
#[derive(Debug, PartialEq, Eq)]
pub enum Fit {
    /// It is.
    Fits,
    /// It is not.
    Differs {
        /// That of the events.
        found: String,
    },
    /// Nobody can say; why, as a clause.
    Unknown(&'static str),
}

/// Counts the digest while rows come.
#[derive(Default)]
pub struct Recount {
    digest: Digest,
    /// How long each AUV listens before it pings, in local nanoseconds: no row tells it.
    listen_ns: BTreeMap<AuvId, i64>,
    /// Entries of the batch at hand.
    batch: Vec<Entry>,
    /// End of that batch.
    end: i64,
    unknown: Option<&'static str>,
}

impl Recount {
    /// Takes a row, in the order of the record.
    pub fn take(&mut self, row: Row) {
        let (at, auv, what) = match row {
            Row::Truth(row) => (row.t_ns, row.auv, What::Truth(truth(&row))),
            Row::Sensed { at, auv, sensed } => (at, auv, What::Sensed(sensed)),
            Row::Report(row) => {
                let listen_ns = self.listen_ns.get(&row.auv).copied().unwrap_or_default();
                let Some(acted) = acted(&row, listen_ns) else {
                    self.unknown = Some("a report in it is none of Shoal's");
                    return;
                };
                (row.t_ns, row.auv, What::Acted(Box::new(acted)))
            }
            Row::Ping(row) => {
                let Some(traffic) = traffic(&row) else {
                    self.unknown = Some("a ping in it took a way that is unknown here");
                    return;
                };
                (traffic.at, subject(&traffic), What::Traffic(traffic))
            }
            Row::Born(born) => {
                if let MediumAccess::Csma { listen_ns, .. } = born.orders.access {
                    self.listen_ns.insert(born.auv, listen_ns);
                }
                return;
            }
            Row::Header(_)
            | Row::Offline(_)
            | Row::Flock(_)
            | Row::Poses(_)
            | Row::Log(_)
            | Row::Summary(_) => return,
        };
        let end = batch_end(at);
        if end != self.end {
            self.close();
            self.end = end;
        }
        self.batch.push(Entry { at, auv, what });
    }

    /// The digest of the events, against the one that the record states, and whether scenario and seed determine it.
    pub fn finish(mut self, stated: Option<(String, bool)>) -> Fit {
        self.close();
        match (self.unknown, stated) {
            (_, None) => Fit::Unknown("the run did not end"),
            (_, Some((_, false))) => Fit::Unknown("the run cannot be reproduced"),
            (Some(why), _) => Fit::Unknown(why),
            (None, Some((stated, true))) => {
                let found = self.digest.text();
                if found == stated { Fit::Fits } else { Fit::Differs { found } }
            }
        }
    }

    fn close(&mut self) {
        // Stable: events of one AUV and kind keep their order.
        self.batch.sort_by_key(|entry| (entry.at, entry.auv, entry.what.rank()));
        if self.digest.update(&self.batch).is_err() {
            self.unknown = Some("an event in it is too long");
        }
        self.batch.clear();
    }
}

/// End of the batch that holds `at`.
fn batch_end(at: SimTime) -> i64 {
    let batch_ns = shoal_bus::record::BATCH_NS;
    at.ns().max(0).saturating_add(batch_ns - 1) / batch_ns
}

fn truth(row: &TruthRow) -> Truth {
    Truth {
        tick: row.tick,
        local: row.local_ns,
        position_m: row.position_m.map(|real| real.0),
        velocity_m_s: row.velocity_m_s.map(|real| real.0),
        heading_rad: row.heading_rad.0,
        pitch_rad: row.pitch_rad.0,
    }
}

/// A bound that is not finite is `null` in a record: it is infinite.
fn bounds([lower, upper]: Pair) -> Bounds {
    let or = |real: f64, infinite: f64| if real.is_nan() { infinite } else { real };
    Bounds::new(or(lower.0, f64::NEG_INFINITY), or(upper.0, f64::INFINITY))
}

fn acted(row: &ReportRow, listen_ns: i64) -> Option<Acted> {
    let ping = |booked: &shoal_bus::record::rows::BookedRow| {
        Some(PlannedPing { at: booked.at_local_ns, listen_ns, frame: Frame::new(&booked.bytes()?)? })
    };
    Some(Acted {
        tick: row.tick,
        setpoint: Setpoint { velocity_m_s: row.setpoint_m_s.map(|real| real.0) },
        pings: row.booked.iter().map(ping).collect::<Option<_>>()?,
        report: Report {
            position_m: row.position_m.map(bounds),
            clock_offset_s: bounds(row.clock_offset_s),
            slice: Slice {
                position_m: row.slice_position_m.map(bounds),
                clock_offset_s: bounds(row.slice_clock_offset_s),
            },
            emptied: match &row.emptied {
                Some(emptied) => Some(self::emptied(emptied)?),
                None => None,
            },
            neighbours: row.neighbours,
            contractions: row.contractions,
            rejected: row.rejected,
            around: row
                .around
                .iter()
                .map(|around| Around { auv: around.auv, position_m: around.position_m.map(bounds) })
                .collect(),
            components: row.components,
            gaussian: row.gaussian.as_ref().map(|gaussian| Gaussian {
                mean: gaussian.mean.map(|real| real.0),
                covariance: gaussian.covariance.map(|real| real.0),
            }),
        },
    })
}

fn emptied(row: &EmptiedRow) -> Option<Emptied> {
    let by = match (row.by.as_str(), row.sender) {
        ("inertial", _) => Culprit::Inertial,
        ("dvl", _) => Culprit::Dvl,
        ("depth", _) => Culprit::Depth,
        ("gnss", _) => Culprit::Gnss,
        ("ping", Some(sender)) => Culprit::Ping(sender),
        ("sabotage", _) => Culprit::Sabotage,
        _ => return None,
    };
    Some(Emptied { stamp: row.at_local_ns, by })
}

fn traffic(row: &PingRow) -> Option<Traffic> {
    let received = |row: &Option<ReceptionRow>| match row {
        None => Some(None),
        Some(row) => reception(row).map(Some),
    };
    Some(match row {
        PingRow::Emitted { t_ns, from, sequence, position_m, bytes, box_width_m, beyond_range, packet_s } => {
            Traffic {
                at: *t_ns,
                from: *from,
                sequence: *sequence,
                fate: Fate::Emitted {
                    position_m: position_m.map(|real| real.0),
                    bytes: *bytes,
                    box_width_m: infinite_or(box_width_m.0),
                    beyond_range: *beyond_range,
                    packet_s: packet_s.0,
                },
            }
        }
        PingRow::Heard { t_ns, from, sequence, to, range_m, travel_s, box_width_m, reception, outlier } => {
            Traffic {
                at: *t_ns,
                from: *from,
                sequence: *sequence,
                fate: Fate::Heard {
                    to: *to,
                    range_m: range_m.0,
                    travel_s: travel_s.0,
                    box_width_m: infinite_or(box_width_m.0),
                    reception: received(reception)?,
                    outlier: *outlier,
                },
            }
        }
        PingRow::Lost { t_ns, from, sequence, to, reason, range_m, reception, colliding } => Traffic {
            at: *t_ns,
            from: *from,
            sequence: *sequence,
            fate: Fate::Lost {
                to: *to,
                reason: *reason,
                range_m: range_m.0,
                reception: received(reception)?,
                colliding: colliding.clone(),
            },
        },
    })
}

/// A width that is not finite is `null` in a record.
fn infinite_or(width: f64) -> f64 {
    if width.is_nan() { f64::INFINITY } else { width }
}

fn reception(row: &ReceptionRow) -> Option<Reception> {
    let path = match row.path.as_str() {
        "direct" => SoundPath::Direct,
        bounces => {
            let first = match bounces.split('-').next()? {
                "surface" => Boundary::Surface,
                "bottom" => Boundary::Bottom,
                _ => return None,
            };
            SoundPath::Bounced { first, bounces: u8::try_from(bounces.split('-').count()).ok()? }
        }
    };
    Some(Reception { path, level_db: row.level_db.0, sinr_db: row.sinr_db.0, doppler: row.doppler.0 })
}

/// Whom the chronicle tells it of.
fn subject(traffic: &Traffic) -> AuvId {
    match traffic.fate {
        Fate::Heard { to, .. } | Fate::Lost { to: Some(to), .. } => to,
        Fate::Emitted { .. } | Fate::Lost { to: None, .. } => traffic.from,
    }
}
