//! Pictures that a page and a document can show alike: networks with the power that flows in them.

use crate::network::Network;
use crate::picture::{Drafter, Live, Mark, Picture, line};
use rungc_analysis::resolve::Resolved;
use svg::Document;

/// Power in the circuit of a network ([`crate::circuit::Circuit`]), by the numbers of its parts.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Power {
    /// Nets with power.
    pub nets: Vec<bool>,
    /// Links that conduct, are on or are driven.
    pub links: Vec<bool>,
}

/// A picture, for pages and documents.
#[derive(Clone, Debug)]
pub struct Drawing(pub(crate) Picture);

impl Drawing {
    /// A network, in lines of about `width` characters, with the power that flows in it drawn thick: in a page, such
    /// wires and boxes have the class `lit`.
    pub fn powered(
        resolved: &Resolved,
        (number, network): (usize, &Network),
        power: &Power,
        width: usize,
    ) -> Drawing {
        let drafter = Drafter::new(resolved, &[(number, network)], width);
        let (mut picture, _) = drafter.live(number, network);
        let marks = std::mem::take(&mut picture.marks).into_iter();
        picture.marks = marks.filter_map(|mark| lit(mark, false, power)).collect();
        Drawing(picture)
    }

    /// The picture within a page.
    pub fn svg(&self) -> Document {
        crate::svg::document(&self.0)
    }
}

/// A mark with the power that it shows, if any: none if it stands for a value. `on` says whether what it belongs to has
/// power.
fn lit(mark: Mark, on: bool, power: &Power) -> Option<Mark> {
    let has = |parts: &[bool], number: usize| parts.get(number).copied().unwrap_or(false);
    let all = |marks: Vec<Mark>, on: bool| -> Vec<Mark> {
        let marks = marks.into_iter();
        marks.filter_map(|mark| lit(mark, on, power)).collect()
    };
    Some(match mark {
        Mark::Live(Live::Value(_), _) => return None,
        Mark::Live(Live::Net(net), marks) => Mark::About(None, all(marks, has(&power.nets, net))),
        Mark::Live(Live::Link(link), marks) => {
            Mark::About(None, all(marks, has(&power.links, link)))
        }
        Mark::About(device, marks) => Mark::About(device, all(marks, on)),
        Mark::Link(network, marks) => Mark::Link(network, all(marks, on)),
        Mark::Line { class, from, to } if on => Mark::Line {
            class: thick(class),
            from,
            to,
        },
        Mark::Wires(wires) if on => {
            let lines = wires.into_iter();
            let lines = lines.map(|(from, to)| line(thick("wire"), from, to));
            Mark::About(None, lines.collect())
        }
        Mark::Frame {
            class,
            at,
            size,
            radius,
        } if on => Mark::Frame {
            class: thick(class),
            at,
            size,
            radius,
        },
        other => other,
    })
}

/// The class of the same mark in thick lines.
fn thick(class: &'static str) -> &'static str {
    match class {
        "wire" => "wire lit",
        "rail" => "rail lit",
        "box" => "box lit",
        "area" => "area lit",
        other => other,
    }
}
