//! A host's end: it joins, is given AUVs to carry, and passes messages on between them and the launcher.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use zenoh::bytes::ZBytes;
use zenoh::pubsub::Subscriber;
use zenoh::{Session, Wait};

use super::frame::{Frame, Heard, Line};
use super::handshake::{Handshake, Join, PROGRAM, Proof, Welcome, this_process, wall_clock_ns};
use super::heart::{Heart, Pulse, Stopped, send};
use super::network::{Network, NetworkError};
use super::parcels::{ListWriter, Reader, from_host, to_host, write_losses};
use super::token::{Prover, is_proof, proof, random_hex};
use super::{Assignment, HostError, JOIN_KEY, Relay, down_key, reply_key, up_key};
use crate::codec::{self, FORMAT};
use crate::lockstep::{FleetError, Loss, ToAuv};
use crate::message::Born;

/// How often a host asks until it is answered.
const ASK_AGAIN: Duration = Duration::from_millis(500);

/// How long a host that said goodbye waits for the answer.
const FAREWELL: Duration = Duration::from_secs(1);

/// What a host says of itself.
#[derive(Clone, Debug)]
pub struct Offer {
    /// Where the launcher listens, such as `tcp/192.168.0.7:7447`.
    pub endpoint: String,
    /// What people call this host.
    pub name: String,
    /// How many AUVs it can carry.
    pub slots: u32,
    /// What the launcher must know, and is shown that this host knows, if anything.
    pub token: Option<String>,
    /// Hash of the only scenario that it will run, if it insists on one.
    pub scenario: Option<String>,
    /// How long to wait for the launcher to be there.
    pub wait: Duration,
}

/// What a host is told when it has joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Joined {
    /// Name of the scenario.
    pub scenario: String,
    /// Hash of its text.
    pub hash: String,
    /// This host's wall clock minus the launcher's, in seconds.
    pub clock_ahead_s: f64,
    /// How far that may be wrong, in seconds.
    pub clock_error_s: f64,
    /// Whether it waits to take the place of one that is lost.
    pub is_spare: bool,
}

/// How a host's run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The launcher said that the run is over.
    Over,
    /// The launcher said that it is over, for this reason.
    Failed(String),
    /// The launcher has given this host up, for this reason.
    Dismissed(String),
    /// The launcher was not heard for so long.
    LauncherGone(Duration),
    /// This host was told to stop.
    Stopped,
}

/// What a host does with what it is given.
pub trait Crew {
    /// Starts the processes of these AUVs and returns what reaches them.
    fn start(&mut self, assignment: &Assignment) -> Result<Box<dyn Relay>, FleetError>;

    /// How many processes it started.
    fn processes(&self) -> u32;

    /// Says more of how an AUV was lost, if it knows.
    fn explain(&mut self, loss: &mut Loss);

    /// So many windows are done; this one had so many messages.
    fn progress(&mut self, windows: u64, messages: usize);

    /// Waits for the processes, which have been told to end, and ends those that do not.
    fn disband(&mut self);
}

/// A host that has joined.
pub struct Host {
    _heart: Heart,
    _subscribers: [Subscriber<()>; 2],
    session: Session,
    pulse: Arc<Pulse>,
    events: Receiver<Event>,
    post: Sender<Event>,
    interrupt: Interrupt,
    line: Line,
    up: String,
    limit: Duration,
    joined: Joined,
}

enum Event {
    Reply(ZBytes),
    Down(ZBytes),
    LauncherGone,
    Stop,
}

/// What ends a wait for AUVs when the run is over in the middle of a window.
#[derive(Clone, Default)]
struct Interrupt(Arc<Mutex<Option<Interrupter>>>);

type Interrupter = Box<dyn Fn() + Send>;

impl Interrupt {
    fn set(&self, interrupt: Interrupter) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(interrupt);
    }

    fn call(&self) {
        if let Some(interrupt) = self.0.lock().unwrap_or_else(PoisonError::into_inner).as_ref() {
            interrupt();
        }
    }
}

/// Makes a [`Host`] leave the run, from any thread.
#[derive(Clone)]
pub struct HostStopHandle {
    post: Sender<Event>,
    interrupt: Interrupt,
}

