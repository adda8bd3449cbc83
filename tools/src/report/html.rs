//! A page as HTML: one file that needs no other, on screens bright and dark, and on paper.

use std::fmt::Write as _;

use shoal_interval::figure::escaped;

use super::page::{Block, Page, Table};
use crate::figure;

const STYLE: &str = include_str!("page.css");

/// The text of the file.
pub fn text(page: &Page) -> String {
    let mut html = String::new();
    let title = escaped(&page.title);
    // Writing to a string cannot fail.
    let _ = write!(
        html,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
        <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
        <title>{title}</title>\n<style>\n{STYLE}{}\n</style>\n</head>\n<body>\n<header><h1>{title}</h1><p>{}</p></header>\n",
        figure::STYLE,
        escaped(&page.subtitle)
    );
    let headings = page.blocks.iter().filter_map(|block| match block {
        Block::Heading(text) => Some(text),
        _ => None,
    });
    let links: String =
        headings.map(|text| format!("<a href=\"#{}\">{}</a>\n", anchor(text), escaped(text))).collect();
    let _ = writeln!(html, "<nav>\n{links}</nav>\n<main>");
    let mut figures = 0;
    for block in &page.blocks {
        write_block(&mut html, block, &mut figures);
    }
    html.push_str("</main>\n</body>\n</html>\n");
    html
}

fn write_block(html: &mut String, block: &Block, figures: &mut usize) {
    let _ = match block {
        Block::Heading(text) => writeln!(html, "<h2 id=\"{}\">{}</h2>", anchor(text), escaped(text)),
        Block::Text(text) => writeln!(html, "<p>{}</p>", escaped(text)),
        Block::Verdict { is_good, text } => {
            let (class, sign) = if *is_good { ("good", "✓") } else { ("bad", "✗") };
            writeln!(html, "<p class=\"verdict {class}\"><b>{sign}</b> {}</p>", escaped(text))
        }
        Block::Table(table) => write_table(html, table),
        Block::Figures(side_by_side) => {
            let _ = writeln!(html, "<div class=\"figures of{}\">", side_by_side.len());
            for (_, figure) in side_by_side {
                let svg = figure.to_element(&format!("f{figures}-"));
                *figures += 1;
                let _ = writeln!(html, "<figure>\n{svg}</figure>");
            }
            writeln!(html, "</div>")
        }
        Block::Listing { title, text } => writeln!(
            html,
            "<details><summary>{}</summary><pre>{}</pre></details>",
            escaped(title),
            escaped(text)
        ),
    };
}

fn write_table(html: &mut String, table: &Table) -> std::fmt::Result {
    let class = |column: usize| if table.is_of_numbers(column) { " class=\"number\"" } else { "" };
    html.push_str("<div class=\"table\"><table>\n<thead><tr>");
    for (column, text) in table.head.iter().enumerate() {
        write!(html, "<th{}>{}</th>", class(column), escaped(text))?;
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in &table.rows {
        html.push_str("<tr>");
        for (column, text) in row.iter().enumerate() {
            write!(html, "<td{}>{}</td>", class(column), escaped(text))?;
        }
        html.push_str("</tr>\n");
    }
    writeln!(html, "</tbody></table></div>")
}

/// What a link to a heading says: its letters and digits.
fn anchor(heading: &str) -> String {
    let letters = heading.chars().filter(|letter| letter.is_ascii_alphanumeric() || *letter == ' ');
    letters.map(|letter| if letter == ' ' { '-' } else { letter.to_ascii_lowercase() }).collect()
}
