//! A mass on a spring that hears its own echo: the example of seed 001, section 4.3.2, without initial conditions.
//!
//! The mass pings each second; the sound, at 100 m/s, comes back from a wall at 100 m while the mass moves on. Each ping
//! links two positions: `x(t1) + x(t2) = 2 L - c (t2 - t1)`, to 0.05 m, and some pings are lost. Nothing is known of the start.
//!
//! What differs from the seed: integration is guaranteed in place of Euler's method, so the tube is a proof and holds
//! the truth at all times; receptions need not be at a multiple of 0.01 s, because the tube is cut there too; and the box in
//! which the mass is looked for at `k0` is `[-100, 100] x [-100, 100]` for every `k0 > 0`. The seed looks in
//! `[0, 100] x [-100, 100]` at all times, but the mass swings through its rest position at zero: at 5 s it is at -7.1 m.
//! One thing more is assumed: the mass is never faster than 20 m/s. At 100 m/s it would swing by 24 m four times in 5 s, and
//! the guaranteed steps would have to be far shorter than 0.01 s to follow it.
//!
//! Run with `cargo run --release -p shoal-tube --example mass_spring_sonar`; the figures are those of 4.8 and 4.9.

use nalgebra::Vector2;
use shoal_interval::contractor::Contracted;
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::{Interval, IntervalBox, IntervalMatrix};
use shoal_tube::estimation::{EstimationError, Search, Strangled, System, from_contraction};
use shoal_tube::figure::{DrawTube, over_time};
use shoal_tube::integration::Evolution;
use shoal_tube::{Place, TimeDomain, Tube, TubeError};
use std::time::Instant;

const MASS_KG: f64 = 8.0;
const DAMPING: f64 = 1.0;
const ELASTICITY: f64 = 2.0;
const STIFFNESS: f64 = -0.5;
const WALL_M: f64 = 100.0;
const SOUND_SPEED_M_S: f64 = 100.0;
const RANGE_ERROR_M: f64 = 0.05;

/// Position and speed at the start, which the estimator is not told.
const START: Vector2<f64> = Vector2::new(10.0, 0.0);

/// Where the mass is looked for at any time: between the walls, and slower than sound.
const ANYWHERE: f64 = 100.0;

/// No spring is stretched so far that the mass becomes faster than this.
const FASTEST_M_S: f64 = 20.0;

type States = Tube<IntervalBox<2>>;

/// One ping that came back.
#[derive(Debug, Clone, Copy)]
struct Ping {
    emission_s: f64,
    reception_s: f64,
    /// Holds `x(emission) + x(reception)`.
    sum_m: Interval,
}

/// The truth: position and speed every millisecond, until the last echo is back.
struct Swing {
    states: Vec<Vector2<f64>>,
}

impl Swing {
    const STEP_S: f64 = 1e-3;

    fn new(duration_s: f64) -> Swing {
        let mut states = vec![START];
        for _ in 0..((duration_s + 5.0) / Swing::STEP_S) as usize {
            states.push(runge_kutta(&states[states.len() - 1], Swing::STEP_S));
        }
        Swing { states }
    }

    /// The state at any time, by a shorter step from the one before.
    fn at(&self, time_s: f64) -> Vector2<f64> {
        let before = (time_s / Swing::STEP_S) as usize;
        runge_kutta(&self.states[before], time_s - before as f64 * Swing::STEP_S)
    }

    /// When the echo of a ping comes back: the root of a function that rises with the time.
    fn reception_s(&self, emission_s: f64) -> f64 {
        let emitted_m = self.at(emission_s).x;
        let (mut early_s, mut late_s) = (emission_s, emission_s + 4.0 * WALL_M / SOUND_SPEED_M_S);
        for _ in 0..60 {
            let middle_s = 0.5 * (early_s + late_s);
            let way_m = 2.0 * WALL_M - emitted_m - self.at(middle_s).x;
            let heard = SOUND_SPEED_M_S * (middle_s - emission_s) >= way_m;
            if heard { late_s = middle_s } else { early_s = middle_s }
        }
        late_s
    }
}

