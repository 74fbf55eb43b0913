//! Diagnostics for people: the message, the lines that it is about with what is to be said of them, and what to do.
//!
//! Of each line a window is drawn that holds what is marked, so that a diagnostic takes a few lines of a terminal however long the lines
//! of the source are, and however many places it names.

use super::Findings;
use super::place::{Place, instr_at};
use super::visible::visible_line;
use super::window::Window;
use anstyle::{AnsiColor, Color, Style};
use rungc_syntax::{Diagnostic, Severity, SourceKind, Span};
use std::fmt::Write as _;
use std::io::{self, Write};

/// How many places besides the main one are drawn.
const MAX_PLACES: usize = 6;

/// Prints at most `limit` diagnostics (0: all) about a program of this name.
pub fn print(
    findings: &Findings,
    name: &str,
    limit: usize,
    color: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    if findings.program.is_none() {
        return Ok(());
    }
    let all = findings.diagnostics.len();
    let shown = if limit == 0 { all } else { limit };
    for diagnostic in findings.diagnostics.iter().take(shown) {
        writeln!(out, "{}", draw(findings, name, diagnostic, color))?;
    }
    let hidden = all.saturating_sub(shown);
    if hidden > 0 {
        writeln!(out, "… and {hidden} more (--limit 0 prints all)\n")?;
    }
    Ok(())
}

/// What is said of a place.
struct Mark<'a> {
    span: Span,
    text: &'a str,
    style: Style,
}

/// A part of a line, with what is said of places in it.
struct Row<'a> {
    /// What stands in the margin: the number of the line, or the step.
    number: String,
    window: Window<'a>,
    marks: Vec<Placed<'a>>,
}

/// A mark from column to column of a row.
struct Placed<'a> {
    from: usize,
    to: usize,
    mark: &'a Mark<'a>,
}

impl Placed<'_> {
    /// The column from which a line leads to the text.
    fn middle(&self) -> usize {
        self.from.midpoint(self.to)
    }
}

fn draw(findings: &Findings, name: &str, d: &Diagnostic, color: bool) -> String {
    let style = |color: AnsiColor| Style::new().fg_color(Some(Color::Ansi(color)));
    let main = style(match d.severity {
        Severity::Error => AnsiColor::Red,
        Severity::Warning => AnsiColor::Yellow,
        Severity::Note => AnsiColor::Cyan,
    });
    let label = if d.label.is_empty() { "here" } else { &d.label };
    let mut marks = vec![Mark {
        span: d.span,
        text: label,
        style: main,
    }];
    marks.extend(d.others.iter().take(MAX_PLACES).map(|other| Mark {
        span: other.span,
        text: &other.text,
        style: style(AnsiColor::Blue),
    }));
    marks.sort_by_key(|mark| mark.span.start);
    let rows = rows(findings, &marks);
    let width = rows.iter().map(|row| row.number.len()).max().unwrap_or(1);
    let mut drawing = Drawing {
        text: String::new(),
        width,
        color,
        remarked: false,
    };
    let heading = format!("{}[{}]:", d.severity.name(), d.code);
    drawing.heading(&heading, main, &d.message);
    let head = Place::of(findings, d.span).unwrap_or_default().headed(name);
    drawing.open(&visible_line(&head));
    for row in &rows {
        drawing.row(row);
    }
    let more = d.others.len().saturating_sub(MAX_PLACES);
    if more > 0 {
        drawing.remark(
            "",
            &format!("… and {more} more places (`--format json` names all)"),
        );
    }
    if let Some(help) = &d.help {
        drawing.remark("Help: ", help);
    }
    let plc = d
        .plc_error
        .map(|code| format!("the PLC reports this as error {code}; "))
        .unwrap_or_default();
    let note = format!("{plc}`rungc explain {}` tells more", d.code);
    drawing.remark("Note: ", &note);
    drawing.close();
    drawing.text
}

/// The parts of lines that hold the marks, which are in the order of their places.
fn rows<'a>(findings: &'a Findings, marks: &'a [Mark<'a>]) -> Vec<Row<'a>> {
    let Some(program) = findings.program else {
        return Vec::new();
    };
    let list = program.kind == SourceKind::Il;
    let mut rows: Vec<Row> = Vec::new();
    for mark in marks {
        let start = mark.span.start as usize;
        if !rows.last().is_some_and(|row| row.window.holds(start)) {
            let number = match list {
                true => Some(program.source.line(mark.span.start)),
                false => Place::of(findings, mark.span).and_then(|place| place.step.or(place.line)),
            };
            let text = &program.source.text;
            let instr = instr_at(program, mark.span.start).map(|at| program.instrs[at].span);
            let window = instr.and_then(|span| Window::of_rows(text, span));
            rows.push(Row {
                number: number.map_or_else(String::new, |number| number.to_string()),
                window: window.unwrap_or_else(|| Window::around(text, start, !list)),
                marks: Vec::new(),
            });
        }
        if let Some(row) = rows.last_mut() {
            let from = row.window.column(start);
            let to = row.window.column(mark.span.end as usize).max(from);
            row.marks.push(Placed { from, to, mark });
        }
    }
    rows
}

