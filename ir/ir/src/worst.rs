//! The longest way through a program: how much a scan does at most.
//!
//! What is counted are PLC steps of the networks that are passed and operations of the IR (a statement, an operator, a
//! read of a device). Of two branches the longer one counts, a loop counts as often as it runs, a call with all that it
//! calls.

use crate::node::{
    Action, Branch, Expr, ExprId, Function, FunctionKind, LabelId, Module, Part, Repeat, Stmt,
};
use crate::walk::{for_exprs, operands, statements};
use std::collections::BTreeMap;
use typed_index_collections::TiVec;

/// Upper bound of executed operations.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Cost {
    /// Steps of the PLC program.
    pub steps: u64,
    /// Operations of the IR.
    pub operations: u64,
}

impl Cost {
    fn plus(self, other: Cost) -> Cost {
        Cost {
            steps: self.steps.saturating_add(other.steps),
            operations: self.operations.saturating_add(other.operations),
        }
    }

    fn times(self, count: u64) -> Cost {
        Cost {
            steps: self.steps.saturating_mul(count),
            operations: self.operations.saturating_mul(count),
        }
    }

    fn max(self, other: Cost) -> Cost {
        Cost {
            steps: self.steps.max(other.steps),
            operations: self.operations.max(other.operations),
        }
    }
}

/// A loop that runs as often as a device says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct OpenLoop {
    /// Step where its network starts.
    pub step: u32,
    /// Cost of each further iteration; one is counted.
    pub iteration: Cost,
}

/// Event between two scans or within one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Event {
    /// The interrupt routine of this pointer.
    Interrupt(u32),
    /// All interrupts that are requested at one point, with what asks for them.
    Interrupts,
    /// An edge of this input X.
    Edge(u32),
}

/// Worst-case cost of a program.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Worst {
    /// A scan, without interrupts.
    pub scan: Cost,
    /// Additional cost of each event.
    pub events: Vec<(Event, Cost)>,
    /// Loops for which `scan` holds only if they run once, in the order of the program.
    pub open_loops: Vec<OpenLoop>,
    /// Steps of networks with jumps back: `scan` holds only if they are not made. [`Stmt::Watch`] is their limit.
    pub jumps_back: Vec<u32>,
}

/// Finds the longest way through a program.
pub fn worst(module: &Module) -> Worst {
    let mut finder = Finder::new(module);
    let mut scan = Cost::default();
    for number in 0..module.functions.len().min(3) {
        scan = scan.plus(finder.function(number));
    }
    let mut worst = Worst {
        scan,
        ..Worst::default()
    };
    finder.aside = false;
    finder.known.clear();
    for (number, function) in module.functions.iter().enumerate() {
        let event = match function.kind {
            FunctionKind::Interrupt(pointer) => Event::Interrupt(pointer),
            FunctionKind::TakeInterrupts => Event::Interrupts,
            FunctionKind::InputEdge { input, .. } => Event::Edge(input),
            FunctionKind::Begin
            | FunctionKind::Main
            | FunctionKind::End
            | FunctionKind::Subroutine(_)
            | FunctionKind::Signals => continue,
        };
        let cost = finder.function(number);
        match worst.events.iter_mut().find(|(known, _)| *known == event) {
            Some((_, known)) => *known = known.max(cost),
            None => worst.events.push((event, cost)),
        }
    }
    let loops = finder.open_loops.into_iter();
    worst.open_loops = loops
        .map(|(step, iteration)| OpenLoop { step, iteration })
        .collect();
    worst.jumps_back = finder.jumps_back;
    worst.jumps_back.sort();
    worst.jumps_back.dedup();
    worst
}

struct Finder<'m> {
    module: &'m Module,
    /// Length of each network in steps.
    lengths: Vec<u64>,
    /// Operations of each expression.
    sizes: TiVec<ExprId, u64>,
    /// Costs of the functions examined so far.
    known: BTreeMap<usize, Cost>,
    /// True if interrupts are left aside.
    aside: bool,
    /// Step of the network that is looked at.
    step: u32,
    open_loops: BTreeMap<u32, Cost>,
    jumps_back: Vec<u32>,
}

impl<'m> Finder<'m> {
    fn new(module: &'m Module) -> Self {
        let mut sizes: TiVec<ExprId, u64> = TiVec::with_capacity(module.exprs.len());
        for expr in &module.exprs {
            let inner = operands(expr).map(|id| sizes.get(id).copied().unwrap_or(0));
            let inner = inner.fold(0u64, u64::saturating_add);
            sizes.push(inner.saturating_add(own(expr)));
        }
        Finder {
            module,
            lengths: lengths(module),
            sizes,
            known: BTreeMap::new(),
            aside: true,
            step: 0,
            open_loops: BTreeMap::new(),
            jumps_back: Vec::new(),
        }
    }

