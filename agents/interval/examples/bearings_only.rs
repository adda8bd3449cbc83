//! Localization by bearings alone, and with bearings that are wrong (seed 001, figures 3.6 and 3.7).
//!
//! A bearing is the direction in which a beacon sees the robot, from the x axis towards the y axis.

use nalgebra::Vector2;
use shoal_interval::contractor::Sector;
use shoal_interval::figure::{Figure, figures_folder};
use shoal_interval::paving::{Options, pave};
use shoal_interval::separator::{FromContractors, from_contractors, q_intersection};
use shoal_interval::{Interval, IntervalBox};
use std::f64::consts::TAU;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bearings = [
        (Vector2::new(-3.0, -3.0), Interval::new(0.2, 0.3)?),
        (Vector2::new(-4.0, 4.0), Interval::new(5.55, 5.65)?),
        (Vector2::new(3.0, 1.0), Interval::new(4.4, 4.5)?),
    ];
    let separators = bearings.map(|(beacon, bearing)| seen_from(beacon, bearing));
    let initial = IntervalBox::from([Interval::new(-10.0, 10.0)?; 2]);
    let figures = [
        (1, 0, "3_6a_one_bearing"),
        (2, 0, "3_6b_two_bearings"),
        (3, 0, "3_6c_three_bearings"),
        (3, 1, "3_7a_bearings_relaxed"),
        (3, 2, "3_7b_bearings_relaxed"),
    ];
    for (taken, outliers, file) in figures {
        let seen = q_intersection(&separators[..taken], outliers);
        let paving = pave(&seen, initial, &Options::new(0.05))?;
        println!(
            "bearings {taken}, outliers {outliers}: area between {:.4} and {:.4} m2 in {} part(s), {} bisections",
            paving.inner_volume().lower(),
            paving.outer_volume().upper(),
            paving.parts(),
            paving.statistics().bisections,
        );
        let title = format!("Bearings seen: {taken}; of these may be wrong: {outliers}");
        let mut figure = Figure::new(initial)?.title(&title).paving(&paving).axes("x (m)", "y (m)");
        for &(beacon, bearing) in &bearings[..taken] {
            for side in [bearing.lower(), bearing.upper()] {
                let (sine, cosine) = pxfm::f_sincos(side % TAU);
                figure = figure.segment(beacon, beacon + 40.0 * Vector2::new(cosine, sine));
            }
            figure = figure.point(beacon, "");
        }
        figure.save(figures_folder().join(format!("001_{file}.svg")))?;
    }
    Ok(())
}

/// The separator of what a beacon sees under a bearing.
fn seen_from(
    beacon: Vector2<f64>,
    bearing: Interval,
) -> FromContractors<impl shoal_interval::contractor::Contractor<2> + Copy, Sector> {
    let sector = Sector::new(IntervalBox::centred(&beacon, 0.0), bearing);
    from_contractors(sector.complement(), sector)
}
