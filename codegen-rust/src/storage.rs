//! The fields of the emitted struct: where each stored device lives.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use rungc_ir::Module;
use rungc_ir::layout::{Area, Grid};
use rungc_models::Model;
use rungc_models::runs::FIRST_COUNTER32;
use rungc_syntax::DeviceClass;

/// What a field holds per device.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Elem {
    /// `bool`.
    Bit,
    /// `u8`, 0 or 1: a bit in an array of columns.
    Level,
    /// `i16`.
    Word,
    /// `rungc_rt::Timer`.
    Timer,
    /// `rungc_rt::Counter16`.
    Counter16,
    /// `rungc_rt::Counter32`.
    Counter32,
}

impl Elem {
    /// Name of its type.
    pub fn type_name(self) -> &'static str {
        match self {
            Elem::Bit => "bool",
            Elem::Level => "u8",
            Elem::Word => "i16",
            Elem::Timer => "Timer",
            Elem::Counter16 => "Counter16",
            Elem::Counter32 => "Counter32",
        }
    }

    fn of(class: DeviceClass, number: u32) -> Self {
        match class {
            DeviceClass::T => Elem::Timer,
            DeviceClass::C if number < FIRST_COUNTER32 => Elem::Counter16,
            DeviceClass::C => Elem::Counter32,
            DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S => Elem::Bit,
            _ => Elem::Word,
        }
    }
}

/// A field: one device, or an array of neighbours.
#[derive(Clone, Debug)]
pub struct Field {
    /// `x0`, `d` (an array from D0 on), `d100` (one from D100 on, or D100 itself).
    pub name: Ident,
    /// The devices.
    pub area: Area,
    /// What each of them is.
    pub elem: Elem,
    /// How the array is divided into columns, if a loop over rungs goes through it.
    pub grid: Option<Grid>,
    /// The parts of the area that are kept in the same cases; more than one only if it has columns.
    pub parts: Vec<Area>,
}

impl Field {
    fn new(area: Area) -> Self {
        let prefix = area.class.prefix().to_lowercase();
        let name = match area.class {
            _ if area.array && area.first == 0 => prefix,
            class if class.is_octal() => format!("{prefix}{:o}", area.first),
            _ => format!("{prefix}{}", area.first),
        };
        Field {
            name: Ident::new(&name, Span::call_site()),
            elem: Elem::of(area.class, area.first),
            area,
            grid: None,
            parts: vec![area],
        }
    }

    /// The grid, if it has more than one column.
    pub fn columns(&self) -> Option<Grid> {
        self.grid.filter(|grid| grid.columns > 1)
    }

    /// An array of columns.
    fn of_grid(grid: Grid, parts: Vec<Area>) -> Self {
        let area = Area {
            class: grid.class,
            first: grid.first,
            count: grid.count,
            array: true,
            latched: parts.iter().all(|part| part.latched),
        };
        let field = Field::new(area);
        Field {
            elem: match field.elem {
                Elem::Bit => Elem::Level,
                other => other,
            },
            grid: Some(grid),
            parts,
            ..field
        }
    }

    /// Whether it holds a device.
    pub fn holds(&self, number: u32) -> bool {
        let columns = self.grid.is_none_or(|grid| grid.holds(number));
        columns && (self.area.first..=self.last()).contains(&number)
    }

    /// Number of its last device.
    pub fn last(&self) -> u32 {
        self.area.first + self.area.count.max(1) - 1
    }
}

/// Areas of a grid, those joined that are kept in the same cases: what lies between them is not stored.
fn joined(areas: Vec<Area>) -> Vec<Area> {
    let mut joined: Vec<Area> = Vec::new();
    for area in areas {
        match joined.last_mut() {
            Some(last) if last.latched == area.latched => {
                last.count = area.first + area.count - last.first;
            }
            _ => joined.push(area),
        }
    }
    joined
}

/// All fields, sorted by class and number.
#[derive(Clone, Debug)]
pub struct Storage {
    model: &'static Model,
    /// The fields.
    pub fields: Vec<Field>,
}

