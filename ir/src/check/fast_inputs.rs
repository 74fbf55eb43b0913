//! Fast inputs: high-speed counters and interrupts that want the same terminal, and interrupts of one source.

use super::Code;
use super::pointers::Pointers;
use crate::catalogue::Basic;
use crate::high_speed;
use crate::interrupts::{self, Source};
use crate::model::{ModelId, ModelSet};
use rungc_syntax::{DeviceClass, Diagnostics, codes};

/// Models on which a register chooses the edge, so that both routines of an input may stand in the program (hm-programming §7.8).
const BOTH_EDGES_ALLOWED: ModelSet = ModelSet::of(&[ModelId::Hm]);

/// Checks who uses the fast inputs.
pub(super) fn check(code: &Code, pointers: &Pointers, out: &mut Diagnostics) {
    let interrupts = interrupts(code.model().id, pointers);
    let counters = counters(code);
    one_pointer_per_source(code, &interrupts, out);
    inputs_shared(code, &interrupts, &counters, out);
    counters_share(code, &counters, out);
    never_enabled(code, &interrupts, out);
}

/// An interrupt routine.
struct Interrupt {
    /// Its pointer's number.
    number: u32,
    /// Where it begins.
    label: usize,
    /// The input that requests it.
    input: Option<u32>,
}

impl Interrupt {
    /// What it must not share with another: an input, or one of the timers I6, I7, I8.
    fn source(&self) -> Option<(bool, u32)> {
        let timer = (601..=899).contains(&self.number);
        let timer = timer.then_some((true, self.number / 100));
        self.input.map(|input| (false, input)).or(timer)
    }
}

/// The interrupt routines in the order of the program.
fn interrupts(model: ModelId, pointers: &Pointers) -> Vec<Interrupt> {
    let mut found: Vec<_> = pointers
        .iter()
        .filter(|(device, _)| device.class == DeviceClass::I)
        .filter_map(|(device, pointer)| {
            let number = device.number;
            let label = *pointer.labels.first()?;
            let input = match interrupts::find(model, number).and_then(|known| known.source) {
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
    found.sort_unstable_by_key(|interrupt| interrupt.label);
    found
}

fn one_pointer_per_source(code: &Code, interrupts: &[Interrupt], out: &mut Diagnostics) {
    if BOTH_EDGES_ALLOWED.has(code.model().id) {
        return;
    }
    for (n, second) in interrupts.iter().enumerate() {
        let same =
            |first: &&Interrupt| second.source().is_some() && first.source() == second.source();
        let Some(first) = interrupts[..n].iter().find(same) else {
            continue;
        };
        let message = match second.input {
            Some(input) => format!("both edges of `{}` interrupt", DeviceClass::X.number(input)),
            None => format!("timer interrupt I{} has two periods", second.number / 100),
        };
        let diagnostic = codes::BOTH_EDGES
            .at(code.span(second.label), message)
            .label("the second routine of this source")
            .other(code.span(first.label), "the first one");
        out.push(diagnostic);
    }
}

/// A high-speed counter that the program drives.
struct Counter {
    number: u32,
    /// What it counts, resets and starts by.
    inputs: Vec<u32>,
    /// Its first coil.
    coil: usize,
}

/// The high-speed counters that the program drives, each once.
fn counters(code: &Code) -> Vec<Counter> {
    let table = high_speed::counters(code.model().id);
    let mut found: Vec<Counter> = Vec::new();
    for i in 0..code.len {
        let Some(device) = code
            .device(i, 0)
            .filter(|_| code.basic(i) == Some(Basic::Out))
        else {
            continue;
        };
        let number = device.number;
        let known = found.iter().any(|counter| counter.number == number);
        if device.class != DeviceClass::C || known {
            continue;
        }
        if let Some(counter) = table.iter().find(|counter| counter.number == number) {
            found.push(Counter {
                number,
                inputs: counter.inputs().collect(),
                coil: i,
            });
        }
    }
    found
}

fn inputs_shared(
    code: &Code,
    interrupts: &[Interrupt],
    counters: &[Counter],
    out: &mut Diagnostics,
) {
    for interrupt in interrupts {
        let Some(input) = interrupt.input else {
            continue;
        };
        for counter in counters
            .iter()
            .filter(|counter| counter.inputs.contains(&input))
        {
            let input = DeviceClass::X.number(input);
            let message = format!(
                "`{input}` serves both an interrupt and counter `C{}`",
                counter.number
            );
            let diagnostic = codes::INPUT_SHARED
                .at(code.span(interrupt.label), message)
                .label("requests an interrupt here …")
                .other(code.span(counter.coil), "… and counts here");
            out.push(diagnostic);
        }
    }
}

fn counters_share(code: &Code, counters: &[Counter], out: &mut Diagnostics) {
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
            let message = format!(
                "`C{}` and `C{}` both use `{input}`",
                first.number, second.number
            );
            let diagnostic = codes::COUNTERS_SHARE
                .at(code.span(second.coil), message)
                .label("used here …")
                .other(code.span(first.coil), "… and here")
                .help("choose counters with inputs of their own");
            out.push(diagnostic);
        }
    }
}

fn never_enabled(code: &Code, interrupts: &[Interrupt], out: &mut Diagnostics) {
    let enabled = || (0..code.len).any(|i| code.basic(i) == Some(Basic::Ei));
    let Some(first) = interrupts.first().filter(|_| !enabled()) else {
        return;
    };
    let diagnostic = codes::NEVER_ENABLED
        .at(
            code.span(first.label),
            "this interrupt routine never runs: there is no EI",
        )
        .label("interrupts are disabled at the start of RUN")
        .help("put EI at the beginning of the program");
    out.push(diagnostic);
}
