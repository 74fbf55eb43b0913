//! The step ladder.
//!
//! A state's block runs while the state is on, and once more, with its bus off, when it has gone off. A transition
//! turns the target on and marks the states it leaves; each is turned off where its block begins in the next scan, so
//! that source and target are both on for one scan (h1u-h2u-programming §4.2). The mark is an edge memory of the state.

use super::operand::fixed;
use super::step_groups::Guards;
use super::{Lowerer, basic_of};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::node::{Access, EdgeId, Expr};
use rungc_rt::EdgeKind;
use rungc_rt::special::M_TRANSFER_OFF;
use rungc_syntax::{Device, DeviceClass};
use rustc_hash::{FxHashMap, FxHashSet};

/// Annunciators: S devices that are not states.
pub(super) const ANNUNCIATORS: std::ops::RangeInclusive<u32> = 900..=999;

/// The step ladder of a program.
pub(super) struct Steps {
    /// States that a block leaves by a transition.
    left: FxHashSet<u32>,
    /// True for each STL that continues a row of STLs.
    pub(super) continues_row: Vec<bool>,
    /// Marks of the states that are left.
    marks: FxHashMap<u32, EdgeId>,
    /// States whose first block has come.
    begun: FxHashSet<u32>,
    /// The states of the block at hand; none outside.
    current: Vec<u32>,
    /// Tests that leave blocks out.
    pub(super) guards: Guards,
}

/// The S device that an instruction names first.
fn state(resolved: &Resolved, i: usize) -> Option<u32> {
    let operand = resolved.program.instrs.get(i)?.operands.first()?;
    let device = operand.kind.device()?;
    (device.class == DeviceClass::S).then_some(device.number)
}

impl Steps {
    pub(super) fn of(resolved: &Resolved) -> Self {
        let count = resolved.instrs.len();
        let mut steps = Steps {
            left: FxHashSet::default(),
            continues_row: vec![false; count],
            marks: FxHashMap::default(),
            begun: FxHashSet::default(),
            current: Vec::new(),
            guards: Guards::default(),
        };
        let mut row: Vec<u32> = Vec::new();
        let mut in_row = false;
        for i in 0..count {
            let basic = basic_of(resolved, i);
            match basic {
                Some(Basic::Nop) => continue,
                Some(Basic::Stl) => {
                    steps.continues_row[i] = in_row;
                    if !in_row {
                        row.clear();
                    }
                    row.extend(state(resolved, i));
                }
                Some(Basic::Ret) => row.clear(),
                Some(Basic::Set | Basic::Out) => {
                    let target = state(resolved, i).filter(|n| !ANNUNCIATORS.contains(n));
                    if let Some(target) = target {
                        steps.left.extend(row.iter().filter(|&&s| s != target));
                    }
                }
                _ => {}
            }
            in_row = basic == Some(Basic::Stl);
        }
        steps
    }

    /// Returns true if a block leaves a state by a transition.
    pub(super) fn is_left(&self, state: u32) -> bool {
        self.left.contains(&state)
    }

    /// Sets the mark of a state.
    pub(super) fn set_mark(&mut self, state: u32, mark: EdgeId) {
        self.marks.insert(state, mark);
    }
}

impl Lowerer<'_> {
    /// STL, with the STLs that follow it directly.
    pub(super) fn begin_state(&mut self) {
        if self.steps.continues_row[self.at] {
            return;
        }
        self.close_state();
        let mut states = Vec::new();
        let mut i = self.at;
        loop {
            match self.basic_at(i) {
                Some(Basic::Stl) => states.extend(state(self.resolved, i)),
                Some(Basic::Nop) => {}
                _ => break,
            }
            i += 1;
        }
        self.open_tests();
        for &state in &states {
            self.leave_if_marked(state);
        }
        let on = states
            .iter()
            .map(|&state| self.add(Expr::Read(Access::bit(fixed(DeviceClass::S, state)))))
            .collect::<Vec<_>>()
            .into_iter()
            .reduce(|a, b| self.and(a, b));
        let Some(on) = on else {
            return;
        };
        let bus = self.settled(on);
        let was_on = self.was_on();
        let left = self.edge(was_on, EdgeKind::Falling, bus);
        let runs = self.or(bus, left);
        self.open_state(runs);
        self.logic.bus = Some(bus);
        self.steps.current = states;
    }

    /// Turns a state off that a transition left in the scan before. It may have several blocks (a merge of branches has
    /// its own one): the first decides.
    fn leave_if_marked(&mut self, state: u32) {
        let may_be_left = self.steps.is_left(state) || self.steps.marks.contains_key(&state);
        if !self.steps.begun.insert(state) || !may_be_left {
            return;
        }
        let mark = self.mark(state);
        let off = self.bit_const(false);
        let marked = self.edge(mark, EdgeKind::Falling, off);
        self.when(marked, |this| this.write_device(DeviceClass::S, state, off));
    }

    fn mark(&mut self, state: u32) -> EdgeId {
        match self.steps.marks.get(&state) {
            Some(&mark) => mark,
            None => {
                let mark = self.new_edge();
                self.steps.marks.insert(state, mark);
                mark
            }
        }
    }

    /// STL, RET or the end of the function: ends the block at hand.
    pub(super) fn close_state(&mut self) {
        self.close_open_state();
        self.close_tests();
        if !self.steps.current.is_empty() {
            self.steps.current.clear();
            self.logic.bus = None;
            self.logic.stack.clear();
        }
    }

    /// Returns true if SET or OUT of a device is a transition here.
    pub(super) fn is_transition(&self, device: Device) -> bool {
        device.class == DeviceClass::S
            && !self.steps.current.is_empty()
            && !ANNUNCIATORS.contains(&device.number)
    }

    /// SET or OUT of a state in a block.
    pub(super) fn transition(&mut self, target: u32) {
        let mut drive = self.drive_of_form();
        if self.keeps(M_TRANSFER_OFF) {
            let held = self.add(Expr::Read(Access::bit(M_TRANSFER_OFF)));
            let free = self.not(held);
            drive = self.and(drive, free);
        }
        self.when(drive, |this| {
            let on = this.bit_const(true);
            this.write_device(DeviceClass::S, target, on);
            this.keep_state(Device {
                class: DeviceClass::S,
                number: target,
            });
            for state in this.steps.current.clone() {
                if state != target {
                    let mark = this.mark(state);
                    this.edge(mark, EdgeKind::Rising, on);
                }
            }
        });
    }

    /// A state that is set again is not left.
    pub(super) fn keep_state(&mut self, device: Device) {
        if device.class == DeviceClass::S && self.steps.is_left(device.number) {
            let mark = self.mark(device.number);
            let off = self.bit_const(false);
            self.edge(mark, EdgeKind::Rising, off);
        }
    }
}
