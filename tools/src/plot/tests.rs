//! Tests of the figures of records.

mod moments;

use std::io::Cursor;

use clap::Parser;
use shoal_bus::chronicle::{Entry, Truth, What};
use shoal_bus::message::AuvId;
use shoal_bus::record::{RecordHeader, RecordWriter, RecordedAuv};
use shoal_bus::time::{LocalTime, SimTime};
use shoal_bus::traffic::{Boundary, Fate as Became, LossReason, Reception, SoundPath, Traffic};

use super::*;
use crate::cli::{Cli, Command};
use crate::figure::assert_well_formed;

const SEA: &str = r#"
name = "made-up"
duration_s = 10

[environment]
area_m = [[0, 4000], [0, 4000], [-200, 0]]
level = "sea"

[environment.sea]
sound_speed = "summer-thermocline"
bottom_depth_m = 200

[[group]]
name = "a"
count = 2
kind = "lauv"
clock = "tcxo"
controller = { name = "hold" }
modem = "evologics-18-34"
start = { region_m = [[0, 4000], [0, 4000], [-190, -5]], box_width_m = [5, 10] }
"#;

/// The record of two AUVs at 20 m and 30 m and these pings, each at its second.
fn record(scenario_text: &str, fates: Vec<Became>) -> Vec<u8> {
    let auv =
        |index| RecordedAuv { name: format!("a-{index}"), group: 0, group_name: "a".into(), length_m: 2.0 };
    let header = RecordHeader {
        scenario_name: "made-up".into(),
        seed: 4,
        scenario_text: scenario_text.into(),
        auvs: vec![auv(0), auv(1)],
    };
    let mut writer = RecordWriter::create(Vec::new(), &header).unwrap();
    for (second, fate) in fates.into_iter().enumerate() {
        let at = SimTime::from_ns(second as i64 * 1_000_000_000);
        let tick = |auv: u32| Entry {
            at,
            auv: AuvId(auv),
            what: What::Truth(Truth {
                tick: second as u64,
                local: LocalTime::from_ns(at.ns()),
                position_m: [0.0, 0.0, -20.0 - 10.0 * f64::from(auv)],
                velocity_m_s: [0.0; 3],
                heading_rad: 0.0,
                pitch_rad: 0.0,
            }),
        };
        let traffic = Traffic { at: at + 1, from: AuvId(0), sequence: second as u32, fate };
        let ping = Entry { at: at + 1, auv: AuvId(0), what: What::Traffic(traffic) };
        writer.append(&[tick(0), tick(1), ping]).unwrap();
    }
    drop(writer.advance(SimTime::from_ns(60_000_000_000)));
    writer.finish(&summary()).unwrap()
}

fn summary() -> shoal_bus::summary::Summary {
    let text = r#"{"format":"shoal.summary/1","scenario":"made-up","seed":4,"reproducible":true,"auvs":2,"sim_s":60.0,"wakes":0,
        "digest":"blake3:00","containment":{"checks":0,"violations":0},
        "position_width_m":{"start_median":0.0,"end_median":0.0,"end_max":0.0},
        "clock_width_s":{"start_median":0.0,"end_median":0.0,"end_max":0.0},
        "pings":{"emitted":0,"heard":0,"in_flight":0,
            "lost":{"range":0,"noise":0,"collision":0,"half_duplex":0,"late":0,"dead":0}},
        "flock":{"polarization":0.0,"min_separation_m":null,"collisions":0,"connectivity":0.0},
        "agents":{"lost":[],"restarted":[]}}"#;
    serde_json::from_str(text).unwrap()
}

fn reception(path: SoundPath, sinr_db: f64) -> Option<Reception> {
    Some(Reception { path, level_db: 100.0, sinr_db, doppler: 1.0 })
}

fn heard(range_m: f64, reception: Option<Reception>, outlier: bool) -> Became {
    let travel_s = range_m / if outlier { 1400.0 } else { 1520.0 };
    Became::Heard { to: AuvId(1), range_m, travel_s, box_width_m: 5.0, reception, outlier }
}

