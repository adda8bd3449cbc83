//! Summaries of blocks of slices, of blocks of blocks, and so on.
//!
//! Slices are counted from the first that the tube ever had, dropped ones included, and blocks begin at multiples of their
//! size. Only whole blocks have a summary: what sticks out at the front and at the end is looked at slice by slice. So
//! nothing changes when old slices are dropped, but for the blocks that go, and appending touches a block when it is full.

use super::{Slices, Summary};
use crate::enclosure::Enclosure;
use crate::storage::push_sparingly;
use std::collections::VecDeque;
use std::ops::{ControlFlow, Range};

/// The slices of a block of the lowest level are 2 to this power.
const BLOCK_BITS: u32 = 4;
/// The blocks that make one of the next level are 2 to this power.
const BRANCH_BITS: u32 = 2;

/// How many slices a block of `level` spans, as a power of two.
#[inline]
const fn span_bits(level: usize) -> u32 {
    BLOCK_BITS + BRANCH_BITS * level as u32
}

/// The summaries of all whole blocks of a tube.
#[derive(Debug, Clone)]
pub(crate) struct SummaryTree<T: Enclosure> {
    /// How many slices were dropped at the front.
    dropped: usize,
    count: usize,
    levels: Vec<Level<T>>,
}

/// Blocks of the same size.
#[derive(Debug, Clone)]
struct Level<T: Enclosure> {
    /// The number of the first block, counted from the first that there ever was.
    first: usize,
    blocks: VecDeque<Summary<T>>,
}

/// Some neighbouring slices, on the way through a tree.
#[derive(Debug)]
pub(crate) enum Part<'a, T: Enclosure> {
    /// A whole block, and what is known about it.
    Block(Range<usize>, &'a Summary<T>),
    /// Slices to be looked at one by one.
    Slices(Range<usize>),
}

/// Where to go from a [`Part`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step<B> {
    /// To what comes after it.
    Past,
    /// Into its smaller parts; past it if it is slices already.
    Into,
    /// No further: this is the answer.
    Stop(B),
}

impl<T: Enclosure> SummaryTree<T> {
    /// The tree of these slices.
    pub(crate) fn new(slices: Slices<'_, T>) -> SummaryTree<T> {
        let count = slices.values.len();
        let mut tree = SummaryTree { dropped: 0, count, levels: Vec::new() };
        let mut blocks = count >> BLOCK_BITS;
        while blocks > 0 {
            let level = tree.levels.len();
            let summaries = (0..blocks).map(|number| tree.summary_of(level, number, slices)).collect();
            tree.levels.push(Level { first: 0, blocks: summaries });
            blocks >>= BRANCH_BITS;
        }
        tree
    }

    /// Takes in a slice that was added at the end of `slices`.
    pub(crate) fn append(&mut self, slices: Slices<'_, T>) {
        self.count += 1;
        let end = self.dropped + self.count;
        for level in 0.. {
            let span = 1 << span_bits(level);
            if !end.is_multiple_of(span) || end < self.dropped + span {
                break;
            }
            let number = (end - span) >> span_bits(level);
            let summary = self.summary_of(level, number, slices);
            if level == self.levels.len() {
                self.levels.push(Level { first: number, blocks: VecDeque::new() });
            }
            let level = &mut self.levels[level];
            if level.blocks.is_empty() {
                level.first = number;
            }
            push_sparingly(&mut level.blocks, summary);
        }
    }

    /// Forgets the `count` oldest slices.
    pub(crate) fn drop_front(&mut self, count: usize) {
        self.dropped += count;
        self.count -= count;
        for (level, blocks) in self.levels.iter_mut().enumerate() {
            let first_whole = self.dropped.div_ceil(1 << span_bits(level));
            let gone = first_whole.saturating_sub(blocks.first).min(blocks.blocks.len());
            blocks.blocks.drain(..gone);
            blocks.first += gone;
            if blocks.blocks.capacity() > (64_usize).max(4 * blocks.blocks.len()) {
                blocks.blocks.shrink_to(2 * blocks.blocks.len());
            }
        }
    }

    /// Takes in that some slices have changed. Goes up only as far as summaries change.
    pub(crate) fn refresh(&mut self, changed: Range<usize>, slices: Slices<'_, T>) {
        if changed.is_empty() {
            return;
        }
        let (first, last) = (self.dropped + changed.start, self.dropped + changed.end - 1);
        for level in 0..self.levels.len() {
            let bits = span_bits(level);
            let known = self.levels[level].first..self.levels[level].first + self.levels[level].blocks.len();
            let mut any = false;
            for number in (first >> bits).max(known.start)..((last >> bits) + 1).min(known.end) {
                let summary = self.summary_of(level, number, slices);
                let before = &mut self.levels[level].blocks[number - known.start];
                any |= *before != summary;
                *before = summary;
            }
            if !any {
                break;
            }
        }
    }

