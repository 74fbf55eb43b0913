//! Holds a module to the rules of [`crate::node`].

use crate::node::{
    Action, Arg, BinOp, Block, Body, Branch, Expr, ExprId, FunctionKind, IndexedCoil, LabelId,
    Module, Place, SetEntry, Steps, Stmt, SysValue, TempId, Ty,
};
use crate::reach::{self, Footprint};
use crate::walk::{assigned, callees, for_exprs, operands};
use rungc_models::runs::is_special;
use rungc_syntax::DeviceClass;
use typed_index_collections::TiVec;

/// Checks every rule; the first one that is broken.
pub fn validate(module: &Module) -> Result<(), String> {
    let kinds: Vec<_> = module.functions.iter().take(3).map(|f| &f.kind).collect();
    let first = [FunctionKind::Begin, FunctionKind::Main, FunctionKind::End];
    if kinds != first.iter().collect::<Vec<_>>() {
        return Err(format!("the first functions are {kinds:?}"));
    }
    for (i, expr) in module.exprs.iter().enumerate() {
        check_expr(module, i, expr)?;
    }
    if let Some(area) = module.layout.areas.iter().find(|area| {
        let last = area.first + area.count - 1;
        module.model.has_alias(area.class, area.first, last)
    }) {
        return Err(format!("{area:?} holds other names of index registers"));
    }
    no_recursion(module)?;
    one_meaning_each(module)?;
    for function in &module.functions {
        let mut checker = Checker {
            module,
            assigned: vec![false; module.temps.len()].into(),
            log: Vec::new(),
            labels: Vec::new(),
            iterations: 1,
        };
        checker
            .body(&function.body)
            .map_err(|error| format!("{:?}: {error}", function.kind))?;
    }
    Ok(())
}

/// Flags and cells become fields of one struct.
fn one_meaning_each(module: &Module) -> Result<(), String> {
    let flags = module.flags.iter().map(|flag| flag.name.as_str());
    let cells = module.cells.iter().map(|cell| cell.name.as_str());
    let mut names: Vec<&str> = flags.chain(cells).collect();
    names.sort();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(format!("two flags or cells are called {}", pair[0])),
        None => Ok(()),
    }
}

fn check_expr(module: &Module, at: usize, expr: &Expr) -> Result<(), String> {
    for operand in operands(expr) {
        if usize::from(operand) >= at {
            return Err(format!("expression {at} ({expr:?}) uses a later one"));
        }
    }
    if let Expr::Temp(temp) = expr
        && module.temps.get(*temp).is_none()
    {
        return Err(format!("expression {at} is {temp:?}, which does not exist"));
    }
    let ty = |id: ExprId| module.ty(id);
    let integer = |id: ExprId| matches!(ty(id), Ty::I16 | Ty::I32);
    let indexed = |place: Place| place.index.is_none_or(|index| ty(index) == Ty::I32);
    let well_typed = match *expr {
        Expr::Not(a) | Expr::BitToInt(a) => ty(a) == Ty::Bit,
        Expr::And(a, b) | Expr::Or(a, b) => ty(a) == Ty::Bit && ty(b) == Ty::Bit,
        Expr::Cmp(_, a, b) => ty(a) == ty(b) && ty(a) != Ty::Bit,
        Expr::Bin(BinOp::MulHigh, a, b) => ty(a) == Ty::I32 && ty(b) == Ty::I32,
        Expr::Bin(_, a, b) => ty(a) == ty(b) && integer(a),
        Expr::Un(op, a) => op.takes(ty(a)),
        Expr::Float(_, a, b) => ty(a) == Ty::F32 && ty(b) == Ty::F32,
        Expr::Complement(a) | Expr::Neg(a) => integer(a),
        Expr::Widen(a) => ty(a) == Ty::I16,
        Expr::Narrow(a) | Expr::HighWord(a) => ty(a) == Ty::I32,
        Expr::Read(access) => access.is_well_formed() && indexed(access.place),
        Expr::InRange {
            place,
            count,
            length,
        } => count > 0 && indexed(place) && length.is_none_or(|length| ty(length) == Ty::I32),
        Expr::Cell(cell) => module.cells.get(cell).is_some(),
        Expr::Within { value, low, high } => ty(value) == Ty::I32 && low <= high,
        Expr::Stride(iteration, by) => by > 0 && module.temps.get(iteration) == Some(&Ty::I32),
        Expr::Entry(table, index) => module.tables.get(table).is_some() && ty(index) == Ty::I32,
        Expr::Flag(flag) => module.flags.get(flag).is_some(),
        Expr::Sys(
            SysValue::Running
            | SysValue::FirstScan
            | SysValue::NowMs
            | SysValue::MinuteMs
            | SysValue::SinceScanMs
            | SysValue::Scan100us,
        )
        | Expr::Bit(_)
        | Expr::I16(_)
        | Expr::I32(_)
        | Expr::F32(_)
        | Expr::Temp(_) => true,
    };
    if well_typed {
        Ok(())
    } else {
        Err(format!("expression {at} ({expr:?}) is ill typed"))
    }
}

