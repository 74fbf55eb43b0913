//! Operation errors of all instructions with random values: the page of an instruction lists each.

use rungc_catalogue::explain_on;
use rungc_golden::operands::{Candidate, candidates};
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId, Plc as Named};
use rungc_rt::{Class, Plc, Program, VirtualHal};
use std::collections::{BTreeMap, BTreeSet};

/// Draws of each instruction.
const DRAWS: u32 = 2;
/// D8067, the code of the last operation error.
const CODE: u32 = 8067;
/// Its codes of tuning are those of modules on other models.
const WITH_OWN_CODES: &str = "PID";
/// Registers that operands are drawn from.
const REGISTERS: u32 = 64;

/// Values that instructions are likely to reject.
fn value(rng: &mut Rng) -> i16 {
    match rng.below(4) {
        0 => -1 - rng.below(3) as i16,
        1 => rng.below(100) as i16,
        _ => rng.value(16) as i16,
    }
}

/// The error that an instruction causes in one scan.
fn error(text: &str, model: ModelId, rng: &mut Rng) -> Option<u16> {
    let program = format!("LD M8000\n{text}\nMOV D8067 D8067\nEND\n");
    let read = rungc_frontend::read_text("error.il", &program);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module?;
    let mut machine = Machine::new(&module);
    for number in 0..REGISTERS {
        machine.set_word(Class::D, number, value(rng));
    }
    for class in [Class::V, Class::Z] {
        for number in 0..8 {
            machine.set_word(class, number, value(rng));
        }
    }
    machine.scan(&mut VirtualHal::new(), 0, 10_000);
    let code = machine.word(Class::D, CODE).map(|code| code as u16);
    code.filter(|&code| code != 0)
}

/// Returns true for the instructions of the test; a pulse form does the same as the other.
fn is_meant(candidate: &Candidate) -> bool {
    !candidate.form().pulse && candidate.inst().name != WITH_OWN_CODES
}

/// Returns true for a constant to which an index register adds, such as K5Z0.
fn is_indexed_constant(operand: &str) -> bool {
    let digits = operand.strip_prefix(['K', 'H']).unwrap_or_default();
    let rest = digits.trim_start_matches(|c: char| c == '-' || c.is_ascii_hexdigit());
    rest.len() < digits.len() && rest.starts_with(['V', 'Z'])
}

/// Errors that the page of an instruction lists.
fn listed(candidate: &Candidate, model: ModelId) -> BTreeSet<u16> {
    let plc = Named::named(Model::get(model).name).expect("a model");
    let page = explain_on(candidate.inst().name, plc).expect("a page");
    let errors = page.split("## Errors").nth(1).unwrap_or_default();
    let errors = errors.split("## ").next().unwrap_or_default();
    let lines = errors.lines().filter_map(|line| line.strip_prefix("- "));
    lines
        .filter_map(|line| line.split(':').next()?.parse().ok())
        .collect()
}

#[test]
fn pages_list_the_errors_of_their_instructions() {
    let mut missing: BTreeMap<(u16, &str), String> = BTreeMap::new();
    let mut seen = 0;
    for model in [ModelId::H2u, ModelId::L01s, ModelId::Fx3u] {
        let mut rng = Rng::new(11);
        let all = candidates(model).into_iter();
        for candidate in all.filter(is_meant) {
            let listed = listed(&candidate, model);
            for _ in 0..DRAWS {
                let text = candidate.draw(&mut rng, model);
                let Some(text) = text.filter(|text| !text.split(' ').any(is_indexed_constant))
                else {
                    continue;
                };
                let Some(code) = error(&text, model, &mut rng) else {
                    continue;
                };
                seen += 1;
                if !listed.contains(&code) {
                    let name = candidate.inst().name;
                    missing
                        .entry((code, name))
                        .or_insert(format!("{model:?} {text}"));
                }
            }
        }
    }
    assert!(seen > 300, "{seen} errors");
    assert!(
        missing.is_empty(),
        "{} of {seen}: {missing:#?}",
        missing.len()
    );
}
