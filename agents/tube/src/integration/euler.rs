//! The steps of the seeds. Not a proof.

use super::evolution::Evolution;
use crate::Constraint;
use crate::contraction::together;
use crate::derivative::Direction;
use crate::tube::Tube;
use shoal_interval::contractor::Contracted;
use shoal_interval::{Interval, IntervalBox};

impl<const N: usize> Tube<IntervalBox<N>> {
    /// Contracts the gates by Euler's method, and each slice to the hull of its gates. **Not a proof**: trajectories are lost,
    /// because the velocity is taken at the start of a slice only. It is here to show the seeds' figures again; use
    /// [`contract_evolution`](Tube::contract_evolution) for everything else.
    ///
    /// `[x](k+1) := [x](k+1) ∩ ([x](k) + h [f]([x](k)))`, and backward `[x](k) := [x](k) ∩ ([x](k+1) - h [f]([x](k+1)))`.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::{Direction, TimeDomain, Tube};
    ///
    /// let growth = |_: Interval, x: &IntervalBox<1>| *x;
    /// let mut x = Tube::constant(TimeDomain::uniform(0.0, 0.5, 2)?, IntervalBox::ENTIRE);
    /// x.contract_gate(0, &IntervalBox::from([Interval::ONE]))?;
    /// x.contract_euler_unguaranteed(&growth, Direction::Forward);
    /// // The truth is e = 2.718...
    /// assert_eq!(x.last_gate()[0], Interval::point(2.25)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Source: seed 001, tables 4.1 and 4.3 and equation (4.37).
    pub fn contract_euler_unguaranteed<E: Evolution<N> + ?Sized>(
        &mut self,
        evolution: &E,
        direction: Direction,
    ) -> Contracted {
        let all = 0..self.slice_count();
        let mut contracted = Contracted::Unchanged;
        let step = |tube: &mut Self, from: usize, to: usize| {
            let length_s = at(tube.domain.border_at(to)) - at(tube.domain.border_at(from));
            let gate = tube.gates[from];
            let velocity = evolution.velocity(at(tube.domain.border_at(from)), &gate);
            let of_gate = tube.narrow_gate(to, gate + velocity * length_s);
            let between = gate | tube.gates[to];
            together(of_gate, tube.narrow_slice(from.min(to), between))
        };
        if direction != Direction::Backward {
            for index in all.clone() {
                contracted = together(contracted, step(self, index, index + 1));
            }
        }
        if direction != Direction::Forward {
            for index in all.clone().rev() {
                contracted = together(contracted, step(self, index + 1, index));
            }
        }
        if contracted != Contracted::Unchanged {
            self.refresh(all);
        }
        self.blamed(contracted, Constraint::StateEquation)
    }
}

fn at(time_s: f64) -> Interval {
    Interval::spanning(time_s, time_s)
}
