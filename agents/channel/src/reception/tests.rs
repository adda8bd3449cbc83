use proptest::prelude::*;
use shoal_bus::traffic::Boundary;
use shoal_scenario::model::{FadingKind, FadingPer, Modulation, Noise};

use super::*;
use crate::acoustics::modulation::{self, bit_error_rate, packet_error_rate};
use crate::draw::Purpose;

const MS: i64 = 1_000_000;
const NOISE_DB: f64 = 70.0;
const SURFACE: SoundPath = SoundPath::Bounced { first: Boundary::Surface, bounces: 1 };
const BOTTOM: SoundPath = SoundPath::Bounced { first: Boundary::Bottom, bounces: 1 };
const GAUSSIAN: Fading = Fading { kind: FadingKind::Gaussian, per: FadingPer::Packet };
const RAYLEIGH: Fading = Fading { kind: FadingKind::Rayleigh, per: FadingPer::Packet };

/// SINR and Eb/N0 are the same in this modem.
fn settings(fading: Fading) -> EarSettings {
    let physical = PhysicalLayer {
        source_level_db: 180.0,
        centre_hz: 25_000.0,
        bandwidth_hz: 1_000.0,
        bit_rate_bit_s: 1_000.0,
        preamble_s: 0.05,
        modulation: Modulation::Bpsk,
        coding_gain_db: 0.0,
        detection_threshold_db: 3.0,
        capture_db: 6.0,
    };
    EarSettings { noise_db: NOISE_DB, physical, fading, sense_ns: 20 * MS }
}

fn ear(settings: EarSettings) -> Ear {
    Ear::new(settings, Draws::new(1, Purpose::Reception, AuvId(0), Noise::Uniform))
}

/// A packet of 200 bits and 250 ms that starts at `start_ms` with this SNR.
fn packet(from: u32, start_ms: i64, snr_db: f64) -> Arrival {
    Arrival {
        from: AuvId(from),
        sequence: 0,
        path: SoundPath::Direct,
        start: SimTime::from_ns(start_ms * MS),
        end: SimTime::from_ns((start_ms + 250) * MS),
        level_db: NOISE_DB + snr_db,
        doppler: 1.0,
        flight: 0,
        kind: ArrivalKind::Packet { copies: 1, bits: 200, asleep: false, known: true },
    }
}

/// The same, as one of `copies` copies by `path`.
fn copy(arrival: Arrival, path: SoundPath, copies: u8) -> Arrival {
    let ArrivalKind::Packet { bits, asleep, known, .. } = arrival.kind else { return arrival };
    Arrival { path, kind: ArrivalKind::Packet { copies, bits, asleep, known }, ..arrival }
}

fn settle(ear: &mut Ear) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    ear.settle(SimTime::from_ns(i64::MAX), &mut outcomes);
    assert_eq!(ear.pending(), 0);
    outcomes
}

/// Emitter, reason and colliding emitters, in the order told; the reason is `heard` for a packet decoded.
fn verdicts(settings: EarSettings, arrivals: &[Arrival]) -> Vec<(u32, &'static str, Vec<u32>)> {
    let mut ear = ear(settings);
    arrivals.iter().for_each(|&arrival| ear.expect(arrival));
    settle(&mut ear).iter().map(told).collect()
}

fn told(outcome: &Outcome) -> (u32, &'static str, Vec<u32>) {
    let (name, colliding) = match &outcome.verdict {
        Verdict::Heard => ("heard", Vec::new()),
        Verdict::Lost { reason, colliding } => (reason.name(), colliding.iter().map(|auv| auv.0).collect()),
    };
    (outcome.arrival.from.0, name, colliding)
}

