//! The table on a terminal.

use std::io;
use std::time::{Duration, Instant};

use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line as TextLine;
use ratatui::widgets::{Cell, Paragraph, Row, Table};
use ratatui::{DefaultTerminal, Frame};
use shoal_bus::time::SimTime;

use super::roster::{Roster, TITLES};
use crate::tap::args::Sort;
use crate::tap::source::Source;
use crate::terminal::stdout_has_colour;

const KEYS: &str = "q quit  sort: a auv  b box  c clock  n neighbours  h heard  l lost  r reverse   up/down, page, home, end: scroll";

/// What the user wants.
pub enum Wish {
    Quit,
    Redraw,
}

/// The terminal while it shows the table; dropped, it is what it was.
pub struct Screen {
    terminal: DefaultTerminal,
    view: View,
    began: Option<(Instant, SimTime)>,
}

/// What of the table is shown, and how.
struct View {
    /// How many lines have been scrolled over.
    scrolled: usize,
    has_colour: bool,
}

impl Screen {
    /// Takes the terminal.
    pub fn open() -> io::Result<Self> {
        let view = View { scrolled: 0, has_colour: stdout_has_colour() };
        Ok(Self { terminal: ratatui::try_init()?, view, began: None })
    }

    /// Draws the present state.
    pub fn draw(&mut self, roster: &Roster, source: &Source, is_over: bool) -> io::Result<()> {
        let (since, from) = *self.began.get_or_insert((Instant::now(), roster.at));
        let pace = (roster.at - from) as f64 / 1e9 / since.elapsed().as_secs_f64().max(1e-3);
        let name = source.cast().map_or("", |cast| cast.header.scenario_name.as_str());
        let run = source.run().map_or(String::new(), |run| format!("run {}  ", run.id()));
        let missed = source.gaps().join("; ");
        let state = if is_over { "it is over".to_owned() } else { format!("{pace:.1} x real time") };
        let (at_s, auvs, heard, lost) = (roster.at.as_s(), roster.len(), roster.heard, roster.lost);
        let title =
            format!("{run}{name}  {auvs} AUVs  {at_s:.1} s  {state}  {heard} heard  {lost} lost  {missed}");
        let view = &mut self.view;
        self.terminal.draw(|frame| view.draw(frame, &title, roster)).map(drop)
    }

    /// What the user wants, if anything within `patience`.
    pub fn wish(&mut self, patience: Duration, roster: &mut Roster) -> io::Result<Option<Wish>> {
        if !event::poll(patience)? {
            return Ok(None);
        }
        let Event::Key(key) = event::read()? else { return Ok(Some(Wish::Redraw)) };
        if key.kind == KeyEventKind::Release {
            return Ok(Some(Wish::Redraw));
        }
        let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
        let page = usize::from(self.terminal.size()?.height.saturating_sub(4)).max(1);
        let scrolled = &mut self.view.scrolled;
        match key.code {
            KeyCode::Char('c') if is_control => return Ok(Some(Wish::Quit)),
            KeyCode::Char('q') | KeyCode::Esc => return Ok(Some(Wish::Quit)),
            KeyCode::Char('a') => roster.sort = Sort::Auv,
            KeyCode::Char('b') => roster.sort = Sort::Box,
            KeyCode::Char('c') => roster.sort = Sort::Clock,
            KeyCode::Char('n') => roster.sort = Sort::Neighbours,
            KeyCode::Char('h') => roster.sort = Sort::Heard,
            KeyCode::Char('l') => roster.sort = Sort::Lost,
            KeyCode::Char('r') => roster.is_reversed = !roster.is_reversed,
            KeyCode::Up => *scrolled = scrolled.saturating_sub(1),
            KeyCode::Down => *scrolled += 1,
            KeyCode::PageUp => *scrolled = scrolled.saturating_sub(page),
            KeyCode::PageDown => *scrolled += page,
            KeyCode::Home => *scrolled = 0,
            KeyCode::End => *scrolled = usize::MAX,
            _ => {}
        }
        Ok(Some(Wish::Redraw))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        ratatui::restore();
    }
}

