//! Program flow: which instructions belong to which function, jumps, calls, loops.

use super::operand::Guards;
use super::parts::{Item, Jump, structure};
use super::{Lowerer, basic_of};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::node::{
    Action, BinOp, Body, Branch, CellId, Expr, ExprId, FunctionKind, Steps, Stmt, TempId,
};
use rungc_rt::CmpOp;
use rungc_syntax::{DeviceClass, Index, OperandKind, codes};
use rustc_hash::{FxHashMap, FxHashSet};

/// A jump leads nowhere.
const NO_LABEL: u16 = 6701;
/// CALL nested too deep.
const CALL_DEPTH: u16 = 6702;

/// Instructions `start..end` that are a function (the main program without those of the routines in it).
#[derive(Clone, Debug)]
pub(super) struct Region {
    pub(super) kind: FunctionKind,
    /// Its index in [`rungc_ir::node::Module::functions`].
    pub(super) function: u32,
    start: usize,
    end: usize,
    /// The subroutine that it falls through into, if a return is missing.
    runs_into: Option<u32>,
}

/// An interrupt routine.
pub(super) struct Routine {
    /// Its pointer's number.
    pub(super) number: u32,
    /// Its index in [`rungc_ir::node::Module::functions`].
    pub(super) function: u32,
    /// Its pointer's instruction.
    pub(super) start: usize,
}

/// Boundaries of functions, and the targets of jumps.
pub(super) struct Flow {
    /// The main program first.
    pub(super) regions: Vec<Region>,
    /// Region of each subroutine, by pointer.
    subroutines: FxHashMap<u32, usize>,
    /// Calls that would be recursive: (region of the call, region called).
    recursive: FxHashSet<(usize, usize)>,
    /// Number of open calls, if they may nest deeper than the model allows.
    open_calls: Option<CellId>,
    /// Pointers that a jump goes to.
    jumped_to: FxHashSet<u32>,
    /// The pointers in the current function.
    labels: Vec<u32>,
    /// The region at hand.
    current: usize,
    /// Assignments at the start of the current function.
    prologue: Vec<(TempId, ExprId)>,
    /// True if the current instruction is unreachable.
    dead: bool,
}

/// A body whose end has not come.
pub(super) enum Open {
    /// FOR.
    Loop { count: ExprId, outer: Vec<Item> },
    /// STL.
    State { cond: ExprId, outer: Vec<Item> },
    /// Blocks that are left out while they are off.
    Steps { steps: Steps, outer: Vec<Item> },
}

impl Flow {
    pub(super) fn of(resolved: &Resolved) -> Self {
        let count = resolved.instrs.len();
        let end = (0..count)
            .find(|&i| basic_of(resolved, i) == Some(Basic::End))
            .unwrap_or(count);
        let pointers = |basic: Basic| -> FxHashSet<u32> {
            (0..count)
                .filter(|&i| basic_of(resolved, i) == Some(basic))
                .filter_map(|i| pointer(resolved, i))
                .collect()
        };
        let indexed = |basic: Basic| {
            (0..count).any(|i| {
                basic_of(resolved, i) == Some(basic) && pointer_index(resolved, i).is_some()
            })
        };
        let labels_from = |first: usize| {
            let labels = resolved.instrs[first..]
                .iter()
                .filter_map(|instr| instr.label);
            labels
                .filter(|label| label.class == DeviceClass::P)
                .map(|label| label.number)
        };
        let (mut called, mut jumped_to) = (pointers(Basic::Call), pointers(Basic::Cj));
        // An index may lead to any label; those that are called come after FEND.
        if indexed(Basic::Call) {
            let fend = (0..count).find(|&i| basic_of(resolved, i) == Some(Basic::Fend));
            let subroutines = labels_from(fend.unwrap_or(count));
            called.extend(subroutines.filter(|label| !jumped_to.contains(label)));
        }
        if indexed(Basic::Cj) {
            jumped_to.extend(labels_from(0));
        }
        let mut flow = Flow {
            regions: vec![Region {
                kind: FunctionKind::Main,
                function: 1,
                start: 0,
                end,
                runs_into: None,
            }],
            subroutines: FxHashMap::default(),
            recursive: FxHashSet::default(),
            open_calls: None,
            jumped_to,
            labels: Vec::new(),
            current: 0,
            prologue: Vec::new(),
            dead: false,
        };
        let routine = |i: usize| -> Option<FunctionKind> {
            let label = resolved.instrs[i].label?;
            if label.class == DeviceClass::I {
                return Some(FunctionKind::Interrupt(label.number));
            }
            let subroutine = label.class == DeviceClass::P && called.contains(&label.number);
            subroutine.then_some(FunctionKind::Subroutine(label.number))
        };
        let mut i = 0;
        while i < end {
            match routine(i) {
                Some(kind) => i = flow.add_routine(resolved, kind, i, end, &routine),
                None => i += 1,
            }
        }
        flow.find_recursion(resolved);
        flow
    }

