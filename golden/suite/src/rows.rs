//! The rows of the catalogue: rungs in which each occurs in every form, and what occurs in programs.

use crate::operands::{Candidate, OperandGoal, has_form, in_any_rung, operand_goals};
use crate::rng::Rng;
use rungc_catalogue::{Form, Inst, Lower};
use rungc_models::{Model, ModelId};
use rungc_syntax::Classes;
use std::collections::{BTreeMap, BTreeSet};

/// An instruction in a rung.
#[derive(Clone, Debug)]
pub struct Rung {
    /// The lines.
    pub text: String,
    /// The same with operands that no one means, which may not compile.
    pub hostile: Vec<String>,
}

/// The models and forms of an instruction.
fn pairs(inst: &Inst) -> Vec<(ModelId, Form)> {
    let models = ModelId::ALL.into_iter();
    models
        .flat_map(|model| {
            let forms = inst.spellings().into_iter().map(|(_, form)| form);
            let mut forms: Vec<Form> = forms.filter(|form| has_form(inst, *form, model)).collect();
            forms.dedup();
            forms.into_iter().map(move |form| (model, form))
        })
        .collect()
}

/// The operands that this model and form are to show of an instruction: over all of them, each operand is of each class
/// that it may be.
fn share(inst: &Inst, pair: (ModelId, Form), seed: u64) -> Vec<OperandGoal> {
    let all = pairs(inst);
    let mut able: BTreeMap<_, Vec<_>> = BTreeMap::new();
    let is_run = |model| !matches!(inst.lower_on_model(model), Lower::Todo(_));
    for &(model, form) in all.iter().filter(|(model, _)| is_run(*model)) {
        for ((name, class), goal) in operand_goals(inst, model, form) {
            let able = able.entry((name, class.0)).or_default();
            able.push(((model, form), goal));
        }
    }
    let turns = able.values().zip(seed..);
    turns
        .filter_map(|(able, turn)| able.get((turn % able.len() as u64) as usize))
        .filter(|(able, _)| *able == pair)
        .map(|&(_, goal)| goal)
        .collect()
}

/// Rungs in which each instruction of a model occurs in each of its forms, once or more: over all models its operands
/// are of each class. Each rung has this many hostile twins.
pub fn rungs(model: ModelId, seed: u64, hostile: u64) -> Vec<Rung> {
    let mut rng = Rng::new(seed ^ (model as u64) << 32);
    let mut rungs = Vec::new();
    let mut later = Vec::new();
    for candidate in in_any_rung(model) {
        let operand_goals = share(candidate.inst(), (model, candidate.form()), seed);
        let lines = candidate.draw_with(&mut rng, model, operand_goals);
        for (time, drawn) in lines.into_iter().enumerate() {
            let twins = (0..hostile).map(|_| spoilt(&mut rng, &drawn));
            let twins: Vec<String> = twins.collect();
            let hostile = twins.iter().map(|twin| rung(&mut rng, &candidate, twin));
            let hostile = hostile.collect();
            let text = rung(&mut rng, &candidate, &drawn);
            // Forms of an instruction that may be used once should not meet in a program.
            let rungs = match candidate.form() {
                Form { pulse: false, .. } if time == 0 => &mut rungs,
                _ => &mut later,
            };
            rungs.push(Rung { text, hostile });
        }
    }
    rungs.append(&mut later);
    rungs
}

/// An instruction with a contact that drives it.
fn rung(rng: &mut Rng, candidate: &Candidate, instruction: &str) -> String {
    let drives: &[&str] = match candidate.form().pulse {
        true => &["LD X000", "LDI X001", "LD M8013"],
        false => &["LD M8000", "LD M8000", "LD X000", "LDI X002"],
    };
    let drive = rng.pick(drives).unwrap_or("LD M8000");
    let lines = candidate.after_contact(instruction);
    // Logic needs a coil; each another one.
    let coil = format!("OUT M{}", rng.below(24));
    format!("{drive}\n{}", lines.replace("OUT M0", &coil))
}

/// A number that no one means: at a border, or beyond.
fn beyond(rng: &mut Rng) -> &'static str {
    let numbers = [
        "K-1",
        "K0",
        "K32767",
        "K-32768",
        "K2147483647",
        "K-2147483648",
        "HFFFF",
        "HFFFFFFFF",
        "H80000000",
    ];
    numbers[rng.below(numbers.len() as u32) as usize]
}