#[test]
fn a_packet_alone_is_heard_at_its_end_with_its_numbers() {
    let arrival = Arrival { flight: 17, doppler: 1.001, ..packet(3, 40, 20.0) };
    let mut ear = ear(settings(GAUSSIAN));
    ear.expect(arrival);
    assert_eq!(ear.pending(), 1);
    let mut outcomes = Vec::new();
    ear.settle(arrival.end, &mut outcomes);
    assert!(outcomes.is_empty(), "what ends at the border belongs to the next window");
    ear.settle(arrival.end + 1, &mut outcomes);
    let [Outcome { arrival: decided, at, reception, verdict }] = outcomes.as_slice() else { panic!() };
    assert_eq!((*decided, *at, verdict), (arrival, arrival.end, &Verdict::Heard));
    assert_eq!((reception.path, reception.level_db, reception.doppler), (SoundPath::Direct, 90.0, 1.001));
    assert!((reception.sinr_db - 20.0).abs() < 1e-12);
    assert_eq!(ear.pending(), 0);
}

#[test]
fn equal_packets_that_overlap_collide() {
    let got = verdicts(settings(GAUSSIAN), &[packet(1, 0, 30.0), packet(2, 125, 30.0)]);
    assert_eq!(got, [(1, "collision", vec![2]), (2, "collision", vec![1])]);
    // One after the other, they do not.
    let got = verdicts(settings(GAUSSIAN), &[packet(1, 0, 30.0), packet(2, 250, 30.0)]);
    assert_eq!(got, [(1, "heard", vec![]), (2, "heard", vec![])]);
}

#[test]
fn the_louder_one_is_captured_whichever_came_first() {
    let got = verdicts(settings(GAUSSIAN), &[packet(1, 0, 20.0), packet(2, 125, 40.0)]);
    assert_eq!(got, [(1, "collision", vec![2]), (2, "heard", vec![])]);
    let got = verdicts(settings(GAUSSIAN), &[packet(1, 0, 40.0), packet(2, 125, 20.0)]);
    assert_eq!(got, [(1, "heard", vec![]), (2, "collision", vec![1])]);
    // Detectable, but not louder by enough: the receiver stays with the first, which the second spoils.
    let got = verdicts(settings(GAUSSIAN), &[packet(1, 0, 20.0), packet(2, 125, 25.9)]);
    assert_eq!(got, [(1, "collision", vec![2]), (2, "collision", vec![1])]);
}

#[test]
fn all_that_collide_are_named_but_not_those_that_hardly_sound() {
    let faint = Arrival { kind: ArrivalKind::Interference, ..packet(9, 10, 10.0) };
    let three = [packet(5, 0, 30.0), packet(3, 100, 30.0), packet(4, 200, 30.0), faint];
    let got = verdicts(settings(GAUSSIAN), &three);
    let expected = [(5, "collision", vec![3, 4]), (3, "collision", vec![4, 5]), (4, "collision", vec![3, 5])];
    assert_eq!(got, expected);
    // Fifty that would do no harm each do so together, and each has its part in it.
    let mut crowd: Vec<_> =
        (10..60).map(|from| Arrival { kind: ArrivalKind::Interference, ..packet(from, 0, 10.0) }).collect();
    crowd.push(packet(1, 100, 20.0));
    let got = verdicts(settings(GAUSSIAN), &crowd);
    let [(1, "collision", colliding)] = got.as_slice() else { panic!("{got:?}") };
    assert!(colliding.len() >= 45, "{colliding:?}");
}

#[test]
fn what_drowned_the_beginning_is_named_though_it_was_short() {
    let blast = Arrival { end: SimTime::from_ns(101 * MS), ..packet(7, 95, 40.0) };
    let long = Arrival { kind: ArrivalKind::Interference, ..packet(8, 105, 35.0) };
    let got = verdicts(settings(GAUSSIAN), &[blast, packet(1, 100, 20.0), long]);
    assert_eq!(got.last(), Some(&(1, "collision", vec![7, 8])));
}

