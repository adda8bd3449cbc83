//! The columns of every topic's table: their names, where they stand in an event, and what they are.

use serde_json::{Map, Value, json};
use shoal_bus::record::Topic;

/// Name with unit; where it stands in an event, as a JSON pointer; what it is.
pub type Column = (&'static str, &'static str, &'static str);

/// The columns of a topic's table, in order.
pub fn columns(topic: Topic) -> &'static [Column] {
    match topic {
        Topic::Auvs => AUVS,
        Topic::Poses => POSES,
        Topic::Log => LOG,
        Topic::Ticks => TICKS,
        Topic::Reports => REPORTS,
        Topic::Pings => PINGS,
        Topic::Sensed => SENSED,
        Topic::Summary => SUMMARY,
        Topic::Born => BORN,
        Topic::Offline => OFFLINE,
        Topic::Flock => FLOCK,
    }
}

const AUV: Column = ("auv", "/auv", "which AUV: its number");
const TICK: Column = ("tick", "/tick", "index of its tick");
const T: Column = ("t_ns", "/t_ns", "true time, nanoseconds since the run's beginning");
const LOCAL: Column = ("local_ns", "/local_ns", "what the AUV's clock reads, nanoseconds");

const AUVS: &[Column] = &[
    AUV,
    ("name", "/name", "its name"),
    ("group", "/group", "index of its group"),
    ("group_name", "/group_name", "name of its group"),
    ("length_m", "/length_m", "length of its body"),
];

const POSES: &[Column] = &[
    T,
    AUV,
    ("x_m", "/position/x", "true position east, to the millimetre"),
    ("y_m", "/position/y", "north"),
    ("z_m", "/position/z", "up"),
    ("orientation_x", "/orientation/x", "true attitude, a unit quaternion"),
    ("orientation_y", "/orientation/y", ""),
    ("orientation_z", "/orientation/z", ""),
    ("orientation_w", "/orientation/w", ""),
];

const LOG: &[Column] = &[
    T,
    ("level", "/level", "3 for a warning, 4 for an error"),
    ("name", "/name", "name of the AUV"),
    ("message", "/message", "what happened"),
];

const TICKS: &[Column] = &[
    T,
    AUV,
    TICK,
    LOCAL,
    ("x_m", "/position_m/0", "true position east"),
    ("y_m", "/position_m/1", "north"),
    ("z_m", "/position_m/2", "up"),
    ("velocity_x_m_s", "/velocity_m_s/0", "true velocity through the water, east"),
    ("velocity_y_m_s", "/velocity_m_s/1", "north"),
    ("velocity_z_m_s", "/velocity_m_s/2", "up"),
    ("heading_rad", "/heading_rad", "true heading, counter-clockwise from east"),
    ("pitch_rad", "/pitch_rad", "true pitch, nose up"),
];

