//! The channel's end.

use std::fmt::Display;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use zenoh::bytes::ZBytes;
use zenoh::pubsub::Subscriber;
use zenoh::{Session, Wait};

use super::member::{Awaits, Member};
use super::{BUS, session, up_key};
use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss, PROCESS_ENDED};
use crate::message::{AuvId, Born, Sensed};
use crate::os::raise_descriptor_limit;
use crate::run_dir::RunDir;
use crate::watch::Watch;
use crate::wire::ToAuvRef;

/// How long live AUVs may be silent unless [`ZenohFleet::set_stall_limit`] says otherwise.
const STALL_LIMIT: Duration = Duration::from_secs(300);

/// How long the end of a run waits for the AUVs to have heard of it.
const FAREWELL: Duration = Duration::from_secs(2);

/// The channel's end of the `zenoh` transport.
pub struct ZenohFleet {
    watch: Watch,
    _up: Subscriber<()>,
    members: Vec<Member>,
    events: Receiver<Event>,
    post: Sender<Event>,
    session: Session,
    stall_limit: Duration,
    waited: Duration,
    has_told_end: bool,
}

enum Event {
    /// What the AUV whose key it came on has sent.
    Up(AuvId, ZBytes),
    ProcessEnded(AuvId),
    Interrupted,
}

/// Makes a waiting [`ZenohFleet`] give up, from any thread.
#[derive(Clone)]
pub struct ZenohInterruptHandle(Sender<Event>);

impl ZenohInterruptHandle {
    /// What the fleet is waiting for, or does next, ends in [`FleetError::Interrupted`].
    pub fn interrupt(&self) {
        // A fleet that is gone waits for nothing.
        let _gone = self.0.send(Event::Interrupted);
    }
}

impl ZenohFleet {
    /// The endpoint of a run whose processes are all on this host: a socket in its folder.
    pub fn local_endpoint(run: &RunDir) -> String {
        format!("unixsock-stream/{}", run.zenoh_socket().display())
    }

    /// Listens on `endpoint`, such as [`local_endpoint`](Self::local_endpoint) or `tcp/127.0.0.1:7447`, for the AUVs of the
    /// run with this id.
    pub fn create(endpoint: &str, run: &str, auvs: &[AuvId]) -> Result<Self, FleetError> {
        Self::try_create(endpoint, run, auvs).map_err(|cause| FleetError::Setup { bus: BUS, cause })
    }

    fn try_create(endpoint: &str, run: &str, auvs: &[AuvId]) -> Result<Self, String> {
        raise_descriptor_limit().map_err(|error| format!("descriptor limit: {error}"))?;
        let session = session("router", "listen", endpoint)?;
        let (post, events) = channel();
        let arrived = post.clone();
        let up = session
            .declare_subscriber(up_key(run, '*'))
            .callback(move |sample| {
                let auv = sample.key_expr().rsplit('/').next().and_then(|auv| auv.parse().ok());
                if let Some(auv) = auv {
                    // Nobody receives any more when the fleet is being dropped.
                    let _dropped = arrived.send(Event::Up(AuvId(auv), sample.payload().clone()));
                }
            })
            .wait()
            .map_err(|error| format!("subscriber: {error}"))?;
        let ended = post.clone();
        let watch = Watch::new(move |auv| {
            let _dropped = ended.send(Event::ProcessEnded(auv));
        });
        let watch = watch.map_err(|error| format!("watch: {error}"))?;
        let mut auvs = auvs.to_vec();
        auvs.sort_unstable();
        let members =
            auvs.into_iter().map(|auv| Member::new(&session, run, auv)).collect::<Result<_, String>>()?;
        Ok(Self {
            watch,
            _up: up,
            members,
            events,
            post,
            session,
            stall_limit: STALL_LIMIT,
            waited: Duration::ZERO,
            has_told_end: false,
        })
    }

    /// Says which process of this host is which AUV, so that its end is noticed; again for one that was restarted.
    pub fn attach_processes(&mut self, processes: &[(AuvId, u32)]) -> Result<(), FleetError> {
        for (auv, _) in processes {
            let index = self.index(*auv)?;
            self.members[index].has_ended = false;
        }
        self.watch.attach(processes).map_err(failed)
    }

    /// How long live AUVs may be silent before [`FleetError::Stalled`]; 300 s at first.
    pub fn set_stall_limit(&mut self, limit: Duration) {
        self.stall_limit = limit;
    }

    /// A handle that makes this fleet give up.
    pub fn interrupt_handle(&self) -> ZenohInterruptHandle {
        ZenohInterruptHandle(self.post.clone())
    }

    fn index(&self, auv: AuvId) -> Result<usize, FleetError> {
        let found = self.members.binary_search_by_key(&auv, |member| member.auv);
        found.map_err(|_| failed(format_args!("AUV {auv} is not of this run")))
    }

