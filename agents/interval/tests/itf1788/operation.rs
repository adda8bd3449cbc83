//! Which method of the crate answers to which operation of the standard, and how tight it must be.

use crate::value::Value;
use shoal_interval::Interval;

/// What the suite asks for and the crate does not have.
pub const NOT_OFFERED: [&str; 16] = [
    "acosh",
    "asinh",
    "atanh",
    "cosh",
    "coshRev",
    "coshRevBin",
    "dot_nearest",
    "exp10",
    "exp2",
    "log10",
    "log2",
    "sinh",
    "sum_abs_nearest",
    "sum_nearest",
    "sum_sqr_nearest",
    "tanh",
];

/// How far a result may be from the tightest one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tightness {
    /// The tightest interval, or the same number or word.
    Exact,
    /// An interval that holds the tightest one and is at most one unit in the last place wider on each side.
    OneUnit,
}

impl Tightness {
    pub fn of(operation: &str) -> Tightness {
        match operation {
            "acos" | "asin" | "atan" | "atan2" | "cos" | "cosRev" | "cosRevBin" | "exp" | "log" | "pow"
            | "powRev1" | "powRev2" | "pown" | "pownRev" | "pownRevBin" | "sin" | "sinRev" | "sinRevBin"
            | "tan" | "tanRev" | "tanRevBin" => Tightness::OneUnit,
            _ => Tightness::Exact,
        }
    }

    pub fn accepts(self, result: &[Value], expected: &[Value]) -> bool {
        result.len() == expected.len()
            && result.iter().zip(expected).all(|(one, other)| self.accepts_one(one, other))
    }

    fn accepts_one(self, result: &Value, expected: &Value) -> bool {
        match (result, expected) {
            (Value::Number(result), Value::Number(expected)) => {
                result == expected || result.is_nan() && expected.is_nan()
            }
            (Value::Interval(result), Value::Interval(expected)) if self != Tightness::Exact => {
                holds_closely(*result, *expected)
            }
            _ => result == expected,
        }
    }
}

fn holds_closely(result: Interval, expected: Interval) -> bool {
    if result.is_empty() || expected.is_empty() {
        return result == expected;
    }
    let widest = (expected.lower().next_down(), expected.upper().next_up());
    expected.is_subset_of(result) && result.lower() >= widest.0 && result.upper() <= widest.1
}

/// What the crate gives, or nothing when it does not offer the operation.
pub fn evaluate(operation: &str, operands: &[Value]) -> Option<(Vec<Value>, Tightness)> {
    let result = match operands {
        [Value::Interval(x)] => unary(operation, *x),
        [Value::Interval(x), Value::Interval(y)] => binary(operation, *x, *y),
        [Value::Interval(x), Value::Interval(y), Value::Interval(z)] => ternary(operation, *x, *y, *z),
        [Value::Interval(x), Value::Number(n)] => integer_power(operation, *x, Interval::ENTIRE, *n),
        [Value::Interval(x), Value::Interval(y), Value::Number(n)] => integer_power(operation, *x, *y, *n),
        [Value::Number(x), Value::Interval(y)] => (operation == "isMember").then(|| truth(y.contains(*x))),
        [Value::Number(x), Value::Number(y)] => {
            (operation == "b-numsToInterval").then(|| made(Interval::new(*x, *y).ok()))
        }
        [Value::Text(text)] => (operation == "b-textToInterval").then(|| made(text.parse().ok())),
        _ => None,
    }?;
    Some((result, Tightness::of(operation)))
}

fn set(x: Interval) -> Vec<Value> {
    vec![Value::Interval(x)]
}

fn number(x: f64) -> Vec<Value> {
    vec![Value::Number(x)]
}

fn truth(holds: bool) -> Vec<Value> {
    vec![Value::Word(holds.to_string())]
}

/// A constructor's result; where it fails, the standard asks for the empty set and a signal.
fn made(interval: Option<Interval>) -> Vec<Value> {
    match interval {
        Some(interval) => set(interval),
        None => [
            set(Interval::EMPTY),
            ["signal", "UndefinedOperation"].map(|word| Value::Word(word.to_owned())).into(),
        ]
        .concat(),
    }
}

