//! `shoal tap hz`, `bw` and `delay`: how often messages come, how large they are, how late.

use std::time::{Duration, Instant, SystemTime};

use serde_json::{Value, json};
use shoal_bus::record::{BATCH_NS, Topic};
use shoal_bus::time::SimTime;

use super::args::TapArgs;
use super::choice::Choice;
use super::source::{Heard, Source, Window};
use super::{say, warn};
use crate::exit::Exit;
use crate::failure::Failure;

/// How often a live run is summed up.
const PERIOD: Duration = Duration::from_secs(1);

/// What to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// How often messages come.
    Rate,
    /// How many bytes they are, as the JSON of a record.
    Bandwidth,
    /// How long they take from the water to this tap, and how long after they happened they are told.
    Delay,
}

/// Prints a line a second of a live run, and one at the end of a record.
pub fn measure(args: &TapArgs, topic: Topic, measure: Measure) -> Result<Exit, Failure> {
    if matches!(topic, Topic::Auvs | Topic::Born | Topic::Summary | Topic::Offline) {
        return Err(Failure::usage(format!("{} has no rate: it is told once", topic.name())));
    }
    let is_live = args.origin.read.is_none();
    if measure == Measure::Delay && !is_live {
        return Err(Failure::usage(
            "a record does not tell when its messages arrived: `delay` needs a live run",
        ));
    }
    let choice = Choice::new(&args.choice, topic)?;
    let mut source = Source::open(&args.origin, &[topic])?;
    let mut left = args.choice.limit();
    let mut period = Period::new(measure);
    period.from =
        args.origin.from.filter(|_| !is_live).map(|from| SimTime::from_ns((from * 1e9).round() as i64));
    loop {
        match source.next()? {
            Heard::Window(window) => {
                let before = period.messages.count;
                period.take(&window, topic, &choice);
                if period.messages.count > before {
                    source.taken();
                }
            }
            Heard::Nothing => {}
            Heard::End => break,
        }
        if is_live && period.is_over() {
            if !say(&period.line(args, topic, true))? {
                return Ok(Exit::Good);
            }
            left -= 1;
            if left == 0 {
                return Ok(warn(&source));
            }
            period = period.next();
        }
    }
    // What is left of a live run is less than a second, and of a record all of it.
    if !is_live || period.messages.count > 0 {
        say(&period.line(args, topic, is_live))?;
    }
    Ok(warn(&source))
}

/// What was heard for a while.
struct Period {
    measure: Measure,
    began: Instant,
    /// When the last window came.
    arrived: Option<Instant>,
    from: Option<SimTime>,
    to: Option<SimTime>,
    latest: Option<SimTime>,
    /// Bytes of the messages.
    messages: Spread,
    /// Seconds between them.
    intervals: Spread,
    /// Seconds from publication to arrival, and from the event to the end of its window.
    transport: Spread,
    telling: Spread,
}

impl Period {
    fn new(measure: Measure) -> Self {
        let [messages, intervals, transport, telling] = [Spread::default(); 4];
        let (began, arrived, from, to, latest) = (Instant::now(), None, None, None, None);
        Self { measure, began, arrived, from, to, latest, messages, intervals, transport, telling }
    }

    /// The one that follows at once.
    fn next(&self) -> Self {
        let began = self.arrived.unwrap_or(self.began);
        Self { began, from: self.to, to: self.to, latest: self.latest, ..Self::new(self.measure) }
    }

    fn is_over(&self) -> bool {
        self.to > self.from && self.began.elapsed() >= PERIOD
    }

    fn take(&mut self, window: &Window, topic: Topic, choice: &Choice) {
        let now = Instant::now();
        self.arrived = Some(now);
        if window.published.is_some() && self.from.is_none() {
            // A live run is measured from the end of the first window on.
            (self.began, self.from, self.to) = (now, Some(window.to), Some(window.to));
            return;
        }
        let transport = window.published.and_then(|at| SystemTime::now().duration_since(at).ok());
        for row in window.rows.iter().filter(|row| row.topic() == topic) {
            if choice.takes(row).is_none() {
                continue;
            }
            let at = row.at();
            if let Some(before) = self.latest.replace(at) {
                self.intervals.add((at - before) as f64 / 1e9);
            }
            let is_weighed = self.measure == Measure::Bandwidth;
            let bytes = if is_weighed { serde_json::to_vec(row).map_or(0, |text| text.len()) } else { 0 };
            self.messages.add(bytes as f64);
            if let Some(transport) = transport {
                self.transport.add(transport.as_secs_f64());
                self.telling.add((window.to - at) as f64 / 1e9);
            }
        }
        // A record is measured from the first batch with such messages, or from where it was asked to.
        self.from.get_or_insert(SimTime::from_ns((window.to.ns() - BATCH_NS).max(0)));
        self.to = Some(window.to);
    }

