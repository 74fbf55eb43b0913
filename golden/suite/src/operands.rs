//! Random applied instructions: operands as the catalogue's rows allow them.

use crate::fitting::{self, Place};
use crate::rng::Rng;
use rungc_catalogue::{Basic, Drive, Form, Forms, Inst, Lower, Param, Rule, When};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::runs::FIRST_COUNTER32;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Classes, DeviceClass};

/// Number of devices of a class that programs use, so that instructions meet each other's results.
pub(crate) const CROWD: u32 = 24;

/// Number of words in the buffer memory of module 0 that programs use.
pub const BUFFER_WORDS: u32 = 16;

/// Special relays that change what instructions do or show what they did.
pub(crate) const FLAGS: [u32; 9] = [8020, 8021, 8022, 8024, 8029, 8160, 8161, 8168, 8067];

/// An instruction that may be drawn: how it is written, and its row.
#[derive(Clone, Debug)]
pub struct Candidate {
    spelling: String,
    form: Form,
    inst: &'static Inst,
}

/// All applied instructions that a model has and that are implemented.
pub fn candidates(model: ModelId) -> Vec<Candidate> {
    select(model, |inst| {
        let lower = inst.lower_on_model(model);
        inst.drive == Drive::Contact && !matches!(lower, Lower::Basic(_) | Lower::Compare(..))
    })
}

/// All instructions of a model that may stand in any rung, in all their forms: applied ones, contacts, coils,
/// comparisons.
pub fn in_any_rung(model: ModelId) -> Vec<Candidate> {
    let mut found = select(model, |inst| match inst.lower_on_model(model) {
        Lower::Basic(basic) => stands_alone(basic),
        _ => true,
    });
    found.retain(|found| found.inst.spelling_of(found.form).as_ref() == Some(&found.spelling));
    found
}

/// Returns true if a basic instruction needs nothing else of a program but the rest of its rung.
fn stands_alone(basic: Basic) -> bool {
    use Basic::{And, Andf, Andp, Ani, Inv, Ld, Ldf, Ldi, Ldp, Mef, Mep, Nop, Or, Orf, Ori, Orp};
    use Basic::{Out, Plf, Pls, Rst, Set, Wdt};
    let logic = matches!(
        basic,
        Ld | Ldi | Ldp | Ldf | And | Ani | Andp | Andf | Or | Ori | Orp | Orf
    );
    logic
        || matches!(
            basic,
            Inv | Mep | Mef | Nop | Out | Set | Rst | Pls | Plf | Wdt
        )
}

/// The implemented instructions of a model that are wanted, in all their spellings.
fn select(model: ModelId, is_wanted: impl Fn(&Inst) -> bool) -> Vec<Candidate> {
    rungc_catalogue::all()
        .filter(|inst| inst.models.has(model) && is_wanted(inst))
        .filter(|inst| !matches!(inst.lower_on_model(model), Lower::Todo(_)))
        .flat_map(|inst| {
            let spellings = inst.spellings().into_iter();
            spellings
                .filter(move |(spelling, form)| {
                    // A spelling without its D is another name on some models only.
                    let bare = rungc_catalogue::find(spelling).is_none_or(|found| found.bare);
                    has_form(inst, *form, model) && !bare
                })
                .map(move |(spelling, form)| Candidate {
                    spelling,
                    form,
                    inst,
                })
        })
        .collect()
}

/// Returns true if an instruction has a form on a model.
pub fn has_form(inst: &Inst, form: Form, model: ModelId) -> bool {
    let has = inst.forms_on(model);
    let width = if form.wide { Forms::W32 } else { Forms::W16 };
    inst.models.has(model) && has.has(width) && (!form.pulse || has.has(Forms::PULSE))
}

