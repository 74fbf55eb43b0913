//! The fields of the emitted struct as Rust.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use rungc_emit::storage::{At, Field, Kind, Member, Storage};
use rungc_syntax::DeviceClass;

/// Name of the type of what a device is stored as.
pub fn type_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Bit => "bool",
        Kind::NumericBit => "u8",
        Kind::Word => "i16",
        Kind::Timer => "Timer",
        Kind::Counter16 => "Counter16",
        Kind::Counter32 => "Counter32",
    }
}

/// A field as Rust.
pub trait PrintField {
    /// `x0`, `d` (an array from D0 on), `d100` (one from D100 on, or D100 itself).
    fn name(&self) -> Ident;
}

impl PrintField for Field {
    fn name(&self) -> Ident {
        let prefix = self.class.prefix().to_lowercase();
        let name = match (self.is_numbered(), self.class.is_octal()) {
            (false, _) => prefix,
            (true, true) => format!("{prefix}{:o}", self.first),
            (true, false) => format!("{prefix}{}", self.first),
        };
        Ident::new(&name, Span::call_site())
    }
}

/// Stored devices as Rust.
pub trait PrintStorage {
    /// The field of a device of `plc`: `plc.x0`, `plc.d[7]`.
    fn cell(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream>;

    /// The place of a device of a loop's current iteration, whose number is in `variable`.
    fn cell_of_iteration(
        &self,
        device: (DeviceClass, u32),
        by: u32,
        variable: &Ident,
    ) -> Option<TokenStream>;

    /// Location of its state as a bit: a number if [`Storage::is_numeric_bit`].
    fn bit(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        bit_of(class, number, self.cell(plc, class, number)?)
    }

    /// Location of its value as a 16-bit word.
    fn word(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        word_of(class, number, self.cell(plc, class, number)?)
    }

    /// Location of a 32-bit counter's value.
    fn counter32(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        let cell = self.cell(plc, class, number)?;
        (Kind::of(class, number) == Some(Kind::Counter32)).then(|| quote!(#cell.value))
    }
}

impl PrintStorage for Storage<'_> {
    fn cell(&self, plc: &TokenStream, class: DeviceClass, number: u32) -> Option<TokenStream> {
        let (field, number) = self.slot(class, number)?;
        let name = field.name();
        Some(match field.at(number) {
            At::Field => quote!(#plc.#name),
            At::Element(n) => {
                let n = Literal::u32_unsuffixed(n);
                quote!(#plc.#name[#n])
            }
            At::Column { column, row } => {
                let [column, row] = [column, row].map(Literal::u32_unsuffixed);
                quote!(#plc.#name[#column][#row])
            }
        })
    }

    fn cell_of_iteration(
        &self,
        (class, number): (DeviceClass, u32),
        by: u32,
        variable: &Ident,
    ) -> Option<TokenStream> {
        let slot = self.round_slot(class, number, by)?;
        let name = slot.field.name();
        let column = slot.column.map(|column| {
            let column = Literal::u32_unsuffixed(column);
            quote!([#column])
        });
        let row = match slot.row {
            0 => quote!(#variable),
            row => {
                let row = Literal::u32_unsuffixed(row);
                quote!(#row + #variable)
            }
        };
        Some(quote!(plc.#name #column [#row]))
    }
}

/// State as a bit of a device stored in `cell`.
pub fn bit_of(class: DeviceClass, number: u32, cell: TokenStream) -> Option<TokenStream> {
    Some(member(cell, Kind::of(class, number)?.bit()?))
}

/// Value as a 16-bit word of a device stored in `cell`.
pub fn word_of(class: DeviceClass, number: u32, cell: TokenStream) -> Option<TokenStream> {
    Some(member(cell, Kind::of(class, number)?.word()?))
}

/// A member of a device that is stored there.
pub fn member(cell: TokenStream, member: Member) -> TokenStream {
    match member {
        Member::Whole => cell,
        Member::Done => quote!(#cell.done),
        Member::Value => quote!(#cell.value),
    }
}
