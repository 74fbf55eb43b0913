//! Special modules and analog inputs of an image in C.

use crate::board::AnalogPin;
use crate::image::Image;
use crate::template;
use std::fmt::Write;

/// Fields of `rungc_hal` that the modules are.
pub(super) const FIELDS: [&str; 2] = ["read_bfm", "write_bfm"];

/// Returns true if the board's own functions leave the buffer memory to the image.
fn are_own(image: &Image) -> bool {
    let own = |field: &&str| image.board.functions.contains_key(*field);
    !FIELDS.iter().any(own)
}

/// Returns true if the image has modules.
pub(super) fn are_there(image: &Image) -> bool {
    are_own(image) && !image.modules().is_empty()
}

/// Returns true if a field of the hardware is filled here.
pub(super) fn fills(image: &Image, field: &str) -> bool {
    let puts_out = || are_own(image) && !image.own_outputs().is_empty();
    FIELDS.contains(&field) && are_there(image) || field == "write_bfm" && puts_out()
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
                "    case {channel}u:\n        *value = (int16_t){};\n        return true;",
                measured(pin)
            );
        }
        text.push_str(&template!("analog.c").replace("/* CASES */\n", &cases));
    }
    let outputs = match are_own(image) {
        true => image.own_outputs(),
        false => Vec::new(),
    };
    if !outputs.is_empty() {
        text.push_str(&put_out(&outputs));
    }
    match (are_there(image), outputs.is_empty()) {
        (true, _) => text.push_str(&modules(image, &outputs)),
        (false, false) => text.push_str(BOARD_OUTPUTS),
        (false, true) => {}
    }
    let count = if text.contains("count(0x") { COUNT } else { "" };
    match text.contains("converted(0x") {
        true => format!("{COUNT}{CONVERTED}{text}"),
        false => format!("{count}{text}"),
    }
}

/// The expression that is the count of an input.
fn measured(pin: &AnalogPin) -> String {
    let (at, full) = (pin.at, pin.full);
    match pin.start {
        Some(start) => format!(
            "converted(0x{:08X}u, 0x{:X}u, 0x{:X}u, 0x{at:08X}u, {full}u)",
            start.at, start.write, start.wait
        ),
        None => format!("count(0x{at:08X}u, {full}u)"),
    }
}

/// Function that sets the board's own outputs.
fn put_out(outputs: &[(u8, AnalogPin)]) -> String {
    let mut cases = String::new();
    for (channel, pin) in outputs {
        // Writing to a String does not fail.
        let _ = writeln!(
            cases,
            "    case {channel}u:\n        REGISTER(0x{:08X}u) = value < 0 ? 0u : value > {full} ? {full}u : (uint32_t)value;\n        return true;",
            pin.at,
            full = pin.full
        );
    }
    PUT_OUT.replace("/* CASES */\n", &cases)
}

/// The modules and what goes between them and the pins.
fn modules(image: &Image, outputs: &[(u8, AnalogPin)]) -> String {
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
            let count = measured(pin);
            format!("(void)rungc_module_connect({channel}, signal_of({count}, {scale}))")
        }));
        give.push_str(&wires(n, &module.outputs, |pin, channel, scale| {
            let signal = format!("rungc_module_signal({channel})");
            format!("REGISTER(0x{:08X}u) = count_of({signal}, {scale})", pin.at)
        }));
    }
    let board = match outputs.is_empty() {
        true => "",
        false => "    if (unit == 0u) {\n        return put_out(address, value);\n    }\n",
    };
    template!("modules.c")
        .replace("/* BOARD */", board)
        .replace("/* UNITS */", units.trim_end_matches(", "))
        .replace("/* NUMBER */", &modules.len().to_string())
        .replace("/* FIT */\n", &fit)
        .replace("/* TAKE */\n", &take)
        .replace("/* GIVE */\n", &give)
}

/// Function that reads a converter.
const COUNT: &str = "/* Result of a conversion. */
static uint32_t count(uint32_t address, uint32_t full)
{
    uint32_t value = REGISTER(address) & 0xFFFFu;
    return value < full ? value : full;
}

";

/// Function that starts a converter, and reads it.
const CONVERTED: &str = "/* Starts a converter, waits and reads it. */
static uint32_t converted(uint32_t start, uint32_t word, uint32_t ready, uint32_t address, uint32_t full)
{
    REGISTER(start) = word;
    while ((REGISTER(start) & ready) == 0u) {
    }
    return count(address, full);
}

";

const PUT_OUT: &str = "/* The board's own analog outputs, by their counts. */
static bool put_out(uint16_t channel, int16_t value)
{
    switch (channel) {
/* CASES */
    default:
        return false;
    }
}

";

/// Unit 0 is the board; there are no others.
const BOARD_OUTPUTS: &str = "\
static bool write_bfm(void *context, uint16_t unit, uint16_t address, int16_t value)
{
    (void)context;
    return unit == 0u && put_out(address, value);
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