const REPORTS: &[Column] = &[
    T,
    AUV,
    TICK,
    LOCAL,
    ("x_lower_m", "/position_m/0/0", "what encloses its position at the tick, east: lower bound"),
    ("x_upper_m", "/position_m/0/1", "upper bound"),
    ("y_lower_m", "/position_m/1/0", "north"),
    ("y_upper_m", "/position_m/1/1", ""),
    ("z_lower_m", "/position_m/2/0", "up"),
    ("z_upper_m", "/position_m/2/1", ""),
    ("clock_offset_lower_s", "/clock_offset_s/0", "what encloses true time minus local time at the tick"),
    ("clock_offset_upper_s", "/clock_offset_s/1", ""),
    ("slice_x_lower_m", "/slice_position_m/0/0", "what encloses its position since the tick before, east"),
    ("slice_x_upper_m", "/slice_position_m/0/1", ""),
    ("slice_y_lower_m", "/slice_position_m/1/0", "north"),
    ("slice_y_upper_m", "/slice_position_m/1/1", ""),
    ("slice_z_lower_m", "/slice_position_m/2/0", "up"),
    ("slice_z_upper_m", "/slice_position_m/2/1", ""),
    (
        "slice_clock_offset_lower_s",
        "/slice_clock_offset_s/0",
        "true time minus local time since the tick before",
    ),
    ("slice_clock_offset_upper_s", "/slice_clock_offset_s/1", ""),
    (
        "emptied_at_local_ns",
        "/emptied/at_local_ns",
        "local time of the measurement that left nothing, if one did",
    ),
    ("emptied_by", "/emptied/by", "its kind"),
    ("emptied_sender", "/emptied/sender", "who sent the ping, if it was one"),
    ("neighbours", "/neighbours", "neighbours that the controller heeds"),
    ("contractions", "/contractions", "measurements that made the enclosure smaller since the tick before"),
    ("rejected", "/rejected", "pings taken for outliers, or dropped"),
    ("components", "/components", "separate parts of the set"),
    (
        "around",
        "/around",
        "neighbours followed in its own frame: number:x_lower:x_upper:y_lower:y_upper in metres",
    ),
    ("mean_x_m", "/gaussian/mean/0", "mean of a Kalman filter, east"),
    ("mean_y_m", "/gaussian/mean/1", "north"),
    ("mean_z_m", "/gaussian/mean/2", "up"),
    ("mean_clock_offset_s", "/gaussian/mean/3", "true time minus local time"),
    ("covariance_xx_m2", "/gaussian/covariance/0", "upper triangle of its covariance, t for the clock"),
    ("covariance_xy_m2", "/gaussian/covariance/1", ""),
    ("covariance_xz_m2", "/gaussian/covariance/2", ""),
    ("covariance_xt_m_s", "/gaussian/covariance/3", ""),
    ("covariance_yy_m2", "/gaussian/covariance/4", ""),
    ("covariance_yz_m2", "/gaussian/covariance/5", ""),
    ("covariance_yt_m_s", "/gaussian/covariance/6", ""),
    ("covariance_zz_m2", "/gaussian/covariance/7", ""),
    ("covariance_zt_m_s", "/gaussian/covariance/8", ""),
    ("covariance_tt_s2", "/gaussian/covariance/9", ""),
    ("setpoint_x_m_s", "/setpoint_m_s/0", "desired velocity through the water, east"),
    ("setpoint_y_m_s", "/setpoint_m_s/1", "north"),
    ("setpoint_z_m_s", "/setpoint_m_s/2", "up"),
    ("booked", "/booked", "pings booked: local time in nanoseconds:frame in hexadecimal digits"),
];

const PINGS: &[Column] = &[
    T,
    ("from", "/from", "who emitted it"),
    ("sequence", "/sequence", "the emitter's number of the ping"),
    ("fate", "/fate", "emitted, heard or lost"),
    ("to", "/to", "who heard it, or lost it"),
    ("reason", "/reason", "why it was lost"),
    ("range_m", "/range_m", "from the emitter at emission to the receiver at reception"),
    ("travel_s", "/travel_s", "true travel time"),
    ("box_width_m", "/box_width_m", "width of the position box that it carries"),
    ("x_m", "/position_m/0", "true position of the emitter, east"),
    ("y_m", "/position_m/1", "north"),
    ("z_m", "/position_m/2", "up"),
    ("bytes", "/bytes", "length of the frame"),
    ("beyond_range", "/beyond_range", "AUVs too far away to ever hear it"),
    ("packet_s", "/packet_s", "length of the packet"),
    ("path", "/reception/path", "which way sound took, at level `sea`"),
    ("level_db", "/reception/level_db", "received level, dB re 1 µPa"),
    ("sinr_db", "/reception/sinr_db", "level over noise and interference"),
    ("doppler", "/reception/doppler", "factor of frequencies"),
    ("outlier", "/outlier", "true when it came the long way round"),
    ("colliding", "/colliding", "whose packets it collided with"),
];

