//! Interrupt routines that can never run: nothing requests them, or nothing allows them.

use super::Code;
use super::overlaps::clears;
use super::pointers::Pointers;
use super::ports::may_be_written;
use crate::accesses::Access;
use crate::resolve::suggest::any_of;
use rungc_catalogue::Basic;
use rungc_models::interrupts::{Capture, Gate, Source};
use rungc_rt::{EdgeKind, Register, Relay};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Phrase, codes, phrase};

/// Programs that reach special devices through an index stay this near.
const USUAL_INDEX: u32 = 256;

/// Warns of interrupt routines that can never run. A program without EI has another warning.
pub(super) fn check(code: &Code, pointers: &Pointers, out: &mut Diagnostics) {
    let enabled = (0..code.len).any(|i| code.basic(i) == Some(Basic::Ei));
    if !enabled || !code.is_understood() {
        return;
    }
    for (device, pointer) in pointers.iter() {
        let Some(&label) = pointer.labels.first() else {
            continue;
        };
        // Comparisons of counters name the pointer.
        let named = !pointer.others.is_empty() || pointers.any_may_be_meant();
        let reason = (device.class == DeviceClass::I).then(|| reason(code, device.number, named));
        let Some(reason) = reason.flatten() else {
            continue;
        };
        let mut diagnostic = codes::NEVER_REQUESTED
            .at(
                code.span(label),
                phrase!("`{device}` never runs: {why}", device, why = reason.why),
            )
            .label("this interrupt routine")
            .help(reason.help);
        for (i, note) in reason.writes {
            diagnostic = diagnostic.other(code.span(i), note);
        }
        out.push(diagnostic);
    }
}

/// Reason for which a routine never runs.
struct Reason {
    /// The second half of the message.
    why: Phrase,
    help: Phrase,
    /// What the program writes instead, and where.
    writes: Vec<(usize, Phrase)>,
}

impl Reason {
    fn new(why: Phrase, help: Phrase) -> Self {
        let writes = Vec::new();
        Reason { why, help, writes }
    }
}

/// The reason for which the routine of pointer I`number` never runs, if that is certain.
fn reason(code: &Code, number: u32, named: bool) -> Option<Reason> {
    let interrupts = &code.model().interrupts;
    let (source, request, gate) = match interrupts.find(number) {
        Some(known) => (known.source, known.request, known.gate),
        None => {
            let advanced = interrupts.find_advanced(number)?;
            (None, Some(advanced.request), Gate::Forbids(advanced.mask))
        }
    };
    if let Some(reason) = forbidden(code, gate) {
        return Some(reason);
    }
    // A program may do without the source.
    if named || request.is_some_and(|relay| may_switch(code, relay, true)) {
        return None;
    }
    match source {
        None => request.map(|relay| {
            Reason::new(
                phrase!(
                    "nothing switches `M{number}` on, which requests it",
                    number = relay.number()
                ),
                phrase!(
                    "add `SET M{number}` where it should run",
                    number = relay.number()
                ),
            )
        }),
        Some(Source::Comparison { .. }) => Some(Reason::new(
            phrase!("no comparison of a high-speed counter names it"),
            phrase!(
                "name it as the target of one, as in `DHSCS K100 C235 {pointer}`",
                pointer = format!("I{number:03}")
            ),
        )),
        Some(Source::Input { number, kind }) => excluded(code, number, kind),
        _ => None,
    }
}

/// The reason for which the relay of a routine always forbids it.
fn forbidden(code: &Code, gate: Gate) -> Option<Reason> {
    let default = |relay: Relay| {
        let row = code.model().special(DeviceClass::M, relay.number());
        row.is_some_and(|row| row.default != 0)
    };
    match gate {
        Gate::Forbids(relay) if default(relay) && !may_switch(code, relay, false) => {
            let mask = relay.number();
            Some(Reason::new(
                phrase!("`M{mask}`, which is on at power-on, forbids it", mask),
                phrase!(
                    "add `RST M{mask}` where it may run, for example under M8002",
                    mask
                ),
            ))
        }
        Gate::Allows(relay) if !default(relay) && !may_switch(code, relay, true) => {
            let relay = relay.number();
            Some(Reason::new(
                phrase!("nothing switches `M{relay}` on, which allows it", relay),
                phrase!(
                    "add `SET M{relay}` where it may run, for example under M8002",
                    relay
                ),
            ))
        }
        _ => None,
    }
}

