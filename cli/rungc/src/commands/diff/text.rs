//! A comparison as text: for a terminal, and as Markdown.

use super::Compared;
use rungc_ladder::compare::{Drawn, text};
use std::fmt::Write as _;
use terminal_size::{Width, terminal_size};

/// Characters on a line where nothing says how many there are.
const USUAL_WIDTH: u16 = 120;
/// Characters on a line that a page of a forge shows.
const PAGE_WIDTH: u16 = 100;

/// Summary of the differences, in one line.
pub fn summary(compared: &Compared) -> String {
    let mut text = text::summary(&compared.comparison);
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
        let _ = writeln!(out, "\n{}", text::heading(sides(compared), change));
        // Two characters say on which side a line is.
        out.push_str(&text::fragment(sides(compared), change, width - 2));
    }
    for (title, body) in text::tables(&compared.comparison) {
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
        let title = text::heading(sides(compared), change);
        let _ = write!(
            out,
            "**{title}**\n\n{}\n",
            fenced(&text::fragment(sides(compared), change, width))
        );
    }
    for (title, body) in text::tables(&compared.comparison) {
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

fn sides<'a>(compared: &Compared<'a>) -> [Drawn<'a>; 2] {
    [compared.old, compared.new]
}
