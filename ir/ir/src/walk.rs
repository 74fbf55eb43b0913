//! Ways through the IR: operands of expressions, expressions and bodies of statements, calls between functions.

use crate::node::{
    Access, Arg, Block, Body, Branch, Call, Count, Counter16Coil, Counter32Coil, Edge, Expr,
    ExprId, Fetch, FunctionKind, IndexedCoil, Module, Part, Place, Repeat, Send, SetEntry, Stmt,
    TempId, TimerCoil,
};

/// The expressions that an expression evaluates.
pub fn operands(expr: &Expr) -> impl Iterator<Item = ExprId> + use<> {
    let [first, second] = operand_slots(expr).map(Option::<&ExprId>::copied);
    first.into_iter().chain(second)
}

/// The expressions that an expression evaluates, to replace them.
pub fn operands_mut(expr: &mut Expr) -> impl Iterator<Item = &mut ExprId> {
    let [first, second] = operand_slots_mut(expr);
    first.into_iter().chain(second)
}

/// A function that finds the operands of an expression, to look at them or to replace them.
macro_rules! operand_slots {
    ($name:ident, $index:ident $(, $mutable:tt)?) => {
        fn $name(expr: &$($mutable)? Expr) -> [Option<&$($mutable)? ExprId>; 2] {
    match expr {
        Expr::Not(a)
        | Expr::Complement(a)
        | Expr::Neg(a)
        | Expr::Un(_, a)
        | Expr::Widen(a)
        | Expr::Narrow(a)
        | Expr::HighWord(a)
        | Expr::BitToInt(a)
        | Expr::Within { value: a, .. }
        | Expr::Entry(_, a) => [Some(a), None],
        Expr::And(a, b) | Expr::Or(a, b) | Expr::Cmp(_, a, b)
        | Expr::Bin(_, a, b)
        | Expr::Float(_, a, b) => [Some(a), Some(b)],
        Expr::Read(Access { place, .. }) | Expr::InRange { place, .. } => [place.index.$index(), None],
        Expr::Bit(_)
        | Expr::I16(_)
        | Expr::I32(_)
        | Expr::F32(_)
        | Expr::Temp(_)
        | Expr::Sys(_)
        | Expr::Flag(_)
        | Expr::Stride(..)
        | Expr::Cell(_) => [None, None],
    }
        }
    };
}

operand_slots!(operand_slots, as_ref);
operand_slots!(operand_slots_mut, as_mut, mut);

