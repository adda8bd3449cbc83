//! The scenarios that come with Shoal, and how a name on the command line becomes a text.

use std::path::Path;

/// A scenario of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LibraryEntry {
    /// Name, as in `shoal run NAME`.
    pub name: &'static str,
    /// Text of the scenario file.
    pub text: &'static str,
}

const LIBRARY: &[LibraryEntry] = &[
    LibraryEntry { name: "two-circles", text: include_str!("../library/two-circles.toml") },
    LibraryEntry { name: "six-circles", text: include_str!("../library/six-circles.toml") },
    LibraryEntry { name: "six-auvs-3d", text: include_str!("../library/six-auvs-3d.toml") },
    LibraryEntry { name: "sea-trial", text: include_str!("../library/sea-trial.toml") },
    LibraryEntry { name: "swarm-3", text: include_str!("../library/swarm-3.toml") },
    LibraryEntry { name: "kidnapped", text: include_str!("../library/kidnapped.toml") },
    LibraryEntry { name: "unknown-start", text: include_str!("../library/unknown-start.toml") },
    LibraryEntry { name: "surface-bounce", text: include_str!("../library/surface-bounce.toml") },
    LibraryEntry { name: "echoes", text: include_str!("../library/echoes.toml") },
    LibraryEntry { name: "thermocline", text: include_str!("../library/thermocline.toml") },
    LibraryEntry { name: "crowded-band", text: include_str!("../library/crowded-band.toml") },
    LibraryEntry { name: "data-incest", text: include_str!("../library/data-incest.toml") },
    LibraryEntry { name: "sweep-16", text: include_str!("../library/sweep-16.toml") },
    LibraryEntry { name: "swarm-300", text: include_str!("../library/swarm-300.toml") },
    LibraryEntry { name: "swarm-1000", text: include_str!("../library/swarm-1000.toml") },
    LibraryEntry { name: "seismic-grid-3000", text: include_str!("../library/seismic-grid-3000.toml") },
    LibraryEntry { name: "swarm-10000", text: include_str!("../library/swarm-10000.toml") },
];

/// Every scenario that comes with Shoal, from the simplest to the largest.
pub fn library() -> &'static [LibraryEntry] {
    LIBRARY
}

/// Why there is no text to read.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// Neither in the library nor a file.
    #[error(
        "there is no scenario `{name}`, neither in the library nor as a file{}; the library has {}, \
         or give the path of a .toml file",
        .similar.map_or(String::new(), |similar| format!(": did you mean `{similar}`?")),
        names()
    )]
    Unknown {
        /// What was asked for.
        name: String,
        /// The closest name of the library.
        similar: Option<&'static str>,
    },
    /// The file is there but cannot be read.
    #[error("cannot read the scenario file `{path}`: {cause}; it must be a readable UTF-8 text file")]
    Unreadable {
        /// Its path.
        path: String,
        /// What the operating system says.
        #[source]
        cause: std::io::Error,
    },
}

fn names() -> String {
    LIBRARY.iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

/// Finds a scenario by its name in the library or by the path of its file: its source name and its text.
///
/// A name of the library wins over a file of that name; write `./swarm-3` to mean the file.
///
/// # Errors
/// [`LoadError`] when there is neither, or when the file cannot be read.
pub fn load(name_or_path: &str) -> Result<(String, String), LoadError> {
    if let Some(entry) = LIBRARY.iter().find(|entry| entry.name == name_or_path) {
        return Ok((format!("library/{}.toml", entry.name), entry.text.to_string()));
    }
    if Path::new(name_or_path).exists() {
        return match std::fs::read_to_string(name_or_path) {
            Ok(text) => Ok((name_or_path.to_string(), text)),
            Err(cause) => Err(LoadError::Unreadable { path: name_or_path.to_string(), cause }),
        };
    }
    let similar = crate::reader::closest(name_or_path, LIBRARY.iter().map(|entry| entry.name));
    Err(LoadError::Unknown { name: name_or_path.to_string(), similar })
}
