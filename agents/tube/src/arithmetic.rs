//! Arithmetic on tubes: what holds for the sets holds for the trajectories in them, slice by slice and gate by gate.
//!
//! Two tubes must be cut at the same times; an operation on two returns a `Result` because of that. An operation on one
//! tube and a number or a set of numbers cannot fail and is written with the operator. Every other function of
//! trajectories is made by [`Tube::map`] or [`Tube::zip`] from one of intervals.
//!
//! Where a function has no value (the root of what is negative, a quotient by zero) the result is empty. A function
//! that jumps makes a trajectory that jumps: its tube holds it, but no contractor that takes it as continuous may be used.
//!
//! Source: seed 001, section 4.2.2, equations (4.7) and (4.8).

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::tube::Tube;
use shoal_interval::{Interval, IntervalBox};
use std::ops::{Add, Div, Mul, Neg, Sub};

impl<T: Enclosure> Tube<T> {
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
        let slices = self.slices.iter().map(|&slice| function(slice)).collect();
        let gates = self.gates.iter().map(|&gate| function(gate)).collect();
        Tube::assembled(self.domain.clone(), slices, gates)
    }

    /// The tube of a function of two trajectories, from an enclosure of the function.
    ///
    /// ```
    /// use shoal_interval::{Interval, IntervalBox};
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let time = TimeDomain::uniform(0.0, 1.0, 5)?;
    /// let heading_rad = Tube::from_function(time.clone(), |t| t * 0.1);
    /// let speed_m_s = Tube::constant(time, Interval::new(1.0, 1.5)?);
    /// let velocity_m_s = speed_m_s.zip(&heading_rad, |speed, heading| {
    ///     let (sin, cos) = heading.sin_cos();
    ///     IntervalBox::from([speed * cos, speed * sin])
    /// })?;
    /// assert_eq!(velocity_m_s.at(0.0)?[0], Interval::new(1.0, 1.5)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn zip<U: Enclosure, V: Enclosure>(
        &self,
        other: &Tube<U>,
        mut function: impl FnMut(T, U) -> V,
    ) -> Result<Tube<V>, TubeError> {
        self.check_same_domain(other)?;
        let slices =
            self.slices.iter().zip(&other.slices).map(|(&own, &others)| function(own, others)).collect();
        let gates =
            self.gates.iter().zip(&other.gates).map(|(&own, &others)| function(own, others)).collect();
        Ok(Tube::assembled(self.domain.clone(), slices, gates))
    }

    /// The tube of the sums of two trajectories.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn sum(&self, other: &Tube<T>) -> Result<Tube<T>, TubeError> {
        self.zip(other, T::add)
    }

    /// The tube of this trajectory less another.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn difference(&self, other: &Tube<T>) -> Result<Tube<T>, TubeError> {
        self.zip(other, T::sub)
    }
}

