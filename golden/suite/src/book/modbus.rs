//! The page of the addresses at which Modbus masters find devices.

use rungc_rt::Class;
use rungc_rt::comm::modbus::{Area, FX3U, Fill, H1U, H2U, HM, L01S, Limits, Profile};
use std::fmt::Write;

/// Models and the tables that they serve.
const PROFILES: [(&str, &Profile); 5] = [
    ("H2U", &H2U),
    ("H1U", &H1U),
    ("L01S", &L01S),
    ("FX3U and compatible boards", &FX3U),
    ("HM", &HM),
];

/// The page: a table for each model, as the runtime holds it.
pub fn addresses() -> String {
    let mut page = "# Modbus addresses\n\nAddresses as they stand in frames, in hexadecimal digits. X and Y count on in decimal numbers: \
                    X010 is the ninth input. [Modbus](../modbus.md) says the rest.\n"
        .to_owned();
    for (name, profile) in PROFILES {
        let Limits {
            read_bits,
            write_bits,
            read_words,
            write_words,
            diagnosis: _,
        } = profile.limits;
        // Writing to a String cannot fail.
        let _ = write!(
            page,
            "\n## {name}\n\nOne frame reads at most {read_bits} coils or {read_words} registers and writes at most {write_bits} coils or \
             {write_words} registers.\n"
        );
        let tables = [
            ("Coils (01, 05, 0F)", profile.coils),
            ("Inputs (02)", profile.inputs),
            ("Registers (03, 06, 10)", profile.registers),
            ("Input registers (04)", profile.input_registers),
        ];
        for (i, (title, areas)) in tables.iter().enumerate() {
            let same = tables[..i].iter().find(|(_, others)| others == areas);
            if let Some((other, _)) = same {
                let _ = write!(page, "\n### {title}\n\nAs {other}; nothing is written.\n");
                continue;
            }
            let _ = write!(
                page,
                "\n### {title}\n\n| from | to | devices | |\n|---|---|---|---|\n"
            );
            for area in *areas {
                page += &row(area);
            }
        }
    }
    page
}

fn row(area: &Area) -> String {
    let devices = match area.fill {
        Fill::Bits | Fill::Coils | Fill::Words => area.count,
        Fill::Counters => area.count / 2,
        Fill::Packed => area.count * 16,
    };
    let last = area.first + u32::from(devices) - 1;
    let how = match (area.fill, area.class) {
        (Fill::Counters, _) => "two registers each, the low word first",
        (Fill::Packed, _) => "16 to a register, the first in bit 0",
        (Fill::Coils, _) => "coils, not written",
        (Fill::Bits, Class::T | Class::C) => "contacts",
        (Fill::Words, Class::T | Class::C) => "current values",
        _ if !area.writable => "not written",
        _ => "",
    };
    format!(
        "| {:04X} | {:04X} | {}–{} | {how} |\n",
        area.address,
        area.address + (area.count - 1),
        name(area.class, area.first),
        name(area.class, last),
    )
}

/// A device's name: X and Y are numbered in octal.
fn name(class: Class, number: u32) -> String {
    match class {
        Class::X | Class::Y => format!("{class:?}{number:03o}"),
        _ => format!("{class:?}{number}"),
    }
}
