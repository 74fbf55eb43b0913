//! Networks as marks on paper: lines, frames and texts with their places. `svg` and `pdf` write them.

use crate::circuit::Circuit;
use crate::face::{Face, masters, operand_text};
use crate::layout::{Cell, Grid, Placed, lay_out};
use crate::network::{InstrIndex, Network, NetworkBody, Shape};
use rungc_analysis::resolve::Resolved;
use rungc_syntax::Device;
use std::collections::BTreeMap;

/// Width of a character, in pixels; the font is 12 pixels high.
pub(crate) const CHARACTER: f64 = 7.3;
/// Left of the rail: number, label and step.
const MARGIN: f64 = 62.0;
/// From the top of a row to its wire, and from there to its comments.
const ABOVE: f64 = 24.0;
const BELOW: f64 = 12.0;
const COMMENT: f64 = 13.0;
/// Half a contact's gap, and half its height.
const GAP: f64 = 4.5;
const BAR: f64 = 8.0;
/// Height of the bar of a master control.
const MASTER: f64 = 26.0;

/// A place, in pixels from the upper left corner.
pub(crate) type Point = (f64, f64);

/// Drawing element. Classes are those of the style sheets: `wire`, `rail`, `name`, `text`, `comment`, `margin`, `area`,
/// `box`; `middle` and `end` say where a text is anchored.
#[derive(Clone, Debug)]
pub(crate) enum Mark {
    /// A straight line.
    Line {
        class: &'static str,
        from: Point,
        to: Point,
    },
    /// Horizontal and vertical wires.
    Wires(Vec<(Point, Point)>),
    /// A line of text, from its base line.
    Text {
        class: &'static str,
        at: Point,
        text: String,
    },
    /// A rectangle: its upper left corner and size, and the radius of its corners.
    Frame {
        class: &'static str,
        at: Point,
        size: Point,
        radius: Option<u8>,
    },
    /// Marks about a device.
    About(Option<Device>, Vec<Mark>),
    /// Marks that lead to a network.
    Link(usize, Vec<Mark>),
    /// Marks that show the state of a running program.
    Live(Live, Vec<Mark>),
}

/// State of a running program that marks show, by its number in the network's [`Circuit`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Live {
    /// Power of a net.
    Net(usize),
    /// State of a link: a contact conducts, a coil is on, a box is driven.
    Link(usize),
    /// The values that a link works with.
    Value(usize),
}

/// Marks on a sheet.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    /// Its width and height.
    pub(crate) size: Point,
    pub(crate) marks: Vec<Mark>,
    /// Heights at which it may continue on another page.
    pub(crate) breaks: Vec<f64>,
}

pub(crate) fn text(class: &'static str, at: Point, text: &str) -> Mark {
    let text = text.to_string();
    Mark::Text { class, at, text }
}

pub(crate) fn line(class: &'static str, from: Point, to: Point) -> Mark {
    Mark::Line { class, from, to }
}

/// Settings for pictures of a program's networks.
#[derive(Clone, Copy)]
pub(crate) struct Drafter<'a> {
    face: Face<'a>,
    columns: usize,
}

impl<'a> Drafter<'a> {
    /// For these networks of a program, in lines of about `width` characters.
    pub(crate) fn new(
        resolved: &'a Resolved<'a>,
        networks: &[(usize, &Network)],
        width: usize,
    ) -> Self {
        let face = Face::of(resolved, networks, true);
        Drafter {
            face,
            columns: (width / face.cell).max(2),
        }
    }

    /// The picture of a network.
    pub(crate) fn network(&self, number: usize, network: &Network) -> Picture {
        match &network.body {
            NetworkBody::Rung(node) => {
                let grid = lay_out(node, &self.face, self.columns);
                Draft::new(self.face, &grid, None).draw(number, network)
            }
            NetworkBody::List { why } => self.list(number, network, why),
        }
    }

    /// The picture of a network whose parts show where power flows, and its circuit.
    pub(crate) fn live(&self, number: usize, network: &Network) -> (Picture, Option<Circuit>) {
        match &network.body {
            NetworkBody::Rung(node) => {
                let grid = lay_out(node, &self.face, self.columns);
                let circuit = Circuit::of(&grid);
                let draft = Draft::new(self.face, &grid, Some(&circuit));
                (draft.draw(number, network), Some(circuit))
            }
            NetworkBody::List { why } => (self.list(number, network, why), None),
        }
    }

