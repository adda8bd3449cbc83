//! How fast a replay goes, and when it waits for a key.

use std::io::BufRead;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use shoal_bus::time::SimTime;

use super::judge::Judge;
use crate::cli::Pace;

/// How often an interrupt is looked for.
const LOOK_AGAIN: Duration = Duration::from_millis(20);

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    GoOn,
    End,
}

/// Lets simulated time go by.
pub struct Pacer {
    rate: Pace,
    from: SimTime,
    /// When the next stop is due.
    stop_at: Option<SimTime>,
    step_s: Option<f64>,
    /// What is typed, line by line.
    keys: Option<Receiver<String>>,
    /// Wall clock and simulated time at which it began, or went on.
    began: Option<(Instant, SimTime)>,
}

impl Pacer {
    pub fn new(rate: Pace, from: Option<SimTime>, pause: bool, step_s: Option<f64>) -> Self {
        let from = from.unwrap_or(SimTime::ZERO);
        let is_driven = pause || step_s.is_some();
        Self {
            rate,
            from,
            stop_at: is_driven.then_some(from),
            step_s,
            keys: is_driven.then(keys),
            began: None,
        }
    }

    /// Waits until `at` is due, at a stop for a key.
    pub fn until(&mut self, at: SimTime, interrupted: &AtomicBool, judge: &Judge) -> Word {
        if at < self.from {
            return Word::GoOn;
        }
        // Whoever presses Enter on the way wants to stop here.
        if let Some(line) = self.keys.as_ref().and_then(|keys| keys.try_recv().ok()) {
            match line.trim() {
                "q" => return Word::End,
                _ => self.stop_at = Some(at),
            }
        }
        if self.stop_at.is_some_and(|stop_at| at >= stop_at) {
            self.stop_at = None;
            if self.stop(at, interrupted, judge) == Word::End {
                return Word::End;
            }
            self.began = None;
        }
        let (began, since) = *self.began.get_or_insert((Instant::now(), at));
        let Pace::Factor(factor) = self.rate else { return Word::GoOn };
        let due = Duration::try_from_secs_f64((at - since) as f64 * 1e-9 / factor).unwrap_or(Duration::MAX);
        while let Some(early) = due.checked_sub(began.elapsed()).filter(|early| !early.is_zero()) {
            if interrupted.load(Ordering::Acquire) {
                return Word::End;
            }
            std::thread::sleep(early.min(LOOK_AGAIN));
        }
        Word::GoOn
    }

    /// Says how things are, and waits for a line.
    fn stop(&mut self, at: SimTime, interrupted: &AtomicBool, judge: &Judge) -> Word {
        let how = if self.step_s.is_some() { "Enter to step, c to go on" } else { "Enter to go on" };
        eprintln!("{:10.3} s  {}  [{how}, q to end]", at.as_s(), judge.in_short());
        let Some(keys) = &self.keys else { return Word::GoOn };
        loop {
            if interrupted.load(Ordering::Acquire) {
                return Word::End;
            }
            match keys.recv_timeout(LOOK_AGAIN) {
                Ok(line) => match (line.trim(), self.step_s) {
                    ("q", _) => return Word::End,
                    ("c", _) | (_, None) => return Word::GoOn,
                    (_, Some(step_s)) => {
                        self.stop_at = Some(at + (step_s * 1e9) as i64);
                        return Word::GoOn;
                    }
                },
                Err(RecvTimeoutError::Timeout) => {}
                // Nobody can press anything any more: on to the end.
                Err(RecvTimeoutError::Disconnected) => return Word::GoOn,
            }
        }
    }
}

/// The lines of standard input, read in a thread of their own.
fn keys() -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    // It ends with the program, or with the input.
    let _reading = std::thread::Builder::new().name("keys".to_owned()).spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}
