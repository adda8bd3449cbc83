//! One AUV as the water knows it: body, clock, sensors, and the messages that wait for it.

use std::collections::VecDeque;

use shoal_bus::message::{
    Acted, AuvId, Born, Bounds, BoundsBox, Event, MediumAccess, PlannedPing, Sense, Sensed,
};
use shoal_bus::ping::Frame;
use shoal_bus::time::{LocalTime, SimTime};
use shoal_scenario::LISTEN_MAX_NS;
use shoal_scenario::model::FalseArrivals;

use crate::bearing::{BearingArray, Incidence};
use crate::birth::Newborn;
use crate::body::{Body, Pose, Vec3};
use crate::clock::{STAMP_NS, TrueClock};
use crate::draw::Draws;
use crate::exposure::Exposure;
use crate::sensors::Sensors;
use crate::sound::Wavefront;

/// So many pings beyond twice its schedule may wait to be emitted; more is an AUV out of its mind.
const PINGS_OUTSTANDING: usize = 64;
/// A ping may be booked at most so much earlier than a schedule needs, in local nanoseconds.
const BOOKING_SLACK_NS: i64 = 60 * 1_000_000_000;

/// One AUV, true through and through.
pub struct Vehicle {
    /// What it was told at birth.
    pub born: Born,
    /// True body.
    pub body: Body,
    /// True clock.
    pub clock: TrueClock,
    /// False once its process has ended.
    pub alive: bool,
    /// Bound of its speed over ground, in m/s.
    pub ground_speed_m_s: f64,
    /// Length of its body in metres.
    pub length_m: f64,
    /// Pings emitted so far.
    pub emitted: u32,
    /// Pings that arrived and were decoded so far.
    pub pings_heard: u64,
    /// End of its last packet, at the emitter.
    pub emits_until: SimTime,
    exposure: Exposure,
    false_arrivals: FalseArrivals,
    outliers: Draws,
    kidnappings: Vec<Kidnapping>,
    sensors: Sensors,
    timestamps: Draws,
    timestamp_error_s: f64,
    bearings: Option<BearingArray>,
    /// Local time of tick 0, in whichever life that was.
    first_tick: LocalTime,
    next_tick: u64,
    next_tick_at: SimTime,
    last_tick_at: SimTime,
    /// True time of its last birth.
    pub(crate) born_at: SimTime,
    /// The truth at the moment between ticks, once that moment is over.
    between: Option<(Vec3, f64)>,
    heard: Vec<HeardPing>,
    held: Vec<(LocalTime, SimTime)>,
    planned: VecDeque<Planned>,
    /// Ticks that wait for their answers.
    pub answered: VecDeque<Tick>,
}

/// A ping that is booked.
#[derive(Clone, Copy, Debug)]
pub struct Planned {
    /// True time of its emission.
    pub at: SimTime,
    /// The local time for which it was booked.
    pub stamp: LocalTime,
    /// Not to be emitted when the modem heard something within so many nanoseconds before.
    pub listen_ns: i64,
    /// What it says.
    pub frame: Frame,
    /// True time of the tick that booked it.
    pub booked: SimTime,
}

/// A body carried elsewhere, with or without its mind's notice.
#[derive(Clone, Copy, Debug)]
struct Kidnapping {
    at: SimTime,
    noticed: Option<SimTime>,
}

/// A ping that was decoded but not yet handed over.
struct HeardPing {
    stamp: LocalTime,
    at: SimTime,
    from: AuvId,
    frame: Frame,
    /// Where it came from, if the AUV has an array.
    bearing: Option<Sense>,
    /// Whether range or payload is wrong.
    is_false: bool,
}

/// A tick that waits for its answer, with the truth to check it against.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// Its index.
    pub index: u64,
    /// Its local time.
    pub stamp: LocalTime,
    /// Its true time.
    pub at: SimTime,
    /// The truth at it.
    pub pose: Pose,
    /// The true position at a moment between the tick before (or birth) and this one, in metres.
    pub between_position_m: Vec3,
    /// True time minus local time at that moment, in seconds.
    pub between_offset_s: f64,
}

impl Vehicle {
    /// A newborn in the water.
    pub fn new(newborn: Newborn, ground_speed_m_s: f64, length_m: f64, timestamp_error_s: f64) -> Self {
        let Newborn { mut clock, body, sensors, arrivals, bearings, outliers, false_arrivals, born } =
            newborn;
        let exposure = Exposure::new(&born.orders.estimator);
        let first_tick = born.wake.first_tick;
        let next_tick_at = clock.reaches(first_tick);
        Self {
            born,
            body,
            clock,
            alive: true,
            ground_speed_m_s,
            length_m,
            emitted: 0,
            pings_heard: 0,
            emits_until: SimTime::ZERO,
            exposure,
            false_arrivals,
            outliers,
            kidnappings: Vec::new(),
            sensors,
            timestamps: arrivals,
            timestamp_error_s,
            bearings,
            first_tick,
            next_tick: 0,
            next_tick_at,
            last_tick_at: SimTime::ZERO,
            born_at: SimTime::ZERO,
            between: None,
            heard: Vec::new(),
            held: Vec::new(),
            planned: VecDeque::new(),
            answered: VecDeque::new(),
        }
    }

