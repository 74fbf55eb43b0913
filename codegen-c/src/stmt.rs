//! Simple statements as C.

use crate::expr::Around;
use crate::page::Page;
use crate::text;
use crate::writer::{Memory, Writer, c_type, function_name};
use rungc_emit::comments;
use rungc_emit::temps::Home;
use rungc_ir::node::{ExprId, LabelId, Stmt, TempId};
use rungc_rt::EdgeKind;
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
    fn value(&mut self, code: &mut String, value: ExprId) {
        self.expr(code, value, Around::Exact);
        code.push(';');
    }

    fn edge(&mut self, code: &mut String, edge: (Memory, EdgeKind, ExprId), out: TempId) {
        if self.plan.temp(out).used == 0 {
            self.edge_memory(code, edge.0);
            code.push_str(" = ");
            return self.value(code, edge.2);
        }
        code.push_str(&self.assigned_temp(out));
        self.edge_call(code, edge);
        code.push(';');
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
        if !code.is_empty() {
            let beside = comments::written(stmt)
                .and_then(|(class, number)| self.fields.comment(class, number));
            page.commented(&code, beside);
        }
    }

    fn watch(&mut self, page: &mut Page, steps: u32, at: u32) {
        let (name, at) = (&self.module.name, at as u16);
        page.open(&format!("if ({name}_out_of_time(plc, {steps}u, {at}u)) {{"));
        page.line(self.leave());
        page.close();
    }

    fn goto(&self, label: LabelId) -> String {
        let root = self.root();
        let state = self.plan.state(root, label);
        state.map_or(String::new(), |state| {
            format!("return {};", self.state_name(root, state))
        })
    }

    /// The last line of a statement; those before it are written.
    fn code(&mut self, page: &mut Page, stmt: &Stmt) -> String {
        let name = &self.module.name;
        let mut code = String::with_capacity(text::WIDTH);
        match stmt {
            Stmt::Let(temp, value) => {
                if self.plan.temp(*temp).used > 0 {
                    code = self.assigned_temp(*temp);
                    self.value(&mut code, *value);
                }
            }
            Stmt::Edge {
                edge,
                index,
                kind,
                input,
                out,
            } => self.edge(&mut code, ((*edge, *index), *kind, *input), *out),
            Stmt::SetCell(cell, value) => {
                code = format!("plc->{} = ", self.module.cells[*cell].name);
                self.value(&mut code, *value);
            }
            Stmt::SetEntry(table, index, value) => {
                code = format!("plc->{}[", self.module.tables[*table].name);
                self.expr(&mut code, *index, Around::Exact);
                code.push_str("] = ");
                self.value(&mut code, *value);
            }
            Stmt::SetFlag(flag, on) => {
                code = format!("plc->{} = ", self.module.flags[*flag].name);
                self.value(&mut code, *on);
            }
            Stmt::CallSub(function) => {
                function_name(&mut code, self.module, *function as usize);
                code.push_str("(plc);");
            }
            Stmt::Return => code.push_str(self.leave()),
            Stmt::Watch { steps, at } => self.watch(page, *steps, *at),
            Stmt::Goto(label) => code = self.goto(*label),
            Stmt::Fetch {
                from,
                wide,
                value,
                there,
                step,
            } => {
                if self.plan.temp(*there).used > 0 {
                    code = self.assigned_temp(*there);
                }
                self.fetch(&mut code, from, (*wide, *step), *value);
            }
            Stmt::Send {
                to,
                wide,
                value,
                step,
            } => self.send(&mut code, to, (*wide, *step), *value),
            Stmt::Call(call) => self.runtime_call(&mut code, call),
            Stmt::Fault { code: fault, step } => {
                code = format!("{name}_fault(plc, {fault}, {});", *step as u16);
            }
            Stmt::Stop => {
                page.line("plc->error.stop = PLC_STOP_M8037;");
                code = format!("{name}_set_running(plc, false);");
            }
            Stmt::Clear { latched } => {
                let what = if *latched { "latched" } else { "general" };
                code = format!("{name}_clear_{what}(plc);");
            }
            Stmt::Write(..)
            | Stmt::Timer { .. }
            | Stmt::TimerAt { .. }
            | Stmt::TimerGoesOn { .. }
            | Stmt::Counter16 { .. }
            | Stmt::Counter16At { .. }
            | Stmt::Counter32 { .. }
            | Stmt::Count { .. }
            | Stmt::Reset(_) => self.device_stmt(&mut code, stmt),
            // Written as nodes.
            Stmt::Network(_)
            | Stmt::If { .. }
            | Stmt::For { .. }
            | Stmt::Repeat { .. }
            | Stmt::Parts(_) => {}
        }
        code
    }
}
