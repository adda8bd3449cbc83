//! How messages are written: to the byte or as text, the same messages.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::reason::{brief, shown};
use crate::codec::{self, CodecError, MESSAGE_LIMIT_BYTES};
use crate::lockstep::FromAuv;
use crate::message::Acted;
use crate::wire::{NOT_A_MESSAGE, all_ticks};

/// How the bodies of messages are written, both ways; see [the two dialects](super#the-two-dialects).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dialect {
    /// Fixed-width little-endian numbers, field after field: what Shoal's own AUVs speak.
    #[default]
    Binary,
    /// JSON: every field has its name, and errors name the field.
    Json,
}

/// Why a message cannot be written.
#[derive(Debug, Error)]
pub enum DialectError {
    /// Not in binary.
    #[error(transparent)]
    Binary(#[from] CodecError),
    /// Not as JSON.
    #[error("the message cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl Dialect {
    /// The body of a message. In JSON, what is infinite becomes `null`.
    ///
    /// # Errors
    /// [`DialectError`] when the message is too large.
    ///
    /// ```
    /// use shoal_bus::lockstep::ToAuv;
    /// use shoal_bus::protocol::Dialect;
    /// assert_eq!(Dialect::Json.write(&ToAuv::End)?, b"\"End\"");
    /// assert_eq!(Dialect::Binary.write(&ToAuv::End)?, [1, 0, 2, 0, 0, 0]);
    /// # Ok::<(), shoal_bus::protocol::DialectError>(())
    /// ```
    pub fn write<T: Serialize>(self, message: &T) -> Result<Vec<u8>, DialectError> {
        match self {
            Self::Binary => Ok(codec::encode(message)?),
            Self::Json => Ok(serde_json::to_vec(message)?),
        }
    }

    /// Reads the answers to `ticks` ticks.
    ///
    /// # Errors
    /// A clause that says why their sender is lost, and in JSON where.
    pub fn read_acted(self, body: &[u8], ticks: usize) -> Result<Vec<Acted>, String> {
        let message: FromAuv = match self {
            Self::Binary => {
                codec::decode(body).map_err(|error| format!("{NOT_A_MESSAGE}: {}", brief(&error.to_string())))
            }
            Self::Json if body.len() > MESSAGE_LIMIT_BYTES => {
                Err(format!("{NOT_A_MESSAGE}: {} bytes are too many", body.len()))
            }
            Self::Json => serde_json::from_slice(body)
                .map_err(|error| format!("{NOT_A_MESSAGE}: {}", shown(&error, body))),
        }?;
        all_ticks(message, ticks)
    }
}
