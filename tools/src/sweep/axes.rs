//! What a sweep goes over: seeds, and values of keys.

use std::ops::RangeInclusive;

use crate::failure::Failure;
use crate::set::Setting;

/// No sweep has more runs of one combination.
const SEEDS_MAX: u64 = 100_000;

/// Seeds to run each combination with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seeds(pub Vec<u64>);

impl Seeds {
    /// Reads `1..20`, both ends included, or `3,5,8`, or both mixed.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut seeds = Vec::new();
        for part in text.split(',') {
            let range = range(part.trim()).ok_or_else(|| {
                format!("`{part}` is no seed: write `1..20`, which has both ends, or `3,5,8`, whole numbers from 0")
            })?;
            if range.end() - range.start() >= SEEDS_MAX {
                return Err(format!("{part} has more than {SEEDS_MAX} seeds"));
            }
            seeds.extend(range);
        }
        let mut sorted = seeds.clone();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => {
                Err(format!("seed {} stands there twice; it would give the same run twice", pair[0]))
            }
            None => Ok(Self(seeds)),
        }
    }
}

fn range(part: &str) -> Option<RangeInclusive<u64>> {
    let (first, last) = match part.split_once("..") {
        Some((first, last)) => (first.parse().ok()?, last.trim_start_matches('=').parse().ok()?),
        None => (part.parse().ok()?, part.parse().ok()?),
    };
    (first <= last).then_some(first..=last)
}

/// The values of one key: at least one.
#[derive(Clone, Debug)]
pub struct Axis {
    first: Setting,
    others: Vec<Setting>,
}

impl Axis {
    /// Reads `KEY=A,B,C`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut settings = Setting::parse_list(text)?.into_iter();
        let first = settings.next().ok_or("a value is missing: write KEY=A,B,C")?;
        Ok(Self { first, others: settings.collect() })
    }

    /// The key, as it was written.
    pub fn key(&self) -> &str {
        self.first.key()
    }

    fn settings(&self) -> impl Iterator<Item = &Setting> {
        std::iter::once(&self.first).chain(&self.others)
    }
}

/// Refuses axes that say the same thing twice.
pub fn check(axes: &[Axis], has_seeds: bool) -> Result<(), Failure> {
    for (index, axis) in axes.iter().enumerate() {
        let key = axis.key();
        if axes[..index].iter().any(|other| other.key() == key) {
            let all = format!("give all of its values in one --set {key}=A,B,C");
            return Err(Failure::usage(format!("--set {key} is given twice: {all}")));
        }
        if key == "seed" && has_seeds {
            return Err(Failure::usage("--seeds and --set seed: give one of them"));
        }
    }
    Ok(())
}

/// Every combination of one value of each axis; the last axis changes fastest.
pub fn combinations(axes: &[Axis]) -> Vec<Vec<Setting>> {
    let mut combinations = vec![Vec::new()];
    for axis in axes {
        combinations = combinations
            .iter()
            .flat_map(|before| {
                axis.settings().map(|setting| [&before[..], std::slice::from_ref(setting)].concat())
            })
            .collect();
    }
    combinations
}
