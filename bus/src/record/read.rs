//! Reads the rows of a record: typed, in the order of the file, one batch in memory at a time.

use std::io::{Read, Seek};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize, Serializer};

use super::rows::{FlockRow, LogRow, OfflineRow, PingRow, PosesInFrame, ReportRow, TruthRow};
use super::scan::{Ending, Item, Source, scan};
use super::{Damage, METADATA_RUN, RECORD_FORMAT, RecordHeader, RecordReadError, RecordedAuv, Topic};
use crate::codec;
use crate::message::{AuvId, Born, Sensed};
use crate::summary::Summary;
use crate::time::SimTime;

/// One row of a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// What stands at the beginning; comes first, and once.
    Header(RecordHeader),
    /// One AUV's true state at a tick, from [`Topic::Ticks`].
    Truth(TruthRow),
    /// What one AUV answered and believed at a tick, from [`Topic::Reports`].
    Report(Box<ReportRow>),
    /// What became of a ping, from [`Topic::Pings`].
    Ping(PingRow),
    /// What one AUV was told at a tick, from [`Topic::Sensed`].
    Sensed {
        /// True time of the tick.
        at: SimTime,
        /// Which AUV.
        auv: AuvId,
        /// What it was told.
        sensed: Sensed,
    },
    /// What one AUV was told at birth, from [`Topic::Born`].
    Born(Box<Born>),
    /// What is known of one AUV at a tick after the run, from [`Topic::Offline`].
    Offline(OfflineRow),
    /// How the swarm moves and holds together at one second, from [`Topic::Flock`].
    Flock(FlockRow),
    /// Where all AUVs are, from [`Topic::Poses`].
    Poses(PosesInFrame),
    /// Something to tell people, from [`Topic::Log`].
    Log(LogRow),
    /// The outcome, from [`Topic::Summary`].
    Summary(Box<Summary>),
}

impl Row {
    /// The topic that it comes from.
    pub fn topic(&self) -> Topic {
        match self {
            Self::Header(_) => Topic::Auvs,
            Self::Truth(_) => Topic::Ticks,
            Self::Report(_) => Topic::Reports,
            Self::Ping(_) => Topic::Pings,
            Self::Sensed { .. } => Topic::Sensed,
            Self::Born(_) => Topic::Born,
            Self::Offline(_) => Topic::Offline,
            Self::Flock(_) => Topic::Flock,
            Self::Poses(_) => Topic::Poses,
            Self::Log(_) => Topic::Log,
            Self::Summary(_) => Topic::Summary,
        }
    }

    /// When it happened, in true time; zero for what stands at the beginning, and the end of the run for the outcome.
    pub fn at(&self) -> SimTime {
        match self {
            Self::Header(_) | Self::Born(_) => SimTime::ZERO,
            Self::Truth(row) => row.t_ns,
            Self::Report(row) => row.t_ns,
            Self::Ping(row) => row.at(),
            Self::Sensed { at, .. } => *at,
            Self::Offline(row) => row.t_ns,
            Self::Flock(row) => row.t_ns,
            Self::Poses(row) => row.timestamp.sim_time(),
            Self::Log(row) => row.timestamp.sim_time(),
            // No scenario comes near the year 2262.
            Self::Summary(summary) => SimTime::from_ns((summary.sim_s * 1e9).round() as i64),
        }
    }
}

/// As an element of its message in a record; whole messages where those have no elements. What was told to an AUV, which has a
/// binary encoding there, has the field names of [`Sensed`] and [`Born`].
impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct SensedRow<'a> {
            t_ns: SimTime,
            auv: AuvId,
            #[serde(flatten)]
            sensed: &'a Sensed,
        }
        match self {
            Self::Header(header) => super::header::Auvs { auvs: &header.auvs }.serialize(serializer),
            Self::Truth(row) => row.serialize(serializer),
            Self::Report(row) => row.serialize(serializer),
            Self::Ping(row) => row.serialize(serializer),
            Self::Sensed { at, auv, sensed } => {
                SensedRow { t_ns: *at, auv: *auv, sensed }.serialize(serializer)
            }
            Self::Born(row) => row.serialize(serializer),
            Self::Offline(row) => row.serialize(serializer),
            Self::Flock(row) => row.serialize(serializer),
            Self::Poses(row) => row.serialize(serializer),
            Self::Log(row) => row.serialize(serializer),
            Self::Summary(row) => row.serialize(serializer),
        }
    }
}

