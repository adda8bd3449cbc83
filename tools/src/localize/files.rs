//! The files of a data set, with all that can be wrong in them.
//!
//! | file | columns |
//! |---|---|
//! | `beacons.csv` | `id,x_m,y_m` |
//! | `odom.csv` | `from,to,dx_m,dy_m,dtheta_rad`: the way from a pose to the next, in the frame of the body at the first of them |
//! | `ranges.csv` | `pose,beacon,range_m,sigma_m` |
//! | `ref_poses.csv` | `pose,x_m,y_m,theta_rad`; may be missing |
//!
//! Poses count from 0 without a gap, x and y are any axes that stand upright on each other, and headings turn from x to y.

use std::path::Path;

use nalgebra::Vector2;
use shoal_auv::beacons::{BeaconRange, Mission, Step};

use super::table::Table;
use crate::failure::Failure;

/// A data set.
#[derive(Debug)]
pub struct Dataset {
    /// What was measured.
    pub mission: Mission,
    /// Names of the beacons.
    pub beacon_ids: Vec<String>,
    /// What to compare with: one for each pose, or nothing.
    pub reference: Option<Vec<ReferencePose>>,
}

/// Where somebody else says that the vehicle was.
#[derive(Clone, Copy, Debug)]
pub struct ReferencePose {
    /// Position, in metres.
    pub position_m: Vector2<f64>,
    /// Heading, in radians.
    pub heading_rad: f64,
}

impl Dataset {
    /// Reads a folder.
    ///
    /// # Errors
    /// A sentence with the file, the line, the cause and the fix.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        let (beacon_ids, beacons_m) = read_beacons(&folder.join("beacons.csv"))?;
        let steps = read_odometry(&folder.join("odom.csv"))?;
        let ranges = read_ranges(&folder.join("ranges.csv"), &beacon_ids, steps.len())?;
        let reference = folder.join("ref_poses.csv");
        let reference =
            if reference.exists() { Some(read_reference(&reference, steps.len())?) } else { None };
        let mission = Mission::new(beacons_m, steps, ranges)
            .map_err(|error| Failure::failed(format!("{}: {error}", folder.display())))?;
        Ok(Self { mission, beacon_ids, reference })
    }
}

fn read_beacons(path: &Path) -> Result<(Vec<String>, Vec<Vector2<f64>>), Failure> {
    let table = Table::read(path, &["id", "x_m", "y_m"])?;
    let mut ids: Vec<String> = Vec::new();
    let mut beacons_m = Vec::new();
    for row in &table.rows {
        let id = table.text(row, 0);
        if ids.iter().any(|known| known == id) {
            return Err(
                table.wrong(row.line, format!("beacon `{id}` is there already: give each its own id"))
            );
        }
        ids.push(id.to_owned());
        beacons_m.push(Vector2::new(table.number(row, 1)?, table.number(row, 2)?));
    }
    if ids.is_empty() {
        return Err(table.wrong(1, "there is no beacon: add a line for each, such as `L0,730.1,429.9`"));
    }
    Ok((ids, beacons_m))
}

fn read_odometry(path: &Path) -> Result<Vec<Step>, Failure> {
    let table = Table::read(path, &["from", "to", "dx_m", "dy_m", "dtheta_rad"])?;
    let mut steps = Vec::new();
    for row in &table.rows {
        let (from, to) = (table.index(row, 0)?, table.index(row, 1)?);
        let expected = steps.len();
        if from != expected || to != expected + 1 {
            let cause = format!(
                "this leads from pose {from} to {to}, but from {expected} to {} is next: give every step, in order",
                expected + 1
            );
            return Err(table.wrong(row.line, cause));
        }
        steps.push(Step {
            forward_m: table.number(row, 2)?,
            left_m: table.number(row, 3)?,
            turn_rad: table.number(row, 4)?,
        });
    }
    if steps.is_empty() {
        return Err(table.wrong(1, "there is no step: add a line for each, such as `0,1,3.9,0.1,-0.02`"));
    }
    Ok(steps)
}

fn read_ranges(path: &Path, beacon_ids: &[String], last_pose: usize) -> Result<Vec<BeaconRange>, Failure> {
    let table = Table::read(path, &["pose", "beacon", "range_m", "sigma_m"])?;
    let mut ranges: Vec<BeaconRange> = Vec::new();
    for row in &table.rows {
        let wrong = |cause: String| Err(table.wrong(row.line, cause));
        let pose = table.index(row, 0)?;
        if pose > last_pose {
            return wrong(format!("pose {pose} is none: odom.csv ends with pose {last_pose}"));
        }
        if ranges.last().is_some_and(|last| pose < last.pose) {
            return wrong(format!("pose {pose} comes after a later one: sort the lines by pose"));
        }
        let id = table.text(row, 1);
        let Some(beacon) = beacon_ids.iter().position(|known| known == id) else {
            return wrong(format!(
                "beacon `{id}` is not in beacons.csv, which has {}",
                beacon_ids.join(", ")
            ));
        };
        let (range_m, sigma_m) = (table.number(row, 2)?, table.number(row, 3)?);
        if range_m < 0.0 {
            return wrong(format!("range_m is {range_m}: a distance is never negative, leave the line out"));
        }
        if sigma_m <= 0.0 {
            return wrong(format!(
                "sigma_m is {sigma_m}: give a standard deviation above zero, such as 0.75"
            ));
        }
        ranges.push(BeaconRange { pose, beacon, range_m, sigma_m });
    }
    Ok(ranges)
}

fn read_reference(path: &Path, last_pose: usize) -> Result<Vec<ReferencePose>, Failure> {
    let table = Table::read(path, &["pose", "x_m", "y_m", "theta_rad"])?;
    let mut reference = Vec::new();
    for row in &table.rows {
        let pose = table.index(row, 0)?;
        if pose != reference.len() || pose > last_pose {
            let cause = format!("this is pose {pose}: give poses 0 to {last_pose}, each once, in order");
            return Err(table.wrong(row.line, cause));
        }
        reference.push(ReferencePose {
            position_m: Vector2::new(table.number(row, 1)?, table.number(row, 2)?),
            heading_rad: table.number(row, 3)?,
        });
    }
    if reference.len() != last_pose + 1 {
        let last_line = table.rows.last().map_or(1, |row| row.line);
        let cause = format!(
            "the reference ends after {} poses of {}: add the others, or remove the file",
            reference.len(),
            last_pose + 1
        );
        return Err(table.wrong(last_line, cause));
    }
    Ok(reference)
}
