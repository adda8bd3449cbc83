//! Random gaps: exponentially distributed, from draws of the AUV's own.

use pxfm::f_log;

/// Gaps with the exponential distribution: those between the arrivals of a Poisson process.
#[derive(Clone, Debug)]
pub struct Gaps {
    mean_ns: f64,
    draws: SplitMix64,
}

impl Gaps {
    /// Gaps of `mean_ns` nanoseconds on average; the same `entropy` gives the same gaps.
    pub fn new(mean_ns: i64, entropy: u64) -> Self {
        Self { mean_ns: mean_ns.max(1) as f64, draws: SplitMix64(entropy) }
    }

    /// The next gap in nanoseconds: at least one, and below 37 means, because `-ln` of the least draw, 2⁻⁵³, is 36.7.
    pub fn next_ns(&mut self) -> i64 {
        // In (0, 1], so that the logarithm is finite.
        let unit = ((self.draws.next() >> 11) + 1) as f64 * (1.0 / (1u64 << 53) as f64);
        ((-f_log(unit) * self.mean_ns) as i64).max(1)
    }
}

/// The generator SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014, figure 14).
#[derive(Clone, Debug)]
struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_those_of_split_mix() {
        // The reference implementation's output for the seed 1234567 (Vigna, splitmix64.c).
        let mut draws = SplitMix64(1_234_567);
        let expected = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!([draws.next(), draws.next(), draws.next()], expected);
    }

    #[test]
    fn gaps_are_exponential() {
        let mean_ns = 5_000_000_000.0;
        let mut gaps = Gaps::new(mean_ns as i64, 7);
        let mut gaps_ns: Vec<f64> = (0..100_000).map(|_| gaps.next_ns() as f64).collect();
        gaps_ns.sort_by(f64::total_cmp);
        // The largest distance of the empirical distribution from 1 - exp(-x / mean) (Kolmogorov-Smirnov), which exceeds
        // 1.63 / sqrt(n) in one of a hundred sets of n draws.
        let count = gaps_ns.len() as f64;
        let distance = gaps_ns.iter().enumerate().fold(0.0_f64, |distance, (index, gap_ns)| {
            let expected = 1.0 - pxfm::f_exp(-gap_ns / mean_ns);
            distance.max((expected - index as f64 / count).abs())
        });
        assert!(distance < 1.63 / count.sqrt(), "{distance}");
    }

    #[test]
    fn a_gap_is_never_nothing() {
        let mut gaps = Gaps::new(0, 1);
        assert!((0..1_000).all(|_| gaps.next_ns() >= 1));
    }
}
