//! Statements and functions as C.

use crate::expr::Around;
use crate::helpers::Helpers;
use crate::text;
use rungc_emit::comments;
use rungc_emit::edges::{Asker, asker};
use rungc_emit::parts::{self, Limits};
use rungc_emit::plan::{Flow, Function, Node, Plan};
use rungc_emit::stations::Device;
use rungc_emit::storage::Storage;
use rungc_emit::temps::Home;
use rungc_emit::timers::Coils;
use rungc_ir::Module;
use rungc_ir::node::{EdgeId, Expr, ExprId, FunctionKind, Stmt, TempId, Ty};
use rungc_rt::EdgeKind;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::fmt::Write;

/// How much of an expression stands in one place.
const LIMITS: Limits = Limits {
    depth: 12,
    shared: 8,
    plain: 256,
};

/// The memory of an edge, and how far behind it that of a loop's present round is.
type Memory = (EdgeId, Option<ExprId>);

/// Writes the functions of one module.
pub struct Writer<'a, 'm> {
    pub(crate) module: &'m Module,
    pub(crate) plan: &'a Plan<'m>,
    pub(crate) fields: &'a Storage<'m>,
    /// Functions for indexed access that are needed.
    pub helpers: Helpers,
    /// Whether [`Stmt::Fault`] occurs where something of it is to be seen.
    pub faults: bool,
    /// Whether the program clears the general devices, or the latched ones.
    pub clears: [bool; 2],
    /// Names of parts of the current statement's expressions.
    pub(crate) named: FxHashMap<ExprId, String>,
    /// What timers have to remember.
    pub(crate) coils: Coils,
    /// The current function.
    function: usize,
    /// Loops around the current statement.
    pub(crate) loops: usize,
    /// Whether an operand beside is a number, so that `!` would seem a slip.
    pub(crate) numbers: bool,
    /// Variable that counts the rounds of the loop over rungs.
    pub(crate) round: String,
    /// How many rounds that has.
    pub(crate) rounds: u32,
    /// Devices that it reads before its first round.
    pub(crate) invariants: BTreeSet<Device>,
    /// Devices that a loop of this function reads so.
    pub(crate) invariants_named: BTreeSet<Device>,
    /// Parts that have been given a name in this function.
    names: u32,
}

impl<'a, 'm> Writer<'a, 'm> {
    /// A writer.
    pub fn new(module: &'m Module, plan: &'a Plan<'m>, fields: &'a Storage<'m>) -> Self {
        Writer {
            module,
            plan,
            fields,
            helpers: Helpers::default(),
            faults: false,
            clears: [false; 2],
            named: FxHashMap::default(),
            coils: Coils::of(module, plan, fields),
            function: 0,
            loops: 0,
            numbers: false,
            round: String::new(),
            rounds: 0,
            invariants: BTreeSet::new(),
            invariants_named: BTreeSet::new(),
            names: 0,
        }
    }

    /// Name of a C function.
    pub fn function_name(&self, out: &mut String, function: &Function) {
        function_name(out, self.module, function.root);
        out.push_str(&function.suffix);
    }

    /// The head of a C function, without storage class and body.
    pub fn signature(&self, function: &Function) -> String {
        let mut out = String::from(if function.flow == Flow::Void {
            "void "
        } else {
            "int "
        });
        self.function_name(&mut out, function);
        let _ = write!(out, "({}_plc *plc)", self.module.name);
        out
    }

