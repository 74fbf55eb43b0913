//! Ways through the IR: operands of expressions, expressions and bodies of statements, calls between functions.

use crate::node::{
    Access, Action, Arg, Block, Body, Branch, Call, Count, Counter16Coil, Counter32Coil, Edge,
    Expr, ExprId, Fetch, FunctionKind, IndexedCoil, Module, Part, Place, Repeat, Send, SetEntry,
    Steps, Stmt, TempId, TimerCoil,
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
        Expr::Read(Access { place, .. }) => [place.index.$index(), None],
        Expr::InRange { place, length, .. } => [place.index.$index(), length.$index()],
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

/// A part of an action; references to it are shared or mutable.
enum ActionPart<Value, Named, Result> {
    /// An expression that it evaluates, except for the index of a place.
    Value(Value),
    /// A place that it names.
    Place(Named),
    /// The temporary that it gives a value.
    Result(Result),
}

/// A function that calls `f` with the parts of an action in the order of evaluation, to look at them or to replace
/// them.
macro_rules! action_parts {
    ($name:ident, $of_arg:ident, $iter:ident $(, $mutable:tt)?) => {
        fn $of_arg<'a>(
            arg: &'a $($mutable)? Arg,
            f: &mut dyn FnMut(
                ActionPart<&'a $($mutable)? ExprId, &'a $($mutable)? Place, &'a $($mutable)? TempId>,
            ),
        ) {
            match arg {
                Arg::Const { index, .. } | Arg::Buffer { index, .. } => {
                    index.$iter().for_each(|index| f(ActionPart::Value(index)));
                }
                Arg::Device { place, .. } | Arg::Nibbles { place, .. } | Arg::WordBit { place, .. } => {
                    f(ActionPart::Place(place));
                }
                Arg::Float(_) | Arg::Text(_) => {}
            }
        }

        fn $name<'a>(
            action: &'a $($mutable)? Action,
            f: &mut dyn FnMut(
                ActionPart<&'a $($mutable)? ExprId, &'a $($mutable)? Place, &'a $($mutable)? TempId>,
            ),
        ) {
            use ActionPart::{Place, Result, Value};
            match action {
                Action::Let(out, value) => {
                    f(Value(value));
                    f(Result(out));
                }
                Action::Edge(Edge { index, input, out, .. }) => {
                    index.$iter().for_each(|index| f(Value(index)));
                    f(Value(input));
                    f(Result(out));
                }
                Action::SetFlag(_, value) | Action::SetCell(_, value) => f(Value(value)),
                Action::SetEntry(SetEntry { index, value, .. }) => {
                    f(Value(index));
                    f(Value(value));
                }
                Action::Write(access, value) => {
                    f(Place(&$($mutable)? access.place));
                    f(Value(value));
                }
                Action::Block(Block::Copy { from, to, length, .. }) => {
                    f(Place(from));
                    f(Place(to));
                    length.$iter().for_each(|length| f(Value(length)));
                }
                Action::Block(Block::Fill { to, length, value, .. }) => {
                    f(Place(to));
                    length.$iter().for_each(|length| f(Value(length)));
                    f(Value(value));
                }
                Action::Timer(TimerCoil { drive, preset, .. })
                | Action::Counter16(Counter16Coil { drive, preset, .. }) => {
                    f(Value(drive));
                    f(Value(preset));
                }
                Action::TimerAt(IndexedCoil { place, drive, preset })
                | Action::Counter16At(IndexedCoil { place, drive, preset }) => {
                    f(Place(place));
                    f(Value(drive));
                    f(Value(preset));
                }
                Action::Counter32(Counter32Coil { drive, down, preset, .. }) => {
                    f(Value(drive));
                    f(Value(down));
                    f(Value(preset));
                }
                Action::Count(Count { down, preset, .. }) => {
                    f(Value(down));
                    f(Value(preset));
                }
                Action::Reset { place, .. } => f(Place(place)),
                Action::Call(Call { args, drive, .. }) => {
                    for arg in args {
                        $of_arg(arg, f);
                    }
                    drive.$iter().for_each(|drive| f(Value(drive)));
                }
                Action::Fetch(Fetch { from, there, .. }) => {
                    $of_arg(from, f);
                    f(Result(there));
                }
                Action::Send(Send { to, value, .. }) => {
                    $of_arg(to, f);
                    f(Value(value));
                }
                Action::TimerGoesOn { .. }
                | Action::Fault { .. }
                | Action::RestartWatchdog
                | Action::Stop
                | Action::Clear { .. } => {}
            }
        }
    };
}

