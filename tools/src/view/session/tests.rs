use super::*;

#[test]
fn a_page_may_ask_for_scenes_and_tracks_only() {
    let ask = |text| serde_json::from_str::<Ask>(text);
    assert!(matches!(ask(r#"{"scene":12}"#), Ok(Ask::Scene { scene: 12 })));
    assert!(matches!(ask(r#"{"track":7,"from":3}"#), Ok(Ask::Track { track: 7, from: 3 })));
    for text in [r#"{"scene":-1}"#, r#"{"track":7}"#, r#"{"scene":4294967296}"#, "[]", "", "{}"] {
        assert!(ask(text).is_err(), "{text}");
    }
}

#[test]
fn a_track_is_told_parts_first() {
    let part = |byte| TrackPart { fates: vec![byte; 44], rows: vec![byte; 2 * ROW_BYTES] };
    let bytes = track_message(7, &[(3, part(1)), (5, part(2))]);
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!([0, 4, 8, 12, 16, 16 + 48].map(word), [2, 7, 2, 4, 3, 5]);
    assert_eq!(bytes.len(), 16 + 2 * 48 + 4 * ROW_BYTES);
    // Rows begin where an `f64` may.
    assert_eq!((16 + 2 * 48) % 8, 0);
    assert_eq!(bytes[16 + 2 * 48], 1);
}

#[test]
fn what_is_reached_is_told_in_json() {
    let reached = Reached {
        figures: vec!["{\"second\":1}".to_owned()],
        first: 1,
        end: 2,
        done: true,
        note: "a \"b\"".to_owned(),
    };
    let told: serde_json::Value = serde_json::from_str(&reached.message()).unwrap();
    assert_eq!(told["reached"]["figures"][0]["second"], 1);
    assert_eq!(told["reached"]["note"], "a \"b\"");
}
