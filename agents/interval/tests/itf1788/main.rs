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
    ("libieeep1788_bool", include_str!("vectors/libieeep1788_bool.txt"), 0, 0),
    ("libieeep1788_cancel", include_str!("vectors/libieeep1788_cancel.txt"), 0, 0),
    ("libieeep1788_class", include_str!("vectors/libieeep1788_class.txt"), 0, 0),
    ("libieeep1788_elem", include_str!("vectors/libieeep1788_elem.txt"), 0, 0),
    ("libieeep1788_mul_rev", include_str!("vectors/libieeep1788_mul_rev.txt"), 0, 0),
    ("libieeep1788_num", include_str!("vectors/libieeep1788_num.txt"), 0, 0),
    ("libieeep1788_overlap", include_str!("vectors/libieeep1788_overlap.txt"), 0, 0),
    ("libieeep1788_rec_bool", include_str!("vectors/libieeep1788_rec_bool.txt"), 0, 0),
    ("libieeep1788_reduction", include_str!("vectors/libieeep1788_reduction.txt"), 0, 0),
    ("libieeep1788_rev", include_str!("vectors/libieeep1788_rev.txt"), 0, 0),
    ("libieeep1788_set", include_str!("vectors/libieeep1788_set.txt"), 0, 0),
    ("pow_rev", include_str!("vectors/pow_rev.txt"), 0, 0),
];

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
        println!("{name}: {run} checks passed or failed, {left} not offered");
        if (run, left) != (expected_run, expected_left) {
            miscounted.push(format!("{name}: {run} and {left}, not {expected_run} and {expected_left}"));
        }
        total += run;
    }
    println!("in all: {total} checks, {} failed", failures.len());
    println!("not offered: {not_offered:?}");
    assert!(failures.is_empty(), "{} checks failed:\n{}", failures.len(), failures.join("\n"));
    assert!(miscounted.is_empty(), "other numbers of checks than known:\n{}", miscounted.join("\n"));
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
