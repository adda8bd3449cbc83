//! Whatever happened to a tube before, every answer is the one that a look at each slice gives.

mod cases;

use cases::cases;
use proptest::prelude::*;
use shoal_interval::Interval;
use shoal_tube::{Direction, Place, TimeDomain, Tube};

/// A tube without any memory of blocks: lists, looked at from one end to the other.
#[derive(Debug, Clone)]
struct Naive {
    borders: Vec<f64>,
    slices: Vec<Interval>,
    gates: Vec<Interval>,
}

/// What can happen to a tube.
#[derive(Debug, Clone)]
enum Change {
    Append { step: f64, slice: Interval, gate: Interval },
    AppendMany { step: f64, count: usize, slice: Interval },
    Drop(usize),
    ContractGate { share: f64, value: Interval },
    ContractSlice { share: f64, value: Interval },
    ContractSliceDerivative { share: f64, slope: Interval, direction: Direction },
    ContractDerivative { slope: Interval, direction: Direction },
    Refine(f64),
}

impl Naive {
    fn of(tube: &Tube<Interval>) -> Naive {
        Naive {
            borders: tube.domain().borders_s().collect(),
            slices: tube.slices().collect(),
            gates: tube.gates().collect(),
        }
    }

    fn span(&self, index: usize) -> Interval {
        Interval::spanning(self.borders[index], self.borders[index + 1])
    }

    fn duration(&self, index: usize) -> Interval {
        Interval::spanning(self.borders[index + 1], self.borders[index + 1]) - self.borders[index]
    }

    fn index(&self, share: f64, count: usize) -> usize {
        ((share * count as f64) as usize).min(count - 1)
    }

    fn append(&mut self, end: f64, slice: Interval, gate: Interval) {
        let last = self.gates.len() - 1;
        self.gates[last] = self.gates[last] & slice;
        self.borders.push(end);
        self.slices.push(slice);
        self.gates.push(gate & slice);
    }

    fn contract_slice(&mut self, index: usize, value: Interval) {
        self.slices[index] = self.slices[index] & value;
        for gate in [index, index + 1] {
            self.gates[gate] = self.gates[gate] & self.slices[index];
        }
    }

    fn carry(&mut self, index: usize, slope: Interval, direction: Direction) {
        let (duration, from_zero) = (self.duration(index), self.duration(index) | Interval::ZERO);
        if direction != Direction::Backward {
            let input = self.gates[index];
            self.gates[index + 1] = self.gates[index + 1] & (input + slope * duration);
            self.contract_slice(index, input + slope * from_zero);
        }
        if direction != Direction::Forward {
            let output = self.gates[index + 1];
            self.gates[index] = self.gates[index] & (output - slope * duration);
            self.contract_slice(index, output - slope * from_zero);
        }
    }

    fn at(&self, time: f64) -> Interval {
        match self.borders.iter().position(|&border| border == time) {
            Some(gate) => self.gates[gate],
            None => self.slices[self.borders.iter().position(|&border| border > time).unwrap() - 1],
        }
    }

