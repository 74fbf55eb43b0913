//! And-inverter graphs: all logic as two-input ands and inversions, each and once.

use rustc_hash::FxHashMap;

/// A node of a graph, perhaps inverted.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Lit(u32);

impl Lit {
    /// Never on.
    pub const FALSE: Lit = Lit(0);
    /// Always on.
    pub const TRUE: Lit = Lit(1);

    /// The node.
    pub fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Returns true if it is the inversion of the node.
    pub(crate) fn is_inverted(self) -> bool {
        self.0 & 1 == 1
    }

    /// The constant that it is, if it is one.
    pub fn constant(self) -> Option<bool> {
        (self.node() == 0).then_some(self.is_inverted())
    }

    /// As it is, or inverted.
    #[must_use]
    pub fn invert_if(self, inverted: bool) -> Lit {
        Lit(self.0 ^ u32::from(inverted))
    }

    /// The number of the literal in the format of AIGER: twice the node, and 1 more if it is inverted.
    pub fn code(self) -> u32 {
        self.0
    }
}

impl std::ops::Not for Lit {
    type Output = Lit;

    fn not(self) -> Lit {
        Lit(self.0 ^ 1)
    }
}

impl From<bool> for Lit {
    fn from(on: bool) -> Lit {
        Lit(on.into())
    }
}

/// Kind of a node.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Node {
    /// Node 0, the constant false.
    False,
    /// A free bit, by its number.
    Input(u32),
    /// Both are on.
    And(Lit, Lit),
}

/// A graph. Operands of a node come before it.
#[derive(Clone, Debug)]
pub struct Aig {
    nodes: Vec<Node>,
    ands: FxHashMap<(Lit, Lit), Lit>,
    inputs: u32,
}

impl Default for Aig {
    fn default() -> Self {
        Aig {
            nodes: vec![Node::False],
            ands: FxHashMap::default(),
            inputs: 0,
        }
    }
}

impl Aig {
    /// The nodes, operands first.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Number of inputs.
    pub fn inputs(&self) -> u32 {
        self.inputs
    }

    fn push(&mut self, node: Node) -> Lit {
        let lit = Lit((self.nodes.len() as u32) << 1);
        self.nodes.push(node);
        lit
    }

    /// A node as it is.
    pub fn literal(&self, node: usize) -> Lit {
        Lit((node as u32) << 1)
    }

    /// A new free bit; its number is that of the inputs before.
    pub fn input(&mut self) -> Lit {
        let number = self.inputs;
        self.inputs += 1;
        self.push(Node::Input(number))
    }

    /// The operands, if a literal is an and that is not inverted.
    fn operands(&self, lit: Lit) -> Option<(Lit, Lit)> {
        match self.nodes[lit.node()] {
            Node::And(a, b) if !lit.is_inverted() => Some((a, b)),
            _ => None,
        }
    }

    /// Both.
    pub fn and(&mut self, a: Lit, b: Lit) -> Lit {
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        if a == Lit::FALSE || a == !b {
            return Lit::FALSE;
        }
        if a == Lit::TRUE || a == b {
            return b;
        }
        if let Some(simple) = self.absorb(a, b).or_else(|| self.absorb(b, a)) {
            return simple;
        }
        if let Some(simple) = self.resolve(a, b) {
            return simple;
        }
        if let Some(&known) = self.ands.get(&(a, b)) {
            return known;
        }
        let lit = self.push(Node::And(a, b));
        self.ands.insert((a, b), lit);
        lit
    }

    /// `a & b` where `b` is an and, or the inversion of one, with `a` in it.
    fn absorb(&mut self, a: Lit, b: Lit) -> Option<Lit> {
        if let Some((x, y)) = self.operands(b) {
            if x == a || y == a {
                return Some(b);
            }
            if x == !a || y == !a {
                return Some(Lit::FALSE);
            }
        }
        let (x, y) = self.operands(!b)?;
        if x == !a || y == !a {
            return Some(a);
        }
        if x == a {
            return Some(self.and(a, !y));
        }
        (y == a).then(|| self.and(a, !x))
    }

