//! The functions of the emitted program: a module divided into functions of bounded size.

use crate::measure::Sizes;
use crate::steps::{self, Ladders};
use crate::temps::{self, Temp};
use rungc_ir::Module;
use rungc_ir::node::{Body, Branch, ExprId, LabelId, Part, Steps, Stmt, TempId};
use rungc_ir::walk::{called_functions, calls_runtime, for_exprs};
use smallvec::SmallVec;
use std::collections::{BTreeSet, HashMap};
use typed_index_collections::TiVec;

/// About how many operations a function may hold: what a reader can take in and every compiler optimises in linear
/// time.
const FUNCTION_WEIGHT: u64 = 1200;
/// Largest depth of blocks in one function (C99 promises 127 levels).
const MAX_NESTING: u32 = 24;

/// A function of the emitted program.
pub struct Function<'m> {
    /// Index in [`Module::functions`] of the function it belongs to.
    pub root: usize,
    /// Suffix to the root's name: nothing, `_2`, `_P12`.
    pub suffix: String,
    /// Its statements.
    pub body: Vec<Node<'m>>,
    /// Kind of its end.
    pub flow: Flow,
    /// Its size, in operations.
    pub weight: u64,
    /// True if its own statements call the runtime.
    pub calls_runtime: bool,
    /// True if it or a function that it calls calls the runtime, so that it needs the hardware.
    pub needs_hardware: bool,
}

impl Function<'_> {
    /// Returns true if it is a whole function of the module, or the rest of one after blocks and parts have been
    /// outlined.
    pub fn is_whole(&self) -> bool {
        self.suffix.is_empty()
    }

    /// Returns true if it does not use the program's struct: it only jumps, if it does that.
    pub fn is_idle(&self) -> bool {
        let idle = |node: &Node| {
            matches!(
                node,
                Node::Stmt(Stmt::Network(_) | Stmt::Goto(_) | Stmt::Return)
            )
        };
        self.body.iter().all(idle)
    }

    /// The steps of its first and last network.
    pub fn steps(&self, module: &Module) -> Option<(u32, u32)> {
        let mut steps = Vec::new();
        statements(&self.body, &mut |stmt| {
            if let Stmt::Network(network) = stmt {
                steps.extend(module.networks.get(*network as usize).map(|n| n.step));
            }
        });
        Some((*steps.first()?, *steps.last()?))
    }

    /// Returns true if it ends with its own jump or return.
    pub fn ends_by_jump(&self) -> bool {
        let last = self.body.last();
        matches!(last, Some(Node::Stmt(Stmt::Goto(_) | Stmt::Return)))
    }
}

/// Kind of end of a function.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Flow {
    /// No result; runs to its end or returns.
    Void,
    /// A block of another one, with jumps out of it: returns the state of the part to continue with, or that the root
    /// is to be left, or that it has come to its end.
    Outlined,
    /// A part: returns the same; from its end it continues with this part.
    Part {
        /// State of the next part, if there is one.
        next: Option<u32>,
    },
}

