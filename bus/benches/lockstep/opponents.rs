//! What a lockstep of processes costs at least on this machine: the same rounds, the same bytes, nobody reads them.

use std::os::fd::{AsFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use rustix::event::epoll;
use rustix::net::{AddressFamily, SocketFlags, SocketType, socketpair};
use rustix::thread::futex;
use shoal_bus::os::{SharedWords, end_with_parent};

const OPPONENT: &str = "SHOAL_BENCH_OPPONENT";
const PARENT: &str = "SHOAL_BENCH_PARENT";

const BELL: usize = 0;
const LEFT: usize = 16;
const SLOTS: usize = 32;

/// How many bytes each process gets and gives in a round.
#[derive(Clone, Copy)]
pub struct Sizes {
    pub down: usize,
    pub up: usize,
}

/// Takes part in rounds until killed, if this process was started for that.
pub fn be_one_if_asked() {
    let Ok(words) = std::env::var(OPPONENT) else { return };
    let parent = std::env::var(PARENT).unwrap().parse().unwrap();
    if !end_with_parent(parent).unwrap() {
        std::process::exit(0);
    }
    let words: Vec<&str> = words.split(' ').collect();
    let number = |at: usize| words[at].parse::<usize>().unwrap();
    match words[0] {
        "raw" => answer_raw(Path::new(words[4]), number(1), Sizes { down: number(2), up: number(3) }),
        _ => answer_packets(Sizes { down: number(2), up: number(3) }),
    }
}

fn start(words: &str, stdin: Stdio) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env(OPPONENT, words).env(PARENT, std::process::id().to_string());
    command.stdin(stdin).stdout(Stdio::null()).spawn().unwrap()
}

struct Children(Vec<Child>);

impl Drop for Children {
    fn drop(&mut self) {
        self.0.iter_mut().for_each(|child| child.kill().unwrap());
        for child in &mut self.0 {
            child.wait().unwrap();
        }
    }
}

/// Shared memory and one futex that wakes everyone.
pub struct Raw {
    _children: Children,
    shared: SharedWords,
    sizes: Sizes,
    count: usize,
    bytes: Vec<u32>,
}

impl Raw {
    pub fn new(path: PathBuf, count: usize, sizes: Sizes) -> Self {
        let shared = SharedWords::create(&path, SLOTS + count * slot(sizes)).unwrap();
        shared.words()[LEFT].store(count as u32, Ordering::SeqCst);
        let one = |index| {
            let words = format!("raw {index} {} {} {}", sizes.down, sizes.up, path.display());
            start(&words, Stdio::null())
        };
        let children = Children((0..count).map(one).collect());
        let mut raw = Self { _children: children, shared, sizes, count, bytes: Vec::new() };
        raw.await_all();
        raw
    }

    fn await_all(&mut self) {
        loop {
            match self.shared.words()[LEFT].load(Ordering::Acquire) {
                0 => return,
                left => sleep(&self.shared.words()[LEFT], left),
            }
        }
    }

    pub fn round(&mut self) {
        let words = self.shared.words();
        for index in 0..self.count {
            let start = SLOTS + index * slot(self.sizes);
            let down = &words[start..][..self.sizes.down.div_ceil(4)];
            down.iter().zip(1..).for_each(|(word, value)| word.store(value, Ordering::Relaxed));
        }
        words[LEFT].store(self.count as u32, Ordering::Relaxed);
        words[BELL].fetch_add(1, Ordering::SeqCst);
        futex::wake(&words[BELL], futex::Flags::empty(), i32::MAX as u32).unwrap();
        self.await_all();
        let words = self.shared.words();
        for index in 0..self.count {
            let start = SLOTS + index * slot(self.sizes) + self.sizes.down.div_ceil(4);
            let up = &words[start..][..self.sizes.up.div_ceil(4)];
            self.bytes.clear();
            self.bytes.extend(up.iter().map(|word| word.load(Ordering::Relaxed)));
            std::hint::black_box(&self.bytes);
        }
    }
}

