//! The storage of devices: which field of the program's struct holds each of them.

use rungc_ir::Module;
use rungc_ir::layout::{Area, Grid};
use rungc_models::Model;
use rungc_models::runs::{FIRST_COUNTER32, FIRST_SPECIAL, is_counter32, is_special};
use rungc_syntax::DeviceClass;
use std::collections::HashMap;

/// Storage type of a device.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// A bit.
    Bit,
    /// A number, 0 or 1: a bit in a [`Grid`]. Compilers vectorise loops over numbers better than loops over booleans.
    NumericBit,
    /// A signed 16-bit word.
    Word,
    /// A timer of the runtime.
    Timer,
    /// A 16-bit counter of the runtime.
    Counter16,
    /// A 32-bit counter of the runtime.
    Counter32,
}

impl Kind {
    /// Storage type of a device of this class and number outside a grid; `None` for classes that are not devices
    /// (labels, nesting levels).
    pub fn of(class: DeviceClass, number: u32) -> Option<Kind> {
        use DeviceClass::*;
        Some(match class {
            X | Y | M | S => Kind::Bit,
            T => Kind::Timer,
            C if is_counter32(class, number) => Kind::Counter32,
            C => Kind::Counter16,
            D | R | ER | V | Z => Kind::Word,
            P | I | N => return None,
        })
    }

    /// The same in a grid.
    fn in_grid(self) -> Kind {
        if self == Kind::Bit {
            Kind::NumericBit
        } else {
            self
        }
    }

    /// Returns true if it has a contact, a value and a coil, as timers and counters have.
    pub fn has_members(self) -> bool {
        matches!(self, Kind::Timer | Kind::Counter16 | Kind::Counter32)
    }

    /// Member with its state as a bit; `None` if it has none.
    pub fn bit(self) -> Option<Member> {
        match self {
            Kind::Bit | Kind::NumericBit => Some(Member::Whole),
            Kind::Word => None,
            Kind::Timer | Kind::Counter16 | Kind::Counter32 => Some(Member::Done),
        }
    }

    /// Member with its value as a 16-bit word; `None` if it has none.
    pub fn word(self) -> Option<Member> {
        match self {
            Kind::Word => Some(Member::Whole),
            Kind::Timer | Kind::Counter16 => Some(Member::Value),
            Kind::Bit | Kind::NumericBit | Kind::Counter32 => None,
        }
    }

    /// Its size and alignment in bytes, on a 32-bit machine.
    pub fn size(self) -> (u32, u32) {
        match self {
            Kind::Bit | Kind::NumericBit => (1, 1),
            Kind::Word => (2, 2),
            Kind::Timer => (8, 2),
            Kind::Counter16 => (4, 2),
            Kind::Counter32 => (8, 4),
        }
    }
}

/// Member of a stored device.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Member {
    /// All of it: a bit or a word.
    Whole,
    /// The contact of a timer or counter.
    Done,
    /// The current value of a timer or counter.
    Value,
}

/// Effect of RUN/STOP and power-off on a run of devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Keep {
    /// X: never cleared, set by the host.
    Input,
    /// Cleared in STOP and at power-on.
    General,
    /// Kept over STOP and power-off.
    Latched,
    /// Special relays and registers: their power-on values come back at power-on only.
    Special,
    /// Special registers that are retained over power-off, and that no program clears.
    Record,
}

/// In which section of the struct a field is. The order puts together what is cleared together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Section {
    /// [`Keep::Input`].
    Inputs,
    /// An array of which some devices are kept and others are not.
    Mixed,
    /// [`Keep::General`].
    General,
    /// [`Keep::Latched`].
    Latched,
    /// [`Keep::Special`].
    Special,
    /// [`Keep::Record`].
    Records,
}

impl Section {
    fn of(keep: Keep) -> Self {
        match keep {
            Keep::Input => Section::Inputs,
            Keep::General => Section::General,
            Keep::Latched => Section::Latched,
            Keep::Special => Section::Special,
            Keep::Record => Section::Records,
        }
    }
}

/// A field of the struct: one device, or an array of neighbours.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// Number of devices, including those that a grid leaves out.
    pub count: u32,
    /// An array, even of one.
    pub array: bool,
    /// Columns of the array, if a loop over rungs traverses it.
    pub grid: Option<Grid>,
    /// Storage type of each device.
    pub kind: Kind,
    /// Section of the struct.
    pub section: Section,
}

