//! Calls of the runtime library, and the table by which it finds the program's devices.

use crate::expr::{Around, integer};
use crate::writer::Writer;
use rungc_ir::node::{Arg, Expr, ExprId, Place, Stmt};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// The C name of a class.
pub fn class_name(class: DeviceClass) -> String {
    format!("RUNGC_{}", class.prefix())
}

impl Writer<'_, '_> {
    /// Writes a [`Stmt::Call`].
    pub fn runtime_call(&mut self, code: &mut String, stmt: &Stmt) {
        let Stmt::Call {
            function,
            wide,
            args,
            drive,
            slot,
            step,
        } = stmt
        else {
            return;
        };
        let _ = write!(code, "rungc_{}(&map, ", function.name());
        self.site(code, *wide, *drive, *slot, *step);
        for i in 0..function.operands().len() {
            code.push_str(", ");
            match args.get(i) {
                Some(arg) => self.argument(code, arg),
                // An operand that was left out.
                None => code.push_str("rungc_k(0)"),
            }
        }
        code.push_str(");");
    }

    fn site(&mut self, code: &mut String, wide: bool, drive: Option<ExprId>, slot: u16, step: u32) {
        let always = drive.is_none_or(|e| *self.module.expr(e) == Expr::Bit(true));
        if always && slot == 0 {
            let function = if wide { "rungc_wide_at" } else { "rungc_at" };
            let _ = write!(code, "{function}({step})");
            return;
        }
        let _ = write!(code, "(rungc_site){{.step = {step}");
        if slot > 0 {
            let _ = write!(code, ", .slot = {slot}");
        }
        if wide {
            code.push_str(", .wide = true");
        }
        code.push_str(", .drive = ");
        match drive {
            Some(drive) => self.expr(code, drive, Around::Exact),
            None => code.push_str("true"),
        }
        code.push('}');
    }

    fn argument(&mut self, code: &mut String, arg: &Arg) {
        match arg {
            Arg::Const { value, index, wide } => self.constant(code, *value, *index, *wide),
            Arg::Float(value) => {
                let _ = match value.is_finite() {
                    true => write!(code, "rungc_e({value:?}f)"),
                    false => write!(code, "rungc_e(plc_float({}))", value.to_bits() as i32),
                };
            }
            Arg::Device { place, .. } => {
                let _ = write!(code, "rungc_d({}, ", class_name(place.class));
                self.device_number(code, place);
            }
            Arg::Nibbles { place, digits, .. } => {
                let _ = write!(code, "rungc_kn({digits}, {}, ", class_name(place.class));
                self.device_number(code, place);
            }
            Arg::WordBit { place, bit } => {
                let _ = write!(code, "rungc_word_bit({bit}, {}, ", class_name(place.class));
                self.device_number(code, place);
            }
            Arg::Text(text) => {
                let _ = write!(code, "rungc_text({text})");
            }
        }
    }

    fn device_number(&mut self, code: &mut String, place: &Place) {
        self.number(code, place, 0);
        code.push(')');
    }

    fn constant(&mut self, code: &mut String, value: i32, index: Option<ExprId>, wide: bool) {
        code.push_str("rungc_k(");
        match (index, wide) {
            (None, _) => integer(code, value),
            (Some(index), true) => {
                code.push_str("plc_add32(");
                integer(code, value);
                code.push_str(", ");
                self.expr(code, index, Around::Exact);
                code.push(')');
            }
            (Some(index), false) => {
                code.push_str("plc_low(plc_add32(");
                integer(code, value);
                code.push_str(", ");
                self.expr(code, index, Around::Exact);
                code.push_str("))");
            }
        }
        code.push(')');
    }
}