    /// Returns true if an instruction is part of an interrupt routine.
    pub(super) fn is_interrupt(&self, i: usize) -> bool {
        self.regions.iter().any(|region| {
            matches!(region.kind, FunctionKind::Interrupt(_))
                && (region.start..region.end).contains(&i)
        })
    }

    /// Returns true if there are coils that not every scan executes: routines or jumps.
    pub(super) fn skips(&self) -> bool {
        self.regions.len() > 1 || !self.jumped_to.is_empty()
    }

    /// Adds the routine that begins at `start`; where it ends.
    fn add_routine(
        &mut self,
        resolved: &Resolved,
        kind: FunctionKind,
        start: usize,
        last: usize,
        routine: &impl Fn(usize) -> Option<FunctionKind>,
    ) -> usize {
        let limit = (start + 1..last)
            .find(|&i| routine(i).is_some())
            .unwrap_or(last);
        let mut labels = FxHashMap::default();
        for i in start + 1..limit {
            if let Some(label) = resolved.instrs[i].label {
                labels.insert(label.number, i);
            }
        }
        // A return that a jump passes over is not the last one.
        let mut reach = 0;
        let mut end = limit;
        for i in start..limit {
            match basic_of(resolved, i) {
                Some(Basic::Cj) => {
                    let target = pointer(resolved, i).and_then(|p| labels.get(&p));
                    reach = reach.max(target.copied().unwrap_or(0));
                }
                Some(Basic::Sret | Basic::Iret | Basic::Pret) if reach <= i => {
                    end = i + 1;
                    break;
                }
                _ => {}
            }
        }
        let returns = end > start
            && matches!(
                basic_of(resolved, end - 1),
                Some(Basic::Sret | Basic::Iret | Basic::Pret | Basic::Fend)
            );
        let next = if returns || end >= last {
            None
        } else {
            routine(end)
        };
        let runs_into = match next {
            Some(FunctionKind::Subroutine(pointer)) => Some(pointer),
            _ => None,
        };
        if let FunctionKind::Subroutine(pointer) = kind {
            self.subroutines
                .entry(pointer)
                .or_insert(self.regions.len());
        }
        self.regions.push(Region {
            kind,
            function: self.regions.len() as u32 + 2,
            start,
            end,
            runs_into,
        });
        end
    }

    /// The interrupt routines.
    pub(super) fn interrupts(&self) -> Vec<Routine> {
        let routine = |region: &Region| match region.kind {
            FunctionKind::Interrupt(number) => Some(Routine {
                number,
                function: region.function,
                start: region.start,
            }),
            FunctionKind::Main
            | FunctionKind::Begin
            | FunctionKind::End
            | FunctionKind::Subroutine(_)
            | FunctionKind::TakeInterrupts
            | FunctionKind::InputEdge { .. }
            | FunctionKind::Signals => None,
        };
        self.regions.iter().filter_map(routine).collect()
    }

    /// The function at hand.
    pub(super) fn function(&self) -> u32 {
        self.regions[self.current].function
    }

    /// Returns true if the current function is the main program.
    pub(super) fn in_main(&self) -> bool {
        self.current == 0
    }

    /// Finds the calls that lead back to a subroutine that is running: depth first over the calls.
    fn find_recursion(&mut self, resolved: &Resolved) {
        let calls: Vec<Vec<usize>> = self
            .regions
            .iter()
            .map(|r| self.calls(resolved, r))
            .collect();
        #[derive(Clone, Copy, PartialEq)]
        enum Seen {
            Not,
            Running,
            Done,
        }
        let mut seen = vec![Seen::Not; calls.len()];
        for root in 0..calls.len() {
            let mut stack = vec![(root, 0)];
            while let Some((region, next)) = stack.pop() {
                if next == 0 && seen[region] == Seen::Done {
                    continue;
                }
                seen[region] = Seen::Running;
                let Some(&callee) = calls[region].get(next) else {
                    seen[region] = Seen::Done;
                    continue;
                };
                stack.push((region, next + 1));
                match seen[callee] {
                    Seen::Not => stack.push((callee, 0)),
                    Seen::Running => {
                        self.recursive.insert((region, callee));
                    }
                    Seen::Done => {}
                }
            }
        }
    }

