//! The shape of the sources: lines of at most 120 columns, functions of at most 80 lines, files of at most 700; and
//! that nothing large is kept in the repository.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use walkdir::WalkDir;

/// Columns of a line of code or of a comment. What string literals hold does not count: a text is broken where its
/// reader needs it.
const COLUMNS: usize = 120;

/// Lines of a function, from the one that names it to its closing brace.
const FUNCTION_LINES: usize = 80;

/// Bytes of any file in the repository: what is larger is output of a build or a recording, which a script makes again.
const FILE_BYTES: u64 = 128 * 1024;

/// Lines of a file.
const FILE_LINES: usize = 700;

/// Templates, which are broken as emitted text is, and output of builds.
const LEFT_OUT: &[&str] = &["target", "node_modules", "templates"];

/// Files whose comments are those of the emitted header, which is broken at its own width.
const HEADER: &[&str] = &[
    "runtime-rt/rt/src/capi.rs",
    "runtime-rt/rt/src/capi/exports.rs",
    "runtime-rt/rt/src/capi_virtual.rs",
    "runtime-rt/rt/src/comm/line.rs",
    "runtime-rt/rt/src/comm/memory.rs",
    "runtime-rt/rt/src/operand.rs",
    "runtime-rt/rt/src/plc.rs",
];

/// Functions that have an arm or a replacement for each of many things, with their lines.
const LONG: &[(&str, &str, usize)] = &[("sim/sim/src/engines/interpreter.rs", "execute", 91)];

/// A source with nothing in its string literals; it has as many lines as before.
fn without_texts(source: &str) -> String {
    let mut rest = source;
    let mut out = String::with_capacity(source.len());
    while let Some(at) = rest.find(['"', '\'', '/']) {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let hashes = before.len() - before.trim_end_matches('#').len();
        let is_raw = before.trim_end_matches('#').ends_with('r') && from.starts_with('"');
        let length = match from.as_bytes() {
            [b'/', b'/', ..] => from.find('\n').unwrap_or(from.len()),
            [b'/', b'*', ..] => from.find("*/").map_or(from.len(), |end| end + 2),
            [b'"', ..] if is_raw => {
                let end = format!("\"{}", "#".repeat(hashes));
                from[1..].find(&end).map_or(from.len(), |at| at + 2)
            }
            [b'"', ..] => quoted(from),
            [b'\'', b'\\', ..] => from[2..].find('\'').map_or(1, |at| at + 3),
            // A character; otherwise a lifetime.
            [b'\'', ..] => match from.char_indices().nth(2) {
                Some((at, '\'')) => at + 1,
                _ => 1,
            },
            _ => 1,
        };
        let (token, after) = from.split_at(length);
        match token.starts_with('"') {
            true => out.extend(token.chars().filter(|&c| c == '\n')),
            false => out.push_str(token),
        }
        rest = after;
    }
    out + rest
}

/// Bytes of the string literal that a text starts with.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    let end = text[1..].find(|c| {
        let ends = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |end| end + 2)
}

/// Names and lengths of the functions of a source, which rustfmt has formatted.
fn functions(source: &str) -> Vec<(&str, usize)> {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let lines: Vec<&str> = source.lines().collect();
    let mut found = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let words = line.trim_start();
        let Some((before, name)) = words.split_once("fn ") else {
            continue;
        };
        let qualifiers = ["pub", "pub(crate) ", "pub(super) ", "const ", "extern "];
        let is_head = before.is_empty() || qualifiers.iter().any(|word| before.starts_with(word));
        if !is_head || line.ends_with(['}', ';']) {
            continue;
        }
        let of_head = |other: &&str| indent(other) == indent(line) && !other.trim().is_empty();
        let after = lines[i + 1..].iter().zip(2..);
        let mut after = after.filter(|(other, _)| of_head(other));
        let end =
            after.find(|(other, _)| other.trim_start().starts_with('}') || other.ends_with(';'));
        let length = end.map_or(lines.len() - i, |(_, length)| length);
        let name = name.split(['(', '<']).next().unwrap_or(name);
        found.push((name, length));
    }
    found
}

