//! The program's struct: which field holds a device.

use crate::text;
use rungc_ir::Module;
use rungc_models::Model;
use rungc_models::runs::{FIRST_COUNTER32, FIRST_SPECIAL, is_counter32, is_special};
use rungc_syntax::DeviceClass;
use std::collections::HashMap;
use std::fmt::Write;

/// What a device is stored as.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// `bool`.
    Bit,
    /// `int16_t`.
    Word,
    /// `plc_timer`.
    Timer,
    /// `plc_counter16`.
    Counter16,
    /// `plc_counter32`.
    Counter32,
}

impl Kind {
    /// What a device of this class and number is stored as; `None` for what is no device (labels, nesting levels).
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

    /// Its C type.
    pub fn c_type(self) -> &'static str {
        match self {
            Kind::Bit => "bool",
            Kind::Word => "int16_t",
            Kind::Timer => "plc_timer",
            Kind::Counter16 => "plc_counter16",
            Kind::Counter32 => "plc_counter32",
        }
    }

    /// Its size and alignment in bytes.
    pub fn size(self) -> (u32, u32) {
        match self {
            Kind::Bit => (1, 1),
            Kind::Word => (2, 2),
            Kind::Timer => (8, 2),
            Kind::Counter16 => (4, 2),
            Kind::Counter32 => (8, 4),
        }
    }
}

/// In which section of the struct a field stands. The order makes what is cleared together stand together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Section {
    /// X: never cleared, set by the host.
    Inputs,
    /// An array that is partly general and partly latched (or special).
    Mixed,
    /// Cleared in STOP and at power-on.
    General,
    /// Kept.
    Latched,
    /// Special relays and registers: power-on values at power-on only.
    Special,
    /// Special registers that outlast power-off, and that no program clears.
    Records,
}

/// A field.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// How many devices.
    pub count: u32,
    /// An array.
    pub array: bool,
    /// A loop over rungs goes through it ([`rungc_ir::layout::Grid`]).
    pub grid: bool,
    /// How many columns the array has, each of which holds every so manieth device: 1 unless it is a grid.
    pub columns: u32,
    /// How many of the columns are stored: the first ones.
    pub kept: u32,
    /// Whether the array's name carries the number it begins with.
    numbered: bool,
    /// What each is.
    pub kind: Kind,
    /// Where it stands.
    pub section: Section,
}

impl Field {
    /// Writes its name: `X10`, `D`, `M8000`.
    pub fn name(&self, out: &mut String) {
        out.push_str(self.class.prefix());
        match (self.array && !self.numbered, self.class.is_octal()) {
            (true, _) => {}
            (false, true) => text::push_octal(out, self.first),
            (false, false) => text::push_number(out, self.first),
        }
    }

    /// The C type of its elements. Bits that a loop over rungs goes through are numbers, which compilers vectorise best.
    pub fn c_type(&self) -> &'static str {
        match (self.grid, self.kind) {
            (true, Kind::Bit) => "uint8_t",
            _ => self.kind.c_type(),
        }
    }

    /// How many devices it has room for.
    pub fn room(&self) -> u32 {
        self.kept * self.count.div_ceil(self.columns)
    }

    /// The dimensions of an array: `[10]`, `[10][32]`.
    pub fn dimensions(&self) -> String {
        let rows = self.count.div_ceil(self.columns);
        match self.columns {
            1 => format!("[{rows}]"),
            _ => format!("[{}][{rows}]", self.kept),
        }
    }

    /// Whether it holds a device.
    pub fn holds(&self, number: u32) -> bool {
        (self.first..self.end()).contains(&number)
            && (number - self.first) % self.columns < self.kept
    }

    /// That it holds one of its numbers, which stands in a variable, if it does not hold all: `(n - 16) % 10 < 8`.
    pub fn column_is_kept(&self, number: &str, unsigned: &str) -> Option<String> {
        let (columns, kept) = (self.columns, self.kept);
        let distance = match self.first {
            0 => number.to_string(),
            first => format!("({number} - {first}{unsigned})"),
        };
        (kept < columns).then(|| format!("{distance} % {columns}{unsigned} < {kept}{unsigned}"))
    }

    /// Where in an array a device is: `[3]`, `[3][0]`.
    pub fn subscript(&self, number: u32) -> String {
        let n = number - self.first;
        match self.columns {
            1 => format!("[{n}]"),
            columns => format!("[{}][{}]", n % columns, n / columns),
        }
    }

    /// Writes where in an array the device is whose number stands in a variable: `[n]`, `[n - 16]`.
    pub fn element(&self, out: &mut String, number: &str, unsigned: &str) {
        let distance = match self.first {
            0 => number.to_string(),
            first => format!("{number} - {first}{unsigned}"),
        };
        let _ = match (self.columns, self.first) {
            (1, _) => write!(out, "[{distance}]"),
            (columns, 0) => write!(
                out,
                "[{distance} % {columns}{unsigned}][{distance} / {columns}{unsigned}]"
            ),
            (columns, _) => write!(
                out,
                "[({distance}) % {columns}{unsigned}][({distance}) / {columns}{unsigned}]"
            ),
        };
    }

    /// One past the last number.
    pub fn end(&self) -> u32 {
        self.first + self.count
    }
}