    /// True time of its next tick.
    pub fn next_tick_at(&self) -> SimTime {
        self.next_tick_at
    }

    /// Nothing that it decides acts sooner than so many nanoseconds of true time later.
    pub fn lookahead_ns(&self) -> i64 {
        let usable_ns = (self.born.wake.reaction_ns - crate::clock::STAMP_NS) as f64;
        (usable_ns / (1.0 + self.born.clock.drift)).floor() as i64
    }

    /// Why no promise covers what it states of itself at its tick at `tick`: it was told more that is false than it was to expect.
    pub fn is_exposed_at(&self, tick: SimTime) -> bool {
        self.exposure.is_broken_at(tick)
    }

    /// Whether it was told anything false until its tick at `tick`.
    pub fn is_deceived_at(&self, tick: SimTime) -> bool {
        self.exposure.deceived_since.is_some_and(|since| since <= tick)
    }

    /// Windows of pings that it was told, and how many of them kept to what it assumes.
    pub fn windows(&self) -> (u64, u64) {
        self.exposure.windows()
    }

    /// So much later than it arrived its modem stamps the next ping, in local nanoseconds, when it takes something else for it.
    pub fn draw_false_arrival(&mut self) -> Option<i64> {
        let FalseArrivals { rate, delay_s } = self.false_arrivals;
        if rate <= 0.0 {
            return None;
        }
        let (is_false, delay_s) = (self.outliers.unit() < rate, self.outliers.between(0.0, delay_s));
        is_false.then_some((delay_s * 1e9) as i64)
    }

    /// Carries its body to `to_m` at `at`; its mind is not told.
    pub fn kidnap(&mut self, at: SimTime, to_m: Vec3) {
        self.body.kidnap(at, to_m);
        self.kidnappings.push(Kidnapping { at, noticed: None });
    }

    /// Whether it is carried elsewhere at any time of the run.
    pub fn is_ever_kidnapped(&self) -> bool {
        !self.kidnappings.is_empty()
    }

    /// Whether what it states at `at`, by what it knew at its tick at `known`, may rest on where it was before a kidnapping: it has
    /// not said since that nothing was left of its set.
    pub fn is_kidnapped_at(&self, at: SimTime, known: SimTime) -> bool {
        self.kidnappings.iter().any(|of| of.at <= at && of.noticed.is_none_or(|noticed| known < noticed))
    }

    /// Whether kidnappers had its modem out of the water between `since` and `at`.
    pub fn was_kidnapped_between(&self, since: SimTime, at: SimTime) -> bool {
        // The body leaps at the next knot.
        self.kidnappings.iter().any(|of| since <= of.at && of.at <= at) || self.body.leapt_between(since, at)
    }

    /// It said at its tick at `at` that nothing was left of its set; the answer is the nanoseconds since the kidnapping that it
    /// has noticed by that, if it is one.
    pub fn notices(&mut self, at: SimTime) -> Option<i64> {
        let unnoticed = self.kidnappings.iter_mut().filter(|of| of.at <= at && of.noticed.is_none());
        let since = unnoticed.map(|of| {
            of.noticed = Some(at);
            at - of.at
        });
        since.max()
    }

    /// Whether it measures from where pings come.
    pub fn has_bearings(&self) -> bool {
        self.bearings.is_some()
    }

    /// Takes a ping that was decoded at true time `at`, its modem having read the clock at `stamp`, or just then, and so many
    /// nanoseconds too late.
    pub fn hear(
        &mut self,
        at: SimTime,
        stamp: Option<LocalTime>,
        late_ns: i64,
        wavefront: &Wavefront,
        incidence: Option<&Incidence>,
        is_false: bool,
    ) {
        let Wavefront { from, frame, .. } = *wavefront;
        let error_ns = (self.timestamps.error(self.timestamp_error_s) * 1e9) as i64;
        let stamp = stamp.unwrap_or_else(|| self.clock.read(at)) + error_ns + late_ns;
        let bearing =
            self.bearings.as_mut().zip(incidence).map(|(array, incidence)| array.sense(from, incidence));
        self.pings_heard += 1;
        self.heard.push(HeardPing { stamp, at, from, frame, bearing, is_false });
    }

