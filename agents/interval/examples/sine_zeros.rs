//! The zeros of the sine on [-1, 7]: a contractor alone, SIVIA, SIVIA with the contractor (seed 002, section 3.5.4).

use nalgebra::Vector2;
use shoal_interval::contractor::{Contractor, from_fn};
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::paving::{Options, csivia, from_test_fn, set_inversion, sivia};
use shoal_interval::{Interval, IntervalBox, Membership};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let initial = IntervalBox::from([Interval::new(-1.0, 7.0)?]);
    // Between the widths 1/16, of the boxes that the seed prints, and 1/8, of their parents.
    let options = Options::new(0.1);
    let contractor = from_fn(|x: IntervalBox<1>| IntervalBox::from([Interval::ZERO.sin_rev(x[0])]));
    let sine = set_inversion(|x: &IntervalBox<1>| x.map(Interval::sin), IntervalBox::from([Interval::ZERO]));
    // The set is thin: no box is inside, and the contractor says all that there is to say.
    let thin = from_test_fn(|_: &IntervalBox<1>| Membership::Undecided);

    let once = contractor.contract(initial);
    let classical = sivia(&sine, initial, &options)?;
    let contracted = csivia(&contractor, &thin, initial, &options)?;
    println!("contractor alone: {once}");
    let rows = [("classical SIVIA", &classical), ("SIVIA with the contractor", &contracted)];
    for (name, paving) in rows {
        println!("{name}: {} iterations, {}", paving.statistics().boxes, listed(paving.boundary()));
    }
    // Contracted to [0, 2π] and bisected at π, the interval puts π in both halves. The seed's five iterations and three
    // boxes come when the bisection, at 3, is first.
    let (low, high) = initial.bisect().ok_or("[-1, 7] has a middle")?;
    let halves = [csivia(&contractor, &thin, low, &options)?, csivia(&contractor, &thin, high, &options)?];
    let iterations = 1 + halves.iter().map(|half| half.statistics().boxes).sum::<usize>();
    let boxes = halves.iter().map(|half| listed(half.boundary())).collect::<Vec<_>>().join(", ");
    println!("the same, bisected first: {iterations} iterations, {boxes}");

    let view = IntervalBox::from([initial[0], Interval::new(-3.2, 1.2)?]);
    let on_row = |boxes: &[IntervalBox<1>], top: f64| -> Vec<IntervalBox<2>> {
        boxes.iter().map(|part| IntervalBox::from([part[0], Interval::centred(top, 0.2)])).collect()
    };
    let curve: Vec<_> =
        (-100..=700).map(|x| f64::from(x) / 100.0).map(|x| Vector2::new(x, pxfm::f_sin(x))).collect();
    let mut figure = Figure::new(view)?
        .title("sin x = 0 on [-1, 7]")
        .curve(&curve)
        .boxes(&on_row(&[once], -1.6), Class::Boundary);
    for ((_, paving), row) in rows.into_iter().zip([-2.2, -2.8]) {
        figure = figure
            .boxes(&on_row(paving.outside(), row), Class::Outside)
            .boxes(&on_row(paving.boundary(), row), Class::Boundary);
    }
    for (row, name) in [(-1.65, "contractor"), (-2.25, "SIVIA"), (-2.85, "both")] {
        figure = figure.text(Vector2::new(0.9, row), name);
    }
    figure
        .segment(Vector2::new(-1.0, 0.0), Vector2::new(7.0, 0.0))
        .legend(Class::Boundary, "may hold a zero")
        .legend(Class::Outside, "holds none")
        .axes("x", "")
        .save(figures_folder().join("002_3_13_sine_zeros.svg"))?;
    Ok(())
}

fn listed(boxes: &[IntervalBox<1>]) -> String {
    boxes.iter().map(|part| part.to_string()).collect::<Vec<_>>().join(", ")
}
