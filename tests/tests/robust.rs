//! Robust estimators among real errors: echoes taken for pings, an unknown start, a kidnapping.

use std::collections::VecDeque;

use shoal_auv::Auv;
use shoal_bus::chronicle::What;
use shoal_bus::message::{Report, box_width};
use shoal_bus::summary::Summary;
use shoal_bus::traffic::Fate;
use shoal_scenario::model::{Estimator, Noise, Scenario, TubeSettings};
use shoal_tests::{library_scenario, run_local, run_local_watched};

fn tubes(scenario: &mut Scenario, change: impl Fn(&mut TubeSettings)) {
    for group in &mut scenario.groups {
        if let Estimator::Tube(settings) = &mut group.estimator {
            change(settings);
        }
    }
}

/// Runs a scenario, and gives back what `auv` reported, by true time in seconds.
fn reports(scenario: &Scenario, auv: u32) -> (Summary, Vec<(f64, Report)>) {
    let mut reports = Vec::new();
    let summary = run_local_watched(scenario, None, Auv::new, |entry| {
        if let What::Acted(acted) = &entry.what
            && entry.auv.0 == auv
        {
            reports.push((entry.at.as_s(), acted.report.clone()));
        }
    });
    (summary.unwrap(), reports)
}

const WINDOW: u16 = 20;
const TOLERATED: u16 = 9;

/// What one AUV heard.
#[derive(Clone, Default)]
struct Heard {
    last: VecDeque<bool>,
    pings: u32,
    echoes: u32,
    /// More echoes than tolerated in some window.
    is_beyond: bool,
}

impl Heard {
    fn hear(&mut self, is_echo: bool) {
        self.last.push_back(is_echo);
        if self.last.len() > usize::from(WINDOW) {
            self.last.pop_front();
        }
        self.pings += 1;
        self.echoes += u32::from(is_echo);
        self.is_beyond |= self.last.iter().filter(|wrong| **wrong).count() > usize::from(TOLERATED);
    }
}

/// Runs a scenario; also tells what each AUV heard.
fn run_listening(scenario: &Scenario) -> (Summary, Vec<Heard>) {
    let mut heard = vec![Heard::default(); scenario.auv_count() as usize];
    let summary = run_local_watched(scenario, None, Auv::new, |entry| {
        let What::Traffic(traffic) = &entry.what else { return };
        let Fate::Heard { outlier, .. } = traffic.fate else { return };
        heard[entry.auv.0 as usize].hear(outlier);
    });
    (summary.unwrap(), heard)
}

#[test]
fn echoes_mislead_nobody_who_tolerates_them() {
    let (mut kept_runs, mut auvs, mut beyond) = (0, 0, 0);
    let (mut pings, mut echoes, mut misled_by_all) = (0, 0, [0; 2]);
    for seed in 1..=8 {
        let at = |name: &str| Scenario { seed, ..library_scenario(name) };
        let plain = run_local(&at("surface-bounce"), None);
        assert!(plain.containment.misled.violations > 1_000, "{seed}: {:?}", plain.containment.misled);
        let (robust, heard) = run_listening(&at("echoes"));
        let beyond_now = heard.iter().filter(|heard| heard.is_beyond).count();
        auvs += heard.len();
        beyond += beyond_now;
        pings += heard.iter().map(|heard| heard.pings).sum::<u32>();
        echoes += heard.iter().map(|heard| heard.echoes).sum::<u32>();
        assert_eq!(robust.containment.violations, 0, "{seed}: {:?}", robust.containment.first);
        let misled = robust.containment.misled;
        misled_by_all[0] += plain.containment.misled.violations;
        misled_by_all[1] += misled.violations;
        if beyond_now == 0 {
            kept_runs += 1;
            assert_eq!(misled.violations, 0, "{seed}: {misled:?}");
        } else {
            // Even then, few are.
            assert!(10 * misled.violations < plain.containment.misled.violations, "{seed}: {misled:?}");
        }
        let assumption = &robust.containment.assumptions[0];
        println!("{seed}: {beyond_now} AUVs beyond it, misled {}, {assumption:?}", misled.violations);
        assert!(
            assumption.pings > 40 && assumption.holds > 0.0 && assumption.holds < assumption.window_holds
        );
    }
    let share = f64::from(echoes) / f64::from(pings);
    println!(
        "{share:.3} of {pings} pings were echoes; {beyond} of {auvs} AUVs heard too many of them in some window; without the truth: \
         {} enclosures of plain tubes, {} of these",
        misled_by_all[0], misled_by_all[1]
    );
    assert!(kept_runs > 0);
}

