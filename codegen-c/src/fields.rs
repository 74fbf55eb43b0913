//! The fields of the program's struct as C.

use crate::text;
use rungc_emit::storage::{At, Field, Kind, Storage};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// The C type of what a device is stored as.
pub(crate) fn c_type(kind: Kind) -> &'static str {
    match kind {
        Kind::Bit => "bool",
        Kind::NumericBit => "uint8_t",
        Kind::Word => "int16_t",
        Kind::Timer => "plc_timer",
        Kind::Counter16 => "plc_counter16",
        Kind::Counter32 => "plc_counter32",
    }
}

/// A field as C.
pub trait PrintField {
    /// Writes its name: `X10`, `D`, `M8000`.
    fn name(&self, out: &mut String);
    /// The dimensions of an array: `[10]`, `[10][32]`.
    fn extents(&self) -> String;
    /// Subscript of a device in an array: `[3]`, `[3][0]`.
    fn subscript(&self, number: u32) -> String;
    /// Writes where in an array the device is whose number is in a variable: `[n]`, `[n - 16]`.
    fn element(&self, out: &mut String, number: &str, unsigned: &str);
    /// That it holds one of its numbers, which is in a variable, if it does not hold all: `(n - 16) % 10 < 8`.
    fn column_is_stored(&self, number: &str, unsigned: &str) -> Option<String>;
}

impl PrintField for Field {
    fn name(&self, out: &mut String) {
        out.push_str(self.class.prefix());
        match (self.is_numbered(), self.class.is_octal()) {
            (false, _) => {}
            (true, true) => text::push_octal(out, self.first),
            (true, false) => text::push_number(out, self.first),
        }
    }

    fn extents(&self) -> String {
        match self.dimensions() {
            (None, rows) => format!("[{rows}]"),
            (Some(columns), rows) => format!("[{columns}][{rows}]"),
        }
    }

    fn subscript(&self, number: u32) -> String {
        match self.at(number) {
            At::Field => String::new(),
            At::Element(n) => format!("[{n}]"),
            At::Column { column, row } => format!("[{column}][{row}]"),
        }
    }

    fn element(&self, out: &mut String, number: &str, unsigned: &str) {
        let distance = match self.first {
            0 => number.to_string(),
            first => format!("{number} - {first}{unsigned}"),
        };
        let columns = self.columns().map(|grid| grid.columns);
        // Writing to a String does not fail, here and below.
        let _ = match (columns, self.first) {
            (None, _) => write!(out, "[{distance}]"),
            (Some(columns), 0) => write!(
                out,
                "[{distance} % {columns}{unsigned}][{distance} / {columns}{unsigned}]"
            ),
            (Some(columns), _) => write!(
                out,
                "[({distance}) % {columns}{unsigned}][({distance}) / {columns}{unsigned}]"
            ),
        };
    }

    fn column_is_stored(&self, number: &str, unsigned: &str) -> Option<String> {
        let grid = self.trimmed()?;
        let distance = match self.first {
            0 => number.to_string(),
            first => format!("({number} - {first}{unsigned})"),
        };
        let (columns, stored) = (grid.columns, grid.stored_columns);
        Some(format!(
            "{distance} % {columns}{unsigned} < {stored}{unsigned}"
        ))
    }
}

/// Stored devices as C.
pub trait PrintStorage {
    /// Writes the expression of a stored device; false if it is not stored.
    fn access(&self, out: &mut String, class: DeviceClass, number: u32) -> bool;
    /// Writes the expression of a device of a loop's current iteration, whose number is in `variable`; false if it is
    /// not stored so.
    fn access_iteration(
        &self,
        out: &mut String,
        device: (DeviceClass, u32),
        by: u32,
        variable: &str,
    ) -> bool;
}

impl PrintStorage for Storage<'_> {
    fn access(&self, out: &mut String, class: DeviceClass, number: u32) -> bool {
        let Some((field, number)) = self.slot(class, number) else {
            return false;
        };
        out.push_str("plc->");
        field.name(out);
        out.push_str(&field.subscript(number));
        true
    }

    fn access_iteration(
        &self,
        out: &mut String,
        (class, number): (DeviceClass, u32),
        by: u32,
        variable: &str,
    ) -> bool {
        let Some(slot) = self.round_slot(class, number, by) else {
            return false;
        };
        out.push_str("plc->");
        slot.field.name(out);
        if let Some(column) = slot.column {
            let _ = write!(out, "[{column}]");
        }
        let _ = match slot.row {
            0 => write!(out, "[{variable}]"),
            row => write!(out, "[{row} + {variable}]"),
        };
        true
    }
}
