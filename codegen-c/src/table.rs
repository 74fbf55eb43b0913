//! The tables by which the runtime finds a program's devices.

use crate::fields::PrintField;
use crate::text;
use rungc_emit::storage::{Field, Kind, Storage};
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

/// The runtime's order of classes, in which it searches: as the values of its enum.
fn rank(class: DeviceClass) -> usize {
    use DeviceClass::*;
    [X, Y, M, S, T, C, D, R, V, Z, ER]
        .iter()
        .position(|&c| c == class)
        .unwrap_or(usize::MAX)
}

/// Writes the tables and the function that binds them to a struct.
pub fn write(out: &mut String, module: &Module, fields: &Storage) {
    let name = &module.name;
    let mut layout = Vec::new();
    let areas = areas(name, fields);
    layout.extend(table(
        out,
        ("areas", "area", "Where the runtime finds the devices."),
        name,
        &areas,
    ));
    let ranges = ranges(module);
    layout.extend(table(
        out,
        ("ranges", "range", "Devices that the model has."),
        name,
        &ranges,
    ));
    let aliases: Vec<String> = module
        .model
        .index_aliases
        .iter()
        .filter(|(_, class, index)| fields.find(*class, *index).is_some())
        .map(|(number, class, index)| format!("{{{number}, {}, {index}}}", class_name(*class)))
        .collect();
    layout.extend(table(
        out,
        (
            "aliases",
            "alias",
            "Special registers that are other names of index registers.",
        ),
        name,
        &aliases,
    ));
    let texts: Vec<String> = module
        .texts
        .iter()
        .map(|text| {
            format!(
                "{{(const uint8_t *){}, {}}}",
                text::string_literal(text),
                text.len()
            )
        })
        .collect();
    layout.extend(table(
        out,
        ("texts", "text", "Texts of the program."),
        name,
        &texts,
    ));

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
        let numbers: Vec<String> = module.ports.iter().map(u8::to_string).collect();
        let _ = writeln!(
            out,
            "/* Serial ports, in the order of `port`. */\nstatic const uint8_t {name}_port_numbers[] = {{{}}};\n",
            numbers.join(", ")
        );
        layout.push(format!(".ports = offsetof({name}_plc, port)"));
        layout.push(format!(".port_numbers = {name}_port_numbers"));
        layout.push(format!(".port_count = {}", numbers.len()));
        let family = format!("{:?}", module.model.ports).to_ascii_uppercase();
        layout.push(format!(".port_family = RUNGC_PORTS_{family}"));
        layout.push(format!(".type_code = {}", module.model.type_code()));
    }
    if module.model.z_pairs_with_v {
        layout.push(".z_pairs_with_v = true".to_string());
    }
    layout.push(format!(
        ".error_relay = {}",
        module.model.error_relay.number()
    ));
    layout.push(format!(".value_error = {}", module.model.value_error));
    // Writing to a String does not fail.
    let _ = write!(
        out,
        "static const rungc_layout {name}_layout = {{\n    {},\n}};\n\n\
         rungc_map {name}_map({name}_plc *plc)\n{{\n    \
         const rungc_map map = {{.layout = &{name}_layout, .plc = plc, .hal = plc->hal}};\n    return map;\n}}\n\n",
        layout.join(",\n    ")
    );
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

/// Areas: arrays, and relays or words of consecutive numbers that stand side by side.
fn areas(name: &str, fields: &Storage) -> Vec<String> {
    let mut order: Vec<(usize, &Field)> = fields.in_sections().into_iter().enumerate().collect();
    order.sort_by_key(|(_, f)| (rank(f.class), f.first));
    let mut rows: Vec<(usize, &Field, u32)> = Vec::new();
    for (place, field) in order {
        match rows.last_mut() {
            // Elements of one type that follow each other in the struct have no gap between them.
            Some((last, first, count))
                if *last + 1 == place
                    && first.class == field.class
                    && first.kind == field.kind
                    && first.grid.is_none()
                    && field.grid.is_none()
                    && first.first + *count == field.first =>
            {
                *last = place;
                *count += field.count;
            }
            _ => rows.push((place, field, field.count)),
        }
    }
    rows.iter()
        .map(|(_, field, count)| {
            let mut member = String::new();
            field.name(&mut member);
            let (columns, kept) = field
                .grid
                .map_or((1, 1), |grid| (grid.columns, grid.stored_columns));
            format!(
                "{{{}, {}, {}, {count}, {columns}, {kept}, offsetof({name}_plc, {member})}}",
                class_name(field.class),
                kind_name(field.kind),
                field.first,
            )
        })
        .collect()
}

/// The model's devices, neighbouring ranges joined.
fn ranges(module: &Module) -> Vec<String> {
    let mut joined: Vec<(DeviceClass, u32, u32)> = Vec::new();
    let devices = module
        .model
        .ranges
        .iter()
        .filter(|r| rank(r.class) != usize::MAX);
    let mut sorted: Vec<_> = devices.collect();
    sorted.sort_by_key(|r| (rank(r.class), r.first));
    for range in sorted {
        match joined.last_mut() {
            Some((class, _, last)) if *class == range.class && *last + 1 == range.first => {
                *last = range.last
            }
            _ => joined.push((range.class, range.first, range.last)),
        }
    }
    joined
        .iter()
        .map(|(class, first, last)| format!("{{{}, {first}, {last}}}", class_name(*class)))
        .collect()
}