#[test]
fn whoever_emits_hears_nothing() {
    let fate = |start_ms, end_ms, snr_db| {
        let mut ear = ear(settings(GAUSSIAN));
        ear.expect(packet(1, 100, snr_db));
        ear.emit(SimTime::from_ns(start_ms * MS), SimTime::from_ns(end_ms * MS));
        told(&settle(&mut ear)[0]).1
    };
    // It begins while the receiver emits; the receiver begins to emit while it is received; they only touch.
    assert_eq!(fate(0, 101, 30.0), "half_duplex");
    assert_eq!(fate(349, 500, 30.0), "half_duplex");
    assert_eq!(fate(200, 210, 30.0), "half_duplex");
    assert_eq!(fate(0, 100, 30.0), "heard");
    assert_eq!(fate(350, 500, 30.0), "heard");
    // What noise alone would have swallowed is no matter of the emission.
    assert_eq!(fate(0, 101, 2.9), "noise");
}

#[test]
fn a_faint_first_path_is_lost_and_a_later_one_decoded() {
    let direct = copy(packet(1, 0, -10.0), SoundPath::Direct, 2);
    let bounced = copy(packet(1, 30, 20.0), SURFACE, 2);
    let mut ear = ear(settings(GAUSSIAN));
    ear.expect(bounced);
    ear.expect(direct);
    assert_eq!(ear.pending(), 1);
    let outcomes = settle(&mut ear);
    let [outcome] = outcomes.as_slice() else { panic!("{outcomes:?}") };
    assert_eq!((outcome.arrival, outcome.at), (bounced, bounced.end));
    assert_eq!((outcome.reception.path, &outcome.verdict), (SURFACE, &Verdict::Heard));
    // Copies of a packet do not disturb each other.
    assert!((outcome.reception.sinr_db - 20.0).abs() < 1e-9);
}

#[test]
fn the_most_hopeful_copy_tells_why_its_packet_is_lost() {
    let last = |arrivals: &[Arrival]| {
        let mut ear = ear(settings(GAUSSIAN));
        arrivals.iter().for_each(|&arrival| ear.expect(arrival));
        settle(&mut ear).into_iter().find(|outcome| outcome.arrival.from == AuvId(1)).unwrap()
    };
    // Both are too faint: the direct one, though fainter, told at the end of the last.
    let direct = copy(packet(1, 0, -20.0), SoundPath::Direct, 2);
    let bounced = copy(packet(1, 30, -5.0), SURFACE, 2);
    let outcome = last(&[direct, bounced]);
    assert_eq!((outcome.arrival, outcome.at), (direct, bounced.end));
    assert_eq!(told(&outcome).1, "noise");
    // No direct one: the loudest.
    let (left, right) = (copy(packet(1, 0, -20.0), SURFACE, 2), copy(packet(1, 30, -5.0), BOTTOM, 2));
    assert_eq!(last(&[left, right]).arrival, right);
    // One would have been decoded, were it not for another packet: that is why.
    let bounced = copy(packet(1, 30, 20.0), SURFACE, 2);
    let outcome = last(&[direct, bounced, packet(2, 10, 20.0)]);
    assert_eq!((outcome.arrival, told(&outcome)), (bounced, (1, "collision", vec![2])));
}

#[test]
fn sleeping_and_foreign_modems_hear_nothing_but_energy() {
    let mut asleep = packet(1, 0, 30.0);
    asleep.kind = ArrivalKind::Packet { copies: 1, bits: 200, asleep: true, known: true };
    let mut foreign = packet(2, 400, 30.0);
    foreign.kind = ArrivalKind::Packet { copies: 1, bits: 200, asleep: false, known: false };
    let got = verdicts(settings(GAUSSIAN), &[asleep, foreign, packet(3, 500, 30.0)]);
    assert_eq!(got, [(1, "asleep", vec![]), (2, "band", vec![]), (3, "collision", vec![2])]);
}

