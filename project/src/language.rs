//! Languages of human-readable reports.

/// A language that reports can be in.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Language {
    /// English, the language of all other texts.
    #[default]
    English,
    /// Simplified Chinese.
    Chinese,
}

/// Variables of the environment that name the language of messages, the one that counts most first.
const VARIABLES: [&str; 3] = ["LC_ALL", "LC_MESSAGES", "LANG"];

impl Language {
    /// All languages.
    pub const ALL: [Language; 2] = [Language::English, Language::Chinese];

    /// Name in options and settings.
    pub fn name(self) -> &'static str {
        match self {
            Language::English => "en",
            Language::Chinese => "zh",
        }
    }

    /// Tag of the language and its script or region, for tools that read texts.
    pub fn tag(self) -> &'static str {
        match self {
            Language::English => "en",
            Language::Chinese => "zh-CN",
        }
    }

    /// The language with a name, which may state a script, a region and an encoding: `zh`, `zh-CN`, `zh_CN.UTF-8`,
    /// `zh-Hans-CN`. Traditional Chinese is another language.
    pub fn find(name: &str) -> Option<Self> {
        let tag = name.split(['.', '@']).next().unwrap_or_default();
        let tag = tag.replace('_', "-").to_ascii_lowercase();
        let mut parts = tag.split('-');
        let language = parts.next()?;
        let mut rest = parts;
        match language {
            "en" | "c" | "posix" => Some(Language::English),
            "zh" if rest.all(|part| ["cn", "sg", "my", "hans"].contains(&part)) => {
                Some(Language::Chinese)
            }
            _ => None,
        }
    }

    /// The language with a name, as [`find`](Language::find) reads it.
    ///
    /// # Errors
    /// Message that lists the languages.
    pub fn named(name: &str) -> Result<Self, String> {
        Language::find(name).ok_or_else(|| format!("unknown language; {}", Language::known()))
    }

    /// List of the known names, for the message about an unknown one.
    pub(crate) fn known() -> String {
        let known = Language::ALL.map(|language| format!("`{}`", language.name()));
        format!("these are known: {}", known.join(", "))
    }

    /// The language of the environment, whose variables are looked up with `variable`; English where it names another
    /// one, or none.
    pub fn of_environment(variable: impl Fn(&str) -> Option<String>) -> Self {
        let set = VARIABLES.into_iter().filter_map(variable);
        let mut named = set.filter(|value| !value.is_empty());
        let language = named.next().and_then(|name| Language::find(&name));
        language.unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::Language::{self, Chinese, English};

    #[test]
    fn names_may_state_regions_and_encodings() {
        for name in [
            "zh",
            "zh-CN",
            "zh_CN.UTF-8",
            "zh_CN.GB18030",
            "zh-Hans-SG",
            "ZH",
        ] {
            assert_eq!(Language::find(name), Some(Chinese), "{name}");
        }
        for name in ["en", "en_GB.UTF-8", "C", "C.UTF-8", "POSIX"] {
            assert_eq!(Language::find(name), Some(English), "{name}");
        }
        for name in ["zh_TW.UTF-8", "zh-Hant", "de_DE", "", "zhx", "zh-"] {
            assert_eq!(Language::find(name), None, "{name}");
        }
        let error = Language::named("fr").unwrap_err();
        assert_eq!(error, "unknown language; these are known: `en`, `zh`");
    }

    #[test]
    fn variables_of_the_environment_take_precedence_in_the_order_of_posix() {
        let of = |set: &[(&str, &str)]| {
            Language::of_environment(|name| {
                let found = set.iter().find(|(variable, _)| *variable == name);
                found.map(|(_, value)| (*value).to_owned())
            })
        };
        assert_eq!(of(&[]), English);
        assert_eq!(of(&[("LANG", "zh_CN.UTF-8")]), Chinese);
        assert_eq!(of(&[("LANG", "zh_CN.UTF-8"), ("LC_ALL", "C")]), English);
        assert_eq!(of(&[("LANG", "zh_CN.UTF-8"), ("LC_ALL", "")]), Chinese);
        assert_eq!(
            of(&[("LANG", "C"), ("LC_MESSAGES", "zh_CN.UTF-8")]),
            Chinese
        );
        assert_eq!(of(&[("LANG", "de_DE.UTF-8")]), English);
    }
}