/// Parts of a source that are too long.
fn too_long(name: &str, source: &str) -> Vec<String> {
    let mut found = Vec::new();
    let code = without_texts(source);
    for (number, line) in code.lines().enumerate() {
        let columns = line.chars().count();
        // A row of a table cannot be broken.
        let is_row = line.trim_start_matches([' ', '/', '!']).starts_with('|');
        if columns > COLUMNS && !is_row && !HEADER.contains(&name) {
            found.push(format!("{name}:{}: {columns} columns", number + 1));
        }
    }
    for (function, lines) in functions(&code) {
        let known = LONG
            .iter()
            .find(|long| (long.0, long.1) == (name, function));
        if lines > known.map_or(FUNCTION_LINES, |long| long.2) {
            found.push(format!("{name}: `{function}` has {lines} lines"));
        }
    }
    let lines = source.lines().count();
    if lines > FILE_LINES {
        found.push(format!("{name} has {lines} lines"));
    }
    found
}

#[test]
fn nothing_is_too_long() {
    let root = PathBuf::from(env!("RUNGC_ROOT"));
    let is_ours = |entry: &walkdir::DirEntry| {
        let name = entry.file_name().to_string_lossy();
        entry.depth() == 0 || !name.starts_with('.') && !LEFT_OUT.contains(&name.as_ref())
    };
    let (mut found, mut files) = (Vec::new(), 0);
    for entry in WalkDir::new(&root).into_iter().filter_entry(is_ours) {
        let path = entry.unwrap().into_path();
        if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(&root).unwrap().display().to_string();
            found.extend(too_long(&name, &fs::read_to_string(&path).unwrap()));
            files += 1;
        }
    }
    assert!(files > 500, "only {files} files were read");
    assert!(found.is_empty(), "{}:\n{}", found.len(), found.join("\n"));
}

#[test]
fn no_file_is_large() {
    let root = PathBuf::from(env!("RUNGC_ROOT"));
    if !root.join(".git").exists() {
        eprintln!("not a repository: which files belong to it is not known");
        return;
    }
    let listed = Command::new("git")
        .args(["ls-files", "-z"])
        .current_dir(&root)
        .output();
    let listed = String::from_utf8(listed.unwrap().stdout).unwrap();
    let files: Vec<&str> = listed.split_terminator('\0').collect();
    assert!(files.len() > 1000, "only {} files are listed", files.len());
    let large = files.iter().filter(|file| {
        // A file that has just been removed is still listed.
        fs::metadata(root.join(file)).is_ok_and(|file| file.len() > FILE_BYTES)
    });
    assert_eq!(large.collect::<Vec<_>>(), [&""; 0]);
}

#[test]
fn what_is_too_long_is_found() {
    let comment = format!("// {}\n", "word ".repeat(30));
    assert_eq!(too_long("a.rs", &comment), ["a.rs:1: 153 columns"]);
    let text = "word ".repeat(30);
    let strings = format!(
        "const A: &str = \"{text}\\\"{text}\n{text}\";\nconst B: &str = r#\"\"{text}\"#;\n"
    );
    assert_eq!(too_long("a.rs", &strings), [""; 0]);
    let quotes = format!("const A: [char; 2] = ['\"', '\\''];\nfn a<'b>() {{}} // \"{text}\n");
    assert_eq!(too_long("a.rs", &quotes).len(), 1);
    let body = "        let a = 1;\n".repeat(79);
    let function =
        format!("impl A {{\n    pub fn a(\n        b: u8,\n    ) -> u8 {{\n{body}    }}\n}}\n");
    assert_eq!(too_long("a.rs", &function), ["a.rs: `a` has 83 lines"]);
    let short = format!(
        "trait A {{\n    fn a(\n        b: u8,\n    );\n    fn c() {{\n{}    }}\n}}\n",
        &body[..19 * 78]
    );
    assert_eq!(too_long("a.rs", &short), [""; 0]);
    assert_eq!(too_long("a.rs", &"\n".repeat(701)), ["a.rs has 701 lines"]);
}
