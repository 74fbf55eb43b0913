//! What happens outside the scan: flags that a host's interrupts set, and the functions that it calls for that.

use crate::writer::function_name;
use rungc_ir::Module;
use rungc_ir::node::{EdgeKind, Flag, FunctionKind, Source};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Whether a program takes notice of what happens outside its scan.
pub fn has_events(module: &Module) -> bool {
    !module.flags.is_empty()
}

/// The flags with a period, and their periods in milliseconds.
fn periods(module: &Module) -> impl Iterator<Item = (&Flag, u32)> {
    module.flags.iter().filter_map(|flag| match flag.source {
        Some(Source::Period { ms }) => Some((flag, ms)),
        _ => None,
    })
}

/// The input terminals whose edges a program takes notice of, each once.
pub fn inputs(module: &Module) -> BTreeSet<u32> {
    let number = |flag: &Flag| match flag.source {
        Some(Source::Input { number, .. }) => Some(number),
        _ => None,
    };
    module.flags.iter().filter_map(number).collect()
}

/// Whether some flag is set each time a period has passed.
pub fn has_periods(module: &Module) -> bool {
    periods(module).next().is_some()
}

/// The fields of the flags: declaration, comment, size in bytes.
pub fn fields(module: &Module) -> Vec<(String, String, u32)> {
    let name = &module.name;
    let flags = module.flags.iter().map(|flag| {
        let (volatile, comment) = match flag.source {
            Some(Source::Input { .. }) => ("volatile ", format!("set by {name}_input_edge")),
            Some(Source::Period { .. }) => ("volatile ", format!("set by {name}_tick")),
            None => ("", "EI was executed".to_string()),
        };
        (format!("{volatile}bool {};", flag.name), comment, 1)
    });
    let since = periods(module).map(|(flag, _)| {
        let comment = "when this period began".to_string();
        (format!("uint32_t {}_since;", flag.name), comment, 4)
    });
    flags.chain(since).collect()
}

/// The statements that forget what happened, when RUN begins.
pub fn forget(module: &Module) -> String {
    let mut out = String::new();
    // Writing to a String does not fail.
    for flag in &module.flags {
        let _ = writeln!(out, "    plc->{} = false;", flag.name);
    }
    for (flag, _) in periods(module) {
        let _ = writeln!(out, "    plc->{}_since = plc->sys.now_ms;", flag.name);
    }
    out
}

/// Prototypes of the functions that a host calls.
pub fn prototypes(module: &Module) -> String {
    let name = &module.name;
    format!(
        "\n/* An input terminal X (a plain number: 8 is X010) goes on or off. Safe in an interrupt handler: it only notes the edge. */\n\
         void {name}_input_edge({name}_plc *plc, unsigned terminal, bool on);\n\n\
         /* Time goes on: call it each millisecond, in an interrupt handler or the main loop, for timer interrupts to be on time. */\n\
         void {name}_tick({name}_plc *plc, uint32_t now_ms);\n\n\
         /* Runs the interrupt routines that are requested. A scan does so in front of each network; call it while waiting for the next. */\n\
         void {name}_take_interrupts({name}_plc *plc);\n"
    )
}

/// The functions that a host calls.
pub fn functions(module: &Module) -> String {
    let name = &module.name;
    let mut out = input_edge(module);
    let _ = write!(
        out,
        "void {name}_tick({name}_plc *plc, uint32_t now_ms)\n{{\n"
    );
    for (flag, ms) in periods(module) {
        let flag = &flag.name;
        let _ = write!(
            out,
            "    if (now_ms - plc->{flag}_since >= {ms}u) {{\n        plc->{flag}_since += {ms}u;\n        plc->{flag} = true;\n    }}\n"
        );
    }
    if !has_periods(module) {
        out.push_str("    (void)plc;\n    (void)now_ms;\n");
    }
    let mut function = String::new();
    let kinds = module.functions.iter().map(|f| &f.kind);
    if let Some(at) = kinds
        .into_iter()
        .position(|kind| *kind == FunctionKind::TakeInterrupts)
    {
        function_name(&mut function, module, at);
    }
    let _ = write!(
        out,
        "}}\n\nvoid {name}_take_interrupts({name}_plc *plc)\n{{\n    if (plc->sys.running) {{\n        {function}(plc);\n    }}\n}}\n\n"
    );
    out
}

fn input_edge(module: &Module) -> String {
    let name = &module.name;
    let mut out =
        format!("void {name}_input_edge({name}_plc *plc, unsigned terminal, bool on)\n{{\n");
    let inputs: Vec<_> = module
        .flags
        .iter()
        .filter_map(|flag| match flag.source {
            Some(Source::Input { number, kind }) => Some((&flag.name, number, kind)),
            _ => None,
        })
        .collect();
    for &(flag, number, kind) in &inputs {
        let level = match kind {
            EdgeKind::Rising => "on",
            EdgeKind::Falling => "!on",
        };
        let _ = write!(
            out,
            "    if (terminal == {number}u && {level}) {{\n        plc->{flag} = true;\n    }}\n"
        );
    }
    if inputs.is_empty() {
        out.push_str("    (void)plc;\n    (void)terminal;\n    (void)on;\n");
    }
    out.push_str("}\n\n");
    out
}