    fn list(&self, number: usize, network: &Network, why: &str) -> Picture {
        let instrs = &self.face.resolved.program.instrs[network.instrs.clone()];
        let lines = std::iter::once(format!("cannot be drawn: {why}"));
        let lines: Vec<String> = lines
            .chain(instrs.iter().map(|instr| format!("  {instr}")))
            .collect();
        let height = lines.len() as f64 * 16.0 + 12.0;
        let mut marks = vec![text("margin", (2.0, 16.0), &number.to_string())];
        for (i, line) in lines.iter().enumerate() {
            let class = if i == 0 { "comment" } else { "text" };
            marks.push(text(class, (MARGIN, 16.0 * (i + 1) as f64), line));
        }
        let size = (MARGIN + 60.0 * CHARACTER, height);
        let breaks = (1..lines.len()).map(|i| 16.0 * i as f64 + 4.0).collect();
        Picture {
            size,
            marks,
            breaks,
        }
    }
}

/// A grid in pixels.
struct Draft<'a> {
    face: Face<'a>,
    grid: &'a Grid,
    /// Its circuit, if the picture shows where power flows.
    circuit: Option<&'a Circuit>,
    /// Height of each row's wire.
    wires: Vec<f64>,
    height: f64,
}

impl<'a> Draft<'a> {
    fn new(face: Face<'a>, grid: &'a Grid, circuit: Option<&'a Circuit>) -> Self {
        let mut comments = vec![0; grid.rows];
        for placed in &grid.placed {
            let lines = face.comment(*placed).len();
            comments[placed.row] = comments[placed.row].max(lines);
        }
        let mut top = 0.0;
        let mut wires = Vec::with_capacity(grid.rows);
        for lines in comments {
            wires.push(top + ABOVE);
            top += ABOVE + BELOW + COMMENT * lines as f64;
        }
        Draft {
            face,
            grid,
            circuit,
            wires,
            height: top,
        }
    }

    /// Position of a boundary.
    fn x(&self, boundary: usize) -> f64 {
        MARGIN + (boundary * self.face.cell) as f64 * CHARACTER
    }

    fn draw(&self, number: usize, network: &Network) -> Picture {
        let right = self.x(self.grid.columns);
        let masters = masters(self.face.resolved, network);
        let height = self.height + MASTER * masters.len() as f64;
        let mut marks = self.margin(number, network);
        let rail = |x| line("rail", (x, 0.0), (x, height));
        let power = self.circuit.map(|_| 0);
        marks.extend([fed(power, rail(self.x(0))), rail(right)]);
        marks.extend(self.wires());
        let placed = self.grid.placed.iter().enumerate();
        marks.extend(placed.map(|(i, placed)| self.placed(*placed, i)));
        for (i, master) in masters.into_iter().enumerate() {
            marks.push(self.master(master, self.height + MASTER * (i as f64 + 0.5)));
        }
        Picture {
            size: (right + 2.0, height),
            marks,
            breaks: self.wires.iter().map(|wire| wire - ABOVE).collect(),
        }
    }

    fn margin(&self, number: usize, network: &Network) -> Vec<Mark> {
        let labels: Vec<InstrIndex> =
            (network.instrs.start..network.instrs.start + network.labels).collect();
        let program = self.face.resolved.program;
        let names: Vec<&str> = labels
            .iter()
            .map(|label| &*program.instrs[*label].mnemonic)
            .collect();
        let mut marks = vec![
            text("margin", (2.0, 12.0), &number.to_string()),
            text("name end", (MARGIN - 6.0, 12.0), &names.join(" ")),
        ];
        if let Some(first) = self
            .face
            .resolved
            .instrs
            .get(network.instrs.start + network.labels)
        {
            let place = (MARGIN - 6.0, self.wires[0] + 4.0);
            marks.push(text("margin end", place, &first.step.to_string()));
        }
        marks
    }

