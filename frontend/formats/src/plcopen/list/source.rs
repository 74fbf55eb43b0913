//! The lines of an instruction list: comments, and instructions with their operands.

/// A line.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Line {
    /// A comment that stands alone.
    Comment(String),
    /// Instructions; one with parameters is whole.
    Code(String),
}

/// The lines of a text. Comments beside instructions are left out.
pub(super) fn lines(text: &str) -> Vec<Line> {
    let mut out = Vec::new();
    let mut code = String::new();
    let mut rest = text;
    while let Some(start) = comment(rest) {
        let end = rest[start..].find("*)");
        let end = end.map_or(rest.len(), |end| start + end + 2);
        code.push_str(&rest[..start]);
        let is_alone = code
            .rsplit('\n')
            .next()
            .is_some_and(|before| before.trim().is_empty());
        let after = rest[end..].split('\n').next().unwrap_or_default();
        if is_alone && after.trim().is_empty() && !is_open_call(&code) {
            add(&mut out, &code);
            code.clear();
            let inside = rest[start + 2..end].trim_end_matches("*)");
            let comments = inside
                .lines()
                .map(str::trim)
                .filter(|line| !line.is_empty());
            out.extend(comments.map(|comment| Line::Comment(comment.to_owned())));
        } else {
            code.extend(rest[start..end].chars().filter(|c| *c == '\n'));
        }
        rest = &rest[end..];
    }
    code.push_str(rest);
    add(&mut out, &code);
    out
}

/// Start of the first comment. Texts hold none.
fn comment(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        let found = at + text[at..].find(['"', '('])?;
        at = found + 1;
        if text[found..].starts_with("(*") {
            return Some(found);
        }
        if text[found..].starts_with('"') {
            let end = text[at..].find(['"', '\n']).map(|end| at + end);
            at = end
                .filter(|end| text[*end..].starts_with('"'))
                .map_or(at, |end| end + 1);
        }
    }
}

/// A list in which texts hold no parentheses, with everything at its place.
fn without_texts(list: &str) -> String {
    let mut in_text = false;
    let letter = |c: char| {
        in_text = c != '\n' && in_text != (c == '"');
        if in_text && matches!(c, '(' | ')') {
            ' '
        } else {
            c
        }
    };
    list.chars().map(letter).collect()
}

/// Returns true if the last line of a list calls something and its parameters are not complete.
fn is_open_call(list: &str) -> bool {
    let text = without_texts(list);
    let Some(start) = text.rfind('(') else {
        return false;
    };
    let line = text[..start].rsplit('\n').next().unwrap_or_default();
    let line = line.trim_start();
    let calls = line
        .get(..4)
        .is_some_and(|word| word.eq_ignore_ascii_case("CAL "))
        || line.starts_with(super::blocks::INSTRUCTION);
    calls && !text[start..].contains(')')
}

/// Adds lines of code; what is between the parentheses of a call becomes one line.
fn add(out: &mut Vec<Line>, text: &str) {
    let mut whole = String::new();
    for line in text.lines() {
        if !whole.is_empty() {
            whole.push(' ');
        }
        whole.push_str(line.trim());
        if !is_open_call(&whole) {
            out.push(Line::Code(std::mem::take(&mut whole)));
        }
    }
    if !whole.is_empty() {
        out.push(Line::Code(whole));
    }
}
