use shoal_bus::record::RecordedAuv;

use super::*;

fn header(text: &str) -> RecordHeader {
    let auv = |name: &str, group: u16, group_name: &str| RecordedAuv {
        name: name.to_owned(),
        group,
        group_name: group_name.to_owned(),
        length_m: 2.0,
    };
    RecordHeader {
        scenario_name: "swarm-1000".to_owned(),
        seed: 3,
        scenario_text: text.to_owned(),
        auvs: vec![auv("blue-0", 0, "blue"), auv("green-0", 1, "green"), auv("red-0", 2, "red")],
    }
}

#[test]
fn ranges_and_area_are_those_of_the_scenario() {
    let (_, text) = shoal_scenario::load("swarm-1000").unwrap();
    let cast = Cast::new(&header(&text), false);
    assert!(!cast.needs_receptions());
    assert_eq!(cast.auvs(), 3);
    let ranges: Vec<_> = cast.groups.iter().map(|group| (group.name.as_str(), group.range_m)).collect();
    assert_eq!(ranges, [("blue", Some(250.0)), ("green", Some(120.0)), ("red", Some(400.0))]);
    assert_eq!(cast.groups.iter().map(|group| group.ping_period_s).collect::<Vec<_>>(), [Some(1.0); 3]);
    assert_eq!(cast.area_m, Some([[0.0, 1000.0], [0.0, 1000.0], [-1000.0, 0.0]]));
}

#[test]
fn at_sea_there_is_no_sharp_range() {
    let (_, text) = shoal_scenario::load("crowded-band").unwrap();
    let cast = Cast::new(&header(&text), false);
    assert!(cast.needs_receptions());
    assert_eq!(cast.groups[0].range_m, None);
}

#[test]
fn a_scenario_that_cannot_be_read_costs_ranges_only() {
    let cast = Cast::new(&header("from = 'the future'"), true);
    assert_eq!((cast.auvs(), cast.area_m, cast.duration_s), (3, None, None));
    assert!(cast.needs_receptions());
}
