//! Whatever is asked of a tube, and however it is contracted, the trajectory inside is still inside.

mod cases;

use cases::cases;
use proptest::prelude::*;
use shoal_interval::{Interval, IntervalBox, Membership};
use shoal_tube::{Contracted, Direction, TimeDomain, Tube};

/// A polynomial and a sine, known exactly:
/// `offset + slope t + curvature t^2 + jerk t^3 + amplitude sin(rate t + phase)`.
#[derive(Debug, Clone, Copy)]
struct Trajectory {
    offset: f64,
    slope: f64,
    curvature: f64,
    jerk: f64,
    amplitude: f64,
    rate: f64,
    phase: f64,
}

impl Trajectory {
    fn value(&self, time: Interval) -> Interval {
        let polynomial = ((time * self.jerk + self.curvature) * time + self.slope) * time + self.offset;
        (time * self.rate + self.phase).sin() * self.amplitude + polynomial
    }

    fn derivative(&self, time: Interval) -> Interval {
        let polynomial = (time * (3.0 * self.jerk) + 2.0 * self.curvature) * time + self.slope;
        (time * self.rate + self.phase).cos() * self.rate * self.amplitude + polynomial
    }

    /// The value at one time, up to rounding.
    fn at(&self, time: f64) -> Interval {
        self.value(Interval::spanning(time, time))
    }
}

prop_compose! {
    fn trajectory()(
        offset in -100.0..100.0_f64, slope in -3.0..3.0_f64,
        // Multiples of powers of two, of which 3 j and 2 c are exact.
        curvature in prop_oneof![Just(0), -8..8_i32], jerk in prop_oneof![Just(0), -8..8_i32],
        amplitude in -20.0..20.0_f64, rate in 0.0..4.0_f64, phase in -4.0..4.0_f64,
    ) -> Trajectory {
        let (curvature, jerk) = (f64::from(curvature) / 16.0, f64::from(jerk) / 1024.0);
        Trajectory { offset, slope, curvature, jerk, amplitude, rate, phase }
    }
}

