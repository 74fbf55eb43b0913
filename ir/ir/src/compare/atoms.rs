//! The statements of a module as atoms: texts, and what each reads and writes.

use crate::node::{
    Action, Arg, Body, Branch, Call, CellId, Edge, EdgeId, Expr, ExprId, Fetch, FlagId,
    FunctionKind, Module, Send, SetEntry, Stmt, TableId, TempId,
};
use crate::reach::{Footprint, beyond_operands, of_action, of_expr};
use crate::walk::{action_exprs_mut, bodies, operands, operands_mut};
use rungc_rt::{Needs, Register, Relay};
use rungc_syntax::DeviceClass;
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// A run of devices: class, first and last number.
pub(super) type Run = (DeviceClass, u32, u32);

/// No model has special devices from 10000 on.
const LAST_SPECIAL: u32 = 9999;

/// Special devices that an instruction of the runtime may read or write: all but those that the scan alone maintains,
/// M8000 to M8003 and M8011 to M8014.
const SPECIAL: [Run; 3] = [
    (DeviceClass::M, 8004, 8010),
    (DeviceClass::M, 8015, LAST_SPECIAL),
    (DeviceClass::D, 8000, LAST_SPECIAL),
];

/// Devices that an operation error writes. The first one of a scan is kept, so an error also depends on them.
pub(super) const ERRORS: [Run; 5] = [
    (DeviceClass::M, 8004, 8004),
    (DeviceClass::M, 8067, 8069),
    (DeviceClass::D, 8004, 8004),
    (DeviceClass::D, 8067, 8069),
    // The error log.
    (DeviceClass::D, 8490, 8509),
];

/// Texts by number, the same for all modules that are compared.
#[derive(Default)]
pub(super) struct Names(FxHashMap<String, u32>);

impl Names {
    fn of(&mut self, text: String) -> u32 {
        let next = self.0.len() as u32;
        *self.0.entry(text).or_insert(next)
    }

    /// Name shared by the instructions that use modules, pulse outputs and serial ports.
    pub(super) fn hardware(&mut self) -> u32 {
        self.of("hardware".to_string())
    }
}

/// Devices and names that an atom reads or writes.
#[derive(Clone, Default)]
pub(super) struct Uses {
    pub runs: Vec<Run>,
    /// Temporaries, private memory, conditions, calls.
    pub names: Vec<u32>,
    /// Anything at all.
    pub all: bool,
}

/// A statement, or what a branch or loop asks.
pub(super) struct Atom {
    /// The number of its text.
    pub text: u32,
    pub reads: Uses,
    pub writes: Uses,
    /// The function that it calls, by its position.
    pub calls: Option<usize>,
    /// Its step, if it is assumed to use all special devices.
    pub vague: Option<u32>,
    /// True if it controls what is executed next to it, or uses anything at all, so that nothing moves across it.
    pub fixed: bool,
}

/// The atoms of a module.
pub(super) struct Sequence {
    pub atoms: Vec<Atom>,
    /// Range of each function's atoms.
    pub functions: Vec<(FunctionKind, Range<usize>)>,
}

impl Sequence {
    /// Of two modules; `steps` is whether the steps of errors are a part of what they do.
    ///
    /// Networks that both have name their private memory by themselves, so that it keeps them wherever they move.
    pub(super) fn of_both(modules: [&Module; 2], names: &mut Names, steps: bool) -> [Self; 2] {
        let [old, new] = modules.map(|module| {
            let mut reader = Reader::of(module, names, steps);
            let mut found = FxHashSet::default();
            for function in &module.functions {
                reader.networks(&function.body, &mut found);
            }
            found
        });
        let shared: FxHashSet<u32> = old.intersection(&new).copied().collect();
        modules.map(|module| {
            let mut reader = Reader::of(module, names, steps);
            reader.shared = Some(&shared);
            reader.sequence()
        })
    }
}

