//! Devices that an access may reach: the one rule that the layout, the validator and the passes share.
//!
//! A place without an index names one device, and the access starts there. **An index leads to any device of the class
//! that the model has**, general or special, regardless of the number it is added to ([`Expr::InRange`]); where it
//! leads to none, the operand does not exist, which is the PLC's error 6706 (h1u-h2u-programming §8.2). Several devices
//! together lie in one run ([`Model::runs`]): none continues from the general devices into the special ones. The range
//! of an index is known from [`Expr::Within`].

use crate::node::{
    Access, AccessKind, Action, Arg, Call, Count, Counter16Coil, Counter32Coil, Expr, ExprId,
    Fetch, IndexedCoil, Module, Place, Send, Stmt, TimerCoil,
};
use crate::walk::statements;
use rungc_models::Model;
use rungc_models::runs::{is_counter32, words_of_bits};
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass;
use std::ops::Range;
use typed_index_collections::TiSlice;

/// Devices that an expression or a statement uses: one, or several in a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Footprint {
    /// The first device.
    pub place: Place,
    /// Number of devices; `None`: to the end of the run.
    pub count: Option<u32>,
    /// They are one unit that code by number finds only in an array: a group of bits, or what the runtime is handed.
    pub in_array: bool,
    /// It may write them.
    pub writes: bool,
}

impl Footprint {
    fn of(place: Place, writes: bool) -> Self {
        Footprint {
            place,
            count: Some(1),
            in_array: false,
            writes,
        }
    }

    fn run(place: Place, count: Option<u32>, writes: bool) -> Self {
        Footprint {
            place,
            count,
            in_array: count != Some(1),
            writes,
        }
    }

    /// The runs of devices that it may meet, as (first, last).
    pub fn reach(&self, model: &Model, exprs: &TiSlice<ExprId, Expr>) -> Vec<(u32, u32)> {
        let Place { class, number, .. } = self.place;
        let (low, high) = match self.place.index.map(|index| &exprs[index]) {
            None => (0, 0),
            Some(&Expr::Within { low, high, .. }) => (low, high),
            Some(&Expr::I32(index)) => (index, index),
            Some(_) => (i32::MIN, i32::MAX),
        };
        let at = |by: i32| u32::try_from(i64::from(number) + i64::from(by)).unwrap_or(0);
        if i64::from(number) + i64::from(high) < 0 {
            return Vec::new();
        }
        let (low, high) = (at(low), at(high));
        let from_run = |(first, last): (u32, u32)| {
            let (low, high) = (first.max(low), last.min(high));
            let end = match self.count {
                Some(count) => high.saturating_add(count.max(1) - 1).min(last),
                None => last,
            };
            (low <= high).then_some((low, end))
        };
        model.runs(class).into_iter().filter_map(from_run).collect()
    }
}

/// Reports the devices of an access: the words of a pair separately, since that of Z is V and Z on some models.
pub(crate) fn of_access(
    model: &Model,
    access: Access,
    writes: bool,
    found: &mut impl FnMut(Footprint),
) {
    let place = access.place;
    match access.kind {
        AccessKind::Bit | AccessKind::WordBit(_) | AccessKind::Word => {
            found(Footprint::of(place, writes));
        }
        AccessKind::Pair | AccessKind::Float if place.index.is_none() => {
            found(Footprint::of(place, writes));
            if !is_counter32(place.class, place.number) {
                found(Footprint::of(place.high_word(model), writes));
            }
        }
        AccessKind::Pair | AccessKind::Float | AccessKind::Nibbles { .. } => {
            found(Footprint::run(place, Some(access.extent()), writes));
        }
    }
}

/// Reports the devices that an expression itself reads.
pub fn of_expr(model: &Model, expr: &Expr, found: &mut impl FnMut(Footprint)) {
    if let Expr::Read(access) = *expr {
        of_access(model, access, false, found);
    }
}

/// Reports the devices that a statement itself accesses, as [`of_action`] does.
pub fn of_stmt(model: &Model, stmt: &Stmt, found: &mut impl FnMut(Footprint)) {
    match stmt {
        Stmt::Do(action) => of_action(model, action, found),
        Stmt::Steps(steps) => {
            let first = Place::fixed(DeviceClass::S, steps.first);
            found(Footprint::run(first, Some(steps.states), false));
        }
        Stmt::Network(_)
        | Stmt::If(_)
        | Stmt::For { .. }
        | Stmt::Repeat(_)
        | Stmt::CallSub(_)
        | Stmt::Return
        | Stmt::Parts(_)
        | Stmt::Goto(_)
        | Stmt::Watch { .. } => {}
    }
}

