//! Selection of the statements that run on whole lanes.

use super::mirror::{Meeting, Met};
use crate::fields::PrintStorage;
use rungc_emit::plan::{Flow, Node, Plan};
use rungc_emit::storage::Storage;
use rungc_emit::temps::Home;
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Action, Expr, ExprId, Place, Stmt, SysValue, TempId, Ty};
use rungc_ir::walk::{assigned, operands};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Classification of a program's statements.
pub(super) struct Classes<'a, 'm> {
    pub module: &'m Module,
    pub plan: &'a Plan<'m>,
    pub fields: &'a Storage<'m>,
    /// Temporaries that one instance has, not all in lanes.
    single: BTreeSet<TempId>,
    /// Timers and counters whose coils always run, since something else writes their values.
    pub forced: BTreeSet<(DeviceClass, u32)>,
}

impl<'a, 'm> Classes<'a, 'm> {
    /// Looks at all functions.
    pub fn of(module: &'m Module, plan: &'a Plan<'m>, fields: &'a Storage<'m>) -> Self {
        let temps = plan.temps.iter_enumerated();
        let single =
            temps.filter(|&(id, temp)| module.temps[id] != Ty::Bit || temp.home() == Home::Field);
        let mut classes = Classes {
            module,
            plan,
            fields,
            single: single.map(|(id, _)| id).collect(),
            forced: BTreeSet::new(),
        };
        let mut meeting = classes.meeting();
        (0..plan.functions.len()).for_each(|function| meeting.function(function));
        classes.forced = meeting.met.forced;
        // A temporary of one instance makes what reads it code of one instance, which may assign others.
        while classes.add_single() {}
        classes
    }

    fn meeting(&self) -> Meeting<'a, 'm> {
        Meeting {
            module: self.module,
            plan: self.plan,
            fields: self.fields,
            met: Met::default(),
        }
    }

    /// Use of the fields in lanes by nodes.
    pub fn met(&self, nodes: &[Node]) -> Met {
        let mut meeting = self.meeting();
        nodes.iter().for_each(|node| meeting.node(node));
        meeting.met
    }

    fn add_single(&mut self) -> bool {
        let before = self.single.len();
        let plan = self.plan;
        for function in &plan.functions {
            self.add_single_of(&function.body);
        }
        self.single.len() > before
    }

    fn add_single_of(&mut self, nodes: &[Node]) {
        for node in nodes {
            if let Node::Stmt(stmt) = node
                && let Some(temp) = assigned(stmt)
                && !self.slices(node)
            {
                self.single.insert(temp);
            }
            for body in node.bodies() {
                self.add_single_of(body);
            }
        }
    }

    /// Returns true if a function runs as a whole in each instance: it is left before its end.
    pub(crate) fn is_left_early(&self, function: usize) -> bool {
        let function = &self.plan.functions[function];
        function.flow != Flow::Void || self.jumps(&function.body)
    }

    fn jumps(&self, nodes: &[Node]) -> bool {
        nodes.iter().any(|node| match node {
            Node::Stmt(stmt) => matches!(stmt, Stmt::Return | Stmt::Goto(_) | Stmt::Watch { .. }),
            Node::Parts { leaves, .. } => *leaves,
            Node::Outlined(function) => self.plan.functions[*function].flow != Flow::Void,
            Node::If { .. } | Node::For { .. } | Node::Repeat(_) | Node::Steps { .. } => {
                node.bodies().any(|body| self.jumps(body))
            }
        })
    }

    /// Selects the nodes that run on whole lanes. A temporary of one instance keeps all between its first and its last
    /// use together.
    pub(crate) fn of_nodes(&self, nodes: &[Node]) -> Vec<bool> {
        let mut sliced: Vec<bool> = nodes.iter().map(|node| self.slices(node)).collect();
        let mut uses: Vec<BTreeSet<TempId>> = Vec::with_capacity(nodes.len());
        for node in nodes {
            let mut found = BTreeSet::new();
            self.temps_of(node, &mut found);
            found.retain(|temp| {
                self.single.contains(temp) && self.plan.temp(*temp).home() != Home::Field
            });
            uses.push(found);
        }
        let all: BTreeSet<_> = uses.iter().flatten().copied().collect();
        for temp in all {
            let first = uses.iter().position(|uses| uses.contains(&temp));
            let last = uses.iter().rposition(|uses| uses.contains(&temp));
            if let (Some(first), Some(last)) = (first, last)
                && (first < last || matches!(nodes[first], Node::Stmt(_)))
            {
                sliced[first..=last].fill(false);
            }
        }
        sliced
    }

    /// All temporaries that a node assigns or reads.
    fn temps_of(&self, node: &Node, found: &mut BTreeSet<TempId>) {
        for root in node.roots() {
            self.temps_read(root, found);
        }
        if let Node::Stmt(stmt) = node {
            found.extend(assigned(stmt));
        }
        for body in node.bodies() {
            body.iter().for_each(|node| self.temps_of(node, found));
        }
    }

    /// The temporaries that an expression reads.
    pub(crate) fn temps_read(&self, id: ExprId, found: &mut BTreeSet<TempId>) {
        let expr = self.module.expr(id);
        if let Expr::Temp(temp) = *expr {
            found.insert(temp);
        }
        operands(expr).for_each(|operand| self.temps_read(operand, found));
    }

