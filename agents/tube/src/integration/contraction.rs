//! Tubes contracted by a state equation.

use super::carrier::{Carrier, Diverged, Steps, Way};
use super::evolution::Evolution;
use crate::Constraint;
use crate::contraction::together;
use crate::derivative::Direction;
use crate::enclosure::Enclosure;
use crate::time_domain::TimeDomain;
use crate::tube::Tube;
use shoal_interval::IntervalBox;
use shoal_interval::contractor::Contracted;

/// What [`Tube::contract_evolution`] did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evolved {
    /// Whether anything was removed, or everything.
    pub contracted: Contracted,
    /// The first slice met, if any, through which nothing could be carried.
    pub diverged: Option<Diverged>,
}

impl<const N: usize> Tube<IntervalBox<N>> {
    /// The tube of all solutions of a state equation that are in `start` when the domain starts. A proof: no solution leaves
    /// it at any time.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::integration::Steps;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let decay = |_: Interval, x: &IntervalBox<1>| -*x;
    /// let one = IntervalBox::from([Interval::ONE]);
    /// let x = Tube::solution(TimeDomain::uniform(0.0, 0.01, 100)?, &decay, one, Steps::default())?;
    /// assert!(x.last_gate()[0].contains(0.367_879_441_171_442_33));
    ///
    /// // x' = x^2 from 1 is 1 / (1 - t), which is nowhere at 1 s.
    /// let blast = |_: Interval, x: &IntervalBox<1>| x.map(|x| x.sqr());
    /// let diverged = Tube::solution(TimeDomain::uniform(0.0, 0.01, 101)?, &blast, one, Steps::default());
    /// assert!(diverged.unwrap_err().to_s <= 1.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When no bounded enclosure is found over a slice. To keep what is known until then, contract a tube that is
    /// [`ENTIRE`](IntervalBox::ENTIRE) after its first gate.
    pub fn solution<E: Evolution<N> + ?Sized>(
        domain: TimeDomain,
        evolution: &E,
        start: IntervalBox<N>,
        steps: Steps,
    ) -> Result<Tube<IntervalBox<N>>, Diverged> {
        let mut tube = Tube::constant(domain, IntervalBox::ENTIRE);
        tube.narrow_gate(0, start);
        match tube.contract_evolution(evolution, Direction::Forward, steps).diverged {
            Some(diverged) => Err(diverged),
            None => Ok(tube),
        }
    }

    /// Removes from the tube what no solution of a state equation that stays in the tube can reach: from the past with
    /// [`Forward`](Direction::Forward), from the future with [`Backward`](Direction::Backward), or both in turn.
    ///
    /// Every solution that was inside stays inside, at all times. A slice that is too long for an enclosure stays as it is
    /// unless it is bounded, and what was known before it goes no further; the answer tells of the first.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::integration::Steps;
    /// use shoal_tube::{Direction, TimeDomain, Tube};
    ///
    /// // Cooling by a tenth of the difference each second, measured after 10 s.
    /// let cooling = |_: Interval, kelvin: &IntervalBox<1>| *kelvin * Interval::new(-0.11, -0.09).unwrap();
    /// let mut difference = Tube::constant(TimeDomain::uniform(0.0, 0.1, 100)?, IntervalBox::ENTIRE);
    /// difference.contract_gate(100, &IntervalBox::from([Interval::new(3.0, 3.1)?]))?;
    /// difference.contract_evolution(&cooling, Direction::Backward, Steps::default());
    /// // It was 3 e^0.9 to 3.1 e^1.1 at the start.
    /// let start = difference.at(0.0)?[0];
    /// assert!(Interval::new(7.3789, 9.3128)?.is_subset_of(start) && start.width() < 2.1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Source: seed 001, table 4.1, with guaranteed steps in place of Euler's.
    pub fn contract_evolution<E: Evolution<N> + ?Sized>(
        &mut self,
        evolution: &E,
        direction: Direction,
        steps: Steps,
    ) -> Evolved {
        let all = 0..self.slice_count();
        let mut evolved = Evolved { contracted: Contracted::Unchanged, diverged: None };
        if self.is_empty() {
            return Evolved { contracted: Contracted::Empty, ..evolved };
        }
        let mut pass = |tube: &mut Self, carrier: &mut Carrier<'_, N, E>, index: usize| {
            let passage = carrier.pass(tube, index);
            evolved.contracted = together(evolved.contracted, passage.contracted);
            evolved.diverged = evolved.diverged.or(passage.diverged);
            passage.contracted != Contracted::Empty
        };
        if direction != Direction::Backward {
            let mut carrier = Carrier::new(evolution, steps, Way::Forward);
            let _ = all.clone().all(|index| pass(self, &mut carrier, index));
        }
        if direction != Direction::Forward && !self.gates.iter().any(Enclosure::is_empty) {
            let mut carrier = Carrier::new(evolution, steps, Way::Backward);
            let _ = all.clone().rev().all(|index| pass(self, &mut carrier, index));
        }
        if evolved.contracted != Contracted::Unchanged {
            self.refresh(all);
        }
        self.blamed(evolved.contracted, Constraint::StateEquation);
        evolved
    }
}
