//! Texts that are open in the editor.

use crate::lines::{Encoding, Lines};
use crate::uri;
use gen_lsp_types::{Position, Range, TextDocumentContentChangeEvent, TextDocumentItem, Uri};
use rungc::index::Index;
use rungc::{Diagnostic, Error, Options, Project, Unsaved};
use rungc_syntax::{Program, SourceKind, Span};
use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Ending of the names of test files.
const TEST_FILE: &str = ".plctest.toml";

/// Kinds of texts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    /// A program.
    Program,
    /// `rungc.toml`.
    Settings,
    /// A test file.
    Test,
    /// A file of another kind, of which nothing is known.
    Other,
}

/// A text as it is at a moment. A clone is the same text.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    /// The text.
    pub(crate) text: Arc<str>,
    /// Its lines.
    pub(crate) lines: Arc<Lines>,
}

/// An open text.
#[derive(Debug)]
pub(crate) struct Document {
    /// Its address.
    pub(crate) uri: Uri,
    /// Its file, or the name of a text that has none.
    pub(crate) path: PathBuf,
    /// True if it has a file, so that settings hold for it.
    pub(crate) has_file: bool,
    /// Its kind.
    pub(crate) kind: Kind,
    /// Its version, as the editor counts.
    pub(crate) version: i32,
    /// Number of changes of it or of what it depends on.
    pub(crate) revision: u64,
    /// The text.
    pub(crate) now: Text,
    /// Time of the next check.
    pub(crate) due: Option<Instant>,
    /// The revision that is checked now.
    pub(crate) in_check: Option<u64>,
    /// The revision and the findings of the last check.
    pub(crate) checked: Option<(u64, Arc<[Diagnostic]>)>,
    /// Its index, once it has been asked for.
    index: OnceCell<Option<Index>>,
}

impl Text {
    /// Takes a text over.
    pub(crate) fn new(text: impl Into<Arc<str>>, encoding: Encoding) -> Self {
        let text = text.into();
        let lines = Arc::new(Lines::of(&text, encoding));
        Text { text, lines }
    }

    /// Length of the byte-order mark, which readers leave out.
    fn lead(&self) -> usize {
        self.text.len() - self.content().len()
    }

    /// The text without its byte-order mark.
    pub(crate) fn content(&self) -> &str {
        self.text.strip_prefix('\u{feff}').unwrap_or(&self.text)
    }

    /// The range of bytes of the content.
    pub(crate) fn range(&self, span: Span) -> Range {
        let position = |at: u32| self.lines.position(&self.text, at as usize + self.lead());
        Range {
            start: position(span.start),
            end: position(span.end.max(span.start)),
        }
    }

    /// The range of a line, without its end.
    fn line_range(&self, line: u32) -> Range {
        let bytes = self.lines.range(&self.text, line);
        Range {
            start: self.lines.position(&self.text, bytes.start),
            end: self.lines.position(&self.text, bytes.end),
        }
    }

    /// The range of a place in a program that was read from this text. Of a table it is the row, or in it the only word
    /// that is written like the place; other formats have their places at the beginning.
    pub(crate) fn range_in(&self, program: &Program, span: Span) -> Range {
        match program.kind {
            SourceKind::Il | SourceKind::Ladder | SourceKind::StructuredText => self.range(span),
            SourceKind::Csv => {
                let line = |at: u32| program.source.line(at).saturating_sub(1);
                let first = line(span.start);
                // The operands of an instruction may be in rows below it.
                let instrs = &program.instrs;
                let next = instrs.partition_point(|instr| instr.span.start <= span.start);
                let next = instrs
                    .get(next)
                    .map_or(first + 1, |next| line(next.span.start));
                let word = program.source.slice(span);
                (first..next.max(first + 1))
                    .find_map(|line| self.word(line, word))
                    .unwrap_or_else(|| self.line_range(first))
            }
            _ => self.line_range(0),
        }
    }

