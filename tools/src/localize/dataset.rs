//! Localization from odometry, beacons and ranges in a folder.

use std::f64::consts::PI;
use std::io::Write;
use std::path::Path;

use shoal_auv::beacons::{
    EkfSettings, HeadingSearch, OdometryBounds, Start, Track, TubeSettings, dead_reckoning, ekf,
    search_heading, tube,
};
use shoal_interval::{Interval, IntervalBox};

use super::files::Dataset;
use super::report::Report;
use super::{DatasetBounds, EstimatorKind, FirstPose, LocalizeArgs, map};
use crate::exit::Exit;
use crate::failure::{Failure, While};

/// Reads the folder, estimates, prints how it went and draws it.
pub fn localize(folder: &Path, args: &LocalizeArgs) -> Result<Exit, Failure> {
    let dataset = Dataset::read(folder)?;
    let start = start(&dataset, args)?;
    let (track, report) = estimate(&dataset, &start, args);
    if let Some(out) = &args.out {
        let svg = map::figure(&dataset, &track, &report, &title(args)).to_svg();
        std::fs::write(out, svg).map_err(|error| {
            Failure::failed(format!("{}: the figure cannot be written: {error}", out.display()))
        })?;
    }
    let text = if args.json {
        serde_json::to_string(&report).while_doing("print the result")?
    } else {
        told(&dataset, &start, args, &report)
    };
    // A reader that has enough closes the pipe.
    let _closed = writeln!(std::io::stdout().lock(), "{}", text.trim_end());
    Ok(Exit::Good)
}

/// What the figure is called.
fn title(args: &LocalizeArgs) -> String {
    let filter = match (args.estimator, args.bounds.gate_sigma()) {
        (EstimatorKind::Ekf, Some(gate)) => format!(", gate {gate} sigma"),
        (EstimatorKind::Ekf, None) => ", no gate".to_owned(),
        _ => String::new(),
    };
    format!("Localized by {}{filter}", args.estimator.name())
}

/// Runs the estimator of the command line.
pub(super) fn estimate(dataset: &Dataset, start: &Start, args: &LocalizeArgs) -> (Track, Report) {
    let name = args.estimator.name();
    let mission = &dataset.mission;
    let odometry = odometry(&args.bounds);
    match args.estimator {
        EstimatorKind::DeadReckoning => {
            let track = dead_reckoning(mission, start, &odometry);
            let report = Report::new(name, &track, false, dataset);
            (track, report)
        }
        EstimatorKind::Ekf => {
            let settings = EkfSettings {
                step_m: odometry.step_m,
                relative: odometry.relative,
                turn_rad: odometry.turn_rad,
                sigma_m: args.bounds.sigma_m,
                gate: args.bounds.gate_sigma(),
            };
            let track = ekf(mission, start, &settings);
            let report = Report::new(name, &track, true, dataset);
            (track, report)
        }
        EstimatorKind::Tube => {
            let online = tube(mission, start, &tube_settings(&args.bounds, false));
            let online_report = Report::new(name, &online, true, dataset);
            if args.bounds.online {
                return (online, online_report);
            }
            let track = tube(mission, start, &tube_settings(&args.bounds, true));
            let report =
                Report { online: Some(Box::new(online_report)), ..Report::new(name, &track, true, dataset) };
            (track, report)
        }
    }
}

/// What is known of the first pose.
pub(super) fn start(dataset: &Dataset, args: &LocalizeArgs) -> Result<Start, Failure> {
    let bounds = &args.bounds;
    let reference = dataset.reference.as_ref().and_then(|reference| reference.first());
    let unless_given = if reference.is_some() { FirstPose::Reference } else { FirstPose::Unknown };
    let around = |position_m: nalgebra::Vector2<f64>, heading_rad| Start {
        position_m: IntervalBox::centred(&position_m, bounds.start_m),
        heading_rad: Interval::centred(heading_rad, bounds.heading_rad),
    };
    match (bounds.start.unwrap_or(unless_given), reference) {
        (FirstPose::At([x_m, y_m, heading_rad]), _) => {
            Ok(around(nalgebra::Vector2::new(x_m, y_m), heading_rad))
        }
        (FirstPose::Reference, Some(first)) => Ok(around(first.position_m, first.heading_rad)),
        (FirstPose::Reference, None) => Err(Failure::usage(
            "there is no ref_poses.csv to start from: give `--start X,Y,HEADING` or `--start unknown`",
        )),
        (FirstPose::Unknown, _) => search(dataset, args),
    }
}

/// Looks for a start that agrees with the whole mission.
fn search(dataset: &Dataset, args: &LocalizeArgs) -> Result<Start, Failure> {
    let anywhere = Start { position_m: dataset.mission.area_m(), heading_rad: Interval::spanning(-PI, PI) };
    let settings = tube_settings(&args.bounds, false);
    let search = HeadingSearch { precision_rad: (2.0 * args.bounds.heading_rad).max(1e-3) };
    let heading_rad = search_heading(&dataset.mission, &anywhere, &settings, &search);
    if heading_rad.is_empty() {
        return Err(Failure::failed(
            "no heading at the start agrees with the bounds: allow more with --outliers, --range-m or --step-relative",
        ));
    }
    Ok(Start { heading_rad, ..anywhere })
}

fn odometry(bounds: &DatasetBounds) -> OdometryBounds {
    OdometryBounds { step_m: bounds.step_m, relative: bounds.step_relative, turn_rad: bounds.turn_rad }
}

fn tube_settings(bounds: &DatasetBounds, smoothed: bool) -> TubeSettings {
    TubeSettings {
        odometry: odometry(bounds),
        range_m: bounds.range_m,
        window: bounds.window as usize,
        outliers: bounds.outliers as usize,
        margin: bounds.margin as usize,
        precision_m: bounds.precision_m,
        smoothed,
    }
}

/// The result for people, with what was assumed.
fn told(dataset: &Dataset, start: &Start, args: &LocalizeArgs, report: &Report) -> String {
    let mission = &dataset.mission;
    let bounds = &args.bounds;
    let reference = if dataset.reference.is_some() { "a reference" } else { "no reference" };
    let mut text = format!(
        "{} poses, {} ranges to {} beacons, {reference}\n  start        {:.1} m, heading {:.3} rad\n  \
        odometry     {} m + {} % of each step, {} rad a turn\n",
        mission.pose_count(),
        mission.ranges().len(),
        mission.beacons_m().len(),
        start.position_m,
        start.heading_rad,
        bounds.step_m,
        100.0 * bounds.step_relative,
        bounds.turn_rad,
    );
    match args.estimator {
        EstimatorKind::DeadReckoning => {}
        EstimatorKind::Tube => text.push_str(&format!(
            "  ranges       {} m either way, at most {} of {} successive ones are outliers, margin {}\n",
            bounds.range_m, bounds.outliers, bounds.window, bounds.margin
        )),
        EstimatorKind::Ekf => {
            let sigma = bounds.sigma_m.map_or("as stated".to_owned(), |sigma_m| format!("{sigma_m} m"));
            let gate = bounds.gate_sigma().map_or("no gate".to_owned(), |gate| format!("gate {gate} sigma"));
            text.push_str(&format!("  ranges       standard deviation {sigma}, {gate}\n"));
        }
    }
    match &report.online {
        Some(online) => {
            text.push_str(&online.text("tube, online"));
            text.push_str(&report.text("tube, back and forth"));
        }
        None => text.push_str(&report.text(report.estimator)),
    }
    text
}