action_parts!(action_parts, arg_parts, iter);
action_parts!(action_parts_mut, arg_parts_mut, iter_mut, mut);

/// A function over the expressions that a statement evaluates, to look at them or to replace them.
macro_rules! for_exprs {
    ($(#[$doc:meta])* $name:ident, $of_action:ident, $parts:ident, $iter:ident $(, $mutable:tt)?) => {
        pub(crate) fn $of_action(action: &$($mutable)? Action, f: &mut impl FnMut(&$($mutable)? ExprId)) {
            $parts(action, &mut |part| match part {
                ActionPart::Value(value) => f(value),
                ActionPart::Place(place) => place.index.$iter().for_each(&mut *f),
                ActionPart::Result(_) => {}
            });
        }

        $(#[$doc])*
        pub fn $name(stmt: &$($mutable)? Stmt, f: &mut impl FnMut(&$($mutable)? ExprId)) {
            match stmt {
                Stmt::Do(action) => $of_action(action, f),
                Stmt::If(Branch { cond, .. }) => f(cond),
                Stmt::For { count, .. } => f(count),
                Stmt::Network(_)
                | Stmt::Repeat(_)
                | Stmt::Steps(_)
                | Stmt::CallSub(_)
                | Stmt::Return
                | Stmt::Parts(_)
                | Stmt::Goto(_)
                | Stmt::Watch { .. } => {}
            }
        }
    };
}

for_exprs! {
    /// Calls `f` with the expressions that a statement itself evaluates, without those of the bodies inside it.
    for_exprs, action_exprs, action_parts, iter
}
for_exprs! {
    /// Calls `f` with the expressions that a statement itself evaluates, to replace them.
    for_exprs_mut, action_exprs_mut, action_parts_mut, iter_mut, mut
}

/// Calls `f` with the places that a statement itself names, in addition to those in its expressions, to replace them.
pub(crate) fn places_mut(stmt: &mut Stmt, f: &mut impl FnMut(&mut Place)) {
    if let Stmt::Do(action) = stmt {
        action_parts_mut(action, &mut |part| {
            if let ActionPart::Place(place) = part {
                f(place);
            }
        });
    }
}

/// The temporary that a statement gives a value.
pub fn assigned(stmt: &Stmt) -> Option<TempId> {
    let mut temp = None;
    if let Stmt::Do(action) = stmt {
        action_parts(action, &mut |part| {
            if let ActionPart::Result(out) = part {
                temp = Some(*out);
            }
        });
    }
    temp
}

/// Returns true if a statement itself calls the runtime.
pub fn calls_runtime(stmt: &Stmt) -> bool {
    matches!(
        stmt,
        Stmt::Do(Action::Call(_) | Action::Fetch(_) | Action::Send(_))
    )
}

/// The step at which a statement reports a fault, if it can.
pub fn fault_step(stmt: &Stmt) -> Option<u32> {
    if let Stmt::Do(
        Action::Call(Call { step, .. })
        | Action::Fetch(Fetch { step, .. })
        | Action::Send(Send { step, .. })
        | Action::Fault { step, .. },
    )
    | Stmt::Watch { at: step, .. } = *stmt
    {
        Some(step)
    } else {
        None
    }
}

/// A function that finds the bodies inside a statement, to look at them or to change them.
macro_rules! bodies {
    ($(#[$doc:meta])* $name:ident, $iter:ident $(, $mutable:tt)?) => {
        $(#[$doc])*
        pub fn $name(stmt: &$($mutable)? Stmt) -> impl Iterator<Item = &$($mutable)? Body> {
            let (own, parts): ([Option<&$($mutable)? Body>; 2], &$($mutable)? [Part]) = match stmt {
                Stmt::If(Branch { then, otherwise, .. }) => ([Some(then), Some(otherwise)], &$($mutable)? []),
                Stmt::For { body, .. }
                | Stmt::Repeat(Repeat { body, .. })
                | Stmt::Steps(Steps { body, .. }) => ([Some(body), None], &$($mutable)? []),
                Stmt::Parts(parts) => ([None, None], parts),
                Stmt::Network(_)
                | Stmt::Do(_)
                | Stmt::CallSub(_)
                | Stmt::Return
                | Stmt::Goto(_)
                | Stmt::Watch { .. } => ([None, None], &$($mutable)? []),
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
            coils += usize::from(matches!(stmt, Stmt::Do(Action::Timer(_))));
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
        i < 3 || kind.is_some_and(FunctionKind::runs_between_scans)
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
