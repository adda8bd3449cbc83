use shoal_bus::record::rows::{Real, TruthRow};
use shoal_bus::time::LocalTime;

use super::*;

const TENTH_NS: i64 = NS_PER_S / 10;

fn truth(auv: u32, tick: u64, t_ns: i64) -> Row {
    Row::Truth(TruthRow {
        auv: AuvId(auv),
        tick,
        t_ns: SimTime::from_ns(t_ns),
        local_ns: LocalTime::from_ns(t_ns - 2_000_000),
        position_m: [10.0, 20.0, -30.0].map(Real),
        velocity_m_s: [Real(0.0); 3],
        heading_rad: Real(0.5),
        pitch_rad: Real(0.0),
    })
}

/// An answer whose box is `around_m` to each side of the truth, beside it by `beside_m` in x.
fn report(auv: u32, tick: u64, t_ns: i64, around_m: f64, beside_m: f64) -> Row {
    let around = |centre: f64| [Real(centre - around_m), Real(centre + around_m)];
    let sides = [around(10.0 + beside_m), around(20.0), around(-30.0)];
    Row::Report(Box::new(ReportRow {
        auv: AuvId(auv),
        tick,
        t_ns: SimTime::from_ns(t_ns),
        local_ns: Some(LocalTime::from_ns(t_ns - 2_000_000)),
        position_m: sides,
        clock_offset_s: [Real(0.001), Real(0.003)],
        slice_position_m: sides,
        slice_clock_offset_s: [Real(0.001), Real(0.003)],
        emptied: None,
        neighbours: 3,
        contractions: 2,
        rejected: 0,
        components: 1,
        around: Vec::new(),
        gaussian: None,
        setpoint_m_s: [Real(0.0); 3],
        booked: Vec::new(),
    }))
}

fn gathered(auvs: usize, rows: &[Row]) -> Vec<Chunk> {
    let mut chunks = Vec::new();
    let mut gatherer = Gatherer::new(auvs, true);
    rows.iter().for_each(|row| gatherer.take(row, &mut |chunk| chunks.push(chunk)));
    gatherer.finish(&mut |chunk| chunks.push(chunk));
    chunks
}

