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

/// Where a phrase is meant: the line contains this.
const MEANT: &[&str] = &[
    // "There is no …", "no longer".
    "there is no",
    "there are no",
    "there was no",
    "is no longer",
    "are no longer",
    "is no more",
    // What a system says.
    "connection refused",
];

/// Folders and files without prose of ours.
const LEFT_OUT: &[&str] = &[
    "target",
    "vendor",
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
    // What is in quotes and has several words, and a comment beside code.
    let (code, comment) = line.split_once(" // ").unwrap_or((line, ""));
    let texts = code.split('"').skip(1).step_by(2);
    let texts: Vec<_> = texts.filter(|text| text.contains(' ')).collect();
    format!("{} {comment}", texts.join(" ")).to_lowercase()
}

/// Whether a text contains the words of a phrase, one after the other.
fn has(text: &str, phrase: &str) -> bool {
    text.match_indices(phrase).any(|(at, _)| {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '`';
        let before = text[..at].chars().next_back();
        let after = text[at + phrase.len()..].chars().next();
        !before.is_some_and(is_word) && !after.is_some_and(is_word)
    })
}

#[test]
fn prose_is_plain() {
    let is_ours = |entry: &walkdir::DirEntry| {
        let name = entry.file_name().to_string_lossy();
        let hidden = name.starts_with('.') && entry.depth() > 0 && name != "..";
        !hidden && !LEFT_OUT.contains(&name.as_ref())
    };
    let mut odd = Vec::new();
    let mut lines = 0;
    for entry in WalkDir::new(root()).into_iter().filter_entry(is_ours) {
        let path = entry.unwrap().into_path();
        let Some(extension) = path.extension().and_then(|found| found.to_str()) else {
            continue;
        };
        if !["rs", "md", "toml", "h", "c", "il"].contains(&extension) {
            continue;
        }
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
