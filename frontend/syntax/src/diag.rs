//! Diagnostics: what is wrong with a program, where, and what to do about it. Rendering is the command line's business.

use crate::{Device, Phrase, Span, codes};

/// Severity of a finding.
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
    /// Position.
    pub span: Span,
    /// Text at the position.
    pub text: Phrase,
}

/// A change of the program's text that does what a diagnostic proposes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// Effect, in the imperative: `write INCP`.
    pub title: Phrase,
    /// Replacements; no edit overlaps another.
    pub edits: Vec<Edit>,
    /// True if it is certainly the intention, so that it may be applied automatically; others are suggestions.
    pub certain: bool,
}

/// A piece of text to replace.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edit {
    /// Text to be replaced; an empty span is an insertion.
    pub span: Span,
    /// The new text.
    pub text: String,
}

impl Fix {
    /// A fix that is certainly what was meant: nothing else could be, or the program does not change by it.
    pub fn certain(title: impl Into<Phrase>) -> Self {
        Self::new(title.into(), true)
    }

    /// A fix that may not be what was meant.
    pub fn suggested(title: impl Into<Phrase>) -> Self {
        Self::new(title.into(), false)
    }

    fn new(title: Phrase, certain: bool) -> Self {
        let edits = Vec::new();
        Fix {
            title,
            edits,
            certain,
        }
    }

    /// Replaces a piece of text.
    #[must_use]
    pub fn replace(mut self, span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        self.edits.push(Edit { span, text });
        self
    }

    /// Ends the lines of its edits as those of a text end.
    #[must_use]
    pub fn with_line_ends_of(mut self, text: &str) -> Self {
        if text.contains("\r\n") {
            for edit in &mut self.edits {
                edit.text = edit.text.replace('\n', "\r\n");
            }
        }
        self
    }
}

/// A text after fixes were applied to it, and for each fix whether it was: one that touches what another changes is
/// left out.
pub fn apply(text: &str, fixes: &[&Fix]) -> (String, Vec<bool>) {
    let reach = |fix: &Fix| {
        let spans = fix.edits.iter().map(|edit| edit.span);
        spans
            .reduce(Span::to)
            .filter(|span| text.get(span.range()).is_some())
    };
    let mut order: Vec<(Span, usize)> = Vec::new();
    for (n, fix) in fixes.iter().enumerate() {
        order.extend(reach(fix).map(|span| (span, n)));
    }
    order.sort();
    let mut applied = vec![false; fixes.len()];
    let mut edits: Vec<&Edit> = Vec::new();
    // Up to where the text is taken; two insertions at one place would depend on their order.
    let mut taken: Option<u32> = None;
    for (span, n) in order {
        if taken.is_none_or(|taken| taken < span.start) {
            taken = Some(span.end);
            applied[n] = true;
            edits.extend(&fixes[n].edits);
        }
    }
    edits.sort_by_key(|edit| edit.span);
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    for Edit { span, text: new } in edits {
        let range = span.range();
        result.push_str(text.get(at..range.start).unwrap_or_default());
        result.push_str(new);
        at = range.end;
    }
    result.push_str(text.get(at..).unwrap_or_default());
    (result, applied)
}

/// One finding.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// Stable code, a row of the table of codes: `E0106`, `W0203`.
    pub code: &'static str,
    /// Error, warning or note.
    pub severity: Severity,
    /// One sentence, lower case, no full stop; devices and mnemonics in back quotes.
    pub message: Phrase,
    /// The place it is about.
    pub span: Span,
    /// Text at that place; may be empty.
    pub label: Phrase,
    /// Other places involved.
    pub others: Vec<Label>,
    /// All devices that it is about, where the message names only some; empty otherwise.
    pub devices: Vec<Device>,
    /// Advice.
    pub help: Option<Phrase>,
    /// The same as a change of the text, where it is known.
    pub fix: Option<Fix>,
    /// The PLC's own error code, where the manual gives one.
    pub plc_error: Option<u16>,
}

impl Diagnostic {
    /// An error with this code at this place.
    pub fn error(code: &'static str, span: Span, message: impl Into<Phrase>) -> Self {
        Self::new(Severity::Error, code, span, message)
    }

    /// A warning with this code at this place.
    pub fn warning(code: &'static str, span: Span, message: impl Into<Phrase>) -> Self {
        Self::new(Severity::Warning, code, span, message)
    }

    /// A diagnostic of this severity and code at this place.
    pub fn new(
        severity: Severity,
        code: &'static str,
        span: Span,
        message: impl Into<Phrase>,
    ) -> Self {
        Diagnostic {
            code,
            severity,
            message: message.into(),
            span,
            label: "".into(),
            others: Vec::new(),
            devices: Vec::new(),
            help: None,
            fix: None,
            plc_error: None,
        }
    }

