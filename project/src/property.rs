//! `[[property]]` and `[verify]`: what a program must never do, and what is supposed of the machine around it.

use crate::{Named, Range};
use rungc_syntax::Span;

/// A requirement on a program, from the sheet of whoever asks for the machine.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Requirement {
    /// Identifier: properties and test cases name it.
    pub id: String,
    /// Text of the sheet; empty if the settings do not have it.
    pub text: String,
    /// Place in the sheet, such as a document and a section; empty if the settings do not have it.
    pub source: String,
    /// Position in the file.
    pub span: Span,
}

/// A property. Conditions are as written; what they mean is the caller's to know.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Row {
    /// Name, if it has one.
    pub name: Option<String>,
    /// Identifier of the requirement that it belongs to, one of [`crate::Project::requirements`].
    pub requirement: Option<String>,
    /// The property.
    pub kind: PropertyKind,
    /// Position in the file.
    pub span: Span,
}

/// Kind of a property.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum PropertyKind {
    /// `never = "…"`
    Never(Named),
    /// `always = "…"`
    Always(Named),
    /// `reachable = "…"`
    Reachable(Named),
    /// `whenever = "…"`, `then = "…"`, and perhaps `within = "2s"`.
    Whenever {
        /// Triggering condition.
        when: Named,
        /// Condition that must follow.
        then: Named,
        /// Time limit; none: in the same scan.
        within: Option<Named>,
    },
    /// `stays = "…"`, and perhaps `after = "…"` and `until = "…"`.
    Stays {
        /// Condition from which on the other must hold; none: it must keep holding once it holds.
        after: Option<Named>,
        /// Condition that must keep holding.
        holds: Named,
        /// Condition that ends it.
        until: Option<Named>,
    },
}

/// Several properties by one row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Use {
    /// Name, if it has one.
    pub name: Option<String>,
    /// Identifier of the requirement that its properties belong to, one of [`crate::Project::requirements`].
    pub requirement: Option<String>,
    /// Source of the properties.
    pub source: UseSource,
    /// Position in the file.
    pub span: Span,
}

/// Source of several properties.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum UseSource {
    /// `use = "two-hand"`: a safety function with its parameters.
    Function {
        /// Name of the function, as written.
        function: Named,
        /// All other keys of the row.
        parameters: Vec<Parameter>,
    },
    /// `matrix = "cause-effect.csv"`: path of a cause-and-effect matrix.
    Matrix(Named),
}

/// A parameter of a safety function, as written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Parameter {
    /// Its key.
    pub key: Named,
    /// Its value, or those of a list.
    pub values: Vec<Named>,
}

impl PropertyKind {
    /// The conditions.
    pub fn conditions(&self) -> Vec<&Named> {
        match self {
            PropertyKind::Never(only)
            | PropertyKind::Always(only)
            | PropertyKind::Reachable(only) => vec![only],
            PropertyKind::Whenever { when, then, .. } => vec![when, then],
            PropertyKind::Stays {
                after,
                holds,
                until,
            } => [after.as_ref(), Some(holds), until.as_ref()]
                .into_iter()
                .flatten()
                .collect(),
        }
    }
}

/// `[verify]`
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Verify {
    /// Conditions that hold after every scan.
    pub assume: Vec<Named>,
    /// Devices that something other than the program may write.
    pub free: Vec<Range>,
    /// The longest time from one scan to the next.
    pub scan: Option<Named>,
    /// Limit of the effort for each property, in steps of the search.
    pub effort: Option<u32>,
    /// Time limit for each property.
    pub timeout: Option<Named>,
}
