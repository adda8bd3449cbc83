//! The launcher's end: all hosts of a run.

use std::fmt::Display;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use zenoh::bytes::ZBytes;
use zenoh::pubsub::Subscriber;
use zenoh::{Session, Wait};

use super::frame::{Frame, Heard};
use super::heart::{Heart, Pulses, Stopped, send};
use super::member::{Awaits, Brought, Member, State};
use super::network::{Network, NetworkError};
use super::parcels::{ListWriter, to_host};
use super::roster::{Candidate, Terms, share_out};
use super::token::random_hex;
use super::{Assignment, BUS, HostsError, JOIN_KEY, up_key};
use crate::codec;
use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss};
use crate::message::{Acted, AuvId, Born, Sensed};
use crate::wire::ToAuvRef;

/// How long a host that is there may take for anything; its own limit for its AUVs is shorter.
const STALL_LIMIT: Duration = Duration::from_secs(360);

/// How long the end of a run waits for the hosts to have ended their AUVs.
const FAREWELL: Duration = Duration::from_secs(5);

/// The launcher's end of a run on several hosts.
///
/// It is made by [`listen`](Self::listen); [`gather`](Self::gather) waits until all hosts have joined.
pub struct HostsFleet {
    // The heart first: it uses the session.
    _heart: Heart,
    _subscribers: [Subscriber<()>; 2],
    pub(super) pulses: Pulses,
    pub(super) session: Session,
    events: Receiver<Event>,
    post: Sender<Event>,
    pub(super) terms: Terms,
    /// Part of the keys of this run.
    pub(super) run: String,
    pub(super) candidates: Vec<Candidate>,
    pub(super) members: Vec<Member>,
    /// The host of each AUV, by its id.
    homes: Vec<Option<usize>>,
    /// Who is to carry whom from the next births on.
    assigned: Vec<(usize, Vec<AuvId>)>,
    /// AUVs whose host is gone, each list to be taken by one other.
    orphans: Vec<Vec<AuvId>>,
    acted: Vec<Batch<Acted>>,
    losses: Vec<Loss>,
    pub(super) has_begun: bool,
    has_ended: bool,
    processes: Arc<AtomicU32>,
    waited: Duration,
    news: Box<dyn FnMut(&str)>,
}

pub(super) enum Event {
    Handshake(ZBytes),
    /// What the host with this id has sent.
    Up(String, ZBytes),
    Stopped(String, Stopped),
    Interrupted,
}

/// Makes a waiting [`HostsFleet`] give up, from any thread.
#[derive(Clone)]
pub struct HostsInterruptHandle(Sender<Event>);

impl HostsInterruptHandle {
    /// What the fleet is waiting for, or does next, ends in [`FleetError::Interrupted`].
    pub fn interrupt(&self) {
        // A fleet that is gone waits for nothing.
        let _gone = self.0.send(Event::Interrupted);
    }
}

impl HostsFleet {
    /// Listens on `endpoint`, such as `tcp/192.168.0.7:7447`, for hosts that agree to `terms`. What happens to hosts is told
    /// to `news`, in sentences.
    ///
    /// # Errors
    /// When nobody can be listened for.
    pub fn listen(
        endpoint: &str,
        network: &Network,
        terms: Terms,
        news: impl FnMut(&str) + 'static,
    ) -> Result<Self, HostsError> {
        let session = network.listen(endpoint)?;
        let broken = |cause: String| NetworkError::Session { endpoint: endpoint.to_owned(), cause };
        let run = random_hex(8).map_err(|error| broken(error.to_string()))?;
        let (post, events) = channel();
        let pulses = Pulses::default();
        let joining = post.clone();
        // Nobody receives any more when the fleet is being dropped.
        let joins = session
            .declare_subscriber(JOIN_KEY)
            .callback(move |sample| drop(joining.send(Event::Handshake(sample.payload().clone()))))
            .wait();
        let (heard, arriving) = (Arc::clone(&pulses), post.clone());
        let ups = session
            .declare_subscriber(up_key(&run, "*"))
            .callback(move |sample| {
                let Some(host) = sample.key_expr().rsplit('/').nth(1) else { return };
                let pulses = heard.lock().unwrap_or_else(PoisonError::into_inner);
                pulses.iter().filter(|pulse| pulse.id == host).for_each(|pulse| pulse.heard());
                drop(pulses);
                let _dropped = arriving.send(Event::Up(host.to_owned(), sample.payload().clone()));
            })
            .wait();
        let subscribers = [joins, ups].map(|made| made.map_err(|error| broken(error.to_string())));
        let [joins, ups] = subscribers;
        let stopping = post.clone();
        let stopped = move |pulse: &super::heart::Pulse, why| {
            let _dropped = stopping.send(Event::Stopped(pulse.id.clone(), why));
        };
        let heart = Heart::start(session.clone(), Arc::clone(&pulses), terms.limit, stopped);
        Ok(Self {
            _heart: heart.map_err(|error| broken(error.to_string()))?,
            _subscribers: [joins?, ups?],
            pulses,
            session,
            events,
            post,
            terms,
            run,
            candidates: Vec::new(),
            members: Vec::new(),
            homes: Vec::new(),
            assigned: Vec::new(),
            orphans: Vec::new(),
            acted: Vec::new(),
            losses: Vec::new(),
            has_begun: false,
            has_ended: false,
            processes: Arc::default(),
            waited: Duration::ZERO,
            news: Box::new(news),
        })
    }