impl Candidate {
    /// The instruction's row.
    pub fn inst(&self) -> &'static Inst {
        self.inst
    }

    /// Its form.
    pub fn form(&self) -> Form {
        self.form
    }

    /// The instruction with random operands that the compiler accepts; `None` if it was not lucky.
    pub fn draw(&self, rng: &mut Rng, model: ModelId) -> Option<String> {
        let lists = lists(self.inst, model);
        (0..TRIES).find_map(|time| {
            let list = rng.pick(&lists)?;
            let mut classes = Vec::new();
            for param in list.params {
                if param.optional && rng.percent(50) {
                    break;
                }
                classes.push(rng.pick(&list.classes(classes.len(), model, self.form))?);
            }
            let classes = list.related(classes, (model, self.form), 0);
            self.attempt(rng, model, &list, &classes, time)
        })
    }

    /// The instruction with each of these among its operands, in as few lines as that takes; those that the compiler
    /// rejects with whatever stands beside them are missing. Without goals it is one line.
    pub fn draw_with(
        &self,
        rng: &mut Rng,
        model: ModelId,
        mut operand_goals: Vec<OperandGoal>,
    ) -> Vec<String> {
        let lists = lists(self.inst, model);
        let mut drawn: Vec<String> = Vec::new();
        while let Some(&first) = operand_goals.first() {
            let list = &lists[first.list];
            let found = (0..WISHES).find_map(|time| {
                let classes = (0..list.params.len()).map(|at| {
                    let goal = operand_goals
                        .iter()
                        .find(|goal| goal.list == first.list && goal.at == at);
                    match goal {
                        Some(goal) if time < WISHES / 2 || *goal == first => Some(goal.class),
                        _ => rng.pick(&list.classes(at, model, self.form)),
                    }
                });
                let classes = list.related(
                    classes.collect::<Option<_>>()?,
                    (model, self.form),
                    first.at,
                );
                let text = self.attempt(rng, model, list, &classes, time)?;
                Some((text, classes))
            });
            let (text, classes) = found.unzip();
            drawn.extend(text);
            let classes = classes.unwrap_or_default();
            operand_goals.retain(|goal| {
                let is_met = goal.list == first.list && classes.get(goal.at) == Some(&goal.class);
                *goal != first && !is_met
            });
        }
        if drawn.is_empty() {
            drawn.extend((0..WISHES).find_map(|_| self.draw(rng, model)));
        }
        drawn
    }

    fn attempt(
        &self,
        rng: &mut Rng,
        model: ModelId,
        list: &List,
        classes: &[Classes],
        time: u32,
    ) -> Option<String> {
        let place = Place {
            model: Model::get(model),
            form: self.form,
            params: list.params,
            classes,
            first: list.numbers,
            // Some instructions want many of the devices that there are.
            is_small: time % 3 == 2,
        };
        let operands = fitting::draw(rng, place)?;
        let text = std::iter::once(self.spelling.clone()).chain(operands);
        let text = text.collect::<Vec<_>>().join(" ");
        accepted(&self.after_contact(&text), model).then_some(text)
    }

    /// The instruction as it may stand after a contact, with what belongs to it.
    pub fn after_contact(&self, text: &str) -> String {
        match self.inst.drive {
            Drive::Logic if text.starts_with("LD") => format!("{text}\nANB\nOUT M0"),
            Drive::Logic => format!("{text}\nOUT M0"),
            Drive::Contact | Drive::Alone => text.to_string(),
        }
    }
}

/// Returns true if an instruction after a contact compiles.
pub fn accepted(instruction: &str, model: ModelId) -> bool {
    let program = format!("LD M0\n{instruction}\nEND\n");
    let read = rungc_frontend::read_text("draw.il", &program);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    !read.diagnostics.has_errors() && compile(&read.program, &options).module.is_some()
}

/// Attempts to draw operands. Almost all fit the first time; the conditions of rules' functions, and those on the whole
/// instruction, are left to the compiler.
const TRIES: u32 = 6;
const WISHES: u32 = 24;

/// The classes of a set, one by one.
pub(crate) fn each(classes: Classes) -> Vec<Classes> {
    (0..32)
        .map(|bit| Classes(1 << bit))
        .filter(|class| class.meets(classes))
        .collect()
}

/// Operands that an instruction may have on a model: OUT Y000 has others than OUT T0.
#[derive(Clone, Copy, Debug)]
struct List {
    params: &'static [Param],
    /// Class of the first operand.
    first: Classes,
    /// Its numbers, where these decide.
    numbers: Option<(u32, u32)>,
}

impl List {
    /// The classes of an operand.
    fn classes(&self, at: usize, model: ModelId, form: Form) -> Vec<Classes> {
        let (param, model) = (&self.params[at], Model::get(model));
        let classes = param.classes_on(model);
        // A pair of V and Z is named by its Z.
        let is_half = model.z_pairs_with_v && fitting::words(param, form) == 2;
        let classes = classes.without(if is_half { Classes::V } else { Classes::NONE });
        let pointers = Classes::P.or(Classes::I).or(Classes::N);
        let mut classes = each(classes.without(pointers));
        classes.retain(|class| at > 0 || class.meets(self.first));
        classes
    }

