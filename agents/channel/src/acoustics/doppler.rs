//! How motion stretches and squeezes sound.

/// The factor by which both ends' motion along a ray raises the frequency of what is received.
///
/// A range rate is how fast one end's own motion lengthens the path, in m/s: positive when it moves away along the ray, that of the
/// emitter at the emission, that of the receiver at the reception, both slower than sound. In still water the two do
/// not act alike: (1 - receiver / c) / (1 + emitter / c).
///
/// ```
/// use shoal_channel::acoustics::doppler::doppler_factor;
///
/// // A receiver that closes in with 2 m/s hears 25 kHz as 25,033.3 Hz.
/// assert!((25e3 * doppler_factor(0.0, -2.0, 1500.0) - 25_033.333).abs() < 1e-3);
/// // Two that move the same way along the ray hear each other as if at rest.
/// assert_eq!(doppler_factor(-3.0, 3.0, 1500.0), 1.0);
/// ```
pub fn doppler_factor(
    emitter_range_rate_m_s: f64,
    receiver_range_rate_m_s: f64,
    sound_speed_m_s: f64,
) -> f64 {
    (sound_speed_m_s - receiver_range_rate_m_s) / (sound_speed_m_s + emitter_range_rate_m_s)
}

/// The frequency in Hz at which the receiver hears what was emitted at `emitted_hz`.
pub fn received_frequency_hz(emitted_hz: f64, doppler_factor: f64) -> f64 {
    emitted_hz * doppler_factor
}

/// For how many seconds the receiver hears what took `emitted_s` to emit: a higher pitch is over sooner.
pub fn received_duration_s(emitted_s: f64, doppler_factor: f64) -> f64 {
    emitted_s / doppler_factor
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::sound_speed::mackenzie;
    use super::*;

    /// Closing speed of the receiver, then what it hears of 50 kHz at 27 °C, 35 psu and 10 m by Mackenzie, and of 25 kHz at
    /// 1,500 m/s. From the project's table of acoustic reference values.
    #[test]
    fn a_moving_receiver_hears_the_reference_values() {
        for (closing_m_s, warm_hz, round_hz) in [
            (2.0, 50064.973601836005, 25033.333333333336),
            (-1.0, 49967.513199082, 24983.333333333332),
            (0.5, 50016.243400459, 25008.333333333332),
        ] {
            let factor = doppler_factor(0.0, -closing_m_s, mackenzie(27.0, 35.0, 10.0));
            let found = received_frequency_hz(50e3, factor);
            assert!((found - warm_hz).abs() < 6e-10, "{found} for {warm_hz}");
            let found = received_frequency_hz(25e3, doppler_factor(0.0, -closing_m_s, 1500.0));
            assert!((found - round_hz).abs() < 8e-12, "{found} for {round_hz}");
        }
    }

    proptest! {
        /// The end of a tone is emitted `duration` later, from where the emitter is then, and meets the receiver where that is
        /// then: the difference of the two receptions is the received duration.
        #[test]
        fn durations_follow_from_travel_times(
            emitter in -5.0..5.0_f64, receiver in -5.0..5.0_f64, c in 1400.0..1600.0_f64,
            duration in 0.01..5.0_f64, range in 1.0..5000.0_f64,
        ) {
            // On a line: |range| grows by `emitter` per second of emission and by `receiver` per second of reception.
            let first = range / (c - receiver);
            let last = (range + emitter * duration + c * duration) / (c - receiver);
            let found = received_duration_s(duration, doppler_factor(emitter, receiver, c));
            prop_assert!((found - (last - first)).abs() < 1e-12 * (1.0 + last));
        }
    }
}
