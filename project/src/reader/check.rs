//! `[check]` and `[report]`.

use super::Reader;
use crate::{Language, Named, Project};
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Severity, diag};
use toml::de::DeTable;

impl Reader {
    pub(super) fn check(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let mut seen: Vec<(&'static str, &'static str)> = Vec::new();
        for key in ["allow", "warn", "deny"] {
            for name in self.list(table, key) {
                let Some(code) = self.code(&name, key) else {
                    continue;
                };
                if let Some((_, other)) = seen.iter().find(|(id, _)| *id == code.id) {
                    let message = format!("`{}` is already in `{other}`", name.text);
                    self.wrong(name.span, message, "");
                    continue;
                }
                seen.push((code.id, key));
                match key {
                    "allow" => project.check.allow.push(code.id),
                    "warn" => project.check.warn.push(code.id),
                    _ => project.check.deny.push(code.id),
                }
            }
        }
    }

    /// The code with a name, if its severity is what the key takes.
    fn code(&mut self, name: &Named, key: &str) -> Option<&'static Code> {
        let (what, takes): (_, fn(Severity) -> bool) = match key {
            "allow" => ("warning", |severity| severity != Severity::Error),
            "warn" => ("error", |severity| severity == Severity::Error),
            _ => ("warning", |severity| severity == Severity::Warning),
        };
        let Some(code) = codes::find(&name.text) else {
            let names: Vec<_> = codes::all()
                .into_iter()
                .filter(|code| takes(code.severity))
                .flat_map(|code| [code.id, code.name])
                .collect();
            let near = diag::did_you_mean(&name.text.to_lowercase(), names);
            let help = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let message = format!("unknown {what} `{}`", name.text);
            self.wrong(name.span, message, &help);
            return None;
        };
        if !takes(code.severity) {
            let is = match code.severity {
                Severity::Error => "an error",
                Severity::Warning => "a warning",
                Severity::Note => "a note",
            };
            let message = format!("`{}` is {is}; `{key}` is for {what}s", name.text);
            self.wrong(name.span, message, "");
            return None;
        }
        if key == "warn"
            && let Err(why) = code.can_be_eased()
        {
            let message = format!("`{}` must remain an error", name.text);
            self.wrong(name.span, message, why);
            return None;
        }
        Some(code)
    }

    pub(super) fn report(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let Some(name) = self.get(table, "lang") else {
            return;
        };
        project.language = Language::find(&name.text);
        if project.language.is_none() {
            let message = format!("unknown language `{}`", name.text);
            self.wrong(name.span, message, &Language::known());
        }
    }
}
