//! Special modules and analog inputs of an image in Rust.

use crate::board::AnalogPin;
use crate::image::Image;
use crate::template;
use rungc_rt::modules::Quantity;
use std::fmt::Write;

/// Function that reads a converter.
const COUNT: &str = "/// Result of a conversion.
fn count(address: usize, full: u32) -> u32 {
    (read(address) & 0xFFFF).min(full)
}

";

/// Function that starts a converter, and reads it.
const CONVERTED: &str = "/// Starts a converter, waits and reads it.
fn converted(start: usize, word: u32, ready: u32, address: usize, full: u32) -> u32 {
    write(start, word);
    while read(start) & ready == 0 {}
    count(address, full)
}

";

/// Returns true if the converter needs a start command.
fn starts(image: &Image) -> bool {
    let analog = &image.board.analog;
    let modules = image.modules();
    let inputs = modules.iter().flat_map(|module| &module.inputs);
    let mut pins = inputs
        .map(|(_, pin)| pin)
        .chain(analog.channels().map(|(_, pin)| pin));
    pins.any(|pin| pin.start.is_some())
}

/// Returns true if converters are read.
fn counts(image: &Image) -> bool {
    let modules = image.modules();
    let inputs = modules.iter().any(|module| !module.inputs.is_empty());
    inputs || image.board.analog.channels().next().is_some()
}

/// The modules, and what goes between them and the pins.
pub(super) fn drivers(image: &Image) -> String {
    let mut count = String::new();
    if counts(image) {
        count.push_str(COUNT);
    }
    if starts(image) {
        count.push_str(CONVERTED);
    }
    let modules = image.modules();
    if modules.is_empty() {
        return count;
    }
    let (mut take, mut give) = (String::new(), String::new());
    for (n, module) in modules.iter().enumerate() {
        for (channel, pin) in &module.inputs {
            // Writing to a String does not fail.
            let _ = writeln!(
                take,
                "        self.modules[{n}].connect({channel}, Signal {{\n            quantity: Quantity::{:?},\n            millionths: {},\n        }});",
                pin.quantity,
                measured(pin)
            );
        }
        for (channel, pin) in &module.outputs {
            let _ = writeln!(give, "{}", put_out(n, *channel, pin));
        }
    }
    let units = modules.iter().enumerate();
    let units: Vec<_> = units
        .map(|(n, module)| format!("            {} => Some({n}),\n", module.unit))
        .collect();
    let text = template!("modules.rs")
        .replace("/* UNITS */\n", &units.concat())
        .replace("/* NUMBER */", &modules.len().to_string())
        .replace("/* TAKE */\n", &take)
        .replace("/* GIVE */\n", &give);
    format!("{count}{text}")
}

/// The signal at a pin.
fn measured(pin: &AnalogPin) -> String {
    let [low, high] = pin.signal;
    format!("signal_of({}, [{low}, {high}], {})", counted(pin), pin.full)
}

/// The count of a pin.
fn counted(pin: &AnalogPin) -> String {
    let (at, full) = (pin.at, pin.full);
    match pin.start {
        Some(start) => format!(
            "converted(0x{:08X}, 0x{:X}, 0x{:X}, 0x{at:08X}, {full})",
            start.at, start.write, start.wait
        ),
        None => format!("count(0x{at:08X}, {full})"),
    }
}

/// Function that sets the board's own outputs, by their counts.
fn own_outputs(image: &Image) -> String {
    let outputs = image.own_outputs();
    let mut text = String::new();
    for (channel, pin) in &outputs {
        // Writing to a String does not fail.
        let _ = writeln!(
            text,
            "                {channel} => write(0x{:08X}, i32::from(value).clamp(0, {}) as u32),",
            pin.at, pin.full
        );
    }
    match outputs.is_empty() {
        true => text,
        false => format!(
            "        if unit == 0 {{\n            match address {{\n{text}                _ => return None,\n            }}\n            return Some(());\n        }}\n"
        ),
    }
}

/// Method that writes buffer memory if there are no modules but the board.
const WRITE: &str =
    "    fn write_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
/* BOARD */        None
    }

";

fn put_out(n: usize, channel: u8, pin: &AnalogPin) -> String {
    let (at, full) = (pin.at, pin.full);
    let [low, high] = pin.signal;
    let quantity: Quantity = pin.quantity;
    format!(
        "        let signal = self.modules[{n}].signal({channel}, Quantity::{quantity:?}).unwrap_or(0);\n        write(0x{at:08X}, count_of(signal, [{low}, {high}], {full}));"
    )
}

/// Methods of the hardware for FROM and TO and for built-in analog inputs.
pub(super) fn hal(image: &Image) -> String {
    let mut text = String::new();
    let outputs = own_outputs(image);
    let buffer = match (image.modules().is_empty(), outputs.is_empty()) {
        (false, _) => template!("buffer.rs"),
        (true, false) => WRITE,
        (true, true) => "",
    };
    text.push_str(&buffer.replace("/* BOARD */", &outputs));
    if image.board.analog.channels().next().is_some() {
        text.push_str(
            "    fn analog(&mut self, channel: u8) -> Option<i16> {\n        match channel {\n",
        );
        for (channel, pin) in image.board.analog.channels() {
            let _ = writeln!(
                text,
                "            {channel} => Some({} as i16),",
                counted(pin)
            );
        }
        text.push_str("            _ => None,\n        }\n    }\n");
    }
    text
}

/// The fields of the pins, and how they begin.
pub(super) fn fields(image: &Image) -> Option<(String, String)> {
    let modules = image.modules();
    if modules.is_empty() {
        return None;
    }
    let kinds = modules.iter().map(|module| {
        format!(
            "Module::new(&KINDS[{}] /* {} */)",
            module.kind.index(),
            module.kind.name
        )
    });
    let kinds: Vec<_> = kinds.collect();
    let fields = format!(
        "    /// Special modules, whose channels are pins.\n    modules: [Module; {}],\n    /// When they were exchanged last.\n    exchanged_us: u32,\n",
        modules.len()
    );
    Some((
        fields,
        format!(" modules: [{}], exchanged_us: 0,", kinds.join(", ")),
    ))
}

/// Imports from the runtime for the modules.
pub(super) fn uses(image: &Image) -> &'static str {
    let modules = image.modules();
    let inputs = modules.iter().any(|module| !module.inputs.is_empty());
    match (modules.is_empty(), inputs) {
        (true, _) => "",
        (false, true) => "use rungc_rt::modules::{KINDS, Module, Quantity, Signal};\n",
        (false, false) => "use rungc_rt::modules::{KINDS, Module, Quantity};\n",
    }
}
