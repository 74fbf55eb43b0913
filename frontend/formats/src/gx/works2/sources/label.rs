//! Labels: tables of global labels (`*.gh`, in a library `*.lng`) and those of a POU (`*.lh`, in a library `*.lnl`).

use super::Table;
use crate::gx::fields::Fields;

/// A label: a row of a label table.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// Name. Names that differ in case alone are equal.
    pub name: String,
    /// Data type as written: `BOOL`, `ARRAY [0..7] OF DINT`, or the name of a structure or block.
    pub data_type: String,
    /// Section of the declaration that it belongs to.
    pub class: Class,
    /// Device as written (`X010`, `TC0`, `K1M100`, `D0.1`); empty if the compiler chooses one.
    pub device: String,
    /// Address in the notation of IEC 61131-3 (`%MX0.100`); empty without a device.
    pub address: String,
    /// Devices of the members of a structure, in the order of the members' numbers; empty for other types, and where
    /// the compiler chooses them. Of an array of structures, the devices of its two parts.
    pub members: Vec<Place>,
    /// Initial value as written. A constant has one; GX Works2 compiles no other for an FX CPU.
    pub initial: String,
    /// Comment.
    pub comment: String,
    /// True for an array.
    pub is_array: bool,
    /// Name of the structure or block that is its type, or that of its elements; empty for elementary types.
    pub type_name: String,
}

/// Device and address of a member of a structure.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Place {
    /// Device as written; empty if the compiler chooses one.
    pub device: String,
    /// Address in the notation of IEC 61131-3.
    pub address: String,
}

/// Class of a label.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Class {
    /// Input of a block or function.
    Input,
    /// Output of a block or function.
    Output,
    /// Input and output of a block or function, passed by reference.
    InOut,
    /// Variable of a POU.
    Var,
    /// Constant of a POU.
    Constant,
    /// Global variable.
    Global,
    /// Global constant.
    GlobalConstant,
}

impl Class {
    /// Name of the class in the label tables of GX Works2.
    pub const fn name(self) -> &'static str {
        match self {
            Class::Input => "VAR_INPUT",
            Class::Output => "VAR_OUTPUT",
            Class::InOut => "VAR_IN_OUT",
            Class::Var => "VAR",
            Class::Constant => "VAR_CONSTANT",
            Class::Global => "VAR_GLOBAL",
            Class::GlobalConstant => "VAR_GLOBAL_CONSTANT",
        }
    }

    /// First line of a section of such labels in the notation of IEC 61131-3.
    pub const fn section(self) -> &'static str {
        match self {
            Class::Constant => "VAR CONSTANT",
            Class::GlobalConstant => "VAR_GLOBAL CONSTANT",
            _ => self.name(),
        }
    }

    const fn of(code: u32) -> Option<Self> {
        Some(match code {
            1 => Class::Var,
            2 => Class::Constant,
            3 => Class::Input,
            4 => Class::Output,
            5 => Class::InOut,
            8 => Class::Global,
            9 => Class::GlobalConstant,
            _ => return None,
        })
    }
}

/// The rows of a table of global labels, which begins with their number.
pub(super) fn globals(fields: &mut Fields) -> Table<Label> {
    let row = |fields: &mut Fields| label(fields, &[Class::Global, Class::GlobalConstant]);
    Table::read(fields, row)
}

/// The rows of the labels of a POU, which begin with their number.
pub(super) fn locals(fields: &mut Fields) -> Table<Label> {
    use Class::{Constant, InOut, Input, Output, Var};
    let row = |fields: &mut Fields| label(fields, &[Var, Constant, Input, Output, InOut]);
    Table::read(fields, row)
}