    /// All wires as one path, or those of each net.
    fn wires(&self) -> Vec<Mark> {
        let mut wires: BTreeMap<Option<usize>, Vec<_>> = BTreeMap::new();
        let mut add = |row, boundary, wire| {
            let net = self.circuit.map(|circuit| circuit.net(row, boundary));
            wires.entry(net).or_default().push(wire);
        };
        for (row, &y) in self.wires.iter().enumerate() {
            let mut column = 0;
            while column < self.grid.columns {
                let start = column;
                while column < self.grid.columns && self.grid.wire(row, column) {
                    column += 1;
                }
                if column > start {
                    add(row, start, ((self.x(start), y), (self.x(column), y)));
                }
                column += 1;
            }
            if row + 1 < self.grid.rows {
                let below = self.wires[row + 1];
                for boundary in
                    (1..self.grid.columns).filter(|boundary| self.grid.down(row, *boundary))
                {
                    let x = self.x(boundary);
                    add(row, boundary, ((x, y), (x, below)));
                }
            }
        }
        if self.circuit.is_none() {
            // A picture has a path of wires even if there are none.
            return vec![Mark::Wires(wires.remove(&None).unwrap_or_default())];
        }
        let nets = wires.into_iter();
        nets.map(|(net, wires)| fed(net, Mark::Wires(wires)))
            .collect()
    }

    /// The contact of a master control in the left rail, which feeds what lies below.
    fn master(&self, instr: InstrIndex, y: f64) -> Mark {
        let name = |at| operand_text(self.face.resolved, instr, at);
        let rail = self.x(0);
        let mut marks = Vec::new();
        for bar in [y - GAP, y + GAP] {
            marks.push(line("wire", (rail - BAR, bar), (rail + BAR, bar)));
        }
        let gap = Mark::Frame {
            class: "gap",
            at: (rail - 2.0, y - GAP + 1.0),
            size: (4.0, 2.0 * GAP - 2.0),
            radius: None,
        };
        marks.push(gap);
        marks.push(text("name end", (rail - BAR - 4.0, y + 4.0), &name(0)));
        marks.push(text("name", (rail + BAR + 4.0, y + 4.0), &name(1)));
        let operands = &self.face.resolved.program.instrs[instr].operands;
        let device = operands.get(1).and_then(|operand| operand.kind.device());
        Mark::About(device, marks)
    }

    /// The nets on both sides of a cell.
    fn nets(&self, placed: Placed) -> Sides {
        let ends = [placed.column, placed.column + placed.span];
        ends.map(|end| Some(self.circuit?.net(placed.row, end)))
    }

    /// The `index`-th cell of the grid.
    fn placed(&self, placed: Placed, index: usize) -> Mark {
        let y = self.wires[placed.row];
        let (left, right) = (self.x(placed.column), self.x(placed.column + placed.span));
        // Area that a pointer hits.
        let mut marks = vec![Mark::Frame {
            class: "area",
            at: (left, y - ABOVE + 2.0),
            size: (right - left, ABOVE + BELOW - 4.0),
            radius: None,
        }];
        let middle = (left + right) / 2.0;
        let nets = self.nets(placed);
        let link = self.circuit.and_then(|circuit| circuit.link(index));
        match placed.cell {
            Cell::Contact(contact) if contact.shape != Shape::Compare => {
                contact_marks(contact.shape, (left, right), y, nets, &mut marks);
                let name = self.face.name(placed.cell);
                marks.push(text("name middle", (middle, y - 12.0), &name));
            }
            Cell::Contact(_) | Cell::Output(_) => {
                let label = self.face.symbol(placed.cell);
                let is_output = matches!(placed.cell, Cell::Output(_));
                let nets = if is_output { [nets[0]; 2] } else { nets };
                boxed(&label, (left, right), y, (is_output, nets), &mut marks);
                if let Some(link) = link {
                    let (class, x) = match is_output {
                        true => ("value end", right - 8.0),
                        false => ("value middle", middle),
                    };
                    let place = text(class, (x, y - 13.0), "");
                    marks.push(Mark::Live(Live::Value(link), vec![place]));
                }
            }
            Cell::Result(_) => {
                let wires = match self.circuit {
                    Some(_) => vec![((left, middle), nets[0]), ((middle, right), nets[1])],
                    None => vec![((left, right), None)],
                };
                for ((from, to), net) in wires {
                    marks.push(fed(net, line("wire", (from, y), (to, y))));
                }
                let ends = ((middle - 5.0, y + BAR), (middle + 5.0, y - BAR));
                marks.push(line("wire", ends.0, ends.1));
                let sign = self.face.symbol(placed.cell);
                marks.push(text("name middle", (middle, y - 12.0), &sign));
            }
            // The wire of a row that continues below touches no rail.
            Cell::FoldOut(_) => {
                marks.push(fed(nets[0], line("wire", (left, y), (middle, y))));
                let sign = self.face.symbol(placed.cell);
                marks.push(text("name middle", (middle, y - 6.0), &sign));
            }
            Cell::FoldIn(_) => {
                marks.push(fed(nets[0], line("wire", (middle, y), (right, y))));
                let sign = self.face.symbol(placed.cell);
                marks.push(text("name middle", (middle, y - 6.0), &sign));
            }
        }
        for (i, comment) in self.face.comment(placed).iter().enumerate() {
            let y = y + BELOW + 9.0 + COMMENT * i as f64;
            marks.push(match placed.cell {
                Cell::Output(_) => text("comment end", (right - 4.0, y), comment),
                _ => text("comment middle", (middle, y), comment),
            });
        }
        let marks = Mark::About(self.face.device(placed.cell), marks);
        match link {
            Some(link) => Mark::Live(Live::Link(link), vec![marks]),
            None => marks,
        }
    }
}

