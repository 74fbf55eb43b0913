//! Operation errors of all instructions with random values: the page of an instruction lists each.

use rungc_catalogue::explain_on;
use rungc_golden::operands::{Candidate, in_any_rung};
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
/// The relay of HM that is on once an instruction failed; D8006 holds its step, not a code.
const FAILED: u32 = 8006;
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

/// An error that an instruction causes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Error {
    /// A code.
    Code(u16),
    /// Any.
    Some,
}

/// The error that an instruction, with what belongs to it, causes in one scan.
fn error(text: &str, model: ModelId, rng: &mut Rng) -> Option<Error> {
    let is_hm = model == ModelId::Hm;
    let shown = if is_hm {
        "LD M8006\nOUT M9"
    } else {
        "LD M8000\nMOV D8067 D8067"
    };
    let program = format!("LD M8000\n{text}\n{shown}\nEND\n");
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
    if is_hm {
        return machine.bit(Class::M, FAILED)?.then_some(Error::Some);
    }
    let code = machine.word(Class::D, CODE).map(|code| code as u16);
    code.filter(|&code| code != 0).map(Error::Code)
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
    let mut missing: BTreeMap<String, String> = BTreeMap::new();
    let mut seen: BTreeMap<ModelId, usize> = BTreeMap::new();
    for model in ModelId::ALL {
        let mut rng = Rng::new(11);
        for candidate in in_any_rung(model) {
            let listed = listed(&candidate, model);
            for _ in 0..DRAWS {
                let text = candidate.draw(&mut rng, model);
                let Some(text) = text.filter(|text| !text.split(' ').any(is_indexed_constant))
                else {
                    continue;
                };
                let error = error(&candidate.after_contact(&text), model, &mut rng);
                *seen.entry(model).or_default() += usize::from(error.is_some());
                let is_listed = match error {
                    None => true,
                    Some(Error::Code(code)) => listed.contains(&code),
                    Some(Error::Some) => !listed.is_empty(),
                };
                if let (Some(error), false) = (error, is_listed) {
                    let name = candidate.inst().name;
                    let key = match error {
                        Error::Code(code) => format!("{code} of {name}"),
                        Error::Some => format!("{name} on HM"),
                    };
                    missing.entry(key).or_insert(format!("{model:?} {text}"));
                }
            }
        }
    }
    assert!(seen.values().all(|&errors| errors > 30), "{seen:?}");
    assert!(
        missing.is_empty(),
        "{} of {seen:?}: {missing:#?}",
        missing.len()
    );
}

/// The page of an instruction for all models lists what an index can do on one of them.
#[test]
fn pages_for_all_models_list_errors_of_some() {
    for name in ["LD", "OUT", "SET", "RST", "PLS"] {
        let page = rungc_catalogue::explain(name).expect("a page");
        let line = page.lines().find(|line| line.starts_with("- 6706: "));
        let line = line.unwrap_or_else(|| panic!("{page}"));
        assert!(line.ends_with("(only on fx3u, fx3u-compatible)"), "{line}");
    }
}
