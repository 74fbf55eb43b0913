//! Kinds of files, by their content.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Kind of a file that a command writes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// A page.
    Html,
    /// A drawing.
    Svg,
    /// A document.
    Pdf,
    /// A recording of signals.
    Vcd,
    /// A capture of frames.
    Capture,
    /// A log of frames.
    Frames,
    /// A model or a formula for other provers: AIGER, BTOR2, CNF, DRAT.
    Proof,
    /// A table of uses of devices, or of samples.
    Table,
    /// A report, human-readable or for programs: JSON, SARIF, JUnit, LCOV.
    Report,
    /// A file that people write or edit, or that has no recognisable content: it is never replaced unasked.
    Own,
}

/// Size of the part of a file that shows its kind, in bytes.
const HEAD: u64 = 64 << 10;

impl Kind {
    /// Kind of a content, as rungc writes it.
    pub fn of(content: &[u8]) -> Kind {
        if content.starts_with(b"%PDF-") {
            let own = content.windows(5).any(|word| word == b"rungc");
            return if own { Kind::Pdf } else { Kind::Own };
        }
        if content.starts_with(b"aig ") {
            return Kind::Proof;
        }
        // A section header without options; other tools name themselves there.
        if content.starts_with(&[0x0A, 0x0D, 0x0D, 0x0A, 28, 0, 0, 0]) {
            return Kind::Capture;
        }
        let text = match std::str::from_utf8(content) {
            Ok(text) => text,
            // A character may be cut at the end of the head.
            Err(error) if error.error_len().is_none() => {
                std::str::from_utf8(&content[..error.valid_up_to()]).unwrap_or_default()
            }
            Err(_) => return Kind::Own,
        };
        of_text(text).unwrap_or(Kind::Own)
    }

    /// Returns true if the file at a path is an earlier result of this kind, or empty.
    pub fn replaces(self, path: &Path) -> bool {
        let mut head = Vec::new();
        let read = File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
        match read {
            Ok(length) => self != Kind::Own && (length == 0 || Kind::of(&head) == self),
            Err(_) => false,
        }
    }

    /// The difference of the file that is there, for a message.
    pub fn difference(self) -> &'static str {
        match self {
            Kind::Own => "",
            _ => " and is not an earlier result of this kind",
        }
    }
}

/// Kind of a text.
fn of_text(text: &str) -> Option<Kind> {
    let start = text.trim_start();
    let first = start.lines().next().unwrap_or_default();
    let kind = if start.starts_with("<!DOCTYPE html>") && start.contains(":root { color-scheme:") {
        Kind::Html
    } else if start.starts_with("<svg height=\"") {
        Kind::Svg
    } else if start.starts_with("<?xml") && start.contains("<testsuites name=\"rungc") {
        Kind::Report
    } else if start.starts_with("$version") && start.contains("rungc") {
        Kind::Vcd
    } else if start.starts_with("TN:") {
        Kind::Report
    } else if first.starts_with("p cnf ") || is_proof(start) || is_model(start) {
        Kind::Proof
    } else if start.starts_with('{') && is_document(start) {
        Kind::Report
    } else if first.starts_with("first,last,comment,network,") || first.starts_with("time_ms,") {
        Kind::Table
    } else if is_frame(first) {
        Kind::Frames
    } else if is_report(start) {
        Kind::Report
    } else {
        return None;
    };
    Some(kind)
}

/// Returns true for the beginning of one of rungc's documents, by the first of its keys.
fn is_document(text: &str) -> bool {
    const KEYS: [&str; 9] = [
        "$schema",
        "comments",
        "differs",
        "diagnostics",
        "file",
        "files",
        "model",
        "passed",
        "programs",
    ];
    let first = text.split('"').nth(1).unwrap_or_default();
    let sarif = first != "$schema" || text.contains("sarif-2.1.0");
    KEYS.contains(&first) && sarif
}

/// Returns true for a proof in DRAT: numbers that end in 0.
fn is_proof(text: &str) -> bool {
    let mut lines = text
        .lines()
        .filter(|line| !line.is_empty())
        .take(8)
        .peekable();
    lines.peek().is_some()
        && lines.all(|line| {
            let mut words = line.strip_prefix("d ").unwrap_or(line).split(' ');
            let end = words.next_back() == Some("0");
            end && words.all(|word| word.parse::<i64>().is_ok())
        })
}

/// Returns true for a model in BTOR2, as rungc writes it.
fn is_model(text: &str) -> bool {
    let mut code = text.lines().filter(|line| !line.starts_with(';'));
    code.next()
        .is_some_and(|line| line.starts_with("1 sort bitvec "))
}

/// Returns true for a line of a log of frames: its time, and the direction.
fn is_frame(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let time = words.next().and_then(|word| word.split_once('.'));
    time.is_some_and(|(s, us)| us.len() == 6 && s.parse::<u64>().is_ok())
        && (line.contains(" <- ") || line.contains(" -> "))
}

/// Returns true for a report: of `test`, its coverage and its mutants, of `diff`, `verify` and `xref`.
fn is_report(text: &str) -> bool {
    const VERDICTS: [&str; 5] = ["proved", "violated", "reached", "not", "differs"];
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default();
    let second = lines.next().unwrap_or_default();
    let last = text.trim_end().lines().last().unwrap_or_default();
    let compared = first.starts_with("--- ") && second.starts_with("+++ ");
    let compared = compared || first.starts_with("### `") && first.contains("` → `");
    let uses = second.starts_with("    network ") && second.contains(" step ");
    let cases = last.contains(" passed, ") && last.ends_with(" s)");
    let word = first.split(' ').next().unwrap_or_default();
    let verdict = VERDICTS.contains(&word) && first.ends_with(" s)");
    let verdict = verdict || first.starts_with("the same    ");
    let share =
        first.contains(" mutants noticed") || first.contains(" of ") && first.ends_with(" %)");
    compared || uses || cases || verdict || share || first.starts_with("::error file=")
}