/// Reports the devices that an action accesses, in addition to the reads of its expressions. The runtime may write the
/// operands passed to it.
pub fn of_action(model: &Model, action: &Action, found: &mut impl FnMut(Footprint)) {
    match *action {
        Action::Write(access, _) => of_access(model, access, true, found),
        Action::TimerAt(IndexedCoil { place, .. })
        | Action::Counter16At(IndexedCoil { place, .. })
        | Action::Reset { place, .. } => found(Footprint::of(place, true)),
        Action::Block(block) => {
            let (to, count) = block.written();
            found(Footprint::run(to, Some(count), true));
            if let Some(from) = block.source() {
                found(Footprint::run(from, Some(count), false));
            }
        }
        Action::Timer(TimerCoil { number, .. }) | Action::TimerGoesOn { number, .. } => {
            found(Footprint::of(Place::fixed(DeviceClass::T, number), true));
        }
        Action::Counter16(Counter16Coil { number, .. })
        | Action::Counter32(Counter32Coil { number, .. })
        | Action::Count(Count { number, .. }) => {
            found(Footprint::of(Place::fixed(DeviceClass::C, number), true));
        }
        Action::Call(ref call) => {
            let args = call.args.iter();
            args.for_each(|arg| of_arg(model, arg, call.wide, found));
            // These save and restore all index registers, whether the program names them or not.
            if matches!(call.function, RtFn::Zpush | RtFn::Zpop) {
                for class in [DeviceClass::V, DeviceClass::Z] {
                    found(Footprint::run(Place::fixed(class, 0), None, true));
                }
            }
        }
        Action::Fetch(Fetch { ref from, wide, .. }) => of_arg(model, from, wide, found),
        Action::Send(Send { ref to, wide, .. }) => of_arg(model, to, wide, found),
        Action::Let(..)
        | Action::Edge(_)
        | Action::SetFlag(..)
        | Action::SetCell(..)
        | Action::SetEntry(_)
        | Action::Fault { .. }
        | Action::RestartWatchdog
        | Action::Stop
        | Action::Clear { .. } => {}
    }
}

fn of_arg(model: &Model, arg: &Arg, wide: bool, found: &mut impl FnMut(Footprint)) {
    match *arg {
        Arg::Device { place, extent } => {
            found(Footprint::run(place, extent, true));
            if wide && place.class == DeviceClass::Z && model.z_pairs_with_v {
                let class = DeviceClass::V;
                found(Footprint::run(Place { class, ..place }, extent, true));
            }
        }
        Arg::Nibbles { place, extent, .. } => found(Footprint::run(place, extent, true)),
        Arg::WordBit { place, bit, extent } => {
            let words = extent.map(|bits| words_of_bits(bit, bits));
            found(Footprint::run(place, words, true));
        }
        Arg::Const { .. } | Arg::Float(_) | Arg::Text(_) | Arg::Buffer { .. } => {}
    }
}

/// Reports the devices that an action writes: as [`of_action`], without operands that the runtime is known only to
/// read.
pub fn written_by(model: &Model, action: &Action, found: &mut impl FnMut(Footprint)) {
    let mut found = |used: Footprint| {
        if used.writes {
            found(used);
        }
    };
    let Action::Call(call) = action else {
        return of_action(model, action, &mut found);
    };
    let written = match call.function.written_operands() {
        // Refreshing outputs changes nothing but terminals.
        _ if shows_outputs(call) => &[][..],
        Some(written) => written,
        None => return of_action(model, action, &mut found),
    };
    let args = written.iter().filter_map(|&operand| call.args.get(operand));
    args.for_each(|arg| of_arg(model, arg, call.wide, &mut found));
}

fn shows_outputs(call: &Call) -> bool {
    let is_output =
        |arg: &Arg| matches!(arg, Arg::Device { place, .. } if place.class == DeviceClass::Y);
    matches!(call.function, RtFn::Ref | RtFn::RefHm) && call.args.first().is_some_and(is_output)
}

/// Last output of any model (Y377).
const LAST_OUTPUT: u32 = 0o377;

/// Outputs for the directions of a model's axes, one for each of the outputs to which axes are bound
/// (hm-motion-controller §5.7.2).
pub fn axis_directions(model: &Model) -> Range<u32> {
    const FIRST: u32 = 0o10;
    FIRST..FIRST + model.pulses.outputs().len() as u32
}

