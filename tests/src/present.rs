//! What the payloads that one AUV received and its odometry allow of its present state: all of it, by set inversion.
//!
//! The constraints are those of an online estimator that forgets nothing and takes its time: what it was told at birth, every depth
//! and every fix, carried along by odometry, and every ping of its life as a ring around the present position. At each tick that
//! brings a ping, all of them are contracted to a fixed point, and the box goes on from there: one ring after the other, each worn by
//! the whole way since, says less than what they left together when they were new. At the end the solution set in (x, y, z, clock
//! offset) is searched by branch and bound for how far it reaches along each axis, with points of it as witnesses from the inside,
//! so that its hull is known from both sides.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use shoal_auv::odometry::Way;
use shoal_auv::rings::Ring;
use shoal_auv::state::{Sound, State};
use shoal_auv::together;
use shoal_auv::travel::{Travel, local_s, seconds};
use shoal_bus::message::{Born, Bounds, Event, Sense, Sensed};
use shoal_bus::ping::Ping;
use shoal_interval::{Interval, IntervalBox};

/// No more boxes than this are looked at for one side of a hull.
const BOXES: usize = 400;
/// A side is found when it is known to this part of the width of the hull.
const FINE: f64 = 0.02;

/// All that is known of an AUV's present, nothing contracted.
pub struct Present {
    travel: Travel,
    sound: Sound,
    timestamp_s: f64,
    stamp_s: f64,
    known: State,
    rings: Vec<Ring>,
}

/// How far a set reaches, from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Hull {
    /// Holds the set.
    pub outer: State,
    /// Is held by the hull of the set.
    pub inner: State,
}

impl Present {
    /// What was told at birth.
    pub fn new(born: &Born) -> Self {
        Self {
            travel: Travel::new(born),
            sound: Sound {
                speed_m_s: interval(born.modem.sound_speed_m_s),
                hearing_range_m: born.modem.hearing_range_m,
            },
            timestamp_s: born.modem.timestamp_s,
            stamp_s: born.clock.stamp_ns as f64 * 1e-9,
            known: State {
                offset_s: interval(born.clock.offset_s),
                position_m: IntervalBox::from(born.prior_position_m.map(interval)),
            },
            rings: Vec::new(),
        }
    }

    /// Goes on to the next tick.
    ///
    /// # Panics
    /// When something contradicts what is known.
    pub fn update(&mut self, sensed: &Sensed) {
        let begun = self.travel.now();
        let stretch = self.travel.advance(sensed, &mut None);
        let before = self.known;
        let over = |from_s: f64| Way::from(&self.travel.motion().over(&stretch, from_s, stretch.length_s));
        let whole = over(0.0);
        self.known = whole.ahead(&before);
        self.rings.iter_mut().for_each(|ring| ring.carry(&whole));
        for event in &sensed.events {
            let since = over(seconds(event.stamp - begun).clamp(0.0, stretch.length_s));
            if let Sense::Heard { frame } = &event.sense {
                let mut ring = self.ring(&Ping::decode(frame).expect("a frame of a ping"), event);
                ring.carry(&since);
                self.rings.push(ring);
            } else {
                // Where it was then, no farther from the last tick nor from this one than odometry says.
                let then = since.back(&self.known);
                let told = self.contracted(&then, event);
                self.known = self.known.intersection(&since.ahead(&told));
            }
        }
        assert!(!self.known.is_empty(), "{:?}", sensed.stamp);
        if sensed.events.iter().any(|event| matches!(event.sense, Sense::Heard { .. })) {
            let rings = self.active(&self.known, &self.rings);
            self.known = self.contract(&self.known, &rings).expect("the truth is allowed");
        }
    }

    fn ring(&self, ping: &Ping, event: &Event) -> Ring {
        let apart = Way::within(self.travel.motion(), self.timestamp_s + 2.0 * self.stamp_s);
        Ring::new(ping, local_s(event.stamp, self.stamp_s).inflate(self.timestamp_s), apart)
    }

    fn contracted(&self, then: &State, event: &Event) -> State {
        match &event.sense {
            Sense::Depth { depth_m } => then.with_depth(*depth_m),
            Sense::Gnss { position_m, time_s } => {
                let position_m = IntervalBox::from(position_m.map(interval));
                then.with_fix(&position_m, interval(*time_s), local_s(event.stamp, self.stamp_s))
            }
            _ => Ok(*then),
        }
        .expect("it agrees with what is known")
    }

    /// The hull of all states that everything allows, position in metres; clock offset in seconds.
    ///
    /// # Panics
    /// When there are none.
    pub fn hull(&self) -> Hull {
        let mut outer = self.contract(&self.known, &self.rings).expect("the truth is allowed");
        let rings = self.active(&outer, &self.rings);
        let mut inner: Option<State> = None;
        for axis in 0..4 {
            for sign in [1.0, -1.0] {
                let (bound, witnesses) = self.reach(&outer, &rings, axis, sign);
                let mut sides = sides(&outer);
                let (lower, upper) = (sides[axis].lower(), sides[axis].upper());
                sides[axis] = if sign > 0.0 {
                    Interval::spanning(lower, upper.min(bound).max(lower))
                } else {
                    Interval::spanning(lower.max(-bound).min(upper), upper)
                };
                outer = state(sides);
                for witness in witnesses {
                    inner = Some(inner.map_or(witness, |inner| inner.hull(&witness)));
                }
            }
        }
        Hull { outer, inner: inner.expect("some point is found") }
    }

