//! Statements that write to devices, as C.

use crate::expr::Around;
use crate::fields::PrintStorage;
use crate::helpers::reset_function;
use crate::writer::Writer;
use rungc_ir::node::{Access, AccessKind, Block, Expr, ExprId, IndexedCoil, Place, TimerCoil};
use rungc_models::runs::is_counter32;
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

impl Writer<'_, '_> {
    /// A run of devices is copied or filled; nothing is written of one that is not stored.
    pub(crate) fn block(&mut self, code: &mut String, block: Block) {
        let (to, count) = block.written();
        let words = matches!(to.class, DeviceClass::D | DeviceClass::R);
        let kind = if words { "words" } else { "bits" };
        let Some(target) = self.run(to, count) else {
            return;
        };
        match block {
            Block::Copy { from, .. } => {
                if let Some(source) = self.run(from, count) {
                    let _ = write!(code, "plc_copy_{kind}({target}, {source}, {count});");
                }
            }
            Block::Fill { value, .. } => {
                let _ = write!(code, "plc_fill_{kind}({target}, {count}, ");
                self.expr(code, value, Around::Exact);
                code.push_str(");");
            }
        }
    }

    /// A pointer to the first of some devices that are side by side.
    fn run(&self, first: Place, count: u32) -> Option<String> {
        self.fields.array(first.class, first.number, count)?;
        let mut element = "&".to_string();
        self.fields.access(&mut element, first.class, first.number);
        Some(element)
    }

    pub(crate) fn timer_goes_on(&mut self, code: &mut String, number: u32, kind: TimerKind) {
        code.push_str("plc_timer_go_on(&");
        self.fields.access(code, DeviceClass::T, number);
        let _ = write!(code, ", &plc->sys, {}u, ", kind.unit_ms.max(1));
        timer_options(code, self.coils.kind(number, kind));
        code.push_str(");");
    }

    pub(crate) fn timer(&mut self, code: &mut String, coil: &TimerCoil) {
        let kind = self.coils.kind(coil.number, coil.kind);
        let mut timer = String::new();
        self.fields.access(&mut timer, DeviceClass::T, coil.number);
        self.run_timer(code, (&timer, kind), coil.drive, coil.preset);
    }

    fn run_timer(
        &mut self,
        code: &mut String,
        (timer, kind): (&str, TimerKind),
        drive: ExprId,
        preset: ExprId,
    ) {
        let [drive, preset] = [drive, preset].map(|argument| {
            let mut text = String::new();
            self.expr(&mut text, argument, Around::Exact);
            text
        });
        run_timer(code, kind, timer, &drive, &preset);
    }

    /// A coil of the timer or counter of a loop's current iteration; false for any other.
    fn coil_of_iteration(&mut self, code: &mut String, coil: &IndexedCoil) -> bool {
        let IndexedCoil {
            ref place,
            drive,
            preset,
        } = *coil;
        let mut device = String::new();
        if !self.access_iteration(&mut device, place) {
            return false;
        }
        match (place.class, self.module.model.timer(place.number)) {
            (DeviceClass::T, Some(kind)) => {
                let by = match place.index.map(|index| self.module.expr(index)) {
                    Some(&Expr::Stride(_, by)) => by,
                    _ => 0,
                };
                let kind = self
                    .coils
                    .kind_of_iterations(place.number, by, self.iterations, kind);
                self.run_timer(code, (&device, kind), drive, preset);
            }
            _ => {
                let _ = write!(code, "plc_count16(&{device}, ");
                self.expr(code, drive, Around::Exact);
                code.push_str(", ");
                self.expr(code, preset, Around::Exact);
                code.push_str(");");
            }
        }
        true
    }

    /// A coil of a timer or counter that an index leads to.
    pub(crate) fn indexed_coil(&mut self, code: &mut String, coil: &IndexedCoil) {
        if self.coil_of_iteration(code, coil) {
            return;
        }
        let place = &coil.place;
        self.helpers.out(place.class);
        let _ = write!(
            code,
            "{}_out_{}(plc, ",
            self.module.name,
            place.class.prefix()
        );
        self.number(code, place);
        for argument in [coil.drive, coil.preset] {
            code.push_str(", ");
            self.expr(code, argument, Around::Exact);
        }
        code.push_str(");");
    }