    /// Returns true if a temporary is in lanes.
    pub fn in_lanes(&self, temp: TempId) -> bool {
        !self.single.contains(&temp)
    }

    /// Returns true if a node runs on whole lanes, or its inside may.
    fn slices(&self, node: &Node) -> bool {
        match node {
            Node::Stmt(stmt) => self.slices_stmt(stmt),
            Node::If { cond, .. } => self.slices_expr(*cond),
            Node::Repeat(stations) => stations.body.iter().all(|node| self.slices_in_loop(node)),
            Node::Steps { .. } => true,
            Node::Outlined(function) => !self.is_left_early(*function),
            Node::For { .. } | Node::Parts { .. } => false,
        }
    }

    /// In a loop over stations the whole body does, or none of it.
    fn slices_in_loop(&self, node: &Node) -> bool {
        let coil = matches!(
            node,
            Node::Stmt(Stmt::Do(
                Action::Timer(_)
                    | Action::Counter16(_)
                    | Action::Counter32(_)
                    | Action::Reset { .. }
            ))
        );
        !coil
            && self.slices(node)
            && node
                .bodies()
                .flatten()
                .all(|node| self.slices_in_loop(node))
    }

    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "what is not known to run on whole lanes runs on each lane"
    )]
    fn slices_stmt(&self, stmt: &Stmt) -> bool {
        let Stmt::Do(action) = stmt else {
            return matches!(stmt, Stmt::Network(_));
        };
        match action {
            Action::Let(temp, value) => self.in_lanes(*temp) && self.slices_expr(*value),
            Action::Edge(edge) => self.in_lanes(edge.out) && self.slices_expr(edge.input),
            Action::SetFlag(_, value) => self.slices_expr(*value),
            Action::Write(access, value) => {
                access.kind == AccessKind::Bit
                    && !matches!(access.place.class, DeviceClass::T | DeviceClass::C)
                    && self.has_lanes(access.place)
                    && self.slices_expr(*value)
            }
            Action::Timer(coil) => self.slices_expr(coil.drive) && self.is_single(coil.preset),
            Action::Counter16(coil) => self.slices_expr(coil.drive) && self.is_single(coil.preset),
            Action::Counter32(coil) => {
                self.slices_expr(coil.drive)
                    && self.slices_expr(coil.down)
                    && self.is_single(coil.preset)
            }
            Action::Reset { place, .. } => place.index.is_none(),
            _ => false,
        }
    }

    /// Returns true if the lanes of a place are known where it is named.
    fn has_lanes(&self, place: Place) -> bool {
        match place.index.map(|index| self.module.expr(index)) {
            None => true,
            Some(Expr::Stride(_, by)) => {
                let device = (place.class, place.number);
                self.fields
                    .access_iteration(&mut String::new(), device, *by, "i")
            }
            Some(_) => false,
        }
    }

    /// Returns true if a bit is made of bits in lanes, and of comparisons that each instance can make.
    pub(crate) fn slices_expr(&self, id: ExprId) -> bool {
        let expr = *self.module.expr(id);
        if let Expr::Temp(temp) = expr {
            return self.in_lanes(temp);
        }
        let is_gate = matches!(expr, Expr::Not(_) | Expr::And(..) | Expr::Or(..));
        if is_gate {
            return operands(&expr).all(|operand| self.slices_expr(operand));
        }
        self.is_lanes(id) || self.is_single(id)
    }

    /// Returns true if a bit by itself is in lanes, or the same in all.
    pub(crate) fn is_lanes(&self, id: ExprId) -> bool {
        let expr = self.module.expr(id);
        let known = matches!(
            expr,
            Expr::Bit(_) | Expr::Flag(_) | Expr::Sys(SysValue::Running | SysValue::FirstScan)
        );
        known || expr.as_bit().is_some_and(|place| self.has_lanes(place))
    }

    /// Returns true if an expression reads nothing that is in lanes, so that each instance has all of it.
    fn is_single(&self, id: ExprId) -> bool {
        let mut temps = BTreeSet::new();
        self.temps_read(id, &mut temps);
        let mut meeting = self.meeting();
        meeting.expr(id);
        let met = meeting.met;
        let bits = met
            .devices
            .iter()
            .any(|(class, _)| !matches!(class, DeviceClass::T | DeviceClass::C));
        temps.is_empty() && !bits && met.flags.is_empty() && !self.has_stride(id)
    }

    fn has_stride(&self, id: ExprId) -> bool {
        let expr = self.module.expr(id);
        matches!(expr, Expr::Stride(..)) || operands(expr).any(|operand| self.has_stride(operand))
    }

    /// Returns true if all instances have the same value: it is made of constants and of values of the scan driver.
    pub(crate) fn is_uniform(&self, id: ExprId) -> bool {
        let expr = self.module.expr(id);
        let own = matches!(
            expr,
            Expr::Read(_) | Expr::Temp(_) | Expr::Cell(_) | Expr::Entry(..) | Expr::Flag(_)
        );
        let found = matches!(expr, Expr::InRange { place, .. } if place.index.is_some());
        !own && !found && operands(expr).all(|operand| self.is_uniform(operand))
    }
}
