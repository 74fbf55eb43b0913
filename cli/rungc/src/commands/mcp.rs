//! `rungc mcp` and `rungc guide`: what assistants get.

use super::{Failure, Outcome, Result, book, demo, eprint_line, print_text};
use crate::args::McpArgs;
use rungc_mcp::{Options, Text};
use std::io::{self, IsTerminal};
use std::path::PathBuf;

/// The page of the book that is the guide.
const GUIDE: &str = "guide";

/// Serves an assistant on standard input and output.
pub fn run(args: &McpArgs) -> Result {
    if io::stdin().is_terminal() {
        eprint_line(
            "rungc: mcp: waiting for a client on standard input; `rungc book assistants` shows how to set one up",
        );
    }
    let mut roots = args.root.clone();
    if roots.is_empty() {
        roots.push(PathBuf::from("."));
    }
    let pages = book::PAGES.iter().map(|page| Text {
        name: page.name,
        title: page.title,
        text: page.text,
    });
    let examples = demo::FILES.iter().map(|(name, text)| Text {
        name,
        title: "Sliding gate, an example project",
        text,
    });
    let options = Options {
        roots,
        write: args.allow_write.clone(),
        guide: text(),
        pages: pages.collect(),
        examples: examples.collect(),
    };
    let served = rungc_mcp::serve_stdio(&options);
    served.map_err(|error| Failure::Because(format!("mcp: {error}")))?;
    Ok(Outcome::Success)
}

/// Prints the guide.
pub fn guide() -> Result {
    print_text(text())?;
    Ok(Outcome::Success)
}

fn text() -> &'static str {
    book::page(GUIDE).map_or("", |page| page.text)
}

#[cfg(test)]
mod tests {
    #[test]
    fn there_is_a_guide_of_a_bounded_length() {
        let words = super::text().split_whitespace().count();
        assert!((500..=2_000).contains(&words), "{words}");
    }
}
