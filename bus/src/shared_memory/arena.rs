//! The arena: one mapped file with all that crosses between the channel and its AUVs, and the words on which they sleep.
//!
//! After a header come a line for each wake-up group, a slot for each AUV, and the far parts of the slots, which take no memory
//! until they are written to. A slot holds one message each way; who writes into a part of it is the only one who does.

use std::io;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use crate::codec::FORMAT;
use crate::message::AuvId;
use crate::os::{self, SharedWords, Slept};
use crate::run_dir::RunDir;

/// `shoal` in a word.
const MAGIC: u32 = 0x5348_4f4c;

/// Words per cache line: what different processes write stays on different lines.
const LINE: usize = 16;

const BELL: usize = LINE;
const IS_ASLEEP: usize = LINE + 1;
const GROUPS: usize = 2 * LINE;
/// Words of one group: the bell on which its processes sleep, and what they count down.
const GROUP: usize = LINE;

/// Where the channel's part of a slot holds a message, and how much of it.
const DOWN: usize = 7;
const DOWN_NEAR: usize = 15 * LINE - DOWN;
const DOWN_FAR: usize = 256 * LINE;
/// Where the AUV's part begins, and what it holds.
const UP_PART: usize = DOWN + DOWN_NEAR;
const UP: usize = UP_PART + 3;
const UP_NEAR: usize = 8 * LINE - 3;
const UP_FAR: usize = 128 * LINE;
/// An odd number of lines, so that what is touched first in each slot is spread over all sets of a cache.
const SLOT: usize = UP + UP_NEAR;
const FAR: usize = DOWN_FAR + UP_FAR;

/// Bits of a group's count that count answers; the others tell the windows apart.
const COUNT_BITS: u32 = 20;

/// How many processes a wake-up group can have: each has a bit of its own, by which it alone can be woken.
pub(super) const GROUP_MAX: usize = 32;

/// How many processes of each group are guards: one may die with the channel.
const GUARDS: u32 = 2;

/// The channel has ended the run.
pub(super) const ENDED: u32 = 1;
/// The channel has ended without a word.
pub(super) const ORPHANED: u32 = 2;

/// The arena of a run.
#[derive(Debug)]
pub(super) struct Arena {
    shared: SharedWords,
    groups: usize,
    auvs: usize,
}

/// Where an AUV's process sleeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the group.
    pub(super) group: usize,
    /// The process's own bit in it.
    pub(super) bit: u32,
}

impl Place {
    /// Whether the process looks now and then if the channel is alive, for all of its group: each window of each process would
    /// cost a fifth more with a timer for its sleep.
    fn is_guard(self) -> bool {
        self.bit.trailing_zeros() < GUARDS
    }
}

/// One AUV's slot.
#[derive(Clone, Copy)]
pub(super) struct Slot<'a> {
    /// Not zero when the channel wants nothing more from it.
    pub(super) dismissed: &'a AtomicU32,
    /// Which window of its group the message down belongs to, for [`Arena::answered`].
    pub(super) window: &'a AtomicU32,
    /// Process of the AUV that has joined; zero before.
    pub(super) pid: &'a AtomicU32,
    /// From the channel.
    pub(super) down: Lane<'a>,
    /// From the AUV.
    pub(super) up: Lane<'a>,
}

/// Room for one message.
#[derive(Clone, Copy)]
pub(super) struct Lane<'a> {
    /// Number of the message; written last, read first. Messages up have the number of what they answer.
    pub(super) sequence: &'a AtomicU32,
    /// In bytes. What is longer than [`Lane::capacity`] is in a file instead.
    pub(super) length: &'a AtomicU32,
    near: &'a [AtomicU32],
    far: &'a [AtomicU32],
}

impl Arena {
    /// Makes the arena of `run`. `members` is (AUV, where it sleeps), sorted by AUV.
    pub(super) fn create(run: &RunDir, members: &[(AuvId, Place)], groups: usize) -> io::Result<Self> {
        let words = GROUPS + groups * GROUP + members.len() * (SLOT + FAR);
        let arena = Self { shared: SharedWords::create(&run.arena(), words)?, groups, auvs: members.len() };
        for (index, (auv, place)) in members.iter().enumerate() {
            let start = arena.slot_start(index);
            for (at, value) in [auv.0, place.group as u32, place.bit].into_iter().enumerate() {
                arena.word(start + at).store(value, Ordering::Relaxed);
            }
        }
        let header = [u32::from(FORMAT), members.len() as u32, groups as u32, std::process::id()];
        for (at, value) in header.into_iter().enumerate() {
            arena.word(1 + at).store(value, Ordering::Relaxed);
        }
        // Last: who sees it sees the rest.
        arena.word(0).store(MAGIC, Ordering::Release);
        Ok(arena)
    }

