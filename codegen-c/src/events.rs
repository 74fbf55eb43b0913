//! Events outside the scan: the functions that a host calls for them, and the private fields that these use.

use crate::writer::function_name;
use rungc_emit::events::{clocks, edges, edges_only_note, follows_time, interrupts};
use rungc_ir::Module;
use rungc_rt::EdgeKind;
use std::fmt::Write;

/// The statements that forget what happened, when RUN begins.
pub fn forget(module: &Module) -> String {
    let mut out = String::new();
    // Writing to a String does not fail.
    for flag in module.flags.iter().filter(|flag| !flag.retained) {
        let _ = writeln!(out, "    plc->{} = false;", flag.name);
    }
    for (flag, _) in module.periods() {
        let _ = writeln!(
            out,
            "    plc_stopwatch_begin(&plc->{}_since, plc->sys.clock.reading);",
            flag.name
        );
    }
    out
}

/// The statements by which periods begin with the first scan.
pub fn begin_periods(module: &Module) -> String {
    let mut out = String::new();
    for (flag, _) in module.periods() {
        let flag = &flag.name;
        let _ = write!(
            out,
            "        plc_stopwatch_begin(&plc->{flag}_since, now_ms);\n        plc->{flag} = false;\n"
        );
    }
    match out.is_empty() {
        true => out,
        false => format!("    if (plc->sys.scan == 0u) {{\n{out}    }}\n"),
    }
}

/// The statements that clear cells and tables at power-on.
pub(crate) fn clear_cells(module: &Module) -> String {
    let cells = module.cells.iter();
    let cells = cells.map(|cell| format!("    plc->{} = 0;\n", cell.name));
    let tables = module.tables.iter().map(|table| {
        let name = &table.name;
        format!("    (void)memset(plc->{name}, 0, sizeof plc->{name});\n")
    });
    cells.chain(tables).collect()
}

/// Prototypes of the functions that a host calls.
pub fn prototypes(module: &Module) -> String {
    let name = &module.name;
    let when = if edges_only_note(module) {
        "An interrupt handler may call it: it only notes the edge."
    } else {
        "In the main loop, not while a scan runs: it counts or acts at once."
    };
    let mut out = format!(
        "\n/* An input terminal X (a plain number: 8 is X010) turns on or off. {when} */\n\
         void {name}_input_edge({name}_plc *plc, unsigned terminal, bool on);\n"
    );
    if module.takes_time() {
        let when = if module.ticks_only_note() {
            "An interrupt handler may call it: it only notes the\n   time."
        } else {
            "In the main loop, not while a scan runs."
        };
        let _ = write!(
            out,
            "\n/* Advances time: call it each millisecond, so that everything timed is on time; `now_ms` as for {name}_scan. {when} */\n\
             void {name}_tick({name}_plc *plc, uint32_t now_ms);\n"
        );
    }
    if module.sends_pulses() {
        let _ = write!(
            out,
            "\n/* Drives the pins of pulse outputs (rungc_hal.set_output) at `now_us`, microseconds by a clock that may begin anywhere, wrapping;\n   \
             returns after how many of them the next one changes, UINT32_MAX if none does. Call it then, and after each scan, which may begin\n   \
             pulses. One interrupt handler may call it, if rungc_hal.hold_pulses keeps that interrupt from coming; then the main loop holds\n   \
             it, too, while it calls this function, {name}_init, {name}_set_running or {name}_power_cycle, or reads a pulse output. */\n\
             uint32_t {name}_pulse_timer({name}_plc *plc, uint32_t now_us);\n"
        );
    }
    if interrupts(module).is_some() {
        let _ = write!(
            out,
            "\n/* Runs the interrupt routines that are requested. A scan does so in front of each network; call it while waiting for the next,\n   \
             in the main loop. */\n\
             void {name}_take_interrupts({name}_plc *plc);\n"
        );
    }
    out
}

/// The functions that a host calls.
pub fn functions(module: &Module) -> String {
    let name = &module.name;
    let mut out = input_edge(module);
    if module.takes_time() {
        out.push_str(&tick(module));
    }
    if module.sends_pulses() {
        let _ = write!(
            out,
            "uint32_t {name}_pulse_timer({name}_plc *plc, uint32_t now_us)\n{{\n    rungc_map map = {name}_map(plc);\n\n    return rungc_pulse_timer(&map, now_us);\n}}\n\n"
        );
    }
    if let Some(at) = interrupts(module) {
        let mut function = String::new();
        function_name(&mut function, module, at);
        let _ = write!(
            out,
            "void {name}_take_interrupts({name}_plc *plc)\n{{\n    if (plc->sys.running) {{\n        {function}(plc);\n    }}\n}}\n\n"
        );
    }
    out
}

