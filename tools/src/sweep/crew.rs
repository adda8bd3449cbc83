//! Tasks side by side, one thread each, with results in the order in which they come.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use crate::failure::Failure;

/// Carries out `tasks`, up to `jobs` at a time and begun in their order, and hands each result over to `done` in this thread with the
/// number of its task. When `done` fails no further task is begun.
pub fn side_by_side<T: Sync, R: Send>(
    tasks: &[T],
    jobs: usize,
    carry_out: impl Fn(&T) -> R + Sync,
    mut done: impl FnMut(usize, R) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let next = AtomicUsize::new(0);
    let (sender, results) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, tasks.len().max(1)) {
            let sender = sender.clone();
            scope.spawn(|| {
                let sender = sender;
                // What a task does side by side stays in one thread: the other cores have tasks of their own.
                let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
                let carry_out = |task| match &alone {
                    Ok(alone) => alone.install(|| carry_out(task)),
                    Err(_) => carry_out(task),
                };
                while let Some((index, task)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    tasks.get(index).map(|task| (index, task))
                } {
                    // The receiver lives until the last of us has ended, unless it has failed.
                    if sender.send((index, carry_out(task))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let outcome = results.iter().try_for_each(|(index, result)| done(index, result));
        next.store(tasks.len(), Ordering::Relaxed);
        outcome
    })
}
