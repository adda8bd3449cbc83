//! Minimal contractors for a sum, a product and a square.
//!
//! Source: seed 001, section 2.3.5 and equation (3.7).

use super::{Contracted, Contractor, replace};
use crate::interval::Interval;
use crate::interval_box::IntervalBox;

/// Contracts three intervals linked by `z = x + y`. Minimal.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::contract_sum;
///
/// let (mut x, mut y) = (Interval::new(f64::NEG_INFINITY, 2.0)?, Interval::new(f64::NEG_INFINITY, 3.0)?);
/// let mut z = Interval::new(4.0, f64::INFINITY)?;
/// contract_sum(&mut x, &mut y, &mut z);
/// assert_eq!((x, y, z), (Interval::new(1.0, 2.0)?, Interval::new(2.0, 3.0)?, Interval::new(4.0, 5.0)?));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, equations (2.39) to (2.41).
#[inline]
pub fn contract_sum(x: &mut Interval, y: &mut Interval, z: &mut Interval) -> Contracted {
    let contracted = [*x & (*z - *y), *y & (*z - *x), *z & (*x + *y)];
    replace([x, y, z], contracted)
}

/// Contracts three intervals linked by `z = x y`. Minimal, also when intervals hold zero: a factor is free when the other
/// factor and the product may both be zero, and loses the gap around zero when only the other factor may.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::contract_product;
///
/// let (mut x, mut y) = (Interval::new(-1.0, 9.0)?, Interval::new(-0.5, 1.0)?);
/// let mut z = Interval::new(3.0, 20.0)?;
/// contract_product(&mut x, &mut y, &mut z);
/// assert_eq!(x, Interval::new(3.0, 9.0)?);
/// assert_eq!((y.upper(), z), (1.0, Interval::new(3.0, 9.0)?));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 2.3.5.
#[inline]
pub fn contract_product(x: &mut Interval, y: &mut Interval, z: &mut Interval) -> Contracted {
    let contracted = [y.mul_rev(*z, *x), x.mul_rev(*z, *y), *z & (*x * *y)];
    replace([x, y, z], contracted)
}

/// Contracts two intervals linked by `y = x²`. Minimal: each root is met with `x` before they are joined.
///
/// ```
/// use shoal_interval::Interval;
/// use shoal_interval::contractor::contract_square;
///
/// let (mut x, mut y) = (Interval::new(-1.0, 5.0)?, Interval::new(4.0, 100.0)?);
/// contract_square(&mut x, &mut y);
/// assert_eq!((x, y), (Interval::new(2.0, 5.0)?, Interval::new(4.0, 25.0)?));
/// # Ok::<(), shoal_interval::IntervalError>(())
/// ```
///
/// Source: seed 001, section 2.3.5.
#[inline]
pub fn contract_square(x: &mut Interval, y: &mut Interval) -> Contracted {
    let root = y.sqr_rev(*x);
    let contracted = [root, *y & root.sqr()];
    replace([x, y], contracted)
}

/// `z = x + y` over the box of `x`, `y`, `z`, by [`contract_sum`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sum;

impl Contractor<3> for Sum {
    #[inline]
    fn contract(&self, domain: IntervalBox<3>) -> IntervalBox<3> {
        let [mut x, mut y, mut z] = domain.sides();
        contract_sum(&mut x, &mut y, &mut z);
        IntervalBox::from([x, y, z])
    }
}

/// `z = x y` over the box of `x`, `y`, `z`, by [`contract_product`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Product;

impl Contractor<3> for Product {
    #[inline]
    fn contract(&self, domain: IntervalBox<3>) -> IntervalBox<3> {
        let [mut x, mut y, mut z] = domain.sides();
        contract_product(&mut x, &mut y, &mut z);
        IntervalBox::from([x, y, z])
    }
}

/// `y = x²` over the box of `x`, `y`, by [`contract_square`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Square;

impl Contractor<2> for Square {
    #[inline]
    fn contract(&self, domain: IntervalBox<2>) -> IntervalBox<2> {
        let [mut x, mut y] = domain.sides();
        contract_square(&mut x, &mut y);
        IntervalBox::from([x, y])
    }
}

#[cfg(test)]
mod tests;
