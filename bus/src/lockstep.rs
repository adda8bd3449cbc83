//! Lockstep: the one meaning that every transport keeps.
//!
//! The channel advances in windows. In each it sends every AUV that is due its ordered batch of [`Sensed`], and waits until
//! each of them has answered with as many [`Acted`], or has died. Slowness is waited for and changes nothing.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use thiserror::Error;

use crate::message::{Acted, AuvId, Born, Sensed};

/// One AUV's ordered batch for one window.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch<T> {
    /// Whose.
    pub auv: AuvId,
    /// In the order of its ticks.
    pub items: Vec<T>,
}

/// The reason of a loss whose process has ended; how, its parent knows.
pub const PROCESS_ENDED: &str = "its process ended";

/// An AUV that is gone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loss {
    /// Who.
    pub auv: AuvId,
    /// How it ended, as a clause; [`PROCESS_ENDED`] when no more is known here.
    pub reason: String,
}

/// What a window brought back.
#[derive(Debug, Default, PartialEq)]
pub struct Answers {
    /// Answers, sorted by AUV, one [`Acted`] for every [`Sensed`] of the batch.
    pub acted: Vec<Batch<Acted>>,
    /// AUVs that were found dead in this window; they have no answer.
    pub losses: Vec<Loss>,
}

impl Answers {
    /// Puts what came from several places in the order of the AUVs.
    pub(crate) fn sort(&mut self) {
        self.acted.sort_by_key(|batch| batch.auv);
        self.losses.sort_by_key(|loss| loss.auv);
    }
}

/// The channel's end of a transport: all AUVs of a run.
pub trait Fleet {
    /// Waits for every AUV to report in and tells each what it is. `born` is sorted by AUV. Those that die before they
    /// answer are returned as losses.
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError>;

    /// Sends the batches (sorted by AUV) and gathers the answers. An AUV without a batch stays asleep. `meanwhile` is called
    /// once, when all is sent and the AUVs are at work.
    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError>;

    /// AUVs that were lost and have a place again, sorted: their births may follow, by [`born`](Self::born). Each is told once.
    fn vacancies(&mut self) -> Vec<AuvId> {
        Vec::new()
    }

    /// How long the last exchange waited for AUVs at work, `meanwhile` excluded; nothing where that is not known.
    fn waited(&self) -> Duration {
        Duration::ZERO
    }

    /// As [`exchange`](Self::exchange), for AUVs that may be late: waits until `deadline` at most, for those at work on earlier
    /// batches as well, and brings back whatever is there. Batches of AUVs that are still at work are not sent: they stay in
    /// `sensed`, in which each AUV has one batch at most, and can grow until a later exchange takes them.
    ///
    /// # Errors
    /// Silence is none here. [`FleetError::NoDeadlines`] from transports that can only wait.
    fn exchange_until(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        deadline: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let (_, _, _) = (sensed, deadline, meanwhile);
        Err(FleetError::NoDeadlines)
    }

    /// Tells every AUV that the run is over.
    fn end(&mut self);
}

/// The end of a transport in a process of AUVs: usually one, at times several that share it.
pub trait Link {
    /// The next message from the channel; blocks.
    fn receive(&mut self) -> Result<ToProcess, LinkError>;
    /// Answers the last batch that its AUV received. Batches of other AUVs may be received in between.
    fn answer(&mut self, acted: Batch<Acted>) -> Result<(), LinkError>;
}

/// What a process of AUVs hears.
#[derive(Clone, Debug, PartialEq)]
pub enum ToProcess {
    /// What one of its AUVs is.
    Born(Box<Born>),
    /// What one of its AUVs sensed.
    Sensed(Batch<Sensed>),
    /// The run is over, for all of them.
    End,
}

/// From the channel to one AUV, as it is written.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum ToAuv {
    /// What you are.
    Born(Box<Born>),
    /// What you sensed, tick by tick.
    Sensed(Vec<Sensed>),
    /// The run is over.
    End,
}

/// From one AUV to the channel, as it is written.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum FromAuv {
    /// The answers to one batch.
    Acted(Vec<Acted>),
}

/// One vehicle's mind as a pure state machine.
pub trait Mind {
    /// Takes in one tick and answers it.
    fn step(&mut self, sensed: &Sensed) -> Acted;
}

/// Lives the lives of a process's AUVs on a link: each waits to be born, answers batches, ends when told.
pub fn live<M: Mind>(link: &mut dyn Link, be_born: impl Fn(&Born) -> M) -> Result<(), LinkError> {
    let mut minds: BTreeMap<AuvId, M> = BTreeMap::new();
    loop {
        match link.receive()? {
            ToProcess::Born(born) => {
                minds.insert(born.auv, be_born(&born));
            }
            ToProcess::Sensed(Batch { auv, items }) => {
                let Some(mind) = minds.get_mut(&auv) else { return Err(LinkError::NotBorn { auv }) };
                let acted = items.iter().map(|sensed| mind.step(sensed)).collect();
                link.answer(Batch { auv, items: acted })?;
            }
            ToProcess::End => return Ok(()),
        }
    }
}

/// What stops the channel's end of a transport.
#[derive(Debug, Error)]
pub enum FleetError {
    /// The transport could not be set up.
    #[error("the {bus} bus could not be set up: {cause}")]
    Setup {
        /// Which transport.
        bus: &'static str,
        /// What its library said.
        cause: String,
    },
    /// The transport failed in the middle of a run.
    #[error("the {bus} bus failed: {cause}")]
    Failed {
        /// Which transport.
        bus: &'static str,
        /// What its library said.
        cause: String,
    },
    /// Live AUVs gave no answer for a very long time.
    #[error("AUVs {} gave no answer for {limit_s} s, though their processes are alive", list(waiting))]
    Stalled {
        /// Who is being waited for.
        waiting: Vec<AuvId>,
        /// For how long.
        limit_s: u64,
    },
    /// Somebody asked for deadlines of a transport that waits for every answer.
    #[error("this transport waits for every answer, so it cannot run freely")]
    NoDeadlines,
    /// The launcher asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// What stops the end of a transport in a process of AUVs.
#[derive(Debug, Error)]
pub enum LinkError {
    /// The transport could not be set up.
    #[error("could not join the {bus} bus: {cause}")]
    Setup {
        /// Which transport.
        bus: &'static str,
        /// What its library said.
        cause: String,
    },
    /// The transport failed.
    #[error("the {bus} bus failed: {cause}")]
    Failed {
        /// Which transport.
        bus: &'static str,
        /// What its library said.
        cause: String,
    },
    /// A message could not be read.
    #[error("a message from the channel could not be read: {0}")]
    Codec(#[from] crate::codec::CodecError),
    /// A batch came before birth.
    #[error("the channel sent a batch before it sent what AUV {auv} is")]
    NotBorn {
        /// Who.
        auv: AuvId,
    },
}

fn list(auvs: &[AuvId]) -> String {
    let shown: Vec<String> = auvs.iter().take(10).map(AuvId::to_string).collect();
    let more = auvs.len().saturating_sub(shown.len());
    if more == 0 { shown.join(", ") } else { format!("{} and {more} more", shown.join(", ")) }
}
