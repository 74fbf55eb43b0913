//! Constants with which an instruction fails each time it runs: check knows those, and reports no others.

use rungc_catalogue::{Limits, Param};
use rungc_golden::operands::{Candidate, candidates};
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_syntax::{Classes, codes};
use std::collections::BTreeMap;

/// Draws of each instruction.
const DRAWS: u32 = 12;
/// How many of them must have a constant in common before that is the cause.
const ENOUGH: u32 = 3;
/// Its operands are what D8126 says: lengths, or an address and a number of words.
const SET_BY_A_REGISTER: &str = "RS";
/// M8067.
const OPERATION_ERROR: u32 = 8067;

/// An instruction that ran.
struct Run {
    text: String,
    /// Operands, from 0, with their constants.
    constants: Vec<(usize, i64)>,
    failed: bool,
    reported: bool,
}

/// Runs a drawn instruction for a scan.
fn run(text: &str, model: ModelId) -> Option<Run> {
    let program = format!("LD M0\n{text}\nLD M8067\nOUT M1\nEND\n");
    let read = rungc_frontend::read_text("constants.il", &program);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let operands = &read.program.instrs.get(1)?.operands;
    let constants = operands.iter().enumerate();
    let constants = constants.filter_map(|(i, operand)| Some((i, operand.kind.constant()?)));
    let constants = constants.collect::<Vec<_>>();
    let mut found = compiled.diagnostics.iter();
    let reported = found.any(|found| found.code == codes::CONSTANT_FAILS.id);
    let module = compiled.module?;
    let mut machine = Machine::new(&module);
    machine.set_bit(Class::M, 0, true);
    machine.scan(&mut VirtualHal::new(), 0, 10_000);
    Some(Run {
        text: text.to_owned(),
        constants,
        failed: machine.bit(Class::M, OPERATION_ERROR) == Some(true),
        reported,
    })
}

/// Returns true if an operand may be any constant, as far as the compiler knows. The pulse form does the same.
fn takes_any_constant(candidate: &Candidate, model: ModelId) -> bool {
    let params = candidate.inst().params_of(&[], Model::get(model));
    let any = |param: &Param| param.limits == Limits::None && param.classes.meets(Classes::K);
    let fixed = candidate.inst().name != SET_BY_A_REGISTER;
    fixed && !candidate.form().pulse && params.iter().any(any)
}

/// Runs of an instruction with random operands.
fn runs(candidate: &Candidate, model: ModelId) -> Vec<Run> {
    let mut rng = Rng::new(7);
    let draws = (0..DRAWS).filter_map(|_| candidate.draw(&mut rng, model));
    draws.filter_map(|text| run(&text, model)).collect()
}

/// Negative constants and 0 with which all runs failed, although others did not.
fn unreported(runs: &[Run], out: &mut Vec<String>) {
    let mut kinds: BTreeMap<(usize, i64), Vec<&Run>> = BTreeMap::new();
    for run in runs {
        for &(i, value) in run.constants.iter().filter(|constant| constant.1 <= 0) {
            kinds.entry((i, value.signum())).or_default().push(run);
        }
    }
    for ((i, sign), with) in kinds {
        let fails = with.iter().all(|run| run.failed && !run.reported);
        let works = runs.iter().any(|run| !run.failed);
        if fails && works && with.len() as u32 >= ENOUGH {
            let sign = if sign < 0 { "negative" } else { "zero" };
            out.push(format!("operand {} {sign}: {}", i + 1, with[0].text));
        }
    }
}

#[test]
fn constants_that_always_fail_are_reported_and_no_others() {
    let mut wrong = Vec::new();
    for model in [ModelId::H2u, ModelId::Fx3u] {
        let candidates = candidates(model).into_iter();
        for candidate in candidates.filter(|candidate| takes_any_constant(candidate, model)) {
            let runs = runs(&candidate, model);
            let harmless = runs.iter().filter(|run| run.reported && !run.failed);
            wrong.extend(harmless.map(|run| format!("reported, but works: {}", run.text)));
            unreported(&runs, &mut wrong);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