/// A statement of a function.
pub enum Node<'m> {
    /// A simple one.
    Stmt(&'m Stmt),
    /// `if`.
    If {
        /// Condition.
        cond: ExprId,
        /// If on.
        then: Vec<Node<'m>>,
        /// If off.
        otherwise: Vec<Node<'m>>,
    },
    /// `for`.
    For {
        /// Number of iterations.
        count: ExprId,
        /// Repeated statements.
        body: Vec<Node<'m>>,
    },
    /// A loop over stations: rungs that are alike.
    Repeat(Stations<'m>),
    /// Blocks of a step ladder.
    Steps {
        /// States and memories of the blocks.
        of: &'m Steps,
        /// The blocks.
        body: Vec<Node<'m>>,
    },
    /// The choice between parts.
    Parts {
        /// State and function of each.
        parts: Vec<(u32, usize)>,
        /// True if a part may continue outside of them.
        leaves: bool,
    },
    /// A call of a block of this function that is a separate function.
    Outlined(usize),
}

impl Node<'_> {
    /// The bodies directly inside it.
    pub fn bodies(&self) -> impl Iterator<Item = &[Self]> {
        let bodies: [&[Self]; 2] = match self {
            Node::If {
                then, otherwise, ..
            } => [then, otherwise],
            Node::For { body, .. } | Node::Steps { body, .. } => [body, &[]],
            Node::Repeat(stations) => [&stations.body, &[]],
            Node::Stmt(_) | Node::Parts { .. } | Node::Outlined(_) => [&[], &[]],
        };
        bodies.into_iter()
    }

    /// The expressions that it evaluates itself, without those of the bodies inside it.
    pub fn roots(&self) -> SmallVec<[ExprId; 4]> {
        let mut roots = SmallVec::new();
        match self {
            Node::Stmt(stmt) => for_exprs(stmt, &mut |&e| roots.push(e)),
            Node::If { cond, .. } => roots.push(*cond),
            Node::For { count, .. } => roots.push(*count),
            Node::Repeat(_) | Node::Steps { .. } | Node::Parts { .. } | Node::Outlined(_) => {}
        }
        roots
    }
}

/// A loop over stations.
pub struct Stations<'m> {
    /// Number of stations.
    pub count: u32,
    /// The rungs of one.
    pub body: Vec<Node<'m>>,
    /// Steps of its first and last network.
    pub steps: (u32, u32),
}

/// Calls `visit` with every statement of some nodes, those of the bodies inside them after them.
pub fn statements<'m>(nodes: &[Node<'m>], visit: &mut dyn FnMut(&'m Stmt)) {
    for node in nodes {
        if let Node::Stmt(stmt) = node {
            visit(stmt);
        }
        for body in node.bodies() {
            statements(body, visit);
        }
    }
}

/// Exits of a body other than its end.
#[derive(Clone, Default)]
struct Leaves {
    returns: bool,
    labels: BTreeSet<LabelId>,
}

impl Leaves {
    fn add(&mut self, other: &Leaves) {
        self.returns |= other.returns;
        self.labels.extend(&other.labels);
    }

    fn any(&self) -> bool {
        self.returns || !self.labels.is_empty()
    }
}

/// Calls `visit` with blocks of step ladders and their bodies.
fn steps_of<'n, 'm>(nodes: &'n [Node<'m>], visit: &mut dyn FnMut(&'m Steps, &'n [Node<'m>])) {
    for node in nodes {
        if let Node::Steps { of, body } = node {
            visit(of, body);
        }
        for body in node.bodies() {
            steps_of(body, visit);
        }
    }
}

/// A node with what is known of it.
struct Item<'m> {
    node: Node<'m>,
    weight: u64,
    leaves: Leaves,
}

/// A finished body.
#[derive(Default)]
struct Closed<'m> {
    nodes: Vec<Node<'m>>,
    weight: u64,
    leaves: Leaves,
}

fn weight(items: &[Item]) -> u64 {
    items.iter().map(|item| item.weight).sum()
}

fn close(items: Vec<Item>) -> Closed {
    let mut closed = Closed::default();
    closed.nodes.reserve(items.len());
    for item in items {
        closed.weight += item.weight;
        closed.leaves.add(&item.leaves);
        closed.nodes.push(item.node);
    }
    closed
}

/// The division.
pub struct Plan<'m> {
    /// The functions, each after those it calls (but for subroutines).
    pub functions: Vec<Function<'m>>,
    /// The temporaries, by their handles.
    pub temps: TiVec<TempId, Temp>,
    /// Sizes of expressions.
    pub sizes: Sizes,
    /// Blocks of step ladders that are cases.
    pub ladders: Ladders,
    /// States of labelled parts: (root, label) to state.
    states: HashMap<(usize, LabelId), u32>,
    /// Names of states by root: the suffix of each, from state 1 on.
    state_names: Vec<Vec<String>>,
    /// The whole function of each root, if it is emitted.
    whole: Vec<Option<usize>>,
}