    /// Its modem held back, at true time `at`, the ping that was booked for `stamp`.
    pub fn hold(&mut self, stamp: LocalTime, at: SimTime) {
        self.held.push((stamp, at));
    }

    /// Refuses answers that no working AUV gives; the reason is a clause.
    pub fn validate(&self, acted: &Acted, tick: &Tick) -> Result<(), String> {
        let Born { wake, modem, orders, .. } = &self.born;
        if acted.tick != tick.index {
            return Err(format!("it answered tick {} when asked tick {}", acted.tick, tick.index));
        }
        let is_velocity = |component: &f64| component.is_finite() && component.abs() < 1e6;
        let mut components = acted.setpoint.velocity_m_s.iter().enumerate();
        if let Some((axis, wrong)) = components.find(|(_, component)| !is_velocity(component)) {
            return Err(format!(
                "its setpoint.velocity_m_s[{axis}] is {wrong:?}, a velocity is finite and below 1e6 m/s"
            ));
        }
        let ahead_ns = wake.reaction_ns + 2 * wake.period_ns;
        let scheduled = shortest_gap_ns(&orders.access).map_or(0, |gap_ns| ahead_ns / gap_ns) as usize;
        if self.planned.len() + acted.pings.len() > 2 * scheduled + PINGS_OUTSTANDING {
            let waiting = self.planned.len();
            return Err(format!("it booked {} pings on top of {waiting}", acted.pings.len()));
        }
        for ping in &acted.pings {
            let bytes = ping.frame.bytes().len();
            if bytes > usize::from(modem.frame_bytes) {
                return Err(format!(
                    "it booked a ping of {bytes} bytes, its modem carries {}",
                    modem.frame_bytes
                ));
            }
            if !(0..=LISTEN_MAX_NS).contains(&ping.listen_ns) {
                return Err(format!(
                    "it booked a ping with listen_ns {}, which is not from 0 to {LISTEN_MAX_NS}",
                    ping.listen_ns
                ));
            }
            if ping.at.ns().saturating_sub(tick.stamp.ns()) > ahead_ns + BOOKING_SLACK_NS {
                return Err(format!(
                    "it booked a ping at {} ns, far ahead of its tick at {} ns",
                    ping.at.ns(),
                    tick.stamp.ns()
                ));
            }
        }
        Ok(())
    }

    /// Books a ping at its tick at `booked`; `at` lies in no window already advanced.
    pub fn plan(&mut self, ping: PlannedPing, booked: SimTime) {
        let at = self.clock.reaches(ping.at);
        let place = self.planned.partition_point(|earlier| earlier.at <= at);
        let PlannedPing { at: stamp, listen_ns, frame } = ping;
        self.planned.insert(place, Planned { at, stamp, listen_ns, frame, booked });
    }

    /// Whether a booked ping leaves before `horizon`.
    pub fn emits_before(&self, horizon: SimTime) -> bool {
        self.planned.front().is_some_and(|next| next.at < horizon)
    }

    /// The next booked ping that leaves before `horizon`.
    pub fn next_emission(&mut self, horizon: SimTime) -> Option<Planned> {
        if self.emits_before(horizon) { self.planned.pop_front() } else { None }
    }

    /// What it senses at its next tick, which comes before the horizon that its body is integrated to, written to `events`, which
    /// are empty.
    pub fn sense(&mut self, mut events: Vec<Event>) -> (Tick, Sensed) {
        let wake = self.born.wake;
        let stamp = self.stamp_of(self.next_tick);
        let at = self.next_tick_at;
        let pose = self.body.at(at);
        let (between_position_m, between_offset_s) =
            self.between.take().unwrap_or_else(|| self.truth_at(self.between_ticks()));

        // The sensors speak last, so that hardly anything is left to sort.
        self.hand_over_heard(stamp, at, &mut events);
        self.hand_over_held(stamp, at, &mut events);
        self.sensors.sense(stamp, at, &pose, &mut events);
        events.sort_by_key(|event| (event.stamp, kind_rank(&event.sense)));

        let tick = Tick { index: self.next_tick, stamp, at, pose, between_position_m, between_offset_s };
        self.answered.push_back(tick);
        self.next_tick += 1;
        self.last_tick_at = at;
        self.next_tick_at = self.clock.reaches(stamp + wake.period_ns);
        (tick, Sensed { tick: tick.index, stamp, events })
    }

    /// Pings heard up to this tick, in the order (stamp, emitter).
    fn hand_over_heard(&mut self, stamp: LocalTime, at: SimTime, events: &mut Vec<Event>) {
        self.heard.sort_by_key(|ping| (ping.stamp, ping.from, ping.at));
        let ready = self.heard.extract_if(.., |ping| ping.stamp <= stamp && ping.at <= at);
        for HeardPing { stamp: heard, frame, bearing, is_false, .. } in ready {
            self.exposure.told(is_false, at);
            events.push(Event { stamp: heard, sense: Sense::Heard { frame } });
            events.extend(bearing.map(|sense| Event { stamp: heard, sense }));
        }
    }

