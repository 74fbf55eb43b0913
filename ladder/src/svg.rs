//! Drawing a network as a picture.

use crate::face::Face;
use crate::layout::{Cell, Grid, Placed, lay_out};
use crate::network::{InstrIndex, Network, NetworkBody, Shape};
use rungc_analysis::resolve::Resolved;
use rungc_syntax::text::one_line;
use std::fmt::Write as _;
use svg::node::element::{Group, Line, Path, Rectangle, Text};
use svg::{Document, Node as _};

/// Width of a character, in pixels; the font is 12 pixels high.
const CHARACTER: f64 = 7.3;
/// Left of the rail: number, label and step.
const MARGIN: f64 = 62.0;
/// From the top of a row to its wire, and from there to its comments.
const ABOVE: f64 = 24.0;
const BELOW: f64 = 12.0;
const COMMENT: f64 = 13.0;
/// Half a contact's gap, and half its height.
const GAP: f64 = 4.5;
const BAR: f64 = 8.0;

/// The style of a picture that is a separate file.
const STYLE: &str = include_str!("page/picture.css");

/// How pictures of a program's networks are drawn.
#[derive(Clone, Copy)]
pub struct Painter<'a> {
    face: Face<'a>,
    columns: usize,
}

impl<'a> Painter<'a> {
    /// For these networks of a program, in lines of about `width` characters.
    pub fn new(resolved: &'a Resolved<'a>, networks: &[(usize, &Network)], width: usize) -> Self {
        let face = Face::of(resolved, networks, true);
        Painter {
            face,
            columns: (width / face.cell).max(2),
        }
    }

    /// A network as a picture within a page. Its classes are `wire`, `rail`, `name`, `text`, `comment`, `margin`,
    /// `area` and `box`; what is about a device is a group with the attribute `data-device`.
    pub fn network(&self, number: usize, network: &Network) -> Document {
        self.sized(number, network).0
    }

    /// The picture of a network, its width and height.
    fn sized(&self, number: usize, network: &Network) -> (Document, (f64, f64)) {
        match &network.body {
            NetworkBody::Rung(node) => {
                let grid = lay_out(node, &self.face, self.columns);
                Picture::new(self.face, &grid).draw(number, network)
            }
            NetworkBody::List { why } => self.list(number, network, why),
        }
    }

    /// All these networks in one picture, below each other, with the style that a page would give them.
    pub fn sheet(&self, networks: &[(usize, &Network)]) -> Document {
        let mut top = 0.0;
        let mut width: f64 = 0.0;
        let mut pictures = Vec::with_capacity(networks.len());
        for (number, network) in networks {
            let (picture, (wide, high)) = self.sized(*number, network);
            pictures.push(picture.set("y", round(top)));
            top += high;
            width = width.max(wide);
        }
        let mut sheet = document(width, top);
        sheet.append(svg::node::element::Style::new(STYLE));
        pictures
            .into_iter()
            .for_each(|picture| sheet.append(picture));
        sheet
    }

    fn list(&self, number: usize, network: &Network, why: &str) -> (Document, (f64, f64)) {
        let instrs = &self.face.resolved.program.instrs[network.instrs.clone()];
        let lines = std::iter::once(format!("cannot be drawn: {why}"));
        let lines: Vec<String> = lines
            .chain(instrs.iter().map(|instr| format!("  {instr}")))
            .collect();
        let height = lines.len() as f64 * 16.0 + 12.0;
        let size = (MARGIN + 60.0 * CHARACTER, height);
        let mut picture = document(size.0, size.1);
        picture.append(text("margin", 2.0, 16.0, &number.to_string()));
        for (i, line) in lines.iter().enumerate() {
            let class = if i == 0 { "comment" } else { "text" };
            picture.append(text(class, MARGIN, 16.0 * (i + 1) as f64, line));
        }
        (picture, size)
    }
}

fn document(width: f64, height: f64) -> Document {
    let size = (round(width), round(height));
    Document::new()
        .set("width", size.0)
        .set("height", size.1)
        .set("viewBox", format!("0 0 {} {}", size.0, size.1))
        .set("role", "img")
}

/// To tenths of a pixel: shorter files.
fn round(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

fn text(class: &str, x: f64, y: f64, content: &str) -> Text {
    let text = Text::new(one_line(content)).set("class", class);
    text.set("x", round(x)).set("y", round(y))
}

fn line(class: &str, from: (f64, f64), to: (f64, f64)) -> Line {
    Line::new()
        .set("class", class)
        .set("x1", round(from.0))
        .set("y1", round(from.1))
        .set("x2", round(to.0))
        .set("y2", round(to.1))
}

/// A grid in pixels.
struct Picture<'a> {
    face: Face<'a>,
    grid: &'a Grid,
    /// Where the wire of each row lies.
    wires: Vec<f64>,
    height: f64,
}

impl<'a> Picture<'a> {
    fn new(face: Face<'a>, grid: &'a Grid) -> Self {
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
        Picture {
            face,
            grid,
            wires,
            height: top,
        }
    }

    /// Where a boundary lies.
    fn x(&self, boundary: usize) -> f64 {
        MARGIN + (boundary * self.face.cell) as f64 * CHARACTER
    }

    fn draw(&self, number: usize, network: &Network) -> (Document, (f64, f64)) {
        let right = self.x(self.grid.columns);
        let mut picture = document(right + 2.0, self.height);
        self.margin(number, network, &mut picture);
        for rail in [self.x(0), right] {
            picture.append(line("rail", (rail, 0.0), (rail, self.height)));
        }
        picture.append(self.wires());
        for placed in &self.grid.placed {
            picture.append(self.placed(*placed));
        }
        (picture, (right + 2.0, self.height))
    }

