//! Every operation gives the same bits on every machine: with and without fused multiply-add, whatever the processor.
//!
//! The digests below were made on x86-64 with and without FMA. One that differs is either a new way to compute an operation,
//! and then a new digest is in order, or a machine on which a run of Shoal would have another digest than elsewhere.

use shoal_interval::Interval;
use shoal_interval::contractor::contract_polar;

/// How many operands each operation is given.
const OPERANDS: u64 = 100_000;

type Operation = (&'static str, u64, fn(Interval, Interval) -> Interval);

const OPERATIONS: &[Operation] = &[
    ("add", 0x81f9_b06a_430d_dda8, |x, y| x + y),
    ("mul", 0x0221_47a2_be8e_0310, |x, y| x * y),
    ("div", 0x6337_e2cc_7410_7456, |x, y| x / y),
    ("mul_add", 0xeb2f_bb0e_2d4a_d8de, |x, y| x.mul_add(y, x)),
    ("sqrt", 0x6edf_f723_582c_2306, |x, _| x.sqrt()),
    ("powi", 0xc646_7278_a8ae_1b8a, |x, _| x.powi(5) | x.powi(-3)),
    ("powf", 0x1e6f_31ac_4252_e600, |x, y| x.abs().powf(y)),
    ("exp", 0x55a0_465f_70de_fa29, |x, _| x.exp()),
    ("ln", 0xee51_6365_4ae2_df9f, |x, _| x.abs().ln()),
    ("sin", 0xe8c3_601b_a931_db94, |x, _| x.sin()),
    ("cos", 0xf96b_8dcf_901c_14fa, |x, _| x.cos()),
    ("tan", 0xce3a_a48d_07d8_6d9c, |x, _| x.tan()),
    ("asin", 0x8e85_7329_4cc0_50ab, |x, _| x.asin()),
    ("acos", 0xaa0c_73e0_5408_8dfc, |x, _| x.acos()),
    ("atan", 0x4963_86ca_0764_00c7, |x, _| x.atan()),
    ("atan2", 0x0211_a5a1_4ac9_3742, |x, y| y.atan2(x)),
    ("wrap_angle", 0xeaa6_0d20_a382_9282, |x, _| x.wrap_angle()),
    ("mul_rev", 0x021f_b65e_415f_761e, |x, y| x.mul_rev(y, Interval::ENTIRE)),
    ("sin_rev", 0x8c4c_c22d_e388_1269, |x, y| x.sin_rev(y)),
    ("polar", 0x9f15_9923_b31f_0ab9, |x, y| {
        let (mut x, mut y) = (x, y);
        let (mut range, mut bearing) = (Interval::NON_NEGATIVE, Interval::ENTIRE);
        contract_polar(&mut x, &mut y, &mut range, &mut bearing);
        range + bearing
    }),
];

#[test]
fn every_operation_gives_the_same_bits() {
    let mut wrong = Vec::new();
    for &(name, digest, operation) in OPERATIONS {
        let mut random = SplitMix(1);
        let found = (0..OPERANDS).fold(0xcbf2_9ce4_8422_2325, |hash, _| {
            let result = operation(random.interval(), random.interval());
            // Zeros of either sign are the same bound.
            let hash = (hash ^ (result.lower() + 0.0).to_bits()).wrapping_mul(0x100_0000_01b3);
            (hash ^ (result.upper() + 0.0).to_bits()).wrapping_mul(0x100_0000_01b3).rotate_left(29)
        });
        if found != digest {
            wrong.push(format!("{name}: {found:#018x}"));
        }
    }
    assert!(wrong.is_empty(), "other bits than elsewhere:\n{}", wrong.join("\n"));
}

struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Half of them of everyday size, half anywhere among all numbers; some are points.
    fn interval(&mut self) -> Interval {
        let (kind, one, other) = (self.next(), self.next(), self.next());
        let everyday = |bits: u64| (bits as f64 / u64::MAX as f64 - 0.5) * 20.0;
        let any = |bits: u64| Some(f64::from_bits(bits)).filter(|x| x.is_finite()).unwrap_or(1.0);
        let (one, other) =
            if kind % 2 == 0 { (everyday(one), everyday(other)) } else { (any(one), any(other)) };
        Interval::spanning(one, if kind % 3 == 0 { one } else { other })
    }
}
