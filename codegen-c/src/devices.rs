//! Statements that write to devices, as C.

use crate::code::Code;
use crate::expr::Around;
use crate::fields::PrintStorage;
use crate::helpers::{hold_function, reset_function};
use crate::writer::Writer;
use rungc_ir::node::{Access, AccessKind, Block, Expr, ExprId, IndexedCoil, Place, TimerCoil};
use rungc_models::runs::is_counter32;
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

impl Writer<'_, '_> {
    /// A run of devices is copied or filled; nothing is written of one that is not stored.
    pub(crate) fn block(&mut self, code: &mut Code, block: Block) {
        let (to, count) = block.written();
        let has_index = |place: Place| place.index.is_some();
        if has_index(to) || block.source().is_some_and(has_index) {
            return self.indexed_block(code, block);
        }
        let words = matches!(to.class, DeviceClass::D | DeviceClass::R);
        let kind = if words { "words" } else { "bits" };
        let Some(target) = self.run(to, count) else {
            return;
        };
        match block {
            Block::Copy { from, .. } => {
                if let Some(source) = self.run(from, count) {
                    let _ = write!(code.text(), "plc_copy_{kind}");
                    code.open("(");
                    code.push_str(&target);
                    code.argument(source);
                    self.length(code, block);
                    code.close(");");
                }
            }
            Block::Fill { value, .. } => {
                let _ = write!(code.text(), "plc_fill_{kind}");
                code.open("(");
                code.push_str(&target);
                self.length(code, block);
                self.last_argument(code, value);
            }
        }
    }

    /// The number of devices as an argument, a `size_t`.
    fn length(&mut self, code: &mut Code, block: Block) {
        match block.length() {
            None => code.argument(block.written().1),
            Some(length) => {
                code.comma();
                code.push_str("(size_t)");
                self.expr(code, length, Around::Unary);
            }
        }
    }

    /// A block that begins where an index leads.
    fn indexed_block(&mut self, code: &mut Code, block: Block) {
        let (to, count) = block.written();
        let source = block.source();
        self.helpers.block(to.class, source.map(|from| from.class));
        for place in [Some(to), source].into_iter().flatten() {
            if place.index.is_none() {
                self.helpers.reach(place.class, place.number, count);
            }
        }
        let name = &self.module.name;
        let class = to.class.prefix();
        let _ = match source {
            Some(from) if from.class == to.class => write!(code.text(), "{name}_copy_{class}"),
            Some(from) => write!(
                code.text(),
                "{name}_copy_{}_to_{class}",
                from.class.prefix()
            ),
            None => write!(code.text(), "{name}_fill_{class}"),
        };
        code.open("(plc");
        for place in [Some(to), source].into_iter().flatten() {
            code.comma();
            self.number(code, &place);
        }
        match block.length() {
            None => code.argument(count),
            Some(length) => {
                code.comma();
                self.expr(code, length, Around::Exact);
            }
        }
        if let Block::Fill { value, .. } = block {
            code.comma();
            self.expr(code, value, Around::Exact);
        }
        code.close(");");
    }

    /// A pointer to the first of some devices that are side by side.
    fn run(&self, first: Place, count: u32) -> Option<String> {
        self.fields.array(first.class, first.number, count)?;
        let mut element = "&".to_string();
        self.fields.access(&mut element, first.class, first.number);
        Some(element)
    }

    pub(crate) fn timer_goes_on(&mut self, code: &mut Code, number: u32, kind: TimerKind) {
        code.open("plc_timer_go_on(&");
        self.fields.access(code.text(), DeviceClass::T, number);
        code.argument("&plc->sys");
        code.argument(format_args!("{}u", kind.unit_ms.max(1)));
        timer_options(code, self.coils.kind(number, kind));
        code.close(");");
    }

    /// The last argument of a call, and its end.
    fn last_argument(&mut self, code: &mut Code, value: ExprId) {
        code.comma();
        self.expr(code, value, Around::Exact);
        code.close(");");
    }

    pub(crate) fn timer(&mut self, code: &mut Code, coil: &TimerCoil) {
        let kind = self.coils.kind(coil.number, coil.kind);
        let mut timer = String::new();
        self.fields.access(&mut timer, DeviceClass::T, coil.number);
        self.run_timer(code, (&timer, kind), coil.drive, coil.preset);
    }

