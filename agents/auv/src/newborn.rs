//! An AUV for tests to change: at the origin, 100 ms between ticks, nothing known of anyone else.

use shoal_bus::message::{
    AuvId, BodyBounds, Born, Bounds, ClockBounds, Controller, Estimator, MediumAccess, ModemBounds, Orders,
    TubeSettings, Wake,
};
use shoal_bus::time::LocalTime;

/// Local nanoseconds between its ticks.
pub const PERIOD_NS: i64 = 100_000_000;

/// It is born at local time zero and pings by `access`.
pub fn newborn(access: MediumAccess) -> Born {
    let none = Bounds::default();
    Born {
        auv: AuvId(0),
        group: 0,
        name: "test-0".to_owned(),
        wake: Wake {
            first_tick: LocalTime::from_ns(PERIOD_NS),
            period_ns: PERIOD_NS,
            reaction_ns: PERIOD_NS,
        },
        clock: ClockBounds { drift: 1e-4, offset_s: none, stamp_ns: 2 },
        birth: LocalTime::ZERO,
        prior_position_m: [none; 3],
        body: BodyBounds {
            speed_m_s: 2.0,
            acceleration_m_s2: 1.0,
            current_m_s: [none; 3],
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: [none; 3],
        },
        modem: ModemBounds {
            range_m: 1_000.0,
            hearing_range_m: 1_000.0,
            sound_speed_m_s: Bounds::new(1_500.0, 1_500.0),
            sound_speed_is_constant: false,
            timestamp_s: 1e-5,
            frame_bytes: 64,
        },
        orders: Orders {
            estimator: Estimator::Tube(TubeSettings::forward(100 * PERIOD_NS)),
            controller: Controller::Hold,
            access,
            area_m: [Bounds::new(-1e4, 1e4); 3],
            sabotage: None,
            relative: None,
        },
    }
}