/// A function over the expressions that a statement evaluates, to look at them or to replace them.
macro_rules! for_exprs {
    ($(#[$doc:meta])* $name:ident, $index_of:ident, $iter:ident $(, $mutable:tt)?) => {
        fn $index_of(arg: &$($mutable)? Arg) -> Option<&$($mutable)? ExprId> {
            let index = match arg {
                Arg::Const { index, .. } | Arg::Buffer { index, .. } => index,
                Arg::Device { place, .. }
                | Arg::Nibbles { place, .. }
                | Arg::WordBit { place, .. } => &$($mutable)? place.index,
                Arg::Float(_) | Arg::Text(_) => return None,
            };
            index.$iter().next()
        }

        $(#[$doc])*
        pub fn $name(stmt: &$($mutable)? Stmt, f: &mut impl FnMut(&$($mutable)? ExprId)) {
            match stmt {
                Stmt::Write(access, value) => {
                    access.place.index.$iter().for_each(&mut *f);
                    f(value);
                }
                Stmt::Let(_, value) | Stmt::SetFlag(_, value) | Stmt::SetCell(_, value) => f(value),
                Stmt::SetEntry(SetEntry { index, value, .. }) => {
                    f(index);
                    f(value);
                }
                Stmt::Count(Count { down, preset, .. }) => {
                    f(down);
                    f(preset);
                }
                Stmt::Edge(Edge { index, input, .. }) => {
                    index.$iter().for_each(&mut *f);
                    f(input);
                }
                Stmt::Timer(TimerCoil { drive, preset, .. }) | Stmt::Counter16(Counter16Coil { drive, preset, .. }) => {
                    f(drive);
                    f(preset);
                }
                Stmt::TimerAt(IndexedCoil { place, drive, preset })
                | Stmt::Counter16At(IndexedCoil { place, drive, preset }) => {
                    place.index.$iter().for_each(&mut *f);
                    f(drive);
                    f(preset);
                }
                Stmt::Counter32(Counter32Coil { drive, down, preset, .. }) => {
                    f(drive);
                    f(down);
                    f(preset);
                }
                Stmt::Reset(place) => place.index.$iter().for_each(f),
                Stmt::Block(Block::Fill { value, .. }) => f(value),
                Stmt::If(Branch { cond, .. }) => f(cond),
                Stmt::For { count, .. } => f(count),
                Stmt::Call(Call { args, drive, .. }) => {
                    for arg in args {
                        if let Some(index) = $index_of(arg) {
                            f(index);
                        }
                    }
                    drive.$iter().for_each(f);
                }
                Stmt::Fetch(Fetch { from, .. }) => $index_of(from).into_iter().for_each(f),
                Stmt::Send(Send { to, value, .. }) => {
                    if let Some(index) = $index_of(to) {
                        f(index);
                    }
                    f(value);
                }
                Stmt::Network(_)
                | Stmt::Block(Block::Copy { .. })
                | Stmt::Repeat(_)
                | Stmt::CallSub(_)
                | Stmt::Return
                | Stmt::TimerGoesOn { .. }
                | Stmt::Parts(_)
                | Stmt::Goto(_)
                | Stmt::Fault { .. }
                | Stmt::Watch { .. }
                | Stmt::Stop
                | Stmt::Clear { .. } => {}
            }
        }
    };
}

for_exprs! {
    /// Calls `f` with the expressions that a statement itself evaluates, without those of the bodies inside it.
    for_exprs, index_of, iter
}
for_exprs! {
    /// Calls `f` with the expressions that a statement itself evaluates, to replace them.
    for_exprs_mut, index_of_mut, iter_mut, mut
}

/// Calls `f` with the places that a statement itself names, in addition to those in its expressions, to replace them.
pub fn places_mut(stmt: &mut Stmt, f: &mut impl FnMut(&mut Place)) {
    let of_arg = |arg: &mut Arg, f: &mut dyn FnMut(&mut Place)| match arg {
        Arg::Device { place, .. } | Arg::Nibbles { place, .. } | Arg::WordBit { place, .. } => {
            f(place);
        }
        Arg::Const { .. } | Arg::Float(_) | Arg::Text(_) | Arg::Buffer { .. } => {}
    };
    match stmt {
        Stmt::Write(Access { place, .. }, _)
        | Stmt::TimerAt(IndexedCoil { place, .. })
        | Stmt::Counter16At(IndexedCoil { place, .. })
        | Stmt::Reset(place) => f(place),
        Stmt::Call(Call { args, .. }) => args.iter_mut().for_each(|arg| of_arg(arg, f)),
        Stmt::Fetch(Fetch { from: arg, .. }) | Stmt::Send(Send { to: arg, .. }) => of_arg(arg, f),
        Stmt::Network(_)
        | Stmt::Let(..)
        | Stmt::Edge(_)
        | Stmt::SetFlag(..)
        | Stmt::SetCell(..)
        | Stmt::SetEntry(_)
        | Stmt::Timer(_)
        | Stmt::TimerGoesOn { .. }
        | Stmt::Counter16(_)
        | Stmt::Counter32(_)
        | Stmt::Count(_)
        | Stmt::Block(_)
        | Stmt::If(_)
        | Stmt::For { .. }
        | Stmt::Repeat(_)
        | Stmt::CallSub(_)
        | Stmt::Return
        | Stmt::Parts(_)
        | Stmt::Goto(_)
        | Stmt::Fault { .. }
        | Stmt::Watch { .. }
        | Stmt::Stop
        | Stmt::Clear { .. } => {}
    }
}

/// The temporary that a statement gives a value.
pub fn assigned(stmt: &Stmt) -> Option<TempId> {
    match stmt {
        Stmt::Let(temp, _)
        | Stmt::Edge(Edge { out: temp, .. })
        | Stmt::Fetch(Fetch { there: temp, .. }) => Some(*temp),
        Stmt::Network(_)
        | Stmt::SetFlag(..)
        | Stmt::SetCell(..)
        | Stmt::SetEntry(_)
        | Stmt::Write(..)
        | Stmt::Timer(_)
        | Stmt::TimerAt(_)
        | Stmt::TimerGoesOn { .. }
        | Stmt::Counter16(_)
        | Stmt::Counter16At(_)
        | Stmt::Counter32(_)
        | Stmt::Count(_)
        | Stmt::Reset(_)
        | Stmt::Block(_)
        | Stmt::If(_)
        | Stmt::For { .. }
        | Stmt::Repeat(_)
        | Stmt::CallSub(_)
        | Stmt::Return
        | Stmt::Parts(_)
        | Stmt::Goto(_)
        | Stmt::Call(_)
        | Stmt::Send(_)
        | Stmt::Fault { .. }
        | Stmt::Watch { .. }
        | Stmt::Stop
        | Stmt::Clear { .. } => None,
    }
}

/// Returns true if a statement itself calls the runtime.
pub fn calls_runtime(stmt: &Stmt) -> bool {
    matches!(stmt, Stmt::Call(_) | Stmt::Fetch(_) | Stmt::Send(_))
}

/// The step at which a statement reports a fault, if it can.
pub fn fault_step(stmt: &Stmt) -> Option<u32> {
    match *stmt {
        Stmt::Call(Call { step, .. })
        | Stmt::Fetch(Fetch { step, .. })
        | Stmt::Send(Send { step, .. })
        | Stmt::Fault { step, .. }
        | Stmt::Watch { at: step, .. } => Some(step),
        Stmt::Network(_)
        | Stmt::Let(..)
        | Stmt::Edge(_)
        | Stmt::SetFlag(..)
        | Stmt::SetCell(..)
        | Stmt::SetEntry(_)
        | Stmt::Write(..)
        | Stmt::Timer(_)
        | Stmt::TimerAt(_)
        | Stmt::TimerGoesOn { .. }
        | Stmt::Counter16(_)
        | Stmt::Counter16At(_)
        | Stmt::Counter32(_)
        | Stmt::Count(_)
        | Stmt::Reset(_)
        | Stmt::Block(_)
        | Stmt::If(_)
        | Stmt::For { .. }
        | Stmt::Repeat(_)
        | Stmt::CallSub(_)
        | Stmt::Return
        | Stmt::Parts(_)
        | Stmt::Goto(_)
        | Stmt::Stop
        | Stmt::Clear { .. } => None,
    }
}

/// A function that finds the bodies inside a statement, to look at them or to change them.
macro_rules! bodies {
    ($(#[$doc:meta])* $name:ident, $iter:ident $(, $mutable:tt)?) => {
        $(#[$doc])*
        pub fn $name(stmt: &$($mutable)? Stmt) -> impl Iterator<Item = &$($mutable)? Body> {
            let (own, parts): ([Option<&$($mutable)? Body>; 2], &$($mutable)? [Part]) = match stmt {
                Stmt::If(Branch { then, otherwise, .. }) => ([Some(then), Some(otherwise)], &$($mutable)? []),
                Stmt::For { body, .. } | Stmt::Repeat(Repeat { body, .. }) => {
                    ([Some(body), None], &$($mutable)? [])
                }
                Stmt::Parts(parts) => ([None, None], parts),
                Stmt::Network(_)
                | Stmt::Let(..)
                | Stmt::Edge(_)
                | Stmt::SetFlag(..)
                | Stmt::SetCell(..)
                | Stmt::SetEntry(_)
                | Stmt::Write(..)
                | Stmt::Timer(_)
                | Stmt::TimerAt(_)
                | Stmt::TimerGoesOn { .. }
                | Stmt::Counter16(_)
                | Stmt::Counter16At(_)
                | Stmt::Counter32(_)
                | Stmt::Count(_)
                | Stmt::Reset(_)
                | Stmt::Block(_)
                | Stmt::CallSub(_)
                | Stmt::Return
                | Stmt::Goto(_)
                | Stmt::Call(_)
                | Stmt::Fetch(_)
                | Stmt::Send(_)
                | Stmt::Fault { .. }
                | Stmt::Watch { .. }
                | Stmt::Stop
                | Stmt::Clear { .. } => ([None, None], &$($mutable)? []),
            };
            let parts = parts.$iter().map(|part| &$($mutable)? part.body);
            own.into_iter().flatten().chain(parts)
        }
    };
}

bodies! {
    /// The bodies directly inside a statement.
    bodies, iter
}
bodies! {
    /// The bodies directly inside a statement, to change them.
    bodies_mut, iter_mut, mut
}

/// Calls `visit` with every statement, those of the bodies inside it after it.
pub fn statements<'a>(body: &'a [Stmt], visit: &mut dyn FnMut(&'a Stmt)) {
    for stmt in body {
        visit(stmt);
        for inner in bodies(stmt) {
            statements(inner, visit);
        }
    }
}

/// Number of timer coils that counts as very many: more than any machine needs. Each takes a hundred bytes of code
/// where compilers inline it.
const MANY_TIMERS: usize = 1000;

/// Returns true if a program has too many timer coils to expand each inline.
pub fn has_many_timers(module: &Module) -> bool {
    let mut coils = 0;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            coils += usize::from(matches!(stmt, Stmt::Timer(_)));
        });
    }
    coils > MANY_TIMERS
}

/// Numbers of the functions that statements call.
pub fn callees(body: &[Stmt]) -> Vec<usize> {
    let mut found = Vec::new();
    statements(body, &mut |stmt| {
        if let Stmt::CallSub(function) = stmt {
            found.push(*function as usize);
        }
    });
    found
}

/// Functions that the scan cycle calls, by number. Subroutines that nothing calls are left out of emitted code.
pub fn called_functions(module: &Module) -> Vec<bool> {
    let mut called = vec![false; module.functions.len()];
    // `Begin`, `Main` and `End` come first.
    let by_host = |&i: &usize| {
        let kind = module.functions.get(i).map(|function| &function.kind);
        i < 3
            || matches!(
                kind,
                Some(FunctionKind::TakeInterrupts | FunctionKind::InputEdge { .. })
            )
    };
    let mut open: Vec<usize> = (0..called.len()).filter(by_host).collect();
    while let Some(i) = open.pop() {
        if let Some(known) = called.get_mut(i).filter(|known| !**known) {
            *known = true;
            open.extend(callees(&module.functions[i].body));
        }
    }
    called
}