    /// Waits until as many hosts have joined as the terms say, and shares the AUVs out to them, in proportion to their slots.
    ///
    /// # Errors
    /// When they have too few slots, which ends the run for them, or when it is interrupted.
    pub fn gather(&mut self) -> Result<(), HostsError> {
        loop {
            let idle: Vec<usize> = self.idle().take(self.terms.hosts).collect();
            if idle.len() == self.terms.hosts {
                let slots: Vec<u32> = idle.iter().map(|&host| self.members[host].join.slots).collect();
                let shares = share_out(&self.terms.auvs, &slots).map_err(|missing| {
                    let offers = idle.iter().map(|&host| self.members[host].offer()).collect::<Vec<_>>();
                    HostsError::Slots { auvs: self.terms.auvs.len(), missing, offers: offers.join(", ") }
                });
                if let Err(error) = &shares {
                    self.end_with(&error.to_string());
                }
                self.assigned = idle.into_iter().zip(shares?).filter(|(_, auvs)| !auvs.is_empty()).collect();
                self.has_begun = true;
                return Ok(());
            }
            // It holds its own sender, so that it never hears the end of the queue.
            let taken = self.events.recv().map(|event| self.take(event));
            if !matches!(taken, Ok(Ok(()))) {
                self.end_with(&HostsError::Interrupted.to_string());
                return Err(HostsError::Interrupted);
            }
        }
    }

    /// A handle that makes this fleet give up.
    pub fn interrupt_handle(&self) -> HostsInterruptHandle {
        HostsInterruptHandle(self.post.clone())
    }

    /// How many processes the hosts have started for AUVs, at any time from now on.
    pub fn processes(&self) -> Arc<AtomicU32> {
        Arc::clone(&self.processes)
    }

