//! A million arguments a function against `core-math`, whose results are the nearest `f64` to the exact ones.

use crate::interval::Interval;
use crate::strategies::angles::{BITS, fixed, hardest, sine_and_cosine};
use crate::strategies::{SplitMix64, UNIT_SHIFT, exact};
use num_bigint::BigInt;

const ARGUMENTS: usize = 1_000_000;

/// The exact result is within half a step of `nearest`, and not past `least` and `most`, which are what can be reached.
/// The tightest interval then has `nearest` as a bound, so one step more on each side is at most one too many.
fn check(result: Interval, nearest: f64, (least, most): (f64, f64), arguments: &[f64]) {
    let (lower, upper) = (result.lower(), result.upper());
    let holds = (lower < nearest || nearest == least) && (nearest < upper || nearest == most);
    let tight = lower >= nearest.next_down() && upper <= nearest.next_up();
    assert!(holds && tight, "at {arguments:?}: [{lower:e}, {upper:e}] around {nearest:e}");
}

/// As [`check`], for bounds that may be the tightest: then one of them is the nearest number. On which side of it the exact
/// result is, exact arithmetic tells elsewhere.
fn check_tightest(result: Interval, nearest: f64, arguments: &[f64]) {
    let (lower, upper) = (result.lower(), result.upper());
    let holds = lower <= nearest && nearest <= upper;
    let tight = upper <= lower.next_up().next_up();
    assert!(holds && tight, "at {arguments:?}: [{lower:e}, {upper:e}] beside {nearest:e}");
}

/// Checks a function of one variable, on points and where it is defined. `exact` tells what is known exactly.
fn check_million(
    seed: u64,
    argument: impl Fn(&mut SplitMix64) -> f64,
    function: impl Fn(Interval) -> Interval,
    reference: impl Fn(f64) -> f64,
    reach: (f64, f64),
    exact: impl Fn(f64) -> Option<f64>,
) {
    let mut random = SplitMix64(seed);
    for _ in 0..ARGUMENTS {
        let x = argument(&mut random);
        let result = function(Interval::point(x).unwrap());
        let nearest = reference(x);
        if nearest.is_nan() || nearest.is_infinite() && x == 0.0 {
            assert!(result.is_empty(), "at {x:e}: {result} where nothing is defined");
        } else if let Some(value) = exact(x) {
            assert_eq!((result.lower(), result.upper()), (value, value), "at {x:e}");
        } else {
            check(result, nearest, reach, &[x]);
        }
    }
}

fn only(at: f64, value: f64) -> impl Fn(f64) -> Option<f64> {
    move |x| (x == at).then_some(value)
}

/// The reach of a function that nothing limits.
const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// Half of the arguments are near multiples of pi/2.
fn angle(random: &mut SplitMix64) -> f64 {
    let x = random.number();
    if x.to_bits() & 1 == 0 { random.near_a_quarter_turn() } else { x }
}

#[test]
fn exponentials() {
    let near_the_ends = |random: &mut SplitMix64| match random.next() % 4 {
        0 => random.between(-708.0, -700.0),
        1 => random.between(709.0, 710.0),
        2 => random.between(-1e4, -747.0),
        _ => Some(random.number()).filter(|x| !(-746.0..-708.0).contains(x)).unwrap_or(0.0),
    };
    let reach = (0.0, f64::INFINITY);
    check_million(1, near_the_ends, Interval::exp, core_math::exp, reach, only(0.0, 1.0));
}

/// Where `pxfm` 0.1.30 gives 4.9e-309 for 6.8e-309, among others.
#[test]
fn subnormal_exponentials() {
    let mut random = SplitMix64(12);
    for _ in 0..ARGUMENTS {
        let x = random.between(-746.0, -707.9);
        check_tightest(Interval::point(x).unwrap().exp(), core_math::exp(x), &[x]);
    }
}

#[test]
fn logarithms() {
    let near_one = |random: &mut SplitMix64| match random.next() % 4 {
        0 => 1.0 + random.between(-1e-9, 1e-9),
        _ => random.number(),
    };
    check_million(2, near_one, Interval::ln, core_math::log, ANY, only(1.0, 0.0));
}

#[test]
fn sines() {
    check_million(3, angle, Interval::sin, core_math::sin, (-1.0, 1.0), only(0.0, 0.0));
    check_million(3, angle, |x| x.sin_cos().0, core_math::sin, (-1.0, 1.0), only(0.0, 0.0));
}

#[test]
fn cosines() {
    check_million(4, angle, Interval::cos, core_math::cos, (-1.0, 1.0), only(0.0, 1.0));
    check_million(4, angle, |x| x.sin_cos().1, core_math::cos, (-1.0, 1.0), only(0.0, 1.0));
}

/// `pxfm` is off by a little more than half a unit now and then: exact arithmetic decides these.
#[test]
fn tangents() {
    let mut random = SplitMix64(5);
    let mut decided = 0;
    for _ in 0..ARGUMENTS {
        let x = angle(&mut random);
        let result = Interval::point(x).unwrap().tan();
        if x == 0.0 {
            assert_eq!(result, Interval::ZERO);
        } else {
            decided += usize::from(check_tangent(x, result));
        }
    }
    assert!(decided < ARGUMENTS / 10_000);
}