impl Field {
    /// Returns true if its name includes its first number; an array that begins with device 0 is named by its class
    /// alone.
    pub fn is_numbered(&self) -> bool {
        !self.array || self.first != 0
    }

    /// The grid, if it has more than one column: a field of two dimensions.
    pub fn columns(&self) -> Option<Grid> {
        self.grid.filter(|grid| grid.columns > 1)
    }

    /// The grid, if it leaves columns out.
    pub fn trimmed(&self) -> Option<Grid> {
        self.grid.filter(|grid| grid.stored_columns < grid.columns)
    }

    /// Number of devices in each dimension: columns, if there are several, and rows.
    pub fn dimensions(&self) -> (Option<u32>, u32) {
        match self.columns() {
            Some(grid) => (Some(grid.stored_columns), self.count.div_ceil(grid.columns)),
            None => (None, self.count),
        }
    }

    /// Number of devices that it can store.
    pub fn room(&self) -> u32 {
        let (columns, rows) = self.dimensions();
        columns.unwrap_or(1) * rows
    }

    /// Returns true if it holds a device of its class.
    pub fn holds(&self, number: u32) -> bool {
        (self.first..self.end()).contains(&number)
            && self.grid.is_none_or(|grid| grid.stores(number))
    }

    /// The numbers that it holds.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        (self.first..self.end()).filter(|&number| self.holds(number))
    }

    /// One past the last number.
    pub fn end(&self) -> u32 {
        self.first + self.count
    }

    /// The last number.
    pub fn last(&self) -> u32 {
        self.end() - 1
    }

    /// Position of one of its devices.
    pub fn at(&self, number: u32) -> At {
        match self.columns() {
            Some(grid) => {
                let (column, row) = grid.position(number);
                At::Column { column, row }
            }
            None if self.array => At::Element(number - self.first),
            None => At::Field,
        }
    }
}

/// Position of a device in a field.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum At {
    /// It is the field.
    Field,
    /// An element of an array, counted from 0.
    Element(u32),
    /// An element of an array of columns.
    Column {
        /// Number of the column.
        column: u32,
        /// Row in the column.
        row: u32,
    },
}

/// Location of the device of a loop's current iteration.
#[derive(Clone, Copy, Debug)]
pub struct RoundSlot<'a> {
    /// The field.
    pub field: &'a Field,
    /// Number of the column, if there are several.
    pub column: Option<u32>,
    /// Row of the device of iteration 0; those of the next iterations follow.
    pub row: u32,
}

/// A run of devices within one field that power-off treats alike.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// First number.
    pub first: u32,
    /// Number of devices.
    pub count: u32,
    /// Treatment in STOP and at power-off.
    pub keep: Keep,
}

/// Stands for devices that no field holds.
const NO_FIELD: u32 = u32::MAX;

/// All fields of a program's struct.
pub struct Storage<'m> {
    model: &'static Model,
    /// By class and number.
    fields: Vec<Field>,
    /// Range of each class in `fields`.
    of_class: [(usize, usize); DeviceClass::ALL.len()],
    /// For each class by number: which of its fields holds the device, [`NO_FIELD`] if none does.
    by_number: [Vec<u32>; DeviceClass::ALL.len()],
    /// By class and number: runs treated alike, cut at the ends of fields.
    runs: Vec<(DeviceClass, Run)>,
    comments: HashMap<(DeviceClass, u32), &'m str>,
}

impl<'m> Storage<'m> {
    /// Decides on the fields.
    pub fn new(module: &'m Module) -> Self {
        let pieces = pieces(module);
        let fields = fields(&pieces);
        let mut of_class = [(0, 0); DeviceClass::ALL.len()];
        for class in DeviceClass::ALL {
            of_class[class as usize] = (
                fields.partition_point(|f| f.class < class),
                fields.partition_point(|f| f.class <= class),
            );
        }
        let by_number = of_class.map(|(from, to)| fields_by_number(&fields[from..to]));
        let comments = module.comments.iter();
        Storage {
            model: module.model,
            fields,
            of_class,
            by_number,
            runs: runs(&pieces),
            comments: comments
                .map(|(class, n, text)| ((*class, *n), text.as_str()))
                .collect(),
        }
    }

