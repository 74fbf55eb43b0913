//! Special modules and analog inputs of an image in C.

use crate::board::AnalogPin;
use crate::image::Image;
use std::fmt::Write;

const MODULES: &str = include_str!("../../../templates/modules.c");
const ANALOG: &str = include_str!("../../../templates/analog.c");

/// Fields of `rungc_hal` that the modules are.
pub(super) const FIELDS: [&str; 2] = ["read_bfm", "write_bfm"];

/// Whether the board's own functions leave the buffer memory to the image.
pub(super) fn are_there(image: &Image) -> bool {
    let own = |field: &&str| image.board.functions.contains_key(*field);
    !FIELDS.iter().any(own) && !image.modules().is_empty()
}

/// The functions of the modules, and of the built-in analog inputs.
pub(super) fn drivers(image: &Image) -> String {
    let mut text = String::new();
    if image.board.analog.channels().next().is_some() {
        let mut cases = String::new();
        for (channel, pin) in image.board.analog.channels() {
            // Writing to a String does not fail.
            let _ = writeln!(
                cases,
                "    case {channel}u:\n        *value = (int16_t)count(0x{:08X}u, {}u);\n        return true;",
                pin.at, pin.full
            );
        }
        text.push_str(&ANALOG.replace("/* CASES */\n", &cases));
    }
    if are_there(image) {
        text.push_str(&modules(image));
    }
    match text.contains("count(0x") {
        true => format!("{COUNT}{text}"),
        false => text,
    }
}

/// The modules and what goes between them and the pins.
fn modules(image: &Image) -> String {
    let modules = image.modules();
    let mut units = String::new();
    let (mut fit, mut take, mut give) = (String::new(), String::new(), String::new());
    for (n, module) in modules.iter().enumerate() {
        let _ = write!(units, "{}u, ", module.unit);
        let (kind, name) = (module.kind.index(), module.kind.name);
        let _ = writeln!(
            fit,
            "    (void)rungc_module_fit(&modules[{n}], {kind}u); /* {name} */"
        );
        take.push_str(&wires(n, &module.inputs, |pin, channel, scale| {
            let count = format!("count(0x{:08X}u, {}u)", pin.at, pin.full);
            format!("(void)rungc_module_connect({channel}, signal_of({count}, {scale}))")
        }));
        give.push_str(&wires(n, &module.outputs, |pin, channel, scale| {
            let signal = format!("rungc_module_signal({channel})");
            format!("REGISTER(0x{:08X}u) = count_of({signal}, {scale})", pin.at)
        }));
    }
    MODULES
        .replace("/* UNITS */", units.trim_end_matches(", "))
        .replace("/* NUMBER */", &modules.len().to_string())
        .replace("/* FIT */\n", &fit)
        .replace("/* TAKE */\n", &take)
        .replace("/* GIVE */\n", &give)
}

/// What reads a converter.
const COUNT: &str = "/* What a converter holds. */
static uint32_t count(uint32_t address, uint32_t full)
{
    uint32_t value = REGISTER(address) & 0xFFFFu;
    return value < full ? value : full;
}

";

/// A statement for each pin that is wired to a channel of module `n`. `statement` takes the pin, the
/// arguments that name the channel, and those that scale its signal.
fn wires(
    n: usize,
    pins: &[(u8, AnalogPin)],
    statement: impl Fn(&AnalogPin, &str, &str) -> String,
) -> String {
    let wire = |(channel, pin): &(u8, AnalogPin)| {
        let [low, high] = pin.signal;
        let channel = format!("&modules[{n}], {channel}u, {}u", pin.quantity as u8);
        let scale = format!("{}, {low}, {high}", pin.full);
        let statement = statement(pin, &channel, &scale);
        format!("    {statement};\n")
    };
    pins.iter().map(wire).collect()
}
