//! `rungc book`.

use super::{Context, Failure, Outcome, Result, explain, print_text};
use crate::args::{BookArgs, ExplainArgs};
use rungc_syntax::diag;
use std::fmt::Write;

/// A page of the book.
#[derive(Debug)]
pub struct Page {
    /// Path below the book's sources, without its extension.
    pub name: &'static str,
    /// Title in the table of contents.
    pub title: &'static str,
    /// Markdown.
    pub text: &'static str,
}

/// Pages in the order of the book.
pub const PAGES: &[Page] = include!(concat!(env!("OUT_DIR"), "/pages.rs"));

/// Prints a page of the book, or lists all.
pub fn run(args: &BookArgs, cx: Context) -> Result {
    let Some(name) = &args.page else {
        print_text(&contents())?;
        return Ok(Outcome::Success);
    };
    if let Some(page) = page(name) {
        print_text(page.text)?;
        return Ok(Outcome::Success);
    }
    let topic = plain(name);
    let topic = topic.rsplit('/').next().unwrap_or_default();
    let topic = ExplainArgs {
        topic: topic.to_string(),
        model: None,
    };
    let explained = explain::page(&topic, cx.language.language());
    let text = explained.ok_or_else(|| {
        let near = diag::did_you_mean(&plain(name), PAGES.iter().map(|page| page.name));
        let hint = near.map_or_else(
            || "`rungc book` lists the pages".to_string(),
            |near| format!("did you mean `{near}`?"),
        );
        Failure::Because(format!("the book has no page `{name}`; {hint}"))
    })?;
    print_text(&format!("{}\n", text.trim_end()))?;
    Ok(Outcome::Success)
}

/// The page of this name, as `rungc book` lists it or by its path in the repository.
pub fn page(name: &str) -> Option<&'static Page> {
    let name = plain(name);
    PAGES.iter().find(|page| page.name == name)
}

fn plain(name: &str) -> String {
    let name = name.trim().to_lowercase();
    let name = name.strip_prefix("docs/src/").unwrap_or(&name);
    let name = name.split('#').next().unwrap_or_default();
    name.strip_suffix(".md").unwrap_or(name).to_string()
}

/// All pages, a line each.
fn contents() -> String {
    let mut text = "Pages of the book; `rungc book PAGE` prints one:\n\n".to_string();
    let width = PAGES.iter().map(|page| page.name.len()).max().unwrap_or(0);
    for Page { name, title, .. } in PAGES {
        let _ = writeln!(text, "  {name:width$}  {title}");
    }
    text + "\nChecks, instructions, special devices and error codes: `rungc explain TOPIC`. Commands: `rungc help COMMAND`.\n"
}