    /// The range of a word that a line holds once.
    fn word(&self, line: u32, word: &str) -> Option<Range> {
        let bytes = self.lines.range(&self.text, line);
        let content = self.text.get(bytes.clone())?;
        let is_part = |c: char| c.is_alphanumeric();
        let mut found = content.match_indices(word).filter(|(at, _)| {
            let (before, after) = (&content[..*at], &content[at + word.len()..]);
            !before.ends_with(is_part) && !after.starts_with(is_part)
        });
        let (at, _) = found.next().filter(|_| !word.is_empty())?;
        let start = bytes.start + at;
        found.next().is_none().then(|| Range {
            start: self.lines.position(&self.text, start),
            end: self.lines.position(&self.text, start + word.len()),
        })
    }

    /// The byte of the content at a position.
    pub(crate) fn offset(&self, position: Position) -> u32 {
        let at = self.lines.offset(&self.text, position);
        at.saturating_sub(self.lead()) as u32
    }
}

fn kind(name: &str) -> Kind {
    let name = name.to_lowercase();
    match name.as_str() {
        rungc_project::FILE => Kind::Settings,
        name if name.ends_with(TEST_FILE) => Kind::Test,
        name if name.ends_with(".toml") => Kind::Other,
        _ => Kind::Program,
    }
}

impl Document {
    /// Takes a text that the editor opens.
    pub(crate) fn new(item: TextDocumentItem, encoding: Encoding) -> Self {
        let file = uri::path(&item.uri);
        let name = uri::name(&item.uri);
        Document {
            has_file: file.is_some(),
            kind: kind(&name),
            path: file.unwrap_or_else(|| PathBuf::from(name)),
            uri: item.uri,
            version: item.version,
            revision: 0,
            now: Text::new(item.text, encoding),
            due: None,
            in_check: None,
            checked: None,
            index: OnceCell::new(),
        }
    }

    /// Applies changes in their order.
    pub(crate) fn change(
        &mut self,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
        encoding: Encoding,
    ) {
        use TextDocumentContentChangeEvent as Change;
        for change in changes {
            let text = match change {
                Change::TextDocumentContentChangeWholeDocument(whole) => whole.text,
                Change::TextDocumentContentChangePartial(part) => {
                    let Text { text, lines } = &self.now;
                    let start = lines.offset(text, part.range.start);
                    let end = lines.offset(text, part.range.end).max(start);
                    [&text[..start], &part.text, &text[end..]].concat()
                }
            };
            self.now = Text::new(text, encoding);
        }
        self.version = version;
    }

    /// The index of the program in it; `None` if it is none that can be read.
    pub(crate) fn index(&self, unsaved: &Unsaved) -> Option<&Index> {
        let index = self.index.get_or_init(|| {
            let opened = (self.kind == Kind::Program).then(|| self.opened(unsaved));
            let project = opened?.project.ok()?;
            Some(Index::new(&project))
        });
        index.as_ref()
    }

    fn opened(&self, unsaved: &Unsaved) -> Opened {
        Opened::of(&self.path, self.has_file, unsaved)
    }

    /// Notes that it, or what it depends on, has changed.
    pub(crate) fn invalidate(&mut self) {
        self.revision += 1;
        self.index = OnceCell::new();
    }

    /// The findings of the last check, if it was of what is there now.
    pub(crate) fn findings(&self) -> Option<&Arc<[Diagnostic]>> {
        let (revision, findings) = self.checked.as_ref()?;
        (*revision == self.revision).then_some(findings)
    }
}

/// A program that is open, with the mistakes in its settings.
#[derive(Debug)]
pub(crate) struct Opened {
    /// The program, without settings if these have mistakes.
    pub(crate) project: Result<Project, Error>,
    /// The mistakes.
    pub(crate) mistakes: Vec<Diagnostic>,
}

impl Opened {
    /// Reads a program of which there are unsaved texts.
    pub(crate) fn of(path: &Path, has_file: bool, unsaved: &Unsaved) -> Self {
        let options = Options {
            unsaved: unsaved.clone(),
            without_settings: !has_file,
            ..Options::default()
        };
        let mut mistakes = Vec::new();
        let project = match Project::open_with(path, &options) {
            Err(Error::Settings(error)) => {
                mistakes = rungc::mistakes::of(&error);
                let options = Options {
                    without_settings: true,
                    ..options
                };
                Project::open_with(path, &options)
            }
            opened => opened,
        };
        Opened { project, mistakes }
    }
}
