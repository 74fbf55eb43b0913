//! The host program for Linux: scans in real time.

use crate::fields::PrintStorage;
use crate::text;
use rungc_emit::storage::{Field, Storage};
use rungc_ir::Module;
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;
use std::fmt::Write;

/// What stands around the tables of terminals.
const MAIN_C: &str = include_str!("../include/main.c");

/// How a program waits for its next scan that follows the time.
const WAIT_WITH_TIME: &str = "\
for (uint64_t now = microseconds(); now < next && !stopped; now = microseconds()) {
            sleep_until(now + 1000u < next ? now + 1000u : next);
            PROGRAM_tick(plc, (uint32_t)((microseconds() - start) / 1000u));
/* INTERRUPTS */        }";

/// `main.c` for a program.
pub fn main_file(module: &Module) -> String {
    let fields = Storage::new(module);
    let name = &module.name;
    let mut inputs = String::new();
    for (number, statements) in inputs_of(module, &fields) {
        let _ = writeln!(
            inputs,
            "    case {number}:\n{statements}        return true;"
        );
    }
    let mut outputs = String::new();
    // Those that send pulses would be printed all the time.
    let quiet = |number: &u32| module.pulse_outputs.contains(number);
    let terminals_y = terminals(&fields, DeviceClass::Y);
    for (number, _) in terminals_y.iter().filter(|(number, _)| !quiet(number)) {
        let number = *number;
        let label = DeviceClass::Y.number(number).to_string();
        let text = fields
            .comment(DeviceClass::Y, number)
            .map(text::comment)
            .unwrap_or_default();
        let _ = writeln!(
            outputs,
            "    {{{number}, \"{label}\", {}}},",
            text::string_literal(&text)
        );
    }
    let wait = if module.takes_time() {
        WAIT_WITH_TIME
    } else {
        "sleep_until(next);"
    };
    let interrupts = if rungc_emit::events::interrupts(module).is_some() {
        "            PROGRAM_take_interrupts(plc);\n"
    } else {
        ""
    };
    let errors = match module.may_fail() {
        true => rungc_models::plc_errors::PLC_ERRORS,
        false => &[],
    };
    let errors: String = errors
        .iter()
        .map(|error| {
            let title = text::string_literal(error.title);
            format!("    case {}u:\n        return {title};\n", error.code)
        })
        .collect();
    MAIN_C
        .replace("    /* ERRORS */\n", &errors)
        .replace("/* WAIT */", wait)
        .replace("/* INTERRUPTS */", interrupts)
        .replace("    /* INPUTS */\n", &inputs)
        .replace("    /* OUTPUTS */\n", &outputs)
        .replace("PROGRAM", name)
}

/// The input terminals, and the effect of each turning on or off.
fn inputs_of(module: &Module, fields: &Storage) -> BTreeMap<u32, String> {
    let mut inputs: BTreeMap<u32, String> = BTreeMap::new();
    for (number, access) in terminals(fields, DeviceClass::X) {
        inputs.insert(number, format!("        {access} = on;\n"));
    }
    for number in rungc_emit::events::inputs(module) {
        let edge = format!("        {}_input_edge(plc, {number}, on);\n", module.name);
        inputs.entry(number).or_default().push_str(&edge);
    }
    inputs
}

/// The terminals that the program looks at, and the fields that they have.
pub fn terminals(fields: &Storage, class: DeviceClass) -> Vec<(u32, String)> {
    let numbers = fields.of_class(class).iter().flat_map(Field::numbers);
    numbers
        .map(|number| {
            let mut access = String::new();
            fields.access(&mut access, class, number);
            (number, access)
        })
        .collect()
}