impl HostStopHandle {
    /// The host says goodbye and ends.
    pub fn stop(&self) {
        // A host that is gone has stopped.
        let _gone = self.post.send(Event::Stop);
        self.interrupt.call();
    }
}

impl Host {
    /// Joins the run at `offer.endpoint`.
    ///
    /// # Errors
    /// When nobody is there in time, or either end refuses the other.
    pub fn join(offer: &Offer, network: &Network) -> Result<Self, HostError> {
        let since = Instant::now();
        let session = network.connect(&offer.endpoint, offer.wait)?;
        let broken = |cause: String| NetworkError::Session { endpoint: offer.endpoint.clone(), cause };
        let random = |bytes| random_hex(bytes).map_err(|error| broken(error.to_string()));
        let id = random(8)?;
        let join = Join {
            host: id.clone(),
            name: offer.name.clone(),
            program: PROGRAM.to_owned(),
            messages: FORMAT,
            slots: offer.slots,
            nonce: random(16)?,
            scenario: offer.scenario.clone(),
            process: this_process(),
        };
        let (post, events) = channel();
        let replying = post.clone();
        // Nobody receives any more when the host is being dropped.
        let replies = session
            .declare_subscriber(reply_key(&id))
            .callback(move |sample| drop(replying.send(Event::Reply(sample.payload().clone()))))
            .wait()
            .map_err(|error| broken(error.to_string()))?;
        let welcome = ask(&session, &join, offer, &events, since)?;

        let pulse = Arc::new(Pulse::new(&id, up_key(&welcome.run, &id), None));
        let interrupt = Interrupt::default();
        let (heard, arriving, ending) = (Arc::clone(&pulse), post.clone(), interrupt.clone());
        let downs = session
            .declare_subscriber(down_key(&welcome.run, &id))
            .callback(move |sample| {
                heard.heard();
                let is_end = is_end(&sample.payload().to_bytes());
                let _dropped = arriving.send(Event::Down(sample.payload().clone()));
                if is_end {
                    ending.call();
                }
            })
            .wait()
            .map_err(|error| broken(error.to_string()))?;
        // Too long to be told in seconds is for ever.
        let limit = Duration::try_from_secs_f64(welcome.limit_s).unwrap_or(Duration::MAX);
        let (leaving, ending) = (post.clone(), interrupt.clone());
        let stopped = move |_: &Pulse, _: Stopped| {
            let _dropped = leaving.send(Event::LauncherGone);
            ending.call();
        };
        let pulses = Arc::new(Mutex::new(vec![Arc::clone(&pulse)]));
        let heart = Heart::start(session.clone(), pulses, limit, stopped);
        let Welcome { name, scenario, clock_ahead_s, clock_error_s, spare, .. } = welcome;
        let mut host = Self {
            _heart: heart.map_err(|error| broken(error.to_string()))?,
            _subscribers: [replies, downs],
            session,
            up: pulse.key.clone(),
            pulse,
            events,
            post,
            interrupt,
            line: Line::default(),
            limit,
            joined: Joined { scenario: name, hash: scenario, clock_ahead_s, clock_error_s, is_spare: spare },
        };
        // The launcher has refused another scenario already, if it is the program that it says it is.
        if let Some(only) = offer.scenario.as_ref().filter(|only| **only != host.joined.hash) {
            let reason = HostError::Scenario { only: only.clone(), found: host.joined.hash.clone() };
            host.say_goodbye(&reason.to_string());
            return Err(reason);
        }
        Ok(host)
    }

    /// What it was told when it joined.
    pub fn joined(&self) -> &Joined {
        &self.joined
    }

    /// A handle that makes it leave the run.
    pub fn stop_handle(&self) -> HostStopHandle {
        HostStopHandle { post: self.post.clone(), interrupt: self.interrupt.clone() }
    }