prop_compose! {
    fn domain()(
        start in -50.0..50.0_f64,
        steps in prop::collection::vec(prop_oneof![Just(0.1), 1.0e-6..0.01_f64, 0.01..0.5_f64], 1..40),
    ) -> TimeDomain {
        if steps[0] == 0.1 {
            return TimeDomain::uniform(start, 0.1, steps.len()).unwrap();
        }
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
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

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
    fn integrals(x in trajectory(), domain in domain(), shares in prop::array::uniform4(0.0..=1.0_f64)) {
        let derivative = Tube::from_function(domain.clone(), |time| x.derivative(time));
        let tube = Tube::primitive(&derivative, x.at(domain.start_s()));
        let [a, b, c, d] = shares.map(|share| time_in(&domain, share));
        prop_assert!(holds(tube.at(a).unwrap(), x.at(a)));
        prop_assert!(holds(tube.last_gate(), x.at(domain.end_s())));
        prop_assert!(holds(derivative.integral(a, b).unwrap(), x.at(b) - x.at(a)));
        let (from, to) = (Interval::spanning(a, b), Interval::spanning(c, d));
        let between = derivative.integral_between(from, to).unwrap();
        for (start, end) in [(a, c), (a, d), (b, c), (b, d), (from.mid(), to.mid())] {
            prop_assert!(holds(between, x.at(end) - x.at(start)));
        }
    }

    #[test]
    fn queries_with_a_derivative(
        x in trajectory(), domain in domain(), error in 0.0..0.5_f64, shares in prop::array::uniform3(0.0..=1.0_f64),
    ) {
        let derivative = Tube::from_function(domain.clone(), |time| x.derivative(time).inflate(error));
        let mut tube = Tube::from_function(domain.clone(), |time| x.value(time).inflate(error));
        tube.contract_derivative(&derivative, Direction::Both).unwrap();
        let [time, one, other] = shares.map(|share| time_in(&domain, share));
        let at = tube.at_with_derivative(time, &derivative).unwrap();
        prop_assert!(holds(at, x.at(time)) && at.is_subset_of(tube.at(time).unwrap()));

        let times = Interval::spanning(one, other);
        let over = tube.over_with_derivative(times, &derivative).unwrap();
        prop_assert!(over.is_subset_of(tube.over(times).unwrap()));
        let mut sampled = Interval::EMPTY;
        for step in 0..=200 {
            let time = (one + f64::from(step) / 200.0 * (other - one)).clamp(times.lower(), times.upper());
            sampled = sampled | tube.at_with_derivative(time, &derivative).unwrap();
            prop_assert!(holds(over, x.at(time)));
        }
        prop_assert!(sampled.is_subset_of(over.inflate(1e-12 * (1.0 + over.magnitude()))));
        // Inside one slice the answer is tight: samples come as near as the steepest line lets them.
        let inside = !domain.borders_s().any(|border| times.contains(border));
        if inside {
            let index = domain.borders_s().position(|border| border > times.upper()).unwrap() - 1;
            let step = derivative.slice(index).unwrap().magnitude() * times.width() / 200.0;
            prop_assert!(over.is_subset_of(sampled.inflate(step + 1e-9 * (1.0 + over.magnitude()))));
        }

        for within in [Interval::ENTIRE, Interval::spanning(time, one)] {
            let whole_slices = tube.invert_components_within(x.at(time), within);
            let components = tube.invert_components_with_derivative(x.at(time), &derivative, within).unwrap();
            prop_assert!(components.iter().any(|times| times.contains(time)));
            prop_assert!(components.iter().all(|times| whole_slices.iter().any(|whole| times.is_subset_of(*whole))));
            prop_assert!(components.windows(2).all(|pair| pair[0].upper() < pair[1].lower()));
            let hull = components.iter().fold(Interval::EMPTY, |hull, &times| hull | times);
            prop_assert_eq!(tube.invert_with_derivative(x.at(time), &derivative, within), Ok(hull));
            // What was left out of a slice is outside its cones.
            for step in 0..=50 {
                let span = domain.span();
                let asked = (span.lower() + f64::from(step) / 50.0 * (span.upper() - span.lower())).min(span.upper());
                let meets = !tube.at_with_derivative(asked, &derivative).unwrap().is_disjoint_from(x.at(time));
                let inside = within.contains(asked) && meets;
                prop_assert!(!inside || components.iter().any(|times| times.contains(asked)));
            }
        }
    }

    #[test]
    fn arithmetic(x in trajectory(), y in trajectory(), domain in domain(), share in 0.0..=1.0_f64) {
        let [own, others] = [x, y].map(|known| Tube::from_function(domain.clone(), |time| known.value(time)));
        let time = time_in(&domain, share);
        let (a, b) = (x.at(time), y.at(time));
        let truths = [
            (own.sum(&others), a + b),
            (own.difference(&others), a - b),
            (own.product(&others), a * b),
            (own.quotient(&others), a / b),
            (own.min(&others), a.min(b)),
            (own.max(&others), a.max(b)),
            (own.hull(&others), a),
            (own.hull(&others), b),
            (Ok(own.sqr()), a.sqr()),
            (Ok(own.abs()), a.abs()),
            (Ok(own.sin()), a.sin()),
            (Ok(own.cos()), a.cos()),
            (own.atan2(&others), a.atan2(b)),
            (own.abs().powf(&others.cos()), a.abs().powf(b.cos())),
            (Ok(own.atan()), a.atan()),
            (Ok(own.sin().asin()), a.sin().asin()),
            (Ok(own.cos().acos()), a.cos().acos()),
            (Ok((&own * 0.1).exp()), (a * 0.1).exp()),
            (Ok((&own.abs() + 1.0).ln()), (a.abs() + 1.0).ln()),
            (Ok(own.tan()), a.tan()),
            (Ok(own.abs().sqrt()), a.abs().sqrt()),
            (Ok(own.recip()), a.recip()),
            (Ok(own.powi(-3)), a.powi(-3)),
            (Ok(own.floor()), a.floor()),
            (Ok(own.sign()), a.sign()),
            (Ok(own.wrap_angle()), a.wrap_angle()),
            (Ok(-&own), -a),
            (Ok(2.0 / &(&own.sqr() + 1.0)), 2.0 / (a.sqr() + 1.0)),
        ];
        for (tube, value) in truths {
            prop_assert!(holds(tube.unwrap().at(time).unwrap(), value));
        }
        let both = Tube::from_components([&own, &others]).unwrap();
        prop_assert_eq!(both.components(), [own.clone(), others.clone()]);
        let vector = IntervalBox::from([a, b]);
        prop_assert!(!(both.at(time).unwrap() & vector).is_empty());
        prop_assert!(holds(both.norm().at(time).unwrap(), vector.norm()));
        prop_assert!(holds(both.dot(&both).unwrap().at(time).unwrap(), vector.dot(&vector)));
        prop_assert_eq!(own.intersection(&own.inflate(0.1)).unwrap(), own.clone());
        prop_assert_eq!(own.is_subset_of(&own.hull(&others).unwrap()), Ok(true));
        prop_assert!(own.volume() <= own.hull(&others).unwrap().volume());
    }

    #[test]
    fn shifted_composed_and_cut(
        x in trajectory(), domain in domain(), delay in -20.0..20.0_f64, shares in prop::array::uniform3(0.0..=1.0_f64),
    ) {
        let tube = Tube::from_function(domain.clone(), |time| x.value(time));
        let late = tube.shifted(delay);
        // Slices may be shorter than the times are exact.
        if let Ok(late) = late {
            let time = time_in(late.domain(), shares[0]);
            let value = x.value(Interval::spanning(time, time) - delay);
            prop_assert!(holds(late.at(time).unwrap(), value));
            prop_assert!((late.domain().start_s() - delay - domain.start_s()).abs() < 1e-12);
        }
        // The time goes back and forth within the domain.
        let [_, low, high] = shares.map(|share| time_in(&domain, share));
        let inner = |time: Interval| {
            let middle = Interval::spanning(low, low) + (high - low) / 2.0 * (time.sin() + 1.0);
            middle & domain.span()
        };
        let composed = tube.composed_with(&Tube::from_function(domain.clone(), inner)).unwrap();
        let time = time_in(&domain, shares[0]);
        prop_assert!(holds(composed.at(time).unwrap(), x.value(inner(Interval::spanning(time, time)))));

        let mut cut = tube.clone();
        cut.refine(shares.map(|share| time_in(&domain, share))).unwrap();
        prop_assert!(holds(cut.at(time).unwrap(), x.at(time)));
        prop_assert_eq!(cut.over(domain.span()), tube.over(domain.span()));
    }

    #[test]
    fn a_trajectory_is_never_called_what_it_is_not(
        x in trajectory(), y in trajectory(), domain in domain(), error in 0.0..1.0_f64,
    ) {
        let tube = Tube::from_function(domain, |time| x.value(time).inflate(error));
        prop_assert!(tube.contains(|time| x.value(time)) != Membership::Outside);
        prop_assert_eq!(tube.inflate(1e-6).contains(|time| x.value(time)), Membership::Inside);
        let answer = tube.contains(|time| y.value(time));
        let outside_somewhere = tube.domain().borders_s().any(|border| !holds(tube.at(border).unwrap(), y.at(border)));
        prop_assert!(answer != Membership::Inside || !outside_somewhere);
        prop_assert!(answer == Membership::Outside || !outside_somewhere);
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