    /// These classes as rules demand that they go together; that of one operand stays.
    fn related(
        &self,
        mut classes: Vec<Classes>,
        (model, form): (ModelId, Form),
        stays: usize,
    ) -> Vec<Classes> {
        let rules = self.params.iter().zip(0..classes.len());
        for (rule, at) in rules.flat_map(|(param, at)| param.rules.iter().map(move |r| (r, at))) {
            let (Rule::ClassLike(other) | Rule::GroupLike(other)) = *rule else {
                continue;
            };
            let Some(&of_other) = classes.get(other) else {
                continue;
            };
            let (changed, like) = match at == stays {
                true => (other, classes[at]),
                false => (at, of_other),
            };
            let is_alike = |class: Classes| match rule {
                Rule::ClassLike(_) => class == like,
                _ => fitting::is_group(class) == fitting::is_group(like),
            };
            if !is_alike(classes[changed]) {
                let mut fitting = self.classes(changed, model, form).into_iter();
                classes[changed] = fitting.find(|&c| is_alike(c)).unwrap_or(classes[changed]);
            }
        }
        classes
    }
}

/// The operands that an instruction may have on a model, most often one list.
fn lists(inst: &Inst, model: ModelId) -> Vec<List> {
    let mut lists: Vec<List> = Vec::new();
    let mut others = Classes(u32::MAX);
    let variants = inst
        .variants
        .iter()
        .filter(|variant| variant.models.has(model));
    for variant in variants {
        let Some(params) = variant.params else {
            continue;
        };
        match variant.when {
            // Later conditions are not examined.
            When::Always => break,
            When::Indexed => continue,
            When::First(first, low, high) => {
                let numbers = (low > 0 || high < u32::MAX).then_some((low, high));
                let known = |list: &List| list.first == first && list.numbers == numbers;
                if !lists.iter().any(known) {
                    lists.push(List {
                        params,
                        first,
                        numbers,
                    });
                    others = others.without(first);
                }
            }
        }
    }
    let params = inst.params_of(&[], Model::get(model));
    lists.push(List {
        params,
        first: others,
        numbers: None,
    });
    lists
}

/// An operand of a class that an instruction is to have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct OperandGoal {
    /// Index of the list of operands that the instruction may have.
    list: usize,
    /// Index of the operand.
    at: usize,
    class: Classes,
}

/// The operands that an instruction may have on a model, of each class, by their names and classes.
pub fn operand_goals(
    inst: &Inst,
    model: ModelId,
    form: Form,
) -> Vec<((&'static str, Classes), OperandGoal)> {
    let mut operand_goals = Vec::new();
    for (number, list) in lists(inst, model).iter().enumerate() {
        for (at, param) in list.params.iter().enumerate() {
            for class in list.classes(at, model, form) {
                let goal = OperandGoal {
                    list: number,
                    at,
                    class,
                };
                operand_goals.push(((param.name, class), goal));
            }
        }
    }
    operand_goals
}

/// A special register that is another name of an index register, or precedes one.
pub fn special_register(rng: &mut Rng, model: &Model) -> u32 {
    let aliases = model.index_aliases;
    let first = aliases[rng.below(aliases.len() as u32) as usize].register;
    first.number() - rng.below(4).saturating_sub(1)
}

/// The first 32-bit counter of a model.
pub fn first_counter32(model: &Model) -> u32 {
    let mut numbers = FIRST_COUNTER32..256;
    let first = numbers.find(|&number| model.has(DeviceClass::C, number));
    first.unwrap_or(FIRST_COUNTER32)
}

#[cfg(test)]
mod tests {
    use super::{Rng, in_any_rung};
    use rungc_models::ModelId;

    /// Operands are computed, not found by chance: what remains to chance are rules that are functions.
    #[test]
    fn almost_all_operands_fit_at_once() {
        let mut rng = Rng::new(1);
        let (mut count, mut seldom) = (0, Vec::new());
        for model in ModelId::ALL {
            for candidate in in_any_rung(model) {
                count += 1;
                if candidate.draw(&mut rng, model).is_none() {
                    seldom.push(format!("{model:?} {}", candidate.spelling));
                }
            }
        }
        assert!(
            seldom.len() * 100 < count,
            "{} of {count}: {seldom:?}",
            seldom.len()
        );
    }
}
