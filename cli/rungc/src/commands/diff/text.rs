//! A comparison as text: for a terminal, and as Markdown.

use super::{Compared, counted};
use rungc_ladder::compare::{Change, Differing, Drawn};
use rungc_ladder::text::{Style, draw_alike};
use rungc_syntax::align::{Line, lines};
use std::fmt::{Display, Write as _};
use terminal_size::{Width, terminal_size};

/// Characters on a line where nothing says how many there are.
const USUAL_WIDTH: u16 = 120;
/// Characters on a line that a page of a forge shows.
const PAGE_WIDTH: u16 = 100;

/// Summary of the differences, in one line.
pub fn summary(compared: &Compared) -> String {
    let comparison = &compared.comparison;
    let verbs = ["changed", "added", "removed", "moved", "remarked"];
    let mut parts = Vec::new();
    for verb in verbs {
        let count = comparison.count(verb);
        if count > 0 {
            parts.push(match parts.is_empty() {
                true => format!("{} {verb}", counted(count, "network")),
                false => format!("{count} {verb}"),
            });
        }
    }
    let comments = comparison.comments.len();
    if comments > 0 {
        parts.push(counted(comments, "device comment"));
    }
    let parameters = comparison.parameters.len();
    if parameters > 0 {
        parts.push(counted(parameters, "setting"));
    }
    if parts.is_empty() {
        parts.push("no differences".to_string());
    }
    let mut text = parts.join(", ");
    for words in compared.in_words() {
        let _ = write!(text, "\n{words}");
    }
    text
}

/// For a terminal.
pub fn human(compared: &Compared, width: Option<u16>) -> String {
    let [old, new] = compared.names;
    let terminal = terminal_size().map(|(Width(width), _)| width);
    let width = width.or(terminal).unwrap_or(USUAL_WIDTH);
    let mut out = format!("--- {old}\n+++ {new}\n{}\n", summary(compared));
    for &change in &compared.comparison.networks {
        let _ = writeln!(out, "\n{}", heading(compared, change));
        // Two characters say on which side a line is.
        out.push_str(&fragment(compared, change, width - 2));
    }
    for (title, body) in tables(compared) {
        let _ = write!(out, "\n{title}\n{body}");
    }
    out
}

/// For a comment on a pull request.
pub fn markdown(compared: &Compared, width: Option<u16>) -> String {
    let [old, new] = compared.names.map(|name| name.replace('`', "'"));
    let mut out = format!("### `{old}` → `{new}`\n\n");
    for line in summary(compared).lines() {
        let _ = writeln!(out, "{line}\n");
    }
    let width = width.unwrap_or(PAGE_WIDTH) - 2;
    for &change in &compared.comparison.networks {
        let title = heading(compared, change);
        let _ = write!(
            out,
            "**{title}**\n\n{}\n",
            fenced(&fragment(compared, change, width))
        );
    }
    for (title, body) in tables(compared) {
        let _ = write!(out, "**{title}**\n\n{}\n", fenced(&body));
    }
    out
}

/// A block of Markdown that its content cannot end.
fn fenced(body: &str) -> String {
    let mut fence = "```".to_string();
    while body.contains(&fence) {
        fence.push('`');
    }
    format!("{fence}diff\n{body}{fence}\n")
}

/// Heading for the change of a network.
fn heading(compared: &Compared, change: Change) -> String {
    let place = |of: Drawn, at: usize| {
        let first = of.network(at).instrs.start;
        let step = of.resolved.instrs.get(first).map_or(0, |instr| instr.step);
        format!("{} (step {step})", at + 1)
    };
    let (old, new) = (compared.old, compared.new);
    match change {
        Change::Added { new: at } => format!("Network {} added", place(new, at)),
        Change::Removed { old: at } => format!("Network {} removed", place(old, at)),
        Change::Moved { old: from, new: to } => {
            format!(
                "Network {} moved, before: {}",
                place(new, to),
                place(old, from)
            )
        }
        Change::Changed { old: from, new: to } => {
            format!(
                "Network {} changed, before: {}",
                place(new, to),
                place(old, from)
            )
        }
        Change::Remarked { new: at, .. } => {
            format!("Network {}: statements or notes changed", place(new, at))
        }
    }
}

/// The lines of a network, each after `-`, `+` or a space.
fn fragment(compared: &Compared, change: Change, width: u16) -> String {
    let style = Style {
        width: width.into(),
        comments: false,
    };
    let [old, new] = change.places();
    let (old, new) = (
        old.map(|at| (compared.old, at)),
        new.map(|at| (compared.new, at)),
    );
    let drawn = |of: Drawn<'_>, at: usize| match change {
        Change::Remarked { .. } => Some(remarks(of, at)),
        _ => None,
    };
    let mut texts = [old, new].map(|side| side.and_then(|(of, at)| drawn(of, at)));
    if texts == [None, None] {
        let sides: Vec<_> = [old, new].into_iter().flatten().collect();
        let networks: Vec<_> = sides
            .iter()
            .map(|(of, at)| (of.resolved, of.network(*at)))
            .collect();
        let mut all = draw_alike(&networks, style).into_iter();
        texts = [old, new].map(|side| side.and_then(|_| all.next()));
    }
    let [old, new] = texts.map(Option::unwrap_or_default);
    let mut out = String::new();
    for line in lines(&old, &new) {
        let _ = match line {
            Line::Same(line) => writeln!(out, "  {line}"),
            Line::Old(line) => writeln!(out, "- {line}"),
            Line::New(line) => writeln!(out, "+ {line}"),
        };
    }
    out
}

/// The list of a network with its statements and notes.
fn remarks(of: Drawn<'_>, at: usize) -> String {
    let mut out = String::new();
    for instr in &of.resolved.program.instrs[of.network(at).instrs.clone()] {
        for line in instr.statement().into_iter().flat_map(str::lines) {
            let _ = writeln!(out, "; {line}");
        }
        let note = instr.note().map(|note| format!("  ; {note}"));
        let _ = writeln!(out, "{instr}{}", note.unwrap_or_default());
    }
    out
}

/// Comments of devices, and settings.
fn tables(compared: &Compared) -> Vec<(&'static str, String)> {
    let comparison = &compared.comparison;
    let tables = [
        ("Device comments", table(&comparison.comments)),
        ("Settings", table(&comparison.parameters)),
    ];
    tables
        .into_iter()
        .filter(|(_, body)| !body.is_empty())
        .collect()
}

fn table<K: Display>(differing: &[Differing<K>]) -> String {
    let mut out = String::new();
    for Differing { key, old, new } in differing {
        for (sign, value) in [('-', old), ('+', new)] {
            if let Some(value) = value {
                let value = rungc_syntax::text::one_line(value);
                let _ = writeln!(out, "{sign} {key} = {value}");
            }
        }
    }
    out
}