    /// Opens the arena of `run`.
    pub(super) fn open(run: &RunDir) -> io::Result<Self> {
        let invalid = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
        let shared = SharedWords::open(&run.arena())?;
        let header: Option<[u32; 4]> = match shared.words() {
            [magic, rest @ ..] if magic.load(Ordering::Acquire) == MAGIC => {
                rest.first_chunk::<4>().map(|words| words.each_ref().map(|word| word.load(Ordering::Relaxed)))
            }
            _ => None,
        };
        let [format, auvs, groups, _] = header.ok_or_else(|| invalid("it is no arena".into()))?;
        if format != u32::from(FORMAT) {
            return Err(invalid(format!("the channel speaks format {format}, this build {FORMAT}")));
        }
        let arena = Self { shared, groups: groups as usize, auvs: auvs as usize };
        match arena.slot_start(arena.auvs) + arena.auvs * FAR == arena.shared.words().len() {
            true => Ok(arena),
            false => Err(invalid("the arena has a wrong length".into())),
        }
    }

    /// Process of the channel.
    pub(super) fn channel_pid(&self) -> u32 {
        self.word(4).load(Ordering::Relaxed)
    }

    /// Zero until the run is over, then [`ENDED`] or [`ORPHANED`].
    pub(super) fn ended(&self) -> &AtomicU32 {
        self.word(5)
    }

    /// Tells a group that the channel's process has ended.
    pub(super) fn orphan(&self, group: usize) -> io::Result<()> {
        self.ended().store(ORPHANED, Ordering::Release);
        self.ring_group(group, u32::MAX)
    }

    /// Index of the slot of `auv`, and where its process sleeps.
    pub(super) fn find(&self, auv: AuvId) -> Option<(usize, Place)> {
        let auv_of = |index| self.word(self.slot_start(index)).load(Ordering::Relaxed);
        let (mut low, mut high) = (0, self.auvs);
        while low < high {
            let middle = low.midpoint(high);
            if auv_of(middle) < auv.0 { low = middle + 1 } else { high = middle }
        }
        if low == self.auvs || auv_of(low) != auv.0 {
            return None;
        }
        let [group, bit] = [1, 2].map(|at| self.word(self.slot_start(low) + at).load(Ordering::Relaxed));
        let place = Place { group: group as usize, bit };
        (place.group < self.groups).then_some((low, place))
    }

    pub(super) fn slot(&self, index: usize) -> Slot<'_> {
        let slot = &self.shared.words()[self.slot_start(index)..][..SLOT];
        let far = &self.shared.words()[self.slot_start(self.auvs) + index * FAR..][..FAR];
        let (down_far, up_far) = far.split_at(DOWN_FAR);
        let (down, up) = slot.split_at(UP_PART);
        Slot {
            dismissed: &down[3],
            window: &down[4],
            pid: &up[0],
            down: Lane { sequence: &down[5], length: &down[6], near: &down[DOWN..], far: down_far },
            up: Lane { sequence: &up[1], length: &up[2], near: &up[UP - UP_PART..], far: up_far },
        }
    }

    /// The bell of a group as it is now, for [`sleep`](Self::sleep).
    pub(super) fn group_bell(&self, group: usize) -> u32 {
        self.word(GROUPS + group * GROUP).load(Ordering::Acquire)
    }

    /// Sleeps until the bell of its group is rung for this place after it was `seen`; guards at most for `limit`. May return early.
    pub(super) fn sleep(&self, place: Place, seen: u32, limit: Duration) -> io::Result<Slept> {
        let limit = Some(limit).filter(|_| place.is_guard());
        os::sleep_as(self.word(GROUPS + place.group * GROUP), seen, place.bit, limit)
    }

    /// Begins a window in which `answers` AUVs of a group are due. Returns its name.
    pub(super) fn begin_window(&self, group: usize, answers: usize) -> u32 {
        let window = self.group_bell(group).wrapping_add(1);
        self.pending(group).store(window << COUNT_BITS | answers as u32, Ordering::Release);
        window
    }

    /// Wakes the processes of a group that have these bits.
    pub(super) fn ring_group(&self, group: usize, bits: u32) -> io::Result<()> {
        let bell = self.word(GROUPS + group * GROUP);
        bell.fetch_add(1, Ordering::Release);
        os::wake_these(bell, bits)
    }

    /// Counts one answer, and wakes the channel when it was the last of its group in this window. A hint only: a process may
    /// die between answer and count, so the channel looks again by itself.
    pub(super) fn answered(&self, group: usize, window: u32) -> io::Result<()> {
        let count_of = |pending: u32| pending & ((1 << COUNT_BITS) - 1);
        let counted = self.pending(group).try_update(Ordering::AcqRel, Ordering::Acquire, |pending| {
            let is_now = pending >> COUNT_BITS == window << COUNT_BITS >> COUNT_BITS;
            (is_now && count_of(pending) > 0).then(|| pending - 1)
        });
        match counted {
            Ok(before) if count_of(before) == 1 => self.ring_channel(),
            _ => Ok(()),
        }
    }

    /// The channel's bell as it is now, for [`await_channel_bell`](Self::await_channel_bell).
    pub(super) fn channel_bell(&self) -> u32 {
        self.word(BELL).load(Ordering::Acquire)
    }

    /// Sleeps until the channel's bell is rung after it was `seen`, or for `limit`.
    pub(super) fn await_channel_bell(&self, seen: u32, limit: Duration) -> io::Result<()> {
        // Whoever rings changes the bell before it looks whether anybody sleeps: either it sees this, or the sleep ends at once.
        self.word(IS_ASLEEP).store(1, Ordering::SeqCst);
        let slept = os::sleep_on(self.word(BELL), seen, limit);
        self.word(IS_ASLEEP).store(0, Ordering::Relaxed);
        slept
    }

    /// Wakes the channel, if it sleeps.
    pub(super) fn ring_channel(&self) -> io::Result<()> {
        self.word(BELL).fetch_add(1, Ordering::SeqCst);
        match self.word(IS_ASLEEP).load(Ordering::SeqCst) {
            0 => Ok(()),
            _ => os::wake_all(self.word(BELL)),
        }
    }

    fn pending(&self, group: usize) -> &AtomicU32 {
        self.word(GROUPS + group * GROUP + 1)
    }

    fn slot_start(&self, index: usize) -> usize {
        GROUPS + self.groups * GROUP + index * SLOT
    }

    fn word(&self, at: usize) -> &AtomicU32 {
        &self.shared.words()[at]
    }
}

