//! Conditions and their members in words.

use crate::answer::{Link, Place};
use crate::graph::{Fact, FactKind, Graph, Id, Node};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Basic, Lower};
use rungc_ladder::Ladder;
use rungc_syntax::{Device, OperandKind, Phrase, phrase};

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

/// State of a bit.
pub(crate) fn on_off(on: bool) -> Phrase {
    match on {
        true => phrase!("on"),
        false => phrase!("off"),
    }
}

/// State of a device as a sentence.
pub(crate) fn is(name: &str, state: Phrase) -> Phrase {
    phrase!("{name} is {state}", name, state)
}

/// Several in a sentence.
pub(crate) fn list(texts: &[Phrase]) -> Phrase {
    let [others @ .., last] = texts else {
        return Phrase::default();
    };
    let mut others = others.iter().cloned();
    let Some(first) = others.next() else {
        return last.clone();
    };
    let others = others.fold(first, |before, next| {
        phrase!("{before}, {next}", before, next)
    });
    phrase!("{others} and {last}", others, last)
}

fn opposite(condition: Phrase) -> Phrase {
    phrase!("not {condition}", condition)
}

fn with_opposite(condition: Phrase) -> [Phrase; 2] {
    [condition.clone(), opposite(condition)]
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
    pub(crate) fn at(&self, instr: usize) -> Phrase {
        let place = self.place(instr);
        phrase!(
            "{instruction} (step {step})",
            instruction = place.instruction,
            step = place.step
        )
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
    fn fact(&self, fact: &Fact) -> [Phrase; 2] {
        let source = || match fact.instr {
            Some(instr) => phrase!("the result of {instruction}", instruction = self.at(instr)),
            None => phrase!("the result of the PLC"),
        };
        let named = fact.device.map(|device| self.named(device));
        let operand = fact.instr.and_then(|instr| self.operand(instr, 0));
        let plain = || operand.map_or_else(source, |operand| operand.to_string().into());
        match (fact.kind, named) {
            // What is constant is the contact, not its relay: LDI M8000.
            (FactKind::Constant, _) if self.is_inverted(fact.instr) => {
                let [text, inverse] = with_opposite(plain());
                [inverse, text]
            }
            (FactKind::Constant | FactKind::WordBit | FactKind::Indexed, _) => {
                with_opposite(plain())
            }
            (FactKind::Comparison, _) => {
                let text = fact.instr.and_then(|instr| self.comparison(instr));
                with_opposite(text.map_or_else(source, Phrase::from))
            }
            (FactKind::Elapsed, Some(name)) => [
                phrase!("{name} having run its time", name),
                phrase!("{name} not having run its time", name),
            ],
            (FactKind::Counted, Some(name)) => [
                phrase!("{name} having counted to its preset", name),
                phrase!("{name} counting on", name),
            ],
            (FactKind::Elapsed | FactKind::Counted, None) => with_opposite(source()),
            (FactKind::Written | FactKind::Other, _) => {
                let other = phrase!("another result than {result}", result = source());
                [source(), other]
            }
            (FactKind::System, Some(name)) => with_opposite(name.into()),
            (FactKind::System, None) => with_opposite(plain()),
        }
    }

    /// A condition: `X000 "start" and not X001`.
    pub(crate) fn condition(&self, graph: &Graph, id: Id) -> Phrase {
        self.within(graph, id, Around::Nothing)
    }

    fn within(&self, graph: &Graph, id: Id, around: Around) -> Phrase {
        let group = |text: Phrase, own: Around| match around > own {
            true => phrase!("({condition})", condition = text),
            false => text,
        };
        match graph.node(id) {
            Node::Const(true) => phrase!("always"),
            Node::Const(false) => phrase!("never"),
            Node::Start(device) => self.named(*device).into(),
            Node::Memory(..) => phrase!("its state in the scan before"),
            Node::Contact { device, .. } => self.named(*device).into(),
            Node::Not(a) => match graph.node(*a) {
                Node::Fact(fact) => {
                    let [_, opposite] = self.fact(fact);
                    opposite
                }
                _ => opposite(self.within(graph, *a, Around::Not)),
            },
            Node::And(a, b) => match (graph.node(*a), graph.node(*b)) {
                (_, Node::Not(m)) if matches!(graph.node(*m), Node::Memory(..)) => {
                    let condition = self.within(graph, *a, Around::Not);
                    group(phrase!("{condition} coming on", condition), Around::And)
                }
                (Node::Not(a), Node::Memory(..)) => {
                    let condition = self.within(graph, *a, Around::Not);
                    group(phrase!("{condition} going off", condition), Around::And)
                }
                _ => {
                    let [a, b] = [a, b].map(|part| self.within(graph, *part, Around::And));
                    group(phrase!("{a} and {b}", a, b), Around::And)
                }
            },
            Node::Or(a, b) => {
                let [a, b] = [a, b].map(|part| self.within(graph, *part, Around::Or));
                group(phrase!("{a} or {b}", a, b), Around::Or)
            }
            Node::Fact(fact) => {
                let [text, _] = self.fact(fact);
                text
            }
        }
    }

    /// A member of a set: its state, and that which is needed. `values` gives the values of an instruction's operands.
    pub(crate) fn link(&self, graph: &Graph, id: Id, values: &dyn Fn(usize) -> Phrase) -> Link {
        let on = graph.value(id);
        let of_device = |device: Device, instr: Option<usize>| {
            let name = self.named(device);
            Link {
                device: Some(device.to_string()),
                comment: self.comment(device),
                now: is(&name, on_off(on)),
                needed: phrase!("{name} {state}", name, state = on_off(!on)),
                at: instr.map(|instr| self.place(instr)),
                opaque: false,
            }
        };
        match graph.node(id) {
            Node::Contact { instr, device, .. } => of_device(*device, *instr),
            Node::Start(device) => of_device(*device, None),
            Node::Memory(_, instr) => self.edge_link(*instr, on),
            Node::Fact(fact) => self.fact_link(fact, on, values),
            _ => Link {
                device: None,
                comment: None,
                now: self.condition(graph, id),
                needed: opposite(self.condition(graph, id)),
                at: None,
                opaque: true,
            },
        }
    }

    /// The memory of an edge.
    fn edge_link(&self, instr: Option<usize>, on: bool) -> Link {
        let edge = instr.map_or_else(|| phrase!("an edge"), |instr| self.at(instr));
        let (now, needed) = match on {
            true => (
                phrase!("the input of {edge} was on in the scan before", edge),
                phrase!("at {edge} a change: off, then on again", edge),
            ),
            false => (
                phrase!("the input of {edge} was off in the scan before", edge),
                phrase!("at {edge} a change: on, then off again", edge),
            ),
        };
        let about = instr.and_then(|instr| self.operand(instr, 0)?.device());
        Link {
            device: about.map(|device| device.to_string()),
            comment: about.and_then(|device| self.comment(device)),
            now,
            needed,
            at: instr.map(|instr| self.place(instr)),
            opaque: true,
        }
    }

    fn fact_link(&self, fact: &Fact, on: bool, values: &dyn Fn(usize) -> Phrase) -> Link {
        let about = fact.device.or_else(|| {
            let instr = fact.instr?;
            self.operand(instr, 0)?.device()
        });
        let (now, needed) = match fact.instr {
            Some(instr) => self.instruction_link(fact, instr, on, values),
            None => self.state_link(fact, on),
        };
        Link {
            device: about.map(|device| device.to_string()),
            comment: about.and_then(|device| self.comment(device)),
            now,
            needed,
            at: fact.instr.map(|instr| self.place(instr)),
            opaque: true,
        }
    }

    /// State of a bit, and what is needed instead.
    fn state_link(&self, fact: &Fact, on: bool) -> (Phrase, Phrase) {
        let [yes, no] = self.fact(fact);
        let now = phrase!("{name} is {state}", name = yes, state = on_off(on));
        (now, if on { no } else { yes })
    }

    /// State of a bit that an instruction decides, and what is needed instead.
    fn instruction_link(
        &self,
        fact: &Fact,
        instr: usize,
        on: bool,
        values: &dyn Fn(usize) -> Phrase,
    ) -> (Phrase, Phrase) {
        let [yes, no] = self.fact(fact);
        let of_coil = || match fact.device {
            Some(device) => self.named(device).into(),
            None => self.at(instr),
        };
        match (fact.kind, on) {
            (FactKind::Comparison, true) => {
                let now = phrase!(
                    "{comparison} holds ({values})",
                    comparison = yes,
                    values = values(instr)
                );
                (now, no)
            }
            (FactKind::Comparison, false) => {
                let now = phrase!(
                    "{comparison} does not hold ({values})",
                    comparison = yes,
                    values = values(instr)
                );
                (now, yes)
            }
            (FactKind::Elapsed, true) => {
                let now = phrase!(
                    "{timer} has run its time ({progress})",
                    timer = of_coil(),
                    progress = values(instr)
                );
                (now, yes)
            }
            (FactKind::Elapsed, false) => {
                let now = phrase!(
                    "{timer} has not run its time ({progress})",
                    timer = of_coil(),
                    progress = values(instr)
                );
                (now, yes)
            }
            (FactKind::Counted, true) => {
                let now = phrase!(
                    "{counter} has counted to its preset ({progress})",
                    counter = of_coil(),
                    progress = values(instr)
                );
                (now, no)
            }
            (FactKind::Counted, false) => {
                let now = phrase!(
                    "{counter} has not counted to its preset ({progress})",
                    counter = of_coil(),
                    progress = values(instr)
                );
                (now, yes)
            }
            (FactKind::Written, _) => self.unfollowed_link(fact, instr),
            _ => self.state_link(fact, on),
        }
    }

    /// A bit that an instruction writes in a way that is not followed.
    fn unfollowed_link(&self, fact: &Fact, instr: usize) -> (Phrase, Phrase) {
        let instruction = self.at(instr);
        let written = fact
            .device
            .map_or_else(|| phrase!("it"), |device| self.named(device).into());
        let now = match self.index(instr) {
            Some(index) => phrase!(
                "{instruction} through index {index} writes {written}, which cannot be followed",
                instruction,
                index,
                written
            ),
            None => phrase!(
                "{instruction} writes {written}, which cannot be followed",
                instruction,
                written
            ),
        };
        (now, phrase!("another result of {instruction}", instruction))
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
