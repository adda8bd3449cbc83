use proptest::prelude::*;
use shoal_bus::lockstep::Mind;
use shoal_bus::message::{Bounds, Event, Sense};
use shoal_bus::ping::Ping;

use super::*;
use crate::Auv;
use crate::newborn::{PERIOD_NS, newborn};

const WAKE: Wake = Wake { first_tick: LocalTime::ZERO, period_ns: 100, reaction_ns: 250 };

/// All bookings over ticks 0, 100, ..., as (tick, booking); `held` says which emissions the modem holds back.
fn bookings(orders: Orders, ticks: i64, held: impl Fn(LocalTime) -> bool) -> Vec<(i64, Booking)> {
    let mut access = ordered(&orders);
    let mut waiting: Vec<LocalTime> = Vec::new();
    let mut all = Vec::new();
    for tick in 0..ticks {
        let stamp = LocalTime::from_ns(WAKE.period_ns * tick);
        let (now, later) = waiting.into_iter().partition(|&at| at <= stamp);
        waiting = later;
        let events =
            Vec::into_iter(now).filter(|&at| held(at)).map(|stamp| Event { stamp, sense: Sense::Held });
        let sensed = Sensed { tick: tick as u64, stamp, events: events.collect() };
        let mut booked = Vec::new();
        access.book(&Tick::new(&sensed, &WAKE, &|_| Interval::ENTIRE), &mut booked);
        waiting.extend(booked.iter().map(|booking| booking.at));
        all.extend(booked.into_iter().map(|booking| (stamp.ns(), booking)));
    }
    all
}

fn undisturbed(orders: Orders) -> Vec<(i64, Booking)> {
    bookings(orders, 40, |_| false)
}

fn periodic(first_ns: i64, period_ns: i64) -> Orders {
    Orders::Periodic { first: LocalTime::from_ns(first_ns), period_ns }
}

#[test]
fn every_periodic_ping_is_booked_once_at_the_last_tick_that_may() {
    let booked = undisturbed(periodic(1_000, 330));
    assert_eq!(booked[0].0, 700);
    for (index, &(tick, Booking { at, listen_ns })) in booked.iter().enumerate() {
        assert_eq!((at.ns(), listen_ns), (1_000 + 330 * index as i64, 0));
        assert!((tick + 250..tick + 350).contains(&at.ns()), "ping at {at} booked at {tick}");
    }
    // Several pings between two ticks are all booked at the one before.
    assert!(undisturbed(periodic(1_000, 40)).iter().filter(|(tick, _)| *tick == 1_000).count() >= 2);
}

#[test]
fn periodic_pings_that_could_not_be_booked_are_left_out() {
    let (tick, first) = undisturbed(periodic(10, 300))[0];
    assert_eq!((tick, first.at.ns()), (0, 310));
}

#[test]
fn the_silent_never_ping() {
    assert!(undisturbed(Orders::Silent).is_empty());
}

fn aloha(first_ns: i64, mean_period_ns: i64, entropy: u64) -> Orders {
    Orders::Aloha { first: LocalTime::from_ns(first_ns), mean_period_ns, entropy }
}

#[test]
fn aloha_pings_at_its_own_random_times() {
    let booked = bookings(aloha(1_000, 330, 1), 20_000, |_| false);
    let mut before = LocalTime::from_ns(1_000);
    for &(tick, Booking { at, listen_ns }) in &booked {
        assert!(at > before && listen_ns == 0);
        assert!((tick + 250..tick + 350).contains(&at.ns()), "ping at {at} booked at {tick}");
        before = at;
    }
    // A Poisson count of 6,057 on average has a deviation of 78.
    let expected = (20_000.0 * 100.0 - 1_000.0) / 330.0;
    assert!((booked.len() as f64 - expected).abs() < 4.0 * expected.sqrt(), "{} of {expected}", booked.len());
    assert_eq!(booked, bookings(aloha(1_000, 330, 1), 20_000, |_| false));
    assert_ne!(booked, bookings(aloha(1_000, 330, 2), 20_000, |_| false));
}

#[test]
fn aloha_never_books_the_past() {
    let booked = undisturbed(aloha(-1_000_000, 330, 1));
    assert!(booked.len() > 3 && booked[0].1.at.ns() > 250);
}

fn csma(backoff_ns: i64) -> Orders {
    Orders::Csma { first: LocalTime::from_ns(1_000), period_ns: 5_000, listen_ns: 70, backoff_ns, entropy: 5 }
}