struct Reader<'a> {
    module: &'a Module,
    names: &'a mut Names,
    steps: bool,
    atoms: Vec<Atom>,
    /// Number of times each text was given as a name, so that no name is given twice.
    seen: FxHashMap<u32, u32>,
    temps: FxHashMap<TempId, u32>,
    edges: FxHashMap<EdgeId, u32>,
    slots: FxHashMap<u16, u32>,
    /// The texts of expressions.
    exprs: FxHashMap<ExprId, u32>,
    /// The networks that both modules have, once they are known.
    shared: Option<&'a FxHashSet<u32>>,
    /// The network at hand if both modules have it, else 0.
    network: u32,
    /// The contexts around the statement at hand, and whether parts are in them between which jumps go.
    around: Vec<(u32, bool)>,
    /// The labels before the statement at hand.
    passed: FxHashSet<u32>,
    /// The step of the statement at hand, if it is assumed to use all special devices.
    vague: Option<u32>,
}

impl<'a> Reader<'a> {
    fn of(module: &'a Module, names: &'a mut Names, steps: bool) -> Self {
        Reader {
            module,
            names,
            steps,
            atoms: Vec::new(),
            seen: FxHashMap::default(),
            temps: FxHashMap::default(),
            edges: FxHashMap::default(),
            slots: FxHashMap::default(),
            exprs: FxHashMap::default(),
            shared: None,
            network: 0,
            around: Vec::new(),
            passed: FxHashSet::default(),
            vague: None,
        }
    }

    fn sequence(mut self) -> Sequence {
        let module = self.module;
        let mut functions = Vec::with_capacity(module.functions.len());
        for function in &module.functions {
            let start = self.atoms.len();
            let context = self.names.of(format!("function {:?}", function.kind));
            self.passed.clear();
            self.body(&function.body, context, false);
            functions.push((function.kind.clone(), start..self.atoms.len()));
        }
        Sequence {
            atoms: self.atoms,
            functions,
        }
    }

    /// Collects the networks of a body, with those inside its statements.
    fn networks(&mut self, body: &Body, found: &mut FxHashSet<u32>) {
        for (at, stmt) in body.iter().enumerate() {
            if let Stmt::Network(_) = stmt {
                found.insert(self.alike(&body[at + 1..]));
            }
            for inner in bodies(stmt) {
                self.networks(inner, found);
            }
        }
    }

    /// A name for what the statements up to the next network do, the same for all that do the same.
    fn alike(&mut self, rest: &[Stmt]) -> u32 {
        let mut alone = Reader::of(self.module, self.names, self.steps);
        let stmts = rest.iter();
        for stmt in stmts.take_while(|stmt| !matches!(stmt, Stmt::Network(_))) {
            alone.stmt(stmt, 0);
        }
        let texts: Vec<u32> = alone.atoms.iter().map(|atom| atom.text).collect();
        self.names.of(format!("network {texts:?}"))
    }

    /// A name that nothing else in this module has.
    fn unique(&mut self, text: String) -> u32 {
        let text = self.names.of(format!("{} {text}", self.network));
        let count = self.seen.entry(text).or_default();
        *count += 1;
        let name = format!("{text}#{count}");
        self.names.of(name)
    }

    fn push(&mut self, text: String, reads: Uses, writes: Uses) {
        let text = self.names.of(text);
        self.atoms.push(Atom {
            text,
            fixed: reads.all || writes.all,
            reads,
            writes,
            calls: None,
            vague: self.vague.take(),
        });
    }

    /// The atoms of statements that are executed where a context says; `parts` if jumps go from one part of it to
    /// another.
    fn body(&mut self, body: &Body, context: u32, parts: bool) {
        self.around.push((context, parts));
        let outer = self.network;
        for (at, stmt) in body.iter().enumerate() {
            if let (Stmt::Network(_), Some(shared)) = (stmt, self.shared) {
                let network = self.alike(&body[at + 1..]);
                self.network = if shared.contains(&network) {
                    network
                } else {
                    0
                };
            }
            self.stmt(stmt, context);
        }
        self.network = outer;
        self.around.pop();
    }

