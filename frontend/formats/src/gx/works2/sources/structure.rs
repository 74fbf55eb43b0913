//! Structures: `*.str`, in a library `*.lns`.

use super::{Table, label};
use crate::gx::fields::Fields;

/// A structure: a data type of named members.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Structure {
    /// Name.
    pub name: String,
    /// Library that it comes from; `None` for one of the project itself.
    pub library: Option<String>,
    /// Members, in the order of their list.
    pub members: Vec<Member>,
}

/// A member of a structure.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Member {
    /// Name.
    pub name: String,
    /// Data type as written.
    pub data_type: String,
    /// Initial value as written.
    pub initial: String,
    /// Number by which labels order the devices of their members.
    pub number: u32,
    /// Comment.
    pub comment: String,
    /// True for an array.
    pub is_array: bool,
    /// Name of the structure or block that is its type, or that of its elements; empty for elementary types.
    pub type_name: String,
}

impl Structure {
    /// Members in the order in which labels list their devices.
    pub fn numbered(&self) -> Vec<&Member> {
        let mut members: Vec<_> = self.members.iter().collect();
        members.sort_by_key(|member| member.number);
        members
    }
}

/// The members of a structure, which begin with their number.
pub(super) fn members(fields: &mut Fields) -> Table<Member> {
    Table::read(fields, member)
}

fn member(fields: &mut Fields) -> Option<Member> {
    let (name, data_type) = (label::name(fields)?, fields.whole_text()?);
    let initial = fields.whole_text()?;
    fields.whole_text()?;
    let number = fields.u32()?;
    let comment = fields.whole_text()?;
    let (is_array, type_name) = label::end_of_row(fields, &data_type)?;
    Some(Member {
        name,
        data_type,
        initial,
        number,
        comment,
        is_array,
        type_name,
    })
}
