//! What the command line changes in a scenario.

use crate::model::{Fault, MediumAccess, Noise, Place, Scenario, WaterSabotage};
use crate::time::{NotWhole, ms_text, ns_of_decimal};
use crate::{AUVS_MAX, window_limit_ns};

/// Changes to a scenario; `None` leaves it as its file says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// `--seed`.
    pub seed: Option<u64>,
    /// `--auvs`: scales all groups in proportion.
    pub auvs: Option<u32>,
    /// `--duration-s`.
    pub duration_s: Option<f64>,
    /// `--window-ms`.
    pub window_ms: Option<f64>,
    /// `--noise`.
    pub noise: Option<Noise>,
}

/// Why an override is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OverrideError {
    /// Fewer AUVs than groups.
    #[error(
        "--auvs {auvs}: the scenario `{scenario}` needs {groups} or more, at least one AUV for each of its groups"
    )]
    FewerAuvsThanGroups {
        /// AUVs asked for.
        auvs: u32,
        /// Groups there are.
        groups: usize,
        /// Name of the scenario.
        scenario: String,
    },
    /// More AUVs than a run can have.
    #[error("--auvs {auvs}: a run has at most {AUVS_MAX} AUVs")]
    TooManyAuvs {
        /// AUVs asked for.
        auvs: u32,
    },
    /// A group has one start point per AUV.
    #[error(
        "--auvs {auvs}: group `{group}` would have {count} AUVs but has {points} start points, one per AUV; \
         edit `start.points_m` in the scenario file, or give the group a `region_m`"
    )]
    StartPoints {
        /// AUVs asked for.
        auvs: u32,
        /// The group.
        group: String,
        /// AUVs it would have.
        count: u32,
        /// Points it has.
        points: usize,
    },
    /// A group has a grid of start points with one for each AUV.
    #[error(
        "--auvs {auvs}: group `{group}` would have {count} AUVs but its grid has {points} points; \
         add rows to `start.grid` in the scenario file"
    )]
    StartGrid {
        /// AUVs asked for.
        auvs: u32,
        /// The group.
        group: String,
        /// AUVs it would have.
        count: u32,
        /// Points it has.
        points: u64,
    },
    /// The AUV whose truth is shifted, or that is kidnapped, would be gone.
    #[error("--auvs {auvs}: the scenario has something in store for AUV {auv}, counted from 0; ask for {} or more", .auv + 1)]
    SabotagedAuvGone {
        /// AUVs asked for.
        auvs: u32,
        /// The AUV.
        auv: u32,
    },
    /// Not a time a run can last.
    #[error("--duration-s {value:?}: {why}")]
    Duration {
        /// Value asked for.
        value: f64,
        /// What a duration must be.
        why: String,
    },
    /// Not a window a run can have.
    #[error("--window-ms {value:?}: {why}")]
    Window {
        /// Value asked for.
        value: f64,
        /// What a window must be.
        why: String,
    },
}

impl Overrides {
    /// The scenario with these changes.
    ///
    /// `--auvs` shares the AUVs among the groups in proportion to their counts by largest remainder, at least one
    /// each; among equal remainders the earlier group goes first. A frame that has one slot for each AUV keeps to that.
    ///
    /// # Errors
    /// [`OverrideError`] when the changed scenario could not run; it names the flag.
    pub fn apply(&self, mut scenario: Scenario) -> Result<Scenario, OverrideError> {
        if let Some(seed) = self.seed {
            scenario.seed = seed;
        }
        if let Some(noise) = self.noise {
            scenario.noise = noise;
        }
        if let Some(auvs) = self.auvs {
            rescale(&mut scenario, auvs)?;
        }
        if let Some(value) = self.duration_s {
            scenario.duration_ns = duration_ns(&scenario, value)?;
        }
        if let Some(value) = self.window_ms {
            scenario.window_ns = window_ns(&scenario, value)?;
        }
        Ok(scenario)
    }
}

fn duration_ns(scenario: &Scenario, value: f64) -> Result<i64, OverrideError> {
    let refuse = |why: String| Err(OverrideError::Duration { value, why });
    let ns = match ns_of_decimal(&value.to_string(), 9) {
        Ok(ns) if ns > 0 => ns,
        Ok(_) => return refuse("a run lasts more than 0 s".into()),
        Err(NotWhole) => {
            return refuse("a duration is a finite, whole number of nanoseconds below 292 years".into());
        }
    };
    match scenario.sabotage {
        Some(WaterSabotage::ShiftedTruth { at_ns, .. }) if at_ns >= ns => refuse(format!(
            "the scenario shifts a truth at {} s, so the run must last longer",
            at_ns as f64 / 1e9
        )),
        _ => {
            match scenario.faults.iter().map(|Fault::Kidnap { at_ns, .. }| *at_ns).find(|at_ns| *at_ns >= ns)
            {
                Some(at_ns) => refuse(format!(
                    "the scenario has a fault at {} s, so the run must last longer",
                    at_ns as f64 / 1e9
                )),
                None => Ok(ns),
            }
        }
    }
}

