//! Kinds of files, by their content.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
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
    /// A model or a formula for other provers: AIGER, BTOR2, CNF.
    Proof,
    /// A proof in DRAT. A solver writes it, so that it names no author.
    Refutation,
    /// A table of uses of devices, or of samples.
    Table,
    /// A report, human-readable or for programs: JSON, SARIF, JUnit, LCOV.
    Report,
    /// A functional mock-up unit.
    Fmu,
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
            let own = content.ends_with(b"c\nrungc\n");
            return if own { Kind::Proof } else { Kind::Own };
        }
        if content.starts_with(b"PK\x03\x04") {
            let own = is_unit(content);
            return if own { Kind::Fmu } else { Kind::Own };
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
        match ends(path) {
            Ok(content) => self != Kind::Own && (content.is_empty() || Kind::of(&content) == self),
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

/// The parts of a file that show its kind: the head, and of a longer one a piece of the end.
fn ends(path: &Path) -> io::Result<Vec<u8>> {
    /// Size of the piece, in bytes.
    const END: i64 = 16;
    let mut file = File::open(path)?;
    let mut content = Vec::new();
    (&mut file).take(HEAD).read_to_end(&mut content)?;
    if file.metadata()?.len() > HEAD && content.starts_with(b"aig ") {
        file.seek(SeekFrom::End(-END))?;
        file.read_to_end(&mut content)?;
    }
    Ok(content)
}

/// Kind of a text.
fn of_text(text: &str) -> Option<Kind> {
    let start = text.trim_start();
    let first = start.lines().next().unwrap_or_default();
    let kind = if start.starts_with("<!DOCTYPE html>") && is_page(start) {
        Kind::Html
    } else if start.starts_with("<svg height=\"") && is_drawing(start) {
        Kind::Svg
    } else if start.starts_with("<?xml") && start.contains("<testsuites name=\"rungc") {
        Kind::Report
    } else if start.starts_with("$version") && start.contains("rungc") {
        Kind::Vcd
    } else if first == "TN:rungc" {
        Kind::Report
    } else if first == "c rungc" || is_model(start) {
        Kind::Proof
    } else if is_refutation(start) {
        Kind::Refutation
    } else if start.starts_with('{') && is_document(start) {
        Kind::Report
    } else if first.starts_with("first,last,comment,network,") || is_samples(first) {
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

/// Returns true for a functional mock-up unit: an archive that begins with its description, which is not compressed.
fn is_unit(archive: &[u8]) -> bool {
    /// Start of the name of the first file.
    const NAME: usize = 30;
    const TOOL: &[u8] = b" generationTool=\"rungc ";
    let named = archive.get(NAME..);
    named.is_some_and(|name| name.starts_with(b"modelDescription.xml"))
        && archive.windows(TOOL.len()).any(|word| word == TOOL)
}

/// Returns true for a page, by the beginning of its style sheet.
fn is_page(text: &str) -> bool {
    const STYLES: [&str; 2] = [
        ":root { color-scheme: light dark; --paper: #fff; --ink: ",
        ":root { color-scheme: light dark; }\nbody { margin: 0; font: 14px/1.4 system-ui, ",
    ];
    STYLES.iter().any(|style| text.contains(style))
}

/// Returns true for a drawing, by what a ladder or a diagram begins with.
fn is_drawing(text: &str) -> bool {
    let mut lines = text.lines().skip(1);
    let second = lines.next().unwrap_or_default();
    let third = lines.next().unwrap_or_default();
    let is_ladder = second == "<style>" && third.starts_with("svg { font: 12px ui-monospace, ");
    is_ladder || second.starts_with("<rect fill=\"#ffffff\" height=\"")
}

/// Returns true for the heading of samples: the time, and devices.
fn is_samples(line: &str) -> bool {
    let Some(columns) = line.strip_prefix("time_ms,") else {
        return false;
    };
    let is_device = |column: &str| {
        let number = column.trim_start_matches(|c: char| c.is_ascii_uppercase());
        number.len() < column.len() && number.starts_with(|c: char| c.is_ascii_digit())
    };
    columns.split(',').all(is_device)
}

/// Returns true for the beginning of one of rungc's documents: the first of its keys, and one that comes with it.
fn is_document(text: &str) -> bool {
    const KEYS: [(&str, &str); 9] = [
        ("$schema", "\"name\": \"rungc\""),
        // The name may come far below verdicts.
        ("$schema", "\"verifications\": ["),
        ("comments", "\n  \"differs\": "),
        ("errors", "\n  \"notes\": "),
        ("file", "\n  \"warnings\": "),
        ("model", "\n  \"devices\": ["),
        ("passed", "\n  \"seconds\": "),
        ("programs", "\n      \"file\": "),
        ("report", "\n  \"rungc\": "),
    ];
    let first = text.split('"').nth(1).unwrap_or_default();
    let mut keys = KEYS.iter();
    keys.any(|(key, other)| *key == first && text.contains(other))
}

/// Returns true for a proof in DRAT: numbers that end in 0.
fn is_refutation(text: &str) -> bool {
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
    text.starts_with("; rungc: ")
        && code
            .next()
            .is_some_and(|line| line.starts_with("1 sort bitvec "))
}

/// Returns true for a line of a log of frames: its time, the direction, and the bytes.
fn is_frame(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let time = words.next().and_then(|word| word.split_once('.'));
    let bytes = line.trim_end().strip_suffix(']');
    let bytes = bytes.and_then(|line| line.rsplit_once("  ["));
    let is_byte = |word: &str| word.len() == 2 && u8::from_str_radix(word, 16).is_ok();
    time.is_some_and(|(s, us)| us.len() == 6 && s.parse::<u64>().is_ok())
        && (line.contains(" <- ") || line.contains(" -> "))
        && bytes.is_some_and(|(_, bytes)| bytes.split(' ').all(is_byte))
}

/// Returns true for a report: of `test`, its coverage and its mutants, of `diff`, `verify` and `xref`.
fn is_report(text: &str) -> bool {
    const VERDICTS: [&str; 5] = ["proved", "violated", "reached", "not", "differs"];
    let mut lines = text.lines();
    let mut line = || lines.next().unwrap_or_default();
    let (first, second, third) = (line(), line(), line());
    let last = text.trim_end().lines().last().unwrap_or_default();
    // In patches, the place of the first change follows.
    let is_patch = third.starts_with("@@") || third.is_empty();
    let compared = first.starts_with("--- ") && second.starts_with("+++ ") && !is_patch;
    let compared = compared || first.starts_with("### `") && first.contains("` → `");
    let uses = second.starts_with("    network ") && second.contains(" step ");
    let words: Vec<_> = last.split(' ').collect();
    let cases = matches!(words[..], [n, "passed,", m, ..] if is_number(n) && is_number(m));
    let word = first.split(' ').next().unwrap_or_default();
    let verdict = VERDICTS.contains(&word) && ends_in_seconds(first);
    let verdict = verdict || first.starts_with("the same    ");
    compared
        || uses
        || cases && ends_in_seconds(last)
        || verdict
        || is_share(first)
        || first.contains(" mutants noticed")
        || first.starts_with("::error file=")
}

fn is_number(word: &str) -> bool {
    !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit())
}

/// Returns true for a line that ends in a time: `(0.2 s)`.
fn ends_in_seconds(line: &str) -> bool {
    let time = line
        .strip_suffix(" s)")
        .and_then(|line| line.rsplit_once('('));
    let parts = time.and_then(|(_, time)| time.split_once('.'));
    parts.is_some_and(|(whole, rest)| is_number(whole) && is_number(rest))
}

/// Returns true for a share after what it is of: `motor.il: 3 of 5 (60 %)`.
fn is_share(line: &str) -> bool {
    let words = line.rsplit(": ").next().unwrap_or_default();
    let words: Vec<_> = words.split(' ').collect();
    matches!(words[..], [n, "of", m, percent, "%)"]
        if is_number(n) && is_number(m) && percent.strip_prefix('(').is_some_and(is_number))
}
