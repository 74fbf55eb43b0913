//! Divides a module into C functions of bounded size, and finds where temporaries live.

use crate::scopes::{self, Temp};
use crate::walk::Sizes;
use rungc_ir::Module;
use rungc_ir::node::{Body, ExprId, LabelId, Part, Stmt};
use rungc_ir::walk::{called_functions, for_exprs};
use std::collections::{BTreeSet, HashMap};

/// About how many operations a C function may hold: what a reader can take in and every compiler optimises in linear time.
const FUNCTION_WEIGHT: u64 = 1200;
/// How deep blocks may nest in one C function (C99 promises 127 levels).
const MAX_NESTING: u32 = 24;

/// A C function of the program.
pub struct CFunction<'m> {
    /// Which of [`Module::functions`] it belongs to.
    pub root: usize,
    /// What stands behind the root's name in its own: empty, `_2`, `_P12`.
    pub suffix: String,
    /// Its statements.
    pub body: Vec<Node<'m>>,
    /// How it ends.
    pub flow: Flow,
    /// Its size.
    pub weight: u64,
}

/// How a C function ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Flow {
    /// No result; runs to its end or returns.
    Void,
    /// A stretch of another one, with jumps out of it: returns the part to go on with, `PLC_LEAVE`, or `PLC_GO_ON`.
    Stretch,
    /// A part: returns likewise; at its end it goes on with this part.
    Part {
        /// State of the next part, if there is one.
        next: Option<u32>,
    },
}

/// A statement of a C function.
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
        /// How often.
        count: ExprId,
        /// What.
        body: Vec<Node<'m>>,
    },
    /// A loop over rungs that are alike.
    Repeat {
        /// How often.
        count: u32,
        /// What.
        body: Vec<Node<'m>>,
        /// Steps of its first and last network.
        steps: (u32, u32),
    },
    /// The switch over parts.
    Parts {
        /// State and C function of each.
        parts: Vec<(u32, usize)>,
        /// Whether a part may go on outside.
        leaves: bool,
    },
    /// Call of a stretch of this function that stands in a C function of its own.
    Stretch(usize),
}

/// Where control may go from a body besides its end.
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
    /// C functions, each after those it calls (but for subroutines).
    pub functions: Vec<CFunction<'m>>,
    /// States of labelled parts: (root, label) to state.
    pub states: HashMap<(usize, LabelId), u32>,
    /// Names of states by root: the suffix of each, from state 1 on.
    pub state_names: Vec<Vec<String>>,
    /// Temporaries.
    pub temps: Vec<Temp>,
    /// Sizes of expressions.
    pub sizes: Sizes,
}

impl<'m> Plan<'m> {
    /// Makes it.
    pub fn new(module: &'m Module) -> Self {
        let mut builder = Builder {
            plan: Plan {
                functions: Vec::new(),
                states: HashMap::new(),
                state_names: vec![Vec::new(); module.functions.len()],
                temps: Vec::new(),
                sizes: Sizes::new(module),
            },
            stretches: vec![0; module.functions.len()],
        };
        let called = called_functions(module);
        for (root, function) in module
            .functions
            .iter()
            .enumerate()
            .filter(|&(root, _)| called[root])
        {
            let items = builder.body(&function.body, root, 0);
            let items = builder.bounded(items, root);
            builder.function(close(items), root, String::new(), Flow::Void);
        }
        let mut plan = builder.plan;
        plan.temps = scopes::temps(module, &plan);
        plan
    }
}

struct Builder<'m> {
    plan: Plan<'m>,
    /// Stretches made so far, by root.
    stretches: Vec<u32>,
}

impl<'m> Builder<'m> {
    fn function(&mut self, body: Closed<'m>, root: usize, suffix: String, flow: Flow) -> usize {
        let (body, weight) = (body.nodes, body.weight);
        self.plan.functions.push(CFunction {
            root,
            suffix,
            body,
            flow,
            weight,
        });
        self.plan.functions.len() - 1
    }

