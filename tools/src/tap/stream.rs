//! Prints messages one by one: the default, and `echo`.

use shoal_bus::record::{Row, Topic};
use shoal_bus::tap::Cast;

use super::args::TapArgs;
use super::choice::Choice;
use super::print::{Printer, Stop};
use super::source::{Heard, Source};
use super::warn;
use crate::exit::Exit;
use crate::failure::Failure;

/// Prints the chosen messages of `topic` until the run ends, or as many as `--count` says are printed.
pub fn stream(args: &TapArgs, topic: Topic) -> Result<Exit, Failure> {
    let choice = Choice::new(&args.choice, topic)?;
    let mut printer = Printer::new(&args.form, topic)?;
    let mut source = Source::open(&args.origin, &[topic])?;
    let mut left = args.choice.limit();
    match follow(&mut source, topic, &choice, &mut printer, &mut left) {
        Ok(()) | Err(Ended::Quietly) => {}
        Err(Ended::Failing(failure)) => return Err(failure),
    }
    // Who has what was asked for misses nothing.
    Ok(if left == 0 { Exit::Good } else { warn(&source) })
}

/// Why following ends before the messages do.
enum Ended {
    Quietly,
    Failing(Failure),
}

impl From<Stop> for Ended {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::Closed => Self::Quietly,
            Stop::Failed(error) => Self::Failing(Failure::failed(format!("could not print: {error}"))),
        }
    }
}

impl From<Failure> for Ended {
    fn from(failure: Failure) -> Self {
        Self::Failing(failure)
    }
}

fn follow(
    source: &mut Source,
    topic: Topic,
    choice: &Choice,
    printer: &mut Printer,
    left: &mut u64,
) -> Result<(), Ended> {
    let mut print = |rows: Vec<Row>| {
        let before = *left;
        for row in rows.iter().filter(|row| row.topic() == topic) {
            if *left == 0 {
                return Err(Ended::Quietly);
            }
            if let Some(json) = choice.takes(row) {
                printer.print(row, json)?;
                *left -= 1;
            }
        }
        printer.flush()?;
        // Whether there was anything.
        if *left == 0 { Err(Ended::Quietly) } else { Ok(*left < before) }
    };
    if matches!(topic, Topic::Auvs | Topic::Born) {
        let cast = source.await_cast()?;
        return print(cast.map(|cast| of_cast(cast, topic)).unwrap_or_default()).map(drop);
    }
    loop {
        match source.next()? {
            Heard::Window(window) => {
                if print(window.rows)? {
                    source.taken();
                }
            }
            Heard::Nothing => {}
            Heard::End => break,
        }
    }
    match source.summary() {
        // In a record it is a message like any other.
        Some(summary) if topic == Topic::Summary && source.run().is_some() => {
            print(vec![Row::Summary(Box::new(summary.clone()))]).map(drop)
        }
        _ => Ok(()),
    }
}

/// The rows of what is told once.
fn of_cast(cast: Cast, topic: Topic) -> Vec<Row> {
    if topic == Topic::Auvs {
        vec![Row::Header(cast.header)]
    } else {
        cast.born.into_iter().map(|born| Row::Born(Box::new(born))).collect()
    }
}
