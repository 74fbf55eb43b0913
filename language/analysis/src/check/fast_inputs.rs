//! Fast inputs: high-speed counters, interrupts, pulse catch and SPD that want the same terminal, and interrupts of one
//! source.

use super::pointers::Pointers;
use super::{Code, fast_units};
use rungc_catalogue::{Basic, Lower};
use rungc_models::Model;
use rungc_models::high_speed::{self, Kind};
use rungc_models::interrupts::Source;
use rungc_rt::{RtFn, Wiring};
use rungc_syntax::{Device, DeviceClass, Diagnostics, OperandKind, Phrase, codes, phrase};

/// Checks who uses the fast inputs.
pub(super) fn check(code: &Code, pointers: &Pointers, out: &mut Diagnostics) {
    let interrupts = interrupts(code.model(), pointers);
    let counters = counters(code);
    without_input(code, out);
    one_pointer_per_source(code, &interrupts, out);
    let others = others(code, &interrupts);
    inputs_shared(code, &others, &counters, out);
    two_purposes(code, &others, out);
    looked_at(code, &others, &counters, out);
    fast_units::check(code, &others, &counters, out);
    counters_share(code, &counters, out);
    never_enabled(code, &others, &interrupts, out);
}

/// An interrupt routine.
struct Interrupt {
    /// Its pointer's number.
    number: u32,
    /// Position of its label.
    label: usize,
    /// The input that requests it.
    input: Option<u32>,
}

impl Interrupt {
    /// Resource that it must not share with another: an input, or one of the timers I6, I7, I8.
    fn source(&self) -> Option<(bool, u32)> {
        let timer = (601..=899).contains(&self.number);
        let timer = timer.then_some((true, self.number / 100));
        self.input.map(|input| (false, input)).or(timer)
    }
}

/// The interrupt routines in the order of the program.
fn interrupts(model: &Model, pointers: &Pointers) -> Vec<Interrupt> {
    let mut found: Vec<_> = pointers
        .iter()
        .filter(|(device, _)| device.class == DeviceClass::I)
        .filter_map(|(device, pointer)| {
            let number = device.number;
            let label = *pointer.labels.first()?;
            let input = match model.interrupts.find(number).and_then(|known| known.source) {
                Some(Source::Input { number, .. }) => Some(number),
                _ => None,
            };
            Some(Interrupt {
                number,
                label,
                input,
            })
        })
        .collect();
    found.sort_by_key(|interrupt| interrupt.label);
    found
}

fn one_pointer_per_source(code: &Code, interrupts: &[Interrupt], out: &mut Diagnostics) {
    if code.model().interrupts.both_edges {
        return;
    }
    for (n, second) in interrupts.iter().enumerate() {
        let same =
            |first: &&Interrupt| second.source().is_some() && first.source() == second.source();
        let Some(first) = interrupts[..n].iter().find(same) else {
            continue;
        };
        let message = match second.input {
            Some(input) => phrase!(
                "two interrupt routines use `{input}` (rising and falling edge)",
                input = DeviceClass::X.number(input)
            ),
            None => phrase!(
                "timer interrupt I{number} has two periods",
                number = second.number / 100
            ),
        };
        let diagnostic = codes::BOTH_EDGES
            .at(code.span(second.label), message)
            .label("the second routine of this source")
            .other(code.span(first.label), "the first one");
        out.push(diagnostic);
    }
}

/// A high-speed counter that the program drives.
pub(super) struct Counter {
    number: u32,
    pub(super) kind: Kind,
    /// Inputs by which it counts, resets and starts.
    inputs: Vec<u32>,
    /// Its first coil.
    pub(super) coil: usize,
}

/// The high-speed counters that the program drives, each once.
fn counters(code: &Code) -> Vec<Counter> {
    let mut found: Vec<Counter> = Vec::new();
    for i in 0..code.len {
        if code.basic(i) != Some(Basic::Out) {
            continue;
        }
        let Some(device) = code.device(i, 0) else {
            continue;
        };
        let number = device.number;
        let known = || found.iter().any(|counter| counter.number == number);
        if device.class != DeviceClass::C || known() {
            continue;
        }
        if let Some(counter) = code.model().high_speed.counter(number) {
            found.push(Counter {
                number,
                kind: counter.kind,
                inputs: counter.inputs().collect(),
                coil: i,
            });
        }
    }
    found
}

