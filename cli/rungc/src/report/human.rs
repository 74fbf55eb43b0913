//! Human-readable diagnostics, drawn by ariadne: the message, the lines that it is about with their labels, and what to
//! do.
//!
//! The library draws whole lines of whole files, numbered from 1. It is given a source made of the marked lines alone,
//! each cut to a window, so that a diagnostic takes little time and a few lines of a terminal however long the program
//! and its lines are and however many places the diagnostic names. The numbers of the lines, or the steps, are then
//! written into the margin.

use super::Findings;
use super::visible::{visible, visible_line};
use super::window::Window;
use ariadne::{Color, Config, Label, Report, ReportKind};
use rungc::Language;
use rungc::language::{self, message};
use rungc::location::instr_at;
use rungc_syntax::{Diagnostic, Severity, Span, codes};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::Range;

/// Maximum number of places that are drawn in addition to the main one.
const MAX_PLACES: usize = 6;

/// Text between the marked lines in the drawn source: an empty line, which the library draws as a gap.
const GAP: &str = "\n\n";

/// Stands before texts in a drawing, so that the words of the library before them can be found. Sources and messages
/// have it written out.
const MARK: char = '\u{1}';

/// Presentation of diagnostics.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Maximum number of diagnostics; 0: all.
    pub limit: usize,
    /// With colours.
    pub color: bool,
    /// Language of titles and of the words of a frame.
    pub language: Language,
}

/// Prints diagnostics about a program of this name.
pub fn print(findings: &Findings, name: &str, style: Style, out: &mut dyn Write) -> io::Result<()> {
    let Style {
        limit, language, ..
    } = style;
    if findings.program.is_none() {
        return Ok(());
    }
    let all = findings.diagnostics.len();
    let shown = if limit == 0 { all } else { limit };
    for (i, diagnostic) in findings.diagnostics.iter().take(shown).enumerate() {
        writeln!(out, "{}", draw(findings, name, diagnostic, style)?)?;
        if let Some(network) = findings.drawn.get(i).filter(|drawn| !drawn.is_empty()) {
            writeln!(out, "{}", visible(network))?;
        }
    }
    let hidden = all.saturating_sub(shown);
    if hidden > 0 {
        let hidden = hidden.to_string();
        let more = message(language, "more-findings", &[("count", (&hidden).into())]);
        writeln!(out, "{more}\n")?;
    }
    Ok(())
}

/// Message about a place.
struct Mark<'a> {
    span: Span,
    text: Cow<'a, str>,
    color: Color,
}

/// A part of a line, with the messages about places in it.
struct Row<'a> {
    /// The text in the margin: the number of the line, or the step.
    number: String,
    window: Window<'a>,
    marks: Vec<&'a Mark<'a>>,
}

fn draw(findings: &Findings, name: &str, d: &Diagnostic, style: Style) -> io::Result<String> {
    let Style {
        color, language, ..
    } = style;
    let main_color = match d.severity {
        Severity::Error => Color::Red,
        Severity::Warning => Color::Yellow,
        Severity::Note => Color::Cyan,
    };
    let said = |text| language::phrase(language, text);
    let mut marks = vec![Mark {
        span: d.span,
        text: match d.label.is_empty() {
            true => message(language, "here", &[]).into(),
            false => said(&d.label),
        },
        color: main_color,
    }];
    marks.extend(d.others.iter().take(MAX_PLACES).map(|other| Mark {
        span: other.span,
        text: said(&other.text),
        color: Color::Blue,
    }));
    let main = file_of(findings, d.span);
    marks.sort_by_key(|mark| (file_of(findings, mark.span) != main, mark.span.start));
    let rows = rows(findings, &marks);
    let (source, labels) = excerpt(&rows);
    let heads = heads(findings, d.span, &marks, name);
    let head_of = |span| heads.get(&file_of(findings, span)).cloned();
    let head_of = |span| head_of(span).unwrap_or_default();
    let head = head_of(d.span);
    let heading = format!("{}[{}]", severity(d.severity, language), d.code);
    let detail = said(&d.message);
    let detail = visible_line(&detail);
    let title = title(d, language);
    let marked = |text: &str| match &title {
        Some(_) => format!("{MARK}{text}"),
        None => text.to_owned(),
    };
    let mut report = Report::build(ReportKind::Custom(&heading, main_color), (head, 0..0))
        .with_config(Config::default().with_color(color))
        .with_message(marked(title.as_deref().unwrap_or(&detail)));
    for (range, mark) in labels {
        let label = Label::new((head_of(mark.span), range));
        let label = label.with_message(visible_line(&mark.text));
        report.add_label(label.with_color(mark.color));
    }
    if let Some(help) = &d.help {
        report.add_help(marked(&visible_line(&said(help))));
    }
    let hidden = d.others.len().saturating_sub(MAX_PLACES);
    if hidden > 0 {
        let count = hidden.to_string();
        let places = message(language, "more-places", &[("count", (&count).into())]);
        report.add_note(marked(&places));
    }
    report.add_note(marked(&more(d, language)));
    let mut drawn = Vec::new();
    let sources = heads.values().map(|head| (head.clone(), source.clone()));
    let cache = ariadne::sources(sources);
    report.finish().write(cache, &mut drawn)?;
    let drawn = String::from_utf8_lossy(&drawn);
    let drawn = numbered(&drawn, &rows);
    let drawn = match title {
        Some(_) => translated(&drawn, &detail, language),
        None => drawn,
    };
    Ok(match color {
        true => drawn,
        // The library colours the heading even where colours are off.
        false => anstream::adapter::strip_str(&drawn).to_string(),
    })
}

