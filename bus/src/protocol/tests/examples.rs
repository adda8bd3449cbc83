//! Messages as they are written in a run.

use std::fmt::Write;

use serde::Serialize;

use crate::lockstep::{FromAuv, ToAuv};
use crate::message::{
    Acted, Around, AuvId, BodyBounds, Born, Bounds, ClockBounds, Controller, Estimator, Event, Measured,
    MediumAccess, ModemBounds, Orders, PlannedPing, Report, Sense, Sensed, Setpoint, Slice, TubeSettings,
    Wake,
};
use crate::ping::{Frame, Ping};
use crate::protocol::{Dialect, Hello};
use crate::time::LocalTime;
use crate::zenoh::{Kind, Up, write_down};

pub fn made() -> String {
    let mut text = String::new();
    let (born, sensed, acted) = (ToAuv::Born(Box::new(born())), ToAuv::Sensed(vec![sensed()]), acted());
    json(&mut text, "`Born`", &born);
    json(&mut text, "`Sensed`, one tick with some of everything", &sensed);
    json(&mut text, "The answer to it", &FromAuv::Acted(vec![acted.clone()]));
    assert_eq!(
        Dialect::Json.read_acted(&Dialect::Json.write(&FromAuv::Acted(vec![acted.clone()])).unwrap(), 1),
        Ok(vec![acted])
    );
    writeln!(text, "`End`, in JSON: `\"End\"`\n").unwrap();
    writeln!(text, "Whole frames in hexadecimal, of an agent that chose the binary dialect:\n\n```text")
        .unwrap();
    let hello = Up { kind: Kind::Hello, sequence: 0, message: &Hello::new(Dialect::Binary).write() }.write();
    hexadecimal(&mut text, "hello", &hello);
    let quiet = ToAuv::Sensed(vec![Sensed {
        tick: 8,
        stamp: LocalTime::from_ns(890_000_000),
        events: vec![Event {
            stamp: LocalTime::from_ns(890_000_000),
            sense: Sense::Depth { depth_m: Measured { value: 12.5, error: 0.125 } },
        }],
    }]);
    hexadecimal(
        &mut text,
        "Sensed: tick 8 at 0.89 s, a depth of 12.5 ± 0.125 m",
        &write_down(9, &Dialect::Binary.write(&quiet).unwrap()),
    );
    hexadecimal(&mut text, "End", &write_down(10, &Dialect::Binary.write(&ToAuv::End).unwrap()));
    hexadecimal(&mut text, "received", &Up { kind: Kind::Received, sequence: 10, message: &[] }.write());
    writeln!(text, "```\n").unwrap();
    let heard = Ping::decode(&ping().encode().unwrap()).unwrap();
    writeln!(text, "A ping's frame, and what is read from it:\n\n```text").unwrap();
    hexadecimal(&mut text, "frame", ping().encode().unwrap().bytes());
    let Ping { sender, sequence, emission_s, position_m, velocity_m_s } = heard;
    writeln!(text, "sender {sender}, sequence {sequence}").unwrap();
    let mut side =
        |name: &str, of: &Bounds| writeln!(text, "{name} [{:?}, {:?}]", of.lower, of.upper).unwrap();
    side("emission_s", &emission_s);
    position_m.iter().for_each(|of| side("position_m", of));
    velocity_m_s.iter().for_each(|of| side("velocity_m_s", of));
    writeln!(text, "```").unwrap();
    text
}

fn json(text: &mut String, title: &str, message: &impl Serialize) {
    let value: serde_json::Value = serde_json::from_slice(&Dialect::Json.write(message).unwrap()).unwrap();
    writeln!(text, "{title}:\n\n```json").unwrap();
    shaped(text, &value, 0);
    writeln!(text, "\n```\n").unwrap();
}

/// JSON with what fits on one line on one line.
fn shaped(text: &mut String, value: &serde_json::Value, indent: usize) {
    let whole = value.to_string();
    let pad = " ".repeat(indent + 2);
    match value {
        serde_json::Value::Object(members) if whole.len() > 100 => {
            text.push_str("{\n");
            for (index, (key, value)) in members.iter().enumerate() {
                write!(text, "{}{pad}\"{key}\": ", if index > 0 { ",\n" } else { "" }).unwrap();
                shaped(text, value, indent + 2);
            }
            write!(text, "\n{}}}", " ".repeat(indent)).unwrap();
        }
        serde_json::Value::Array(items) if whole.len() > 100 => {
            text.push_str("[\n");
            for (index, value) in items.iter().enumerate() {
                write!(text, "{}{pad}", if index > 0 { ",\n" } else { "" }).unwrap();
                shaped(text, value, indent + 2);
            }
            write!(text, "\n{}]", " ".repeat(indent)).unwrap();
        }
        _ => text.push_str(&whole),
    }
}

fn hexadecimal(text: &mut String, title: &str, bytes: &[u8]) {
    writeln!(text, "{title}").unwrap();
    for line in bytes.chunks(24) {
        let bytes: Vec<String> = line.iter().map(|byte| format!("{byte:02x}")).collect();
        writeln!(text, "  {}", bytes.join(" ")).unwrap();
    }
}

