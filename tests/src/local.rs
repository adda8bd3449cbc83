//! Runs without processes: water and minds in this one, as `--bus local` does it.

use shoal_auv::Auv;
use shoal_bus::chronicle::Entry;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Fleet, Mind};
use shoal_bus::message::Born;
use shoal_bus::summary::Summary;
use shoal_channel::channel::Channel;
use shoal_scenario::{Scenario, load, parse};

/// Why a run without processes failed.
pub type LocalRunError = Box<dyn std::error::Error>;

/// The scenario of this name from the library.
///
/// # Panics
/// When there is none.
pub fn library_scenario(name: &str) -> Scenario {
    let (source, text) = load(name).expect("the library has it");
    parse(&source, &text).expect("the library's scenarios are valid")
}

/// Carries `scenario` out in windows of `window_ns` nanoseconds (its own, if `None`).
///
/// # Panics
/// When the run cannot go on, as with a window that is too long.
pub fn run_local(scenario: &Scenario, window_ns: Option<i64>) -> Summary {
    let channel = Channel::new(scenario).expect("the run can begin");
    carry_out(scenario, channel, window_ns, Auv::new, |_| {}).expect("the run goes on to its end")
}

/// As [`run_local`], with minds made by `be_born`, showing `watch` all that happens, in order, and how the swarm moves.
///
/// # Errors
/// When the run cannot go on.
pub fn run_local_watched<M: Mind>(
    scenario: &Scenario,
    window_ns: Option<i64>,
    be_born: impl Fn(&Born) -> M,
    watch: impl FnMut(&Entry),
) -> Result<Summary, LocalRunError> {
    let mut channel = Channel::new(scenario)?;
    channel.watch_flock();
    carry_out(scenario, channel, window_ns, be_born, watch)
}

fn carry_out<M: Mind>(
    scenario: &Scenario,
    mut channel: Channel,
    window_ns: Option<i64>,
    be_born: impl Fn(&Born) -> M,
    mut watch: impl FnMut(&Entry),
) -> Result<Summary, LocalRunError> {
    let window_ns = window_ns.unwrap_or(scenario.window_ns);
    let mut fleet = Local::new(be_born);
    fleet.born(&channel.born())?;
    while channel.now() < channel.end() {
        let to = (channel.now() + window_ns).min(channel.end());
        let sensed = channel.advance(to)?;
        let answers = fleet.exchange(&sensed, &mut || {})?;
        channel.accept(sensed, answers);
        channel.chronicle()?.iter().for_each(&mut watch);
    }
    Ok(channel.summary())
}
