//! `shoal tap`: looks at a live run, or at a record, without touching it.

mod args;
mod capture;
mod choice;
mod file;
mod info;
mod list;
pub mod live;
mod measure;
mod print;
mod source;
mod stream;
mod text;
mod top;
mod topic;

use shoal_bus::record::Topic;

pub use args::TapArgs;

use crate::exit::Exit;
use crate::failure::Failure;
use args::Verb;
use measure::Measure;
use source::Source;

/// Does what the verb says; without one, prints pings.
pub fn run(args: &TapArgs) -> Result<Exit, Failure> {
    let is_printing = matches!(&args.verb, None | Some(Verb::Echo(_)));
    if !is_printing {
        refuse_printing_options(args)?;
    }
    match (&args.verb, &args.form.write) {
        (None, Some(path)) => capture::capture(args, None, path),
        (Some(Verb::Echo(of)), Some(path)) => capture::capture(args, Some(topic::by_name(&of.topic)?), path),
        (None, None) => stream::stream(args, Topic::Pings),
        (Some(Verb::Echo(of)), None) => stream::stream(args, topic::by_name(&of.topic)?),
        (Some(Verb::List), _) => list::list(args),
        (Some(Verb::Info(of)), _) => info::info(args, topic::by_name(&of.topic)?),
        (Some(Verb::Hz(of)), _) => measure::measure(args, topic::by_name(&of.topic)?, Measure::Rate),
        (Some(Verb::Bw(of)), _) => measure::measure(args, topic::by_name(&of.topic)?, Measure::Bandwidth),
        (Some(Verb::Delay(of)), _) => measure::measure(args, topic::by_name(&of.topic)?, Measure::Delay),
        (Some(Verb::Top(top)), _) => top::top(args, top.sort),
    }
}

/// Options that only make sense where messages are printed would otherwise do nothing.
fn refuse_printing_options(args: &TapArgs) -> Result<(), Failure> {
    let form = &args.form;
    let given = [
        ("--write", form.write.is_some()),
        ("--csv", form.csv),
        ("--field", !form.field.is_empty()),
        ("--filter", args.choice.filter.is_some() && is_whole(args)),
        ("--kind", !args.choice.kind.is_empty() && is_whole(args)),
        ("--lost", args.choice.lost.is_some() && is_whole(args)),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => {
            let sentence =
                format!("{option} is for messages: use it with `shoal tap` or `shoal tap echo TOPIC`");
            Err(Failure::usage(sentence))
        }
        None => Ok(()),
    }
}

/// Whether the verb is about all messages.
fn is_whole(args: &TapArgs) -> bool {
    matches!(args.verb, Some(Verb::List | Verb::Info(_) | Verb::Top(_)))
}

/// Says what is missing from what was told, and how to exit.
fn warn(source: &Source) -> Exit {
    let gaps = source.gaps();
    gaps.iter().for_each(|gap| eprintln!("warning: {gap}"));
    if gaps.is_empty() { Exit::Good } else { Exit::Loss }
}

/// Prints `text` on the standard output. Whoever closed it does not want more: `false`.
fn say(text: &str) -> Result<bool, Failure> {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Failure::failed(format!("could not print: {error}"))),
    }
}
