//! Devices as users name them: `D0`, or by the comment that the program has on it.

use rungc_project::device;
use rungc_sim::Target;
use rungc_sim::names::Comments;
use rungc_sim::record::decimal;
use rungc_syntax::{Device, DeviceClass, Program};

/// The greatest signal of a channel, in its unit.
const MOST_SIGNAL: f64 = 2000.0;

/// Devices of a program by their comments.
#[derive(Clone, Debug)]
pub struct Names {
    comments: Comments,
    /// The largest number of commas in a comment.
    most_commas: usize,
}

/// Reads what is watched or set by its device: `D0.f32`. A timer or counter is its current value.
///
/// # Errors
/// Description of the mistake.
pub fn target(name: &str) -> Result<Target, String> {
    let upper = upper(name);
    if device::range(&name.trim().to_uppercase()).is_some_and(|(_, first, last)| first < last) {
        return Err(format!("`{name}`: name one device"));
    }
    // As its author wrote it.
    let written =
        |wrong: String| wrong.replacen(&format!("`{upper}`"), &format!("`{}`", name.trim()), 1);
    match Target::parse(&upper).map_err(written)? {
        Target::Bit(class @ (DeviceClass::T | DeviceClass::C), n) => Ok(Target::Current(class, n)),
        target => Ok(target),
    }
}

/// Device letters in upper case, views (`.i32`) as they are.
fn upper(name: &str) -> String {
    let (device, view) = name
        .trim()
        .split_once('.')
        .map_or((name.trim(), None), |(d, v)| (d, Some(v)));
    let device = device.to_uppercase();
    view.map_or(device.clone(), |view| {
        format!("{device}.{}", view.to_lowercase())
    })
}

/// A name in quotes, and what follows it.
fn quoted(text: &str) -> Option<(&str, &str)> {
    text.trim().strip_prefix('"')?.split_once('"')
}

impl Names {
    /// The names that the comments of a program give.
    pub fn of(program: &Program) -> Self {
        let comments = Comments::of(program);
        Names {
            most_commas: comments.most_commas(),
            comments,
        }
    }

    /// The devices with this comment.
    pub fn with_comment(&self, name: &str) -> &[Device] {
        self.comments.devices(name)
    }

