//! Calls of the runtime library.

use crate::code::Code;
use crate::expr::{Around, float, integer};
use crate::writer::Writer;
use rungc_emit::areas;
use rungc_ir::node::{Arg, Call, Expr, ExprId, Fetch, Place, Send};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Location and form of a call.
struct Site {
    wide: bool,
    drive: Option<ExprId>,
    signal: bool,
    period_ms: u16,
    slot: u16,
    step: u32,
}

impl Writer<'_, '_> {
    /// Writes a [`Action::Call`](rungc_ir::node::Action::Call).
    pub(crate) fn runtime_call(&mut self, code: &mut Code, call: &Call) {
        let _ = write!(code.text(), "rungc_{}", call.function.name());
        code.open("(&map");
        code.comma();
        let site = Site {
            wide: call.wide,
            drive: call.drive,
            signal: call.signal,
            period_ms: call.period_ms,
            slot: call.slot,
            step: call.step,
        };
        self.site(code, &site);
        for i in 0..call.function.operands().len() {
            code.comma();
            match call.args.get(i) {
                Some(arg) => self.argument(code, arg),
                // An operand that was left out.
                None => code.push_str("rungc_K(0)"),
            }
        }
        code.close(");");
    }

    /// Writes a [`Action::Fetch`](rungc_ir::node::Action::Fetch), without what it assigns.
    pub fn fetch(&mut self, code: &mut Code, fetch: &Fetch) {
        self.operand_call(code, "fetch", (fetch.wide, fetch.step), &fetch.from);
        let cell = &self.module.cells[fetch.value].name;
        code.argument(format_args!("&plc->{cell}"));
        code.close(");");
    }

    /// Writes a [`Action::Send`](rungc_ir::node::Action::Send).
    pub fn send(&mut self, code: &mut Code, send: &Send) {
        self.operand_call(code, "send", (send.wide, send.step), &send.to);
        code.comma();
        self.expr(code, send.value, Around::Exact);
        code.close(");");
    }

    /// The start of a call that reads or writes an operand.
    fn operand_call(
        &mut self,
        code: &mut Code,
        function: &str,
        (wide, step): (bool, u32),
        arg: &Arg,
    ) {
        let _ = write!(code.text(), "rungc_{function}");
        code.open("(&map");
        code.comma();
        let site = Site {
            wide,
            drive: None,
            signal: false,
            period_ms: 0,
            slot: 0,
            step,
        };
        self.site(code, &site);
        code.comma();
        self.argument(code, arg);
    }

    fn site(&mut self, code: &mut Code, site: &Site) {
        let Site {
            wide,
            drive,
            signal,
            period_ms,
            slot,
            step,
        } = *site;
        let always = drive.is_none_or(|e| *self.module.expr(e) == Expr::Bit(true));
        if always && slot == 0 && period_ms == 0 {
            let function = if wide { "rungc_wide_at" } else { "rungc_at" };
            let _ = write!(code.text(), "{function}({step})");
            return;
        }
        code.open("(rungc_site){");
        let _ = write!(code.text(), ".step = {step}");
        if slot > 0 {
            code.argument(format_args!(".slot = {slot}"));
        }
        if wide {
            code.argument(".wide = true");
        }
        code.argument(".drive = ");
        match drive {
            Some(drive) => self.expr(code, drive, Around::Exact),
            None => code.push_str("true"),
        }
        if signal {
            code.argument(".signal = true");
        }
        if period_ms > 0 {
            code.argument(format_args!(".period_ms = {period_ms}"));
        }
        code.close("}");
    }

    fn argument(&mut self, code: &mut Code, arg: &Arg) {
        match arg {
            Arg::Const { value, index, wide } => self.constant(code, *value, *index, *wide),
            Arg::Float(value) => {
                code.open("rungc_E(");
                float(code.text(), *value);
                code.close(")");
            }
            Arg::Device { place, .. } => self.device(code, place),
            Arg::Nibbles { place, digits, .. } => {
                code.open("rungc_group(");
                code.push_str(&digits.to_string());
                code.comma();
                self.device(code, place);
                code.close(")");
            }
            Arg::WordBit { place, bit, .. } => {
                code.open("rungc_bit_of(");
                self.device(code, place);
                code.argument(bit);
                code.close(")");
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
                code.open("rungc_U(");
                code.push_str(&module.to_string());
                code.comma();
                self.number(code, &place);
                code.close(")");
            }
            Arg::Text(text) => {
                let _ = write!(code.text(), "rungc_string({text})");
            }
        }
    }

    /// A device, and in which area the runtime finds it without a search: with an index, that of its operand, where
    /// most indexes lead.
    fn device(&mut self, code: &mut Code, place: &Place) {
        let area = areas::named(&self.areas, place.class, place.number);
        if let Some(area) = area {
            code.open("rungc_in(");
            let _ = write!(code.text(), "{area}");
            code.comma();
        }
        let _ = write!(code.text(), "rungc_{}", place.class.prefix());
        code.open("(");
        self.number(code, place);
        code.close(")");
        if area.is_some() {
            code.close(")");
        }
    }

    fn constant(&mut self, code: &mut Code, value: i32, index: Option<ExprId>, wide: bool) {
        code.open("rungc_K(");
        match (index, wide) {
            (None, _) => integer(code.text(), value),
            (Some(index), true) => self.indexed_constant(code, value, index),
            (Some(index), false) => {
                code.open("plc_low(");
                self.indexed_constant(code, value, index);
                code.close(")");
            }
        }
        code.close(")");
    }

    fn indexed_constant(&mut self, code: &mut Code, value: i32, index: ExprId) {
        code.open("plc_add32(");
        integer(code.text(), value);
        code.comma();
        self.expr(code, index, Around::Exact);
        code.close(")");
    }
}