    /// Takes in what has arrived since the last window, and the ends among it.
    fn bury(&mut self, answers: &mut Answers) -> Result<(), FleetError> {
        while let Ok(event) = self.events.try_recv() {
            self.take(&event, answers)?;
        }
        for member in self.members.iter_mut().filter(|member| member.is_alive && member.has_ended) {
            member.lose(PROCESS_ENDED, &mut answers.losses);
        }
        Ok(())
    }

    /// Waits until nobody is awaited any more, at most for `limit` without any news.
    fn wait(&mut self, answers: &mut Answers, limit: Duration) -> Result<(), FleetError> {
        let mut awaited = self.members.iter().filter(|member| member.is_awaited()).count();
        let mut since = Instant::now();
        while awaited > 0 {
            match self.events.recv_timeout(limit.saturating_sub(since.elapsed())) {
                Ok(event) if self.take(&event, answers)? => {
                    awaited -= 1;
                    since = Instant::now();
                }
                Ok(_) => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                    let waiting = self.members.iter().filter(|member| member.is_awaited());
                    let waiting = waiting.map(|member| member.auv).collect();
                    return Err(FleetError::Stalled { waiting, limit_s: limit.as_secs() });
                }
            }
        }
        Ok(())
    }

    /// Waits until nobody is awaited any more, or until `deadline`.
    fn wait_until(&mut self, answers: &mut Answers, deadline: Instant) -> Result<(), FleetError> {
        let mut awaited = self.members.iter().filter(|member| member.is_awaited()).count();
        while awaited > 0 {
            match self.events.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(event) => awaited -= usize::from(self.take(&event, answers)?),
                Err(_) => break,
            }
        }
        Ok(())
    }

    /// Takes in one event. Returns whether somebody is awaited no longer.
    fn take(&mut self, event: &Event, answers: &mut Answers) -> Result<bool, FleetError> {
        match event {
            Event::Interrupted => Err(FleetError::Interrupted),
            Event::ProcessEnded(auv) => {
                let index = self.index(*auv)?;
                let member = &mut self.members[index];
                member.has_ended = true;
                let was_awaited = member.is_awaited();
                if was_awaited {
                    member.lose(PROCESS_ENDED, &mut answers.losses);
                }
                Ok(was_awaited)
            }
            Event::Up(auv, payload) => match self.index(*auv) {
                Ok(index) => self.members[index].take(&payload.to_bytes(), answers),
                Err(_) => Ok(false),
            },
        }
    }
}

impl Fleet for ZenohFleet {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        let mut answers = Answers::default();
        for born in born {
            let index = self.index(born.auv)?;
            let member = &mut self.members[index];
            member.sequence += 1;
            member.is_alive = true;
            member.awaits = Awaits::Birth(Box::new(born.clone()));
            if member.has_ended {
                member.lose(PROCESS_ENDED, &mut answers.losses);
            }
        }
        self.wait(&mut answers, self.stall_limit)?;
        answers.losses.sort_by_key(|loss| loss.auv);
        Ok(answers.losses)
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut answers = Answers::default();
        self.bury(&mut answers)?;
        for batch in sensed {
            let index = self.index(batch.auv)?;
            let member = &mut self.members[index];
            if member.is_alive {
                member.send_batch(&batch.items)?;
            }
        }
        meanwhile();
        let since = Instant::now();
        self.wait(&mut answers, self.stall_limit)?;
        self.waited = since.elapsed();
        answers.sort();
        Ok(answers)
    }

    fn waited(&self) -> Duration {
        self.waited
    }

    fn exchange_until(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        deadline: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut answers = Answers::default();
        self.bury(&mut answers)?;
        let mut unsent = Vec::new();
        for batch in sensed.drain(..) {
            let index = self.index(batch.auv)?;
            let member = &mut self.members[index];
            if member.is_awaited() {
                unsent.push(batch);
            } else if member.is_alive {
                member.send_batch(&batch.items)?;
            }
        }
        *sensed = unsent;
        meanwhile();
        self.wait_until(&mut answers, deadline)?;
        answers.sort();
        Ok(answers)
    }

    fn end(&mut self) {
        if std::mem::replace(&mut self.has_told_end, true) {
            return;
        }
        for member in &mut self.members {
            let is_told = member.is_alive && !member.has_ended && member.send_next(&ToAuvRef::End).is_ok();
            member.awaits = if is_told { Awaits::End } else { Awaits::Nothing };
        }
        // Whoever does not hear of it in time ends with the connection.
        let _all_heard = self.wait(&mut Answers::default(), FAREWELL);
    }
}

impl Drop for ZenohFleet {
    fn drop(&mut self) {
        self.end();
        // The process goes on without the session, closed or not.
        let _closed = self.session.close().wait();
    }
}

pub(super) fn failed(cause: impl Display) -> FleetError {
    FleetError::Failed { bus: BUS, cause: cause.to_string() }
}
