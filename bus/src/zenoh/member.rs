//! What the channel keeps of each AUV, and how it takes what that sends.

use zenoh::pubsub::Publisher;
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

use super::down_key;
use super::fleet::failed;
use super::frame::{Kind, Up, write_down};
use crate::codec;
use crate::lockstep::{Answers, Batch, FleetError, Loss};
use crate::message::{AuvId, Sensed};
use crate::wire::{NOT_A_MESSAGE, ToAuvRef, read_acted};

/// One AUV as the channel sees it.
pub(super) struct Member {
    pub(super) auv: AuvId,
    pub(super) down: Publisher<'static>,
    /// Of the last frame down.
    pub(super) sequence: u64,
    pub(super) is_alive: bool,
    pub(super) has_ended: bool,
    pub(super) awaits: Awaits,
}

/// What the channel waits for from one AUV.
pub(super) enum Awaits {
    Nothing,
    /// Each hello is answered with this frame until one is acknowledged.
    Birth(Vec<u8>),
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
        Ok(Self { auv, down, sequence: 0, is_alive: false, has_ended: false, awaits: Awaits::Nothing })
    }

    pub(super) fn is_awaited(&self) -> bool {
        self.is_alive && !matches!(self.awaits, Awaits::Nothing)
    }

    pub(super) fn send_next(&mut self, message: &[u8]) -> Result<(), FleetError> {
        self.sequence += 1;
        self.down.put(write_down(self.sequence, message)).wait().map_err(failed)
    }

    /// Sends what it sensed and awaits its answers.
    pub(super) fn send_batch(&mut self, items: &[Sensed]) -> Result<(), FleetError> {
        let message = codec::encode(&ToAuvRef::Sensed(items)).map_err(failed)?;
        self.send_next(&message)?;
        self.awaits = Awaits::Answers(items.len());
        Ok(())
    }

    pub(super) fn lose(&mut self, reason: &str, losses: &mut Vec<Loss>) {
        self.is_alive = false;
        self.awaits = Awaits::Nothing;
        losses.push(Loss { auv: self.auv, reason: reason.to_owned() });
    }

    /// Takes in a frame. Returns whether this AUV is awaited no longer.
    pub(super) fn take(&mut self, bytes: &[u8], answers: &mut Answers) -> Result<bool, FleetError> {
        if !self.is_alive {
            return Ok(false);
        }
        let Some(up) = Up::read(bytes) else {
            let was_awaited = self.is_awaited();
            self.lose(NOT_A_MESSAGE, &mut answers.losses);
            return Ok(was_awaited);
        };
        match (&self.awaits, up.kind) {
            (Awaits::Birth(frame), Kind::Hello) => {
                self.down.put(frame.clone()).wait().map_err(failed)?;
                return Ok(false);
            }
            // One that was on its way when birth arrived.
            (_, Kind::Hello) => return Ok(false),
            (_, _) if up.sequence != self.sequence => {
                let (auv, found, expected) = (self.auv, up.sequence, self.sequence);
                return Err(failed(format_args!("AUV {auv} answered frame {found} instead of {expected}")));
            }
            (Awaits::Birth(_) | Awaits::End, Kind::Received) => self.awaits = Awaits::Nothing,
            (Awaits::Answers(ticks), Kind::Answer) => match read_acted(up.message, *ticks) {
                Ok(items) => {
                    self.awaits = Awaits::Nothing;
                    answers.acted.push(Batch { auv: self.auv, items });
                }
                Err(reason) => self.lose(&reason, &mut answers.losses),
            },
            _ => {
                let was_awaited = self.is_awaited();
                self.lose(NOT_A_MESSAGE, &mut answers.losses);
                return Ok(was_awaited);
            }
        }
        Ok(true)
    }
}
