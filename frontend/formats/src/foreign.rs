//! Texts in other PLC languages, which are reported once instead of line by line.

use rungc_syntax::{Diagnostic, Program, Source, SourceKind, Span, codes, phrase};

/// Number of lines of code that decide.
const LINES: usize = 200;
/// Longer lines are not code.
const MAX_LINE: usize = 1_000;

/// A language that is not an FX list.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Language {
    PlcopenXml,
    Xml,
    List,
    StructuredText,
}

/// Says that a text is in another language, if it is, and gives a program without instructions.
pub(crate) fn detect(name: &str, text: &str) -> Option<(Program, Diagnostic)> {
    let (language, span) = language(text)?;
    let (what, help) = match language {
        Language::PlcopenXml => (
            phrase!("this is a PLCopen XML project, not an FX instruction list"),
            "open it in its editor and export the list of the compiled program",
        ),
        Language::Xml => (
            phrase!("this is an XML file, not an FX instruction list"),
            "open it in the editor that wrote it and export the list of the compiled program",
        ),
        Language::List => (
            phrase!("this is IEC 61131-3 instruction list, not an FX instruction list"),
            "an FX list names devices: `LD X000`, `ANI X001`, `OUT Y000`, `END`",
        ),
        Language::StructuredText => (
            phrase!("this is structured text, not an FX instruction list"),
            "name the file `.st`, begin it with `PROGRAM Name` and end it with `END_PROGRAM`",
        ),
    };
    let diagnostic = codes::FOREIGN_LANGUAGE
        .at(span, what)
        .label("this shows the language")
        .help(help);
    let program = Program {
        source: Source::new(name, text),
        kind: SourceKind::Il,
        unread: vec![0],
        ..Program::default()
    };
    Some((program, diagnostic))
}

/// The language of a text, if it is one of these, and what shows it. It must show at once, or often and in more lines
/// than those of an FX list: lines of another language in a list are mistakes, which hide no others.
fn language(text: &str) -> Option<(Language, Span)> {
    let begin = text.len()
        - text
            .trim_start_matches(['\u{FEFF}', ' ', '\t', '\r', '\n'])
            .len();
    if text.get(begin..)?.starts_with('<') {
        let head: String = text.chars().take(4_096).collect();
        let language = match head.to_ascii_lowercase().contains("plcopen") {
            true => Language::PlcopenXml,
            false => Language::Xml,
        };
        let end = text
            .get(begin..)?
            .find(['>', '\n'])
            .map_or(text.len(), |end| begin + end + 1);
        let end = end.min(begin + MAX_LINE);
        return text
            .is_char_boundary(end)
            .then(|| (language, Span::new(begin as u32, end as u32)));
    }
    let mut found: Vec<(Language, Span)> = Vec::new();
    let mut lines = 0;
    let mut of_lists = 0;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let code = line.split(['"', ';']).next().unwrap_or_default();
        let code = code.split("//").next().unwrap_or_default();
        if code.trim().is_empty() || code.trim_start().starts_with("(*") || line.len() > MAX_LINE {
            continue;
        }
        lines += 1;
        let sign = sign(code);
        of_lists += usize::from(sign.is_none() && is_of_list(code));
        found.extend(sign.map(|(language, from, to)| {
            (
                language,
                Span::new((start + from) as u32, (start + to) as u32),
            )
        }));
        if lines == LINES {
            break;
        }
    }
    let &(first, span) = found.first()?;
    let at_once = first_code_line_end(text) >= span.end as usize;
    let statements = found
        .iter()
        .any(|(language, _)| *language == Language::StructuredText);
    let language = if statements {
        Language::StructuredText
    } else {
        first
    };
    let at_once = at_once && found.len() >= of_lists;
    let often = 4 * found.len() >= lines && found.len() > of_lists;
    (at_once || often).then_some((language, span))
}

/// Returns true if a line looks like an instruction of an FX list, though it may have mistakes: `LD X000`,
/// `OUTT T0 K10`, `MOV D0`.
fn is_of_list(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let (Some(word), Some(operand)) = (words.next(), words.next()) else {
        return false;
    };
    let (class, number) = operand.split_at(operand.chars().next().map_or(0, char::len_utf8));
    word.starts_with(|first: char| first.is_ascii_alphabetic())
        && "XYMSTCDKH".contains(&class.to_ascii_uppercase())
        && !number.is_empty()
        && number.bytes().all(|digit| digit.is_ascii_digit())
}

