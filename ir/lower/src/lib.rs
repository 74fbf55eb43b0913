//! Lowering: from instructions to the IR of [`rungc_ir::node`].
//!
//! One walk over the instructions. Contact logic is collected as an expression (`logic`) until an instruction consumes
//! it; operands become expressions and places with the conditions under which they exist (`operand`). Jumps and loops
//! are collected as items and made into structured statements when their body ends (`flow`). What the layout stores is
//! found last.
//!
//! This crate must not know file formats or output languages. Start reading at [`compile::compile`], the whole way from
//! a program to a module.

#![deny(clippy::wildcard_enum_match_arm)]

mod advanced;
mod annunciators;
mod arith;
mod axes;
mod blocks;
mod bounds;
mod build;
mod call;
mod capture;
mod coil;
mod comment;
pub mod compile;
mod count_rows;
mod count_table;
mod counter_words;
mod density;
mod digits;
mod drums;
mod edges;
mod errors;
mod extension;
mod flow;
mod high_speed;
mod indexed_blocks;
mod inline;
mod input_axes;
mod interrupt;
mod limits;
mod logic;
pub mod marks;
mod name;
mod operand;
mod origins;
mod parts;
mod ports;
mod protocols;
mod pulse_width;
mod queues;
mod resets;
mod sampling;
mod shared_timers;
mod signals;
mod special;
mod step_groups;
mod stl;
mod system;
mod times;
mod values;
mod watchdog;
mod words;

use self::comment::shortened;
pub use name::{module_name, stem};
use rungc_analysis::check::unimplemented::refusal;
use rungc_analysis::latches;
use rungc_analysis::resolve::{Resolution, Resolved};
use rungc_catalogue::{Basic, Drive, Join, Lower};
use rungc_ir::layout::{self, Wanted};
use rungc_ir::node::{Action, CellId, ExprId, Function, FunctionKind, Module, Network, Stmt};
use rungc_ir::ranges::{self, Bound, Reached};
use rungc_models::{Model, Variant};
use std::collections::BTreeMap;
use typed_index_collections::TiVec;

use flow::{Flow, Open};
use marks::Marks;
use parts::Item;
use rungc_rt::{EdgeKind, RtFn, TimerKind};
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, Instr, OperandKind};
use special::Specials;
use std::cell::OnceCell;

/// Options in addition to the program.
#[derive(Clone, Debug, Default)]
pub struct LowerOptions {
    /// Name of the module; else it is made from the name of the source.
    pub name: Option<String>,
    /// Devices that a host reads.
    pub wanted: Wanted,
    /// Ranges of operands with an index.
    pub bounds: Vec<Bound>,
    /// PLC of the model's family that the program is for, if that is known.
    pub variant: Option<&'static Variant>,
}

/// Lowers a program that was checked. What cannot be lowered (yet) is reported as errors, and then there is no module.
pub fn lower(resolved: &Resolved, options: &LowerOptions) -> (Option<Module>, Diagnostics) {
    let (lowered, findings) = lower_with(resolved, options, None);
    (lowered.map(|(module, _)| module), findings)
}

/// As [`lower`], with marks in the module, which say where its parts come from.
pub(crate) fn lower_marked(
    resolved: &Resolved,
    options: &LowerOptions,
) -> (Option<(Module, Marks)>, Diagnostics) {
    lower_with(resolved, options, Some(Marks::default()))
}

