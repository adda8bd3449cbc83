//! Heartbeats, on a thread of their own: whatever else an end does, the other knows that it is there.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use zenoh::bytes::ZBytes;
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

use super::frame::Frame;
use crate::os::Process;

/// Time between two beats, in which a lost message is noticed.
const BEAT: Duration = Duration::from_millis(500);

/// Time between two looks at processes of this machine.
const LOOK: Duration = Duration::from_millis(50);

/// The other end of a line, as the heart knows it.
pub(super) struct Pulse {
    /// Who it is.
    pub(super) id: String,
    /// Where to send it anything.
    pub(super) key: String,
    /// Its process, if that is on this machine.
    process: Option<Process>,
    sent: AtomicU64,
    /// Beats since it was last heard.
    silent: AtomicU32,
    is_over: AtomicBool,
}

/// Why a pulse stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stopped {
    Silent,
    ProcessEnded,
}

impl Pulse {
    pub(super) fn new(id: &str, key: String, process: Option<Process>) -> Self {
        Self {
            id: id.to_owned(),
            key,
            process,
            sent: AtomicU64::new(0),
            silent: AtomicU32::new(0),
            is_over: AtomicBool::new(false),
        }
    }

    /// The message of this number was sent to it.
    pub(super) fn sent(&self, number: u64) {
        self.sent.store(number, Ordering::Release);
    }

    /// It was heard.
    pub(super) fn heard(&self) {
        self.silent.store(0, Ordering::Relaxed);
    }

    /// No more beats for it.
    pub(super) fn stop(&self) {
        self.is_over.store(true, Ordering::Relaxed);
    }
}

/// Everyone who is to hear the beats.
pub(super) type Pulses = Arc<Mutex<Vec<Arc<Pulse>>>>;

/// Beats until it is dropped.
pub(super) struct Heart {
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Heart {
    /// Beats for all of `pulses`, and calls `stopped` once for each that is silent for longer than `limit` or whose process
    /// has ended. Silence is counted in beats, so that nobody dies of this process being suspended.
    pub(super) fn start(
        session: Session,
        pulses: Pulses,
        limit: Duration,
        stopped: impl Fn(&Pulse, Stopped) + Send + 'static,
    ) -> std::io::Result<Self> {
        let (stop, stops) = channel();
        let limit_beats = u32::try_from(limit.as_millis() / BEAT.as_millis()).unwrap_or(u32::MAX);
        let run = move || {
            for look in 1_u64.. {
                if stops.recv_timeout(LOOK) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
                let beats = u128::from(look) % (BEAT.as_millis() / LOOK.as_millis()) == 0;
                for pulse in all(&pulses) {
                    if let Some(why) = pulse.look(&session, beats, limit_beats) {
                        pulse.stop();
                        stopped(&pulse, why);
                    }
                }
            }
        };
        let thread = std::thread::Builder::new().name("heart".to_owned()).spawn(run)?;
        Ok(Self { stop: Some(stop), thread: Some(thread) })
    }
}

/// Those who are to hear beats now.
fn all(pulses: &Pulses) -> Vec<Arc<Pulse>> {
    let mut pulses = pulses.lock().unwrap_or_else(PoisonError::into_inner);
    pulses.retain(|pulse| !pulse.is_over.load(Ordering::Relaxed));
    pulses.clone()
}

impl Pulse {
    fn look(&self, session: &Session, beats: bool, limit_beats: u32) -> Option<Stopped> {
        if self.process.as_ref().is_some_and(|process| process.has_ended().unwrap_or(false)) {
            return Some(Stopped::ProcessEnded);
        }
        if !beats {
            return None;
        }
        let beat = Frame::Beat(self.sent.load(Ordering::Acquire)).write();
        // One that cannot be sent is like one that is lost.
        let _lost =
            session.put(&self.key, beat).congestion_control(CongestionControl::Drop).express(true).wait();
        let silent = self.silent.fetch_add(1, Ordering::Relaxed);
        (silent > limit_beats).then_some(Stopped::Silent)
    }
}

impl Drop for Heart {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let _ended = thread.join();
        }
    }
}

/// Sends what must arrive, or is asked for again.
pub(super) fn send(session: &Session, key: &str, frame: ZBytes) -> Result<(), String> {
    session
        .put(key, frame)
        .congestion_control(CongestionControl::Block)
        .express(true)
        .wait()
        .map_err(|error| error.to_string())
}
