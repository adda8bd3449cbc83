//! Tests of the figures of tubes, widths, maps and links, from rows made by hand.

use shoal_bus::message::AuvId;
use shoal_bus::record::rows::{PingRow, Real, ReportRow, TruthRow};
use shoal_bus::record::{RecordHeader, RecordedAuv, Row};
use shoal_bus::time::{LocalTime, NS_PER_S, SimTime};

use crate::figure::{Figure, Layer};
use crate::plot::{Kind, Of, plot_of};

const LIBRARY: &str = "swarm-3";

fn header() -> RecordHeader {
    let auv = |(name, group, group_name): (&str, u16, &str)| RecordedAuv {
        name: name.into(),
        group,
        group_name: group_name.into(),
        length_m: 2.0,
    };
    RecordHeader {
        scenario_name: "by-hand".into(),
        seed: 1,
        scenario_text: shoal_scenario::load(LIBRARY).unwrap().1,
        auvs: [("a-0", 0, "a"), ("a-1", 0, "a"), ("b-0", 1, "b")].map(auv).to_vec(),
    }
}

/// AUV `auv` at second `second`, at x = its number and y = the second, its clock 1 ms late.
fn truth(auv: u32, second: i64) -> Row {
    Row::Truth(TruthRow {
        auv: AuvId(auv),
        tick: second as u64,
        t_ns: SimTime::from_ns(second * NS_PER_S),
        local_ns: LocalTime::from_ns(second * NS_PER_S - 1_000_000),
        position_m: [f64::from(auv), second as f64, -5.0].map(Real),
        velocity_m_s: [Real(0.0); 3],
        heading_rad: Real(0.0),
        pitch_rad: Real(0.0),
    })
}

/// What it believes then: boxes that reach `half` to each side of the truth, slices twice as far.
fn report(auv: u32, second: i64, half: f64) -> Row {
    let around = |middle: f64, half: f64| serde_json::json!([middle - half, middle + half]);
    let position = |half: f64| [f64::from(auv), second as f64, -5.0].map(|middle| around(middle, half));
    let row = serde_json::json!({
        "auv": auv, "tick": second, "t_ns": second * NS_PER_S, "local_ns": second * NS_PER_S - 1_000_000,
        "position_m": position(half), "clock_offset_s": around(1e-3, half * 1e-3),
        "slice_position_m": position(2.0 * half), "slice_clock_offset_s": around(1e-3, 2e-3 * half),
        "neighbours": 0, "contractions": 0, "rejected": 0, "components": 1, "setpoint_m_s": [0, 0, 0],
    });
    Row::Report(Box::new(serde_json::from_value::<ReportRow>(row).unwrap()))
}

fn heard(at_ns: i64, from: u32, to: u32) -> Row {
    Row::Ping(PingRow::Heard {
        t_ns: SimTime::from_ns(at_ns),
        from: AuvId(from),
        sequence: 0,
        to: AuvId(to),
        range_m: Real(1.0),
        travel_s: Real(1.0),
        box_width_m: Real(1.0),
        reception: None,
        outlier: false,
    })
}

fn emitted(at_ns: i64, from: u32) -> Row {
    Row::Ping(PingRow::Emitted {
        t_ns: SimTime::from_ns(at_ns),
        from: AuvId(from),
        sequence: 0,
        position_m: [10.0, 20.0, -5.0].map(Real),
        bytes: 32,
        box_width_m: Real(1.0),
        beyond_range: 0,
        packet_s: Real(0.0),
    })
}

fn figure(kind: Kind, of: Of, rows: &[Row]) -> Result<Figure, String> {
    let mut plot = plot_of(kind, &of);
    rows.iter().for_each(|row| plot.take(row));
    plot.figure(&header())
}

fn of_auv(auv: u32) -> Of {
    Of { auv: Some(auv), ..Of::default() }
}

fn at(at_s: f64) -> Of {
    Of { at_s: Some(at_s), ..Of::default() }
}

fn legend(figure: &Figure) -> Vec<&str> {
    figure.legend.iter().map(|entry| entry.meaning.as_str()).collect()
}

#[test]
fn tubes_show_gates_at_ticks_slices_between_and_the_truth() {
    let rows = [truth(1, 0), truth(2, 0), report(1, 0, 1.0), truth(1, 1), report(1, 1, 2.0)];
    let figure = figure(Kind::Tubes, of_auv(1), &rows).unwrap();
    assert!(figure.title.contains("a-1 (AUV 1)"), "{}", figure.title);
    assert_eq!(figure.panels.len(), 8);
    let labels: Vec<&str> = figure.panels.iter().map(|panel| panel.y.label.as_str()).collect();
    assert_eq!(labels[..3], ["x, east (m)", "x − truth (m)", "y, north (m)"]);
    let [Layer::Area { corners: slices, .. }, Layer::Area { corners: gates, .. }, Layer::Line { points, .. }] =
        &figure.panels[2].layers[..]
    else {
        panic!("{:?}", figure.panels[2].layers)
    };
    // y is 0 and then 1: gates 1 and 2 to each side, the slice 4 from the first tick to the second.
    assert_eq!(gates[..], [[0.0, -1.0], [1.0, -1.0], [1.0, 3.0], [0.0, 1.0]]);
    assert_eq!(slices[..], [[0.0, -3.0], [1.0, -3.0], [1.0, 5.0], [0.0, 5.0]]);
    assert_eq!(points[..], [[0.0, 0.0], [1.0, 1.0]]);
    // The clock in milliseconds, less the truth.
    let Layer::Area { corners, .. } = &figure.panels[7].layers[1] else { panic!() };
    let expected = [[0.0, -1.0], [1.0, -2.0], [1.0, 2.0], [0.0, 1.0]];
    for (found, wanted) in corners.iter().zip(expected) {
        assert!((found[0] - wanted[0]).abs() < 1e-9 && (found[1] - wanted[1]).abs() < 1e-9, "{corners:?}");
    }
}