    fn line(&self, args: &TapArgs, topic: Topic, is_live: bool) -> String {
        let to_s = self.to.map_or(0.0, SimTime::as_s);
        let sim_s = to_s - self.from.map_or(0.0, SimTime::as_s);
        let per_sim_s = |amount: f64| (sim_s > 0.0).then(|| amount / sim_s);
        let per_s = |amount: f64| {
            let wall_s = self.arrived.map_or(0.0, |arrived| (arrived - self.began).as_secs_f64());
            (is_live && wall_s > 0.0).then(|| amount / wall_s)
        };
        let messages = self.messages.count;
        if args.form.json {
            let (name, figures) = match self.measure {
                Measure::Rate => {
                    let (sim, wall) = (per_sim_s(messages as f64), per_s(messages as f64));
                    ("hz", json!({ "sim_hz": sim, "wall_hz": wall, "interval_s": self.intervals.json() }))
                }
                Measure::Bandwidth => {
                    let (sim, wall) = (per_sim_s(self.messages.sum), per_s(self.messages.sum));
                    (
                        "bw",
                        json!({ "bytes": self.messages.sum, "bytes_per_sim_s": sim, "bytes_per_s": wall,
                        "message_bytes": self.messages.json() }),
                    )
                }
                Measure::Delay => {
                    ("delay", json!({ "arrival_s": self.transport.json(), "telling_s": self.telling.json() }))
                }
            };
            let mut line = json!({ "format": format!("shoal.tap.{name}/1"), "topic": topic.name(), "t_s": to_s,
                "messages": messages });
            if let (Value::Object(line), Value::Object(figures)) = (&mut line, figures) {
                line.extend(figures);
            }
            return format!("{line}\n");
        }
        let figures = match self.measure {
            Measure::Rate => format!(
                "{}{}  every {}",
                rate(per_sim_s(messages as f64), "a simulated s"),
                rate(per_s(messages as f64), "a s"),
                self.intervals.text(1e3, "ms")
            ),
            Measure::Bandwidth => format!(
                "{}{}  messages of {}",
                volume(per_sim_s(self.messages.sum), "a simulated s"),
                volume(per_s(self.messages.sum), "a s"),
                self.messages.text(1.0, "B")
            ),
            Measure::Delay => format!(
                "  arrived after {}  told at the end of a window, after {} of simulated time",
                self.transport.text(1e3, "ms"),
                self.telling.text(1e3, "ms")
            ),
        };
        format!("{to_s:10.3} s  {messages} messages{figures}\n")
    }
}

fn rate(rate: Option<f64>, unit: &str) -> String {
    rate.map_or(String::new(), |rate| format!("  {rate:.1} {unit}"))
}

fn volume(bytes: Option<f64>, unit: &str) -> String {
    bytes.map_or(String::new(), |bytes| match bytes {
        1e6.. => format!("  {:.2} MB {unit}", bytes / 1e6),
        1e3.. => format!("  {:.2} kB {unit}", bytes / 1e3),
        _ => format!("  {bytes:.0} B {unit}"),
    })
}

/// How numbers are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Spread {
    count: u64,
    sum: f64,
    least: f64,
    most: f64,
    mean: f64,
    /// Sum of the squares of the differences to the mean (Welford's method).
    squares: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        (self.least, self.most) = match self.count {
            0 => (value, value),
            _ => (self.least.min(value), self.most.max(value)),
        };
        self.count += 1;
        self.sum += value;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (value - self.mean);
    }

    /// Standard deviation.
    fn deviation(&self) -> f64 {
        if self.count == 0 { 0.0 } else { (self.squares / self.count as f64).sqrt() }
    }

    fn json(&self) -> Value {
        let Self { count, least, most, mean, .. } = *self;
        if count == 0 {
            return Value::Null;
        }
        json!({ "mean": mean, "min": least, "max": most, "deviation": self.deviation() })
    }

    fn text(&self, factor: f64, unit: &str) -> String {
        let Self { count, least, most, mean, .. } = *self;
        if count == 0 {
            return "-".to_owned();
        }
        let [mean, least, most, deviation] =
            [mean, least, most, self.deviation()].map(|value| value * factor);
        format!("{mean:.2} {unit} ({least:.2} to {most:.2}, deviation {deviation:.2})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_what_statistics_say() {
        let mut spread = Spread::default();
        [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().for_each(|value| spread.add(value));
        assert_eq!((spread.mean, spread.deviation(), spread.least, spread.most), (5.0, 2.0, 2.0, 9.0));
        assert_eq!(spread.text(1.0, "m"), "5.00 m (2.00 to 9.00, deviation 2.00)");
        assert_eq!(Spread::default().text(1.0, "m"), "-");
    }
}