    /// Depth of nested calls: the longest chain of calls that begins in each region.
    fn depths(&self, resolved: &Resolved) -> Vec<u32> {
        let mut calls: Vec<Vec<usize>> = Vec::with_capacity(self.regions.len());
        for (i, region) in self.regions.iter().enumerate() {
            let mut made = self.calls(resolved, region);
            made.retain(|&callee| !self.recursive.contains(&(i, callee)));
            calls.push(made);
        }
        let mut depths = vec![0; calls.len()];
        // Knowledge spreads by a level of calls in each round; without recursive calls it converges.
        loop {
            let next: Vec<u32> = calls
                .iter()
                .map(|made| {
                    made.iter()
                        .map(|&callee| depths[callee] + 1)
                        .max()
                        .unwrap_or(0)
                })
                .collect();
            if next == depths {
                return depths;
            }
            depths = next;
        }
    }

    /// The regions that a region calls.
    fn calls(&self, resolved: &Resolved, region: &Region) -> Vec<usize> {
        let mut calls: Vec<usize> = self
            .instructions(region)
            .filter(|&i| basic_of(resolved, i) == Some(Basic::Call))
            .flat_map(|i| match pointer_index(resolved, i) {
                Some(_) => self.subroutines.keys().copied().collect(),
                None => Vec::from_iter(pointer(resolved, i)),
            })
            .chain(region.runs_into)
            .filter_map(|pointer| self.subroutines.get(&pointer).copied())
            .collect();
        calls.sort();
        calls.dedup();
        calls
    }

    /// The instructions of a region.
    fn instructions(&self, region: &Region) -> impl Iterator<Item = usize> + use<> {
        let routines: Vec<(usize, usize)> = match region.kind {
            FunctionKind::Main => self.regions[1..].iter().map(|r| (r.start, r.end)).collect(),
            FunctionKind::Begin
            | FunctionKind::End
            | FunctionKind::Subroutine(_)
            | FunctionKind::Interrupt(_)
            | FunctionKind::TakeInterrupts
            | FunctionKind::InputEdge { .. }
            | FunctionKind::Signals => Vec::new(),
        };
        let mut routines = routines.into_iter().peekable();
        (region.start..region.end).filter(move |&i| {
            while routines.next_if(|&(_, end)| end <= i).is_some() {}
            routines.peek().is_none_or(|&(start, _)| i < start)
        })
    }
}

/// The pointer that CJ or CALL names.
fn pointer(resolved: &Resolved, i: usize) -> Option<u32> {
    match resolved.program.instrs.get(i)?.operands.first()?.kind {
        OperandKind::Device(device, _) => Some(device.number),
        OperandKind::WordBit(..)
        | OperandKind::Nibbles(..)
        | OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => None,
    }
}

/// The index of the pointer that CJ or CALL names.
fn pointer_index(resolved: &Resolved, i: usize) -> Option<Index> {
    match resolved.program.instrs.get(i)?.operands.first()?.kind {
        OperandKind::Device(_, index) => index,
        OperandKind::WordBit(..)
        | OperandKind::Nibbles(..)
        | OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => None,
    }
}