const SENSED: &[Column] = &[
    T,
    AUV,
    TICK,
    ("local_ns", "/stamp", "what the AUV's clock reads at the tick, nanoseconds"),
    (
        "event_local_ns",
        "/event/stamp",
        "what it read at the event; empty for a tick at which nothing was told",
    ),
    ("kind", "/kind", "inertial, dvl, depth, gnss, heard, held or bearing"),
    ("heading_rad", "/is/heading_rad/value", "heading"),
    ("heading_error_rad", "/is/heading_rad/error", "its stated bound"),
    ("pitch_rad", "/is/pitch_rad/value", "pitch"),
    ("pitch_error_rad", "/is/pitch_rad/error", "its stated bound"),
    ("speed_m_s", "/is/speed_m_s/value", "speed along the nose"),
    ("speed_error_m_s", "/is/speed_m_s/error", "its stated bound"),
    ("velocity_forward_m_s", "/is/velocity_m_s/0/value", "velocity over ground, forward"),
    ("velocity_forward_error_m_s", "/is/velocity_m_s/0/error", "its stated bound"),
    ("velocity_port_m_s", "/is/velocity_m_s/1/value", "to port"),
    ("velocity_port_error_m_s", "/is/velocity_m_s/1/error", "its stated bound"),
    ("velocity_up_m_s", "/is/velocity_m_s/2/value", "up"),
    ("velocity_up_error_m_s", "/is/velocity_m_s/2/error", "its stated bound"),
    ("depth_m", "/is/depth_m/value", "depth, positive down"),
    ("depth_error_m", "/is/depth_m/error", "its stated bound"),
    ("x_lower_m", "/is/position_m/0/lower", "satellite fix, east: lower bound"),
    ("x_upper_m", "/is/position_m/0/upper", "upper bound"),
    ("y_lower_m", "/is/position_m/1/lower", "north"),
    ("y_upper_m", "/is/position_m/1/upper", ""),
    ("z_lower_m", "/is/position_m/2/lower", "up"),
    ("z_upper_m", "/is/position_m/2/upper", ""),
    ("time_lower_s", "/is/time_s/lower", "true time by the fix"),
    ("time_upper_s", "/is/time_s/upper", ""),
    ("frame", "/is/frame", "the ping's bytes as hexadecimal digits"),
    ("sender", "/is/sender", "whose ping came from the bearing"),
    ("azimuth_rad", "/is/azimuth_rad/value", "bearing from the nose, counter-clockwise"),
    ("azimuth_error_rad", "/is/azimuth_rad/error", "its stated bound"),
    ("elevation_rad", "/is/elevation_rad/value", "bearing above the horizontal"),
    ("elevation_error_rad", "/is/elevation_rad/error", "its stated bound"),
];

const OFFLINE: &[Column] = &[
    T,
    AUV,
    TICK,
    LOCAL,
    ("alone_x_lower_m", "/alone_position_m/0/0", "what would enclose its position without any ping, east"),
    ("alone_x_upper_m", "/alone_position_m/0/1", ""),
    ("alone_y_lower_m", "/alone_position_m/1/0", "north"),
    ("alone_y_upper_m", "/alone_position_m/1/1", ""),
    ("alone_z_lower_m", "/alone_position_m/2/0", "up"),
    ("alone_z_upper_m", "/alone_position_m/2/1", ""),
    ("alone_clock_offset_lower_s", "/alone_clock_offset_s/0", "true time minus local time, likewise"),
    ("alone_clock_offset_upper_s", "/alone_clock_offset_s/1", ""),
    ("x_lower_m", "/position_m/0/0", "what encloses its position by all records together, east"),
    ("x_upper_m", "/position_m/0/1", ""),
    ("y_lower_m", "/position_m/1/0", "north"),
    ("y_upper_m", "/position_m/1/1", ""),
    ("z_lower_m", "/position_m/2/0", "up"),
    ("z_upper_m", "/position_m/2/1", ""),
    ("clock_offset_lower_s", "/clock_offset_s/0", "true time minus local time, likewise"),
    ("clock_offset_upper_s", "/clock_offset_s/1", ""),
];

