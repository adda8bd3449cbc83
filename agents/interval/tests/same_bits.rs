//! Every operation gives the same bits on every machine: with and without fused multiply-add, whatever the processor.
//!
//! The digests below were made on x86-64 with and without FMA. One that differs is either a new way to compute an operation,
//! and then a new digest is in order, or a machine on which a run of Shoal would have another digest than elsewhere.

use shoal_interval::Interval;

/// How many operands each operation is given.
const OPERANDS: u64 = 20_000;

type Operation = (&'static str, u64, fn(Interval, Interval) -> Interval);

const OPERATIONS: &[Operation] = &[
    ("add", 0, |x, y| x + y),
    ("mul", 0, |x, y| x * y),
    ("div", 0, |x, y| x / y),
    ("mul_add", 0, |x, y| x.mul_add(y, x)),
    ("sqrt", 0, |x, _| x.sqrt()),
    ("powi", 0, |x, _| x.powi(5) | x.powi(-3)),
    ("powf", 0, |x, y| x.abs().powf(y)),
    ("exp", 0, |x, _| x.exp()),
    ("ln", 0, |x, _| x.abs().ln()),
    ("sin", 0, |x, _| x.sin()),
    ("cos", 0, |x, _| x.cos()),
    ("tan", 0, |x, _| x.tan()),
    ("asin", 0, |x, _| x.asin()),
    ("acos", 0, |x, _| x.acos()),
    ("atan", 0, |x, _| x.atan()),
    ("atan2", 0, |x, y| y.atan2(x)),
    ("wrap_angle", 0, |x, _| x.wrap_angle()),
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
