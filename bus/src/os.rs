//! What the transports ask of the operating system (Linux): shared words, sleeping on them, and the ends of processes.
#![allow(unsafe_code)]

use std::fs::{File, OpenOptions};
use std::io;
use std::num::NonZeroU32;
use std::os::fd::{BorrowedFd, OwnedFd, RawFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec};
use rustix::mm::{MapFlags, ProtFlags};
use rustix::process::{Pid, PidfdFlags, Resource, Rlimit, Signal};
use rustix::thread::futex;

/// A file of atomic words, mapped by every process that opens it.
#[derive(Debug)]
pub struct SharedWords {
    start: NonNull<AtomicU32>,
    count: usize,
}

// SAFETY: the mapping is only reached through `&[AtomicU32]`, which is `Send` and `Sync`; it lives until `drop`.
unsafe impl Send for SharedWords {}
// SAFETY: as above.
unsafe impl Sync for SharedWords {}

impl SharedWords {
    /// Makes the file with `count` words, all zero; fails when it exists.
    pub fn create(path: &Path, count: usize) -> io::Result<Self> {
        let file = OpenOptions::new().read(true).write(true).create_new(true).mode(0o600).open(path)?;
        file.set_len((count * size_of::<AtomicU32>()) as u64)?;
        Self::map(&file, count)
    }

    /// Maps a file that [`create`](Self::create) made.
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().read(true).write(true).open(path)?;
        let count = usize::try_from(file.metadata()?.len()).unwrap_or(0) / size_of::<AtomicU32>();
        Self::map(&file, count)
    }

    fn map(file: &File, count: usize) -> io::Result<Self> {
        if count == 0 {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "the file is empty"));
        }
        // SAFETY: a fresh mapping at an address that the kernel chooses aliases no Rust object.
        let start = unsafe {
            rustix::mm::mmap(
                std::ptr::null_mut(),
                count * size_of::<AtomicU32>(),
                ProtFlags::READ | ProtFlags::WRITE,
                MapFlags::SHARED,
                file,
                0,
            )
        }?;
        let start = NonNull::new(start.cast()).ok_or(io::ErrorKind::AddrNotAvailable)?;
        Ok(Self { start, count })
    }

    /// The words, as all processes see them.
    pub fn words(&self) -> &[AtomicU32] {
        // SAFETY: the mapping is page-aligned, `count` words long, readable and writable until `drop`, and any bits are a
        // valid `AtomicU32`. Every process of a run accesses it through atomics only; the run's folder is private
        // (0700) and nobody truncates the file.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr(), self.count) }
    }
}

impl Drop for SharedWords {
    fn drop(&mut self) {
        // SAFETY: exactly the range that `map` mapped; the borrow of `words` cannot outlive `self`.
        let unmapped =
            unsafe { rustix::mm::munmap(self.start.as_ptr().cast(), self.count * size_of::<AtomicU32>()) };
        debug_assert!(unmapped.is_ok());
    }
}

/// How a sleep ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slept {
    /// Somebody woke the sleeper, or there was no need to sleep, or no reason at all.
    Woken,
    /// The time was over.
    Out,
}

/// Sleeps while `word` is `value`, at most for `limit` if there is one, and is woken by [`wake_these`] if that names a bit of `bits`. May
/// also return early: look again.
pub fn sleep_as(word: &AtomicU32, value: u32, bits: u32, limit: Option<Duration>) -> io::Result<Slept> {
    let bits = NonZeroU32::new(bits).ok_or(io::ErrorKind::InvalidInput)?;
    if word.load(Ordering::Acquire) != value {
        return Ok(Slept::Woken);
    }
    let now = || rustix::time::clock_gettime(rustix::time::ClockId::Monotonic);
    let deadline = limit.and_then(|limit| timespec(limit).checked_add(now()));
    match futex::wait_bitset(word, futex::Flags::empty(), value, deadline.as_ref(), bits) {
        Ok(()) | Err(rustix::io::Errno::AGAIN | rustix::io::Errno::INTR) => Ok(Slept::Woken),
        Err(rustix::io::Errno::TIMEDOUT) => Ok(Slept::Out),
        Err(error) => Err(error.into()),
    }
}

/// Wakes those who sleep on `word` as one of `bits`, in all processes.
pub fn wake_these(word: &AtomicU32, bits: u32) -> io::Result<()> {
    let Some(bits) = NonZeroU32::new(bits) else { return Ok(()) };
    futex::wake_bitset(word, futex::Flags::empty(), i32::MAX as u32, bits)?;
    Ok(())
}

