//! It heeds its logs and nothing else.

use shoal_bus::message::{Bounds, Estimator as Orders, Event, Measured, MediumAccess};

use super::*;
use crate::newborn::{PERIOD_NS, newborn};

fn exactly(value: f64) -> Measured {
    Measured { value, error: 0.0 }
}

#[test]
fn it_grows_for_ever_whatever_it_is_told_of_its_place() {
    let mut born = newborn(MediumAccess::Silent);
    born.orders.estimator = Orders::DeadReckoning;
    born.body.disturbance_m_s = [Bounds::new(-0.1, 0.1); 3];
    let mut reckoning = DeadReckoning::new(&born);
    let mut width_m = 0.0;
    for tick in 0..100 {
        let stamp = LocalTime::from_ns((tick + 1) * PERIOD_NS);
        let log =
            Sense::Inertial { heading_rad: exactly(0.0), pitch_rad: exactly(0.0), speed_m_s: exactly(1.0) };
        let fix = Sense::Gnss { position_m: [Bounds::default(); 3], time_s: Bounds::default() };
        let senses = [log, Sense::Depth { depth_m: exactly(0.0) }, fix];
        let events = senses.map(|sense| Event { stamp, sense }).to_vec();
        let estimate = reckoning.update(&Sensed { tick: tick as u64, stamp, events });
        let east_m = estimate.state.position_m[0];
        let gone_m = 0.1 * (tick + 1) as f64;
        // At full speed from the first log on; before it the AUV stood or went, it does not know.
        assert!(east_m.contains(gone_m) && estimate.emptied.is_none(), "{east_m} at {gone_m} m");
        assert!(estimate.state.position_m.width() > width_m);
        width_m = estimate.state.position_m.width();
    }
    assert!(width_m > 2.0 * 0.1 * 10.0 * 0.99, "{width_m}");
}