    fn function(&mut self, number: usize) -> Cost {
        if let Some(known) = self.known.get(&number) {
            return *known;
        }
        // There is no recursion; a function that is being looked at costs nothing once more.
        self.known.insert(number, Cost::default());
        let function: Option<&Function> = self.module.functions.get(number);
        let cost = function.map_or(Cost::default(), |function| self.body(&function.body));
        self.known.insert(number, cost);
        cost
    }

    fn body(&mut self, body: &[Stmt]) -> Cost {
        body.iter()
            .fold(Cost::default(), |sum, stmt| sum.plus(self.stmt(stmt)))
    }

    fn stmt(&mut self, stmt: &Stmt) -> Cost {
        let mut operations = 1u64;
        for_exprs(stmt, &mut |&id| {
            let size = self.sizes.get(id).copied().unwrap_or(0);
            operations = operations.saturating_add(size);
        });
        let cost = Cost {
            steps: 0,
            operations,
        };
        match stmt {
            Stmt::Network(number) => self.network(*number),
            Stmt::If(Branch {
                then, otherwise, ..
            }) => {
                let then = self.body(then);
                cost.plus(then.max(self.body(otherwise)))
            }
            Stmt::For { count, body } => {
                let step = self.step;
                let iteration = self.body(body);
                if let Expr::I16(count) = *self.module.expr(*count) {
                    cost.plus(iteration.times(count.max(1) as u64))
                } else {
                    self.open_loops.insert(step, iteration);
                    cost.plus(iteration)
                }
            }
            Stmt::Repeat(Repeat { count, body, .. }) => {
                let iteration = self.body(body);
                cost.plus(iteration.times(u64::from(*count)))
            }
            Stmt::Steps(steps) => cost.plus(self.body(&steps.body)),
            Stmt::Do(Action::Block(block)) => {
                let (_, count) = block.written();
                cost.plus(Cost {
                    steps: 0,
                    operations: u64::from(count),
                })
            }
            Stmt::CallSub(number) => {
                let number = *number as usize;
                let kind = self.module.functions.get(number).map(|f| &f.kind);
                if self.aside && kind == Some(&FunctionKind::TakeInterrupts) {
                    cost
                } else {
                    cost.plus(self.function(number))
                }
            }
            Stmt::Parts(parts) => cost.plus(self.parts(parts)),
            Stmt::Do(_) | Stmt::Return | Stmt::Goto(_) | Stmt::Watch { .. } => cost,
        }
    }

    fn network(&mut self, number: u32) -> Cost {
        if let Some(network) = self.module.networks.get(number as usize) {
            self.step = network.step;
        }
        Cost {
            steps: self.lengths.get(number as usize).copied().unwrap_or(0),
            operations: 0,
        }
    }

    /// The longest way through parts that jump forward, from the first one on.
    fn parts(&mut self, parts: &[Part]) -> Cost {
        let mut own = Vec::with_capacity(parts.len());
        let mut targets = Vec::with_capacity(parts.len());
        for (i, part) in parts.iter().enumerate() {
            let step = self.step;
            own.push(self.body(&part.body));
            let ahead = self.ahead(parts, i, step);
            targets.push(ahead);
        }
        let mut longest = vec![Cost::default(); parts.len() + 1];
        for i in (0..parts.len()).rev() {
            let on = targets[i].iter().map(|&target| longest[target]);
            let after = on.fold(longest[i + 1], Cost::max);
            longest[i] = own[i].plus(after);
        }
        longest.first().copied().unwrap_or_default()
    }

    /// The later parts that a part jumps to. Jumps back are noted.
    fn ahead(&mut self, parts: &[Part], from: usize, mut step: u32) -> Vec<usize> {
        let at = |label: LabelId| parts.iter().position(|part| part.label == Some(label));
        let mut ahead = Vec::new();
        statements(&parts[from].body, &mut |stmt| {
            if let Stmt::Network(number) = stmt {
                let network = self.module.networks.get(*number as usize);
                step = network.map_or(step, |network| network.step);
            } else if let Stmt::Goto(label) = stmt {
                match at(*label) {
                    Some(target) if target > from => ahead.push(target),
                    Some(_) => self.jumps_back.push(step),
                    None => {}
                }
            }
        });
        ahead
    }
}

/// Operations of an expression in addition to its operands: none for a constant or an existing temporary.
fn own(expr: &Expr) -> u64 {
    let nothing = matches!(
        expr,
        Expr::Bit(_) | Expr::I16(_) | Expr::I32(_) | Expr::F32(_) | Expr::Temp(_)
    );
    u64::from(!nothing)
}

/// The lengths of all networks: each ends where the next one starts.
pub fn lengths(module: &Module) -> Vec<u64> {
    let mut begins: Vec<u32> = module.networks.iter().map(|network| network.step).collect();
    begins.push(module.steps);
    begins.sort();
    begins.dedup();
    let next = |step: u32| {
        begins
            .get(begins.partition_point(|&other| other <= step))
            .copied()
    };
    let length = |step: u32| next(step).map_or(0, |next| u64::from(next - step));
    module
        .networks
        .iter()
        .map(|network| length(network.step))
        .collect()
}
