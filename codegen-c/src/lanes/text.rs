//! `NAME_lanes.h` and the functions of a program in lanes.

use super::classify::Classes;
use super::mirror::sliced;
use super::slice::Slicer;
use crate::fields::{PrintField, PrintStorage};
use crate::writer::Writer;
use rungc_emit::plan::Plan;
use rungc_emit::storage::{Field, Kind, Storage};
use rungc_ir::Module;
use std::fmt::Write;

/// Frame of the struct in the header.
const HEADER: &str = "\
#ifndef GUARD
#define GUARD

#include \"NAME.h\"
#include \"rungc_lanes.h\"

#ifdef __cplusplus
extern \"C\" {
#endif

/* PLC_LANES instances of the program that scan together. A bit device has one bit for each instance; write inputs and
   read outputs here. Words, and the values of timers and counters, are in the structs of the instances, whose own bits
   mean nothing. A timer whose value the program does not look at is not updated in each scan: NAME_lanes_settle does it. */
typedef struct NAME_lanes {
FIELDS    plc_sys sys;
    NAME_plc lane[PLC_LANES]; /* words, timers and counters of each instance */
} NAME_lanes;

/* Power on: all instances in RUN, before their first scan. */
void NAME_lanes_init(NAME_lanes *all);

/* One scan of all instances. `now_ms`: milliseconds since power-on, wrapping; `scan_us`: how long the last scan took. */
void NAME_lanes_scan(NAME_lanes *all, uint32_t now_ms, uint32_t scan_us);

/* Brings the values of all timers up to date. */
void NAME_lanes_settle(NAME_lanes *all);

/* Gives an instance the state of `plc`, which has been scanned as often and at the same times as all instances. */
void NAME_lanes_load(NAME_lanes *all, unsigned lane, const NAME_plc *plc);

/* The state of an instance, with its bits. */
void NAME_lanes_store(const NAME_lanes *all, unsigned lane, NAME_plc *plc);

#ifdef __cplusplus
}
#endif

#endif
";

/// The text of `NAME_lanes.h`, without its first line.
pub fn header(module: &Module) -> String {
    let fields = Storage::new(module);
    let mut members = String::new();
    for field in sliced(&fields) {
        let mut name = String::new();
        field.name(&mut name);
        let extents = extents(field);
        // Writing to a String does not fail, here and below.
        let _ = writeln!(members, "    plc_lanes {name}{extents};");
        if field.kind.has_members() {
            let _ = writeln!(members, "    plc_lanes {name}_coil{extents};");
        }
        if field.kind == Kind::Timer {
            let _ = writeln!(members, "    uint32_t {name}_passed{extents};");
            let _ = writeln!(members, "    uint32_t {name}_left{extents};");
        }
    }
    if module.edges > 0 {
        let _ = writeln!(members, "    plc_lanes edge[{}];", module.edges);
    }
    for flag in &module.flags {
        let _ = writeln!(members, "    plc_lanes {};", flag.name);
    }
    let guard = format!("{}_LANES_H", module.name.to_ascii_uppercase());
    HEADER
        .replace("GUARD", &guard)
        .replace("FIELDS", &members)
        .replace("NAME", &module.name)
}

fn extents(field: &Field) -> String {
    if field.array {
        field.extents()
    } else {
        String::new()
    }
}

