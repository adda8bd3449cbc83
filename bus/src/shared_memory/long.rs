//! Messages that are too long for a lane: the lane says how long, and a file of the run holds them.

use std::fs::File;
use std::io::{self, Read};
use std::sync::atomic::Ordering;

use super::arena::Lane;
use crate::codec::MESSAGE_LIMIT_BYTES;
use crate::message::AuvId;
use crate::run_dir::RunDir;

/// Which way a message goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Down,
    Up,
}

/// Writes a message of any length and gives it its number.
pub(super) fn send(
    lane: Lane<'_>,
    run: &RunDir,
    way: Way,
    auv: AuvId,
    sequence: u32,
    message: &[u8],
) -> io::Result<()> {
    let too_long = || io::Error::new(io::ErrorKind::InvalidInput, "a message is longer than 64 MiB");
    if message.len() > MESSAGE_LIMIT_BYTES {
        return Err(too_long());
    }
    match message.len() <= lane.capacity() {
        true => lane.write(message),
        false => std::fs::write(run.long_message(way == Way::Up, auv), message)?,
    }
    lane.length.store(message.len() as u32, Ordering::Relaxed);
    lane.sequence.store(sequence, Ordering::Release);
    Ok(())
}

/// Copies out the message whose number was just read. `None`: there is none of the length that its sender claims.
pub(super) fn receive(
    lane: Lane<'_>,
    run: &RunDir,
    way: Way,
    auv: AuvId,
    message: &mut Vec<u8>,
) -> Option<()> {
    let length = lane.length.load(Ordering::Relaxed) as usize;
    if length <= lane.capacity() {
        lane.read(length, message);
        return Some(());
    }
    let file =
        File::open(run.long_message(way == Way::Up, auv)).ok().filter(|_| length <= MESSAGE_LIMIT_BYTES)?;
    message.clear();
    file.take(length as u64 + 1).read_to_end(message).ok()?;
    (message.len() == length).then_some(())
}