    /// Splits a list at its commas, but for those in quotes and in comments; `name` finds the name in an item.
    pub fn items<'t>(&self, list: &'t str, name: fn(&str) -> &str) -> Vec<&'t str> {
        let mut items = Vec::new();
        let mut rest = Some(list);
        while let Some(text) = rest {
            let end = self.item(text, name);
            items.push(&text[..end]);
            rest = text.get(end + 1..);
        }
        items
    }

    /// Length of the first item of a list.
    fn item(&self, list: &str, name: fn(&str) -> &str) -> usize {
        let next = |from: usize| list[from..].find(',').map_or(list.len(), |at| from + at);
        if let Some((_, after)) = quoted(list) {
            return next(list.trim_end().len() - after.len());
        }
        let ends = list.match_indices(',').map(|(at, _)| at);
        let is_comment = |end: &usize| {
            let name = name(&list[..*end]);
            let is_view = |view: &str| view.bytes().all(|byte| byte.is_ascii_alphanumeric());
            let view = name.rsplit_once('.').filter(|(_, view)| is_view(view));
            let plain = view.map_or(name, |(plain, _)| plain);
            name.contains(',')
                && [name, plain]
                    .iter()
                    .any(|name| !self.comments.devices(name).is_empty())
        };
        // A list may be long, and a comment has few commas.
        let ends = ends.chain([list.len()]).take(self.most_commas + 1);
        let longest = ends.filter(is_comment).last();
        longest.unwrap_or_else(|| next(0))
    }

    /// Reads what is set or watched: `D0.f32`, or `Speed.f32` of a comment `Speed`. A name in quotes is a comment.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn target(&self, text: &str) -> Result<Target, String> {
        if let Some((name, view)) = quoted(text) {
            let device = self.comments.device(name)?;
            let device = device.ok_or_else(|| self.unknown(name, &not_a_comment(name)))?;
            return target(&format!("{device}{view}"));
        }
        let target = self.comments.target(text, target);
        target.map_err(|wrong| self.unknown(text, &wrong))
    }

    /// Reads what is watched: as [`target`](Self::target), or devices in a row: `Y000..Y007`.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn targets(&self, text: &str) -> Result<Vec<Target>, String> {
        match self.range(text) {
            Ok((class, first, last)) if first < last || is_range(text) => {
                let names = (first..=last).map(|number| class.number(number).to_string());
                names.map(|name| self.target(&name)).collect()
            }
            Err(wrong) if is_range(text) => Err(wrong),
            _ => self.target(text).map(|target| vec![target]),
        }
    }

    /// Reads one device: `M100`.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn device(&self, text: &str) -> Result<Device, String> {
        let device = |text: &str| {
            let upper = text.trim().to_uppercase();
            device::device(&upper)
                .ok_or_else(|| wrong(text, &upper, "a device is written `X010`, `M100` or `D0`"))
        };
        self.read(text, device, Err)
    }

    /// Reads devices in a row: `M100..M199`, or one.
    ///
    /// # Errors
    /// Description of the mistake.
    pub fn range(&self, text: &str) -> Result<(DeviceClass, u32, u32), String> {
        let range = |text: &str| {
            let upper = text.to_uppercase();
            let example = "devices are written `M100` or `D100..D199`";
            device::range(&upper).ok_or_else(|| wrong(text, &upper, example))
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
        if let Some((name, "")) = quoted(text) {
            let device = self.comments.device(name)?;
            let device = device.ok_or_else(|| self.unknown(name, &not_a_comment(name)))?;
            return read(&device.to_string());
        }
        let wrong = match read(text) {
            Ok(read) => return Ok(read),
            Err(wrong) => wrong,
        };
        match self.comments.device(text)? {
            Some(device) => read(&device.to_string()),
            None => another(wrong).map_err(|wrong| self.unknown(text, &wrong)),
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
        match self.comments.similar(text) {
            Some(near) => format!("`{text}` is not a device or a comment; did you mean `{near}`?"),
            None => wrong.to_string(),
        }
    }
}

/// Returns true for a text with a device at either end, whether or not they can be a range: `D10..D0`.
fn is_range(text: &str) -> bool {
    let is_device = |end: &str| {
        let digits = end.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        let letters = end[..end.len() - digits.len()].to_uppercase();
        let is_number = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
        is_number && DeviceClass::from_prefix(&letters).is_some()
    };
    let ends = text.split_once("..").or_else(|| text.split_once('-'));
    ends.is_some_and(|(first, last)| is_device(first.trim()) && is_device(last.trim()))
}

/// Message for a text that does not name devices; `example` says how it would.
fn wrong(text: &str, upper: &str, example: &str) -> String {
    match device::mistake(upper) {
        Some(why) => format!("`{text}`: {why}; {example}"),
        None => format!("`{text}`: {example}"),
    }
}

/// Message for a name in quotes that is not a comment.
fn not_a_comment(name: &str) -> String {
    format!("no device has the comment `{name}`")
}

/// Checks that a device can be set to a value.
///
/// # Errors
/// The reason why not.
pub fn fits(target: Target, value: f64) -> Result<(), String> {
    let fits = match target {
        Target::Float(..) => Target::is_float(value),
        Target::Channel(_) => value.abs() <= MOST_SIGNAL,
        Target::Text(..) => return Err("characters cannot be set here".to_string()),
        Target::Pulses(_) | Target::Frequency(_) => {
            return Err("only the program can send pulses".to_string());
        }
        Target::Bit(..)
        | Target::Word(..)
        | Target::Current(..)
        | Target::Pair(..)
        | Target::Nibbles(..) => {
            let range = target.integers();
            value.fract() == 0.0 && range.is_some_and(|range| range.contains(&(value as i64)))
        }
    };
    let holds = match (target, target.integers()) {
        (Target::Bit(..), _) => "is 0 or 1".to_owned(),
        (_, Some(range)) => format!("holds integers from {} to {}", range.start(), range.end()),
        (Target::Channel(_), None) => format!("is -{MOST_SIGNAL} to {MOST_SIGNAL}"),
        (_, None) => "holds numbers of 32 bits: 0, or 1.4e-45 to 3.4e38".to_owned(),
    };
    match fits {
        true => Ok(()),
        false => {
            let value = decimal(value);
            Err(format!("`{value}` does not fit `{target}`, which {holds}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            "`Guards open` is not a device or a comment; did you mean `Guard open`?"
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

    #[test]
    fn lists_are_split_at_commas_between_items() {
        let list = ";! D0 = Speed, set\n;! D2 = Speed\n;! M0 = a, b, c\nLD M0\nEND\n";
        let names = Names::of(&rungc_frontend::read_text("a.il", list).program);
        let of_setting = |text: &str| {
            let name: fn(&str) -> &str =
                |item| item.rsplit_once('=').map_or(item, |(name, _)| name);
            names.items(text, name).join("|")
        };
        for (list, items) in [
            ("X0=1,Speed=2", "X0=1|Speed=2"),
            ("Speed, set=5,X0=1", "Speed, set=5|X0=1"),
            ("X0=1,speed,  set.f32=5@1s", "X0=1|speed,  set.f32=5@1s"),
            ("\"Speed, set\"=5,X0=1", "\"Speed, set\"=5|X0=1"),
            ("A, B, C=1,M1=0", "A, B, C=1|M1=0"),
            ("M0=1,,M1=1", "M0=1||M1=1"),
            ("M0=1,", "M0=1|"),
        ] {
            assert_eq!(of_setting(list), items);
        }
        let long = vec!["D0=1"; 20_000].join(",");
        assert_eq!(of_setting(&long).split('|').count(), 20_000);
        let watched = names.items("Speed, set.f32,Speed,D0", |name| name);
        assert_eq!(watched, ["Speed, set.f32", "Speed", "D0"]);
        assert_eq!(
            names.target("\"speed, set\".i32"),
            Ok(Target::Pair(DeviceClass::D, 0))
        );
        assert!(
            names
                .target("\"D0\"")
                .unwrap_err()
                .contains("no device has the comment")
        );
    }

    #[test]
    fn ranges_that_are_wrong_say_why() {
        let names = names();
        for (text, why) in [
            ("Q9", "there are no devices Q"),
            ("X999", "the numbers of X are octal"),
            ("X0..X8", "the numbers of X are octal"),
            ("D5..D0", "the first device is after the last"),
            ("Speed..D0", "the first device is after the last"),
            ("D0..M5", "both ends are devices of one class"),
            ("D9999999", "no model has that many"),
        ] {
            let wrong = names.range(text).unwrap_err();
            assert!(wrong.contains(why), "{text}: {wrong}");
        }
        // What is watched, too.
        for (text, why) in [
            ("D10..D0", "write `D0..D10`"),
            ("x7-x0", "write `X000..X007`"),
            ("D0-M10", "both ends are devices of one class"),
        ] {
            let wrong = names.targets(text).unwrap_err();
            assert!(wrong.contains(why), "{text}: {wrong}");
        }
        assert_eq!(names.targets("D5..D5").unwrap().len(), 1);
        assert_eq!(names.targets("D5-D7").unwrap().len(), 3);
    }
}
