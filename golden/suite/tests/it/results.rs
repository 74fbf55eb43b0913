//! Results of all instructions that write relays and outputs: check knows that a coil after them replaces the result.

use rungc_catalogue::{Extent, Inst, Param, Role};
use rungc_golden::operands::{Candidate, candidates};
use rungc_golden::rng::Rng;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Classes, Device, DeviceClass, Operand, OperandKind, codes};

/// Draws of each instruction.
const DRAWS: u32 = 3;

/// A longer run of devices is not about one of them.
const MAX_RUN: i64 = 64;

/// A bit that an operand is the result for, or that its result contains, if the operands tell how long it is.
fn result(inst: &Inst, param: &Param, operands: &[Operand], operand: &Operand) -> Option<Device> {
    let (device, digits) = match operand.kind {
        OperandKind::Device(device, None) => (device, 1),
        OperandKind::Nibbles(digits, device, None) => (device, digits),
        _ => return None,
    };
    let values = match param.extent {
        Extent::One => 1,
        Extent::Count(count) | Extent::Between { most: count, .. } => i64::from(count),
        Extent::Operand { i, extra } => operands[i].kind.constant()? + i64::from(extra),
        Extent::Through(_) | Extent::Of(_) | Extent::Bits(_) => return None,
    };
    let bit = matches!(device.class, DeviceClass::Y | DeviceClass::M);
    // BMOV goes forwards where nothing switches M8024 on.
    let source = inst.name == "BMOV" && param.name == "S";
    let is_result = bit && param.role != Role::Read && !param.sends_pulses && !source;
    // A coil may feed the end of a run that is shifted.
    let whole = param.role == Role::Write || values == 1;
    let is_short = (1..=MAX_RUN).contains(&(values * 4 * i64::from(digits)));
    let is_plain = !is_special(device.class, device.number);
    (is_result && whole && is_short && is_plain).then_some(device)
}

/// Returns true if an instruction has relays or outputs as results. The pulse form has the same.
fn may_write_bits(candidate: &Candidate, model: ModelId) -> bool {
    let bits = Classes::Y.or(Classes::M).or(Classes::KNY).or(Classes::KNM);
    let params = candidate.inst().params_of(&[], Model::get(model)).iter();
    let mut results = params.filter(|param| param.role != Role::Read);
    !candidate.form().pulse && results.any(|param| param.classes.meets(bits))
}

/// The mistakes of check with an instruction: results that a coil replaces without a warning.
fn missed(candidate: &Candidate, model: ModelId, tried: &mut u32) -> Vec<String> {
    let mut rng = Rng::new(11);
    let draws = (0..DRAWS).filter_map(|_| candidate.draw(&mut rng, model));
    let mut missed = Vec::new();
    for line in draws.collect::<Vec<_>>() {
        let text = format!("LD X0\n{line}\nLD X1\n");
        let options = CompileOptions {
            model: Some(model),
            ..CompileOptions::default()
        };
        let read = rungc_frontend::read_text("results.il", &format!("{text}END\n"));
        let operands = &read.program.instrs[1].operands;
        let params = candidate.inst().params_of(operands, Model::get(model));
        let clears = candidate.inst().name == "ZRST"
            || operands
                .first()
                .is_some_and(|first| first.kind.constant() == Some(0));
        let results = operands.iter().zip(params);
        let bits = results
            .filter_map(|(operand, param)| result(candidate.inst(), param, operands, operand));
        for bit in bits {
            let with = format!("{text}OUT {bit}\nEND\n");
            let read = rungc_frontend::read_text("results.il", &with);
            let checked = compile::check(&read.program, &options);
            let mut found = checked.diagnostics.iter();
            if clears || checked.diagnostics.has_errors() {
                continue;
            }
            *tried += 1;
            if !found.any(|found| found.code == codes::DOUBLE_COIL.id) {
                missed.push(format!("{model:?} {line}: {bit}"));
            }
        }
    }
    missed
}

#[test]
fn a_coil_after_any_result_is_reported() {
    let (mut tried, mut all) = (0, Vec::new());
    for model in ModelId::ALL {
        let all_candidates = candidates(model).into_iter();
        for candidate in all_candidates.filter(|candidate| may_write_bits(candidate, model)) {
            all.extend(missed(&candidate, model, &mut tried));
        }
    }
    assert!(
        all.is_empty(),
        "{} of {tried}:\n{}",
        all.len(),
        all.join("\n")
    );
    assert!(tried > 1000, "{tried} results");
}