    /// Hosts that carry nobody.
    fn idle(&self) -> impl Iterator<Item = usize> + '_ {
        let members = self.members.iter().enumerate();
        members.filter(|(_, member)| member.state == State::Idle).map(|(index, _)| index)
    }

    pub(super) fn tell(&mut self, news: &str) {
        (self.news)(news);
    }

    /// Takes in one event.
    fn take(&mut self, event: Event) -> Result<(), FleetError> {
        match event {
            Event::Interrupted => return Err(FleetError::Interrupted),
            Event::Handshake(payload) => self.shake_hands(&payload.to_bytes()),
            Event::Stopped(host, why) => {
                let reason = match why {
                    Stopped::Silent => format!("was silent for {} s", self.terms.limit.as_secs_f64()),
                    Stopped::ProcessEnded => "ended without a word".to_owned(),
                };
                if let Some(index) = self.find(&host) {
                    self.bury(index, &reason);
                }
            }
            Event::Up(host, payload) => match self.find(&host) {
                Some(index) => self.hear(index, &payload.to_bytes()),
                None => self.dismiss(&host, "it is none of this run's hosts"),
            },
        }
        Ok(())
    }

    fn find(&self, host: &str) -> Option<usize> {
        self.members.iter().position(|member| member.join.host == host)
    }

    fn hear(&mut self, index: usize, bytes: &[u8]) {
        let member = &mut self.members[index];
        if member.state == State::Gone {
            let host = member.join.host.clone();
            return self.dismiss(&host, "it was given up, and its AUVs are lost");
        }
        match member.line.take(bytes) {
            Heard::Message(body) => match member.take(body, &mut self.acted, &mut self.losses) {
                Some(Brought::Taken) => {}
                Some(Brought::Births { processes }) => {
                    self.processes.fetch_add(processes, Ordering::Relaxed);
                }
                Some(Brought::Goodbye(reason)) => {
                    let host = member.join.host.clone();
                    self.dismiss(&host, "");
                    self.bury(index, &format!("said goodbye: {reason}"));
                }
                None => {
                    let host = member.join.host.clone();
                    self.dismiss(&host, "it sent what is no message, or not the one that was due");
                    self.bury(index, "sent what is no message, or not the one that was due");
                }
            },
            Heard::Reply(frame) => {
                // What is lost is asked for again.
                let _lost = send(&self.session, &member.pulse.key, frame);
            }
            Heard::Dismissed(_) | Heard::Nothing => {}
        }
    }

    /// Tells a host that it is none any more; an empty reason answers its goodbye.
    fn dismiss(&self, host: &str, reason: &str) {
        let frame = Frame::Dismissal(reason).write();
        // It is told again when it says something again.
        let _lost = send(&self.session, &super::down_key(&self.run, host), frame.into());
    }

    /// A host is gone, and its AUVs with it.
    fn bury(&mut self, index: usize, reason: &str) {
        let member = &mut self.members[index];
        if member.state == State::Gone {
            return;
        }
        let has_said_goodbye = member.awaits == Awaits::Goodbye;
        let reason = format!("host {} {reason}", member.name);
        member.state = State::Gone;
        member.awaits = Awaits::Nothing;
        member.pulse.stop();
        let auvs = member.lose_all(&reason, &mut self.losses);
        self.assigned.retain(|(host, _)| *host != index);
        if has_said_goodbye {
            return;
        }
        if auvs.is_empty() {
            self.tell(&format!("{reason}; it carried nobody"));
        } else {
            let shown = super::ranges(&auvs);
            self.tell(&format!(
                "{reason}: AUVs {shown} are lost until another host with {} slots joins",
                auvs.len()
            ));
            self.orphans.push(auvs);
        }
    }

    /// Waits until nobody is awaited any more.
    fn wait(&mut self, limit: Duration) -> Result<(), FleetError> {
        let mut since = Instant::now();
        let mut awaited = usize::MAX;
        loop {
            let now = self.members.iter().filter(|member| member.awaits != Awaits::Nothing).count();
            if now == 0 {
                return Ok(());
            }
            if now < awaited {
                (awaited, since) = (now, Instant::now());
            }
            match self.events.recv_timeout(limit.saturating_sub(since.elapsed())) {
                Ok(event) => self.take(event)?,
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                    let waiting = self.members.iter().filter(|member| member.awaits != Awaits::Nothing);
                    let waiting = waiting.flat_map(|member| member.auvs.keys().copied()).collect();
                    return Err(FleetError::Stalled { waiting, limit_s: limit.as_secs() });
                }
            }
        }
    }

    fn assign(&mut self, index: usize, auvs: &[AuvId], born: &[Born]) -> Result<(), FleetError> {
        let mut sorted = auvs.to_vec();
        sorted.sort_unstable();
        let born: Vec<&Born> = born.iter().filter(|born| sorted.binary_search(&born.auv).is_ok()).collect();
        let Self { members, session, terms, homes, .. } = self;
        let member = &mut members[index];
        let assignment = Assignment { auvs: auvs.to_vec(), auvs_per_process: terms.auvs_per_process };
        let head = codec::encode(&assignment).map_err(failed)?;
        let mut written = Ok(());
        let sent = member.say(session, to_host::ASSIGNMENT, |bytes| {
            bytes.extend((head.len() as u32).to_le_bytes());
            bytes.extend_from_slice(&head);
            let mut list = ListWriter::new(bytes);
            written = born.iter().try_for_each(|born| {
                list.push(born.auv, |bytes| codec::encode_into(&ToAuvRef::Born(born), bytes))
            });
        });
        sent.map_err(failed)?;
        written.map_err(failed)?;
        member.auvs = born.iter().map(|born| (born.auv, 0)).collect();
        member.state = State::Carrying;
        member.awaits = Awaits::Births;
        for born in born {
            let at = born.auv.0 as usize;
            if homes.len() <= at {
                homes.resize(at + 1, None);
            }
            homes[at] = Some(index);
        }
        let (name, shown) = (member.name.clone(), super::ranges(auvs));
        self.tell(&format!("host {name} carries AUVs {shown}"));
        Ok(())
    }

    /// Tells all hosts that the run is over; the reason is empty when all is well.
    fn end_with(&mut self, reason: &str) {
        if std::mem::replace(&mut self.has_ended, true) {
            return;
        }
        let Self { members, session, .. } = self;
        for member in members.iter_mut().filter(|member| member.state != State::Gone) {
            let told = member.say(session, to_host::END, |bytes| bytes.extend_from_slice(reason.as_bytes()));
            member.awaits = if told.is_ok() { Awaits::Goodbye } else { Awaits::Nothing };
        }
        // Whoever does not hear of it in time notices that the launcher is gone.
        let _all_heard = self.wait(FAREWELL);
    }
}