#[test]
fn a_kidnapped_auv_finds_itself_again() {
    for noise in [Noise::Uniform, Noise::Adversarial] {
        let mut scenario = library_scenario("kidnapped");
        scenario.noise = noise;
        let (summary, reports) = reports(&scenario, 4);
        let containment = &summary.containment;
        let kidnapped = containment.kidnapped.unwrap();
        assert_eq!((kidnapped.kidnappings, kidnapped.noticed), (1, 1), "{kidnapped:?}");
        // Three of the four beacons' pings, of which there is one each 0.5 s, contradict what it believed.
        assert!(kidnapped.noticed_after_s.unwrap() < 4.0 && kidnapped.violations > 10, "{kidnapped:?}");
        // From then on it holds the truth again: violations after it are not excused.
        assert_eq!(containment.violations, 0, "{:?}", containment.first);
        let emptied: Vec<f64> =
            reports.iter().filter(|(_, report)| report.emptied.is_some()).map(|(at_s, _)| *at_s).collect();
        assert!(emptied.len() == 1 && emptied[0] > 20.0, "{emptied:?}");
        let width_m =
            |at_s: f64| box_width(&reports.iter().find(|(time_s, _)| *time_s >= at_s).unwrap().1.position_m);
        let notice_s = emptied[0];
        println!(
            "{noise:?}: before {:.1} m, noticed after {:.2} s, then {:.0} m, after 10 s {:.1} m, after 30 s {:.1} m",
            width_m(19.0),
            notice_s - 20.0,
            width_m(notice_s),
            width_m(notice_s + 10.0),
            width_m(notice_s + 30.0)
        );
        assert!(width_m(19.0) < 10.0 && width_m(notice_s) > 500.0 && width_m(notice_s + 10.0) < 10.0);
        assert!(reports.iter().any(|(at_s, report)| *at_s > notice_s && report.components > 1));
        assert_eq!(reports.last().unwrap().1.components, 1);
    }
}

#[test]
fn a_plain_tube_never_gets_over_a_kidnapping() {
    let mut scenario = library_scenario("kidnapped");
    tubes(&mut scenario, |settings| {
        settings.outliers = None;
        settings.on_empty = shoal_scenario::model::Recovery::Drop;
    });
    let summary = run_local(&scenario, None);
    // It notices, goes on as before, and is told so.
    assert_eq!(summary.containment.kidnapped.unwrap().noticed, 1);
    assert!(summary.containment.violations > 300);
}

#[test]
fn an_auv_that_knows_nothing_finds_where_it_is() {
    for noise in [Noise::Uniform, Noise::Adversarial] {
        for robust in [true, false] {
            let mut scenario = library_scenario("unknown-start");
            scenario.noise = noise;
            if !robust {
                tubes(&mut scenario, |settings| settings.outliers = None);
            }
            let (summary, reports) = reports(&scenario, 4);
            assert_eq!(summary.containment.violations, 0, "{:?}", summary.containment.first);
            let first = &reports[0].1;
            assert!(box_width(&first.position_m) > 999.0 && first.components == 1);
            let most = reports.iter().map(|(_, report)| report.components).max().unwrap();
            let found_s = reports.iter().find(|(_, report)| box_width(&report.position_m) < 10.0).unwrap().0;
            println!("{noise:?}, robust {robust}: up to {most} parts, found after {found_s:.1} s");
            // Without outliers, two rings and the depth leave one place at once.
            assert!((most > 1 || !robust) && found_s < 15.0, "{most} parts, found after {found_s} s");
            assert_eq!(reports.last().unwrap().1.components, 1);
            assert!(reports.iter().all(|(_, report)| report.emptied.is_none()));
        }
    }
}

