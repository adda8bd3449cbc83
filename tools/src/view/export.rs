//! The page and all its data in one file, which opens without Shoal.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde_json::json;

use super::cast::Cast;
use super::reader::Reading;
use super::server::{LICENCES, PAGE, SCRIPT, STYLE};
use super::store::Store;
use crate::exit::Exit;
use crate::failure::{Failure, While};

/// Browsers refuse to load much larger files.
const LIMIT_BYTES: u64 = 400 << 20;

/// Writes the page to `path` when all is read.
pub fn export(path: &Path, reading: Reading) -> Result<Exit, Failure> {
    let Reading { cast, store, thread } = reading;
    thread.join().map_err(|_| Failure::failed("the record could not be read to its end"))?;
    let kept = store.bytes();
    if kept > LIMIT_BYTES {
        return Err(Failure::failed(format!(
            "{} MB are too much for one page ({} MB at most): `shoal view` without --export shows records of any size",
            kept >> 20,
            LIMIT_BYTES >> 20
        )));
    }
    let reached = store.reached(0);
    let file = File::create(path).while_doing(&format!("write {}", path.display()))?;
    let mut out = BufWriter::new(file);
    write(&mut out, &cast, &store).while_doing(&format!("write {}", path.display()))?;
    if reached.note.is_empty() {
        return Ok(Exit::Good);
    }
    eprintln!("warning: {}", reached.note);
    Ok(Exit::Loss)
}

fn write(out: &mut impl Write, cast: &Cast, store: &Store) -> io::Result<()> {
    let unexpected = || io::Error::other("the page is not of this version");
    let (head, rest) = PAGE.split_once("<!-- style -->").ok_or_else(unexpected)?;
    let (body, end) = rest.split_once("<!-- script -->").ok_or_else(unexpected)?;
    let linked = r#"<link rel="stylesheet" href="view.css">"#;
    let called = r#"<script type="module" src="view.js"></script>"#;
    write!(out, "{head}<style>{STYLE}</style>{}", body.replacen(linked, "", 1))?;
    // Within a script only what would end it must be changed.
    write!(out, "<script type=\"application/json\" id=\"data\">")?;
    let messages = [json!({ "cast": cast }).to_string(), store.reached(0).message()];
    write!(out, "{{\"messages\":[{}],\"seconds\":[", messages.join(",").replace("</", "<\\/"))?;
    for (index, second) in store.seconds().into_iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        write!(out, "{comma}{{\"second\":{second},\"scene\":\"")?;
        base64(out, &store.scene(second)?.unwrap_or_default())?;
        write!(out, "\",\"tracks\":\"")?;
        base64(out, &store.tracks(second)?.unwrap_or_default())?;
        write!(out, "\"}}")?;
    }
    write!(out, "]}}</script>\n<!--\n{}\n-->\n", LICENCES.replace("--", "- -"))?;
    write!(
        out,
        "<script type=\"module\">{}</script>{}",
        SCRIPT.replace("</script", "<\\/script"),
        end.replacen(called, "", 1)
    )?;
    out.flush()
}

/// RFC 4648, section 4.
fn base64(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digit = |word: u32, shift: u32| DIGITS.get((word >> shift & 63) as usize).copied().unwrap_or(b'=');
    let mut line = Vec::with_capacity(4 * bytes.len().div_ceil(3));
    for three in bytes.chunks(3) {
        let byte = |at: usize| u32::from(three.get(at).copied().unwrap_or(0));
        let word = byte(0) << 16 | byte(1) << 8 | byte(2);
        line.extend([digit(word, 18), digit(word, 12)]);
        line.push(if three.len() > 1 { digit(word, 6) } else { b'=' });
        line.push(if three.len() > 2 { digit(word, 0) } else { b'=' });
    }
    out.write_all(&line)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RFC 4648, section 10.
    #[test]
    fn base64_is_that_of_the_standard() {
        let of = |text: &str| {
            let mut out = Vec::new();
            base64(&mut out, text.as_bytes()).unwrap();
            String::from_utf8(out).unwrap()
        };
        let found = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(of);
        assert_eq!(found, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    #[test]
    fn the_page_has_the_places_that_are_filled() {
        for place in ["<!-- style -->", "<!-- script -->"] {
            assert_eq!(PAGE.matches(place).count(), 1, "{place}");
        }
    }
}
