//! Devices by the comments that a program has on them.

use crate::target::Target;
use rungc_syntax::{Device, Program, diag};
use std::collections::BTreeMap;
use unicode_normalization::UnicodeNormalization;

/// Devices of a program by their comments.
#[derive(Clone, Debug, Default)]
pub struct Comments(BTreeMap<String, Commented>);

/// Devices with one comment.
#[derive(Clone, Debug)]
struct Commented {
    /// The comment of the first of them, as written.
    comment: String,
    devices: Vec<Device>,
}

/// A comment without what people leave out, and what they do not see: case, blanks at the ends and in rows, and whether
/// a letter and its accent are one character or two.
fn plain(comment: &str) -> String {
    words(comment).nfc().collect::<String>().to_lowercase()
}

/// The words of a comment, with a blank between them.
fn words(comment: &str) -> String {
    comment.split_whitespace().collect::<Vec<_>>().join(" ")
}

impl Comments {
    /// The comments of a program.
    pub fn of(program: &Program) -> Self {
        let mut comments: BTreeMap<String, Commented> = BTreeMap::new();
        for (device, comment) in &program.comments {
            let entry = comments.entry(plain(comment));
            let commented = entry.or_insert_with(|| Commented {
                comment: words(comment),
                devices: Vec::new(),
            });
            commented.devices.push(*device);
        }
        comments.remove("");
        Comments(comments)
    }

    /// The devices with this comment.
    pub fn devices(&self, comment: &str) -> &[Device] {
        let found = self.0.get(&plain(comment));
        found.map_or(&[], |commented| &commented.devices)
    }

    /// The largest number of commas in a comment.
    pub fn most_commas(&self) -> usize {
        let commas = self.0.keys().map(|comment| comment.matches(',').count());
        commas.max().unwrap_or(0)
    }

    /// The device with this comment, if there is one.
    ///
    /// # Errors
    /// Several devices have it.
    pub fn device(&self, comment: &str) -> Result<Option<Device>, String> {
        match self.devices(comment) {
            [] => Ok(None),
            [device] => Ok(Some(*device)),
            [first, second, ..] => Err(format!(
                "`{comment}` is the comment of several devices, such as {first} and {second}"
            )),
        }
    }

    /// Reads a name as `read` does, or as that of a device by its comment: `Speed`, or `Speed.f32`.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn target(
        &self,
        name: &str,
        read: impl Fn(&str) -> Result<Target, String>,
    ) -> Result<Target, String> {
        let wrong = match read(name) {
            Ok(target) => return Ok(target),
            Err(wrong) => wrong,
        };
        if let Some(device) = self.device(name)? {
            return read(&device.to_string());
        }
        match name.rsplit_once('.') {
            Some((comment, view)) => match self.device(comment)? {
                Some(device) => read(&format!("{device}.{view}")),
                None => Err(wrong),
            },
            None => Err(wrong),
        }
    }

    /// The comment that is meant by a misspelt one or by a part of it, as the program has it; `None` for a comment.
    pub fn similar(&self, name: &str) -> Option<&str> {
        let name = plain(name);
        if self.0.contains_key(&name) {
            return None;
        }
        let near = diag::did_you_mean(&name, self.0.keys().map(String::as_str));
        let is_part = |known: &&String| name.chars().count() > 2 && known.contains(&name);
        let part = || self.0.keys().find(is_part).map(String::as_str);
        let found = self.0.get(near.or_else(part)?)?;
        Some(&found.comment)
    }
}

#[cfg(test)]
mod tests {
    use super::Comments;

    #[test]
    fn accents_are_found_in_both_notations() {
        let list = ";! X000 = Tür  öffnen\n;! X001 = Tu\u{308}r zu\nLD X000\nEND\n";
        let comments = Comments::of(&rungc_frontend::read_text("a.il", list).program);
        for (name, device) in [
            ("Tür öffnen", "X000"),
            ("Tu\u{308}r o\u{308}ffnen", "X000"),
            ("TÜR ZU", "X001"),
            ("tu\u{308}r zu", "X001"),
        ] {
            let found = comments.device(name).unwrap();
            assert_eq!(
                found.map(|d| d.to_string()).as_deref(),
                Some(device),
                "{name}"
            );
        }
        assert_eq!(comments.similar("Tür offnen"), Some("Tür öffnen"));
    }
}
