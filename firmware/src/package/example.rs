//! The example of a package: a board whose pins are the program's terminals.

use super::Package;
use crate::image::{comment, terminals};
use rungc_emit::storage::Storage;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Style of a build system's example.
pub struct Style {
    /// The program around what depends on the terminals.
    pub template: &'static str,
    /// Additional code if the program takes edges.
    pub edges: &'static str,
    /// Its pins, in the order in which terminals get them.
    pub pins: &'static [u8],
    /// The pin of a terminal for which none is left.
    pub none: &'static str,
    /// True if an interrupt handler has an argument, so that one serves all inputs.
    pub one_handler: bool,
}

/// A terminal: its number, its name and comment, and its pin.
pub struct Terminal {
    pub number: u32,
    pub name: String,
    pub pin: Option<u8>,
}

/// The terminals of the program with their pins: inputs and outputs. If pins are short, each side has half of them.
pub fn pins(package: &Package, pins: &[u8]) -> [Vec<Terminal>; 2] {
    let numbers = |class| terminals(package.module, class).collect::<BTreeSet<_>>();
    let (mut inputs, outputs) = (numbers(DeviceClass::X), numbers(DeviceClass::Y));
    inputs.extend(rungc_emit::events::inputs(package.module));
    let half = pins.len() / 2;
    let of_inputs = inputs
        .len()
        .min(half.max(pins.len().saturating_sub(outputs.len())));
    let (first, rest) = pins.split_at(of_inputs);
    let with = |class: DeviceClass, numbers: BTreeSet<u32>, pins: &[u8]| {
        let of = |(i, number): (usize, u32)| Terminal {
            number,
            name: named(package, class, number),
            pin: pins.get(i).copied(),
        };
        numbers.into_iter().enumerate().map(of).collect()
    };
    [
        with(DeviceClass::X, inputs, first),
        with(DeviceClass::Y, outputs, rest),
    ]
}

/// The name of a terminal and its comment.
fn named(package: &Package, class: DeviceClass, number: u32) -> String {
    let mut name = class.number(number).to_string();
    if let Some(text) = Storage::new(package.module).comment(class, number) {
        let _ = write!(name, ": {}", comment(text));
    }
    name
}

/// The example's source.
pub fn source(package: &Package, style: &Style) -> String {
    let table = |terminals: &[Terminal]| {
        let mut text = String::new();
        for Terminal { number, name, pin } in terminals {
            let pin = pin.map_or(style.none.to_string(), |pin| pin.to_string());
            let _ = writeln!(text, "    {{{number}, {pin}}}, /* {name} */");
        }
        text
    };
    let [inputs, outputs] = pins(package, style.pins);
    fill(package, style, &table(&inputs), &table(&outputs))
}

/// The example's source with these tables.
pub fn fill(package: &Package, style: &Style, inputs: &str, outputs: &str) -> String {
    let watched = rungc_emit::events::inputs(package.module);
    let (mut edges, mut attach) = (String::new(), String::new());
    if !watched.is_empty() {
        edges.push_str(style.edges);
        attach.push_str("    board.next_edge = next_edge;\n");
    }
    for number in watched {
        let _ = match style.one_handler {
            true => writeln!(attach, "    attach({number});"),
            false => writeln!(attach, "    attach({number}, [] {{ note({number}); }});"),
        };
    }
    style
        .template
        .replace("/* INPUTS */", inputs)
        .replace("/* OUTPUTS */", outputs)
        .replace("/* EDGES */", &edges)
        .replace("/* ATTACH */", &attach)
        .replace("PROGRAM", package.name())
}
