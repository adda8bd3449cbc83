//! One vehicle's mind: estimator, controller and modem, tick by tick.

use shoal_bus::lockstep::Mind;
use shoal_bus::message::{
    Acted, Around, Born, Culprit, Emptied, Estimator as EstimatorOrders, Report, Sabotage, Sensed, Setpoint,
    Slice,
};
use shoal_bus::time::NS_PER_S;

use crate::bounds::{bounds, bounds_box};
use crate::controller::{self, Belief, Controller};
use crate::dead_reckoning::DeadReckoning;
use crate::ekf::Ekf;
use crate::estimator::{Estimate, Estimator, Prediction};
use crate::modem::Modem;
use crate::relative::Neighbourhood;
use crate::sabotage;
use crate::set_observer::SetObserver;
use crate::state::State;
use crate::tube_estimator::TubeEstimator;

/// An AUV's mind. All it ever learns is [`Born`] and [`Sensed`], all it ever does is [`Acted`].
pub struct Auv {
    born: Born,
    estimator: Box<dyn Estimator>,
    controller: Box<dyn Controller>,
    neighbourhood: Option<Neighbourhood>,
    modem: Modem,
    lead_s: f64,
}

impl Auv {
    /// The mind of a newborn.
    pub fn new(born: &Born) -> Self {
        let believed = sabotage::believed(born);
        let estimator: Box<dyn Estimator> = match born.orders.estimator {
            EstimatorOrders::Tube(settings) if SetObserver::is_asked_for(born, &settings) => {
                Box::new(SetObserver::new(&believed, &settings))
            }
            EstimatorOrders::Tube(_) => Box::new(TubeEstimator::new(&believed)),
            EstimatorOrders::Ekf(settings) => Box::new(Ekf::new(&believed, settings)),
            EstimatorOrders::DeadReckoning => Box::new(DeadReckoning::new(&believed)),
        };
        let orders = &born.orders;
        let lead_ns = born.wake.reaction_ns + born.wake.period_ns / 2;
        Self {
            estimator,
            controller: controller::ordered(&orders.controller, &born.prior_position_m, &orders.area_m),
            neighbourhood: orders.relative.map(|relative| Neighbourhood::new(&believed, relative)),
            modem: Modem::new(born),
            lead_s: lead_ns as f64 / NS_PER_S as f64,
            born: born.clone(),
        }
    }

    fn belief(&self, estimate: &Estimate, now: &Prediction) -> Belief {
        let state = self.estimator.likeliest().unwrap_or(estimate.state);
        Belief {
            time_s: now.time_s.mid(),
            position_m: state.position_m.mid(),
            box_width_m: state.position_m.width(),
            velocity_m_s: now.velocity_m_s.mid(),
            lead_s: self.lead_s,
        }
    }

    /// The neighbours that it follows.
    fn around(&self, state: &State) -> Vec<Around> {
        let around = self.neighbourhood.iter().flat_map(|neighbourhood| neighbourhood.around(state));
        around.map(|(auv, at_m)| Around { auv, position_m: at_m.sides().map(bounds) }).collect()
    }

    /// The estimate as it is reported; clock offsets are told against stamps, which may be off by the stamp's tolerance.
    fn report(&self, sensed: &Sensed, estimate: &Estimate, neighbours: u16) -> Report {
        let stamp_s = self.born.clock.stamp_ns as f64 * 1e-9;
        let offset_s = |state: &State| bounds(state.offset_s.inflate(stamp_s));
        let mut emptied = estimate.emptied;
        if self.born.orders.sabotage == Some(Sabotage::EmptySet) && sensed.tick == sabotage::EMPTYING_TICK {
            emptied = Some(Emptied { stamp: sensed.stamp, by: Culprit::Sabotage });
        }
        Report {
            position_m: bounds_box(&estimate.state.position_m),
            clock_offset_s: offset_s(&estimate.state),
            slice: Slice {
                position_m: bounds_box(&estimate.slice.position_m),
                clock_offset_s: offset_s(&estimate.slice),
            },
            emptied,
            neighbours,
            around: self.around(&estimate.state),
            contractions: estimate.contractions,
            rejected: estimate.rejected,
            components: estimate.components,
            gaussian: estimate.gaussian,
        }
    }
}

impl Mind for Auv {
    fn step(&mut self, sensed: &Sensed) -> Acted {
        let estimate = self.estimator.update(sensed);
        if let Some(neighbourhood) = &mut self.neighbourhood {
            neighbourhood.update(sensed, &estimate.state);
        }
        let now = self.estimator.predict(sensed.stamp);
        let steering = self.controller.steer(sensed, &self.belief(&estimate, &now));
        let through_water_m_s =
            (steering.velocity_m_s - now.current_m_s.mid()).cap_magnitude(self.born.body.speed_m_s);

        let mut pings = Vec::new();
        for booking in self.modem.due(sensed, &|at| self.estimator.predict(at).time_s) {
            let mut prediction = self.estimator.predict(booking.at);
            if self.born.orders.sabotage == Some(Sabotage::LyingPing) {
                sabotage::lie(&mut prediction);
            }
            pings.extend(self.modem.plan(booking, &prediction));
        }
        Acted {
            tick: sensed.tick,
            setpoint: Setpoint { velocity_m_s: through_water_m_s.into() },
            pings,
            report: self.report(sensed, &estimate, steering.neighbours),
        }
    }
}
