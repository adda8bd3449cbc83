//! `shoal localize`: finds out where vehicles were, after the run or from files.
//!
//! | file | idea |
//! |---|---|
//! | `recorded.rs` | what a record holds for it |
//! | `offline.rs` | all trajectories of a record at once |
//! | `outcome.rs` | widths, containment: the table |
//! | `dataset.rs` | odometry, beacons and ranges from a folder |
//! | `files.rs` | the files of such a folder, with all that can be wrong in them |
//! | `table.rs` | one file of comma-separated values |
//! | `report.rs` | how good an estimate is |
//! | `map.rs` | the figure |

mod dataset;
mod files;
mod map;
mod offline;
mod outcome;
mod recorded;
mod report;
mod table;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::exit::Exit;
use crate::failure::Failure;

/// What to localize, from what, and how.
#[derive(Debug, Args)]
pub struct LocalizeArgs {
    /// The record, as `shoal run --record` leaves it
    pub record: Option<PathBuf>,
    /// From all of the record: every ping contracts both its ends, forward and backward in time
    #[arg(long, requires = "record")]
    pub offline: bool,
    /// Instead of a record: folder with beacons.csv (id,x_m,y_m), odom.csv (from,to,dx_m,dy_m,dtheta_rad), ranges.csv
    /// (pose,beacon,range_m,sigma_m) and, to compare with, ref_poses.csv (pose,x_m,y_m,theta_rad)
    #[arg(long, value_name = "DIR")]
    pub dataset: Option<PathBuf>,
    /// Who estimates from the data set
    #[arg(long, value_enum, default_value_t = EstimatorKind::Tube, requires = "dataset")]
    pub estimator: EstimatorKind,
    /// File to write: of a record a copy with the trajectories, RECORD.offline.mcap unless given; of a data set a figure (SVG) of
    /// map, error and width
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Print the outcome as one JSON line
    #[arg(long)]
    pub json: bool,
    /// No progress bar
    #[arg(long, short)]
    pub quiet: bool,
    #[command(flatten)]
    pub bounds: DatasetBounds,
}

/// Who estimates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EstimatorKind {
    /// A tube of boxes that holds the truth as long as the bounds hold, with outliers
    Tube,
    /// An extended Kalman filter: bounds of the odometry count as standard deviations
    Ekf,
    /// Odometry alone
    DeadReckoning,
}

impl EstimatorKind {
    /// As on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tube => "tube",
            Self::Ekf => "ekf",
            Self::DeadReckoning => "dead-reckoning",
        }
    }
}

/// What is believed of the measurements in a data set.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Data set")]
#[group(requires = "dataset")]
pub struct DatasetBounds {
    /// First pose: `reference` (the first of ref_poses.csv), `unknown` (searched for), or X,Y,HEADING in metres and radians;
    /// the reference when there is one
    #[arg(long, value_name = "POSE", allow_hyphen_values = true, value_parser = FirstPose::parse)]
    pub start: Option<FirstPose>,
    /// How wrong a known first position may be along each axis, in metres
    #[arg(long, value_name = "METRES", default_value_t = 5.0, value_parser = bound)]
    pub start_m: f64,
    /// How wrong a known first heading may be, in radians
    #[arg(long, value_name = "RADIANS", default_value_t = 0.03, value_parser = bound)]
    pub heading_rad: f64,
    /// Longest error of a step's displacement, in metres, whatever its length
    #[arg(long, value_name = "METRES", default_value_t = 0.1, value_parser = bound)]
    pub step_m: f64,
    /// What is added to it for each metre of the step
    #[arg(long, value_name = "PART", default_value_t = 0.03, value_parser = bound)]
    pub step_relative: f64,
    /// Greatest error of a step's turn, in radians; it adds up
    #[arg(long, value_name = "RADIANS", default_value_t = 1e-4, value_parser = bound)]
    pub turn_rad: f64,
    /// For `tube`: greatest error of a range that is no outlier, in metres
    #[arg(long, value_name = "METRES", default_value_t = 10.0, value_parser = positive)]
    pub range_m: f64,
    /// For `tube`: so many successive ranges are looked at together
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub window: u32,
    /// For `tube`: at most so many of them are outliers; with more, the search begins anew
    #[arg(long, value_name = "COUNT", default_value_t = 5, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub outliers: u32,
    /// For `tube`: so many are tolerated beyond the least number that explains the ranges
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub margin: u32,
    /// For `tube`: how fine the plane is searched, in metres
    #[arg(long, value_name = "METRES", default_value_t = 0.5, value_parser = positive)]
    pub precision_m: f64,
    /// For `tube`: do not look back from the end
    #[arg(long)]
    pub online: bool,
    /// For `ekf`: standard deviation of the ranges, in metres; as ranges.csv states it unless given
    #[arg(long, value_name = "METRES", value_parser = positive)]
    pub sigma_m: Option<f64>,
    /// For `ekf`: ranges that surprise by more standard deviations are rejected; 0 for none [default: 3]
    #[arg(long, value_name = "SIGMAS", value_parser = bound)]
    pub gate: Option<f64>,
}

