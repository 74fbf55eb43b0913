//! The C that an engineer would write by hand for a program: a struct of arrays of all devices that the machine has,
//! one assignment for each coil, functions of 200 rungs. It knows nothing of PLCs beyond what the program does, so that
//! does not slow it down: a timer counts milliseconds and knows no current value in its units, arithmetic sets no
//! flags.

use super::driven::Form;
use super::{Action, Chain, Contact, Device, Ladder, Operation, RELAYS, Rung, TERMINALS};
use super::{Kind, compare, control, display, float, index, process, recipe, sequence};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Rungs of a function.
const PART: usize = 200;

/// A header that programs include.
macro_rules! template {
    ($name:literal) => {
        include_str!(concat!("../../templates/hand_", $name, ".h"))
    };
}

/// Headers of a kind, and members of the struct beside bits: for `mixed`, a long at the last register needs one more.
fn parts(ladder: &Ladder) -> (&'static [&'static str], String) {
    let registers = |count: u32| format!(" int16_t D[{count}];");
    match ladder.kind {
        Kind::Contacts | Kind::Stations => (&[], String::new()),
        Kind::Mixed => {
            let edges = ladder.rungs.iter().filter(|r| has_edge(&r.action)).count();
            let timers = "struct timer T[200]; struct counter C[100];";
            let members = format!(" {timers}{} bool edge[{}];", registers(201), edges.max(1));
            (&[template!("words"), template!("mixed")], members)
        }
        Kind::Process => (&[template!("process")], registers(process::REGISTERS)),
        Kind::Control => {
            let loops = format!(" union loop loop[{}];", control::LOOPS);
            let members = registers(control::REGISTERS) + &loops;
            (&[template!("limits"), template!("control")], members)
        }
        Kind::Sequence => {
            let count = ladder.sequences.len();
            let members = format!(" bool stopped; struct sequence sequence[{count}];");
            (&[template!("words"), template!("sequence")], members)
        }
        Kind::Index => (&[template!("words")], registers(index::REGISTERS)),
        Kind::Recipe => (&[template!("process")], registers(recipe::REGISTERS)),
        Kind::Display => (&[template!("display")], registers(display::REGISTERS)),
        Kind::Compare => (&[template!("words")], registers(compare::REGISTERS)),
        Kind::Float => {
            let headers: &[&str] = &[template!("process"), template!("limits")];
            (headers, registers(float::REGISTERS))
        }
    }
}

/// The header of a program written by hand: `struct plc` and `void PREFIX_scan(struct plc *p)`, in programs that
/// [take the time](takes_time) also with the milliseconds since the last scan, in `control` also
/// `void PREFIX_init(struct plc *p)`.
pub fn header(ladder: &Ladder, prefix: &str) -> String {
    let mut out = String::from("#include <stdbool.h>\n#include <stdint.h>\n#include <string.h>\n");
    let (headers, members) = parts(ladder);
    out.extend(headers.iter().copied());
    // Writing to a String does not fail.
    if has_init(ladder) {
        let _ = writeln!(out, "struct plc;\nvoid {prefix}_init(struct plc *p);");
    }
    let devices = format!("bool X[{TERMINALS}], Y[{TERMINALS}], M[{RELAYS}];{members}");
    let _ = writeln!(out, "struct plc {{ {devices} }};");
    let _ = writeln!(out, "void {prefix}_scan(struct plc *p{});", time(ladder).0);
    out
}

/// The program, to be compiled with its header included.
pub fn source(ladder: &Ladder, prefix: &str) -> String {
    let (parameter, argument) = time(ladder);
    let mut out = String::new();
    if ladder.kind == Kind::Sequence {
        sequence::hand(&ladder.sequences, prefix, &mut out);
        return out;
    }
    let mut edges = 0;
    let is_settings = |rung: &&Rung| matches!(rung.action, Action::Control(c) if c.is_settings());
    let (settings, rungs): (Vec<&Rung>, Vec<&Rung>) = ladder.rungs.iter().partition(is_settings);
    if has_init(ladder) {
        let _ = writeln!(
            out,
            "void {prefix}_init(struct plc *p) {{\n  memset(p, 0, sizeof *p);"
        );
        for rung in settings {
            let _ = writeln!(out, "  {}", statement(rung, edges));
        }
        out.push_str("}\n");
    }
    for (i, rungs) in rungs.chunks(PART).enumerate() {
        let _ = writeln!(out, "static void part{i}(struct plc *p{parameter}) {{");
        if takes_time(ladder) {
            out.push_str("  (void)dt;\n");
        }
        for rung in rungs {
            let text = statement(rung, edges);
            let _ = writeln!(out, "  {text}");
            edges += u32::from(has_edge(&rung.action));
        }
        out.push_str("}\n");
    }
    let _ = writeln!(out, "void {prefix}_scan(struct plc *p{parameter}) {{");
    for i in 0..rungs.chunks(PART).len() {
        let _ = writeln!(out, "  part{i}(p{argument});");
    }
    out.push_str("}\n");
    out
}