const FLOCK: &[Column] = &[
    T,
    ("polarization", "/polarization", "length of the mean unit velocity, 0 to 1"),
    ("min_separation_m", "/min_separation_m", "least distance between two bodies since the row before"),
    ("collisions", "/collisions", "pairs that came closer than their lengths allow, so far"),
    ("connectivity", "/connectivity", "part of all ordered pairs whose second is in range of the first"),
    (
        "algebraic_connectivity",
        "/algebraic_connectivity",
        "second smallest eigenvalue of the graph's Laplacian",
    ),
    ("components", "/components", "connected components of the graph"),
    ("largest_component", "/largest_component", "AUVs in the largest of them"),
];

const BORN: &[Column] = &[
    AUV,
    ("key", "/key", "a fact that it was told at birth, with dots between the names of `Born`"),
    ("value", "/value", "the fact"),
];

const SUMMARY: &[Column] = &[
    ("key", "/key", "a figure of the summary, with dots between its names"),
    ("value", "/value", "the figure"),
];

/// The rows that an event makes in its topic's table.
pub fn rows(topic: Topic, event: Value) -> Vec<Value> {
    match topic {
        Topic::Auvs => {
            let Some(auvs) = event["auvs"].as_array() else { return Vec::new() };
            auvs.iter().enumerate().map(|(auv, of)| with(of.clone(), "auv", json!(auv))).collect()
        }
        Topic::Poses => {
            let t_ns = timestamp_ns(&event);
            let Some(poses) = event["poses"].as_array() else { return Vec::new() };
            let pose = |(auv, pose): (usize, &Value)| {
                with(with(pose.clone(), "auv", json!(auv)), "t_ns", json!(t_ns))
            };
            poses.iter().enumerate().map(pose).collect()
        }
        Topic::Log => {
            let t_ns = timestamp_ns(&event);
            vec![with(event, "t_ns", json!(t_ns))]
        }
        Topic::Sensed => sensed(event),
        Topic::Born => {
            let auv = event["auv"].clone();
            leaves(event).into_iter().map(|row| with(row, "auv", auv.clone())).collect()
        }
        Topic::Summary => leaves(event),
        Topic::Ticks | Topic::Reports | Topic::Pings | Topic::Offline | Topic::Flock => vec![event],
    }
}

/// One row for each thing sensed; one for a tick without any.
fn sensed(mut tick: Value) -> Vec<Value> {
    let Value::Array(events) = tick["events"].take() else { return vec![tick] };
    if events.is_empty() {
        return vec![tick];
    }
    let row = |mut event: Value| {
        // A variant with fields is an object of one member, one without is its name.
        let (kind, is) = match event["sense"].take() {
            Value::Object(sense) => sense.into_iter().next().unwrap_or_default(),
            Value::String(kind) => (kind, Value::Null),
            _ => Default::default(),
        };
        let row = with(tick.clone(), "event", event);
        with(with(row, "kind", json!(kind.to_lowercase())), "is", is)
    };
    events.into_iter().map(row).collect()
}

fn with(mut of: Value, key: &str, value: Value) -> Value {
    if let Value::Object(members) = &mut of {
        members.insert(key.to_owned(), value);
    }
    of
}

fn timestamp_ns(event: &Value) -> i64 {
    let part = |key: &str| event["timestamp"][key].as_i64().unwrap_or_default();
    part("sec").saturating_mul(1_000_000_000).saturating_add(part("nsec"))
}

/// Every number, word and truth value inside, with the way that leads there.
fn leaves(of: Value) -> Vec<Value> {
    fn walk(path: &str, of: Value, rows: &mut Vec<Value>) {
        let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        match of {
            Value::Object(members) => {
                members.into_iter().for_each(|(key, value)| walk(&below(&key), value, rows));
            }
            Value::Array(elements) => {
                let each = elements.into_iter().enumerate();
                each.for_each(|(index, value)| walk(&below(&index.to_string()), value, rows));
            }
            value => rows.push(json!({ "key": path, "value": value })),
        }
    }
    let mut rows = Vec::new();
    walk("", of, &mut rows);
    rows
}

