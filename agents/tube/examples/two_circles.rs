//! Two vehicles on a circle, one ping: the example of seed 001, section 5.4.1, as printed and rigorously.
//!
//! Vehicle 1 starts at (10, 0) m and vehicle 2 at (-10, 0) m; both circle the origin at 10 m/s, and sound travels at
//! 100 m/s. Vehicle 1 pings when its clock shows 1.00 s, vehicle 2 hears it when its own clock shows 1.37 s.
//!
//! The printed numbers were made by rules that are **not** rigorous, and this example follows them to meet the numbers:
//! noise adds up in Euler steps of 0.01 s around the exact circle; a clock that shows `s` means a true time of
//! `s (1 ± n_h)`, which is not the inverse of `dh/dt = 1 ± n_h`; and the ping is noticed at the end of the step in which it
//! arrives, so 1.37 s stands for 1.36 s to 1.37 s. They give every digit that is printed before the ping, with the emission
//! rounded outwards as an enclosure must be. After the ping the bounds hang on digits of `b` that are not printed: from
//! 1.224 s come -1.86 m and -10.21 m, from 1.2219 s, within 0.02 m, the printed -1.25 m and -9.98 m; the new upper bound of
//! `b`, 1.2353 s, is printed cut off, as 1.23 s.
//!
//! Done rigorously the same clock reading contradicts the same bounds: the answer is the empty set. A clock of vehicle 2
//! inside its bounds shows at most 1.36 s when the ping arrives.
//!
//! Run with `cargo run -p shoal-tube --example two_circles`; the figure shows the reading that is possible.

use nalgebra::Vector2;
use pxfm::{f_cos, f_sin};
use shoal_interval::contractor::{Contracted, contract_range};
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::{Interval, IntervalBox};
use shoal_tube::figure::DrawTube;
use shoal_tube::{TimeDomain, Tube, TubeError};
use std::error::Error;

const RADIUS_M: f64 = 10.0;
const SOUND_SPEED_M_S: f64 = 100.0;
const EMISSION_SHOWN_S: f64 = 1.00;
const RECEPTION_SHOWN_S: f64 = 1.37;

/// One vehicle: on which side of the circle it starts, and how far its speed and its clock may be off.
#[derive(Clone, Copy)]
struct Vehicle {
    /// 1 when it starts at (10, 0) m, -1 when it starts at (-10, 0) m.
    side: f64,
    speed_noise_m_s: f64,
    clock_noise: f64,
}

const SENDER: Vehicle = Vehicle { side: 1.0, speed_noise_m_s: 0.1, clock_noise: 0.01 };
const RECEIVER: Vehicle = Vehicle { side: -1.0, speed_noise_m_s: 1.0, clock_noise: 0.1 };

/// Everything that the ping links.
#[derive(Debug, Clone, Copy)]
struct Ping {
    emission_s: Interval,
    emitter_m: IntervalBox<2>,
    reception_s: Interval,
    position_m: IntervalBox<2>,
}

