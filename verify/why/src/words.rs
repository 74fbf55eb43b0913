//! Conditions and their members in words.

use crate::answer::{Link, Place};
use crate::graph::{Fact, FactKind, Graph, Id, Node};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Basic, Lower};
use rungc_ladder::Ladder;
use rungc_syntax::{Device, OperandKind};

/// Words of a program.
pub(crate) struct Words<'p> {
    pub(crate) resolved: Resolved<'p>,
    pub(crate) ladder: Ladder,
}

/// Strength of the operator around a condition.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Around {
    Nothing,
    Or,
    And,
    Not,
}

impl Words<'_> {
    /// Comment of a device.
    pub(crate) fn comment(&self, device: Device) -> Option<String> {
        let comment = self.resolved.program.comments.get(&device)?;
        let comment = comment.split_whitespace().collect::<Vec<_>>().join(" ");
        (!comment.is_empty()).then_some(comment)
    }

    /// A device with its comment: `X000 "start"`.
    pub(crate) fn named(&self, device: Device) -> String {
        match self.comment(device) {
            Some(comment) => format!("{device} \"{comment}\""),
            None => device.to_string(),
        }
    }

    /// Place of an instruction.
    pub(crate) fn place(&self, instr: usize) -> Place {
        let mut networks = self.ladder.networks.iter();
        let network = networks.position(|network| network.instrs.contains(&instr));
        Place {
            step: self.resolved.instrs[instr].step,
            network: network.map_or(0, |n| n + 1),
            instruction: self.resolved.program.instrs[instr].to_string(),
        }
    }

    /// An instruction with its step: `MOV D0 D1 (step 5)`.
    pub(crate) fn at(&self, instr: usize) -> String {
        let place = self.place(instr);
        format!("{} (step {})", place.instruction, place.step)
    }

    fn operand(&self, instr: usize, n: usize) -> Option<&OperandKind> {
        let operands = &self.resolved.program.instrs[instr].operands;
        operands.get(n).map(|operand| &operand.kind)
    }

    /// The comparison of an instruction: `D0 > K100`.
    fn comparison(&self, instr: usize) -> Option<String> {
        let Some(Lower::Compare(_, op)) = self.resolved.instrs[instr].lower else {
            return None;
        };
        let [a, b] = [self.operand(instr, 0)?, self.operand(instr, 1)?];
        Some(format!("{a} {} {b}", op.symbol()))
    }

    /// Returns true for a normally closed contact.
    fn is_inverted(&self, instr: Option<usize>) -> bool {
        let lower = instr.and_then(|instr| self.resolved.instrs[instr].lower);
        matches!(
            lower,
            Some(Lower::Basic(Basic::Ldi | Basic::Ani | Basic::Ori))
        )
    }

    /// A bit that is not followed further, in words, and as its opposite.
    fn fact(&self, fact: &Fact) -> [String; 2] {
        let source = || match fact.instr {
            Some(instr) => format!("the result of {}", self.at(instr)),
            None => "the result of the PLC".to_string(),
        };
        let device = |verb: [&str; 2]| match fact.device {
            Some(device) => verb.map(|verb| format!("{} {verb}", self.named(device))),
            None => [source(), format!("not {}", source())],
        };
        match fact.kind {
            FactKind::Constant | FactKind::WordBit | FactKind::Indexed => {
                let operand = fact.instr.and_then(|instr| self.operand(instr, 0));
                let text = operand.map_or_else(source, ToString::to_string);
                let inverse = format!("not {text}");
                // What is constant is the contact, not its relay: LDI M8000.
                match fact.kind == FactKind::Constant && self.is_inverted(fact.instr) {
                    true => [inverse, text],
                    false => [text, inverse],
                }
            }
            FactKind::Comparison => {
                let text = fact.instr.and_then(|instr| self.comparison(instr));
                let text = text.unwrap_or_else(source);
                [text.clone(), format!("not {text}")]
            }
            FactKind::Elapsed => device(["having run its time", "not having run its time"]),
            FactKind::Counted => device(["having counted to its preset", "counting on"]),
            FactKind::Written | FactKind::Other => {
                [source(), format!("another result than {}", source())]
            }
            FactKind::System => match fact.device {
                Some(device) => [self.named(device), format!("not {}", self.named(device))],
                None => {
                    let operand = fact.instr.and_then(|instr| self.operand(instr, 0));
                    let text = operand.map_or_else(source, ToString::to_string);
                    [text.clone(), format!("not {text}")]
                }
            },
        }
    }

    /// A condition: `X000 "start" and not X001`.
    pub(crate) fn condition(&self, graph: &Graph, id: Id) -> String {
        self.within(graph, id, Around::Nothing)
    }

    fn within(&self, graph: &Graph, id: Id, around: Around) -> String {
        let group = |text: String, own: Around| match around > own {
            true => format!("({text})"),
            false => text,
        };
        match graph.node(id) {
            Node::Const(true) => "always".to_string(),
            Node::Const(false) => "never".to_string(),
            Node::Start(device) => self.named(*device),
            Node::Memory(..) => "its state in the scan before".to_string(),
            Node::Contact { device, .. } => self.named(*device),
            Node::Not(a) => match graph.node(*a) {
                Node::Fact(fact) => self.fact(fact)[1].clone(),
                _ => format!("not {}", self.within(graph, *a, Around::Not)),
            },
            Node::And(a, b) => {
                let edge = match (graph.node(*a), graph.node(*b)) {
                    (_, Node::Not(m)) if matches!(graph.node(*m), Node::Memory(..)) => {
                        Some((*a, "coming on"))
                    }
                    (Node::Not(a), Node::Memory(..)) => Some((*a, "going off")),
                    _ => None,
                };
                if let Some((a, verb)) = edge {
                    let edge = format!("{} {verb}", self.within(graph, a, Around::Not));
                    return group(edge, Around::And);
                }
                let [a, b] = [a, b].map(|part| self.within(graph, *part, Around::And));
                group(format!("{a} and {b}"), Around::And)
            }
            Node::Or(a, b) => {
                let [a, b] = [a, b].map(|part| self.within(graph, *part, Around::Or));
                group(format!("{a} or {b}"), Around::Or)
            }
            Node::Fact(fact) => self.fact(fact)[0].clone(),
        }
    }

    /// A member of a set: its state, and that which is needed. `values` gives the values of an instruction's operands.
    pub(crate) fn link(&self, graph: &Graph, id: Id, values: &dyn Fn(usize) -> String) -> Link {
        let on = graph.value(id);
        let of_device = |device: Device, instr: Option<usize>, opaque: bool| {
            let name = self.named(device);
            let [is, other] = match on {
                true => ["on", "off"],
                false => ["off", "on"],
            };
            Link {
                device: Some(device.to_string()),
                comment: self.comment(device),
                now: format!("{name} is {is}"),
                needed: format!("{name} {other}"),
                at: instr.map(|instr| self.place(instr)),
                opaque,
            }
        };
        match graph.node(id) {
            Node::Contact { instr, device, .. } => of_device(*device, *instr, false),
            Node::Start(device) => of_device(*device, None, false),
            Node::Memory(_, instr) => {
                let (now, needed) = match on {
                    true => ("was on in the scan before", "a change: off, then on again"),
                    false => ("was off in the scan before", "a change: on, then off again"),
                };
                let what = instr.map(|instr| self.at(instr));
                let what = what.unwrap_or_else(|| "an edge".to_string());
                let about = instr.and_then(|instr| self.operand(instr, 0)?.device());
                Link {
                    device: about.map(|device| device.to_string()),
                    comment: about.and_then(|device| self.comment(device)),
                    now: format!("the input of {what} {now}"),
                    needed: format!("at {what} {needed}"),
                    at: instr.map(|instr| self.place(instr)),
                    opaque: true,
                }
            }
            Node::Fact(fact) => self.fact_link(fact, on, values),
            _ => Link {
                device: None,
                comment: None,
                now: self.condition(graph, id),
                needed: format!("not {}", self.condition(graph, id)),
                at: None,
                opaque: true,
            },
        }
    }

    fn fact_link(&self, fact: &Fact, on: bool, values: &dyn Fn(usize) -> String) -> Link {
        let [yes, no] = self.fact(fact);
        let place = fact.instr.map(|instr| self.place(instr));
        let about = fact.device.or_else(|| {
            let instr = fact.instr?;
            self.operand(instr, 0)?.device()
        });
        let (now, needed) = match (fact.kind, fact.instr) {
            (FactKind::Comparison, Some(instr)) => {
                let holds = if on { "holds" } else { "does not hold" };
                let needed = if on { no } else { yes.clone() };
                (format!("{yes} {holds} ({})", values(instr)), needed)
            }
            (FactKind::Elapsed | FactKind::Counted, Some(instr)) => {
                let has = if on { "has" } else { "has not" };
                let done = match fact.kind {
                    FactKind::Elapsed => "run its time",
                    _ => "counted to its preset",
                };
                let name = fact
                    .device
                    .map_or_else(|| self.at(instr), |device| self.named(device));
                let needed = if on && fact.kind == FactKind::Counted {
                    no
                } else {
                    yes
                };
                (format!("{name} {has} {done} ({})", values(instr)), needed)
            }
            (FactKind::Written, Some(instr)) => {
                let through = self
                    .index(instr)
                    .map(|index| format!(" through index {index}"));
                let written = fact
                    .device
                    .map_or("it".to_owned(), |device| self.named(device));
                let now = format!(
                    "{}{} writes {written}, which cannot be followed",
                    self.at(instr),
                    through.unwrap_or_default()
                );
                let needed = format!("another result of {}", self.at(instr));
                (now, needed)
            }
            _ if on => (format!("{yes} is on"), no),
            _ => (format!("{yes} is off"), yes),
        };
        Link {
            device: about.map(|device| device.to_string()),
            comment: about.and_then(|device| self.comment(device)),
            now,
            needed,
            at: place,
            opaque: true,
        }
    }

    /// The index register of an instruction's operands, if it has one.
    pub(crate) fn index(&self, instr: usize) -> Option<String> {
        let operands = self.resolved.program.instrs[instr].operands.iter();
        let mut indexes = operands.filter_map(|operand| match operand.kind {
            OperandKind::Device(_, index)
            | OperandKind::WordBit(_, _, index)
            | OperandKind::Nibbles(_, _, index)
            | OperandKind::Decimal(_, index)
            | OperandKind::Hex(_, index)
            | OperandKind::Buffer { index, .. } => index,
            OperandKind::Float(_) | OperandKind::Text(_) | OperandKind::Unreadable(_) => None,
        });
        indexes.next().map(|index| index.to_string())
    }
}
