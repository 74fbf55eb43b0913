//! A bound of the stack that an image for a Cortex-M takes, from its machine code: what each function takes
//! ([`super::thumb`]), along the longest way through the calls. A call through a register may lead to every function
//! whose address is stored somewhere.

use super::elf::Elf;
use super::thumb::{Frame, frame};
use object::{Object, ObjectSection, ObjectSymbol, SectionKind, SymbolKind};
use std::collections::{BTreeMap, BTreeSet};

/// Reason why there is no bound.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Unbounded {
    /// These functions call each other in a ring.
    Recursion(Vec<String>),
    /// This function takes as much as its data say.
    Dynamic(String),
    /// There is no such function.
    Missing(String),
}

impl std::fmt::Display for Unbounded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unbounded::Recursion(names) => {
                write!(f, "these may form a call cycle: {}", names.join(", "))
            }
            Unbounded::Dynamic(name) => write!(f, "the frame of {name} has no fixed size"),
            Unbounded::Missing(name) => write!(f, "function {name} not found"),
        }
    }
}

/// The functions of an image.
pub struct Functions {
    by_address: BTreeMap<u32, Function>,
    /// Addresses of those that a register may lead to.
    stored: BTreeSet<u32>,
}

/// Stack of a function with everything that it calls by name.
#[derive(Clone, Copy)]
struct Depth {
    bytes: u32,
    /// True if one of them calls through a register.
    indirect: bool,
}

struct Function {
    name: String,
    end: u32,
    frame: Frame,
}

/// The code of an image, its address, and the parts of it that are not code.
struct Code<'d> {
    sections: Vec<(u32, &'d [u8])>,
    /// From each address on: whether there is code.
    marks: BTreeMap<u32, bool>,
}

impl Code<'_> {
    /// The halfword at an address, if it is code.
    fn at(&self, address: u32) -> Option<u16> {
        let mark = self.marks.range(..=address).next_back();
        if mark.is_some_and(|(_, is_code)| !is_code) {
            return None;
        }
        self.sections.iter().find_map(|(start, bytes)| {
            let from = address.checked_sub(*start)? as usize;
            let pair = bytes.get(from..from + 2)?;
            Some(u16::from_le_bytes([pair[0], pair[1]]))
        })
    }

    /// All words that are not code.
    fn words(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.sections.iter().flat_map(move |(start, bytes)| {
            let words = bytes.chunks_exact(4).enumerate();
            words.filter_map(move |(i, word)| {
                let address = start + 4 * i as u32;
                let mark = self.marks.range(..=address).next_back();
                let is_code = mark.is_some_and(|(_, is_code)| *is_code);
                let word: [u8; 4] = word.try_into().ok()?;
                (!is_code).then(|| (address, u32::from_le_bytes(word)))
            })
        })
    }
}

/// Reads sections and the marks between code and data (`$t`, `$d`), which begin anew in each section.
fn code<'d>(file: &Elf<'d>) -> Code<'d> {
    let mut code = Code {
        sections: Vec::new(),
        marks: BTreeMap::new(),
    };
    for section in file.sections() {
        let data = section.data().unwrap_or_default();
        let address = section.address() as u32;
        match section.kind() {
            SectionKind::Text => {}
            SectionKind::Data | SectionKind::ReadOnlyData => {
                code.marks.insert(address, false);
            }
            _ => continue,
        }
        code.sections.push((address, data));
    }
    for symbol in file.symbols() {
        let name = symbol.name().unwrap_or_default();
        let mark = name.split('.').next();
        if let Some(mark @ ("$t" | "$d")) = mark {
            code.marks.insert(symbol.address() as u32, mark == "$t");
        }
    }
    code
}

impl Functions {
    /// Reads all functions of an image. Vectors do not count as stored addresses: only hardware jumps through them.
    pub fn new(file: &Elf) -> Self {
        let code = code(file);
        let mut by_address = BTreeMap::new();
        let mut vectors = 0..0;
        for symbol in file.symbols() {
            let from = symbol.address() as u32 & !1;
            let end = from + symbol.size() as u32;
            let name = symbol.name().unwrap_or_default();
            if name == "vectors" {
                vectors = from..end;
            }
            if symbol.kind() != SymbolKind::Text || !symbol.is_definition() || from == end {
                continue;
            }
            let frame = frame(from, end, &|address| code.at(address));
            let name = name.to_string();
            by_address.insert(from, Function { name, end, frame });
        }
        let words = code.words().filter(|(at, _)| !vectors.contains(at));
        let constants = by_address
            .values()
            .flat_map(|f: &Function| &f.frame.constants);
        let stored = words.map(|(_, word)| word).chain(constants.copied());
        let stored = stored.filter(|word| word & 1 == 1 && by_address.contains_key(&(word & !1)));
        let stored: BTreeSet<_> = stored.map(|word| word & !1).collect();
        Functions { by_address, stored }
    }

    /// Returns true if any function calls through a register.
    pub(crate) fn has_indirect_calls(&self) -> bool {
        self.by_address.values().any(|f| f.frame.indirect)
    }

    /// Stack of a function of this name with everything that it calls. Programs and the runtime are not recursive, so
    /// that on one way through the calls a pointer leads to each stored function at most once.
    pub fn depth(&self, name: &str) -> Result<u32, Unbounded> {
        let found = self.by_address.iter().find(|(_, f)| f.name == name);
        let (address, _) = found.ok_or_else(|| Unbounded::Missing(name.to_string()))?;
        let mut known = BTreeMap::new();
        let own = self.direct(*address, &mut Vec::new(), &mut known)?;
        if !own.indirect {
            return Ok(own.bytes);
        }
        let mut between = 0u32;
        let mut last = 0;
        for stored in &self.stored {
            let depth = self.direct(*stored, &mut Vec::new(), &mut known)?;
            match depth.indirect {
                true => between = between.saturating_add(depth.bytes),
                false => last = last.max(depth.bytes),
            }
        }
        Ok(own.bytes.saturating_add(between).saturating_add(last))
    }

    /// A function with all that it calls by name.
    fn direct(
        &self,
        address: u32,
        open: &mut Vec<u32>,
        known: &mut BTreeMap<u32, Depth>,
    ) -> Result<Depth, Unbounded> {
        // An address amid a function stands for it.
        let found = self.by_address.range(..=address).next_back();
        let Some((&address, function)) = found.filter(|(_, f)| address < f.end) else {
            return Err(Unbounded::Missing(format!("at 0x{address:08X}")));
        };
        if let Some(depth) = known.get(&address) {
            return Ok(*depth);
        }
        if let Some(begin) = open.iter().position(|other| *other == address) {
            let names = open[begin..].iter().filter_map(|a| self.by_address.get(a));
            let names = names.map(|f| f.name.clone()).collect();
            return Err(Unbounded::Recursion(names));
        }
        if function.frame.dynamic {
            return Err(Unbounded::Dynamic(function.name.clone()));
        }
        open.push(address);
        let mut depth = Depth {
            bytes: 0,
            indirect: function.frame.indirect,
        };
        for callee in &function.frame.calls {
            let below = self.direct(*callee, open, known)?;
            depth.bytes = depth.bytes.max(below.bytes);
            depth.indirect |= below.indirect;
        }
        open.pop();
        depth.bytes = depth.bytes.saturating_add(function.frame.bytes);
        known.insert(address, depth);
        Ok(depth)
    }
}
