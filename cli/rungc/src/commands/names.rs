//! Devices as the command line and the page name them: `D0`, or by the comment that the program has on it.

use super::setting;
use rungc_syntax::{Device, DeviceClass, Program, diag};
use std::collections::BTreeMap;

/// Devices of a program by their comments.
#[derive(Clone, Debug)]
pub struct Names(BTreeMap<String, Vec<Device>>);

/// A comment without what people leave out: case, and blanks at the ends and in rows.
fn plain(comment: &str) -> String {
    let words: Vec<_> = comment.split_whitespace().collect();
    words.join(" ").to_lowercase()
}

impl Names {
    /// The names that the comments of a program give.
    pub fn of(program: &Program) -> Self {
        let mut names: BTreeMap<String, Vec<Device>> = BTreeMap::new();
        for (device, comment) in &program.comments {
            names.entry(plain(comment)).or_default().push(*device);
        }
        names.remove("");
        Names(names)
    }

    /// The devices with this comment.
    pub fn with_comment(&self, name: &str) -> &[Device] {
        self.0.get(&plain(name)).map_or(&[], Vec::as_slice)
    }

    /// Reads what is set or watched: `D0.f32`, or `Speed.f32` of a comment `Speed`.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn target(&self, text: &str) -> Result<rungc_sim::Target, String> {
        self.read(text, setting::target, |wrong| match text.rsplit_once('.') {
            Some((name, view)) => match self.commented(name)? {
                Some(device) => setting::target(&format!("{device}.{view}")),
                None => Err(wrong),
            },
            None => Err(wrong),
        })
    }

    /// Reads one device: `M100`.
    ///
    /// # Errors
    /// Description of the mistake.
    fn device(&self, text: &str) -> Result<Device, String> {
        let device = |text: &str| {
            rungc_project::device::device(&text.trim().to_uppercase())
                .ok_or_else(|| format!("`{text}`: a device is written `X010`, `M100` or `D0`"))
        };
        self.read(text, device, Err)
    }

    /// Reads devices in a row: `M100..M199`, or one.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn range(&self, text: &str) -> Result<(DeviceClass, u32, u32), String> {
        let range = |text: &str| {
            rungc_project::device::range(&text.to_uppercase())
                .ok_or_else(|| format!("`{text}`: devices are written `M100` or `D100..D199`"))
        };
        self.read(text, range, |wrong| {
            let Some((first, last)) = text.split_once("..") else {
                return Err(wrong);
            };
            let ends = [first, last].map(|end| self.device(end).map(|device| device.to_string()));
            let [first, last] = ends;
            range(&format!("{}..{}", first?, last?))
        })
    }

    /// Reads a text as devices, then as a comment, then in `another` way.
    fn read<T>(
        &self,
        text: &str,
        read: impl Fn(&str) -> Result<T, String>,
        another: impl FnOnce(String) -> Result<T, String>,
    ) -> Result<T, String> {
        let wrong = match read(text) {
            Ok(read) => return Ok(read),
            Err(wrong) => wrong,
        };
        match self.commented(text)? {
            Some(device) => read(&device.to_string()),
            None => another(wrong).map_err(|wrong| self.unknown(text, &wrong)),
        }
    }

    /// The device with this comment, if there is one.
    fn commented(&self, name: &str) -> Result<Option<Device>, String> {
        match self.with_comment(name) {
            [] => Ok(None),
            [device] => Ok(Some(*device)),
            [first, second, ..] => Err(format!(
                "`{name}` is the comment of several devices, such as {first} and {second}"
            )),
        }
    }

    /// Message for a text that is neither a device nor a comment; `wrong` says what is wrong with it as a device.
    fn unknown(&self, text: &str, wrong: &str) -> String {
        let text = text.trim();
        let digits = text
            .find(|c: char| c.is_ascii_digit())
            .unwrap_or(text.len());
        let letters = text[..digits].to_uppercase();
        if digits < text.len() && DeviceClass::from_prefix(&letters).is_some() {
            return wrong.to_string();
        }
        let name = plain(text);
        let near = diag::did_you_mean(&name, self.0.keys().map(String::as_str));
        let is_part = |known: &&String| name.chars().count() > 2 && known.contains(&name);
        let part = || self.0.keys().find(is_part).map(String::as_str);
        match near.or_else(part) {
            Some(near) => format!("`{text}` is not a device or a comment; did you mean `{near}`?"),
            None => wrong.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_sim::Target;

    fn names() -> Names {
        let list = ";! X003 = Guard  open\n;! D10 = Speed\n;! T5 = Delay\n;! M1 = Ready\n;! M2 = ready\nLD X3\nEND\n";
        Names::of(&rungc_frontend::read_text("a.il", list).program)
    }

    #[test]
    fn comments_name_devices_in_any_place() {
        let names = names();
        let guard = Device {
            class: DeviceClass::X,
            number: 3,
        };
        for written in ["X3", "x003", "Guard open", " guard  OPEN "] {
            assert_eq!(names.device(written), Ok(guard), "{written}");
            assert_eq!(
                names.target(written),
                Ok(Target::Bit(DeviceClass::X, 3)),
                "{written}"
            );
            assert_eq!(
                names.range(written),
                Ok((DeviceClass::X, 3, 3)),
                "{written}"
            );
        }
        assert_eq!(
            names.target("speed.f32"),
            Ok(Target::Float(DeviceClass::D, 10))
        );
        assert_eq!(
            names.target("Delay"),
            Ok(Target::Current(DeviceClass::T, 5))
        );
        let range = Ok((DeviceClass::D, 10, 15));
        for written in ["D10..D15", "d10-d15", "Speed..D15"] {
            assert_eq!(names.range(written), range, "{written}");
        }
    }

    #[test]
    fn names_without_one_device_are_explained() {
        let names = names();
        let several = names.target("Ready").unwrap_err();
        assert_eq!(
            several,
            "`Ready` is the comment of several devices, such as M1 and M2"
        );
        let near = names.device("Guards open").unwrap_err();
        assert_eq!(
            near,
            "`Guards open` is not a device or a comment; did you mean `guard open`?"
        );
        assert!(
            names
                .device("Q1")
                .unwrap_err()
                .ends_with("a device is written `X010`, `M100` or `D0`")
        );
        assert!(names.target("X008").unwrap_err().contains("octal"));
        assert!(names.target("Speed.hz").is_err());
        assert!(names.range("Guard open..Speed").is_err());
    }
}