    fn stmt(&mut self, stmt: &Stmt, context: u32) {
        match stmt {
            Stmt::Network(_) | Stmt::Watch { .. } => {}
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => {
                let [then_context, else_context] = self.header("if", Some(*cond), context);
                self.body(then, then_context, false);
                self.body(otherwise, else_context, false);
            }
            Stmt::For { count, body } => {
                let [inside, _] = self.header("for", Some(*count), context);
                self.body(body, inside, false);
            }
            Stmt::Repeat(repeat) => {
                let [inside, _] = self.header(&format!("repeat {}", repeat.count), None, context);
                self.body(&repeat.body, inside, false);
            }
            // What it leaves out has no effect.
            Stmt::Steps(steps) => self.body(&steps.body, context, false),
            Stmt::Parts(parts) => {
                let [inside, _] = self.header("parts", None, context);
                for part in parts {
                    let label = part.label.map(|label| label.0);
                    self.passed.extend(label);
                    self.jump(format!("part {label:?}"), inside, vec![inside]);
                    self.body(&part.body, inside, true);
                }
            }
            // A jump back may continue until the watchdog stops the PLC.
            Stmt::Goto(label) if self.passed.contains(&label.0) => {
                self.everything(format!("goto {}", label.0), context);
            }
            Stmt::Goto(label) => {
                let outermost = self.around.iter().position(|(_, parts)| *parts);
                let left = self.contexts(outermost.unwrap_or(0));
                self.jump(format!("goto {}", label.0), context, left);
            }
            Stmt::Return => {
                let left = self.contexts(0);
                self.jump("return".to_string(), context, left);
            }
            Stmt::Do(Action::Stop) => self.everything("stop".to_string(), context),
            Stmt::Do(Action::Clear { latched }) => {
                self.everything(format!("clear {latched}"), context)
            }
            Stmt::CallSub(function) => {
                let kind = self.module.functions.get(*function as usize);
                let kind = format!("function {:?}", kind.map(|function| &function.kind));
                let text = format!("{context} call {kind}");
                let called = self.names.of(kind);
                let mut reads = Uses::default();
                reads.names.push(context);
                let mut writes = Uses::default();
                writes.names.push(called);
                self.push(text, reads, writes);
                if let Some(last) = self.atoms.last_mut() {
                    last.calls = Some(*function as usize);
                }
            }
            Stmt::Do(action) => self.leaf(action, context),
        }
    }

    /// The atom of what a branch or a loop asks, and the contexts of the bodies in it.
    fn header(&mut self, kind: &str, asked: Option<ExprId>, context: u32) -> [u32; 2] {
        let value = asked.map(|asked| self.expr(asked));
        let text = format!("{context} {kind} {value:?}");
        let name = self.unique(text.clone());
        let inside = [0, 1].map(|branch| self.names.of(format!("{name} branch {branch}")));
        let mut reads = Uses::default();
        reads.names.push(context);
        if let Some(asked) = asked {
            self.read_expr(asked, &mut reads);
        }
        let mut writes = Uses::default();
        writes.names.extend(inside);
        self.push(text, reads, writes);
        inside
    }

    /// The contexts around the statement at hand, from one on.
    fn contexts(&self, first: usize) -> Vec<u32> {
        self.around[first..].iter().map(|(name, _)| *name).collect()
    }

    /// An atom that decides what else is executed in some contexts.
    fn jump(&mut self, text: String, context: u32, decided: Vec<u32>) {
        let mut reads = Uses::default();
        reads.names.push(context);
        let writes = Uses {
            names: decided,
            ..Uses::default()
        };
        self.push(format!("{context} {text}"), reads, writes);
        self.fix();
    }

    /// An atom that reaches everything.
    fn everything(&mut self, text: String, context: u32) {
        let mut reads = Uses::default();
        reads.names.push(context);
        let writes = Uses {
            all: true,
            ..Uses::default()
        };
        self.push(format!("{context} {text}"), reads, writes);
    }

    /// Nothing moves across the last atom.
    fn fix(&mut self) {
        if let Some(last) = self.atoms.last_mut() {
            last.fixed = true;
        }
    }

    /// The text of an expression.
    fn expr(&mut self, id: ExprId) -> u32 {
        if let Some(text) = self.exprs.get(&id) {
            return *text;
        }
        let expr = *self.module.expr(id);
        let inner: Vec<u32> = operands(&expr).map(|operand| self.expr(operand)).collect();
        let private = self.private(&expr);
        let mut plain = expr;
        operands_mut(&mut plain).for_each(|operand| *operand = ExprId(0));
        let text = match private {
            Some(name) => format!("private {name} {inner:?}"),
            None => format!("{plain:?} {inner:?}"),
        };
        let text = self.names.of(text);
        self.exprs.insert(id, text);
        text
    }