    /// Carries AUVs until the run is over, or over for this host.
    ///
    /// # Errors
    /// When its AUVs cannot be started or reached any more; the launcher is told.
    pub fn serve(mut self, crew: &mut dyn Crew) -> Result<Ending, HostError> {
        let mut relay = None;
        let outcome = self.carry(crew, &mut relay);
        // Told to end, and waited for, before the launcher hears that this host has ended.
        if let Some(mut relay) = relay {
            relay.end();
        }
        crew.disband();
        match &outcome {
            Ok(Ending::Over | Ending::Failed(_)) => self.say_goodbye("the run is over"),
            Ok(Ending::Stopped) => self.say_goodbye("interrupted"),
            Ok(Ending::Dismissed(_) | Ending::LauncherGone(_)) => {}
            Err(error) => self.say_goodbye(&error.to_string()),
        }
        outcome
    }

    fn carry(
        &mut self,
        crew: &mut dyn Crew,
        relay: &mut Option<Box<dyn Relay>>,
    ) -> Result<Ending, HostError> {
        let mut windows = 0;
        loop {
            // It holds its own sender, so that it never hears the end of the queue.
            let Ok(event) = self.events.recv() else { return Ok(Ending::Stopped) };
            let frame = match event {
                Event::Reply(_) => continue,
                Event::Stop => return Ok(Ending::Stopped),
                Event::LauncherGone => return Ok(Ending::LauncherGone(self.limit)),
                Event::Down(frame) => frame,
            };
            let bytes = frame.to_bytes();
            let body = match self.line.take(&bytes) {
                Heard::Message(body) => body,
                Heard::Dismissed(reason) => return Ok(Ending::Dismissed(reason.to_owned())),
                Heard::Reply(frame) => {
                    // What is lost is asked for again.
                    let _lost = send(&self.session, &self.up, frame);
                    continue;
                }
                Heard::Nothing => continue,
            };
            let Some((tag, body)) = body.split_first() else { return Err(HostError::NotAMessage) };
            match (*tag, relay.as_mut()) {
                (to_host::ASSIGNMENT, None) => {
                    let (assignment, born) = read_assignment(body)?;
                    let started = relay.insert(crew.start(&assignment)?);
                    self.interrupt.set(started.interrupter());
                    let Some(mut losses) = unless_interrupted(started.born(&born))? else { continue };
                    losses.iter_mut().for_each(|loss| crew.explain(loss));
                    let processes = crew.processes();
                    self.say(from_host::BORN, |bytes| {
                        bytes.extend(processes.to_le_bytes());
                        write_losses(&losses, bytes);
                    });
                }
                (to_host::WINDOW, Some(relay)) => {
                    let mut reader = Reader(body);
                    let batches = reader.list().and_then(|list| reader.ending(list));
                    let batches = batches.ok_or(HostError::NotAMessage)?;
                    let mut losses = Ok(Some(Vec::new()));
                    let frame = self.line.next(from_host::ANSWERS, |bytes| {
                        let mut list = ListWriter::new(bytes);
                        let answered =
                            relay.exchange(&batches, &mut |auv, message| list.push_bytes(auv, message));
                        losses = unless_interrupted(answered);
                        if let Ok(Some(losses)) = &mut losses {
                            losses.iter_mut().for_each(|loss| crew.explain(loss));
                            write_losses(losses, bytes);
                        }
                    });
                    if losses?.is_some() {
                        self.post(frame);
                        windows += 1;
                        crew.progress(windows, batches.len());
                    }
                }
                (to_host::END, _) => {
                    let reason = String::from_utf8_lossy(body).into_owned();
                    return Ok(if reason.is_empty() { Ending::Over } else { Ending::Failed(reason) });
                }
                _ => return Err(HostError::NotAMessage),
            }
        }
    }

    fn say(&mut self, tag: u8, fill: impl FnOnce(&mut Vec<u8>)) {
        let frame = self.line.next(tag, fill);
        self.post(frame);
    }

    fn post(&self, frame: ZBytes) {
        // What is lost is asked for again.
        let _lost = send(&self.session, &self.up, frame);
        self.pulse.sent(self.line.sent());
    }

