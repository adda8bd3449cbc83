//! `shoal record info`.

use std::io::Write;
use std::path::Path;

use shoal_bus::record::RecordInfo;

use crate::exit::Exit;
use crate::failure::{Failure, While};

/// Prints what a record holds. A record that was cut is readable, but incomplete.
pub fn info(file: &Path, as_json: bool) -> Result<Exit, Failure> {
    let info = RecordInfo::open(file).map_err(Failure::failed)?;
    let text = if as_json {
        serde_json::to_string(&info).while_doing("print what the record holds")?
    } else {
        info.to_string()
    };
    // A reader that has enough closes the pipe.
    let _closed = writeln!(std::io::stdout().lock(), "{}", text.trim_end());
    Ok(if info.truncated.is_some() { Exit::Loss } else { Exit::Good })
}
