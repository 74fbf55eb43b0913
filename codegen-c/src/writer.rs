//! Statements and functions as C.

use crate::code::Code;
use crate::expr::Around;
use crate::helpers::Helpers;
use crate::page::Page;
use crate::text;
use rungc_emit::areas::{self, Area};
use rungc_emit::comments;
use rungc_emit::edges::{Asker, user_of_edge};
use rungc_emit::parts::{self, Limits};
use rungc_emit::plan::{Flow, Function, Node, Plan};
use rungc_emit::stations::Device;
use rungc_emit::storage::Storage;
use rungc_emit::temps::Home;
use rungc_emit::timers::Coils;
use rungc_ir::Module;
use rungc_ir::node::{Action, Edge, Expr, ExprId, FunctionKind, Stmt, TempId, Ty};
use rungc_rt::EdgeKind;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Limits of an expression written inline.
pub(crate) const LIMITS: Limits = Limits {
    depth: 12,
    shared: 8,
    plain: 256,
};

/// Replacement of an expression in the statement being written.
pub(crate) struct Named {
    /// Its code.
    pub code: Code,
    /// True if the code calls a function.
    pub calls: bool,
}

/// Writes the functions of one module.
pub struct Writer<'a, 'm> {
    pub(crate) module: &'m Module,
    pub(crate) plan: &'a Plan<'m>,
    pub(crate) fields: &'a Storage<'m>,
    /// Areas by which the runtime finds devices; empty if it is not called.
    pub(crate) areas: Vec<Area<'a>>,
    /// Functions for indexed access that are needed.
    pub helpers: Helpers,
    /// Names of parts of the current statement's expressions.
    pub(crate) named: FxHashMap<ExprId, Named>,
    /// Number of function calls written so far: shows whether an operand makes any.
    pub(crate) calls: u64,
    /// Memories of the timers.
    pub(crate) coils: Coils,
    /// True if a condition that joins contacts is compared with 0: `&` makes an `int` of them.
    pub(crate) boolean_conditions: bool,
    /// The current function.
    function: usize,
    /// Loops around the current statement.
    pub(crate) loops: usize,
    /// The ladder and the state of the block around it, where blocks are cases.
    pub(crate) block: Option<(usize, u32)>,
    /// True if an adjacent operand is a number, so that `!` would look like a mistake.
    pub(crate) numbers: bool,
    /// Variable that counts the iterations of the loop over rungs.
    pub(crate) iteration: String,
    /// Number of its iterations.
    pub(crate) iterations: u32,
    /// Devices that it reads before its first iteration.
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
            areas: match plan.functions.iter().any(|function| function.calls_runtime) {
                true => areas::areas(fields),
                false => Vec::new(),
            },
            helpers: Helpers::default(),
            named: FxHashMap::default(),
            calls: 0,
            coils: Coils::of(module, plan, fields),
            boolean_conditions: false,
            function: 0,
            loops: 0,
            block: None,
            numbers: false,
            iteration: String::new(),
            iterations: 0,
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
        self.enter(index);
        let _ = write!(out, "{storage}{}\n{{\n", self.signature(function));
        let mut page = Page::new(std::mem::take(out));
        if function.is_idle() {
            page.line("(void)plc;");
        }
        if function.calls_runtime {
            page.line(&format!("rungc_map map = {}_map(plc);", self.module.name));
        }
        let temps = plan.temps.iter().zip(&self.module.temps);
        for (temp, &ty) in temps {
            if temp.home() == Home::Variable(index) && temp.used > 0 {
                page.line(&format!("{} {temp}{}", c_type(ty), zero(ty)));
            }
        }
        self.nodes(&mut page, &function.body);
        match function.flow {
            Flow::Void => {}
            _ if function.ends_by_jump() => {}
            Flow::Part { next: Some(next) } => {
                page.line(&format!("return {};", self.state_name(function.root, next)));
            }
            Flow::Part { next: None } | Flow::Outlined => page.line("return PLC_GO_ON;"),
        }
        *out = page.finish();
        out.push_str("}\n\n");
    }

    /// Starts writing this function of the plan.
    pub(crate) fn enter(&mut self, index: usize) {
        self.function = index;
        self.loops = 0;
        self.names = 0;
        self.invariants_named.clear();
    }

    /// Name of a state: `MOTOR_PROGRAM_P12`.
    pub fn state_name(&self, root: usize, state: u32) -> String {
        let mut name = String::new();
        function_name(&mut name, self.module, root);
        let _ = write!(name, "_{}", self.plan.state_names(root)[state as usize - 1]);
        name.to_ascii_uppercase()
    }

    pub(crate) fn nodes(&mut self, page: &mut Page, nodes: &[Node<'m>]) {
        let mut i = 0;
        while let Some(node) = nodes.get(i) {
            if let Some((change, count)) = self.plan.ladders.next_move(self.module, &nodes[i..]) {
                self.step_move(page, change);
                i += count;
                continue;
            }
            i += 1;
            if Plan::is_silent(self.module, node, nodes.get(i)) {
                continue;
            }
            // An edge within an expression would be a call whose result `&` joins, for which compilers warn.
            if let (Node::Stmt(Stmt::Do(Action::Edge(edge))), Some(next)) = (node, nodes.get(i))
                && let Some(Asker::Whole(user_of_edge)) =
                    user_of_edge(self.module, self.plan, self.fields, edge, next)
            {
                self.name_parts(page, &[edge.input]);
                let mut code = Code::default();
                self.edge_call(&mut code, edge);
                self.named.clear();
                self.named.insert(user_of_edge, Named { code, calls: true });
                self.node_with_names(page, next);
                i += 1;
                continue;
            }
            self.node(page, node);
        }
    }

    pub(crate) fn edge_call(&mut self, out: &mut Code, edge: &Edge) {
        if edge.kind == EdgeKind::Falling && *self.module.expr(edge.input) == Expr::Bit(false) {
            out.open("plc_take(&");
            self.edge_memory(out.text(), edge);
            out.close(")");
            return;
        }
        let function = match edge.kind {
            EdgeKind::Rising => "plc_rising(&",
            EdgeKind::Falling => "plc_falling(&",
        };
        out.open(function);
        self.edge_memory(out.text(), edge);
        out.comma();
        self.expr(out, edge.input, Around::Exact);
        out.close(")");
    }

    /// Writes where the memory of an edge is: `plc->edge[3]`, `plc->edge[3 + 2 * i]`.
    pub(crate) fn edge_memory(&self, out: &mut String, edge: &Edge) {
        let first = self.plan.ladders.edge(edge.memory);
        let _ = match (edge.index.map(|index| self.module.expr(index)), first) {
            (Some(Expr::Stride(_, 1)), 0) => write!(out, "plc->edge[{}]", self.iteration),
            (Some(Expr::Stride(_, 1)), _) => write!(out, "plc->edge[{first} + {}]", self.iteration),
            (Some(Expr::Stride(_, by)), 0) => write!(out, "plc->edge[{by} * {}]", self.iteration),
            (Some(Expr::Stride(_, by)), _) => {
                write!(out, "plc->edge[{first} + {by} * {}]", self.iteration)
            }
            _ => write!(out, "plc->edge[{first}]"),
        };
    }

    fn node(&mut self, page: &mut Page, node: &Node<'m>) {
        self.name_parts(page, &node.roots());
        self.node_with_names(page, node);
    }

    /// Gives names to inner parts of expressions that nest deep, or whose shared parts would make the text explode.
    fn name_parts(&mut self, page: &mut Page, roots: &[ExprId]) {
        self.named.clear();
        for e in parts::named(self.module, &self.plan.sizes, roots, LIMITS) {
            self.names += 1;
            let name = format!("part{}", self.names);
            let mut code = Code::new();
            let _ = write!(code.text(), "const {} {name} = ", c_type(self.module.ty(e)));
            self.expr(&mut code, e, Around::Exact);
            code.push_str(";");
            page.commented(&code, None);
            self.named.insert(
                e,
                Named {
                    code: Code::from(&*name),
                    calls: false,
                },
            );
        }
    }

    fn node_with_names(&mut self, page: &mut Page, node: &Node<'m>) {
        match node {
            Node::Stmt(Stmt::Network(network)) => self.network(page, *network),
            Node::Stmt(stmt) => self.stmt(page, stmt),
            Node::If {
                cond,
                then,
                otherwise,
            } => self.branch(page, *cond, then, otherwise),
            Node::For { count, body } => self.repeat(page, *count, body),
            Node::Repeat(stations) => self.station_loop(page, stations),
            Node::Steps { of, body } => self.steps(page, of, body),
            Node::Parts { parts, leaves } => self.parts(page, parts, *leaves),
            Node::Outlined(function) => self.outline(page, *function),
        }
    }

    fn branch(&mut self, page: &mut Page, cond: ExprId, then: &[Node<'m>], otherwise: &[Node<'m>]) {
        let mut code = Code::new();
        code.open("if (");
        if then.is_empty() {
            code.push_str("!");
            self.expr(&mut code, cond, Around::Unary);
        } else if self.boolean_conditions && self.is_compound(cond) {
            self.expr(&mut code, cond, Around::Operand("!="));
            code.push_str(" != 0");
        } else {
            self.expr(&mut code, cond, Around::Loose);
        }
        code.close(") {");
        page.open_code(&code);
        self.nodes(page, then);
        if !then.is_empty() && !otherwise.is_empty() {
            page.reopen("} else {");
        }
        self.nodes(page, otherwise);
        page.close();
    }

    fn repeat(&mut self, page: &mut Page, count: ExprId, body: &[Node<'m>]) {
        let i = self.loop_variable();
        let mut code = Code::new();
        if let Expr::I16(times) = *self.module.expr(count) {
            let times = times.max(1);
            let _ = write!(code.text(), "for (int {i} = 0; {i} < {times}; {i}++) {{");
        } else {
            code.open("for (");
            code.open(&format!("int16_t {i} = plc_times("));
            self.expr(&mut code, count, Around::Exact);
            code.close(")");
            code.close(&format!("; {i} > 0; {i}--) {{"));
        }
        page.open_code(&code);
        self.loops += 1;
        self.nodes(page, body);
        self.loops -= 1;
        page.close();
    }

    pub(crate) fn loop_variable(&self) -> String {
        match self.loops {
            n @ 0..6 => char::from(b'i' + n as u8).to_string(),
            n => format!("i{n}"),
        }
    }

    pub(crate) fn is_void(&self) -> bool {
        self.plan.functions[self.function].flow == Flow::Void
    }

    /// Module function to which the one being written belongs.
    pub(crate) fn root(&self) -> usize {
        self.plan.functions[self.function].root
    }

    /// A call of a function of the plan.
    fn planned_call(&self, function: usize) -> String {
        let mut code = String::new();
        self.function_name(&mut code, &self.plan.functions[function]);
        code.push_str("(plc)");
        code
    }

    fn parts(&mut self, page: &mut Page, parts: &[(u32, usize)], leaves: bool) {
        let root = self.root();
        let Some(&(first, _)) = parts.first() else {
            return;
        };
        let first = self.state_name(root, first);
        if let (&[(_, function)], false) = (parts, leaves) {
            let call = self.planned_call(function);
            page.comment(comments::ONE_PART);
            page.open(&format!("while ({call} == {first}) {{"));
            page.close();
            return;
        }
        page.comment(comments::PARTS);
        page.open(&format!("for (int next = {first}; next != PLC_GO_ON;) {{"));
        page.open("switch (next) {");
        page.back();
        for &(state, function) in parts {
            let (state, call) = (self.state_name(root, state), self.planned_call(function));
            page.line(&format!("case {state}:"));
            page.inner(&format!("next = {call};"));
            page.inner("break;");
        }
        page.line("default:");
        match (leaves, self.is_void()) {
            (true, true) => page.inner("return;"),
            (true, false) => page.inner("return next;"),
            (false, _) => {
                page.inner("next = PLC_GO_ON;");
                page.inner("break;");
            }
        }
        page.line("}");
        page.close();
    }

    fn outline(&mut self, page: &mut Page, function: usize) {
        let call = self.planned_call(function);
        match (
            self.plan.functions[function].flow == Flow::Void,
            self.is_void(),
        ) {
            (true, _) => page.line(&format!("{call};")),
            (false, true) => {
                page.open(&format!("if ({call} != PLC_GO_ON) {{"));
                page.line("return;");
                page.close();
            }
            (false, false) => {
                page.open("{");
                page.line(&format!("const int next = {call};"));
                page.open("if (next != PLC_GO_ON) {");
                page.line("return next;");
                page.close();
                page.close();
            }
        }
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

    pub(crate) fn network(&mut self, page: &mut Page, network: u32) {
        if let Some(network) = self.module.networks.get(network as usize) {
            page.set_off();
            page.comment(&comments::heading(network, text::comment));
        }
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
pub(crate) fn c_type(ty: Ty) -> &'static str {
    match ty {
        Ty::Bit => "bool",
        Ty::I16 => "int16_t",
        Ty::I32 => "int32_t",
        Ty::F32 => "float",
    }
}

pub(crate) fn zero(ty: Ty) -> &'static str {
    match ty {
        Ty::Bit => " = false;",
        Ty::I16 | Ty::I32 => " = 0;",
        Ty::F32 => " = 0.0f;",
    }
}