    /// The slices that share more than an end with some times.
    fn touched(&self, times: Interval) -> impl Iterator<Item = usize> + '_ {
        (0..self.slices.len()).filter(move |&index| {
            let common = self.span(index) & times;
            !common.is_empty() && !common.is_point()
        })
    }

    fn over(&self, times: Interval) -> Interval {
        if times.is_point() {
            return self.at(times.lower());
        }
        self.touched(times).fold(Interval::EMPTY, |hull, index| hull | self.slices[index])
    }

    fn invert_components(&self, values: Interval, within: Interval) -> Vec<Interval> {
        if within.is_point() {
            let meets = !(self.at(within.lower()) & values).is_empty();
            return if meets { vec![within] } else { vec![] };
        }
        let mut components: Vec<Interval> = Vec::new();
        for index in self.touched(within) {
            if (self.slices[index] & values).is_empty() {
                continue;
            }
            let times = self.span(index) & within;
            match components.last_mut() {
                Some(last) if last.upper() == times.lower() => *last = *last | times,
                _ => components.push(times),
            }
        }
        components
    }

    fn integral(&self, from: f64, to: f64) -> Interval {
        let times = Interval::spanning(from, to);
        self.touched(times).fold(Interval::ZERO, |sum, index| {
            let part = self.span(index) & times;
            sum + self.slices[index] * (Interval::spanning(part.upper(), part.upper()) - part.lower())
        })
    }

    /// The hull over the times at which the bounds of an integral turn, for times in order.
    fn integral_between(&self, from: Interval, to: Interval) -> Interval {
        let turns = |times: Interval| {
            let inside = self.borders.iter().copied().filter(move |&border| times.contains(border));
            [times.lower(), times.upper()].into_iter().chain(inside)
        };
        let mut hull = Interval::EMPTY;
        for one in turns(from) {
            for other in turns(to) {
                hull = hull | self.integral(one, other);
            }
        }
        hull
    }
}

fn change(tube: &mut Tube<Interval>, naive: &mut Naive, change: Change) {
    match change {
        Change::Append { step, slice, gate } => {
            let end = tube.domain().end_s() + step;
            tube.append(end, slice, gate).unwrap();
            naive.append(end, slice, gate);
        }
        Change::AppendMany { step, count, slice } => {
            let start = tube.domain().end_s();
            for index in 1..=count {
                let (end, slice) = (start + index as f64 * step, slice + 0.01 * index as f64);
                tube.append(end, slice, Interval::ENTIRE).unwrap();
                naive.append(end, slice, Interval::ENTIRE);
            }
        }
        Change::Drop(count) => {
            tube.drop_front(count);
            let count = count.min(naive.slices.len());
            naive.borders.drain(..count);
            naive.slices.drain(..count);
            naive.gates.drain(..count);
        }
        Change::ContractGate { share, value } => {
            let index = naive.index(share, naive.gates.len());
            tube.contract_gate(index, &value).unwrap();
            naive.gates[index] = naive.gates[index] & value;
        }
        Change::ContractDerivative { slope, direction } => {
            tube.contract_derivative(&Tube::constant(tube.domain().clone(), slope), direction).unwrap();
            if direction != Direction::Backward {
                (0..naive.slices.len()).for_each(|index| naive.carry(index, slope, Direction::Forward));
            }
            if direction != Direction::Forward {
                (0..naive.slices.len())
                    .rev()
                    .for_each(|index| naive.carry(index, slope, Direction::Backward));
            }
        }
        _ if naive.slices.is_empty() => {}
        Change::ContractSlice { share, value } => {
            let index = naive.index(share, naive.slices.len());
            tube.contract_slice(index, &value).unwrap();
            naive.contract_slice(index, value);
        }
        Change::ContractSliceDerivative { share, slope, direction } => {
            let index = naive.index(share, naive.slices.len());
            tube.contract_slice_derivative(index, slope, direction).unwrap();
            naive.carry(index, slope, direction);
        }
        Change::Refine(share) => {
            let time = time_in(naive, share);
            tube.refine([time]).unwrap();
            if !naive.borders.contains(&time) {
                let after = naive.borders.iter().position(|&border| border > time).unwrap();
                let slice = naive.slices[after - 1];
                naive.borders.insert(after, time);
                naive.slices.insert(after, slice);
                naive.gates.insert(after, slice);
            }
        }
    }
}

fn time_in(naive: &Naive, share: f64) -> f64 {
    let (start, end) = (naive.borders[0], naive.borders[naive.borders.len() - 1]);
    // Half of the times are borders.
    let index = (share * 2.0 * naive.borders.len() as f64) as usize;
    naive
        .borders
        .get(index)
        .copied()
        .unwrap_or_else(|| (start + (2.0 * share - 1.0) * (end - start)).clamp(start, end))
}