    /// Writes a call that counts: a coil's, or that of a high-speed counter.
    pub(crate) fn counter(
        &mut self,
        code: &mut String,
        function: &str,
        number: u32,
        arguments: &[ExprId],
    ) {
        let _ = write!(code, "{function}(&");
        self.fields.access(code, DeviceClass::C, number);
        for &argument in arguments {
            code.push_str(", ");
            self.expr(code, argument, Around::Exact);
        }
        code.push_str(");");
    }

    pub(crate) fn write(&mut self, code: &mut String, access: &Access, value: ExprId) {
        let place = &access.place;
        match access.kind {
            AccessKind::Bit => self.put(code, "bit", place, value),
            AccessKind::WordBit(bit) => self.put_word_bit(code, place, bit, value),
            AccessKind::Word => self.put(code, "word", place, value),
            AccessKind::Pair => self.put_pair(code, place, value, false),
            AccessKind::Float => self.put_pair(code, place, value, true),
            AccessKind::Nibbles { .. } => self.put_nibbles(code, place, access.extent(), value),
        }
    }

    fn put(&mut self, code: &mut String, what: &'static str, place: &Place, value: ExprId) {
        let of_iteration = self.access_iteration(code, place);
        if place.index.is_some() && !of_iteration {
            self.helpers.put(what, place.class);
            let _ = write!(
                code,
                "{}_put_{what}_{}(plc, ",
                self.module.name,
                place.class.prefix()
            );
            self.number(code, place);
            code.push_str(", ");
            self.expr(code, value, Around::Exact);
            code.push_str(");");
            return;
        }
        // A device that nothing reads is not stored.
        if of_iteration || self.fields.access(code, place.class, place.number) {
            code.push_str(match (place.class, what) {
                (DeviceClass::T | DeviceClass::C, "bit") => ".done = ",
                (DeviceClass::T | DeviceClass::C, _) => ".value = ",
                _ => " = ",
            });
            match self.fields.is_numeric_bit(place.class, place.number) {
                true => self.grid_value(code, value),
                false => self.expr(code, value, Around::Exact),
            }
            code.push(';');
        }
    }

    fn put_word_bit(&mut self, code: &mut String, place: &Place, bit: u8, value: ExprId) {
        if place.index.is_some() {
            self.helpers.get("word", place.class);
            self.helpers.put("word", place.class);
            let (name, class) = (&self.module.name, place.class.prefix());
            let _ = write!(code, "{name}_put_word_{class}(plc, ");
            self.number(code, place);
            let _ = write!(code, ", plc_with_bit({name}_word_{class}(plc, ");
            self.number(code, place);
            let _ = write!(code, "), {bit}u, ");
            self.expr(code, value, Around::Exact);
            code.push_str("));");
            return;
        }
        let mut target = String::new();
        if self.fields.access(&mut target, place.class, place.number) {
            let _ = write!(code, "plc_put_bit(&{target}, {bit}u, ");
            self.expr(code, value, Around::Exact);
            code.push_str(");");
        }
    }

