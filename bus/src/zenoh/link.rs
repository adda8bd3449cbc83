//! An AUV's end.

use std::fmt::Display;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use zenoh::bytes::ZBytes;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

use super::frame::{Kind, Up, read_down};
use super::{BUS, down_key, session, up_key};
use crate::codec;
use crate::lockstep::{FromAuv, Link, LinkError, ToAuv};
use crate::message::{Acted, AuvId};
use crate::protocol::{Dialect, Hello};

/// How often an AUV says hello until it is born.
const HELLO_AGAIN: Duration = Duration::from_millis(100);

/// How long an AUV waits before it looks whether the channel is there.
const CHANNEL_CHECK: Duration = Duration::from_secs(1);

/// One AUV's end of the `zenoh` transport.
pub struct ZenohLink {
    inbox: Receiver<ZBytes>,
    up: Publisher<'static>,
    _down: Subscriber<()>,
    session: Session,
    /// Of the last frame down; `None` before birth.
    sequence: Option<u64>,
    has_batch: bool,
}

impl ZenohLink {
    /// Joins the run with this id as `auv`, through the channel that listens on `endpoint`, and reports in.
    pub fn join(endpoint: &str, run: &str, auv: AuvId) -> Result<Self, LinkError> {
        Self::try_join(endpoint, run, auv).map_err(|cause| LinkError::Setup { auv, bus: BUS, cause })
    }

    fn try_join(endpoint: &str, run: &str, auv: AuvId) -> Result<Self, String> {
        let session = session("client", "connect", endpoint)?;
        let (outbox, inbox) = channel();
        let down = session
            .declare_subscriber(down_key(run, auv))
            .callback(move |sample| {
                // Nobody receives any more when the link is being dropped.
                let _dropped = outbox.send(sample.payload().clone());
            })
            .wait()
            .map_err(|error| format!("subscriber: {error}"))?;
        let up = session
            .declare_publisher(up_key(run, auv))
            .congestion_control(CongestionControl::Block)
            .express(true)
            .wait()
            .map_err(|error| format!("publisher: {error}"))?;
        let link = Self { inbox, up, _down: down, session, sequence: None, has_batch: false };
        link.hello().map_err(|error| error.to_string())?;
        Ok(link)
    }

    fn hello(&self) -> Result<(), LinkError> {
        self.send(Kind::Hello, 0, &Hello::new(Dialect::Binary).write())
    }

    fn send(&self, kind: Kind, sequence: u64, message: &[u8]) -> Result<(), LinkError> {
        let frame = Up { kind, sequence, message }.write();
        self.up.put(frame).wait().map_err(failed)
    }

    /// The next frame down.
    fn frame(&self) -> Result<ZBytes, LinkError> {
        loop {
            let patience = if self.sequence.is_some() { CHANNEL_CHECK } else { HELLO_AGAIN };
            match self.inbox.recv_timeout(patience) {
                Ok(frame) => return Ok(frame),
                Err(RecvTimeoutError::Disconnected) => return Err(failed("the subscription has ended")),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if self.session.info().routers_zid().wait().next().is_none() {
                return Err(failed("the connection to the channel has ended"));
            }
            if self.sequence.is_none() {
                self.hello()?;
            }
        }
    }
}

impl Link for ZenohLink {
    fn receive(&mut self) -> Result<ToAuv, LinkError> {
        loop {
            let frame = self.frame()?;
            let bytes = frame.to_bytes();
            let (sequence, message) = read_down(&bytes).ok_or_else(|| failed("a frame is too short"))?;
            let message = codec::decode(message)?;
            match (&message, self.sequence) {
                // Every hello is answered, and several may have been on their way.
                (ToAuv::Born(_), Some(last)) if sequence == last => continue,
                (_, Some(last)) if sequence != last + 1 => {
                    return Err(failed(format_args!("frame {sequence} came after frame {last}")));
                }
                (ToAuv::Sensed(_), None) => return Err(LinkError::NotBorn),
                _ => self.sequence = Some(sequence),
            }
            match message {
                ToAuv::Sensed(_) => self.has_batch = true,
                ToAuv::Born(_) | ToAuv::End => self.send(Kind::Received, sequence, &[])?,
            }
            return Ok(message);
        }
    }

    fn answer(&mut self, acted: Vec<Acted>) -> Result<(), LinkError> {
        match self.sequence {
            Some(sequence) if std::mem::take(&mut self.has_batch) => {
                self.send(Kind::Answer, sequence, &codec::encode(&FromAuv::Acted(acted))?)
            }
            _ => Err(failed("an answer without a batch")),
        }
    }
}

fn failed(cause: impl Display) -> LinkError {
    LinkError::Failed { bus: BUS, cause: cause.to_string() }
}
