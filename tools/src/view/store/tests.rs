use super::*;
use crate::view::chunk::{FATES, ROW_BYTES};

/// A second whose scene is its number, eight times, with one row in the track of its only AUV.
fn chunk(second: u32) -> Chunk {
    let byte = u8::try_from(second).unwrap();
    let begins = [0_u32, 1].into_iter().flat_map(u32::to_le_bytes);
    let tracks = begins.chain([byte; 4 * FATES]).chain([byte; ROW_BYTES]).collect();
    Chunk { second, scene: vec![byte; 8], tracks, figures: format!("{{\"second\":{second}}}") }
}

fn filled(store: Store) -> Store {
    [0, 1, 4].into_iter().for_each(|second| store.put(chunk(second)).unwrap());
    store
}

#[test]
fn seconds_come_back_from_disk_and_from_memory() {
    for store in [filled(Store::on_disk().unwrap()), filled(Store::in_memory(1 << 20))] {
        assert_eq!(store.scene(1).unwrap(), Some(vec![1; 8]));
        // What is between stays as it was last.
        assert_eq!(store.scene(3).unwrap(), Some(vec![1; 8]));
        assert_eq!(store.scene(9).unwrap(), Some(vec![4; 8]));
        let parts = store.track(0, 1, 1).unwrap();
        assert_eq!(parts.iter().map(|(second, _)| *second).collect::<Vec<_>>(), [1, 4]);
        assert_eq!(parts[1].1, TrackPart { fates: vec![4; 4 * FATES], rows: vec![4; ROW_BYTES] });
        assert!(store.track(5, 1, 0).is_err());
        let reached = store.reached(2);
        assert_eq!((reached.first, reached.end, reached.done), (0, 5, false));
        assert_eq!(reached.figures, ["{\"second\":4}"]);
        store.finish("cut".to_owned());
        assert_eq!((store.reached(5).done, store.reached(5).note.as_str()), (true, "cut"));
    }
}

#[test]
fn in_memory_the_oldest_makes_way() {
    let each = chunk(0).scene.len() + chunk(0).tracks.len();
    let store = Store::in_memory(2 * each);
    (0..6).for_each(|second| store.put(chunk(second)).unwrap());
    assert_eq!(store.seconds(), [4, 5]);
    assert_eq!(store.bytes(), 2 * each as u64);
    assert_eq!(store.scene(1).unwrap(), None);
    assert_eq!((store.reached(0).first, store.reached(0).end), (4, 6));
}