    /// Writes a C function; `storage` is `static ` or nothing.
    pub fn function(&mut self, out: &mut String, index: usize, storage: &str) {
        let plan = self.plan;
        let function = &plan.functions[index];
        self.function = index;
        self.loops = 0;
        self.names = 0;
        self.invariants_named.clear();
        let _ = write!(out, "{storage}{}\n{{\n", self.signature(function));
        if function.is_idle() {
            out.push_str("    (void)plc;\n");
        }
        if function.calls_runtime {
            let _ = writeln!(out, "    rungc_map map = {}_map(plc);", self.module.name);
        }
        for (temp, known) in plan
            .temps
            .iter()
            .enumerate()
            .filter(|(_, t)| t.home() == Home::Variable(index) && t.used > 0)
        {
            let mut code = String::from(c_type(self.module.temps[temp]));
            code.push(' ');
            let _ = write!(code, "{known}");
            code.push_str(zero(self.module.temps[temp]));
            text::line(out, 4, &code, None);
        }
        self.nodes(out, &function.body, 4);
        let ends = function.ends_by_jump();
        match function.flow {
            Flow::Part { next: Some(next) } if !ends => {
                let code = format!("return {};", self.state_name(function.root, next));
                text::line(out, 4, &code, None);
            }
            Flow::Void => {}
            _ if ends => {}
            _ => out.push_str("    return PLC_GO_ON;\n"),
        }
        out.push_str("}\n\n");
    }

    /// Name of a state: `MOTOR_PROGRAM_P12`.
    pub fn state_name(&self, root: usize, state: u32) -> String {
        let mut name = String::new();
        function_name(&mut name, self.module, root);
        let _ = write!(name, "_{}", self.plan.state_names(root)[state as usize - 1]);
        name.to_ascii_uppercase()
    }

