//! Which devices a compiled program stores, and how: decided once for both backends.
//!
//! A device that is only ever named directly becomes a field of its own; devices that are indexed, moved in blocks or handed to a
//! runtime function as a run become arrays. Special devices that the program never looks at are not stored.

use crate::lower::LowerOptions;
use crate::node::{Arg, Body, Expr, Module, Place, Stmt};
use crate::runs::{is_counter32, is_special, words_of_bits};
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass;

/// A run of stored devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Area {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// An array (even of one) rather than a field of its own.
    pub array: bool,
    /// Kept over RUN/STOP and power-off. An area never mixes both.
    pub latched: bool,
}

impl Area {
    /// Whether M8031 (`latched` false) or M8032 (true) clears it ([`crate::node::Stmt::Clear`]); what M8031 clears, going to STOP
    /// clears as well. Inputs and special devices are never cleared (h1u-h2u-programming §8.9). Cleared timers and counters
    /// forget their coil, too.
    pub fn is_cleared(&self, latched: bool) -> bool {
        let special = is_special(self.class, self.first);
        self.class != DeviceClass::X && !special && self.latched == latched
    }
}

/// Devices that a [`Stmt::Repeat`] goes through: an array of columns, each of which has every so manieth device. The devices lie in areas
/// that are arrays.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Grid {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// How many; need not be a multiple of the columns.
    pub count: u32,
    /// How far the devices of a column are apart, and how many columns that makes. At least 1.
    pub columns: u32,
    /// How many of the columns are stored, at least 1: the first ones. The program names no device of the others.
    pub kept: u32,
}

impl Grid {
    /// In which column a device is, and where in that.
    pub fn place(&self, number: u32) -> (u32, u32) {
        let n = number.wrapping_sub(self.first);
        (n % self.columns, n / self.columns)
    }

    /// Whether it stores a device.
    pub fn holds(&self, number: u32) -> bool {
        (self.first..self.end()).contains(&number) && self.place(number).0 < self.kept
    }

    /// Length of a column.
    pub fn rows(&self) -> u32 {
        self.count.div_ceil(self.columns)
    }

    /// One past the last number.
    pub fn end(&self) -> u32 {
        self.first + self.count
    }
}

/// All stored devices, sorted by class and number, disjoint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// The areas.
    pub areas: Vec<Area>,
    /// Arrays of several columns, sorted and disjoint likewise.
    pub grids: Vec<Grid>,
}

impl Layout {
    /// The array of columns that holds a device.
    pub fn grid(&self, class: DeviceClass, number: u32) -> Option<&Grid> {
        let after = |g: &Grid| (g.class, g.first) <= (class, number);
        let i = self.grids.partition_point(after).checked_sub(1)?;
        let grid = self.grids.get(i)?;
        (grid.class == class && grid.holds(number)).then_some(grid)
    }

    /// The area that holds a device.
    pub fn area(&self, class: DeviceClass, number: u32) -> Option<&Area> {
        let i = self
            .areas
            .partition_point(|a| (a.class, a.first) <= (class, number))
            .checked_sub(1)?;
        self.areas
            .get(i)
            .filter(|a| a.class == class && number - a.first < a.count)
    }
}

/// What is known of one device while the layout is built.
const STORED: u8 = 1;
const IN_ARRAY: u8 = 2;

/// Finds out which devices a module stores: those that its code accesses, those observed, and the special ones that the functions
/// it calls use (`flags`). They may use devices of a `whole` class by number.
pub(crate) fn build(
    module: &mut Module,
    options: &LowerOptions,
    flags: &[(DeviceClass, u32)],
    whole: Option<DeviceClass>,
) {
    let mut builder = Builder::new(module);
    for function in &module.functions {
        builder.body(&function.body);
    }
    for expr in &module.exprs {
        builder.expr(expr);
    }
    for &(class, number) in options.observe.iter().chain(flags) {
        builder.mark(class, number, 1, false);
    }
    if let Some(class) = whole {
        builder.mark_run(class, 0, false);
    }
    if options.observe_all {
        for range in &*module.ranges {
            builder.mark(range.class, range.first, range.last - range.first + 1, true);
        }
    }
    module.layout = builder.finish();
}