#[test]
fn the_medium_is_busy_while_sound_is_noticeable_or_the_modem_emits() {
    let mut ear = ear(settings(GAUSSIAN));
    let at = |ms| SimTime::from_ns(ms * MS);
    // Two that are too faint each are not too faint together.
    for from in [1, 2] {
        ear.expect(Arrival { kind: ArrivalKind::Interference, ..packet(from, i64::from(from) * 100, 1.0) });
    }
    ear.emit(at(500), at(550));
    let mut busy_ms = Vec::new();
    for ms in (10..=700).step_by(10) {
        ear.settle(at(ms), &mut Vec::new());
        if ear.busy(at(ms - 10), at(ms)) {
            busy_ms.push(ms - 10);
        }
        // What has just ended is remembered for 20 ms.
        assert_eq!(
            ear.busy(at(ms - 20), at(ms)),
            (201..370).contains(&ms) || (501..570).contains(&ms),
            "{ms}"
        );
    }
    let expected: Vec<i64> = (200..350).chain(500..550).step_by(10).collect();
    assert_eq!(busy_ms, expected);
    // A span of no length is an instant.
    ear.expect(packet(5, 710, 30.0));
    ear.settle(at(720), &mut Vec::new());
    assert!(ear.busy(at(700), at(720)) && ear.busy(at(720), at(720)) && !ear.busy(at(700), at(710)));
}

/// The lost part of `count` packets of `bits` bits, one after the other, with this mean SNR.
fn lost_fraction(settings: EarSettings, bits: u32, snr_db: f64, count: u32) -> f64 {
    let mut ear = ear(settings);
    let mut outcomes = Vec::new();
    for sequence in 0..count {
        let mut arrival = Arrival { sequence, ..packet(1, i64::from(sequence) * 300, snr_db) };
        arrival.kind = ArrivalKind::Packet { copies: 1, bits, asleep: false, known: true };
        ear.expect(arrival);
        ear.settle(arrival.end + 1, &mut outcomes);
    }
    assert_eq!(outcomes.len(), count as usize);
    let lost = outcomes.iter().filter(|outcome| told(outcome).1 == "noise").count();
    assert_eq!(lost, outcomes.iter().filter(|outcome| outcome.verdict != Verdict::Heard).count());
    lost as f64 / f64::from(count)
}

/// Within four standard deviations of what theory says.
fn assert_probability(measured: f64, expected: f64, count: u32) {
    let deviation = (expected * (1.0 - expected) / f64::from(count)).sqrt();
    assert!((measured - expected).abs() < 4.0 * deviation, "{measured} {expected} {deviation}");
}

#[test]
fn packets_are_lost_as_often_as_theory_says() {
    const COUNT: u32 = 20_000;
    // BPSK at 7 dB, 256 bits: the reference value of the seed.
    assert_probability(lost_fraction(settings(GAUSSIAN), 256, 7.0, COUNT), 0.1795, COUNT);
    // The same with a wide band, a slow bit rate and coding, which together are worth 7 dB.
    let mut coded = settings(GAUSSIAN);
    coded.physical.bandwidth_hz = 2_000.0;
    coded.physical.coding_gain_db = 3.5 - db_from_power(2.0);
    assert_probability(lost_fraction(coded, 256, 3.5, COUNT), 0.1795, COUNT);
    // Fast Rayleigh fading at 20 dB.
    let fast = settings(Fading { kind: FadingKind::Rayleigh, per: FadingPer::Bit });
    let rate = bit_error_rate(modulation::Modulation::Bpsk, modulation::Fading::Rayleigh, 100.0);
    assert_probability(lost_fraction(fast, 256, 20.0, COUNT), packet_error_rate(rate, 256), COUNT);
    // Slow Rayleigh fading, nothing but detection: the outage is 1 - exp(-threshold / mean).
    let outage = 1.0 - pxfm::f_exp(-power_from_db(3.0 - 10.0));
    assert_probability(lost_fraction(settings(RAYLEIGH), 0, 10.0, COUNT), outage, COUNT);
}

