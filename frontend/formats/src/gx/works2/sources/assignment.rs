//! Devices that the compiler chose for labels without one: `LockVariable.map` in the compiler's store, an OLE compound
//! file (`ESCompiler.stg`). The store keeps them so that a label has the same device after the next compilation.

use super::super::container::Container;
use crate::encoding::decode_text;
use crate::gx::fields::Fields;
use encoding_rs::Encoding;
use rungc_syntax::{Device, DeviceClass};

/// A scope: what one program, instance or structure declares.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Scope {
    /// Name: of an instance `PROGRAM.INSTANCE`.
    pub name: String,
    /// Kind.
    pub kind: ScopeKind,
    /// Type of a block's instance; empty for others.
    pub block: String,
    /// Labels and temporaries (`__B0_1`, `__W0_1`), in the order of the file.
    pub variables: Vec<Assigned>,
}

/// Kind of a scope.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ScopeKind {
    /// Global labels.
    Globals,
    /// Program.
    Program,
    /// Instance of a block.
    Instance,
    /// Function.
    Function,
    /// Structure.
    Structure,
    /// Task that runs by an interval, and others.
    Other(u32),
}

/// A label or temporary, and its device.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Assigned {
    /// Name.
    pub name: String,
    /// First device; `None` for a value passed by reference and for a class that is not known.
    pub device: Option<Device>,
    /// Number of devices from there on.
    pub count: u32,
    /// Of a structure or array of structures, the first device of its members of one bit.
    pub bits: Option<Device>,
    /// Labels of a structure or instance.
    pub members: Option<Box<Scope>>,
}

/// The stream that lists the contents of the store.
const INDEX: &str = "Index";
/// The content that holds the devices.
const MAP: &str = "LockVariable.map";
/// Nesting of structures and instances.
const DEEPEST: usize = 16;

/// The content of the map in a compiler's store; `None` if the store has none.
pub(super) fn map(store: &[u8]) -> Option<Vec<u8>> {
    let store = Container::open(store)?;
    let index = store.stream(INDEX)?;
    let mut fields = Fields::new(&index);
    fields.u32()?;
    loop {
        let (id, storage, length) = (fields.u32()?, fields.u32()?, fields.u32()?);
        let name = fields.take(length as usize)?;
        if name.strip_suffix(&[0]).unwrap_or(name) == MAP.as_bytes() {
            let storage = match storage {
                1 => "Project",
                2 => "Task",
                3 => "POU",
                _ => "Resource",
            };
            return store.stream(&format!("{storage}/{id:08X}"));
        }
    }
}

/// The scopes of a map, and the offset of the field that could not be read.
pub(super) fn scopes(map: &[u8], encoding: &'static Encoding) -> (Vec<Scope>, Option<usize>) {
    let mut reader = Reader {
        fields: Fields::new(map),
        encoding,
    };
    let mut scopes = Vec::new();
    let mut read = || {
        // Size; a byte.
        reader.fields.take(5)?;
        while !reader.fields.rest().is_empty() {
            scopes.push(reader.scope(DEEPEST)?);
        }
        Some(())
    };
    let damaged = read().is_none();
    (scopes, damaged.then(|| reader.fields.at()))
}

struct Reader<'b> {
    fields: Fields<'b>,
    encoding: &'static Encoding,
}

impl Reader<'_> {
    fn name(&mut self) -> Option<String> {
        let length = self.fields.u32()? as usize;
        let name = self.fields.take(length.checked_sub(1)?)?;
        let name = decode_text(name, self.encoding);
        (self.fields.take(2)? == b"\r\n").then_some(name)
    }

    /// An address: class, number, a number of words or bits.
    fn address(&mut self) -> Option<(Option<Device>, u32)> {
        let class = self.fields.u16()?;
        let number = self.fields.u32()? & 0x00FF_FFFF;
        let count = self.fields.u32()?;
        self.fields.u32()?;
        let class = match class {
            0x021 => Some(DeviceClass::M),
            0x524 => Some(DeviceClass::D),
            0xB05 | 0xB06 | 0xC05 | 0xD05 => Some(DeviceClass::T),
            0xE0A => Some(DeviceClass::C),
            _ => None,
        };
        Some((class.map(|class| Device { class, number }), count))
    }

    fn scope(&mut self, depth: usize) -> Option<Scope> {
        let name = self.name()?;
        self.fields.u32()?;
        let kind = match self.fields.u32()? {
            1 => ScopeKind::Function,
            2 => ScopeKind::Instance,
            3 => ScopeKind::Program,
            5 => ScopeKind::Structure,
            6 => ScopeKind::Globals,
            other => ScopeKind::Other(other),
        };
        let block = match kind {
            ScopeKind::Instance => self.name()?,
            _ => String::new(),
        };
        // Device, number, a constant.
        self.fields.take(12)?;
        let flags = self.fields.u8()?;
        let mut scope = Scope {
            name,
            kind,
            block,
            variables: Vec::new(),
        };
        let mut follows = flags & 1 != 0;
        while follows {
            let (variable, flags) = self.variable(depth.checked_sub(1)?)?;
            scope.variables.push(variable);
            follows = flags & 1 != 0;
        }
        let mut follows = flags & 2 != 0;
        while follows {
            self.name()?;
            // Class, number, a constant.
            self.fields.take(12)?;
            follows = self.fields.u8()? & 2 != 0;
        }
        Some(scope)
    }

    /// A variable, and flags that say if another one follows.
    fn variable(&mut self, depth: usize) -> Option<(Assigned, u8)> {
        const ARRAY: u32 = 0x33;
        const STRUCTURE: u32 = 0x34;
        const BLOCK: u32 = 0x35;
        let name = self.name()?;
        let data_type = self.fields.u32()?;
        self.fields.u32()?;
        let (device, count) = self.address()?;
        let flags = self.fields.u8()?;
        let mut bits = None;
        if data_type == ARRAY {
            let element = self.fields.u32()?;
            self.fields.u32()?;
            if element == STRUCTURE {
                self.name()?;
                bits = self.address()?.0;
            }
        }
        let members = match data_type {
            STRUCTURE | BLOCK => Some(Box::new(self.scope(depth)?)),
            _ => None,
        };
        let variable = Assigned {
            name,
            device,
            count,
            bits,
            members,
        };
        Some((variable, flags))
    }
}
