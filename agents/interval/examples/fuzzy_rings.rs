//! Four ranges: united, intersected, relaxed, and weighted (seed 000, examples 2.3.2 and 2.4.3).
//!
//! Of the seed's table 2.1 only the landmarks (-1, 3) and (8, -1) can be read, with ranges that fit a robot at the origin:
//! the distances there are 3.2 and 8.1, plus and minus 1. They are taken for the first and the third, since the text makes
//! [11.1, 13.1] of the third range to get an outlier. The other two landmarks are made up, with ranges from the same origin.

use nalgebra::Vector2;
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::fuzzy::{AlphaCut, Grade, ScoreFunction};
use shoal_interval::paving::{Options, Paving, pave};
use shoal_interval::separator::{Ring, intersection_of, q_intersection, union_of};
use shoal_interval::{Interval, IntervalBox};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let landmarks = [(-1.0, 3.0), (-5.0, -4.0), (8.0, -1.0), (2.0, -6.0)].map(|(x, y)| Vector2::new(x, y));
    let ranges = [(2.2, 4.2), (5.4, 7.4), (7.1, 9.1), (5.3, 7.3)];
    let rings = |ranges: [(f64, f64); 4]| -> Result<Vec<Ring<2>>, shoal_interval::IntervalError> {
        let ring = |(centre, (lower, upper))| Ok(Ring::new(centre, Interval::new(lower, upper)?));
        landmarks.into_iter().zip(ranges).map(ring).collect()
    };
    let good = rings(ranges)?;
    let mut wrong = ranges;
    wrong[2] = (11.1, 13.1);
    let with_outlier = rings(wrong)?;
    let initial = IntervalBox::from([Interval::new(-14.0, 22.0)?, Interval::new(-16.0, 14.0)?]);
    let options = Options::new(0.2);

    let all = pave(&intersection_of(&good[..]), initial, &options)?;
    print("intersection", &all);
    let any = pave(&union_of(&good[..]), initial, &options)?;
    print("union", &any);
    frame("Four ranges: union and intersection", initial, &landmarks)?
        .boxes(any.outer(), Class::Level(0))
        .boxes(all.outer(), Class::Level(4))
        .legend(Class::Level(0), "in one of them")
        .legend(Class::Level(4), "in all of them")
        .save(figures_folder().join("000_2_8a_rings.svg"))?;

    let none = pave(&intersection_of(&with_outlier[..]), initial, &options)?;
    print("intersection with an outlier", &none);
    let relaxed = pave(&q_intersection(&with_outlier[..], 1), initial, &options)?;
    print("1-relaxed intersection with an outlier", &relaxed);
    let any = pave(&union_of(&with_outlier[..]), initial, &options)?;
    frame("Four ranges, one of them wrong: union and 1-relaxed intersection", initial, &landmarks)?
        .boxes(any.outer(), Class::Level(0))
        .boxes(relaxed.outer(), Class::Level(3))
        .legend(Class::Level(0), "in one of them")
        .legend(Class::Level(3), "in all but one")
        .save(figures_folder().join("000_2_8b_rings_relaxed.svg"))?;

    let mut figure = frame("Four ranges, the second worth twice the others", initial, &landmarks)?;
    for fifths in 1..=5 {
        let score = ScoreFunction::weighted_mean(&[1, 2, 1, 1])?;
        let cut = pave(&AlphaCut::new(score, Grade::new(fifths, 5)?, good.clone())?, initial, &options)?;
        print(&format!("alpha-cut at {fifths}/5"), &cut);
        let class = Class::Level(fifths as u8 - 1);
        figure = figure.boxes(cut.outer(), class).legend(class, &format!("{fifths}/5"));
    }
    figure.save(figures_folder().join("000_2_14_alpha_cuts.svg"))?;
    Ok(())
}

fn frame(
    title: &str,
    initial: IntervalBox<2>,
    landmarks: &[Vector2<f64>],
) -> Result<Figure, Box<dyn std::error::Error>> {
    let figure = Figure::new(initial)?.title(title).axes("x1", "x2").point(Vector2::new(0.0, 0.0), "robot");
    Ok(landmarks
        .iter()
        .enumerate()
        .fold(figure, |figure, (index, landmark)| figure.point(*landmark, &format!("m({})", index + 1))))
}

fn print(name: &str, paving: &Paving<2>) {
    println!(
        "{name}: area between {:.3} and {:.3}, {} bisections",
        paving.inner_volume().lower(),
        paving.outer_volume().upper(),
        paving.statistics().bisections,
    );
}
