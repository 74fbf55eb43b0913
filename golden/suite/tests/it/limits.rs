//! Limits of constants that an index register changes: the instruction faults beyond them, as the constant alone is an
//! error.

use rungc_catalogue::{Limits, Param, Role, Rule, Shape};
use rungc_golden::operands::{Candidate, candidates};
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::node::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_syntax::Classes;

/// Draws of each instruction.
const DRAWS: u32 = 4;
/// M8067.
const OPERATION_ERROR: u32 = 8067;
/// Scans after which an instruction has looked at its operands.
const SCANS: u32 = 2;

/// Limits of a parameter that is a constant of 16 bits, in the form of a candidate.
fn limits(param: &Param, wide: bool) -> Option<(i64, i64)> {
    let stated = param.shape == Shape::Word && param.role == Role::Read && param.indexable;
    let of_wide_form = param.rules.iter().find_map(|rule| match *rule {
        Rule::WideLimits(min, max) if wide => Some((min, max)),
        _ => None,
    });
    match param.limits {
        Limits::Between(range) if stated && param.classes.meets(Classes::K) => {
            Some(of_wide_form.unwrap_or(range))
        }
        _ => None,
    }
}

/// Returns true if an instruction has such a parameter, whatever its operands. The pulse form does the same.
fn has_limits(candidate: &Candidate, model: ModelId) -> bool {
    let inst = candidate.inst();
    let variants = inst
        .variants
        .iter()
        .filter(|variant| variant.models.has(model));
    let mut lists = variants
        .filter_map(|variant| variant.params)
        .chain([inst.params]);
    let wide = candidate.form().wide;
    !candidate.form().pulse
        && lists.any(|list| list.iter().any(|param| limits(param, wide).is_some()))
}

fn compiled(program: &str, model: ModelId) -> Option<Module> {
    let read = rungc_frontend::read_text("limits.il", program);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    compile(&read.program, &options).module
}

/// Runs some scans; returns true if M8067 comes on.
fn fails_in_scans(machine: &mut Machine) -> bool {
    (0..SCANS).any(|scan| {
        machine.scan(&mut VirtualHal::new(), scan * 10, 10_000);
        machine.bit(Class::M, OPERATION_ERROR) == Some(true)
    })
}

/// Returns true if an instruction fails while Z7 has a value; `None` if it does not compile.
fn fails(text: &str, index: i16, model: ModelId) -> Option<bool> {
    let program = format!("LD M0\n{text}\nLD M8067\nOUT M1\nLD= V7 Z7\nOUT M2\nEND\n");
    let module = compiled(&program, model)?;
    let mut machine = Machine::new(&module);
    machine.set_bit(Class::M, 0, true);
    machine.set_word(Class::Z, 7, index);
    machine.set_word(Class::V, 7, index >> 15);
    Some(fails_in_scans(&mut machine))
}

/// Returns true if an instruction fails although it is not driven, while the index registers that draws use lead
/// nowhere; `None` if it does not compile.
fn fails_undriven(text: &str, index: i16, model: ModelId) -> Option<bool> {
    let program = format!("LD M0\n{text}\nLD M8067\nOUT M1\nLD= V0 V1\nAND= Z0 Z1\nOUT M2\nEND\n");
    let module = compiled(&program, model)?;
    let mut machine = Machine::new(&module);
    for register in 0..2 {
        machine.set_word(Class::Z, register, index);
        machine.set_word(Class::V, register, index);
    }
    Some(fails_in_scans(&mut machine))
}

/// Drawn instructions that work although a constant with its index is beyond a limit.
fn beyond(candidate: &Candidate, model: ModelId, out: &mut Vec<String>) {
    let mut rng = Rng::new(7);
    let draws = (0..DRAWS).filter_map(|_| candidate.draw(&mut rng, model));
    for text in draws.collect::<Vec<_>>() {
        let words: Vec<_> = text.split(' ').collect();
        let read = rungc_frontend::read_text("limits.il", &format!("{text}\n"));
        let Some(instr) = read.program.instrs.first() else {
            continue;
        };
        let params = candidate
            .inst()
            .params_of(&instr.operands, Model::get(model));
        for (i, param) in params.iter().enumerate() {
            let constant = instr
                .operands
                .get(i)
                .and_then(|operand| operand.kind.constant());
            let limits = limits(param, candidate.form().wide).filter(|_| constant.is_some());
            let Some((low, high)) = limits else { continue };
            for (stated, index) in [(low, -1), (high, 1)] {
                let mut words: Vec<_> = words.iter().map(ToString::to_string).collect();
                words[1 + i] = format!("K{stated}Z7");
                let text = words.join(" ");
                if high < i64::from(i16::MAX) && fails(&text, index, model) == Some(false) {
                    out.push(format!("{model:?}: {text}, Z7 = {index}"));
                }
            }
        }
    }
}

#[test]
fn constants_with_an_index_are_held_to_their_limits() {
    let mut wrong = Vec::new();
    let models = [
        ModelId::H1u,
        ModelId::H2u,
        ModelId::L01s,
        ModelId::Fx2n,
        ModelId::Fx3u,
    ];
    for model in models {
        let candidates = candidates(model).into_iter();
        for candidate in candidates.filter(|candidate| has_limits(candidate, model)) {
            beyond(&candidate, model, &mut wrong);
        }
    }
    wrong.dedup();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_not_driven_does_not_fail() {
    let mut wrong = Vec::new();
    for model in [ModelId::H2u, ModelId::Fx3u] {
        let candidates = candidates(model).into_iter();
        for candidate in candidates.filter(|candidate| !candidate.form().pulse) {
            let mut rng = Rng::new(7);
            let draws = (0..DRAWS).filter_map(|_| candidate.draw(&mut rng, model));
            let indexed =
                draws.filter(|text| [" ", "Z", "V"].iter().all(|part| text.contains(part)));
            for text in indexed.collect::<Vec<_>>() {
                let fails = |index| fails_undriven(&text, index, model) == Some(true);
                if fails(9000) || fails(-9000) {
                    wrong.push(format!("{model:?}: {text}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