/// One emission; three pings heard directly and two off the surface, which are outliers; two collisions, a shadow, one
/// out of range and one that never left.
fn fates() -> Vec<Became> {
    let surface = SoundPath::Bounced { first: Boundary::Surface, bounces: 1 };
    let lost = |reason, range_m| Became::lost(Some(AuvId(1)), reason, range_m);
    let collision = |range_m, sinr_db| Became::Lost {
        to: Some(AuvId(1)),
        reason: LossReason::Collision,
        range_m,
        reception: reception(SoundPath::Direct, sinr_db),
        colliding: vec![AuvId(0)],
    };
    vec![
        Became::Emitted {
            position_m: [0.0, 0.0, -20.0],
            bytes: 32,
            box_width_m: 5.0,
            beyond_range: 7,
            packet_s: 0.1,
        },
        heard(100.0, reception(SoundPath::Direct, 30.0), false),
        heard(200.0, reception(SoundPath::Direct, 20.0), false),
        heard(300.0, reception(SoundPath::Direct, 10.0), false),
        heard(400.0, reception(surface, 12.0), true),
        heard(500.0, reception(surface, 11.0), true),
        collision(600.0, -3.0),
        collision(700.0, -6.0),
        lost(LossReason::Shadow, 800.0),
        lost(LossReason::Range, 9000.0),
        Became::lost(None, LossReason::Late, 0.0),
    ]
}

fn draw_kind(kind: &str, record: &[u8], more: &[&str]) -> Result<String, String> {
    let Command::Plot(args) =
        Cli::try_parse_from([&["shoal", "plot", "r", kind], more].concat()).unwrap().command
    else {
        panic!("another command");
    };
    let (svg, ending) = draw_one(Cursor::new(record), plot_of(args.kind, &args.of))?;
    assert_eq!(ending, Ending::Complete);
    assert_well_formed(&svg);
    Ok(svg)
}

/// How many marks of a shape and a colour a figure has, without the one in its legend.
fn marks(svg: &str, shape: &str, colour: &str) -> usize {
    let groups =
        svg.split("<g ").filter(|group| group.lines().next().is_some_and(|head| head.contains(colour)));
    let used = format!("<use href=\"#{shape}\"");
    groups.map(|group| group.split("</g>").next().unwrap().matches(&used).count()).sum::<usize>() - 1
}

const BLUE: &str = "#0072b2";
const VERMILLION: &str = "#d55e00";

#[test]
fn ranges_mark_every_ping_that_was_heard() {
    let svg = draw_kind("ranges", &record(SEA, fates()), &[]).unwrap();
    assert_eq!((marks(&svg, "disc", BLUE), marks(&svg, "cross", VERMILLION)), (3, 2));
    for words in ["direct: 3", "off the surface, outlier: 2", "made-up, seed 4, 2 AUVs", "true range (m)"] {
        assert!(svg.contains(words), "{words}");
    }
}

