//! Rigorous interval mathematics for robots that must not be wrong about where they are: intervals, contractors, separators
//! and pavings that never lose the truth.
//!
//! This page is a short course. Each section has its mathematics, its guarantee and a program that runs.
//!
//! # 1. Sets instead of numbers
//! A sensor does not measure a number. It measures that a number lies in a set: a depth of 12.3 m within 0.2 m *is* the set
//! `[12.1, 12.5]`. Set-membership estimation computes with such sets, and asks of every operation one thing only: that nothing
//! that is possible gets lost. A position found in this way is not likely, it is proved, as far as the stated error bounds hold;
//! and when the bounds contradict each other, the answer is the empty set, which says so.
//!
//! An [`Interval`] is a closed set of real numbers `{x : lower <= x <= upper}`, possibly empty, possibly unbounded. The operation
//! `◇` on two of them gives the smallest interval that holds every result:
//! `[x] ◇ [y] = hull {x ◇ y : x ∈ [x], y ∈ [y]}` (seed 001, equation (2.9)).
//!
//! ```
//! use shoal_interval::Interval;
//!
//! let x = Interval::new(-1.0, 3.0)?;
//! let y = Interval::new(2.0, 7.0)?;
//! assert_eq!(x + y, Interval::new(1.0, 10.0)?);
//! assert_eq!(x - y, Interval::new(-8.0, 1.0)?);
//! assert_eq!(x * y, Interval::new(-7.0, 21.0)?);
//! assert_eq!(x / y, Interval::new(-0.5, 1.5)?);
//! assert!((x & Interval::new(4.0, 5.0)?).is_empty());
//! # Ok::<(), shoal_interval::IntervalError>(())
//! ```
//!
//! # 2. Rounding is part of the truth
//! One third is no `f64`. Every bound is rounded outwards, and as little as possible: the operation is done once, to nearest,
//! its *exact* error is computed, and the sign of that error decides whether to step to the next number. So an exact result is
//! not widened, the rounding mode of the processor is never touched, and every result has the same bits on every machine.
//!
//! | operations | a bound is |
//! |---|---|
//! | `+ - * /`, `recip`, `sqr`, `sqrt`, `mul_add`, `abs`, `min`, `max`, `sign`, `floor`, `ceil`, rounding, `cancel_minus`, hull, intersection | the tightest there is |
//! | `powi`, `powf`, `exp`, `ln`, `sin`, `cos`, `tan`, `asin`, `acos`, `atan`, `atan2`, `wrap_angle` | at most one unit in the last place from the tightest, for arguments of every size |
//! | reading and writing text | the tightest for the digits there are |
//!
//! Elementary functions come from `pxfm`, are widened by a unit in the last place, and are held against a correctly rounded
//! library on a million arguments each; where `pxfm` was found to be off by more, other ways are gone. The crate passes every
//! check of the IEEE 1788 test suite whose operation it offers (5,279; six of its results are not the tightest, and are asked for
//! as the tightest): `cargo test --release -p shoal-interval --test itf1788 -- --nocapture` counts them.
//!
//! ```
//! use shoal_interval::Interval;
//!
//! let third: Interval = "[1/3]".parse()?;
//! assert!(third.lower() < third.upper() && third.width() < 1e-16);
//! assert_eq!(third * 3.0 - 1.0, Interval::new(-f64::EPSILON / 2.0, f64::EPSILON)?);
//! // No turn is forgotten, however many there were: both bounds are within a unit of the exact ones.
//! assert!(Interval::point(1e300)?.sin().width() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 3. Boxes and inclusion functions
//! An [`IntervalBox`] is a product of intervals, an axis-aligned box of vectors; [`IntervalMatrix`] does the same for matrices,
//! rotations first of all. A function of boxes is an *inclusion function* of `f` when it holds all of `f`'s values:
//! `f([x]) ⊂ [f]([x])`. Replacing every operation by that of intervals gives the *natural* one. It is minimal when every variable
//! occurs once; otherwise it forgets that both places mean the same number, and other forms do better:
//! an [`Expression`](expression::Expression) is written once and evaluated in all of them.
//!
//! ```
//! use shoal_interval::expression::Expression;
//! use shoal_interval::{Interval, IntervalBox};
//!
//! let f = Expression::new(|[x]| x - x.sqr());
//! let domain = IntervalBox::from([Interval::new(0.4, 0.6)?]);
//! assert_eq!(format!("{:.2}", f.natural(&domain)), "[0.04, 0.45]");
//! // The mean-value form knows the slope, which is small here: the values are 0.24 to 0.25.
//! assert_eq!(format!("{:.2}", f.centred(&domain)), "[0.22, 0.28]");
//! # Ok::<(), shoal_interval::IntervalError>(())
//! ```
//!
//! # 4. Contractors: equations as narrowing
//! A constraint links variables, each of which is known to be in a set. A [`Contractor`](contractor::Contractor) removes from the
//! sets what cannot satisfy it: `C([x]) ⊂ [x]`, and `[x] ∩ S ⊂ C([x])`. It needs no inverse, no initial guess and no order: whatever
//! is known narrows whatever is not. It is built from *reverse operations*, named as in IEEE 1788: `c.sqr_rev(x)` are the numbers of
//! `x` whose square is in `c`; of two arguments the known one is the receiver, `b.mul_rev(c, x)` being the numbers of `x` that times some
//! number of `b` give one of `c`, and a digit says which argument is sought (`pow_rev1` the base, `pow_rev2` the exponent; `pown_rev`
//! reverses `powi`). Ready-made ones are listed in [`contractor`]; a new one is a closure, or comes from an expression.
//!
//! ```
//! use shoal_interval::contractor::{Contractor, contract_distance};
//! use shoal_interval::expression::Expression;
//! use shoal_interval::{Interval, IntervalBox};
//!
//! // A beacon hears the vehicle, which is east of it, at 4 m to 5 m.
//! let mut beacon = IntervalBox::from([Interval::ZERO; 2]);
//! let mut vehicle = IntervalBox::from([Interval::new(1.0, 9.0)?, Interval::new(-3.0, 3.0)?]);
//! let mut range_m = Interval::new(4.0, 5.0)?;
//! contract_distance(&mut beacon, &mut vehicle, &mut range_m);
//! assert_eq!(format!("{vehicle:.2}"), "[2.64, 5.00] x [-3.00, 3.00]");
//!
//! // Your own constraint, y = x² with y <= 0.5, in a line; repeated until it narrows by less than a hundredth.
//! let parabola = Expression::new(|[x, y]| y - x.sqr()).contractor(Interval::ZERO).fixpoint(0.01);
//! let domain = IntervalBox::from([Interval::NON_NEGATIVE, Interval::new(0.0, 0.25)?]);
//! assert_eq!(parabola.contract(domain).to_string(), "[0, 0.5] x [0, 0.25]");
//! # Ok::<(), shoal_interval::IntervalError>(())
//! ```
//!
//! Contractors combine: the intersection of two narrows by both equations, the union says "one or the other", the relaxed
//! intersection tolerates that `q` of `m` measurements are wrong, symmetries make one octant into the whole plane.
//!
//! # 5. Separators and pavings: sets of any shape
//! A box is a poor picture of a ring. A [`Separator`](separator::Separator) is a pair of contractors, one for a set and one for what
//! is not in it: what the one removes is outside, what the other removes is inside. What both leave is bisected, and so on: SIVIA, *set
//! inversion via interval analysis*. The result is a [`Paving`](paving::Paving) `inner ⊂ S ⊂ inner ∪ boundary`, and each of its
//! boxes is a proof.
//!
//! ```
//! use nalgebra::Vector2;
//! use shoal_interval::paving::{Options, pave};
//! use shoal_interval::separator::{Ring, Separator};
//! use shoal_interval::{Interval, IntervalBox};
//!
//! let heard = |x, y, near, far| Ring::new(Vector2::new(x, y), Interval::new(near, far).unwrap());
//! let place = heard(3.0, 3.0, 3.0, 4.0).intersection(heard(-3.0, -1.0, 5.0, 6.0)).intersection(heard(-2.0, 2.0, 4.0, 5.0));
//! let sea = IntervalBox::from([Interval::new(-10.0, 10.0)?; 2]);
//! let paving = pave(&place, sea, &Options::new(0.05))?;
//! // The area of the place is 0.4228: proved to lie between the two.
//! assert!(paving.inner_volume().upper() < 0.4228 && 0.4229 < paving.outer_volume().lower());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 6. When a measurement is wrong
//! Bounds are sometimes broken: a multipath echo, a wrong wall. One outlier makes an intersection empty, which is at least noticed.
//! [`separator::q_intersection`] tolerates `q` outliers, [`paving::gomne`] finds the fewest that explain the data, and [`fuzzy`]
//! weighs what is believed more and what less.
//!
//! # 7. Figures
//! [`figure`] draws pavings as SVG. The examples of this crate are the examples of the seed documents, each leaves its figure in
//! `target/figures/`: `cargo run --release -p shoal-interval --example beacons`.
//!
//! # What bad input gets
//! Bounds that are inverted or not numbers are refused with an [`IntervalError`], text that is no interval with a
//! [`ParseIntervalError`] that says where, an unbounded box or a precision of zero with a [`PavingError`](paving::PavingError). A number
//! that is NaN stands for any number, an empty operand gives the empty set. Nothing here panics but an index out of range, nothing loops for
//! ever, and a budget of boxes that runs out leaves a result that is coarser, not wrong, and says so.
//!
//! # Sources
//! Seed 001, chapters 2 and 3; seed 002, chapter 3 and section 5.3; seed 000, sections 2.3, 2.4, 4.3 and chapter 5; IEEE Std
//! 1788-2015; L. Jaulin, M. Kieffer, O. Didrit and E. Walter, *Applied Interval Analysis*, 2001; J.-M. Muller et al., *Handbook of
//! Floating-Point Arithmetic*, 2nd edition.

mod arithmetic;
mod bisection;
mod comparison;
pub mod contractor;
mod elementary;
mod error;
pub mod expression;
pub mod figure;
pub mod fuzzy;
mod interval;
mod interval_box;
mod interval_matrix;
mod lanes;
mod membership;
pub mod paving;
mod reverse;
mod rounding;
pub mod separator;
#[cfg(feature = "serde")]
mod serialization;
mod set;
#[cfg(test)]
mod strategies;
mod text;

pub use comparison::Overlap;
pub use error::IntervalError;
pub use interval::Interval;
pub use interval_box::{Difference, IntervalBox};
pub use interval_matrix::IntervalMatrix;
pub use membership::Membership;
pub use text::ParseIntervalError;