#[test]
fn widths_are_quantiles_over_the_swarm_and_all_of_one_auv() {
    let rows: Vec<Row> =
        (0..3).flat_map(|auv| (0..40).map(move |second| report(auv, second, f64::from(auv + 1)))).collect();
    let figure = figure(Kind::Widths, of_auv(2), &rows).unwrap();
    let [Layer::Area { corners, .. }, _, Layer::Line { points: median, .. }, Layer::Line { points: own, .. }] =
        &figure.panels[0].layers[..]
    else {
        panic!("{:?}", figure.panels[0].layers)
    };
    assert!(median.iter().all(|[_, width]| *width == 4.0) && own.iter().all(|[_, width]| *width == 6.0));
    let widths: std::collections::BTreeSet<u64> = corners.iter().map(|[_, width]| *width as u64).collect();
    assert_eq!(widths.into_iter().collect::<Vec<_>>(), [2, 6]);
    assert_eq!((median.len(), own.len()), (40, 40));
    assert!(legend(&figure).contains(&"b-0 (AUV 2), each tick"));
    assert!(figure.panels[1].y.label.ends_with("(ms)") && figure.panels[1].y.last > 6.0);
}

#[test]
fn long_runs_of_widths_keep_the_widest() {
    let half = |second: i64| if second == 4_321 { 50.0 } else { 1.0 };
    let rows: Vec<Row> = (0..10_000).map(|second| report(0, second, half(second))).collect();
    let figure = figure(Kind::Widths, Of::default(), &rows).unwrap();
    let Layer::Line { points, .. } = &figure.panels[0].layers[2] else { panic!() };
    assert!(points.len() <= 200 && points.len() > 90, "{}", points.len());
    assert_eq!(points.iter().filter(|[_, width]| *width == 100.0).count(), 1);
}

#[test]
fn a_map_shows_everyone_at_the_last_tick_until_then_and_sound_on_its_way() {
    let rows = [
        truth(0, 0),
        report(0, 0, 1.0),
        truth(1, 0),
        truth(2, 0),
        emitted(900_000_000, 1),
        emitted(950_000_000, 2),
        truth(0, 1),
        report(0, 1, 3.0),
        heard(1_200_000_000, 1, 0),
        truth(0, 2),
        report(0, 2, 9.0),
    ];
    let figure = figure(Kind::Map, at(1.1), &rows).unwrap();
    assert!(figure.title.ends_with("at 1.100 s"), "{}", figure.title);
    assert!(legend(&figure).contains(&"ping under way: 1"), "{:?}", legend(&figure));
    assert!(legend(&figure).contains(&"0.100 s to 1.100 s ago"), "{:?}", legend(&figure));
    let layers = &figure.panels[0].layers;
    let [Layer::Arcs { turns, .. }, Layer::Boxes { boxes, .. }, _, Layer::Marks { points, .. }, ..] =
        &layers[..]
    else {
        panic!("{layers:?}")
    };
    // 1500 m/s and at most 0.1 m/s more or less, for 0.2 s, around where it left.
    assert!((turns[0].at[0] - 310.0).abs() < 0.02 && (turns[0].at[1] - 20.0).abs() < 1e-9, "{turns:?}");
    assert_eq!((&boxes[..], &points[..]), (&[[-3.0, 3.0, -2.0, 4.0]][..], &[[0.0, 1.0], [1.0, 0.0]][..]));
    // The same scale along both axes.
    let panel = &figure.panels[0];
    let scale = (panel.x.last - panel.x.first) / panel.width_px;
    assert!((scale - (panel.y.last - panel.y.first) / 420.0).abs() < 1e-9);
}

#[test]
fn links_are_those_of_the_second_before_and_counts_those_of_every_second() {
    let rows = [
        truth(0, 0),
        truth(1, 0),
        truth(2, 0),
        heard(100_000_000, 0, 2),
        heard(1_100_000_000, 0, 1),
        heard(1_200_000_000, 1, 0),
        heard(1_300_000_000, 0, 1),
        heard(1_900_000_000, 2, 1),
        truth(0, 3),
    ];
    let figure = figure(Kind::Links, at(1.95), &rows).unwrap();
    let words = legend(&figure);
    for told in ["hear each other: 1 pairs", "one hears the other: 1", "heard once or more: 3"] {
        assert!(words.contains(&told), "{told}: {words:?}");
    }
    let Layer::Marks { points, .. } = &figure.panels[1].layers[0] else { panic!() };
    assert_eq!(points[..], [[1.0, 0.0], [0.0, 1.0], [1.0, 2.0]]);
    let [Layer::Line { points: receptions, .. }, Layer::Line { points: pairs, .. }] =
        &figure.panels[2].layers[..]
    else {
        panic!()
    };
    assert_eq!(receptions[..2], [[0.5, 1.0], [1.5, 4.0]]);
    assert_eq!(pairs[..2], [[0.5, 1.0], [1.5, 3.0]]);
}

#[test]
fn where_there_is_nothing_to_show_a_sentence_says_so() {
    for kind in [Kind::Widths, Kind::Map, Kind::Links] {
        let why = figure(kind, Of::default(), &[]).unwrap_err();
        assert!(why.starts_with("nothing to show: "), "{kind:?}: {why}");
    }
    assert!(figure(Kind::Tubes, of_auv(0), &[]).unwrap_err().contains("AUV 0 reported nothing"));
    let why = figure(Kind::Tubes, of_auv(9), &[]).unwrap_err();
    assert!(why.contains("there is no AUV 9: the record has 3"), "{why}");
}
