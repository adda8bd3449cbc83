use super::*;
use crate::interval_box::IntervalBox;
use crate::strategies::{UNIT_SHIFT, exact, number};
use num_bigint::BigInt;
use proptest::prelude::*;

fn between(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

fn read(text: &str) -> Interval {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The examples of IEEE 1788-2015, tables 9.4 and 12.1, clauses 9.7, 9.8, 10.5.1 and 12.11.
#[test]
fn literals_of_the_standard() {
    for (text, bounds) in [
        ("[1.2345]", "[0x1.3c083126e978dp+0, 0x1.3c083126e978ep+0]"),
        ("[1,+infinity]", "[0x1p0, inf]"),
        ("[1,1e3]", "[0x1p0, 0x3E8]"),
        ("[1.e-3, 1.1e-3]", "[0x4.189374bc6a7ecp-12, 0x4.816f0068db8bcp-12]"),
        ("[-0x1.3p-1, 2/3]", "[-0x9.8p-4, +0x0.aaaaaaaaaaaabp0]"),
        ("[3.56]", "[0x3.8f5c28f5c28f4p+0, 0x3.8f5c28f5c28f6p+0]"),
        ("3.56?1", "[0x3.8ccccccccccccp+0, 0x3.91eb851eb852p+0]"),
        ("3.56?1e2", "[0x163p0, 0x165p0]"),
        ("3.560?2", "[0x3.8ed916872b02p+0, 0x3.8fdf3b645a1ccp+0]"),
        ("3.56?", "[0x3.8e147ae147aep+0, 0x3.90a3d70a3d70cp+0]"),
        ("3.560?2u", "[0x3.8f5c28f5c28f4p+0, 0x3.8fdf3b645a1ccp+0]"),
        ("-10?", "[-0x15p-1, -0x13p-1]"),
        ("-10?u", "[-0xap0, -0x13p-1]"),
        ("-10?12", "[-0x16p0, 0x2p0]"),
        ("-10??u", "[-0xap0, inf]"),
        ("-10??", "[-inf, inf]"),
        ("[1.234e5,Inf]", "[0x1e208, inf]"),
        ("3.1416?1", "[0x3.24395810624dcp+0, 0x3.24467381d7dcp+0]"),
        ("[-Inf, 2/3]", "[-inf, 0xa.aaaaaaaaaaabp-4]"),
        ("[0x1.3p-1,]", "[0x1.3p-1, inf]"),
        ("2.500?5e+27", "[0x1.01fa19a08fe7fp+91, 0x1.0302cc4352683p+91]"),
        ("2.500?5ue4", "[0x1.86ap+14, 0x1.8768p+14]"),
        ("2.500?5de-5", "[0x1.a2976f1cee4d5p-16, 0x1.a36e2eb1c432dp-16]"),
        ("0.0?", "[-1/20, 1/20]"),
        ("0.0?u", "[0, 1/20]"),
        ("-0.000?5d", "[-5/1000, 0]"),
        ("2.5?", "[0x1.3999999999999p+1, 0x1.4666666666667p+1]"),
        ("2.500?5d", "[0x1.3f5c28f5c28f5p+1, 5/2]"),
        ("2.5??u", "[5/2, inf]"),
        ("2.5??d", "[-inf, 5/2]"),
        ("10?3e380", "[0x1.fffffffffffffp+1023, infinity]"),
        ("[1.0E+400 ]", "[0x1.fffffffffffffp+1023, infinity]"),
        ("1.0000000000000001?1", "[0x1p0, 0x1.0000000000001p+0]"),
        ("[ -4/2, 10/5 ]", "[-0x2, 0x2]"),
    ] {
        assert_eq!(read(text), read(bounds), "{text}");
    }
    for text in ["[]", "[ ]", "[empty]", "[ Empty  ]", "empty"] {
        assert_eq!(read(text), Interval::EMPTY, "{text}");
    }
    for text in ["[,]", "[ ENTIRE ]", "[ -inf , INF  ]", "0.0??", "entire", " [-Infinity,\t+inf]\n"] {
        assert_eq!(read(text), Interval::ENTIRE, "{text}");
    }
    assert_eq!(read("[1.0000000000000002,1.0000000000000001]"), between(1.0, 1.0_f64.next_up()));
    assert_eq!(read(&format!("10?18{}", "0".repeat(308))), Interval::ENTIRE);
}

#[test]
fn hexadecimals_are_what_rust_reads_in_decimals() {
    assert_eq!(read("[0x1.3c083126e978dp+0]"), Interval::point(1.2345).unwrap());
    assert_eq!(read("[-0x1.8, 0X.8P1]"), between(-1.5, 1.0));
    assert_eq!(read("[0x1p-1074, 0x1p1023]"), between(f64::from_bits(1), 2.0 * (f64::MAX / 4.0).next_up()));
    assert_eq!(read("0x1.00000000000008p0"), between(1.0, 1.0_f64.next_up()));
}

#[test]
fn what_is_no_interval_is_refused_where_it_goes_wrong() {
    for (text, message) in [
        ("", "expected an interval or a number at the end of the text"),
        ("[1.0,2.0", "expected `]` at the end of the text"),
        ("[ foo ]", "expected a number, found `f` at character 3"),
        ("[ Nai  ]", "expected a number, found `N` at character 3"),
        ("[-I  nf, 1.000 ]", "expected a number, found `I` at character 3"),
        ("[-Inf, 1.0  00 ]", "expected `]`, found `0` at character 13"),
        ("[1,2]_com", "expected the end of the text, found `_` at character 6"),
        ("[ Empty  ]_trv", "expected the end of the text, found `_` at character 11"),
        ("[1/0]", "the denominator that ends before character 5 is zero"),
        ("[1.5/2]", "expected `]`, found `/` at character 5"),
        ("[1/, 2]", "expected a digit, found `,` at character 4"),
        ("1e", "expected an exponent at the end of the text"),
        ("[.]", "expected a number, found `]` at character 3"),
        ("3.5?é", "expected the end of the text, found `é` at character 5"),
        ("[é]", "expected a number, found `é` at character 2"),
        ("0x", "expected a number at the end of the text"),
        ("[2, 1]", "the lower bound of an interval cannot be above its upper bound: [2.0, 1.0]"),
        ("[-Inf ]", "an interval must hold a real number, [-inf, -inf] holds none"),
        ("[Inf , INF]", "an interval must hold a real number, [inf, inf] holds none"),
        ("[+infinity]", "an interval must hold a real number, [inf, inf] holds none"),
        ("[inf, 1]", "the lower bound of an interval cannot be above its upper bound: [inf, 1.0]"),
        ("--1", "expected a number, found `-` at character 2"),
        ("[1.0?]", "expected `]`, found `?` at character 5"),
        ("inf", "expected an interval or a number, found `i` at character 1"),
    ] {
        let mistake = text.parse::<Interval>().expect_err(text);
        assert_eq!(mistake.to_string(), message, "{text}");
    }
    let long = "0".repeat(ParseIntervalError::LONGEST + 1);
    assert_eq!(long.parse::<Interval>(), Err(ParseIntervalError::TooLong { length: long.len() }));
}

#[test]
fn exponents_and_digits_beyond_all_measure() {
    let least = f64::from_bits(1);
    for exponent in ["400", "999999999", "99999999999999999999999999"] {
        assert_eq!(read(&format!("1e{exponent}")), between(f64::MAX, f64::INFINITY));
        assert_eq!(read(&format!("-1e-{exponent}")), between(-least, 0.0));
        assert_eq!(read(&format!("[0e{exponent}]")), Interval::ZERO);
        assert_eq!(read(&format!("1?2e{exponent}")), Interval::ENTIRE);
        assert_eq!(read(&format!("1?2e-{exponent}")), between(-least, least));
    }
    assert_eq!(read("[-0x1p99999999999, 0x1p-99999999999]"), between(f64::NEG_INFINITY, least));
    let zeros = "0".repeat(60_000);
    assert_eq!(read(&format!("1{zeros}e-60000")), Interval::ONE);
    assert_eq!(read(&format!("0.{zeros}1e60001")), Interval::ONE);
    assert_eq!(read(&format!("1.{zeros}1")), between(1.0, 1.0_f64.next_up()));
    assert_eq!(read(&format!("1{}/1{}", &zeros[..30_000], &zeros[..30_000])), Interval::ONE);
}

#[test]
fn bounds_are_written_outwards() {
    for (bounds, places, text) in [
        ((0.001, 0.001), 2, "[0.00, 0.01]"),
        ((-0.001, -0.001), 2, "[-0.01, 0.00]"),
        ((-0.0, 0.0), 2, "[0.00, 0.00]"),
        ((9.999, 9.999), 2, "[9.99, 10.00]"),
        ((0.5, 99.5), 0, "[0, 100]"),
        ((-1e-300, 1e-300), 1, "[-0.1, 0.1]"),
        ((0.25, f64::INFINITY), 4, "[0.2500, inf]"),
        ((-2.5, -1.5), 0, "[-3, -1]"),
        ((123.456, 123.456), 1, "[123.4, 123.5]"),
    ] {
        assert_eq!(format!("{:.places$}", between(bounds.0, bounds.1)), text);
    }
    for (x, text) in [
        (Interval::EMPTY, "empty"),
        (Interval::ENTIRE, "[-inf, inf]"),
        (between(-0.0, 1.5), "[0, 1.5]"),
        (between(0.3, 0.3), "[0.29999999999999998, 0.3]"),
        (between(-1e300, 1e-7), "[-1.0000000000000001e300, 1e-7]"),
        (between(100.0, 1e15), "[100, 1000000000000000]"),
        (between(f64::MIN, f64::from_bits(1)), "[-1.7976931348623158e308, 5e-324]"),
    ] {
        assert_eq!(x.to_string(), text);
    }
    assert_eq!(format!("{:.1200}", Interval::ONE).len(), "[1., 1.]".len() + 2 * 1200);
}

#[test]
fn boxes_pass_on_how_to_write() {
    let sides = IntervalBox::from([between(0.0, 0.126), Interval::ONE]);
    assert_eq!(format!("{sides:.2}"), "[0.00, 0.13] x [1.00, 1.00]");
    assert_eq!(format!("{:x}", IntervalBox::from([Interval::ONE])), "[0x1p0, 0x1p0]");
    assert_eq!(format!("{} {:x}", IntervalBox::<2>::EMPTY, IntervalBox::<2>::EMPTY), "empty empty");
}

/// Whether the written fraction, `numerator / denominator`, is where `bound` says it is; `bound` may be infinite.
fn compare(numerator: &BigInt, denominator: &BigInt, bound: f64) -> std::cmp::Ordering {
    if bound.is_infinite() {
        return 0.0_f64.partial_cmp(&bound).unwrap();
    }
    let value: BigInt = numerator << UNIT_SHIFT;
    value.cmp(&(exact(bound) * denominator))
}

fn is_tightest(x: Interval, numerator: &BigInt, denominator: &BigInt) -> bool {
    let to_lower = compare(numerator, denominator, x.lower());
    let to_upper = compare(numerator, denominator, x.upper());
    let neighbours = x.upper() == x.lower().next_up();
    if x.is_point() { to_lower.is_eq() } else { neighbours && to_lower.is_gt() && to_upper.is_lt() }
}

fn power_of_ten(exponent: i32) -> (BigInt, BigInt) {
    let power = BigInt::from(10).pow(exponent.unsigned_abs());
    if exponent < 0 { (1.into(), power) } else { (power, 1.into()) }
}

proptest! {
    #[test]
    fn decimals_are_enclosed_tightest(digits in any::<i128>(), fewer in 0..35_u32, exponent in -350..320_i32) {
        let digits = digits / 10_i128.pow(fewer);
        let (up, down) = power_of_ten(exponent);
        let x = read(&format!("{digits}e{exponent}"));
        prop_assert!(is_tightest(x, &(up * digits), &down), "{digits}e{exponent} {x:x}");
    }

    #[test]
    fn decimals_near_numbers_are_enclosed_tightest(x in number(), places in 0..40_usize) {
        let text = format!("{x:.places$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap();
        let digits: BigInt = mantissa.replace('.', "").parse().unwrap();
        let (up, down) = power_of_ten(exponent.parse::<i32>().unwrap() - places as i32);
        prop_assert!(is_tightest(read(&text), &(up * digits), &down), "{text}");
    }

    #[test]
    fn fractions_are_enclosed_tightest(numerator in any::<i128>(), denominator in 1..u128::MAX, fewer in 0..38_u32) {
        let denominator = denominator / 10_u128.pow(fewer) + 1;
        let x = read(&format!("[{numerator}/{denominator}]"));
        prop_assert!(is_tightest(x, &numerator.into(), &denominator.into()));
    }

    #[test]
    fn uncertain_numbers_are_enclosed_tightest(
        digits in -1_000_000..1_000_000_i64, radius in 0..2_000_000_i64, exponent in -330..310_i32,
    ) {
        let (up, down) = power_of_ten(exponent);
        let negative = if digits == 0 { "-" } else { "" };
        let x = read(&format!("{negative}{digits}?{radius}e{exponent}"));
        let bound = |digits: i64, bound: f64, other: f64| {
            let to_bound = compare(&(&up * digits), &down, bound);
            to_bound.is_eq() || to_bound != compare(&(&up * digits), &down, other) && bound != other
        };
        prop_assert!(bound(digits - radius, x.lower(), x.lower().next_up()));
        prop_assert!(bound(digits + radius, x.upper(), x.upper().next_down()));
    }

    #[test]
    fn hexadecimals_come_back_the_same(one in number(), other in number(), open in any::<bool>()) {
        let x = if open { between(one, f64::INFINITY) } else { Interval::spanning(one, other) };
        let (text, negative) = (format!("{x:x}"), format!("{:x}", -x).to_uppercase());
        prop_assert_eq!((read(&text), read(&negative)), (x, -x));
    }

    #[test]
    fn what_is_written_holds_what_was_meant(one in number(), other in number(), places in 0..330_usize) {
        let x = Interval::spanning(one, other);
        let written = read(&x.to_string());
        prop_assert!(x.is_subset_of(written));
        prop_assert!(written.lower() >= x.lower().next_down() && written.upper() <= x.upper().next_up());
        let rounded = read(&format!("{x:.places$}"));
        prop_assert!(x.is_subset_of(rounded));
    }

    /// The decimal in front of each written bound by one in the last place is on the inner side.
    #[test]
    fn a_precision_loses_less_than_one_in_the_last_place(value in -1.0e6..1.0e6_f64, places in 0..12_usize) {
        let text = format!("{:.places$}", Interval::point(value).unwrap());
        let scaled = |text: &str| text.replace('.', "").parse::<i64>().unwrap();
        let (lower, upper) = text[1..text.len() - 1].split_once(", ").unwrap();
        let power = BigInt::from(10).pow(places as u32);
        let at = |units: i64| compare(&units.into(), &power, value);
        prop_assert!(at(scaled(lower)).is_le() && at(scaled(lower) + 1).is_gt());
        prop_assert!(at(scaled(upper)).is_ge() && at(scaled(upper) - 1).is_lt());
    }

    #[test]
    fn no_text_makes_it_panic(text in r"[\[\]0-9a-fxpinu?,./+\- é]{0,12}") {
        if let Ok(x) = text.parse::<Interval>() {
            prop_assert!(x.is_empty() || x.lower() <= x.upper());
        }
    }
}
