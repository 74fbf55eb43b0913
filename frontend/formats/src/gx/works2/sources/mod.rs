//! Sources of a GX Works2 project: labels, structures, POUs in their languages, tasks, and the devices that the
//! compiler chose for labels without one.
//!
//! A part that is damaged gives what can be read of it and an entry in [`Sources::unread`]; the compiled program does
//! not depend on it.

mod assignment;
mod declaration;
mod devices;
mod gather;
mod graph;
mod label;
mod ladder;
mod networks;
mod pou;
mod structure;
mod summary;
mod table;
mod text;

pub use assignment::{Assigned, Scope, ScopeKind};
pub use devices::LabelDevice;
pub use gather::read_parts;
pub use graph::{Network, Node, NodeKind, Port, PortRole, Wire};
pub use label::{Class, Label, Place};
pub use ladder::LadderLine;
pub use pou::{Body, Pou, PouKind};
pub use structure::{Member, Structure};
pub use text::SourceFile;

use crate::gx::fields::Fields;
use rungc_syntax::DeviceRun;

/// Sources of a project, as far as they can be read.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Sources {
    /// Tables of global labels.
    pub globals: Vec<Globals>,
    /// Structures.
    pub structures: Vec<Structure>,
    /// POUs.
    pub pous: Vec<Pou>,
    /// Tasks.
    pub tasks: Vec<Task>,
    /// Devices reserved for labels without one; empty in a project without labels.
    pub reserved: Vec<DeviceRun>,
    /// Devices that the compiler chose, by the scopes that labels are declared in. It also lists labels that were
    /// deleted, whose devices stay reserved.
    pub scopes: Vec<Scope>,
    /// Parts that could not be read to their end.
    pub unread: Vec<Unread>,
}

/// A table of global labels.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Globals {
    /// Name of the table.
    pub name: String,
    /// Library that it comes from; `None` for one of the project itself.
    pub library: Option<String>,
    /// Labels, in the order of the table.
    pub labels: Vec<Label>,
}

/// A task: when which programs run.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Task {
    /// Name.
    pub name: String,
    /// Event: `TRUE` for each scan, `FALSE` with an interval, or an interrupt pointer (`I750`).
    pub event: String,
    /// Interval as written: `T#20ms`; `0` for none.
    pub interval: String,
    /// Priority: the smaller, the earlier; 31 by default.
    pub priority: u32,
    /// Names of the programs, in the order in which they run.
    pub pous: Vec<String>,
}

/// A part of a project that could not be read to its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Unread {
    /// Description: ``the labels of `MAIN` ``.
    pub what: String,
    /// Offset in the part, in bytes.
    pub at: usize,
    /// Bytes from there on, a few.
    pub bytes: Vec<u8>,
    /// True for the source of a POU. Of a plain ladder, the reader of the program reports the damage.
    pub is_source: bool,
}

impl Sources {
    /// Returns true if there is more than ladders of devices: labels, structures, or POUs in another language.
    pub fn is_structured(&self) -> bool {
        let plain = |pou: &Pou| matches!(pou.body, Body::Ladder(_) | Body::Unread);
        self.labels().next().is_some()
            || !self.structures.is_empty()
            || !self.pous.iter().all(plain)
    }

    /// All labels, those of global tables first, with the POU that declares them.
    pub fn labels(&self) -> impl Iterator<Item = (Option<&Pou>, &Label)> {
        let globals = self.globals.iter().flat_map(|table| &table.labels);
        let locals = self.pous.iter();
        let locals = locals.flat_map(|pou| pou.labels.iter().map(move |label| (Some(pou), label)));
        globals.map(|label| (None, label)).chain(locals)
    }

    /// The structure of this name.
    pub fn structure(&self, name: &str) -> Option<&Structure> {
        let mut structures = self.structures.iter();
        structures.find(|structure| structure.name.eq_ignore_ascii_case(name))
    }

    /// The POU of this name.
    pub fn pou(&self, name: &str) -> Option<&Pou> {
        let mut pous = self.pous.iter();
        pous.find(|pou| pou.name.eq_ignore_ascii_case(name))
    }
}

/// Rows of a part, which begin with their number, as far as they can be read.
struct Table<T> {
    rows: Vec<T>,
    /// Offset of the field that could not be read.
    damaged: Option<usize>,
}

/// The most bytes that follow the rows of a table: a time, and a number.
const END: usize = 32;

impl<T> Table<T> {
    fn read(fields: &mut Fields, row: fn(&mut Fields) -> Option<T>) -> Self {
        let mut rows = Vec::new();
        let mut read = || {
            let count = fields.u32()?;
            for _ in 0..count {
                rows.push(row(fields)?);
            }
            Some(())
        };
        let damaged = read().is_none() || fields.rest().len() > END;
        Table {
            rows,
            damaged: damaged.then(|| fields.at()),
        }
    }
}