    /// All fields, by class and number.
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// The fields of a class.
    pub fn of_class(&self, class: DeviceClass) -> &[Field] {
        let (from, to) = self.of_class[class as usize];
        &self.fields[from..to]
    }

    /// Size of the devices in bytes, without padding.
    pub fn bytes(&self) -> u64 {
        let bytes = |field: &Field| u64::from(field.room()) * u64::from(field.kind.size().0);
        self.fields.iter().map(bytes).sum()
    }

    /// The fields by sections. Arrays that loops over rungs go through are side by side: clang makes vectors of two
    /// bytes only if few others lie between what a loop reads and what it writes.
    pub fn in_sections(&self) -> Vec<&Field> {
        let mut fields: Vec<&Field> = self.fields.iter().collect();
        fields.sort_by_key(|f| match f.section {
            Section::Inputs | Section::Mixed => (f.section, f.grid.is_some()),
            Section::General | Section::Latched | Section::Special | Section::Records => {
                (f.section, f.grid.is_none())
            }
        });
        fields
    }

    /// The field that holds a device, under whichever name.
    pub fn find(&self, class: DeviceClass, number: u32) -> Option<&Field> {
        self.slot(class, number).map(|(field, _)| field)
    }

    /// The field that holds a device, and the device's number in it: that of an index register, if it is another name
    /// of one.
    pub fn slot(&self, class: DeviceClass, number: u32) -> Option<(&Field, u32)> {
        let (class, number) = self.model.canonical(class, number);
        let i = *self.by_number[class as usize].get(number as usize)?;
        let field = self.of_class(class).get(i as usize)?;
        field.holds(number).then_some((field, number))
    }

    /// Location of the device of a loop's current iteration, which advances by this many numbers with each iteration.
    pub fn round_slot(&self, class: DeviceClass, number: u32, by: u32) -> Option<RoundSlot<'_>> {
        let field = self.find(class, number)?;
        let grid = field.grid.filter(|grid| grid.columns == by)?;
        let (column, row) = grid.position(number);
        Some(RoundSlot {
            field,
            column: (by > 1).then_some(column),
            row,
        })
    }

    /// The array that holds `count` devices from `number` on, one after the other.
    pub fn array(&self, class: DeviceClass, number: u32, count: u32) -> Option<&Field> {
        self.find(class, number)
            .filter(|f| f.array && f.grid.is_none() && f.end() - number >= count)
    }

    /// Returns true if a device is a bit that is stored as a number.
    pub fn is_numeric_bit(&self, class: DeviceClass, number: u32) -> bool {
        let field = self.find(class, number);
        field.is_some_and(|field| field.kind == Kind::NumericBit)
    }

    /// The runs of a field that power-off treats alike.
    pub fn runs(&self, field: &Field) -> impl Iterator<Item = Run> + use<'_> {
        let (class, first, end) = (field.class, field.first, field.end());
        let from = self
            .runs
            .partition_point(|(c, r)| (*c, r.first + r.count) <= (class, first));
        self.runs[from..]
            .iter()
            .take_while(move |(c, r)| *c == class && r.first < end)
            .map(|(_, r)| *r)
    }

    /// The comment on a device.
    pub fn comment(&self, class: DeviceClass, number: u32) -> Option<&'m str> {
        self.comments.get(&(class, number)).copied()
    }
}

/// Size of the devices of a class in the program's struct, in bytes on a 32-bit machine.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Memory {
    /// The class.
    pub class: DeviceClass,
    /// Number of stored devices.
    pub devices: u32,
    /// Their bytes, without what aligns fields.
    pub bytes: u32,
}

/// Sizes of a program's devices, by class; the rest of the struct is private.
pub fn memory(module: &Module) -> Vec<Memory> {
    let storage = Storage::new(module);
    let of = |class: DeviceClass| {
        let fields = storage.of_class(class);
        let bytes = |field: &Field| field.kind.size().0 * field.room();
        let devices = |field: &Field| field.numbers().count() as u32;
        Memory {
            class,
            devices: fields.iter().map(devices).sum(),
            bytes: fields.iter().map(bytes).sum(),
        }
    };
    let all = DeviceClass::ALL.into_iter().map(of);
    all.filter(|memory| memory.devices > 0).collect()
}

