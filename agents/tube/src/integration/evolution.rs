//! The state equation.

use shoal_interval::expression::Expression;
use shoal_interval::{Interval, IntervalBox, IntervalMatrix};

/// A state equation `x' = f(t, x)`, or the inclusion `x'` in `f(t, x)` when inputs or noise are only known to lie in sets,
/// given by enclosures.
///
/// There are three ways to write one: an [`Expression`], whose derivatives are found by itself; a closure `|times_s, states|
/// velocities` where there are inputs or noise, tubes that the closure holds and asks for `input.over(times_s)`
/// (the tube of a command that jumps has an empty gate at the jump, so never ask it at one time); and
/// [`Autonomous`] or [`Driven`] with a Jacobian of your own. With a Jacobian enclosures are far tighter.
///
/// ```
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::integration::Steps;
/// use shoal_tube::{TimeDomain, Tube};
///
/// // A vehicle with a speed of 1 to 1.2 m/s and a heading that is a tube.
/// let time = TimeDomain::uniform(0.0, 0.1, 100)?;
/// let heading = Tube::from_function(time.clone(), |t| t * 0.1);
/// let drive = |times_s: Interval, _: &IntervalBox<2>| {
///     let speed_m_s = Interval::new(1.0, 1.2).unwrap();
///     let (sin, cos) = heading.over(times_s).unwrap_or(Interval::ENTIRE).sin_cos();
///     IntervalBox::from([cos, sin]) * speed_m_s
/// };
/// let position_m = Tube::solution(time, &drive, IntervalBox::from([Interval::ZERO; 2]), Steps::default())?;
/// // x(10) = 10 v sin 1
/// assert!(position_m.last_gate()[0].contains(11.0 * 0.841471));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Evolution<const N: usize> {
    /// Holds `f(t, x)` for every time `t` of `times_s`, in seconds, every `x` of `states`, and whatever the inputs and the
    /// noise may be. States for which `f` is not defined count for nothing.
    fn velocity(&self, times_s: Interval, states: &IntervalBox<N>) -> IntervalBox<N>;

    /// Holds the partial derivatives of `f` by the state, for every time, state, input and noise: row `j` is the gradient of
    /// coordinate `j`. An entry must be [`Interval::ENTIRE`] if `f` is not differentiable, or not defined, somewhere in
    /// `states`; where `f` has a kink, all slopes of both sides do. `None` when it is not known.
    fn jacobian(&self, _times_s: Interval, _states: &IntervalBox<N>) -> Option<IntervalMatrix<N, N>> {
        None
    }

    /// Holds `x''` of every solution that is in `states` at a time of `times_s`. `None` when it is not known, or when
    /// inputs or noise may be anything in their sets, because `x'` then jumps.
    fn acceleration(&self, _times_s: Interval, _states: &IntervalBox<N>) -> Option<IntervalBox<N>> {
        None
    }

    /// Holds `d/ds J(t + s, y(s))`, with `J` the Jacobian, for every path `y` in `states` whose velocity is in
    /// [`velocity`](Evolution::velocity) of all `states`. With it, fast motion costs no tightness: the error of a step shrinks
    /// with one more power of its length. `None` when it is not known.
    fn jacobian_rate(&self, _times_s: Interval, _states: &IntervalBox<N>) -> Option<IntervalMatrix<N, N>> {
        None
    }
}

impl<const N: usize, F> Evolution<N> for F
where
    F: Fn(Interval, &IntervalBox<N>) -> IntervalBox<N>,
{
    #[inline]
    fn velocity(&self, times_s: Interval, states: &IntervalBox<N>) -> IntervalBox<N> {
        self(times_s, states)
    }
}

/// A state equation `x' = f(x)` without time, inputs and noise, and the Jacobian of `f`.
///
/// The acceleration follows from both, so the error of a step shrinks with the cube of its length.
#[derive(Debug, Clone, Copy)]
pub struct Autonomous<F, J> {
    velocity: F,
    jacobian: J,
}

