//! The IEEE 1788 test suite ITF1788: every check of bare intervals whose operation the crate offers.
//!
//! `vectors` holds the checks as plain text, one a line: `operation operands = expected`. Results that IEEE 1788 can ask to be
//! the tightest must be exactly that; the others must hold the tightest interval and may be one unit in the last place wider
//! on each side.

mod operation;
mod value;

use operation::{NOT_OFFERED, Tightness, evaluate};
use std::collections::BTreeMap;
use value::{Value, parse_all};

/// The files with the number of checks that run and of those whose operation is not offered, so that a reader that skips
/// lines does not pass.
const FILES: [(&str, &str, usize, usize); 16] = [
    ("abs_rev", include_str!("vectors/abs_rev.txt"), 24, 0),
    ("atan2", include_str!("vectors/atan2.txt"), 38, 0),
    ("ieee1788-constructors", include_str!("vectors/ieee1788-constructors.txt"), 22, 0),
    ("ieee1788-exceptions", include_str!("vectors/ieee1788-exceptions.txt"), 3, 0),
    ("libieeep1788_bool", include_str!("vectors/libieeep1788_bool.txt"), 171, 0),
    ("libieeep1788_cancel", include_str!("vectors/libieeep1788_cancel.txt"), 121, 0),
    ("libieeep1788_class", include_str!("vectors/libieeep1788_class.txt"), 76, 0),
    ("libieeep1788_elem", include_str!("vectors/libieeep1788_elem.txt"), 3177, 146),
    ("libieeep1788_mul_rev", include_str!("vectors/libieeep1788_mul_rev.txt"), 172, 0),
    ("libieeep1788_num", include_str!("vectors/libieeep1788_num.txt"), 89, 0),
    ("libieeep1788_overlap", include_str!("vectors/libieeep1788_overlap.txt"), 48, 0),
    ("libieeep1788_rec_bool", include_str!("vectors/libieeep1788_rec_bool.txt"), 62, 0),
    ("libieeep1788_reduction", include_str!("vectors/libieeep1788_reduction.txt"), 0, 15),
    ("libieeep1788_rev", include_str!("vectors/libieeep1788_rev.txt"), 462, 10),
    ("libieeep1788_set", include_str!("vectors/libieeep1788_set.txt"), 10, 0),
    ("pow_rev", include_str!("vectors/pow_rev.txt"), 804, 0),
];

/// Checks whose expected interval is wider than the tightest one, with the tightest one. Root and angles are some units in the
/// last place off; of the last two, a base in `[0.25, 1]` has powers of two and more for exponents up to -1/2 only.
const CORRECTED: [(&str, &str); 6] = [
    ("pownRev [0X0P+0,0X0.0000000000001P-1022] -7", "[0x1.588cea3f093bdp+153,infinity]"),
    ("pownRev [-0X0.0000000000001P-1022,-0X0P+0] -7", "[-infinity,-0x1.588cea3f093bdp+153]"),
    (
        "tanRevBin [0X1.D02967C31CDB4P+53,0X1.D02967C31CDB5P+53] [-1.5708,1.5708]",
        "[-0x1.921fb54442d19p+0,0x1.921fb54442d19p+0]",
    ),
    (
        "tanRevBin [0X1.72CECE675D1FCP-52,0X1.72CECE675D1FDP-52] [-3.15,3.15]",
        "[-0x1.921fb54442d18p+1,0x1.921fb54442d1ap+1]",
    ),
    ("powRev2 [0.25,0.5] [2.0,infinity] [entire]", "[-infinity,-0.5]"),
    ("powRev2 [0.25,1.0] [2.0,infinity] [entire]", "[-infinity,-0.5]"),
];

/// A text that the standard lets a reader doubt: whether its bounds are in order is not decided in `f64`. The interval is asked
/// for all the same, and the crate, which decides exactly, has no such signal.
const DOUBT: &str = " signal PossiblyUndefinedOperation";

#[test]
fn every_check_whose_operation_is_offered_passes() {
    let mut failures = Vec::new();
    let mut miscounted = Vec::new();
    let mut not_offered: BTreeMap<&str, usize> = BTreeMap::new();
    let mut total = 0;
    for (name, text, expected_run, expected_left) in FILES {
        let (mut run, mut left) = (0, 0);
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            let check = Check::read(line);
            match evaluate(check.operation, &check.operands) {
                Some((result, tightness)) => {
                    run += 1;
                    if !tightness.accepts(&result, &check.expected) {
                        failures.push(format!("{name}: {line}\n    gives {result:?}"));
                    }
                }
                None => {
                    left += 1;
                    *not_offered.entry(check.operation).or_default() += 1;
                }
            }
        }
        println!("{name}: {run} checks ran, {left} are of operations that are not offered");
        if (run, left) != (expected_run, expected_left) {
            miscounted.push(format!("{name}: {run} and {left}, not {expected_run} and {expected_left}"));
        }
        total += run;
    }
    println!("in all: {total} checks ran, {} failed", failures.len());
    println!("not offered: {not_offered:?}");
    assert!(failures.is_empty(), "{} checks failed:\n{}", failures.len(), failures.join("\n"));
    assert!(miscounted.is_empty(), "other numbers of checks than known:\n{}", miscounted.join("\n"));
    assert_eq!(total, 5279);
    assert!(not_offered.keys().eq(NOT_OFFERED.iter()), "the list of what is not offered is wrong");
}

/// One line of a file: `operation operands = expected`.
struct Check<'a> {
    operation: &'a str,
    operands: Vec<Value>,
    expected: Vec<Value>,
}

impl<'a> Check<'a> {
    fn read(line: &'a str) -> Check<'a> {
        let (left, expected) = line.rsplit_once(" = ").expect("an equals sign");
        let corrected = CORRECTED.iter().find(|(check, _)| *check == left);
        let expected = corrected.map_or(expected, |(_, tightest)| tightest);
        let expected = expected.strip_suffix(DOUBT).unwrap_or(expected);
        let (operation, operands) = left.split_once(' ').expect("an operand");
        Check { operation, operands: parse_all(operands), expected: parse_all(expected) }
    }
}

#[test]
fn a_wrong_expectation_is_noticed() {
    for line in [
        "add [1.0,2.0] [1.0,2.0] = [2.0,0x1.0000000000001p2]",
        "sin [0.0,1.0] = [0.0,1.0]",
        "sin [0.0,1.0] = [0.0,0.5]",
        "subset [1.0,2.0] [1.0,2.0] = false",
        "mid [1.0,2.0] = 1.25",
        "add [1.0,2.0] [1.0,2.0] = [empty]",
    ] {
        let check = Check::read(line);
        let (result, tightness) =
            evaluate(check.operation, &check.operands).expect("an operation that is offered");
        assert!(!tightness.accepts(&result, &check.expected), "{line} gives {result:?}");
    }
    assert_eq!(Tightness::Exact, Tightness::of("add"));
}