impl<'m> Plan<'m> {
    /// Makes it.
    pub fn new(module: &'m Module) -> Self {
        let mut plan = Plan::without_ladders(module);
        plan.ladders = Ladders::of(module, &plan);
        plan.name_ladders(module);
        plan
    }

    /// Makes one in which no blocks of step ladders are cases.
    pub fn without_ladders(module: &'m Module) -> Self {
        let mut builder = Builder {
            module,
            functions: Vec::new(),
            sizes: Sizes::new(module),
            states: HashMap::new(),
            state_names: vec![Vec::new(); module.functions.len()],
            outlined: vec![0; module.functions.len()],
        };
        let mut whole = vec![None; module.functions.len()];
        let called = called_functions(module);
        for (root, function) in module
            .functions
            .iter()
            .enumerate()
            .filter(|&(root, function)| called[root] && !function.body.is_empty())
        {
            let items = builder.body(&function.body, root, 0);
            let items = builder.bounded(items, root);
            whole[root] = Some(builder.function(close(items), root, String::new(), Flow::Void));
        }
        let mut functions = builder.functions;
        hand_hardware_on(&mut functions, &whole);
        Plan {
            temps: temps::temps(module, &functions, &builder.sizes),
            functions,
            sizes: builder.sizes,
            ladders: Ladders::default(),
            states: builder.states,
            state_names: builder.state_names,
            whole,
        }
    }

    /// Names the temporaries of whether a state is on alike in all blocks of ladders.
    fn name_ladders(&mut self, module: &Module) {
        let mut named = Vec::new();
        for function in &self.functions {
            steps_of(&function.body, &mut |of, body| {
                let cases = match self.ladders.find(of) {
                    Some(_) => steps::cases(module, self, of, body),
                    None => None,
                };
                named.extend(cases.into_iter().flatten().filter_map(|case| case.on));
            });
        }
        for temp in named {
            self.temps[temp].name_on();
        }
    }

    /// Whole function of a root in the plan; `None` if it is not emitted.
    pub fn whole(&self, root: usize) -> Option<&Function<'m>> {
        self.functions.get((*self.whole.get(root)?)?)
    }

    /// The state that stands for the part with this label.
    pub fn state(&self, root: usize, label: LabelId) -> Option<u32> {
        self.states.get(&(root, label)).copied()
    }

    /// The names of a root's states, from state 1 on: what a name adds to the root's, `P12`, `part3`.
    pub fn state_names(&self, root: usize) -> &[String] {
        &self.state_names[root]
    }

    /// A temporary.
    pub fn temp(&self, temp: TempId) -> &Temp {
        &self.temps[temp]
    }

    /// Returns true if nothing remains of a network, so that it needs no heading.
    pub fn is_silent(module: &Module, node: &Node, next: Option<&Node>) -> bool {
        let Node::Stmt(Stmt::Network(network)) = node else {
            return false;
        };
        let known = module.networks.get(*network as usize);
        let silent = known.is_none_or(|n| n.statement.is_none() && n.note.is_none());
        silent && matches!(next, None | Some(Node::Stmt(Stmt::Network(_))))
    }
}

/// Returns true if a function of the module has no statements.
fn is_empty(module: &Module, root: usize) -> bool {
    let function = module.functions.get(root);
    function.is_none_or(|function| function.body.is_empty())
}

/// Finds the functions that need the hardware because one that they call does.
fn hand_hardware_on(functions: &mut [Function], whole: &[Option<usize>]) {
    let callees: Vec<Vec<usize>> = functions.iter().map(|f| callees(&f.body, whole)).collect();
    // Calls do not recurse, so this ends after as many passes as calls nest.
    let mut changed = true;
    while changed {
        changed = false;
        for (caller, callees) in callees.iter().enumerate() {
            let needs = callees
                .iter()
                .any(|&callee| functions[callee].needs_hardware);
            changed |= needs && !functions[caller].needs_hardware;
            functions[caller].needs_hardware |= needs;
        }
    }
}