struct Builder<'m> {
    module: &'m Module,
    /// Marks of each class, by number; empty for P, I, N.
    marks: Vec<Vec<u8>>,
    runs: Vec<Vec<(u32, u32)>>,
}

impl<'m> Builder<'m> {
    fn new(module: &'m Module) -> Self {
        let model = module.model;
        let marks = DeviceClass::ALL
            .iter()
            .map(|&class| {
                let pointer = matches!(class, DeviceClass::P | DeviceClass::I | DeviceClass::N);
                let end = model.ranges_of(class).map(|r| r.last + 1).max();
                vec![0; end.filter(|_| !pointer).unwrap_or(0) as usize]
            })
            .collect();
        Builder {
            module,
            marks,
            runs: DeviceClass::ALL.iter().map(|&c| model.runs(c)).collect(),
        }
    }

    /// `count` devices from `number` on are stored, in an array if they are accessed as a run. Registers that are other names of
    /// index registers are stored as these, by themselves.
    fn mark(&mut self, class: DeviceClass, number: u32, count: u32, array: bool) {
        let marks = &mut self.marks[class as usize];
        let end = (number as usize)
            .saturating_add(count as usize)
            .min(marks.len());
        for mark in marks.iter_mut().take(end).skip(number as usize) {
            *mark |= STORED | if array { IN_ARRAY } else { 0 };
        }
        if class != DeviceClass::D {
            return;
        }
        for &(alias, class, index) in self.module.model.index_aliases {
            if (number as usize..end).contains(&(alias as usize)) {
                self.marks[DeviceClass::D as usize][alias as usize] = 0;
                self.marks[class as usize][index as usize] |= STORED;
            }
        }
    }

    /// The run that a device lies in is an array: an index or a runtime function may lead anywhere in it.
    fn mark_run(&mut self, class: DeviceClass, number: u32, from_here: bool) {
        let run = self.runs[class as usize]
            .iter()
            .find(|&&(first, last)| (first..=last).contains(&number));
        if let Some(&(first, last)) = run {
            let first = if from_here { number } else { first };
            self.mark(class, first, last - first + 1, true);
        }
    }

    /// `count` devices from a place on are accessed.
    fn place(&mut self, place: Place, count: u32) {
        if place.index.is_some() {
            self.mark_run(place.class, place.number, false);
        } else {
            self.mark(place.class, place.number, count, count > 1);
        }
    }

    /// Whether the high word of a pair at this place is V.
    fn pairs_with_v(&self, place: Place) -> bool {
        place.class == DeviceClass::Z && self.module.model.z_pairs_with_v
    }

    /// A pair is two words that stand for themselves; that of Z is V and Z on some models.
    fn pair(&mut self, place: Place) {
        let counter32 = is_counter32(place.class, place.number);
        let with_v = self.pairs_with_v(place);
        self.place(place, 1);
        if place.index.is_some() {
            if with_v {
                self.mark_run(DeviceClass::V, place.number, false);
            }
        } else if with_v {
            self.mark(DeviceClass::V, place.number, 1, false);
        } else if !counter32 {
            self.mark(place.class, place.number + 1, 1, false);
        }
    }

