//! The language of human-readable reports.

use rungc::Language;

/// Variable of the environment that names the language of rungc alone.
const VARIABLE: &str = "RUNGC_LANG";

/// The language that the command line or the environment asks for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chosen {
    language: Language,
    /// True if it takes precedence over settings.
    is_firm: bool,
}

impl Chosen {
    /// The language for a program whose settings may name one.
    pub fn or(self, settings: Option<Language>) -> Language {
        match settings {
            Some(language) if !self.is_firm => language,
            _ => self.language,
        }
    }

    /// The language where no settings are read.
    pub fn language(self) -> Language {
        self.language
    }
}

/// The language that an option names, else the environment.
///
/// # Errors
/// The variable of rungc names an unknown language.
pub fn chosen(option: Option<Language>) -> Result<Chosen, String> {
    let variable = |name: &str| std::env::var(name).ok();
    let own = match variable(VARIABLE).filter(|name| !name.is_empty()) {
        Some(name) if option.is_none() => {
            let language = Language::named(&name);
            Some(language.map_err(|error| format!("{VARIABLE}={name}: {error}"))?)
        }
        _ => None,
    };
    let firm = option.or(own);
    Ok(Chosen {
        language: firm.unwrap_or_else(|| Language::of_environment(variable)),
        is_firm: firm.is_some(),
    })
}
