//! Messages as the transports write and judge them.

use serde::Serialize;

use crate::codec;
use crate::lockstep::FromAuv;
use crate::message::{Acted, Born, Sensed};

/// Encodes to the bytes of the [`ToAuv`](crate::lockstep::ToAuv) of the same name.
#[derive(Serialize)]
pub(crate) enum ToAuvRef<'a> {
    Born(&'a Born),
    Sensed(&'a [Sensed]),
    #[cfg_attr(not(feature = "zenoh"), allow(dead_code, reason = "shared memory tells the end by a flag"))]
    End,
}

impl ToAuvRef<'_> {
    /// How many ticks it asks to be answered.
    #[cfg(feature = "iceoryx2")]
    pub(crate) fn ticks(&self) -> usize {
        match self {
            Self::Sensed(items) => items.len(),
            Self::Born(_) | Self::End => 0,
        }
    }
}

/// Why an AUV that sent garbage is lost.
pub(crate) const NOT_A_MESSAGE: &str = "sent bytes that are not a message";

/// Reads the answers to `ticks` ticks, or says why their sender is lost.
pub(crate) fn read_acted(message: &[u8], ticks: usize) -> Result<Vec<Acted>, String> {
    codec::decode(message).map_err(|_| NOT_A_MESSAGE.to_owned()).and_then(|message| all_ticks(message, ticks))
}

/// The answers, if they are as many as the ticks.
pub(crate) fn all_ticks(message: FromAuv, ticks: usize) -> Result<Vec<Acted>, String> {
    let FromAuv::Acted(acted) = message;
    if acted.len() == ticks { Ok(acted) } else { Err(format!("answered {} of {ticks} ticks", acted.len())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{decode, encode};
    use crate::lockstep::ToAuv;
    use crate::time::LocalTime;

    #[test]
    fn borrowed_messages_decode_as_owned_ones() {
        let sensed = vec![Sensed { tick: 3, stamp: LocalTime::from_ns(9), events: Vec::new() }];
        let bytes = encode(&ToAuvRef::Sensed(&sensed)).unwrap();
        assert_eq!(bytes, encode(&ToAuv::Sensed(sensed.clone())).unwrap());
        assert_eq!(decode::<ToAuv>(&bytes).unwrap(), ToAuv::Sensed(sensed));
        assert_eq!(decode::<ToAuv>(&encode(&ToAuvRef::End).unwrap()).unwrap(), ToAuv::End);
    }

    #[test]
    fn what_is_no_answer_is_a_reason_for_loss() {
        let encode = |message: &FromAuv| encode(message).unwrap();
        assert_eq!(read_acted(&encode(&FromAuv::Acted(Vec::new())), 0), Ok(Vec::new()));
        assert_eq!(read_acted(&encode(&FromAuv::Acted(Vec::new())), 2), Err("answered 0 of 2 ticks".into()));
        for bytes in [&b""[..], b"garbage", &[0xff; 64], &codec::encode(&7u32).unwrap()] {
            assert_eq!(read_acted(bytes, 1), Err(NOT_A_MESSAGE.into()));
        }
    }
}
