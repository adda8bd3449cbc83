//! Tests of pages as text.

use super::page::{Block, Page, Table};
use super::*;
use crate::figure::{Axis, Colour, Entry, Figure, Layer, Panel, Sample, assert_well_formed};

/// Words that would be markup, if nobody saw to it.
const WORDS: &str = "<b>a & b</b> | *c* `d` [e](f)";

fn page() -> Page {
    let mut table = Table::new(&["name", "count"]);
    table.row([WORDS, "1,234"]);
    table.row(["x", "–"]);
    let figure = Figure {
        title: WORDS.to_owned(),
        subtitle: "made up".to_owned(),
        panels: vec![Panel {
            width_px: 100.0,
            x: Axis::new("x (m)", 0.0, 1.0),
            y: Axis::new("y (m)", 0.0, 1.0),
            layers: vec![Layer::Line { colour: Colour::Blue, points: vec![[0.0, 0.0], [1.0, 1.0]] }],
        }],
        legend: vec![Entry::new(Sample::Line(Colour::Blue), WORDS)],
    };
    Page {
        title: WORDS.to_owned(),
        subtitle: "made up".to_owned(),
        blocks: vec![
            Block::Verdict { is_good: false, text: WORDS.to_owned() },
            Block::Heading("First part".to_owned()),
            Block::Text(WORDS.to_owned()),
            Block::Table(table),
            Block::Figures(vec![("a b.svg".to_owned(), figure.clone()), ("c.svg".to_owned(), figure)]),
            Block::Listing { title: WORDS.to_owned(), text: "a = \"```\" # <script>\n".to_owned() },
        ],
    }
}

#[test]
fn a_page_is_html_that_needs_nothing_else_and_takes_no_words_for_markup() {
    let html = html::text(&page());
    let (_, body) = html.split_once("<body>").unwrap();
    assert_well_formed(&format!("<body>{}", body.trim_end().trim_end_matches("</html>")));
    for outside in ["<script", "<link", "<img", "@import", "src=", "<b>a"] {
        assert!(!html.contains(outside), "{outside}");
    }
    // The one address is the name of the language of figures; links lead to places of the page.
    assert!(html.matches("http").count() == html.matches("http://www.w3.org/2000/svg").count());
    assert!(html.split("href=\"").skip(1).all(|link| link.starts_with('#')));
    assert_eq!(html.matches("<svg ").count(), 2);
    let ids: Vec<&str> = html.split(" id=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let different: std::collections::BTreeSet<&&str> = ids.iter().collect();
    assert_eq!(different.len(), ids.len(), "{ids:?}");
    assert!(html.contains("<th class=\"number\">count</th>") && html.contains("<td>x</td>"));
}

#[test]
fn a_page_is_markdown_that_takes_no_words_for_markup() {
    insta::assert_snapshot!(markdown::text(&page(), Some("my figures")));
    let without = markdown::text(&page(), None);
    assert!(!without.contains("!["), "{without}");
}