#[test]
fn csma_is_periodic_while_nobody_else_speaks() {
    let booked = bookings(csma(300), 400, |_| false);
    let expected = bookings(periodic(1_000, 5_000), 400, |_| false);
    assert!(booked.iter().all(|(_, booking)| booking.listen_ns == 70));
    assert!(
        booked
            .iter()
            .map(|(tick, booking)| (tick, booking.at))
            .eq(expected.iter().map(|(tick, booking)| (tick, booking.at)))
    );
}

#[test]
fn csma_tries_again_what_was_held_back_until_the_next_ping_is_due() {
    // The medium is busy for the first 3,000 ns of each period.
    let busy = |at: LocalTime| (at.ns() - 1_000).rem_euclid(5_000) < 3_000;
    let booked = bookings(csma(300), 4_000, busy);
    let mut tries: Vec<Vec<LocalTime>> = Vec::new();
    for &(tick, Booking { at, listen_ns }) in &booked {
        assert!(listen_ns == 70 && (tick + 250..tick + 350).contains(&at.ns()), "{at} booked at {tick}");
        if (at.ns() - 1_000) % 5_000 == 0 {
            tries.push(Vec::new());
        }
        tries.last_mut().unwrap().push(at);
    }
    assert_eq!(tries.len(), 80);
    for of_one in &tries {
        // Every try but the last was held back, and follows it after what a booking takes.
        assert!(of_one.windows(2).all(|pair| busy(pair[0]) && pair[1] - pair[0] > 250));
        assert!(of_one.len() > 1 && of_one.iter().all(|&at| at - of_one[0] < 5_000));
    }
    assert!(tries.iter().filter(|of_one| !busy(*of_one.last().unwrap())).count() > 70);

    // Always busy: tried several times, given up each time before the next one is due, and never stuck.
    let booked = bookings(csma(300), 4_000, |_| true);
    assert!(booked.windows(2).all(|pair| pair[0].1.at < pair[1].1.at));
    assert_eq!(booked.iter().filter(|(_, booking)| (booking.at.ns() - 1_000) % 5_000 == 0).count(), 80);
}

#[test]
fn csma_gives_up_a_ping_whose_follower_is_already_booked() {
    // Periods shorter than the reaction time: what was held back is known when the next ping is long since booked.
    let orders = Orders::Csma {
        first: LocalTime::from_ns(1_000),
        period_ns: 110,
        listen_ns: 70,
        backoff_ns: 10,
        entropy: 5,
    };
    let booked = bookings(orders, 100, |_| true);
    assert!(booked.iter().all(|(_, booking)| (booking.at.ns() - 1_000) % 110 == 0));
}

