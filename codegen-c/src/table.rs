//! The tables by which the runtime finds a program's devices.

use crate::fields::PrintField;
use crate::text;
use rungc_emit::areas::{self, Area};
use rungc_emit::cycle;
use rungc_emit::storage::{Kind, Storage};
use rungc_ir::Module;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// The C name of a class.
fn class_name(class: DeviceClass) -> String {
    format!("RUNGC_CLASS_{}", class.prefix())
}

/// The C name of what an area is made of.
fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Bit | Kind::NumericBit => "RUNGC_AREA_KIND_BITS",
        Kind::Word => "RUNGC_AREA_KIND_WORDS",
        Kind::Timer => "RUNGC_AREA_KIND_TIMERS",
        Kind::Counter16 => "RUNGC_AREA_KIND_COUNTERS16",
        Kind::Counter32 => "RUNGC_AREA_KIND_COUNTERS32",
    }
}

/// Writes the tables and the function that binds them to a struct.
pub fn write(out: &mut String, module: &Module, fields: &Storage) {
    let name = &module.name;
    let mut layout = Vec::new();
    tables(out, &mut layout, module, fields);
    layout.push(format!(".sys = offsetof({name}_plc, sys)"));
    if module.may_fail() {
        layout.push(format!(".error = offsetof({name}_plc, error)"));
    }
    if module.states > 0 {
        layout.push(format!(".states = offsetof({name}_plc, state)"));
        layout.push(format!(".state_count = {}", module.states));
    }
    if module.sends_pulses() {
        let outputs: Vec<String> = module.pulse_outputs.iter().map(u32::to_string).collect();
        let _ = writeln!(
            out,
            "/* Outputs Y that send pulses, in the order of `axis`. */\nstatic const uint8_t {name}_pulse_outputs[] = {{{}}};\n",
            outputs.join(", ")
        );
        layout.push(format!(".axes = offsetof({name}_plc, axis)"));
        layout.push(format!(".outputs = {name}_pulse_outputs"));
        layout.push(format!(".output_count = {}", outputs.len()));
        let family = format!("{:?}", module.model.pulses).to_ascii_uppercase();
        layout.push(format!(".pulses = RUNGC_PULSES_{family}"));
    }
    if module.has_ports() {
        ports(out, &mut layout, module);
    }
    if module.model.z_pairs_with_v {
        layout.push(".z_pairs_with_v = true".to_string());
    }
    layout.push(format!(
        ".error_relay = {}",
        module.model.error_relay.number()
    ));
    layout.push(format!(".value_error = {}", module.model.value_error));
    let rules = cycle::error_rules(module, fields);
    if rules.sums_up_ports {
        layout.push(".sums_up_ports = true".to_string());
    }
    if rules.logs {
        layout.push(".logs_errors = true".to_string());
    }
    let on_error = match module.may_fail() {
        true => {
            format!(
                "#ifdef PLC_ON_ERROR\n    .on_error = offsetof({name}_plc, on_error),\n#endif\n"
            )
        }
        false => String::new(),
    };
    // Writing to a String does not fail.
    let _ = write!(
        out,
        "static const rungc_layout {name}_layout = {{\n    {},\n{on_error}}};\n\n\
         rungc_map {name}_map({name}_plc *plc)\n{{\n    \
         const rungc_map map = {{.layout = &{name}_layout, .plc = plc, .hal = plc->hal}};\n    return map;\n}}\n\n",
        layout.join(",\n    ")
    );
}