fn slot(sizes: Sizes) -> usize {
    (sizes.down.div_ceil(4) + sizes.up.div_ceil(4)).next_multiple_of(16)
}

fn sleep(word: &AtomicU32, value: u32) {
    // Woken, changed or interrupted: whoever sleeps looks again.
    let _early = futex::wait(word, futex::Flags::empty(), value, None);
}

fn answer_raw(path: &Path, index: usize, sizes: Sizes) -> ! {
    let shared = SharedWords::open(path).unwrap();
    let words = shared.words();
    let (down, up) = words[SLOTS + index * slot(sizes)..][..slot(sizes)].split_at(sizes.down.div_ceil(4));
    let mut bytes = Vec::new();
    let mut bell = words[BELL].load(Ordering::Acquire);
    loop {
        let left = words[LEFT].fetch_sub(1, Ordering::AcqRel);
        // Only the last wakes; while all start, the first one waits for each.
        if left == 1 {
            futex::wake(&words[LEFT], futex::Flags::empty(), 1).unwrap();
        }
        while words[BELL].load(Ordering::Acquire) == bell {
            sleep(&words[BELL], bell);
        }
        bell = bell.wrapping_add(1);
        bytes.clear();
        bytes.extend(down.iter().map(|word| word.load(Ordering::Relaxed)));
        std::hint::black_box(&bytes);
        up[..sizes.up.div_ceil(4)]
            .iter()
            .zip(1..)
            .for_each(|(word, value)| word.store(value, Ordering::Relaxed));
    }
}

/// A Unix socket of whole packets for each process, and epoll.
pub struct Packets {
    _children: Children,
    sockets: Vec<OwnedFd>,
    epoll: OwnedFd,
    sizes: Sizes,
}

impl Packets {
    pub fn new(count: usize, sizes: Sizes) -> Self {
        let epoll = epoll::create(epoll::CreateFlags::CLOEXEC).unwrap();
        let mut children = Vec::new();
        let mut sockets = Vec::new();
        for index in 0..count {
            let (ours, theirs) =
                socketpair(AddressFamily::UNIX, SocketType::SEQPACKET, SocketFlags::CLOEXEC, None).unwrap();
            let data = epoll::EventData::new_u64(index as u64);
            epoll::add(&epoll, &ours, data, epoll::EventFlags::IN).unwrap();
            children
                .push(start(&format!("packets {index} {} {}", sizes.down, sizes.up), Stdio::from(theirs)));
            sockets.push(ours);
        }
        let mut packets = Self { _children: Children(children), sockets, epoll, sizes };
        packets.round();
        packets
    }

    pub fn round(&mut self) {
        let mut bytes = vec![7; self.sizes.down.max(self.sizes.up)];
        for socket in &self.sockets {
            assert_eq!(rustix::io::write(socket, &bytes[..self.sizes.down]).unwrap(), self.sizes.down);
        }
        let mut left = self.sockets.len();
        let mut events = Vec::with_capacity(256);
        while left > 0 {
            events.clear();
            epoll::wait(&self.epoll, rustix::buffer::spare_capacity(&mut events), None).unwrap();
            for event in &events {
                let socket = &self.sockets[event.data.u64() as usize];
                assert_eq!(rustix::io::read(socket, &mut bytes).unwrap(), self.sizes.up);
                left -= 1;
            }
        }
    }
}

fn answer_packets(sizes: Sizes) -> ! {
    let stdin = std::io::stdin();
    let socket = stdin.as_fd();
    let mut bytes = vec![7; sizes.down.max(sizes.up)];
    while rustix::io::read(socket, &mut bytes).is_ok_and(|read| read == sizes.down) {
        rustix::io::write(socket, &bytes[..sizes.up]).unwrap();
    }
    std::process::exit(0)
}
