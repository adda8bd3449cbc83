//! Figures hold what they were given, in a form that XML readers take.

use super::*;
use crate::interval::Interval;
use nalgebra::Vector2;

fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn unit() -> Figure {
    Figure::new(IntervalBox::from([over(0.0, 1.0); 2])).unwrap()
}

#[test]
fn a_view_without_area_is_refused() {
    for view in [
        IntervalBox::EMPTY,
        IntervalBox::ENTIRE,
        IntervalBox::from([Interval::ONE, over(0.0, 1.0)]),
        IntervalBox::from([over(f64::MIN, f64::MAX); 2]),
    ] {
        assert!(matches!(Figure::new(view), Err(FigureError::View { .. })));
    }
}

#[test]
fn coordinates_keep_all_their_digits() {
    let svg = unit().boxes(&[IntervalBox::from([over(0.1, 0.1_f64.next_up()); 2])], Class::Inner).to_svg();
    assert!(svg.contains("M0.1 0.1H0.10000000000000002V0.10000000000000002H0.1z"), "{svg}");
}

#[test]
fn texts_are_escaped() {
    let svg = unit().title("a < b & \"c\"").point(Vector2::new(0.5, 0.5), "<script>").axes("x", "y").to_svg();
    assert!(svg.contains("a &lt; b &amp; &quot;c&quot;") && !svg.contains("<script>"));
}

#[test]
fn what_is_not_finite_or_not_there_is_left_out() {
    let empty = unit().to_svg();
    let svg = unit()
        .circle(Vector2::new(f64::NAN, 0.0), 1.0)
        .circle(Vector2::new(0.0, 0.0), f64::INFINITY)
        .ring(Vector2::new(0.0, 0.0), Interval::EMPTY)
        .point(Vector2::new(f64::INFINITY, 0.0), "far")
        .curve(&[Vector2::new(0.0, 0.0), Vector2::new(0.0, f64::NAN)])
        .polygon(&[])
        .boxes(&[IntervalBox::EMPTY], Class::Outside)
        .to_svg();
    assert_eq!(svg, empty);
    assert!(!unit().boxes(&[IntervalBox::ENTIRE], Class::Outside).to_svg().contains("inf"));
}

#[test]
fn ticks_are_round_and_few() {
    for (width, last) in [(1.0, "1.0"), (20.0, "20"), (7.0, "7"), (0.003, "0.0030"), (1.0e9, "1000000000")] {
        let view = IntervalBox::from([over(0.0, width), over(0.0, width)]);
        let svg = Figure::new(view).unwrap().axes("x", "y").to_svg();
        assert!(svg.contains(&format!(">{last}<")), "{last}: {svg}");
        assert!(svg.matches("class=\"frame\"").count() < 26);
    }
}

#[test]
fn saving_makes_the_folder_and_says_what_failed() {
    let folder = std::env::temp_dir().join(format!("shoal-figure-{}", std::process::id()));
    let path = folder.join("deeper").join("figure.svg");
    unit().save(&path).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), unit().to_svg());
    let error = unit().save(path.join("inside-a-file.svg")).unwrap_err();
    assert!(error.to_string().contains("inside-a-file.svg"));
    std::fs::remove_dir_all(folder).unwrap();
}