fn label(fields: &mut Fields, classes: &[Class]) -> Option<Label> {
    let (name, data_type) = (name(fields)?, fields.whole_text()?);
    let is_class = |code: &u32| Class::of(*code).is_some_and(|class| classes.contains(&class));
    let class = Class::of(fields.checked(Fields::u32, is_class)?)?;
    let place = place(fields)?;
    let members = members(fields)?;
    let initial = fields.whole_text()?;
    fields.whole_text()?;
    // Number of the row.
    fields.u32()?;
    let comment = fields.whole_text()?;
    let (is_array, type_name) = end_of_row(fields, &data_type)?;
    Some(Label {
        name,
        data_type,
        class,
        device: place.device,
        address: place.address,
        members,
        initial,
        comment,
        is_array,
        type_name,
    })
}

/// A name of a label or member.
pub(super) fn name(fields: &mut Fields) -> Option<String> {
    let is_name = |name: &String| -> bool {
        !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_')
    };
    fields.checked(Fields::whole_text, is_name)
}

/// The end of a row of labels or members: whether its type is an array, and the name of the structure or block that is
/// its type, or that of its elements. Both, and a code between them, must fit the type's text.
pub(super) fn end_of_row(fields: &mut Fields, data_type: &str) -> Option<(bool, String)> {
    const ELEMENTARY: [&str; 8] = [
        "BOOL", "INT", "DINT", "WORD", "DWORD", "REAL", "TIME", "STRING",
    ];
    let element = data_type
        .strip_prefix("ARRAY")
        .map(|rest| rest.rsplit_once(" OF ").map_or("", |(_, of)| of.trim()));
    let is_array = element.is_some();
    fields.checked(Fields::u32, |&flag| flag == u32::from(is_array))?;
    let element = element.unwrap_or(data_type);
    // The length of a string follows its type.
    let word = element
        .split(['(', '['])
        .next()
        .unwrap_or_default()
        .trim_end();
    let of = ELEMENTARY
        .iter()
        .position(|known| known.eq_ignore_ascii_case(word));
    fields.checked(Fields::u32, |&code| match of {
        Some(at) => code as usize == at + 1,
        None => !(1..=ELEMENTARY.len()).contains(&(code as usize)),
    })?;
    let is_type = |name: &String| match of {
        Some(_) => name.is_empty(),
        None => name.is_empty() || name == element,
    };
    let type_name = fields.checked(Fields::whole_text, is_type)?;
    Some((is_array, type_name))
}

fn place(fields: &mut Fields) -> Option<Place> {
    let read = |fields: &mut Fields| {
        Some(Place {
            device: fields.whole_text()?,
            address: fields.whole_text()?,
        })
    };
    fields.checked(read, Place::is_sound)
}

impl Place {
    /// Returns true unless device and address have different numbers. A device may be part of another, or of digits;
    /// then only its characters are looked at.
    fn is_sound(&self) -> bool {
        let is_letter = |c: char| c.is_ascii_alphanumeric() || ".@[]\\".contains(c);
        if !self.device.chars().all(is_letter) {
            return false;
        }
        let digits = self
            .device
            .trim_start_matches(|c: char| c.is_ascii_uppercase());
        let class = &self.device[..self.device.len() - digits.len()];
        let radix = if matches!(class, "X" | "Y") { 8 } else { 10 };
        let stated = self.address.rsplit(|c: char| !c.is_ascii_digit()).next();
        let stated = stated.and_then(|digits| digits.parse::<u32>().ok());
        match (u32::from_str_radix(digits, radix), stated) {
            (Ok(number), Some(stated)) => number == stated,
            _ => self.address.is_empty() || self.address.starts_with('%'),
        }
    }
}

/// The devices of members. Their form comes first: none, those of a structure, those of an array of structures.
fn members(fields: &mut Fields) -> Option<Vec<Place>> {
    match fields.u32()? {
        0 => Some(Vec::new()),
        1 => {
            let count = fields.u32()?;
            (0..count).map(|_| place(fields)).collect()
        }
        2 => {
            let first = place(fields)?;
            fields.u32()?;
            Some(vec![first, place(fields)?])
        }
        _ => None,
    }
}
