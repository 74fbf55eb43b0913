//! Texts in, above and beneath the cells of a ladder.

use crate::layout::{Cell, Measure, Placed};
use crate::network::{Contact, InstrIndex, Network, Output, Shape};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Basic, Lower};
use rungc_syntax::{Device, OperandKind};
use std::fmt::Write as _;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// The narrowest column; a comment beneath a contact has this room less 2.
const NARROW: usize = 9;
const WITH_COMMENTS: usize = 13;
const WIDEST: usize = 24;

/// Characters of a column, with the boundary to its left.
fn cell_width(resolved: &Resolved, networks: &[(usize, &Network)], comments: bool) -> usize {
    let program = resolved.program;
    let instrs = networks
        .iter()
        .flat_map(|(_, network)| network.instrs.clone());
    let names = instrs.filter_map(|instr| program.instrs[instr].operands.first());
    let widest = names.map(|operand| operand.kind.to_string().width()).max();
    let least = match comments && !program.comments.is_empty() {
        true => WITH_COMMENTS,
        false => NARROW,
    };
    (widest.unwrap_or(0) + 3).clamp(least, WIDEST)
}

/// The texts of a program's ladder, and how much room they have.
#[derive(Clone, Copy)]
pub(crate) struct Face<'a> {
    pub(crate) resolved: &'a Resolved<'a>,
    /// True if comments are drawn.
    pub(crate) comments: bool,
    /// Characters of a column, with the boundary to its left.
    pub(crate) cell: usize,
}

impl Measure for Face<'_> {
    fn contact(&self, contact: Contact) -> usize {
        match contact.shape {
            Shape::Compare => self.columns(&self.boxed(contact.instr)),
            Shape::Open | Shape::Closed | Shape::Rising | Shape::Falling => 1,
        }
    }

    fn output(&self, output: Output) -> usize {
        self.columns(&self.output_text(output))
    }
}

impl<'a> Face<'a> {
    /// For these networks of a program.
    pub(crate) fn of(
        resolved: &'a Resolved<'a>,
        networks: &[(usize, &Network)],
        comments: bool,
    ) -> Self {
        Face {
            resolved,
            comments,
            cell: cell_width(resolved, networks, comments),
        }
    }

    /// Number of columns of a text, with some wire on both sides.
    pub(crate) fn columns(&self, text: &str) -> usize {
        (text.width() + 3).div_ceil(self.cell)
    }

    /// A comparison without the LD, AND or OR that the wires show: `[>= D0 K5]`.
    pub(crate) fn boxed(&self, instr: InstrIndex) -> String {
        let written = &self.resolved.program.instrs[instr];
        let resolution = &self.resolved.instrs[instr];
        let operator = resolution.inst.map_or("", |inst| inst.name);
        let operator =
            operator.trim_start_matches(|character: char| character.is_ascii_alphabetic());
        let wide = if resolution.form.wide { "D" } else { "" };
        let mut text = format!("[{wide}{operator}");
        for operand in &written.operands {
            let _ = write!(text, " {}", operand.kind);
        }
        text.push(']');
        text
    }

    pub(crate) fn output_text(&self, output: Output) -> String {
        if !output.coil {
            let instr = &self.resolved.program.instrs[output.instr];
            return format!("[{instr}]");
        }
        let operands = &self.resolved.program.instrs[output.instr].operands;
        let operands: Vec<_> = operands
            .iter()
            .map(|operand| operand.kind.to_string())
            .collect();
        format!("({})", operands.join(" "))
    }

    /// Text above a cell.
    pub(crate) fn name(&self, cell: Cell) -> String {
        match cell {
            Cell::Contact(Contact {
                shape: Shape::Compare,
                ..
            }) => String::new(),
            Cell::Contact(contact) => operand_text(self.resolved, contact.instr, 0),
            Cell::Result(_) | Cell::Output(_) | Cell::FoldOut(_) | Cell::FoldIn(_) => String::new(),
        }
    }

