//! Tests of figures as text.

use super::*;

/// Fails unless every element of the text is closed in turn, every attribute is quoted, and no stray `<` or `&` is left.
pub fn assert_well_formed(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    while let Some((text, tagged)) = rest.split_once('<') {
        for entity in text.split('&').skip(1) {
            assert!(
                ["amp;", "lt;", "gt;", "quot;", "apos;"].iter().any(|known| entity.starts_with(known)),
                "{text}"
            );
        }
        let (tag, after) = tagged.split_once('>').expect("a tag ends");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name), "{tag}"),
            None if tag.ends_with('/') => {}
            None => open.push(tag.split_whitespace().next().unwrap()),
        }
        rest = after;
    }
    assert!(open.is_empty(), "{open:?}");
    assert_eq!(rest.trim(), "");
}

fn figure() -> Figure {
    let mark = Mark::new(Shape::Cross, Colour::Vermillion);
    let panel = |layers| Panel {
        width_px: 200.0,
        x: Axis::from_zero("time (s)", 10.0),
        y: Axis::around("depth < \"z\" (m)", 0.0, 4.0).reversed(),
        layers,
    };
    let turn = |at, direction| Turn { at, direction };
    Figure {
        title: "Marks & lines".to_owned(),
        subtitle: "made up".to_owned(),
        panels: vec![
            panel(vec![
                Layer::Area { colour: Colour::Pale, corners: vec![[0.0, 0.0], [10.0, 0.0], [10.0, 1.0]] },
                Layer::Marks { mark, points: vec![[1.0, 1.0], [f64::NAN, 2.0], [9.0, 3.0]] },
            ]),
            panel(vec![
                Layer::Bars { colour: Colour::Blue, bars: vec![[0.0, 1.0, 0.0, 2.0]] },
                Layer::Line { colour: Colour::Grey, points: vec![[0.0, 0.0], [10.0, 4.0]] },
                Layer::Arcs {
                    colour: Colour::Green,
                    turns: vec![turn([0.0, 0.0], [1.0, 0.0]), turn([2.0, 2.0], [0.0, 1.0])],
                },
            ]),
        ],
        legend: vec![
            Entry::new(Sample::Mark(mark), "a mark"),
            Entry::new(Sample::Area(Colour::Blue), "an area"),
            Entry::new(Sample::Line(Colour::Grey), "a line"),
            Entry::remark("a remark"),
        ],
    }
}

#[test]
fn a_figure_is_the_same_text_every_time() {
    let svg = figure().to_svg();
    assert_well_formed(&svg);
    assert_eq!(svg, figure().to_svg());
    insta::assert_snapshot!(svg);
}

#[test]
fn axes_hold_what_they_are_around() {
    for (least, greatest) in [(0.0, 1.0), (-5.0, 5.0), (3.0, 3.0), (0.0, 0.0), (1e9, 1e9)] {
        let axis = Axis::around("", least, greatest);
        assert!(axis.part(least) > 0.0 && axis.part(greatest) < 1.0, "{least} {greatest}");
        assert!(!axis.ticks(600.0, 0).is_empty(), "{least} {greatest}");
    }
    let nothing = Axis::around("", f64::INFINITY, f64::NEG_INFINITY);
    assert_eq!((nothing.first, nothing.last), (0.0, 1.0));
}

#[test]
fn arcs_are_those_of_circles() {
    // A quarter of the unit circle: the middle of the cubic lies 2.7e-4 off at most, here and in any scale.
    let from = Turn { at: [1.0, 0.0], direction: [0.0, 1.0] };
    let to = Turn { at: [0.0, 1.0], direction: [-1.0, 0.0] };
    let [first, second] = from.controls(&to);
    let middle: [f64; 2] = std::array::from_fn(|axis| {
        (from.at[axis] + 3.0 * first[axis] + 3.0 * second[axis] + to.at[axis]) / 8.0
    });
    let radius = (middle[0] * middle[0] + middle[1] * middle[1]).sqrt();
    assert!((radius - 1.0).abs() < 3e-4, "{radius}");
    assert!((first[1] - 4.0 / 3.0 * (2.0_f64.sqrt() - 1.0)).abs() < 1e-12, "{first:?}");
}
