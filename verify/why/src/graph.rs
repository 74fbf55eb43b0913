//! Conditions of one scan as a graph: how bits came about, from what they were when the scan began.

use rungc_ir::node::EdgeId;
use rungc_syntax::Device;
use rustc_hash::FxHashMap;

/// Handle of a node.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) struct Id(u32);

/// A bit of the scan. Its operands have lower handles.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Node {
    /// A constant.
    Const(bool),
    /// A device when the scan began.
    Start(Device),
    /// The memory of an edge when the scan began.
    Memory(EdgeId, Option<usize>),
    /// A device where an instruction reads it.
    Contact {
        /// The instruction; `None` if it is not one of the program.
        instr: Option<usize>,
        /// The device.
        device: Device,
        /// The device's state then.
        of: Id,
    },
    Not(Id),
    And(Id, Id),
    Or(Id, Id),
    /// A bit that is not followed further.
    Fact(Fact),
}

/// A bit that is not followed further.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Fact {
    pub(crate) kind: FactKind,
    /// The instruction that it belongs to.
    pub(crate) instr: Option<usize>,
    /// The device that it is about.
    pub(crate) device: Option<Device>,
    /// Bits that it may depend on.
    pub(crate) inputs: Vec<Id>,
    /// True if its value is that of a scan that executes it.
    pub(crate) live: bool,
}

/// Kind of [`Fact`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum FactKind {
    /// A contact that the model makes constant, such as M8000.
    Constant,
    /// A comparison holds.
    Comparison,
    /// A bit of a word.
    WordBit,
    /// A contact that an index register selects.
    Indexed,
    /// A timer has run its time.
    Elapsed,
    /// A counter is one count from its preset, or there.
    Counted,
    /// The value that an instruction gives a device.
    Written,
    /// The value that the PLC gives a special device.
    System,
    /// Anything else, such as a value of arithmetic.
    Other,
}

/// The graph, with the value of each node.
#[derive(Default)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    values: Vec<bool>,
    known: FxHashMap<Key, Id>,
}

/// Nodes that are made once.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Const(bool),
    Start(Device),
    Memory(EdgeId),
    Contact(Option<usize>, Device, Id),
    Not(Id),
    And(Id, Id),
    Or(Id, Id),
}

impl Id {
    /// Position of its node in the graph.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

impl Graph {
    /// All nodes, operands first.
    pub(crate) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id.index()]
    }

    /// The values of all nodes.
    pub(crate) fn values(&self) -> &[bool] {
        &self.values
    }

    pub(crate) fn value(&self, id: Id) -> bool {
        self.values[id.index()]
    }

    fn push(&mut self, node: Node, value: bool) -> Id {
        let id = Id(self.nodes.len() as u32);
        self.nodes.push(node);
        self.values.push(value);
        id
    }

    fn once(&mut self, key: Key, node: Node, value: bool) -> Id {
        if let Some(&id) = self.known.get(&key) {
            return id;
        }
        let id = self.push(node, value);
        self.known.insert(key, id);
        id
    }

    pub(crate) fn constant(&mut self, value: bool) -> Id {
        self.once(Key::Const(value), Node::Const(value), value)
    }

    pub(crate) fn start(&mut self, device: Device, value: bool) -> Id {
        self.once(Key::Start(device), Node::Start(device), value)
    }

    pub(crate) fn memory(&mut self, memory: EdgeId, instr: Option<usize>, value: bool) -> Id {
        self.once(Key::Memory(memory), Node::Memory(memory, instr), value)
    }

    pub(crate) fn contact(&mut self, instr: Option<usize>, device: Device, of: Id) -> Id {
        let value = self.value(of);
        let node = Node::Contact { instr, device, of };
        self.once(Key::Contact(instr, device, of), node, value)
    }

    pub(crate) fn fact(&mut self, fact: Fact, value: bool) -> Id {
        self.push(Node::Fact(fact), value)
    }

    pub(crate) fn not(&mut self, a: Id) -> Id {
        match *self.node(a) {
            Node::Const(value) => self.constant(!value),
            Node::Not(inner) => inner,
            _ => {
                let value = !self.value(a);
                self.once(Key::Not(a), Node::Not(a), value)
            }
        }
    }

    pub(crate) fn and(&mut self, a: Id, b: Id) -> Id {
        match (self.node(a), self.node(b)) {
            (Node::Const(true), _) => b,
            (_, Node::Const(true)) => a,
            (Node::Const(false), _) => a,
            (_, Node::Const(false)) => b,
            _ if a == b => a,
            _ => {
                let value = self.value(a) && self.value(b);
                self.once(Key::And(a, b), Node::And(a, b), value)
            }
        }
    }

    pub(crate) fn or(&mut self, a: Id, b: Id) -> Id {
        match (self.node(a), self.node(b)) {
            (Node::Const(false), _) => b,
            (_, Node::Const(false)) => a,
            (Node::Const(true), _) => a,
            (_, Node::Const(true)) => b,
            _ if a == b => a,
            _ => {
                let value = self.value(a) || self.value(b);
                self.once(Key::Or(a, b), Node::Or(a, b), value)
            }
        }
    }

    /// `then` if a condition is on, else `otherwise`.
    pub(crate) fn choice(&mut self, cond: Id, then: Id, otherwise: Id) -> Id {
        if then == otherwise {
            return then;
        }
        let then = self.and(cond, then);
        let not = self.not(cond);
        let otherwise = self.and(not, otherwise);
        self.or(then, otherwise)
    }
}