#[test]
fn fading_changes_no_mean() {
    const COUNT: u32 = 40_000;
    for (kind, k) in [(FadingKind::Rayleigh, 0.0), (FadingKind::Rician { k_db: 6.0 }, power_from_db(6.0))] {
        let gain = Gain::new(Fading { kind, per: FadingPer::Packet });
        let mut draws = Draws::new(3, Purpose::Reception, AuvId(0), Noise::Adversarial);
        let gains: Vec<f64> = (0..COUNT).map(|_| gain.draw(&mut draws)).collect();
        let mean = gains.iter().sum::<f64>() / f64::from(COUNT);
        let variance = gains.iter().map(|gain| (gain - 1.0) * (gain - 1.0)).sum::<f64>() / f64::from(COUNT);
        // Of the noncentral chi-squared distribution with two degrees of freedom and mean one.
        let expected = (1.0 + 2.0 * k) / ((1.0 + k) * (1.0 + k));
        assert!((mean - 1.0).abs() < 4.0 * (expected / f64::from(COUNT)).sqrt(), "{kind:?}: {mean}");
        assert!((variance / expected - 1.0).abs() < 0.1, "{kind:?}: {variance} {expected}");
        assert!(gains.iter().all(|&drawn| drawn <= gain.greatest()));
    }
}

#[test]
fn each_bit_fails_with_the_interference_of_its_time() {
    let settings = settings(GAUSSIAN);
    let noise = power_from_db(NOISE_DB);
    let decoder = Decoder::new(&settings.physical, settings.fading, noise);
    let arrival = packet(1, 0, 7.0);
    let power = power_from_db(arrival.level_db);
    let rate = |sinr| bit_error_rate(modulation::Modulation::Bpsk, modulation::Fading::None, sinr);
    let stretch = |ms, interference| Stretch { since: SimTime::from_ns(ms * MS), interference };
    // 200 bits in 200 ms after a preamble of 50 ms: 100 bits each.
    let stretches = [stretch(0, 0.0), stretch(20, 9.0 * noise), stretch(30, 0.0), stretch(150, noise)];
    let expected = (1.0 - packet_error_rate(rate(power / noise), 100))
        * (1.0 - packet_error_rate(rate(power / (2.0 * noise)), 100));
    let success = decoder.success(&arrival, 200, power, &stretches);
    assert!((success / expected - 1.0).abs() < 1e-12, "{success} {expected}");
    assert_eq!(decoder.success(&arrival, 200, 1e9 * power, &stretches), 1.0);
}

#[test]
fn no_luck_lifts_a_packet_that_is_fainter_than_noticeable() {
    assert!((settings(GAUSSIAN).noticeable_db() - (NOISE_DB + 3.0)).abs() < 2e-6);
    // The luckiest draw is 53 bits of ones: -ln 2^-53 = 36.74, which is 15.65 dB.
    assert!((settings(RAYLEIGH).noticeable_db() - (NOISE_DB + 3.0 - 15.651)).abs() < 1e-3);
    let nearly_steady = Fading { kind: FadingKind::Rician { k_db: 60.0 }, per: FadingPer::Packet };
    assert!((settings(nearly_steady).noticeable_db() - (NOISE_DB + 3.0)).abs() < 0.1);
}