    /// Goes through the slices of `range` from the first to the last, in parts as large as possible; `visit` says at each
    /// whether to look closer. The answer is what `visit` stopped with.
    #[inline]
    pub(crate) fn walk<B>(
        &self,
        range: Range<usize>,
        mut visit: impl FnMut(Part<'_, T>) -> Step<B>,
    ) -> ControlFlow<B> {
        let (mut at, end) = (self.dropped + range.start, self.dropped + range.end);
        let mut levels = self.levels.len();
        while at < end {
            let level = self.largest_block(at, end - at, levels);
            let (length, part) = match level {
                Some(level) => {
                    let span = 1 << span_bits(level);
                    (span, self.block(level, at, span))
                }
                None => {
                    let length = (block_end(at) - at).min(end - at);
                    (length, Part::Slices(at - self.dropped..at - self.dropped + length))
                }
            };
            match (visit(part), level) {
                (Step::Stop(answer), _) => return ControlFlow::Break(answer),
                (Step::Into, Some(level)) => levels = level,
                _ => {
                    at += length;
                    levels = self.levels.len();
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// [`walk`](SummaryTree::walk) from the last slice to the first.
    pub(crate) fn walk_back<B>(
        &self,
        range: Range<usize>,
        mut visit: impl FnMut(Part<'_, T>) -> Step<B>,
    ) -> ControlFlow<B> {
        let (start, mut end) = (self.dropped + range.start, self.dropped + range.end);
        let mut levels = self.levels.len();
        while start < end {
            let level = self.largest_block(end, end - start, levels);
            let (length, part) = match level {
                Some(level) => {
                    let span = 1 << span_bits(level);
                    (span, self.block(level, end - span, span))
                }
                None => {
                    let length = (end - block_start(end - 1)).min(end - start);
                    (length, Part::Slices(end - length - self.dropped..end - self.dropped))
                }
            };
            match (visit(part), level) {
                (Step::Stop(answer), _) => return ControlFlow::Break(answer),
                (Step::Into, Some(level)) => levels = level,
                _ => {
                    end -= length;
                    levels = self.levels.len();
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The bytes on the heap.
    pub(crate) fn memory_bytes(&self) -> usize {
        let blocks: usize = self.levels.iter().map(|level| level.blocks.capacity()).sum();
        blocks * size_of::<Summary<T>>() + self.levels.capacity() * size_of::<Level<T>>()
    }

    /// The largest level below `levels` that has a block with a border at `at` and no more than `room` slices.
    #[inline]
    fn largest_block(&self, at: usize, room: usize, levels: usize) -> Option<usize> {
        let bits = at.trailing_zeros().min(room.ilog2());
        let above = (bits + BRANCH_BITS).saturating_sub(BLOCK_BITS) / BRANCH_BITS;
        (above as usize).min(levels).checked_sub(1)
    }

    #[inline]
    fn block(&self, level: usize, at: usize, span: usize) -> Part<'_, T> {
        let blocks = &self.levels[level];
        let start = at - self.dropped;
        Part::Block(start..start + span, &blocks.blocks[(at >> span_bits(level)) - blocks.first])
    }

    /// The summary of a block, from those of the level below.
    fn summary_of(&self, level: usize, number: usize, slices: Slices<'_, T>) -> Summary<T> {
        let Some(below) = level.checked_sub(1) else {
            let start = (number << BLOCK_BITS) - self.dropped;
            return slices.summary(start..start + (1 << BLOCK_BITS));
        };
        let below = &self.levels[below];
        let first = (number << BRANCH_BITS) - below.first;
        let mut parts = below.blocks.range(first..first + (1 << BRANCH_BITS));
        let mut summary = parts.next().copied().unwrap_or_else(|| slices.summary(0..0));
        for part in parts {
            summary = summary.followed_by(part);
        }
        summary
    }
}

/// The end of the block of the lowest level that the slice `at` is in.
#[inline]
fn block_end(at: usize) -> usize {
    ((at >> BLOCK_BITS) + 1) << BLOCK_BITS
}

/// The start of the block of the lowest level that the slice `at` is in.
#[inline]
fn block_start(at: usize) -> usize {
    (at >> BLOCK_BITS) << BLOCK_BITS
}
