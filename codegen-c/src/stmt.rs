//! Simple statements as C.

use crate::code::Code;
use crate::expr::Around;
use crate::page::Page;
use crate::unit::watchdog_begins;
use crate::writer::{Writer, c_type, function_name};
use rungc_emit::comments;
use rungc_emit::temps::Home;
use rungc_ir::node::{Action, Edge, ExprId, LabelId, SetEntry, Stmt, TableId, TempId};
use std::fmt::Write;

impl Writer<'_, '_> {
    /// The left side of an assignment to a temporary.
    fn assigned_temp(&self, temp: TempId) -> String {
        let mut code = String::new();
        if self.plan.temp(temp).home() == Home::Constant {
            let _ = write!(code, "const {} ", c_type(self.module.temps[temp]));
        }
        self.temp(&mut code, temp);
        code.push_str(" = ");
        code
    }

    /// Writes the right side of an assignment.
    fn value(&mut self, code: &mut Code, value: ExprId) {
        self.expr(code, value, Around::Exact);
        code.push_str(";");
    }

    fn let_temp(&mut self, code: &mut Code, temp: TempId, value: ExprId) {
        if self.plan.temp(temp).used > 0 {
            code.push_str(&self.assigned_temp(temp));
            self.value(code, value);
        }
    }

    /// Writes an assignment to a private field.
    fn set(&mut self, code: &mut Code, name: &str, value: ExprId) {
        let _ = write!(code.text(), "plc->{name} = ");
        self.value(code, value);
    }

    fn set_entry(&mut self, code: &mut Code, table: TableId, index: ExprId, value: ExprId) {
        let _ = write!(code.text(), "plc->{}[", self.module.tables[table].name);
        self.expr(code, index, Around::Exact);
        code.push_str("] = ");
        self.value(code, value);
    }

    fn edge(&mut self, code: &mut Code, edge: &Edge) {
        if self.plan.temp(edge.out).used == 0 {
            self.edge_memory(code.text(), edge);
            code.push_str(" = ");
            return self.value(code, edge.input);
        }
        code.push_str(&self.assigned_temp(edge.out));
        self.edge_call(code, edge);
        code.push_str(";");
    }

    /// The statement that leaves the function of the module.
    fn leave(&self) -> &'static str {
        match self.is_void() {
            true => "return;",
            false => "return PLC_LEAVE;",
        }
    }

    /// Writes a statement, and beside it the comment on the device that it writes.
    pub(crate) fn stmt(&mut self, page: &mut Page, stmt: &Stmt) {
        let code = self.code(page, stmt);
        if !code.as_str().is_empty() {
            let beside = comments::written(stmt)
                .and_then(|(class, number)| comments::beside(self.fields, class, number));
            page.commented(&code, beside.as_deref());
        }
    }

    fn watch(&mut self, page: &mut Page, steps: u32, at: u32) {
        let (name, at) = (&self.module.name, at as u16);
        let mut code = Code::new();
        code.open("if (");
        code.open(&format!("{name}_out_of_time(plc"));
        code.argument(format_args!("{steps}u"));
        code.argument(format_args!("{at}u"));
        code.close(")");
        code.close(") {");
        page.open_code(&code);
        page.line(self.leave());
        page.close();
    }

    fn goto(&self, code: &mut Code, label: LabelId) {
        let root = self.root();
        if let Some(state) = self.plan.state(root, label) {
            let _ = write!(code.text(), "return {};", self.state_name(root, state));
        }
    }

    /// The last line of a statement; those before it are written.
    fn code(&mut self, page: &mut Page, stmt: &Stmt) -> Code {
        let mut code = Code::new();
        match stmt {
            Stmt::Do(action) => self.action(page, &mut code, action),
            Stmt::CallSub(function) => {
                function_name(code.text(), self.module, *function as usize);
                code.push_str("(plc);");
            }
            Stmt::Return => code.push_str(self.leave()),
            Stmt::Goto(label) => self.goto(&mut code, *label),
            Stmt::Watch { steps, at } => self.watch(page, *steps, *at),
            // Written as nodes.
            Stmt::Network(_)
            | Stmt::If(_)
            | Stmt::For { .. }
            | Stmt::Repeat(_)
            | Stmt::Steps(_)
            | Stmt::Parts(_) => {}
        }
        code
    }

    /// The last line of an action; those before it are written.
    fn action(&mut self, page: &mut Page, code: &mut Code, action: &Action) {
        let module = self.module;
        match action {
            Action::Let(temp, value) => self.let_temp(code, *temp, *value),
            Action::Edge(edge) => self.edge(code, edge),
            Action::SetFlag(flag, on) => self.set(code, &module.flags[*flag].name, *on),
            Action::SetCell(cell, value) => self.set(code, &module.cells[*cell].name, *value),
            Action::SetEntry(SetEntry {
                table,
                index,
                value,
            }) => {
                self.set_entry(code, *table, *index, *value);
            }
            Action::Write(access, value) => self.write(code, access, *value),
            Action::Timer(coil) => self.timer(code, coil),
            Action::TimerAt(coil) | Action::Counter16At(coil) => self.indexed_coil(code, coil),
            Action::TimerGoesOn { number, kind } => self.timer_goes_on(code, *number, *kind),
            Action::Counter16(coil) => {
                let arguments = [coil.drive, coil.preset];
                self.counter(code, "plc_count16", coil.number, &arguments);
            }
            Action::Counter32(coil) => {
                let arguments = [coil.drive, coil.down, coil.preset];
                self.counter(code, "plc_count32", coil.number, &arguments);
            }
            Action::Count(count) => {
                let arguments = [count.down, count.preset];
                self.counter(code, "plc_count32_once", count.number, &arguments);
            }
            Action::Reset { place, holds } => self.reset(code, place, *holds),
            Action::Block(block) => self.block(code, *block),
            Action::Call(call) => self.runtime_call(code, call),
            Action::Fetch(fetch) => {
                if self.plan.temp(fetch.there).used > 0 {
                    code.push_str(&self.assigned_temp(fetch.there));
                }
                self.fetch(code, fetch);
            }
            Action::Send(send) => self.send(code, send),
            Action::Fault { code: fault, step } => {
                let _ = write!(code.text(), "{}_fault", module.name);
                code.open("(plc");
                code.argument(fault);
                code.argument(*step as u16);
                code.close(");");
            }
            Action::RestartWatchdog => {
                let begins = watchdog_begins(module, self.fields);
                code.push_str(&begins.unwrap_or_default());
            }
            Action::Stop => {
                page.line("plc->error.stop = PLC_STOP_M8037;");
                let _ = write!(code.text(), "{}_set_running", module.name);
                code.open("(plc");
                code.argument("false");
                code.close(");");
            }
            Action::Clear { latched } => {
                let what = if *latched { "latched" } else { "general" };
                let _ = write!(code.text(), "{}_clear_{what}(plc);", module.name);
            }
        }
    }
}