/// The value of a column in a row; `null` where there is none.
pub fn value(topic: Topic, row: &Value, column: &Column) -> Value {
    let found = row.pointer(column.1).cloned().unwrap_or_default();
    match (topic, column.0, found) {
        (Topic::Sensed, "frame", Value::Array(bytes)) => {
            let digits = bytes.iter().filter_map(Value::as_u64).map(|byte| format!("{byte:02x}"));
            Value::String(digits.collect())
        }
        (Topic::Pings, "colliding", Value::Array(auvs)) => joined(auvs.iter().map(Value::to_string)),
        (Topic::Reports, "booked", Value::Array(booked)) => joined(booked.iter().map(|booked| {
            format!("{}:{}", booked["at_local_ns"], booked["frame"].as_str().unwrap_or_default())
        })),
        (Topic::Reports, "around", Value::Array(around)) => joined(around.iter().map(|around| {
            let bound = |axis: usize, side: usize| &around["position_m"][axis][side];
            format!("{}:{}:{}:{}:{}", around["auv"], bound(0, 0), bound(0, 1), bound(1, 0), bound(1, 1))
        })),
        (_, _, found) => found,
    }
}

fn joined(words: impl Iterator<Item = String>) -> Value {
    let words: Vec<String> = words.collect();
    if words.is_empty() { Value::Null } else { Value::String(words.join(" ")) }
}

/// A row as an object with its columns.
pub fn object(topic: Topic, row: &Value) -> Value {
    let members: Map<String, Value> = columns(topic)
        .iter()
        .map(|column| (column.0.to_owned(), value(topic, row, column)))
        .filter(|(_, value)| !value.is_null())
        .collect();
    Value::Object(members)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_numbers_have_units() {
        for topic in Topic::ALL {
            let mut names: Vec<&str> = columns(topic).iter().map(|column| column.0).collect();
            names.sort_unstable();
            assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{topic:?}: {names:?}");
            assert!(columns(topic).iter().all(|column| column.1.starts_with('/')));
            let bounds = names.iter().filter(|name| name.contains("lower") || name.contains("upper"));
            assert!(bounds.into_iter().all(|name| name.ends_with("_m") || name.ends_with("_s")), "{names:?}");
        }
    }

    #[test]
    fn what_was_sensed_is_a_row_each() {
        let tick = json!({"t_ns": 5, "auv": 1, "tick": 2, "stamp": 6, "events": [
            {"stamp": 3, "sense": {"Depth": {"depth_m": {"value": 12.5, "error": 0.1}}}},
            {"stamp": 4, "sense": {"Heard": {"frame": [1, 255]}}},
            {"stamp": 5, "sense": "Held"},
        ]});
        let rows = rows(Topic::Sensed, tick);
        let text: Vec<String> = rows.iter().map(|row| object(Topic::Sensed, row).to_string()).collect();
        assert_eq!(
            text,
            [
                r#"{"t_ns":5,"auv":1,"tick":2,"local_ns":6,"event_local_ns":3,"kind":"depth","depth_m":12.5,"depth_error_m":0.1}"#,
                r#"{"t_ns":5,"auv":1,"tick":2,"local_ns":6,"event_local_ns":4,"kind":"heard","frame":"01ff"}"#,
                r#"{"t_ns":5,"auv":1,"tick":2,"local_ns":6,"event_local_ns":5,"kind":"held"}"#,
            ]
        );
        let silent = super::rows(Topic::Sensed, json!({"t_ns": 5, "events": []}));
        assert_eq!(silent.len(), 1);
    }

    #[test]
    fn what_is_nested_becomes_keys_with_dots() {
        let rows = rows(Topic::Summary, json!({"pings": {"lost": {"late": 3}}, "groups": [{"name": "a"}]}));
        assert_eq!(
            rows,
            [json!({"key": "pings.lost.late", "value": 3}), json!({"key": "groups.0.name", "value": "a"})]
        );
    }
}
