//! What all paving algorithms share: levels of boxes, threads, the budget.

use super::{Options, Paving, PavingError, Stopped};
use crate::interval_box::IntervalBox;

/// Fewer boxes than this for each thread are not worth starting one.
const WORTH_A_THREAD: usize = 32;

/// Paves `initial` with `cut`, which sorts the certain parts of a box into a paving, counts what it asks, and returns
/// what is undecided.
///
/// Boxes are handled level by level, from the initial box to its halves, their halves, and so on, always in the same
/// order. Threads take consecutive pieces of a level, and their results are joined in that order.
pub(super) fn run<const N: usize>(
    initial: IntervalBox<N>,
    options: &Options<N>,
    cut: impl Fn(IntervalBox<N>, &mut Paving<N>) -> IntervalBox<N> + Sync,
) -> Result<Paving<N>, PavingError> {
    options.check(&initial)?;
    let mut paving = Paving::empty();
    if initial.is_empty() {
        return Ok(paving);
    }
    let mut level = vec![initial];
    let mut next = Vec::new();
    while !level.is_empty() {
        let affordable = options.budget() - paving.statistics.boxes;
        if affordable < level.len() {
            let left = level.split_off(affordable);
            paving.stopped = Stopped::BudgetSpent { left: left.len() };
            run_level(&level, options, &cut, &mut paving, &mut next);
            paving.stopped = Stopped::BudgetSpent { left: left.len() + next.len() };
            paving.boundary.extend(left);
            paving.boundary.append(&mut next);
            break;
        }
        run_level(&level, options, &cut, &mut paving, &mut next);
        std::mem::swap(&mut level, &mut next);
        next.clear();
    }
    Ok(paving)
}

fn run_level<const N: usize>(
    level: &[IntervalBox<N>],
    options: &Options<N>,
    cut: &(impl Fn(IntervalBox<N>, &mut Paving<N>) -> IntervalBox<N> + Sync),
    paving: &mut Paving<N>,
    next: &mut Vec<IntervalBox<N>>,
) {
    let threads = options.threads().min(level.len() / WORTH_A_THREAD);
    if threads < 2 {
        run_piece(level, options, cut, paving, next);
        return;
    }
    std::thread::scope(|scope| {
        let pieces = level.chunks(level.len().div_ceil(threads)).map(|piece| {
            scope.spawn(move || {
                let (mut found, mut next) = (Paving::empty(), Vec::new());
                run_piece(piece, options, cut, &mut found, &mut next);
                (found, next)
            })
        });
        let workers: Vec<_> = pieces.collect();
        for worker in workers {
            match worker.join() {
                Ok((found, undecided)) => {
                    paving.append(found);
                    next.extend(undecided);
                }
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
    });
}

fn run_piece<const N: usize>(
    piece: &[IntervalBox<N>],
    options: &Options<N>,
    cut: &impl Fn(IntervalBox<N>, &mut Paving<N>) -> IntervalBox<N>,
    paving: &mut Paving<N>,
    next: &mut Vec<IntervalBox<N>>,
) {
    for &part in piece {
        paving.statistics.boxes += 1;
        let undecided = cut(part, paving);
        if undecided.is_empty() {
            continue;
        }
        let halves = if options.is_fine(&part, &undecided) { None } else { options.bisect(&undecided) };
        match halves {
            Some((first, second)) => {
                paving.statistics.bisections += 1;
                next.push(first);
                next.push(second);
            }
            None => paving.boundary.push(undecided),
        }
    }
}

impl<const N: usize> Paving<N> {
    fn append(&mut self, mut other: Paving<N>) {
        self.inner.append(&mut other.inner);
        self.boundary.append(&mut other.boundary);
        self.outside.append(&mut other.outside);
        self.statistics.boxes += other.statistics.boxes;
        self.statistics.bisections += other.statistics.bisections;
    }
}