    /// Says goodbye, and waits a little until it is heard.
    fn say_goodbye(&mut self, reason: &str) {
        self.say(from_host::GOODBYE, |bytes| bytes.extend_from_slice(reason.as_bytes()));
        let since = Instant::now();
        while let Ok(event) = self.events.recv_timeout(FAREWELL.saturating_sub(since.elapsed())) {
            let Event::Down(frame) = event else { continue };
            match self.line.take(&frame.to_bytes()) {
                Heard::Dismissed(_) => return,
                Heard::Reply(frame) => drop(send(&self.session, &self.up, frame)),
                Heard::Message(_) | Heard::Nothing => {}
            }
        }
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // The process goes on without the session, closed or not.
        let _closed = self.session.close().wait();
    }
}

/// Asks to join until it is decided.
fn ask(
    session: &Session,
    join: &Join,
    offer: &Offer,
    events: &Receiver<Event>,
    since: Instant,
) -> Result<Welcome, HostError> {
    let knock = |handshake: &Handshake| drop(send(session, JOIN_KEY, handshake.write().into()));
    let mut nonce = None;
    let mut asked = None;
    loop {
        if asked.is_none_or(|asked: Instant| asked.elapsed() >= ASK_AGAIN) {
            if since.elapsed() > offer.wait + ASK_AGAIN {
                return Err(HostError::NoAnswer {
                    endpoint: offer.endpoint.clone(),
                    wait_s: offer.wait.as_secs(),
                });
            }
            knock(&Handshake::Join(join.clone()));
            asked = Some(Instant::now());
        }
        let reply = match events.recv_timeout(ASK_AGAIN) {
            Ok(Event::Reply(reply)) => reply,
            Ok(_) | Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => continue,
        };
        match Handshake::read(&reply.to_bytes()) {
            Ok(Handshake::Challenge(challenge)) => {
                let token = offer.token.as_ref();
                knock(&Handshake::Proof(Proof {
                    host: join.host.clone(),
                    proof: token.map(|token| proof(token, Prover::Host, &join.nonce, &challenge.nonce)),
                    challenged_ns: challenge.clock_ns,
                    clock_ns: wall_clock_ns(),
                }));
                nonce = Some(challenge.nonce);
                asked = Some(Instant::now());
            }
            Ok(Handshake::Welcome(welcome)) => {
                let is_proven = |token: &String| {
                    let stated = welcome.proof.as_deref().zip(nonce.as_deref());
                    stated.is_some_and(|(stated, nonce)| {
                        is_proof(stated, token, Prover::Launcher, &join.nonce, nonce)
                    })
                };
                if offer.token.as_ref().is_some_and(|token| !is_proven(token)) {
                    return Err(HostError::Launcher);
                }
                return Ok(welcome);
            }
            Ok(Handshake::Refusal { reason }) => return Err(HostError::Refused { reason }),
            // Not for a host.
            Ok(Handshake::Join(_) | Handshake::Proof(_)) => {}
            Err(stranger) => return Err(HostError::Refused { reason: stranger.reason() }),
        }
    }
}

/// Whether a frame tells the end of the run or of this host's part in it.
fn is_end(bytes: &[u8]) -> bool {
    match Frame::read(bytes) {
        Some(Frame::Message(_, body)) => body.first() == Some(&to_host::END),
        Some(Frame::Dismissal(_)) => true,
        _ => false,
    }
}

fn read_assignment(body: &[u8]) -> Result<(Assignment, Vec<Born>), HostError> {
    let mut reader = Reader(body);
    let length = reader.number().ok_or(HostError::NotAMessage)? as usize;
    let head = reader.bytes(length).ok_or(HostError::NotAMessage)?;
    let list = reader.list().and_then(|list| reader.ending(list)).ok_or(HostError::NotAMessage)?;
    let born = list.into_iter().map(|(_, message)| match codec::decode(message)? {
        ToAuv::Born(born) => Ok(*born),
        _ => Err(HostError::NotAMessage),
    });
    Ok((codec::decode(head)?, born.collect::<Result<_, HostError>>()?))
}

/// An interrupted wait is no failure: why is the next event.
fn unless_interrupted<T>(outcome: Result<T, FleetError>) -> Result<Option<T>, HostError> {
    match outcome {
        Ok(value) => Ok(Some(value)),
        Err(FleetError::Interrupted) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
