//! The protocol between the channel and an AUV's process, for agents in any language.
//!
//! A group of a scenario with `command = ["python3", "agent.py"]` has AUVs that are programs of your own. Shoal starts one process for
//! each, tells it what an AUV is told, lets it sense, and does what it says; nothing else about the run changes. This page is all that it
//! takes to write one; `agents/python` is one. Whatever such a program does costs at most its own AUV its place, with a reason in the
//! summary that says what was wrong and what was expected.
//!
//! 1. [The process](#the-process): how it is started, and how it ends
//! 2. [Zenoh](#zenoh): where messages come and go
//! 3. [Frames](#frames), [hello](#hello) and [the life of an agent](#the-life-of-an-agent)
//! 4. [The two dialects](#the-two-dialects): JSON, or numbers to the byte
//! 5. [Time](#time): ticks, reactions, when pings leave
//! 6. [What an AUV senses](#what-an-auv-senses) and [what it answers](#what-it-answers)
//! 7. [What is promised and what is checked](#what-is-promised-and-what-is-checked)
//! 8. [Messages](#messages), field by field, and [examples](#examples)
//!
//! # The process
//!
//! The command is started once for each AUV of its group, in the folder of the scenario file (for a scenario of the library, in the present
//! folder), so paths in it are relative to that file. A program without a slash in its name is looked for in `PATH`. Each process is told
//! where it belongs by three variables in its environment, and by the same as arguments at the end of the command:
//!
//! | environment | argument | what |
//! |---|---|---|
//! | `SHOAL_ENDPOINT` | `--endpoint` | the zenoh endpoint of the channel, such as `tcp/127.0.0.1:7447` or `unixsock-stream//dev/shm/...` |
//! | `SHOAL_RUN` | `--run` | id of the run: eight hexadecimal digits, a part of every key |
//! | `SHOAL_AUV` | `--auv` | id of the AUV: its number in the scenario, from 0, groups in the order of the file |
//!
//! `ZENOH_RUNTIME` is set too: it holds zenoh to one thread. Standard input is empty; standard output and standard error go to a log of
//! the run. If the AUV is lost, the last line of that log is part of the reason, and the end of the log is shown: the message of an uncaught
//! exception tells what happened. A process that ends is a lost AUV, whatever its exit code, unless it was told to end; its body drifts on
//! and the run does too (or aborts, with `on_crash = "abort"`). The process is killed when the run's launcher dies, and 10 seconds after it was
//! told to end. Close the session in any case, after an exception too: in some languages an open one keeps the process from ending, and a
//! process that neither ends nor answers is waited for. A program that starts others must end them itself: begin shell commands with `exec`.
//!
//! # Zenoh
//!
//! Open one [zenoh](https://zenoh.io) session (1.x) of mode `client` that connects to the endpoint, without scouting. Subscribe to
//! `shoal/RUN/down/AUV`, then publish on `shoal/RUN/up/AUV`, with congestion control `block`: nothing may be dropped. The channel does
//! the same at its end, so nothing is lost while the session lasts. When it is gone (no router is known any more), so is the run: end.
//!
//! # Frames
//!
//! The payload of every message is a short header and a body. All numbers in headers are little-endian.
//!
//! | down: bytes | what | | up: bytes | what |
//! |---|---|---|---|---|
//! | 0-7 | sequence number, `u64` | | 0 | kind, `u8`: 0 hello, 1 received, 2 answer |
//! | 8-... | body: a [`ToAuv`](#toauv) | | 1-8 | sequence number of the frame that it answers, `u64`; any in a hello |
//! | | | | 9-... | body: of a hello [see there](#hello), of an answer a [`FromAuv`](#fromauv), else nothing |
//!
//! Frames down are numbered one by one. A gap means that something is broken: end. The first may have any number.
//!
//! # Hello
//!
//! The body of a hello is JSON in both dialects: the version of the protocol, which is 1, and the dialect, `"json"` or `"binary"`:
//!
//! ```json
//! {"protocol":1,"dialect":"json"}
//! ```
//!
//! An agent whose version the channel does not speak is told `End`, and lost for that reason.
//!
//! # The life of an agent
//!
//! | channel | | agent |
//! |---|---|---|
//! | | ← | hello, again every 100 ms until something comes |
//! | `Born` | → | |
//! | | ← | received, once; a second `Born` of the same number is a copy: ignore it |
//! | `Sensed`: a list of ticks, at least one | → | |
//! | | ← | answer: an `Acted` for each of them, in the same order |
//! | ... | | |
//! | `End` | → | |
//! | | ← | received; then end the process |
//!
//! `End` may come at any time, even instead of `Born`. The channel waits for every answer, however long it takes (after 300 s the run gives up and says
//! for whom): an agent that is slow changes nothing about a run but its pace. A mind that answers from what it was told alone,
//! and not from clocks, threads or chance, makes the run reproducible: the same digest every time, on every bus.
//!
//! # The two dialects
//!
//! Both write the same messages, field by field as [below](#messages).
//!
//! | type | JSON | binary |
//! |---|---|---|
//! | message | its value | [`FORMAT`](crate::codec::FORMAT), 1, as `u16`; then its value |
//! | `u16`, `u32`, `u64`, `i64` | number without fraction; `entropy` needs all 64 bits | so many bits, little-endian |
//! | `u8` | number | one byte |
//! | `f64` | number; read and write it to the last bit (17 digits, or the shortest that come back); what is infinite is `null` | IEEE 754, little-endian |
//! | `bool` | `true`, `false` | one byte, 1 or 0 |
//! | `String` | string | length in bytes as `u64`, UTF-8 |
//! | `Frame`: bytes | string of two hexadecimal digits each | length as `u64`, bytes |
//! | `[T; 3]` | array | the values |
//! | `Vec<T>` | array | length as `u64`, the values |
//! | `Option<T>` | value or `null` | one byte, 0, or 1 and the value |
//! | struct | object; the order is free | its fields in the order below |
//! | enum, variant `A` | `"A"` | number of the variant as `u32` |
//! | enum, variant `A(T)` | `{"A": value}` | the same, then the value |
//! | enum, variant `A` with fields | `{"A": {"field": value, ...}}` | the same, then its fields |
//! | `AuvId` | as `u32` | as `u32` |
//! | `LocalTime` | as `i64` | as `i64`: nanoseconds of the AUV's own clock |
//! | `BoundsBox` | array of three `Bounds`: x, y, z | three `Bounds` |
//!
//! In JSON, fields marked "optional" may be left out of what goes up; unknown fields are refused, so that a slip of the pen is noticed. JSON has neither
//! infinities nor NaN: to bound nothing, state a large number such as `1e300`. Down, only `hearing_range_m` and `gate_sigma` may be infinite.
//! Nothing is lost by JSON: a run has the same digest in either dialect. Take it unless you wake thousands of AUVs; errors then name the field.
//!
//! # Time
//!
//! An AUV knows its own clock alone. Its ticks are at the local times `s_k = first_tick + k * period_ns`, from k = 0 on. At each it is
//! told what happened up to it, and what it answers to tick k takes effect at `s_k + reaction_ns`, on its own clock, exactly: the answer may
//! take as long as it likes. In detail:
//!
//! - The clock h advances by `1 - drift` to `1 + drift` local seconds per true second. Between two local times `ds` apart lie `ds / (1 + drift)` to
//!   `ds / (1 - drift)` true seconds. At birth, true minus local time lies in `offset_s`; true time zero is the start of the run.
//! - A stamp s of an event at true time t says that `h(t)` lies within `stamp_ns` of s. So the time between two stamps is known to `2 * stamp_ns`. A tick is
//!   such an event, too.
//! - A setpoint holds from `s_k + reaction_ns` until the next one does.
//! - A ping booked `at` leaves when the own clock reads that, if `at` is not before `s_k + reaction_ns`; else it is lost (reason `late`) and nobody hears it.
//!   It may be booked by several ticks in advance; booked at the last tick that still may, `at < s_k + reaction_ns + period_ns`, its payload is as fresh as can be.
//!   With `listen_ns` above zero the modem holds it back when it heard something within so long before, and a `Held` is sensed.
//! - A ping is stamped when its beginning arrives, within `timestamp_s` seconds besides the tolerance of the stamp. It is told at the first tick after its
//!   end. With `level = "sea"` a packet takes seconds, so its stamp may be older than the tick before; with `"ideal"` it takes no time.
//!
//! # What an AUV senses
//!
//! Coordinates are x east, y north, z up in metres, the surface is z = 0; headings are counter-clockwise from east, pitch is positive nose up.
//! Each [`Sensed`](#sensed) has the events up to its tick, sorted by stamp, and for equal stamps in the order `Inertial`, `Dvl`, `Depth`,
//! `Gnss`, `Heard`, `Bearing`, `Held`. `Inertial` comes at every tick, others if the AUV has the sensor and it works there. All but
//! `Heard`, `Bearing` and `Held` are stamped with the tick itself and true at it. A `Measured` holds the truth within `value ± error`.
//!
//! The body moves by `dp/dt = v + current + disturbance` per true second, with the velocity through the water `v = speed * (cos(pitch) cos(heading),
//! cos(pitch) sin(heading), sin(pitch))`, `|v| <= speed_m_s`, `|dv/dt| <= acceleration_m_s2`, current and disturbance anywhere in their boxes.
//!
//! What a `frame` holds is whatever its sender sent. Shoal's own AUVs send the 31 bytes of a [`Ping`](crate::ping::Ping), laid out in
//! [`crate::ping`] byte by byte: intervals of the emission's true time and of position and velocity over ground at it, rounded outwards. A ping emitted at
//! true time a from `p_i` arrives at b where `|p_i - p(b)| = c (b - a)`, with c in `sound_speed_m_s`: position and clock of whoever hears it lie
//! on that ring.
//!
//! # What it answers
//!
//! An [`Acted`](#acted) names the tick, a velocity through the water (the body does what it can, and no more than its kind allows), pings, and a
//! report: boxes that hold position and clock at the tick, and everywhere since the tick before (since birth at tick 0).
//!
//! A frame is rounded **outwards**: a lower bound is divided by its unit, a power of two, and rounded down to an integer; the upper bound is rounded up, and
//! their difference is the width. Scaling by a power of two is exact in binary floating point, so what is read holds what was written. Take the least
//! exponent at which all three sides fit. `sequence` counts an AUV's pings modulo 256.
//!
//! # What is promised and what is checked
//!
//! All that an AUV is told at birth and all that it senses keeps its stated bounds, as long as nothing is declared in the scenario to break them (faults,
//! outliers of modems). In turn the channel compares with the truth, and counts as `containment` in the summary:
//!
//! - each report: position and `clock_offset_s` (true time minus the tick's stamp: so include `stamp_ns`) at the tick; `slice` at a moment between the ticks; `around`.
//!   An interval whose bounds are in the wrong order holds nothing. `emptied` says that nothing was left, which counts as a violation too;
//! - each ping when it leaves: emission, position and velocity, and that `sender` is its own. A payload that is no `Ping` is a violation.
//!
//! With `estimator = "ekf"` in its group an AUV promises nothing, and is only measured. Violations cost nothing but the run's exit code, 4.
//! An AUV loses its place, and its process is told `End`, when
//!
//! - its hello has another version or cannot be read, or comes again after its birth;
//! - a frame, its number or its message is not as described, or the answers are not as many as the ticks;
//!
//! and without being told, until the run ends, when
//!
//! - `tick` is not the tick that it was asked;
//! - a component of the setpoint is not finite, or not below 10⁶ m/s;
//! - a ping has more than `frame_bytes` bytes, listens for less than 0 or more than 10 s, or is booked more than a minute (and two periods) ahead;
//! - it books more than 64 pings beyond twice what its `access` would.
//!
//! # Messages
//!
//! Made from the source text of the types; a test keeps it so.
//!
#![doc = include_str!("protocol/messages.md")]
//! # Examples
//!
//! Written by the code that writes them in a run; a test keeps them so.
//!
#![doc = include_str!("protocol/examples.md")]

mod dialect;
mod hello;
mod reason;
#[cfg(test)]
mod tests;

pub use dialect::{Dialect, DialectError};
pub use hello::Hello;

/// Version of the protocol, said in each [`Hello`]; that of the messages.
pub const PROTOCOL: u16 = crate::codec::FORMAT;
