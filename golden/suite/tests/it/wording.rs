//! Plain English in documents, help, messages and comments: phrases that are not idiomatic, with what to write instead.

use std::fs;
use std::path::PathBuf;
use walkdir::WalkDir;

/// Phrases to avoid, in lower case, and better ones.
const PHRASES: &[(&str, &str)] = &[
    ("behind", "after"),
    ("tells", "says, reports, shows"),
    ("told", "reported, given"),
    ("for people", "human-readable"),
    ("manieth", "n-th"),
    ("no say", "is ignored"),
    ("begin of", "start of"),
    ("the begin", "the start"),
    ("its begin", "its start"),
    ("and its like", "and similar ones"),
    ("and their like", "and similar ones"),
    ("and kin", "and related ones"),
    ("their kin", "related ones"),
    ("its kin", "related ones"),
    ("besides", "also, in addition to"),
    ("nobody", "no one, nothing"),
    ("so many", "this many, N"),
    ("so much", "this much, N"),
    ("goes on", "continues, turns on"),
    ("go on", "continue, turn on"),
    ("went on", "continued, turned on"),
    ("of its own", "separate, its own …"),
    ("of their own", "separate, their own …"),
    ("for want of", "without"),
    ("do not do", "are not enough"),
    ("refuse", "reject"),
    ("refuses", "rejects"),
    ("refused", "rejected"),
    ("where it stands", "where it is"),
    ("what stands around", "what surrounds"),
    ("what stands above", "what is above"),
    ("what stands between", "what is between"),
    ("stand side by side", "are side by side"),
    ("characters stand", "the format of characters"),
    ("is no", "is not a"),
    ("are no", "are not"),
    ("was no", "was not a"),
];

/// Contexts in which a phrase is allowed: the line contains one of these.
const MEANT: &[&str] = &[
    // "There is no …", "no longer".
    "there is no",
    "there are no",
    "there was no",
    "is no longer",
    "are no longer",
    "is no more",
    // Messages of systems.
    "connection refused",
];

/// Words that begin a relative clause: a doc comment begins with a noun phrase, or with a verb in the third person.
const RELATIVE: &[&str] = &[
    "How",
    "One that",
    "That which",
    "What",
    "When",
    "Where",
    "Whether",
    "Which",
    "Who",
    "Whose",
    "Why",
];

/// Share of doc comments that may begin so, in percent.
const RELATIVE_SHARE: usize = 4;

/// Folders and files without prose of ours.
const LEFT_OUT: &[&str] = &[
    "target",
    "node_modules",
    "snapshots",
    "conformance",
    "book",
    "wording.rs",
];

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

/// The prose of a line: all of it in Markdown; comments and texts in sources.
fn prose(line: &str, markdown: bool) -> String {
    if markdown {
        return line.to_lowercase();
    }
    let start = line.trim_start();
    let is_comment = ["//", "/*", "* ", "#", ";"]
        .iter()
        .any(|mark| start.starts_with(mark));
    if is_comment {
        return line.to_lowercase();
    }
    // Quoted texts of several words, and a comment beside code.
    let (code, comment) = line.split_once(" // ").unwrap_or((line, ""));
    let texts = code.split('"').skip(1).step_by(2);
    let texts: Vec<_> = texts.filter(|text| text.contains(' ')).collect();
    format!("{} {comment}", texts.join(" ")).to_lowercase()
}

/// Returns true if a text contains the words of a phrase, one after the other.
fn has(text: &str, phrase: &str) -> bool {
    text.match_indices(phrase).any(|(at, _)| {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '`';
        let before = text[..at].chars().next_back();
        let after = text[at + phrase.len()..].chars().next();
        !before.is_some_and(is_word) && !after.is_some_and(is_word)
    })
}

