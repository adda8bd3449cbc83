//! A page as GitHub-flavoured Markdown.

use std::fmt::Write as _;

use super::page::{Block, Page, Table};

/// The text of the file; its figures are files of `folder`, or left out.
pub fn text(page: &Page, folder: Option<&str>) -> String {
    let mut text = format!("# {}\n\n{}\n", escaped(&page.title), escaped(&page.subtitle));
    for block in &page.blocks {
        write_block(&mut text, block, folder);
    }
    text
}

fn write_block(text: &mut String, block: &Block, folder: Option<&str>) {
    // Writing to a string cannot fail.
    let _ = match block {
        Block::Heading(words) => writeln!(text, "\n## {}", escaped(words)),
        Block::Text(words) => writeln!(text, "\n{}", escaped(words)),
        Block::Verdict { is_good, text: words } => {
            let kind = if *is_good { "NOTE" } else { "WARNING" };
            writeln!(text, "\n> [!{kind}]\n> {}", escaped(words))
        }
        Block::Table(table) => write_table(text, table),
        Block::Figures(figures) => {
            let Some(folder) = folder else { return };
            text.push('\n');
            for (file, figure) in figures {
                let (folder, file) = (in_link(folder), in_link(file));
                let title = format!("{}: {}", figure.title, figure.subtitle);
                let _ = writeln!(text, "![{}]({folder}/{file})", escaped(&title));
            }
            Ok(())
        }
        Block::Listing { title, text: listed } => {
            // A fence longer than any in the text.
            let longest = listed.split(|letter| letter != '`').map(str::len).max().unwrap_or(0);
            let fence = "`".repeat(longest.max(2) + 1);
            writeln!(
                text,
                "\n<details><summary>{}</summary>\n\n{fence}toml\n{}\n{fence}\n\n</details>",
                escaped(title),
                listed.trim_end()
            )
        }
    };
}

fn write_table(text: &mut String, table: &Table) -> std::fmt::Result {
    let row = |cells: &[String]| -> String {
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule = |column: usize| if table.is_of_numbers(column) { "---:" } else { "---" };
    let rules: Vec<&str> = (0..table.head.len()).map(rule).collect();
    write!(text, "\n{}| {} |\n", row(&table.head), rules.join(" | "))?;
    table.rows.iter().try_for_each(|cells| text.write_str(&row(cells)))
}

/// Words that mean nothing but themselves: no markup, no HTML, no end of a cell or line.
fn escaped(words: &str) -> String {
    let mut escaped = String::with_capacity(words.len());
    for letter in words.chars() {
        match letter {
            '\n' | '\r' => escaped.push(' '),
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '~' | '#' | '$' => {
                escaped.push('\\');
                escaped.push(letter);
            }
            _ => escaped.push(letter),
        }
    }
    escaped
}

/// A part of a link: letters, digits, and what means nothing there; the rest as percent and two digits.
fn in_link(part: &str) -> String {
    let mut link = String::new();
    for byte in part.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.".contains(&byte) {
            link.push(char::from(byte));
        } else {
            let _ = write!(link, "%{byte:02X}");
        }
    }
    link
}
