//! Drawing a ladder in characters.

use crate::face::{Face, masters, operand_text};
use crate::layout::{Cell, Grid, Placed, lay_out};
use crate::network::{InstrIndex, Network, NetworkBody};
use rungc_analysis::resolve::Resolved;
use std::convert::Infallible;
use std::fmt::Write as _;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Style of a drawn ladder.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Characters a line may have; more only where a network's branches need them.
    pub width: usize,
    /// True if the comments of devices are drawn beneath them.
    pub comments: bool,
}

/// Draws networks, one after another, each with its number, counted from 1, its labels and its first step.
pub fn draw(resolved: &Resolved, networks: &[(usize, &Network)], style: Style) -> String {
    let mut all = String::new();
    let drawn: Result<(), Infallible> = draw_parts(resolved, networks, style, |part| {
        all.push_str(part);
        Ok(())
    });
    match drawn {
        Ok(()) => all,
    }
}

/// Size of the parts of a long drawing in bytes, about.
const PART: usize = 1 << 16;

/// As [`draw`], in parts of bounded size: the drawing takes many times the memory of its program.
///
/// # Errors
/// The first error of `take`, after which nothing is drawn.
pub fn draw_parts<E>(
    resolved: &Resolved,
    networks: &[(usize, &Network)],
    style: Style,
    mut take: impl FnMut(&str) -> Result<(), E>,
) -> Result<(), E> {
    let page = Page {
        face: Face::of(resolved, networks, style.comments),
        width: style.width,
        margin: Margin::of(resolved, networks),
        counted: true,
        marked: None,
    };
    let mut out = String::new();
    for (number, network) in networks {
        page.network(*number, network, &mut out);
        if out.len() >= PART {
            take(&out)?;
            out.clear();
        }
    }
    match out.is_empty() {
        true => Ok(()),
        false => take(&out),
    }
}

/// Draws a network, with `^` beneath the symbol of an instruction.
pub fn draw_marked(
    resolved: &Resolved,
    (number, network): (usize, &Network),
    style: Style,
    marked: InstrIndex,
) -> String {
    let networks = [(number, network)];
    let page = Page {
        face: Face::of(resolved, &networks, style.comments),
        width: style.width,
        margin: Margin::of(resolved, &networks),
        counted: true,
        marked: Some(marked),
    };
    let mut out = String::new();
    page.network(number, network, &mut out);
    out
}

/// Draws networks of different programs so that they can be compared line by line: without numbers and steps, in
/// columns of one width.
pub fn draw_alike(networks: &[(&Resolved, &Network)], style: Style) -> Vec<String> {
    let networks: Vec<_> = networks
        .iter()
        .map(|&(resolved, network)| (resolved, [(1, network)]))
        .collect();
    let faces = networks.iter();
    let faces = faces.map(|(resolved, network)| Face::of(resolved, network, style.comments));
    let cell = faces.clone().map(|face| face.cell).max().unwrap_or(1);
    let labels = networks.iter();
    let labels = labels.map(|(resolved, network)| widest_label(resolved, network[0].1));
    let margin = Margin {
        numbers: 0,
        steps: labels.max().unwrap_or(0),
    };
    let drawn = networks.iter().zip(faces).map(|((_, network), face)| {
        let page = Page {
            face: Face { cell, ..face },
            width: style.width,
            margin,
            counted: false,
            marked: None,
        };
        let mut out = String::new();
        page.network(1, network[0].1, &mut out);
        out
    });
    drawn.collect()
}

/// Space to the left of the rail: the widths of the columns of numbers, and of labels and steps.
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
            steps = steps.max(widest_label(resolved, network));
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

fn widest_label(resolved: &Resolved, network: &Network) -> usize {
    let names = labels(network).map(|label| resolved.program.instrs[label].mnemonic.len());
    let nesting = masters(resolved, network)
        .into_iter()
        .map(|master| operand_text(resolved, master, 0).len());
    names.chain(nesting).max().unwrap_or(0)
}

fn labels(network: &Network) -> std::ops::Range<InstrIndex> {
    network.instrs.start..network.instrs.start + network.labels
}

/// Common properties of all networks.
#[derive(Clone, Copy)]
struct Page<'a> {
    face: Face<'a>,
    width: usize,
    margin: Margin,
    /// True if numbers and steps are shown.
    counted: bool,
    /// The instruction whose symbol is marked.
    marked: Option<InstrIndex>,
}

