//! Parts of answers, so that each fits the memory of an assistant.

use serde_json::{Value, json};

/// Most lines of a part of a text.
const LINES: usize = 200;

/// Most bytes of a part of a text.
const BYTES: usize = 20_000;

/// Most entries of a part of a list.
pub(crate) const ENTRIES: usize = 50;

/// A part of a text.
#[derive(Debug)]
pub(crate) struct Page {
    pub(crate) text: String,
    /// The first line, from 0.
    offset: usize,
    /// Number of lines in all.
    total: usize,
    /// The first line of the next part.
    next: Option<usize>,
}

impl Page {
    /// The part of a text from a line on.
    pub(crate) fn of(text: &str, offset: usize) -> Self {
        let total = text.lines().count();
        let mut part = String::new();
        let mut end = offset.min(total);
        for line in text.lines().skip(offset).take(LINES) {
            if !part.is_empty() && part.len() + line.len() >= BYTES {
                break;
            }
            part.push_str(shortened(line));
            part.push('\n');
            end += 1;
        }
        Page {
            text: part,
            offset,
            total,
            next: (end < total).then_some(end),
        }
    }

    /// Adds the number of lines, and where the next part begins, to an object.
    pub(crate) fn mark(&self, object: &mut Value) {
        object["total"] = json!(self.total);
        object["offset"] = json!(self.offset);
        if let Some(next) = self.next {
            object["next_offset"] = json!(next);
        }
    }

    /// The text, with a remark how to get the rest.
    pub(crate) fn with_remark(&self) -> String {
        format!("{}{}", self.text, remark(self.next, self.total, "lines"))
    }
}

/// A line that is longer than a part is cut.
fn shortened(line: &str) -> &str {
    let end = line
        .char_indices()
        .map(|(at, _)| at)
        .find(|at| *at >= BYTES);
    &line[..end.unwrap_or(line.len())]
}

/// How to get the rest of something.
pub(crate) fn remark(next: Option<usize>, total: usize, what: &str) -> String {
    match next {
        None => String::new(),
        Some(next) => format!(
            "\n[{next} of {total} {what}; call again with \"offset\": {next} for the rest]\n"
        ),
    }
}

/// Part of a list: at most `most` entries, the number of all, and where the next part begins.
pub(crate) fn entries<T>(
    all: Vec<T>,
    offset: usize,
    most: usize,
) -> (Vec<T>, usize, Option<usize>) {
    let total = all.len();
    let part: Vec<T> = all.into_iter().skip(offset).take(most).collect();
    let end = offset.saturating_add(part.len());
    (part, total, (end < total).then_some(end))
}

#[cfg(test)]
mod tests {
    use super::{Page, entries};

    #[test]
    fn parts_follow_each_other_without_gaps() {
        let text: String = (0..450).map(|n| format!("line {n}\n")).collect();
        let mut all = String::new();
        let mut next = Some(0);
        let mut parts = 0;
        while let Some(offset) = next {
            let page = Page::of(&text, offset);
            all.push_str(&page.text);
            next = page.next;
            parts += 1;
        }
        assert_eq!((all, parts), (text, 3));
        assert!(Page::of("a\n", 7).text.is_empty());
        assert!(Page::of(&"启".repeat(50_000), 0).text.len() <= 20_003);
    }

    #[test]
    fn a_list_ends() {
        assert_eq!(entries(vec![1, 2, 3], 1, 1), (vec![2], 3, Some(2)));
        assert_eq!(entries(vec![1, 2, 3], usize::MAX, 2), (vec![], 3, None));
    }
}