/// One step of fourth order.
fn runge_kutta(state: &Vector2<f64>, step_s: f64) -> Vector2<f64> {
    let field = |s: Vector2<f64>| {
        let force = (STIFFNESS * s.x * s.x - ELASTICITY) * s.x - DAMPING * s.y;
        Vector2::new(s.y, force / MASS_KG)
    };
    let k1 = field(*state);
    let k2 = field(state + k1 * (0.5 * step_s));
    let k3 = field(state + k2 * (0.5 * step_s));
    let k4 = field(state + k3 * step_s);
    state + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (step_s / 6.0)
}

/// Seed 001, equation (4.35).
#[derive(Debug, Clone, Copy)]
struct Spring;

impl Spring {
    /// The derivative of the acceleration by the position.
    fn slope(position_m: Interval) -> Interval {
        (position_m.sqr() * (3.0 * STIFFNESS) - ELASTICITY) / MASS_KG
    }

    fn acceleration(state: &IntervalBox<2>) -> Interval {
        let [x, v] = state.sides();
        // Each term falls with its variable, so nothing is lost to dependency but where the position changes its sign.
        (x.sqr() * x * STIFFNESS - x * ELASTICITY - v * DAMPING) / MASS_KG
    }
}

impl Evolution<2> for Spring {
    fn velocity(&self, _times_s: Interval, state: &IntervalBox<2>) -> IntervalBox<2> {
        IntervalBox::from([state[1], Spring::acceleration(state)])
    }

    fn jacobian(&self, _times_s: Interval, state: &IntervalBox<2>) -> Option<IntervalMatrix<2, 2>> {
        let by_speed = Interval::spanning(DAMPING, DAMPING) / -MASS_KG;
        Some(IntervalMatrix::from([[Interval::ZERO, Interval::ONE], [Spring::slope(state[0]), by_speed]]))
    }

    fn acceleration(&self, _times_s: Interval, state: &IntervalBox<2>) -> Option<IntervalBox<2>> {
        let acceleration = Spring::acceleration(state);
        let jerk = Spring::slope(state[0]) * state[1] - acceleration * (DAMPING / MASS_KG);
        Some(IntervalBox::from([acceleration, jerk]))
    }

    fn jacobian_rate(&self, _times_s: Interval, state: &IntervalBox<2>) -> Option<IntervalMatrix<2, 2>> {
        let rate = state[0] * state[1] * (6.0 * STIFFNESS / MASS_KG);
        Some(IntervalMatrix::from([[Interval::ZERO; 2], [rate, Interval::ZERO]]))
    }
}

/// The pings that came back before `duration_s`: one each second, every seventh lost, with errors up to the bound.
fn pings(swing: &Swing, duration_s: f64) -> Vec<Ping> {
    let mut random = 12_345_u32;
    let mut pings = Vec::new();
    for second in 0..duration_s as u32 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let emission_s = f64::from(second);
        let reception_s = swing.reception_s(emission_s);
        if second % 7 == 3 || reception_s >= duration_s {
            continue;
        }
        let error_m = (f64::from(random) / f64::from(u32::MAX) * 2.0 - 1.0) * (0.999 * RANGE_ERROR_M);
        let sum_m = 2.0 * WALL_M - SOUND_SPEED_M_S * (reception_s - emission_s) + error_m;
        pings.push(Ping { emission_s, reception_s, sum_m: Interval::centred(sum_m, RANGE_ERROR_M) });
    }
    pings
}

/// Contracts the positions at both ends of a ping: the sum is measured, the difference is the way gone between.
///
/// Source: seed 001, equations (4.43) and (4.44).
fn contract_ping(states: &mut States, ping: &Ping) -> Result<Contracted, TubeError> {
    let (emission, reception) = (gate_at(states, ping.emission_s)?, gate_at(states, ping.reception_s)?);
    let way_m = states.integral(ping.emission_s, ping.reception_s)?[1];
    let (from_m, to_m) = (states.at(ping.emission_s)?[0], states.at(ping.reception_s)?[0]);
    let from_m = from_m & (ping.sum_m - to_m) & ((ping.sum_m - way_m) * 0.5);
    let to_m = to_m & (ping.sum_m - from_m) & ((ping.sum_m + way_m) * 0.5);
    let of_emission = states.contract_gate(emission, &IntervalBox::from([from_m, Interval::ENTIRE]))?;
    let of_reception = states.contract_gate(reception, &IntervalBox::from([to_m, Interval::ENTIRE]))?;
    Ok(match (of_emission, of_reception) {
        (Contracted::Empty, _) | (_, Contracted::Empty) => Contracted::Empty,
        (Contracted::Unchanged, Contracted::Unchanged) => Contracted::Unchanged,
        _ => Contracted::Narrowed,
    })
}

