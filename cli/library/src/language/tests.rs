use super::{ENGLISH, bundle, message, text, title};
use fluent_bundle::FluentResource;
use rungc_project::Language;
use rungc_syntax::codes::{self, Code};
use std::collections::{BTreeMap, BTreeSet};
use unicode_width::UnicodeWidthStr;

/// A translation and what it is made from.
struct Entry {
    id: String,
    /// Lines of the comment above it.
    english: Vec<String>,
    /// The entry itself, without its identifier.
    text: String,
}

/// The entries of a file, which empty lines separate.
fn entries(file: &str) -> Vec<Entry> {
    let blocks = file.split("\n\n").filter(|block| !block.trim().is_empty());
    blocks
        .map(|block| {
            let comment = |line: &str| line.strip_prefix('#').map(|text| text.trim().to_owned());
            let (id, text) = block
                .lines()
                .find(|line| !line.starts_with('#'))
                .and_then(|line| line.split_once('='))
                .unwrap_or_else(|| panic!("no message: {block}"));
            let rest = block.lines().skip_while(|line| line.starts_with('#'));
            let rest: Vec<_> = rest.skip(1).map(str::trim).collect();
            Entry {
                id: id.trim().to_owned(),
                english: block.lines().filter_map(comment).collect(),
                text: [&[text.trim()], rest.as_slice()]
                    .concat()
                    .join("\n")
                    .trim()
                    .to_owned(),
            }
        })
        .collect()
}

/// Texts in backquotes, sorted.
fn quoted(text: &str) -> Vec<&str> {
    let mut quoted: Vec<_> = text.split('`').skip(1).step_by(2).collect();
    quoted.sort_unstable();
    quoted
}

