//! Messages to bytes and back: bincode 2, fixed-width integers, little-endian, behind a format version.
//!
//! Every encoded message starts with [`FORMAT`] as a `u16`; then come the fields in the order of their declaration, enum
//! variants as a `u32` index, sequences and strings behind a `u64` length. Python's `struct` can read all of it.

use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use bincode::enc::write::Writer;
use bincode::error::EncodeError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Version of the messages in this build; both ends must have the same.
pub const FORMAT: u16 = 1;

/// No message is longer, whatever its bytes claim: a bound on what a faulty sender can make the reader allocate.
pub const MESSAGE_LIMIT_BYTES: usize = 64 << 20;

/// Room for most messages, so that their buffer need not grow.
const USUAL_MESSAGE_BYTES: usize = 1024;

const CONFIG: Configuration<LittleEndian, Fixint, Limit<MESSAGE_LIMIT_BYTES>> = bincode::config::standard()
    .with_little_endian()
    .with_fixed_int_encoding()
    .with_limit::<MESSAGE_LIMIT_BYTES>();

/// Why bytes are not a message.
#[derive(Debug, Error)]
pub enum CodecError {
    /// The value cannot be encoded.
    #[error("the message cannot be encoded: {0}")]
    Encode(#[from] bincode::error::EncodeError),
    /// The bytes are not this message.
    #[error("the bytes are not a message of this kind: {0}")]
    Decode(#[from] bincode::error::DecodeError),
    /// The other end speaks another version.
    #[error(
        "the message has format {found}, this build speaks format {FORMAT}: use the same build on both ends"
    )]
    Format {
        /// The version that the message carries.
        found: u16,
    },
    /// Bytes are left over.
    #[error("{extra} bytes are left over after the message")]
    Trailing {
        /// How many.
        extra: usize,
    },
}

/// Encodes `message` behind the format version.
///
/// ```
/// let bytes = shoal_bus::codec::encode(&7u32)?;
/// assert_eq!(bytes, [1, 0, 7, 0, 0, 0]);
/// assert_eq!(shoal_bus::codec::decode::<u32>(&bytes)?, 7);
/// # Ok::<(), shoal_bus::codec::CodecError>(())
/// ```
pub fn encode<T: Serialize>(message: &T) -> Result<Vec<u8>, CodecError> {
    let mut bytes = Vec::with_capacity(USUAL_MESSAGE_BYTES);
    encode_into(message, &mut bytes)?;
    Ok(bytes)
}

/// Appends what [`encode`] makes of `message` to `bytes`.
pub fn encode_into<T: Serialize>(message: &T, bytes: &mut Vec<u8>) -> Result<(), CodecError> {
    bytes.extend(FORMAT.to_le_bytes());
    encode_bare_into(message, bytes)
}

/// Decodes what [`encode`] made; every byte must be used.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, CodecError> {
    let (found, body) = match bytes {
        [low, high, body @ ..] => (u16::from_le_bytes([*low, *high]), body),
        _ => return Err(CodecError::Format { found: 0 }),
    };
    if found != FORMAT {
        return Err(CodecError::Format { found });
    }
    let (message, used) = bincode::serde::decode_from_slice(body, CONFIG)?;
    match body.len() - used {
        0 => Ok(message),
        extra => Err(CodecError::Trailing { extra }),
    }
}

/// Appends `message` to `bytes` without a version: the canonical bytes that a digest hashes.
pub fn encode_bare_into<T: Serialize>(message: &T, bytes: &mut Vec<u8>) -> Result<(), CodecError> {
    Ok(bincode::serde::encode_into_writer(message, Appending(bytes), CONFIG)?)
}

/// Writes at the end of a buffer.
struct Appending<'a>(&'a mut Vec<u8>);

impl Writer for Appending<'_> {
    // Fields are a few bytes each, of known lengths: where that is seen, a field is one store and not a call.
    #[inline]
    fn write(&mut self, bytes: &[u8]) -> Result<(), EncodeError> {
        self.0.extend_from_slice(bytes);
        Ok(())
    }
}
