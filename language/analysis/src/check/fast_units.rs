//! Use of the hardware for fast inputs and outputs.

use super::Code;
use super::fast_inputs::{Counter, Other, measured};
use rungc_syntax::{DeviceClass, Diagnostics, codes, phrase};
use std::collections::BTreeMap;

/// Warns of a program that asks for more than there is.
pub(super) fn check(code: &Code, others: &[Other], counters: &[Counter], out: &mut Diagnostics) {
    let Some(of) = code.model().fast_units else {
        return;
    };
    let outputs = outputs(code).into_values().map(|at| (at, of.output));
    let inputs: BTreeMap<_, _> = measured(code).map(|(i, input)| (input.number, i)).collect();
    let inputs = inputs.into_values().map(|at| (at, of.density));
    let others = others.iter().map(|other| (other.at, of.edge));
    let counters = counters.iter().map(|c| (c.coil, of.counter(c.kind)));
    let mut uses: Vec<(usize, u32)> = outputs
        .chain(inputs)
        .chain(others)
        .chain(counters)
        .collect();
    uses.sort();
    let asked: u32 = uses.iter().map(|&(_, units)| units).sum();
    let mut so_far = 0;
    let beyond = uses.iter().find(|&&(_, units)| {
        so_far += units;
        so_far > of.total
    });
    if let Some(&(at, _)) = beyond {
        let message = phrase!(
            "fast inputs and outputs take {asked} units of hardware, {model} has {total}",
            asked,
            model = code.model().name,
            total = of.total
        );
        let diagnostic = codes::FAST_UNITS
            .at(code.span(at), message)
            .label("none is left for this");
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
