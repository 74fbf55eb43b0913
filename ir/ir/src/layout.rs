//! Layout of the devices that a compiled program stores: decided once for both backends.
//!
//! A device that is only ever named directly becomes a separate field; devices that are indexed, moved in blocks or
//! handed to a runtime function as a run become arrays. Special devices that the program never looks at are not stored.

use crate::node::{Module, Place};
use crate::reach::{Footprint, of_expr, of_stmt};
use crate::walk::statements;
use rungc_models::Model;
use rungc_rt::special::{D_FIRST_ERROR_STEP, M_FIRST_ERROR};
use rungc_syntax::DeviceClass;

/// A run of stored devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Area {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// Number of devices.
    pub count: u32,
    /// An array (even of one) rather than a separate field.
    pub array: bool,
    /// Kept over RUN/STOP and power-off. An area never mixes both.
    pub latched: bool,
}

/// Devices that a [`Stmt::Repeat`](crate::node::Stmt::Repeat) goes through, as an array of columns: column 0 holds the
/// first device of each row, column 1 the second, and so on. Each iteration of the loop moves on by one row. The
/// devices lie in areas that are arrays.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Grid {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// Number of devices; need not be a multiple of the columns.
    pub count: u32,
    /// The number of columns, at least 1: the stride of the loop, by which the devices of a column are apart.
    pub columns: u32,
    /// Number of stored columns, at least 1: the first ones. The program names no device of the others.
    pub stored_columns: u32,
}

impl Grid {
    /// The column and the row of a device.
    pub fn position(&self, number: u32) -> (u32, u32) {
        let n = number.wrapping_sub(self.first);
        (n % self.columns, n / self.columns)
    }

    /// Returns true if it stores a device.
    pub fn stores(&self, number: u32) -> bool {
        (self.first..self.end()).contains(&number) && self.position(number).0 < self.stored_columns
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
        (grid.class == class && grid.stores(number)).then_some(grid)
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

/// Devices that a host reads or writes, in addition to those that the program names.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Devices that tests or a monitor read, stored in addition to those that the program uses.
    pub observe: Vec<(DeviceClass, u32)>,
    /// Store every device of the model.
    pub observe_all: bool,
    /// Serial ports that the host opens, in addition to those that the program uses.
    pub ports: Vec<u8>,
    /// Slaves by Modbus RTU do not answer QLink, which takes memory.
    pub without_qlink: bool,
}

impl Wanted {
    /// Returns true if a host may read and write a device.
    pub fn observes(&self, model: &Model, class: DeviceClass, number: u32) -> bool {
        let mut observed = self.observe.iter();
        self.observe_all
            || observed.any(|other| model.canonical(other.0, other.1) == (class, number))
    }
}

/// Marks of a device while the layout is built.
const STORED: u8 = 1;
const IN_ARRAY: u8 = 2;

/// Finds out which devices a module stores: those that its code accesses, those observed, and the special ones that the
/// functions it calls use (`flags`). They may use devices of the `whole` classes by number.
pub fn build(
    module: &mut Module,
    wanted: &Wanted,
    flags: &[(DeviceClass, u32)],
    whole: &[DeviceClass],
) {
    let mut builder = Builder::new(module);
    let model = module.model;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            of_stmt(model, stmt, &mut |used| builder.store(used));
        });
    }
    for expr in &module.exprs {
        of_expr(model, expr, &mut |used| builder.store(used));
    }
    for &(class, number) in wanted.observe.iter().chain(flags) {
        builder.mark(class, number, 1, false);
    }
    for &class in whole {
        builder.mark_run(class);
    }
    if wanted.observe_all {
        for range in &*module.ranges {
            builder.mark(range.class, range.first, range.last - range.first + 1, true);
        }
    }
    // The register keeps the step of the first error as long as the relay is on.
    let register = builder.marks[DeviceClass::D as usize].get(D_FIRST_ERROR_STEP.number() as usize);
    if register.is_some_and(|mark| mark & STORED != 0) {
        builder.mark(DeviceClass::M, M_FIRST_ERROR.number(), 1, false);
    }
    module.layout = builder.finish();
}

struct Builder<'m> {
    module: &'m Module,
    /// Marks of each class, by number; empty for P, I, N.
    marks: Vec<Vec<u8>>,
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
        Builder { module, marks }
    }

    /// `count` devices from `number` on are stored, in an array if they are accessed as a run. Registers that are other
    /// names of index registers are stored as these, by themselves.
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
        for alias in self.module.model.index_aliases {
            let register = alias.register.number() as usize;
            if (number as usize..end).contains(&register) {
                self.marks[DeviceClass::D as usize][register] = 0;
                self.marks[alias.class as usize][alias.index as usize] |= STORED;
            }
        }
    }

    /// Stores the devices of an access: in an array if an index selects them, or as a run.
    fn store(&mut self, used: Footprint) {
        let Place { class, number, .. } = used.place;
        if let (None, Some(count)) = (used.place.index, used.count) {
            return self.mark(class, number, count, used.in_array);
        }
        for (first, last) in used.reach(self.module.model, &self.module.exprs) {
            self.mark(class, first, last - first + 1, true);
        }
    }

    /// All devices of a class that are not special.
    fn mark_run(&mut self, class: DeviceClass) {
        if let Some(&(first, last)) = self.module.model.runs(class).first() {
            self.mark(class, first, last - first + 1, true);
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
