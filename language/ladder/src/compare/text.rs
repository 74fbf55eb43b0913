//! A comparison as text: what differs between two programs, network by network.

use super::{Change, Comparison, Differing, Drawn};
use crate::text::{Style, draw_alike};
use rungc_syntax::align::{Line, lines};
use rungc_syntax::diag::counted;
use std::fmt::{Display, Write as _};

/// Numbers of changes, in one line: `2 networks changed, 1 added`.
pub fn summary(comparison: &Comparison) -> String {
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
    match parts.is_empty() {
        true => "no differences".to_string(),
        false => parts.join(", "),
    }
}

/// Heading for the change of a network.
pub fn heading([old, new]: [Drawn; 2], change: Change) -> String {
    let place = |of: Drawn, at: usize| {
        let first = of.network(at).instrs.start;
        let step = of.resolved.instrs.get(first).map_or(0, |instr| instr.step);
        format!("{} (step {step})", at + 1)
    };
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

/// The lines of a network, each after `-`, `+` or a space, with at most `width` characters after that.
pub fn fragment([before, after]: [Drawn; 2], change: Change, width: u16) -> String {
    let style = Style {
        width: width.into(),
        comments: false,
    };
    let [old, new] = change.places();
    let (old, new) = (old.map(|at| (before, at)), new.map(|at| (after, at)));
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

/// Differing comments of devices, and settings, each after its title.
pub fn tables(comparison: &Comparison) -> Vec<(&'static str, String)> {
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
