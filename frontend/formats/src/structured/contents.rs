//! What a file of structured text defines for others, and the names in it that it does not define.

use rungc_syntax::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Contents of a file; all names in upper case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Contents {
    /// Programs.
    pub programs: BTreeSet<String>,
    /// Functions, function blocks, data types and global labels.
    pub defined: BTreeSet<String>,
    /// Names of all else, with the place of their first use.
    pub used: BTreeMap<String, Span>,
    /// Programs that a CONFIGURATION names.
    pub runs: BTreeSet<String>,
    /// True if it has a CONFIGURATION.
    pub has_tasks: bool,
}

/// A word or sign and its place.
#[derive(Clone, Copy, Debug)]
struct Token<'t> {
    text: &'t str,
    span: Span,
}

impl Token<'_> {
    fn is(&self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword)
    }

    fn is_word(&self) -> bool {
        self.text.starts_with(begins_word)
    }
}

fn begins_word(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_in_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Length of a text in quotation marks, in which `$` begins a character.
fn quoted(text: &str, mark: char) -> usize {
    let mut rest = text.char_indices().skip(1);
    while let Some((at, c)) = rest.next() {
        match c {
            '$' => drop(rest.next()),
            c if c == mark || c == '\n' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// Words and signs; comments, texts, numbers, addresses and typed values are left out.
fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut all = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let until = |end: &str| {
            let found = rest[2..].find(end);
            found.map_or(rest.len(), |found| 2 + found + end.len())
        };
        let length = |goes: fn(char) -> bool| rest.find(|c| !goes(c)).unwrap_or(rest.len());
        let (length, counts) = if rest.starts_with("(*") {
            (until("*)"), false)
        } else if rest.starts_with("//") {
            (until("\n"), false)
        } else if first == '\'' || first == '"' {
            (quoted(rest, first), false)
        } else if first.is_ascii_digit() || first == '%' {
            let length = length(|c| is_in_word(c) || matches!(c, '#' | '.' | '%'));
            // `1..5` is a range.
            (rest[..length].find("..").unwrap_or(length), false)
        } else if begins_word(first) {
            let word = length(is_in_word);
            match rest[word..].starts_with('#') {
                true => (length(|c| is_in_word(c) || matches!(c, '#' | '.')), false),
                false => (word, true),
            }
        } else if [":=", "=>", ".."].iter().any(|sign| rest.starts_with(sign)) {
            (2, true)
        } else {
            (first.len_utf8(), !first.is_whitespace())
        };
        if counts {
            all.push(Token {
                text: &rest[..length],
                span: Span::new(at as u32, (at + length) as u32),
            });
        }
        at += length;
    }
    all
}

/// Part of a text that a name stands in.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    /// Statements, or between units.
    Body,
    Types,
    Members,
    /// Declarations of labels of a unit.
    Locals,
    Globals,
    /// Names of global labels, again.
    Externals,
    Tasks,
}

struct Scan<'t> {
    tokens: Vec<Token<'t>>,
    found: Contents,
    /// Labels of the present unit.
    locals: BTreeSet<String>,
    /// Names in the present unit.
    names: Vec<(String, Span)>,
    section: Section,
    /// True where a declaration begins.
    begins: bool,
}

impl Contents {
    /// Those of a text.
    pub(super) fn of(text: &str) -> Contents {
        let mut scan = Scan {
            tokens: tokens(text),
            found: Contents::default(),
            locals: BTreeSet::new(),
            names: Vec::new(),
            section: Section::Body,
            begins: false,
        };
        let mut at = 0;
        while at < scan.tokens.len() {
            at = scan.token(at);
        }
        scan.unit();
        let Contents { defined, used, .. } = &mut scan.found;
        used.retain(|name, _| !defined.contains(name));
        scan.found
    }
}