/// A drawing in the making.
struct Drawing {
    text: String,
    /// Columns of the numbers in the margin.
    width: usize,
    color: bool,
    /// Whether a remark stands below the rows.
    remarked: bool,
}

impl Drawing {
    fn paint(&self, text: &str, style: Style) -> String {
        match self.color && !text.is_empty() {
            true => format!("{style}{text}{style:#}"),
            false => text.to_owned(),
        }
    }

    /// A line of the margin's colour.
    fn frame(&self, text: &str) -> String {
        self.paint(
            text,
            Style::new().fg_color(Some(Color::Ansi(AnsiColor::BrightBlack))),
        )
    }

    fn heading(&mut self, heading: &str, style: Style, message: &str) {
        let heading = self.paint(heading, style);
        let _ = writeln!(self.text, "{heading} {}", visible_line(message));
    }

    fn open(&mut self, head: &str) {
        let (space, frame) = (" ".repeat(self.width + 2), self.frame("╭─["));
        let end = self.frame("]");
        let _ = writeln!(self.text, "{space}{frame} {head} {end}");
        self.line("");
    }

    /// A line without a number.
    fn line(&mut self, content: &str) {
        let (space, frame) = (" ".repeat(self.width + 2), self.frame("│"));
        let line = format!("{space}{frame} {content}");
        let _ = writeln!(self.text, "{}", line.trim_end());
    }

    fn row(&mut self, row: &Row) {
        let margin = self.frame(&format!(" {:>width$} │", row.number, width = self.width));
        let line = format!("{margin} {}", row.window.shown());
        let _ = writeln!(self.text, "{}", line.trim_end());
        let end = row.marks.iter().map(|placed| placed.to).max().unwrap_or(0);
        let mut under = Cells::default();
        for placed in &row.marks {
            for column in placed.from..placed.to {
                under.put(column, '─', placed);
            }
            let sign = if placed.from < placed.to {
                '┬'
            } else {
                '│'
            };
            under.put(placed.middle(), sign, placed);
        }
        self.line(&under.text(self));
        for (n, placed) in row.marks.iter().enumerate() {
            let waiting = &row.marks[n + 1..];
            let mut arrow = Cells::default();
            waiting
                .iter()
                .for_each(|other| arrow.put(other.middle(), '│', other));
            arrow.put(placed.middle(), '╰', placed);
            for column in placed.middle() + 1..=end + 1 {
                arrow.put(column, '─', placed);
            }
            let text = visible_line(placed.mark.text);
            self.line(&format!("{} {text}", arrow.text(self)));
            if !waiting.is_empty() {
                let mut bars = Cells::default();
                waiting
                    .iter()
                    .for_each(|other| bars.put(other.middle(), '│', other));
                self.line(&bars.text(self));
            }
        }
        self.line("");
    }

    /// A remark below the rows, each with a line of its own between.
    fn remark(&mut self, what: &str, text: &str) {
        if std::mem::replace(&mut self.remarked, true) {
            self.line("");
        }
        self.line(&format!("{what}{}", visible_line(text)));
    }

    fn close(&mut self) {
        let end = self.frame(&format!("{}╯", "─".repeat(self.width + 2)));
        let _ = writeln!(self.text, "{end}");
    }
}

/// A line of signs, each in its colour.
#[derive(Default)]
struct Cells(Vec<(char, Style)>);

impl Cells {
    fn put(&mut self, column: usize, sign: char, placed: &Placed) {
        if self.0.len() <= column {
            self.0.resize(column + 1, (' ', Style::new()));
        }
        self.0[column] = (sign, placed.mark.style);
    }

    fn text(&self, drawing: &Drawing) -> String {
        let mut text = String::new();
        for run in self.0.chunk_by(|a, b| a.1 == b.1) {
            let signs: String = run.iter().map(|&(sign, _)| sign).collect();
            match run[0].1 == Style::new() {
                true => text.push_str(&signs),
                false => text.push_str(&drawing.paint(&signs, run[0].1)),
            }
        }
        text
    }
}
