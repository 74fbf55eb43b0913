//! Timers that wait: while the same instances count and none of them can time out, a scan only adds up the time that
//! has passed. It reaches the values of the timers when an instance starts, stops or times out.
//!
//! That is possible for timers whose value the program does not look at and only their coil changes, and which one coil
//! with a constant preset runs in every scan of all instances.

use super::classify::Classes;
use crate::code::Code;
use crate::devices::run_timer;
use crate::expr::Around;
use crate::fields::{PrintField, PrintStorage};
use crate::writer::Writer;
use rungc_emit::plan::Node;
use rungc_ir::node::{Action, Expr, Stmt, TimerCoil};
use rungc_ir::reach::{Footprint, of_expr, of_stmt};
use rungc_ir::walk::statements;
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// A timer that waits.
#[derive(Clone, Debug)]
pub(super) struct Waiting {
    /// Statement that runs its timer in the struct `plc` with the time of `sys`, with `DRIVE` for the state of its
    /// coil.
    pub run: String,
    /// Its timer in the struct `plc`.
    pub device: String,
    /// Its contact, in lanes.
    pub done: String,
    /// The last state of its coil, in lanes.
    pub coil: String,
    /// The time that has passed and is not yet in the timers, in milliseconds.
    pub passed: String,
    /// Time that may pass before one of them times out.
    pub left: String,
    /// Remaining time of a timer, in milliseconds.
    pub rest: String,
}

/// The timers that wait, by number.
pub(super) fn waiting(classes: &Classes, writer: &mut Writer) -> BTreeMap<u32, Waiting> {
    let mut coils = BTreeMap::new();
    let plan = classes.plan;
    for (index, function) in plan.functions.iter().enumerate() {
        if function.root < 3 && function.is_whole() && !classes.is_left_early(index) {
            always(classes, &function.body, &mut coils);
        }
    }
    let Some(seen) = seen(classes) else {
        return BTreeMap::new();
    };
    coils.retain(|number, _| !seen.contains(number));
    let timers = coils.into_iter();
    timers
        .filter_map(|(number, coil)| Some((number, timer(classes, writer, coil)?)))
        .collect()
}

/// The coils that run in every scan of all instances, on whole lanes.
fn always(classes: &Classes, nodes: &[Node], found: &mut BTreeMap<u32, TimerCoil>) {
    for (node, sliced) in nodes.iter().zip(classes.of_nodes(nodes)) {
        match node {
            Node::Stmt(Stmt::Do(Action::Timer(coil))) if sliced => {
                found.insert(coil.number, *coil);
            }
            Node::Outlined(function) if sliced => {
                always(classes, &classes.plan.functions[*function].body, found);
            }
            Node::Stmt(_)
            | Node::Outlined(_)
            | Node::If { .. }
            | Node::For { .. }
            | Node::Parts { .. }
            | Node::Steps { .. }
            | Node::Repeat(_) => {}
        }
    }
}

/// The timers whose value something reads, or changes other than by their only coil; `None` if all are cleared at
/// times.
fn seen(classes: &Classes) -> Option<BTreeSet<u32>> {
    let module = classes.module;
    let (mut seen, mut coils) = (BTreeSet::new(), BTreeSet::new());
    let mut footprints: Vec<Footprint> = Vec::new();
    let mut clears = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            if let Stmt::Do(Action::Timer(coil)) = stmt {
                if !coils.insert(coil.number) {
                    seen.insert(coil.number);
                }
            } else if matches!(stmt, Stmt::Do(Action::Clear { .. })) {
                clears = true;
            } else {
                of_stmt(module.model, stmt, &mut |used| footprints.push(used));
            }
        });
    }
    for expr in module.exprs.iter().filter(|expr| expr.as_bit().is_none()) {
        of_expr(module.model, expr, &mut |used| footprints.push(used));
    }
    for used in footprints {
        if used.place.class == DeviceClass::T {
            for (first, last) in used.reach(module.model, &module.exprs) {
                seen.extend(first..=last);
            }
        }
    }
    (!clears).then_some(seen)
}

fn timer(classes: &Classes, writer: &mut Writer, coil: TimerCoil) -> Option<Waiting> {
    let kind = writer.coils.kind(coil.number, coil.kind);
    let keeps = kind.accumulating || kind.free_running || kind.latches_preset || kind.overruns;
    let is_constant = matches!(classes.module.expr(coil.preset), Expr::I16(_));
    if keeps || kind.stepwise || kind.shared || !is_constant {
        return None;
    }
    let (class, number, fields) = (DeviceClass::T, coil.number, classes.fields);
    let field = fields.find(class, number)?;
    let member = |what: &str| {
        let mut name = String::from("all->");
        field.name(&mut name);
        format!("{name}_{what}{}", field.subscript(number))
    };
    let mut device = String::new();
    if !fields.access(&mut device, class, number) {
        return None;
    }
    let mut preset = Code::new();
    writer.expr(&mut preset, coil.preset, Around::Exact);
    let mut run = Code::new();
    run_timer(&mut run, kind, &device, &Code::from("DRIVE"), &preset);
    Some(Waiting {
        run: run.as_str().replace("&plc->sys", "&sys"),
        done: super::mirror::in_lanes(&device),
        coil: member("coil"),
        passed: member("passed"),
        left: member("left"),
        rest: format!(
            "((uint32_t)({} - {device}.value) * {}u) - {device}.part_ms",
            preset.as_str(),
            kind.unit_ms
        ),
        device,
    })
}

impl Waiting {
    /// The instances that count.
    fn counting(&self) -> String {
        format!("{} & ~{}", self.coil, self.done)
    }

    /// Code that brings the timer of one instance up to date, in its struct `plc`.
    pub fn store(&self) -> String {
        format!(
            "    if (plc_in_lane({}, lane)) {{\n        plc_sys sys = all->sys;\n\n        sys.dt_ms = {};\n        {}\n    }}\n",
            self.counting(),
            self.passed,
            self.run.replace("DRIVE", "true")
        )
    }

    /// Code that brings the timers of all instances up to date.
    pub fn settle(&self, name: &str) -> String {
        let mut out = format!("    sys.dt_ms = {};\n", self.passed);
        // Writing to a String does not fail.
        let _ = write!(
            out,
            "    for (plc_lanes rest = {}; rest != 0u; rest &= rest - 1u) {{\n        \
             {name}_plc *const plc = &all->lane[plc_first_lane(rest)];\n\n        {}\n    }}\n    \
             {} = 0;\n    {} = 0;\n",
            self.counting(),
            self.run.replace("DRIVE", "true"),
            self.passed,
            self.left
        );
        out
    }
}