/// A mark that belongs to a net, if the picture shows where power flows.
fn fed(net: Option<usize>, mark: Mark) -> Mark {
    match net {
        Some(net) => Mark::Live(Live::Net(net), vec![mark]),
        None => mark,
    }
}

/// The nets to the left and right of a cell, if the picture shows where power flows.
type Sides = [Option<usize>; 2];

fn contact_marks(
    shape: Shape,
    (left, right): (f64, f64),
    y: f64,
    nets: Sides,
    marks: &mut Vec<Mark>,
) {
    let middle = (left + right) / 2.0;
    let halves = [(left, middle - GAP), (middle + GAP, right)];
    for ((from, to), net) in halves.into_iter().zip(nets) {
        marks.push(fed(net, line("wire", (from, y), (to, y))));
    }
    for bar in [middle - GAP, middle + GAP] {
        marks.push(line("wire", (bar, y - BAR), (bar, y + BAR)));
    }
    let ends = ((middle - 7.0, y + BAR), (middle + 7.0, y - BAR));
    match shape {
        Shape::Open | Shape::Compare => {}
        Shape::Closed => marks.push(line("wire", ends.0, ends.1)),
        Shape::Rising => marks.push(text("text middle", (middle, y + 4.0), "↑")),
        Shape::Falling => marks.push(text("text middle", (middle, y + 4.0), "↓")),
    }
}

/// A comparison, coil or box: its text, which holds its brackets.
fn boxed(
    label: &str,
    (left, right): (f64, f64),
    y: f64,
    (at_rail, nets): (bool, Sides),
    marks: &mut Vec<Mark>,
) {
    let is_coil = label.starts_with('(');
    let label = label.trim_matches(['(', ')', '[', ']']);
    let width = unicode_width::UnicodeWidthStr::width(label) as f64 * CHARACTER + 12.0;
    let start = match at_rail {
        true => right - width - 8.0,
        false => (left + right - width) / 2.0,
    };
    for ((from, to), net) in [(left, start), (start + width, right)]
        .into_iter()
        .zip(nets)
    {
        marks.push(fed(net, line("wire", (from, y), (to, y))));
    }
    marks.push(Mark::Frame {
        class: if is_coil { "box coil" } else { "box" },
        at: (start, y - 10.0),
        size: (width, 20.0),
        radius: Some(if is_coil { 10 } else { 2 }),
    });
    marks.push(text("text middle", (start + width / 2.0, y + 4.0), label));
}

impl Picture {
    /// A picture that stays on one page.
    pub(crate) fn of(size: Point, marks: Vec<Mark>) -> Self {
        let breaks = Vec::new();
        Picture {
            size,
            marks,
            breaks,
        }
    }

    /// Without links, for a picture that is a separate file.
    pub(crate) fn unlink(&mut self) {
        unlink(&mut self.marks);
    }
}

fn unlink(marks: &mut [Mark]) {
    for mark in marks {
        match mark {
            Mark::Link(_, inner) => {
                unlink(inner);
                *mark = Mark::About(None, std::mem::take(inner));
            }
            Mark::About(_, inner) | Mark::Live(_, inner) => unlink(inner),
            Mark::Line { .. } | Mark::Wires(_) | Mark::Text { .. } | Mark::Frame { .. } => {}
        }
    }
}