fn lower_with(
    resolved: &Resolved,
    options: &LowerOptions,
    marks: Option<Marks>,
) -> (Option<(Module, Marks)>, Diagnostics) {
    let mut findings = Diagnostics::new();
    bounds::check(resolved, &options.bounds, &mut findings);
    let mut reached = Reached::default();
    let (mut module, specials, indexes, resets, marks) = loop {
        let mut lowerer = Lowerer::new(resolved, options, &reached);
        lowerer.marks.clone_from(&marks);
        lowerer.program(&options.wanted);
        let Lowerer {
            mut module,
            diagnostics,
            specials,
            indexes,
            resets,
            marks,
            ..
        } = lowerer;
        if diagnostics.has_errors() || findings.has_errors() {
            findings.extend(diagnostics.sorted());
            return (None, findings);
        }
        // The scan keeps special devices that an index leads to, too: then it has to be lowered with them.
        if !reached.add(ranges::find(&mut module, &options.wanted)) {
            break (module, specials, indexes, resets, marks);
        }
    };
    bounds::costs(&module, &indexes, &mut findings);
    resets::shorten_tables(&mut module, &resets.entries);
    shared_timers::mark(&mut module);
    sampling::mark(&mut module);
    watchdog::watch(&mut module, resolved);
    layout::build(
        &mut module,
        &options.wanted,
        &specials.flags,
        &specials.whole,
    );
    module.origins = origins::find(&module, resolved);
    module.comments = resolved
        .program
        .comments
        .iter()
        .filter(|(device, _)| module.layout.area(device.class, device.number).is_some())
        .map(|(device, text)| (device.class, device.number, shortened(text)))
        .collect();
    module.variant = options.variant;
    module.initial_words = module
        .special_words()
        .filter(|(register, _)| {
            module
                .layout
                .area(DeviceClass::D, register.number())
                .is_some()
        })
        .collect();
    module.initial_bits = module
        .model
        .special_bits()
        .filter(|relay| module.layout.area(DeviceClass::M, relay.number()).is_some())
        .collect();
    debug_assert_eq!(rungc_ir::validate::validate(&module), Ok(()));
    (Some((module, marks.unwrap_or_default())), findings)
}

/// State of the walk.
struct Lowerer<'a> {
    resolved: &'a Resolved<'a>,
    model: &'static Model,
    module: Module,
    /// Depth of each expression's tree.
    depths: TiVec<ExprId, u8>,
    /// Runs of devices of each class, see [`Model::runs`].
    runs: Vec<Vec<(u32, u32)>>,
    specials: Specials,
    flow: Flow,
    diagnostics: Diagnostics,
    /// The instruction at hand.
    at: usize,
    /// Items of the current body.
    out: Vec<Item>,
    /// Bodies around it, from the outermost.
    open: Vec<Open>,
    logic: logic::Logic,
    steps: stl::Steps,
    interrupts: interrupt::Interrupts,
    /// Timers that continue in scans that do not execute their coils.
    free_running: BTreeMap<u32, TimerKind>,
    high_speed: high_speed::HighSpeed,
    resets: resets::Resets,
    edges: edges::Edges,
    signals: signals::Signals,
    /// Number of the instruction that runs, of those that run one at a time, from 1, and the count of such instructions
    /// so far.
    exclusive: Option<(CellId, i32)>,
    /// Devices that tests or a monitor look at.
    observed: &'a [(DeviceClass, u32)],
    /// Functions that work on serial ports, of those that the program calls.
    port_functions: Vec<RtFn>,
    /// Ranges of operands with an index, where given.
    bounds: &'a [Bound],
    /// Operands with an index.
    indexes: Vec<bounds::IndexUse>,
    /// The ordinary registers that instructions name, once it was asked.
    named: OnceCell<Vec<bool>>,
    /// Number of SPD so far.
    densities: usize,
    /// Number of inline matrices of switches.
    matrices: usize,
    /// Statement above a network that has not begun yet.
    heading: Option<String>,
    /// Sources of the module's parts, if requested.
    marks: Option<Marks>,
}

impl<'a> Lowerer<'a> {
    fn new(resolved: &'a Resolved<'a>, options: &'a LowerOptions, reached: &Reached) -> Self {
        let program = resolved.program;
        let model = resolved.model;
        let flow = Flow::of(resolved);
        let full_name = options.name.as_deref().unwrap_or(&program.source.name);
        Lowerer {
            resolved,
            model,
            module: Module {
                steps: resolved.steps,
                ranges: latches::ranges(program, model),
                requests: program
                    .parameters
                    .iter()
                    .flat_map(|p| p.requests.clone())
                    .collect(),
                exprs: TiVec::with_capacity(2 * resolved.instrs.len()),
                functions: Vec::new(),
                full_name: stem(full_name).to_owned(),
                ..Module::empty(module_name(full_name), program.source.name.clone(), model)
            },
            depths: TiVec::with_capacity(2 * resolved.instrs.len()),
            runs: DeviceClass::ALL.iter().map(|&c| model.runs(c)).collect(),
            specials: Specials::of(resolved, options, reached),
            logic: logic::Logic::of(resolved),
            steps: stl::Steps::of(resolved),
            interrupts: interrupt::Interrupts::default(),
            free_running: BTreeMap::new(),
            high_speed: high_speed::HighSpeed::default(),
            resets: resets::Resets::default(),
            edges: edges::Edges::default(),
            signals: signals::Signals::default(),
            exclusive: None,
            observed: &options.wanted.observe,
            port_functions: Vec::new(),
            bounds: &options.bounds,
            indexes: Vec::new(),
            named: OnceCell::new(),
            densities: 0,
            matrices: 0,
            flow,
            diagnostics: Diagnostics::new(),
            at: 0,
            out: Vec::new(),
            open: Vec::new(),
            heading: None,
            marks: None,
        }
    }