/// The reason for which no such edge of an input requests an interrupt: the register that selects edges.
fn excluded(code: &Code, input: u32, kind: EdgeKind) -> Option<Reason> {
    let mut captures = code.model().interrupts.captures.iter();
    let capture = captures.find(|capture| capture.inputs.contains(&input))?;
    let register = capture.register;
    if may_be_written(code) || is_written_outside(code, d(register)) || indexed(code, d(register)) {
        return None;
    }
    let settings = code.facts().settings(register)?;
    let lets = |value: u16| lets(capture, input, kind, value);
    if settings.iter().any(|&(value, _)| lets(value)) {
        return None;
    }
    let edge = match kind {
        EdgeKind::Rising => phrase!("rising"),
        EdgeKind::Falling => phrase!("falling"),
    };
    let input = DeviceClass::X.number(input);
    let n = register.number();
    let power_on = settings.iter().find(|(_, writer)| writer.is_none());
    let left = power_on.map(|(value, _)| {
        phrase!(
            ", which is H{value} at power-on,",
            value = format!("{value:02X}")
        )
    });
    let values: Vec<_> = capture.modes().filter(|&value| lets(value)).collect();
    let values: Vec<_> = values.iter().map(|value| format!("H{value:02X}")).collect();
    let writes = settings.iter().filter_map(|&(value, writer)| {
        let note = phrase!(
            "`D{n}` becomes H{value} here",
            n,
            value = format!("{value:02X}")
        );
        Some((writer?, note))
    });
    Some(Reason {
        why: phrase!(
            "`D{n}`{left} excludes the {edge} edge of `{input}`",
            n,
            left = left.unwrap_or_default(),
            edge,
            input
        ),
        help: phrase!(
            "write {values} to `D{n}` in the first scan",
            values = any_of(&values),
            n
        ),
        writes: writes.collect(),
    })
}

/// Returns true if an edge interrupts with a value of its register.
fn lets(capture: &Capture, input: u32, kind: EdgeKind, value: u16) -> bool {
    let demands = capture.demands(input, kind);
    demands.is_some_and(|(mask, wanted)| i32::from(value) & mask == wanted)
}

/// Returns true if the program, or something outside it, may switch a relay on, or off.
fn may_switch(code: &Code, relay: Relay, on: bool) -> bool {
    let device = Device {
        class: DeviceClass::M,
        number: relay.number(),
    };
    let switches = |i: usize| match on {
        true => !clears(code, i),
        false => code.basic(i) != Some(Basic::Set),
    };
    let mut writers = (0..code.len).filter(|&i| switches(i));
    is_written_outside(code, device)
        || writers.any(|i| {
            code.accesses(i)
                .any(|access| access.writes() && may_meet(&access, device))
        })
}

/// Returns true if an access may be one to a device; an index stays near.
fn may_meet(access: &Access, device: Device) -> bool {
    let first = access.first;
    if first.class != device.class {
        return false;
    }
    match access.count {
        Some(_) if !access.indexed => access.devices().contains(&device),
        _ => first.number.abs_diff(device.number) <= USUAL_INDEX,
    }
}

/// Returns true if the program writes a register through an index, perhaps.
fn indexed(code: &Code, device: Device) -> bool {
    let mut accesses = (0..code.len).flat_map(|i| code.accesses(i));
    accesses.any(|access| {
        let open = access.indexed || access.count.is_none();
        open && access.writes() && may_meet(&access, device)
    })
}

/// Returns true if the settings of the project say that something else writes a device.
fn is_written_outside(code: &Code, device: Device) -> bool {
    let parameters = code.resolved.program.parameters.as_ref();
    let runs = parameters.map_or(&[][..], |known| &known.written_externally);
    let mut runs = runs.iter().filter(|run| run.class == device.class);
    runs.any(|run| (run.first..run.first + run.count).contains(&device.number))
}

/// The device that a register is.
fn d(register: Register) -> Device {
    Device {
        class: DeviceClass::D,
        number: register.number(),
    }
}
