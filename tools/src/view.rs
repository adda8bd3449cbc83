//! `shoal view`: a run as a page in the browser, from its record or while it happens.
//!
//! | file | idea |
//! |---|---|
//! | `cast.rs` | who takes part, how far they are heard: the first message to the page |
//! | `chunk.rs` | one simulated second, gathered from the rows of a record |
//! | `chunk/layout.rs` | its bytes, as the page reads them |
//! | `store.rs` | all seconds gathered so far, on disk or the last of them in memory |
//! | `reader.rs` | a record, read once into the store |
//! | `live.rs` | a run in progress, gathered while it happens |
//! | `server.rs` | the page and its web socket, on one port of this machine |
//! | `request.rs` | who may see them |
//! | `session.rs` | one page: what it asks for, and what it is told |
//! | `export.rs` | the page and all its data in one file |
//! | `browser.rs` | how to get to see it |
//!
//! The page itself is `tools/view`: its sources, and in `dist` what `npm run build` makes of them, which is built in here.

mod browser;
mod cast;
mod chunk;
mod export;
mod live;
mod reader;
mod request;
mod server;
mod session;
mod store;

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use clap::Args;

use crate::exit::Exit;
use crate::failure::{Failure, While};
use server::Server;
use store::Store;

/// How often it is looked whether somebody wants it to end.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// What is kept of a live run: with a thousand AUVs that tick ten times a second, the last five minutes.
const LIVE_BYTES: usize = 512 << 20;

/// What to show, and where.
#[derive(Debug, Args)]
pub struct ViewArgs {
    /// The record, as `shoal run --record` leaves it
    #[arg(required_unless_present = "live")]
    pub record: Option<PathBuf>,
    /// Instead of a record: a run in progress on this host, of which the last minutes are kept
    #[arg(long, conflicts_with = "record")]
    pub live: bool,
    /// For `--live`: id or scenario of the run, when there are several
    #[arg(long, value_name = "RUN", requires = "live")]
    pub run: Option<String>,
    /// For `--live`: wait so many seconds for a run to begin
    #[arg(long, value_name = "SECONDS", default_value = "0", requires = "live", value_parser = patience)]
    pub wait: Duration,
    /// Port of this machine to serve the page on; a free one unless given
    #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Only print the address, do not open a browser
    #[arg(long)]
    pub no_open: bool,
    /// Instead of serving it, write the page with all its data to one file that opens without Shoal
    #[arg(long, value_name = "FILE.html", conflicts_with_all = ["live", "port", "no_open", "json"])]
    pub export: Option<PathBuf>,
    /// Print the address as one JSON line
    #[arg(long)]
    pub json: bool,
}

/// Serves the page until it is interrupted, or writes it to a file.
pub fn view(args: &ViewArgs) -> Result<Exit, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let (cast, store, watching) = match &args.record {
        Some(record) => {
            let store = Arc::new(Store::on_disk().while_doing("make a temporary file")?);
            let reading = reader::start(record, Arc::clone(&store))?;
            if let Some(file) = &args.export {
                return export::export(file, reading);
            }
            heed_signals(&stop)?;
            (reading.cast, store, None)
        }
        None => {
            heed_signals(&stop)?;
            let store = Arc::new(Store::in_memory(LIVE_BYTES));
            let watching =
                live::start(args.run.as_deref(), args.wait, Arc::clone(&store), Arc::clone(&stop))?;
            (watching.cast, store, Some(watching.thread))
        }
    };
    let server = Server::bind(args.port)
        .map_err(|error| Failure::usage(format!("port {} of this machine: {error}", args.port)))?;
    announce(&server, args);
    server.serve(cast, store).while_doing("start a thread")?;
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(LOOK_AGAIN);
    }
    // A tap that leaves properly leaves nothing behind.
    watching.map(std::thread::JoinHandle::join);
    Ok(Exit::Good)
}

/// Ctrl-C ends the page, not the process in the middle of something.
fn heed_signals(stop: &Arc<AtomicBool>) -> Result<(), Failure> {
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(stop)).while_doing("listen for Ctrl-C")?;
    }
    Ok(())
}

/// Tells where the page is, and opens it if there is a browser.
fn announce(server: &Server, args: &ViewArgs) {
    let url = server.url();
    let mut out = std::io::stdout().lock();
    // Whoever does not want to know has closed the pipe, and may know the address all the same.
    let _closed = if args.json {
        let line = serde_json::json!({ "format": "shoal.view/1", "url": url, "port": server.port() });
        writeln!(out, "{line}")
    } else {
        writeln!(out, "{url}")
    };
    let _closed = out.flush();
    drop(out);
    if let Some(line) = browser::tunnel(server.port()) {
        eprintln!(
            "This is a remote shell. To see the page on your own machine, run there:\n  {line}\nand open the address above."
        );
    } else if !args.no_open && browser::open(&url) {
        eprintln!("Opened in the browser. Ctrl-C ends it.");
    } else {
        eprintln!("Open this address in a browser on this machine. Ctrl-C ends it.");
    }
}

fn patience(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.0..=1e6).contains(seconds));
    seconds.map(Duration::from_secs_f64).ok_or_else(|| "give seconds from 0 to 1000000".to_owned())
}
