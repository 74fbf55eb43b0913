//! Memories of timers.

use crate::plan::{Node, Plan};
use crate::storage::Storage;
use rungc_ir::Module;
use rungc_ir::node::{Action, Expr, ExprId, IndexedCoil, Stmt, TimerCoil};
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;

/// The coils of the timers.
pub struct Coils {
    /// By number: how many coils a timer has; one whose preset may change counts twice.
    coils: FxHashMap<u32, u32>,
}

impl Coils {
    /// Counts them.
    pub fn of(module: &Module, plan: &Plan, storage: &Storage) -> Self {
        let mut coils = Coils {
            coils: FxHashMap::default(),
        };
        for function in &plan.functions {
            coils.count(module, storage, &function.body, 1);
        }
        coils
    }

    /// The behaviour of a timer's coil. It need not remember the preset with which it began if only one coil names a
    /// constant.
    pub fn kind(&self, number: u32, kind: TimerKind) -> TimerKind {
        TimerKind {
            latches_preset: kind.latches_preset && self.coils.get(&number) != Some(&1),
            ..kind
        }
    }

    /// The same for a coil that runs the timers of all iterations of a loop.
    pub fn kind_of_iterations(
        &self,
        first: u32,
        by: u32,
        iterations: u32,
        kind: TimerKind,
    ) -> TimerKind {
        let numbers = (0..iterations).map(|n| first + n * by);
        let mut kinds = numbers.map(|number| self.kind(number, kind));
        TimerKind {
            latches_preset: kinds.any(|kind| kind.latches_preset),
            ..kind
        }
    }

    fn count(&mut self, module: &Module, storage: &Storage, nodes: &[Node], iterations: u32) {
        for node in nodes {
            match node {
                Node::Stmt(Stmt::Do(Action::Timer(TimerCoil { number, preset, .. }))) => {
                    *self.coils.entry(*number).or_default() += weight(module, *preset);
                }
                Node::Stmt(Stmt::Do(Action::TimerAt(IndexedCoil { place, preset, .. }))) => {
                    match place.index.map(|index| module.expr(index)) {
                        Some(&Expr::Stride(_, by)) => {
                            for n in 0..iterations {
                                let coils = self.coils.entry(place.number + n * by).or_default();
                                *coils += weight(module, *preset);
                            }
                        }
                        // An index may lead to any of them.
                        Some(_) | None => {
                            let fields = storage.of_class(DeviceClass::T).iter();
                            let numbers = fields.flat_map(|field| field.first..field.end());
                            self.coils.extend(numbers.map(|number| (number, 2)));
                        }
                    }
                }
                Node::Stmt(_)
                | Node::If { .. }
                | Node::For { .. }
                | Node::Repeat(_)
                | Node::Steps { .. }
                | Node::Parts { .. }
                | Node::Outlined(_) => {}
            }
            let iterations = match node {
                Node::Repeat(stations) => stations.count,
                Node::Stmt(_)
                | Node::If { .. }
                | Node::For { .. }
                | Node::Steps { .. }
                | Node::Parts { .. }
                | Node::Outlined(_) => iterations,
            };
            for body in node.bodies() {
                self.count(module, storage, body, iterations);
            }
        }
    }
}

/// As how many a coil with this preset counts.
fn weight(module: &Module, preset: ExprId) -> u32 {
    if matches!(module.expr(preset), Expr::I16(_)) {
        1
    } else {
        2
    }
}
