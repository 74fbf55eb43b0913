//! Texts that are not programs: what shows each, which an instruction list does not have.

use super::Recognised;
use crate::csv;
use crate::il::is_basic;

const RECORDS: &str = "name the program that the memory was made of";
const BYTES: &str = "name the file that the bytes are of; `xxd -r` and `base64 -d` make it again";
const WRITING: &str = "copy the instruction list in it into a text file";
const BUILT: &str = "rungc compiles programs of PLCs: name the program";

/// Returns true if lines are the rows of a table with instructions. A row of a drawn ladder has wires.
fn is_markdown(lines: &[&str]) -> bool {
    let is_row = |line: &&&str| line.starts_with('|') && !line.contains("--");
    let mut rows = lines.iter().filter(is_row);
    rows.any(|line| line.split('|').any(|cell| is_basic(cell.trim())))
}

/// A text whose lines may look like instructions, but which cannot be read as a program.
pub(super) fn spoilt(lines: &[&str]) -> Option<Recognised> {
    let first = *lines.first()?;
    let any = |prefix: &str| lines.iter().any(|line| line.starts_with(prefix));
    let is = |what, help| Some(Recognised { what, help });
    if first.starts_with("version https://git-lfs.github.com/spec/") {
        return is(
            "a pointer of Git LFS, not the file itself",
            "fetch the file with `git lfs pull`",
        );
    }
    if any("<<<<<<< ") && any(">>>>>>> ") {
        return is(
            "a file with unresolved merge conflicts",
            "resolve the conflict between `<<<<<<<` and `>>>>>>>`, and remove these marks",
        );
    }
    if any("diff --git ") || any("@@ -") && any("+++ ") {
        return is(
            "a patch (diff)",
            "apply it, and name the changed program; `rungc diff` compares programs",
        );
    }
    if lines.iter().all(|line| is_intel_hex(line)) {
        return is("an image (Intel HEX)", RECORDS);
    }
    if lines.iter().all(|line| is_s_record(line)) {
        return is("an image (Motorola S-record)", RECORDS);
    }
    if lines.iter().all(|line| is_dump(line)) {
        return is("a dump of bytes, written as text", BYTES);
    }
    if is_base64(lines) {
        return is("bytes written as text (base64)", BYTES);
    }
    if any("```") {
        return is("a text in Markdown", WRITING);
    }
    if csv::is_cross_reference(lines) {
        return is(
            "a cross-reference table",
            "name the program that it was made of, or export that as a list (CSV)",
        );
    }
    None
}

/// A text without instructions.
pub(super) fn other(name: &str, text: &str, lines: &[&str]) -> Option<Recognised> {
    let first = *lines.first()?;
    let any = |prefixes: &[&str]| {
        lines
            .iter()
            .any(|line| prefixes.iter().any(|prefix| line.starts_with(prefix)))
    };
    let is = |what, help| Some(Recognised { what, help });
    let is_named = |ending: &str| {
        let ends = name
            .len()
            .checked_sub(ending.len())
            .and_then(|at| name.get(at..));
        ends.is_some_and(|end| end.eq_ignore_ascii_case(ending))
    };
    if first.starts_with("<?xml") && (text.contains("<testsuites") || text.contains("<testsuite "))
    {
        return is(
            "a report of tests (JUnit)",
            "run the tests with `rungc test`",
        );
    }
    if first.starts_with("first,last,comment,network,step,use,instruction") {
        return is(
            "a cross-reference of rungc",
            "name the program that it was made of",
        );
    }
    if is_markdown(lines) {
        return is(
            "a table (Markdown)",
            "write a line for each row, such as `LD X000`, or save the table as CSV",
        );
    }
    let is_table = first.starts_with("time ") || first.starts_with("time,");
    if is_table
        || lines
            .get(1)
            .is_some_and(|line| line.starts_with("network "))
    {
        return is("a report of rungc", "name the program that it was made of");
    }
    if any(&["From: ", "Received: ", "Return-Path: "]) && any(&["Subject: ", "To: "]) {
        return is("a message (e-mail)", WRITING);
    }
    if any(&["[package]", "[workspace]", "[dependencies]", "[[package]]"]) {
        return is("a file of a Rust package", BUILT);
    }
    if any(&["cmake_minimum_required", "add_library(", "add_executable("]) {
        return is("a file of CMake", BUILT);
    }
    if is_named("makefile") || any(&[".PHONY", "CFLAGS"]) {
        return is("a makefile", BUILT);
    }
    let code = lines.iter().filter(|line| !line.starts_with([';', '#']));
    let code: Vec<&str> = code.copied().collect();
    let is_section = |line: &&str| line.starts_with('[') && line.ends_with(']');
    let is_setting = |line: &&str| is_section(line) || line.contains('=');
    if code.first().is_some_and(is_section) && code.iter().all(is_setting) {
        return is("a file of settings (INI)", "name the program");
    }
    let is_key = |line: &&str| {
        let line = line.strip_prefix("- ").unwrap_or(line);
        let key = line
            .split_once(':')
            .filter(|(_, rest)| rest.is_empty() || rest.starts_with(' '));
        key.is_some_and(|(key, _)| !key.contains(char::is_whitespace))
    };
    let of_yaml = |line: &&str| is_key(line) || line.starts_with("- ");
    let has_keys = code.iter().filter(|line| is_key(line)).count() > 1;
    if first == "---" && code.len() > 1 || has_keys && code.iter().all(of_yaml) {
        return is("a file of settings (YAML)", "name the program");
    }
    let heading = first.trim_start_matches('#');
    if heading.len() < first.len() && heading.starts_with(' ') {
        return is("a text in Markdown, or a script", WRITING);
    }
    None
}

/// Returns true for a record of Intel HEX.
fn is_intel_hex(line: &str) -> bool {
    let digits = line.strip_prefix(':').unwrap_or_default();
    digits.len() >= 10 && digits.bytes().all(|b| b.is_ascii_hexdigit())
}

/// Returns true for a line of bytes in hexadecimal after their address, as `xxd`, `hexdump -C` and `od -t x1` write it.
fn is_dump(line: &str) -> bool {
    let is_hex = |word: &str| word.bytes().all(|b| b.is_ascii_hexdigit());
    let mut words = line.split_whitespace();
    let address = words.next().unwrap_or_default();
    let address = address.strip_suffix(':').unwrap_or(address);
    let is_address = (6..=16).contains(&address.len()) && is_hex(address);
    // The last line may hold the size alone.
    let are_bytes = |word: &str| matches!(word.len(), 2 | 4 | 8) && is_hex(word);
    is_address && words.next().is_none_or(are_bytes)
}

/// Returns true for lines of base64, or of hexadecimal digits alone: long ones, of one length but for the last.
fn is_base64(lines: &[&str]) -> bool {
    let [first, rest @ ..] = lines else {
        return false;
    };
    let is_digit = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'+' | b'/' | b'=');
    let fits = |line: &&str| line.len() <= first.len() && line.bytes().all(is_digit);
    let whole = rest.split_last().map_or(&[][..], |(_, whole)| whole);
    let is_even = whole.iter().all(|line| line.len() == first.len());
    first.len() >= 40 && first.len() % 4 == 0 && is_even && lines.iter().all(fits)
}

/// Returns true for a Motorola S-record.
fn is_s_record(line: &str) -> bool {
    let digits = line.strip_prefix('S').unwrap_or_default();
    digits.len() >= 9 && digits.bytes().all(|b| b.is_ascii_hexdigit())
}