#[test]
fn reach_marks_every_ping_that_came_to_a_receiver_at_its_depth() {
    let svg = draw_kind("reach", &record(SEA, fates()), &[]).unwrap();
    let found = [("disc", BLUE), ("cross", VERMILLION), ("plus", "#000000")];
    assert_eq!(found.map(|(shape, colour)| marks(&svg, shape, colour)), [5, 2, 1]);
    assert!(svg.contains("out of range, not drawn: 8"), "{svg}");
    // All receivers are at 30 m, on an axis from 0 to 4 percent beyond.
    let height =
        |line: &str| line.split("y=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap();
    let in_panel = svg.split("clip-path=").nth(1).unwrap().split("</g><rect").next().unwrap();
    let heights: Vec<f64> = in_panel.lines().filter(|line| line.starts_with("<use")).map(height).collect();
    assert_eq!(heights.len(), 8);
    assert!(heights.iter().all(|y| (y - (60.0 + 420.0 / 1.04)).abs() < 2e-3), "{heights:?}");
}

#[test]
fn sinr_marks_every_packet_that_has_one() {
    let svg = draw_kind("sinr", &record(SEA, fates()), &[]).unwrap();
    assert_eq!((marks(&svg, "disc", BLUE), marks(&svg, "cross", VERMILLION)), (5, 2));
    assert!(svg.contains("without a ratio, not drawn: 2"), "{svg}");
}

#[test]
fn losses_stack_a_bar_for_each_fate() {
    let svg = draw_kind("losses", &record(SEA, fates()), &[]).unwrap();
    let told =
        ["heard: 5", "lost by collision: 2", "lost in a shadow zone: 1", "out of range: 8", "never left: 1"];
    for words in told {
        assert!(svg.contains(words), "{words}");
    }
    // The events of eight seconds, one in each: eight bars.
    let in_panel = svg.split("clip-path=").nth(1).unwrap().split("</g><rect").next().unwrap();
    assert_eq!(in_panel.matches("<rect").count(), 8);
}

#[test]
fn bars_widen_and_keep_their_counts() {
    let mut losses = losses::Losses::default();
    let of_second = |second: i64| {
        let traffic = Traffic {
            at: SimTime::from_ns(second * 1_000_000_000),
            from: AuvId(0),
            sequence: 0,
            fate: heard(10.0, None, false),
        };
        Row::Ping(shoal_bus::record::rows::PingRow::new(&traffic))
    };
    (0..1000).for_each(|second| losses.take(&of_second(second)));
    let header =
        RecordHeader { scenario_name: "a".into(), seed: 0, scenario_text: String::new(), auvs: vec![] };
    let figure = Box::new(losses).figure(&header).unwrap();
    let crate::figure::Layer::Bars { bars, .. } = &figure.panels[0].layers[0] else { panic!() };
    // Bars of 10 s, with one reception in each second.
    assert_eq!(bars.len(), 100);
    assert!(
        bars.iter().all(|[from, to, bottom, top]| (to - from, *bottom, *top) == (10.0, 0.0, 1.0)),
        "{bars:?}"
    );
}

#[test]
fn rays_leave_the_first_emitter_or_where_they_are_told_to() {
    let record = record(SEA, fates());
    let svg = draw_kind("rays", &record, &[]).unwrap();
    assert!(svg.contains("source, 20.0 m deep") && svg.contains("sound speed (m/s)"), "{svg}");
    // Forty-one rays that are blue until they bounce, besides their line in the legend.
    assert_eq!(svg.matches(&format!("stroke=\"{BLUE}\"")).count(), 42);
    let deep = draw_kind("rays", &record, &["--depth-m", "150", "--range-m", "2000"]).unwrap();
    assert!(deep.contains("source, 150.0 m deep") && deep.contains(">2000<"));
    let too_deep = draw_kind("rays", &record, &["--depth-m", "250"]).unwrap_err();
    assert!(too_deep.contains("250 m is not in this water, which is 200 m deep"), "{too_deep}");
}

#[test]
fn a_figure_has_the_same_bytes_every_time() {
    let record = record(SEA, fates());
    for kind in ["losses", "ranges", "reach", "rays", "sinr"] {
        assert_eq!(draw_kind(kind, &record, &[]), draw_kind(kind, &record, &[]), "{kind}");
    }
}

#[test]
fn where_there_is_nothing_to_show_a_sentence_says_so() {
    let silent = record(SEA, vec![]);
    for kind in ["losses", "ranges", "reach", "sinr"] {
        let why = draw_kind(kind, &silent, &[]).unwrap_err();
        assert!(why.starts_with("nothing to show: "), "{kind}: {why}");
    }
    assert!(draw_kind("rays", &silent, &[]).unwrap_err().contains("--depth-m"));
    let ideal = shoal_scenario::load("swarm-3").unwrap().1;
    let ideal = record(&ideal, vec![heard(100.0, None, false)]);
    assert!(draw_kind("sinr", &ideal, &[]).unwrap_err().contains("none of 1 receptions"));
    assert!(draw_kind("rays", &ideal, &[]).unwrap_err().contains("rays are straight"));
    assert!(draw_kind("ranges", &ideal, &[]).is_ok());
    let foreign = record("no TOML", vec![heard(100.0, None, false)]);
    let why = draw_kind("ranges", &foreign, &[]).unwrap_err();
    assert!(why.contains("does not read the record's scenario"), "{why}");
}

#[test]
fn an_unknown_kind_is_refused_with_the_known_ones() {
    let refusal = Cli::try_parse_from(["shoal", "plot", "r", "loses"]).unwrap_err().to_string();
    for kind in Kind::value_variants() {
        assert!(refusal.contains(kind.to_possible_value().unwrap().get_name()), "{refusal}");
    }
    let args = ["shoal", "plot", "r", "losses", "--depth-m", "5"];
    let Command::Plot(args) = Cli::try_parse_from(args).unwrap().command else { panic!() };
    assert_eq!(plot(&args).unwrap_err().exit, Exit::Usage);
}