/// Outputs Y on which ZRN and DSZR give their clear signals: the usual one, unless a register that may change names
/// another.
fn clear_signals(module: &Module, call: &Call) -> Vec<(DeviceClass, u32, u32)> {
    let all = vec![(DeviceClass::Y, 0, LAST_OUTPUT)];
    let operand = if call.function == RtFn::Zrn { 3 } else { 2 };
    let Some(Arg::Device { place, .. }) = call.args.get(operand) else {
        return all;
    };
    let outputs = module.model.pulses.outputs();
    let wiring = outputs.get(place.number as usize);
    let Some(wiring) = wiring.filter(|_| place.index.is_none()) else {
        return all;
    };
    let clears = [wiring.zrn_clear, wiring.home.and_then(|home| home.clear)];
    let mut found = Vec::new();
    for clear in clears.into_iter().flatten() {
        found.push((DeviceClass::Y, clear.output, clear.output));
        let Some(register) = clear.register else {
            continue;
        };
        let number = register.number();
        if may_change(module, (DeviceClass::D, number)) {
            return all;
        }
        // The register names an output as it is at power-on.
        let named = clear.named(module.model.word_at_power_on(register) as u16);
        found.extend(named.map(|output| (DeviceClass::Y, output, output)));
    }
    found
}

/// Returns true if a device may have another value than at power-on: power-off leaves it at any, the program may write
/// it, or it reads what a panel may write.
fn may_change(module: &Module, (class, number): (DeviceClass, u32)) -> bool {
    let mut found = module.is_latched(class, number);
    let mut note = |used: Footprint| {
        let runs = used.reach(module.model, &module.exprs).into_iter();
        let mut runs = runs.filter(|_| used.place.class == class);
        found |= runs.any(|(first, last)| (first..=last).contains(&number));
    };
    for expr in &module.exprs {
        of_expr(module.model, expr, &mut note);
    }
    let mut leads_anywhere = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            of_stmt(module.model, stmt, &mut note);
            leads_anywhere |=
                matches!(stmt, Stmt::Do(Action::Call(call)) if call.function.needs().anywhere);
        });
    }
    found || leads_anywhere
}

/// Runs of devices (class, first, last) that a call may write although no operand names them, in addition to special
/// devices; the program may have none of them. [`rungc_rt::Needs::anywhere`] is not among them.
pub fn beyond_operands(module: &Module, call: &Call) -> Vec<(DeviceClass, u32, u32)> {
    use DeviceClass::{S, Y};
    let mut runs = Vec::new();
    let needs = call.function.needs();
    if needs.clears {
        runs.extend(clear_signals(module, call));
    }
    if needs.axis {
        let directions = axis_directions(module.model);
        runs.push((Y, directions.start, directions.end.saturating_sub(1)));
    }
    if call.function == RtFn::Anr {
        // The annunciators.
        runs.push((S, 900, 999));
    }
    if call.function == RtFn::Ist {
        // It chooses one of the first states, and ends those of automatic operation with all outputs.
        runs.extend([(S, 0, 2), (Y, 0, LAST_OUTPUT)]);
        if let [
            _,
            Arg::Device { place: first, .. },
            Arg::Device { place: last, .. },
        ] = call.args[..]
        {
            runs.push((S, first.number, last.number));
        }
    }
    runs
}

/// The devices of a class that indexes lead to, as runs (first, last) in order. They are all in arrays, but for those
/// that are other names of index registers.
pub fn by_index(module: &Module, class: DeviceClass) -> Vec<(u32, u32)> {
    let mut runs = Vec::new();
    let mut note = |used: Footprint| {
        let index = used.place.index.map(|index| module.expr(index));
        let leads = index.is_some_and(|index| !matches!(index, Expr::Stride(..)));
        if leads && used.place.class == class {
            runs.extend(used.reach(module.model, &module.exprs));
        }
    };
    for expr in &module.exprs {
        of_expr(module.model, expr, &mut note);
    }
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            of_stmt(module.model, stmt, &mut note)
        });
    }
    runs.sort();
    let mut joined: Vec<(u32, u32)> = Vec::new();
    for (first, last) in runs {
        match joined.last_mut() {
            Some(before) if first <= before.1 + 1 => before.1 = before.1.max(last),
            _ => joined.push((first, last)),
        }
    }
    joined
}
