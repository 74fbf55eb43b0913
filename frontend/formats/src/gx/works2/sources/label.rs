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

/// The rows of a label table, which begins with their number.
pub(super) fn labels(fields: &mut Fields) -> Table<Label> {
    Table::read(fields, label)
}

fn label(fields: &mut Fields) -> Option<Label> {
    let (name, data_type) = (fields.text()?, fields.text()?);
    let class = Class::of(fields.u32()?)?;
    let place = place(fields)?;
    let members = members(fields)?;
    let initial = fields.text()?;
    fields.text()?;
    // Number of the row.
    fields.u32()?;
    let comment = fields.text()?;
    let is_array = fields.u32()? == 1;
    // Code of the type, which its text names.
    fields.u32()?;
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
        type_name: fields.text()?,
    })
}

fn place(fields: &mut Fields) -> Option<Place> {
    Some(Place {
        device: fields.text()?,
        address: fields.text()?,
    })
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