/// Writes methods on scalar tubes that do to the trajectory what the method of the same name does to an interval.
macro_rules! of_one_trajectory {
    ($($(#[$doc:meta])* $name:ident $(($argument:ident: $kind:ty))?;)*) => {
        impl Tube<Interval> {$(
            $(#[$doc])*
            pub fn $name(&self $(, $argument: $kind)?) -> Tube<Interval> {
                self.map(|set| set.$name($($argument)?))
            }
        )*}
    };
}

of_one_trajectory! {
    /// The squares of the trajectory, by [`Interval::sqr`].
    sqr;
    /// The square roots of the trajectory, by [`Interval::sqrt`]; empty where it has none.
    sqrt;
    /// The absolute values of the trajectory, by [`Interval::abs`].
    abs;
    /// The sines of the trajectory, in radians, by [`Interval::sin`].
    sin;
    /// The cosines of the trajectory, in radians, by [`Interval::cos`].
    cos;
    /// The tangents of the trajectory, in radians, by [`Interval::tan`]; the whole line over slices that may hold a pole.
    tan;
    /// The arc sines of the trajectory, in radians, by [`Interval::asin`]; empty where it has none.
    asin;
    /// The arc cosines of the trajectory, in radians, by [`Interval::acos`]; empty where it has none.
    acos;
    /// The arc tangents of the trajectory, in radians, by [`Interval::atan`].
    atan;
    /// The exponentials of the trajectory, by [`Interval::exp`].
    exp;
    /// The natural logarithms of the trajectory, by [`Interval::ln`]; empty where it has none.
    ln;
    /// One divided by the trajectory, by [`Interval::recip`].
    recip;
    /// The trajectory to a whole power, by [`Interval::powi`].
    powi(exponent: i32);
    /// The sign of the trajectory, -1, 0 or 1, by [`Interval::sign`].
    sign;
    /// The largest whole numbers not above the trajectory, by [`Interval::floor`].
    floor;
    /// The smallest whole numbers not below the trajectory, by [`Interval::ceil`].
    ceil;
    /// The trajectory rounded towards zero, by [`Interval::trunc`].
    trunc;
    /// The trajectory rounded to the nearest whole number, ties to the even one, by [`Interval::round_ties_even`].
    round_ties_even;
    /// The trajectory rounded to the nearest whole number, ties away from zero, by [`Interval::round_ties_away`].
    round_ties_away;
    /// The angles of the trajectory, in radians, less whole turns, by [`Interval::wrap_angle`].
    wrap_angle;
    /// Everything within `radius` of the tube, by [`Interval::inflate`].
    inflate(radius: f64);
}

/// Writes methods on two scalar tubes from functions of two intervals.
macro_rules! of_two_trajectories {
    ($($(#[$doc:meta])* $name:ident = $function:expr;)*) => {
        impl Tube<Interval> {$(
            $(#[$doc])*
            ///
            /// # Errors
            /// When the two tubes are cut at different times.
            pub fn $name(&self, other: &Tube<Interval>) -> Result<Tube<Interval>, TubeError> {
                self.zip(other, $function)
            }
        )*}
    };
}

of_two_trajectories! {
    /// The tube of the products of two trajectories.
    product = Interval::mul;
    /// The tube of this trajectory divided by another, by the rules of the interval quotient: the whole line where the
    /// divisor may pass zero.
    quotient = Interval::div;
    /// The angles, in radians, of the vectors with this trajectory as second coordinate and `other` as first, by
    /// [`Interval::atan2`].
    atan2 = Interval::atan2;
    /// This trajectory to the power of another, by [`Interval::powf`].
    powf = Interval::powf;
    /// The smaller of the two trajectories at each time, by [`Interval::min`].
    min = Interval::min;
    /// The larger of the two trajectories at each time, by [`Interval::max`].
    max = Interval::max;
}

impl<const N: usize> Tube<IntervalBox<N>> {
    /// The Euclidean lengths of the vectors of the trajectory, by [`IntervalBox::norm`].
    pub fn norm(&self) -> Tube<Interval> {
        self.map(|set| set.norm())
    }

    /// The dot products of two trajectories, by [`IntervalBox::dot`].
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn dot(&self, other: &Tube<IntervalBox<N>>) -> Result<Tube<Interval>, TubeError> {
        self.zip(other, |own, others| own.dot(&others))
    }
}

impl<T: Enclosure> Neg for &Tube<T> {
    type Output = Tube<T>;

    fn neg(self) -> Tube<T> {
        self.map(T::neg)
    }
}

/// Writes the operators between a scalar tube and a set of numbers or a number, on either side; a NaN is any number.
macro_rules! with_constants {
    ($($operator:ident :: $method:ident with $($constant:ty),*;)*) => {$($(
        impl $operator<$constant> for &Tube<Interval> {
            type Output = Tube<Interval>;

            fn $method(self, constant: $constant) -> Tube<Interval> {
                self.map(|set| $operator::$method(set, constant))
            }
        }

        impl $operator<&Tube<Interval>> for $constant {
            type Output = Tube<Interval>;

            fn $method(self, tube: &Tube<Interval>) -> Tube<Interval> {
                tube.map(|set| $operator::$method(self, set))
            }
        }
    )*)*};
}

with_constants! {
    Add::add with Interval, f64;
    Sub::sub with Interval, f64;
    Mul::mul with Interval, f64;
    Div::div with Interval, f64;
}

impl<const N: usize> Add<IntervalBox<N>> for &Tube<IntervalBox<N>> {
    type Output = Tube<IntervalBox<N>>;

    fn add(self, constant: IntervalBox<N>) -> Tube<IntervalBox<N>> {
        self.map(|set| set + constant)
    }
}

impl<const N: usize> Sub<IntervalBox<N>> for &Tube<IntervalBox<N>> {
    type Output = Tube<IntervalBox<N>>;

    fn sub(self, constant: IntervalBox<N>) -> Tube<IntervalBox<N>> {
        self.map(|set| set - constant)
    }
}

impl<const N: usize> Mul<Interval> for &Tube<IntervalBox<N>> {
    type Output = Tube<IntervalBox<N>>;

    fn mul(self, factor: Interval) -> Tube<IntervalBox<N>> {
        self.map(|set| set * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    #[test]
    fn operators_and_names() {
        let t = Tube::from_function(TimeDomain::uniform(0.0, 1.0, 4).unwrap(), |time| time);
        let two = &(&t * 0.0) + over(1.0, 3.0);
        assert_eq!(two.slice(1), Some(over(1.0, 3.0)));
        assert_eq!((1.0 / &(&t + 1.0)).slice(0), Some(over(0.5, 1.0)));
        assert_eq!((-&t).last_gate(), over(-4.0, -4.0));
        assert_eq!(t.product(&t).unwrap().slice(1), Some(over(1.0, 4.0)));
        assert_eq!(t.quotient(&(&t + 1.0)).unwrap().gate(1), Some(over(0.5, 0.5)));
        assert_eq!(t.sum(&t).unwrap().difference(&t).unwrap().gate(3), Some(over(3.0, 3.0)));
        assert_eq!(t.min(&t.sqr()).unwrap().slice(0), Some(over(0.0, 1.0)));
        assert_eq!(t.sqrt().last_gate(), over(2.0, 2.0));
        assert_eq!(t.inflate(0.5).slice(0), Some(over(-0.5, 1.5)));
        let other = Tube::constant(TimeDomain::uniform(0.0, 1.0, 3).unwrap(), Interval::ONE);
        assert_eq!(t.max(&other), Err(TubeError::DifferentDomains));
    }

    #[test]
    fn gates_stay_inside_even_if_a_function_is_careless() {
        let t = Tube::constant(TimeDomain::uniform(0.0, 1.0, 2).unwrap(), Interval::ONE);
        let mut calls = 0;
        let grown = t.map(|set| {
            calls += 1;
            set.inflate(f64::from(calls))
        });
        assert_eq!((grown.slice(0), grown.gate(0)), (Some(over(0.0, 2.0)), Some(over(0.0, 2.0))));
    }
}