/// Whether exact arithmetic had to decide.
fn check_tangent(x: f64, tangent: Interval) -> bool {
    let nearest = core_math::tan(x);
    if tangent.lower() < nearest && nearest < tangent.upper() {
        check(tangent, nearest, ANY, &[x]);
        return false;
    }
    check_tangent_exactly(x, tangent);
    true
}

fn check_tangent_exactly(x: f64, tangent: Interval) {
    let (sine, cosine) = sine_and_cosine(x);
    let (sine, cosine) = if cosine < BigInt::ZERO { (-sine, -cosine) } else { (sine, cosine) };
    let is_below = |bound: f64| fixed(bound) * &cosine < (&sine << BITS);
    let (lower, upper) = (tangent.lower(), tangent.upper());
    assert!(is_below(lower) && !is_below(upper), "tan {x:e} is not in [{lower:e}, {upper:e}]");
    assert!(!is_below(lower.next_up().next_up()) && is_below(upper.next_down().next_down()), "tan {x:e}");
}

#[test]
fn the_hardest_angles() {
    let angles = hardest();
    assert!(
        angles.contains(&(6_381_956_970_095_103.0 * f64::from_bits((1023 + 797) << 52))),
        "the worst of all"
    );
    for x in angles {
        let angle = Interval::point(x).unwrap();
        check(angle.sin(), core_math::sin(x), (-1.0, 1.0), &[x]);
        check(angle.cos(), core_math::cos(x), (-1.0, 1.0), &[x]);
        check_tangent(x, angle.tan());
    }
}

#[test]
fn inverse_sines() {
    check_million(6, near_sines, Interval::asin, core_math::asin, ANY, only(0.0, 0.0));
}

#[test]
fn inverse_cosines() {
    check_million(7, near_sines, Interval::acos, core_math::acos, ANY, only(1.0, 0.0));
}

/// Numbers close to 1 among others.
fn near_sines(random: &mut SplitMix64) -> f64 {
    match random.next() % 4 {
        0 => random.between(-1.0, 1.0),
        1 => 1.0 - random.any_size().abs().min(0.5),
        _ => random.number(),
    }
}

#[test]
fn inverse_tangents() {
    check_million(8, SplitMix64::number, Interval::atan, core_math::atan, ANY, only(0.0, 0.0));
}

#[test]
fn angles_of_points() {
    let mut random = SplitMix64(9);
    for _ in 0..ARGUMENTS {
        let (y, x) = (random.number(), random.number());
        let y = if random.next().is_multiple_of(2) { y } else { x * random.between(-3.0, 3.0) };
        if x == 0.0 || y == 0.0 || !y.is_finite() {
            continue;
        }
        let result = Interval::point(y).unwrap().atan2(Interval::point(x).unwrap());
        let least = if y > 0.0 { 0.0 } else { f64::NEG_INFINITY };
        let most = if y < 0.0 { -0.0 } else { f64::INFINITY };
        let nearest = core_math::atan2(y, x);
        if nearest.is_subnormal() {
            // The angle is below the quotient by far less than anything that matters here.
            let (numerator, denominator) = (exact(y.abs()) << UNIT_SHIFT, exact(x));
            let size = if y > 0.0 { result } else { -result };
            let is_below = |bound: f64| exact(bound) * &denominator < numerator;
            let (lower, upper) = (size.lower(), size.upper());
            assert!(is_below(lower) && !is_below(lower.next_up().next_up()), "{y:e} {x:e}");
            assert!(!is_below(upper) && is_below(upper.next_down().next_down()), "{y:e} {x:e}");
            continue;
        }
        check(result, nearest, (least, most), &[y, x]);
    }
}

#[test]
fn real_powers() {
    let mut random = SplitMix64(10);
    for _ in 0..ARGUMENTS {
        let x = random.number().abs();
        let y = match random.next() % 4 {
            0 => random.between(-3.0, 3.0),
            1 => random.between(-40.0, 40.0).round() / 4.0,
            2 => random.between(-750.0, 750.0) / core_math::log(x),
            3 if x > 1.0 => random.between(-746.0, -700.0) / core_math::log(x),
            _ => random.number(),
        };
        if x == 0.0 || !y.is_finite() {
            continue;
        }
        let result = Interval::point(x).unwrap().powf(Interval::point(y).unwrap());
        let nearest = core_math::pow(x, y);
        if y.fract() == 0.0 && y.abs() < 2.0e9 || y.abs() == 0.5 {
            check_tightest(result, nearest, &[x, y]);
        } else if x == 1.0 {
            assert_eq!(result, Interval::ONE);
        } else {
            check(result, nearest, (0.0, f64::INFINITY), &[x, y]);
        }
    }
}

#[test]
fn whole_powers() {
    let mut random = SplitMix64(11);
    for _ in 0..ARGUMENTS {
        let x = random.number();
        let n = match random.next() % 4 {
            0 => random.between(-750.0, 750.0) / core_math::log(x.abs()),
            1 => random.between(-2.2e9, 2.2e9),
            _ => random.between(-12.0, 12.0),
        };
        let n = n as i32;
        if x == 0.0 {
            continue;
        }
        let result = Interval::point(x).unwrap().powi(n);
        let nearest = core_math::pow(x, f64::from(n));
        check_tightest(result, nearest, &[x, f64::from(n)]);
    }
}
