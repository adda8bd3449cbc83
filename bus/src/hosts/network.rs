//! The network between hosts: a configuration of zenoh, and sessions made of it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::Value;
use thiserror::Error;
use zenoh::{Config, Session, Wait};

/// What holds unless the user's file says otherwise; the file `--print-zenoh-config` prints.
pub const DEFAULT_CONFIG: &str = include_str!("zenoh.json5");

/// How hosts reach each other.
#[derive(Clone, Debug)]
pub struct Network {
    config: Config,
}

/// Why hosts cannot reach each other.
#[derive(Debug, Error)]
pub enum NetworkError {
    /// The user's file is no configuration.
    #[error("{}: this is no configuration of zenoh: {cause}; begin with `shoal host --print-zenoh-config`", path.display())]
    Config {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        cause: String,
    },
    /// A setting is refused.
    #[error("zenoh refuses the setting `{key}`: {cause}")]
    Setting {
        /// Which.
        key: String,
        /// Why.
        cause: String,
    },
    /// Nobody can be listened for.
    #[error(
        "cannot listen on {endpoint}: {cause}; is the port in use, or the address not one of this machine? Choose another \
         with --listen"
    )]
    Listen {
        /// Where.
        endpoint: String,
        /// What zenoh said.
        cause: String,
    },
    /// Nobody is there.
    #[error(
        "nobody could be reached at {endpoint} within {wait_s} s: {cause}; start `shoal run ... --listen {endpoint} --hosts M` \
         there, and look at the address and at firewalls in between"
    )]
    Connect {
        /// Where.
        endpoint: String,
        /// How long it was tried.
        wait_s: u64,
        /// What zenoh said.
        cause: String,
    },
    /// The session does not work.
    #[error("the session on {endpoint} does not work: {cause}")]
    Session {
        /// Where.
        endpoint: String,
        /// What zenoh said.
        cause: String,
    },
}

impl Network {
    /// [`DEFAULT_CONFIG`], and over it what `file` says.
    ///
    /// # Errors
    /// [`NetworkError::Config`] for a file that cannot be read or that zenoh does not understand.
    pub fn new(file: Option<&Path>) -> Result<Self, NetworkError> {
        let mut config = Config::default();
        lay(&mut config, "", &defaults())?;
        if let Some(path) = file {
            let wrong = |cause: String| NetworkError::Config { path: path.to_owned(), cause };
            let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
            let over: Value = json5::from_str(&text).map_err(|error| wrong(error.to_string()))?;
            if !over.is_object() {
                return Err(wrong("it is no table of settings".to_owned()));
            }
            lay(&mut config, "", &over).map_err(|error| wrong(error.to_string()))?;
        }
        Ok(Self { config })
    }

    /// A session that listens on `endpoint`.
    pub(super) fn listen(&self, endpoint: &str) -> Result<Session, NetworkError> {
        let settings = [
            ("mode", Value::from("router")),
            ("listen/endpoints", Value::from([endpoint].as_slice())),
            ("listen/timeout_ms", Value::from(0)),
            ("listen/exit_on_failure", Value::from(true)),
        ];
        let session = zenoh::open(self.with(&settings)?).wait();
        session.map_err(|error| NetworkError::Listen { endpoint: endpoint.to_owned(), cause: said(&*error) })
    }

    /// A session that connects to `endpoint`, which may come into being within `wait`.
    pub(super) fn connect(&self, endpoint: &str, wait: Duration) -> Result<Session, NetworkError> {
        let settings = [
            ("mode", Value::from("client")),
            ("listen/endpoints", Value::Array(Vec::new())),
            ("connect/endpoints", Value::from([endpoint].as_slice())),
            ("connect/timeout_ms", Value::from(i64::try_from(wait.as_millis()).unwrap_or(i64::MAX))),
            ("connect/exit_on_failure", Value::from(true)),
        ];
        zenoh::open(self.with(&settings)?).wait().map_err(|error| NetworkError::Connect {
            endpoint: endpoint.to_owned(),
            wait_s: wait.as_secs(),
            cause: said(&*error),
        })
    }