/// Coils of counters that no input of the model drives.
fn without_input(code: &Code, out: &mut Diagnostics) {
    let counters = &code.model().high_speed;
    for i in (0..code.len).filter(|&i| code.basic(i) == Some(Basic::Out)) {
        let Some(device) = code.device(i, 0) else {
            continue;
        };
        let fast = device.class == DeviceClass::C && device.number >= high_speed::FIRST;
        // If it does not exist at all, that is reported elsewhere.
        let fast = fast && code.model().has(device.class, device.number);
        if fast && counters.counter(device.number).is_none() {
            let message = phrase!(
                "`{device}` does not count an input of {model}",
                device,
                model = code.model().name
            );
            let span = code
                .instr(i)
                .operands
                .first()
                .map_or(code.span(i), |o| o.span);
            out.push(match counters.idle.contains(&device.number) {
                true => codes::COUNTS_NOTHING.at(span, message),
                false => codes::NO_DEVICE.at(span, message),
            });
        }
    }
}

/// An interrupt, as messages name it.
const INTERRUPT: &str = "an interrupt";

/// Another user of an input's edges.
pub(super) struct Other {
    input: u32,
    /// `an interrupt`.
    name: &'static str,
    /// `requests an interrupt`.
    here: fn() -> Phrase,
    pub(super) at: usize,
}

/// Interrupts of inputs, and relays that catch pulses.
fn others(code: &Code, interrupts: &[Interrupt]) -> Vec<Other> {
    let interrupts = interrupts.iter().filter_map(|interrupt| {
        Some(Other {
            input: interrupt.input?,
            name: INTERRUPT,
            here: || phrase!("requests an interrupt here …"),
            at: interrupt.label,
        })
    });
    interrupts.chain(caught(code)).collect()
}

/// The relays of pulse catch that the program looks at, each once.
fn caught(code: &Code) -> Vec<Other> {
    let Some(catch) = code.model().interrupts.pulse_catch else {
        return Vec::new();
    };
    let mut found: Vec<Other> = Vec::new();
    for i in 0..code.len {
        let relay = code
            .device(i, 0)
            .filter(|device| device.class == DeviceClass::M);
        let Some(input) = relay.and_then(|relay| relay.number.checked_sub(catch.first.number()))
        else {
            continue;
        };
        if input < catch.inputs && found.iter().all(|other| other.input != input) {
            found.push(Other {
                input,
                name: "pulse catch",
                here: || phrase!("its pulses are caught here …"),
                at: i,
            });
        }
    }
    found
}

/// Interrupts and pulse catch at one input. It works, and the manuals say of both that the input has one purpose.
fn two_purposes(code: &Code, others: &[Other], out: &mut Diagnostics) {
    let (interrupts, caught): (Vec<_>, Vec<_>) =
        others.iter().partition(|other| other.name == INTERRUPT);
    for interrupt in interrupts {
        let Some(catch) = caught.iter().find(|catch| catch.input == interrupt.input) else {
            continue;
        };
        let input = DeviceClass::X.number(catch.input);
        let message = phrase!("`{input}` serves both an interrupt and pulse catch", input);
        let diagnostic = codes::MEASURED_INPUT
            .at(code.span(catch.at), message)
            .label("its pulses are caught here …")
            .other(code.span(interrupt.at), "… and request an interrupt here")
            .help("use a separate input, or set a relay in the interrupt routine");
        out.push(diagnostic);
    }
}

fn inputs_shared(code: &Code, others: &[Other], counters: &[Counter], out: &mut Diagnostics) {
    for other in others {
        for counter in counters
            .iter()
            .filter(|counter| counter.inputs.contains(&other.input))
        {
            let input = DeviceClass::X.number(other.input);
            let message = phrase!(
                "`{input}` serves both {other} and counter `C{number}`",
                input,
                other = other.name,
                number = counter.number
            );
            let diagnostic = codes::INPUT_SHARED
                .at(code.span(other.at), message)
                .label((other.here)())
                .other(code.span(counter.coil), "… and counts here");
            out.push(diagnostic);
        }
    }
}

/// SPD and positioning on an input that serves something else. The manuals advise against it, but it works all the same
/// (h1u-h2u-programming §4.3.6 allows counters and interrupts at the input of SPD, and §4.3.1 advises against
/// interrupts; l01s-programming §6.4.1).
fn looked_at(code: &Code, others: &[Other], counters: &[Counter], out: &mut Diagnostics) {
    let measures: Vec<(usize, u32)> = measured(code).map(|(i, x)| (i, x.number)).collect();
    let positions = positioned(code);
    let looks = measures.iter().chain(&positions);
    for (n, &(i, input)) in looks.enumerate() {
        let is_free = n < measures.len() && code.model().high_speed.spd_takes_counters;
        let counter = counters
            .iter()
            .find(|counter| !is_free && counter.inputs.contains(&input))
            .map(|counter| {
                (
                    phrase!("counter `C{number}`", number = counter.number),
                    counter.coil,
                )
            });
        let other = others
            .iter()
            .find(|other| other.input == input)
            .map(|other| (other.name.into(), other.at));
        let spd = measures
            .iter()
            .find(|measured| n >= measures.len() && measured.1 == input)
            .map(|measured| ("SPD".into(), measured.0));
        let (Some((name, at)), Some(inst)) = (counter.or(other).or(spd), code.inst(i)) else {
            continue;
        };
        let input = DeviceClass::X.number(input);
        let message = phrase!(
            "`{input}` serves both {inst} and {name}",
            input,
            inst = inst.name,
            name
        );
        let diagnostic = codes::MEASURED_INPUT
            .at(code.span(i), message)
            .label("read here …")
            .other(code.span(at), "… and used here")
            .help("use a separate input");
        out.push(diagnostic);
    }
}

