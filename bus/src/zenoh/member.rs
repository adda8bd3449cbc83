//! What the channel keeps of each AUV, and how it takes what that sends.

use zenoh::pubsub::Publisher;
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

use super::down_key;
use super::fleet::failed;
use super::frame::{Kind, Up, write_down};
use crate::lockstep::{Answers, Batch, FleetError, Loss};
use crate::message::{AuvId, Born, Sensed};
use crate::protocol::{Dialect, Hello};
use crate::wire::ToAuvRef;

/// One AUV as the channel sees it.
pub(super) struct Member {
    pub(super) auv: AuvId,
    pub(super) down: Publisher<'static>,
    /// Of the last frame down.
    pub(super) sequence: u64,
    pub(super) is_alive: bool,
    pub(super) has_ended: bool,
    pub(super) awaits: Awaits,
    /// What it said it speaks, when it said hello.
    dialect: Dialect,
}

/// What the channel waits for from one AUV.
pub(super) enum Awaits {
    Nothing,
    /// Each hello is answered with this until it is acknowledged.
    Birth(Box<Born>),
    /// So many answers.
    Answers(usize),
    End,
}

impl Member {
    pub(super) fn new(session: &Session, run: &str, auv: AuvId) -> Result<Self, String> {
        let down = session
            .declare_publisher(down_key(run, auv))
            .congestion_control(CongestionControl::Block)
            .express(true)
            .wait()
            .map_err(|error| format!("publisher for AUV {auv}: {error}"))?;
        Ok(Self {
            auv,
            down,
            sequence: 0,
            is_alive: false,
            has_ended: false,
            awaits: Awaits::Nothing,
            dialect: Dialect::default(),
        })
    }

    pub(super) fn is_awaited(&self) -> bool {
        self.is_alive && !matches!(self.awaits, Awaits::Nothing)
    }

    pub(super) fn send_next(&mut self, message: &ToAuvRef<'_>) -> Result<(), FleetError> {
        self.sequence += 1;
        self.send(message)
    }

    fn send(&self, message: &ToAuvRef<'_>) -> Result<(), FleetError> {
        let body = self.dialect.write(message).map_err(failed)?;
        self.down.put(write_down(self.sequence, &body)).wait().map_err(failed)
    }

    /// Sends what it sensed and awaits its answers.
    pub(super) fn send_batch(&mut self, items: &[Sensed]) -> Result<(), FleetError> {
        self.send_next(&ToAuvRef::Sensed(items))?;
        self.awaits = Awaits::Answers(items.len());
        Ok(())
    }

    pub(super) fn lose(&mut self, reason: &str, losses: &mut Vec<Loss>) {
        self.is_alive = false;
        self.awaits = Awaits::Nothing;
        losses.push(Loss { auv: self.auv, reason: reason.to_owned() });
    }

    /// Takes in a frame. Returns whether this AUV is awaited no longer. Whatever it sends, the run goes on.
    pub(super) fn take(&mut self, bytes: &[u8], answers: &mut Answers) -> Result<bool, FleetError> {
        if !self.is_alive {
            return Ok(false);
        }
        let was_awaited = self.is_awaited();
        match self.understand(bytes, answers) {
            Ok(()) => {}
            Err(Trouble::Refused(reason)) => {
                self.lose(&reason, &mut answers.losses);
                // So that its process does not wait for what never comes; one that does not hear it ends with the run.
                self.send_next(&ToAuvRef::End)?;
            }
            Err(Trouble::Failed(error)) => return Err(error),
        }
        Ok(was_awaited && !self.is_awaited())
    }

    fn understand(&mut self, bytes: &[u8], answers: &mut Answers) -> Result<(), Trouble> {
        let refused = |reason: &str| Err(Trouble::Refused(reason.to_owned()));
        let Some(up) = Up::read(bytes) else {
            return refused("sent a frame without kind (0, 1 or 2) and sequence number (8 bytes)");
        };
        let awaits = std::mem::replace(&mut self.awaits, Awaits::Nothing);
        match (awaits, up.kind) {
            (Awaits::Birth(born), Kind::Hello) => {
                // Whoever cannot say hello is told so in what is easiest to read.
                self.dialect = Dialect::Json;
                self.dialect = Hello::read(up.message).map_err(Trouble::Refused)?.dialect;
                self.send(&ToAuvRef::Born(&born))?;
                self.awaits = Awaits::Birth(born);
            }
            // All hellos that were on their way when birth arrived came before it was acknowledged.
            (_, Kind::Hello) => return refused("said hello again after its birth"),
            (_, _) if up.sequence != self.sequence => {
                let (found, expected) = (up.sequence, self.sequence);
                return refused(&format!("answered frame {found} instead of {expected}"));
            }
            (Awaits::Birth(_) | Awaits::End, Kind::Received) => {}
            (Awaits::Answers(ticks), Kind::Answer) => {
                let items = self.dialect.read_acted(up.message, ticks).map_err(Trouble::Refused)?;
                answers.acted.push(Batch { auv: self.auv, items });
            }
            (Awaits::Birth(_) | Awaits::End, Kind::Answer) => return refused("answered before it was asked"),
            (Awaits::Answers(_), Kind::Received) => return refused("acknowledged a batch without an answer"),
            (Awaits::Nothing, _) => return refused("sent an answer that nobody asked for"),
        }
        Ok(())
    }
}

/// Why a frame was not understood.
enum Trouble {
    /// Its sender is lost for this reason.
    Refused(String),
    /// The transport failed.
    Failed(FleetError),
}

impl From<FleetError> for Trouble {
    fn from(error: FleetError) -> Self {
        Self::Failed(error)
    }
}