fn words(bytes: &[u8], at: usize, count: usize) -> Vec<u32> {
    bytes[at..at + 4 * count].chunks(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}

fn floats(bytes: &[u8], at: usize, count: usize) -> Vec<f32> {
    words(bytes, at, count).into_iter().map(f32::from_bits).collect()
}

/// Three ticks of AUV 0 in the first second and one in the second; AUV 1 ticks once, beside its box.
fn rows() -> Vec<Row> {
    vec![
        truth(0, 0, TENTH_NS),
        truth(1, 0, 2 * TENTH_NS),
        truth(0, 1, 2 * TENTH_NS),
        report(0, 0, TENTH_NS, 2.0, 0.0),
        report(0, 1, 2 * TENTH_NS, 1.0, 0.0),
        report(1, 0, 2 * TENTH_NS, 2.0, 5.0),
        truth(0, 2, 9 * TENTH_NS),
        report(0, 2, 9 * TENTH_NS, 0.5, 0.0),
        Row::Ping(PingRow::Emitted {
            t_ns: SimTime::from_ns(9 * TENTH_NS),
            from: AuvId(1),
            sequence: 4,
            position_m: [1.0, 2.0, -3.0].map(Real),
            bytes: 60,
            box_width_m: Real(4.0),
            beyond_range: 7,
            packet_s: Real(0.0),
        }),
        Row::Ping(PingRow::Lost {
            t_ns: SimTime::from_ns(9 * TENTH_NS),
            from: AuvId(1),
            sequence: 4,
            to: Some(AuvId(0)),
            reason: LossReason::Collision,
            range_m: Real(5.0),
            reception: None,
            colliding: Vec::new(),
        }),
        truth(0, 3, 15 * TENTH_NS),
        report(0, 3, 15 * TENTH_NS, 0.25, 0.0),
    ]
}

#[test]
fn the_scene_of_a_second_holds_every_auv_with_its_row_before() {
    let chunks = gathered(2, &rows());
    assert_eq!(chunks.iter().map(|chunk| chunk.second).collect::<Vec<_>>(), [0, 1]);
    let scene = &chunks[0].scene;
    assert_eq!(words(scene, 0, 5), [0, 2, 4, 1, 0]);
    assert_eq!(words(scene, 20, 3), [0, 3, 4]);
    assert_eq!(floats(scene, 32, 4), [0.1, 0.2, 0.9, 0.2]);
    // After time, place and course: the lower ends of the boxes in x.
    assert_eq!(floats(scene, 32 + 6 * 16, 4), [8.0, 9.0, 9.5, 13.0]);
    // After box and clock: answered, and inside but for the last.
    assert_eq!(words(scene, 32 + 13 * 16, 4), [3, 3, 3, 1]);
    // The ping.
    assert_eq!(floats(scene, 32 + 14 * 16, 4), [0.9, 1.0, 2.0, -3.0]);
    assert_eq!(words(scene, 32 + 15 * 16, 1), [1]);
    assert_eq!(scene.len(), 32 + 15 * 16 + 4);

    let scene = &chunks[1].scene;
    assert_eq!(words(scene, 0, 5), [1, 2, 3, 0, 0]);
    assert_eq!(words(scene, 20, 3), [0, 2, 3]);
    let times = floats(scene, 32, 3);
    assert!((times[0] + 0.1).abs() < 1e-6 && times[1] == 0.5 && (times[2] + 0.8).abs() < 1e-6, "{times:?}");
}

#[test]
fn a_track_holds_the_rows_and_fates_of_one_auv() {
    let chunks = gathered(2, &rows());
    let of = |auv, chunk: &Chunk| {
        TrackPart::read(auv, 2, &|at, length| Ok(chunk.tracks[at..at + length].to_vec())).unwrap()
    };
    let part = of(0, &chunks[0]);
    assert_eq!(part.rows.len(), 3 * ROW_BYTES);
    let collision = LossReason::Collision as usize + 1;
    let fates = words(&part.fates, 0, FATES);
    assert_eq!((fates[collision], fates.iter().sum::<u32>()), (1, 1));
    let row = &part.rows[2 * ROW_BYTES..];
    assert_eq!(f64::from_le_bytes(row[..8].try_into().unwrap()), 0.9);
    assert_eq!(
        floats(row, 8, 12),
        [10.0, 20.0, -30.0, 9.5, 10.5, 19.5, 20.5, -30.5, -29.5, 0.002, 0.001, 0.003]
    );
    assert_eq!(row[92..96], [3, 0, 2, 0]);
    assert_eq!(of(1, &chunks[0]).rows.len(), ROW_BYTES);
    assert_eq!(of(1, &chunks[1]).rows.len(), 0);
}

#[test]
fn figures_tell_of_misses_and_losses() {
    let figures: Vec<serde_json::Value> =
        gathered(2, &rows()).iter().map(|chunk| serde_json::from_str(&chunk.figures).unwrap()).collect();
    assert_eq!((&figures[0]["misses"], &figures[1]["misses"]), (&1.into(), &0.into()));
    assert_eq!(figures[0]["emitted"], 1);
    let range = LossReason::Range as usize + 1;
    assert_eq!(figures[0]["fates"][range], 7);
    assert_eq!(figures[1]["width_max_m"], 4.0);
}

#[test]
fn rows_that_cannot_be_are_left_out() {
    let far =
        [truth(0, 0, i64::MAX), truth(0, 1, -5), truth(7, 0, TENTH_NS), report(0, 9, TENTH_NS, 1.0, 0.0)];
    let chunks = gathered(1, &far);
    assert!(chunks.iter().all(|chunk| words(&chunk.scene, 8, 1) == [0]), "{chunks:?}");
    // A second that is closed stays as it is.
    let late = [truth(0, 0, TENTH_NS), truth(0, 1, 5 * NS_PER_S), truth(0, 2, 2 * TENTH_NS)];
    assert_eq!(gathered(1, &late).iter().map(|chunk| chunk.second).collect::<Vec<_>>(), [0, 5]);
}