impl Fleet for HostsFleet {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        for (index, auvs) in std::mem::take(&mut self.assigned) {
            self.assign(index, &auvs, born)?;
        }
        let homeless = |born: &&Born| self.homes.get(born.auv.0 as usize).copied().flatten().is_none();
        if let Some(born) = born.iter().find(homeless) {
            return Err(failed(format_args!("AUV {} is on no host", born.auv)));
        }
        self.wait(STALL_LIMIT)?;
        let mut losses = std::mem::take(&mut self.losses);
        losses.sort_by_key(|loss| loss.auv);
        Ok(losses)
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        while let Ok(event) = self.events.try_recv() {
            self.take(event)?;
        }
        let mut due: Vec<Vec<&Batch<Sensed>>> = vec![Vec::new(); self.members.len()];
        for batch in sensed {
            let Some(home) = self.homes.get(batch.auv.0 as usize).copied().flatten() else {
                return Err(failed(format_args!("AUV {} is on no host", batch.auv)));
            };
            if let Some(ticks) = self.members[home].auvs.get_mut(&batch.auv) {
                *ticks = batch.items.len();
                due[home].push(batch);
            }
        }
        let Self { members, session, .. } = self;
        for (member, due) in members.iter_mut().zip(&due).filter(|(_, due)| !due.is_empty()) {
            let mut written = Ok(());
            let sent = member.say(session, to_host::WINDOW, |bytes| {
                let mut list = ListWriter::new(bytes);
                written = due.iter().try_for_each(|batch| {
                    list.push(batch.auv, |bytes| codec::encode_into(&ToAuvRef::Sensed(&batch.items), bytes))
                });
            });
            written.map_err(failed)?;
            sent.map_err(failed)?;
            member.awaits = Awaits::Answers;
        }
        meanwhile();
        let waiting_since = Instant::now();
        self.wait(STALL_LIMIT)?;
        self.waited = waiting_since.elapsed();
        let mut answers =
            Answers { acted: std::mem::take(&mut self.acted), losses: std::mem::take(&mut self.losses) };
        answers.acted.sort_by_key(|batch| batch.auv);
        answers.losses.sort_by_key(|loss| loss.auv);
        Ok(answers)
    }

    fn waited(&self) -> Duration {
        self.waited
    }

    fn vacancies(&mut self) -> Vec<AuvId> {
        let mut vacancies = Vec::new();
        for auvs in std::mem::take(&mut self.orphans) {
            let fits = |index: &usize| {
                let is_taken = self.assigned.iter().any(|(host, _)| host == index);
                !is_taken && self.members[*index].join.slots as usize >= auvs.len()
            };
            let found = self.idle().find(fits);
            match found {
                Some(index) => {
                    vacancies.extend(&auvs);
                    self.assigned.push((index, auvs));
                }
                None => self.orphans.push(auvs),
            }
        }
        vacancies.sort_unstable();
        vacancies
    }

    fn end(&mut self) {
        self.end_with("");
    }
}

impl Drop for HostsFleet {
    fn drop(&mut self) {
        self.end_with("");
        // The process goes on without the session, closed or not.
        let _closed = self.session.close().wait();
    }
}

fn failed(cause: impl Display) -> FleetError {
    FleetError::Failed { bus: BUS, cause: cause.to_string() }
}
