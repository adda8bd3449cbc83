//! Localization among beacons: one, two, three ranges, a fourth that is right or wrong, and how many are wrong (seed 001,
//! figures 2.10 to 2.12 and table 2.5).

use nalgebra::Vector2;
use shoal_interval::figure::{Figure, figures_folder};
use shoal_interval::paving::{Options, Paving, gomne, pave};
use shoal_interval::separator::{Ring, intersection_of, q_intersection};
use shoal_interval::{Interval, IntervalBox, IntervalError};

type Range = (Vector2<f64>, Interval);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let three: [Range; 3] =
        [range(3.0, 3.0, 3.0, 4.0)?, range(-3.0, -1.0, 5.0, 6.0)?, range(-2.0, 2.0, 4.0, 5.0)?];
    let (good, faulty) = (range(4.0, -4.0, 3.0, 4.0)?, range(4.0, -4.0, 1.0, 2.0)?);
    let initial = IntervalBox::from([Interval::new(-10.0, 10.0)?; 2]);
    let options = Options::new(0.05);
    let rings = |ranges: &[Range]| -> Vec<Ring<2>> {
        ranges.iter().map(|&(beacon, range)| Ring::new(beacon, range)).collect()
    };

    for (count, file) in [(1, "2_10a_one_beacon"), (2, "2_10b_two_beacons"), (3, "2_10c_three_beacons")] {
        let ranges = &three[..count];
        let paving = pave(&intersection_of(rings(ranges)), initial, &options)?;
        report(file, &format!("Ranges to {count} of the beacons"), ranges, &paving, initial)?;
    }
    for (fourth, file, title) in [
        (good, "2_11a_fourth_beacon", "A fourth range"),
        (faulty, "2_11b_outlier", "A fourth range that is wrong: no position is left"),
    ] {
        let ranges = [three[0], three[1], three[2], fourth];
        let paving = pave(&intersection_of(rings(&ranges)), initial, &options)?;
        report(file, title, &ranges, &paving, initial)?;
    }

    let with_outlier = [three[0], three[1], three[2], faulty];
    for (outliers, file) in [(1, "2_12a_relaxed"), (2, "2_12b_relaxed"), (3, "2_12c_relaxed")] {
        let paving = pave(&q_intersection(rings(&with_outlier), outliers), initial, &options)?;
        report(
            file,
            &format!("{outliers}-relaxed intersection of four ranges"),
            &with_outlier,
            &paving,
            initial,
        )?;
    }
    let found = gomne(&rings(&with_outlier), 0, initial, &options)?;
    println!("GOMNE: at least {} outliers, {} are enough", found.at_least, found.enough);
    Ok(())
}

/// A beacon's position and the range to it.
fn range(x: f64, y: f64, lower: f64, upper: f64) -> Result<Range, IntervalError> {
    Ok((Vector2::new(x, y), Interval::new(lower, upper)?))
}

fn report(
    file: &str,
    title: &str,
    ranges: &[Range],
    paving: &Paving<2>,
    initial: IntervalBox<2>,
) -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "{title}: area between {:.4} and {:.4} m2 in {} parts, {} bisections",
        paving.inner_volume().lower(),
        paving.outer_volume().upper(),
        paving.parts(),
        paving.statistics().bisections,
    );
    let mut figure = Figure::new(initial)?.title(title).paving(paving).axes("x (m)", "y (m)");
    for (beacon, range) in ranges {
        figure = figure.ring(*beacon, *range).point(*beacon, "");
    }
    figure.save(figures_folder().join(format!("001_{file}.svg")))?;
    Ok(())
}