    fn body(&mut self, body: &'m Body, root: usize, nesting: u32) -> Vec<Item<'m>> {
        body.iter()
            .map(|stmt| self.stmt(stmt, root, nesting))
            .collect()
    }

    fn stmt(&mut self, stmt: &'m Stmt, root: usize, nesting: u32) -> Item<'m> {
        let mut leaves = Leaves::default();
        let mut weight = 1;
        for_exprs(stmt, &mut |&e| weight += self.plan.sizes.size(e));
        let mut inner = |body: &'m Body| {
            let closed = self.inner(body, root, nesting + 1);
            weight += closed.weight;
            leaves.add(&closed.leaves);
            closed.nodes
        };
        let node = match stmt {
            Stmt::If {
                cond,
                then,
                otherwise,
            } => Node::If {
                cond: *cond,
                then: inner(then),
                otherwise: inner(otherwise),
            },
            Stmt::For { count, body } => Node::For {
                count: *count,
                body: inner(body),
            },
            Stmt::Repeat {
                count, body, steps, ..
            } => Node::Repeat {
                count: *count,
                body: inner(body),
                steps: *steps,
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
            _ => Node::Stmt(stmt),
        };
        Item {
            node,
            weight,
            leaves,
        }
    }

    /// A branch or a loop's body: bounded, and in a C function of its own if it nests too deep.
    fn inner(&mut self, body: &'m Body, root: usize, nesting: u32) -> Closed<'m> {
        let items = self.body(body, root, nesting);
        let items = self.bounded(items, root);
        if nesting.is_multiple_of(MAX_NESTING) && items.len() > 1 {
            close(vec![self.stretch(items, root)])
        } else {
            close(items)
        }
    }

    fn parts(&mut self, parts: &'m [Part], root: usize, leaves: &mut Leaves) -> Node<'m> {
        let first = self.plan.state_names[root].len() as u32 + 1;
        for (part, state) in parts.iter().zip(first..) {
            let name = match &part.name {
                Some(name) => name.chars().filter(char::is_ascii_alphanumeric).collect(),
                None => format!("part{state}"),
            };
            self.plan.state_names[root].push(name);
            if let Some(label) = part.label {
                self.plan.states.insert((root, label), state);
            }
        }
        let mut own = Vec::with_capacity(parts.len());
        for (part, state) in parts.iter().zip(first..) {
            let items = self.body(&part.body, root, 0);
            let body = close(self.bounded(items, root));
            leaves.add(&body.leaves);
            let suffix = format!("_{}", self.plan.state_names[root][state as usize - 1]);
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

    /// Moves stretches of a body that is too large into C functions of their own.
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
        let mut stretch = Vec::new();
        let mut size = 0;
        for item in items {
            // Rungs stay together, unless one is larger than a whole function.
            let limit = match item.node {
                Node::Stmt(Stmt::Network(_)) => FUNCTION_WEIGHT * 3 / 4,
                _ => FUNCTION_WEIGHT,
            };
            if size + item.weight > limit {
                let full = std::mem::take(&mut stretch);
                self.put_stretch(full, root, &mut outer);
                size = 0;
            }
            size += item.weight;
            stretch.push(item);
        }
        self.put_stretch(stretch, root, &mut outer);
        outer
    }

    fn put_stretch(&mut self, items: Vec<Item<'m>>, root: usize, outer: &mut Vec<Item<'m>>) {
        // A single statement would not get smaller by a function of its own.
        if items.len() > 1 {
            outer.push(self.stretch(items, root));
        } else {
            outer.extend(items);
        }
    }

    fn stretch(&mut self, items: Vec<Item<'m>>, root: usize) -> Item<'m> {
        let body = close(items);
        let leaves = body.leaves.clone();
        let flow = if leaves.any() {
            Flow::Stretch
        } else {
            Flow::Void
        };
        self.stretches[root] += 1;
        let suffix = format!("_{}", self.stretches[root]);
        Item {
            node: Node::Stretch(self.function(body, root, suffix, flow)),
            weight: 1,
            leaves,
        }
    }
}
