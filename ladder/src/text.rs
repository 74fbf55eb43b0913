//! Drawing a ladder in characters.

use crate::layout::{Cell, Grid, Measure, Placed, lay_out};
use crate::network::{Contact, InstrIndex, Network, NetworkBody, Output, Shape};
use rungc_analysis::resolve::Resolved;
use rungc_syntax::{Device, OperandKind};
use std::fmt::Write as _;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// How a ladder is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Characters a line may have; more only where a network's branches need them.
    pub width: usize,
    /// Whether the comments of devices are drawn beneath them.
    pub comments: bool,
}

/// Draws networks, one after another, each with its number, counted from 1, its labels and its first step.
pub fn draw(resolved: &Resolved, networks: &[(usize, &Network)], style: Style) -> String {
    let page = Page {
        resolved,
        style,
        margin: Margin::of(resolved, networks),
        cell: cell_width(resolved, networks, style),
    };
    let mut out = String::new();
    for (number, network) in networks {
        page.network(*number, network, &mut out);
    }
    out
}

/// What lies to the left of the rail: the widths of the columns of numbers, and of labels and steps.
#[derive(Clone, Copy)]
struct Margin {
    numbers: usize,
    steps: usize,
}

impl Margin {
    fn of(resolved: &Resolved, networks: &[(usize, &Network)]) -> Self {
        let last = networks.last().map_or(1, |(number, _)| *number);
        let mut steps = 1;
        for (_, network) in networks {
            let step = resolved.instrs[network.instrs.start..].first();
            steps = steps.max(step.map_or(1, |of| of.step.to_string().len()));
            for label in labels(network) {
                steps = steps.max(resolved.program.instrs[label].mnemonic.len());
            }
        }
        Margin {
            numbers: last.to_string().len(),
            steps,
        }
    }

    fn width(self) -> usize {
        self.numbers + 1 + self.steps + 1
    }
}

fn labels(network: &Network) -> std::ops::Range<InstrIndex> {
    network.instrs.start..network.instrs.start + network.labels
}

/// The narrowest column; a comment beneath a contact has this room less 2.
const NARROW: usize = 9;
const WITH_COMMENTS: usize = 13;
const WIDEST: usize = 24;

/// Characters of a column, with the boundary to its left.
fn cell_width(resolved: &Resolved, networks: &[(usize, &Network)], style: Style) -> usize {
    let program = resolved.program;
    let instrs = networks
        .iter()
        .flat_map(|(_, network)| network.instrs.clone());
    let names = instrs.filter_map(|instr| program.instrs[instr].operands.first());
    let widest = names.map(|operand| operand.kind.to_string().width()).max();
    let least = match style.comments && !program.comments.is_empty() {
        true => WITH_COMMENTS,
        false => NARROW,
    };
    (widest.unwrap_or(0) + 3).clamp(least, WIDEST)
}

/// What all networks have in common.
#[derive(Clone, Copy)]
struct Page<'a> {
    resolved: &'a Resolved<'a>,
    style: Style,
    margin: Margin,
    cell: usize,
}

impl Measure for Page<'_> {
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

