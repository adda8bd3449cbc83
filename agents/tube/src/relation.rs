//! How tubes lie to each other and to a trajectory.

use crate::enclosure::Enclosure;
use crate::error::TubeError;
use crate::time_domain::exactly;
use crate::tube::Tube;
use shoal_interval::{Interval, Membership};

/// How often a slice is halved, at most, to find on which side of the tube's boundary a trajectory is.
const HALVINGS: u32 = 6;

impl<T: Enclosure> Tube<T> {
    /// Whether every trajectory of this tube is in `other`, slice by slice and gate by gate. An empty tube holds none.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    ///
    /// Source: seed 001, equation (4.11).
    pub fn is_subset_of(&self, other: &Tube<T>) -> Result<bool, TubeError> {
        self.check_same_domain(other)?;
        Ok(self.is_empty() || self.all_sets(other, T::is_subset_of))
    }

    /// Whether every slice and gate of this tube is inside that of `other` and does not touch its boundary.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    pub fn is_interior_of(&self, other: &Tube<T>) -> Result<bool, TubeError> {
        self.check_same_domain(other)?;
        Ok(self.is_empty() || self.all_sets(other, T::is_interior_of))
    }

    /// The smallest tube that holds both; one that is empty anywhere holds no trajectory, and adds none.
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    ///
    /// Source: seed 001, equation (4.9).
    pub fn hull(&self, other: &Tube<T>) -> Result<Tube<T>, TubeError> {
        self.check_same_domain(other)?;
        match (self.is_empty(), other.is_empty()) {
            (true, _) => Ok(other.clone()),
            (_, true) => Ok(self.clone()),
            _ => self.zip(other, |own, others| own | others),
        }
    }

    /// The trajectories that are in both; empty where they contradict each other.
    ///
    /// ```
    /// use shoal_interval::Interval;
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let time = TimeDomain::uniform(0.0, 1.0, 4)?;
    /// let from_sonar_m = Tube::from_function(time.clone(), |t| t.inflate(1.0));
    /// let from_map_m = Tube::constant(time, Interval::new(0.0, 2.0)?);
    /// let depth_m = from_sonar_m.intersection(&from_map_m)?;
    /// assert_eq!(depth_m.slice(2), Some(Interval::new(1.0, 2.0)?));
    /// assert!(depth_m.is_subset_of(&from_map_m)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the two tubes are cut at different times.
    ///
    /// Source: seed 001, equation (4.12).
    pub fn intersection(&self, other: &Tube<T>) -> Result<Tube<T>, TubeError> {
        self.zip(other, |own, others| own & others)
    }

    /// Whether a trajectory is in the tube, the whole of it. `enclose` is an inclusion function of the trajectory, as in
    /// [`from_function`](Tube::from_function).
    ///
    /// [`Inside`](Membership::Inside) and [`Outside`](Membership::Outside) are proofs. A slice of which neither can be said
    /// is halved up to six times, because inclusion functions are sharper over less time;
    /// [`Undecided`](Membership::Undecided) is what remains, as along a boundary that is touched.
    ///
    /// ```
    /// use shoal_interval::{Interval, Membership};
    /// use shoal_tube::{TimeDomain, Tube};
    ///
    /// let x_m = Tube::from_function(TimeDomain::uniform(0.0, 0.1, 50)?, |t| t.sin().inflate(0.1));
    /// assert_eq!(x_m.contains(|t| t.sin()), Membership::Inside);
    /// assert_eq!(x_m.contains(|t| t.cos()), Membership::Outside);
    /// # Ok::<(), shoal_tube::TubeError>(())
    /// ```
    pub fn contains(&self, mut enclose: impl FnMut(Interval) -> T) -> Membership {
        let mut found = Membership::Inside;
        for (index, gate) in self.gates.iter().enumerate() {
            let at_border = compare(gate, exactly(self.domain.border_at(index)), &mut enclose, 0);
            let over_slice = self.slices.get(index).map_or(Membership::Inside, |slice| {
                compare(slice, self.domain.span_at(index), &mut enclose, HALVINGS)
            });
            found = both(found, both(at_border, over_slice));
            if found == Membership::Outside {
                break;
            }
        }
        found
    }

    fn all_sets(&self, other: &Tube<T>, holds: impl Fn(&T, &T) -> bool) -> bool {
        self.slices.iter().zip(&other.slices).all(|(own, others)| holds(own, others))
            && self.gates.iter().zip(&other.gates).all(|(own, others)| holds(own, others))
    }
}