fn values() -> impl Strategy<Value = Interval> {
    prop_oneof![
        6 => (-5.0..5.0_f64, 0.0..8.0_f64).prop_map(|(mid, radius)| Interval::centred(mid, radius)),
        2 => (-9.0..9.0_f64).prop_map(|value| Interval::spanning(value, value)),
        2 => Just(Interval::ENTIRE),
        1 => (-5.0..5.0_f64).prop_map(|value| Interval::NON_NEGATIVE + value),
    ]
}

fn directions() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::Forward), Just(Direction::Backward), Just(Direction::Both)]
}

fn changes() -> impl Strategy<Value = Change> {
    let step = || prop_oneof![Just(0.25), 0.001..2.0_f64];
    let wide = || (-5.0..5.0_f64, 4.0..20.0_f64).prop_map(|(mid, radius)| Interval::centred(mid, radius));
    let any_slice =
        || (-9.0..9.0_f64, 1.0..12.0_f64).prop_map(|(mid, radius)| Interval::centred(mid, radius));
    prop_oneof![
        2 => (step(), values(), values()).prop_map(|(step, slice, gate)| Change::Append { step, slice, gate }),
        3 => (step(), 1..90_usize, any_slice()).prop_map(|(step, count, slice)| Change::AppendMany { step, count, slice }),
        2 => (0..70_usize).prop_map(Change::Drop),
        3 => (0.0..1.0_f64, wide()).prop_map(|(share, value)| Change::ContractGate { share, value }),
        3 => (0.0..1.0_f64, wide()).prop_map(|(share, value)| Change::ContractSlice { share, value }),
        1 => (0.0..1.0_f64, values()).prop_map(|(share, value)| Change::ContractSlice { share, value }),
        2 => (0.0..1.0_f64, wide(), directions())
            .prop_map(|(share, slope, direction)| Change::ContractSliceDerivative { share, slope, direction }),
        2 => (wide(), directions()).prop_map(|(slope, direction)| Change::ContractDerivative { slope, direction }),
        1 => (0.0..1.0_f64).prop_map(Change::Refine),
    ]
}

