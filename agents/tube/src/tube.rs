//! The tube: what it is, how it is made, how its parts are read.

use crate::enclosure::Enclosure;
use crate::error::{Emptied, TubeError};
use crate::summary::{Part, Slices, Step, SummaryTree};
use crate::time_domain::{Place, TimeDomain, exactly};
use shoal_interval::Interval;
use std::collections::VecDeque;
use std::ops::Range;

/// An enclosure of one continuous trajectory over a [`TimeDomain`].
///
/// Slice `i` holds the trajectory over all times of the domain's slice `i`; gate `i` holds it at border `i`. A gate is
/// always inside the slices on both of its sides, because the trajectory is continuous. If one slice or gate is empty, no
/// trajectory is left and the tube [is empty](Tube::is_empty).
///
/// Beside slices and gates a tube keeps the hull, the innermost bounds and the integral of blocks of slices, so a question
/// about many slices takes a time that grows with the logarithm of their number, and so does a change of one slice. A
/// scalar tube takes less than 64 bytes a slice in all.
///
/// Source: seed 001, section 4.2.1, where a tube is a pair of trajectories; slices and gates as in Codac.
#[derive(Debug, Clone)]
pub struct Tube<T: Enclosure> {
    pub(crate) domain: TimeDomain,
    pub(crate) slices: VecDeque<T>,
    pub(crate) gates: VecDeque<T>,
    pub(crate) summaries: SummaryTree<T>,
    /// How many slices and gates are empty.
    pub(crate) empty_count: usize,
    /// The first contraction that left nothing.
    pub(crate) first_emptied: Option<Emptied>,
}

impl<T: Enclosure> Tube<T> {
    /// The tube with the same value at all times.
    pub fn constant(domain: TimeDomain, value: T) -> Tube<T> {
        let slices = VecDeque::from(vec![value; domain.slice_count()]);
        let gates = VecDeque::from(vec![value; domain.slice_count() + 1]);
        Tube::assembled(domain, slices, gates)
    }

    /// The tube of a trajectory that is known by an inclusion function: `enclose` is given an interval of time, in
    /// seconds, and returns a set that holds the trajectory over all of it.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let x_m = Tube::from_function(TimeDomain::uniform(0.0, 0.1, 30)?, |t| t.cos() * 10.0);
    /// assert!(x_m.holds(1.05, &4.976)?);
    /// # Ok::<(), shoal_tube::TubeError>(())
    /// ```
    pub fn from_function(domain: TimeDomain, mut enclose: impl FnMut(Interval) -> T) -> Tube<T> {
        let gates = domain.borders_s().map(|time_s| enclose(exactly(time_s))).collect();
        let slices = (0..domain.slice_count()).map(|index| enclose(domain.span_at(index))).collect();
        Tube::assembled(domain, slices, gates)
    }

    /// The tube of these slices and gates, one gate more than slices; gates keep only what is inside the slices beside.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let time = TimeDomain::uniform(0.0, 1.0, 2)?;
    /// let depth_m = Tube::from_parts(
    ///     time,
    ///     [Interval::new(0.0, 2.0)?, Interval::new(1.0, 5.0)?],
    ///     [Interval::ZERO, Interval::ENTIRE, Interval::new(4.0, 6.0)?],
    /// )?;
    /// assert_eq!(depth_m.gate(1), Some(Interval::new(1.0, 2.0)?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When there are not as many slices as in the domain, or not one gate more.
    pub fn from_parts(
        domain: TimeDomain,
        slices: impl IntoIterator<Item = T>,
        gates: impl IntoIterator<Item = T>,
    ) -> Result<Tube<T>, TubeError> {
        let slices: VecDeque<T> = slices.into_iter().collect();
        let gates: VecDeque<T> = gates.into_iter().collect();
        let expected = domain.slice_count();
        if slices.len() != expected || gates.len() != expected + 1 {
            return Err(TubeError::WrongCount { expected, slices: slices.len(), gates: gates.len() });
        }
        Ok(Tube::assembled(domain, slices, gates))
    }