/// Returns true if a scan takes the time: there are timers.
pub fn takes_time(ladder: &Ladder) -> bool {
    matches!(ladder.kind, Kind::Mixed | Kind::Control | Kind::Sequence)
}

/// Returns true if there is a function that makes a controller ready; without, its memory is cleared.
pub fn has_init(ladder: &Ladder) -> bool {
    ladder.kind == Kind::Control
}

/// Parameter and argument for the time since the last scan.
fn time(ladder: &Ladder) -> (&'static str, &'static str) {
    match takes_time(ladder) {
        true => (", uint32_t dt", ", dt"),
        false => ("", ""),
    }
}

/// Location of a device in the struct.
pub fn place((class, number): Device) -> String {
    match class {
        DeviceClass::D => control::place(number),
        _ => format!("{}[{number}]", class.prefix()),
    }
}

fn has_edge(action: &Action) -> bool {
    matches!(action, Action::MoveOnce(..) | Action::IncrementOnce(_))
}

/// A contact as an expression.
pub fn contact(contact: &Contact) -> String {
    let not = if contact.negated { "!" } else { "" };
    format!("{not}p->{}", place(contact.device))
}

fn chain(chain: &Chain) -> String {
    let first = contact(&chain.first);
    chain.rest.iter().fold(first, |text, (next, parallel)| {
        let operator = if *parallel { '|' } else { '&' };
        format!("({text} {operator} {})", contact(next))
    })
}

fn statement(rung: &Rung, edge: u32) -> String {
    let first = chain(&rung.chain);
    let on = match &rung.block {
        None => first,
        Some((block, parallel)) => {
            let operator = if *parallel { '|' } else { '&' };
            format!("({first} {operator} {})", chain(block))
        }
    };
    match rung.action {
        Action::Driven(ref driven, coil) => {
            let (what, after) = (&driven.hand, &driven.after);
            match (driven.form, coil) {
                (Form::Contacts, Some(coil)) => {
                    format!("p->{} = {on} && {what};", place(coil))
                }
                (Form::Always, _) => format!("{{ {what} }}"),
                _ => format!("if ({on}) {{ {what} }} {after}"),
            }
        }
        Action::Coil(device) => format!("p->{} = {on};", place(device)),
        Action::Timer(n, preset) => {
            format!("timer_run(&p->T[{n}], {on}, {}, dt);", preset * 100)
        }
        Action::Counter(n, preset) => format!("counter_run(&p->C[{n}], {on}, {preset});"),
        Action::Constant(value, to) => format!("if ({on}) p->D[{to}] = {value};"),
        Action::MoveOnce(from, to) => {
            format!("if (rising(&p->edge[{edge}], {on})) p->D[{to}] = p->D[{from}];")
        }
        Action::IncrementOnce(n) => {
            format!("if (rising(&p->edge[{edge}], {on})) p->D[{n}] = (int16_t)(p->D[{n}] + 1);")
        }
        Action::Compare(d, value, m) => {
            let (greater, less) = (m, m + 2);
            let equal = m + 1;
            format!(
                "if ({on}) {{ p->M[{greater}] = p->D[{d}] > {value}; p->M[{equal}] = p->D[{d}] == {value}; \
                 p->M[{less}] = p->D[{d}] < {value}; }}"
            )
        }
        Action::Arithmetic(operation, registers) => arithmetic(&on, operation, registers),
        Action::Set(n) => format!("if ({on}) p->M[{n}] = true;"),
        Action::Reset(n) => format!("if ({on}) p->M[{n}] = false;"),
        Action::Process(process) => process.hand(&on),
        Action::Control(control) => control.hand(),
    }
}

fn arithmetic(on: &str, operation: Operation, [a, b, to]: [u32; 3]) -> String {
    let operator = match operation {
        Operation::Add => '+',
        Operation::Sub => '-',
        Operation::And => '&',
        Operation::AddLong => {
            return format!(
                "if ({on}) put_long(&p->D[{to}], get_long(&p->D[{a}]) + get_long(&p->D[{b}]));"
            );
        }
    };
    format!("if ({on}) p->D[{to}] = (int16_t)(p->D[{a}] {operator} p->D[{b}]);")
}
