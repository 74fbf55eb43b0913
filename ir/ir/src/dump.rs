//! Text of a module, for readers and snapshots.
//!
//! One line a statement; temporaries are `t0`, edge memories `e0`, devices have their names, pairs and floats `D0:32`,
//! `D0:f`, an index is added in brackets: `D[10 + t0]`.

use crate::layout::Area;
use crate::node::{
    Access, AccessKind, Action, Arg, BinOp, Block, Body, Branch, Call, CellId, Count,
    Counter16Coil, Counter32Coil, Edge, EdgeId, Expr, ExprId, Fetch, FlagId, Function,
    FunctionKind, IndexedCoil, Module, Part, Place, Repeat, Send, SetEntry, Steps, Stmt, SysValue,
    TableId, TimerCoil,
};
use rungc_rt::{EdgeKind, TimerKind};
use std::fmt::Write as _;

/// The text of a module.
pub fn dump(module: &Module) -> String {
    let mut out = Out {
        module,
        text: String::new(),
        indent: 0,
    };
    out.line(&format!(
        "module {} for {}: {} steps, {} edges, {} states",
        module.name, module.model.name, module.steps, module.edges, module.states
    ));
    for area in &module.layout.areas {
        out.line(&format!("store {}", area_text(area)));
    }
    for grid in &module.layout.grids {
        let first = grid.class.number(grid.first);
        let mut line = format!("{first}[{}] in {} columns", grid.count, grid.columns);
        if grid.stored_columns < grid.columns {
            line.push_str(&format!(", {} stored", grid.stored_columns));
        }
        out.line(&line);
    }
    for &(register, value) in &module.initial_words {
        let number = register.number();
        out.line(&format!("D{number} begins as {value}"));
    }
    for function in &module.functions {
        out.function(function);
    }
    out.text
}

fn area_text(area: &Area) -> String {
    let mut text = area.class.number(area.first).to_string();
    if area.array {
        let _ = write!(text, "[{}]", area.count);
    }
    if area.latched {
        text.push_str(" latched");
    }
    text
}

struct Out<'m> {
    module: &'m Module,
    text: String,
    indent: usize,
}