    fn put_pair(&mut self, code: &mut String, place: &Place, value: ExprId, float: bool) {
        let wide = is_counter32(place.class, place.number);
        if place.index.is_some() {
            self.put_indexed_pair(code, place, value, float);
            return;
        }
        let mut text = String::new();
        if float {
            text.push_str("plc_float_bits(");
        }
        self.expr(&mut text, value, Around::Exact);
        if float {
            text.push(')');
        }
        if wide {
            if self.fields.access(code, place.class, place.number) {
                let _ = write!(code, ".value = {text};");
            }
            return;
        }
        let high = place.high_word(self.module.model);
        let part = if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            ".value"
        } else {
            ""
        };
        let (mut low_name, mut high_name) = (String::new(), String::new());
        let low = self.fields.access(&mut low_name, place.class, place.number);
        let high = self.fields.access(&mut high_name, high.class, high.number);
        let _ = match (low, high) {
            (true, true) => write!(
                code,
                "plc_split(&{high_name}{part}, &{low_name}{part}, {text});"
            ),
            (true, false) => write!(code, "{low_name}{part} = plc_low({text});"),
            (false, true) => write!(code, "{high_name}{part} = plc_high({text});"),
            (false, false) => Ok(()),
        };
    }

    fn put_indexed_pair(&mut self, code: &mut String, place: &Place, value: ExprId, float: bool) {
        self.helpers.put("long", place.class);
        let _ = write!(
            code,
            "{}_put_long_{}(plc, ",
            self.module.name,
            place.class.prefix()
        );
        self.number(code, place);
        code.push_str(if float { ", plc_float_bits(" } else { ", " });
        self.expr(code, value, Around::Exact);
        code.push_str(if float { "));" } else { ");" });
    }

    fn put_nibbles(&mut self, code: &mut String, place: &Place, count: u32, value: ExprId) {
        if place.index.is_some() {
            self.helpers.put_bits(place.class);
            let _ = write!(
                code,
                "{}_put_bits_{}(plc, ",
                self.module.name,
                place.class.prefix()
            );
            self.number(code, place);
            let _ = write!(code, ", {count}u, ");
            self.expr(code, value, Around::Exact);
            code.push_str(");");
        } else if self
            .fields
            .array(place.class, place.number, count)
            .is_some()
        {
            code.push_str("plc_put_bits(&");
            self.fields.access(code, place.class, place.number);
            let _ = write!(code, ", {count}u, ");
            self.expr(code, value, Around::Exact);
            code.push_str(");");
        } else {
            self.put_scattered(code, place, count, value);
        }
    }

    /// Spreads a number over relays that are not an array.
    fn put_scattered(&mut self, code: &mut String, place: &Place, count: u32, value: ExprId) {
        code.push_str("plc_scatter((bool *const[]){");
        for bit in 0..count {
            code.push_str(if bit > 0 { ", " } else { "" });
            let mut name = String::new();
            if self
                .fields
                .access(&mut name, place.class, place.number + bit)
            {
                let _ = write!(code, "&{name}");
            } else {
                code.push_str("NULL");
            }
        }
        let _ = write!(code, "}}, {count}u, ");
        self.expr(code, value, Around::Exact);
        code.push_str(");");
    }

    pub(crate) fn reset(&mut self, code: &mut String, place: &Place) {
        let mut name = String::new();
        let of_iteration = self.access_iteration(&mut name, place);
        if place.index.is_some() && !of_iteration {
            self.helpers.reset(place.class);
            let _ = write!(
                code,
                "{}_reset_{}(plc, ",
                self.module.name,
                place.class.prefix()
            );
            self.number(code, place);
            code.push_str(");");
            return;
        }
        let Some(field) = self.fields.find(place.class, place.number) else {
            return;
        };
        if !of_iteration {
            self.fields.access(&mut name, place.class, place.number);
        }
        let _ = write!(code, "{}(&{name});", reset_function(field.kind));
    }
}

/// Writes the call that runs a timer.
pub fn run_timer(code: &mut String, kind: TimerKind, timer: &str, drive: &str, preset: &str) {
    let unit = kind.unit_ms;
    let family = match kind.accumulating {
        _ if kind.free_running
            || kind.latches_preset
            || kind.overruns
            || kind.stepwise
            || kind.shared =>
        {
            None
        }
        true => Some("retentive"),
        false => Some("timer"),
    };
    let arguments = format!("(&{timer}, {drive}, {preset}, &plc->sys");
    let _ = match family {
        Some(family) => write!(code, "plc_{family}_{unit}ms{arguments}"),
        None => write!(code, "plc_timer_run{arguments}, {}u, ", unit.max(1)),
    };
    if family.is_none() {
        timer_options(code, kind);
    }
    code.push_str(");");
}

fn timer_options(code: &mut String, kind: TimerKind) {
    let options = [
        (kind.accumulating, "PLC_RETENTIVE"),
        (kind.free_running, "PLC_FREE_RUNNING"),
        (kind.latches_preset, "PLC_LATCHES_PRESET"),
        (kind.overruns, "PLC_OVERRUNS"),
        (kind.stepwise, "PLC_STEPWISE"),
        (kind.shared, "PLC_SHARED"),
    ];
    let set: Vec<&str> = options.iter().filter(|o| o.0).map(|o| o.1).collect();
    if set.is_empty() {
        code.push_str("0u");
    } else {
        code.push_str(&set.join(" | "));
    }
}
