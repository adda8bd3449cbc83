//! A robot in a room with a pillar, a beacon and a range to the wall ahead (seed 000, figures 5.2 to 5.6).
//!
//! The seed prints no dimensions: those here are made up. The robot looks along the x axis, and its rangefinder does not
//! see the pillar, as in the seed.

use nalgebra::Vector2;
use shoal_interval::contractor::{Wall, WallRange};
use shoal_interval::figure::{Class, Figure, figures_folder};
use shoal_interval::fuzzy::{AlphaCut, FuzzyRing, Grade, Score, ScoreFunction};
use shoal_interval::paving::{Options, pave};
use shoal_interval::separator::{Polygon, Ring, Separator, from_contractors};
use shoal_interval::{Interval, IntervalBox};

type Granule<'a> = Box<dyn Separator<2> + Sync + 'a>;

/// How many steps stand for the fuzzy range.
const STEPS: u32 = 8;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let corners: Vec<Vector2<f64>> =
        [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (7.0, 5.0), (6.0, 8.0), (0.0, 7.0)]
            .map(|(x, y)| Vector2::new(x, y))
            .to_vec();
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let walls: Vec<Wall> = edges.map(|(&from, &to)| Wall::new(from, to)).collect();
    let room = Polygon::new(corners.clone())?;
    let pillar = Ring::disc(Vector2::new(4.6, 3.4), 0.7);
    let beacon = Vector2::new(8.5, 1.0);
    let range_to_beacon = Ring::new(beacon, Interval::new(4.5, 5.5)?);
    let ahead = WallRange::new(&walls, Interval::ZERO, Interval::new(4.2, 5.0)?);
    let range_to_wall = from_contractors(ahead.complement(), ahead);
    let initial = IntervalBox::from([Interval::new(-1.0, 11.0)?, Interval::new(-1.0, 9.0)?]);
    let options = Options::new(0.05);
    let picture = |title: &str| -> Result<Figure, Box<dyn std::error::Error>> {
        let figure = Figure::new(initial)?.title(title).axes("x (m)", "y (m)").point(beacon, "A");
        Ok(figure)
    };

    // Equation (5.18): in the room, not in the pillar, and the more of both ranges the better.
    let ranges = Score::mean([(1, Score::granule(2)), (1, Score::granule(3))]);
    let score = ScoreFunction::new(4, Score::least([Score::granule(0), Score::granule(1), ranges]))?;
    let mut figure = picture("Crisp granules: the cuts at 1/2 and at 1")?;
    for (grade, class) in [(Grade::new(1, 2)?, Class::Level(3)), (Grade::ONE, Class::Level(4))] {
        let granules: Vec<Granule> = vec![
            Box::new(&room),
            Box::new(pillar.complement()),
            Box::new(range_to_beacon),
            Box::new(range_to_wall),
        ];
        let cut = pave(&AlphaCut::new(score.clone(), grade, granules)?, initial, &options)?;
        print(grade, &cut);
        figure = figure.boxes(cut.outer(), class).legend(class, &format!("cut at {grade}"));
    }
    figure
        .polygon(&corners)
        .circle(Vector2::new(4.6, 3.4), 0.7)
        .ring(beacon, Interval::new(4.5, 5.5)?)
        .save(figures_folder().join("000_5_4_fuzzy_room.svg"))?;

    // Figure 5.5: the range to the beacon is a trapezium, here in steps.
    let fuzzy = FuzzyRing::new(beacon, Interval::new(4.0, 6.0)?, Interval::new(4.75, 5.25)?)?;
    let first_step = 3;
    let steps = Score::mean((0..STEPS as usize).map(|step| (1, Score::granule(first_step + step))));
    let ranges = Score::mean([(1, steps), (1, Score::granule(2))]);
    let score = ScoreFunction::new(
        first_step + STEPS as usize,
        Score::least([Score::granule(0), Score::granule(1), ranges]),
    )?;
    let mut figure = picture("A fuzzy range to the beacon: five cuts")?;
    for fifths in 1..=5 {
        let mut granules: Vec<Granule> =
            vec![Box::new(&room), Box::new(pillar.complement()), Box::new(range_to_wall)];
        granules.extend(fuzzy.steps(STEPS).into_iter().map(|step| Box::new(step) as Granule));
        let grade = Grade::new(fifths, 5)?;
        let cut = pave(&AlphaCut::new(score.clone(), grade, granules)?, initial, &options)?;
        print(grade, &cut);
        let class = Class::Level(fifths as u8 - 1);
        figure = figure.boxes(cut.inner(), class).legend(class, &format!("cut at {grade}"));
    }
    figure
        .polygon(&corners)
        .circle(Vector2::new(4.6, 3.4), 0.7)
        .save(figures_folder().join("000_5_6_fuzzy_granule.svg"))?;
    Ok(())
}

fn print(grade: Grade, cut: &shoal_interval::paving::Paving<2>) {
    println!(
        "cut at {grade}: area between {:.3} and {:.3} m2, {} bisections",
        cut.inner_volume().lower(),
        cut.outer_volume().upper(),
        cut.statistics().bisections,
    );
}