impl Page<'_> {
    /// How many columns a text takes, with some wire on both sides.
    fn columns(&self, text: &str) -> usize {
        (text.width() + 3).div_ceil(self.cell)
    }

    /// A comparison without the LD, AND or OR that the wires show: `[>= D0 K5]`.
    fn boxed(&self, instr: InstrIndex) -> String {
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

    fn output_text(&self, output: Output) -> String {
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

    /// What stands above a cell.
    fn name(&self, cell: Cell) -> String {
        match cell {
            Cell::Contact(Contact {
                shape: Shape::Compare,
                ..
            }) => String::new(),
            Cell::Contact(contact) => {
                let operand = self.resolved.program.instrs[contact.instr].operands.first();
                operand.map_or(String::new(), |operand| operand.kind.to_string())
            }
            Cell::Result(_) | Cell::Output(_) | Cell::FoldOut(_) | Cell::FoldIn(_) => String::new(),
        }
    }

    /// What lies in a cell.
    fn symbol(&self, cell: Cell) -> String {
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

    /// The comment of the device of a cell, folded to lines.
    fn comment(&self, placed: Placed) -> Vec<String> {
        let instr = match placed.cell {
            Cell::Contact(contact) => contact.instr,
            Cell::Output(output) => output.instr,
            Cell::Result(_) | Cell::FoldOut(_) | Cell::FoldIn(_) => return Vec::new(),
        };
        if !self.style.comments {
            return Vec::new();
        }
        let device = self.resolved.program.instrs[instr].operands.first();
        let comment = device
            .and_then(|operand| device_of(&operand.kind))
            .and_then(|device| self.resolved.program.comments.get(&device));
        comment.map_or_else(Vec::new, |comment| {
            fold(comment, placed.span * self.cell - 2, 2)
        })
    }

    fn network(&self, number: usize, network: &Network, out: &mut String) {
        let instrs = &self.resolved.program.instrs[network.instrs.clone()];
        for statement in instrs.iter().filter_map(|instr| instr.statement()) {
            for line in statement.lines() {
                let _ = writeln!(out, "{:width$}; {line}", "", width = self.margin.width());
            }
        }
        match &network.body {
            NetworkBody::Rung(node) => {
                let room = self.style.width.saturating_sub(self.margin.width() + 1);
                let grid = lay_out(node, self, (room / self.cell).max(2));
                self.grid(number, network, &grid, out);
            }
            NetworkBody::List { why } => self.list(number, network, why, out),
        }
    }

    fn list(&self, number: usize, network: &Network, why: &str, out: &mut String) {
        let step = self.resolved.instrs[network.instrs.start].step;
        let lead = self.lead(number, "");
        let _ = writeln!(out, "{lead}│ cannot be drawn: {why}");
        let mut step = step.to_string();
        for instr in &self.resolved.program.instrs[network.instrs.clone()] {
            let lead = self.lead("", &std::mem::take(&mut step));
            let _ = writeln!(out, "{lead}│   {instr}");
        }
    }

    /// What lies to the left of the rail on a line.
    fn lead(&self, number: impl std::fmt::Display, step: &str) -> String {
        let Margin { numbers, steps } = self.margin;
        format!("{number:>numbers$} {step:>steps$} ")
    }

    fn grid(&self, number: usize, network: &Network, grid: &Grid, out: &mut String) {
        let mut labels: Vec<&str> = labels(network)
            .map(|label| &*self.resolved.program.instrs[label].mnemonic)
            .collect();
        labels.reverse();
        let first = network.instrs.start + network.labels;
        let step = self
            .resolved
            .instrs
            .get(first)
            .map(|of| of.step.to_string());
        let mut step = step.unwrap_or_default();
        for row in 0..grid.rows {
            let placed: Vec<Placed> = grid
                .placed
                .iter()
                .copied()
                .filter(|placed| placed.row == row)
                .collect();
            let mut names = self.blank(grid, |boundary| row > 0 && grid.down(row - 1, boundary));
            for placed in &placed {
                let name = self.name(placed.cell);
                names.center(
                    self.column(placed.column) + 1,
                    self.cell * placed.span - 1,
                    &name,
                );
            }
            let label = labels.pop().unwrap_or("");
            let named = placed
                .iter()
                .any(|placed| !self.name(placed.cell).is_empty());
            // A row of boxes needs no line for names; the first row has one, which parts it from the network above.
            if named || row == 0 || !label.is_empty() {
                let number = if row == 0 {
                    number.to_string()
                } else {
                    String::new()
                };
                let _ = writeln!(out, "{}{}", self.lead(number, label), names.text());
            }
            let lead = self.lead("", &std::mem::take(&mut step));
            let _ = writeln!(out, "{lead}{}", self.wires(grid, row, &placed).text());
            let comments: Vec<Vec<String>> =
                placed.iter().map(|placed| self.comment(*placed)).collect();
            for line in 0..comments.iter().map(Vec::len).max().unwrap_or(0) {
                let mut text = self.blank(grid, |boundary| {
                    row + 1 < grid.rows && grid.down(row, boundary)
                });
                for (placed, comment) in placed.iter().zip(&comments) {
                    if let Some(comment) = comment.get(line) {
                        text.center(
                            self.column(placed.column) + 1,
                            self.cell * placed.span - 1,
                            comment,
                        );
                    }
                }
                let _ = writeln!(out, "{}{}", self.lead("", ""), text.text());
            }
        }
    }

    fn column(&self, column: usize) -> usize {
        column * self.cell
    }

    /// A line with the rails and the wires that cross it.
    fn blank(&self, grid: &Grid, crosses: impl Fn(usize) -> bool) -> Line {
        let mut line = Line::new(grid.columns * self.cell + 1);
        for boundary in 0..=grid.columns {
            if boundary == 0 || boundary == grid.columns || crosses(boundary) {
                line.put(self.column(boundary), "│");
            }
        }
        line
    }

    /// The line of a row that holds its wires.
    fn wires(&self, grid: &Grid, row: usize, placed: &[Placed]) -> Line {
        let mut line = Line::new(grid.columns * self.cell + 1);
        let mut full: Vec<bool> = (0..grid.columns)
            .map(|column| grid.wire(row, column))
            .collect();
        for placed in placed {
            full[placed.column..placed.column + placed.span].fill(true);
        }
        for (column, _) in full.iter().enumerate().filter(|(_, full)| **full) {
            let wire = "─".repeat(self.cell - 1);
            line.put(self.column(column) + 1, &wire);
        }
        for boundary in 0..=grid.columns {
            let rail = boundary == 0 || boundary == grid.columns;
            let within = placed
                .iter()
                .any(|placed| placed.column < boundary && boundary < placed.column + placed.span);
            let arms = Arms {
                left: boundary > 0 && full[boundary - 1],
                right: boundary < grid.columns && full[boundary],
                up: rail || row > 0 && grid.down(row - 1, boundary),
                down: rail || row + 1 < grid.rows && grid.down(row, boundary),
            };
            line.put(
                self.column(boundary),
                if within { "─" } else { arms.symbol() },
            );
        }
        for placed in placed {
            let symbol = self.symbol(placed.cell);
            let start = self.column(placed.column) + 1;
            let room = self.cell * placed.span - 1;
            match placed.cell {
                Cell::Output(_) | Cell::FoldOut(_) => {
                    line.put(start + room - symbol.width().min(room), &symbol)
                }
                Cell::FoldIn(_) => line.put(start, &symbol),
                Cell::Contact(_) | Cell::Result(_) => line.center(start, room, &symbol),
            }
        }
        line
    }
}

/// The device whose comment describes an operand.
fn device_of(kind: &OperandKind) -> Option<Device> {
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

/// Wires that meet at a boundary.
#[derive(Clone, Copy)]
struct Arms {
    left: bool,
    right: bool,
    up: bool,
    down: bool,
}

impl Arms {
    fn symbol(self) -> &'static str {
        let Arms {
            left,
            right,
            up,
            down,
        } = self;
        match (left, right, up, down) {
            (false, false, false, false) => " ",
            (_, _, false, false) => "─",
            (false, false, _, _) => "│",
            (true, false, true, true) => "┤",
            (true, false, false, true) => "┐",
            (true, false, true, false) => "┘",
            (false, true, true, true) => "├",
            (false, true, false, true) => "┌",
            (false, true, true, false) => "└",
            (true, true, false, true) => "┬",
            (true, true, true, false) => "┴",
            (true, true, true, true) => "┼",
        }
    }
}

/// A line of text by columns of a terminal, in which a wide character takes two.
struct Line(Vec<Option<char>>);

impl Line {
    fn new(width: usize) -> Self {
        Line(vec![Some(' '); width])
    }

    fn put(&mut self, mut at: usize, text: &str) {
        for character in text.chars() {
            let width = character.width().unwrap_or(0);
            if width == 0 || at + width > self.0.len() {
                continue;
            }
            self.0[at] = Some(character);
            self.0[at + 1..at + width].fill(None);
            at += width;
        }
    }

    fn center(&mut self, at: usize, room: usize, text: &str) {
        let width = text.width().min(room);
        self.put(at + (room - width) / 2, text);
    }

    fn text(&self) -> String {
        let text: String = self.0.iter().flatten().collect();
        text.trim_end().to_string()
    }
}

/// A text as at most `lines` lines of `width`; the last ends in `…` if there is more.
fn fold(text: &str, width: usize, lines: usize) -> Vec<String> {
    let mut folded: Vec<String> = vec![String::new()];
    for word in text.split_whitespace() {
        for (i, character) in word
            .chars()
            .filter(|character| !character.is_control())
            .enumerate()
        {
            let line = folded.last_mut().expect("there is a line");
            let rest = UnicodeWidthStr::width(word);
            let space = usize::from(i == 0 && !line.is_empty());
            let fits = line.width()
                + space
                + if i == 0 {
                    rest.min(width)
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