    fn extent(&mut self, place: Place, extent: Option<u32>) {
        match (place.index, extent) {
            (None, Some(count)) => self.mark(place.class, place.number, count, count > 1),
            (None, None) => self.mark_run(place.class, place.number, true),
            (Some(_), _) => self.mark_run(place.class, place.number, false),
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match *expr {
            Expr::ReadBit(place) | Expr::ReadWordBit(place, _) | Expr::ReadWord(place) => {
                self.place(place, 1)
            }
            Expr::ReadPair(place) | Expr::ReadFloat(place) => self.pair(place),
            Expr::ReadNibbles { place, digits, .. } => self.place(place, 4 * u32::from(digits)),
            _ => {}
        }
    }

    fn body(&mut self, body: &Body) {
        for stmt in body {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match stmt {
            Stmt::WriteBit(place, _)
            | Stmt::WriteWordBit(place, ..)
            | Stmt::WriteWord(place, _)
            | Stmt::TimerAt { place, .. }
            | Stmt::Counter16At { place, .. }
            | Stmt::Reset(place) => self.place(*place, 1),
            Stmt::WritePair(place, _) | Stmt::WriteFloat(place, _) => self.pair(*place),
            Stmt::WriteNibbles { place, digits, .. } => self.place(*place, 4 * u32::from(*digits)),
            Stmt::Timer { number, .. } | Stmt::TimerGoesOn { number, .. } => {
                self.mark(DeviceClass::T, *number, 1, false)
            }
            Stmt::Counter16 { number, .. }
            | Stmt::Counter32 { number, .. }
            | Stmt::Count { number, .. } => self.mark(DeviceClass::C, *number, 1, false),
            Stmt::If {
                then, otherwise, ..
            } => {
                self.body(then);
                self.body(otherwise);
            }
            Stmt::For { body, .. } | Stmt::Repeat { body, .. } => self.body(body),
            Stmt::Parts(parts) => parts.iter().for_each(|part| self.body(&part.body)),
            Stmt::Call {
                function,
                wide,
                args,
                ..
            } => {
                args.iter().for_each(|arg| self.arg(arg, *wide));
                // These save and restore all index registers, whether the program names them or not.
                if matches!(function, RtFn::Zpush | RtFn::Zpop) {
                    self.mark_run(DeviceClass::V, 0, false);
                    self.mark_run(DeviceClass::Z, 0, false);
                }
            }
            Stmt::Fetch { from, wide, .. } => self.arg(from, *wide),
            Stmt::Send { to, wide, .. } => self.arg(to, *wide),
            Stmt::Network(_)
            | Stmt::Let(..)
            | Stmt::Edge { .. }
            | Stmt::CallSub(_)
            | Stmt::Return
            | Stmt::Goto(_)
            | Stmt::Fault { .. }
            | Stmt::Watch { .. }
            | Stmt::Stop
            | Stmt::SetFlag(..)
            | Stmt::SetCell(..)
            | Stmt::SetEntry(..)
            | Stmt::Clear { .. } => {}
        }
    }

    fn arg(&mut self, arg: &Arg, wide: bool) {
        match *arg {
            Arg::Device { place, extent } => {
                self.extent(place, extent);
                if wide && self.pairs_with_v(place) {
                    let class = DeviceClass::V;
                    self.extent(Place { class, ..place }, extent);
                }
            }
            Arg::Nibbles { place, extent, .. } => self.extent(place, extent),
            Arg::WordBit { place, bit, extent } => {
                self.extent(place, extent.map(|bits| words_of_bits(bit, bits)));
            }
            Arg::Const { .. } | Arg::Float(_) | Arg::Text(_) | Arg::Buffer { .. } => {}
        }
    }

    fn finish(&self) -> Layout {
        let mut areas: Vec<Area> = Vec::new();
        for range in &*self.module.ranges {
            let marks = &self.marks[range.class as usize];
            if marks.is_empty() {
                continue;
            }
            let mut open = false;
            for number in range.first..=range.last {
                let mark = marks[number as usize];
                let array = mark & IN_ARRAY != 0;
                match areas.last_mut() {
                    Some(area) if open && array => area.count += 1,
                    _ if mark & STORED != 0 => areas.push(Area {
                        class: range.class,
                        first: number,
                        count: 1,
                        array,
                        latched: range.latched,
                    }),
                    _ => {}
                }
                open = array;
            }
        }
        areas.sort_by_key(|area| (area.class, area.first));
        Layout {
            areas,
            grids: Vec::new(),
        }
    }
}