impl Lane<'_> {
    /// Bytes that fit.
    pub(super) fn capacity(&self) -> usize {
        (self.near.len() + self.far.len()) * size_of::<AtomicU32>()
    }

    /// Puts a message in that fits, but for its length and sequence number.
    pub(super) fn write(&self, message: &[u8]) {
        let (words, rest) = message.as_chunks::<4>();
        let mut last = [0; 4];
        last[..rest.len()].copy_from_slice(rest);
        let values = words.iter().chain([&last]).map(|bytes| u32::from_ne_bytes(*bytes));
        for (word, value) in self.near.iter().chain(self.far).zip(values) {
            word.store(value, Ordering::Relaxed);
        }
    }

    /// Takes a message of `length` bytes out, at most all there is.
    pub(super) fn read(&self, length: usize, message: &mut Vec<u8>) {
        let length = length.min(self.capacity());
        message.clear();
        message.resize(length.next_multiple_of(4), 0);
        let (words, _) = message.as_chunks_mut::<4>();
        let (near, far) = words.split_at_mut(words.len().min(self.near.len()));
        for (bytes, word) in near.iter_mut().zip(self.near).chain(far.iter_mut().zip(self.far)) {
            *bytes = word.load(Ordering::Relaxed).to_ne_bytes();
        }
        message.truncate(length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_hold_messages_of_all_lengths_and_keep_apart() {
        let run = RunDir::create(&serde_json::Value::Null).unwrap();
        let place = |bit| Place { group: 0, bit };
        let members = [(AuvId(3), place(1)), (AuvId(70_000), place(2)), (AuvId(70_001), place(4))];
        let made = Arena::create(&run, &members, 1).unwrap();
        let opened = Arena::open(&run).unwrap();
        run.remove().unwrap();
        for (index, (auv, place)) in members.iter().enumerate() {
            assert_eq!(opened.find(*auv), Some((index, *place)));
        }
        assert_eq!([0, 4, 70_002].map(|auv| opened.find(AuvId(auv))), [None; 3]);
        let lanes = |arena| [0, 1, 2].map(|index| Arena::slot(arena, index)).map(|slot| [slot.down, slot.up]);
        let (written, seen) = (lanes(&made), lanes(&opened));
        let mut message = Vec::new();
        for length in [0, 1, 3, 4, 5, 500, 501, 931, 932, 933, 8_000, 17_316, 8_692] {
            for (lane, seed) in written.as_flattened().iter().zip(1u8..) {
                let bytes = vec![seed; length.min(lane.capacity())];
                lane.write(&bytes);
            }
            for (lane, seed) in seen.as_flattened().iter().zip(1u8..) {
                lane.read(length, &mut message);
                assert_eq!(message, vec![seed; length.min(lane.capacity())]);
            }
        }
        assert!(written.as_flattened().iter().all(|lane| lane.sequence.load(Ordering::Relaxed) == 0));
        assert_eq!(SLOT / LINE % 2, 1);
    }

    #[test]
    fn answers_of_another_window_do_not_count() {
        let run = RunDir::create(&serde_json::Value::Null).unwrap();
        let arena = Arena::create(&run, &[(AuvId(0), Place { group: 0, bit: 1 })], 1).unwrap();
        run.remove().unwrap();
        let window = arena.begin_window(0, 2);
        let bell = arena.channel_bell();
        arena.answered(0, window.wrapping_sub(1)).unwrap();
        arena.answered(0, window).unwrap();
        assert_eq!(arena.channel_bell(), bell);
        arena.answered(0, window).unwrap();
        assert_ne!(arena.channel_bell(), bell);
        let bell = arena.channel_bell();
        arena.answered(0, window).unwrap();
        assert_eq!(arena.channel_bell(), bell);
    }
}
