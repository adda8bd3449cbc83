//! Trajectories that are known, ways to cut time, and tubes that hold the trajectories but not much else.

use proptest::prelude::*;
use shoal_interval::Interval;
use shoal_tube::{TimeDomain, Tube};

/// The trajectory `offset + slope t + curvature t² + amplitude sin(rate t + phase)`.
#[derive(Debug, Clone, Copy)]
pub struct Trajectory {
    pub offset: f64,
    pub slope: f64,
    pub curvature: f64,
    pub amplitude: f64,
    pub rate: f64,
    pub phase: f64,
}

impl Trajectory {
    pub fn value(&self, time: Interval) -> Interval {
        (time * self.rate + self.phase).sin() * self.amplitude
            + time.sqr() * self.curvature
            + time * self.slope
            + self.offset
    }

    pub fn derivative(&self, time: Interval) -> Interval {
        (time * self.rate + self.phase).cos() * self.rate * self.amplitude
            + time * (2.0 * self.curvature)
            + self.slope
    }

    /// The value at one time, up to rounding.
    pub fn at(&self, time: f64) -> Interval {
        self.value(Interval::spanning(time, time))
    }
}

prop_compose! {
    pub fn trajectory()(
        offset in -10.0..10.0_f64, slope in -3.0..3.0_f64, curvature in -0.3..0.3_f64,
        amplitude in -5.0..5.0_f64, rate in 0.0..4.0_f64, phase in -4.0..4.0_f64,
    ) -> Trajectory {
        Trajectory { offset, slope, curvature, amplitude, rate, phase }
    }
}

/// Uniform or not, exact in binary or not, with very short slices among long ones.
pub fn domain() -> impl Strategy<Value = TimeDomain> {
    let step = || prop_oneof![Just(0.1), Just(0.25), 1.0e-6..0.01_f64, 0.01..0.5_f64];
    let start = prop_oneof![Just(0.0), Just(-2.0), -3.0..1.0_f64];
    let listed = (start.clone(), prop::collection::vec(step(), 1..32)).prop_map(|(start, steps)| {
        let ends = steps.iter().scan(start, |end, step| {
            *end += step;
            Some(*end)
        });
        TimeDomain::new(std::iter::once(start).chain(ends)).unwrap()
    });
    let uniform = (start, prop_oneof![Just(0.1), Just(0.125), 0.01..0.3_f64], 1..40_usize)
        .prop_map(|(start, step, count)| TimeDomain::uniform(start, step, count).unwrap());
    prop_oneof![listed, uniform]
}

/// By how much slices and gates are wider than the truth; the first is for the first slice, and so on around.
pub fn radii() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(prop_oneof![Just(0.0), Just(1.0e-6), 0.001..0.3_f64, 0.3..10.0_f64], 1..6)
}

/// A tube that holds the trajectory of which `value` is an inclusion function.
pub fn around(
    domain: &TimeDomain,
    radii: &[f64],
    scale: f64,
    value: impl Fn(Interval) -> Interval,
) -> Tube<Interval> {
    let mut radius = radii.iter().cycle();
    Tube::from_function(domain.clone(), |time| value(time).inflate(scale * radius.next().unwrap()))
}

/// The time at this share of the domain.
pub fn time_in(domain: &TimeDomain, share: f64) -> f64 {
    (domain.start_s() + share * (domain.end_s() - domain.start_s())).clamp(domain.start_s(), domain.end_s())
}

/// Whether the tube holds the trajectory, as far as samples in every slice tell; the truth is known only up to rounding.
pub fn holds(tube: &Tube<Interval>, value: impl Fn(Interval) -> Interval) -> bool {
    let domain = tube.domain();
    let sampled = |set: Interval, time: f64| !(set & value(Interval::spanning(time, time))).is_empty();
    let gates = domain.borders_s().zip(tube.gates()).all(|(border, gate)| sampled(gate, border));
    gates
        && tube.slices().enumerate().all(|(index, slice)| {
            let span = domain.slice_span(index).unwrap();
            [0.0, 0.1, 0.37, 0.5, 0.8, 1.0].iter().all(|share| {
                let time = span.lower() + share * (span.upper() - span.lower());
                sampled(slice, time.clamp(span.lower(), span.upper()))
            })
        })
}

/// Whether a contracted tube is inside what it was, cut as before, with gates in slices and true summaries.
pub fn is_sound(before: &Tube<Interval>, after: &Tube<Interval>) -> bool {
    let hull = after.slices().fold(Interval::EMPTY, |hull, slice| hull | slice);
    let gates_inside = (0..after.slice_count()).all(|index| {
        let slice = after.slice(index).unwrap();
        after.input_gate(index).unwrap().is_subset_of(slice)
            && after.output_gate(index).unwrap().is_subset_of(slice)
    });
    let remade = Tube::from_parts(after.domain().clone(), after.slices(), after.gates()).unwrap();
    let span = after.domain().span();
    before.domain() == after.domain()
        && after.is_subset_of(before) == Ok(true)
        && gates_inside
        && after.codomain() == hull
        && (after.is_empty()
            || after.integral(span.lower(), span.upper()) == remade.integral(span.lower(), span.upper()))
}