    /// Symbol in a cell.
    pub(crate) fn symbol(&self, cell: Cell) -> String {
        match cell {
            Cell::Contact(contact) => match contact.shape {
                Shape::Open => "┤ ├".into(),
                Shape::Closed => "┤/├".into(),
                Shape::Rising => "┤↑├".into(),
                Shape::Falling => "┤↓├".into(),
                Shape::Compare => self.boxed(contact.instr),
            },
            Cell::Result(instr) => match &*self.resolved.program.instrs[instr].mnemonic {
                "INV" => "/".into(),
                "MEP" => "↑".into(),
                "MEF" => "↓".into(),
                other => other.into(),
            },
            Cell::Output(output) => self.output_text(output),
            Cell::FoldOut(number) => format!("→{number}"),
            Cell::FoldIn(number) => format!("{number}→"),
        }
    }

    /// The device that a cell is about: its first operand.
    pub(crate) fn device(&self, cell: Cell) -> Option<Device> {
        let instr = match cell {
            Cell::Contact(contact) => contact.instr,
            Cell::Output(output) => output.instr,
            Cell::Result(_) | Cell::FoldOut(_) | Cell::FoldIn(_) => return None,
        };
        let operand = self.resolved.program.instrs[instr].operands.first()?;
        device_of(&operand.kind)
    }

    /// The comment of the device of a cell, folded to lines.
    pub(crate) fn comment(&self, placed: Placed) -> Vec<String> {
        let device = self.device(placed.cell).filter(|_| self.comments);
        let comment = device.and_then(|device| self.resolved.program.comments.get(&device));
        comment.map_or_else(Vec::new, |comment| {
            fold(comment, placed.span * self.cell - 2, 2)
        })
    }
}

/// The instructions of a network that switch the rail below it: MC.
pub(crate) fn masters(resolved: &Resolved, network: &Network) -> Vec<InstrIndex> {
    let is_master = |instr: &InstrIndex| {
        let lower = resolved.instrs[*instr].lower;
        matches!(lower, Some(Lower::Basic(Basic::Mc)))
    };
    network.instrs.clone().filter(is_master).collect()
}

/// An operand as it is written; nothing if it is missing.
pub(crate) fn operand_text(resolved: &Resolved, instr: InstrIndex, at: usize) -> String {
    let operand = resolved.program.instrs[instr].operands.get(at);
    operand.map_or_else(String::new, |operand| operand.kind.to_string())
}

/// The device whose comment describes an operand.
pub(crate) fn device_of(kind: &OperandKind) -> Option<Device> {
    match kind {
        OperandKind::Device(device, _)
        | OperandKind::WordBit(device, ..)
        | OperandKind::Nibbles(_, device, _) => Some(*device),
        OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => None,
    }
}

/// A text as at most `lines` lines of `width`; the last ends in `…` if there is more.
pub(crate) fn fold(text: &str, width: usize, lines: usize) -> Vec<String> {
    let mut folded: Vec<String> = vec![String::new()];
    'words: for word in text.split_whitespace() {
        let rest = UnicodeWidthStr::width(word).min(width);
        for (i, character) in word
            .chars()
            .filter(|character| !character.is_control())
            .enumerate()
        {
            if folded.len() > lines {
                break 'words;
            }
            let line = folded.last_mut().expect("there is a line");
            let space = usize::from(i == 0 && !line.is_empty());
            let fits = line.width()
                + space
                + if i == 0 {
                    rest
                } else {
                    character.width().unwrap_or(0)
                }
                <= width;
            if !fits {
                folded.push(String::new());
            } else if space == 1 {
                line.push(' ');
            }
            folded.last_mut().expect("there is a line").push(character);
        }
    }
    if folded.len() > lines {
        folded.truncate(lines);
        let last = folded.last_mut().expect("lines is at least 1");
        while last.width() + 1 > width {
            last.pop();
        }
        last.push('…');
    }
    folded.retain(|line| !line.is_empty());
    folded
}
