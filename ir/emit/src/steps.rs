//! Blocks of a step ladder as the cases of a choice: neighbours of consecutive states that begin alike.
//!
//! Each block begins with the same statements on a state and two memories: a state that a transition left goes off, and
//! the block runs if its state is on, or was. What differs is the rest. So one function of the runtime finds the next
//! block that runs, and the rest of each is a case.

use crate::plan::{Node, Plan};
use rungc_ir::Module;
use rungc_ir::node::{Access, AccessKind, Action, Edge, EdgeId, Expr, ExprId, Steps, Stmt, TempId};
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass::S;

/// Number of memories of each block: whether its state was left, and whether it was on.
const MEMORIES: u32 = 2;

/// The block of a state.
pub struct Case<'n, 'm> {
    /// Number of the network in which it begins; none for the first one, which begins in front of all.
    pub network: Option<u32>,
    /// The temporary of whether the state is on, if the rest uses it.
    pub on: Option<&'m Stmt>,
    /// The rest.
    pub rest: &'n [Node<'m>],
}

/// The cases of neighbouring blocks, if all of them begin alike.
#[expect(clippy::wildcard_enum_match_arm, reason = "others are not blocks")]
pub fn cases<'n, 'm>(
    module: &Module,
    plan: &Plan,
    of: &Steps,
    body: &'n [Node<'m>],
) -> Option<Vec<Case<'n, 'm>>> {
    let mut cases = Vec::new();
    let mut network = None;
    for node in body {
        match node {
            Node::Stmt(Stmt::Network(number)) => network = Some(*number),
            Node::Steps { of: block, body } => {
                let n = cases.len() as u32;
                let state = of.first + n;
                let memory = EdgeId(of.memory.0 + MEMORIES * n);
                let alike = block.first == state
                    && block.states == 1
                    && block.memory == memory
                    && block.memories == MEMORIES;
                let (on, rest) = begin(module, plan, state, memory, body).filter(|_| alike)?;
                cases.push(Case {
                    network: network.take(),
                    on,
                    rest,
                });
            }
            _ => return None,
        }
    }
    (cases.len() as u32 == of.states).then_some(cases)
}

/// What follows the statements with which a block begins, and the temporary of whether its state is on.
fn begin<'n, 'm>(
    module: &Module,
    plan: &Plan,
    state: u32,
    memory: EdgeId,
    body: &'n [Node<'m>],
) -> Option<(Option<&'m Stmt>, &'n [Node<'m>])> {
    let [
        left,
        Node::If {
            cond,
            then,
            otherwise: none,
        },
        begins @ ..,
    ] = body
    else {
        return None;
    };
    let (marked, off) = falling(left, memory)?;
    let goes_off = matches!(then[..], [Node::Stmt(Stmt::Do(Action::Write(access, value)))]
        if is_state(*access, state) && *module.expr(*value) == Expr::Bit(false));
    let is_left =
        *module.expr(off) == Expr::Bit(false) && *module.expr(*cond) == Expr::Temp(marked);
    let (before, last) = begins.split_at(begins.len().checked_sub(1)?);
    let [
        Node::If {
            cond,
            then: rest,
            otherwise,
        },
    ] = last
    else {
        return None;
    };
    let (mut on, mut was_on) = (None, None);
    for node in before {
        if let Node::Stmt(stmt @ Stmt::Do(Action::Let(temp, value))) = node
            && reads(module, *value, state)
        {
            on = Some((*temp, *stmt));
        } else {
            was_on = Some(falling(node, EdgeId(memory.0 + 1))?);
        }
    }
    let (was_on, input) = was_on?;
    let is_on = |value: ExprId| {
        let temp = on.map(|(temp, _)| temp);
        reads(module, value, state)
            || temp.is_some_and(|temp| *module.expr(value) == Expr::Temp(temp))
    };
    let runs = matches!(*module.expr(*cond), Expr::Or(state, left)
        if is_on(state) && *module.expr(left) == Expr::Temp(was_on));
    let alone = [marked, was_on]
        .iter()
        .all(|&temp| plan.temp(temp).used == 1);
    let alike = goes_off && none.is_empty() && is_left && is_on(input) && runs && alone;
    // The condition and the memory use it, too.
    let used = on.filter(|(temp, _)| {
        let beginning = [input, *cond].map(|value| uses(module, value, *temp));
        plan.temp(*temp).used > beginning.iter().map(|&is| u32::from(is)).sum()
    });
    (alike && before.len() <= 2 && otherwise.is_empty())
        .then(|| (used.map(|(_, stmt)| stmt), &rest[..]))
}

/// The result and the input of the statement that finds a falling edge with this memory.
#[expect(clippy::wildcard_enum_match_arm, reason = "others find no edge")]
fn falling(node: &Node, with: EdgeId) -> Option<(TempId, ExprId)> {
    match node {
        Node::Stmt(Stmt::Do(Action::Edge(Edge {
            memory,
            index: None,
            kind: EdgeKind::Falling,
            input,
            out,
        }))) if *memory == with => Some((*out, *input)),
        _ => None,
    }
}

fn is_state(access: Access, state: u32) -> bool {
    access.kind == AccessKind::Bit && access.device() == Some((S, state))
}

/// Returns true if an expression reads a state.
fn reads(module: &Module, value: ExprId, state: u32) -> bool {
    matches!(*module.expr(value), Expr::Read(access) if is_state(access, state))
}

/// Returns true if an expression is a temporary, or joins it with another.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "others do not begin a block"
)]
fn uses(module: &Module, value: ExprId, temp: TempId) -> bool {
    match *module.expr(value) {
        Expr::Temp(read) => read == temp,
        Expr::Or(a, _) => *module.expr(a) == Expr::Temp(temp),
        _ => false,
    }
}
