//! How much of the hardware for fast inputs and outputs a program asks for.

use super::Code;
use super::fast_inputs::{Counter, Other, measured};
use rungc_models::ModelSet;
use rungc_models::high_speed::Kind;
use rungc_syntax::{DeviceClass, Diagnostics, codes};
use std::collections::BTreeMap;

/// Models that share units of hardware among what is fast (h1u-h2u-programming §3.10).
const MODELS: ModelSet = ModelSet::INOVANCE;
/// How many units there are.
const UNITS: u32 = 56;
/// Units of a pulse output, of SPD, of an interrupt or the catching of pulses.
const OUTPUT: u32 = 7;
const DENSITY: u32 = 4;
const EDGE: u32 = 1;

/// Units of a high-speed counter.
fn counter(kind: Kind) -> u32 {
    match kind {
        Kind::One => 6,
        Kind::UpDown | Kind::Direction => 13,
        Kind::Phases => 17,
    }
}

/// Warns of a program that asks for more than there is.
pub(super) fn check(code: &Code, others: &[Other], counters: &[Counter], out: &mut Diagnostics) {
    if !MODELS.has(code.model().id) {
        return;
    }
    let outputs = outputs(code).into_values().map(|at| (at, OUTPUT));
    let inputs: BTreeMap<u32, usize> = measured(code).map(|(i, input)| (input.number, i)).collect();
    let inputs = inputs.into_values().map(|at| (at, DENSITY));
    let others = others.iter().map(|other| (other.at, EDGE));
    let counters = counters.iter().map(|c| (c.coil, counter(c.kind)));
    let mut uses: Vec<(usize, u32)> = outputs
        .chain(inputs)
        .chain(others)
        .chain(counters)
        .collect();
    uses.sort_unstable();
    let asked: u32 = uses.iter().map(|&(_, units)| units).sum();
    let mut so_far = 0;
    let beyond = uses.iter().find(|&&(_, units)| {
        so_far += units;
        so_far > UNITS
    });
    if let Some(&(at, _)) = beyond {
        let message = format!(
            "fast inputs and outputs take {asked} units of hardware, {} has {UNITS}",
            code.model().name
        );
        let diagnostic = codes::FAST_UNITS
            .at(code.span(at), message)
            .label("there is none left for this");
        out.push(diagnostic);
    }
}

/// The outputs that send pulses, and where they are first named.
fn outputs(code: &Code) -> BTreeMap<u32, usize> {
    let mut found = BTreeMap::new();
    for i in 0..code.len {
        for (n, param) in code.params(i).iter().enumerate() {
            let output = code.device(i, n).filter(|_| param.sends_pulses);
            if let Some(output) = output.filter(|output| output.class == DeviceClass::Y) {
                found.entry(output.number).or_insert(i);
            }
        }
    }
    found
}
