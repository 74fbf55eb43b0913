//! Random applied instructions: operands as the catalogue's rows allow them.

use crate::rng::Rng;
use rungc_catalogue::{Drive, Form, Forms, Inst, Lower, Param, Role, Shape};
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
    rungc_catalogue::all()
        .filter(|inst| inst.models.has(model) && inst.drive == Drive::Contact)
        .filter(|inst| {
            let lower = inst.lower_on_model(model);
            !matches!(lower, Lower::Basic(_) | Lower::Compare(..) | Lower::Todo(_))
        })
        .flat_map(|inst| {
            let has = inst.forms_on(model);
            let spellings = inst.spellings().into_iter();
            spellings
                .filter(move |(spelling, form)| {
                    let width = if form.wide { Forms::W32 } else { Forms::W16 };
                    // A spelling without its D is another name on some models only.
                    let bare = rungc_catalogue::find(spelling).is_none_or(|found| found.bare);
                    has.has(width) && (!form.pulse || has.has(Forms::PULSE)) && !bare
                })
                .map(move |(spelling, form)| Candidate {
                    spelling,
                    form,
                    inst,
                })
        })
        .collect()
}

impl Candidate {
    /// The instruction's row.
    pub fn inst(&self) -> &'static Inst {
        self.inst
    }

    /// The instruction with random operands that the compiler accepts; `None` if it was not lucky.
    pub fn draw(&self, rng: &mut Rng, model: ModelId) -> Option<String> {
        (0..6).find_map(|_| {
            let params = self.inst.params_of(&[], Model::get(model));
            let mut text = self.spelling.clone();
            for param in params {
                if param.optional && rng.percent(50) {
                    break;
                }
                text.push(' ');
                text.push_str(&operand(rng, param, self.form, Model::get(model))?);
            }
            accepted(&text, model).then_some(text)
        })
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
fn each(classes: Classes) -> Vec<Classes> {
    (0..32)
        .map(|bit| Classes(1 << bit))
        .filter(|class| class.meets(classes))
        .collect()
}

fn operand(rng: &mut Rng, param: &Param, form: Form, model: &Model) -> Option<String> {
    let class = rng.pick(&each(param.classes_on(model)))?;
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
    use super::{Rng, candidates};
    use rungc_models::ModelId;

    #[test]
    fn every_implemented_instruction_is_drawn() {
        let mut rng = Rng::new(1);
        let mut never = Vec::new();
        for model in ModelId::ALL {
            for candidate in candidates(model) {
                let drawn = (0..200).find_map(|_| candidate.draw(&mut rng, model));
                if drawn.is_none() {
                    never.push(format!("{model:?} {}", candidate.spelling));
                }
            }
        }
        assert!(never.is_empty(), "{never:?}");
    }
}
