//! Several fleets as one: a run whose AUVs do not all come by the same transport.

use std::borrow::Cow;
use std::time::{Duration, Instant};

use crate::lockstep::{Answers, Batch, Fleet, FleetError, Loss};
use crate::message::{AuvId, Born, Sensed};

const BUS: &str = "composite";

/// One of the fleets of a [`Composite`], and the AUVs that it carries.
pub struct Part<'a> {
    /// In any order; no other part carries any of them.
    pub auvs: Vec<AuvId>,
    /// What carries them.
    pub fleet: Box<dyn Fleet + 'a>,
}

/// Fleets that each carry some of a run's AUVs. All are sent to before any is waited for, and what they bring back is put in the
/// order of the AUVs: how a run is divided into parts changes nothing.
///
/// A part that does its work in this program ([`Local`](crate::local::Local)) belongs at the end: the others are at work meanwhile.
///
/// ```
/// use shoal_bus::composite::{Composite, Part};
/// use shoal_bus::local::Local;
/// use shoal_bus::lockstep::{Fleet, Mind};
/// use shoal_bus::message::{Acted, AuvId, Born, Sensed};
///
/// struct Never;
/// impl Mind for Never {
///     fn step(&mut self, _: &Sensed) -> Acted {
///         unreachable!("nobody is due here")
///     }
/// }
/// let part = |auvs: &[u32]| Part {
///     auvs: auvs.iter().copied().map(AuvId).collect(),
///     fleet: Box::new(Local::new(|_: &Born| Never)),
/// };
/// let mut fleet = Composite::new(vec![part(&[0, 2]), part(&[1])])?;
/// let mut calls = 0;
/// assert!(fleet.exchange(&[], &mut || calls += 1)?.acted.is_empty());
/// assert_eq!(calls, 1);
/// assert!(Composite::new(vec![part(&[0, 2]), part(&[2])]).is_err());
/// # Ok::<(), shoal_bus::lockstep::FleetError>(())
/// ```
pub struct Composite<'a> {
    fleets: Vec<Box<dyn Fleet + 'a>>,
    /// Who is carried by which fleet, sorted by AUV.
    places: Vec<(AuvId, usize)>,
}

impl<'a> Composite<'a> {
    /// Puts the parts together.
    ///
    /// # Errors
    /// [`FleetError::Setup`] when two parts carry the same AUV.
    pub fn new(parts: Vec<Part<'a>>) -> Result<Self, FleetError> {
        let mut places = Vec::new();
        let mut fleets = Vec::with_capacity(parts.len());
        for (index, Part { auvs, fleet }) in parts.into_iter().enumerate() {
            places.extend(auvs.into_iter().map(|auv| (auv, index)));
            fleets.push(fleet);
        }
        places.sort_unstable();
        if let Some(twice) = places.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let cause = format!("AUV {} is carried twice", twice[0].0);
            return Err(FleetError::Setup { bus: BUS, cause });
        }
        Ok(Self { fleets, places })
    }

    /// Which part carries each of these AUVs, which ascend.
    fn parts_of(&self, auvs: impl Iterator<Item = AuvId>) -> Result<Vec<usize>, FleetError> {
        // Both are in the order of the AUVs.
        let mut places = self.places.iter();
        auvs.map(|auv| match places.find(|(carried, _)| *carried >= auv) {
            Some((carried, part)) if *carried == auv => Ok(*part),
            _ => {
                let cause = format!("no part carries AUV {auv}, or its batch is out of order");
                Err(FleetError::Failed { bus: BUS, cause })
            }
        })
        .collect()
    }

    /// What of `all`, sorted by AUV, belongs to each part: a piece of it where the part's AUVs stand together, a copy otherwise.
    fn shares<'s, T: Clone>(
        &self,
        all: &'s [T],
        auv_of: impl Fn(&T) -> AuvId,
    ) -> Result<Vec<Cow<'s, [T]>>, FleetError> {
        let mut indices: Vec<Vec<usize>> = vec![Vec::new(); self.fleets.len()];
        for (index, part) in self.parts_of(all.iter().map(auv_of))?.into_iter().enumerate() {
            indices[part].push(index);
        }
        Ok(indices.iter().map(|of_part| share(all, of_part)).collect())
    }

    /// Takes all batches and deals them out to the parts.
    fn deal(&self, all: &mut Vec<Batch<Sensed>>) -> Result<Vec<Vec<Batch<Sensed>>>, FleetError> {
        let parts = self.parts_of(all.iter().map(|batch| batch.auv))?;
        let mut shares: Vec<Vec<Batch<Sensed>>> = self.fleets.iter().map(|_| Vec::new()).collect();
        for (batch, part) in all.drain(..).zip(parts) {
            shares[part].push(batch);
        }
        Ok(shares)
    }
}