/// The functions, which follow those of one instance.
pub fn source(module: &Module, plan: &Plan, fields: &Storage) -> String {
    let classes = Classes::of(module, plan, fields);
    let mut slicer = Slicer::new(classes, Writer::new(module, plan, fields));
    let mut functions = String::new();
    for index in 0..plan.functions.len() {
        let cyclic = plan.functions[index].root < 3;
        if cyclic {
            slicer.function(&mut functions, index);
        }
    }
    let mut out = format!("#include \"{}_lanes.h\"\n\n", module.name);
    out.push_str(&functions);
    let name = &module.name;
    let _ = write!(
        out,
        "void {name}_lanes_settle({name}_lanes *all)\n{{\n{}}}\n\n\
         void {name}_lanes_load({name}_lanes *all, unsigned lane, const {name}_plc *plc)\n{{\n    {name}_lanes_settle(all);\n{}}}\n\n\
         void {name}_lanes_store(const {name}_lanes *all, unsigned lane, {name}_plc *plc)\n{{\n{}}}\n\n",
        settle(name, &slicer),
        load(module, fields),
        store(module, fields, &slicer),
    );
    let _ = write!(
        out,
        "void {name}_lanes_init({name}_lanes *all)\n{{\n    {name}_plc plc;\n\n    {name}_init(&plc);\n    (void)memset(all, 0, sizeof *all);\n    all->sys = plc.sys;\n    \
         for (unsigned l = 0; l < PLC_LANES; l++) {{\n        {name}_lanes_load(all, l, &plc);\n    }}\n}}\n\n"
    );
    let each = |line: &str| match slicer.singles {
        true => {
            format!("    for (unsigned l = 0; l < PLC_LANES; l++) {{\n        {line}\n    }}\n")
        }
        false => String::new(),
    };
    let (before, after) = (
        each("all->lane[l].sys = all->sys;"),
        each("all->lane[l].sys.first_scan = false;"),
    );
    let mut calls = String::new();
    for root in 0..3 {
        let whole = (0..plan.functions.len())
            .find(|&f| plan.functions[f].root == root && plan.functions[f].is_whole());
        if let Some(whole) = whole {
            let _ = writeln!(calls, "    {}(all);", slicer.function_name(whole));
        }
    }
    let _ = write!(
        out,
        "void {name}_lanes_scan({name}_lanes *all, uint32_t now_ms, uint32_t scan_us)\n{{\n    \
         plc_begin_scan(&all->sys, now_ms, scan_us);\n{before}{calls}    all->sys.first_scan = false;\n{after}}}\n"
    );
    out
}

/// Every stored bit: its expression in the struct of one instance.
fn members(module: &Module, fields: &Storage) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for field in sliced(fields) {
        for number in field.numbers() {
            let mut name = String::new();
            if !fields.access(&mut name, field.class, number) {
                continue;
            }
            let lanes = super::mirror::in_lanes(&name);
            if field.kind.has_members() {
                let coil = super::mirror::coil(fields, field.class, number).unwrap_or_default();
                let on = if field.kind == Kind::Timer {
                    " != 0u"
                } else {
                    ""
                };
                all.push((lanes, format!("{name}.done")));
                all.push((coil, format!("{name}.coil{on}")));
            } else {
                all.push((lanes, name));
            }
        }
    }
    for edge in 0..module.edges {
        all.push((format!("all->edge[{edge}]"), format!("plc->edge[{edge}]")));
    }
    for flag in &module.flags {
        all.push((format!("all->{}", flag.name), format!("plc->{}", flag.name)));
    }
    all
}

fn load(module: &Module, fields: &Storage) -> String {
    let mut out = String::from("    all->lane[lane] = *plc;\n");
    for (lanes, single) in members(module, fields) {
        let _ = writeln!(out, "    plc_put_lane(&{lanes}, lane, {single});");
    }
    out
}

/// Code that brings the values of waiting timers up to date.
fn settle(name: &str, slicer: &Slicer) -> String {
    if slicer.waiting.is_empty() {
        return "    (void)all;\n".to_string();
    }
    let timers = slicer.waiting.values().map(|timer| timer.settle(name));
    let timers: String = timers.collect();
    format!("    plc_sys sys = all->sys;\n\n{timers}")
}

fn store(module: &Module, fields: &Storage, slicer: &Slicer) -> String {
    let mut out = String::from("    *plc = all->lane[lane];\n    plc->sys = all->sys;\n");
    for (lanes, single) in members(module, fields) {
        // Coils and contacts of timers and counters are in the struct, too.
        if single.contains(".coil") || single.ends_with(".done") {
            continue;
        }
        let _ = writeln!(out, "    {single} = plc_in_lane({lanes}, lane);");
    }
    slicer
        .waiting
        .values()
        .for_each(|timer| out.push_str(&timer.store()));
    out
}