/// The note on how to read more about a diagnostic.
fn more(d: &Diagnostic, language: Language) -> String {
    let number = d.plc_error.map(|number| number.to_string());
    let id = if number.is_some() {
        "more-of-plc"
    } else {
        "more"
    };
    let arguments = [
        ("code", d.code.into()),
        ("number", number.as_deref().unwrap_or_default().into()),
    ];
    message(language, id, &arguments)
}

/// Start of the file that holds a span, where a program is made of several.
fn file_of(findings: &Findings, span: Span) -> Option<u32> {
    let program = findings.program?;
    Some(program.source.part(span.start)?.start)
}

/// Heads of the files: the place of the finding, and the first place in the others.
fn heads(
    findings: &Findings,
    span: Span,
    marks: &[Mark],
    name: &str,
) -> BTreeMap<Option<u32>, String> {
    let mut heads = BTreeMap::new();
    for span in [span].into_iter().chain(marks.iter().map(|mark| mark.span)) {
        heads.entry(file_of(findings, span)).or_insert_with(|| {
            let head = findings.location(span).unwrap_or_default().headed(name);
            visible_line(&head).into_owned()
        });
    }
    heads
}

/// Severity in a language.
fn severity(severity: Severity, language: Language) -> String {
    let id = match severity {
        Severity::Error => "severity-error",
        Severity::Warning => "severity-warning",
        Severity::Note => "severity-note",
    };
    message(language, id, &[])
}

/// Title of a diagnostic, if the language is not that of its message.
fn title(diagnostic: &Diagnostic, language: Language) -> Option<Cow<'static, str>> {
    let code = codes::find(diagnostic.code).filter(|_| language != Language::English)?;
    Some(language::title(language, code))
}

/// A drawing whose texts begin with a [`MARK`], with the words of a language in place of the library's, and with the
/// message of the diagnostic below the title.
fn translated(drawn: &str, detail: &str, language: Language) -> String {
    let [help, note, colon] = ["help", "note", "colon"].map(|id| message(language, id, &[]));
    let mut text = String::with_capacity(drawn.len() + detail.len());
    for (i, line) in drawn.lines().enumerate() {
        if i == 1 {
            let indent = line.len() - line.trim_start().len();
            text.push_str(&format!("{}{detail}\n", " ".repeat(indent)));
        }
        match line.split_once(MARK) {
            Some((word, rest)) => {
                let word = word.replace("Help", &help).replace("Note", &note);
                let word = word.replacen(':', &colon, 1);
                text.push_str(word.trim_end());
                text.push_str(rest);
            }
            None => text.push_str(line),
        }
        text.push('\n');
    }
    text
}

/// The parts of lines that hold the marks, which are in the order of their places.
fn rows<'a>(findings: &'a Findings, marks: &'a [Mark<'a>]) -> Vec<Row<'a>> {
    let Some(program) = findings.program else {
        return Vec::new();
    };
    let list = program.kind.is_text();
    let mut rows: Vec<Row> = Vec::new();
    for mark in marks {
        let start = mark.span.start as usize;
        if !rows.last().is_some_and(|row| row.window.holds(start)) {
            let number = match list {
                true => Some(program.source.line(mark.span.start)),
                false => findings
                    .location(mark.span)
                    .and_then(|at| at.step.or(at.line)),
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
            row.marks.push(mark);
        }
    }
    rows
}

/// The source that is drawn, each row a line of it, and the range of its characters that each mark covers.
fn excerpt<'a>(rows: &[Row<'a>]) -> (String, Vec<(Range<usize>, &'a Mark<'a>)>) {
    let mut lines = Vec::new();
    let mut labels = Vec::new();
    let mut begin = 0;
    for row in rows {
        // The library knows no line without a character at the end of a source.
        let shown = Some(row.window.shown()).filter(|shown| !shown.is_empty());
        let line = shown.unwrap_or_else(|| " ".to_owned());
        for &mark in &row.marks {
            let from = row.window.column(mark.span.start as usize);
            let to = row.window.column(mark.span.end as usize).max(from);
            // It takes an empty place at the beginning of a line for one in the line before as well.
            let to = to.max(usize::from(from == 0 && begin > 0));
            labels.push((begin + from..begin + to, mark));
        }
        begin += line.chars().count() + GAP.len();
        lines.push(line);
    }
    (lines.join(GAP), labels)
}