/// The gate at a time at which the domain is cut.
fn gate_at(states: &States, time_s: f64) -> Result<usize, TubeError> {
    match states.domain().place_of(time_s)? {
        Place::Gate(index) | Place::Slice(index) => Ok(index),
    }
}

/// The spring and its pings.
fn system(pings: &[Ping]) -> System<'static, 2, Spring> {
    let mut system = System::new(Spring);
    for &ping in pings {
        let times_s = Interval::spanning(ping.emission_s, ping.reception_s);
        system = system
            .observed(from_contraction(times_s, move |states: &mut States| contract_ping(states, &ping)));
    }
    system
}

/// What is known before the first estimation: slices of 0.01 s, cut at emissions and receptions too.
fn unknown(pings: &[Ping], duration_s: f64) -> Result<States, TubeError> {
    let slices = (duration_s / 0.01).round() as usize;
    let cuts_s = pings.iter().flat_map(|ping| [ping.emission_s, ping.reception_s]);
    let time = TimeDomain::uniform(0.0, 0.01, slices)?.refined(cuts_s)?;
    Ok(Tube::constant(time, anywhere()))
}

fn anywhere() -> IntervalBox<2> {
    IntervalBox::from([
        Interval::spanning(-ANYWHERE, ANYWHERE),
        Interval::spanning(-FASTEST_M_S, FASTEST_M_S),
    ])
}

/// STRANGLE2 at `k0` seconds.
fn strangle(
    system: &System<'static, 2, Spring>,
    states: &mut States,
    k0_s: f64,
) -> Result<Strangled<2>, EstimationError> {
    let gate = gate_at(states, k0_s)?;
    let mut initial = anywhere();
    if k0_s == 0.0 {
        initial[0] = Interval::spanning(0.0, ANYWHERE);
    }
    system.strangle(states, gate, initial, &Search::new([0.25, 0.5]))
}