/// Divers among beacons, that hear so many pings wrong by up to 0.2 s and tolerate so many of twenty.
fn among_liars(rate: f64, tolerated: u16, noise: &str, seed: u64) -> Scenario {
    let inlier_probability = 1.0 - rate;
    let text = format!(
        r#"
name = "liars"
seed = {seed}
duration_s = 40
noise = "{noise}"
[environment]
area_m = [[-500, 500], [-500, 500], [-60, 0]]
[[group]]
name = "beacon"
count = 4
modem = {{ ping_period_s = 1, range_m = 2000 }}
[group.sensors]
gnss = {{ depth_max_m = 5, period_s = 1, position_error_m = [0.5, 0.5, 0.5] }}
[group.start]
points_m = [[-400, -350, -1], [420, -380, -1], [380, 410, -1], [-390, 400, -1]]
box_width_m = 2
[[group]]
name = "diver"
count = 4
modem = {{ ping_period_s = false, outlier_rate = {rate}, outlier_delay_s = 0.2 }}
estimator = {{ name = "tube", outliers = {{ window = 20, tolerated = {tolerated}, inlier_probability = {inlier_probability} }}, on_empty = "relax" }}
controller = {{ name = "reynolds", speed_m_s = 1.5 }}
[group.start]
region_m = [[-200, 200], [-200, 200], [-50, -10]]
box_width_m = 10
"#
    );
    shoal_scenario::parse("liars.toml", &text).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

/// Zero violations as long as the assumption holds, at any rate; where it breaks, what was measured stands beside the bound.
#[test]
fn so_many_outliers_as_are_tolerated_cost_nothing() {
    let (mut kept_runs, mut broken_runs) = (0, 0);
    for (rate, enough, few) in [(0.01, 3, 0), (0.05, 5, 1), (0.1, 7, 2), (0.2, 9, 4)] {
        for (tolerated, noise, seed) in
            [(enough, "uniform", 1), (enough, "adversarial", 2), (few, "uniform", 3), (few, "adversarial", 4)]
        {
            let summary = run_local(&among_liars(rate, tolerated, noise, seed), None);
            let (containment, pings) = (&summary.containment, &summary.pings);
            // What an AUV states within its assumption is never excused.
            assert_eq!(containment.violations, 0, "{rate} {noise}: {:?}", containment.first);
            let assumed = &containment.assumptions[0];
            println!(
                "{rate}, {tolerated} of 20 tolerated, {noise}: {} of {} pings wrong, {:.4} of windows kept (bound {:.4}), \
                 {:.4} of reports hold the truth (bound {:.4}), {} violations apart",
                pings.outliers,
                pings.heard,
                assumed.windows_kept_fraction,
                assumed.window_holds,
                assumed.contained_fraction,
                assumed.holds,
                containment.misled.violations
            );
            // The beacons hear each other, and nothing wrong.
            let wrong = pings.outliers as f64 / (pings.heard as f64 * 16.0 / 28.0);
            assert!((wrong - rate).abs() < 0.4 * rate + 0.01, "{wrong} of the pings are wrong for {rate}");
            assert!((assumed.windows_kept_fraction - assumed.window_holds).abs() < 0.15);
            if assumed.windows_kept_fraction == 1.0 {
                kept_runs += 1;
                assert_eq!((containment.misled.violations, assumed.contained_fraction), (0, 1.0));
            } else {
                broken_runs += 1;
                assert!(assumed.contained_fraction >= assumed.holds);
            }
        }
    }
    assert!(kept_runs >= 4 && broken_runs >= 4, "{kept_runs} kept, {broken_runs} broken");
}
