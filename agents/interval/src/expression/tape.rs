//! The tape: an expression as a list of operations, and the two sweeps over it.

use super::binary::Binary;
use super::regularity::Regularity;
use super::unary::Unary;
use crate::interval::Interval;
use std::cell::Cell;

/// One operation of a tape; its operands are slots that come before its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operation {
    Unary(Unary, usize),
    Binary(Binary, usize, usize),
}

impl Operation {
    /// The values over the operands in `values`.
    #[inline]
    pub(super) fn image(self, values: &[Interval]) -> Interval {
        match self {
            Operation::Unary(function, x) => function.image(values[x]),
            Operation::Binary(function, a, b) => function.image(values[a], values[b]),
        }
    }

    /// How the operation behaves on the operands in `values`, where it gives `image`.
    #[inline]
    pub(super) fn regularity(self, values: &[Interval], image: Interval) -> Regularity {
        if image.is_empty() {
            return Regularity::Partial;
        }
        match self {
            Operation::Unary(function, x) => function.regularity(values[x], image),
            Operation::Binary(function, a, b) => function.regularity(values[a], values[b]),
        }
    }
}

/// An expression in the order of its evaluation.
///
/// Every slot holds one value: first come the variables, then the constants, then the result of each operation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tape {
    pub(super) variables: usize,
    pub(super) constants: Vec<Interval>,
    pub(super) operations: Vec<Operation>,
    /// The slots of the results.
    pub(super) outputs: Vec<usize>,
}

impl Tape {
    /// How many values a sweep needs room for.
    #[inline]
    pub(super) fn slots(&self) -> usize {
        self.first_operation() + self.operations.len()
    }

    /// The slot of the result of the first operation.
    #[inline]
    pub(super) fn first_operation(&self) -> usize {
        self.variables + self.constants.len()
    }

    /// Encloses every slot over `domain`.
    #[inline]
    pub(super) fn forward(&self, domain: &[Interval], values: &mut [Interval]) {
        self.sweep(domain, values, |_, _, _| ());
    }

    /// Encloses every slot over `domain`, and tells how the expression behaves there.
    #[inline]
    pub(super) fn forward_with_regularity(&self, domain: &[Interval], values: &mut [Interval]) -> Regularity {
        let mut worst = Regularity::Continuous;
        self.sweep(domain, values, |operation, operands, image| {
            worst = worst.min(operation.regularity(operands, image));
        });
        worst
    }

    #[inline]
    fn sweep(
        &self,
        domain: &[Interval],
        values: &mut [Interval],
        mut visit: impl FnMut(Operation, &[Interval], Interval),
    ) {
        let first = self.first_operation();
        values[..self.variables].copy_from_slice(domain);
        values[self.variables..first].copy_from_slice(&self.constants);
        for (offset, &operation) in self.operations.iter().enumerate() {
            let (operands, results) = values.split_at_mut(first + offset);
            results[0] = operation.image(operands);
            visit(operation, operands, results[0]);
        }
    }

    /// Contracts every slot by the operations that use it, last first. False when nothing is left.
    #[inline]
    #[must_use]
    pub(super) fn backward(&self, values: &mut [Interval]) -> bool {
        let first = self.first_operation();
        for (offset, &operation) in self.operations.iter().enumerate().rev() {
            let (operands, results) = values.split_at_mut(first + offset);
            let possible = match operation {
                Operation::Unary(function, x) => {
                    operands[x] = function.preimage(operands[x], results[0]);
                    !operands[x].is_empty()
                }
                Operation::Binary(function, a, b) => {
                    let (new_a, new_b) = function.preimage(operands[a], operands[b], results[0]);
                    operands[a] = new_a;
                    // Both may be the same slot.
                    operands[b] = operands[b] & new_b;
                    !operands[a].is_empty() && !operands[b].is_empty()
                }
            };
            if !possible {
                return false;
            }
        }
        true
    }
}

thread_local! {
    static WORKSPACE: Cell<Vec<Interval>> = const { Cell::new(Vec::new()) };
}

/// Lends room for `length` intervals, whatever they were before. A thread allocates only when it needs more than ever.
#[inline]
pub(super) fn with_workspace<R>(length: usize, work: impl FnOnce(&mut [Interval]) -> R) -> R {
    // While a thread ends its workspace may be gone already.
    let mut workspace = WORKSPACE.try_with(Cell::take).unwrap_or_default();
    if workspace.len() < length {
        workspace.resize(length, Interval::EMPTY);
    }
    let result = work(&mut workspace[..length]);
    let _ = WORKSPACE.try_with(|kept| kept.set(workspace));
    result
}
