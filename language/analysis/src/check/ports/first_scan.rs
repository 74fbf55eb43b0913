//! Instructions that are certain to be executed in the first scan.

use super::super::calls::Order;
use super::super::drives::Drives;
use super::super::pointers::Pointers;
use super::super::skips::Skips;
use super::super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass};
use std::collections::BTreeMap;

/// Calls nest less deep on all models.
const MAX_DEPTH: usize = 16;

/// Execution of an instruction in the first scan.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct First {
    /// Its place in the scan, if the scan is certain to execute it.
    pub(super) order: Option<Order>,
    /// The only contact on which that depends, and true if it is normally open.
    pub(super) contact: Option<(Device, bool)>,
}

/// The execution of all instructions of a program in the first scan.
pub(super) fn first_scan(code: &Code) -> Vec<First> {
    let pointers = Pointers::new(code);
    let skips = Skips::new(code, &pointers);
    let mut called = BTreeMap::new();
    let mut found = Vec::new();
    for _ in 0..MAX_DEPTH {
        found = pass(code, &skips, &called);
        let calls = (0..code.len).filter(|&i| code.basic(i) == Some(Basic::Call));
        let mut places: BTreeMap<usize, Order> = BTreeMap::new();
        for i in calls {
            let pointer = code.device(i, 0).and_then(|device| pointers.get(device));
            let label = pointer.and_then(|pointer| pointer.labels.first());
            // The last of several calls decides.
            if let (Some(&label), Some(order)) = (label, &found[i].order) {
                let known = places.entry(label).or_default();
                *known = order.clone().max(known.clone());
            }
        }
        if places == called {
            break;
        }
        called = places;
    }
    found
}

/// The same with the subroutines that are known to be called.
fn pass(code: &Code, skips: &Skips, called: &BTreeMap<usize, Order>) -> Vec<First> {
    let mut when = When::new(skips, called);
    let mut drives = Drives::default();
    let instrs = (0..code.len).map(|i| {
        let drive = drives.next(code, i);
        let order = when.next(code, i);
        let plain = when.routine.is_some() && skips.mark(i) == 0;
        let contact = drive.and_then(|drive| drive.contact);
        First {
            order,
            contact: contact.filter(|_| plain),
        }
    });
    instrs.collect()
}

/// Decision whether instructions are certain to be executed in the first scan.
struct When<'a> {
    skips: &'a Skips,
    /// Places of the subroutines that are called in the first scan, by their labels.
    called: &'a BTreeMap<usize, Order>,
    stack: Vec<bool>,
    branches: Vec<bool>,
    /// Place of the routine in the scan; `None` in states, and in routines that need not run.
    routine: Option<Order>,
    /// True after the main program.
    after_main: bool,
    /// Open master controls: the level of each, and true if its zone runs in the first scan.
    zones: Vec<(u32, bool)>,
}

impl<'a> When<'a> {
    fn new(skips: &'a Skips, called: &'a BTreeMap<usize, Order>) -> Self {
        When {
            skips,
            called,
            stack: Vec::new(),
            branches: Vec::new(),
            routine: Some(Order::new()),
            after_main: false,
            zones: Vec::new(),
        }
    }

    /// Takes instruction `i`, the next of the program; its place in the first scan, if that executes it.
    fn next(&mut self, code: &Code, i: usize) -> Option<Order> {
        let top = self.stack.last().copied().unwrap_or(true);
        match code.part(i) {
            Part::Start => self.stack.push(is_on_first(code, i)),
            Part::Continue => {
                let result = match code.basic(i) {
                    Some(Basic::And | Basic::Ani) => top && is_on_first(code, i),
                    Some(Basic::Or | Basic::Ori) => top || is_on_first(code, i),
                    _ => false,
                };
                self.replace(result);
            }
            part @ (Part::JoinSeries | Part::JoinParallel) => {
                self.stack.pop();
                let left = self.stack.last().copied().unwrap_or(true);
                self.replace(match part {
                    Part::JoinSeries => left && top,
                    _ => left || top,
                });
            }
            Part::Push => self.branches.push(top),
            Part::Read => {
                let branch = self.branches.last().copied().unwrap_or(true);
                self.replace(branch);
            }
            Part::Pop => {
                let branch = self.branches.pop().unwrap_or(true);
                self.replace(branch);
            }
            Part::Alone | Part::Unknown => {
                self.stack.clear();
                self.branches.clear();
            }
            Part::Output | Part::Nothing => {}
        }
        let runs = top && self.zones.iter().all(|&(_, runs)| runs);
        self.follow(code, i, runs);
        let mut order = self
            .routine
            .clone()
            .filter(|_| runs && self.skips.mark(i) == 0)?;
        order.push(i as u32);
        Some(order)
    }

    /// Follows the structure of the program through instruction `i`, which runs or not.
    fn follow(&mut self, code: &Code, i: usize, runs: bool) {
        let level = || code.device(i, 0).map_or(0, |level| level.number);
        match code.basic(i) {
            Some(Basic::Label) if self.after_main => {
                if let Some(place) = self.called.get(&i) {
                    self.routine = Some(place.clone());
                }
            }
            Some(Basic::Fend | Basic::End | Basic::Sret | Basic::Iret) => {
                self.after_main = true;
                self.routine = None;
                self.zones.clear();
            }
            Some(Basic::Stl) => self.routine = None,
            Some(Basic::Ret) if !self.after_main => self.routine = Some(Order::new()),
            Some(Basic::Mc) => self.zones.push((level(), runs)),
            Some(Basic::Mcr) => self.zones.retain(|&(open, _)| open < level()),
            _ => {}
        }
    }

    fn replace(&mut self, result: bool) {
        self.stack.pop();
        self.stack.push(result);
    }
}

/// Returns true if a contact is on in the first scan.
fn is_on_first(code: &Code, i: usize) -> bool {
    let Some(device) = code
        .device(i, 0)
        .filter(|device| device.class == DeviceClass::M)
    else {
        return false;
    };
    match code.basic(i) {
        Some(Basic::Ld | Basic::And | Basic::Or | Basic::Ldp) => {
            matches!(device.number, 8000 | 8002)
        }
        Some(Basic::Ldi | Basic::Ani | Basic::Ori) => matches!(device.number, 8001 | 8003),
        _ => false,
    }
}
