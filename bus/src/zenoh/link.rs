//! The end in a process of AUVs.

use std::fmt::Display;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use zenoh::bytes::ZBytes;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

use super::frame::{Kind, Up, read_down};
use super::{BUS, down_key, session, up_key};
use crate::codec;
use crate::lockstep::{Batch, FromAuv, Link, LinkError, ToAuv, ToProcess};
use crate::message::{Acted, AuvId};
use crate::protocol::{Dialect, Hello};

/// How often an AUV says hello until it is born.
const HELLO_AGAIN: Duration = Duration::from_millis(100);

/// How long an AUV waits before it looks whether the channel is there.
const CHANNEL_CHECK: Duration = Duration::from_secs(1);

/// The end of the `zenoh` transport in a process of AUVs: one session for all of them.
pub struct ZenohLink {
    inbox: Receiver<(usize, ZBytes)>,
    members: Vec<Member>,
    session: Session,
}

struct Member {
    auv: AuvId,
    up: Publisher<'static>,
    _down: Subscriber<()>,
    /// Of the last frame down; `None` before birth.
    sequence: Option<u64>,
    has_batch: bool,
    has_ended: bool,
}

impl ZenohLink {
    /// Joins the run with this id for these AUVs, through the channel that listens on `endpoint`, and reports in.
    pub fn join(endpoint: &str, run: &str, auvs: &[AuvId]) -> Result<Self, LinkError> {
        Self::try_join(endpoint, run, auvs).map_err(|cause| LinkError::Setup { bus: BUS, cause })
    }

    fn try_join(endpoint: &str, run: &str, auvs: &[AuvId]) -> Result<Self, String> {
        let session = session("client", "connect", endpoint)?;
        let (outbox, inbox) = channel();
        let join = |(index, &auv)| Member::join(&session, run, auv, index, outbox.clone());
        let members = auvs.iter().enumerate().map(join).collect::<Result<Vec<_>, String>>()?;
        let link = Self { inbox, members, session };
        link.hello().map_err(|error| error.to_string())?;
        Ok(link)
    }

    /// Reports those in that are not born yet.
    fn hello(&self) -> Result<(), LinkError> {
        let message = Hello::new(Dialect::Binary).write();
        let mut unborn = self.members.iter().filter(|member| member.sequence.is_none());
        unborn.try_for_each(|member| member.send(Kind::Hello, 0, &message))
    }

    /// The next frame down, and the index of its AUV.
    fn frame(&self) -> Result<(usize, ZBytes), LinkError> {
        loop {
            let is_born = self.members.iter().all(|member| member.sequence.is_some());
            let patience = if is_born { CHANNEL_CHECK } else { HELLO_AGAIN };
            match self.inbox.recv_timeout(patience) {
                Ok(frame) => return Ok(frame),
                Err(RecvTimeoutError::Disconnected) => return Err(failed("the subscription has ended")),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if self.session.info().routers_zid().wait().next().is_none() {
                return Err(failed("the connection to the channel has ended"));
            }
            self.hello()?;
        }
    }
}

impl Member {
    fn join(
        session: &Session,
        run: &str,
        auv: AuvId,
        index: usize,
        outbox: Sender<(usize, ZBytes)>,
    ) -> Result<Self, String> {
        let down = session
            .declare_subscriber(down_key(run, auv))
            .callback(move |sample| {
                // Nobody receives any more when the link is being dropped.
                let _dropped = outbox.send((index, sample.payload().clone()));
            })
            .wait()
            .map_err(|error| format!("subscriber: {error}"))?;
        let up = session
            .declare_publisher(up_key(run, auv))
            .congestion_control(CongestionControl::Block)
            .express(true)
            .wait()
            .map_err(|error| format!("publisher: {error}"))?;
        Ok(Self { auv, up, _down: down, sequence: None, has_batch: false, has_ended: false })
    }

    fn send(&self, kind: Kind, sequence: u64, message: &[u8]) -> Result<(), LinkError> {
        let frame = Up { kind, sequence, message }.write();
        self.up.put(frame).wait().map_err(failed)
    }

    /// Takes a frame down. `None`: it was there before.
    fn take(&mut self, bytes: &[u8]) -> Result<Option<ToAuv>, LinkError> {
        let (sequence, message) = read_down(bytes).ok_or_else(|| failed("a frame is too short"))?;
        let message = codec::decode(message)?;
        match (&message, self.sequence) {
            // Every hello is answered, and several may have been on their way.
            (ToAuv::Born(_), Some(last)) if sequence == last => return Ok(None),
            (_, Some(last)) if sequence != last + 1 => {
                return Err(failed(format_args!("frame {sequence} came after frame {last}")));
            }
            (ToAuv::Sensed(_), None) => return Err(LinkError::NotBorn { auv: self.auv }),
            _ => self.sequence = Some(sequence),
        }
        match message {
            ToAuv::Sensed(_) => self.has_batch = true,
            ToAuv::Born(_) | ToAuv::End => self.send(Kind::Received, sequence, &[])?,
        }
        Ok(Some(message))
    }
}

impl Link for ZenohLink {
    fn receive(&mut self) -> Result<ToProcess, LinkError> {
        loop {
            let (index, frame) = self.frame()?;
            let Some(member) = self.members.get_mut(index) else { continue };
            match member.take(&frame.to_bytes())? {
                Some(ToAuv::Born(born)) => return Ok(ToProcess::Born(born)),
                Some(ToAuv::Sensed(items)) => {
                    return Ok(ToProcess::Sensed(Batch { auv: member.auv, items }));
                }
                Some(ToAuv::End) => member.has_ended = true,
                None => {}
            }
            // Each is told, and acknowledges it; those that were never born are not.
            let is_over = |member: &Member| member.has_ended || member.sequence.is_none();
            if self.members.iter().all(is_over) && self.members.iter().any(|member| member.has_ended) {
                return Ok(ToProcess::End);
            }
        }
    }

    fn answer(&mut self, acted: Batch<Acted>) -> Result<(), LinkError> {
        let member = self.members.iter_mut().find(|member| member.auv == acted.auv && member.has_batch);
        let Some((sequence, member)) = member.and_then(|member| Some((member.sequence?, member))) else {
            return Err(failed("an answer without a batch"));
        };
        member.has_batch = false;
        member.send(Kind::Answer, sequence, &codec::encode(&FromAuv::Acted(acted.items))?)
    }
}

fn failed(cause: impl Display) -> LinkError {
    LinkError::Failed { bus: BUS, cause: cause.to_string() }
}