impl Ping {
    /// Contracts with `‖p(b) - p(a)‖ = c (b - a)`; everything is empty when there is no solution.
    fn contracted(mut self) -> Ping {
        let mut sound_speed_m_s = Interval::spanning(SOUND_SPEED_M_S, SOUND_SPEED_M_S);
        let contracted = contract_range(
            &mut self.position_m,
            &mut self.emitter_m,
            &mut sound_speed_m_s,
            &mut self.reception_s,
            &mut self.emission_s,
        );
        assert_eq!(contracted == Contracted::Empty, self.reception_s.is_empty());
        self
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let printed = as_printed()?;
    println!("as printed, by rules that are not rigorous");
    print("before the ping", &printed);
    print("after the ping", &printed.contracted());

    let rigorous = rigorously(RECEPTION_SHOWN_S)?;
    println!("rigorously");
    print("before the ping", &rigorous);
    print("after the ping", &rigorous.contracted());
    println!(
        "    (a reading of 1.37 s contradicts the stated bounds, which allow 1.36 s at most: nothing is left)"
    );

    let honest = rigorously(1.30)?;
    println!("rigorously, had the clock shown 1.30 s");
    print("before the ping", &honest);
    let mut after = honest.contracted();
    // The receiver was where it was at the times that are left.
    after.position_m = after.position_m & position(RECEIVER)?.over(after.reception_s)?;
    print("after the ping", &after);
    draw(&honest, &after)?.save(figures_folder().join("001_5_4_1_two_circles.svg"))?;
    Ok(())
}

/// Where both vehicles were from the start on, and where at the ping.
fn draw(ping: &Ping, after: &Ping) -> Result<Figure, Box<dyn Error>> {
    let places = |ping: &Ping| [ping.emitter_m, ping.position_m];
    let mut figure = Figure::new(IntervalBox::from([Interval::centred(0.0, 14.0); 2]))?
        .title("Two vehicles, one ping")
        .trace(&position(SENDER)?, [0, 1], Class::Outside)
        .trace(&position(RECEIVER)?, [0, 1], Class::Outside)
        .boxes(&places(ping), Class::Boundary)
        .boxes(&places(after), Class::Level(0))
        .axes("x (m)", "y (m)");
    for side in [SENDER.side, RECEIVER.side] {
        let circle = |time_s| Vector2::new(f_cos(time_s), f_sin(time_s)) * (side * RADIUS_M);
        figure = figure.path(true_time()?.span(), circle);
    }
    Ok(figure
        .point(Vector2::new(RADIUS_M, 0.0), "sender")
        .point(Vector2::new(-RADIUS_M, 0.0), "receiver")
        .legend(Class::Outside, "tubes")
        .legend(Class::Boundary, "where they were at the ping")
        .legend(Class::Level(0), "contracted by it")
        .legend(Class::Curve, "truth"))
}

fn print(when: &str, ping: &Ping) {
    println!("  {when}");
    println!("    a {} s, p1 {} m", nearest(ping.emission_s), nearest_sides(ping.emitter_m));
    println!("    b {} s, p2 {} m", nearest(ping.reception_s), nearest_sides(ping.position_m));
}

/// The bounds with the digits of the seed, rounded to nearest as there; `{:.2}` of an interval rounds outwards.
fn nearest(interval: Interval) -> String {
    if interval.is_empty() {
        return "empty".to_owned();
    }
    format!("[{:.2}, {:.2}]", interval.lower(), interval.upper())
}

fn nearest_sides(position_m: IntervalBox<2>) -> String {
    if position_m.is_empty() {
        return "empty".to_owned();
    }
    position_m.sides().map(nearest).join(" x ")
}

/// What is known before the ping is used, by the rules of the seed.
fn as_printed() -> Result<Ping, TubeError> {
    let emission_s = euler::clock(SENDER)?.at(EMISSION_SHOWN_S)?;
    let step_s = Interval::spanning(RECEPTION_SHOWN_S - euler::STEP_S, RECEPTION_SHOWN_S);
    let reception_s = euler::clock(RECEIVER)?.at(step_s.mid())?;
    Ok(Ping {
        emission_s,
        emitter_m: euler::position(SENDER)?.over(emission_s)?,
        reception_s,
        position_m: euler::position(RECEIVER)?.over(reception_s)?,
    })
}

/// The seed's tubes: Euler's noise around exact circles, plain rounding.
mod euler {
    use super::*;

    pub const STEP_S: f64 = 0.01;
    const STEPS: usize = 160;

    /// True time as a function of the time that the clock shows.
    pub fn clock(vehicle: Vehicle) -> Result<Tube<Interval>, TubeError> {
        let noise = vehicle.clock_noise;
        let at = |shown_s: f64| Interval::spanning(shown_s * (1.0 - noise), shown_s * (1.0 + noise));
        from_steps(at, |start_s, end_s| at(start_s) | at(end_s))
    }

    /// Position as a function of true time.
    pub fn position(vehicle: Vehicle) -> Result<Tube<IntervalBox<2>>, TubeError> {
        let around = |start_s: f64, end_s: f64| {
            let noise_m = vehicle.speed_noise_m_s * end_s;
            let radius_m = vehicle.side * RADIUS_M;
            IntervalBox::from([
                Interval::spanning(radius_m * f_cos(start_s), radius_m * f_cos(end_s)).inflate(noise_m),
                Interval::spanning(radius_m * f_sin(start_s), radius_m * f_sin(end_s)).inflate(noise_m),
            ])
        };
        from_steps(|time_s| around(time_s, time_s), around)
    }