/// Packets, all with their copies.
fn packets() -> impl Strategy<Value = Vec<Arrival>> {
    let ms = |range: std::ops::Range<i64>| range.prop_map(|tenths| tenths * MS / 10);
    let one = (
        (1..6_u32, ms(0..20_000), 1..4_u8, -10.0..50.0_f64),
        (ms(500..4_000), 0..20_u8, proptest::array::uniform3((ms(0..500), -6.0..6.0_f64))),
    );
    proptest::collection::vec(one, 1..24).prop_map(|packets| {
        let mut arrivals = Vec::new();
        for (index, ((from, start_ns, copies, snr_db), (length_ns, odd, echoes))) in
            packets.iter().enumerate()
        {
            for (path, (delay_ns, gain_db)) in
                [SoundPath::Direct, SURFACE, BOTTOM].into_iter().zip(echoes).take(usize::from(*copies))
            {
                let start = SimTime::from_ns(start_ns + delay_ns);
                let kind = match odd {
                    0 => ArrivalKind::Interference,
                    _ => ArrivalKind::Packet {
                        copies: *copies,
                        bits: 200,
                        asleep: *odd == 1,
                        known: *odd != 2,
                    },
                };
                arrivals.push(Arrival {
                    from: AuvId(*from),
                    sequence: index as u32,
                    path,
                    start,
                    end: start + *length_ns,
                    level_db: NOISE_DB + snr_db + gain_db,
                    doppler: 1.0,
                    flight: arrivals.len() as u32,
                    kind,
                });
            }
        }
        arrivals
    })
}

fn emissions() -> impl Strategy<Value = Vec<(SimTime, SimTime)>> {
    let one = (0..2_000_i64, 1..60_i64);
    let at = |ms| SimTime::from_ns(ms * MS);
    proptest::collection::vec(one.prop_map(move |(start, length)| (at(start), at(start + length))), 0..4)
}

fn fadings() -> impl Strategy<Value = Fading> {
    let kinds = [FadingKind::Gaussian, FadingKind::Rayleigh, FadingKind::Rician { k_db: 6.0 }];
    (proptest::sample::select(kinds.to_vec()), proptest::bool::ANY)
        .prop_map(|(kind, bit)| Fading { kind, per: if bit { FadingPer::Bit } else { FadingPer::Packet } })
}

/// Moments at which every run settles, whatever its windows.
const BORDER_MS: i64 = 450;
const END_MS: i64 = 6 * BORDER_MS;

