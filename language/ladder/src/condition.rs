//! Contacts as a formula, in the notation of IEC 60848.

use crate::face::{Face, operand_text};
use crate::network::{Branch, Contact, Part, Series, Shape};

/// Condition of contacts in series.
#[derive(Clone, Debug, Default)]
pub(crate) struct Condition {
    factors: Vec<Factor>,
}

#[derive(Clone, Debug)]
enum Factor {
    Plain(String),
    /// Alternatives, with nothing around them yet.
    Sum(String),
}

impl Condition {
    /// The contacts of a network that has no picture.
    pub(crate) fn unknown(network: usize) -> Self {
        Condition {
            factors: vec![Factor::Plain(format!("network {network}"))],
        }
    }

    /// Returns true if it is always fulfilled.
    pub(crate) fn is_always(&self) -> bool {
        self.factors.is_empty()
    }

    /// With more contacts after it.
    pub(crate) fn pass(&mut self, face: &Face, series: &Series) {
        for part in series {
            let factor = match part {
                Part::Contact(contact) => Factor::Plain(contact_text(face, *contact)),
                Part::Group(parts) => {
                    self.pass(face, parts);
                    continue;
                }
                Part::Parallel(branches) => Factor::Sum(sum(face, branches)),
                Part::Result(instr) => {
                    let all = std::mem::take(self);
                    let sign = match &*face.resolved.program.instrs[*instr].mnemonic {
                        "MEP" => '↑',
                        "MEF" => '↓',
                        _ => '/',
                    };
                    Factor::Plain(format!("{sign}({})", all.text()))
                }
            };
            self.factors.push(factor);
        }
    }

    /// With devices that are on in front of it.
    pub(crate) fn after(&self, devices: impl Iterator<Item = String>) -> Self {
        let devices = devices.map(Factor::Plain);
        Condition {
            factors: devices.chain(self.factors.iter().cloned()).collect(),
        }
    }

    /// As a formula; `1` if it demands nothing.
    pub(crate) fn text(&self) -> String {
        match &self.factors[..] {
            [] => "1".to_string(),
            [Factor::Plain(text) | Factor::Sum(text)] => text.clone(),
            factors => {
                let texts = factors.iter().map(|factor| match factor {
                    Factor::Plain(text) => text.clone(),
                    Factor::Sum(text) => format!("({text})"),
                });
                texts.collect::<Vec<_>>().join(" · ")
            }
        }
    }
}

fn sum(face: &Face, branches: &[Branch]) -> String {
    let texts = branches.iter().map(|branch| {
        let mut condition = Condition::default();
        condition.pass(face, &branch.series);
        condition.text()
    });
    texts.collect::<Vec<_>>().join(" + ")
}

fn contact_text(face: &Face, contact: Contact) -> String {
    let name = operand_text(face.resolved, contact.instr, 0);
    match contact.shape {
        Shape::Open => name,
        Shape::Closed => format!("/{name}"),
        Shape::Rising => format!("↑{name}"),
        Shape::Falling => format!("↓{name}"),
        Shape::Compare => face.boxed(contact.instr),
    }
}
