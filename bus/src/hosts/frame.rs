//! Frames, and the numbers by which what a link loses is noticed and sent again.

use zenoh::bytes::ZBytes;

const HEADER: usize = 9;

/// What travels in one payload once a host is welcome.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Frame<'a> {
    /// The message of this number. The numbers of one direction grow by one.
    Message(u64, &'a [u8]),
    /// I am here, and my last message has this number.
    Beat(u64),
    /// Send the message of this number again.
    Again(u64),
    /// You are given up, for this reason.
    Dismissal(&'a str),
}

impl<'a> Frame<'a> {
    pub(super) fn write(&self) -> Vec<u8> {
        let (kind, number, rest): (u8, u64, &[u8]) = match self {
            Self::Message(number, body) => (0, *number, body),
            Self::Beat(number) => (1, *number, &[]),
            Self::Again(number) => (2, *number, &[]),
            Self::Dismissal(reason) => (3, 0, reason.as_bytes()),
        };
        let mut bytes = Vec::with_capacity(HEADER + rest.len());
        bytes.push(kind);
        bytes.extend(number.to_le_bytes());
        bytes.extend_from_slice(rest);
        bytes
    }

    /// Takes a frame apart; `None` for bytes that are none.
    pub(super) fn read(bytes: &'a [u8]) -> Option<Self> {
        let (kind, rest) = bytes.split_first()?;
        let (number, rest) = rest.split_first_chunk()?;
        let number = u64::from_le_bytes(*number);
        match (kind, rest) {
            (0, body) => Some(Self::Message(number, body)),
            (1, []) => Some(Self::Beat(number)),
            (2, []) => Some(Self::Again(number)),
            (3, reason) => Some(Self::Dismissal(str::from_utf8(reason).ok()?)),
            _ => None,
        }
    }
}

/// One end of a line that may lose, repeat and delay whatever it carries: a message is heard once, or not yet.
///
/// Each end keeps its last message. In lockstep that is all that can be missing: neither end says the next thing before it
/// has heard the answer to the last, but for the end of the run, which makes up for whatever came before it.
#[derive(Debug, Default)]
pub(super) struct Line {
    sent: u64,
    received: u64,
    last: ZBytes,
}

/// What a frame means to who got it.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Heard<'a> {
    /// A message that was not heard before.
    Message(&'a [u8]),
    /// This is to be sent in return.
    Reply(ZBytes),
    /// The other end has given this one up.
    Dismissed(&'a str),
    /// Nothing new.
    Nothing,
}

impl Line {
    /// The frame of the next message; the first byte of its body is `tag`, `fill` writes the rest.
    pub(super) fn next(&mut self, tag: u8, fill: impl FnOnce(&mut Vec<u8>)) -> ZBytes {
        self.sent += 1;
        let mut bytes = Frame::Message(self.sent, &[tag]).write();
        fill(&mut bytes);
        self.last = bytes.into();
        self.last.clone()
    }

    /// Number of the last message sent.
    pub(super) fn sent(&self) -> u64 {
        self.sent
    }

    /// Takes in a frame.
    pub(super) fn take<'a>(&mut self, bytes: &'a [u8]) -> Heard<'a> {
        match Frame::read(bytes) {
            Some(Frame::Message(number, body)) if number > self.received => {
                self.received = number;
                Heard::Message(body)
            }
            Some(Frame::Beat(number)) if number > self.received => {
                Heard::Reply(Frame::Again(number).write().into())
            }
            Some(Frame::Again(number)) if number == self.sent && number > 0 => {
                Heard::Reply(self.last.clone())
            }
            Some(Frame::Dismissal(reason)) => Heard::Dismissed(reason),
            // Repeated, overtaken, or no frame at all.
            _ => Heard::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn frames_come_back() {
        for frame in [
            Frame::Message(1 << 40, b"body"),
            Frame::Message(1, b""),
            Frame::Beat(7),
            Frame::Again(9),
            Frame::Dismissal("silent"),
        ] {
            let bytes = frame.write();
            assert_eq!(Frame::read(&bytes), Some(frame));
            (0..HEADER).for_each(|length| assert_eq!(Frame::read(&bytes[..length]), None));
        }
        assert_eq!(Frame::read(&[9; 40]), None);
        assert_eq!(Frame::read(&[1; 40]), None);
    }

    /// What becomes of a frame on its way.
    #[derive(Clone, Copy, Debug)]
    enum Luck {
        Arrives,
        IsLost,
        ArrivesTwice,
        /// Only after whatever is sent next.
        IsLate,
    }

    fn luck() -> impl Strategy<Value = Luck> {
        prop_oneof![
            3 => Just(Luck::Arrives),
            2 => Just(Luck::IsLost),
            1 => Just(Luck::ArrivesTwice),
            1 => Just(Luck::IsLate)
        ]
    }

    /// Both ends of a lockstep over a line of this luck: the first asks, the second answers with the same bytes.
    fn converse(mut luck: impl Iterator<Item = Luck>, rounds: u8) -> Vec<u8> {
        let (mut asks, mut answers) = (Line::default(), Line::default());
        let (mut down, mut up): (Vec<ZBytes>, Vec<ZBytes>) = (Vec::new(), Vec::new());
        let mut post = |way: &mut Vec<ZBytes>, frame: ZBytes| match luck.next().unwrap_or(Luck::Arrives) {
            Luck::Arrives => way.push(frame),
            Luck::IsLost => {}
            Luck::ArrivesTwice => way.extend([frame.clone(), frame]),
            Luck::IsLate => way.insert(0, frame),
        };
        let mut heard = Vec::new();
        let mut asked = 0;
        let mut answered = 0;
        let mut beats = 0;
        while heard.len() < usize::from(rounds) {
            beats += 1;
            assert!(beats < 10_000, "the conversation is stuck");
            if asked == heard.len() {
                asked += 1;
                let number = asked as u8;
                post(&mut down, asks.next(number, |_| {}));
            }
            post(&mut down, Frame::Beat(asks.sent()).write().into());
            post(&mut up, Frame::Beat(answers.sent()).write().into());
            while let Some(frame) = (!down.is_empty()).then(|| down.remove(0)) {
                match answers.take(&frame.to_bytes()) {
                    Heard::Message(body) => {
                        answered += 1;
                        assert_eq!(body, [answered]);
                        let body = body.to_vec();
                        post(&mut up, answers.next(body[0], |_| {}));
                    }
                    Heard::Reply(frame) => post(&mut up, frame),
                    _ => {}
                }
            }
            while let Some(frame) = (!up.is_empty()).then(|| up.remove(0)) {
                match asks.take(&frame.to_bytes()) {
                    Heard::Message(body) => heard.extend(body),
                    Heard::Reply(frame) => post(&mut down, frame),
                    _ => {}
                }
            }
        }
        heard
    }

    proptest! {
        #[test]
        fn every_message_is_heard_once_and_in_order(luck in prop::collection::vec(luck(), 0..400)) {
            prop_assert_eq!(converse(luck.into_iter(), 20), (1..=20).collect::<Vec<u8>>());
        }
    }

    #[test]
    fn the_last_message_is_sent_again_to_who_asks() {
        let mut line = Line::default();
        assert_eq!(line.take(&Frame::Again(0).write()), Heard::Nothing);
        let first = line.next(5, |bytes| bytes.push(6));
        assert_eq!(line.take(&Frame::Again(1).write()), Heard::Reply(first));
        line.next(7, |_| {});
        assert_eq!(line.take(&Frame::Again(1).write()), Heard::Nothing);
        // The end of a run is heard by who missed the window before it.
        assert_eq!(line.take(&Frame::Message(4, b"end").write()), Heard::Message(b"end"));
        assert_eq!(line.take(&Frame::Message(3, b"window").write()), Heard::Nothing);
        assert_eq!(line.take(&Frame::Dismissal("silent").write()), Heard::Dismissed("silent"));
    }
}
