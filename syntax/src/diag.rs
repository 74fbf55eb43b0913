//! Diagnostics: what is wrong with a program, where, and what to do about it. Rendering is the command line's business.

use crate::{Device, Span, codes};
use std::borrow::Cow;

/// How bad it is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub enum Severity {
    /// Worth knowing; never fails a build, and is never raised to an error.
    Note,
    /// Legal, but it hurts in practice.
    Warning,
    /// The program cannot be compiled.
    Error,
}

impl Severity {
    /// Its name in reports, lower case.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }

    /// The letter that codes of this severity begin with.
    pub fn letter(self) -> char {
        match self {
            Severity::Note => 'N',
            Severity::Warning => 'W',
            Severity::Error => 'E',
        }
    }
}

/// A second place that a diagnostic points to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there.
    pub text: Cow<'static, str>,
}

/// One finding.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// Stable code, a row of the table of codes: `E0106`, `W0203`.
    pub code: &'static str,
    /// Error, warning or note.
    pub severity: Severity,
    /// One sentence, lower case, no full stop; devices and mnemonics in back quotes.
    pub message: String,
    /// The place it is about.
    pub span: Span,
    /// What to write at that place; may be empty.
    pub label: Cow<'static, str>,
    /// Other places involved.
    pub others: Vec<Label>,
    /// All devices that it is about, where the message names only some; empty otherwise.
    pub devices: Vec<Device>,
    /// What to do about it.
    pub help: Option<Cow<'static, str>>,
    /// The PLC's own error code, where the manual gives one.
    pub plc_error: Option<u16>,
}

impl Diagnostic {
    /// An error with this code at this place.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, span, message)
    }

    /// A warning with this code at this place.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, span, message)
    }

    /// A diagnostic of this severity and code at this place.
    pub fn new(
        severity: Severity,
        code: &'static str,
        span: Span,
        message: impl Into<String>,
    ) -> Self {
        Diagnostic {
            code,
            severity,
            message: message.into(),
            span,
            label: Cow::Borrowed(""),
            others: Vec::new(),
            devices: Vec::new(),
            help: None,
            plc_error: None,
        }
    }

    /// Sets the text at the main place.
    #[must_use]
    pub fn label(mut self, text: impl Into<Cow<'static, str>>) -> Self {
        self.label = text.into();
        self
    }

    /// Adds another place.
    #[must_use]
    pub fn other(mut self, span: Span, text: impl Into<Cow<'static, str>>) -> Self {
        self.others.push(Label {
            span,
            text: text.into(),
        });
        self
    }

    /// Sets the devices that it is about.
    #[must_use]
    pub fn devices(mut self, devices: impl IntoIterator<Item = Device>) -> Self {
        self.devices = devices.into_iter().collect();
        self
    }

    /// Sets the help line.
    #[must_use]
    pub fn help(mut self, text: impl Into<Cow<'static, str>>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Sets the PLC's own error code.
    #[must_use]
    pub fn plc_error(mut self, code: u16) -> Self {
        self.plc_error = Some(code);
        self
    }
}

/// All findings about one source.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Adds many.
    pub fn extend(&mut self, more: impl IntoIterator<Item = Diagnostic>) {
        self.0.extend(more);
    }

    /// Adds what the compiler found to what the reader of the program found. About an operand that could not be read at all the
    /// compiler may know more, since it knows the instruction: then the reader's error gives way to the compiler's.
    pub fn refine(&mut self, compiled: &Diagnostics) {
        let errors = || compiled.iter().filter(|d| d.severity == Severity::Error);
        let mut places: Vec<_> = errors().map(|d| (d.span.start, d.span.end)).collect();
        places.sort_unstable();
        let mut lines: Vec<_> = errors()
            .filter(|d| d.code == codes::ONE_PER_LINE.id)
            .collect();
        lines.sort_unstable_by_key(|d| d.span);
        self.0.retain(|d| {
            let at = places.partition_point(|&(start, _)| start < d.span.start);
            let same = places[at..]
                .iter()
                .take_while(|&&(start, _)| start == d.span.start);
            let known = same.clone().any(|&(_, end)| end >= d.span.end);
            let before = lines.partition_point(|line| line.span.start <= d.span.start);
            let line = before.checked_sub(1).and_then(|last| lines.get(last));
            let second = line.is_some_and(|line| line.span.end >= d.span.end);
            let unreadable = [codes::BAD_OPERAND.id, codes::LABEL_OPERAND.id].contains(&d.code);
            !unreadable || !(known || second)
        });
        self.extend(compiled.iter().cloned());
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Makes warnings of the errors with these codes.
    pub fn ease(&mut self, codes: &[&str]) {
        for diagnostic in &mut self.0 {
            if diagnostic.severity == Severity::Error && codes.contains(&diagnostic.code) {
                diagnostic.severity = Severity::Warning;
            }
        }
    }

    /// Whether any of them is an error.
    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|d| d.severity == Severity::Error)
    }

    /// How many have this severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.0.iter().filter(|d| d.severity == severity).count()
    }

    /// Ordered by place, then by code.
    pub fn sorted(mut self) -> Vec<Diagnostic> {
        self.0
            .sort_by(|a, b| (a.span, a.code).cmp(&(b.span, b.code)));
        self.0
    }

    /// In the order they were found, to be added to.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, Diagnostic> {
        self.0.iter_mut()
    }

    /// In the order they were found.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }
}

/// The closest of `candidates` to a misspelt `word`, if any is close enough to suggest.
pub fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let near = |candidate: &str| strsim::osa_distance(word, candidate);
    let limit = if word.chars().count() <= 3 { 1 } else { 2 };
    candidates
        .into_iter()
        .map(|c| (near(c), c))
        .filter(|&(d, _)| d <= limit)
        .min()
        .map(|(_, c)| c)
}