    pub(crate) fn nodes(&mut self, out: &mut String, nodes: &[Node<'m>], indent: usize) {
        let mut i = 0;
        while let Some(node) = nodes.get(i) {
            i += 1;
            if Plan::is_silent(self.module, node, nodes.get(i)) {
                continue;
            }
            // An edge within an expression would be a call whose result `&` joins, for which compilers warn.
            if let (
                Node::Stmt(Stmt::Edge {
                    edge,
                    index,
                    kind,
                    input,
                    ..
                }),
                Some(next),
            ) = (node, nodes.get(i))
                && let Some(Asker::Whole(asker)) =
                    asker(self.module, self.plan, self.fields, node, next)
            {
                self.name_parts(out, &[*input], indent);
                let mut call = String::new();
                self.edge_call(&mut call, ((*edge, *index), *kind, *input));
                self.named.clear();
                self.named.insert(asker, call);
                self.node_with_names(out, next, indent);
                i += 1;
                continue;
            }
            self.node(out, node, indent);
        }
    }

    fn edge_call(&mut self, out: &mut String, (memory, kind, input): (Memory, EdgeKind, ExprId)) {
        if kind == EdgeKind::Falling && *self.module.expr(input) == Expr::Bit(false) {
            out.push_str("plc_take(&");
            self.edge_memory(out, memory);
            out.push(')');
            return;
        }
        let function = match kind {
            EdgeKind::Rising => "plc_rising",
            EdgeKind::Falling => "plc_falling",
        };
        let _ = write!(out, "{function}(&");
        self.edge_memory(out, memory);
        out.push_str(", ");
        self.expr(out, input, Around::Exact);
        out.push(')');
    }

    /// Writes where the memory of an edge is: `plc->edge[3]`, `plc->edge[3 + 2 * i]`.
    fn edge_memory(&self, out: &mut String, (edge, index): Memory) {
        let first = edge.0;
        let _ = match (index.map(|index| self.module.expr(index)), first) {
            (Some(Expr::Stride(_, 1)), 0) => write!(out, "plc->edge[{}]", self.round),
            (Some(Expr::Stride(_, 1)), _) => write!(out, "plc->edge[{first} + {}]", self.round),
            (Some(Expr::Stride(_, by)), 0) => write!(out, "plc->edge[{by} * {}]", self.round),
            (Some(Expr::Stride(_, by)), _) => {
                write!(out, "plc->edge[{first} + {by} * {}]", self.round)
            }
            _ => write!(out, "plc->edge[{first}]"),
        };
    }

    fn node(&mut self, out: &mut String, node: &Node<'m>, indent: usize) {
        self.name_parts(out, &node.roots(), indent);
        self.node_with_names(out, node, indent);
    }

    /// Gives names to inner parts of expressions that nest deep, or that share parts so much that writing them out would explode.
    fn name_parts(&mut self, out: &mut String, roots: &[ExprId], indent: usize) {
        self.named.clear();
        for e in parts::named(self.module, &self.plan.sizes, roots, LIMITS) {
            self.names += 1;
            let name = format!("part{}", self.names);
            let mut code = format!("const {} {name} = ", c_type(self.module.ty(e)));
            self.expr(&mut code, e, Around::Exact);
            code.push(';');
            text::line(out, indent, &code, None);
            self.named.insert(e, name);
        }
    }

    fn node_with_names(&mut self, out: &mut String, node: &Node<'m>, indent: usize) {
        match node {
            Node::Stmt(Stmt::Network(network)) => self.network(out, *network, indent),
            Node::Stmt(stmt) => self.stmt(out, stmt, indent),
            Node::If {
                cond,
                then,
                otherwise,
            } => self.branch(out, *cond, (then, otherwise), indent),
            Node::For { count, body } => self.repeat(out, *count, body, indent),
            Node::Repeat(stations) => self.rounds(out, stations, indent),
            Node::Parts { parts, leaves } => self.parts(out, parts, *leaves, indent),
            Node::Stretch(function) => self.stretch(out, *function, indent),
        }
    }

    fn branch(
        &mut self,
        out: &mut String,
        cond: ExprId,
        bodies: (&[Node<'m>], &[Node<'m>]),
        indent: usize,
    ) {
        let (then, otherwise) = bodies;
        let mut code = String::from("if (");
        let inverted = then.is_empty() && !otherwise.is_empty();
        if inverted {
            code.push('!');
            self.expr(&mut code, cond, Around::Unary);
        } else {
            self.expr(&mut code, cond, Around::Loose);
        }
        code.push_str(") {");
        text::line(out, indent, &code, None);
        self.nodes(out, if inverted { otherwise } else { then }, indent + 4);
        if !inverted && !otherwise.is_empty() {
            text::line(out, indent, "} else {", None);
            self.nodes(out, otherwise, indent + 4);
        }
        text::line(out, indent, "}", None);
    }

    fn repeat(&mut self, out: &mut String, count: ExprId, body: &[Node<'m>], indent: usize) {
        let variable = self.loop_variable();
        let mut code = String::new();
        if let Expr::I16(times) = *self.module.expr(count) {
            let _ = write!(
                code,
                "for (int {variable} = 0; {variable} < {}; {variable}++) {{",
                times.max(1)
            );
        } else {
            let _ = write!(code, "for (int16_t {variable} = plc_times(");
            self.expr(&mut code, count, Around::Exact);
            let _ = write!(code, "); {variable} > 0; {variable}--) {{");
        }
        text::line(out, indent, &code, None);
        self.loops += 1;
        self.nodes(out, body, indent + 4);
        self.loops -= 1;
        text::line(out, indent, "}", None);
    }

    pub(crate) fn loop_variable(&self) -> String {
        match self.loops {
            n @ 0..6 => char::from(b'i' + n as u8).to_string(),
            n => format!("i{n}"),
        }
    }

    fn is_void(&self) -> bool {
        self.plan.functions[self.function].flow == Flow::Void
    }

    fn parts(&mut self, out: &mut String, parts: &[(u32, usize)], leaves: bool, indent: usize) {
        let root = self.plan.functions[self.function].root;
        let Some(&(first, _)) = parts.first() else {
            return;
        };
        let first = self.state_name(root, first);
        if let (&[(_, function)], false) = (parts, leaves) {
            let mut name = String::new();
            self.function_name(&mut name, &self.plan.functions[function]);
            let pad = " ".repeat(indent);
            let _ = writeln!(
                out,
                "{pad}/* {} */\n{pad}while ({name}(plc) == {first}) {{\n{pad}}}",
                comments::ONE_PART
            );
            return;
        }
        let pad = " ".repeat(indent);
        let _ = writeln!(out, "{pad}/* {} */", comments::PARTS);
        let _ = writeln!(
            out,
            "{pad}for (int next = {first}; next != PLC_GO_ON;) {{\n{pad}    switch (next) {{"
        );
        for &(state, function) in parts {
            let mut name = String::new();
            self.function_name(&mut name, &self.plan.functions[function]);
            let state = self.state_name(root, state);
            let _ = writeln!(
                out,
                "{pad}    case {state}:\n{pad}        next = {name}(plc);\n{pad}        break;"
            );
        }
        let outside = match (leaves, self.is_void()) {
            (true, true) => "return;",
            (true, false) => "return next;",
            (false, _) => "next = PLC_GO_ON;\n            break;",
        };
        let outside = outside
            .replace('\n', &format!("\n{pad}"))
            .replace("            break", "        break");
        let _ = writeln!(
            out,
            "{pad}    default:\n{pad}        {outside}\n{pad}    }}\n{pad}}}"
        );
    }

    fn stretch(&mut self, out: &mut String, function: usize, indent: usize) {
        let plan = self.plan;
        let mut name = String::new();
        self.function_name(&mut name, &plan.functions[function]);
        let pad = " ".repeat(indent);
        let _ = match (plan.functions[function].flow == Flow::Void, self.is_void()) {
            (true, _) => writeln!(out, "{pad}{name}(plc);"),
            (false, true) => writeln!(
                out,
                "{pad}if ({name}(plc) != PLC_GO_ON) {{\n{pad}    return;\n{pad}}}"
            ),
            (false, false) => writeln!(
                out,
                "{pad}{{\n{pad}    const int next = {name}(plc);\n{pad}    if (next != PLC_GO_ON) {{\n\
                 {pad}        return next;\n{pad}    }}\n{pad}}}"
            ),
        };
    }

    /// Writes a temporary's name as it is used.
    pub(crate) fn temp(&self, out: &mut String, temp: TempId) {
        let known = self.plan.temp(temp);
        let plc = if known.home() == Home::Field {
            "plc->"
        } else {
            ""
        };
        let _ = write!(out, "{plc}{known}");
    }

    /// The left side of an assignment to a temporary.
    fn assigned_temp(&self, temp: TempId) -> String {
        let mut code = String::new();
        if self.plan.temp(temp).home() == Home::Constant {
            let _ = write!(
                code,
                "const {} ",
                c_type(self.module.temps[temp.0 as usize])
            );
        }
        self.temp(&mut code, temp);
        code.push_str(" = ");
        code
    }

    fn stmt(&mut self, out: &mut String, stmt: &Stmt, indent: usize) {
        let mut code = String::with_capacity(text::WIDTH);
        match stmt {
            Stmt::Let(temp, value) => {
                if self.plan.temp(*temp).used == 0 {
                    return;
                }
                code = self.assigned_temp(*temp);
                self.expr(&mut code, *value, Around::Exact);
                code.push(';');
            }
            Stmt::Edge {
                edge,
                index,
                kind,
                input,
                out: temp,
            } => {
                let memory = (*edge, *index);
                if self.plan.temp(*temp).used == 0 {
                    self.edge_memory(&mut code, memory);
                    code.push_str(" = ");
                    self.expr(&mut code, *input, Around::Exact);
                } else {
                    code = self.assigned_temp(*temp);
                    self.edge_call(&mut code, (memory, *kind, *input));
                }
                code.push(';');
            }
            Stmt::SetCell(cell, value) => {
                code = format!("plc->{} = ", self.module.cells[cell.0 as usize].name);
                self.expr(&mut code, *value, Around::Exact);
                code.push(';');
            }
            Stmt::SetEntry(table, index, value) => {
                code = format!("plc->{}[", self.module.tables[table.0 as usize].name);
                self.expr(&mut code, *index, Around::Exact);
                code.push_str("] = ");
                self.expr(&mut code, *value, Around::Exact);
                code.push(';');
            }
            Stmt::SetFlag(flag, on) => {
                let flag = &self.module.flags[flag.0 as usize].name;
                code = format!("plc->{flag} = ");
                self.expr(&mut code, *on, Around::Exact);
                code.push(';');
            }
            Stmt::CallSub(function) => {
                function_name(&mut code, self.module, *function as usize);
                code.push_str("(plc);");
            }
            Stmt::Return => code.push_str(if self.is_void() {
                "return;"
            } else {
                "return PLC_LEAVE;"
            }),
            Stmt::Watch { steps, at } => {
                let leave = if self.is_void() {
                    "return;"
                } else {
                    "return PLC_LEAVE;"
                };
                let condition = format!(
                    "if ({}_out_of_time(plc, {steps}u, {}u)) {{",
                    self.module.name, *at as u16
                );
                text::line(out, indent, &condition, None);
                text::line(out, indent + 4, leave, None);
                code.push('}');
            }
            Stmt::Goto(label) => {
                let root = self.plan.functions[self.function].root;
                if let Some(state) = self.plan.state(root, *label) {
                    code = format!("return {};", self.state_name(root, state));
                }
            }
            Stmt::Fetch { there, .. } => {
                if self.plan.temp(*there).used > 0 {
                    code = self.assigned_temp(*there);
                }
                self.transfer(&mut code, stmt);
            }
            Stmt::Send { .. } => self.transfer(&mut code, stmt),
            Stmt::Call { .. } => self.runtime_call(&mut code, stmt),
            Stmt::Fault { code: fault, step } => {
                self.faults = true;
                code = format!(
                    "{}_fault(plc, {fault}, {});",
                    self.module.name, *step as u16
                );
            }
            Stmt::Stop => {
                text::line(out, indent, "plc->error.stop = PLC_STOP_M8037;", None);
                code = format!("{}_set_running(plc, false);", self.module.name);
            }
            Stmt::Clear { latched } => {
                self.clears[usize::from(*latched)] = true;
                let what = if *latched { "latched" } else { "general" };
                code = format!("{}_clear_{what}(plc);", self.module.name);
            }
            _ => self.device_stmt(&mut code, stmt),
        }
        if !code.is_empty() {
            let beside = comments::written(stmt)
                .and_then(|(class, number)| self.fields.comment(class, number));
            text::line(out, indent, &code, beside);
        }
    }

    fn network(&mut self, out: &mut String, network: u32, indent: usize) {
        let Some(network) = self.module.networks.get(network as usize) else {
            return;
        };
        if !out.ends_with("{\n") {
            out.push('\n');
        }
        let text = comments::heading(network, text::comment);
        text::block(out, indent, &text);
    }
}

/// Name of a function of the module: `motor_program`, `motor_P5`.
pub fn function_name(out: &mut String, module: &Module, function: usize) {
    let name = &module.name;
    let _ = match module.functions.get(function).map(|f| &f.kind) {
        Some(FunctionKind::Begin) => write!(out, "{name}_begin"),
        Some(FunctionKind::End) => write!(out, "{name}_end"),
        Some(FunctionKind::Subroutine(p)) => write!(out, "{name}_P{p}"),
        Some(FunctionKind::Interrupt(i)) => write!(out, "{name}_I{i:03}"),
        Some(FunctionKind::InputEdge { input, kind }) => {
            write!(out, "{name}_X{input:03o}_{}", kind.verb())
        }
        Some(FunctionKind::TakeInterrupts) => write!(out, "{name}_interrupts"),
        Some(FunctionKind::Signals) => write!(out, "{name}_signals"),
        Some(FunctionKind::Main) | None => write!(out, "{name}_program"),
    };
}

/// C type of a temporary.
pub fn c_type(ty: Ty) -> &'static str {
    match ty {
        Ty::Bit => "bool",
        Ty::I16 => "int16_t",
        Ty::I32 => "int32_t",
        Ty::F32 => "float",
    }
}

fn zero(ty: Ty) -> &'static str {
    match ty {
        Ty::Bit => " = false;",
        Ty::I16 | Ty::I32 => " = 0;",
        Ty::F32 => " = 0.0f;",
    }
}