/// One AUV in the slots `slot` of `slots`, with a clock that is off by `offset_s` in an interval of width `width_s` and runs at the
/// rates `1 + drift * rates` from tick to tick; a fix every so many ticks tells it the true time to `fix_s`. Gives the frames
/// in which it spoke; panics when it speaks outside its slot.
fn spoken(
    clock: (f64, f64, f64, &[f64]),
    fix: Option<(usize, f64)>,
    slots: (i64, u32, u32),
    occupied: (i64, i64),
) -> Vec<i64> {
    let (drift, width_s, share, rates) = clock;
    let (slot_ns, count, slot) = slots;
    let (packet_ns, propagation_ns) = occupied;
    let mut born = newborn(Orders::Slotted { slot_ns, slots: count, slot, packet_ns, propagation_ns });
    // True minus local time at birth, of which the AUV knows the interval.
    let offset_s = share * width_s;
    born.clock.drift = drift;
    born.clock.offset_s = Bounds::new(0.0, width_s);
    let mut auv = Auv::new(&born);

    let period_s = PERIOD_NS as f64 * 1e-9;
    let mut true_s = vec![offset_s];
    let mut emitted: Vec<(LocalTime, Ping)> = Vec::new();
    for (index, rate) in rates.iter().enumerate() {
        let at_tick_s = true_s[index] + period_s / (1.0 + drift * rate);
        true_s.push(at_tick_s);
        let stamp = LocalTime::from_ns((index as i64 + 1) * PERIOD_NS);
        let mut events = Vec::new();
        if let Some((every, fix_s)) = fix
            && index % every == every - 1
        {
            let time_s = Bounds::new(at_tick_s - 0.7 * fix_s, at_tick_s + 0.3 * fix_s);
            let position_m = [Bounds::new(-1e4, 1e4); 3];
            events.push(Event { stamp, sense: Sense::Gnss { position_m, time_s } });
        }
        let acted = auv.step(&Sensed { tick: index as u64, stamp, events });
        emitted.extend(acted.pings.iter().map(|ping| (ping.at, Ping::decode(&ping.frame).unwrap())));
    }

    let frame_s = slot_ns as f64 * 1e-9 * f64::from(count);
    let occupied_s = (packet_ns + propagation_ns) as f64 * 1e-9;
    let mut frames = Vec::new();
    for (at, ping) in emitted {
        let before = (at.ns() / PERIOD_NS) as usize;
        let (Some(&from_s), Some(&to_s)) = (true_s.get(before), true_s.get(before + 1)) else { continue };
        let emission_s = from_s + (to_s - from_s) * (at.ns() % PERIOD_NS) as f64 / PERIOD_NS as f64;
        let into_frame_s = emission_s.rem_euclid(frame_s);
        let begin_s = f64::from(slot) * slot_ns as f64 * 1e-9;
        let end_s = begin_s + slot_ns as f64 * 1e-9;
        let slack_s = 1e-9;
        assert!(into_frame_s >= begin_s - slack_s, "{into_frame_s} before {begin_s}");
        assert!(into_frame_s + occupied_s <= end_s + slack_s, "{into_frame_s} after {end_s}");
        assert!(ping.emission_s.contains(emission_s));
        frames.push((emission_s / frame_s) as i64);
    }
    assert!(frames.windows(2).all(|pair| pair[0] < pair[1]), "twice in a slot: {frames:?}");
    frames
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// Wherever the clock's offset is in its interval and however the clock drifts, with and without fixes, the packet and its
    /// sound stay inside the own slot of true time.
    #[test]
    fn nobody_speaks_outside_the_own_slot(
        drift in prop_oneof![Just(0.0), 1e-6..1e-3_f64, 1e-3..0.1_f64],
        (width_s, share) in (prop_oneof![Just(0.0), 0.0..0.5_f64, 0.0..5.0_f64], prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0_f64]),
        rates in prop_oneof![
            prop::collection::vec(-1.0..=1.0_f64, 300),
            Just(vec![1.0; 300]),
            Just(vec![-1.0; 300]),
        ],
        fix in prop::option::of((1usize..80, 1e-4..0.3_f64)),
        slot_ns in 50_000_000..2_000_000_000_i64,
        (slots, slot) in (1u32..8).prop_flat_map(|slots| (Just(slots), 0..slots)),
        (packet, propagation) in (0.01..0.6_f64, 0.0..0.4_f64),
    ) {
        let part = |of: f64| (slot_ns as f64 * of) as i64;
        spoken((drift, width_s, share, &rates), fix, (slot_ns, slots, slot), (part(packet), part(propagation)));
    }
}

#[test]
fn a_known_clock_speaks_in_every_frame() {
    let rates = [0.3; 400];
    for slot in 0..4 {
        let frames =
            spoken((50e-6, 1e-3, 0.5, &rates), None, (1_000_000_000, 4, slot), (400_000_000, 500_000_000));
        // 40 s of ticks, frames of 4 s; at the borders, a slot may be out of reach.
        assert!(frames.len() >= 9, "slot {slot}: {frames:?}");
        assert!(frames.windows(2).all(|pair| pair[1] == pair[0] + 1), "slot {slot}: {frames:?}");
    }
}

#[test]
fn the_own_slot_is_left_silent_once_the_clock_is_too_uncertain() {
    // 100 ms to spare, 20 ms known at first, 2 d = 4 ms/s: enough for about (100 - 20) / 4 = 20 s of frames of 1 s.
    let rates = [-1.0; 400];
    let (slots, occupied) = ((500_000_000, 2, 1), (300_000_000, 100_000_000));
    let clock = (2e-3, 20e-3, 0.5, rates.as_slice());
    let frames = spoken(clock, None, slots, occupied);
    assert!((18..=21).contains(&frames.len()), "{frames:?}");
    assert!(*frames.last().unwrap() <= 21);
    // A fix every 5 s keeps it talking.
    assert!(spoken(clock, Some((50, 5e-3)), slots, occupied).len() >= 38);
}

#[test]
fn silent_slots_are_counted() {
    let mut slotted = Slotted::new(500, 2, 1, 300);
    let sensed = |stamp_ns| Sensed { tick: 0, stamp: LocalTime::from_ns(stamp_ns), events: Vec::new() };
    let mut booked = Vec::new();
    for tick in 0..100 {
        // The true time is known to 100 ns in the first half, to 300 ns in the second, of which a slot has 200 to spare.
        let width_ns = if tick < 50 { 100.0 } else { 300.0 };
        let true_time_s = |at: LocalTime| Interval::centred(at.as_s(), 0.5e-9 * width_ns);
        slotted.book(&Tick::new(&sensed(100 * tick), &WAKE, &true_time_s), &mut booked);
    }
    let (spoken, silent) = (booked.len(), slotted.silent());
    assert!((4..=6).contains(&spoken) && (4..=6).contains(&silent), "{spoken} {silent}");
}