impl Page<'_> {
    fn network(&self, number: usize, network: &Network, out: &mut String) {
        let instrs = &self.face.resolved.program.instrs[network.instrs.clone()];
        for statement in instrs.iter().filter_map(|instr| instr.statement()) {
            for line in statement.lines() {
                let _ = writeln!(out, "{:width$}; {line}", "", width = self.margin.width());
            }
        }
        match &network.body {
            NetworkBody::Rung(node) => {
                let room = self.width.saturating_sub(self.margin.width() + 1);
                let grid = lay_out(node, &self.face, (room / self.face.cell).max(2));
                self.grid(number, network, &grid, out);
            }
            NetworkBody::List { why } => self.list(number, network, why, out),
        }
    }

    fn list(&self, number: usize, network: &Network, why: &str, out: &mut String) {
        let step = self.face.resolved.instrs[network.instrs.start].step;
        let lead = self.lead(number, "");
        let _ = writeln!(out, "{lead}│ cannot be drawn: {why}");
        let mut step = step.to_string();
        for instr in &self.face.resolved.program.instrs[network.instrs.clone()] {
            let lead = self.lead("", &std::mem::take(&mut step));
            let _ = writeln!(out, "{lead}│   {instr}");
        }
    }

    /// Text to the left of the rail on a line.
    fn lead(&self, number: impl std::fmt::Display, step: &str) -> String {
        let Margin { numbers, steps } = self.margin;
        if !self.counted {
            let label = Some(step).filter(|text| text.starts_with(char::is_alphabetic));
            return format!("{:>steps$} ", label.unwrap_or(""));
        }
        format!("{number:>numbers$} {step:>steps$} ")
    }

    fn grid(&self, number: usize, network: &Network, grid: &Grid, out: &mut String) {
        let mut labels: Vec<&str> = labels(network)
            .map(|label| &*self.face.resolved.program.instrs[label].mnemonic)
            .collect();
        labels.reverse();
        let mut number = number.to_string();
        // Each label but the last has a line for itself.
        while labels.len() > 1 {
            let label = labels.pop().unwrap_or("");
            let rails = self.blank(grid, |_| false);
            let number = std::mem::take(&mut number);
            let _ = writeln!(out, "{}{}", self.lead(number, label), rails.text());
        }
        let first = network.instrs.start + network.labels;
        let step = self
            .face
            .resolved
            .instrs
            .get(first)
            .map(|of| of.step.to_string());
        let mut step = step.unwrap_or_default();
        for row in 0..grid.rows {
            let placed = grid.row(row);
            let mut names = self.blank(grid, |boundary| row > 0 && grid.down(row - 1, boundary));
            for placed in placed {
                let name = self.face.name(placed.cell);
                names.center(
                    self.column(placed.column) + 1,
                    self.face.cell * placed.span - 1,
                    &name,
                );
            }
            let label = labels.pop().unwrap_or("");
            let named = placed
                .iter()
                .any(|placed| !self.face.name(placed.cell).is_empty());
            // A row of boxes needs no line for names; the first row has one, which parts it from the network above.
            if named || row == 0 || !label.is_empty() {
                let number = std::mem::take(&mut number);
                let _ = writeln!(out, "{}{}", self.lead(number, label), names.text());
            }
            let lead = self.lead("", &std::mem::take(&mut step));
            let wires = self.wires(grid, row, placed).text();
            let _ = writeln!(out, "{lead}{wires}{}", self.note(placed));
            if let Some(marks) = self.marks(grid, row, placed) {
                let _ = writeln!(out, "{}{}", self.lead("", ""), marks.text());
            }
            let comments: Vec<Vec<String>> = placed
                .iter()
                .map(|placed| self.face.comment(*placed))
                .collect();
            for line in 0..comments.iter().map(Vec::len).max().unwrap_or(0) {
                let mut text = self.blank(grid, |boundary| {
                    row + 1 < grid.rows && grid.down(row, boundary)
                });
                for (placed, comment) in placed.iter().zip(&comments) {
                    if let Some(comment) = comment.get(line) {
                        text.center(
                            self.column(placed.column) + 1,
                            self.face.cell * placed.span - 1,
                            comment,
                        );
                    }
                }
                let _ = writeln!(out, "{}{}", self.lead("", ""), text.text());
            }
        }
        for master in masters(self.face.resolved, network) {
            self.master(master, grid, out);
        }
    }

    /// The contact of a master control in the left rail, which feeds what lies below.
    fn master(&self, master: InstrIndex, grid: &Grid, out: &mut String) {
        let [nesting, device] = [0, 1].map(|at| operand_text(self.face.resolved, master, at));
        let mut lead = self.lead("", &nesting);
        lead.pop();
        let mut rails = self.blank(grid, |_| false);
        rails.put(0, "╪═");
        rails.put(3, &device);
        let _ = writeln!(out, "{lead}═{}", rails.text());
    }

    /// The line beneath a row that marks a symbol in it.
    fn marks(&self, grid: &Grid, row: usize, placed: &[Placed]) -> Option<Line> {
        let marked = placed.iter().find(|placed| match placed.cell {
            Cell::Contact(contact) => Some(contact.instr) == self.marked,
            Cell::Result(instr) => Some(instr) == self.marked,
            Cell::Output(output) => Some(output.instr) == self.marked,
            Cell::FoldOut(_) | Cell::FoldIn(_) => false,
        })?;
        let mut line = self.blank(grid, |boundary| {
            row + 1 < grid.rows && grid.down(row, boundary)
        });
        let start = self.column(marked.column) + 1;
        let room = self.face.cell * marked.span - 1;
        let sign = "^".repeat(self.face.symbol(marked.cell).width().min(room));
        match marked.cell {
            Cell::Output(_) => line.put(start + room - sign.len(), &sign),
            _ => line.center(start, room, &sign),
        }
        Some(line)
    }

    /// The note of the output on a row, after the right rail, where numbers and steps are left out.
    fn note(&self, placed: &[Placed]) -> String {
        let notes = placed.iter().filter_map(|placed| match placed.cell {
            Cell::Output(output) if !self.counted => {
                self.face.resolved.program.instrs[output.instr].note()
            }
            _ => None,
        });
        notes.map(|note| format!("  ; {note}")).collect()
    }

    fn column(&self, column: usize) -> usize {
        column * self.face.cell
    }

    /// A line with the rails and the wires that cross it.
    fn blank(&self, grid: &Grid, crosses: impl Fn(usize) -> bool) -> Line {
        let mut line = Line::new(grid.columns * self.face.cell + 1);
        for boundary in 0..=grid.columns {
            if boundary == 0 || boundary == grid.columns || crosses(boundary) {
                line.put(self.column(boundary), "│");
            }
        }
        line
    }

    /// The line of a row that holds its wires.
    fn wires(&self, grid: &Grid, row: usize, placed: &[Placed]) -> Line {
        let mut line = Line::new(grid.columns * self.face.cell + 1);
        let mut full: Vec<bool> = (0..grid.columns)
            .map(|column| grid.wire(row, column))
            .collect();
        for placed in placed {
            full[placed.column..placed.column + placed.span].fill(true);
        }
        for (column, _) in full.iter().enumerate().filter(|(_, full)| **full) {
            let wire = "─".repeat(self.face.cell - 1);
            line.put(self.column(column) + 1, &wire);
        }
        for boundary in 0..=grid.columns {
            let rail = boundary == 0 || boundary == grid.columns;
            let within = placed
                .iter()
                .any(|placed| placed.column < boundary && boundary < placed.column + placed.span);
            // A row that continues below ends at its mark, and begins at the other one: neither is at a rail.
            let ends = placed.iter().any(|placed| match placed.cell {
                Cell::FoldOut(_) => placed.column + placed.span == boundary,
                _ => false,
            });
            let begins = placed.iter().any(|placed| match placed.cell {
                Cell::FoldIn(_) => placed.column == boundary,
                _ => false,
            });
            let arms = Arms {
                left: boundary > 0 && full[boundary - 1] && !ends,
                right: boundary < grid.columns && full[boundary] && !begins,
                up: rail || row > 0 && grid.down(row - 1, boundary),
                down: rail || row + 1 < grid.rows && grid.down(row, boundary),
            };
            line.put(
                self.column(boundary),
                if within { "─" } else { arms.symbol() },
            );
        }
        for placed in placed {
            let symbol = self.face.symbol(placed.cell);
            let start = self.column(placed.column) + 1;
            let room = self.face.cell * placed.span - 1;
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