/// Writes the table of serial ports; the members of the layout that are about them go into `layout`.
fn ports(out: &mut String, layout: &mut Vec<String>, module: &Module) {
    let name = &module.name;
    let family = module.model.ports.name();
    let places = module.serial_ports().map(|(number, protocols)| {
        let length = protocols.longest_frame();
        let progress = protocols.has_progress();
        let keeps = protocols.keeps_memory();
        let wiring = match module.slave_alone {
            Some(_) => "NULL".to_string(),
            None => format!("&rungc_port_{family}_{number}"),
        };
        format!(
            "{{{wiring}, offsetof({name}_plc, com{number}), {length}, {number}, {progress}, {keeps}}}"
        )
    });
    let places: Vec<String> = places.collect();
    // Writing to a String does not fail.
    let what = match module.slave_alone {
        Some(_) => "The serial port.",
        None => "Serial ports, and what they do.",
    };
    let _ = writeln!(
        out,
        "/* {what} */\nstatic const rungc_port_place {name}_ports[] = {{{}}};",
        places.join(", ")
    );
    layout.push(format!(".ports = {name}_ports"));
    layout.push(format!(".port_count = {}", module.ports.len()));
    if let Some(profile) = module.modbus() {
        layout.push(format!(".modbus = &rungc_modbus_{}", profile.name));
    }
    if module.slave_alone.is_none() {
        let codecs = module.codecs();
        let codecs = codecs.map(|codec| format!("&rungc_codec_{}", codec.name()));
        let codecs: Vec<String> = codecs.collect();
        let array = format!("static const rungc_codec *const {name}_codecs[]");
        layout.extend(list(out, &array, ("codecs", "codec"), name, &codecs));
    }
    out.push('\n');
    let family = format!("{:?}", module.model.ports).to_ascii_uppercase();
    layout.push(format!(".port_family = RUNGC_PORTS_{family}"));
    layout.push(format!(".type_code = {}", module.model.type_code()));
}

/// Writes the tables; the members of the layout that name them go into `layout`.
fn tables(out: &mut String, layout: &mut Vec<String>, module: &Module, fields: &Storage) {
    let name = &module.name;
    let areas = areas(name, fields);
    let ranges = areas::ranges(module).into_iter();
    let ranges: Vec<String> = ranges
        .map(|(class, first, last)| format!("{{{}, {first}, {last}}}", class_name(class)))
        .collect();
    let aliases = module.model.index_aliases.iter();
    let aliases: Vec<String> = aliases
        .filter(|alias| fields.find(alias.class, alias.index).is_some())
        .map(|alias| {
            let (number, class) = (alias.register.number(), class_name(alias.class));
            format!("{{{number}, {class}, {}}}", alias.index)
        })
        .collect();
    let texts = module.texts.iter().map(|text| {
        let literal = text::string_literal(text);
        format!("{{(const uint8_t *){literal}, {}}}", text.len())
    });
    let tables = [
        ("areas", "area", "Lookup of devices for the runtime.", areas),
        ("ranges", "range", "Devices that the model has.", ranges),
        (
            "aliases",
            "alias",
            "Special registers that are other names of index registers.",
            aliases,
        ),
        ("texts", "text", "Texts of the program.", texts.collect()),
    ];
    for (member, ty, what, rows) in tables {
        layout.extend(table(out, (member, ty, what), name, &rows));
    }
}

/// Writes one table; returns the members of the layout that name it.
fn table(
    out: &mut String,
    (member, ty, what): (&str, &str, &str),
    name: &str,
    rows: &[String],
) -> Vec<String> {
    if rows.is_empty() {
        return Vec::new();
    }
    let _ = writeln!(
        out,
        "/* {what} */\nstatic const rungc_{ty} {name}_{member}[] = {{"
    );
    for row in rows {
        let _ = writeln!(out, "    {row},");
    }
    out.push_str("};\n\n");
    vec![
        format!(".{member} = {name}_{member}"),
        format!(".{ty}_count = {}", rows.len()),
    ]
}

/// Writes a table in one line; returns the members of the layout that name it. C has no empty arrays.
fn list(
    out: &mut String,
    array: &str,
    (member, entry): (&str, &str),
    name: &str,
    entries: &[String],
) -> Vec<String> {
    if entries.is_empty() {
        return Vec::new();
    }
    // Writing to a String does not fail.
    let _ = writeln!(out, "{array} = {{{}}};", entries.join(", "));
    vec![
        format!(".{member} = {name}_{member}"),
        format!(".{entry}_count = {}", entries.len()),
    ]
}

/// The rows of the areas.
fn areas(name: &str, storage: &Storage) -> Vec<String> {
    let areas = areas::areas(storage).into_iter();
    areas
        .map(|Area { field, count }| {
            let mut member = String::new();
            field.name(&mut member);
            let grid = field.grid.map(|grid| (grid.columns, grid.stored_columns));
            let (columns, stored) = grid.unwrap_or((1, 1));
            format!(
                "{{{}, {}, {}, {count}, {columns}, {stored}, offsetof({name}_plc, {member})}}",
                class_name(field.class),
                kind_name(field.kind),
                field.first,
            )
        })
        .collect()
}