/// Hands the header and the rows of `topics` to `visit`, in the order of the file, and tells how the file ends.
///
/// What was told at birth comes first. Within a batch (100 ms) all ticks come before all reports, all reports before all pings, and
/// all pings before the flock and what was sensed; each are sorted by time. What was reconstructed after the run comes last.
/// Messages of topics that are not asked for are not parsed, but their checksums are verified.
///
/// Memory: one chunk and the rows of one message, whatever the length of the file.
///
/// ```
/// use shoal_bus::record::{RecordHeader, RecordWriter, Row, Topic, read_rows};
/// let header = RecordHeader { scenario_name: "a".into(), seed: 1, scenario_text: "b".into(), auvs: vec![] };
/// let mut file = Vec::new();
/// drop(RecordWriter::create(&mut file, &header)?);
/// let mut rows = Vec::new();
/// read_rows(std::io::Cursor::new(&file), &[Topic::Pings], &mut |row| rows.push(row)).unwrap();
/// assert_eq!(rows, [Row::Header(header)]);
/// # Ok::<(), shoal_bus::record::RecordWriteError>(())
/// ```
///
/// # Errors
/// When the source cannot be read or is damaged; when it is no MCAP file, no record of a run, or a record whose layout this
/// version does not know. Rows before the damage have been handed over by then.
pub fn read_rows<R: Read + Seek>(
    source: R,
    topics: &[Topic],
    visit: &mut dyn FnMut(Row),
) -> Result<Ending, RecordReadError> {
    let mut beginning = Beginning::default();
    let ending = scan(source, &mut |item| match item {
        Item::Metadata { name: METADATA_RUN, entries } => {
            beginning.format = entries.get("format").and_then(|format| format.parse().ok());
            beginning.name = entries.get("scenario").cloned().unwrap_or_default();
            beginning.seed = entries.get("seed").and_then(|seed| seed.parse().ok()).unwrap_or_default();
            Ok(())
        }
        Item::Attachment { name: "scenario.toml", data, .. } => {
            beginning.text = String::from_utf8_lossy(data).into_owned();
            Ok(())
        }
        Item::Message { source, data, .. } if beginning.is_known() => {
            let topic = Topic::ALL.into_iter().find(|topic| is_of(source, *topic));
            match topic {
                Some(Topic::Auvs) if !beginning.is_told => {
                    visit(Row::Header(beginning.tell(auvs_of(data)?)));
                    Ok(())
                }
                Some(topic) if topics.contains(&topic) => rows_of(topic, data, visit),
                _ => Ok(()),
            }
        }
        _ => Ok(()),
    })?;
    match beginning {
        Beginning { format: None, .. } => Err(RecordReadError::NotARecord),
        Beginning { format: Some(found), .. } if found != RECORD_FORMAT => {
            Err(RecordReadError::UnknownFormat { found })
        }
        _ => Ok(ending),
    }
}

/// What has been seen of the header.
#[derive(Default)]
struct Beginning {
    format: Option<u32>,
    name: String,
    seed: u64,
    text: String,
    is_told: bool,
}

impl Beginning {
    fn is_known(&self) -> bool {
        self.format == Some(RECORD_FORMAT)
    }

    fn tell(&mut self, auvs: Vec<RecordedAuv>) -> RecordHeader {
        self.is_told = true;
        RecordHeader {
            scenario_name: std::mem::take(&mut self.name),
            seed: self.seed,
            scenario_text: std::mem::take(&mut self.text),
            auvs,
        }
    }
}

fn is_of(source: &Source, topic: Topic) -> bool {
    source.topic == topic.name() && source.schema == topic.schema_name()
}

/// Hands the rows of one message of `topic` to `visit`. [`Topic::Auvs`] and the topics for viewers and people have none.
///
/// ```
/// use shoal_bus::record::{Topic, rows_of};
/// let mut rows = 0;
/// rows_of(Topic::Pings, br#"{"from_ns":0,"to_ns":100000000,"pings":[]}"#, &mut |_| rows += 1)?;
/// assert_eq!(rows, 0);
/// # Ok::<(), shoal_bus::record::Damage>(())
/// ```
///
/// # Errors
/// When the message is not one that the topic's schema describes.
pub fn rows_of(topic: Topic, data: &[u8], visit: &mut dyn FnMut(Row)) -> Result<(), Damage> {
    match topic {
        Topic::Ticks => parse::<Ticks>(topic, data)?.ticks.into_iter().map(Row::Truth).for_each(visit),
        Topic::Reports => parse::<Reports>(topic, data)?
            .reports
            .into_iter()
            .map(|row| Row::Report(Box::new(row)))
            .for_each(visit),
        Topic::Pings => parse::<Pings>(topic, data)?.pings.into_iter().map(Row::Ping).for_each(visit),
        Topic::Sensed => {
            let told: Vec<(SimTime, AuvId, Sensed)> = decode(topic, data)?;
            told.into_iter().map(|(at, auv, sensed)| Row::Sensed { at, auv, sensed }).for_each(visit);
        }
        Topic::Born => {
            let born: Vec<Born> = decode(topic, data)?;
            born.into_iter().map(|born| Row::Born(Box::new(born))).for_each(visit);
        }
        Topic::Offline => {
            parse::<Offline>(topic, data)?.offline.into_iter().map(Row::Offline).for_each(visit);
        }
        Topic::Flock => visit(Row::Flock(parse(topic, data)?)),
        Topic::Poses => visit(Row::Poses(parse(topic, data)?)),
        Topic::Log => visit(Row::Log(parse(topic, data)?)),
        Topic::Summary => visit(Row::Summary(parse(topic, data)?)),
        Topic::Auvs => {}
    }
    Ok(())
}

fn parse<T: DeserializeOwned>(topic: Topic, data: &[u8]) -> Result<T, Damage> {
    serde_json::from_slice(data).map_err(|source| Damage::Rows { topic: topic.name(), source })
}

fn decode<T: DeserializeOwned>(topic: Topic, data: &[u8]) -> Result<T, Damage> {
    codec::decode(data).map_err(|source| Damage::Message { topic: topic.name(), source })
}

/// The AUVs that a message of [`Topic::Auvs`] names.
///
/// # Errors
/// When the message is not one that the topic's schema describes.
pub fn auvs_of(data: &[u8]) -> Result<Vec<RecordedAuv>, Damage> {
    Ok(parse::<Auvs>(Topic::Auvs, data)?.auvs)
}

#[derive(Deserialize)]
struct Auvs {
    auvs: Vec<RecordedAuv>,
}

#[derive(Deserialize)]
struct Ticks {
    ticks: Vec<TruthRow>,
}

#[derive(Deserialize)]
struct Reports {
    reports: Vec<ReportRow>,
}

#[derive(Deserialize)]
struct Pings {
    pings: Vec<PingRow>,
}

#[derive(Deserialize)]
struct Offline {
    offline: Vec<OfflineRow>,
}