    fn from_steps<T: shoal_tube::Enclosure>(
        gate: impl Fn(f64) -> T,
        slice: impl Fn(f64, f64) -> T,
    ) -> Result<Tube<T>, TubeError> {
        let mut tube = Tube::starting_at(0.0, gate(0.0))?;
        for step in 0..STEPS {
            let (start_s, end_s) = (step as f64 * STEP_S, (step + 1) as f64 * STEP_S);
            tube.append(end_s, slice(start_s, end_s), gate(end_s))?;
        }
        Ok(tube)
    }
}

/// What is known before the ping is used, without losing anything to rounding, to steps, or to the inverse of a clock.
fn rigorously(reception_shown_s: f64) -> Result<Ping, TubeError> {
    let shown = |time_s: f64| Interval::spanning(time_s, time_s);
    let emission_s = clock(SENDER)?.invert(shown(EMISSION_SHOWN_S));
    let reception_s = clock(RECEIVER)?.invert(shown(reception_shown_s));
    Ok(Ping {
        emission_s,
        emitter_m: position(SENDER)?.over(emission_s)?,
        reception_s,
        position_m: position(RECEIVER)?.over(reception_s)?,
    })
}

fn true_time() -> Result<TimeDomain, TubeError> {
    TimeDomain::uniform(0.0, 0.001, 1600)
}

/// What the clock shows as a function of true time: the integral of `1 ± n_h` (5.6).
fn clock(vehicle: Vehicle) -> Result<Tube<Interval>, TubeError> {
    let rate = Interval::centred(1.0, vehicle.clock_noise);
    Ok(Tube::primitive(&Tube::constant(true_time()?, rate), Interval::ZERO))
}

/// Position as a function of true time: the integral of the velocity and its noise (5.5).
fn position(vehicle: Vehicle) -> Result<Tube<IntervalBox<2>>, TubeError> {
    let radius_m = vehicle.side * RADIUS_M;
    let velocity_m_s = Tube::from_function(true_time()?, |time_s| {
        let (sin, cos) = time_s.sin_cos();
        IntervalBox::from([sin * -radius_m, cos * radius_m]).inflate(vehicle.speed_noise_m_s)
    });
    let start_m = IntervalBox::from([Interval::spanning(radius_m, radius_m), Interval::ZERO]);
    Ok(Tube::primitive(&velocity_m_s, start_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both bounds, each within `tolerance` of what is printed.
    fn near(interval: Interval, printed: [f64; 2], tolerance: f64) -> bool {
        (interval.lower() - printed[0]).abs() <= tolerance
            && (interval.upper() - printed[1]).abs() <= tolerance
    }

    /// With two digits, rounded outwards, as an enclosure must be to remain one.
    fn printed_outwards(interval: Interval) -> [f64; 2] {
        // What is a hundredth but for the last bits stays one.
        let hundredths = |value: f64, nudge: f64| (value + nudge) * 100.0;
        [
            hundredths(interval.lower(), 1e-9).floor() / 100.0,
            hundredths(interval.upper(), -1e-9).ceil() / 100.0,
        ]
    }

    #[test]
    fn the_printed_numbers_before_the_ping() {
        let ping = as_printed().unwrap();
        let half_a_digit = 0.005;
        assert_eq!(printed_outwards(ping.emission_s), [0.99, 1.01]);
        assert_eq!(printed_outwards(ping.emitter_m[0]), [5.21, 5.59]);
        assert_eq!(printed_outwards(ping.emitter_m[1]), [8.26, 8.57]);
        assert!(near(ping.reception_s, [1.22, 1.51], half_a_digit));
        assert!(near(ping.position_m[0], [-4.67, 0.90], half_a_digit));
        assert!(near(ping.position_m[1], [-11.49, -8.16], half_a_digit));
    }

    #[test]
    fn the_printed_numbers_after_the_ping() {
        let after = as_printed().unwrap().contracted();
        assert!(near(after.reception_s, [1.22, 1.23], 0.006));
        assert!(near(after.position_m[0], [-4.67, -1.86], 0.005));
        assert!(near(after.position_m[1], [-11.49, -10.21], 0.005));

        let mut unrounded = as_printed().unwrap();
        unrounded.reception_s = Interval::spanning(1.2219, unrounded.reception_s.upper());
        let after = unrounded.contracted();
        assert!(near(after.position_m[0], [-4.67, -1.25], 0.02));
        assert!(near(after.position_m[1], [-11.49, -9.98], 0.02));
    }

    #[test]
    fn the_printed_measurement_contradicts_the_printed_bounds() {
        let ping = rigorously(RECEPTION_SHOWN_S).unwrap();
        assert!(Interval::spanning(1.37 / 1.1, 1.37 / 0.9).is_subset_of(ping.reception_s));
        assert!(near(ping.reception_s, [1.2455, 1.5223], 0.002));
        let after = ping.contracted();
        assert!(after.reception_s.is_empty() && after.position_m.is_empty());
        assert!(!rigorously(1.34).unwrap().contracted().reception_s.is_empty());
    }

    #[test]
    fn the_truth_stays_whatever_the_clock_shows_within_its_bounds() {
        // On exact circles `20 cos((b - a) / 2) = 100 (b - a)`, with the emission at a = 1 s.
        let flight_s = (0..50).fold(0.2, |flight_s, _| 0.2 * f_cos(flight_s / 2.0));
        let reception_s = EMISSION_SHOWN_S + flight_s;
        for rate in [0.9, 0.95, 1.0, 1.05, 1.1] {
            let before = rigorously(rate * reception_s).unwrap();
            let after = before.contracted();
            assert!(after.emission_s.contains(EMISSION_SHOWN_S) && after.reception_s.contains(reception_s));
            let circle = |time_s| Vector2::new(RADIUS_M * f_cos(time_s), RADIUS_M * f_sin(time_s));
            assert!(after.emitter_m.contains(&circle(EMISSION_SHOWN_S)));
            assert!(after.position_m.contains(&-circle(reception_s)));
            assert!(after.position_m.is_subset_of(&before.position_m));
        }
    }
}
