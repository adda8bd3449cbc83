//! `shoal agent`: becomes a program of the user's that is one AUV, after tying its life to the run's.
//!
//! What kills a process with its launcher outlives the change of program, and needs no help from the program.

use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use shoal_bus::os;
use shoal_bus::run_dir::RunDir;
use shoal_bus::zenoh::{RUNTIME_ENV, ZenohFleet};
use shoal_scenario::Scenario;

use crate::cli::AgentArgs;
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::launch::Order;

/// Becomes the command; returns only when that fails.
pub fn run(args: &AgentArgs) -> Result<Exit, Failure> {
    if !os::end_with_parent(args.launcher).while_doing("tie this AUV's life to the run's")? {
        return Ok(Exit::Failed);
    }
    let Some((program, arguments)) = args.command.split_first() else {
        return Err(Failure::usage("`shoal agent` is started by `shoal run`"));
    };
    let error = Command::new(program).args(arguments).exec();
    Err(Failure::failed(format!("could not start `{program}`: {error}")))
}

/// What starts the process of one such AUV, behind this program's own file: it says where to join, and as whom.
pub fn describe(command: &mut Command, of_user: &[String], run: &RunDir, order: &Order, auv: u32) {
    let endpoint = order.endpoint.clone().unwrap_or_else(|| ZenohFleet::local_endpoint(run));
    let auv = auv.to_string();
    command.args(["agent", "--launcher", &std::process::id().to_string(), "--"]).args(of_user);
    command.args(["--endpoint", &endpoint, "--run", run.id(), "--auv", &auv]);
    command.env("SHOAL_ENDPOINT", &endpoint).env("SHOAL_RUN", run.id()).env("SHOAL_AUV", &auv);
    command.env(RUNTIME_ENV.0, RUNTIME_ENV.1).current_dir(&order.folder);
}

/// Refuses a scenario one of whose groups has a command that cannot be started, before anything is.
pub fn check_commands(scenario: &Scenario, order: &Order) -> Result<(), Failure> {
    for group in &scenario.groups {
        let Some(program) = group.command.as_ref().and_then(|command| command.first()) else { continue };
        let refused = |cause: &str, fix: &str| {
            let name = &group.name;
            Err(Failure::usage(format!("the command of group `{name}` cannot be started: {cause}; {fix}")))
        };
        if program.contains('/') {
            let path = order.folder.join(program);
            let path = path.display();
            if !order.folder.join(program).is_file() {
                return refused(
                    &format!("there is no file `{path}`"),
                    "paths are relative to the scenario file",
                );
            }
            if !is_executable(&order.folder.join(program)) {
                return refused(
                    &format!("`{path}` is not executable"),
                    "make it so with `chmod +x`, or put what runs it in front, as in `[\"python3\", \"agent.py\"]`",
                );
            }
        } else if !in_path(program).any(|path| is_executable(&path)) {
            let here = if order.folder.join(program).is_file() {
                format!("write `./{program}` for the file beside the scenario")
            } else {
                "install it, or write the path of its file".to_owned()
            };
            return refused(&format!("there is no program `{program}` in PATH"), &here);
        }
    }
    Ok(())
}

/// Refuses a scenario with programs of the user's where everything happens in this one: other minds in their place would be another run.
pub fn needs_no_processes(scenario: &Scenario, fix: &str) -> Result<(), Failure> {
    match scenario.groups.iter().find(|group| group.command.is_some()) {
        Some(group) => Err(Failure::usage(format!(
            "the AUVs of group `{}` are programs of their own, and the local bus has no processes; {fix}",
            group.name
        ))),
        None => Ok(()),
    }
}

/// Where a program of this name would be.
fn in_path(program: &str) -> impl Iterator<Item = PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = std::env::split_paths(&folders).collect();
    folders.into_iter().map(move |folder| folder.join(program))
}

fn is_executable(path: &Path) -> bool {
    path.metadata().is_ok_and(|of| of.is_file() && of.permissions().mode() & 0o111 != 0)
}
