//! No contractor loses a trajectory that obeys its constraint, adds one, or cuts time otherwise; and the less it is given,
//! the less it leaves.

mod cases;
mod truth;

use cases::cases;
use proptest::prelude::*;
use shoal_interval::contractor::contract_product;
use shoal_interval::{Interval, IntervalBox};
use shoal_tube::contractor::{
    Moving, Ping, contract_chain, contract_composition, contract_delay, contract_equality, contract_inverse,
    contract_order, contract_ping, contract_uncertain_delay, lift,
};
use shoal_tube::{Contracted, Direction, Tube, TubeError};
use truth::{around, domain, holds, is_sound, radii, time_in, trajectory};

/// An inclusion function of a trajectory that is in a tube.
type Truth<'a> = &'a dyn Fn(Interval) -> Interval;

/// Contracts tubes around these trajectories, narrow ones and wide ones, to the fixpoint, and says what is wrong.
fn check<const M: usize>(
    tubes: impl Fn(f64) -> [Tube<Interval>; M],
    truths: [Truth<'_>; M],
    contract: impl Fn(&mut [Tube<Interval>; M]) -> Contracted,
) -> Result<(), TestCaseError> {
    let contracted = |scale: f64| -> Result<[Tube<Interval>; M], TestCaseError> {
        let before = tubes(scale);
        let mut after = before.clone();
        let outcome = contract(&mut after);
        for index in 0..M {
            prop_assert!(is_sound(&before[index], &after[index]), "tube {index} is not sound");
            prop_assert!(holds(&after[index], truths[index]), "tube {index} lost the truth");
            prop_assert_eq!(after[index].emptied(), None);
        }
        prop_assert!(outcome != Contracted::Empty);
        prop_assert_eq!(outcome == Contracted::Unchanged, before == after);
        let once = after.clone();
        // On the way to the fixpoint nothing is lost either.
        for _ in 0..3 {
            if contract(&mut after) == Contracted::Unchanged {
                break;
            }
        }
        for index in 0..M {
            prop_assert!(holds(&after[index], truths[index]), "tube {} lost the truth later", index);
        }
        Ok(once)
    };
    let (narrow, wide) = (contracted(1.0)?, contracted(1.7)?);
    for index in 0..M {
        prop_assert_eq!(narrow[index].is_subset_of(&wide[index]), Ok(true), "not monotone in tube {}", index);
    }
    Ok(())
}

/// Whether a contractor that can do all at once has done so.
fn is_idempotent<const M: usize>(
    mut tubes: [Tube<Interval>; M],
    contract: impl Fn(&mut [Tube<Interval>; M]) -> Contracted,
) -> bool {
    contract(&mut tubes);
    contract(&mut tubes) == Contracted::Unchanged
}

fn exactly(value: f64) -> Interval {
    Interval::spanning(value, value)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(8000)))]

    #[test]
    fn order_and_equality(x in trajectory(), domain in domain(), radii in radii(), gap in 0.0..0.5_f64) {
        let above = |time: Interval| x.value(time) + gap * 1.0;
        let truth = |time: Interval| x.value(time);
        let reversed: Vec<f64> = radii.iter().rev().copied().collect();
        let order = |tubes: &mut [Tube<Interval>; 2]| {
            let [x, y] = tubes;
            contract_order(x, y).unwrap()
        };
        let tubes = |scale| [around(&domain, &radii, scale, truth), around(&domain, &reversed, scale, above)];
        check(tubes, [&truth, &above], order)?;
        prop_assert!(is_idempotent(tubes(1.0), order));
        let equality = |tubes: &mut [Tube<Interval>; 2]| {
            let [x, y] = tubes;
            contract_equality(x, y).unwrap()
        };
        let tubes = |scale| [around(&domain, &radii, scale, truth), around(&domain, &reversed, scale, truth)];
        check(tubes, [&truth, &truth], equality)?;
        prop_assert!(is_idempotent(tubes(1.0), equality));
    }

    #[test]
    fn products(x in trajectory(), y in trajectory(), domain in domain(), radii in radii()) {
        let truths: [Truth<'_>; 3] = [&|time| x.value(time), &|time| y.value(time), &|time| x.value(time) * y.value(time)];
        let tubes = |scale: f64| truths.map(|truth| around(&domain, &radii, scale, truth));
        check(tubes, truths, |[x, y, z]| {
            lift([x, y, z], |[x, y, z]| { contract_product(x, y, z); }).unwrap()
        })?;
    }

    #[test]
    fn delays(
        x in trajectory(), domains in prop::array::uniform2(domain()), radii in radii(),
        delay in prop_oneof![Just(0.5), Just(0.1), -2.0..2.0_f64],
    ) {
        // x(t) = y(t - tau)
        let earlier = |time: Interval| x.value(time + delay);
        let truth = |time: Interval| x.value(time);
        let tubes = |scale| [around(&domains[0], &radii, scale, truth), around(&domains[1], &radii[..1], scale, earlier)];
        check(tubes, [&truth, &earlier], |[x, y]| contract_delay(x, y, exactly(delay)).unwrap())?;
    }

    #[test]
    fn uncertain_delays(
        x in trajectory(), domains in prop::array::uniform2(domain()), radii in radii(), delay in -2.0..2.0_f64,
        around_delay in prop::array::uniform2(0.0..3.0_f64),
    ) {
        let earlier = |time: Interval| x.value(time + delay);
        let truth = |time: Interval| x.value(time);
        let known = Interval::spanning(delay - around_delay[0], delay + around_delay[1]);
        for scale in [1.0, 0.01] {
            let before = [around(&domains[0], &radii, scale, truth), around(&domains[1], &radii[..1], scale, earlier)];
            let [mut x, mut y] = before.clone();
            let mut left = known;
            let outcome = contract_uncertain_delay(&mut x, &mut y, &mut left);
            prop_assert!(outcome != Contracted::Empty && left.contains(delay) && left.is_subset_of(known));
            prop_assert!(is_sound(&before[0], &x) && is_sound(&before[1], &y));
            prop_assert!(holds(&x, truth) && holds(&y, earlier));
        }
    }

    #[test]
    fn periods(amplitude in 0.1..5.0_f64, period in prop_oneof![Just(0.5), Just(1.0), 0.3..4.0_f64], domain in domain(), radii in radii()) {
        let turns = |time: Interval| (time / period * Interval::TWO_PI).sin() * amplitude;
        check(|scale| [around(&domain, &radii, scale, turns)], [&turns], |[x]| x.contract_period(exactly(period)).unwrap())?;
    }

    #[test]
    fn symmetries(x in trajectory(), axis in prop_oneof![Just(0.0), -1.0..3.0_f64], domain in domain(), radii in radii()) {
        let even = |time: Interval| {
            let since = time - axis;
            (since * x.rate).cos() * x.amplitude + since.sqr() * x.curvature + x.offset
        };
        check(|scale| [around(&domain, &radii, scale, even)], [&even], |[tube]| tube.contract_axial_symmetry(exactly(axis)).unwrap())?;
        let odd = |time: Interval| {
            let since = time - axis;
            (since * x.rate).sin() * x.amplitude + since * x.slope + x.offset
        };
        check(|scale| [around(&domain, &radii, scale, odd)], [&odd], |[tube]| {
            tube.contract_central_symmetry(exactly(axis), exactly(x.offset).inflate(1.0e-12)).unwrap()
        })?;
    }

    #[test]
    fn derivatives_within_and_around(
        x in trajectory(), domain in domain(), radii in radii(), shares in prop::array::uniform2(0.0..=1.0_f64),
    ) {
        let truth = |time: Interval| x.value(time);
        let derivative = around(&domain, &[0.01, 0.3], 1.0, |time| x.derivative(time));
        let [one, other] = shares.map(|share| time_in(&domain, share));
        let window = Interval::spanning(one, other);
        for direction in [Direction::Forward, Direction::Backward, Direction::Both] {
            check(|scale| [around(&domain, &radii, scale, truth)], [&truth], |[x]| {
                x.contract_derivative_within(&derivative, window, direction).unwrap()
            })?;
        }
        // What is learnt in the window goes as far as it would through the whole domain.
        let gate = domain.borders_s().position(|border| window.contains(border));
        let learnt = |scale| {
            let mut tube = around(&domain, &radii, scale, truth);
            tube.contract_derivative(&derivative, Direction::Both).unwrap();
            if let Some(gate) = gate {
                let known = x.at(domain.border_s(gate).unwrap()).inflate(1.0e-3 * scale);
                tube.contract_gate(gate, &known).unwrap();
            }
            tube
        };
        check(|scale| [learnt(scale)], [&truth], |[tube]| tube.contract_derivative_around(&derivative, window).unwrap())?;
        let (mut spread, mut all) = (learnt(1.0), learnt(1.0));
        spread.contract_derivative_around(&derivative, window).unwrap();
        all.contract_derivative(&derivative, Direction::Both).unwrap();
        prop_assert_eq!(spread.is_subset_of(&all.inflate(1.0e-9)), Ok(true));
    }

    #[test]
    fn evaluations(
        x in trajectory(), domain in domain(), radii in radii(), share in 0.0..=1.0_f64,
        early in prop_oneof![Just(0.0), 0.0..1.0_f64], late in prop_oneof![Just(0.0), 0.0..1.0_f64],
        error in prop_oneof![Just(1.0e-9), 0.0..3.0_f64], snap in any::<bool>(),
    ) {
        let truth = |time: Interval| x.value(time);
        let derivative = around(&domain, &[0.01, 0.3], 1.0, |time| x.derivative(time));
        let anywhere = time_in(&domain, share);
        let time = if snap { domain.borders_s().rfind(|&border| border <= anywhere).unwrap() } else { anywhere };
        let possible_s = Interval::spanning(time - early, time + late) & domain.span();
        let evaluate = |scale: f64, slope: Option<&Tube<Interval>>| {
            let before = around(&domain, &radii, scale, truth);
            let mut tube = before.clone();
            let (mut time_s, mut value) = (possible_s, x.at(time).inflate(error * scale));
            let outcome = match slope {
                Some(slope) => tube.contract_evaluation_with_derivative(slope, &mut time_s, &mut value),
                None => tube.contract_evaluation(&mut time_s, &mut value),
            };
            prop_assert!(outcome.unwrap() != Contracted::Empty);
            prop_assert!(time_s.contains(time) && !(value & x.at(time)).is_empty());
            prop_assert!(time_s.is_subset_of(possible_s) && value.is_subset_of(x.at(time).inflate(error * scale)));
            prop_assert!(is_sound(&before, &tube) && holds(&tube, truth));
            Ok((tube, time_s, value))
        };
        for slope in [None, Some(&derivative)] {
            let (narrow, wide) = (evaluate(1.0, slope)?, evaluate(1.7, slope)?);
            prop_assert!(narrow.1.is_subset_of(wide.1) && narrow.2.is_subset_of(wide.2));
            prop_assert_eq!(narrow.0.is_subset_of(&wide.0), Ok(true));
        }
    }

    #[test]
    fn compositions(
        x in trajectory(), domains in prop::array::uniform2(domain()), radii in radii(),
        offset in -1.0..1.0_f64, speed in -1.5..1.5_f64, sway in -0.3..0.3_f64,
    ) {
        let clock = |time: Interval| time * speed + (time * 3.0).sin() * sway + offset;
        let shown = |time: Interval| x.value(clock(time));
        let truth = |time: Interval| x.value(time);
        let tubes = |scale| [
            around(&domains[0], &radii, scale, truth),
            around(&domains[1], &radii[..1], 0.1 * scale, clock),
            around(&domains[1], &radii, scale, shown),
        ];
        check(tubes, [&truth, &clock, &shown], |[x, h, y]| contract_composition(x, h, y).unwrap())?;
    }

    #[test]
    fn inverses(domains in prop::array::uniform2(domain()), radii in radii(), offset in -1.0..1.0_f64, speed in 0.5..1.5_f64) {
        let there = |time: Interval| time * speed + offset;
        let back = |time: Interval| (time - offset) / speed;
        let tubes = |scale| [around(&domains[0], &radii, scale, there), around(&domains[1], &radii, scale, back)];
        check(tubes, [&there, &back], |[h, g]| contract_inverse(h, g).unwrap())?;
    }

    #[test]
    fn state_equations(x in trajectory(), domain in domain(), radii in radii(), gain in -2.0..2.0_f64) {
        let truth = |time: Interval| x.value(time);
        let slope = |time: Interval| x.derivative(time);
        let rate = |time: Interval, state: Interval| x.derivative(time) + (state - x.value(time)) * gain;
        for direction in [Direction::Forward, Direction::Both] {
            check(|scale| [around(&domain, &radii, scale, truth)], [&truth], |[tube]| {
                tube.contract_state_equation(rate, direction, 3)
            })?;
        }
        let push = |time: Interval| x.derivative(time) - x.value(time) * gain;
        let input = around(&domain, &radii, 0.1, push);
        let tubes = |scale| [around(&domain, &radii, scale, truth), around(&domain, &radii, scale, slope)];
        check(tubes, [&truth, &slope], |[state, derivative]| {
            contract_chain(state, derivative, &input, 3, |state, input| state * gain + input).unwrap()
        })?;
    }

    #[test]
    fn pings(
        coordinates in prop::array::uniform4(trajectory()), domain in domain(), radii in radii(),
        share in 0.0..0.9_f64, around_times in prop::array::uniform4(1.0e-9..0.3_f64),
    ) {
        let [x, y, u, v] = coordinates;
        let emission = time_in(&domain, share);
        // Sound fast enough for the reception to be in the domain.
        let distance = |reception: f64| {
            let (dx, dy) = (x.at(reception) - u.at(emission), y.at(reception) - v.at(emission));
            (dx.sqr() + dy.sqr()).sqrt().mid()
        };
        let reception = emission + 0.7 * (domain.end_s() - emission);
        prop_assume!(reception - emission > 1.0e-6);
        let speed = distance(reception) / (reception - emission);
        let [early, late, soon, after] = around_times;
        let before = Ping {
            emission_s: Interval::spanning(emission - early, emission + late) & domain.span(),
            reception_s: Interval::spanning(reception - soon, reception + after) & domain.span(),
            sound_speed_m_s: Interval::centred(speed, 1.0e-6 * speed + 1.0e-9),
        };
        let tube = |one: Truth<'_>, other: Truth<'_>, scale: f64| {
            Tube::from_components([&around(&domain, &radii, scale, one), &around(&domain, &radii, scale, other)]).unwrap()
        };
        let receiver = tube(&|time| x.value(time), &|time| y.value(time), 1.0);
        let emitter = tube(&|time| u.value(time), &|time| v.value(time), 1.0);
        let velocity = tube(&|time| x.derivative(time), &|time| y.derivative(time), 0.1);
        for velocity_m_s in [None, Some(&velocity)] {
            let (mut heard, mut sent, mut ping) = (receiver.clone(), emitter.clone(), before);
            let outcome = contract_ping(
                Moving { position_m: &mut heard, velocity_m_s },
                Moving { position_m: &mut sent, velocity_m_s: None },
                &mut ping,
            );
            prop_assert!(outcome.unwrap() != Contracted::Empty);
            prop_assert!(ping.emission_s.contains(emission) && ping.reception_s.contains(reception));
            prop_assert!(ping.emission_s.is_subset_of(before.emission_s) && ping.sound_speed_m_s.contains(speed));
            let parts = [(&receiver, &heard, x, y), (&emitter, &sent, u, v)];
            for (before, after, one, other) in parts {
                for axis in 0..2 {
                    let coordinate = if axis == 0 { one } else { other };
                    prop_assert!(is_sound(&before.component(axis), &after.component(axis)));
                    prop_assert!(holds(&after.component(axis), |time| coordinate.value(time)));
                }
            }
        }
    }

    /// Boxes do what their sides do.
    #[test]
    fn evaluations_of_boxes(
        x in trajectory(), y in trajectory(), domain in domain(), radii in radii(), share in 0.0..=1.0_f64,
        spread in 0.0..0.5_f64, error in 1.0e-9..1.0_f64,
    ) {
        let tube = |one: Truth<'_>, other: Truth<'_>, scale: f64| {
            Tube::from_components([&around(&domain, &radii, scale, one), &around(&domain, &radii, scale, other)]).unwrap()
        };
        let before = tube(&|time| x.value(time), &|time| y.value(time), 1.0);
        let velocity = tube(&|time| x.derivative(time), &|time| y.derivative(time), 0.1);
        let time = time_in(&domain, share);
        let mut time_s = Interval::centred(time, spread) & domain.span();
        let mut value = IntervalBox::from([x.at(time).inflate(error), y.at(time).inflate(error)]);
        let mut after = before.clone();
        let outcome = after.contract_evaluation_with_derivative(&velocity, &mut time_s, &mut value).unwrap();
        prop_assert!(outcome != Contracted::Empty && time_s.contains(time));
        for (axis, truth) in [x, y].into_iter().enumerate() {
            prop_assert!(!(value[axis] & truth.at(time)).is_empty());
            prop_assert!(is_sound(&before.component(axis), &after.component(axis)));
            prop_assert!(holds(&after.component(axis), |time| truth.value(time)));
        }
    }

    /// Empty, unbounded and huge sets, anywhere: no panic, nothing added, empty where one of the sets is.
    #[test]
    fn anything_at_all(
        sets in prop::array::uniform3(prop::collection::vec(any_set(), 1..6)), domains in prop::array::uniform2(domain()),
        other in any_set(), time in any_set(), known_s in prop_oneof![any_set(), any::<f64>().prop_map(exactly), (-3.0..3.0_f64).prop_map(exactly)],
    ) {
        let [x, y, z] = [0, 1, 2].map(|index| {
            let mut set = sets[index].iter().cycle();
            let domain = &domains[index % 2];
            Tube::from_function(domain.clone(), |_| *set.next().unwrap())
        });
        let within = time & x.domain().span();
        let input = Tube::constant(domains[0].clone(), other);
        let contractors: [Contract<'_>; 13] = [
            ("order", &|[x, _, z]| contract_order(x, z)),
            ("equality", &|[x, _, z]| contract_equality(x, z)),
            ("delay", &|[x, y, _]| contract_delay(x, y, known_s)),
            ("uncertain delay", &|[x, y, _]| Ok(contract_uncertain_delay(x, y, &mut time.clone()))),
            ("period", &|[x, ..]| x.contract_period(known_s)),
            ("axial symmetry", &|[x, ..]| x.contract_axial_symmetry(known_s)),
            ("central symmetry", &|[x, ..]| x.contract_central_symmetry(known_s, other)),
            ("derivative", &|[x, _, z]| x.contract_derivative_around(z, time)),
            ("evaluation", &|[x, ..]| x.contract_evaluation(&mut time.clone(), &mut other.clone())),
            ("evaluation with derivative", &|[x, _, z]| {
                x.contract_evaluation_with_derivative(z, &mut within.clone(), &mut other.clone())
            }),
            ("composition", &|[x, y, z]| contract_composition(y, x, z)),
            ("inverse", &|[x, y, _]| contract_inverse(x, y)),
            ("chain", &|[x, _, z]| contract_chain(x, z, &input, 3, |x, u| x * u)),
        ];
        let before = [x, y, z];
        for (name, contract) in contractors {
            let mut after = before.clone();
            let outcome = contract(&mut after);
            for index in 0..3 {
                prop_assert!(is_sound(&before[index], &after[index]), "{} on tube {}", name, index);
                prop_assert!(!before[index].is_empty() || after[index].is_empty(), "{} revived a tube", name);
            }
            match outcome {
                Ok(Contracted::Empty) => prop_assert!(after.iter().any(Tube::is_empty), "{} left something", name),
                Ok(Contracted::Narrowed) => prop_assert!(name.contains("evaluation") || name.contains("delay") || before != after, "{} did nothing", name),
                Ok(Contracted::Unchanged) | Err(_) => prop_assert_eq!(&before, &after, "{} is silent", name),
            }
        }
    }
}

/// What contracts some of three tubes, of which the first and the last are cut at the same times.
type Contract<'a> = (&'a str, &'a dyn Fn(&mut [Tube<Interval>; 3]) -> Result<Contracted, TubeError>);

/// Sets as they are and as nobody wants them.
fn any_set() -> impl Strategy<Value = Interval> {
    prop_oneof![
        8 => (-5.0..5.0_f64, 0.0..5.0_f64).prop_map(|(mid, radius)| Interval::centred(mid, radius)),
        1 => Just(Interval::EMPTY),
        2 => Just(Interval::ENTIRE),
        2 => Just(Interval::NON_NEGATIVE),
        2 => (any::<f64>(), any::<f64>()).prop_map(|(one, other)| Interval::spanning(one, other)),
    ]
}