/// Whether the truth is in the tube at every millisecond.
fn holds(states: &States, swing: &Swing) -> Result<bool, TubeError> {
    for (index, state) in swing.states.iter().enumerate() {
        let time_s = index as f64 * Swing::STEP_S;
        if time_s <= states.domain().end_s() && !states.at(time_s)?.contains(state) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The mean and the largest width of the slices on one axis.
fn widths(states: &States, axis: usize) -> (f64, f64) {
    let widths = states.slices().map(|slice| slice[axis].width());
    let (sum, largest) =
        widths.fold((0.0, 0.0_f64), |(sum, largest), width| (sum + width, largest.max(width)));
    (sum / states.slice_count() as f64, largest)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let duration_s = 60.0;
    let swing = Swing::new(duration_s);
    let pings = pings(&swing, duration_s);
    let system = system(&pings);
    let mut states = unknown(&pings, duration_s)?;
    println!(
        "{} pings, {} slices, {} bytes a tube",
        pings.len(),
        states.slice_count(),
        states.memory_bytes()
    );

    let begin = Instant::now();
    let mut stages = vec![states.clone()];
    for k0_s in (0..=60).step_by(5).map(f64::from) {
        let strangled = strangle(&system, &mut states, k0_s)?;
        let ((x_m, x_most_m), (v_m_s, v_most_m_s)) = (widths(&states, 0), widths(&states, 1));
        println!(
            "k0 = {k0_s:2} s: {:5} contractions, {:4} boxes kept; widths x {x_m:.3} m (at most {x_most_m:.3}), \
             v {v_m_s:.3} m/s (at most {v_most_m_s:.3}); {:.2} s",
            strangled.contractions,
            strangled.kept.len(),
            begin.elapsed().as_secs_f64()
        );
        if let Some((letter, _)) = [("a", 0.0), ("b", 50.0)].into_iter().find(|&(_, at_s)| at_s == k0_s) {
            let figure = draw_boxes(&strangled, &swing.at(k0_s), k0_s)?;
            figure.save(figures_folder().join(format!("001_4_9{letter}_mass_spring_sonar.svg")))?;
        }
        if [0.0, 25.0, 60.0].contains(&k0_s) {
            stages.push(states.clone());
        }
    }
    println!("the start, in truth (10, 0): {:.3}", states.at(0.0)?);
    if !holds(&states, &swing)? {
        return Err("the tube has lost the truth".into());
    }
    println!("the truth is inside at all times (the seed: 2.5 s and 7 MB, without that proof)");
    for (axis, letter, quantity) in [(0, "p", "x (m)"), (1, "s", "v (m/s)")] {
        let figure = draw_stages(&stages, &swing, axis, quantity)?;
        figure.save(figures_folder().join(format!("001_4_8{letter}_mass_spring_sonar.svg")))?;
    }
    Ok(())
}

/// One axis of the tube before and after some estimations, all over each other.
fn draw_stages(
    stages: &[States],
    swing: &Swing,
    axis: usize,
    quantity: &str,
) -> Result<Figure, Box<dyn std::error::Error>> {
    let span_s = stages[0].domain().span();
    let largest = if axis == 0 { 20.0 } else { 12.0 };
    let mut figure = over_time(span_s, Interval::centred(0.0, largest))?
        .title("A mass on a spring and its echoes, without initial conditions");
    let captions = ["nothing estimated", "k0 = 0 s", "k0 = 0 to 25 s", "every fifth second"];
    for ((stage, caption), level) in stages.iter().zip(captions).zip([0, 2, 3, 4]) {
        figure =
            figure.tube(&stage.component(axis), Class::Level(level)).legend(Class::Level(level), caption);
    }
    Ok(figure
        .trajectory(span_s, |time_s| swing.at(time_s)[axis])
        .legend(Class::Curve, "truth")
        .axes("t (s)", quantity))
}

/// What STRANGLE2 has kept and rejected at `k0_s`, near the truth.
fn draw_boxes(
    strangled: &Strangled<2>,
    truth: &Vector2<f64>,
    k0_s: f64,
) -> Result<Figure, Box<dyn std::error::Error>> {
    let view = strangled.hull().inflate_axes(&Vector2::new(4.0, 4.0));
    Ok(Figure::new(view)?
        .title(&format!("States at {k0_s} s"))
        .boxes(&strangled.rejected, Class::Outside)
        .boxes(&strangled.kept, Class::Boundary)
        .point(*truth, "truth")
        .legend(Class::Outside, "no trajectory")
        .legend(Class::Boundary, "kept")
        .axes("x (m)", "v (m/s)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The whole problem, from nothing but the box that the seed begins with: it takes a while.
    #[test]
    fn the_start_is_found_and_the_truth_is_never_lost() {
        let duration_s = 60.0;
        let swing = Swing::new(duration_s);
        let pings = pings(&swing, duration_s);
        let system = system(&pings);
        let mut states = unknown(&pings, duration_s).unwrap();
        for k0_s in (0..=60).step_by(5).map(f64::from) {
            let strangled = strangle(&system, &mut states, k0_s).unwrap();
            assert!(strangled.hull().contains(&swing.at(k0_s)) && strangled.undecided.is_empty());
            assert!(holds(&states, &swing).unwrap());
        }
        assert!(states.at(0.0).unwrap()[0].width() < 2.0);
        assert!(widths(&states, 0).0 < 0.85 && widths(&states, 1).0 < 1.6);
    }

    #[test]
    fn the_seeds_box_does_not_hold_the_mass_after_five_seconds() {
        let swing = Swing::new(0.0);
        assert!((swing.at(5.0).x + 7.113952804).abs() < 1e-6);
    }
}
