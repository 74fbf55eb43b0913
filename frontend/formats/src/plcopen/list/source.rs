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
    while let Some(start) = rest.find("(*") {
        let end = rest[start..].find("*)");
        let end = end.map_or(rest.len(), |end| start + end + 2);
        code.push_str(&rest[..start]);
        let is_alone = code
            .rsplit('\n')
            .next()
            .is_some_and(|before| before.trim().is_empty());
        let after = rest[end..].split('\n').next().unwrap_or_default();
        if is_alone && after.trim().is_empty() && open_call(&code).is_none() {
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

/// The last line of a text, if it calls something and its parameters are not complete.
fn open_call(text: &str) -> Option<&str> {
    let start = text.rfind('(')?;
    let line = text[..start].rsplit('\n').next()?.trim_start();
    let calls = line
        .get(..4)
        .is_some_and(|word| word.eq_ignore_ascii_case("CAL "))
        || line.starts_with(super::blocks::INSTRUCTION);
    (calls && !text[start..].contains(')')).then_some(line)
}

/// Adds lines of code; what is between the parentheses of a call becomes one line.
fn add(out: &mut Vec<Line>, text: &str) {
    let mut whole = String::new();
    for line in text.lines() {
        if !whole.is_empty() {
            whole.push(' ');
        }
        whole.push_str(line.trim());
        if open_call(&whole).is_none() {
            out.push(Line::Code(std::mem::take(&mut whole)));
        }
    }
    if !whole.is_empty() {
        out.push(Line::Code(whole));
    }
}
