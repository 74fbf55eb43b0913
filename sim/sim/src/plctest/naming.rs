//! What names in a test file stand for: devices, also by their comments, and ports.

use super::format::Reader;
use super::program::CaseProgram;
use super::serial::{self, Port, PortId, Way};
use crate::names::Comments;
use crate::target::Target;
use rungc_models::{Model, Plc};
use rungc_project::serve;
use toml::Spanned;

/// A PLC whose devices and ports are named.
pub(super) struct Named {
    plc: Plc,
    program: CaseProgram,
    /// Comments of the program, once one was looked up.
    comments: Option<Comments>,
}

impl Named {
    pub(super) fn new(plc: Plc, program: CaseProgram) -> Self {
        Named {
            plc,
            program,
            comments: None,
        }
    }

    /// Its model.
    pub(super) fn model(&self) -> &'static Model {
        Model::get(self.plc.model)
    }

    /// Devices by the comments of its program.
    pub(super) fn comments(&mut self) -> &Comments {
        let program = &self.program;
        self.comments.get_or_insert_with(|| match program {
            CaseProgram::List(list) => {
                Comments::of(&rungc_frontend::read_text("list.il", list).program)
            }
            CaseProgram::File(file) => Comments::of(&file.read.program),
        })
    }
}

impl Reader<'_> {
    /// A name without that of another PLC before it, and the number of its PLC.
    pub(super) fn own<'n>(&self, name: &'n str) -> (&'n str, usize) {
        let other = name.split_once(':').and_then(|(plc, own)| {
            let number = self.others.iter().position(|other| other == plc)?;
            Some((own, number + 1))
        });
        other.unwrap_or((name, 0))
    }

    /// The device of a name, and the number of its PLC.
    pub(super) fn target(&mut self, name: &Spanned<String>) -> Option<(usize, Target)> {
        let (own, plc) = self.own(name.get_ref());
        let parsed = match (Target::parse(own), self.named.get_mut(plc)) {
            (Err(_), Some(named)) => {
                let comments = named.comments();
                comments.target(own, Target::parse).map_err(|wrong| {
                    let near = comments.similar(own);
                    near.map_or(wrong, |near| {
                        format!("`{own}` is not a device or a comment; did you mean `{near}`?")
                    })
                })
            }
            (parsed, _) => parsed,
        };
        match parsed {
            Ok(target) => Some((plc, target)),
            Err(message) => {
                self.report(name.span().start, message);
                None
            }
        }
    }

    /// The port of a name.
    pub(super) fn port(&mut self, port: &Spanned<String>) -> Option<Port> {
        let (own, plc) = self.own(port.get_ref());
        let parsed = PortId::parse(own).map_err(str::to_string);
        let found = parsed.and_then(|id| match self.missing(plc, &id) {
            Some(missing) => Err(missing),
            None => Ok(Port { plc, id }),
        });
        match found {
            Ok(port) => Some(port),
            Err(message) => {
                self.report(port.span().start, message);
                None
            }
        }
    }

    /// Message for a port that the PLC does not have.
    fn missing(&self, plc: usize, port: &PortId) -> Option<String> {
        let (number, named) = (port.number()?, self.named.get(plc)?);
        let model = named.model();
        let (message, help) = serve::missing_port(model, number)?;
        // A model stands for compatible boards, too.
        let of_boards = model
            .boards
            .map(|boards| Model::get(boards).ports.get(number));
        match of_boards.flatten() {
            Some(_) => None,
            None => Some(format!("{message}; {help}")),
        }
    }

    /// The ports of a line: two or more of PLCs, each once.
    pub(super) fn wire(&mut self, line: &[Spanned<String>]) -> Vec<Port> {
        let mut ports: Vec<Port> = Vec::new();
        for name in line {
            let Some(port) = self.port(name) else {
                continue;
            };
            let at = name.span().start;
            if port.id.number().is_none() {
                self.report(at, format!("`{}` is not a port of a PLC", name.get_ref()));
            } else if ports.contains(&port) {
                self.report(at, format!("`{}` is on this line already", name.get_ref()));
            } else if line.len() == 1 {
                let message = format!("`{}` is alone on its line", name.get_ref());
                self.report(at, message);
            }
            ports.push(port);
        }
        ports
    }

    /// Holds what goes over a port to the format; returns the port.
    pub(super) fn line_text(
        &mut self,
        port: &Spanned<String>,
        way: Way,
        texts: &[String],
    ) -> Option<Port> {
        let (own, _) = self.own(port.get_ref());
        for text in texts {
            if let Err(message) = serial::check_text(own, way, text) {
                self.report(port.span().start, message.to_string());
            }
        }
        self.port(port)
    }
}
