//! The host program for Linux: scans in real time.

use crate::fields::Fields;
use crate::text;
use rungc_ir::Module;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// What stands around the tables of terminals.
const MAIN_C: &str = include_str!("../include/main.c");

/// `main.c` for a program.
pub fn main_file(module: &Module) -> String {
    let fields = Fields::new(module);
    let name = &module.name;
    let mut inputs = String::new();
    for (number, access) in terminals(&fields, DeviceClass::X) {
        let _ = writeln!(
            inputs,
            "    case {number}:\n        {access} = on;\n        return true;"
        );
    }
    let mut outputs = String::new();
    for (number, _) in terminals(&fields, DeviceClass::Y) {
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
    MAIN_C
        .replace("    /* INPUTS */\n", &inputs)
        .replace("    /* OUTPUTS */\n", &outputs)
        .replace("PROGRAM", name)
}

fn terminals(fields: &Fields, class: DeviceClass) -> Vec<(u32, String)> {
    let numbers = fields.of_class(class).iter().flat_map(|f| f.first..f.end());
    numbers
        .map(|number| {
            let mut access = String::new();
            fields.access(&mut access, class, number);
            (number, access)
        })
        .collect()
}
