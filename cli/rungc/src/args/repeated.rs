//! Arguments in messages that name another command for the same programs.

use super::{FileKind, Reading, Reporting};
use clap::ValueEnum;
use rungc_models::{Model, Plc};

impl FileKind {
    /// The arguments that say this.
    fn arguments(&self) -> Vec<String> {
        let FileKind {
            model,
            encoding,
            compiled,
            from,
            names,
        } = self;
        let of_plc = |plc: &Plc| match plc.variant {
            Some(variant) => variant.name.to_string(),
            None => Model::get(plc.model).name.to_string(),
        };
        let values = [
            ("--model", model.as_ref().map(of_plc)),
            (
                "--encoding",
                encoding.map(|encoding| encoding.name().to_lowercase()),
            ),
            (
                "--from",
                from.and_then(|from| Some(from.to_possible_value()?.get_name().to_owned())),
            ),
            ("--names", names.as_ref().map(|names| names.path.clone())),
        ];
        let values = values
            .into_iter()
            .filter_map(|(option, value)| Some([option.to_owned(), value?]));
        let flags = compiled.then(|| "--compiled".to_owned());
        values.flatten().chain(flags).collect()
    }
}

impl Reading {
    /// The arguments with which another command reads programs and judges them in the same way.
    pub fn arguments(&self) -> Vec<String> {
        let Reading {
            kind,
            project,
            reporting,
        } = self;
        let mut arguments = kind.arguments();
        if let Some(project) = project {
            arguments.extend(["--project".to_owned(), project.display().to_string()]);
        }
        arguments.extend(reporting.arguments());
        arguments
    }
}

impl Reporting {
    /// The arguments that say which diagnostics there are, and how severe they are.
    fn arguments(&self) -> Vec<String> {
        let codes = [("-A", &self.allow), ("-D", &self.deny), ("-W", &self.warn)];
        let codes = codes
            .into_iter()
            .flat_map(|(option, codes)| codes.iter().flat_map(move |code| [option, *code]));
        let all = self.deny_warnings.then_some("--deny-warnings");
        codes.chain(all).map(str::to_owned).collect()
    }
}