/// Whether two sums of the same terms, rounded outwards in different orders, are as close as that lets them be.
fn nearly(one: Interval, other: Interval) -> bool {
    let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-11 * (1.0 + a.abs().max(b.abs()));
    near(one.lower(), other.lower()) && near(one.upper(), other.upper())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    #[test]
    fn after_any_changes(
        start in prop_oneof![Just(0.0), -100.0..100.0_f64],
        steps in prop::collection::vec(changes(), 1..12),
        shares in prop::collection::vec(0.0..=1.0_f64, 8),
        asked in prop::collection::vec(values(), 3),
    ) {
        let mut tube = Tube::starting_at(start, Interval::ENTIRE).unwrap();
        let mut naive = Naive::of(&tube);
        for step in steps {
            change(&mut tube, &mut naive, step);
        }
        prop_assert!(tube.domain().borders_s().eq(naive.borders.iter().copied()));
        prop_assert!(tube.slices().eq(naive.slices.iter().copied()));
        prop_assert!(tube.gates().eq(naive.gates.iter().copied()));
        for (index, slice) in naive.slices.iter().enumerate() {
            prop_assert!(naive.gates[index].is_subset_of(*slice) && naive.gates[index + 1].is_subset_of(*slice));
        }
        let empty = naive.slices.iter().chain(&naive.gates).any(|set| set.is_empty());
        prop_assert_eq!(tube.is_empty(), empty);
        prop_assert_eq!(tube.first_empty().is_some(), empty);
        if let Some(emptied) = tube.first_empty() {
            match emptied.place {
                Place::Gate(index) => {
                    prop_assert!(naive.gates[index].is_empty() && naive.borders[index] == emptied.times_s.mid());
                    prop_assert!(naive.gates[..index].iter().chain(&naive.slices[..index]).all(|set| !set.is_empty()));
                }
                Place::Slice(index) => prop_assert!(naive.slices[index].is_empty()),
            }
        }
        if !naive.slices.is_empty() {
            let hull = naive.slices.iter().fold(Interval::EMPTY, |hull, &slice| hull | slice);
            prop_assert_eq!(tube.codomain(), hull);
        }

        let times: Vec<f64> = shares.iter().map(|&share| time_in(&naive, share)).collect();
        for &time in &times {
            prop_assert_eq!(tube.at(time), Ok(naive.at(time)));
        }
        let spans: Vec<Interval> = times.windows(2).map(|pair| Interval::spanning(pair[0], pair[1])).collect();
        for &span in &spans {
            prop_assert_eq!(tube.over(span), Ok(naive.over(span)));
            for &values in &asked {
                let components = naive.invert_components(values, span);
                let hull = components.iter().fold(Interval::EMPTY, |hull, &times| hull | times);
                prop_assert_eq!(tube.invert_within(values, span), hull);
                prop_assert_eq!(tube.invert_components_within(values, span), components);
            }
            let (from, to) = (span.lower(), span.upper());
            let (integral, naive_integral) = (tube.integral(from, to).unwrap(), naive.integral(from, to));
            prop_assert!(nearly(integral, naive_integral), "{} {}", integral, naive_integral);
            prop_assert_eq!(tube.integral(to, from).unwrap(), -integral);
        }
        let mut sorted = times.clone();
        sorted.sort_by(f64::total_cmp);
        let (from, to) = (Interval::spanning(sorted[0], sorted[2]), Interval::spanning(sorted[5], sorted[7]));
        let naive_integral = naive.integral_between(from, to);
        if !naive.integral(sorted[0], sorted[7]).is_empty() {
            let integral = tube.integral_between(from, to).unwrap();
            prop_assert!(nearly(integral, naive_integral), "{} {}", integral, naive_integral);
            prop_assert_eq!(tube.integral_between(to, from).unwrap(), -integral);
        }
        // Made anew from its parts, the tube gives the same answers, up to the order in which integrals are summed.
        let anew = Tube::from_parts(tube.domain().clone(), tube.slices(), tube.gates()).unwrap();
        prop_assert_eq!(&anew, &tube);
        prop_assert_eq!(anew.over(spans[0]), tube.over(spans[0]));
    }
}

#[test]
fn memory_is_bounded_by_the_horizon() {
    let mut tube = Tube::starting_at(0.0, Interval::ZERO).unwrap();
    let mut largest_bytes = [0; 2];
    for tick in 1..=100_000_u32 {
        let end = f64::from(tick) * 0.1;
        tube.append(end, Interval::spanning(0.0, end), Interval::ENTIRE).unwrap();
        tube.drop_before(end - 10.0);
        assert!(tube.slice_count() <= 101);
        let late = usize::from(tick > 10_000);
        largest_bytes[late] = tube.memory_bytes().max(largest_bytes[late]);
    }
    assert!(largest_bytes[1] <= largest_bytes[0] && largest_bytes[0] < 10_000, "{largest_bytes:?}");
}

#[test]
fn a_scalar_slice_takes_less_than_64_bytes() {
    let listed = TimeDomain::new((0..=100_000).map(|index| f64::from(index) * 0.01)).unwrap();
    for tube in [Tube::constant(listed, Interval::ONE), {
        let mut tube = Tube::starting_at(0.0, Interval::ONE).unwrap();
        for index in 1..=100_001 {
            tube.append(f64::from(index) * 0.01, Interval::ONE, Interval::ONE).unwrap();
        }
        tube
    }] {
        assert!(tube.memory_bytes() < 64 * tube.slice_count(), "{}", tube.memory_bytes());
    }
}
