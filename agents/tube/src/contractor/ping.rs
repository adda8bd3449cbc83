//! A sound that one vehicle sends and another hears: the distance between two trajectories at two times.

use crate::contraction::together;
use crate::error::{Constraint, TubeError};
use crate::tube::Tube;
use shoal_interval::contractor::{Contracted, contract_range};
use shoal_interval::{Interval, IntervalBox};

/// How often times, places and the speed of sound are contracted by each other, at most, before the tubes are.
const PASSES: usize = 4;

/// A trajectory in space, and its velocity if that is known.
#[derive(Debug)]
pub struct Moving<'a, const N: usize> {
    /// The position, in metres.
    pub position_m: &'a mut Tube<IntervalBox<N>>,
    /// The velocity, in metres per second, cut at the same times. Without it only the times and the speed of sound are
    /// contracted, and positions at a gate that is exactly the time.
    pub velocity_m_s: Option<&'a Tube<IntervalBox<N>>>,
}

/// A ping: when it was sent and heard, in seconds of one time, and how fast sound is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ping {
    /// When it was sent.
    pub emission_s: Interval,
    /// When it was heard.
    pub reception_s: Interval,
    /// The speed of sound between the two, in metres per second.
    pub sound_speed_m_s: Interval,
}

impl Ping {
    const EMPTY: Ping =
        Ping { emission_s: Interval::EMPTY, reception_s: Interval::EMPTY, sound_speed_m_s: Interval::EMPTY };
}

/// Contracts two trajectories, the times of a ping between them and the speed of sound by
/// `‖receiver(reception) - emitter(emission)‖ = sound_speed * (reception - emission)`.
///
/// What is learnt about the tubes stays within the slices that the times touch, whose number is what the cost grows with;
/// [`contract_derivative_around`](Tube::contract_derivative_around) carries it on. When nothing is left, all is empty.
///
/// ```
/// use shoal_interval::{Interval, IntervalBox};
/// use shoal_tube::contractor::{Moving, Ping, contract_ping};
/// use shoal_tube::{TimeDomain, Tube};
///
/// let time = TimeDomain::uniform(0.0, 0.1, 100)?;
/// let still_m_s = Tube::constant(time.clone(), IntervalBox::from([Interval::spanning(-0.1, 0.1), Interval::ZERO]));
/// let mut buoy_m = Tube::constant(time.clone(), IntervalBox::from([Interval::ZERO; 2]));
/// let mut vehicle_m = Tube::constant(time, IntervalBox::from([Interval::new(0.0, 2000.0)?, Interval::ZERO]));
/// let mut ping = Ping {
///     emission_s: Interval::point(5.0)?,
///     reception_s: Interval::new(5.99, 6.01)?,
///     sound_speed_m_s: Interval::point(1500.0)?,
/// };
/// let receiver = Moving { position_m: &mut vehicle_m, velocity_m_s: Some(&still_m_s) };
/// let emitter = Moving { position_m: &mut buoy_m, velocity_m_s: None };
/// contract_ping(receiver, emitter, &mut ping)?;
/// assert!(vehicle_m.at(6.0)?[0].is_subset_of(Interval::new(1484.9, 1515.1)?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When a velocity is cut at other times than its position, or a time may be outside the domain of its tube, where nothing
/// is known.
///
/// Source: seed 001, equations (5.4) and (5.7).
pub fn contract_ping<const N: usize>(
    mut receiver: Moving<'_, N>,
    mut emitter: Moving<'_, N>,
    ping: &mut Ping,
) -> Result<Contracted, TubeError> {
    let mut left = *ping;
    let (mut place_m, mut source_m) = (IntervalBox::ENTIRE, IntervalBox::ENTIRE);
    for _ in 0..PASSES {
        let pass = (left, place_m, source_m);
        (left.reception_s, place_m) = receiver.passing(left.reception_s, place_m)?;
        (left.emission_s, source_m) = emitter.passing(left.emission_s, source_m)?;
        let Ping { emission_s, reception_s, sound_speed_m_s } = &mut left;
        let contracted =
            contract_range(&mut place_m, &mut source_m, sound_speed_m_s, reception_s, emission_s);
        if contracted == Contracted::Empty {
            // The places are empty; the times still say where.
            left = *ping;
            break;
        }
        if pass == (left, place_m, source_m) {
            break;
        }
    }
    let heard = receiver.narrow(&mut left.reception_s, &mut place_m)?;
    let sent = emitter.narrow(&mut left.emission_s, &mut source_m)?;
    let contracted = together(heard, sent);
    if contracted == Contracted::Empty {
        receiver.position_m.empty_near(ping.reception_s.mid(), Constraint::Ping);
        emitter.position_m.empty_near(ping.emission_s.mid(), Constraint::Ping);
        *ping = Ping::EMPTY;
        return Ok(Contracted::Empty);
    }
    let of_ping = if left == *ping { Contracted::Unchanged } else { Contracted::Narrowed };
    *ping = left;
    Ok(together(contracted, of_ping))
}

