//! The tube: what it is, how it is made, how its parts are read.

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::time_domain::TimeDomain;
use shoal_interval::Interval;
use std::collections::VecDeque;

/// An enclosure of one continuous trajectory over a [`TimeDomain`].
///
/// Slice `i` holds the trajectory over all times of the domain's slice `i`; gate `i` holds it at border `i`. A gate is
/// always inside the slices on both of its sides, because the trajectory is continuous. If one slice or gate is empty, no
/// trajectory is left and the tube [is empty](Tube::is_empty).
///
/// Source: seed 001, section 4.2.1, where a tube is a pair of trajectories; slices and gates as in Codac.
#[derive(Debug, Clone, PartialEq)]
pub struct Tube<T> {
    pub(crate) domain: TimeDomain,
    pub(crate) slices: VecDeque<T>,
    pub(crate) gates: VecDeque<T>,
}

impl<T: Enclosure> Tube<T> {
    /// The tube with the same value at all times.
    pub fn constant(domain: TimeDomain, value: T) -> Tube<T> {
        let slices = VecDeque::from(vec![value; domain.slice_count()]);
        let gates = VecDeque::from(vec![value; domain.slice_count() + 1]);
        Tube { domain, slices, gates }
    }

    /// The tube of a trajectory that is known by an inclusion function: `enclose` is given an interval of time, in
    /// seconds, and returns a set that holds the trajectory over all of it.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let x_m = Tube::from_function(TimeDomain::uniform(0.0, 0.1, 30)?, |t| t.cos() * 10.0);
    /// assert!(x_m.contains(1.05, &4.976)?);
    /// # Ok::<(), shoal_tube::TubeError>(())
    /// ```
    pub fn from_function(domain: TimeDomain, mut enclose: impl FnMut(Interval) -> T) -> Tube<T> {
        let gates = domain.borders_s().map(|time_s| enclose(Interval::spanning(time_s, time_s))).collect();
        let slices =
            (0..domain.slice_count()).filter_map(|index| domain.slice_span(index)).map(enclose).collect();
        let mut tube = Tube { domain, slices, gates };
        for index in 0..tube.slice_count() {
            tube.narrow_gates_of(index);
        }
        tube
    }

    /// A tube of one gate at `start_s` seconds and no slice, to [`append`](Tube::append) to.
    ///
    /// # Errors
    /// When the time is not finite.
    pub fn starting_at(start_s: f64, gate: T) -> Result<Tube<T>, TubeError> {
        Ok(Tube::constant(TimeDomain::starting_at(start_s)?, gate))
    }

    /// The tube of a function of the trajectory: `function` is given an enclosure of the trajectory and returns one of the
    /// function's value.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let position_m = Tube::constant(TimeDomain::uniform(0.0, 1.0, 5)?, IntervalBox::from([Interval::ONE; 3]));
    /// let depth_m = position_m.map(|position_m| -position_m[2]);
    /// assert_eq!(depth_m.at(2.5)?, -Interval::ONE);
    /// # Ok::<(), shoal_tube::TubeError>(())
    /// ```
    pub fn map<U: Enclosure>(&self, mut function: impl FnMut(T) -> U) -> Tube<U> {
        Tube {
            domain: self.domain.clone(),
            slices: self.slices.iter().map(|&slice| function(slice)).collect(),
            gates: self.gates.iter().map(|&gate| function(gate)).collect(),
        }
    }

    /// The times at which the tube is cut.
    #[inline]
    pub fn domain(&self) -> &TimeDomain {
        &self.domain
    }

    /// The number of slices; there is one gate more.
    #[inline]
    pub fn slice_count(&self) -> usize {
        self.slices.len()
    }

    /// What holds the trajectory over slice `index`; the oldest has index 0.
    #[inline]
    pub fn slice(&self, index: usize) -> Option<T> {
        self.slices.get(index).copied()
    }

    /// What holds the trajectory at border `index`.
    #[inline]
    pub fn gate(&self, index: usize) -> Option<T> {
        self.gates.get(index).copied()
    }

    /// What holds the trajectory at the start of slice `index`.
    #[inline]
    pub fn input_gate(&self, index: usize) -> Option<T> {
        self.slices.get(index).and(self.gate(index))
    }

    /// What holds the trajectory at the end of slice `index`.
    #[inline]
    pub fn output_gate(&self, index: usize) -> Option<T> {
        self.slices.get(index).and(self.gate(index + 1))
    }

    /// What holds the trajectory at the end of the domain.
    #[inline]
    pub fn last_gate(&self) -> T {
        self.gates[self.gates.len() - 1]
    }

    /// Whether no trajectory is left: some slice or gate is empty. Looks at all of them.
    pub fn is_empty(&self) -> bool {
        self.slices.iter().chain(&self.gates).any(Enclosure::is_empty)
    }

    /// The width of the widest slice; zero without slices, NaN if the tube is empty.
    pub fn width(&self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        self.slices.iter().map(Enclosure::width).fold(0.0, f64::max)
    }

    /// Keeps of the gates of one slice what is inside the slice.
    pub(crate) fn narrow_gates_of(&mut self, index: usize) {
        let slice = self.slices[index];
        self.gates[index] = self.gates[index] & slice;
        self.gates[index + 1] = self.gates[index + 1] & slice;
    }
}