impl Out<'_> {
    fn line(&mut self, line: &str) {
        for _ in 0..self.indent {
            self.text.push_str("    ");
        }
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn block(&mut self, head: &str, body: &Body) {
        self.line(&format!("{head} {{"));
        self.indent += 1;
        self.body(body);
        self.indent -= 1;
        self.line("}");
    }

    fn function(&mut self, function: &Function) {
        if function.body.is_empty() && !matches!(function.kind, FunctionKind::Subroutine(_)) {
            return;
        }
        let head = match function.kind {
            FunctionKind::Main => "main".to_string(),
            FunctionKind::Begin => "begin".to_string(),
            FunctionKind::End => "end".to_string(),
            FunctionKind::Subroutine(pointer) => format!("subroutine P{pointer}"),
            FunctionKind::Interrupt(pointer) => format!("interrupt I{pointer:03}"),
            FunctionKind::InputEdge { input, kind } => {
                format!("X{input:03o} {}", kind.verb())
            }
            FunctionKind::TakeInterrupts => "take interrupts".to_string(),
            FunctionKind::Signals => "signals".to_string(),
        };
        self.block(&head, &function.body);
    }

    fn body(&mut self, body: &Body) {
        for stmt in body {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        let line = match stmt {
            Stmt::Network(n) => self.network(*n),
            Stmt::Do(action) => self.action(action),
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => return self.branches(*cond, then, otherwise),
            Stmt::For { count, body } => {
                return self.block(&format!("for {}", self.expr(*count)), body);
            }
            Stmt::Repeat(repeat) => return self.repeat(repeat),
            Stmt::Steps(steps) => {
                let Steps {
                    first,
                    states,
                    memory: EdgeId(memory),
                    memories,
                    body,
                } = steps;
                let head = format!("steps S{first}[{states}] e{memory}[{memories}]");
                return self.block(&head, body);
            }
            Stmt::CallSub(n) => self.call_sub(*n),
            Stmt::Return => "return".into(),
            Stmt::Parts(parts) => return self.parts(parts),
            Stmt::Goto(label) => format!("goto L{}", label.0),
            Stmt::Watch { steps, at } => format!("watch {steps} steps at {at}"),
        };
        self.line(&line);
    }

    fn action(&self, action: &Action) -> String {
        match action {
            Action::Let(temp, value) => format!("t{} = {}", temp.0, self.expr(*value)),
            Action::Edge(edge) => self.edge(edge),
            Action::SetFlag(flag, value) => self.assignment(self.flag(*flag), *value),
            Action::SetCell(cell, value) => self.assignment(self.cell(*cell), *value),
            Action::SetEntry(SetEntry {
                table,
                index,
                value,
            }) => self.assignment(self.entry(*table, *index), *value),
            Action::Write(access, value) => self.assignment(self.access(access), *value),
            Action::Timer(coil) => self.timer(coil),
            Action::TimerAt(coil) => self.coil_at("timer", coil),
            Action::TimerGoesOn { number, kind } => {
                format!("timer T{number} {} continues", timer_text(kind))
            }
            Action::Counter16(coil) => self.counter16(coil),
            Action::Counter16At(coil) => self.coil_at("counter", coil),
            Action::Counter32(coil) => self.counter32(coil),
            Action::Count(count) => self.count(count),
            Action::Reset { place, holds } => {
                let what = if *holds { "hold at 0" } else { "reset" };
                format!("{what} {}", self.place(place))
            }
            Action::Block(block) => self.run(block),
            Action::Call(call) => self.call(call),
            Action::Fetch(fetch) => self.fetch(fetch),
            Action::Send(send) => self.send(send),
            Action::Fault { code, step } => format!("fault {code} at step {step}"),
            Action::RestartWatchdog => "restart the watchdog".into(),
            Action::Stop => "stop".into(),
            Action::Clear { latched: true } => "clear latched".into(),
            Action::Clear { latched: false } => "clear general".into(),
        }
    }

    fn branches(&mut self, cond: ExprId, then: &Body, otherwise: &Body) {
        self.block(&format!("if {}", self.expr(cond)), then);
        if !otherwise.is_empty() {
            self.block("else", otherwise);
        }
    }

    fn repeat(&mut self, repeat: &Repeat) {
        let (count, iteration) = (repeat.count, repeat.iteration.0);
        self.block(&format!("repeat {count} times: t{iteration}"), &repeat.body);
    }

    fn parts(&mut self, parts: &[Part]) {
        self.line("parts {");
        self.indent += 1;
        for part in parts {
            let label = part.label.map(|label| format!("L{}", label.0));
            self.block(label.as_deref().unwrap_or("first"), &part.body);
        }
        self.indent -= 1;
        self.line("}");
    }

    fn network(&self, n: u32) -> String {
        let network = &self.module.networks[n as usize];
        let mut line = format!("# step {}", network.step);
        for text in [&network.statement, &network.note].into_iter().flatten() {
            let _ = write!(line, " {text:?}");
        }
        line
    }

    fn assignment(&self, target: String, value: ExprId) -> String {
        format!("{target} := {}", self.expr(value))
    }

    fn edge(&self, edge: &Edge) -> String {
        let kind = match edge.kind {
            EdgeKind::Rising => "rising",
            EdgeKind::Falling => "falling",
        };
        let memory = match edge.index {
            Some(index) => format!("e[{} + {}]", edge.memory.0, self.expr(index)),
            None => format!("e{}", edge.memory.0),
        };
        let (out, input) = (edge.out.0, self.expr(edge.input));
        format!("t{out} = {kind} {memory} {input}")
    }

    fn timer(&self, coil: &TimerCoil) -> String {
        let (number, kind) = (coil.number, timer_text(&coil.kind));
        let (drive, preset) = (self.expr(coil.drive), self.expr(coil.preset));
        format!("timer T{number} {kind} drive {drive} preset {preset}")
    }

    fn coil_at(&self, what: &str, coil: &IndexedCoil) -> String {
        let place = self.place(&coil.place);
        let (drive, preset) = (self.expr(coil.drive), self.expr(coil.preset));
        format!("{what} {place} drive {drive} preset {preset}")
    }

    fn counter16(&self, coil: &Counter16Coil) -> String {
        let (drive, preset) = (self.expr(coil.drive), self.expr(coil.preset));
        format!("counter C{} drive {drive} preset {preset}", coil.number)
    }

    fn counter32(&self, coil: &Counter32Coil) -> String {
        let [drive, down, preset] = [coil.drive, coil.down, coil.preset].map(|e| self.expr(e));
        let number = coil.number;
        format!("counter C{number} drive {drive} down {down} preset {preset}")
    }

    fn count(&self, count: &Count) -> String {
        let (down, preset) = (self.expr(count.down), self.expr(count.preset));
        format!("count C{} down {down} preset {preset}", count.number)
    }

    fn call_sub(&self, n: u32) -> String {
        let function = self.module.functions.get(n as usize);
        match function.map(|function| &function.kind) {
            Some(FunctionKind::Subroutine(pointer)) => format!("call P{pointer}"),
            Some(FunctionKind::Interrupt(pointer)) => format!("call I{pointer:03}"),
            Some(FunctionKind::TakeInterrupts) => "take interrupts".into(),
            Some(FunctionKind::Signals) => "call signals".into(),
            Some(
                FunctionKind::Begin
                | FunctionKind::Main
                | FunctionKind::End
                | FunctionKind::InputEdge { .. },
            )
            | None => format!("call function {n}"),
        }
    }

    fn fetch(&self, fetch: &Fetch) -> String {
        let (from, wide) = (self.arg(&fetch.from), if fetch.wide { ":32" } else { "" });
        let (there, cell) = (fetch.there.0, self.cell(fetch.value));
        format!("t{there} = fetch {from}{wide} to {cell}")
    }

    fn send(&self, send: &Send) -> String {
        let (to, wide) = (self.arg(&send.to), if send.wide { ":32" } else { "" });
        format!("send {to}{wide} := {}", self.expr(send.value))
    }

    fn run(&self, block: &Block) -> String {
        let (to, count) = block.written();
        let count = match block.length() {
            Some(length) => self.expr(length),
            None => count.to_string(),
        };
        let to = self.place(&to);
        match block {
            Block::Copy { from, .. } => format!("{to}[{count}] := {}[{count}]", self.place(from)),
            Block::Fill { value, .. } => format!("{to}[{count}] := each {}", self.expr(*value)),
        }
    }

    fn cell(&self, cell: CellId) -> String {
        let cells = &self.module.cells;
        let name = cells.get(cell).map_or("?", |cell| &cell.name);
        format!("cell {name}")
    }

    fn entry(&self, table: TableId, index: ExprId) -> String {
        let tables = &self.module.tables;
        let name = tables.get(table).map_or("?", |table| &table.name);
        format!("table {name}[{}]", self.expr(index))
    }

    fn flag(&self, flag: FlagId) -> String {
        let flags = &self.module.flags;
        let name = flags.get(flag).map_or("?", |flag| &flag.name);
        format!("flag {name}")
    }

    fn call(&self, call: &Call) -> String {
        let Call {
            function,
            wide,
            args,
            drive,
            signal,
            period_ms,
            slot,
            step: _,
        } = call;
        let args: Vec<String> = args.iter().map(|arg| self.arg(arg)).collect();
        let mut line = format!("{}({})", function.name(), args.join(", "));
        if *wide {
            line.push_str(" wide");
        }
        if *slot != 0 {
            let _ = write!(line, " slot {slot}");
        }
        if let Some(drive) = drive {
            let _ = write!(line, " drive {}", self.expr(*drive));
        }
        if *signal {
            line.push_str(" signal");
        }
        if *period_ms != 0 {
            let _ = write!(line, " each {period_ms} ms");
        }
        line
    }

    fn arg(&self, arg: &Arg) -> String {
        let count = |extent: &Option<u32>| match extent {
            Some(1) => String::new(),
            Some(count) => format!("*{count}"),
            None => "*".into(),
        };
        match arg {
            Arg::Const {
                value, index: None, ..
            } => value.to_string(),
            Arg::Const {
                value,
                index: Some(index),
                ..
            } => format!("{value} + {}", self.expr(*index)),
            Arg::Float(value) => format!("{value:?}"),
            Arg::Device { place, extent } => format!("{}{}", self.place(place), count(extent)),
            Arg::Nibbles {
                place,
                digits,
                extent,
            } => format!("K{digits}{}{}", self.place(place), count(extent)),
            Arg::WordBit { place, bit, .. } => format!("{}.{bit:X}", self.place(place)),
            Arg::Text(n) => format!("{:?}", self.module.texts[*n as usize]),
            Arg::Buffer {
                module,
                address,
                index,
            } => match index {
                None => format!("U{module}\\G{address}"),
                Some(index) => format!("U{module}\\G[{address} + {}]", self.expr(*index)),
            },
        }
    }

    fn place(&self, place: &Place) -> String {
        match place.index {
            None => place.class.number(place.number).to_string(),
            Some(index) => {
                let number = if place.class.is_octal() {
                    format!("0o{:o}", place.number)
                } else {
                    place.number.to_string()
                };
                format!("{}[{number} + {}]", place.class.prefix(), self.expr(index))
            }
        }
    }

    fn access(&self, access: &Access) -> String {
        let place = self.place(&access.place);
        match access.kind {
            AccessKind::Bit | AccessKind::Word => place,
            AccessKind::WordBit(bit) => format!("{place}.{bit:X}"),
            AccessKind::Pair => format!("{place}:32"),
            AccessKind::Float => format!("{place}:f"),
            AccessKind::Nibbles { digits, wide } => {
                let wide = if wide { ":32" } else { "" };
                format!("K{digits}{place}{wide}")
            }
        }
    }

    fn expr(&self, id: ExprId) -> String {
        let two = |a: &ExprId, op: &str, b: &ExprId| {
            format!("({} {op} {})", self.expr(*a), self.expr(*b))
        };
        let of = |name: &str, a: &ExprId| format!("{name}({})", self.expr(*a));
        match self.module.expr(id) {
            Expr::Bit(true) => "on".into(),
            Expr::Bit(false) => "off".into(),
            Expr::I16(value) => value.to_string(),
            Expr::I32(value) => format!("{value}L"),
            Expr::F32(value) => format!("{value:?}f"),
            Expr::Temp(temp) => format!("t{}", temp.0),
            Expr::Read(access) => self.access(access),
            Expr::Cell(cell) => self.cell(*cell),
            Expr::Stride(iteration, by) => format!("{by} * t{}", iteration.0),
            Expr::Entry(table, index) => self.entry(*table, *index),
            Expr::Flag(flag) => self.flag(*flag),
            Expr::Sys(SysValue::Running) => "running".into(),
            Expr::Sys(SysValue::FirstScan) => "first_scan".into(),
            Expr::Sys(SysValue::NowMs) => "now_ms".into(),
            Expr::Sys(SysValue::MinuteMs) => "minute_ms".into(),
            Expr::Sys(SysValue::SinceScanMs) => "since_scan_ms".into(),
            Expr::Sys(SysValue::Scan100us) => "scan_100us".into(),
            Expr::Not(a) => format!("!{}", self.expr(*a)),
            Expr::And(a, b) => two(a, "&", b),
            Expr::Or(a, b) => two(a, "|", b),
            Expr::Cmp(op, a, b) => two(a, op.symbol(), b),
            Expr::Bin(op, a, b) => two(a, bin_text(*op), b),
            Expr::Un(op, a) => of(op.name(self.module.ty(*a)), a),
            Expr::Float(op, a, b) => {
                format!("{}({}, {})", op.name(), self.expr(*a), self.expr(*b))
            }
            Expr::Complement(a) => format!("~{}", self.expr(*a)),
            Expr::Neg(a) => format!("-{}", self.expr(*a)),
            Expr::Widen(a) => of("widen", a),
            Expr::Narrow(a) => of("narrow", a),
            Expr::HighWord(a) => of("high", a),
            Expr::BitToInt(a) => of("int", a),
            Expr::Within { value, low, high } => {
                format!("{} in {low}..={high}", self.expr(*value))
            }
            Expr::InRange {
                place,
                count,
                length,
            } => {
                let count = match length {
                    Some(length) => self.expr(*length),
                    None => count.to_string(),
                };
                format!("in_range({}, {count})", self.place(place))
            }
        }
    }
}

fn timer_text(kind: &TimerKind) -> String {
    let accumulating = if kind.accumulating {
        " accumulating"
    } else {
        ""
    };
    let free_running = if kind.free_running {
        " free-running"
    } else {
        ""
    };
    let shared = if kind.shared { " shared" } else { "" };
    format!("{}ms{accumulating}{free_running}{shared}", kind.unit_ms)
}

fn bin_text(op: BinOp) -> &'static str {
    match op {
        BinOp::Add => "+",
        BinOp::Sub => "-",
        BinOp::Mul => "*",
        BinOp::MulHigh => "*high",
        BinOp::Div => "/",
        BinOp::Rem => "%",
        BinOp::And => "and",
        BinOp::Or => "or",
        BinOp::Xor => "xor",
        BinOp::SatAdd => "+sat",
        BinOp::SatSub => "-sat",
        BinOp::Min => "min",
        BinOp::Max => "max",
        BinOp::RotateLeft => "rotl",
    }
}
