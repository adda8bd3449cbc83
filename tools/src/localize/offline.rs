//! All trajectories of a record at once.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use shoal_auv::offline::{Reconstruction, Trajectory};
use shoal_bus::message::AuvId;
use shoal_bus::record::rows::{OfflineRow, Real};
use shoal_bus::record::{Ending, append_offline};

use super::LocalizeArgs;
use super::outcome::{Enclosure, LOCALIZE_FORMAT, Line, Outcome, Pose, centre_rms_m};
use super::recorded::{Told, read};
use crate::exit::Exit;
use crate::failure::{Failure, While};

/// A thread takes so large a part of its share at a time: trajectories differ in length.
const PARTS_OF_A_SHARE: usize = 4;

/// Reconstructs, writes the record with the trajectories, and prints how wide they are.
pub fn localize(record: &Path, args: &LocalizeArgs) -> Result<Exit, Failure> {
    let out = args.out.clone().unwrap_or_else(|| beside(record));
    let path = record.display();
    let wrong = |error: &dyn std::fmt::Display| Failure::failed(format!("{path}: {error}"));
    let told = read(File::open(record).map_err(|error| wrong(&error))?).map_err(|error| wrong(&error))?;
    if is_same(record, &out) {
        return Err(Failure::usage(format!("{path} would be overwritten: choose another file with --out")));
    }

    let bar = bar(args.quiet || args.json);
    let began = Instant::now();
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(told.auvs.len().max(1));
    let mut reconstruction = Reconstruction::new(&told.auvs);
    while reconstruction.round(&|trajectories, sweep| side_by_side(threads, trajectories, sweep)) {
        bar.set_message(format!("round {}", reconstruction.rounds()));
        bar.inc(1);
    }
    let solve_s = began.elapsed().as_secs_f64();
    bar.finish_and_clear();

    let poses = poses(&told, &reconstruction);
    write(record, &out, &poses)?;
    let outcome = outcome(&told, &reconstruction, &poses, (threads, solve_s));
    let text = if args.json {
        serde_json::to_string(&outcome).while_doing("print the outcome")? + "\n"
    } else {
        format!("{}trajectories written to {}\n", outcome.text(), out.display())
    };
    // Whoever closed our output does not want the outcome; the exit code still tells.
    let _closed = std::io::stdout().lock().write_all(text.as_bytes());
    if !outcome.keeps_promises() {
        return Ok(Exit::Violated);
    }
    if let Ending::Truncated { .. } = told.ending {
        eprintln!("warning: {path} ends before the run does: trajectories reach as far as it does");
        return Ok(Exit::Loss);
    }
    Ok(Exit::Good)
}

/// `flock.mcap` becomes `flock.offline.mcap`.
fn beside(record: &Path) -> PathBuf {
    record.with_extension("offline.mcap")
}

fn is_same(record: &Path, out: &Path) -> bool {
    let canonical = |path: &Path| path.canonicalize().ok();
    canonical(record).is_some() && canonical(record) == canonical(out)
}

fn bar(hidden: bool) -> ProgressBar {
    let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(None, target);
    if let Ok(style) = ProgressStyle::with_template("{spinner} reconstructing: {msg} {elapsed_precise}") {
        bar.set_style(style);
    }
    bar.set_message("own log, depths and fixes");
    bar.tick();
    bar
}

/// Sweeps over trajectories with so many threads; which takes which does not matter.
fn side_by_side(threads: usize, trajectories: &mut [Trajectory], sweep: &(dyn Fn(&mut Trajectory) + Sync)) {
    let part = trajectories.len().div_ceil(threads * PARTS_OF_A_SHARE).max(1);
    let parts = Mutex::new(trajectories.chunks_mut(part));
    let next = || parts.lock().unwrap_or_else(PoisonError::into_inner).next();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(part) = next() {
                    part.iter_mut().for_each(sweep);
                }
            });
        }
    });
}

