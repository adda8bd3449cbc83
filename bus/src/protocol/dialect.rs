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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::tests::examples::acted;
    use super::*;
    use crate::ping::Frame;

    proptest! {
        /// No bit of a number, and no byte of a frame, is lost in either dialect.
        #[test]
        fn messages_come_back_to_the_bit(
            velocity in prop::array::uniform3(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO),
            bytes in prop::collection::vec(any::<u8>(), 0..=64),
            at in any::<i64>(),
        ) {
            let mut acted = acted();
            acted.setpoint.velocity_m_s = velocity;
            acted.pings[0].frame = Frame::new(&bytes).unwrap();
            acted.pings[0].at = crate::time::LocalTime::from_ns(at);
            let message = FromAuv::Acted(vec![acted.clone()]);
            for dialect in [Dialect::Binary, Dialect::Json] {
                let back = dialect.read_acted(&dialect.write(&message).unwrap(), 1).unwrap();
                prop_assert_eq!(codec::encode(&back).unwrap(), codec::encode(&vec![acted.clone()]).unwrap());
            }
        }

        #[test]
        fn no_bytes_do_harm(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            for dialect in [Dialect::Binary, Dialect::Json] {
                if let Err(reason) = dialect.read_acted(&bytes, 1) {
                    prop_assert!(reason.len() < 2_000 && !reason.contains('\n'));
                }
            }
        }
    }

    #[test]
    fn a_slip_is_named() {
        let text = String::from_utf8(Dialect::Json.write(&FromAuv::Acted(vec![acted()])).unwrap()).unwrap();
        let refused = |from: &str, to: &str, said: &str| {
            assert!(text.contains(from), "{text}");
            let error = Dialect::Json.read_acted(text.replacen(from, to, 1).as_bytes(), 1).unwrap_err();
            assert!(error.starts_with(NOT_A_MESSAGE) && error.contains(said), "{error}");
        };
        refused("\"report\":{\"position_m\"", "\"report\":{\"positoin_m\"", "unknown field `positoin_m`");
        refused("\"velocity_m_s\":[0.5,1.25,-0.5]", "\"velocity_m_s\":[0.5,1.25]", "array of length 3");
        refused("\"velocity_m_s\":[0.5,", "\"velocity_m_s\":[1e999,", "number out of range");
        refused("\"velocity_m_s\":[0.5,", "\"velocity_m_s\":[NaN,", "at ...");
        refused("\"tick\":8,", "\"tick\":8.5,", "expected u64");
        refused("\"tick\":8,", "", "missing field `tick`");
        refused("\"frame\":\"4", "\"frame\":\"x", "two hexadecimal digits");
        // What nobody needs to say may be left out.
        let report = text.find(",\"emptied\"").unwrap();
        let brief = format!("{}}}}}]}}", &text[..report]);
        assert_eq!(Dialect::Json.read_acted(brief.as_bytes(), 1).unwrap()[0].report.components, 1);
    }
}
