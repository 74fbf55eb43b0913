//! Special modules and analog inputs of an image in Rust.

use crate::board::AnalogPin;
use crate::image::Image;
use rungc_rt::modules::Quantity;
use std::fmt::Write;

const MODULES: &str = include_str!("../../../templates/modules.rs");
const BUFFER: &str = include_str!("../../../templates/buffer.rs");

/// What reads a converter.
const COUNT: &str = "/// What a converter holds.
fn count(address: usize, full: u32) -> u32 {
    (read(address) & 0xFFFF).min(full)
}

";

/// Whether converters are read.
fn counts(image: &Image) -> bool {
    let modules = image.modules();
    let inputs = modules.iter().any(|module| !module.inputs.is_empty());
    inputs || image.board.analog.channels().next().is_some()
}

/// The modules, and what goes between them and the pins.
pub(super) fn drivers(image: &Image) -> String {
    let count = if counts(image) { COUNT } else { "" };
    let modules = image.modules();
    if modules.is_empty() {
        return count.to_string();
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
    let text = MODULES
        .replace("/* UNITS */\n", &units.concat())
        .replace("/* NUMBER */", &modules.len().to_string())
        .replace("/* TAKE */\n", &take)
        .replace("/* GIVE */\n", &give);
    format!("{count}{text}")
}

/// The signal at a pin.
fn measured(pin: &AnalogPin) -> String {
    let (at, full) = (pin.at, pin.full);
    let [low, high] = pin.signal;
    format!("signal_of(count(0x{at:08X}, {full}), [{low}, {high}], {full})")
}

fn put_out(n: usize, channel: u8, pin: &AnalogPin) -> String {
    let (at, full) = (pin.at, pin.full);
    let [low, high] = pin.signal;
    let quantity: Quantity = pin.quantity;
    format!(
        "        let signal = self.modules[{n}].signal({channel}, Quantity::{quantity:?}).unwrap_or(0);\n        write(0x{at:08X}, count_of(signal, [{low}, {high}], {full}));"
    )
}

/// What the hardware does for FROM and TO and for built-in analog inputs.
pub(super) fn hal(image: &Image) -> String {
    let mut text = String::new();
    if !image.modules().is_empty() {
        text.push_str(BUFFER);
    }
    if image.board.analog.channels().next().is_some() {
        text.push_str(
            "    fn analog(&mut self, channel: u8) -> Option<i16> {\n        match channel {\n",
        );
        for (channel, pin) in image.board.analog.channels() {
            let _ = writeln!(
                text,
                "            {channel} => Some(count(0x{:08X}, {}) as i16),",
                pin.at, pin.full
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

/// What an image takes from the runtime for its modules.
pub(super) fn uses(image: &Image) -> &'static str {
    let modules = image.modules();
    let inputs = modules.iter().any(|module| !module.inputs.is_empty());
    match (modules.is_empty(), inputs) {
        (true, _) => "",
        (false, true) => "use rungc_rt::modules::{KINDS, Module, Quantity, Signal};\n",
        (false, false) => "use rungc_rt::modules::{KINDS, Module, Quantity};\n",
    }
}