    fn program(&mut self, wanted: &Wanted) {
        for kind in [FunctionKind::Begin, FunctionKind::Main, FunctionKind::End] {
            self.module.functions.push(Function {
                kind,
                body: Vec::new(),
            });
        }
        for region in 0..self.flow.regions.len() {
            let kind = self.flow.regions[region].kind.clone();
            if kind != FunctionKind::Main {
                self.module.functions.push(Function {
                    kind,
                    body: Vec::new(),
                });
            }
        }
        self.find_counters();
        self.find_resets();
        self.limit_comparisons();
        self.find_exclusive();
        self.find_interrupts();
        self.guard_steps();
        self.limit_calls();
        for region in 0..self.flow.regions.len() {
            let body = self.region(region);
            let function = self.flow.regions[region].function as usize;
            self.module.functions[function].body = body;
        }
        self.module.run_states = self.module.states;
        self.find_ports(&wanted.ports);
        self.find_protocols(wanted);
        self.counter_edges();
        self.edge_counts();
        self.pulse_widths();
        self.signal_edges();
        self.stop_inputs();
        self.module.functions[0].body = self.begin_function();
        self.module.functions[2].body = self.end_function();
        self.take_interrupts();
        self.edge_functions();
    }

    fn instr(&self) -> &'a Instr {
        &self.resolved.program.instrs[self.at]
    }

    fn resolution(&self) -> &'a Resolution {
        &self.resolved.instrs[self.at]
    }

    fn operand(&self, i: usize) -> Option<&'a OperandKind> {
        self.instr().operands.get(i).map(|operand| &operand.kind)
    }

    fn step(&self) -> u32 {
        self.resolution().step
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Lowers the instruction at hand.
    fn instruction(&mut self) {
        let instr = self.instr();
        let Some(inst) = self.resolution().inst else {
            return;
        };
        if let Some(statement) = instr.statement() {
            self.heading = Some(statement.to_string());
        }
        let Some(lower) = self.resolution().lower else {
            return;
        };
        let is_label = matches!(lower, Lower::Basic(Basic::Label));
        if is_label {
            // A note on a label applies to the code after it.
            if self.heading.is_none() {
                self.heading = instr.note().map(shortened);
            }
        } else if self.begins_network() {
            self.begin_network();
        } else if let Some(network) = self.module.networks.last_mut() {
            network.span = network.span.to(instr.span);
        }
        if !is_label
            && let (Some(network), Some(note)) = (self.module.networks.last_mut(), instr.note())
        {
            network.note.get_or_insert_with(|| shortened(note));
        }
        match lower {
            Lower::Basic(basic) => self.basic(basic),
            Lower::Compare(join, op) => self.compare_contact(join, op),
            Lower::Call(function) => self.call(function),
            Lower::Exclusive(function) => self.exclusive_call(function),
            Lower::HighSpeed(comparison) => self.high_speed_compare(comparison),
            Lower::Density => self.density(),
            Lower::Values(op) => self.inline(|this| this.values(op)),
            Lower::Move => self.inline(|this| this.move_value(false)),
            Lower::MoveNot => self.inline(|this| this.move_value(true)),
            Lower::MoveCount => self.inline(Self::move_count),
            Lower::Axis(parameters) => self.inline(|this| this.axis_parameters(parameters)),
            Lower::Comment => self.inline(Self::device_comment),
            Lower::Cmp => self.inline(Self::compare),
            Lower::Zcp => self.inline(Self::compare_zone),
            Lower::Arith(op) => self.inline(|this| this.arith(op, false)),
            Lower::ArithSaturating(op) => self.inline(|this| this.arith(op, true)),
            Lower::Todo(what) => self.report(refusal(inst, what, instr.mnemonic_span)),
        }
        if inst.drive == Drive::Alone {
            self.logic.stack.clear();
        }
    }

    fn begins_network(&self) -> bool {
        self.logic.starts_rung[self.at]
            || self.instr_is(Basic::For)
            || self.instr_is(Basic::Stl) && !self.steps.continues_row[self.at]
    }

    fn begin_network(&mut self) {
        self.logic.stack.clear();
        let network = Network {
            step: self.step(),
            span: self.instr().span,
            statement: self.heading.take(),
            note: None,
        };
        // A state's own network begins in front of its block, which opens later.
        if self.instr_is(Basic::Stl) {
            self.close_state();
        }
        self.emit(Stmt::Network(self.module.networks.len() as u32));
        self.module.networks.push(network);
        self.mark_network();
        if self.flow.in_main() {
            self.interruptible();
        }
    }

    fn instr_is(&self, basic: Basic) -> bool {
        self.basic_at(self.at) == Some(basic)
    }

    /// Basic instruction at `i`.
    fn basic_at(&self, i: usize) -> Option<Basic> {
        basic_of(self.resolved, i)
    }

    fn basic(&mut self, basic: Basic) {
        match basic {
            Basic::Ld => self.contact(Join::Ld, false),
            Basic::Ldi => self.contact(Join::Ld, true),
            Basic::And => self.contact(Join::And, false),
            Basic::Ani => self.contact(Join::And, true),
            Basic::Or => self.contact(Join::Or, false),
            Basic::Ori => self.contact(Join::Or, true),
            Basic::Ldp => self.edge_contact(Join::Ld, EdgeKind::Rising),
            Basic::Ldf => self.edge_contact(Join::Ld, EdgeKind::Falling),
            Basic::Andp => self.edge_contact(Join::And, EdgeKind::Rising),
            Basic::Andf => self.edge_contact(Join::And, EdgeKind::Falling),
            Basic::Orp => self.edge_contact(Join::Or, EdgeKind::Rising),
            Basic::Orf => self.edge_contact(Join::Or, EdgeKind::Falling),
            Basic::Anb => self.join_blocks(Join::And),
            Basic::Orb => self.join_blocks(Join::Or),
            Basic::Mps => self.push_result(),
            Basic::Mrd => self.read_result(),
            Basic::Mpp => self.pop_result(),
            Basic::Inv => self.invert_result(),
            Basic::Mep => self.edge_of_result(EdgeKind::Rising),
            Basic::Mef => self.edge_of_result(EdgeKind::Falling),
            Basic::Out => self.coil(),
            Basic::Set | Basic::Rst => self.set_or_reset(basic == Basic::Set),
            Basic::Pls | Basic::Plf => self.pulse(basic),
            Basic::Mc => self.master_control(),
            Basic::Mcr => self.master_control_reset(),
            Basic::Stl => self.begin_state(),
            Basic::Ret => self.close_state(),
            Basic::For => self.begin_loop(),
            Basic::Next => self.end_loop(),
            Basic::Cj => self.jump(),
            Basic::Call => self.call_subroutine(),
            Basic::Label => self.label(),
            Basic::Fend | Basic::End | Basic::Sret => self.return_here(),
            Basic::Iret | Basic::Pret => self.end_interrupt(),
            Basic::Proc => self.process_begins(),
            Basic::Pend => self.process_ends(),
            Basic::Ei | Basic::Di => self.enable_interrupts(basic == Basic::Ei),
            Basic::Nop => {}
            Basic::Wdt => self.driven(|this| this.emit(Action::RestartWatchdog)),
        }
    }
}

/// Basic instruction at `i` of a program.
fn basic_of(resolved: &Resolved, i: usize) -> Option<Basic> {
    resolved.instrs.get(i)?.basic()
}
