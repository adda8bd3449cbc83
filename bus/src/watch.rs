//! Notices the end of processes at once.

use std::io;
use std::sync::Arc;
use std::sync::Mutex;
use std::thread::JoinHandle;

use rustix::event::epoll;
use rustix::event::{EventfdFlags, eventfd};
use rustix::fd::OwnedFd;

use crate::message::AuvId;
use crate::os::Process;

/// Tells of each attached process that ends, once, from a thread of its own.
pub(crate) struct Watch {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    epoll: OwnedFd,
    stop: OwnedFd,
    attached: Mutex<Vec<(Vec<AuvId>, Option<Process>)>>,
    ended: Box<dyn Fn(AuvId) + Send + Sync>,
}

/// The epoll key of `stop`; those of processes are indices of `attached`.
const STOP: u64 = u64::MAX;

impl Watch {
    /// Calls `ended` for every attached process that ends.
    pub(crate) fn new(ended: impl Fn(AuvId) + Send + Sync + 'static) -> io::Result<Self> {
        let epoll = epoll::create(epoll::CreateFlags::CLOEXEC)?;
        let stop = eventfd(0, EventfdFlags::CLOEXEC)?;
        epoll::add(&epoll, &stop, epoll::EventData::new_u64(STOP), epoll::EventFlags::IN)?;
        let shared = Arc::new(Shared { epoll, stop, attached: Mutex::default(), ended: Box::new(ended) });
        let watching = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("watch".into()).spawn(move || watching.run())?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Watches the processes of these AUVs; those that share one are next to each other.
    pub(crate) fn attach(&self, processes: &[(AuvId, u32)]) -> io::Result<()> {
        for together in processes.chunk_by(|(_, one), (_, next)| one == next) {
            let (Some((_, pid)), auvs) = (together.first(), together.iter().map(|(auv, _)| *auv)) else {
                continue;
            };
            let Some(process) = Process::open(*pid)? else {
                auvs.for_each(&self.shared.ended);
                continue;
            };
            let mut attached = self.shared.attached.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let key = epoll::EventData::new_u64(attached.len() as u64);
            epoll::add(&self.shared.epoll, &process.0, key, epoll::EventFlags::IN)?;
            attached.push((auvs.collect(), Some(process)));
        }
        Ok(())
    }
}

impl Shared {
    fn run(&self) {
        let mut events = Vec::with_capacity(64);
        loop {
            events.clear();
            match epoll::wait(&self.epoll, rustix::buffer::spare_capacity(&mut events), None) {
                Ok(_) | Err(rustix::io::Errno::INTR) => {}
                // Nothing can be watched any more; the transports' own limits still hold.
                Err(_) => return,
            }
            for event in &events {
                let key = event.data.u64();
                if key == STOP {
                    return;
                }
                self.end(key as usize);
            }
        }
    }

    fn end(&self, index: usize) {
        let mut attached = self.attached.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let Some((auvs, process)) = attached.get_mut(index) else { return };
        // Closing the descriptor also takes it out of the epoll set.
        if process.take().is_some() {
            let auvs = std::mem::take(auvs);
            drop(attached);
            auvs.into_iter().for_each(&self.ended);
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let told = rustix::io::write(&self.shared.stop, &1u64.to_ne_bytes());
        if let (Ok(_), Some(thread)) = (told, self.thread.take()) {
            let _ended = thread.join();
        }
    }
}