/// The instructions that position by fast inputs, and these inputs.
fn positioned(code: &Code) -> Vec<(usize, u32)> {
    let mut found = Vec::new();
    for i in 0..code.len {
        let Some(Lower::Call(function)) = code.lower(i) else {
            continue;
        };
        if !function.needs().signals {
            continue;
        }
        let operands = &code.instr(i).operands;
        let inputs = operands.iter().filter_map(|operand| match operand.kind {
            OperandKind::Device(device, None) if device.class == DeviceClass::X => {
                Some(device.number)
            }
            _ => None,
        });
        let inputs = inputs.chain(awaited(code, i, function));
        let mut inputs: Vec<u32> = inputs.filter(|&n| n < Wiring::FAST_INPUTS).collect();
        // The zero signal may be that of the DOG.
        inputs.dedup();
        found.extend(inputs.into_iter().map(|input| (i, input)));
    }
    found
}

/// The input whose interrupt DVIT awaits, unless the program chooses others by the register.
fn awaited(code: &Code, i: usize, function: RtFn) -> Option<u32> {
    let operand = code.params(i).iter().position(|param| param.sends_pulses)?;
    let output = code.device(i, operand).filter(|_| function == RtFn::Dvit)?;
    let outputs = code.model().pulses.outputs();
    let interrupt = outputs.get(output.number as usize)?.interrupt;
    let chooses = |i| {
        let relay = code
            .device(i, 0)
            .filter(|relay| relay.class == DeviceClass::M);
        relay.map(|relay| relay.number) == interrupt.chooses.map(|relay| relay.number())
    };
    (!(0..code.len).any(chooses)).then_some(interrupt.input)
}

/// The instructions SPD and their inputs.
pub(super) fn measured(code: &Code) -> impl Iterator<Item = (usize, Device)> {
    (0..code.len).filter_map(|i| {
        let measures = matches!(code.lower(i)?, Lower::Density);
        Some((i, measures.then(|| code.device(i, 0))??))
    })
}

fn counters_share(code: &Code, counters: &[Counter], out: &mut Diagnostics) {
    if code.model().high_speed.counters_take_turns {
        return;
    }
    for (n, second) in counters.iter().enumerate() {
        for first in &counters[..n] {
            let Some(&input) = second
                .inputs
                .iter()
                .find(|input| first.inputs.contains(input))
            else {
                continue;
            };
            let input = DeviceClass::X.number(input);
            let message = phrase!(
                "`C{number}` and `C{number2}` both use `{input}`",
                number = first.number,
                number2 = second.number,
                input
            );
            let diagnostic = codes::COUNTERS_SHARE
                .at(code.span(second.coil), message)
                .label("used here …")
                .other(code.span(first.coil), "… and here")
                .help("use counters with different inputs");
            out.push(diagnostic);
        }
    }
}

/// Interrupt routines and relays of pulse catch (h1u-h2u-programming §3.3) in a program without EI.
fn never_enabled(code: &Code, others: &[Other], interrupts: &[Interrupt], out: &mut Diagnostics) {
    if (0..code.len).any(|i| code.basic(i) == Some(Basic::Ei)) {
        return;
    }
    let routine = interrupts.first().map(|interrupt| {
        let message = phrase!("this interrupt routine never runs: there is no EI");
        (interrupt.label, message)
    });
    let catch = others.iter().find(|other| other.name != INTERRUPT);
    let catch = catch.and_then(|catch| {
        let relay = code.device(catch.at, 0)?;
        let message = phrase!("`{relay}` catches no pulse: there is no EI", relay);
        Some((catch.at, message))
    });
    for (at, message) in routine.into_iter().chain(catch) {
        let diagnostic = codes::NEVER_ENABLED
            .at(code.span(at), message)
            .label("interrupts are disabled at the start of RUN")
            .help("put EI at the start of the program");
        out.push(diagnostic);
    }
}
