//! Forward-backward contraction by hand: three variables of a sum, and three equations that contradict each other.
//!
//! Leaves the way to the contradiction in `target/figures/003_6_3_infeasible.svg`.
//!
//! ```sh
//! cargo run --release -p shoal-interval --example forward_backward
//! ```
//!
//! Source: seed 001, equations (2.39) to (2.49), whose third equation is printed as `y = -x + 1` and used as `y = -3 x + 1`;
//! seed 003, sections 6.2 and 6.3.

use nalgebra::Vector2;
use shoal_interval::contractor::{Contractor, contract_sum};
use shoal_interval::expression::Expression;
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::{Interval, IntervalBox};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let at_most = |bound| Interval::new(f64::NEG_INFINITY, bound);
    let at_least = |bound| Interval::new(bound, f64::INFINITY);

    let (mut x, mut y, mut z) = (at_most(2.0)?, at_most(3.0)?, at_least(4.0)?);
    contract_sum(&mut x, &mut y, &mut z);
    println!("001 (2.39)  i3 in {x}, i6 in {y}, i7 in {z}");

    let (mut x, mut y, mut z) = (at_most(5.0)?, at_most(4.0)?, at_least(6.0)?);
    contract_sum(&mut x, &mut y, &mut z);
    println!("003, 6.2    x in {x}, y in {y}, z in {z}");

    let boxes = until_empty("003, 6.3", 1.0, -2.0);
    until_empty("001 (2.42), as used", 2.0, -3.0);
    until_empty("001 (2.42), as printed", 2.0, -1.0);
    figure(&boxes)?.save(figures_folder().join("003_6_3_infeasible.svg"))?;
    Ok(())
}

/// Contracts the plane by `y = x²`, `x y = product` and `y = slope x + 1` in turn until nothing is left, and returns the boxes
/// on the way.
fn until_empty(name: &str, product: f64, slope: f64) -> Vec<IntervalBox<2>> {
    let equations = [
        ("y = x^2", Expression::new(|[x, y]| y - x.sqr())),
        ("x y = c", Expression::new(|[x, y]| x * y - product)),
        ("y = a x + 1", Expression::new(|[x, y]| y - (x * slope + 1.0))),
    ];
    println!("{name}: y = x^2, x y = {product}, y = {slope} x + 1");
    let mut boxes = vec![IntervalBox::ENTIRE];
    for (equation, expression) in equations.iter().cycle().take(300) {
        let domain = boxes[boxes.len() - 1];
        let contracted = expression.contractor(Interval::ZERO).contract(domain);
        println!("    {equation:12} {contracted:.4}");
        boxes.push(contracted);
        if contracted.is_empty() {
            break;
        }
    }
    boxes
}

fn figure(boxes: &[IntervalBox<2>]) -> Result<Figure, Box<dyn Error>> {
    let view = IntervalBox::from([Interval::new(-1.0, 2.0)?, Interval::new(-0.5, 2.5)?]);
    let bounded: Vec<_> = boxes.iter().map(|part| *part & view).filter(|part| !part.is_empty()).collect();
    let mut figure =
        Figure::new(view)?.title("y = x², x y = 1 and y = -2 x + 1: no common point").axes("x", "y");
    for (step, part) in bounded.iter().enumerate() {
        figure = figure.boxes([part], Class::Level(step as u8));
    }
    let curve = |from: f64, to: f64, value: &dyn Fn(f64) -> f64| -> Vec<_> {
        (0..=200)
            .map(|step| from + (to - from) * f64::from(step) / 200.0)
            .map(|x| Vector2::new(x, value(x)))
            .collect()
    };
    Ok(figure.curve(&curve(-1.0, 1.58, &|x| x * x)).curve(&curve(0.4, 2.0, &|x| 1.0 / x)).curve(&curve(
        -0.75,
        0.75,
        &|x| 1.0 - 2.0 * x,
    )))
}