    /// A tube of one gate at `start_s` seconds and no slice, to [`append`](Tube::append) to.
    ///
    /// # Errors
    /// When the time is not finite.
    pub fn starting_at(start_s: f64, gate: T) -> Result<Tube<T>, TubeError> {
        Ok(Tube::constant(TimeDomain::starting_at(start_s)?, gate))
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

    /// All slices, from the oldest on.
    pub fn slices(&self) -> impl ExactSizeIterator<Item = T> + DoubleEndedIterator + '_ {
        self.slices.iter().copied()
    }

    /// All gates, from the oldest on.
    pub fn gates(&self) -> impl ExactSizeIterator<Item = T> + DoubleEndedIterator + '_ {
        self.gates.iter().copied()
    }

    /// What holds the trajectory at the start of slice `index`.
    #[inline]
    pub fn input_gate(&self, index: usize) -> Option<T> {
        self.slices.get(index).and(self.gate(index))
    }

    /// What holds the trajectory at the end of slice `index`.
    #[inline]
    pub fn output_gate(&self, index: usize) -> Option<T> {
        self.slices.get(index).and_then(|_| self.gate(index + 1))
    }

    /// What holds the trajectory at the end of the domain.
    #[inline]
    pub fn last_gate(&self) -> T {
        self.gates[self.gates.len() - 1]
    }

    /// Whether no trajectory is left: some slice or gate is empty. In constant time.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.empty_count > 0
    }

    /// The first place that no trajectory can pass, and so where a wrong model shows itself; `None` unless the tube
    /// [is empty](Tube::is_empty).
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{Place, TimeDomain, Tube};
    ///
    /// let mut depth_m = Tube::constant(TimeDomain::uniform(0.0, 1.0, 9)?, Interval::NON_NEGATIVE);
    /// depth_m.contract_gate(4, &Interval::point(-1.0)?)?;
    /// let emptied = depth_m.first_empty().expect("above the surface");
    /// assert_eq!(emptied.place, Place::Gate(4));
    /// assert_eq!(emptied.to_string(), "gate 4, at 4 s, is empty");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn first_empty(&self) -> Option<Emptied> {
        if !self.is_empty() {
            return None;
        }
        for (index, gate) in self.gates.iter().enumerate() {
            if gate.is_empty() {
                return Some(self.empty_at(Place::Gate(index)));
            }
            if self.slices.get(index).is_some_and(Enclosure::is_empty) {
                return Some(self.empty_at(Place::Slice(index)));
            }
        }
        None
    }

    /// The contraction that left nothing: where it was, when, and by which constraint. `None` unless the tube
    /// [is empty](Tube::is_empty).
    ///
    /// A contradiction soon spreads over the whole tube, so that [`first_empty`](Tube::first_empty) says little; this
    /// remembers where it began. A tube that was made empty, by arithmetic for example, answers with its first empty place.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{Direction, TimeDomain, Tube};
    ///
    /// let speed_m_s = Tube::constant(TimeDomain::uniform(0.0, 1.0, 9)?, Interval::new(0.0, 1.0)?);
    /// let mut depth_m = Tube::primitive(&speed_m_s, Interval::ZERO);
    /// depth_m.contract_gate(4, &Interval::ZERO)?;
    /// depth_m.contract_gate(7, &Interval::point(5.0)?)?;
    /// depth_m.contract_derivative(&speed_m_s, Direction::Both)?;
    /// let emptied = depth_m.emptied().expect("five metres in three seconds");
    /// assert_eq!(emptied.to_string(), "gate 7, at 7 s, is empty: emptied by the derivative");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn emptied(&self) -> Option<Emptied> {
        if self.is_empty() { self.first_emptied.or_else(|| self.first_empty()) } else { None }
    }

    /// The width of the widest slice; zero without slices, NaN if the tube is empty.
    pub fn width(&self) -> f64 {
        if self.is_empty() {
            return f64::NAN;
        }
        self.slices.iter().map(Enclosure::width).fold(0.0, f64::max)
    }

    /// The volume of the slices (for numbers their width) times their duration in seconds, in all, rounded up; zero if the
    /// tube is empty. What a contraction should make smaller.
    pub fn volume(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let volume = |(index, slice): (usize, &T)| exactly(slice.volume()) * self.domain.duration_at(index);
        self.slices
            .iter()
            .enumerate()
            .map(volume)
            .fold(Interval::ZERO, |total, volume| total + volume)
            .upper()
    }

    /// The hull of all slices, or the only gate of a tube without slices.
    pub fn codomain(&self) -> T {
        if self.slices.is_empty() { self.gates[0] } else { self.hull_of(0..self.slice_count()) }
    }

    /// The bytes that the tube takes, with what it has reserved to grow, and with its domain even if that is shared.
    pub fn memory_bytes(&self) -> usize {
        size_of::<Tube<T>>()
            + self.domain.memory_bytes()
            + (self.slices.capacity() + self.gates.capacity()) * size_of::<T>()
            + self.summaries.memory_bytes()
    }

    /// The tube of as many slices and gates as the domain has. All other ways to a tube end here: gates are cut to the
    /// slices beside them, what is empty is empty on all axes, and the summaries are made.
    pub(crate) fn assembled(domain: TimeDomain, mut slices: VecDeque<T>, mut gates: VecDeque<T>) -> Tube<T> {
        debug_assert!(slices.len() == domain.slice_count() && gates.len() == slices.len() + 1);
        // What was collected from an iterator of unknown length may have room for twice as much.
        slices.shrink_to_fit();
        gates.shrink_to_fit();
        for slice in &mut slices {
            *slice = settled(*slice);
        }
        for (index, gate) in gates.iter_mut().enumerate() {
            let before = index.checked_sub(1).map_or(T::ENTIRE, |before| slices[before]);
            let after = slices.get(index).copied().unwrap_or(T::ENTIRE);
            *gate = settled(*gate) & before & after;
        }
        let empty_count = slices.iter().chain(&gates).filter(|set| set.is_empty()).count();
        let summaries = SummaryTree::new(Slices { domain: &domain, values: &slices });
        let tube = Tube { domain, slices, gates, summaries, empty_count, first_emptied: None };
        debug_assert!((0..tube.slice_count()).all(|index| tube.gates_are_inside(index)));
        tube
    }

    /// The hull of some slices.
    #[inline]
    pub(crate) fn hull_of(&self, range: Range<usize>) -> T {
        let mut hull = T::EMPTY;
        let _ = self.summaries.walk::<()>(range, |part| {
            match part {
                Part::Block(_, summary) => hull = hull | summary.hull,
                Part::Slices(range) => self.slices.range(range).for_each(|&slice| hull = hull | slice),
            }
            Step::Past
        });
        hull
    }

    /// Brings the summaries up to date after slices of `changed` were narrowed.
    pub(crate) fn refresh(&mut self, changed: Range<usize>) {
        self.summaries.refresh(changed, Slices { domain: &self.domain, values: &self.slices });
    }

    /// Fails unless the other tube is cut at the same times.
    pub(crate) fn check_same_domain<U: Enclosure>(&self, other: &Tube<U>) -> Result<(), TubeError> {
        if self.domain == other.domain { Ok(()) } else { Err(TubeError::DifferentDomains) }
    }

    pub(crate) fn check_slice(&self, index: usize) -> Result<(), TubeError> {
        let count = self.slice_count();
        if index < count { Ok(()) } else { Err(TubeError::NoSuchSlice { index, count }) }
    }

    pub(crate) fn check_gate(&self, index: usize) -> Result<(), TubeError> {
        let count = self.gates.len();
        if index < count { Ok(()) } else { Err(TubeError::NoSuchGate { index, count }) }
    }

    pub(crate) fn empty_at(&self, place: Place) -> Emptied {
        let times_s = self.domain.span_of(place);
        Emptied { place, times_s, constraint: None }
    }
}

/// Tubes are equal when their domains, slices and gates are.
impl<T: Enclosure> PartialEq for Tube<T> {
    fn eq(&self, other: &Tube<T>) -> bool {
        self.domain == other.domain && self.slices == other.slices && self.gates == other.gates
    }
}

/// The set itself; if a box is empty on one axis, empty on all.
#[inline]
pub(crate) fn settled<T: Enclosure>(set: T) -> T {
    if set.is_empty() { T::EMPTY } else { set }
}