/// The function that counts pulses.
pub fn count_pulses(module: &Module) -> String {
    if !module.sends_pulses() {
        return String::new();
    }
    let name = &module.name;
    let mut out = format!(
        "/* Counts the pulses that have been sent by now, and takes notice of trains that have ended. */\n\
         static void {name}_count_pulses({name}_plc *plc, uint32_t now_us)\n{{\n    rungc_map map = {name}_map(plc);\n\n    rungc_advance_pulses(&map, now_us);\n"
    );
    for flag in &module.flags {
        let place = flag
            .pulses_end
            .map(|output| module.pulse_outputs.binary_search(&output));
        if let Some(Ok(i)) = place {
            let flag = &flag.name;
            let _ = writeln!(
                out,
                "    plc->{flag} = plc_take(&plc->axis[{i}].ended) || plc->{flag};"
            );
        }
    }
    out.push_str("}\n\n");
    out
}

/// The function that brings serial ports up to date.
pub fn advance_ports(module: &Module) -> String {
    if !module.has_ports() {
        return String::new();
    }
    let name = &module.name;
    if let Some(number) = module.slave_alone {
        let family = module.model.ports.name();
        return format!(
            "/* Brings the serial port up to date. */\n\
             static void {name}_advance_ports({name}_plc *plc, uint32_t now_us)\n{{\n    rungc_map map = {name}_map(plc);\n\n    \
             rungc_advance_slave_{family}_{number}(&map, now_us);\n}}\n\n"
        );
    }
    format!(
        "/* Brings the serial ports up to date, and changes over to RUN or STOP if a partner has asked for it. */\n\
         static void {name}_advance_ports({name}_plc *plc, uint32_t now_us)\n{{\n    rungc_map map = {name}_map(plc);\n    \
         const rungc_request request = rungc_advance_ports(&map, now_us);\n\n    \
         if (request != RUNGC_REQUEST_NONE) {{\n        {name}_set_running(plc, request == RUNGC_REQUEST_RUN);\n    }}\n}}\n\n"
    )
}

fn tick(module: &Module) -> String {
    let name = &module.name;
    let mut out = format!("void {name}_tick({name}_plc *plc, uint32_t now_ms)\n{{\n");
    for (flag, ms) in module.periods() {
        let flag = &flag.name;
        let _ = write!(
            out,
            "    if (plc_stopwatch_ends(&plc->{flag}_since, now_ms, {ms}u)) {{\n        plc->{flag} = true;\n    }}\n"
        );
    }
    if !module.ticks_only_note() {
        out.push_str("    plc_pass(&plc->sys, now_ms);\n");
    }
    for cell in clocks(module) {
        let cell = &cell.name;
        let _ = writeln!(out, "    plc->{cell} = plc_int32(plc->sys.clock.elapsed);");
    }
    if module.sends_pulses() {
        let _ = writeln!(out, "    {name}_count_pulses(plc, plc_now_us(&plc->sys));");
    }
    if module.has_ports() {
        let _ = writeln!(out, "    {name}_advance_ports(plc, plc_now_us(&plc->sys));");
    }
    if !follows_time(module) {
        out.push_str("    (void)plc;\n    (void)now_ms;\n");
    }
    out.push_str("}\n\n");
    out
}

fn input_edge(module: &Module) -> String {
    let name = &module.name;
    let mut out =
        format!("void {name}_input_edge({name}_plc *plc, unsigned terminal, bool on)\n{{\n");
    for (at, input, kind) in edges(module) {
        let level = match kind {
            EdgeKind::Rising => "on",
            EdgeKind::Falling => "!on",
        };
        let mut function = String::new();
        function_name(&mut function, module, at);
        let _ = write!(
            out,
            "    if (terminal == {input}u && {level}) {{\n        {function}(plc);\n    }}\n"
        );
    }
    if edges(module).next().is_none() {
        out.push_str("    (void)plc;\n    (void)terminal;\n    (void)on;\n");
    }
    out.push_str("}\n\n");
    out
}
