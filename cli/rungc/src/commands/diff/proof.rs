//! Outputs that can differ as far as statements show, and are proved the same nevertheless.

use super::Side;
use crate::commands::properties::ExternalWrites;
use crate::commands::verify::report;
use crate::commands::verify::same::assumptions as assumptions_of;
use rungc_ir::Module;
use rungc_ir::compare::Behaviour;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_syntax::{DeviceClass, DeviceRun};
use rungc_verify::model::World;
use rungc_verify::prove::{Options, Verdict};
use rungc_verify::same::{self, Output};
use std::collections::BTreeSet;

/// Limits of the effort: for all outputs together, and for one of them.
const EFFORT: [u64; 2] = [10_000, 2000];

/// The longest time from one scan to the next that proofs suppose, in milliseconds.
pub(super) fn scan_ms() -> u32 {
    World::default().scan_ms
}

/// Outputs that are proved the same, and what the proofs suppose.
#[derive(Default)]
pub(super) struct Proofs {
    pub outputs: Vec<Output>,
    pub assumptions: Vec<String>,
}

/// Takes the outputs Y out of those that can differ that no run makes differ.
pub(super) fn proved(old: &Side, new: &Side, behaviour: &mut Behaviour) -> Proofs {
    let Behaviour::CanDiffer { devices, .. } = behaviour else {
        return Proofs::default();
    };
    let is_output = |run: &&DeviceRun| run.class == DeviceClass::Y;
    let outputs = devices.iter().filter(is_output).flat_map(numbers).count();
    if outputs == 0 {
        return Proofs::default();
    }
    let (Some(old), Some(new)) = (module(old), module(new)) else {
        return Proofs::default();
    };
    let [all, one] = EFFORT;
    let options = Options {
        effort: one.min(all / outputs as u64),
        ..Options::default()
    };
    let mut compared = same::compare(&old, &new, &options);
    compared
        .outputs
        .retain(|output| output.verdict == Verdict::Proved);
    let is_same = |number| {
        compared
            .outputs
            .iter()
            .any(|output| output.number == number)
    };
    let (mut proved, mut rest) = (BTreeSet::new(), Vec::new());
    for run in devices.drain(..) {
        for number in numbers(&run) {
            if run.class == DeviceClass::Y && is_same(number) {
                proved.insert(number);
            } else {
                add(&mut rest, run.class, number);
            }
        }
    }
    *devices = rest;
    let mut assumptions = report::assumptions(&options.world, &[], &ExternalWrites::of(None, None));
    assumptions.extend(assumptions_of(&compared));
    compared
        .outputs
        .retain(|output| proved.contains(&output.number));
    Proofs {
        outputs: compared.outputs,
        assumptions,
    }
}

fn numbers(run: &DeviceRun) -> std::ops::Range<u32> {
    run.first..run.first + run.count
}

/// Adds a device after others.
pub(super) fn add(runs: &mut Vec<DeviceRun>, class: DeviceClass, number: u32) {
    match runs.last_mut() {
        Some(run) if run.class == class && run.first + run.count == number => run.count += 1,
        _ => runs.push(DeviceRun {
            class,
            first: number,
            count: 1,
        }),
    }
}

fn module(side: &Side) -> Option<Module> {
    let options = CompileOptions {
        optimise: false,
        ..side.options()
    };
    let mut module = compile(&side.meant, &options).module?;
    simplify(&mut module);
    Some(module)
}