/// Functions call no function that is running.
fn no_recursion(module: &Module) -> Result<(), String> {
    let mut callers = vec![0u32; module.functions.len()];
    let mut called = Vec::with_capacity(module.functions.len());
    for function in &module.functions {
        let found = callees(&function.body);
        for &callee in &found {
            match callers.get_mut(callee) {
                Some(count) => *count += 1,
                None => return Err(format!("function {callee} does not exist")),
            }
        }
        called.push(found);
    }
    // Functions that none left calls are taken away until none is left, or only those in a circle.
    let mut free: Vec<usize> = (0..callers.len()).filter(|&i| callers[i] == 0).collect();
    let mut taken = 0;
    while let Some(function) = free.pop() {
        taken += 1;
        for &callee in &called[function] {
            callers[callee] -= 1;
            if callers[callee] == 0 {
                free.push(callee);
            }
        }
    }
    if taken == module.functions.len() {
        Ok(())
    } else {
        Err("functions call each other in a circle".into())
    }
}

struct Checker<'m> {
    module: &'m Module,
    /// Temporaries that have a value here.
    assigned: TiVec<TempId, bool>,
    /// Those assigned so far, in order.
    log: Vec<TempId>,
    /// Labels of the parts around, innermost last.
    labels: Vec<LabelId>,
    /// Number of iterations of the surrounding loop over rungs.
    iterations: u32,
}

