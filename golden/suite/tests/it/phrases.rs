//! What diagnostics and `rungc why` say is translated: each sentence in the sources has a message, which is made from
//! its present text.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use rungc::Language;
use rungc::language::{identifier, phrase};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_syntax::{Argument, Phrase, codes};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;
use unicode_width::UnicodeWidthChar;
use walkdir::WalkDir;

/// Folders whose diagnostics are translated, and the file with their phrases.
const FOLDERS: &[(&str, &str)] = &[
    ("frontend", "reading"),
    ("language/analysis/src/check", "checks"),
    ("language/analysis/src/latches.rs", "checks"),
    ("language/analysis/src/resolve", "operands"),
    ("language/structured", "structured"),
    ("ir/lower", "lowering"),
    ("project", "project"),
    ("cli/library", "project"),
    ("verify/why", "why"),
    ("cli/rungc/src/commands/why.rs", "why"),
    ("cli/rungc/src/commands/read.rs", "why"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Sources whose literals of several words are all sentences.
const WHOLE: &[&str] = &[
    "/check/coils.rs",
    "/check/idle_counters.rs",
    "/check/one_output.rs",
    "/check/operation_errors.rs",
    "/check/undefined.rs",
    "/check/ports/findings.rs",
    "/resolve/operands.rs",
    "/resolve/rules.rs",
    "/resolve/suggest.rs",
    "/resolve/wrong.rs",
    "/il/fault.rs",
    "/il/windows.rs",
    "/src/foreign.rs",
];

/// The literals of a text in Rust that are sentences of phrases.
#[derive(Default)]
struct Sentences {
    whole: bool,
    found: BTreeSet<String>,
}

impl Sentences {
    fn walk(&mut self, tokens: TokenStream) {
        let tokens: Vec<_> = tokens.into_iter().collect();
        for (at, token) in tokens.iter().enumerate() {
            let group = match token {
                TokenTree::Group(group) => group,
                TokenTree::Literal(literal) if self.whole => {
                    let text = literal.to_string();
                    if text.contains(' ') {
                        self.add(&text);
                    }
                    continue;
                }
                _ => continue,
            };
            let name = |back: usize| at.checked_sub(back).map(|at| tokens[at].to_string());
            let (last, before) = (name(1), name(2));
            let (last, before) = (last.unwrap_or_default(), before.unwrap_or_default());
            let is_test = last == "#" && group.stream().to_string().contains("cfg (test)");
            if is_test {
                // The tests of a file are its end.
                return;
            }
            let is_attribute = last == "#" || last == "!" && before == "#";
            if is_attribute {
                continue;
            }
            let parenthesis = group.delimiter() == Delimiter::Parenthesis;
            if last == "!" && before == "phrase" {
                self.first_literal(group.stream());
            } else if last == "!" && before == "format" {
                continue;
            } else if parenthesis && before == "." && ["label", "help"].contains(&&*last) {
                self.literals(group.stream(), 0);
            } else if parenthesis && before == "." && ["other", "at"].contains(&&*last) {
                self.literals(group.stream(), 1);
            } else if parenthesis && ["certain", "suggested"].contains(&&*last) {
                self.literals(group.stream(), 0);
            }
            self.walk(group.stream());
        }
    }

    fn first_literal(&mut self, tokens: TokenStream) {
        if let Some(TokenTree::Literal(literal)) = tokens.into_iter().next() {
            self.add(&literal.to_string());
        }
    }

    /// The literals of arguments, without the first ones.
    fn literals(&mut self, tokens: TokenStream, skip: usize) {
        let mut commas = 0;
        let tokens: Vec<_> = tokens.into_iter().collect();
        for (at, token) in tokens.iter().enumerate() {
            match token {
                TokenTree::Punct(punct) if punct.as_char() == ',' => commas += 1,
                TokenTree::Literal(literal) if commas >= skip => self.add(&literal.to_string()),
                TokenTree::Group(group) if commas >= skip => {
                    let is_macro = at > 0 && tokens[at - 1].to_string() == "!";
                    if !is_macro {
                        self.literals(group.stream(), 0);
                    }
                }
                _ => {}
            }
        }
    }

    fn add(&mut self, literal: &str) {
        let Ok(text) = syn::parse_str::<syn::LitStr>(literal) else {
            return;
        };
        let text = text.value();
        let letters = text.as_bytes().windows(2);
        if letters
            .into_iter()
            .any(|pair| pair.iter().all(u8::is_ascii_lowercase))
        {
            self.found.insert(text);
        }
    }
}

/// The sentences of each file of phrases.
fn sentences() -> BTreeMap<&'static str, BTreeSet<String>> {
    let mut all: BTreeMap<_, BTreeSet<String>> = BTreeMap::new();
    for &(folder, file) in FOLDERS {
        let of_file = all.entry(file).or_default();
        for entry in WalkDir::new(root().join(folder)).sort_by_file_name() {
            let path = entry.unwrap().into_path();
            let shown = path.to_string_lossy().replace('\\', "/");
            let is_source = shown.ends_with(".rs") && !shown.contains("/tests");
            if !is_source || shown.ends_with("/phrase.rs") {
                continue;
            }
            let text = fs::read_to_string(&path).unwrap();
            let tokens = text
                .parse()
                .unwrap_or_else(|_| panic!("{shown} is not Rust"));
            let mut found = Sentences {
                whole: WHOLE.iter().any(|end| shown.ends_with(end)),
                ..Sentences::default()
            };
            found.walk(tokens);
            of_file.extend(found.found);
        }
    }
    // A sentence that occurs in two areas stands in the first.
    let mut known = BTreeSet::new();
    for sentences in all.values_mut() {
        sentences.retain(|sentence| known.insert(sentence.clone()));
    }
    all
}

/// A message of a file: its sentence in English and its translation.
type Messages = BTreeMap<String, (String, String)>;

fn messages(file: &str) -> Messages {
    let path = root().join(format!("cli/library/locales/zh-CN/phrases/{file}.ftl"));
    let text = fs::read_to_string(path).unwrap();
    let blocks = text.split("\n\n").filter(|block| !block.trim().is_empty());
    let mut messages = Messages::new();
    for block in blocks {
        let (comment, message) = block
            .trim()
            .split_once('\n')
            .expect("a comment and a message");
        let english = comment.strip_prefix("# ").expect("a comment");
        let (id, chinese) = message.split_once(" = ").expect("a message");
        let entry = (english.to_owned(), chinese.to_owned());
        assert!(
            messages.insert(id.to_owned(), entry).is_none(),
            "{id} occurs twice"
        );
    }
    messages
}

/// Names of arguments, sorted.
fn arguments(text: &str, begin: &str) -> Vec<String> {
    let parts = text.split(begin).skip(1);
    let names = parts.map(|part| part.split('}').next().unwrap_or("").trim().to_owned());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

/// Texts in back quotes without arguments, sorted.
fn quoted(text: &str) -> Vec<String> {
    let plain = text.replace("{ $", "{").replace(" }", "}");
    let mut quoted: Vec<_> = plain
        .split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect();
    quoted.sort();
    quoted
}

#[test]
fn every_sentence_is_translated_from_its_present_text() {
    let mut wrong = Vec::new();
    for (file, sentences) in sentences() {
        let mut messages = messages(file);
        for sentence in sentences {
            let id = identifier(&sentence);
            match messages.remove(&id) {
                None => wrong.push(format!("{file}.ftl lacks:\n# {sentence}\n{id} = …")),
                Some((english, _)) if english != sentence => {
                    wrong.push(format!("{id}: the comment is not the sentence"));
                }
                Some((_, chinese)) => {
                    if arguments(&sentence, "{") != arguments(&chinese, "{ $") {
                        wrong.push(format!("{id}: other arguments"));
                    }
                    let prose: String = chinese.split('`').step_by(2).collect();
                    let unclear = prose.chars().find(|&c| c.width() != c.width_cjk());
                    if let Some(c) = unclear {
                        wrong.push(format!(
                            "{id}: terminals draw `{c}` one or two columns wide"
                        ));
                    }
                    if quoted(&sentence) != quoted(&chinese) {
                        wrong.push(format!("{id}: other texts in back quotes"));
                    }
                }
            }
        }
        wrong.extend(
            messages
                .keys()
                .map(|id| format!("{file}.ftl: no sentence for {id}")),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Meanings of special devices and titles of instructions, which tables have in English.
const OF_TABLES: &[&str] = &[
    "M8000: on while the program runs",
    "Read a high-speed counter",
    "delay time of input interrupts in ms",
];

/// Texts of a phrase that are not translated.
fn untranslated(of: &Phrase, wrong: &mut BTreeSet<String>) {
    let prose: String = of.split('`').step_by(2).collect();
    let has_words = prose.contains(|c: char| c.is_ascii_lowercase());
    if !has_words || OF_TABLES.contains(&of.as_str()) {
        return;
    }
    if phrase(Language::Chinese, of) == of.as_str() {
        wrong.insert(of.to_string());
    }
    for (_, argument) in of.arguments() {
        if let Argument::Phrase(inner) = argument
            && !inner.sentence().is_empty()
        {
            untranslated(inner, wrong);
        }
    }
}

#[test]
fn what_the_wrong_lists_of_the_codes_cause_is_said_in_chinese() {
    let mut wrong = BTreeSet::new();
    for code in codes::all()
        .into_iter()
        .filter(|code| !code.wrong.is_empty())
    {
        let read = rungc_frontend::read_text("wrong.il", code.wrong);
        let model = code.model.and_then(ModelId::from_name);
        let options = CompileOptions {
            model,
            ..CompileOptions::default()
        };
        let compiled = compile(&read.program, &options);
        for found in read.diagnostics.iter().chain(compiled.diagnostics.iter()) {
            let others = found.others.iter().map(|other| &other.text);
            let texts = [&found.message, &found.label].into_iter();
            for text in texts.chain(&found.help).chain(others) {
                untranslated(text, &mut wrong);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_why_says_is_said_in_chinese() {
    let wrong = RefCell::new(BTreeSet::new());
    let mut answers = 0;
    for example in [
        "motor.il",
        "drill.il",
        "packer.il",
        "traffic_light.il",
        "conveyor.il",
    ] {
        let path = root().join("examples/programs").join(example);
        let project = rungc::Project::open(&path).unwrap();
        let program = project.check().compile().unwrap();
        let mut plc = program.start();
        let names = ["Y000", "M0", "M8013", "S20", "T0", "D0", "X000"];
        for _ in 0..2 {
            plc.run_for(Duration::from_millis(700));
            for name in names {
                let Ok(mut why) = plc.why(name) else {
                    continue;
                };
                why.how = plc.how(name).ok();
                let alone = program.why(name).unwrap();
                for why in [alone, why] {
                    answers += 1;
                    why.text_in(&|said| {
                        // Names of devices are the same in all languages.
                        if !said.sentence().is_empty() {
                            untranslated(said, &mut wrong.borrow_mut());
                        }
                        said.as_str().into()
                    });
                }
            }
            let _ = plc.set("X000", !plc.bit("X000").unwrap());
        }
    }
    assert!(answers > 60, "{answers}");
    let wrong = wrong.into_inner();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