/// The functions that some nodes call.
fn callees(nodes: &[Node], whole: &[Option<usize>]) -> Vec<usize> {
    let mut found = Vec::new();
    for node in nodes {
        match node {
            Node::Stmt(Stmt::CallSub(root)) => found.extend(whole[*root as usize]),
            Node::Parts { parts, .. } => found.extend(parts.iter().map(|&(_, function)| function)),
            Node::Outlined(function) => found.push(*function),
            Node::Stmt(_)
            | Node::If { .. }
            | Node::For { .. }
            | Node::Repeat(_)
            | Node::Steps { .. } => {}
        }
        for body in node.bodies() {
            found.extend(callees(body, whole));
        }
    }
    found
}

struct Builder<'m> {
    module: &'m Module,
    functions: Vec<Function<'m>>,
    sizes: Sizes,
    states: HashMap<(usize, LabelId), u32>,
    state_names: Vec<Vec<String>>,
    /// Number of blocks outlined so far, by root.
    outlined: Vec<u32>,
}

impl<'m> Builder<'m> {
    fn function(&mut self, body: Closed<'m>, root: usize, suffix: String, flow: Flow) -> usize {
        let mut runtime = false;
        statements(&body.nodes, &mut |stmt| runtime |= calls_runtime(stmt));
        self.functions.push(Function {
            root,
            suffix,
            body: body.nodes,
            flow,
            weight: body.weight,
            calls_runtime: runtime,
            needs_hardware: runtime,
        });
        self.functions.len() - 1
    }