impl Checker<'_> {
    /// Checks statements in order; whether what follows is reached.
    fn body(&mut self, body: &Body) -> Result<bool, String> {
        let mut reached = true;
        for stmt in body {
            reached &= self.stmt(stmt)?;
        }
        Ok(reached)
    }

    fn stmt(&mut self, stmt: &Stmt) -> Result<bool, String> {
        let mut missing = None;
        for_exprs(stmt, &mut |id| {
            if missing.is_none() {
                missing = self.fault_in(*id);
            }
        });
        if let Some(fault) = missing {
            return Err(format!("{stmt:?}: {fault}"));
        }
        self.typed(stmt)?;
        match stmt {
            Stmt::Do(_) => {
                if let Some(temp) = assigned(stmt) {
                    self.assign(temp);
                }
                Ok(true)
            }
            Stmt::If(Branch {
                then, otherwise, ..
            }) => self.branches(then, otherwise),
            Stmt::For { body, .. } => {
                self.body(body)?;
                Ok(true)
            }
            Stmt::Steps(Steps { body, .. }) => {
                let begin = self.log.len();
                self.body(body)?;
                self.forget(begin);
                Ok(true)
            }
            Stmt::Repeat(repeat) => {
                let begin = self.log.len();
                self.assign(repeat.iteration);
                self.iterations = repeat.count;
                self.body(&repeat.body)?;
                self.iterations = 1;
                self.forget(begin);
                Ok(true)
            }
            Stmt::Parts(parts) => {
                let outer = self.labels.len();
                self.labels
                    .extend(parts.iter().filter_map(|part| part.label));
                let begin = self.log.len();
                for part in parts {
                    if part.label.is_some() {
                        self.forget(begin);
                    }
                    self.body(&part.body)?;
                }
                // Temporaries assigned by the last part are assigned afterwards: the parts end where it does.
                self.labels.truncate(outer);
                Ok(true)
            }
            Stmt::Goto(label) if !self.labels.contains(label) => {
                Err(format!("{label:?} is not around the jump to it"))
            }
            Stmt::Goto(_) | Stmt::Return => Ok(false),
            Stmt::Network(_) | Stmt::CallSub(_) | Stmt::Watch { .. } => Ok(true),
        }
    }

    /// Both branches of a condition: what both assign, or the one that continues, is assigned.
    fn branches(&mut self, then: &Body, otherwise: &Body) -> Result<bool, String> {
        let begin = self.log.len();
        let first = self.body(then)?;
        let by_first = self.forget(begin);
        let second = self.body(otherwise)?;
        let by_second = self.forget(begin);
        match (first, second) {
            (true, true) => {
                for temp in &by_first {
                    self.assigned[*temp] = true;
                }
                let both: Vec<TempId> = by_second
                    .into_iter()
                    .filter(|temp| self.assigned[*temp])
                    .collect();
                for temp in by_first {
                    self.assigned[temp] = false;
                }
                both.into_iter().for_each(|temp| self.assign(temp));
            }
            (true, false) => by_first.into_iter().for_each(|temp| self.assign(temp)),
            (false, true) => by_second.into_iter().for_each(|temp| self.assign(temp)),
            (false, false) => {}
        }
        Ok(first || second)
    }

    fn assign(&mut self, temp: TempId) {
        if let Some(assigned) = self.assigned.get_mut(temp)
            && !std::mem::replace(assigned, true)
        {
            self.log.push(temp);
        }
    }

    /// Takes back assignments down to a length of the log.
    fn forget(&mut self, begin: usize) -> Vec<TempId> {
        let taken = self.log.split_off(begin);
        for temp in &taken {
            self.assigned[*temp] = false;
        }
        taken
    }

    /// Fault of an expression evaluated here.
    fn fault_in(&self, id: ExprId) -> Option<String> {
        let Some(expr) = self.module.exprs.get(id) else {
            return Some(format!("{id:?} does not exist"));
        };
        if let Expr::Temp(temp) | Expr::Stride(temp, _) = *expr
            && !self.assigned[temp]
        {
            return Some(format!("{temp:?} is not assigned on every path"));
        }
        let mut missing = None;
        reach::of_expr(self.module.model, expr, &mut |used| {
            missing = missing.take().or_else(|| self.unstored(used));
        });
        missing.or_else(|| operands(expr).find_map(|operand| self.fault_in(operand)))
    }

    /// The first device that an access may meet and the layout lacks.
    fn unstored(&self, used: Footprint) -> Option<String> {
        let (module, class) = (self.module, used.place.class);
        let index = used.place.index.map(|index| module.expr(index));
        if let Some(&Expr::Stride(_, by)) = index {
            return self.no_column(used.place, by);
        }
        let runs = match (index, used.count) {
            (None, Some(0)) => Vec::new(),
            (None, Some(count)) => {
                // A hostile operand asks for more than any model has, which was rejected before or is cut off.
                let first = used.place.number;
                let last = first.saturating_add(count - 1);
                let exist = module.model.ranges_of(class).map(|range| range.last);
                vec![(first, last.min(exist.max().unwrap_or(first)))]
            }
            _ => used.reach(module.model, &module.exprs),
        };
        for (first, last) in runs {
            let mut number = first;
            while number <= last {
                let (own, own_number) = module.model.canonical(class, number);
                let area = module.layout.area(own, own_number);
                number = match area {
                    // The code that finds devices by number looks for them in arrays.
                    Some(area) if own == class && (area.array || index.is_none()) => {
                        area.first + area.count
                    }
                    Some(_) if own != class => number + 1,
                    _ if !module.model.has(class, number) => number + 1,
                    _ => return Some(format!("{} is not stored", class.number(number))),
                };
            }
        }
        None
    }

    /// The device of a loop's iterations, if it lies in no grid that they go through.
    fn no_column(&self, place: Place, by: u32) -> Option<String> {
        let grid = self.module.layout.grid(place.class, place.number);
        let name = place.class.number(place.number);
        let last = self.last_of_iterations(place.number, by);
        grid.is_none_or(|grid| grid.columns != by || !grid.stores(last))
            .then(|| format!("{name} lies in no grid of {by} columns"))
    }

    /// A number of the last iteration of the loop around, of which that of the first is known.
    fn last_of_iterations(&self, first: u32, by: u32) -> u32 {
        first.saturating_add(self.iterations.saturating_sub(1).saturating_mul(by))
    }

    /// Numbers in all iterations of what is named so in the first.
    fn in_iterations(&self, first: u32, index: Option<ExprId>) -> impl Iterator<Item = u32> {
        let by = match index.map(|index| self.module.expr(index)) {
            Some(&Expr::Stride(_, by)) => by,
            _ => 0,
        };
        (0..self.iterations).map(move |n| first.saturating_add(n.saturating_mul(by)))
    }

    /// Returns true if a coil selects timers of one kind, if it is that of a loop's iterations.
    fn leads_to_one_kind(&self, place: Place) -> bool {
        let kind = |number| self.module.model.timer(number);
        let mut numbers = self.in_iterations(place.number, place.index);
        numbers.all(|number| kind(number) == kind(place.number))
    }

    /// Types of what a statement writes, its handles, the devices it touches.
    fn typed(&self, stmt: &Stmt) -> Result<(), String> {
        if !self.is_well_typed(stmt) {
            return Err(format!(
                "{stmt:?} is ill typed or names what does not exist"
            ));
        }
        match self.unstored_target(stmt) {
            Some(unstored) => Err(format!("{stmt:?}: {unstored}")),
            None => Ok(()),
        }
    }

    /// Device that a statement accesses and the layout lacks.
    fn unstored_target(&self, stmt: &Stmt) -> Option<String> {
        let mut missing = None;
        reach::of_stmt(self.module.model, stmt, &mut |used| {
            missing = missing.take().or_else(|| self.unstored(used));
        });
        missing
    }

    fn is_well_typed(&self, stmt: &Stmt) -> bool {
        let module = self.module;
        let is = |id: ExprId, ty: Ty| module.ty(id) == ty;
        let temp_is = |temp: TempId, ty: Ty| module.temps.get(temp) == Some(&ty);
        match *stmt {
            Stmt::Network(n) => (n as usize) < module.networks.len(),
            Stmt::Do(ref action) => self.is_well_typed_action(action),
            Stmt::If(Branch { cond, .. }) => is(cond, Ty::Bit),
            Stmt::For { count, .. } => is(count, Ty::I16),
            Stmt::Repeat(ref repeat) => repeat.count > 1 && temp_is(repeat.iteration, Ty::I32),
            Stmt::Steps(ref steps) => {
                let end = steps.memory.0.saturating_add(steps.memories);
                steps.states > 0 && steps.memories > 0 && end <= module.edges
            }
            Stmt::CallSub(_)
            | Stmt::Return
            | Stmt::Parts(_)
            | Stmt::Goto(_)
            | Stmt::Watch { .. } => true,
        }
    }

    fn is_well_typed_action(&self, action: &Action) -> bool {
        let module = self.module;
        let is = |id: ExprId, ty: Ty| module.ty(id) == ty;
        let temp_is = |temp: TempId, ty: Ty| module.temps.get(temp) == Some(&ty);
        match *action {
            Action::Let(temp, value) => temp_is(temp, module.ty(value)),
            Action::Edge(edge) => {
                let mut memories = self.in_iterations(edge.memory.0, edge.index);
                let exist = memories.all(|memory| memory < module.edges);
                exist && is(edge.input, Ty::Bit) && temp_is(edge.out, Ty::Bit)
            }
            Action::Write(access, value) => access.is_well_formed() && is(value, access.ty()),
            Action::Timer(coil) => is(coil.drive, Ty::Bit) && is(coil.preset, Ty::I16),
            Action::TimerAt(coil) => self.leads_to_one_kind(coil.place) && self.indexed_coil(&coil),
            Action::Counter16(coil) => is(coil.drive, Ty::Bit) && is(coil.preset, Ty::I16),
            Action::Counter16At(coil) => self.indexed_coil(&coil),
            Action::Counter32(coil) => {
                is(coil.drive, Ty::Bit) && is(coil.down, Ty::Bit) && is(coil.preset, Ty::I32)
            }
            Action::Count(count) => is(count.down, Ty::Bit) && is(count.preset, Ty::I32),
            Action::Call(ref call) => {
                call.slot <= module.states
                    && call.drive.is_none_or(|drive| is(drive, Ty::Bit))
                    && call.args.iter().all(|arg| self.arg(arg))
            }
            Action::Fetch(fetch) => {
                let cell = module.cells.get(fetch.value);
                cell.is_some() && temp_is(fetch.there, Ty::Bit) && self.arg(&fetch.from)
            }
            Action::Send(send) => {
                is(send.value, if send.wide { Ty::I32 } else { Ty::I16 }) && self.arg(&send.to)
            }
            Action::SetCell(cell, value) => module.cells.get(cell).is_some() && is(value, Ty::I32),
            Action::SetEntry(SetEntry {
                table,
                index,
                value,
            }) => module.tables.get(table).is_some() && is(index, Ty::I32) && is(value, Ty::I32),
            Action::SetFlag(flag, value) => module.flags.get(flag).is_some() && is(value, Ty::Bit),
            Action::Block(ref block) => self.block(block),
            Action::Reset { .. }
            | Action::TimerGoesOn { .. }
            | Action::Fault { .. }
            | Action::RestartWatchdog
            | Action::Stop
            | Action::Clear { .. } => true,
        }
    }

    fn indexed_coil(&self, coil: &IndexedCoil) -> bool {
        let is = |id: ExprId, ty: Ty| self.module.ty(id) == ty;
        coil.place.index.is_some() && is(coil.drive, Ty::Bit) && is(coil.preset, Ty::I16)
    }

    /// Returns true if the runs of a block are devices of one kind, ordinary ones that all exist where no index leads
    /// to them.
    fn block(&self, block: &Block) -> bool {
        use DeviceClass::{D, M, R, S, X, Y};
        let model = self.module.model;
        let (to, count) = block.written();
        let bits = matches!(to.class, X | Y | M | S);
        let well = |place: Place| {
            let alike = match bits {
                true => matches!(place.class, X | Y | M | S),
                false => matches!(place.class, D | R),
            };
            let exists = match place.index {
                Some(index) => self.module.ty(index) == Ty::I32,
                None => {
                    !is_special(place.class, place.number)
                        && model.in_range(place.class, place.number.into(), count)
                }
            };
            alike && exists
        };
        let length = block
            .length()
            .is_none_or(|length| self.module.ty(length) == Ty::I32);
        let value = match *block {
            Block::Fill { value, .. } => {
                self.module.ty(value) == if bits { Ty::Bit } else { Ty::I16 }
            }
            Block::Copy { .. } => true,
        };
        count > 0 && length && value && well(to) && block.source().is_none_or(well)
    }

    fn arg(&self, arg: &Arg) -> bool {
        let index = |index: &Option<ExprId>| index.is_none_or(|id| self.module.ty(id) == Ty::I32);
        match arg {
            Arg::Const { index: at, .. } | Arg::Buffer { index: at, .. } => index(at),
            Arg::Device { place, .. } | Arg::Nibbles { place, .. } => index(&place.index),
            Arg::WordBit { place, bit, .. } => *bit < 16 && index(&place.index),
            Arg::Text(n) => (*n as usize) < self.module.texts.len(),
            Arg::Float(_) => true,
        }
    }
}
