//! Two resistors in series: what five laws of electricity leave of seven measurements.
//!
//! ```sh
//! cargo run --release -p shoal-interval --example circuit
//! ```
//!
//! Leaves `target/figures/003_6_5_circuit.svg`: where power, voltages and measurements agree in the plane of current and
//! voltage, in the box that was measured, around the box that was contracted.
//!
//! Source: seed 003, section 6.5.

use nalgebra::Vector2;
use shoal_interval::contractor::Contractor;
use shoal_interval::expression::Expression;
use shoal_interval::figure::{Figure, figures_folder};
use shoal_interval::paving::{Options, pave};
use shoal_interval::{Interval, IntervalBox};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let laws = Expression::system(|[r1, r2, e, i, u1, u2, p]| {
        [
            e * i - p,         // power
            (r1 + r2) * i - e, // Ohm's law for both
            r1 * i - u1,       // for the first
            r2 * i - u2,       // for the second
            u1 + u2 - e,       // the voltages add up
        ]
    });
    let names = ["R1 (ohm)", "R2 (ohm)", "E (V)", "I (A)", "U1 (V)", "U2 (V)", "P (W)"];
    let measured = IntervalBox::from([
        Interval::NON_NEGATIVE,
        Interval::NON_NEGATIVE,
        Interval::new(23.0, 26.0)?,
        Interval::new(4.0, 8.0)?,
        Interval::new(10.0, 11.0)?,
        Interval::new(14.0, 17.0)?,
        Interval::new(124.0, 130.0)?,
    ]);

    let circuit = laws.contractor([Interval::ZERO; 5]).fixpoint(0.0).contract(measured);
    for (name, value) in names.iter().zip(&circuit) {
        println!("{name:9} {value:.3}");
    }
    figure(&measured, &circuit)?.save(figures_folder().join("003_6_5_circuit.svg"))?;
    Ok(())
}

/// Current and voltage: the power and the sum of the partial voltages allow the red set, and the contracted box is its hull.
fn figure(measured: &IntervalBox<7>, circuit: &IntervalBox<7>) -> Result<Figure, Box<dyn Error>> {
    let [_, _, voltage, current, first, second, power] = measured.sides();
    let allowed = Expression::system(|[i, e]| [e * i, e]).separator([power, voltage & (first + second)]);
    let initial = IntervalBox::from([current, voltage]);
    let paving = pave(&allowed, initial, &Options::new(0.02))?;
    let (current, voltage) = (circuit[3], circuit[2]);
    let corners = [
        Vector2::new(current.lower(), voltage.lower()),
        Vector2::new(current.upper(), voltage.lower()),
        Vector2::new(current.upper(), voltage.upper()),
        Vector2::new(current.lower(), voltage.upper()),
    ];
    Ok(Figure::new(initial)?
        .title("Current and voltage: all that the measurements allow")
        .paving(&paving)
        .polygon(&corners)
        .axes("I (A)", "E (V)"))
}