/// The instruction with a constant or the number of a device replaced.
fn spoilt(rng: &mut Rng, instruction: &str) -> String {
    let mut words: Vec<String> = instruction.split(' ').map(str::to_string).collect();
    let count = words.len() as u32 - 1;
    if count == 0 {
        return instruction.to_string();
    }
    let word = &mut words[1 + rng.below(count) as usize];
    let is_constant = word.starts_with(['K', 'H']) && !word.contains(['X', 'Y', 'M', 'S']);
    *word = match rng.below(3) {
        0 if !is_constant => {
            let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
            let numbers = ["0", "7777", "32767", "99999", "4294967295"];
            format!("{letters}{}", numbers[rng.below(5) as usize])
        }
        _ => beyond(rng).to_string(),
    };
    words.join(" ")
}

/// Contents of programs by rows of the catalogue.
#[derive(Clone, Debug, Default)]
pub struct Occurring {
    /// Models, with spellings of forms.
    rows: BTreeSet<(ModelId, String)>,
    /// Instructions, with the names of operands and what these are.
    operands: BTreeSet<(&'static str, &'static str, u32)>,
}

impl Occurring {
    /// Adds what occurs in a program.
    pub fn add(&mut self, model: ModelId, text: &str) {
        let program = rungc_frontend::read_text("occurring.il", text).program;
        for instr in &program.instrs {
            let Some(found) = rungc_catalogue::find(&instr.mnemonic) else {
                continue;
            };
            let (inst, form) = (found.inst, found.form);
            self.rows
                .extend(inst.spelling_of(form).map(|usual| (model, usual)));
            let params = inst.params_of(&instr.operands, Model::get(model)).iter();
            for (param, operand) in params.zip(&instr.operands) {
                let class = Classes::of(&operand.kind);
                self.operands.insert((inst.name, param.name, class.0));
            }
        }
    }

    /// Numbers of instructions of models by form, and of operands by class.
    pub fn counts(&self) -> (usize, usize) {
        (self.rows.len(), self.operands.len())
    }

    /// The operands of implemented instructions that occur on no model, by their names and classes.
    pub fn missing_operands(&self) -> Vec<String> {
        let mut missing = BTreeSet::new();
        for inst in rungc_catalogue::all() {
            for (model, form) in pairs(inst) {
                if matches!(inst.lower_on_model(model), Lower::Todo(_)) {
                    continue;
                }
                for ((name, class), _) in operand_goals(inst, model, form) {
                    if !self.operands.contains(&(inst.name, name, class.0)) {
                        missing.insert(format!("{} {name} {class:?}", inst.name));
                    }
                }
            }
        }
        missing.into_iter().collect()
    }

    /// The forms of a model's instructions that do not occur, each with what implements it.
    pub fn missing(&self, model: ModelId) -> Vec<(String, Lower)> {
        let rows = rungc_catalogue::all().flat_map(|inst| {
            let forms = pairs(inst).into_iter().filter(move |(on, _)| *on == model);
            forms.filter_map(move |(_, form)| Some((inst.spelling_of(form)?, inst)))
        });
        rows.map(|(spelling, inst)| (spelling, inst.lower_on_model(model)))
            .filter(|(spelling, _)| !self.rows.contains(&(model, spelling.clone())))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Occurring, share};
    use crate::operands::in_any_rung;
    use crate::rng::Rng;
    use rungc_catalogue::{Inst, Rule};
    use rungc_models::ModelId;

    fn has_predicate(inst: &Inst) -> bool {
        let variants = inst.variants.iter().filter_map(|variant| variant.params);
        let mut params = variants.chain([inst.params]).flatten();
        params.any(|param| param.rules.iter().any(|r| matches!(r, Rule::Suits(..))))
    }

    /// The differential test demands as much of all instructions, but only if it takes all models.
    #[test]
    fn constants_that_must_suit_a_predicate_occur() {
        let mut occurring = Occurring::default();
        for model in ModelId::ALL {
            let mut rng = Rng::new(1 ^ (model as u64) << 32);
            for candidate in in_any_rung(model) {
                let inst = candidate.inst();
                if has_predicate(inst) {
                    let operand_goals = share(inst, (model, candidate.form()), 1);
                    for line in candidate.draw_with(&mut rng, model, operand_goals) {
                        occurring.add(model, &format!("LD M8000\n{line}\nEND\n"));
                    }
                }
            }
        }
        let mut missing = occurring.missing_operands();
        let asked = |missing: &String| {
            let name = missing.split(' ').next().unwrap();
            rungc_catalogue::find(name).is_some_and(|found| has_predicate(found.inst))
        };
        missing.retain(asked);
        assert!(missing.is_empty(), "no rung has {missing:?}");
        assert!(occurring.counts().0 > 5);
    }
}