impl<const N: usize> Moving<'_, N> {
    fn passing(
        &self,
        time_s: Interval,
        place_m: IntervalBox<N>,
    ) -> Result<(Interval, IntervalBox<N>), TubeError> {
        if let Some(velocity_m_s) = self.velocity_m_s {
            self.position_m.check_same_domain(velocity_m_s)?;
        }
        self.position_m.passing(self.velocity_m_s, time_s, place_m)
    }

    fn narrow(
        &mut self,
        time_s: &mut Interval,
        place_m: &mut IntervalBox<N>,
    ) -> Result<Contracted, TubeError> {
        self.position_m.evaluate(self.velocity_m_s, time_s, place_m, Constraint::Ping)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_domain::TimeDomain;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).unwrap()
    }

    fn still(x: Interval) -> Tube<IntervalBox<2>> {
        let time = TimeDomain::uniform(0.0, 0.125, 80).unwrap();
        Tube::constant(time, IntervalBox::from([x, Interval::ZERO]))
    }

    fn ping(reception_s: Interval) -> Ping {
        Ping { emission_s: over(2.0, 2.0), reception_s, sound_speed_m_s: over(100.0, 100.0) }
    }

    #[test]
    fn the_time_of_reception_is_learnt_from_where_both_are() {
        let (mut heard, mut sent) = (still(over(100.0, 200.0)), still(Interval::ZERO));
        let mut ping = ping(over(0.0, 9.0));
        let receiver = Moving { position_m: &mut heard, velocity_m_s: None };
        let emitter = Moving { position_m: &mut sent, velocity_m_s: None };
        assert_eq!(contract_ping(receiver, emitter, &mut ping), Ok(Contracted::Narrowed));
        assert_eq!(ping.reception_s, over(3.0, 4.0));
    }

    #[test]
    fn a_contradiction_empties_all_and_says_where() {
        let (mut heard, mut sent) = (still(over(100.0, 200.0)), still(Interval::ZERO));
        let mut ping = ping(over(5.0, 9.0));
        let receiver = Moving { position_m: &mut heard, velocity_m_s: None };
        let emitter = Moving { position_m: &mut sent, velocity_m_s: None };
        assert_eq!(contract_ping(receiver, emitter, &mut ping), Ok(Contracted::Empty));
        assert_eq!(ping, Ping::EMPTY);
        assert_eq!(heard.emptied().unwrap().to_string(), "gate 56, at 7 s, is empty: emptied by a ping");
        assert_eq!(sent.emptied().unwrap().constraint, Some(Constraint::Ping));
    }

    #[test]
    fn a_time_outside_the_domain_changes_nothing() {
        let (mut heard, mut sent) = (still(over(100.0, 200.0)), still(Interval::ZERO));
        let before = ping(over(5.0, 11.0));
        let mut ping = before;
        let receiver = Moving { position_m: &mut heard, velocity_m_s: None };
        let emitter = Moving { position_m: &mut sent, velocity_m_s: None };
        assert!(contract_ping(receiver, emitter, &mut ping).is_err());
        assert_eq!(ping, before);
    }
}
