//! How an AUV's process introduces itself.

use serde::{Deserialize, Serialize};

use super::reason::shown;
use super::{Dialect, PROTOCOL};

/// What a [hello](super#hello) says: always JSON, so that every version can read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// Version of the protocol that the agent speaks: [`PROTOCOL`].
    pub protocol: u64,
    /// How it wants messages written, both ways.
    pub dialect: Dialect,
}

/// What is read of a hello before anything else: later versions may say more, or say it otherwise.
#[derive(Deserialize)]
struct Version {
    protocol: u64,
}

impl Hello {
    /// The hello of an agent that speaks this version.
    ///
    /// ```
    /// use shoal_bus::protocol::{Dialect, Hello};
    /// assert_eq!(Hello::new(Dialect::Json).write(), br#"{"protocol":1,"dialect":"json"}"#);
    /// ```
    pub fn new(dialect: Dialect) -> Self {
        Self { protocol: PROTOCOL.into(), dialect }
    }

    /// The bytes to send.
    pub fn write(&self) -> Vec<u8> {
        // A number and a name are always JSON.
        serde_json::to_vec(self).unwrap_or_default()
    }

    /// Reads a hello of this version.
    ///
    /// # Errors
    /// A clause that says why its sender cannot take part, and what was expected.
    ///
    /// ```
    /// use shoal_bus::protocol::Hello;
    /// let error = Hello::read(br#"{"protocol":7}"#).unwrap_err();
    /// assert_eq!(error, "it speaks protocol 7, this build speaks protocol 1");
    /// ```
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let unreadable = |error: serde_json::Error| {
            let example = String::from_utf8(Self::new(Dialect::Json).write()).unwrap_or_default();
            format!("its hello cannot be read ({}): expected {example}", shown(&error, bytes))
        };
        let Version { protocol } = serde_json::from_slice(bytes).map_err(unreadable)?;
        if protocol != u64::from(PROTOCOL) {
            return Err(format!("it speaks protocol {protocol}, this build speaks protocol {PROTOCOL}"));
        }
        serde_json::from_slice(bytes).map_err(unreadable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hello_comes_back() {
        for dialect in [Dialect::Binary, Dialect::Json] {
            let hello = Hello::new(dialect);
            assert_eq!(Hello::read(&hello.write()), Ok(hello));
        }
    }

    #[test]
    fn what_is_no_hello_is_told_apart() {
        let refused = |bytes: &[u8], said: &str| {
            let error = Hello::read(bytes).unwrap_err();
            assert!(error.contains(said), "{error}");
        };
        refused(b"", "expected {\"protocol\":1,\"dialect\":\"json\"}");
        refused(&[1, 0, 0, 0, 0, 0], "its hello cannot be read");
        refused(br#"{"protocol":"one","dialect":"json"}"#, "expected u64");
        refused(br#"{"protocol":1}"#, "missing field `dialect`");
        refused(br#"{"protocol":1,"dialect":"xml"}"#, "expected `binary` or `json`");
        refused(br#"{"protocol":1,"dialect":"json","auv":3}"#, "unknown field `auv`");
        refused(br#"{"protocol":2,"greeting":"hi"}"#, "it speaks protocol 2");
    }
}
