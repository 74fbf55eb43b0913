//! Between which values index registers lie where an index leads to a device, so that no more is stored than it can
//! lead to.
//!
//! A module is executed with intervals in the place of values: constants, sums, masks, comparisons on the way,
//! iterations of loops, and what one scan leaves to the next. An index register that nothing has written is 0. What is
//! known rests on one rule: **a host writes an index register only if it is observed** ([`Wanted::observe`]); other
//! registers it may write between two scans, so that nothing is known of them when a scan begins. Should a host break
//! the rule, or the watchdog end a scan halfway, an index may lead to a device that is not stored: it reads 0, and a
//! write goes nowhere.

mod eval;
mod interval;
mod state;
mod walk;

use crate::layout::Wanted;
use crate::node::{Access, Action, Body, Expr, ExprId, Module, Place, Stmt};
use crate::reach::{Footprint, of_expr, of_stmt};
use crate::walk::{bodies_mut, places_mut, statements};
use eval::Eval;
use interval::Interval;
use rungc_models::runs::{FIRST_SPECIAL, is_special};
use rungc_syntax::DeviceClass::{self, C, D, M, T};
use rungc_syntax::{Device, Index};
use state::Words;
use std::collections::BTreeSet;
use walk::Walk;

/// Range of an operand with an index register, as its user states it: an access beyond is the PLC's error 6706, like
/// one beyond the model's devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Bound {
    /// The operand as the program writes it, without its index.
    pub device: Device,
    /// The index register.
    pub index: Index,
    /// First number that it reaches.
    pub first: u32,
    /// Last number that it reaches, inclusive. A block whose length is a constant lies in these as a whole.
    pub last: u32,
}

/// Special devices that indexes are known to lead to. An index that only the end of the devices stops is not taken to
/// aim at special ones.
#[derive(Default)]
pub struct Reached {
    /// The devices.
    pub special: BTreeSet<(DeviceClass, u32)>,
    /// True if the program may write M8000–M8003 this way.
    pub writes_run_flags: bool,
}

impl Reached {
    /// Adds what another lowering reaches; whether that is more.
    pub fn add(&mut self, other: Reached) -> bool {
        let before = (self.special.len(), self.writes_run_flags);
        self.special.extend(other.special);
        self.writes_run_flags |= other.writes_run_flags;
        before != (self.special.len(), self.writes_run_flags)
    }

    fn add_footprint(&mut self, module: &Module, used: Footprint, stops: &BTreeSet<i32>) {
        let Place {
            class,
            number,
            index: Some(index),
        } = used.place
        else {
            return;
        };
        if !matches!(class, M | D) {
            return;
        }
        let last = module.model.runs(class).last().map_or(0, |run| run.1);
        let stopped =
            matches!(module.expr(index), Expr::Within { high, .. } if stops.contains(high));
        for (first, end) in used.reach(module.model, &module.exprs) {
            let aims = is_special(class, number) || end < last && !stopped;
            if first >= FIRST_SPECIAL && aims {
                self.special
                    .extend((first..=end).map(|number| (class, number)));
                self.writes_run_flags |= used.writes && class == M && first < FIRST_SPECIAL + 4;
            }
        }
    }
}

/// Fills in what is known of each [`Expr::Within`], and names the devices that an index leads to alone.
pub fn find(module: &mut Module, wanted: &Wanted) -> Reached {
    let is_within = |expr: &Expr| matches!(expr, Expr::Within { .. });
    if !module.exprs.iter().any(is_within) {
        return Reached::default();
    }
    let model = module.model;
    // Partners on a line write any device.
    let served = module.has_ports();
    let observed = |class, number| served || wanted.observes(model, class, number);
    let words = Words::of(module, observed);
    let found = Walk::run(Eval { module, words });
    for (expr, id) in module.exprs.iter_mut().zip(0..) {
        if let Expr::Within { low, high, .. } = expr {
            let bound = Interval {
                low: *low,
                high: *high,
            };
            let known = found.get(&ExprId(id)).and_then(|found| found.meet(bound));
            // An index that is never evaluated reaches nothing.
            let known = known.unwrap_or(Interval::of(bound.low.max(0).min(bound.high)));
            (*low, *high) = (known.low, known.high);
        }
    }
    let mut reached = Reached::default();
    let stops = stops(module);
    let mut note = |used| reached.add_footprint(module, used, &stops);
    for expr in &module.exprs {
        of_expr(module.model, expr, &mut note);
    }
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            of_stmt(module.model, stmt, &mut note)
        });
    }
    name_known(module);
    reached
}

/// The values at which the end of the devices stops an index, of this operand or of another one of its instruction.
fn stops(module: &Module) -> BTreeSet<i32> {
    let stop = |expr: &Expr| {
        let Expr::InRange { place, count, .. } = *expr else {
            return None;
        };
        let last = module.model.runs(place.class).last()?.1;
        let index = i64::from(last) + 1 - i64::from(count) - i64::from(place.number);
        i32::try_from(index).ok()
    };
    module.exprs.iter().filter_map(stop).collect()
}

/// Names devices that an index leads to alone, so that they need no number at run time.
fn name_known(module: &mut Module) {
    let model = module.model;
    let exprs = module.exprs.clone();
    let known = |place: &mut Place, count: u32| {
        let Some(index) = place.index else {
            return;
        };
        let Expr::Within { low, high, .. } = exprs[index] else {
            return;
        };
        let number = i64::from(place.number) + i64::from(low);
        if low == high
            && let Ok(number) = u32::try_from(number)
            && model.in_range(place.class, number.into(), count)
            && (count == 1 || !is_special(place.class, number))
        {
            *place = Place {
                number,
                index: None,
                ..*place
            };
        }
    };
    for expr in &mut module.exprs {
        // The width of counters is known when the place is made.
        if let Expr::Read(Access { place, .. }) = expr
            && place.class != C
        {
            known(place, 1);
        }
    }
    for function in &mut module.functions {
        each_place(&mut function.body, &mut |place, count| {
            if !matches!(place.class, T | C) {
                known(place, count);
            }
        });
    }
}

/// Calls `f` with the places that statements themselves name, and how many devices of a block begin there.
fn each_place(body: &mut Body, f: &mut impl FnMut(&mut Place, u32)) {
    for stmt in body {
        let count = if let Stmt::Do(Action::Block(block)) = stmt {
            block.written().1
        } else {
            1
        };
        places_mut(stmt, &mut |place| f(place, count));
        for inner in bodies_mut(stmt) {
            each_place(inner, f);
        }
    }
}
