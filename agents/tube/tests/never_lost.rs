//! Whatever is asked of a tube, and however it is contracted, the trajectory inside is still inside.

use proptest::prelude::*;
use shoal_interval::{Interval, IntervalBox};
use shoal_tube::{Contracted, Direction, TimeDomain, Tube};

/// The trajectory `offset + slope t + amplitude sin(rate t + phase)`, known exactly.
#[derive(Debug, Clone, Copy)]
struct Trajectory {
    offset: f64,
    slope: f64,
    amplitude: f64,
    rate: f64,
    phase: f64,
}

impl Trajectory {
    fn value(&self, time: Interval) -> Interval {
        (time * self.rate + self.phase).sin() * self.amplitude + time * self.slope + self.offset
    }

    fn derivative(&self, time: Interval) -> Interval {
        (time * self.rate + self.phase).cos() * self.rate * self.amplitude + self.slope
    }

    /// The value at one time, up to rounding.
    fn at(&self, time: f64) -> Interval {
        self.value(Interval::spanning(time, time))
    }
}

prop_compose! {
    fn trajectory()(
        offset in -100.0..100.0_f64, slope in -3.0..3.0_f64, amplitude in -20.0..20.0_f64,
        rate in 0.0..4.0_f64, phase in -4.0..4.0_f64,
    ) -> Trajectory {
        Trajectory { offset, slope, amplitude, rate, phase }
    }
}

prop_compose! {
    fn domain()(
        start in -50.0..50.0_f64,
        steps in prop::collection::vec(prop_oneof![Just(0.1), 1.0e-6..0.01_f64, 0.01..0.5_f64], 1..40),
    ) -> TimeDomain {
        let ends = steps.iter().scan(start, |end, step| { *end += step; Some(*end) });
        TimeDomain::new(std::iter::once(start).chain(ends)).unwrap()
    }
}

fn time_in(domain: &TimeDomain, share: f64) -> f64 {
    (domain.start_s() + share * (domain.end_s() - domain.start_s())).clamp(domain.start_s(), domain.end_s())
}

/// Whether the set holds the value, which is itself only known up to rounding.
fn holds(set: Interval, value: Interval) -> bool {
    !(set & value).is_empty()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn queries(x in trajectory(), domain in domain(), shares in prop::array::uniform3(0.0..=1.0_f64)) {
        let tube = Tube::from_function(domain.clone(), |time| x.value(time));
        let [time, one, other] = shares.map(|share| time_in(&domain, share));
        prop_assert!(holds(tube.at(time).unwrap(), x.at(time)));
        let times = Interval::spanning(one, other) | Interval::spanning(time, time);
        prop_assert!(x.at(time).is_subset_of(tube.over(times).unwrap()) || times.is_point());
        prop_assert!(tube.invert(x.at(time)).contains(time));
        for border in domain.borders_s() {
            prop_assert!(holds(tube.at(border).unwrap(), x.at(border)));
        }
    }

    #[test]
    fn integrals(x in trajectory(), domain in domain(), share in 0.0..=1.0_f64) {
        let derivative = Tube::from_function(domain.clone(), |time| x.derivative(time));
        let tube = Tube::primitive(&derivative, x.at(domain.start_s()));
        let time = time_in(&domain, share);
        prop_assert!(holds(tube.at(time).unwrap(), x.at(time)));
        prop_assert!(holds(tube.last_gate(), x.at(domain.end_s())));
    }

    #[test]
    fn contraction_both_ways(
        x in trajectory(), domain in domain(), known in any::<prop::sample::Index>(), share in 0.0..=1.0_f64,
    ) {
        let derivative = Tube::from_function(domain.clone(), |time| x.derivative(time));
        let mut tube = Tube::constant(domain.clone(), Interval::ENTIRE);
        let gate = known.index(domain.slice_count() + 1);
        let known_s = domain.borders_s().nth(gate).unwrap();
        tube.contract_gate(gate, &x.at(known_s).inflate(0.1)).unwrap();
        for direction in [Direction::Backward, Direction::Forward, Direction::Both] {
            prop_assert!(tube.contract_derivative(&derivative, direction).unwrap() != Contracted::Empty);
        }
        prop_assert_eq!(tube.contract_derivative(&derivative, Direction::Both), Ok(Contracted::Unchanged));
        prop_assert!(tube.width() < 1.0e3);
        let time = time_in(&domain, share);
        prop_assert!(holds(tube.at(time).unwrap(), x.at(time)));
        for (index, border) in domain.borders_s().enumerate() {
            prop_assert!(holds(tube.gate(index).unwrap(), x.at(border)));
        }
    }

    /// A vehicle's life: append with what the speed says, learn now and then, forget the past.
    #[test]
    fn online_with_a_bounded_memory(x in trajectory(), y in trajectory(), domain in domain(), every in 1_usize..7) {
        let value = |time| IntervalBox::from([x.value(time), y.value(time)]);
        let slope = |time| IntervalBox::from([x.derivative(time), y.derivative(time)]);
        let at = |time| value(Interval::spanning(time, time));
        let mut tube = Tube::starting_at(domain.start_s(), at(domain.start_s())).unwrap();
        for (index, end) in domain.borders_s().enumerate().skip(1) {
            let span = domain.slice_span(index - 1).unwrap();
            tube.append(end, IntervalBox::ENTIRE, IntervalBox::ENTIRE).unwrap();
            tube.contract_slice_derivative(tube.slice_count() - 1, slope(span), Direction::Forward).unwrap();
            if index % every == 0 {
                tube.contract_gate(tube.slice_count(), &at(end).inflate(0.01)).unwrap();
                tube.contract_slice_derivative(tube.slice_count() - 1, slope(span), Direction::Backward).unwrap();
            }
            tube.drop_before(end - 0.5);
            prop_assert!(tube.domain().start_s() > end - 1.1 && !tube.is_empty());
            prop_assert!(!(tube.last_gate() & at(end)).is_empty());
            prop_assert!(!(tube.at(span.mid()).unwrap() & at(span.mid())).is_empty());
        }
    }
}