/// Sleeps while `word` is `value`, at most for `limit`. May also return early: look again.
pub fn sleep_on(word: &AtomicU32, value: u32, limit: Duration) -> io::Result<()> {
    if word.load(Ordering::Acquire) != value {
        return Ok(());
    }
    match futex::wait(word, futex::Flags::empty(), value, Some(&timespec(limit))) {
        Ok(()) | Err(rustix::io::Errno::AGAIN | rustix::io::Errno::INTR | rustix::io::Errno::TIMEDOUT) => {
            Ok(())
        }
        Err(error) => Err(error.into()),
    }
}

/// Wakes everyone who sleeps on `word`, in all processes.
pub fn wake_all(word: &AtomicU32) -> io::Result<()> {
    futex::wake(word, futex::Flags::empty(), i32::MAX as u32)?;
    Ok(())
}

fn timespec(duration: Duration) -> Timespec {
    Timespec {
        tv_sec: duration.as_secs().try_into().unwrap_or(i64::MAX),
        tv_nsec: duration.subsec_nanos().into(),
    }
}

/// A handle on a process that stays on it even when its number is used again.
#[derive(Debug)]
pub struct Process(pub(crate) OwnedFd);

impl Process {
    /// The process `pid`; `None` when there is none.
    pub fn open(pid: u32) -> io::Result<Option<Self>> {
        let Some(pid) = i32::try_from(pid).ok().and_then(Pid::from_raw) else { return Ok(None) };
        match rustix::process::pidfd_open(pid, PidfdFlags::empty()) {
            Ok(descriptor) => Ok(Some(Self(descriptor))),
            Err(rustix::io::Errno::SRCH) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// Whether it has ended, reaped or not.
    pub fn has_ended(&self) -> io::Result<bool> {
        let mut poll = [PollFd::new(&self.0, PollFlags::IN)];
        match rustix::event::poll(&mut poll, Some(&timespec(Duration::ZERO))) {
            Ok(ready) => Ok(ready > 0),
            Err(rustix::io::Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }
}

/// Has the kernel kill this process when its parent's thread that started it ends. Call it first thing in the child.
///
/// Returns `false` when `parent` is already gone: end at once.
pub fn end_with_parent(parent: u32) -> io::Result<bool> {
    rustix::process::set_parent_process_death_signal(Some(Signal::KILL))?;
    let now = rustix::process::getppid().map_or(0, Pid::as_raw_pid);
    Ok(u32::try_from(now) == Ok(parent))
}

/// Keeps the descriptors that this process has open now, but for the standard three, from the processes that it starts.
///
/// iceoryx2 leaves some of its files open for them: a hundred in each of a thousand AUVs.
pub fn keep_descriptors_from_children() -> io::Result<()> {
    let listed = std::fs::read_dir("/proc/self/fd")?.flatten();
    let open: Vec<RawFd> = listed.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).collect();
    for descriptor in open.into_iter().filter(|descriptor| *descriptor > 2) {
        // SAFETY: the number was open a moment ago and is only borrowed for the two calls below, which change no data. If
        // another thread has closed it in between they fail, and if it has opened another file by that number, that
        // file is close-on-exec already, as all that Rust opens.
        let descriptor = unsafe { BorrowedFd::borrow_raw(descriptor) };
        if let Ok(flags) = rustix::io::fcntl_getfd(descriptor) {
            let _closed_meanwhile = rustix::io::fcntl_setfd(descriptor, flags | rustix::io::FdFlags::CLOEXEC);
        }
    }
    Ok(())
}

/// Raises the soft limit of open descriptors to the hard one, and returns it (`None`: no limit).
pub fn raise_descriptor_limit() -> io::Result<Option<u64>> {
    let limit = rustix::process::getrlimit(Resource::Nofile);
    if limit.current != limit.maximum {
        rustix::process::setrlimit(Resource::Nofile, Rlimit { current: limit.maximum, ..limit })?;
    }
    Ok(limit.maximum)
}

/// Lets other processes of this machine go first, from now on.
pub fn give_way() -> io::Result<()> {
    /// The greatest niceness there is.
    const LEAST_URGENT: i32 = 19;
    rustix::process::nice(LEAST_URGENT)?;
    Ok(())
}
