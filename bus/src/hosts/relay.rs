//! What reaches a host's own AUVs.

use crate::codec;
use crate::lockstep::{Batch, Fleet, FleetError, FromAuv, Loss, ToAuv};
use crate::message::{AuvId, Born, Sensed};

/// The AUVs of one host, reached by messages as they are written.
pub trait Relay {
    /// Tells each what it is, as [`Fleet::born`] does.
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError>;

    /// Passes on encoded batches (sorted by AUV) and hands every encoded answer to `answered`, as [`Fleet::exchange`] does.
    fn exchange(
        &mut self,
        batches: &[(AuvId, &[u8])],
        answered: &mut dyn FnMut(AuvId, &[u8]),
    ) -> Result<Vec<Loss>, FleetError>;

    /// What makes a wait end in [`FleetError::Interrupted`], from any thread.
    fn interrupter(&self) -> Box<dyn Fn() + Send>;

    /// Tells all that the run is over.
    fn end(&mut self);
}

/// Any fleet as a relay: it decodes what it passes on, and encodes the answers.
pub struct Decoding<F, I> {
    fleet: F,
    interrupter: I,
}

impl<F: Fleet, I: Fn() + Clone + Send + 'static> Decoding<F, I> {
    /// `interrupter` makes a wait of `fleet` end.
    pub fn new(fleet: F, interrupter: I) -> Self {
        Self { fleet, interrupter }
    }
}

impl<F: Fleet, I: Fn() + Clone + Send + 'static> Relay for Decoding<F, I> {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        self.fleet.born(born)
    }

    fn exchange(
        &mut self,
        batches: &[(AuvId, &[u8])],
        answered: &mut dyn FnMut(AuvId, &[u8]),
    ) -> Result<Vec<Loss>, FleetError> {
        let sensed: Vec<Batch<Sensed>> = batches.iter().map(decoded).collect::<Result<_, _>>()?;
        let answers = self.fleet.exchange(&sensed, &mut || {})?;
        for Batch { auv, items } in answers.acted {
            let message = codec::encode(&FromAuv::Acted(items)).map_err(failed)?;
            answered(auv, &message);
        }
        Ok(answers.losses)
    }

    fn interrupter(&self) -> Box<dyn Fn() + Send> {
        Box::new(self.interrupter.clone())
    }

    fn end(&mut self) {
        self.fleet.end();
    }
}

fn decoded(&(auv, message): &(AuvId, &[u8])) -> Result<Batch<Sensed>, FleetError> {
    match codec::decode(message).map_err(failed)? {
        ToAuv::Sensed(items) => Ok(Batch { auv, items }),
        _ => Err(failed("what is to be passed on is no batch")),
    }
}

fn failed(cause: impl std::fmt::Display) -> FleetError {
    FleetError::Failed { bus: super::BUS, cause: cause.to_string() }
}