fn window_ns(scenario: &Scenario, value: f64) -> Result<i64, OverrideError> {
    let refuse = |why: String| Err(OverrideError::Window { value, why });
    let ns = match ns_of_decimal(&value.to_string(), 6) {
        Ok(ns) if ns > 0 => ns,
        Ok(_) => return refuse("a window is longer than 0 ms".into()),
        Err(NotWhole) => return refuse("a window is a finite, whole number of nanoseconds".into()),
    };
    let limit_ns = scenario
        .groups
        .iter()
        .map(|group| window_limit_ns(group.reaction_ns, group.clock.drift_bound))
        .min()
        .unwrap_or(i64::MAX);
    if ns > limit_ns {
        return refuse(format!(
            "a window must end before any AUV can act on what happens in it; the longest in whole ms for `{}` is {} ms",
            scenario.name,
            ms_text(limit_ns)
        ));
    }
    Ok(ns)
}

fn rescale(scenario: &mut Scenario, auvs: u32) -> Result<(), OverrideError> {
    let groups = scenario.groups.len();
    if auvs > AUVS_MAX {
        return Err(OverrideError::TooManyAuvs { auvs });
    }
    if (auvs as usize) < groups {
        return Err(OverrideError::FewerAuvsThanGroups { auvs, groups, scenario: scenario.name.clone() });
    }
    let sabotaged = scenario.sabotage.map(|WaterSabotage::ShiftedTruth { auv, .. }| auv);
    let kidnapped = scenario.faults.iter().map(|Fault::Kidnap { auv, .. }| *auv);
    if let Some(auv) = sabotaged.into_iter().chain(kidnapped).find(|auv| *auv >= auvs) {
        return Err(OverrideError::SabotagedAuvGone { auvs, auv });
    }
    let auvs_before = scenario.auv_count();
    let counts = shares(&scenario.groups.iter().map(|group| group.count).collect::<Vec<_>>(), auvs);
    for (group, count) in scenario.groups.iter_mut().zip(counts) {
        if let Place::Points(points) = &group.start.place
            && points.len() != count as usize
        {
            return Err(OverrideError::StartPoints {
                auvs,
                group: group.name.clone(),
                count,
                points: points.len(),
            });
        }
        if let Place::Grid(grid) = &group.start.place
            && grid.points() < u64::from(count)
        {
            let (group, points) = (group.name.clone(), grid.points());
            return Err(OverrideError::StartGrid { auvs, group, count, points });
        }
        group.count = count;
        if let MediumAccess::Slotted { slots, .. } = &mut group.modem.access
            && *slots == auvs_before
        {
            *slots = auvs;
        }
    }
    Ok(())
}

/// Shares `auvs` in proportion to `counts` by largest remainder, at least one each; `auvs >= counts.len()`.
fn shares(counts: &[u32], auvs: u32) -> Vec<u32> {
    let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
    if total == 0 {
        return counts.to_vec();
    }
    let quota = |count: u32| u64::from(count) * u64::from(auvs);
    // A quota is at most `auvs`, so the quotient fits.
    let mut shared: Vec<u32> = counts.iter().map(|&count| ((quota(count) / total) as u32).max(1)).collect();
    let mut by_remainder: Vec<usize> = (0..counts.len()).collect();
    by_remainder.sort_by_key(|&index| (std::cmp::Reverse(quota(counts[index]) % total), index));
    let mut given: u32 = shared.iter().sum();
    for &index in by_remainder.iter().cycle().take_while(|_| !counts.is_empty()) {
        if given >= auvs {
            break;
        }
        shared[index] += 1;
        given += 1;
    }
    // The least of one AUV each may have given out too many: the largest groups give them back.
    while given > auvs {
        let Some(largest) = shared.iter_mut().max_by_key(|share| **share).filter(|share| **share > 1) else {
            break;
        };
        *largest -= 1;
        given -= 1;
    }
    shared
}

#[cfg(test)]
mod tests {
    use super::shares;

    #[test]
    fn shares_are_proportional_and_never_nothing() {
        assert_eq!(shares(&[500, 300, 200], 10), [5, 3, 2]);
        assert_eq!(shares(&[500, 300, 200], 11), [6, 3, 2]);
        assert_eq!(shares(&[1000, 1, 1], 3), [1, 1, 1]);
        assert_eq!(shares(&[1000, 1, 1], 10), [8, 1, 1]);
        assert_eq!(shares(&[1], 65_536), [65_536]);
        for auvs in 3..200 {
            assert_eq!(shares(&[7, 90, 3], auvs).iter().sum::<u32>(), auvs);
        }
    }
}
