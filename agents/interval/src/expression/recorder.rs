//! The recorder: what symbols write down, and the tape that is made of it.

use super::regularity::Regularity;
use super::symbol::Symbol;
use super::tape::{Operation, Tape};
use crate::interval::Interval;
use std::cell::RefCell;

/// Where symbols write down what is done with them.
pub struct Recorder {
    steps: RefCell<Vec<Step>>,
}

#[derive(Clone, Copy)]
struct Step {
    source: Source,
    /// The value, when no variable has a part in it.
    constant: Option<Interval>,
}

#[derive(Clone, Copy, PartialEq)]
enum Source {
    Variable,
    Constant(Interval),
    Operation(Operation),
}

impl Recorder {
    /// A recorder that knows the variables only, in the first slots.
    pub(super) fn new(variables: usize) -> Recorder {
        let variable = Step { source: Source::Variable, constant: None };
        Recorder { steps: RefCell::new(vec![variable; variables]) }
    }

    /// The symbol of a variable.
    pub(super) fn variable(&self, axis: usize) -> Symbol<'_> {
        Symbol::new(self, axis)
    }

    /// The symbol of a constant: the same for the same number, a new one for what is known to an interval only.
    pub(super) fn constant(&self, value: Interval) -> Symbol<'_> {
        self.record(Step { source: Source::Constant(value), constant: Some(value) }, value.is_point())
    }

    /// The symbol of the result of an operation on what is recorded already.
    pub(super) fn operation(&self, operation: Operation) -> Symbol<'_> {
        let constant = self.fold(operation);
        self.record(Step { source: Source::Operation(operation), constant }, true)
    }

    /// The slot of the step: that of an equal one, when equal ones are the same number, or else a new one.
    fn record(&self, step: Step, is_shared: bool) -> Symbol<'_> {
        let mut steps = self.steps.borrow_mut();
        let known = steps.iter().position(|known| is_shared && known.source == step.source);
        let slot = known.unwrap_or_else(|| {
            steps.push(step);
            steps.len() - 1
        });
        Symbol::new(self, slot)
    }

    /// The value of an operation on constants, where it behaves well enough that nothing is forgotten with it.
    fn fold(&self, operation: Operation) -> Option<Interval> {
        let steps = self.steps.borrow();
        let (values, operation) = match operation {
            Operation::Unary(function, x) => {
                ([steps[x].constant?, Interval::EMPTY], Operation::Unary(function, 0))
            }
            Operation::Binary(function, a, b) => {
                ([steps[a].constant?, steps[b].constant?], Operation::Binary(function, 0, 1))
            }
        };
        let image = operation.image(&values);
        let forgets = image.is_empty() || operation.regularity(&values, image) < Regularity::Continuous;
        (!forgets).then_some(image)
    }

    /// The tape that computes `results` and nothing else.
    pub(super) fn into_tape(self, variables: usize, results: &[usize]) -> Tape {
        let steps = self.steps.into_inner();
        let is_used = used(&steps, results);
        let mut constants = Vec::new();
        let mut slot_of: Vec<usize> = (0..steps.len()).collect();
        for (slot, step) in steps.iter().enumerate().skip(variables) {
            if let (true, Some(value)) = (is_used[slot], step.constant) {
                slot_of[slot] = variables + constants.len();
                constants.push(value);
            }
        }
        let first = variables + constants.len();
        let mut operations = Vec::new();
        for (slot, step) in steps.iter().enumerate().skip(variables) {
            if let (true, None, Source::Operation(operation)) = (is_used[slot], step.constant, step.source) {
                slot_of[slot] = first + operations.len();
                operations.push(match operation {
                    Operation::Unary(function, x) => Operation::Unary(function, slot_of[x]),
                    Operation::Binary(function, a, b) => Operation::Binary(function, slot_of[a], slot_of[b]),
                });
            }
        }
        let outputs = results.iter().map(|&slot| slot_of[slot]).collect();
        Tape { variables, constants, operations, outputs }
    }
}

/// Which steps have a part in the results; what a folded constant was made of has none.
fn used(steps: &[Step], results: &[usize]) -> Vec<bool> {
    let mut is_used = vec![false; steps.len()];
    for &slot in results {
        is_used[slot] = true;
    }
    for slot in (0..steps.len()).rev() {
        if let (true, Step { source: Source::Operation(operation), constant: None }) =
            (is_used[slot], steps[slot])
        {
            match operation {
                Operation::Unary(_, x) => is_used[x] = true,
                Operation::Binary(_, a, b) => (is_used[a], is_used[b]) = (true, true),
            }
        }
    }
    is_used
}
