//! From a scenario to the AUVs of a run: where each really is, and what it is told.

mod access;
mod bounds;

use nalgebra::Vector3;
use pxfm::f_sincos;
use shoal_bus::message::{
    AuvId, Born, Bounds, BoundsBox, ClockBounds, Controller, EkfSettings, Estimator, Fleetmates, Fusion,
    MediumAccess, Orders, Outliers, Recovery, Sabotage, TubeSettings, Wake,
};
use shoal_bus::time::SimTime;
use shoal_scenario::model::{self, AuvSabotage, FalseArrivals, Group, Place, Scenario};

use crate::bearing::BearingArray;
use crate::body::{Attitude, Body, Vec3};
use crate::clock::{STAMP_NS, TrueClock};
use crate::draw::{Draws, Purpose};
use crate::sensors::{Sensors, rounding};
use crate::water::Water;

/// An AUV at true time zero.
pub struct Newborn {
    /// Its true clock.
    pub clock: TrueClock,
    /// Its true body.
    pub body: Body,
    /// Its sensors.
    pub sensors: Sensors,
    /// Errors of its modem's timestamps.
    pub arrivals: Draws,
    /// Its array that measures where pings come from, if it has one.
    pub bearings: Option<BearingArray>,
    /// How often its modem takes something else for an arrival.
    pub false_arrivals: FalseArrivals,
    /// When it does.
    pub outliers: Draws,
    /// What it is told.
    pub born: Born,
}

/// Brings AUV `auv`, the `index`-th of group `group_index`, into the world.
pub fn newborn(scenario: &Scenario, water: &Water, auv: AuvId, group_index: u16, index: u32) -> Newborn {
    let group = &scenario.groups[usize::from(group_index)];
    let (seed, noise) = (scenario.seed, scenario.noise);
    let mut start = Draws::new(seed, Purpose::Start, auv, noise);
    let mut phase = Draws::new(seed, Purpose::Phase, auv, noise);

    let mut clock = TrueClock::new(&group.clock, scenario.knot_ns, seed, auv, noise);
    let birth = clock.read(SimTime::ZERO);
    let mut within = |period_ns: i64| 1 + (phase.unit() * (period_ns - 1) as f64) as i64;
    let first_tick = birth + within(group.control_period_ns);
    let first_ping_ns = access::drawn_within_ns(&group.modem.access).map(&mut within);
    let first_fix = birth + group.sensors.gnss.as_ref().map_or(0, |gnss| within(gnss.period_ns));

    let (position_m, attitude) = placed(group, index, &mut start);
    let prior_position_m = prior_box(scenario, group, &position_m, &mut start);
    let body = Body::new(
        &group.kind,
        water.current.clone(),
        scenario.knot_ns,
        position_m,
        attitude,
        (seed, auv, noise),
    );
    let first_ping = birth + first_ping_ns.unwrap_or(0);
    let access = access::orders(scenario, group, water, auv, first_ping, &mut phase);
    let offset_s = group.clock.offset_bound_s + 4.0 * STAMP_NS as f64 * 1e-9;
    let born = Born {
        auv,
        group: group_index,
        name: format!("{}-{index}", group.name),
        wake: Wake { first_tick, period_ns: group.control_period_ns, reaction_ns: group.reaction_ns },
        clock: ClockBounds {
            drift: group.clock.drift_bound,
            offset_s: Bounds::new(-offset_s, offset_s),
            stamp_ns: STAMP_NS,
        },
        birth,
        prior_position_m,
        body: bounds::body(scenario, group),
        modem: bounds::modem(scenario, group, water),
        orders: orders(scenario, group, index, access),
    };
    Newborn {
        clock,
        body,
        sensors: Sensors::new(&group.sensors, scenario.bottom_depth_m(), (seed, auv, noise), first_fix),
        arrivals: Draws::new(seed, Purpose::Arrival, auv, noise),
        bearings: group.modem.bearing_error_rad.map(|error_rad| {
            BearingArray::new(error_rad, group.sensors.heading_error_rad, (seed, auv, noise))
        }),
        false_arrivals: group.modem.outliers,
        outliers: Draws::new(seed, Purpose::Outlier, auv, noise),
        born,
    }
}

/// True position and attitude at the start.
fn placed(group: &Group, index: u32, draws: &mut Draws) -> (Vec3, Attitude) {
    let drawn_heading_rad = draws.between(-std::f64::consts::PI, std::f64::consts::PI);
    let mut heading_rad = group.start.heading_rad.map_or(drawn_heading_rad, first_turn);
    let mut pitch_rad = 0.0;
    let position_m = match &group.start.place {
        Place::Region(region) => Vector3::from_fn(|axis, _| draws.between(region[axis][0], region[axis][1])),
        Place::Points(points) => points.get(index as usize).copied().map_or_else(Vec3::zeros, Vec3::from),
        Place::Grid(grid) => {
            let [x, y, z] = grid.point_m(index);
            let mut beside = |coordinate_m: f64| {
                draws.between(coordinate_m - grid.scatter_m, coordinate_m + grid.scatter_m)
            };
            Vec3::new(beside(x), beside(y), z)
        }
        Place::OnCircle => {
            let Some((position_m, velocity_m_s)) = circle_start(group, index) else {
                return (
                    Vec3::zeros(),
                    Attitude { heading_rad, pitch_rad, speed_m_s: group.start.speed_m_s },
                );
            };
            heading_rad = pxfm::f_atan2(velocity_m_s.y, velocity_m_s.x);
            let horizontal_m_s = (velocity_m_s.x * velocity_m_s.x + velocity_m_s.y * velocity_m_s.y).sqrt();
            pitch_rad = pxfm::f_atan2(velocity_m_s.z, horizontal_m_s);
            position_m
        }
    };
    (position_m, Attitude { heading_rad, pitch_rad, speed_m_s: group.start.speed_m_s })
}