    /// The most of `sign` times a coordinate, and the points that were found on the way.
    fn reach(&self, within: &State, rings: &[Ring], axis: usize, sign: f64) -> (f64, Vec<State>) {
        let most = |of: &State| {
            let side = sides(of)[axis];
            if sign > 0.0 { side.upper() } else { -side.lower() }
        };
        let fine = FINE / 2.0 * sides(within)[axis].width();
        let mut queue = BinaryHeap::from([Part { most: most(within), state: *within }]);
        let mut witnesses: Vec<State> = Vec::new();
        let mut reached = f64::NEG_INFINITY;
        for _ in 0..BOXES {
            let Some(Part { most: bound, state: part }) = queue.pop() else { break };
            if bound <= reached + fine {
                return (bound, witnesses);
            }
            let Some(part) = self.contract(&part, rings) else { continue };
            if most(&part) < bound - fine {
                queue.push(Part { most: most(&part), state: part });
                continue;
            }
            for ahead in [0.99, 0.95, 0.8, 0.5, 0.0] {
                let Some(point) = self.point(&part, rings, axis, sign * ahead) else { continue };
                if most(&point) > reached && self.allows(&point, rings) {
                    reached = most(&point);
                    witnesses.push(point);
                }
            }
            let widths: [f64; 4] = std::array::from_fn(|axis| {
                sides(&part)[axis].width() / sides(within)[axis].width().max(f64::MIN_POSITIVE)
            });
            let widest = (0..4).max_by(|&one, &other| widths[one].total_cmp(&widths[other])).unwrap();
            for half in halves(&part, widest) {
                queue.push(Part { most: most(&half), state: half });
            }
        }
        (queue.peek().map_or(reached, |part| part.most).max(reached), witnesses)
    }

    /// A point of a part that may be allowed: `ahead` of the middle along an axis, as a part of the radius, then in the middle of
    /// what that leaves, axis by axis.
    fn point(&self, part: &State, rings: &[Ring], axis: usize, ahead: f64) -> Option<State> {
        let mut left = *part;
        for next in (0..4).map(|step| (axis + step) % 4) {
            let mut sides = sides(&left);
            let ahead = if next == axis { ahead } else { 0.0 };
            sides[next] = point(sides[next].mid() + ahead * sides[next].radius());
            left = state(sides);
            for ring in rings {
                left = ring.contract(&left, &self.sound).ok()?;
            }
        }
        // Nothing is left but points, a rounding wide where they were contracted.
        Some(state(sides(&left).map(|side| point(side.mid()))))
    }

    /// Whether every constraint allows a point, which `known` holds.
    fn allows(&self, point: &State, rings: &[Ring]) -> bool {
        rings.iter().all(|ring| ring.contract(point, &self.sound).is_ok())
    }

    fn contract(&self, state: &State, rings: &[Ring]) -> Option<State> {
        let mut state = *state;
        for _ in 0..8 {
            let before = state;
            for ring in rings {
                state = ring.contract(&state, &self.sound).ok()?;
            }
            state = together::contract(rings, &state, &self.sound, 0.001).ok()?;
            if !state.is_tighter_by(&before, 0.01) {
                break;
            }
        }
        Some(state)
    }

    /// The rings that may not allow all of `state`.
    fn active(&self, state: &State, rings: &[Ring]) -> Vec<Ring> {
        let speed = self.sound.speed_m_s;
        let is_active = |ring: &&Ring| {
            let (mut near, mut far, mut least) = (0.0, 0.0, 0.0);
            for axis in 0..3 {
                let side = state.position_m[axis];
                let centre = ring.emitter_m[axis] + ring.since.displacement_m[axis];
                // Nearest and farthest of the centre from the ends of the side.
                let outside = (side.upper() - centre.upper()).max(centre.lower() - side.lower()).max(0.0);
                let middle = side.mid().clamp(side.lower(), side.upper());
                let inside = (0..=8)
                    .map(|step| side.lower() + side.width() * f64::from(step) / 8.0)
                    .chain([middle, centre.mid().clamp(side.lower(), side.upper())])
                    .map(|at| (centre.upper() - at).abs().max((at - centre.lower()).abs()))
                    .fold(f64::INFINITY, f64::min);
                near += outside * outside;
                far += inside * inside;
                let reach = (centre - side).magnitude();
                least += reach * reach;
            }
            let delay = |offset_s: f64| {
                Interval::centred(offset_s, 0.0) - ring.since.offset_gain_s + ring.arrival_s - ring.emission_s
            };
            let longest_m = speed.upper() * delay(state.offset_s.lower()).upper();
            let shortest_m = speed.lower() * delay(state.offset_s.upper()).lower();
            near.sqrt() * 1.000_001 > longest_m
                || far.sqrt() * 0.999_999 < shortest_m
                || least.sqrt() * 1.000_001 > self.sound.hearing_range_m
        };
        rings.iter().filter(is_active).copied().collect()
    }
}

/// A part of what is searched.
struct Part {
    most: f64,
    state: State,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most.total_cmp(&other.most)
    }
}

fn interval(of: Bounds) -> Interval {
    Interval::spanning(of.lower, of.upper)
}

fn sides(of: &State) -> [Interval; 4] {
    let [x, y, z] = of.position_m.sides();
    [x, y, z, of.offset_s]
}

fn state([x, y, z, offset_s]: [Interval; 4]) -> State {
    State { offset_s, position_m: IntervalBox::from([x, y, z]) }
}

fn point(at: f64) -> Interval {
    Interval::centred(at, 0.0)
}

fn halves(part: &State, axis: usize) -> [State; 2] {
    let whole = sides(part);
    let middle = whole[axis].mid();
    [(whole[axis].lower(), middle), (middle, whole[axis].upper())].map(|(lower, upper)| {
        let mut half = whole;
        half[axis] = Interval::spanning(lower, upper);
        state(half)
    })
}