/// The elements of `all` at these ascending indices.
fn share<'s, T: Clone>(all: &'s [T], indices: &[usize]) -> Cow<'s, [T]> {
    match indices {
        [] => Cow::Borrowed(&[]),
        [first, .., last] if last - first + 1 > indices.len() => {
            Cow::Owned(indices.iter().map(|index| all[*index].clone()).collect())
        }
        [first, ..] => Cow::Borrowed(&all[*first..first + indices.len()]),
    }
}

impl Fleet for Composite<'_> {
    fn born(&mut self, born: &[Born]) -> Result<Vec<Loss>, FleetError> {
        let shares = self.shares(born, |born| born.auv)?;
        let mut losses = Vec::new();
        for (fleet, share) in self.fleets.iter_mut().zip(&shares) {
            losses.extend(fleet.born(share)?);
        }
        losses.sort_by_key(|loss| loss.auv);
        Ok(losses)
    }

    fn exchange(
        &mut self,
        sensed: &[Batch<Sensed>],
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let shares = self.shares(sensed, |batch| batch.auv)?;
        let mut answers = Answers::default();
        exchange_within(&mut self.fleets, &shares, meanwhile, &mut answers)?;
        answers.sort();
        Ok(answers)
    }

    fn waited(&self) -> Duration {
        self.fleets.iter().map(|fleet| fleet.waited()).sum()
    }

    fn exchange_until(
        &mut self,
        sensed: &mut Vec<Batch<Sensed>>,
        deadline: Instant,
        meanwhile: &mut dyn FnMut(),
    ) -> Result<Answers, FleetError> {
        let mut shares = self.deal(sensed)?;
        let mut answers = Answers::default();
        exchange_within_until(&mut self.fleets, &mut shares, deadline, meanwhile, &mut answers)?;
        answers.sort();
        // What the parts could not send yet.
        sensed.extend(shares.into_iter().flatten());
        sensed.sort_by_key(|batch| batch.auv);
        Ok(answers)
    }

    fn vacancies(&mut self) -> Vec<AuvId> {
        let mut vacancies: Vec<AuvId> = self.fleets.iter_mut().flat_map(|fleet| fleet.vacancies()).collect();
        vacancies.sort_unstable();
        vacancies
    }

    fn end(&mut self) {
        self.fleets.iter_mut().for_each(|fleet| fleet.end());
    }
}

/// The first fleet's exchange, with that of the others for its `meanwhile`.
fn exchange_within(
    fleets: &mut [Box<dyn Fleet + '_>],
    shares: &[Cow<'_, [Batch<Sensed>]>],
    meanwhile: &mut dyn FnMut(),
    answers: &mut Answers,
) -> Result<(), FleetError> {
    let (Some((fleet, fleets)), Some((share, shares))) = (fleets.split_first_mut(), shares.split_first())
    else {
        meanwhile();
        return Ok(());
    };
    let mut others = Ok(());
    let own = fleet.exchange(share, &mut || others = exchange_within(fleets, shares, meanwhile, answers));
    // The others came to their end before this one did: theirs is the first error.
    others?;
    let Answers { acted, losses } = own?;
    answers.acted.extend(acted);
    answers.losses.extend(losses);
    Ok(())
}

/// The same for AUVs that may be late.
fn exchange_within_until(
    fleets: &mut [Box<dyn Fleet + '_>],
    shares: &mut [Vec<Batch<Sensed>>],
    deadline: Instant,
    meanwhile: &mut dyn FnMut(),
    answers: &mut Answers,
) -> Result<(), FleetError> {
    let (Some((fleet, fleets)), Some((share, shares))) = (fleets.split_first_mut(), shares.split_first_mut())
    else {
        meanwhile();
        return Ok(());
    };
    let mut others = Ok(());
    let own = fleet.exchange_until(share, deadline, &mut || {
        others = exchange_within_until(fleets, shares, deadline, meanwhile, answers);
    });
    others?;
    let Answers { acted, losses } = own?;
    answers.acted.extend(acted);
    answers.losses.extend(losses);
    Ok(())
}