/// Settles at each of `cuts_ms`, telling only what must be known by then; also what carrier sense says at the borders.
fn run(
    fading: Fading,
    arrivals: &[Arrival],
    emissions: &[(SimTime, SimTime)],
    cuts_ms: &[i64],
) -> (Vec<Outcome>, Vec<bool>) {
    let mut ear = ear(settings(fading));
    let (mut outcomes, mut busy) = (Vec::new(), Vec::new());
    let mut told = SimTime::from_ns(i64::MIN);
    for &cut_ms in cuts_ms {
        let until = SimTime::from_ns(cut_ms * MS);
        let is_due = |start: SimTime| told <= start && start < until;
        arrivals.iter().filter(|arrival| is_due(arrival.start)).for_each(|&arrival| ear.expect(arrival));
        emissions.iter().filter(|emission| is_due(emission.0)).for_each(|&(start, end)| ear.emit(start, end));
        ear.settle(until, &mut outcomes);
        told = until;
        if cut_ms % BORDER_MS == 0 {
            busy.push(ear.busy(SimTime::from_ns((cut_ms - 20) * MS), until));
        }
    }
    (outcomes, busy)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn neither_windows_nor_the_order_of_telling_matter(
        arrivals in packets(),
        emissions in emissions(),
        fading in fadings(),
        shuffled in Just(()).prop_perturb(|_, mut rng| rng.next_u64()),
        random_ms in proptest::collection::btree_set(1..END_MS, 0..40),
    ) {
        let borders: Vec<i64> = (0..=END_MS).step_by(BORDER_MS as usize).collect();
        let whole = run(fading, &arrivals, &emissions, &borders);
        let mut reordered = arrivals.clone();
        let mixed = |arrival: &Arrival| u64::from(arrival.flight).wrapping_add(shuffled).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        reordered.sort_by_key(mixed);
        for window_ms in [10, 25, 50, 90] {
            let cuts: Vec<i64> = (0..=END_MS).step_by(window_ms).collect();
            prop_assert_eq!(&run(fading, &reordered, &emissions, &cuts), &whole);
        }
        let mut cuts: Vec<i64> = random_ms.into_iter().chain(borders).collect();
        cuts.sort_unstable();
        cuts.dedup();
        prop_assert_eq!(&run(fading, &reordered, &emissions, &cuts), &whole);
    }

    #[test]
    fn every_packet_has_one_outcome_whose_numbers_hold(
        arrivals in packets(),
        emissions in emissions(),
    ) {
        // Without fading, all can be said from the list of arrivals.
        let (outcomes, _) = run(GAUSSIAN, &arrivals, &emissions, &[END_MS]);
        let id = |arrival: &Arrival| (arrival.from, arrival.sequence);
        let is_packet = |arrival: &&Arrival| matches!(arrival.kind, ArrivalKind::Packet { .. });
        let mut expected: Vec<_> = arrivals.iter().filter(is_packet).map(id).collect();
        expected.sort_unstable();
        expected.dedup();
        let mut got: Vec<_> = outcomes.iter().map(|outcome| id(&outcome.arrival)).collect();
        got.sort_unstable();
        prop_assert_eq!(got, expected);
        prop_assert!(outcomes.is_sorted_by_key(|outcome| outcome.at));

        for Outcome { arrival, at, reception, verdict } in &outcomes {
            let overlap_ns = |other: &Arrival| (other.end.min(arrival.end) - other.start.max(arrival.start)).max(0) as f64;
            let others = || arrivals.iter().filter(|other| id(other) != id(arrival));
            let energy: f64 = others().map(|other| power_from_db(other.level_db) * overlap_ns(other)).sum();
            let noise = power_from_db(NOISE_DB) + energy / (arrival.end - arrival.start) as f64;
            prop_assert_eq!(reception.level_db, arrival.level_db);
            prop_assert!((reception.sinr_db - (arrival.level_db - db_from_power(noise))).abs() < 1e-9);
            let copies = arrivals.iter().filter(|copy| id(copy) == id(arrival));
            let deaf = |copy: &Arrival| emissions.iter().any(|&(start, end)| start < copy.end && end > copy.start);
            match verdict {
                Verdict::Heard => {
                    prop_assert_eq!(*at, arrival.end);
                    prop_assert!(!deaf(arrival));
                    prop_assert!(arrival.level_db - NOISE_DB >= 3.0);
                }
                Verdict::Lost { reason, colliding } => {
                    prop_assert_eq!(Some(*at), copies.map(|copy| copy.end).max());
                    prop_assert_eq!(*reason == LossReason::Collision, !colliding.is_empty());
                    prop_assert!(*reason != LossReason::HalfDuplex || deaf(arrival));
                    prop_assert!(colliding.is_sorted_by(|a, b| a < b));
                    for auv in colliding {
                        prop_assert!(others().any(|other| other.from == *auv && overlap_ns(other) > 0.0));
                    }
                }
            }
        }
    }

    #[test]
    fn interference_only_takes(
        snr_db in 3.0..20.0_f64,
        fading in fadings(),
        disturbing in packets(),
        seed in 0..1_000_u64,
    ) {
        let energy = |arrival: &Arrival| Arrival { kind: ArrivalKind::Interference, ..*arrival };
        let is_heard = |count: usize| {
            let draws = Draws::new(seed, Purpose::Reception, AuvId(0), Noise::Uniform);
            let mut ear = Ear::new(settings(fading), draws);
            ear.expect(packet(99, 500, snr_db));
            disturbing.iter().take(count).for_each(|arrival| ear.expect(energy(arrival)));
            settle(&mut ear)[0].verdict == Verdict::Heard
        };
        let heard: Vec<bool> = (0..=disturbing.len()).map(is_heard).collect();
        prop_assert!(heard.is_sorted_by(|less, more| less >= more), "{heard:?}");
    }
}