/// Index of the field that holds a device, by number, among the fields of one class.
fn fields_by_number(fields: &[Field]) -> Vec<u32> {
    let end = fields.last().map_or(0, Field::end);
    let mut by_number = vec![NO_FIELD; end as usize];
    for (field, i) in fields.iter().zip(0..) {
        by_number[field.first as usize..field.end() as usize].fill(i);
    }
    by_number
}

/// A part of an area that is treated alike and of one kind.
struct Piece {
    class: DeviceClass,
    run: Run,
    array: bool,
    grid: Option<Grid>,
    kind: Kind,
}

impl Piece {
    fn end(&self) -> u32 {
        self.run.first + self.run.count
    }

    fn field(&self, first: u32, count: u32) -> Field {
        Field {
            class: self.class,
            first,
            count,
            array: self.array,
            grid: self.grid,
            kind: self.kind,
            section: Section::of(self.run.keep),
        }
    }
}

/// The layout's areas, cut where counters become 32-bit ones and where special devices begin.
fn pieces(module: &Module) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(module.layout.areas.len());
    for area in &module.layout.areas {
        let (first, end) = (area.first, area.first + area.count);
        let cut = match area.class {
            DeviceClass::C => FIRST_COUNTER32,
            DeviceClass::M | DeviceClass::D => FIRST_SPECIAL,
            DeviceClass::X
            | DeviceClass::Y
            | DeviceClass::S
            | DeviceClass::T
            | DeviceClass::R
            | DeviceClass::ER
            | DeviceClass::V
            | DeviceClass::Z
            | DeviceClass::P
            | DeviceClass::I
            | DeviceClass::N => end,
        };
        let cut = cut.clamp(first, end);
        for (first, end) in [(first, cut), (cut, end)] {
            let Some(kind) = Kind::of(area.class, first).filter(|_| first < end) else {
                continue;
            };
            let grid = module.layout.grid(area.class, first).copied();
            pieces.push(Piece {
                class: area.class,
                run: Run {
                    first,
                    count: end - first,
                    keep: keep(area, first),
                },
                array: area.array,
                kind: if grid.is_some() { kind.in_grid() } else { kind },
                grid,
            });
        }
    }
    pieces
}

/// Treatment of the devices of an area from this one on.
fn keep(area: &Area, first: u32) -> Keep {
    match (area.class, is_special(area.class, first), area.latched) {
        (DeviceClass::X, ..) => Keep::Input,
        (_, true, true) => Keep::Record,
        (_, true, false) => Keep::Special,
        (_, false, true) => Keep::Latched,
        (_, false, false) => Keep::General,
    }
}

/// The fields: neighbouring arrays of one kind are one, however power-off treats them.
fn fields(pieces: &[Piece]) -> Vec<Field> {
    let mut fields: Vec<Field> = Vec::new();
    for piece in pieces {
        let run = piece.run;
        if !piece.array {
            fields.extend((run.first..piece.end()).map(|number| piece.field(number, 1)));
            continue;
        }
        let last = fields.last_mut().filter(|last| {
            let alike = last.array && last.class == piece.class && last.kind == piece.kind;
            let continues = match piece.grid {
                Some(grid) => last.grid.is_some_and(|of_last| of_last.first == grid.first),
                None => last.grid.is_none() && last.end() == run.first,
            };
            alike && continues
        });
        match last {
            Some(last) => {
                last.count = piece.end() - last.first;
                if last.section != Section::of(run.keep) {
                    last.section = Section::Mixed;
                }
            }
            None => fields.push(piece.field(run.first, run.count)),
        }
    }
    fields
}

/// The runs: what a grid does not store is not a gap between them.
fn runs(pieces: &[Piece]) -> Vec<(DeviceClass, Run)> {
    let mut runs: Vec<(DeviceClass, Run)> = Vec::new();
    for piece in pieces {
        let run = piece.run;
        let last = runs.last_mut().filter(|(class, last)| {
            let in_grid = |grid: &Grid| grid.first < run.first && grid.first <= last.first;
            *class == piece.class
                && piece.grid.is_some_and(|g| in_grid(&g))
                && last.keep == run.keep
        });
        match last {
            Some((_, last)) => last.count = piece.end() - last.first,
            None => runs.push((piece.class, run)),
        }
    }
    runs
}
