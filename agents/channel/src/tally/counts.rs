//! What can be counted piece by piece of the swarm and added up.

use std::collections::BTreeSet;

use shoal_bus::chronicle::{Entry, Violation, What};
use shoal_bus::message::AuvId;
use shoal_bus::summary::{Lost, Pings};
use shoal_bus::time::SimTime;
use shoal_bus::traffic::{Fate, LossReason, Traffic};

/// So many violations are told one by one in a summary.
const VIOLATIONS_TOLD: usize = 10;

/// Counts of what happened to some AUVs for some time. Added up in the order of the AUVs they are the same however the swarm was cut.
#[derive(Default)]
pub struct Counts {
    /// What happened since it was last taken, in no particular order but that of each AUV.
    pub entries: Vec<Entry>,
    /// Ticks answered.
    pub wakes: u64,
    /// Enclosures checked.
    pub checks: u64,
    /// Violations of a promise.
    pub violations: u64,
    /// Violations of AUVs that were told more that is false than they were to expect.
    pub misled: Apart,
    /// Violations of AUVs that were carried elsewhere and have not noticed yet.
    pub kidnapped: Apart,
    /// Nanoseconds from each kidnapping that was noticed until it was.
    pub noticed_after_ns: Vec<i64>,
    /// The first of the violations of a promise, by (true time, AUV).
    pub first_violations: Vec<(SimTime, AuvId, Violation)>,
    /// Pings by their fates.
    pub pings: Pings,
}

/// Why a violation is counted apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Excuse {
    /// The AUV was told more that is false than it was to expect.
    Misled,
    /// The AUV was carried elsewhere and has not noticed yet.
    Kidnapped,
}

/// Violations that are counted apart.
#[derive(Default)]
pub struct Apart {
    /// Who is concerned.
    pub auvs: BTreeSet<AuvId>,
    /// How many there are.
    pub violations: u64,
}

impl Apart {
    fn add(&mut self, auv: AuvId) {
        self.auvs.insert(auv);
        self.violations += 1;
    }

    fn take(&mut self, other: &mut Self) {
        self.auvs.append(&mut other.auvs);
        self.violations += std::mem::take(&mut other.violations);
    }
}

impl Counts {
    /// Something happened.
    pub fn happened(&mut self, at: SimTime, auv: AuvId, what: What) {
        self.wakes += u64::from(matches!(what, What::Acted(_)));
        self.entries.push(Entry { at, auv, what });
    }

    /// A ping met its fate; `auv` is whose entry it is.
    pub fn traffic(&mut self, auv: AuvId, traffic: Traffic) {
        match traffic.fate {
            Fate::Emitted { beyond_range, .. } => {
                self.pings.emitted += 1;
                self.pings.lost.range += u64::from(beyond_range);
            }
            Fate::Heard { outlier, .. } => {
                self.pings.heard += 1;
                self.pings.outliers += u64::from(outlier);
            }
            Fate::Lost { to: None, reason: LossReason::HalfDuplex, .. } => self.pings.lost.unsent += 1,
            Fate::Lost { reason, .. } => {
                let lost = &mut self.pings.lost;
                *match reason {
                    LossReason::Range => &mut lost.range,
                    LossReason::Noise => &mut lost.noise,
                    LossReason::Collision => &mut lost.collision,
                    LossReason::HalfDuplex => &mut lost.half_duplex,
                    LossReason::Shadow => &mut lost.shadow,
                    LossReason::Asleep => &mut lost.asleep,
                    LossReason::Band => &mut lost.band,
                    LossReason::Busy => &mut lost.busy,
                    LossReason::Late => &mut lost.late,
                    LossReason::Dead => &mut lost.dead,
                } += 1;
            }
        }
        self.happened(traffic.at, auv, What::Traffic(traffic));
    }

    /// An enclosure was checked; a violation with an excuse is counted apart.
    pub fn check(&mut self, auv: AuvId, at: SimTime, violation: Option<Violation>, excuse: Option<Excuse>) {
        self.checks += 1;
        let Some(violation) = violation else { return };
        match excuse {
            Some(Excuse::Misled) => return self.misled.add(auv),
            Some(Excuse::Kidnapped) => return self.kidnapped.add(auv),
            None => {}
        }
        self.violations += 1;
        self.first_violations.push((at, auv, violation));
        self.keep_first_violations();
        self.happened(at, auv, What::Violation(violation));
    }

    /// Adds what was counted elsewhere, where nothing is left of it.
    pub fn take(&mut self, other: &mut Self) {
        self.entries.append(&mut other.entries);
        self.wakes += std::mem::take(&mut other.wakes);
        self.checks += std::mem::take(&mut other.checks);
        self.violations += std::mem::take(&mut other.violations);
        self.misled.take(&mut other.misled);
        self.kidnapped.take(&mut other.kidnapped);
        self.noticed_after_ns.append(&mut other.noticed_after_ns);
        if !other.first_violations.is_empty() {
            self.first_violations.append(&mut other.first_violations);
            self.keep_first_violations();
        }
        add(&mut self.pings, std::mem::take(&mut other.pings));
    }

    fn keep_first_violations(&mut self) {
        self.first_violations.sort_by_key(|&(at, auv, _)| (at, auv));
        self.first_violations.truncate(VIOLATIONS_TOLD);
    }
}

/// Adds numbers of pings.
fn add(to: &mut Pings, pings: Pings) {
    let Pings { emitted, heard, lost, outliers, in_flight } = pings;
    let Lost { range, noise, collision, half_duplex, shadow, asleep, band, busy, unsent, late, dead } = lost;
    to.emitted += emitted;
    to.heard += heard;
    to.outliers += outliers;
    to.in_flight += in_flight;
    to.lost.range += range;
    to.lost.noise += noise;
    to.lost.collision += collision;
    to.lost.half_duplex += half_duplex;
    to.lost.shadow += shadow;
    to.lost.asleep += asleep;
    to.lost.band += band;
    to.lost.busy += busy;
    to.lost.unsent += unsent;
    to.lost.late += late;
    to.lost.dead += dead;
}