    fn margin(&self, number: usize, network: &Network, picture: &mut Document) {
        let labels: Vec<InstrIndex> =
            (network.instrs.start..network.instrs.start + network.labels).collect();
        let program = self.face.resolved.program;
        let names: Vec<&str> = labels
            .iter()
            .map(|label| &*program.instrs[*label].mnemonic)
            .collect();
        picture.append(text("margin", 2.0, 12.0, &number.to_string()));
        picture.append(text("name end", MARGIN - 6.0, 12.0, &names.join(" ")));
        if let Some(first) = self
            .face
            .resolved
            .instrs
            .get(network.instrs.start + network.labels)
        {
            let step = first.step.to_string();
            picture.append(text("margin end", MARGIN - 6.0, self.wires[0] + 4.0, &step));
        }
    }

    /// All wires as one path.
    fn wires(&self) -> Path {
        let mut path = String::new();
        for (row, y) in self.wires.iter().enumerate() {
            let mut column = 0;
            while column < self.grid.columns {
                let start = column;
                while column < self.grid.columns && self.grid.wire(row, column) {
                    column += 1;
                }
                if column > start {
                    let _ = write!(
                        path,
                        "M{} {}H{}",
                        round(self.x(start)),
                        round(*y),
                        round(self.x(column))
                    );
                }
                column += 1;
            }
            if row + 1 < self.grid.rows {
                let below = self.wires[row + 1];
                for boundary in
                    (1..self.grid.columns).filter(|boundary| self.grid.down(row, *boundary))
                {
                    let _ = write!(
                        path,
                        "M{} {}V{}",
                        round(self.x(boundary)),
                        round(*y),
                        round(below)
                    );
                }
            }
        }
        Path::new().set("class", "wire").set("d", path)
    }

    fn placed(&self, placed: Placed) -> Group {
        let y = self.wires[placed.row];
        let (left, right) = (self.x(placed.column), self.x(placed.column + placed.span));
        let mut group = Group::new();
        if let Some(device) = self.face.device(placed.cell) {
            group.assign("data-device", device.to_string());
        }
        // What a pointer hits.
        let area = Rectangle::new()
            .set("class", "area")
            .set("x", round(left))
            .set("y", round(y - ABOVE + 2.0))
            .set("width", round(right - left))
            .set("height", ABOVE + BELOW - 4.0);
        group.append(area);
        let middle = (left + right) / 2.0;
        match placed.cell {
            Cell::Contact(contact) if contact.shape != Shape::Compare => {
                self.contact(contact.shape, (left, right), y, &mut group);
                group.append(text(
                    "name middle",
                    middle,
                    y - 12.0,
                    &self.face.name(placed.cell),
                ));
            }
            Cell::Contact(_) | Cell::Output(_) => {
                let label = self.face.symbol(placed.cell);
                let is_output = matches!(placed.cell, Cell::Output(_));
                self.boxed(&label, (left, right), y, is_output, &mut group);
            }
            Cell::Result(_) => {
                group.append(line("wire", (left, y), (right, y)));
                group.append(line(
                    "wire",
                    (middle - 5.0, y + BAR),
                    (middle + 5.0, y - BAR),
                ));
                group.append(text(
                    "name middle",
                    middle,
                    y - 12.0,
                    &self.face.symbol(placed.cell),
                ));
            }
            Cell::FoldOut(_) | Cell::FoldIn(_) => {
                group.append(line("wire", (left, y), (right, y)));
                group.append(text(
                    "name middle",
                    middle,
                    y - 6.0,
                    &self.face.symbol(placed.cell),
                ));
            }
        }
        for (i, comment) in self.face.comment(placed).iter().enumerate() {
            let y = y + BELOW + 9.0 + COMMENT * i as f64;
            let line = match placed.cell {
                Cell::Output(_) => text("comment end", right - 4.0, y, comment),
                _ => text("comment middle", middle, y, comment),
            };
            group.append(line);
        }
        group
    }

    fn contact(&self, shape: Shape, (left, right): (f64, f64), y: f64, group: &mut Group) {
        let middle = (left + right) / 2.0;
        for (from, to) in [(left, middle - GAP), (middle + GAP, right)] {
            group.append(line("wire", (from, y), (to, y)));
        }
        for bar in [middle - GAP, middle + GAP] {
            group.append(line("wire", (bar, y - BAR), (bar, y + BAR)));
        }
        match shape {
            Shape::Open | Shape::Compare => {}
            Shape::Closed => group.append(line(
                "wire",
                (middle - 7.0, y + BAR),
                (middle + 7.0, y - BAR),
            )),
            Shape::Rising => group.append(text("text middle", middle, y + 4.0, "↑")),
            Shape::Falling => group.append(text("text middle", middle, y + 4.0, "↓")),
        }
    }

    /// A comparison, coil or box: its text, which holds its brackets.
    fn boxed(
        &self,
        label: &str,
        (left, right): (f64, f64),
        y: f64,
        at_rail: bool,
        group: &mut Group,
    ) {
        let is_coil = label.starts_with('(');
        let label = label.trim_matches(['(', ')', '[', ']']);
        let width = unicode_width::UnicodeWidthStr::width(label) as f64 * CHARACTER + 12.0;
        let start = match at_rail {
            true => right - width - 8.0,
            false => (left + right - width) / 2.0,
        };
        group.append(line("wire", (left, y), (start, y)));
        group.append(line("wire", (start + width, y), (right, y)));
        let frame = Rectangle::new()
            .set("class", if is_coil { "box coil" } else { "box" })
            .set("x", round(start))
            .set("y", round(y - 10.0))
            .set("width", round(width))
            .set("height", 20)
            .set("rx", if is_coil { 10 } else { 2 });
        group.append(frame);
        group.append(text("text middle", start + width / 2.0, y + 4.0, label));
    }
}
