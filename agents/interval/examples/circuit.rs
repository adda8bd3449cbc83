//! Two resistors in series: what five laws of electricity leave of seven measurements.
//!
//! ```sh
//! cargo run --release -p shoal-interval --example circuit
//! ```
//!
//! Source: seed 003, section 6.5.

use shoal_interval::contractor::Contractor;
use shoal_interval::expression::Expression;
use shoal_interval::{Interval, IntervalBox, IntervalError};

fn main() -> Result<(), IntervalError> {
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
    Ok(())
}
