//! Reciprocity, causality, order and energy.

use std::collections::BTreeMap;

use shoal_bus::traffic::{Reception, SoundPath};
use shoal_channel::acoustics::ray::WaterColumn;
use shoal_channel::budget::Link;
use shoal_channel::water::Water;
use shoal_scenario::model::{
    Controller, CurrentField, Fading, FadingKind, FadingPer, MediumAccess, Place, Scenario,
};

use crate::runs::{random_sea, sea, shown};

fn column(scenario: &Scenario) -> WaterColumn {
    Water::new(scenario).unwrap().column.unwrap()
}

/// A random sea in which nobody moves, all have one modem, and nothing fades.
fn still_sea(number: u64) -> Scenario {
    let mut scenario = random_sea(number, 20.0);
    let environment = &mut scenario.environment;
    (environment.current_m_s, environment.current_error_m_s) = ([0.0; 3], [0.0; 3]);
    environment.current_field = CurrentField::Uniform;
    sea(&mut scenario).fading = Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet };
    let area_m = scenario.environment.area_m;
    let mut modem = scenario.groups[0].modem.clone();
    modem.access = MediumAccess::Periodic { period_ns: 5_000_000_000, phase_ns: None };
    modem.duty_cycle = None;
    modem.outliers.rate = 0.0;
    if let Some(layer) = &mut modem.physical {
        layer.source_level_db = 190.0;
    }
    scenario.faults.clear();
    for group in &mut scenario.groups {
        group.modem = modem.clone();
        group.kind.disturbance_m_s = [0.0; 3];
        group.kind.speed_max_m_s = 1e-12;
        group.start.speed_m_s = 0.0;
        group.controller = Controller::Hold;
        // On the surface, a nanometre of motion decides whether there is water above.
        group.start.place = Place::Region(area_m.map(|[least, most]| {
            let rim_m = 0.01 * (most - least);
            [least + rim_m, most - rim_m]
        }));
    }
    scenario
}

/// Another way's path, and itself for those that are the same backwards.
fn backwards(path: SoundPath) -> SoundPath {
    match path {
        SoundPath::Bounced { first, bounces } if bounces % 2 == 0 => {
            SoundPath::Bounced { first: first.other(), bounces }
        }
        path => path,
    }
}

#[test]
fn still_bodies_hear_each_other_alike_and_as_the_rays_and_the_budget_say() {
    let (mut pairs, mut direct) = (0, 0);
    for number in 0..40 {
        let mut scenario = still_sea(number);
        let (shown, _) = shown(&scenario);
        let water = column(&scenario);
        let physical = scenario.groups[0].modem.physical.unwrap();
        let link = Link::new(sea(&mut scenario), &physical, &physical);
        let mut ways = BTreeMap::new();
        for passage in &shown.heard {
            ways.insert((passage.from, passage.to, passage.reception.path), passage);
            if passage.reception.path != SoundPath::Direct {
                continue;
            }
            direct += 1;
            let (from, to) = (shown.places_m[&passage.from], shown.places_m[&passage.to]);
            let (east_m, north_m) = (to[0] - from[0], to[1] - from[1]);
            let range_m = (east_m * east_m + north_m * north_m).sqrt();
            let Some(ray) = water.direct(-from[2], -to[2], range_m, None) else {
                panic!(
                    "{number}: no ray {from:?} {to:?} {passage:?} {:?} {}",
                    water.profile(),
                    water.bottom_depth_m()
                )
            };
            assert!((ray.travel_s - passage.travel_s).abs() < 2e-9, "{number}: {passage:?} {ray:?}");
            let level_db = link.level_db(ray.length_m, 0.0);
            assert!((level_db - passage.reception.level_db).abs() < 1e-6, "{number}: {passage:?} {level_db}");
            assert!((passage.reception.doppler - 1.0).abs() < 1e-12);
        }
        for (&(from, to, path), there) in &ways {
            let Some(back) = ways.get(&(to, from, backwards(path))) else { continue };
            pairs += 1;
            // Each is rounded up to a whole nanosecond; bounced paths are found to a microsecond.
            let near_s = if path == SoundPath::Direct { 1.1e-9 } else { 1e-6 };
            assert!((there.travel_s - back.travel_s).abs() < near_s, "{number}: {there:?} {back:?}");
            assert!((there.reception.level_db - back.reception.level_db).abs() < 1e-6, "{there:?} {back:?}");
            assert!((there.range_m - back.range_m).abs() < 1e-9);
        }
    }
    println!("{pairs} pairs of ways, {direct} direct passages");
    assert!(pairs > 300 && direct > 500, "{pairs} {direct}");
}

#[test]
fn nobody_hears_before_sound_can_be_there_or_louder_than_the_source() {
    let mut heard = 0;
    for number in 0..120 {
        let mut scenario = random_sea(500 + number, 20.0);
        let gaussian = matches!(sea(&mut scenario).fading.kind, FadingKind::Gaussian)
            || sea(&mut scenario).fading.per == FadingPer::Bit;
        let (shown, _) = shown(&scenario);
        let (_, fastest_m_s) = column(&scenario).profile().speed_bounds_m_s(f64::NEG_INFINITY, f64::INFINITY);
        let mut last_ns = BTreeMap::new();
        heard += shown.heard.len();
        let mut in_order = shown.heard.clone();
        in_order.sort_by_key(|passage| (passage.from, passage.sequence, passage.to));
        for passage in &in_order {
            // A nanosecond of travel and what the receiver moves in it.
            let soonest_s = passage.range_m / fastest_m_s - 3e-9;
            assert!(passage.travel_s >= soonest_s && passage.travel_s >= 0.0, "{number}: {passage:?}");
            // A ping overtakes nothing that takes the same path.
            let arrived_ns = passage.emitted_ns + (passage.travel_s * 1e9).round() as i64;
            let key = (passage.from, passage.to, passage.reception.path);
            if let Some(before_ns) = last_ns.insert(key, arrived_ns) {
                assert!(before_ns < arrived_ns, "{number}: {passage:?} overtook");
            }
        }
        let mut source_db = Vec::new();
        for group in &scenario.groups {
            let level_db = group.modem.physical.unwrap().source_level_db;
            source_db.extend((0..group.count).map(|_| level_db));
        }
        for (from, reception) in &shown.receptions {
            let Reception { level_db, sinr_db, doppler, .. } = *reception;
            assert!(
                level_db.is_finite() && sinr_db.is_finite() && (0.9..1.1).contains(&doppler),
                "{reception:?}"
            );
            // Fading lifts a packet by 16 dB at most: one in 2^53 gets more.
            let luck_db = if gaussian { 0.0 } else { 18.7 };
            assert!(level_db <= source_db[*from as usize] + luck_db, "{number}: {from} {reception:?}");
        }
    }
    assert!(heard > 3_000, "{heard}");
}
