//! Why bytes from outside cannot be read, for whoever wrote the program that sent them.

/// Longest detail that a reason quotes, in characters: it may come from anybody.
const DETAIL_MAX: usize = 240;
/// So much of the JSON text before the error is quoted, in bytes: enough to name the field.
const BEFORE: usize = 60;

/// What is wrong with a JSON text, and the text just before that: it names the field.
pub(crate) fn shown(error: &serde_json::Error, text: &[u8]) -> String {
    let what = error.to_string();
    // The place is shown as text, which says more than its number in a line of kilobytes.
    let what = what.rsplit_once(" at line ").map_or(what.as_str(), |(what, _)| what);
    let line_start: usize = text
        .split_inclusive(|byte| *byte == b'\n')
        .take(error.line().saturating_sub(1))
        .map(<[u8]>::len)
        .sum();
    let end = (line_start + error.column()).min(text.len());
    let before = String::from_utf8_lossy(&text[end.saturating_sub(BEFORE)..end]);
    match before.trim() {
        "" => brief(what),
        before => format!("{}, at ...{}", brief(what), brief(before)),
    }
}

/// A detail without control characters, and not too long.
pub(crate) fn brief(detail: &str) -> String {
    let clean = |character: char| if character.is_control() { ' ' } else { character };
    let mut short: String = detail.chars().take(DETAIL_MAX).map(clean).collect();
    if detail.chars().nth(DETAIL_MAX).is_some() {
        short.push_str("...");
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_is_named() {
        let text = b"{\"tick\":3,\n\"setpoint\":{\"velocity_m_s\":[null,0,0]}}";
        let error = serde_json::from_slice::<crate::message::Acted>(text).unwrap_err();
        assert_eq!(
            shown(&error, text),
            "invalid type: null, expected f64, at ...{\"tick\":3, \"setpoint\":{\"velocity_m_s\":[null"
        );
    }

    #[test]
    fn no_reason_is_long_or_breaks_lines() {
        let long = "a\n".repeat(10_000);
        assert!(brief(&long).len() < 300 && !brief(&long).contains('\n'));
    }
}
