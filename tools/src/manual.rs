//! What goes with the executable: completions for shells, manual pages, the schema of scenario files. All are made from what the
//! command line and the reader of scenarios are, so that none can be out of date.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use crate::cli::Cli;
use crate::exit::Exit;
use crate::failure::{Failure, While};

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// Which shell
    #[arg(value_enum)]
    pub shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArgs {
    /// The verb, such as `plot` or `record info`; the page of shoal itself unless given
    #[arg(value_name = "VERB", conflicts_with = "out")]
    pub verb: Vec<String>,
    /// Write the pages of all verbs into this folder instead
    #[arg(long, short, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

/// Prints the JSON Schema of scenario files.
pub fn schema() -> Result<Exit, Failure> {
    Ok(print(shoal_scenario::schema().as_bytes()))
}

/// Prints completions for a shell.
pub fn completions(args: &CompletionsArgs) -> Result<Exit, Failure> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "shoal", &mut text);
    Ok(print(&text))
}

/// Prints the manual page of a verb, or writes all of them.
pub fn man(args: &ManArgs) -> Result<Exit, Failure> {
    let whole = built();
    match &args.out {
        Some(folder) => {
            std::fs::create_dir_all(folder).while_doing(&format!("make the folder {}", folder.display()))?;
            write_pages(&whole, folder)?;
            Ok(Exit::Good)
        }
        None => {
            let mut command = &whole;
            for name in &args.verb {
                command = visible(command)
                    .find(|below| below.get_name() == name)
                    .ok_or_else(|| unknown(command, name))?;
            }
            Ok(print(&page(command)?))
        }
    }
}

/// The command line with the full names of its verbs.
fn built() -> clap::Command {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    command
}

/// The verbs below a command that users call.
fn visible(command: &clap::Command) -> impl Iterator<Item = &clap::Command> {
    command.get_subcommands().filter(|below| !below.is_hide_set())
}

fn unknown(command: &clap::Command, name: &str) -> Failure {
    let known: Vec<&str> = visible(command).map(clap::Command::get_name).collect();
    match known.is_empty() {
        true => Failure::usage(format!("`{}` has no verbs: leave `{name}` out", command.get_name())),
        false => Failure::usage(format!("there is no verb `{name}`: give one of {}", known.join(", "))),
    }
}

fn page(command: &clap::Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text).while_doing("write a manual page")?;
    Ok(text)
}

/// The page of a command and of all below it.
fn write_pages(command: &clap::Command, folder: &Path) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    let path = folder.join(format!("{name}.1"));
    std::fs::write(&path, page(command)?).while_doing(&format!("write {}", path.display()))?;
    visible(command).try_for_each(|below| write_pages(below, folder))
}

fn print(text: &[u8]) -> Exit {
    // A reader that has enough closes the pipe.
    let _closed = std::io::stdout().lock().write_all(text);
    Exit::Good
}

#[cfg(test)]
mod tests;