impl View {
    fn draw(&mut self, frame: &mut Frame<'_>, title: &str, roster: &Roster) {
        let [top, middle, bottom] =
            Layout::vertical([Constraint::Length(1), Constraint::Min(0), Constraint::Length(1)])
                .areas(frame.area());
        frame.render_widget(Paragraph::new(TextLine::raw(title)), top);
        frame.render_widget(Paragraph::new(TextLine::raw(KEYS)), bottom);

        let height = usize::from(middle.height.saturating_sub(1));
        self.scrolled = self.scrolled.min(roster.len().saturating_sub(height));
        let lines = roster.sorted();
        let shown: Vec<([String; TITLES.len()], bool)> = lines
            .into_iter()
            .skip(self.scrolled)
            .take(height)
            .map(|(auv, line)| (line.cells(auv), line.is_alive()))
            .collect();
        let titles = TITLES.map(|title| title.trim_start_matches('>'));
        let widths: Vec<usize> = titles
            .iter()
            .enumerate()
            .map(|(column, title)| {
                let cells =
                    shown.iter().filter_map(|(cells, _)| cells.get(column)).map(|cell| cell.chars().count());
                cells.max().unwrap_or(0).max(title.len())
            })
            .collect();
        let fitting = fitting(&widths, usize::from(middle.width));
        let cell = |column: usize, text: &str| {
            let width = widths.get(column).copied().unwrap_or(0);
            let is_right = TITLES.get(column).is_some_and(|title| title.starts_with('>'));
            Cell::new(if is_right { format!("{text:>width$}") } else { text.to_owned() })
        };
        let row = |cells: &[String]| {
            Row::new(
                cells
                    .iter()
                    .take(fitting)
                    .enumerate()
                    .map(|(column, text)| cell(column, text))
                    .collect::<Vec<_>>(),
            )
        };
        let warning = if self.has_colour { Style::new().fg(Color::Red) } else { Style::new() };
        let rows = shown
            .iter()
            .map(|(cells, is_alive)| if *is_alive { row(cells) } else { row(cells).style(warning) });
        let constraints = widths.iter().take(fitting).map(|width| Constraint::Length(*width as u16));
        let table = Table::new(rows, constraints)
            .column_spacing(2)
            .header(row(&titles.map(str::to_owned)).style(Style::new().add_modifier(Modifier::REVERSED)));
        frame.render_widget(table, middle);
    }
}

/// How many columns of these widths fit, at least one.
fn fitting(widths: &[usize], columns: usize) -> usize {
    let mut used = 0;
    let fits = |(index, width): &(usize, &usize)| {
        used += **width + if *index == 0 { 0 } else { 2 };
        used <= columns
    };
    widths.iter().enumerate().take_while(fits).count().max(1)
}

#[cfg(test)]
mod tests {
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use shoal_bus::message::AuvId;
    use shoal_bus::record::Row;
    use shoal_bus::record::rows::PingRow;
    use shoal_bus::traffic::{Fate, Traffic};

    use super::*;
    use crate::tap::source::Window;

    #[test]
    fn lines_scroll_and_columns_that_do_not_fit_are_left_out() {
        let emitted = Fate::Emitted {
            position_m: [0.0; 3],
            bytes: 31,
            box_width_m: 1.0,
            beyond_range: 0,
            packet_s: 0.0,
        };
        let ping = |auv| Traffic { at: SimTime::ZERO, from: AuvId(auv), sequence: 0, fate: emitted.clone() };
        let rows = (0..9).map(|auv| Row::Ping(PingRow::new(&ping(auv)))).collect();
        let mut roster = Roster::new(Sort::Auv);
        roster.take(&Window { to: SimTime::ZERO, rows, counts: None, published: None }, None);
        let mut view = View { scrolled: usize::MAX, has_colour: false };
        let mut shown = |columns: u16| {
            let mut terminal = Terminal::new(TestBackend::new(columns, 6)).unwrap();
            terminal.draw(|frame| view.draw(frame, "a title", &roster)).unwrap();
            (terminal.backend().to_string(), view.scrolled)
        };
        let (wide, scrolled) = shown(130);
        assert_eq!(scrolled, 6, "{wide}");
        assert!(wide.contains("a title") && wide.contains("emitted") && wide.contains("state"), "{wide}");
        assert!(wide.contains("\n\"  8 ") && !wide.contains("\n\"  5 "), "{wide}");
        let (narrow, _) = shown(30);
        assert!(narrow.contains("box m") && !narrow.contains("neighbours"), "{narrow}");
        assert!(shown(1).0.contains('a'));
    }
}