    fn body(&mut self, body: &'m Body, root: usize, nesting: u32) -> Vec<Item<'m>> {
        let module = self.module;
        // Expressions have no effects, and a function without statements is not emitted.
        let does_nothing = |item: &Item| match &item.node {
            Node::If {
                then, otherwise, ..
            } => then.is_empty() && otherwise.is_empty(),
            Node::Stmt(stmt) => {
                matches!(stmt, Stmt::CallSub(root) if is_empty(module, *root as usize))
            }
            Node::Steps { body, .. } => body.is_empty(),
            Node::For { .. } | Node::Repeat(_) | Node::Parts { .. } | Node::Outlined(_) => false,
        };
        let items = body.iter().map(|stmt| self.stmt(stmt, root, nesting));
        items.filter(|item| !does_nothing(item)).collect()
    }

    fn stmt(&mut self, stmt: &'m Stmt, root: usize, nesting: u32) -> Item<'m> {
        let mut leaves = Leaves::default();
        let mut weight = 1;
        for_exprs(stmt, &mut |&e| weight += self.sizes.size(e));
        let mut inner = |body: &'m Body| {
            let closed = self.inner(body, root, nesting + 1);
            weight += closed.weight;
            leaves.add(&closed.leaves);
            closed.nodes
        };
        let node = match stmt {
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => Node::If {
                cond: *cond,
                then: inner(then),
                otherwise: inner(otherwise),
            },
            Stmt::For { count, body } => Node::For {
                count: *count,
                body: inner(body),
            },
            Stmt::Repeat(repeat) => Node::Repeat(Stations {
                count: repeat.count,
                body: inner(&repeat.body),
                steps: repeat.steps,
            }),
            Stmt::Steps(steps) => Node::Steps {
                of: steps,
                body: inner(&steps.body),
            },
            Stmt::Parts(parts) => {
                weight += 2 * parts.len() as u64;
                self.parts(parts, root, &mut leaves)
            }
            Stmt::Return | Stmt::Watch { .. } => {
                leaves.returns = true;
                Node::Stmt(stmt)
            }
            Stmt::Goto(label) => {
                leaves.labels.insert(*label);
                Node::Stmt(stmt)
            }
            Stmt::Network(_) | Stmt::Do(_) | Stmt::CallSub(_) => Node::Stmt(stmt),
        };
        Item {
            node,
            weight,
            leaves,
        }
    }

    /// A branch or a loop's body: bounded, and in a separate function if it nests too deep.
    fn inner(&mut self, body: &'m Body, root: usize, nesting: u32) -> Closed<'m> {
        let items = self.body(body, root, nesting);
        let items = self.bounded(items, root);
        if nesting.is_multiple_of(MAX_NESTING) && items.len() > 1 {
            close(vec![self.outline(items, root)])
        } else {
            close(items)
        }
    }

    fn parts(&mut self, parts: &'m [Part], root: usize, leaves: &mut Leaves) -> Node<'m> {
        let first = self.state_names[root].len() as u32 + 1;
        for (part, state) in parts.iter().zip(first..) {
            let name = match &part.name {
                Some(name) => name.chars().filter(char::is_ascii_alphanumeric).collect(),
                None => format!("part{state}"),
            };
            self.state_names[root].push(name);
            if let Some(label) = part.label {
                self.states.insert((root, label), state);
            }
        }
        let mut own = Vec::with_capacity(parts.len());
        for (part, state) in parts.iter().zip(first..) {
            let items = self.body(&part.body, root, 0);
            let body = close(self.bounded(items, root));
            leaves.add(&body.leaves);
            let suffix = format!("_{}", self.state_names[root][state as usize - 1]);
            let next = (own.len() + 1 < parts.len()).then_some(state + 1);
            own.push((
                state,
                self.function(body, root, suffix, Flow::Part { next }),
            ));
        }
        for label in parts.iter().filter_map(|p| p.label) {
            leaves.labels.remove(&label);
        }
        Node::Parts {
            parts: own,
            leaves: leaves.any(),
        }
    }

    /// Outlines blocks of a body that is too large: makes them separate functions.
    fn bounded(&mut self, mut items: Vec<Item<'m>>, root: usize) -> Vec<Item<'m>> {
        while weight(&items) > FUNCTION_WEIGHT {
            let before = items.len();
            items = self.divided(items, root);
            if items.len() == before {
                break;
            }
        }
        items
    }

    fn divided(&mut self, items: Vec<Item<'m>>, root: usize) -> Vec<Item<'m>> {
        let mut outer = Vec::new();
        let mut block = Vec::new();
        let mut size = 0;
        for item in items {
            // Rungs stay together, unless one is larger than a whole function.
            let limit = if matches!(item.node, Node::Stmt(Stmt::Network(_))) {
                FUNCTION_WEIGHT * 3 / 4
            } else {
                FUNCTION_WEIGHT
            };
            if size + item.weight > limit {
                let full = std::mem::take(&mut block);
                self.put_outlined(full, root, &mut outer);
                size = 0;
            }
            size += item.weight;
            block.push(item);
        }
        self.put_outlined(block, root, &mut outer);
        outer
    }

    fn put_outlined(&mut self, items: Vec<Item<'m>>, root: usize, outer: &mut Vec<Item<'m>>) {
        // A separate function would not make a single statement smaller.
        if items.len() > 1 {
            outer.push(self.outline(items, root));
        } else {
            outer.extend(items);
        }
    }

    fn outline(&mut self, items: Vec<Item<'m>>, root: usize) -> Item<'m> {
        let body = close(items);
        let leaves = body.leaves.clone();
        let flow = if leaves.any() {
            Flow::Outlined
        } else {
            Flow::Void
        };
        self.outlined[root] += 1;
        let suffix = format!("_{}", self.outlined[root]);
        Item {
            node: Node::Outlined(self.function(body, root, suffix, flow)),
            weight: 1,
            leaves,
        }
    }
}