/// End of the first line of code.
fn first_code_line_end(text: &str) -> usize {
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        at += line.len();
        let code = line.trim_start();
        if !(code.is_empty()
            || code.starts_with([';'])
            || code.starts_with("//")
            || code.starts_with("(*"))
        {
            break;
        }
    }
    at
}

/// The part of a line that shows it is not from an FX list: the language and the range.
fn sign(line: &str) -> Option<(Language, usize, usize)> {
    /// Keywords that begin declarations.
    const DECLARATIONS: [&str; 14] = [
        "PROGRAM",
        "END_PROGRAM",
        "FUNCTION",
        "FUNCTION_BLOCK",
        "VAR",
        "VAR_INPUT",
        "VAR_OUTPUT",
        "VAR_IN_OUT",
        "VAR_GLOBAL",
        "VAR_EXTERNAL",
        "END_VAR",
        "TYPE",
        "STRUCT",
        "CONFIGURATION",
    ];
    /// Keywords that begin statements.
    const STATEMENTS: [&str; 9] = [
        "IF",
        "ELSIF",
        "END_IF",
        "CASE",
        "END_CASE",
        "WHILE",
        "END_WHILE",
        "REPEAT",
        "END_FOR",
    ];
    let begin = line.len() - line.trim_start().len();
    let word = line[begin..].split_whitespace().next()?;
    let upper = word.to_ascii_uppercase();
    if DECLARATIONS.contains(&upper.as_str()) {
        return Some((Language::List, begin, begin + word.len()));
    }
    if STATEMENTS.contains(&upper.as_str()) {
        return Some((Language::StructuredText, begin, begin + word.len()));
    }
    if let Some(at) = line.find(":=") {
        return Some((Language::StructuredText, at, at + 2));
    }
    let at = line.find('%')?;
    let address =
        line[at + 1..].trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c == '.');
    let end = line.len() - address.len();
    let mut letters = line[at + 1..end].bytes().map(|b| b.to_ascii_uppercase());
    let area = letters.next().is_some_and(|area| b"IQM".contains(&area));
    let size = letters
        .next()
        .is_some_and(|next| b"XBWDL0123456789".contains(&next));
    (area && size).then_some((Language::List, at, end))
}

#[cfg(test)]
mod tests {
    use super::detect;

    #[test]
    fn a_list_with_one_such_line_stays_a_list() {
        let list = "LD X0\nOUT Y0\nLD X1\nOUT Y1\nLD X2\nOUT Y2\nY3 := X3\nEND\n";
        assert!(detect("a.il", list).is_none());
        assert!(detect("a.il", "LD X0 ; VAR := 5 %IX0.0\n; IF\nEND\n").is_none());
        assert!(detect("a.il", "LD X0\n$MOV \"%IX0 := \" D0\nEND\n").is_none());
        assert!(detect("a.il", "").is_none());
    }

    #[test]
    fn foreign_lines_in_a_list_hide_none_of_its_mistakes() {
        let list = "LD X0\nTON T0 K30\nLD X1\nOUT Y1\nIF M0\nOUT %QX0.0\nEND\n";
        assert!(detect("a.il", list).is_none());
        let mistakes = "LDD X1\nOUT Y9\nMOV D0\nOUT M99999\nSETT M0\nEND\n";
        for foreign in [
            "IF X0 THEN\n",
            "VAR\n",
            "Y0 := X0\n",
            "LD X0\nTON T1 K5\nIF X0 THEN\n",
        ] {
            assert!(
                detect("a.il", &format!("{foreign}{mistakes}")).is_none(),
                "{foreign}"
            );
        }
        assert!(detect("a.st", "IF X0 THEN\nLD X0\nOUT Y0\nEND_IF\n").is_some());
        assert!(detect("a.il", "LD start\nIF X0\nY0 := X0\nEND\n").is_some());
    }
}
