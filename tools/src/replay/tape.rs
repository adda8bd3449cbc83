//! What a record holds for a replay, batch by batch.

use std::collections::{BTreeMap, BTreeSet};

use shoal_bus::lockstep::Batch;
use shoal_bus::message::{AuvId, Born, Sensed};
use shoal_bus::record::rows::{ReportRow, TruthRow};
use shoal_bus::record::{Row, Topic, rows_of};
use shoal_bus::time::{LocalTime, SimTime};

use crate::exit::Exit;
use crate::failure::Failure;
use crate::record::batches::Batches;

/// How the log tells of an AUV that is lost.
const LOST: &str = "the AUV is lost";

/// A record that is played.
pub struct Tape {
    batches: Batches,
    /// Who is played, all if empty.
    named: Vec<String>,
    /// The last tick of those that are played.
    playing: BTreeMap<AuvId, Option<u64>>,
    /// Who is not played any more.
    left: BTreeSet<AuvId>,
    /// Who was lost in the run.
    dead: BTreeSet<AuvId>,
}

/// What happened in one batch.
#[derive(Default)]
pub struct Telling {
    /// Its end.
    pub at: SimTime,
    /// What is told, by AUV.
    pub sensed: Vec<Batch<Sensed>>,
    /// True and local times of the ticks told, by AUV.
    ticks: BTreeMap<AuvId, Vec<(SimTime, LocalTime)>>,
    /// What was answered then.
    pub reports: Vec<ReportRow>,
    /// The truth at the ticks.
    pub truth: Vec<TruthRow>,
}

impl Telling {
    /// True and local times of an AUV's ticks in this batch, in their order.
    pub fn times(&self, auv: AuvId) -> &[(SimTime, LocalTime)] {
        self.ticks.get(&auv).map_or(&[], Vec::as_slice)
    }
}

impl Tape {
    pub fn open(batches: Batches, named: &[String]) -> Result<Self, Failure> {
        Ok(Self {
            batches,
            named: named.to_vec(),
            playing: BTreeMap::new(),
            left: BTreeSet::new(),
            dead: BTreeSet::new(),
        })
    }

    /// What those who are played were told at birth, sorted by AUV.
    pub fn born(&mut self) -> Result<Vec<Born>, Failure> {
        let mut all: Vec<Born> = Vec::new();
        while all.is_empty() {
            let Some(batch) = self.batches.next()? else { break };
            for (topic, data) in &batch.messages {
                if *topic == Topic::Born {
                    let visit = &mut |row| {
                        if let Row::Born(born) = row {
                            all.push(*born);
                        }
                    };
                    rows_of(*topic, data, visit).map_err(|error| self.batches.record.wrong(&error))?;
                }
            }
            // It comes first.
            if batch.at > SimTime::ZERO {
                break;
            }
        }
        if all.is_empty() {
            return Err(self.batches.record.wrong(
                &"the record does not hold what its AUVs were told at birth: it was cut there, or an older version of shoal wrote it; run \
                  the scenario again with --record",
            ));
        }
        all.sort_by_key(|born| born.auv);
        let programs = self.programs();
        let named: Vec<u32> =
            self.named.iter().map(|named| self.batches.record.auv(named)).collect::<Result<_, _>>()?;
        all.retain(|born| {
            let is_program = programs.contains(&born.group);
            (named.is_empty() && !is_program) || named.contains(&born.auv.0)
        });
        if all.is_empty() {
            return Err(self.batches.record.wrong(
                &"all of its AUVs were programs of the user's, which a replay does not start; name some with --auv to replay Shoal's own \
                  mind in their place",
            ));
        }
        self.playing = all.iter().map(|born| (born.auv, None)).collect();
        Ok(all)
    }

    /// Groups whose AUVs were programs of the user's.
    fn programs(&self) -> Vec<u16> {
        let Ok(scenario) = shoal_scenario::parse("scenario.toml", &self.batches.record.scenario) else {
            return Vec::new();
        };
        let groups = scenario.groups.iter().enumerate();
        let programs: Vec<u16> =
            groups.filter(|(_, group)| group.command.is_some()).map(|(index, _)| index as u16).collect();
        if !programs.is_empty() && self.named.is_empty() {
            eprintln!(
                "warning: AUVs that were programs of the user's are left out: only Shoal's own minds are replayed"
            );
        }
        programs
    }

    /// What happened next, up to `to`.
    pub fn next(&mut self, to: Option<SimTime>) -> Result<Option<Telling>, Failure> {
        let Some(batch) = self.batches.next()? else { return Ok(None) };
        if batch.is_offline || to.is_some_and(|to| batch.at > to) {
            return Ok(None);
        }
        let mut telling = Telling { at: batch.at, ..Telling::default() };
        let mut sensed: BTreeMap<AuvId, Vec<Sensed>> = BTreeMap::new();
        let mut lost: Vec<String> = Vec::new();
        let (playing, left, dead) = (&mut self.playing, &mut self.left, &mut self.dead);
        for (topic, data) in &batch.messages {
            if !matches!(topic, Topic::Ticks | Topic::Reports | Topic::Sensed | Topic::Log) {
                continue;
            }
            let visit = &mut |row| match row {
                Row::Sensed { at, auv, sensed: told } => {
                    let Some(last) = playing.get_mut(&auv).filter(|_| !left.contains(&auv)) else { return };
                    // A mind that was not told all, or was born again, is another one.
                    if told.tick != last.map_or(0, |last| last + 1) || dead.contains(&auv) {
                        if left.is_empty() {
                            eprintln!(
                                "warning: AUV {auv} was born again, or the record lacks what it was told, just before {:.3} s: it is replayed up \
                                 to there, and others of which this is true likewise",
                                at.as_s()
                            );
                        }
                        left.insert(auv);
                        return;
                    }
                    *last = Some(told.tick);
                    telling.ticks.entry(auv).or_default().push((at, told.stamp));
                    sensed.entry(auv).or_default().push(told);
                }
                Row::Report(row) if playing.contains_key(&row.auv) && !left.contains(&row.auv) => {
                    telling.reports.push(*row);
                }
                Row::Truth(row) if playing.contains_key(&row.auv) => telling.truth.push(row),
                Row::Log(row) if row.message.starts_with(LOST) => lost.push(row.name),
                _ => {}
            };
            rows_of(*topic, data, visit).map_err(|error| self.batches.record.wrong(&error))?;
        }
        let names = self.batches.record.names.iter().zip(0..);
        dead.extend(names.filter(|(name, _)| lost.contains(name)).map(|(_, auv)| AuvId(auv)));
        telling.sensed = sensed.into_iter().map(|(auv, items)| Batch { auv, items }).collect();
        Ok(Some(telling))
    }

    /// Plays an AUV no more.
    pub fn forget(&mut self, auv: AuvId) {
        self.left.insert(auv);
    }

    /// Names of all AUVs.
    pub fn names(&self) -> &[String] {
        &self.batches.record.names
    }

    /// What the record says of the run, by key.
    pub fn says(&self, key: &str) -> String {
        self.batches.record.run.get(key).cloned().unwrap_or_default()
    }

    /// What others on this host may know of the replay.
    pub fn description(&self) -> serde_json::Value {
        serde_json::json!({
            "format": "shoal.run/1",
            "scenario": format!("{} (replay)", self.says("scenario")),
            "seed": self.says("seed").parse::<u64>().unwrap_or_default(),
            "auvs": self.playing.len(),
            "bus": "iceoryx2",
            "launcher": std::process::id(),
        })
    }

    /// How its reading ended.
    pub fn end(&self) -> Exit {
        self.batches.record.end()
    }
}