impl Storage {
    /// The fields for a program's layout.
    pub fn new(module: &Module) -> Self {
        let layout = &module.layout;
        let mut fields = Vec::new();
        for area in &layout.areas {
            if let Some(grid) = layout.grid(area.class, area.first) {
                if area.first == grid.first {
                    let inside = |a: &&Area| {
                        a.class == grid.class && a.first >= grid.first && a.first < grid.end()
                    };
                    let parts = layout.areas.iter().filter(inside).copied().collect();
                    fields.push(Field::of_grid(*grid, joined(parts)));
                }
                continue;
            }
            if !area.array {
                fields.extend((0..area.count).map(|i| {
                    Field::new(Area {
                        first: area.first + i,
                        count: 1,
                        ..*area
                    })
                }));
                continue;
            }
            // An array has one element type: counters part at C200.
            let wide_from = if area.class == DeviceClass::C {
                FIRST_COUNTER32.clamp(area.first, area.first + area.count)
            } else {
                area.first
            };
            let parts = [
                (area.first, wide_from - area.first),
                (wide_from, area.first + area.count - wide_from),
            ];
            let parts = parts.into_iter().filter(|&(_, count)| count > 0);
            fields.extend(parts.map(|(first, count)| {
                Field::new(Area {
                    first,
                    count,
                    ..*area
                })
            }));
        }
        Storage {
            model: module.model,
            fields,
        }
    }

    /// The field that holds a device, under whichever name.
    pub fn find(&self, class: DeviceClass, number: u32) -> Option<&Field> {
        let (class, number) = self.model.canonical(class, number);
        let after = self
            .fields
            .partition_point(|f| (f.area.class, f.area.first) <= (class, number));
        let field = self.fields.get(after.checked_sub(1)?)?;
        (field.area.class == class && field.holds(number)).then_some(field)
    }

    /// The place of a device behind `plc`: `plc.x0`, `plc.d[7]`.
    pub fn cell(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        let field = self.find(class, number)?;
        let (_, number) = self.model.canonical(class, number);
        let name = &field.name;
        if let Some(grid) = field.columns() {
            let (column, row) = grid.place(number);
            let [column, row] = [column, row].map(Literal::u32_unsuffixed);
            return Some(quote!(#plc.#name[#column][#row]));
        }
        Some(if field.area.array {
            let i = Literal::u32_unsuffixed(number - field.area.first);
            quote!(#plc.#name[#i])
        } else {
            quote!(#plc.#name)
        })
    }

    /// The place of a device of a loop's present round, whose number is in `variable`.
    pub fn cell_of_round(
        &self,
        (class, number): (DeviceClass, u32),
        by: u32,
        variable: &Ident,
    ) -> Option<TokenStream> {
        let field = self.find(class, number)?;
        let grid = field.grid.filter(|grid| grid.columns == by)?;
        let name = &field.name;
        let (column, row) = grid.place(number);
        let column = field.columns().map(|_| {
            let column = Literal::u32_unsuffixed(column);
            quote!([#column])
        });
        let row = match row {
            0 => quote!(#variable),
            row => {
                let row = Literal::u32_unsuffixed(row);
                quote!(#row + #variable)
            }
        };
        Some(quote!(plc.#name #column [#row]))
    }

    /// Whether it is stored as a number, 0 or 1.
    pub fn is_level(&self, class: DeviceClass, number: u32) -> bool {
        let field = self.find(class, number);
        field.is_some_and(|field| field.elem == Elem::Level)
    }

    /// Where its state as a bit is: a number if [`Storage::is_level`].
    pub fn bit(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        bit_of(class, number, self.cell(plc, class, number)?)
    }

    /// Where its value as a 16-bit word is.
    pub fn word(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        word_of(class, number, self.cell(plc, class, number)?)
    }

    /// Where a 32-bit counter's value is.
    pub fn counter32(
        &self,
        plc: &TokenStream,
        class: DeviceClass,
        number: u32,
    ) -> Option<TokenStream> {
        let cell = self.cell(plc, class, number)?;
        (Elem::of(class, number) == Elem::Counter32).then(|| quote!(#cell.value))
    }
}

/// Where the state as a bit is of a device that is stored there.
pub fn bit_of(class: DeviceClass, number: u32, cell: TokenStream) -> Option<TokenStream> {
    match Elem::of(class, number) {
        Elem::Bit | Elem::Level => Some(cell),
        Elem::Word => None,
        Elem::Timer | Elem::Counter16 | Elem::Counter32 => Some(quote!(#cell.done)),
    }
}

/// Where the value as a 16-bit word is of a device that is stored there.
pub fn word_of(class: DeviceClass, number: u32, cell: TokenStream) -> Option<TokenStream> {
    match Elem::of(class, number) {
        Elem::Word => Some(cell),
        Elem::Bit | Elem::Level | Elem::Counter32 => None,
        Elem::Timer | Elem::Counter16 => Some(quote!(#cell.value)),
    }
}