/// What RUN/STOP and power-off do to a run of devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Keep {
    Input,
    General,
    Latched,
    Special,
    Record,
}

/// A run of devices within one field that power-off treats alike.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// First number.
    pub first: u32,
    /// How many.
    pub count: u32,
    keep: Keep,
}

impl Run {
    /// Whether STOP clears it.
    pub fn is_general(&self) -> bool {
        self.keep == Keep::General
    }

    /// Whether it is kept over power-off.
    pub fn is_latched(&self) -> bool {
        self.keep == Keep::Latched
    }

    /// Whether it holds special devices.
    pub fn is_special(&self) -> bool {
        self.keep == Keep::Special
    }
}

/// All fields of a program's struct.
pub struct Fields<'m> {
    model: &'static Model,
    /// By class and number.
    fields: Vec<Field>,
    /// Where each class begins in `fields`.
    of_class: [(usize, usize); DeviceClass::ALL.len()],
    /// For each class by number: which of its fields holds the device, [`NO_FIELD`] if none does.
    by_number: [Vec<u32>; DeviceClass::ALL.len()],
    /// By class and number: alike-treated runs, cut at the ends of fields.
    runs: Vec<(DeviceClass, Run)>,
    comments: HashMap<(DeviceClass, u32), &'m str>,
}

impl<'m> Fields<'m> {
    /// Decides on the fields.
    pub fn new(module: &'m Module) -> Self {
        let runs = runs(module);
        let mut fields: Vec<Field> = Vec::new();
        let mut merged: Vec<(DeviceClass, Run)> = Vec::new();
        for &(class, run, array) in &runs {
            let grid = module.layout.grid(class, run.first);
            let columns = grid.map_or(1, |grid| grid.columns);
            let kept = grid.map_or(1, |grid| grid.kept);
            let first = grid.map_or(0, |grid| grid.first);
            let Some(kind) = Kind::of(class, run.first) else {
                continue;
            };
            match merged.last_mut() {
                // What a grid does not store is no gap between runs.
                Some((of, last))
                    if *of == class
                        && grid.is_some_and(|g| g.first < run.first)
                        && first <= last.first
                        && last.keep == run.keep =>
                {
                    last.count = run.first + run.count - last.first;
                }
                _ => merged.push((class, run)),
            }
            if !array {
                fields.extend((run.first..run.first + run.count).map(|first| Field {
                    class,
                    first,
                    count: 1,
                    array,
                    grid: grid.is_some(),
                    columns,
                    kept,
                    numbered: true,
                    kind,
                    section: section(run.keep),
                }));
                continue;
            }
            match fields.last_mut() {
                Some(last)
                    if last.array
                        && last.grid == grid.is_some()
                        && (!last.grid || last.first == first)
                        && last.class == class
                        && last.kind == kind
                        && (last.grid || last.end() == run.first) =>
                {
                    last.count = run.first + run.count - last.first;
                    if last.section != section(run.keep) {
                        last.section = Section::Mixed;
                    }
                }
                _ => fields.push(Field {
                    class,
                    first: run.first,
                    count: run.count,
                    array,
                    grid: grid.is_some(),
                    columns,
                    kept,
                    numbered: run.first != 0,
                    kind,
                    section: section(run.keep),
                }),
            }
        }
        let mut of_class = [(0, 0); DeviceClass::ALL.len()];
        for class in DeviceClass::ALL {
            of_class[class as usize] = (
                fields.partition_point(|f| f.class < class),
                fields.partition_point(|f| f.class <= class),
            );
        }
        let by_number = of_class.map(|(from, to)| fields_by_number(&fields[from..to]));
        Fields {
            model: module.model,
            fields,
            of_class,
            by_number,
            runs: merged,
            comments: module
                .comments
                .iter()
                .map(|(class, n, text)| ((*class, *n), text.as_str()))
                .collect(),
        }
    }

    /// The fields of a class.
    pub fn of_class(&self, class: DeviceClass) -> &[Field] {
        let (from, to) = self.of_class[class as usize];
        &self.fields[from..to]
    }

    /// How many bytes the devices take, without what stands between them for alignment.
    pub fn bytes(&self) -> u64 {
        let bytes = |field: &Field| u64::from(field.room()) * u64::from(field.kind.size().0);
        self.fields.iter().map(bytes).sum()
    }