fn unary(operation: &str, x: Interval) -> Option<Vec<Value>> {
    Some(match operation {
        "abs" => set(x.abs()),
        "absRev" => set(x.abs_rev(Interval::ENTIRE)),
        "acos" => set(x.acos()),
        "asin" => set(x.asin()),
        "atan" => set(x.atan()),
        "ceil" => set(x.ceil()),
        "cos" => set(x.cos()),
        "cosRev" => set(x.cos_rev(Interval::ENTIRE)),
        "exp" => set(x.exp()),
        "floor" => set(x.floor()),
        "inf" => number(x.lower()),
        "isCommonInterval" => truth(!x.is_empty() && x.is_bounded()),
        "isEmpty" => truth(x.is_empty()),
        "isEntire" => truth(x == Interval::ENTIRE),
        "isSingleton" => truth(x.is_point()),
        "log" => set(x.ln()),
        "mag" => number(x.magnitude()),
        "mid" => number(x.mid()),
        "midRad" => [number(x.mid()), number(x.radius())].concat(),
        "mig" => number(x.mignitude()),
        "neg" => set(-x),
        "pos" => set(x),
        "rad" => number(x.radius()),
        "recip" => set(x.recip()),
        "roundTiesToAway" => set(x.round_ties_away()),
        "roundTiesToEven" => set(x.round_ties_even()),
        "sign" => set(x.sign()),
        "sin" => set(x.sin()),
        "sinRev" => set(x.sin_rev(Interval::ENTIRE)),
        "sqr" => set(x.sqr()),
        "sqrRev" => set(x.sqr_rev(Interval::ENTIRE)),
        "sqrt" => set(x.sqrt()),
        "sup" => number(x.upper()),
        "tan" => set(x.tan()),
        "tanRev" => set(x.tan_rev(Interval::ENTIRE)),
        "trunc" => set(x.trunc()),
        "wid" => number(x.width()),
        _ => return None,
    })
}

fn binary(operation: &str, x: Interval, y: Interval) -> Option<Vec<Value>> {
    Some(match operation {
        "absRevBin" => set(x.abs_rev(y)),
        "add" => set(x + y),
        "atan2" => set(x.atan2(y)),
        "cancelMinus" => set(x.cancel_minus(y)),
        "cancelPlus" => set(x.cancel_plus(y)),
        "convexHull" => set(x.hull(y)),
        "cosRevBin" => set(x.cos_rev(y)),
        "disjoint" => truth(x.is_disjoint_from(y)),
        "div" => set(x / y),
        "equal" => truth(x == y),
        "interior" => truth(x.is_interior_of(y)),
        "intersection" => set(x.intersection(y)),
        "less" => truth(x.is_less_than(y)),
        "max" => set(x.max(y)),
        "min" => set(x.min(y)),
        "mul" => set(x * y),
        "mulRev" => set(x.mul_rev(y, Interval::ENTIRE)),
        "mulRevToPair" => {
            let (below, above) = x.mul_rev_to_pair(y);
            [set(below), set(above)].concat()
        }
        "overlap" => {
            let name = format!("{:?}", x.overlap(y));
            vec![Value::Word(format!("{}{}", name[..1].to_lowercase(), &name[1..]))]
        }
        "pow" => set(x.powf(y)),
        "precedes" => truth(x.precedes(y)),
        "sinRevBin" => set(x.sin_rev(y)),
        "sqrRevBin" => set(x.sqr_rev(y)),
        "strictLess" => truth(x.is_strictly_less_than(y)),
        "strictPrecedes" => truth(x.strictly_precedes(y)),
        "sub" => set(x - y),
        "subset" => truth(x.is_subset_of(y)),
        "tanRevBin" => set(x.tan_rev(y)),
        _ => return None,
    })
}

fn ternary(operation: &str, x: Interval, y: Interval, z: Interval) -> Option<Vec<Value>> {
    Some(match operation {
        "fma" => set(x.mul_add(y, z)),
        "mulRevTen" => set(x.mul_rev(y, z)),
        "powRev1" => set(x.pow_rev1(y, z)),
        "powRev2" => set(x.pow_rev2(y, z)),
        _ => return None,
    })
}

fn integer_power(operation: &str, x: Interval, domain: Interval, n: f64) -> Option<Vec<Value>> {
    let exponent = n as i32;
    assert_eq!(f64::from(exponent), n, "an integer exponent");
    Some(match operation {
        "pown" => set(x.powi(exponent)),
        "pownRev" | "pownRevBin" => set(x.pown_rev(domain, exponent)),
        _ => return None,
    })
}