impl<F, J> Autonomous<F, J> {
    /// The equation with these enclosures, under the rules of [`Evolution`]. `velocity` must enclose one continuously
    /// differentiable function: with noise, use [`Driven`].
    pub const fn new<const N: usize>(velocity: F, jacobian: J) -> Autonomous<F, J>
    where
        F: Fn(&IntervalBox<N>) -> IntervalBox<N>,
        J: Fn(&IntervalBox<N>) -> IntervalMatrix<N, N>,
    {
        Autonomous { velocity, jacobian }
    }
}

impl<const N: usize, F, J> Evolution<N> for Autonomous<F, J>
where
    F: Fn(&IntervalBox<N>) -> IntervalBox<N>,
    J: Fn(&IntervalBox<N>) -> IntervalMatrix<N, N>,
{
    #[inline]
    fn velocity(&self, _times_s: Interval, states: &IntervalBox<N>) -> IntervalBox<N> {
        (self.velocity)(states)
    }

    #[inline]
    fn jacobian(&self, _times_s: Interval, states: &IntervalBox<N>) -> Option<IntervalMatrix<N, N>> {
        Some((self.jacobian)(states))
    }

    #[inline]
    fn acceleration(&self, _times_s: Interval, states: &IntervalBox<N>) -> Option<IntervalBox<N>> {
        Some((self.jacobian)(states) * (self.velocity)(states))
    }
}

/// A state equation `x' = f(t, x)` with inputs, noise or explicit time, and the Jacobian of `f` by the state.
#[derive(Debug, Clone, Copy)]
pub struct Driven<F, J> {
    velocity: F,
    jacobian: J,
}

impl<F, J> Driven<F, J> {
    /// The equation with these enclosures, under the rules of [`Evolution`].
    pub const fn new<const N: usize>(velocity: F, jacobian: J) -> Driven<F, J>
    where
        F: Fn(Interval, &IntervalBox<N>) -> IntervalBox<N>,
        J: Fn(Interval, &IntervalBox<N>) -> IntervalMatrix<N, N>,
    {
        Driven { velocity, jacobian }
    }
}

impl<const N: usize, F, J> Evolution<N> for Driven<F, J>
where
    F: Fn(Interval, &IntervalBox<N>) -> IntervalBox<N>,
    J: Fn(Interval, &IntervalBox<N>) -> IntervalMatrix<N, N>,
{
    #[inline]
    fn velocity(&self, times_s: Interval, states: &IntervalBox<N>) -> IntervalBox<N> {
        (self.velocity)(times_s, states)
    }

    #[inline]
    fn jacobian(&self, times_s: Interval, states: &IntervalBox<N>) -> Option<IntervalMatrix<N, N>> {
        Some((self.jacobian)(times_s, states))
    }
}

/// An expression of the state alone is an autonomous evolution: velocity, Jacobian and acceleration follow from it.
///
/// ```
/// use shoal_interval::expression::Expression;
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::integration::Steps;
/// use shoal_tube::{TimeDomain, Tube};
///
/// // Van der Pol's oscillator.
/// let oscillator = Expression::system(|[x, v]| [v, (1.0 - x.sqr()) * v - x]);
/// let start = IntervalBox::from([Interval::new(1.999, 2.001)?, Interval::ZERO]);
/// let states = Tube::solution(TimeDomain::uniform(0.0, 0.01, 500)?, &oscillator, start, Steps::default())?;
/// assert!(states.last_gate().width() < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl<const N: usize> Evolution<N> for Expression<N, N> {
    fn velocity(&self, _times_s: Interval, states: &IntervalBox<N>) -> IntervalBox<N> {
        self.natural(states)
    }

    fn jacobian(&self, _times_s: Interval, states: &IntervalBox<N>) -> Option<IntervalMatrix<N, N>> {
        Some(Expression::jacobian(self, states))
    }

    fn acceleration(&self, _times_s: Interval, states: &IntervalBox<N>) -> Option<IntervalBox<N>> {
        Some(Expression::jacobian(self, states) * self.natural(states))
    }
}