/// The files of ours with one of these extensions, and their extensions.
fn sources(extensions: &[&'static str]) -> impl Iterator<Item = (PathBuf, &'static str)> {
    let is_ours = |entry: &walkdir::DirEntry| {
        let name = entry.file_name().to_string_lossy();
        let hidden = name.starts_with('.') && entry.depth() > 0 && name != "..";
        !hidden && !LEFT_OUT.contains(&name.as_ref())
    };
    let entries = WalkDir::new(root()).into_iter().filter_entry(is_ours);
    entries.filter_map(move |entry| {
        let path = entry.unwrap().into_path();
        let found = path.extension().and_then(|found| found.to_str())?;
        let mut extensions = extensions.iter();
        let extension = extensions.find(|extension| **extension == found)?;
        Some((path, *extension))
    })
}

/// First lines of a source's doc comments, with their line numbers.
fn doc_comments(source: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut before = "";
    for (line, number) in source.lines().zip(1..) {
        let line = line.trim_start();
        let mark = match line.get(..3) {
            Some(mark @ ("///" | "//!")) if !line.starts_with("////") => mark,
            _ => "",
        };
        if !mark.is_empty() && mark != before {
            found.push((number, line[mark.len()..].trim_start()));
        }
        before = mark;
    }
    found
}

/// Returns true if a doc comment begins with a relative clause.
fn is_relative(comment: &str) -> bool {
    let is_end = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    let mut words = RELATIVE.iter();
    words.any(|word| comment.strip_prefix(word).is_some_and(is_end))
}

#[test]
fn doc_comments_name_what_they_document() {
    let (mut all, mut relative) = (0, Vec::new());
    for (path, _) in sources(&["rs"]) {
        let text = fs::read_to_string(&path).unwrap();
        for (line, comment) in doc_comments(&text) {
            all += 1;
            if is_relative(comment) {
                relative.push(format!("{}:{line}: {comment}", path.display()));
            }
        }
    }
    assert!(all > 10_000, "only {all} doc comments were read");
    assert!(
        100 * relative.len() <= RELATIVE_SHARE * all,
        "{} of {all} doc comments begin with a relative clause:\n{}",
        relative.len(),
        relative.join("\n")
    );
}

#[test]
fn relative_clauses_are_found() {
    let source = "//! What it is.\n\n/// How long.\n/// What follows.\nfn a() {} // Where\n/// Whatever it is.\nfn b() {}";
    let comments = doc_comments(source);
    assert_eq!(
        comments,
        [(1, "What it is."), (3, "How long."), (6, "Whatever it is.")]
    );
    let relative = comments.iter().filter(|(_, comment)| is_relative(comment));
    assert_eq!(relative.count(), 2);
}

#[test]
fn prose_is_plain() {
    let mut odd = Vec::new();
    let mut lines = 0;
    for (path, extension) in sources(&["rs", "md", "toml", "h", "c", "il"]) {
        let text = fs::read_to_string(&path).unwrap();
        for (number, line) in text.lines().enumerate() {
            lines += 1;
            let prose = prose(line, extension == "md");
            if MEANT.iter().any(|meant| prose.contains(meant)) {
                continue;
            }
            for (phrase, better) in PHRASES {
                if has(&prose, phrase) {
                    let line = number + 1;
                    odd.push(format!("{}:{line}: `{phrase}`: {better}", path.display()));
                }
            }
        }
    }
    assert!(lines > 50_000, "only {lines} lines were read");
    assert!(
        odd.is_empty(),
        "{} odd wordings:\n{}",
        odd.len(),
        odd.join("\n")
    );
}

#[test]
fn phrases_are_found() {
    let odd = |line: &str| {
        let prose = prose(line, false);
        PHRASES
            .iter()
            .filter(|(phrase, _)| has(&prose, phrase))
            .count()
    };
    assert_eq!(odd("/// What stands behind it."), 1);
    assert_eq!(odd("let behind = self.behind(told);"), 0);
    assert_eq!(odd("    error(\"`Q5` is no operand\");"), 1);
    assert_eq!(odd("let x = 1; // it goes on"), 1);
    assert_eq!(odd("fn retold() {} // a foretold thing"), 0);
}
