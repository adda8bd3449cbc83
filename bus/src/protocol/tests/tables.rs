//! Tables of all messages, from their source text as the formatter leaves it.

use std::fmt::Write;

const MESSAGES: &str = include_str!("../../message.rs");
const LOCKSTEP: &str = include_str!("../../lockstep.rs");
/// Written otherwise than their fields say; the table of dialects has them.
const BY_HAND: [&str; 1] = ["AuvId"];

/// A struct or an enum.
struct Type {
    name: String,
    is_enum: bool,
    meaning: String,
    members: Vec<Member>,
}

/// A field, a variant, or a field of the variant before it.
struct Member {
    name: String,
    of_type: String,
    meaning: String,
    is_optional: bool,
    is_nested: bool,
}

pub fn made() -> String {
    let lockstep = types(LOCKSTEP).into_iter().filter(|of| ["ToAuv", "FromAuv"].contains(&of.name.as_str()));
    let messages = types(MESSAGES).into_iter().filter(|of| !BY_HAND.contains(&of.name.as_str()));
    let mut text = String::new();
    for of in lockstep.chain(messages) {
        write(&mut text, &of);
    }
    text
}

fn write(text: &mut String, of: &Type) {
    let Type { name, meaning, .. } = of;
    writeln!(text, "## {name}\n\n{meaning}\n").unwrap();
    let first = if of.is_enum { "number and variant" } else { "field" };
    writeln!(text, "| {first} | type | meaning |\n|---|---|---|").unwrap();
    let mut variants = 0..;
    for member in &of.members {
        let number = match (of.is_enum, member.is_nested) {
            (true, false) => format!("{}: ", variants.next().unwrap()),
            (true, true) => "  . ".to_owned(),
            _ => String::new(),
        };
        let of_type = if member.of_type.is_empty() { String::new() } else { format!("`{}`", member.of_type) };
        let optional = if member.is_optional { " (optional)" } else { "" };
        writeln!(text, "| {number}`{}` | {of_type} | {}{optional} |", member.name, member.meaning).unwrap();
    }
    writeln!(text).unwrap();
}

/// All public types with members of a source text.
fn types(source: &str) -> Vec<Type> {
    let mut types = Vec::new();
    let (mut docs, mut is_optional) = (String::new(), false);
    let mut open: Option<Type> = None;
    for line in source.lines() {
        let (indent, line) = (line.len() - line.trim_start().len(), line.trim());
        if let Some(doc) = line.strip_prefix("///") {
            docs.push_str(doc);
            continue;
        }
        if line.starts_with("#[") {
            is_optional |= line.starts_with("#[serde(default");
            continue;
        }
        let meaning = plain(&std::mem::take(&mut docs));
        match &mut open {
            Some(_) if line == "}" && indent == 0 => types.extend(open.take()),
            Some(of) => {
                if let Some((name, of_type)) = member(line) {
                    of.members.push(Member { name, of_type, meaning, is_optional, is_nested: indent > 4 });
                }
            }
            None => {
                let head = line.strip_prefix("pub struct ").or(line.strip_prefix("pub enum "));
                let name = head.and_then(|head| head.strip_suffix(" {"));
                open = name.filter(|name| !name.contains('<')).map(|name| Type {
                    name: name.to_owned(),
                    is_enum: line.starts_with("pub enum"),
                    meaning,
                    members: Vec::new(),
                });
            }
        }
        is_optional = false;
    }
    types
}

/// Name and type of a field or a variant.
fn member(line: &str) -> Option<(String, String)> {
    let line = line.strip_prefix("pub ").unwrap_or(line);
    let name: String = line.chars().take_while(|of| of.is_alphanumeric() || *of == '_').collect();
    let rest = line.strip_prefix(&name)?;
    let of_type = match rest {
        "," | " {" => "",
        _ => rest
            .strip_prefix(": ")
            .and_then(|of| of.strip_suffix(','))
            .or_else(|| rest.strip_prefix('(')?.strip_suffix("),"))?,
    };
    (!name.is_empty()).then(|| (name, of_type.replace("Box<Born>", "Born")))
}

/// Documentation without links, in one cell of a table.
fn plain(docs: &str) -> String {
    let mut text = String::new();
    let mut rest = docs.trim();
    while let Some(start) = rest.find('[') {
        let is_escaped = rest[..start].ends_with('\\');
        let Some(end) = rest[start..].find(']').map(|end| start + end) else { break };
        text.push_str(&rest[..start]);
        let inner = &rest[start + 1..end];
        let after = &rest[end + 1..];
        // A code span such as `[a, b]` is no link.
        let in_code = rest[..start].matches('`').count() % 2 == 1;
        match after.strip_prefix('(').and_then(|link| link.split_once(')')) {
            Some((_, after)) if !is_escaped && !in_code => {
                text.push_str(inner);
                rest = after;
            }
            _ if is_escaped || in_code => {
                text.push_str(&rest[start..=end]);
                rest = after;
            }
            _ => {
                text.push_str(inner);
                rest = after;
            }
        }
    }
    text.push_str(rest);
    text.replace('|', "\\|")
}
