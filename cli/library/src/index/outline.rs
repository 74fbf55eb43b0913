//! The parts of a program: routines, states of step ladders, networks.

use super::Index;
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Span};
use std::ops::Range;

/// A part of a program, which holds others.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Outline {
    /// Its kind.
    pub kind: OutlineKind,
    /// Its name: the label, the state, the number of the network.
    pub name: String,
    /// The comment of the device, or the statement of the network; empty if there is none.
    pub detail: String,
    /// All of it.
    pub span: Span,
    /// The instruction that begins it.
    pub head: Span,
    /// The parts in it.
    pub parts: Vec<Outline>,
}

/// Kinds of parts.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum OutlineKind {
    /// What a label begins: a subroutine, an interrupt routine, the target of a jump.
    Label,
    /// A state of a step ladder.
    State,
    /// A network.
    Network,
}

impl Index {
    /// The parts of the program.
    pub fn outline(&self) -> Vec<Outline> {
        let mut open: Vec<Outline> = Vec::new();
        let mut closed = Vec::new();
        for (number, network) in (1..).zip(&self.networks) {
            let Some(part) = self.network(number, network.clone()) else {
                continue;
            };
            let heads = [self.label(network.clone()), self.state(network.clone())];
            for head in heads.into_iter().flatten() {
                close(&mut open, &mut closed, head.kind);
                open.push(head);
            }
            for one in &mut open {
                one.span = one.span.to(part.span);
            }
            match open.last_mut() {
                Some(last) => last.parts.push(part),
                None => closed.push(part),
            }
            if self.basic_in(network.clone(), Basic::Ret).is_some() {
                close(&mut open, &mut closed, OutlineKind::State);
            }
        }
        close(&mut open, &mut closed, OutlineKind::Label);
        closed
    }

    /// Places of the networks, as far as the text holds them.
    pub fn network_spans(&self) -> impl Iterator<Item = Span> {
        self.networks
            .iter()
            .filter_map(|network| self.span(network.clone()))
    }

    fn span(&self, network: Range<usize>) -> Option<Span> {
        let instrs = self.program().instrs.get(network)?;
        let spans = instrs.iter().map(|instr| instr.span);
        spans
            .filter(|span| !span.range().is_empty())
            .reduce(Span::to)
    }

    fn basic_in(&self, network: Range<usize>, basic: Basic) -> Option<usize> {
        let mut network = network;
        network.find(|i| self.resolutions[*i].basic() == Some(basic))
    }

    fn network(&self, number: usize, network: Range<usize>) -> Option<Outline> {
        let span = self.span(network.clone())?;
        let instrs = self.program().instrs.get(network)?;
        let statement = instrs.iter().find_map(|instr| instr.statement());
        let last = instrs
            .iter()
            .rev()
            .find(|instr| !instr.span.range().is_empty())?;
        let comment = last
            .operands
            .first()
            .and_then(|operand| super::named(&operand.kind));
        let comment = comment.and_then(|device| self.comment(device));
        let statement = statement
            .and_then(|text| text.lines().next())
            .map(str::to_owned);
        Some(Outline {
            kind: OutlineKind::Network,
            name: format!("{number}: {last}"),
            detail: statement.or(comment).unwrap_or_default(),
            span,
            head: span,
            parts: Vec::new(),
        })
    }

    /// The part that the last label of a network begins.
    fn label(&self, network: Range<usize>) -> Option<Outline> {
        let labels = network.map_while(|i| Some((i, self.resolutions.get(i)?.label?)));
        let (i, device) = labels.last()?;
        Some(self.head(OutlineKind::Label, i, device))
    }

    /// The part that STL begins in a network.
    fn state(&self, network: Range<usize>) -> Option<Outline> {
        let i = self.basic_in(network, Basic::Stl)?;
        let operand = self.program().instrs[i].operands.first()?;
        let device = super::named(&operand.kind)?;
        (device.class == DeviceClass::S).then(|| self.head(OutlineKind::State, i, device))
    }

    fn head(&self, kind: OutlineKind, i: usize, device: Device) -> Outline {
        let span = self.program().instrs[i].span;
        Outline {
            kind,
            name: device.to_string(),
            detail: self.comment(device).unwrap_or_default(),
            span,
            head: span,
            parts: Vec::new(),
        }
    }
}

/// Closes the open parts of a kind, and those in them.
fn close(open: &mut Vec<Outline>, closed: &mut Vec<Outline>, kind: OutlineKind) {
    while open.last().is_some_and(|last| last.kind >= kind) {
        let Some(part) = open.pop() else { return };
        match open.last_mut() {
            Some(around) => around.parts.push(part),
            None => closed.push(part),
        }
    }
}
