//! Random applied instructions: operands as the catalogue's rows allow them.

use crate::rng::Rng;
use rungc_catalogue::{Basic, Drive, Form, Forms, Inst, Lower, Param, Role, Shape};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::runs::FIRST_COUNTER32;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Classes, DeviceClass};

/// How many devices of a class programs use, so that instructions meet each other's results.
const CROWD: u32 = 24;

/// How many words of the buffer memory of module 0 programs use.
pub const BUFFER_WORDS: u32 = 16;

/// Special relays that change what instructions do or show what they did.
const FLAGS: [u32; 9] = [8020, 8021, 8022, 8024, 8029, 8160, 8161, 8168, 8067];

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

/// Whether nothing else of a program belongs to a basic instruction but the rest of its rung.
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

/// Whether an instruction has a form on a model.
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
        (0..6).find_map(|_| self.attempt(rng, model, None))
    }

    /// The same with all its operands, each of the class whose turn it is, if the compiler accepts that.
    pub fn draw_in_turn(&self, rng: &mut Rng, model: ModelId, turn: u32) -> Option<String> {
        // Some instructions want few of the devices that there are.
        let mut turns = [Some(turn); 6].into_iter().chain([None; 1000]);
        turns.find_map(|turn| self.attempt(rng, model, turn))
    }

    fn attempt(&self, rng: &mut Rng, model: ModelId, turn: Option<u32>) -> Option<String> {
        let params = self.inst.params_of(&[], Model::get(model));
        let mut text = self.spelling.clone();
        for param in params {
            if param.optional && turn.is_none() && rng.percent(50) {
                break;
            }
            let classes = each(param.classes_on(Model::get(model)));
            let class = match turn {
                Some(turn) => classes
                    .get((turn as usize).checked_rem(classes.len())?)
                    .copied(),
                None => rng.pick(&classes),
            };
            text.push(' ');
            text.push_str(&operand(
                rng,
                param,
                (class?, self.form),
                Model::get(model),
            )?);
        }
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

/// Whether an instruction after a contact compiles.
pub fn accepted(instruction: &str, model: ModelId) -> bool {
    let program = format!("LD M0\n{instruction}\nEND\n");
    let read = rungc_frontend::read_text("draw.il", &program);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    !read.diagnostics.has_errors() && compile(&read.program, &options).module.is_some()
}

/// The classes of a set, one by one.
pub(crate) fn each(classes: Classes) -> Vec<Classes> {
    (0..32)
        .map(|bit| Classes(1 << bit))
        .filter(|class| class.meets(classes))
        .collect()
}

fn operand(
    rng: &mut Rng,
    param: &Param,
    (class, form): (Classes, Form),
    model: &Model,
) -> Option<String> {
    let wide = form.wide && param.shape == Shape::Value || param.shape == Shape::Pair;
    if class == Classes::K || class == Classes::H {
        let bits = if wide { 32 } else { 16 };
        let value = match rng.pick(param.limits.ranges()) {
            Some((low, high)) if rng.percent(90) => {
                let span = u32::try_from(high - low).unwrap_or(u32::MAX);
                low + i64::from(rng.below(span.saturating_add(1).min(40)))
            }
            _ => rng.value(bits),
        };
        if class == Classes::H {
            let mask = if wide { 0xFFFF_FFFF } else { 0xFFFF };
            return Some(format!("H{:X}", value & mask));
        }
        return Some(format!("K{value}"));
    }
    if class == Classes::E {
        return Some(format!("E{:?}", rng.value(16) as f32 / 8.0));
    }
    if class == Classes::TEXT {
        let letters = b"ABCabc0129 -.";
        let count = 1 + rng.below(7);
        let text: String = (0..count)
            .filter_map(|_| rng.pick(letters))
            .map(char::from)
            .collect();
        return Some(format!("\"{text}\""));
    }
    let mut text = if class == Classes::BUFFER {
        // There is no module 1.
        let module = u32::from(rng.percent(5));
        format!("U{module}\\G{}", rng.below(BUFFER_WORDS))
    } else {
        device(rng, (param, model), class, wide)?
    };
    if param.indexable && rng.percent(12) {
        text.push_str(rng.pick(&["Z0", "Z1", "V0", "V1"])?);
    }
    Some(text)
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

fn device(
    rng: &mut Rng,
    (param, model): (&Param, &Model),
    class: Classes,
    wide: bool,
) -> Option<String> {
    let group = |class| [Classes::KNX, Classes::KNY, Classes::KNM, Classes::KNS].contains(&class);
    if group(class) {
        let letters = match class {
            Classes::KNX => DeviceClass::X,
            Classes::KNY => DeviceClass::Y,
            Classes::KNM => DeviceClass::M,
            _ => DeviceClass::S,
        };
        let digits = 1 + rng.below(if wide { 8 } else { 4 });
        let first = if rng.percent(80) {
            8 * rng.below(3)
        } else {
            rng.below(CROWD)
        };
        return Some(format!("K{digits}{}", letters.number(first)));
    }
    let letters = DeviceClass::ALL
        .into_iter()
        .find(|&c| Classes::of_device(c) == class)?;
    if let Some(&(_, first, last)) = param.numbers_on(model).iter().find(|(c, ..)| *c == letters) {
        let number = first + rng.below(last - first + 1);
        return Some(letters.number(number).to_string());
    }
    let number = match letters {
        DeviceClass::D if rng.percent(6) => special_register(rng, model),
        DeviceClass::V | DeviceClass::Z => rng.below(3),
        DeviceClass::M if param.role != Role::Read && rng.percent(4) => rng.pick(&FLAGS)?,
        DeviceClass::C if wide => first_counter32(model) + rng.below(6),
        DeviceClass::T | DeviceClass::C => rng.below(6),
        DeviceClass::P | DeviceClass::I | DeviceClass::N => return None,
        _ if rng.percent(50) => 2 * rng.below(CROWD / 2),
        _ => rng.below(CROWD),
    };
    Some(letters.number(number).to_string())
}

#[cfg(test)]
mod tests {
    use super::{Rng, in_any_rung};
    use rungc_models::ModelId;

    #[test]
    fn every_implemented_instruction_is_drawn() {
        let mut rng = Rng::new(1);
        let mut never = Vec::new();
        for model in ModelId::ALL {
            for candidate in in_any_rung(model) {
                let drawn = (0..200).find_map(|_| candidate.draw(&mut rng, model));
                if drawn.is_none() {
                    never.push(format!("{model:?} {}", candidate.spelling));
                }
            }
        }
        assert!(never.is_empty(), "{never:?}");
    }
}