    /// The fields in the order of the struct. Arrays that loops over rungs go through stand side by side: clang makes vectors of two bytes
    /// only if a few others lie between what a loop reads and what it writes.
    pub fn in_struct_order(&self) -> Vec<&Field> {
        let mut fields: Vec<&Field> = self.fields.iter().collect();
        fields.sort_by_key(|f| match f.section {
            Section::Inputs | Section::Mixed => (f.section, f.grid),
            _ => (f.section, !f.grid),
        });
        fields
    }

    /// The field that holds a device, under whichever name.
    pub fn find(&self, class: DeviceClass, number: u32) -> Option<&Field> {
        let (class, number) = self.model.canonical(class, number);
        let i = *self.by_number[class as usize].get(number as usize)?;
        let field = self.of_class(class).get(i as usize);
        field.filter(|field| field.holds(number))
    }

    /// The array that holds `count` devices from `number` on, one behind the other.
    pub fn array(&self, class: DeviceClass, number: u32, count: u32) -> Option<&Field> {
        self.find(class, number)
            .filter(|f| f.array && !f.grid && f.end() - number >= count)
    }

    /// The runs of a field that power-off treats alike.
    pub fn runs(&self, field: &Field) -> impl Iterator<Item = Run> + '_ {
        let (class, first, end) = (field.class, field.first, field.end());
        let from = self
            .runs
            .partition_point(|(c, r)| (*c, r.first + r.count) <= (class, first));
        self.runs[from..]
            .iter()
            .take_while(move |(c, r)| *c == class && r.first < end)
            .map(|(_, r)| *r)
    }

    /// Writes the expression of a stored device; false if it is not stored.
    pub fn access(&self, out: &mut String, class: DeviceClass, number: u32) -> bool {
        let Some(field) = self.find(class, number) else {
            return false;
        };
        let (_, number) = self.model.canonical(class, number);
        out.push_str("plc->");
        field.name(out);
        if field.columns > 1 {
            out.push_str(&field.subscript(number));
        } else if field.array {
            // D100[103 - 100] keeps the device's own number in sight.
            let _ = match field.first {
                0 => write!(out, "[{number}]"),
                first if first == number => write!(out, "[0]"),
                first => write!(out, "[{number} - {first}]"),
            };
        }
        true
    }

    /// Writes the expression of a device of a loop's present round, whose number stands in `variable`; false if it is not stored so.
    pub fn access_round(
        &self,
        out: &mut String,
        (class, number): (DeviceClass, u32),
        by: u32,
        variable: &str,
    ) -> bool {
        let Some(field) = self
            .find(class, number)
            .filter(|f| f.grid && f.columns == by)
        else {
            return false;
        };
        out.push_str("plc->");
        field.name(out);
        let n = number - field.first;
        if by > 1 {
            let _ = write!(out, "[{}]", n % by);
        }
        let _ = match n / by {
            0 => write!(out, "[{variable}]"),
            row => write!(out, "[{row} + {variable}]"),
        };
        true
    }

    /// The comment on a device.
    pub fn comment(&self, class: DeviceClass, number: u32) -> Option<&'m str> {
        self.comments.get(&(class, number)).copied()
    }
}

/// Stands for devices that no field holds.
const NO_FIELD: u32 = u32::MAX;

/// Which of the fields of one class holds a device, by number.
fn fields_by_number(fields: &[Field]) -> Vec<u32> {
    let end = fields.last().map_or(0, Field::end);
    let mut by_number = vec![NO_FIELD; end as usize];
    for (field, i) in fields.iter().zip(0..) {
        by_number[field.first as usize..field.end() as usize].fill(i);
    }
    by_number
}

fn section(keep: Keep) -> Section {
    match keep {
        Keep::Input => Section::Inputs,
        Keep::General => Section::General,
        Keep::Latched => Section::Latched,
        Keep::Special => Section::Special,
        Keep::Record => Section::Records,
    }
}

/// The layout's areas, cut where counters become 32-bit ones and where special devices begin.
fn runs(module: &Module) -> Vec<(DeviceClass, Run, bool)> {
    let mut runs = Vec::with_capacity(module.layout.areas.len());
    for area in &module.layout.areas {
        let (first, end) = (area.first, area.first + area.count);
        let cut = match area.class {
            DeviceClass::C => FIRST_COUNTER32,
            DeviceClass::M | DeviceClass::D => FIRST_SPECIAL,
            _ => end,
        };
        let special = |n: u32| is_special(area.class, n);
        let cut = cut.clamp(first, end);
        for (first, end) in [(first, cut), (cut, end)] {
            if first < end {
                let keep = if area.class == DeviceClass::X {
                    Keep::Input
                } else if special(first) {
                    if area.latched {
                        Keep::Record
                    } else {
                        Keep::Special
                    }
                } else if area.latched {
                    Keep::Latched
                } else {
                    Keep::General
                };
                runs.push((
                    area.class,
                    Run {
                        first,
                        count: end - first,
                        keep,
                    },
                    area.array,
                ));
            }
        }
    }
    runs
}
