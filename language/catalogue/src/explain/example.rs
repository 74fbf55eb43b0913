//! Small programs that show an instruction.

use super::FORMS;
use crate::{Classes, Drive, Inst, Limits, Param, Rule};
use rungc_models::Model;
use rungc_syntax::DeviceClass;

impl Inst {
    /// A small program that shows it on a model.
    pub fn example_on(&self, model: &Model) -> String {
        if let Some(example) = self.example {
            return example.to_owned();
        }
        let form = FORMS
            .into_iter()
            .find(|&form| self.has_form_on(form, model.id));
        let spelling = form.and_then(|form| self.spelling_of(form));
        let mut line = spelling.unwrap_or_else(|| self.name.to_owned());
        let mut next = Next::default();
        for param in self.params_of(&[], model) {
            line.push(' ');
            line.push_str(&next.operand(param, model));
        }
        match self.drive {
            Drive::Contact => format!("LD X000\n{line}"),
            Drive::Alone => line,
            Drive::Logic if self.name.starts_with("LD") => format!("{line}\nOUT Y000"),
            Drive::Logic => format!("LD X000\n{line}\nOUT Y000"),
        }
    }
}

/// The next devices that an example takes, so that its operands do not overlap.
#[derive(Default)]
struct Next {
    registers: u32,
    relays: u32,
}

impl Next {
    /// An operand that a parameter accepts.
    fn operand(&mut self, param: &Param, model: &Model) -> String {
        if let Some(&(class, first, _)) =
            param.numbers_on(model).iter().find(|(class, first, _)| {
                model.has(*class, *first) && *first != 0 || *class == DeviceClass::Y
            })
        {
            return class.number(first).to_string();
        }
        let classes = param.classes_on(model);
        if param.limits != Limits::None && classes.meets(Classes::K) {
            return constant(param);
        }
        let first_data = if model.has(DeviceClass::R, 99) && !model.has(DeviceClass::R, 100) {
            1000
        } else {
            0
        };
        const ORDER: [(Classes, &str); 10] = [
            (Classes::D, "D"),
            (Classes::M, "M"),
            (Classes::X, "X000"),
            (Classes::Y, "Y000"),
            (Classes::S, "S20"),
            (Classes::C, "C0"),
            (Classes::T, "T0"),
            (Classes::R, "R0"),
            (Classes::KNX, "K4X000"),
            (Classes::KNM, "K4M0"),
        ];
        let found = ORDER.iter().find(|(class, _)| classes.meets(*class));
        match found {
            Some((_, "D")) => {
                let number = first_data + self.registers;
                let roomy = model.has(DeviceClass::D, 300);
                self.registers += if roomy { 100 } else { 50 };
                format!("D{number}")
            }
            Some((_, "M")) => {
                let number = self.relays;
                self.relays += 160;
                format!("M{number}")
            }
            Some((_, device)) => (*device).to_owned(),
            None if classes.meets(Classes::P) => "P0".to_owned(),
            None if classes.meets(Classes::N) => "N0".to_owned(),
            None if classes.meets(Classes::TEXT) => "\"ABC\"".to_owned(),
            None => constant(param),
        }
    }
}

/// A constant that a parameter accepts: 4 where it may be.
fn constant(param: &Param) -> String {
    let ruled = param.rules.iter().find_map(|rule| match *rule {
        Rule::MultipleOf(of) => Some(of),
        Rule::AtMost(_) | Rule::Below(_) => Some(1),
        _ => None,
    });
    let wanted = param.limits.nearest(ruled.unwrap_or(4));
    format!("K{wanted}")
}
