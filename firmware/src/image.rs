//! The sources of an image: a program, a board, and what is between reset and the first scan.

mod boot2;
mod c;
mod modules;
mod rust;

use crate::board::{Board, InputPin, Retain, Serial};
use crate::template;
use rungc_ir::Module;
use rungc_ir::node::FunctionKind;
use rungc_rt::comm::Protocol;
use rungc_syntax::text::one_line;
use rungc_syntax::{DeviceClass, FittedModule};
use std::fmt::Write;

pub use c::{NoPins, pins_project, project as c_project};
pub use rust::project as rust_project;

/// Scripted behaviour of an image, for a simulator.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Script {
    /// Inputs that switch themselves and do not follow their pins: milliseconds since the start, X, whether on. In
    /// order of time.
    pub inputs: Vec<(u32, u32, bool)>,
    /// End of the simulation, in milliseconds.
    pub until_ms: Option<u32>,
}

/// An image to be made.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a> {
    /// The program.
    pub module: &'a Module,
    /// The board.
    pub board: &'a Board,
    /// Scripted behaviour.
    pub script: &'a Script,
    /// The special modules of the PLC; those whose channels are pins of the board are in the image.
    pub modules: &'a [FittedModule],
}

/// Numbers of the terminals of a class that a program looks at.
pub(crate) fn terminals(module: &Module, class: DeviceClass) -> impl Iterator<Item = u32> {
    let areas = module.layout.areas.iter().filter(move |a| a.class == class);
    areas.flat_map(|a| a.first..a.first + a.count)
}

impl Image<'_> {
    /// Inputs whose edges the program takes, in order.
    fn watched(&self) -> Vec<u32> {
        let edges = self.module.functions.iter().filter_map(|f| match f.kind {
            FunctionKind::InputEdge { input, .. } => Some(input),
            _ => None,
        });
        let mut watched: Vec<u32> = edges.collect();
        watched.sort();
        watched.dedup();
        watched
    }

    /// Memory for latched devices, if the board has such memory and the program such devices.
    fn retain(&self) -> Option<&Retain> {
        let retain = self.board.retain.as_ref()?;
        rungc_emit::cycle::keeps_any(self.module).then_some(retain)
    }

    /// The pin by which the supply says that power is about to fail, if that concerns the program: it latches devices,
    /// or looks at those that show the supply.
    fn supply(&self) -> Option<&InputPin> {
        let pin = self.board.retain.as_ref()?.power_fail.as_ref()?;
        let asks = rungc_emit::cycle::uses_supply(self.module);
        (asks || self.retain().is_some()).then_some(pin)
    }

    /// Length of a record of latched devices, and the number of records per slot; `None` if the board has no such
    /// memory or the program no such devices.
    pub fn records(&self) -> Option<(u32, u32)> {
        let length = rungc_codegen_c::record_len(self.module);
        let retain = self.retain()?;
        Some((length, retain.slots[0].length / length.next_multiple_of(8)))
    }

    /// The ports of the board that the program has.
    fn serial(&self) -> Vec<&Serial> {
        let ports = self.board.serial.iter();
        ports
            .filter(|serial| self.module.ports.contains(&serial.port))
            .collect()
    }

    /// Returns true if no port receives while it sends, as with free protocols: then both directions share memory.
    fn takes_turns(&self) -> bool {
        let mut ports = self.module.serial_ports();
        ports.all(|(_, protocols)| !protocols.contains(Protocol::Free))
    }

    /// Outputs that are printed: number, name, and the text after the state, a comment. Those that send pulses would be
    /// printed all the time.
    fn printed(&self) -> Vec<(u32, String, String)> {
        let module = self.module;
        let quiet = |number: &u32| module.pulse_outputs.contains(number);
        let numbers = terminals(module, DeviceClass::Y).filter(|number| !quiet(number));
        let comment = |number: u32| {
            let mut comments = module.comments.iter();
            let found = comments.find(|(class, n, _)| (*class, *n) == (DeviceClass::Y, number));
            found.map_or(String::new(), |(_, _, text)| {
                format!("  {}", one_line(text))
            })
        };
        numbers
            .map(|n| (n, DeviceClass::Y.number(n).to_string(), comment(n)))
            .collect()
    }

    /// Terminals of the program whose pins the description marks as uncertain, by their names.
    pub fn uncertain(&self) -> Vec<String> {
        let named = |class: DeviceClass| {
            terminals(self.module, class).map(move |n| class.number(n).to_string())
        };
        let is_uncertain = |terminal: &String| {
            let mut pins = self.board.pins.iter();
            pins.any(|pin| pin.terminal == *terminal && pin.uncertain.is_some())
        };
        let all = named(DeviceClass::X).chain(named(DeviceClass::Y));
        all.filter(is_uncertain).collect()
    }

    /// Terminals and serial ports of the program that the board has no pin or UART for and no function either, by their
    /// names.
    pub fn unconnected(&self) -> Vec<String> {
        let has = |function: &str| self.board.functions.contains_key(function);
        let scripted = |n: &u32| self.script.inputs.iter().any(|(_, x, _)| x == n);
        let inputs = terminals(self.module, DeviceClass::X)
            .filter(|n| !self.board.inputs.contains_key(n) && !has("input") && !scripted(n));
        let outputs = terminals(self.module, DeviceClass::Y)
            .filter(|n| !self.board.outputs.contains_key(n) && !has("set_output"));
        let is_can = |port: &u8| {
            let wiring = self.module.model.ports.get(*port);
            wiring.is_some_and(|wiring| wiring.is_can())
        };
        let ports = self.module.ports.iter().filter(|port| {
            let described = self.board.serial.iter().any(|serial| serial.port == **port);
            !(described || has("set_line") || is_can(port) && has("can_send"))
        });
        let name = |class: DeviceClass| move |n: u32| class.number(n).to_string();
        inputs
            .map(name(DeviceClass::X))
            .chain(outputs.map(name(DeviceClass::Y)))
            .chain(ports.map(|port| match is_can(port) {
                true => "CAN".to_string(),
                false => format!("COM{port}"),
            }))
            .collect()
    }
}

/// The linker script, the same for both backends.
fn linker_script(board: &Board) -> String {
    let region = |r: crate::board::Region| format!("0x{:08X}, LENGTH = {}", r.origin, r.length);
    let [boot2, in_ram] = boot2::sections(board);
    let mut text = format!("/* Memory of {}. */\n", comment(&board.name));
    let script = template!("image.ld")
        .replace("/* BOOT2 */", boot2)
        .replace("/* IN_RAM */", in_ram)
        .replace("/* FLASH */", &region(board.flash))
        .replace("/* RAM */", &region(board.ram))
        .replace("/* STACK */", &board.stack.to_string());
    let _ = write!(text, "{script}");
    text
}

/// A text that is safe in a comment of C, Rust, `make` or a linker script.
pub(crate) fn comment(text: &str) -> String {
    one_line(text)
        .replace("*/", "* /")
        .replace("/*", "/ *")
        .replace("??", "? ?")
}