    /// The name of the temporary or private memory that an expression itself reads.
    fn private(&mut self, expr: &Expr) -> Option<u32> {
        if let Expr::Temp(temp) = expr {
            // A temporary without an assignment does not occur.
            Some(self.temps.get(temp).copied().unwrap_or_default())
        } else if let Expr::Flag(flag) = expr {
            Some(self.flag(*flag))
        } else if let Expr::Cell(cell) = expr {
            Some(self.cell(*cell))
        } else if let Expr::Entry(table, _) = expr {
            Some(self.table(*table))
        } else {
            None
        }
    }

    fn flag(&mut self, flag: FlagId) -> u32 {
        let flag = &self.module.flags[flag];
        let text = format!(
            "flag {} {:?} {:?} {}",
            flag.name, flag.period_ms, flag.pulses_end, flag.retained
        );
        self.names.of(text)
    }

    fn cell(&mut self, cell: CellId) -> u32 {
        let cell = &self.module.cells[cell];
        self.names
            .of(format!("cell {} {}", cell.name, cell.follows_time))
    }

    fn table(&mut self, table: TableId) -> u32 {
        let table = &self.module.tables[table];
        self.names
            .of(format!("table {} {}", table.name, table.length))
    }

    /// Collects the reads of an expression, with its operands.
    fn read_expr(&mut self, id: ExprId, reads: &mut Uses) {
        let mut open = vec![id];
        let mut seen = FxHashSet::default();
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            let expr = *self.module.expr(id);
            of_expr(self.module.model, &expr, &mut |used| self.run(used, reads));
            reads.names.extend(self.private(&expr));
            open.extend(operands(&expr));
        }
    }

    fn run(&self, used: Footprint, uses: &mut Uses) {
        let class = used.place.class;
        let runs = used.reach(self.module.model, &self.module.exprs);
        let runs = runs.into_iter().map(|(first, last)| (class, first, last));
        uses.runs.extend(runs);
    }

    /// A statement without others in it.
    fn leaf(&mut self, action: &Action, context: u32) {
        let mut reads = Uses::default();
        let mut writes = Uses::default();
        reads.names.push(context);
        let mut plain = action.clone();
        let mut evaluated = Vec::new();
        action_exprs_mut(&mut plain, &mut |id| {
            evaluated.push(std::mem::replace(id, ExprId(0)));
        });
        let inner: Vec<u32> = evaluated.iter().map(|id| self.expr(*id)).collect();
        for id in evaluated {
            self.read_expr(id, &mut reads);
        }
        of_action(self.module.model, action, &mut |used| {
            self.run(used, if used.writes { &mut writes } else { &mut reads });
        });
        let names = self.own(&mut plain, context, &inner, &mut reads, &mut writes);
        let text = format!("{context} {plain:?} {inner:?} {names:?}");
        self.push(text, reads, writes);
    }

    /// Takes the numbers of temporaries, private memory and steps out of an action; the names of what they stood for.
    fn own(
        &mut self,
        plain: &mut Action,
        context: u32,
        inner: &[u32],
        reads: &mut Uses,
        writes: &mut Uses,
    ) -> Vec<u32> {
        let about = format!("{context} {inner:?}");
        let mut names = Vec::new();
        if let Action::Let(temp, _) = plain {
            let name = self.temp(std::mem::replace(temp, TempId(0)), &about);
            writes.names.push(name);
            names.push(name);
        } else if let Action::Edge(Edge {
            memory, kind, out, ..
        }) = plain
        {
            let memory = std::mem::replace(memory, EdgeId(0));
            let about = format!("{about} {kind:?}");
            let memory = match self.edges.get(&memory) {
                Some(name) => *name,
                None => {
                    let name = self.unique(format!("edge {about}"));
                    self.edges.insert(memory, name);
                    name
                }
            };
            let out = self.temp(std::mem::replace(out, TempId(0)), &about);
            reads.names.push(memory);
            writes.names.extend([memory, out]);
            names.extend([memory, out]);
        } else if let Action::SetFlag(flag, _) = plain {
            names.push(self.flag(std::mem::replace(flag, FlagId(0))));
            writes.names.extend(&names);
        } else if let Action::SetCell(cell, _) = plain {
            names.push(self.cell(std::mem::replace(cell, CellId(0))));
            writes.names.extend(&names);
        } else if let Action::SetEntry(SetEntry { table, .. }) = plain {
            names.push(self.table(std::mem::replace(table, TableId(0))));
            writes.names.extend(&names);
        } else if let Action::Fault { step, .. } = plain {
            self.step(step);
            writes.runs.extend(ERRORS);
        } else if let Action::Fetch(Fetch {
            value, there, step, ..
        }) = plain
        {
            let at = self.step(step);
            let cell = self.cell(std::mem::replace(value, CellId(0)));
            let there = self.temp(std::mem::replace(there, TempId(0)), &about);
            self.runtime(at, true, reads, writes);
            writes.names.extend([cell, there]);
            names.extend([cell, there]);
        } else if let Action::Send(Send { step, .. }) = plain {
            let at = self.step(step);
            self.runtime(at, true, reads, writes);
        } else if let Action::Call(call) = plain {
            names.push(self.call(call, &about, reads, writes));
        }
        names
    }

    /// A call of the runtime reads whatever it may write.
    fn call(&mut self, call: &mut Call, about: &str, reads: &mut Uses, writes: &mut Uses) -> u32 {
        let step = self.step(&mut call.step);
        let slot = std::mem::take(&mut call.slot);
        let mut texts = String::new();
        for arg in &mut call.args {
            if let Arg::Text(number) = arg {
                let number = std::mem::take(number) as usize;
                texts.push_str(&format!("{:?}", self.module.texts.get(number)));
            }
        }
        let text = format!("call {} {about} {texts}", call.function.name());
        // Private memory from 1 on; those of instructions begin anew with RUN.
        let memory = match self.slots.get(&slot) {
            _ if slot == 0 => self.names.of(text),
            Some(name) => *name,
            None => {
                let lasts = slot > self.module.run_states;
                let name = self.unique(format!("{text} {lasts}"));
                self.slots.insert(slot, name);
                name
            }
        };
        if slot > 0 {
            reads.names.push(memory);
            writes.names.push(memory);
        }
        reads.runs.extend(writes.runs.iter().copied());
        if let Some(specials) = call.function.specials() {
            let relay = |of: &Relay| (DeviceClass::M, of.number(), of.number());
            let register = |of: &Register| (DeviceClass::D, of.number(), of.number());
            let registers = specials.registers.iter().map(register);
            reads
                .runs
                .extend(specials.reads.iter().map(relay).chain(registers.clone()));
            writes
                .runs
                .extend(specials.writes.iter().map(relay).chain(registers));
            writes.runs.extend(ERRORS);
            return memory;
        }
        let needs = call.function.needs();
        let at_rest = Needs {
            state: needs.state,
            always: needs.always,
            sampled: needs.sampled,
            ..Needs::default()
        };
        self.runtime(step, needs != at_rest, reads, writes);
        let beyond = beyond_operands(self.module, call);
        reads.runs.extend(&beyond);
        writes.runs.extend(beyond);
        reads.all = needs.anywhere;
        writes.all = needs.anywhere;
        memory
    }

    /// Adds the devices that calls of the runtime may read and write in addition to their operands, unless the runtime
    /// specifies them.
    fn runtime(&mut self, step: u32, hardware: bool, reads: &mut Uses, writes: &mut Uses) {
        self.vague = Some(step);
        reads.runs.extend(SPECIAL);
        writes.runs.extend(SPECIAL);
        if hardware {
            let name = self.names.hardware();
            reads.names.push(name);
            writes.names.push(name);
        }
    }

    /// The name of a temporary: after the first statement that assigns it.
    fn temp(&mut self, temp: TempId, about: &str) -> u32 {
        if let Some(name) = self.temps.get(&temp) {
            return *name;
        }
        let name = self.unique(format!("temporary {about}"));
        self.temps.insert(temp, name);
        name
    }

    /// Takes a step out of a statement, unless steps are a part of what it does.
    fn step(&self, step: &mut u32) -> u32 {
        let at = *step;
        if !self.steps {
            *step = 0;
        }
        at
    }
}
