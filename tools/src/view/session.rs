//! One page: what it asks for, and what it is told.
//!
//! The page is told who takes part (`{"cast": ...}`), and whenever there is more, how far the store has come (`{"reached": ...}`). It asks for
//! the scene of a second (`{"scene": 12}`) or what is known of an AUV from a second on (`{"track": 7, "from": 0}`), and gets
//! bytes: `u32` 1, the second asked for, and the scene; or `u32` 2, the AUV, parts, rows, then of each part the second and its
//! fates, and then the rows.

use std::io;
use std::net::TcpStream;
use std::time::Duration;

use serde::Deserialize;
use serde_json::json;
use tungstenite::{Error, Message, WebSocket};

use super::cast::Cast;
use super::chunk::{ROW_BYTES, TrackPart};
use super::store::{Reached, Store};

/// How often a page is told how far it is.
const NEWS: Duration = Duration::from_millis(100);

/// What a page asks for.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Ask {
    Scene { scene: u32 },
    Track { track: u32, from: u32 },
}

/// Serves one page until it goes away.
pub fn hold(mut socket: WebSocket<TcpStream>, cast: &Cast, store: &Store) -> Result<(), Error> {
    socket.get_ref().set_read_timeout(Some(NEWS)).map_err(Error::Io)?;
    socket.send(Message::text(json!({ "cast": cast }).to_string()))?;
    // What the page was told last, without the lines about seconds.
    let mut told = None;
    loop {
        let mut reached = store.reached(told.as_ref().map_or(0, |told: &Reached| told.end));
        let message = reached.message();
        reached.figures.clear();
        if told.as_ref() != Some(&reached) {
            told = Some(reached);
            socket.send(Message::text(message))?;
        }
        match socket.read() {
            Ok(Message::Text(text)) => {
                // What it does not understand it does not answer: a page of another version is not served by this one.
                if let Ok(ask) = serde_json::from_str(&text)
                    && let Some(bytes) = answered(&ask, cast, store).map_err(Error::Io)?
                {
                    socket.send(Message::binary(bytes))?;
                }
            }
            Ok(Message::Close(_)) => return Ok(()),
            Ok(_) => {}
            Err(Error::Io(error)) if is_quiet(&error) => {}
            Err(Error::ConnectionClosed | Error::AlreadyClosed) => return Ok(()),
            Err(error) => return Err(error),
        }
    }
}

impl Reached {
    /// As the page is told. The lines are JSON already.
    pub fn message(&self) -> String {
        let Self { figures, first, end, done, note } = self;
        let note = json!(note);
        let figures = figures.join(",");
        format!(
            r#"{{"reached":{{"first":{first},"end":{end},"done":{done},"note":{note},"figures":[{figures}]}}}}"#
        )
    }
}

fn answered(ask: &Ask, cast: &Cast, store: &Store) -> io::Result<Option<Vec<u8>>> {
    match *ask {
        Ask::Scene { scene } => Ok(store.scene(scene)?.map(|bytes| scene_message(scene, &bytes))),
        Ask::Track { track, from } => match usize::try_from(track) {
            Ok(auv) if auv < cast.auvs() => {
                Ok(Some(track_message(track, &store.track(auv, cast.auvs(), from)?)))
            }
            _ => Ok(None),
        },
    }
}

fn scene_message(second: u32, scene: &[u8]) -> Vec<u8> {
    [1, second].into_iter().flat_map(u32::to_le_bytes).chain(scene.iter().copied()).collect()
}

fn track_message(auv: u32, parts: &[(u32, TrackPart)]) -> Vec<u8> {
    let rows = parts.iter().map(|(_, part)| part.rows.len() / ROW_BYTES).sum::<usize>();
    let count = |of: usize| u32::try_from(of).unwrap_or(u32::MAX);
    let head = [2, auv, count(parts.len()), count(rows)];
    let mut bytes: Vec<u8> = head.into_iter().flat_map(u32::to_le_bytes).collect();
    for (second, part) in parts {
        bytes.extend(second.to_le_bytes());
        bytes.extend(&part.fates);
    }
    parts.iter().for_each(|(_, part)| bytes.extend(&part.rows));
    bytes
}

fn is_quiet(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted)
}

#[cfg(test)]
mod tests;
