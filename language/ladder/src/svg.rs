//! Drawing networks and charts as SVG.

use crate::circuit::Circuit;
use crate::compare::{Comparison, Drawn};
use crate::network::Network;
use crate::picture::{Drafter, Live, Mark, Picture, text};
use crate::sfc::Chart;
use rungc_analysis::resolve::Resolved;
use rungc_syntax::text::one_line;
use std::fmt::Write as _;
use svg::node::Blob;
use svg::node::element::{Anchor, Group, Line, Path, Rectangle, Style, Text};
use svg::{Document, Node};

/// The style of a picture that is a separate file.
const STYLE: &str = include_str!("page/picture.css");

/// Settings for pictures of a program's networks.
#[derive(Clone, Copy)]
pub struct Painter<'a> {
    drafter: Drafter<'a>,
}

impl<'a> Painter<'a> {
    /// For these networks of a program, in lines of about `width` characters.
    pub fn new(resolved: &'a Resolved<'a>, networks: &[(usize, &Network)], width: usize) -> Self {
        let drafter = Drafter::new(resolved, networks, width);
        Painter { drafter }
    }

    /// A network as a picture within a page. Its classes are `wire`, `rail`, `name`, `text`, `comment`, `margin`,
    /// `area` and `box`; what is about a device is a group with the attribute `data-device`.
    pub fn network(&self, number: usize, network: &Network) -> Document {
        document(&self.drafter.network(number, network))
    }

    /// A network as a picture within a page that shows where power flows. What belongs to a net is in groups with the
    /// attribute `data-net`, what belongs to a link of the circuit in one with `data-link`, and the place for the
    /// values of a coil, box or comparison is one with `data-value`, the link's number. A network that is drawn as a
    /// list has no circuit.
    pub fn live(&self, number: usize, network: &Network) -> (Document, Option<Circuit>) {
        let (picture, circuit) = self.drafter.live(number, network);
        (document(&picture), circuit)
    }

    /// All these networks in one picture, below each other, with the style that a page would give them.
    pub fn sheet(&self, networks: &[(usize, &Network)]) -> Document {
        let mut sheet = Sheet::default();
        for (number, network) in networks {
            sheet.picture(&self.drafter.network(*number, network));
        }
        sheet.finish()
    }
}

/// Pictures below each other.
#[derive(Default)]
struct Sheet {
    documents: Vec<Document>,
    width: f64,
    height: f64,
}

impl Sheet {
    fn picture(&mut self, picture: &Picture) {
        let document = document(picture);
        self.documents.push(document.set("y", round(self.height)));
        self.height += picture.size.1;
        self.width = self.width.max(picture.size.0);
    }

    fn finish(self) -> Document {
        let mut sheet = empty((self.width, self.height));
        sheet.append(Style::new(STYLE));
        let documents = self.documents.into_iter();
        documents.for_each(|picture| sheet.append(picture));
        sheet
    }
}

/// The networks in which two programs differ, as a picture: before with a red bar at the left, now with a green one.
pub fn comparison(sides: [Drawn; 2], comparison: &Comparison, width: usize) -> Document {
    let networks = sides.map(|side| (1..).zip(&side.ladder.networks).collect::<Vec<_>>());
    let drafters = [0, 1].map(|side| Drafter::new(sides[side].resolved, &networks[side], width));
    let mut sheet = Sheet::default();
    for change in &comparison.networks {
        let heading = text("heading", (0.0, 20.0), &change.title());
        sheet.picture(&Picture::of((400.0, 28.0), vec![heading]));
        for (side, place) in change.shown().into_iter().enumerate() {
            let Some(at) = place else { continue };
            let mut picture = drafters[side].network(at + 1, sides[side].network(at));
            let bar = Mark::Frame {
                class: ["old", "new"][side],
                at: (0.0, 18.0),
                size: (4.0, picture.size.1 - 20.0),
                radius: None,
            };
            let named = text(
                "comment",
                (8.0, picture.size.1 - 8.0),
                ["before", "now"][side],
            );
            picture.marks.extend([bar, named]);
            sheet.picture(&picture);
        }
    }
    sheet.finish()
}

impl Chart {
    /// The chart as a picture within a page.
    pub fn svg(&self) -> Document {
        document(&self.picture())
    }

    /// The chart as a picture that is a separate file.
    pub fn sheet(&self) -> Document {
        let mut picture = self.picture();
        picture.unlink();
        let mut sheet = Sheet::default();
        sheet.picture(&picture);
        sheet.finish()
    }
}

fn empty(size: (f64, f64)) -> Document {
    let size = (round(size.0), round(size.1));
    Document::new()
        .set("width", size.0)
        .set("height", size.1)
        .set("viewBox", format!("0 0 {} {}", size.0, size.1))
        .set("role", "img")
}

/// Marks become text one by one: a network may have hundreds of thousands.
pub(crate) fn document(picture: &Picture) -> Document {
    let mut text = String::new();
    for (i, mark) in picture.marks.iter().enumerate() {
        let before = if i > 0 { "\n" } else { "" };
        let _ = write!(text, "{before}{}", node(mark));
    }
    let mut document = empty(picture.size);
    if !text.is_empty() {
        document.append(Blob::new(text));
    }
    document
}

/// To tenths of a pixel: shorter files.
fn round(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

fn node(mark: &Mark) -> Box<dyn Node> {
    match mark {
        Mark::Line { class, from, to } => {
            let line = Line::new().set("class", *class);
            let line = line.set("x1", round(from.0)).set("y1", round(from.1));
            line.set("x2", round(to.0)).set("y2", round(to.1)).into()
        }
        Mark::Wires(wires) => {
            let mut path = String::new();
            for (from, to) in wires {
                let _ = write!(path, "M{} {}", round(from.0), round(from.1));
                let _ = match from.1 == to.1 {
                    true => write!(path, "H{}", round(to.0)),
                    false => write!(path, "V{}", round(to.1)),
                };
            }
            Path::new().set("class", "wire").set("d", path).into()
        }
        Mark::Text { class, at, text } => {
            let text = Text::new(one_line(text)).set("class", *class);
            text.set("x", round(at.0)).set("y", round(at.1)).into()
        }
        Mark::Frame {
            class,
            at,
            size,
            radius,
        } => {
            let frame = Rectangle::new().set("class", *class);
            let frame = frame.set("x", round(at.0)).set("y", round(at.1));
            let frame = frame
                .set("width", round(size.0))
                .set("height", round(size.1));
            match radius {
                Some(radius) => frame.set("rx", *radius).into(),
                None => frame.into(),
            }
        }
        Mark::About(device, marks) => {
            let mut group = Group::new();
            if let Some(device) = device {
                group.assign("data-device", device.to_string());
            }
            marks.iter().for_each(|mark| group.append(node(mark)));
            group.into()
        }
        Mark::Live(part, marks) => {
            let (attribute, number) = match part {
                Live::Net(number) => ("data-net", number),
                Live::Link(number) => ("data-link", number),
                Live::Value(number) => ("data-value", number),
            };
            let mut group = Group::new().set(attribute, *number);
            marks.iter().for_each(|mark| group.append(node(mark)));
            group.into()
        }
        Mark::Link(network, marks) => {
            let mut anchor = Anchor::new().set("href", format!("#n{network}"));
            marks.iter().for_each(|mark| anchor.append(node(mark)));
            anchor.into()
        }
    }
}