impl Lowerer<'_> {
    /// Counts open calls if they may nest deeper than the model allows.
    pub(super) fn limit_calls(&mut self) {
        let depths = self.flow.depths(self.resolved);
        if depths.into_iter().any(|depth| depth > self.model.max_call) {
            let cell = self.cell("open_calls".to_string(), "how deep calls are nested");
            self.flow.open_calls = Some(cell);
        }
    }

    /// Lowers a function.
    pub(super) fn region(&mut self, index: usize) -> Body {
        let region = self.flow.regions[index].clone();
        self.flow.current = index;
        self.flow.dead = false;
        self.logic.clear();
        self.flow.labels = self
            .flow
            .instructions(&region)
            .filter_map(|i| self.resolved.instrs[i].label)
            .filter(|label| label.class == DeviceClass::P)
            .map(|label| label.number)
            .collect();
        for i in self.flow.instructions(&region) {
            self.at = i;
            if self.flow.dead && !self.revives() {
                continue;
            }
            self.flow.dead = false;
            self.instruction();
        }
        while !self.open.is_empty() {
            self.close();
        }
        if let Some(pointer) = region.runs_into {
            self.emit_call(pointer);
        }
        self.enter_places();
        let items = std::mem::take(&mut self.out);
        let (mut body, escapes) = structure(items);
        for jump in escapes {
            self.report_jump(&jump);
        }
        if body.last() == Some(&Stmt::Return) {
            body.pop();
        }
        // A scan that the watchdog cut short left calls open.
        if let Some(open) = self.flow.open_calls.filter(|_| index == 0) {
            let none = self.add(Expr::I32(0));
            body.insert(0, Stmt::Do(Action::SetCell(open, none)));
        }
        let prologue = std::mem::take(&mut self.flow.prologue);
        if !prologue.is_empty() {
            body.splice(
                0..0,
                prologue
                    .into_iter()
                    .map(|(t, e)| Stmt::Do(Action::Let(t, e))),
            );
        }
        body
    }

    /// Returns true if the current instruction is the target of a jump.
    fn revives(&self) -> bool {
        self.resolution()
            .label
            .is_some_and(|label| self.flow.jumped_to.contains(&label.number))
    }

    fn report_jump(&mut self, jump: &Jump) {
        let span = self.resolved.program.instrs[jump.at].span;
        let label = DeviceClass::P.number(jump.target);
        self.report(
            codes::BETWEEN_ROUTINES
                .at(span, format!("`{label}` cannot be reached from here"))
                .label("the label is in a loop, a state or a routine that this jump is not in"),
        );
    }

    /// Ends the innermost open body.
    pub(super) fn close(&mut self) {
        match self.open.pop() {
            Some(Open::Loop { count, outer }) => {
                let items = std::mem::replace(&mut self.out, outer);
                let (body, escapes) = structure(items);
                self.push_nested(Stmt::For { count, body }, escapes);
            }
            Some(Open::State { cond, outer }) => {
                let mut items = std::mem::replace(&mut self.out, outer);
                // A label at the end of a state precedes what follows.
                let tail = items
                    .iter()
                    .rposition(|item| !matches!(item, Item::Label(_)));
                let labels = items.split_off(tail.map_or(0, |tail| tail + 1));
                let (then, escapes) = structure(items);
                let stmt = Stmt::If(Branch {
                    cond,
                    then,
                    otherwise: Vec::new(),
                });
                self.push_nested(stmt, escapes);
                self.out.extend(labels);
            }
            Some(Open::Steps { steps, outer }) => {
                let items = std::mem::replace(&mut self.out, outer);
                let (body, escapes) = structure(items);
                self.push_nested(Stmt::Steps(Steps { body, ..steps }), escapes);
            }
            None => {}
        }
    }

    fn push_nested(&mut self, stmt: Stmt, escapes: Vec<Jump>) {
        self.out.push(if escapes.is_empty() {
            Item::Code(stmt)
        } else {
            Item::Nested(stmt, escapes)
        });
    }

    pub(super) fn begin_loop(&mut self) {
        let count = match self.operand(0) {
            Some(operand) => {
                let mut guards = Guards::default();
                let count = self.value(operand, false, &mut guards);
                self.guarded_value(guards, count)
            }
            None => self.int(1, false),
        };
        let outer = std::mem::take(&mut self.out);
        self.open.push(Open::Loop { count, outer });
    }

    pub(super) fn end_loop(&mut self) {
        if matches!(self.open.last(), Some(Open::Loop { .. })) {
            self.close();
        }
    }

    pub(super) fn open_state(&mut self, cond: ExprId) {
        let outer = std::mem::take(&mut self.out);
        self.open.push(Open::State { cond, outer });
    }

    pub(super) fn close_open_state(&mut self) {
        if matches!(self.open.last(), Some(Open::State { .. })) {
            self.close();
        }
    }

    pub(super) fn label(&mut self) {
        let Some(label) = self.resolution().label else {
            return;
        };
        if label.class != DeviceClass::P || !self.flow.jumped_to.contains(&label.number) {
            return;
        }
        // A jump into a zone of master control finds it on.
        let zones = self.logic.zones.iter().map(|&(_, outer)| outer);
        let buses: Vec<ExprId> = zones.chain([self.logic.bus]).flatten().collect();
        if !self.logic.zones.is_empty() {
            for bus in buses {
                if let Expr::Temp(temp) = self.expr(bus) {
                    let on = self.bit_const(true);
                    self.flow.prologue.push((temp, on));
                }
            }
        }
        self.out.push(Item::Label(label.number));
    }

    pub(super) fn jump(&mut self) {
        let cond = self.drive_of_form();
        let Some(target) = pointer(self.resolved, self.at) else {
            return;
        };
        match pointer_index(self.resolved, self.at) {
            Some(index) => self.indexed_jump(cond, target, index),
            None if self.model.end_pointer == Some(target) => {
                self.when(cond, |this| this.emit(Stmt::Return))
            }
            None => self.push_jump(cond, target),
        }
    }

    pub(super) fn push_jump(&mut self, cond: ExprId, target: u32) {
        let stay = self.not(cond);
        self.out.push(Item::Jump(Jump {
            cond,
            stay,
            target,
            at: self.at,
        }));
    }

    /// A jump to the label whose number is `base` and the index: to each of the labels that this may be.
    fn indexed_jump(&mut self, cond: ExprId, base: u32, index: Index) {
        let cond = self.settled(cond);
        let index = self.index(index, false);
        let index = self.settled(index);
        for label in self.flow.labels.clone() {
            let offset = self.add(Expr::I32(label as i32 - base as i32));
            let meant = self.add(Expr::Cmp(CmpOp::Eq, index, offset));
            let cond = self.and(cond, meant);
            self.push_jump(cond, label);
        }
        if let Some(end) = self.model.end_pointer {
            let offset = self.add(Expr::I32(end as i32 - base as i32));
            let meant = self.add(Expr::Cmp(CmpOp::Eq, index, offset));
            let cond = self.and(cond, meant);
            self.when(cond, |this| this.emit(Stmt::Return));
        }
        let step = self.step();
        self.when(cond, |this| {
            this.emit(Action::Fault {
                code: NO_LABEL,
                step,
            })
        });
    }

    pub(super) fn call_subroutine(&mut self) {
        let Some(pointer) = pointer(self.resolved, self.at) else {
            return;
        };
        match pointer_index(self.resolved, self.at) {
            Some(index) => self.driven(|this| this.indexed_call(pointer, index)),
            None => self.driven(|this| this.emit_call(pointer)),
        }
    }

    /// Calls the subroutine whose number is `base` and the index: that one of them all.
    fn indexed_call(&mut self, base: u32, index: Index) {
        let index = self.index(index, false);
        let index = self.settled(index);
        let mut pointers: Vec<u32> = self.flow.subroutines.keys().copied().collect();
        pointers.sort();
        let mut none = self.bit_const(true);
        for pointer in pointers {
            let offset = self.add(Expr::I32(pointer as i32 - base as i32));
            let meant = self.add(Expr::Cmp(CmpOp::Eq, index, offset));
            self.when(meant, |this| this.emit_call(pointer));
            let other = self.not(meant);
            none = self.and(none, other);
        }
        let step = self.step();
        self.when(none, |this| {
            this.emit(Action::Fault {
                code: NO_LABEL,
                step,
            })
        });
    }

    /// Calls a subroutine; a call that would recurse is the PLC's error for calls nested too deep.
    fn emit_call(&mut self, pointer: u32) {
        let Some(&callee) = self.flow.subroutines.get(&pointer) else {
            return;
        };
        let too_deep = Stmt::Do(Action::Fault {
            code: CALL_DEPTH,
            step: self.step(),
        });
        let call = Stmt::CallSub(self.flow.regions[callee].function);
        if self.flow.recursive.contains(&(self.flow.current, callee)) {
            self.emit(too_deep);
        } else if let Some(open) = self.flow.open_calls {
            let now = self.add(Expr::Cell(open));
            let most = self.add(Expr::I32(self.model.max_call as i32));
            let one = self.add(Expr::I32(1));
            let cond = self.add(Expr::Cmp(CmpOp::Lt, now, most));
            let deeper = self.add(Expr::Bin(BinOp::Add, now, one));
            let back = self.add(Expr::Bin(BinOp::Sub, now, one));
            let then = vec![
                Stmt::Do(Action::SetCell(open, deeper)),
                call,
                Stmt::Do(Action::SetCell(open, back)),
            ];
            self.emit(Stmt::If(Branch {
                cond,
                then,
                otherwise: vec![too_deep],
            }));
        } else {
            self.emit(call);
        }
    }

    /// FEND, END, SRET, IRET: the function ends here.
    pub(super) fn return_here(&mut self) {
        self.emit(Stmt::Return);
        self.flow.dead = self.open.is_empty();
    }
}