impl Scan<'_> {
    /// Begins another unit: what the one before declares is not known in it.
    fn unit(&mut self) {
        let locals = std::mem::take(&mut self.locals);
        for (name, span) in self.names.drain(..) {
            if !locals.contains(&name) {
                self.found.used.entry(name).or_insert(span);
            }
        }
    }

    fn is(&self, at: usize, text: &str) -> bool {
        self.tokens.get(at).is_some_and(|token| token.is(text))
    }

    /// The word at a position.
    fn word(&self, at: usize) -> Option<String> {
        let token = self.tokens.get(at).filter(|token| token.is_word())?;
        Some(token.text.to_uppercase())
    }

    /// Takes a token; gives the position of the next one.
    fn token(&mut self, at: usize) -> usize {
        let token = self.tokens[at];
        if !token.is_word() {
            match token.text {
                ";" => self.begins = true,
                ":" => self.begins = false,
                _ => {}
            }
            return at + 1;
        }
        match token.text.to_ascii_uppercase().as_str() {
            "PROGRAM" if self.section == Section::Tasks => self.found.runs.extend(self.run(at)),
            "PROGRAM" => {
                self.unit();
                self.found.programs.extend(self.word(at + 1));
                return at + 2;
            }
            "FUNCTION" | "FUNCTION_BLOCK" => {
                self.unit();
                self.found.defined.extend(self.word(at + 1));
                return at + 2;
            }
            "CONFIGURATION" => {
                self.unit();
                self.found.has_tasks = true;
                self.section = Section::Tasks;
            }
            "TYPE" => self.declare(Section::Types),
            "STRUCT" if self.section == Section::Types => self.declare(Section::Members),
            "END_STRUCT" => self.declare(Section::Types),
            "VAR_GLOBAL" => self.declare(Section::Globals),
            "VAR_EXTERNAL" => self.declare(Section::Externals),
            "VAR" | "VAR_INPUT" | "VAR_OUTPUT" | "VAR_IN_OUT" | "VAR_TEMP" | "VAR_CONSTANT" => {
                self.declare(Section::Locals);
            }
            "CONSTANT" | "RETAIN" => {}
            "AT" => self.begins = false,
            "END_VAR" | "END_TYPE" | "END_CONFIGURATION" => self.section = Section::Body,
            _ => self.name(at),
        }
        at + 1
    }

    fn declare(&mut self, section: Section) {
        self.section = section;
        self.begins = true;
    }

    /// The program that a line of a CONFIGURATION names: the type of the instance, or its only name.
    fn run(&self, at: usize) -> Option<String> {
        let line = (at..self.tokens.len()).take_while(|&next| !self.is(next, ";"));
        let mut colons = line.filter(|&next| self.is(next, ":"));
        self.word(colons.next().unwrap_or(at) + 1)
    }

    /// Takes a name, which is not a keyword of declarations.
    fn name(&mut self, at: usize) {
        let token = self.tokens[at];
        let name = token.text.to_uppercase();
        match self.section {
            Section::Types | Section::Globals if self.begins => {
                self.found.defined.insert(name);
            }
            Section::Locals if self.begins => {
                self.locals.insert(name);
            }
            Section::Members if self.begins => {}
            Section::Tasks => {}
            _ => {
                let before = at.checked_sub(1);
                let follows = |sign| before.is_some_and(|before| self.is(before, sign));
                // The name of an input or member.
                let is_given = (follows("(") || follows(","))
                    && (self.is(at + 1, ":=") || self.is(at + 1, "=>"));
                if !follows(".") && !is_given {
                    self.names.push((name, token.span));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Contents;

    fn shown(text: &str) -> String {
        let found = Contents::of(text);
        let join = |names: Vec<&String>| names.into_iter().cloned().collect::<Vec<_>>().join(" ");
        format!(
            "programs {}; defined {}; used {}; runs {}",
            join(found.programs.iter().collect()),
            join(found.defined.iter().collect()),
            join(found.used.keys().collect()),
            join(found.runs.iter().collect()),
        )
    }

    #[test]
    fn names_of_other_files_are_used() {
        let text = "PROGRAM Main\nVAR a, b : INT := Start; c : ARRAY [1..Count] OF Axis; END_VAR\n\
                    VAR_EXTERNAL Level : INT; END_VAR\n\
                    (* Gone *) // Gone\na := Twice(In := b, Out => x.y) + T#5s + INT#3;\n\
                    b := 'Gone$' Gone';\nEND_PROGRAM";
        let used = "ARRAY AXIS COUNT END_PROGRAM INT LEVEL OF START TWICE X";
        assert_eq!(
            shown(text),
            format!("programs MAIN; defined ; used {used}; runs ")
        );
    }

    #[test]
    fn labels_of_a_unit_are_not_known_in_the_next() {
        let text = "FUNCTION One : INT\nVAR_INPUT n : INT; END_VAR\nOne := n;\nEND_FUNCTION\n\
                    FUNCTION_BLOCK Two\nm := n + One;\nEND_FUNCTION_BLOCK";
        let used = "END_FUNCTION END_FUNCTION_BLOCK INT M N";
        assert_eq!(
            shown(text),
            format!("programs ; defined ONE TWO; used {used}; runs ")
        );
    }

    #[test]
    fn types_globals_and_tasks_are_found() {
        let text = "TYPE Axis : STRUCT Home, Ready : BOOL; Of : Drive; END_STRUCT; END_TYPE\n\
                    VAR_GLOBAL CONSTANT Most : INT := 5; END_VAR\nVAR_GLOBAL Start AT X0 : BOOL; END_VAR\n\
                    CONFIGURATION Line TASK T1(PRIORITY := 1); PROGRAM Main WITH T1 : First; PROGRAM Second; \
                    END_CONFIGURATION";
        assert_eq!(
            shown(text),
            "programs ; defined AXIS MOST START; used BOOL DRIVE INT X0; runs FIRST SECOND"
        );
    }

    #[test]
    fn texts_that_end_early_are_read() {
        for text in [
            "PROGRAM",
            "(* open",
            "'open",
            "CONFIGURATION x PROGRAM",
            "1..",
            "%",
            "é#",
            "INT#",
        ] {
            Contents::of(text);
        }
    }
}
