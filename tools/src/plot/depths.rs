//! The true depth of each AUV at any moment, from its ticks.

use std::collections::{BTreeMap, VecDeque};

use shoal_bus::message::AuvId;
use shoal_bus::record::BATCH_NS;
use shoal_bus::record::rows::TruthRow;

/// So much of the past is kept: within a batch of a record, all ticks come before the pings between them.
const KEPT_NS: i64 = 2 * BATCH_NS;

/// Depths of the recent past, and what waits for those of the near future.
pub struct Depths<T> {
    auvs: BTreeMap<AuvId, Track<T>>,
}

struct Track<T> {
    /// Time in nanoseconds and depth in metres, sorted.
    ticks: VecDeque<(i64, f64)>,
    /// Later than the last tick, sorted as they came.
    waiting: Vec<(i64, T)>,
}

impl<T> Default for Depths<T> {
    fn default() -> Self {
        Self { auvs: BTreeMap::new() }
    }
}

impl<T> Depths<T> {
    fn track(&mut self, auv: AuvId) -> &mut Track<T> {
        self.auvs.entry(auv).or_insert_with(|| Track { ticks: VecDeque::new(), waiting: Vec::new() })
    }

    /// Takes a tick, and tells `found` the depths that were waited for.
    pub fn tick(&mut self, row: &TruthRow, found: &mut dyn FnMut(T, f64)) {
        let track = self.track(row.auv);
        let now_ns = row.t_ns.ns();
        track.ticks.push_back((now_ns, -row.position_m[2].0));
        while track.ticks.get(1).is_some_and(|(t_ns, _)| *t_ns < now_ns - KEPT_NS) {
            track.ticks.pop_front();
        }
        let ticks = &track.ticks;
        let is_due = |(t_ns, _): &mut (i64, T)| *t_ns <= now_ns;
        for (t_ns, what) in track.waiting.extract_if(.., is_due) {
            found(what, between(ticks, t_ns));
        }
    }

    /// Tells `found` the depth of `auv` at a time: now, or when its next tick is known.
    pub fn ask(&mut self, auv: AuvId, t_ns: i64, what: T, found: &mut dyn FnMut(T, f64)) {
        let track = self.track(auv);
        match track.ticks.back() {
            Some((last_ns, _)) if t_ns <= *last_ns => found(what, between(&track.ticks, t_ns)),
            _ => track.waiting.push((t_ns, what)),
        }
    }

    /// No tick follows: what still waits gets the depth of the last one; of an AUV without ticks, nothing is known.
    pub fn end(&mut self, found: &mut dyn FnMut(T, f64)) {
        for track in self.auvs.values_mut() {
            let Some((_, depth_m)) = track.ticks.back() else { continue };
            track.waiting.drain(..).for_each(|(_, what)| found(what, *depth_m));
        }
    }
}

/// Linear between ticks, constant before the first and behind the last.
fn between(ticks: &VecDeque<(i64, f64)>, t_ns: i64) -> f64 {
    let after = ticks.partition_point(|(tick_ns, _)| *tick_ns < t_ns);
    let before = after.checked_sub(1).and_then(|index| ticks.get(index));
    match (before, ticks.get(after)) {
        (Some((from_ns, from_m)), Some((to_ns, to_m))) => {
            let part = (t_ns - from_ns) as f64 / (to_ns - from_ns) as f64;
            from_m + part * (to_m - from_m)
        }
        (Some((_, depth_m)), None) | (None, Some((_, depth_m))) => *depth_m,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use shoal_bus::record::rows::Real;
    use shoal_bus::time::{LocalTime, SimTime};

    use super::*;

    fn tick(auv: u32, t_ns: i64, depth_m: f64) -> TruthRow {
        TruthRow {
            auv: AuvId(auv),
            tick: 0,
            t_ns: SimTime::from_ns(t_ns),
            local_ns: LocalTime::from_ns(t_ns),
            position_m: [0.0, 0.0, -depth_m].map(Real),
            velocity_m_s: [Real(0.0); 3],
            heading_rad: Real(0.0),
            pitch_rad: Real(0.0),
        }
    }

    #[test]
    fn depths_are_interpolated_whenever_they_are_asked_for() {
        let mut depths = Depths::default();
        let mut told = Vec::new();
        let mut found = |what: char, depth_m: f64| told.push((what, depth_m));
        depths.ask(AuvId(1), 5, 'a', &mut found);
        depths.tick(&tick(1, 10, 20.0), &mut found);
        depths.tick(&tick(1, 20, 30.0), &mut found);
        depths.ask(AuvId(1), 15, 'b', &mut found);
        depths.ask(AuvId(1), 25, 'c', &mut found);
        depths.ask(AuvId(1), 35, 'd', &mut found);
        depths.ask(AuvId(2), 1, 'e', &mut found);
        depths.tick(&tick(1, 30, 10.0), &mut found);
        depths.end(&mut found);
        assert_eq!(told, [('a', 20.0), ('b', 25.0), ('c', 20.0), ('d', 10.0)]);
    }

    #[test]
    fn the_past_is_forgotten() {
        let mut depths: Depths<()> = Depths::default();
        (0..10_000).for_each(|index| depths.tick(&tick(0, index * 1_000_000, 1.0), &mut |_, _| {}));
        assert!(depths.auvs[&AuvId(0)].ticks.len() as i64 <= KEPT_NS / 1_000_000 + 2);
    }
}
