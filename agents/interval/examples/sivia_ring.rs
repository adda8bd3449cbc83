//! SIVIA on one range, and what a contractor and a separator save (seed 001, figure 2.9).

use nalgebra::Vector2;
use shoal_interval::contractor::from_fn;
use shoal_interval::figure::{Figure, figures_folder};
use shoal_interval::paving::{Options, Paving, csivia, pave, sivia};
use shoal_interval::separator::{Ring, Separator};
use shoal_interval::{Interval, IntervalBox};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (beacon, range) = (Vector2::new(3.0, 3.0), Interval::new(3.0, 4.0)?);
    let ring = Ring::new(beacon, range);
    let initial = IntervalBox::from([Interval::new(-10.0, 10.0)?; 2]);
    let options = Options::new(0.25);

    let contractor = from_fn(move |domain| ring.outer(domain));
    let pavings: [(&str, &str, Paving<2>); 3] = [
        ("SIVIA", "2_9a_sivia", sivia(&ring, initial, &options)?),
        ("CSIVIA", "2_9b_csivia", csivia(&contractor, &ring, initial, &options)?),
        ("SIVIA with a separator", "2_9c_separator", pave(&ring, initial, &options)?),
    ];
    for (name, file, paving) in &pavings {
        let bisections = paving.statistics().bisections;
        println!(
            "{name}: {bisections} bisections, area between {:.3} and {:.3} (truth {:.3})",
            paving.inner_volume().lower(),
            paving.outer_volume().upper(),
            7.0 * std::f64::consts::PI,
        );
        Figure::new(initial)?
            .title(&format!("{name}: 3 m to 4 m from a beacon, {bisections} bisections"))
            .paving(paving)
            .ring(beacon, range)
            .point(beacon, "beacon 3")
            .axes("x (m)", "y (m)")
            .save(figures_folder().join(format!("001_{file}.svg")))?;
    }
    Ok(())
}