    /// `!(g & c) & !(g & !c)` is `!g`: neither branch of a condition is taken where it is not reached.
    fn resolve(&self, a: Lit, b: Lit) -> Option<Lit> {
        let ((w, x), (y, z)) = (self.operands(!a)?, self.operands(!b)?);
        let pairs = [(w, x, y, z), (w, x, z, y), (x, w, y, z), (x, w, z, y)];
        let found = pairs.into_iter().find(|&(g, c, h, d)| g == h && c == !d);
        found.map(|(g, ..)| !g)
    }

    /// At least one.
    pub fn or(&mut self, a: Lit, b: Lit) -> Lit {
        !self.and(!a, !b)
    }

    /// Exactly one.
    pub fn xor(&mut self, a: Lit, b: Lit) -> Lit {
        self.mux(a, !b, b)
    }

    /// Both or neither.
    pub fn same(&mut self, a: Lit, b: Lit) -> Lit {
        !self.xor(a, b)
    }

    /// `then` where `cond` is on, else `otherwise`.
    pub(crate) fn mux(&mut self, cond: Lit, then: Lit, otherwise: Lit) -> Lit {
        if then == otherwise {
            return then;
        }
        let a = self.and(cond, then);
        let b = self.and(!cond, otherwise);
        self.or(a, b)
    }

    /// All of them.
    pub fn all(&mut self, lits: impl IntoIterator<Item = Lit>) -> Lit {
        let lits = lits.into_iter();
        lits.fold(Lit::TRUE, |all, lit| self.and(all, lit))
    }

    /// Any of them.
    pub fn any(&mut self, lits: impl IntoIterator<Item = Lit>) -> Lit {
        let lits = lits.into_iter();
        lits.fold(Lit::FALSE, |any, lit| self.or(any, lit))
    }
}

#[cfg(test)]
mod tests {
    use super::{Aig, Lit, Node};

    fn value(aig: &Aig, lit: Lit, inputs: u32) -> bool {
        let mut values = vec![false; aig.nodes().len()];
        let of = |values: &[bool], lit: Lit| values[lit.node()] != lit.is_inverted();
        for (i, node) in aig.nodes().iter().enumerate() {
            values[i] = match *node {
                Node::False => false,
                Node::Input(n) => inputs >> n & 1 == 1,
                Node::And(a, b) => of(&values, a) && of(&values, b),
            };
        }
        of(&values, lit)
    }

    #[test]
    fn simplified_logic_has_the_same_values() {
        let mut aig = Aig::default();
        let inputs: Vec<Lit> = (0..3).map(|_| aig.input()).collect();
        let mut lits = vec![Lit::FALSE, inputs[0], inputs[1], inputs[2]];
        // Value of each literal, for the eight values of the inputs.
        let mut tables = vec![0u8, 0b1010_1010, 0b1100_1100, 0b1111_0000];
        for i in 0..40 {
            let (a, b) = (i * 7 % lits.len(), i * 11 % lits.len());
            let (ia, ib) = (i % 3 == 0, i % 5 < 2);
            let lit = aig.and(lits[a].invert_if(ia), lits[b].invert_if(ib));
            let flip = |table: u8, inverted| if inverted { !table } else { table };
            let table = flip(tables[a], ia) & flip(tables[b], ib);
            for n in 0..8 {
                assert_eq!(value(&aig, lit, n), table >> n & 1 == 1);
            }
            lits.push(!lit);
            tables.push(!table);
        }
    }

    #[test]
    fn both_branches_together_are_where_they_part() {
        let mut aig = Aig::default();
        let (g, c) = (aig.input(), aig.input());
        let (then, otherwise) = (aig.and(g, c), aig.and(g, !c));
        assert_eq!(aig.or(then, otherwise), g);
    }
}