/// The drawing of an [`excerpt`] with the numbers of its rows in the margin, which the library numbers 1, 3, 5, …, and
/// no line or column of the excerpt in its head; and without spaces at the ends of lines.
fn numbered(drawn: &str, rows: &[Row]) -> String {
    let mut lines = drawn.lines();
    let mut text = String::with_capacity(drawn.len() + 64);
    let mut push = |line: &str| {
        text.push_str(line.trim_end());
        text.push('\n');
    };
    push(lines.next().unwrap_or_default());
    let head = lines.next().unwrap_or_default();
    let own = head.len() - head.trim_start().len();
    let width = rows.iter().map(|row| row.number.len() + 2).max();
    let wider = width.unwrap_or(0).saturating_sub(own);
    push(&format!("{}{}", " ".repeat(wider), without_place(head)));
    for line in lines {
        let plain = anstream::adapter::strip_str(line).to_string();
        if plain.trim_start().starts_with("├─[ ") {
            push(&format!("{}{}", " ".repeat(wider), without_place(line)));
            continue;
        }
        let (margin, content) = line.split_at(line.find(['│', '─']).unwrap_or(0));
        let blank = margin.trim_end();
        let unnumbered = blank.trim_end_matches(|c: char| c.is_ascii_digit());
        let number = blank[unnumbered.len()..].parse::<usize>().ok();
        push(&match number.and_then(|number| rows.get(number / 2)) {
            Some(row) => {
                let open = unnumbered.trim_end_matches(' ');
                let width = wider + blank.len() - open.len();
                format!("{open}{:>width$} {content}", row.number)
            }
            None => {
                let fill = if content.starts_with('─') {
                    "─"
                } else {
                    " "
                };
                format!("{margin}{}{content}", fill.repeat(wider))
            }
        });
    }
    text
}

/// A head without the line and column that the library adds.
fn without_place(head: &str) -> String {
    let is_number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    // The bracket may be coloured, the place never is.
    let bracket = head.rfind(']').map(|at| &head[..at]);
    let Some((place, _)) = bracket.and_then(|before| before.rsplit_once(' ')) else {
        return head.to_owned();
    };
    let mut parts = place.rsplitn(3, ':');
    match (parts.next(), parts.next(), parts.next()) {
        (Some(column), Some(line), Some(name)) if is_number(column) && is_number(line) => {
            format!("{name}{}", &head[place.len()..])
        }
        _ => head.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Color, Config, Label, Mark, Report, ReportKind, Row, Span};
    use super::{Window, excerpt, numbered};
    use ariadne::Source;

    /// Draws marks in separate rows, each with its number.
    fn drawing(text: &str, marks: &[(&str, u32, u32)], color: bool) -> String {
        let marks: Vec<_> = marks
            .iter()
            .map(|&(number, start, end)| {
                let mark = Mark {
                    span: Span::new(start, end),
                    text: "here".into(),
                    color: Color::Red,
                };
                (number.to_owned(), mark)
            })
            .collect();
        let rows: Vec<_> = marks
            .iter()
            .map(|(number, mark)| Row {
                number: number.clone(),
                window: Window::around(text, mark.span.start as usize, false),
                marks: vec![mark],
            })
            .collect();
        let (source, labels) = excerpt(&rows);
        let mut report = Report::build(ReportKind::Error, ("place", 0..0))
            .with_config(Config::default().with_color(color));
        for (range, mark) in labels {
            report.add_label(Label::new(("place", range)).with_message(&*mark.text));
        }
        let (source, mut drawn) = (Source::from(source), Vec::new());
        let report = report.finish();
        report.write(("place", &source), &mut drawn).unwrap();
        let drawn = numbered(&String::from_utf8(drawn).unwrap(), &rows);
        anstream::adapter::strip_str(&drawn).to_string()
    }

    #[test]
    fn numbers_stand_in_the_margin() {
        let text = "LD 电 Y0\n\nEND\n";
        let marks = [("8", 7, 9), ("", 10, 10), ("123", 11, 14)];
        let expected = "Error:
     ╭─[ place ]
     │
   8 │ LD 电 Y0
     │       ─┬
     │        ╰── here
     │
     │
     │ ┬
     │ ╰── here
     │
 123 │ END
     │ ─┬─
     │  ╰─── here
─────╯
";
        assert_eq!(drawing(text, &marks, false), expected);
        assert_eq!(drawing(text, &marks, true), expected);
    }
}