fn around(middle: f64, error: f64) -> Bounds {
    Bounds::new(middle - error, middle + error)
}

fn born() -> Born {
    let still = Bounds::new(0.0, 0.0);
    Born {
        auv: AuvId(3),
        group: 2,
        name: "python-0".into(),
        wake: Wake {
            first_tick: LocalTime::from_ns(90_000_000),
            period_ns: 100_000_000,
            reaction_ns: 100_000_000,
        },
        clock: ClockBounds { drift: 5e-5, offset_s: around(0.0, 0.005), stamp_ns: 2 },
        birth: LocalTime::from_ns(-1_250_000),
        prior_position_m: [around(100.0, 10.0), around(70.0, 10.0), around(-1.0, 10.0)],
        body: BodyBounds {
            speed_m_s: 2.5,
            acceleration_m_s2: 1.25,
            current_m_s: [around(0.1, 0.05), around(0.0, 0.05), still],
            current_change_m_s2: [0.0; 3],
            current_step_m_s: [0.0; 3],
            disturbance_m_s: [around(0.0, 0.0001); 3],
        },
        modem: ModemBounds {
            range_m: 500.0,
            hearing_range_m: f64::INFINITY,
            sound_speed_m_s: around(1500.0, 1.0),
            sound_speed_is_constant: true,
            timestamp_s: 1e-5,
            frame_bytes: 64,
        },
        orders: Orders {
            estimator: Estimator::Tube(TubeSettings::forward(10_000_000_000)),
            controller: Controller::Waypoints {
                points_m: vec![[100.0, 80.0, -1.0], [120.0, 110.0, -15.0]],
                speed_m_s: 1.5,
                reach_m: 5.0,
                repeat: true,
            },
            access: MediumAccess::Periodic {
                first: LocalTime::from_ns(740_000_000),
                period_ns: 2_000_000_000,
            },
            area_m: [around(100.0, 100.0), around(100.0, 100.0), Bounds::new(-60.0, 0.0)],
            sabotage: None,
            relative: None,
        },
    }
}

fn ping() -> Ping {
    Ping {
        sender: AuvId(0),
        sequence: 7,
        emission_s: around(0.85, 1e-6),
        position_m: [around(96.5, 1.0), around(78.25, 1.0), around(-0.5, 0.1)],
        velocity_m_s: [around(0.3, 0.05), around(1.1, 0.05), around(0.0, 0.02)],
    }
}

fn sensed() -> Sensed {
    let stamp = LocalTime::from_ns(890_000_000);
    let measured = |value, error| Measured { value, error };
    let sender = AuvId(0);
    let at_tick = [
        Sense::Inertial {
            heading_rad: measured(0.25, 0.01),
            pitch_rad: measured(-0.125, 0.01),
            speed_m_s: measured(1.5, 0.02),
        },
        Sense::Dvl { velocity_m_s: [measured(1.5, 0.05), measured(0.0, 0.05), measured(-0.25, 0.05)] },
        Sense::Depth { depth_m: measured(1.25, 0.1) },
        Sense::Gnss {
            position_m: [around(100.5, 1.0), around(70.25, 1.0), around(-1.25, 1.0)],
            time_s: around(0.89, 1e-6),
        },
    ];
    let arrival = LocalTime::from_ns(873_456_789);
    let before = [
        Sense::Heard { frame: ping().encode().unwrap() },
        Sense::Bearing {
            sender,
            azimuth_rad: measured(1.5, 0.1),
            elevation_rad: None,
            heading_rad: measured(0.25, 0.01),
        },
    ];
    let before = before.map(|sense| Event { stamp: arrival, sense });
    let held = Event { stamp: LocalTime::from_ns(880_000_000), sense: Sense::Held };
    let events = before.into_iter().chain([held]);
    let events = events.chain(at_tick.map(|sense| Event { stamp, sense })).collect();
    Sensed { tick: 8, stamp, events }
}

pub fn acted() -> Acted {
    let frame = Frame::new(ping().encode().unwrap().bytes()).unwrap();
    let position_m = [around(100.5, 1.0), around(70.25, 1.0), around(-1.25, 0.1)];
    let clock_offset_s = around(0.0, 1.5e-6);
    Acted {
        tick: 8,
        setpoint: Setpoint { velocity_m_s: [0.5, 1.25, -0.5] },
        pings: vec![PlannedPing { at: LocalTime::from_ns(1_040_000_000), listen_ns: 0, frame }],
        report: Report {
            position_m,
            clock_offset_s,
            slice: Slice { position_m, clock_offset_s },
            emptied: None,
            neighbours: 1,
            contractions: 2,
            rejected: 0,
            around: vec![Around { auv: AuvId(0), position_m: [around(-4.0, 2.0), around(8.0, 2.0)] }],
            components: 1,
            gaussian: None,
        },
    }
}