    /// Sets the text at the main place.
    #[must_use]
    pub fn label(mut self, text: impl Into<Phrase>) -> Self {
        self.label = text.into();
        self
    }

    /// Adds another place.
    #[must_use]
    pub fn other(mut self, span: Span, text: impl Into<Phrase>) -> Self {
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
    pub fn help(mut self, text: impl Into<Phrase>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Sets the change of the text that does what the help says.
    #[must_use]
    pub fn fix(mut self, fix: Fix) -> Self {
        self.fix = Some(fix);
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

    /// Adds what the compiler found to what the reader of the program found. About an operand that could not be read at
    /// all the compiler may know more, since it knows the instruction: then the reader's error gives way to the
    /// compiler's.
    pub fn refine(&mut self, compiled: &Diagnostics) {
        let errors = || compiled.iter().filter(|d| d.severity == Severity::Error);
        let mut places: Vec<_> = errors().map(|d| (d.span.start, d.span.end)).collect();
        places.sort();
        let mut lines: Vec<_> = errors()
            .filter(|d| d.code == codes::ONE_PER_LINE.id)
            .collect();
        lines.sort_by_key(|d| d.span);
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

    /// Number of diagnostics.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns true if there are none.
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

    /// Returns true if any of them is an error.
    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|d| d.severity == Severity::Error)
    }

    /// Number of diagnostics with this severity.
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

/// A number with its noun: `1 case`, `2 431 steps`.
pub fn counted(n: usize, what: &str) -> String {
    format!("{} {what}{}", grouped(n), if n == 1 { "" } else { "s" })
}

/// A number with its thousands set apart.
pub fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// The closest of `candidates` to a misspelt `word`, if any is close enough to suggest.
pub fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let limit = if word.chars().count() <= 3 { 1 } else { 2 };
    candidates
        .into_iter()
        .filter_map(|c| Some((distance(word, c, limit)?, c)))
        .min()
        .map(|(_, c)| c)
}

/// Number of letters that were mistyped, missed, added or exchanged between two words; `None` if it exceeds a limit.
pub fn distance(word: &str, candidate: &str, limit: usize) -> Option<usize> {
    // It is at least the difference in length, and computing it takes time with their product.
    let length = |text: &str| text.chars().count();
    let alike = length(word).abs_diff(length(candidate)) <= limit;
    alike
        .then(|| strsim::osa_distance(word, candidate))
        .filter(|distance| *distance <= limit)
}

#[cfg(test)]
mod tests {
    use super::{Diagnostic, Fix, Span, apply, did_you_mean};

    #[test]
    fn long_quotations_are_cut() {
        let long = "Я".repeat(100_000);
        let quoted = format!("`{long}` is not `X`, nor `{long}`");
        let found = Diagnostic::error("E0001", Span::default(), quoted.clone())
            .label(quoted.clone())
            .help(quoted.clone())
            .other(Span::default(), quoted);
        let short = format!("`{0}…` is not `X`, nor `{0}…`", "Я".repeat(40));
        assert_eq!(found.message, short);
        assert_eq!(found.label, short);
        assert_eq!(found.help.as_deref(), Some(short.as_str()));
        assert_eq!(found.others[0].text, short);
        let usual = format!("`{}` stays", "a".repeat(100));
        let found = Diagnostic::error("E0001", Span::default(), usual.clone());
        assert_eq!(found.message, usual);
    }

    #[test]
    fn long_words_resemble_nothing_and_take_no_time() {
        assert_eq!(did_you_mean("ZRTS", ["ZRST", "ZR"]), Some("ZRST"));
        assert_eq!(did_you_mean("ADDD", ["ADD", "D"]), Some("ADD"));
        let long = "A".repeat(50_000_000);
        assert_eq!(did_you_mean(&long, ["ADD", "A".repeat(100).as_str()]), None);
    }

    #[test]
    fn fixes_that_touch_each_other_are_left_out() {
        let text = "MOV 0x1F 1.5\n";
        let at = |start, end| Span::new(start, end);
        let hex = Fix::certain("write H1F").replace(at(4, 8), "H1F");
        let both = Fix::certain("swap")
            .replace(at(9, 12), "0x1F")
            .replace(at(4, 8), "1.5");
        let float = Fix::suggested("write E1.5").replace(at(9, 12), "E1.5");
        let end = Fix::certain("add END").replace(at(13, 13), "END\n");
        let outside = Fix::certain("nothing").replace(at(99, 100), "");
        let (fixed, applied) = apply(text, &[&float, &both, &end, &hex, &outside]);
        assert_eq!(fixed, "MOV H1F E1.5\nEND\n");
        assert_eq!(applied, [true, false, true, true, false]);
        let (fixed, applied) = apply(text, &[&both]);
        assert_eq!((fixed.as_str(), applied), ("MOV 1.5 0x1F\n", vec![true]));
    }
}