/// Where a mission begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstPose {
    /// At the first pose of the reference.
    Reference,
    /// Anywhere in hearing range of a beacon, with any heading.
    Unknown,
    /// There: x and y in metres, heading in radians.
    At([f64; 3]),
}

impl FirstPose {
    fn parse(text: &str) -> Result<Self, String> {
        match text {
            "reference" => return Ok(Self::Reference),
            "unknown" => return Ok(Self::Unknown),
            _ => {}
        }
        let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x_m, y_m, heading_rad]) if [x_m, y_m, heading_rad].iter().all(|n| n.abs() <= 1e9) => {
                Ok(Self::At([x_m, y_m, heading_rad]))
            }
            _ => Err("give `reference`, `unknown`, or three numbers such as `499.2,334,2.34`".to_owned()),
        }
    }
}

impl DatasetBounds {
    /// The filter's gate in standard deviations; `None` when it believes every range.
    fn gate_sigma(&self) -> Option<f64> {
        Some(self.gate.unwrap_or(3.0)).filter(|gate| *gate > 0.0)
    }
}

impl LocalizeArgs {
    /// Refuses what only a Kalman filter heeds, when another estimator is asked for.
    fn of_the_filter(&self) -> Result<(), Failure> {
        let given = [("--gate", self.bounds.gate), ("--sigma-m", self.bounds.sigma_m)];
        match given.into_iter().find(|(_, value)| value.is_some()) {
            Some((flag, _)) if self.estimator != EstimatorKind::Ekf => Err(Failure::usage(format!(
                "{flag} means nothing to --estimator {}: leave it out, or choose `--estimator ekf`",
                self.estimator.name()
            ))),
            _ => Ok(()),
        }
    }
}

/// Localizes, prints how well, and writes what was found.
pub fn localize(args: &LocalizeArgs) -> Result<Exit, Failure> {
    match (&args.record, &args.dataset) {
        (Some(_), Some(_)) => Err(Failure::usage(
            "both a record and a data set are given: choose `RECORD --offline` or `--dataset DIR`",
        )),
        (Some(record), None) if args.offline => offline::localize(record, args),
        (None, Some(folder)) => {
            args.of_the_filter()?;
            dataset::localize(folder, args)
        }
        (Some(_), None) => Err(Failure::usage(
            "say how to localize: add `--offline` for all trajectories of the record together",
        )),
        (None, None) => Err(Failure::usage(
            "say from what to localize: `RECORD --offline`, or `--dataset DIR` for a folder of files",
        )),
    }
}

/// A bound of an error.
fn bound(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=1e6).contains(number));
    number.ok_or_else(|| "give a number from 0 to 1000000".to_owned())
}

/// A length that must not vanish.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (1e-3..=1e6).contains(number));
    number.ok_or_else(|| "give a number from 0.001 to 1000000".to_owned())
}

#[cfg(test)]
mod tests;
