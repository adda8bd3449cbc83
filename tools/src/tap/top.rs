//! `shoal tap top`: a table of the AUVs that keeps itself up to date.

mod roster;
mod screen;

use std::time::{Duration, Instant};

use shoal_bus::record::Topic;

use super::args::{Sort, TapArgs};
use super::source::{Heard, Source};
use super::{say, warn};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::terminal::{has_screen, stdout_columns};
use roster::Roster;
use screen::{Screen, Wish};

/// How often a plain table is printed of a live run.
const PERIOD: Duration = Duration::from_secs(1);

/// How often the screen is drawn anew.
const FRAME: Duration = Duration::from_millis(100);

const TOPICS: [Topic; 3] = [Topic::Reports, Topic::Pings, Topic::Log];

/// Shows the AUVs on the terminal, or prints a table a second where there is none.
pub fn top(args: &TapArgs, sort: Sort) -> Result<Exit, Failure> {
    let mut source = Source::open(&args.origin, &TOPICS)?;
    let mut roster = Roster::new(sort);
    if has_screen() && !args.form.json && !args.choice.once && args.choice.count.is_none() {
        on_screen(&mut source, &mut roster)?;
    } else {
        as_tables(args, &mut source, &mut roster)?;
    }
    Ok(warn(&source))
}

fn as_tables(args: &TapArgs, source: &mut Source, roster: &mut Roster) -> Result<(), Failure> {
    let is_live = source.run().is_some();
    let mut left = args.choice.limit();
    let mut printed = Instant::now();
    let text =
        |roster: &Roster| if args.form.json { roster.json_lines() } else { roster.table(stdout_columns()) };
    loop {
        match source.next()? {
            Heard::Window(window) => {
                roster.take(&window, source.cast());
                source.taken();
            }
            Heard::Nothing => {}
            Heard::End => break,
        }
        if is_live && printed.elapsed() >= PERIOD && !roster.is_empty() {
            printed = Instant::now();
            if !say(&text(roster))? {
                return Ok(());
            }
            left -= 1;
            if left == 0 {
                return Ok(());
            }
        }
    }
    // The last state is the one that a record, or the end of a run, leaves.
    say(&text(roster)).map(drop)
}

fn on_screen(source: &mut Source, roster: &mut Roster) -> Result<(), Failure> {
    let mut screen = Screen::open().map_err(|error| Failure::failed(format!("the terminal: {error}")))?;
    let trouble = |error: std::io::Error| Failure::failed(format!("the terminal: {error}"));
    let mut drawn: Option<Instant> = None;
    let mut is_over = false;
    loop {
        if !is_over {
            match source.next()? {
                Heard::Window(window) => {
                    roster.take(&window, source.cast());
                    source.taken();
                }
                Heard::Nothing => {}
                Heard::End if source.is_stopped() => return Ok(()),
                Heard::End => is_over = true,
            }
        }
        if is_over || drawn.is_none_or(|drawn| drawn.elapsed() >= FRAME) {
            screen.draw(roster, source, is_over).map_err(trouble)?;
            drawn = Some(Instant::now());
        }
        // A run that is over is looked at until the user has seen enough.
        let patience = if is_over { FRAME } else { Duration::ZERO };
        while let Some(wish) = screen.wish(patience, roster).map_err(trouble)? {
            match wish {
                Wish::Quit => return Ok(()),
                Wish::Redraw => drawn = None,
            }
            if is_over {
                break;
            }
        }
        if source.is_stopped() {
            return Ok(());
        }
    }
}