/// A text without those in backquotes.
fn prose(text: &str) -> String {
    text.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

/// Numbers in the prose of a text; commas in them do not count.
fn numbers(text: &str) -> BTreeSet<String> {
    let prose = prose(text);
    let chars: Vec<char> = prose.chars().collect();
    let is_digit = |at: usize| chars.get(at).is_some_and(char::is_ascii_digit);
    let joined = chars.iter().enumerate().filter(|&(at, &c)| {
        let groups = at > 0 && is_digit(at - 1) && (1..=3).all(|n| is_digit(at + n));
        c != ',' || !groups
    });
    let joined: String = joined.map(|(_, &c)| c).collect();
    let words = joined.split(|c: char| !c.is_ascii_digit());
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Numbers that a text has in words.
fn number_words(text: &str) -> BTreeSet<String> {
    let words = [
        "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    let text = text.to_lowercase();
    let said: BTreeSet<_> = text.split(|c: char| !c.is_ascii_alphabetic()).collect();
    let said = words
        .iter()
        .enumerate()
        .filter(|(_, word)| said.contains(*word));
    said.map(|(number, _)| number.to_string()).collect()
}

/// Reports a translation that does not say the same as its source, or that terminals draw in different widths.
fn check(id: &str, english: &str, chinese: &str, wrong: &mut Vec<String>) {
    if quoted(english) != quoted(chinese) {
        wrong.push(format!("{id}: other texts in backquotes than in English"));
    }
    let (here, there) = (numbers(chinese), numbers(english));
    let said = number_words(english);
    let extra = here
        .iter()
        .filter(|&n| !there.contains(n) && !said.contains(n));
    for number in there.difference(&here).chain(extra) {
        wrong.push(format!("{id}: the number {number} differs"));
    }
    for c in prose(chinese).chars() {
        let c = c.to_string();
        if c.width() != c.width_cjk() {
            wrong.push(format!(
                "{id}: terminals draw `{c}` one or two columns wide"
            ));
        }
    }
}

/// Files that hold the Chinese texts of codes.
fn chinese_codes() -> BTreeMap<String, Entry> {
    let mut all = BTreeMap::new();
    for entry in super::CHINESE_CODES.iter().flat_map(|file| entries(file)) {
        let id = entry.id.clone();
        assert!(all.insert(id.clone(), entry).is_none(), "{id} occurs twice");
    }
    all
}

#[test]
fn every_code_is_translated_from_its_present_text() {
    let entries = chinese_codes();
    let mut wrong = Vec::new();
    for code in codes::all() {
        let Some(entry) = entries.get(code.id) else {
            wrong.push(format!("{}: not translated", code.id));
            continue;
        };
        if entry.english != [code.title, code.text] {
            wrong.push(format!("{}: the English text has changed", code.id));
        }
        let said = [title, text].map(|of| of(Language::Chinese, code).into_owned());
        if said[0] == code.title || said[1] == code.text {
            wrong.push(format!("{}: a part is not translated", code.id));
        }
        check(code.id, code.title, &said[0], &mut wrong);
        check(code.id, code.text, &said[1], &mut wrong);
        let is_sentence = said[1].ends_with('。') && !said[0].ends_with('。');
        if !is_sentence {
            wrong.push(format!(
                "{}: a text ends with 。, a title does not",
                code.id
            ));
        }
    }
    let known: BTreeSet<_> = codes::all().iter().map(|code| code.id).collect();
    let unknown = entries.keys().filter(|id| !known.contains(id.as_str()));
    wrong.extend(unknown.map(|id| format!("{id}: no such code")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_message_is_translated_from_its_present_text() {
    let english = ENGLISH
        .iter()
        .flat_map(|file| entries(file))
        .collect::<Vec<_>>();
    let chinese: BTreeMap<_, _> = super::CHINESE
        .iter()
        .flat_map(|file| entries(file))
        .map(|entry| (entry.id.clone(), entry))
        .collect();
    let mut wrong = Vec::new();
    for entry in &english {
        let Some(other) = chinese.get(&entry.id) else {
            wrong.push(format!("{}: not translated", entry.id));
            continue;
        };
        if other.english.join("\n") != entry.text {
            wrong.push(format!("{}: the English text has changed", entry.id));
        }
        let plain = |text: &str| text.replace(['{', '}', '$'], "");
        check(
            &entry.id,
            &plain(&entry.text),
            &plain(&other.text),
            &mut wrong,
        );
    }
    let known: BTreeSet<_> = english.iter().map(|entry| entry.id.as_str()).collect();
    let unknown = chinese.keys().filter(|id| !known.contains(id.as_str()));
    wrong.extend(unknown.map(|id| format!("{id}: no such message")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_are_in_the_format_of_fluent() {
    for file in ENGLISH
        .iter()
        .chain(&super::CHINESE)
        .chain(&super::CHINESE_CODES)
    {
        if let Err((_, errors)) = FluentResource::try_new((*file).to_owned()) {
            panic!("{errors:?} in {file}");
        }
    }
}

#[test]
fn checks_find_what_differs() {
    let found = |english: &str, chinese: &str| {
        let mut wrong = Vec::new();
        check("x", english, chinese, &mut wrong);
        wrong
    };
    assert!(
        found(
            "`M0` has 2,000 steps and two labels",
            "`M0` 有 2000 步和 2 个标号"
        )
        .is_empty()
    );
    assert_eq!(found("`M0`", "`M1`").len(), 1);
    assert_eq!(found("3 steps", "4 步").len(), 2);
    assert_eq!(found("a → b", "甲 → 乙").len(), 1);
}

#[test]
fn counts_choose_their_plural_and_group_thousands() {
    let of = |language, count: usize| message(language, "errors", &[("count", count.into())]);
    let counts = [0, 1, 2431].map(|count| of(Language::English, count));
    assert_eq!(counts, ["0 errors", "1 error", "2 431 errors"]);
    let counts = [0, 1, 2431].map(|count| of(Language::Chinese, count));
    assert_eq!(counts, ["0 个错误", "1 个错误", "2 431 个错误"]);
}

#[test]
fn english_is_the_text_of_the_table() {
    let code: &'static Code = codes::find("E0401").unwrap();
    assert_eq!(title(Language::English, code), code.title);
    assert_eq!(text(Language::English, code), code.text);
    assert_eq!(title(Language::Chinese, code), "线圈或指令前没有触点");
    let damaged = bundle(Language::Chinese, &["= no identifier\nhelp = 提示\n"]);
    assert!(damaged.has_message("help"));
    assert_eq!(
        message(Language::Chinese, "no-such-message", &[]),
        "no-such-message"
    );
}