/// How a trajectory over some times lies to a set.
fn compare<T: Enclosure>(
    set: &T,
    times_s: Interval,
    enclose: &mut impl FnMut(Interval) -> T,
    halvings: u32,
) -> Membership {
    let values = enclose(times_s);
    if values.is_disjoint_from(set) {
        return Membership::Outside;
    }
    if values.is_subset_of(set) {
        return Membership::Inside;
    }
    match times_s.bisect() {
        Some((early_s, late_s)) if halvings > 0 => match compare(set, early_s, enclose, halvings - 1) {
            Membership::Outside => Membership::Outside,
            early => both(early, compare(set, late_s, enclose, halvings - 1)),
        },
        _ => Membership::Undecided,
    }
}

/// How a trajectory lies that lies in one way over some times and in another over others.
fn both(one: Membership, other: Membership) -> Membership {
    match (one, other) {
        (Membership::Outside, _) | (_, Membership::Outside) => Membership::Outside,
        (Membership::Inside, Membership::Inside) => Membership::Inside,
        _ => Membership::Undecided,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn parabola(radius: f64) -> Tube<Interval> {
        Tube::from_function(TimeDomain::uniform(-1.0, 0.1, 20).unwrap(), |t| t.sqr().inflate(radius))
    }

    #[test]
    fn inclusions() {
        assert_eq!(parabola(0.5).is_subset_of(&parabola(0.5)), Ok(true));
        assert_eq!(parabola(0.5).is_interior_of(&parabola(0.5)), Ok(false));
        assert_eq!(parabola(0.5).is_interior_of(&parabola(0.6)), Ok(true));
        assert_eq!(parabola(0.7).is_subset_of(&parabola(0.6)), Ok(false));
        let mut one_gate = parabola(0.6);
        one_gate.contract_gate(3, &Interval::ZERO).unwrap();
        assert_eq!(parabola(0.5).is_subset_of(&one_gate), Ok(false));
        let other = Tube::constant(TimeDomain::uniform(0.0, 1.0, 2).unwrap(), Interval::ENTIRE);
        assert_eq!(parabola(0.5).is_subset_of(&other), Err(TubeError::DifferentDomains));
        assert!(parabola(0.5).hull(&other).is_err());
    }

    #[test]
    fn a_trajectory_is_inside_outside_or_on_the_edge() {
        let tube = parabola(0.25);
        assert_eq!(tube.contains(|t| t.sqr()), Membership::Inside);
        // A bad inclusion function, rescued by halving.
        assert_eq!(tube.contains(|t| t * t + t - t), Membership::Inside);
        assert_eq!(tube.contains(|t| t.sqr() + t), Membership::Outside);
        assert_eq!(parabola(0.0).contains(|t| t.sqr().inflate(1e-9)), Membership::Undecided);
        assert_eq!(tube.contains(|_| Interval::EMPTY), Membership::Outside);
    }

    #[test]
    fn what_is_empty_somewhere_adds_nothing() {
        let mut impossible = parabola(9.0);
        impossible.contract_gate(3, &Interval::EMPTY).unwrap();
        assert_eq!(impossible.hull(&parabola(0.5)), Ok(parabola(0.5)));
        assert_eq!(parabola(0.5).hull(&impossible), Ok(parabola(0.5)));
        assert_eq!(impossible.is_subset_of(&parabola(0.0)), Ok(true));
        assert!(parabola(0.5).intersection(&impossible).unwrap().is_empty());
    }

    #[test]
    fn one_gate_decides() {
        let mut tube = parabola(0.25);
        tube.contract_gate(10, &Interval::centred(0.2, 0.01)).unwrap();
        assert_eq!(tube.contains(|t| t.sqr()), Membership::Outside);
    }
}
