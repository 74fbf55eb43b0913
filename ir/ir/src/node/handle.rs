//! Handles: what expressions, statements and a module call each other by.

/// Handle of an expression in [`Module::exprs`](super::Module::exprs).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct ExprId(pub u32);

/// Handle of a temporary; its type is in [`Module::temps`](super::Module::temps). Assigned by
/// [`Action::Let`](super::Action::Let), [`Action::Edge`](super::Action::Edge) or
/// [`Action::Fetch`](super::Action::Fetch) before any use on every path, in the same [`Function`](super::Function),
/// which may be in a body around or before the use; some are assigned in several places.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct TempId(pub u32);

/// Handle of an edge memory: one bit, off at power-on and when RUN begins. Several statements may share one: each
/// stores its input.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct EdgeId(pub u32);

/// Handle of a [`Flag`](super::Flag) in [`Module::flags`](super::Module::flags).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct FlagId(pub u32);

/// Handle of a [`Cell`](super::Cell) in [`Module::cells`](super::Module::cells).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct CellId(pub u32);

/// Handle of a [`Table`](super::Table) in [`Module::tables`](super::Module::tables).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct TableId(pub u32);

/// Makes handles index their tables ([`typed_index_collections::TiVec`]).
macro_rules! indexes {
    ($($handle:ident)*) => {$(
        impl From<usize> for $handle {
            fn from(index: usize) -> Self {
                $handle(index as u32)
            }
        }

        impl From<$handle> for usize {
            fn from(handle: $handle) -> usize {
                handle.0 as usize
            }
        }
    )*};
}
indexes!(ExprId TempId EdgeId FlagId CellId TableId);

/// Label of a part, unique in its function.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct LabelId(pub u32);