/// The same direction within the first turn, for angles of any size.
fn first_turn(angle_rad: f64) -> f64 {
    let (sin, cos) = f_sincos(angle_rad);
    pxfm::f_atan2(sin, cos)
}

/// Position and velocity on the group's circle at time zero.
fn circle_start(group: &Group, index: u32) -> Option<(Vec3, Vec3)> {
    let model::Controller::Circle { centre_m, radius_m, rate_rad_s, phase_rad, heave_m, heave_phase_rad } =
        &group.controller
    else {
        return None;
    };
    let angle_rad = phase_rad + spread_rad(group, index);
    let (sin, cos) = f_sincos(angle_rad);
    let (heave_sin, heave_cos) = f_sincos(angle_rad + heave_phase_rad);
    let position_m = Vec3::from(*centre_m) + Vec3::new(radius_m * cos, radius_m * sin, heave_m * heave_cos);
    let velocity_m_s = Vec3::new(-radius_m * sin, radius_m * cos, -heave_m * heave_sin) * *rate_rad_s;
    Some((position_m, velocity_m_s))
}

/// Angle by which the `index`-th AUV of a group is ahead of the first on their common circle.
fn spread_rad(group: &Group, index: u32) -> f64 {
    2.0 * std::f64::consts::PI * f64::from(index) / f64::from(group.count)
}

/// A box of drawn width that holds the true position anywhere inside it; the area for an AUV that is told none.
fn prior_box(scenario: &Scenario, group: &Group, position_m: &Vec3, draws: &mut Draws) -> BoundsBox {
    if !group.start.known {
        return scenario.environment.area_m.map(|[least, greatest]| Bounds::new(least, greatest));
    }
    let [narrowest, widest] = group.start.box_width_m;
    let width_m = draws.between(narrowest, widest);
    std::array::from_fn(|axis| {
        let below_m = 0.5 * width_m + draws.error(0.5 * width_m);
        let truth_m = position_m[axis];
        let slack_m = rounding(truth_m.abs() + width_m);
        Bounds::new(truth_m - below_m - slack_m, truth_m - below_m + width_m + slack_m)
    })
}

fn orders(scenario: &Scenario, group: &Group, index: u32, access: MediumAccess) -> Orders {
    Orders {
        estimator: estimator(&group.estimator),
        controller: controller(scenario, group, index),
        access,
        area_m: scenario.environment.area_m.map(|[least, greatest]| Bounds::new(least, greatest)),
        sabotage: group.sabotage.map(|sabotage| match sabotage {
            AuvSabotage::HalvedClock => Sabotage::HalvedClock,
            AuvSabotage::LyingPing => Sabotage::LyingPing,
            AuvSabotage::EmptySet => Sabotage::EmptySet,
        }),
        relative: group.relative.map(|of| bounds::relative(scenario, &of)),
    }
}

fn controller(scenario: &Scenario, group: &Group, index: u32) -> Controller {
    match group.controller.clone() {
        model::Controller::Hold => Controller::Hold,
        model::Controller::Station { speed_m_s } => {
            let points_m = group.start.place.point_m(index).into_iter().collect();
            Controller::Waypoints { points_m, speed_m_s, reach_m: 0.0, repeat: false }
        }
        model::Controller::Circle { centre_m, radius_m, rate_rad_s, phase_rad, heave_m, heave_phase_rad } => {
            let phase_rad = phase_rad + spread_rad(group, index);
            Controller::Circle { centre_m, radius_m, rate_rad_s, phase_rad, heave_m, heave_phase_rad }
        }
        model::Controller::Waypoints { points_m, speed_m_s, reach_m, repeat } => {
            Controller::Waypoints { points_m, speed_m_s, reach_m, repeat }
        }
        model::Controller::Reynolds {
            speed_m_s,
            separation,
            cohesion,
            alignment,
            margin_m,
            forget_ns,
            trusts,
        } => {
            let trusts = trusts.iter().map(|&group| fleetmates(scenario, group)).collect();
            Controller::Reynolds { speed_m_s, separation, cohesion, alignment, margin_m, forget_ns, trusts }
        }
    }
}

/// The AUVs of a group.
fn fleetmates(scenario: &Scenario, group: u16) -> Fleetmates {
    let (before, from) = scenario.groups.split_at(usize::from(group));
    let first = AuvId(before.iter().map(|group| group.count).sum());
    Fleetmates { first, count: from.first().map_or(0, |group| group.count) }
}

/// How an AUV estimates, as it is told.
fn estimator(of: &model::Estimator) -> Estimator {
    match *of {
        model::Estimator::Tube(of) => Estimator::Tube(TubeSettings {
            horizon_ns: of.horizon_ns,
            rings: of.rings,
            stopping_ratio: of.stopping_ratio,
            outliers: of.outliers.map(|of| Outliers {
                window: of.window,
                tolerated: of.tolerated,
                margin: of.margin,
            }),
            on_empty: match of.on_empty {
                model::Recovery::Drop => Recovery::Drop,
                model::Recovery::Relax => Recovery::Relax,
                model::Recovery::Restart => Recovery::Restart,
            },
        }),
        model::Estimator::Ekf(of) => Estimator::Ekf(EkfSettings {
            gate_sigma: of.gate_sigma,
            fusion: match of.fusion {
                model::Fusion::Independent => Fusion::Independent,
                model::Fusion::CovarianceIntersection => Fusion::CovarianceIntersection,
            },
        }),
        model::Estimator::DeadReckoning => Estimator::DeadReckoning,
    }
}