    /// Pings held back up to this tick.
    fn hand_over_held(&mut self, stamp: LocalTime, at: SimTime, events: &mut Vec<Event>) {
        self.held.retain(|&(held, held_at)| {
            let waits = held > stamp || held_at > at;
            if !waits {
                events.push(Event { stamp: held, sense: Sense::Held });
            }
            waits
        });
    }

    /// The oldest tick that waits for its answer.
    pub fn answer_tick(&mut self) -> Option<Tick> {
        self.answered.pop_front()
    }

    /// Ends its mind at `at`: nothing more is sensed or answered, and the body drifts once it has done what was decided.
    pub fn end(&mut self, at: SimTime) {
        self.alive = false;
        self.heard.clear();
        self.held.clear();
        self.answered.clear();
        let rest_from = self.body.last_setpoint().map_or(at, |last| last.max(at));
        self.body.steer(rest_from, Vec3::zeros());
    }

    /// Begins a new life at `now`, which is the end of the last window, at a place that lies in `prior_position_m`: its clock, its
    /// body, its sensors and its schedule go on, its mind knows nothing. Pings that are booked still leave.
    pub(crate) fn begin_again(&mut self, now: SimTime, prior_position_m: BoundsBox) {
        self.alive = true;
        self.exposure.begin_again(now);
        for of in self.kidnappings.iter_mut().filter(|of| self.body.leapt_between(of.at, now)) {
            of.noticed.get_or_insert(now);
        }
        self.between = None;
        self.last_tick_at = now;
        while self.next_tick_at <= now {
            self.next_tick += 1;
            self.next_tick_at = self.clock.reaches(self.stamp_of(self.next_tick));
        }
        // Since the last birth the clock has gained or lost so much at most; what it reads and what that means are rounded.
        let gained_s = self.born.clock.drift * ((now - self.born_at) as f64 * 1e-9) * (1.0 + 1e-9);
        let slack_s = gained_s + 4.0 * STAMP_NS as f64 * 1e-9;
        let Bounds { lower, upper } = self.born.clock.offset_s;
        self.born.clock.offset_s = Bounds::new(lower - slack_s, upper + slack_s);
        self.born.birth = self.clock.read(now);
        self.born.wake.first_tick = self.stamp_of(self.next_tick);
        self.born.prior_position_m = prior_position_m;
        self.born_at = now;
    }

    /// Local time of a tick.
    fn stamp_of(&self, tick: u64) -> LocalTime {
        self.first_tick + tick as i64 * self.born.wake.period_ns
    }

    /// Moves on to `to`, and forgets what lies before `remembered`. A second time changes nothing.
    pub fn move_on(&mut self, remembered: SimTime, to: SimTime) {
        self.forget_before(remembered);
        self.body.integrate(to);
    }

    /// Forgets the past that no later window of true time from `now` on asks for.
    fn forget_before(&mut self, now: SimTime) {
        if self.alive && self.between.is_none() && self.between_ticks() < now {
            self.between = Some(self.truth_at(self.between_ticks()));
        }
        self.body.forget_before(now);
        self.clock.forget_before(now);
    }

    /// Halfway from the last tick (or birth) to the next.
    fn between_ticks(&self) -> SimTime {
        self.last_tick_at + (self.next_tick_at - self.last_tick_at) / 2
    }

    /// True position in metres, and true time minus local time in seconds.
    fn truth_at(&mut self, at: SimTime) -> (Vec3, f64) {
        (self.body.position_at(at), self.clock.offset_s(at))
    }
}

/// Order of simultaneous events of different kinds.
fn kind_rank(sense: &Sense) -> u8 {
    match sense {
        Sense::Inertial { .. } => 0,
        Sense::Dvl { .. } => 1,
        Sense::Depth { .. } => 2,
        Sense::Gnss { .. } => 3,
        Sense::Heard { .. } => 4,
        Sense::Bearing { .. } => 5,
        Sense::Held => 6,
    }
}

/// Local nanoseconds between pings, on average; `None` for a silent AUV.
fn shortest_gap_ns(access: &MediumAccess) -> Option<i64> {
    match *access {
        MediumAccess::Silent => None,
        MediumAccess::Periodic { period_ns, .. } | MediumAccess::Csma { period_ns, .. } => Some(period_ns),
        MediumAccess::Aloha { mean_period_ns, .. } => Some(mean_period_ns),
        MediumAccess::Slotted { slot_ns, slots, .. } => Some(slot_ns.saturating_mul(i64::from(slots))),
    }
}
