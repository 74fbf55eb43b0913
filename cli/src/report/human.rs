//! Diagnostics for people, drawn by ariadne.

use super::Findings;
use ariadne::{CharSet, Color, Config, IndexType, Label, Report, ReportKind, Source};
use rungc_syntax::{Diagnostic, Severity, Span};
use std::io::{self, Write};

/// Prints at most `limit` diagnostics (0: all) about a program of this name.
pub fn print(
    findings: &Findings,
    name: &str,
    limit: usize,
    color: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    let Some(program) = findings
        .program
        .filter(|_| !findings.diagnostics.is_empty())
    else {
        return Ok(());
    };
    let source = Source::from(one_break(&program.source.text));
    let shown = if limit == 0 {
        findings.diagnostics.len()
    } else {
        limit
    };
    for diagnostic in findings.diagnostics.iter().take(shown) {
        let mut drawn = Vec::new();
        let heading = format!("{}[{}]", diagnostic.severity.name(), diagnostic.code);
        let length = program.source.text.len();
        report(diagnostic, &heading, name, length, color).write((name, &source), &mut drawn)?;
        let drawn = String::from_utf8_lossy(&drawn);
        // The library colours the heading even where colours are off.
        let drawn = if color { drawn } else { plain(&drawn).into() };
        writeln!(out, "{}", tidy(&drawn))?;
    }
    let hidden = findings.diagnostics.len().saturating_sub(shown);
    if hidden > 0 {
        writeln!(out, "… and {hidden} more (--limit 0 prints all)\n")?;
    }
    Ok(())
}

/// The text with line feeds as its only ends of lines, every byte in its place: the library would end lines at other characters
/// as well, and count on from there.
fn one_break(text: &str) -> String {
    let mut chars = text.chars().peekable();
    let mut same = String::with_capacity(text.len());
    while let Some(c) = chars.next() {
        let breaks = match c {
            '\r' => chars.peek() != Some(&'\n'),
            '\u{B}' | '\u{C}' | '\u{85}' | '\u{2028}' | '\u{2029}' => true,
            _ => false,
        };
        match breaks {
            true => same.extend(std::iter::repeat_n(' ', c.len_utf8())),
            false => same.push(c),
        }
    }
    same
}

fn report<'a>(
    d: &Diagnostic,
    heading: &'a str,
    name: &'a str,
    length: usize,
    color: bool,
) -> Report<'a, (&'a str, std::ops::Range<usize>)> {
    let place = |span: Span| {
        let range = span.range();
        (
            name,
            range.start.min(length)..range.end.min(length).max(range.start.min(length)),
        )
    };
    let main_color = match d.severity {
        Severity::Error => Color::Red,
        Severity::Warning => Color::Yellow,
        Severity::Note => Color::Cyan,
    };
    let kind = ReportKind::Custom(heading, main_color);
    let text = if d.label.is_empty() { "here" } else { &d.label };
    let label = |span, text: &str, color| {
        let label = Label::new(place(span)).with_message(text);
        (span.start, label.with_color(color))
    };
    let others = d.others.iter().map(|o| label(o.span, &o.text, Color::Blue));
    // In order of place, or the library draws the source once for each.
    let mut labels: Vec<_> = others.collect();
    labels.push(label(d.span, text, main_color));
    labels.sort_by_key(|(start, _)| *start);
    let config = Config::default()
        .with_color(color)
        .with_index_type(IndexType::Byte)
        .with_char_set(CharSet::Unicode);
    let mut report = Report::build(kind, place(d.span))
        .with_config(config)
        .with_message(&d.message)
        .with_labels(labels.into_iter().map(|(_, label)| label));
    if let Some(help) = &d.help {
        report = report.with_help(help);
    }
    let plc = d
        .plc_error
        .map(|code| format!("the PLC reports this as error {code}; "))
        .unwrap_or_default();
    report
        .with_note(format!("{plc}`rungc explain {}` tells more", d.code))
        .finish()
}

/// A text without the escape sequences that set colours.
fn plain(text: &str) -> String {
    let mut parts = text.split("\u{1b}[");
    let mut plain = parts.next().unwrap_or_default().to_string();
    for part in parts {
        plain.push_str(part.split_once('m').map_or(part, |(_, rest)| rest));
    }
    plain
}

/// Lines without spaces at their ends.
fn tidy(text: &str) -> String {
    text.lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{one_break, plain};

    #[test]
    fn lines_end_at_line_feeds_only() {
        let text = "LD X0 ; a\u{C}b\u{2028}c\r\nEND\r";
        let same = one_break(text);
        assert_eq!(same, "LD X0 ; a b   c\r\nEND ");
        assert_eq!(same.len(), text.len());
    }

    #[test]
    fn colours_are_removed() {
        assert_eq!(plain("\u{1b}[31merror:\u{1b}[0m no"), "error: no");
        assert_eq!(plain("nothing to do"), "nothing to do");
    }
}
