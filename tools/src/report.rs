//! `shoal report`: one page that says what a run amounts to, or what two runs differ in.
//!
//! | file | what |
//! |---|---|
//! | `gather.rs` | reads a record once: figures, margins, pings by range, the summary |
//! | `margins.rs` | how far inside the enclosures the truth is, found again from what the record holds |
//! | `fates.rs` | what became of pings, by range |
//! | `contents.rs`, `proof.rs`, `comparison.rs` | the sections of the page |
//! | `page.rs` | a page: headings, tables, figures |
//! | `html.rs`, `markdown.rs` | a page as text |

mod comparison;
mod contents;
mod fates;
mod gather;
mod html;
mod margins;
mod markdown;
mod page;
mod proof;

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::exit::Exit;
use crate::failure::Failure;
use gather::{Run, gather};
use page::Page;

#[derive(Debug, Args)]
pub struct ReportArgs {
    /// The record, as `shoal run --record` leaves it
    pub record: PathBuf,
    /// Another record, to compare with
    pub other: Option<PathBuf>,
    /// File to write; standard output unless given
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Markdown instead of HTML; with --out, the figures are files of a folder beside it
    #[arg(long)]
    pub markdown: bool,
    /// AUV whose tube is shown, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub auv: u32,
}

/// Writes the report. A record that was cut is reported as far as it goes.
pub fn report(args: &ReportArgs) -> Result<Exit, Failure> {
    let paths = [Some(&args.record), args.other.as_ref()];
    let runs: Vec<Run> =
        paths.into_iter().flatten().map(|path| gather(path, args.auv)).collect::<Result<_, _>>()?;
    let is_cut = runs.iter().any(|run| run.is_cut);
    let page = match <[Run; 2]>::try_from(runs) {
        Ok([first, second]) => comparison::page(first, second),
        Err(mut runs) => match runs.pop() {
            Some(run) => contents::page(run),
            None => return Err(Failure::failed("there is no record to report")),
        },
    };
    match (args.markdown, &args.out) {
        (false, out) => put(out.as_deref(), &html::text(&page))?,
        (true, None) => put(None, &markdown::text(&page, None))?,
        (true, Some(out)) => {
            let folder = figures_of(out, &page)?;
            put(Some(out), &markdown::text(&page, Some(&folder)))?;
        }
    }
    Ok(if is_cut { Exit::Loss } else { Exit::Good })
}

fn put(out: Option<&Path>, text: &str) -> Result<(), Failure> {
    match out {
        Some(out) => std::fs::write(out, text).map_err(|error| {
            Failure::failed(format!("{}: the report cannot be written: {error}", out.display()))
        }),
        None => {
            // A reader that has enough closes the pipe.
            let _closed = std::io::stdout().lock().write_all(text.as_bytes());
            Ok(())
        }
    }
}

/// Writes the figures of a page into a folder beside `out`, `NAME-figures`, and returns what Markdown calls it.
fn figures_of(out: &Path, page: &Page) -> Result<String, Failure> {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{stem}-figures");
    let folder = out.with_file_name(&name);
    let wrong = |path: &Path, error: std::io::Error| {
        Failure::failed(format!("{}: the figures cannot be written: {error}", path.display()))
    };
    std::fs::create_dir_all(&folder).map_err(|error| wrong(&folder, error))?;
    for (file, figure) in page.figures() {
        let path = folder.join(file);
        std::fs::write(&path, figure.to_svg()).map_err(|error| wrong(&path, error))?;
    }
    Ok(name)
}

#[cfg(test)]
mod tests;