    fn run_timer(
        &mut self,
        code: &mut Code,
        (timer, kind): (&str, TimerKind),
        drive: ExprId,
        preset: ExprId,
    ) {
        let [drive, preset] = [drive, preset].map(|argument| {
            let mut argument_code = Code::default();
            self.expr(&mut argument_code, argument, Around::Exact);
            argument_code
        });
        run_timer(code, kind, timer, &drive, &preset);
    }

    /// A coil of the timer or counter of a loop's current iteration; false for any other.
    fn coil_of_iteration(&mut self, code: &mut Code, coil: &IndexedCoil) -> bool {
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
                code.open("plc_count16(&");
                code.push_str(&device);
                code.comma();
                self.expr(code, drive, Around::Exact);
                self.last_argument(code, preset);
            }
        }
        true
    }

    /// A coil of a timer or counter that an index leads to.
    pub(crate) fn indexed_coil(&mut self, code: &mut Code, coil: &IndexedCoil) {
        if self.coil_of_iteration(code, coil) {
            return;
        }
        let place = &coil.place;
        self.helpers.out(place.class);
        self.helper_call(code, "out", place);
        code.comma();
        self.expr(code, coil.drive, Around::Exact);
        self.last_argument(code, coil.preset);
    }

    /// Writes a call that counts: a coil's, or that of a high-speed counter.
    pub(crate) fn counter(
        &mut self,
        code: &mut Code,
        function: &str,
        number: u32,
        arguments: &[ExprId],
    ) {
        code.push_str(function);
        code.open("(&");
        self.fields.access(code.text(), DeviceClass::C, number);
        for &argument in arguments {
            code.comma();
            self.expr(code, argument, Around::Exact);
        }
        code.close(");");
    }

    pub(crate) fn write(&mut self, code: &mut Code, access: &Access, value: ExprId) {
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

    fn put(&mut self, code: &mut Code, what: &'static str, place: &Place, value: ExprId) {
        let is_found = self.access_by_index(code, place);
        if place.index.is_some() && !is_found {
            self.helpers.put(what, place.class);
            self.helper_call(code, &format!("put_{what}"), place);
            self.last_argument(code, value);
            return;
        }
        // A device that nothing reads is not stored.
        if is_found || self.fields.access(code.text(), place.class, place.number) {
            code.push_str(match (place.class, what) {
                (DeviceClass::T | DeviceClass::C, "bit") => ".done = ",
                (DeviceClass::T | DeviceClass::C, _) => ".value = ",
                _ => " = ",
            });
            match self.fields.is_numeric_bit(place.class, place.number) {
                true => self.grid_value(code, value),
                false => self.expr(code, value, Around::Exact),
            }
            code.push_str(";");
        }
    }

    fn put_word_bit(&mut self, code: &mut Code, place: &Place, bit: u8, value: ExprId) {
        if place.index.is_some() {
            self.helpers.get("word", place.class);
            self.helpers.put("word", place.class);
            self.helper_call(code, "put_word", place);
            code.comma();
            code.open("plc_with_bit(");
            self.helper_call(code, "word", place);
            code.close(")");
            code.argument(format_args!("{bit}u"));
            code.comma();
            self.expr(code, value, Around::Exact);
            code.close(")");
            code.close(");");
            return;
        }
        let mut target = String::new();
        if self.fields.access(&mut target, place.class, place.number) {
            code.open("plc_put_bit(&");
            code.push_str(&target);
            code.argument(format_args!("{bit}u"));
            self.last_argument(code, value);
        }
    }

    fn put_pair(&mut self, code: &mut Code, place: &Place, value: ExprId, float: bool) {
        let wide = is_counter32(place.class, place.number);
        if place.index.is_some() {
            self.put_indexed_pair(code, place, value, float);
            return;
        }
        let mut bits = Code::default();
        if float {
            bits.open("plc_float_bits(");
        }
        self.expr(&mut bits, value, Around::Exact);
        if float {
            bits.close(")");
        }
        if wide {
            if self.fields.access(code.text(), place.class, place.number) {
                code.push_str(".value = ");
                code.append(&bits);
                code.push_str(";");
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
        let (low_name, high_name) = (low_name + part, high_name + part);
        match (low, high) {
            (true, true) => {
                code.open("plc_split(&");
                code.push_str(&high_name);
                code.argument(format_args!("&{low_name}"));
                code.comma();
            }
            (true, false) => code.open(&format!("{low_name} = plc_low(")),
            (false, true) => code.open(&format!("{high_name} = plc_high(")),
            (false, false) => return,
        }
        code.append(&bits);
        code.close(");");
    }

    fn put_indexed_pair(&mut self, code: &mut Code, place: &Place, value: ExprId, float: bool) {
        self.helpers.put("long", place.class);
        self.helper_call(code, "put_long", place);
        if !float {
            return self.last_argument(code, value);
        }
        code.comma();
        code.open("plc_float_bits(");
        self.expr(code, value, Around::Exact);
        code.close(")");
        code.close(");");
    }

    fn put_nibbles(&mut self, code: &mut Code, place: &Place, count: u32, value: ExprId) {
        if place.index.is_some() {
            self.helpers.put_bits(place.class);
            self.helper_call(code, "put_bits", place);
            code.argument(format_args!("{count}u"));
            self.last_argument(code, value);
        } else if self
            .fields
            .array(place.class, place.number, count)
            .is_some()
        {
            code.open("plc_put_bits(&");
            self.fields.access(code.text(), place.class, place.number);
            code.argument(format_args!("{count}u"));
            self.last_argument(code, value);
        } else {
            self.put_scattered(code, place, count, value);
        }
    }

    /// Spreads a number over relays that are not an array.
    fn put_scattered(&mut self, code: &mut Code, place: &Place, count: u32, value: ExprId) {
        code.open("plc_scatter(");
        code.open("(bool *const[]){");
        for bit in 0..count {
            if bit > 0 {
                code.comma();
            }
            let mut name = String::new();
            if self
                .fields
                .access(&mut name, place.class, place.number + bit)
            {
                let _ = write!(code.text(), "&{name}");
            } else {
                code.push_str("NULL");
            }
        }
        code.close("}");
        code.argument(format_args!("{count}u"));
        self.last_argument(code, value);
    }

    /// The start of a call of the program's function for an index: `motor_put_word_D(plc, n`.
    fn helper_call(&mut self, code: &mut Code, what: &str, place: &Place) {
        let class = place.class.prefix();
        let _ = write!(code.text(), "{}_{what}_{class}", self.module.name);
        code.open("(plc");
        code.comma();
        self.number(code, place);
    }

    /// RST of a timer or counter. A counter that it `holds` does not count at the next execution of its coil; no index
    /// leads to such a one.
    pub(crate) fn reset(&mut self, code: &mut Code, place: &Place, holds: bool) {
        let mut name = String::new();
        let of_iteration = self.access_iteration(&mut name, place);
        if place.index.is_some() && !of_iteration {
            self.helpers.reset(place.class);
            self.helper_call(code, "reset", place);
            code.close(");");
            return;
        }
        let Some(field) = self.fields.find(place.class, place.number) else {
            return;
        };
        if !of_iteration {
            self.fields.access(&mut name, place.class, place.number);
        }
        let function = match holds {
            true => hold_function(field.kind),
            false => reset_function(field.kind),
        };
        let _ = write!(code.text(), "{function}(&{name});");
    }
}

/// Writes the call that runs a timer.
pub(crate) fn run_timer(
    code: &mut Code,
    kind: TimerKind,
    timer: &str,
    drive: &Code,
    preset: &Code,
) {
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
    // Writing to a String does not fail.
    let _ = match family {
        Some(family) => write!(code.text(), "plc_{family}_{unit}ms"),
        None => write!(code.text(), "plc_timer_run"),
    };
    code.open("(&");
    code.push_str(timer);
    for argument in [drive, preset] {
        code.comma();
        code.append(argument);
    }
    code.argument("&plc->sys");
    if family.is_none() {
        code.argument(format_args!("{}u", unit.max(1)));
        timer_options(code, kind);
    }
    code.close(");");
}

/// Writes the last argument of a timer's call.
fn timer_options(code: &mut Code, kind: TimerKind) {
    let options = [
        (kind.accumulating, "PLC_RETENTIVE"),
        (kind.free_running, "PLC_FREE_RUNNING"),
        (kind.latches_preset, "PLC_LATCHES_PRESET"),
        (kind.overruns, "PLC_OVERRUNS"),
        (kind.stepwise, "PLC_STEPWISE"),
        (kind.shared, "PLC_SHARED"),
    ];
    code.comma();
    let mut set = options.iter().filter(|option| option.0);
    code.push_str(set.next().map_or("0u", |option| option.1));
    for (_, option) in set {
        code.operator("|");
        code.push_str(option);
    }
}
