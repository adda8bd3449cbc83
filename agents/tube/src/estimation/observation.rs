//! What was observed.

use crate::error::TubeError;
use crate::tube::Tube;
use shoal_interval::contractor::Contracted;
use shoal_interval::{Interval, IntervalBox};

/// An observation: what links the states at one or several times with something measured.
pub trait Observation<const N: usize> {
    /// The times, in seconds, of the states that are linked: from the first to the last.
    fn times_s(&self) -> Interval;

    /// Removes from the tube what contradicts the observation, and nothing else. Only gates and slices within
    /// [`times_s`](Observation::times_s) may change.
    ///
    /// # Errors
    /// When the tube refuses a question.
    fn contract(&self, states: &mut Tube<IntervalBox<N>>) -> Result<Contracted, TubeError>;
}

/// An observation made of a closure by [`from_contraction`].
#[derive(Debug, Clone, Copy)]
pub struct FromContraction<F> {
    times_s: Interval,
    contract: F,
}

/// The observation of the states at `times_s` that `contract` removes contradictions with, under the rules of [`Observation`].
///
/// ```
/// use nalgebra::Vector2;
/// use shoal_interval::separator::{Ring, Separator};
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::estimation::from_contraction;
/// use shoal_tube::Tube;
///
/// // 4.9 m to 5.1 m from a beacon at (3, 4) m, 7 s after the start. The domain has a border there.
/// let ring = Ring::new(Vector2::new(3.0, 4.0), Interval::new(4.9, 5.1)?);
/// let range = from_contraction(Interval::point(7.0)?, move |position_m: &mut Tube<IntervalBox<2>>| {
///     let near = ring.outer(position_m.at(7.0)?);
///     position_m.contract_gate(7, &near)
/// });
/// # let mut tube = Tube::constant(shoal_tube::TimeDomain::uniform(0.0, 1.0, 9)?, IntervalBox::ENTIRE);
/// # use shoal_tube::estimation::Observation;
/// # range.contract(&mut tube)?;
/// # assert!((tube.at(7.0)?[0].upper() - 8.1).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn from_contraction<const N: usize, F>(times_s: Interval, contract: F) -> FromContraction<F>
where
    F: Fn(&mut Tube<IntervalBox<N>>) -> Result<Contracted, TubeError>,
{
    FromContraction { times_s, contract }
}

impl<const N: usize, F> Observation<N> for FromContraction<F>
where
    F: Fn(&mut Tube<IntervalBox<N>>) -> Result<Contracted, TubeError>,
{
    fn times_s(&self) -> Interval {
        self.times_s
    }

    fn contract(&self, states: &mut Tube<IntervalBox<N>>) -> Result<Contracted, TubeError> {
        (self.contract)(states)
    }
}