/// By AUV, at every tick of which the record has the truth.
fn poses(told: &Told, reconstruction: &Reconstruction) -> Vec<Vec<Pose>> {
    let of = |(auv, trajectory): (usize, &Trajectory)| {
        let stamp_s = told.auvs[auv].born.clock.stamp_ns as f64 * 1e-9;
        let truths = &told.ticks[auv];
        let pose = |tick: shoal_auv::offline::Tick| {
            let index = truths.binary_search_by_key(&tick.tick, |truth| truth.tick).ok()?;
            let [alone, offline] =
                [&tick.alone, &tick.state].map(|state| Enclosure::at_stamp(state, stamp_s));
            Some(Pose { truth: truths[index], alone, offline })
        };
        trajectory.ticks().filter_map(pose).collect()
    };
    reconstruction.trajectories().iter().enumerate().map(of).collect()
}

fn write(record: &Path, out: &Path, poses: &[Vec<Pose>]) -> Result<(), Failure> {
    let mut rows: Vec<OfflineRow> = poses
        .iter()
        .enumerate()
        .flat_map(|(auv, poses)| poses.iter().map(move |pose| row(AuvId(auv as u32), pose)))
        .collect();
    rows.sort_by_key(|row| (row.t_ns, row.auv));
    let wrong = |error: &dyn std::fmt::Display| {
        Failure::failed(format!("{}: {error}; choose another place with --out", out.display()))
    };
    let source = File::open(record).map_err(|error| wrong(&error))?;
    let file = File::create(out).map_err(|error| wrong(&error))?;
    append_offline(source, BufWriter::new(file), &rows).map_err(|error| wrong(&error))?;
    Ok(())
}

fn row(auv: AuvId, pose: &Pose) -> OfflineRow {
    let pair = |bounds: [f64; 2]| bounds.map(Real);
    let Pose { truth, alone, offline } = pose;
    OfflineRow {
        auv,
        tick: truth.tick,
        t_ns: truth.at,
        local_ns: truth.local,
        alone_position_m: alone.position_m.map(pair),
        alone_clock_offset_s: pair(alone.clock_offset_s),
        position_m: offline.position_m.map(pair),
        clock_offset_s: pair(offline.clock_offset_s),
    }
}

fn outcome(
    told: &Told,
    reconstruction: &Reconstruction,
    poses: &[Vec<Pose>],
    (threads, solve_s): (usize, f64),
) -> Outcome {
    let named = told.header.auvs.iter().zip(poses);
    let each = named.clone().map(|(auv, poses)| Line::of(&auv.name, &[poses])).collect();
    let mut groups = Vec::new();
    for (group, auv) in
        told.header.auvs.iter().map(|auv| (auv.group, auv)).collect::<std::collections::BTreeMap<_, _>>()
    {
        let members: Vec<&[Pose]> =
            named.clone().filter(|(member, _)| member.group == group).map(|(_, poses)| &**poses).collect();
        groups.push(Line::of(&auv.group_name, &members));
    }
    let all: Vec<&[Pose]> = poses.iter().map(|poses| &**poses).collect();
    let all = Line::of("all", &all);
    let (tied, by_payload) = reconstruction.pings();
    Outcome {
        format: LOCALIZE_FORMAT,
        estimator: "offline",
        scenario: told.header.scenario_name.clone(),
        seed: told.header.seed,
        poses: all.poses,
        contained_fraction: if all.poses > 0 { all.contained as f64 / all.poses as f64 } else { 1.0 },
        width_median_m: all.position_width_m.median.offline,
        centre_rms_m: centre_rms_m(poses),
        ranges_used: tied - reconstruction.dropped().min(tied),
        ranges_by_payload: by_payload,
        ranges_rejected: reconstruction.dropped(),
        contradictions: reconstruction.trajectories().iter().map(Trajectory::contradictions).sum(),
        rounds: reconstruction.rounds(),
        restarts: reconstruction.restarts(),
        threads,
        solve_s,
        all,
        groups,
        each,
    }
}
