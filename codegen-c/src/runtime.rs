//! Calls of the runtime library.

use crate::expr::{Around, float, integer};
use crate::writer::Writer;
use rungc_emit::areas;
use rungc_ir::node::{Arg, Call, Expr, ExprId, Fetch, Place, Send};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Where a call is, and what it is.
struct Site {
    wide: bool,
    drive: Option<ExprId>,
    signal: bool,
    slot: u16,
    step: u32,
}

impl Writer<'_, '_> {
    /// Writes a [`Stmt::Call`](rungc_ir::node::Stmt::Call).
    pub fn runtime_call(&mut self, code: &mut String, call: &Call) {
        let _ = write!(code, "rungc_{}(&map, ", call.function.name());
        let site = Site {
            wide: call.wide,
            drive: call.drive,
            signal: call.signal,
            slot: call.slot,
            step: call.step,
        };
        self.site(code, &site);
        for i in 0..call.function.operands().len() {
            code.push_str(", ");
            match call.args.get(i) {
                Some(arg) => self.argument(code, arg),
                // An operand that was left out.
                None => code.push_str("rungc_K(0)"),
            }
        }
        code.push_str(");");
    }

    /// Writes a [`Stmt::Fetch`](rungc_ir::node::Stmt::Fetch), without what it assigns.
    pub fn fetch(&mut self, code: &mut String, fetch: &Fetch) {
        self.operand_call(code, "fetch", (fetch.wide, fetch.step), &fetch.from);
        let cell = &self.module.cells[fetch.value].name;
        let _ = write!(code, ", &plc->{cell});");
    }

    /// Writes a [`Stmt::Send`](rungc_ir::node::Stmt::Send).
    pub fn send(&mut self, code: &mut String, send: &Send) {
        self.operand_call(code, "send", (send.wide, send.step), &send.to);
        code.push_str(", ");
        self.expr(code, send.value, Around::Exact);
        code.push_str(");");
    }

    /// The start of a call that reads or writes an operand.
    fn operand_call(
        &mut self,
        code: &mut String,
        function: &str,
        (wide, step): (bool, u32),
        arg: &Arg,
    ) {
        let _ = write!(code, "rungc_{function}(&map, ");
        let site = Site {
            wide,
            drive: None,
            signal: false,
            slot: 0,
            step,
        };
        self.site(code, &site);
        code.push_str(", ");
        self.argument(code, arg);
    }

    fn site(&mut self, code: &mut String, site: &Site) {
        let Site {
            wide,
            drive,
            signal,
            slot,
            step,
        } = *site;
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
        if signal {
            code.push_str(", .signal = true");
        }
        code.push('}');
    }

    fn argument(&mut self, code: &mut String, arg: &Arg) {
        match arg {
            Arg::Const { value, index, wide } => self.constant(code, *value, *index, *wide),
            Arg::Float(value) => {
                code.push_str("rungc_E(");
                float(code, *value);
                code.push(')');
            }
            Arg::Device { place, .. } => self.device(code, place),
            Arg::Nibbles { place, digits, .. } => {
                let _ = write!(code, "rungc_group({digits}, ");
                self.device(code, place);
                code.push(')');
            }
            Arg::WordBit { place, bit, .. } => {
                code.push_str("rungc_bit_of(");
                self.device(code, place);
                let _ = write!(code, ", {bit})");
            }
            Arg::Buffer {
                module,
                address,
                index,
            } => {
                // An address is indexed as a device's number is.
                let place = Place {
                    class: DeviceClass::D,
                    number: *address,
                    index: *index,
                };
                let _ = write!(code, "rungc_U({module}, ");
                self.number(code, &place);
                code.push(')');
            }
            Arg::Text(text) => {
                let _ = write!(code, "rungc_string({text})");
            }
        }
    }

    /// A device, and in which area the runtime finds it without a search.
    fn device(&mut self, code: &mut String, place: &Place) {
        let area = match place.index {
            None => areas::named(&self.areas, place.class, place.number),
            Some(_) => None,
        };
        if let Some(area) = area {
            let _ = write!(code, "rungc_in({area}, ");
        }
        let _ = write!(code, "rungc_{}(", place.class.prefix());
        self.number(code, place);
        code.push(')');
        if area.is_some() {
            code.push(')');
        }
    }

    fn constant(&mut self, code: &mut String, value: i32, index: Option<ExprId>, wide: bool) {
        code.push_str("rungc_K(");
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
