//! Probes of a scan for the search for events that can never happen in it.

use super::Encoder;
use crate::aig::Lit;
use rungc_ir::node::{Access, AccessKind, Action, Expr, ExprId, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::CmpOp;
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// Writes of a bit device.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    /// The network that writes it first, by number.
    pub network: u32,
    /// It is switched on somewhere in the scan.
    pub on: Lit,
    /// It is switched off somewhere in the scan.
    pub off: Lit,
    /// Every scan writes it, whatever happens in it.
    pub always: bool,
}

/// Execution of a timer.
#[derive(Clone, Copy, Debug)]
pub struct Expiry {
    /// The network that drives it first, by number.
    pub network: u32,
    /// Its coil is on.
    pub driven: Lit,
    /// Its contact is closed by its coil.
    pub expires: Lit,
}

/// Effects of a network.
#[derive(Clone, Copy, Debug)]
pub struct Rung {
    /// The scan comes to it.
    pub reached: Lit,
    /// An instruction in it, other than a coil, is executed; `None`: it has no such instruction. The coil of a counter
    /// may count as one.
    pub acts: Option<Lit>,
}

/// A comparison.
#[derive(Clone, Copy, Debug)]
pub struct Compared {
    /// The network that it is in, by number.
    pub network: u32,
    /// Relation between the numbers.
    pub op: CmpOp,
    /// The numbers.
    pub sides: [ExprId; 2],
    /// Its result.
    pub holds: Lit,
}

/// All that is noted of a scan.
#[derive(Clone, Debug, Default)]
pub struct Probes {
    /// Bits Y, M and S.
    pub bits: BTreeMap<(DeviceClass, u32), Written>,
    /// Timers by number.
    pub timers: BTreeMap<u32, Expiry>,
    /// Networks by number.
    pub rungs: BTreeMap<u32, Rung>,
    /// Comparisons, each as often as it is evaluated.
    pub comparisons: Vec<Compared>,
}

impl Encoder<'_> {
    /// The network that is being executed, if anything is noted.
    fn noted(&self) -> Option<u32> {
        self.network.filter(|_| self.probes.is_some())
    }

    /// Notes that a bit is written.
    pub(super) fn note_bit(&mut self, device: (DeviceClass, u32), value: Lit, guard: Lit) {
        let Some(network) = self.noted() else {
            return;
        };
        let (on, off) = (self.aig.and(guard, value), self.aig.and(guard, !value));
        let Some(probes) = &mut self.probes else {
            return;
        };
        let known = probes.bits.entry(device).or_insert(Written {
            network,
            on: Lit::FALSE,
            off: Lit::FALSE,
            always: false,
        });
        known.always |= guard == Lit::TRUE;
        known.on = self.aig.or(known.on, on);
        known.off = self.aig.or(known.off, off);
    }

    /// Notes that a timer's coil is on under a condition, and under which its contact closes.
    pub(super) fn note_timer(&mut self, number: u32, driven: Lit, expires: Lit) {
        let Some(network) = self.noted() else {
            return;
        };
        let Some(probes) = &mut self.probes else {
            return;
        };
        let known = probes.timers.entry(number).or_insert(Expiry {
            network,
            driven: Lit::FALSE,
            expires: Lit::FALSE,
        });
        known.driven = self.aig.or(known.driven, driven);
        known.expires = self.aig.or(known.expires, expires);
    }

    /// Notes that a scan comes to a statement.
    pub(super) fn note_stmt(&mut self, stmt: &Stmt, guard: Lit) {
        let Some(network) = self.noted() else {
            return;
        };
        let acts = match stmt {
            Stmt::Do(Action::Write(access, value)) => {
                // OUT writes its bit whenever the scan comes to it, SET and RST a constant under their contacts.
                let constant = matches!(self.module.expr(*value), Expr::Bit(_));
                if access.kind == AccessKind::Bit && !constant {
                    return;
                }
                true
            }
            Stmt::Do(
                Action::Block(_)
                | Action::Call(_)
                | Action::Send(_)
                | Action::Fetch(_)
                | Action::Reset { .. },
            )
            | Stmt::CallSub(_) => true,
            Stmt::Network(_) => false,
            _ => return,
        };
        let Some(probes) = &mut self.probes else {
            return;
        };
        let rung = probes.rungs.entry(network).or_insert(Rung {
            reached: Lit::FALSE,
            acts: None,
        });
        match acts {
            true => rung.acts = Some(self.aig.or(rung.acts.unwrap_or(Lit::FALSE), guard)),
            false => rung.reached = self.aig.or(rung.reached, guard),
        }
    }

    /// Notes statements of the network at hand whose condition is never on.
    pub(super) fn note_dead(&mut self, body: &[Stmt]) {
        if self.noted().is_none() {
            return;
        }
        let mut is_here = true;
        let mut dead = Vec::new();
        statements(body, &mut |stmt| {
            is_here &= !matches!(stmt, Stmt::Network(_));
            dead.extend(is_here.then_some(stmt));
        });
        for stmt in dead {
            self.note_stmt(stmt, Lit::FALSE);
            if let Stmt::Do(Action::Write(Access { place, kind }, _)) = stmt
                && (*kind, place.index) == (AccessKind::Bit, None)
                && matches!(
                    place.class,
                    DeviceClass::Y | DeviceClass::M | DeviceClass::S
                )
            {
                self.note_bit((place.class, place.number), Lit::FALSE, Lit::FALSE);
            }
        }
    }

    /// Notes a comparison.
    pub(super) fn note_comparison(&mut self, op: CmpOp, sides: [ExprId; 2], holds: Lit) {
        if let (Some(network), Some(probes)) = (self.noted(), &mut self.probes) {
            probes.comparisons.push(Compared {
                network,
                op,
                sides,
                holds,
            });
        }
    }
}