    fn with(&self, settings: &[(&str, Value)]) -> Result<Config, NetworkError> {
        let mut config = self.config.clone();
        settings.iter().try_for_each(|(key, value)| insert(&mut config, key, value))?;
        Ok(config)
    }
}

/// Our own file, of which a test shows that it can be read.
fn defaults() -> Value {
    json5::from_str(DEFAULT_CONFIG).unwrap_or_default()
}

/// Sets the values of `table`, one by one, so that what it does not name stays; where zenoh wants a table as a whole, it
/// gets that.
fn lay(config: &mut Config, key: &str, value: &Value) -> Result<(), NetworkError> {
    match value {
        Value::Object(table) if !table.is_empty() => {
            for (name, value) in table {
                let inner = if key.is_empty() { name.clone() } else { format!("{key}/{name}") };
                if let Err(error) = lay(config, &inner, value) {
                    return if key.is_empty() {
                        Err(error)
                    } else {
                        insert(config, key, &whole(table)).map_err(|_| error)
                    };
                }
            }
            Ok(())
        }
        _ => insert(config, key, value),
    }
}

fn whole(table: &serde_json::Map<String, Value>) -> Value {
    Value::Object(table.clone())
}

fn insert(config: &mut Config, key: &str, value: &Value) -> Result<(), NetworkError> {
    config
        .insert_json5(key, &value.to_string())
        .map_err(|error| NetworkError::Setting { key: key.to_owned(), cause: said(&*error) })
}

/// What zenoh said, in one line and without the places in its sources.
pub(super) fn said(error: &(dyn std::error::Error + Send + Sync)) -> String {
    let text = error.to_string();
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = line.split_once(" at /").map_or(line.as_str(), |(said, _)| said);
    // Behind a list of what it tried, in brackets, is what the system said.
    let said = said.rsplit_once(": [").map_or(said, |(_, cause)| cause);
    said.trim_end_matches([']', '.', ' ']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn get(network: &Network, key: &str) -> Value {
        serde_json::from_str(&network.config.get_json(key).unwrap()).unwrap()
    }

    fn of_file(text: &str) -> Result<Network, NetworkError> {
        let run = crate::run_dir::RunDir::create(&Value::Null).unwrap();
        let path = run.path().join("zenoh.json5");
        std::fs::write(&path, text).unwrap();
        let network = Network::new(Some(&path));
        run.remove().unwrap();
        network
    }

    #[test]
    fn defaults_hold_where_the_file_is_silent() {
        assert!(defaults().is_object());
        let plain = Network::new(None).unwrap();
        assert_eq!(get(&plain, "scouting/multicast/enabled"), false);
        assert_eq!(get(&plain, "transport/link/tx/lease"), 5000);
        let other = of_file(
            "{ transport: { link: { tx: { lease: 900 }, tls: { root_ca_certificate: 'ca.pem' } } }, \
             connect: { endpoints: ['tcp/router:7447'] }, namespace: 'mine' }",
        );
        let other = other.unwrap();
        assert_eq!(get(&other, "transport/link/tx/lease"), 900);
        assert_eq!(get(&other, "transport/link/tx/keep_alive"), 4);
        assert_eq!(get(&other, "scouting/multicast/enabled"), false);
        assert_eq!(get(&other, "transport/link/tls/root_ca_certificate"), "ca.pem");
        assert_eq!(get(&other, "namespace"), "mine");
        assert_eq!(get(&other, "connect/endpoints").to_string(), "[\"tcp/router:7447\"]");
    }

    #[test]
    fn files_that_are_no_configuration_are_refused_with_a_sentence() {
        for (text, part) in [
            ("{ transport: { lnik: {} } }", "lnik"),
            ("{ scouting: ", "expected"),
            ("[1]", "no table"),
            ("{ transport: { link: { tx: { lease: 'long' } } } }", "lease"),
        ] {
            let error = of_file(text).unwrap_err().to_string();
            assert!(
                error.contains("zenoh.json5: this is no configuration") && error.contains(part),
                "{error}"
            );
        }
        let error = Network::new(Some(Path::new("/no/such/file"))).unwrap_err().to_string();
        assert!(error.starts_with("/no/such/file: ") && error.contains("No such file"), "{error}");
    }
}
