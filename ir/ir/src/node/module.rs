//! Modules: a program with all that belongs to it.

use super::{Action, Body, CellId, Expr, ExprId, FlagId, Stmt, TableId, TempId, Ty, type_of};
use crate::layout::Layout;
use crate::walk::{calls_runtime, statements};
use rungc_models::{Model, Range, Variant};
use rungc_rt::comm::Protocols;
use rungc_rt::comm::codec::{self, Codec};
use rungc_rt::comm::modbus::Profile;
use rungc_rt::special::D_WATCHDOG_MS;
use rungc_rt::{EdgeKind, Register, Relay};
use rungc_syntax::{Device, DeviceClass, Index, NetworkRequest, Span};
use std::borrow::Cow;
use typed_index_collections::TiVec;

/// A private bit with a name; off at power-on and when RUN begins, unless it is retained.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Flag {
    /// An identifier in lower case, unique in the module: `x000_rose`.
    pub name: String,
    /// Meaning, for a comment.
    pub meaning: &'static str,
    /// Set each time that this many milliseconds of RUN have passed since the last time, or since RUN began
    /// ([`rungc_rt::Program::tick`]); `None`: by the program only.
    pub period_ms: Option<u32>,
    /// Set when a train of pulses of this output Y has been sent to its end ([`rungc_rt::Axis::take_end`], asked
    /// whenever pulses are counted).
    pub pulses_end: Option<u32>,
    /// Stays as it is over STOP and power-off, with the latched device that it belongs to, and records of latched
    /// devices hold it ([`rungc_rt::Program::is_reset`]).
    pub retained: bool,
}

/// A private `I32` with a name; 0 at power-on.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cell {
    /// An identifier in lower case, unique in the module: `c235_preset`.
    pub name: String,
    /// Meaning, for a comment.
    pub meaning: &'static str,
    /// Set to the time, as for [`SysValue::NowMs`](super::SysValue::NowMs), each time that a host reports it
    /// ([`rungc_rt::Program::tick`]).
    pub follows_time: bool,
}

/// Private `I32`s with a name; all 0 at power-on.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Table {
    /// An identifier in lower case, unique in the module: `table1`.
    pub name: String,
    /// Meaning, for a comment.
    pub meaning: &'static str,
    /// Number of entries, at least 1.
    pub length: u32,
}

/// Number of steps that a scan may repeat for each millisecond of the watchdog time D8000: more than the fastest PLC
/// executes.
pub const STEPS_PER_MS: u32 = 10_000;

/// The watchdog time of a model without D8000.
const WATCHDOG_MS: i16 = 200;

/// A network: a run of rungs that a comment in the emitted code introduces.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Network {
    /// Step number of its first instruction.
    pub step: u32,
    /// Its place in the source.
    pub span: Span,
    /// Line statement above it.
    pub statement: Option<String>,
    /// Note beside its coil.
    pub note: Option<String>,
}

/// An instruction of the program at which a fault can occur, for hosts that report it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Origin {
    /// Its step number, by which [`Action::Fault`] and others name it.
    pub step: u32,
    /// As the program writes it: `MOV D0 D100Z0`.
    pub text: String,
    /// The devices that it names with an index, from which the index may lead to one that the model does not have.
    pub indexed: Vec<(Device, Index)>,
}

/// Trigger of a function.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum FunctionKind {
    /// The main program.
    Main,
    /// Before each scan's main program: special relays and registers. Runs in STOP too, where nothing else does.
    Begin,
    /// After it, before the output refresh: END processing.
    End,
    /// A subroutine, by its pointer number.
    Subroutine(u32),
    /// An interrupt routine, by its pointer number.
    Interrupt(u32),
    /// Runs the interrupt routines that are requested. `Main` calls it at the start of each network, and after code
    /// that sets or resets a relay that requests or forbids one where relays keep requests (HM); `End` calls it first,
    /// and a host may between two scans ([`rungc_rt::Program::take_interrupts`]): nowhere else is the program
    /// interrupted, and no interrupt routine is itself. What is requested between two of these moments counts as
    /// requested together: then [`rungc_models::interrupts::Interrupts::precedence`] decides which comes first.
    TakeInterrupts,
    /// Runs when an input terminal changes ([`rungc_rt::Program::input_edge`]), between two scans.
    InputEdge {
        /// Terminal X, a plain number.
        input: u32,
        /// Kind of edge.
        kind: EdgeKind,
    },
    /// Calls the instructions that send pulses and look at inputs ([`rungc_rt::Needs::signals`]) once more, with the
    /// drive that they had last. The edges of these inputs call it, when the device X shows them, and so do interrupts
    /// that may give the signal.
    Signals,
}

impl FunctionKind {
    /// Returns true if a host calls it between two scans.
    pub fn runs_between_scans(&self) -> bool {
        matches!(
            self,
            FunctionKind::InputEdge { .. } | FunctionKind::TakeInterrupts
        )
    }
}

/// A function: no parameters, no result, no recursion.
#[derive(Clone, PartialEq, Debug)]
pub struct Function {
    /// Trigger of the function.
    pub kind: FunctionKind,
    /// Statements of the function.
    pub body: Body,
}

/// A compiled program.
#[derive(Clone, Debug)]
pub struct Module {
    /// Name for files and types, an identifier in lower case: `motor`.
    pub name: String,
    /// Name as the user wrote it, which [`Module::name`] need not hold whole: `Motor-1`.
    pub full_name: String,
    /// Name of the source for the header comment: `MAIN.csv`.
    pub source_name: String,
    /// Steps of the program.
    pub steps: u32,
    /// The model.
    pub model: &'static Model,
    /// The devices of the model, with those latched that the project's parameters choose: [`Model::ranges`] if they say
    /// nothing.
    pub ranges: Cow<'static, [Range]>,
    /// Expressions; an expression's operands have lower handles.
    pub exprs: TiVec<ExprId, Expr>,
    /// Types of the temporaries.
    pub temps: TiVec<TempId, Ty>,
    /// Number of edge memories.
    pub edges: u32,
    /// Number of private memories; slots 1..=states are used.
    pub states: u16,
    /// Slots 1..=run_states are those of the program's instructions, which RUN begins anew; the others last until
    /// power-off.
    pub run_states: u16,
    /// Texts.
    pub texts: Vec<String>,
    /// Private bits.
    pub flags: TiVec<FlagId, Flag>,
    /// Private numbers.
    pub cells: TiVec<CellId, Cell>,
    /// Private rows of numbers.
    pub tables: TiVec<TableId, Table>,
    /// Functions: `Begin`, `Main`, `End` first, in this order, then subroutines and interrupt routines,
    /// `TakeInterrupts` if there are any of these, `Signals` if there are any, and one for each edge that means
    /// something.
    pub functions: Vec<Function>,
    /// Outputs Y at which instructions send pulses, in order, each once. Their [`rungc_rt::Axis`] is idle at power-on.
    /// Pulses are counted ([`rungc_rt::advance_pulses`]) at the start of each scan before `Begin`, and each time that a
    /// host reports the time ([`rungc_rt::Program::tick`]).
    pub pulse_outputs: Vec<u32>,
    /// Serial ports, in order: those that instructions use, that the program sets up, and that a host opens. They are
    /// brought up to date ([`rungc_rt::advance_ports`]) when a scan begins, before `Begin`, when it ends, and each time
    /// that a host reports the time.
    pub ports: Vec<u8>,
    /// Protocols that each of these ports may speak, as far as its set-up is known.
    pub port_protocols: Vec<Protocols>,
    /// Requests that hosts with servers send to other servers over TCP, between two scans.
    pub requests: Vec<NetworkRequest>,
    /// The number of its only port, if that is nothing but a slave by Modbus RTU, set up by registers, which no
    /// instruction uses: [`rungc_rt::advance_slave`] brings it up to date.
    pub slave_alone: Option<u8>,
    /// Networks that [`Stmt::Network`] names.
    pub networks: Vec<Network>,
    /// The instructions at which faults can occur, by step.
    pub origins: Vec<Origin>,
    /// Comments on devices.
    pub comments: Vec<(DeviceClass, u32, String)>,
    /// Stored devices.
    pub layout: Layout,
    /// PLC of the model's family that the program is for, if that is known.
    pub variant: Option<&'static Variant>,
    /// Registers of fitted special modules that start with a value other than 0.
    pub fitted_words: Vec<(Register, i16)>,
    /// Special registers' values at power-on, of those stored.
    pub initial_words: Vec<(Register, i16)>,
    /// Special relays that are on at power-on, of those stored.
    pub initial_bits: Vec<Relay>,
}

impl Module {
    /// A program of no instructions, whose three functions do nothing. `name` is an identifier in lower case.
    pub fn empty(name: String, source_name: String, model: &'static Model) -> Self {
        let function = |kind| Function {
            kind,
            body: Body::new(),
        };
        Module {
            full_name: name.clone(),
            name,
            source_name,
            steps: 0,
            model,
            ranges: Cow::Borrowed(model.ranges),
            exprs: TiVec::new(),
            temps: TiVec::new(),
            edges: 0,
            states: 0,
            run_states: 0,
            texts: Vec::new(),
            flags: TiVec::new(),
            cells: TiVec::new(),
            tables: TiVec::new(),
            pulse_outputs: Vec::new(),
            ports: Vec::new(),
            port_protocols: Vec::new(),
            slave_alone: None,
            functions: [FunctionKind::Begin, FunctionKind::Main, FunctionKind::End]
                .map(function)
                .into(),
            requests: Vec::new(),
            networks: Vec::new(),
            origins: Vec::new(),
            comments: Vec::new(),
            layout: Layout::default(),
            variant: None,
            fitted_words: Vec::new(),
            initial_words: Vec::new(),
            initial_bits: Vec::new(),
        }
    }

    /// Special registers that start with a value other than 0, with those of the variant and of fitted modules.
    pub fn special_words(&self) -> impl Iterator<Item = (Register, i16)> + use<> {
        let own = self.variant.map_or(&[][..], |variant| variant.defaults);
        let changed = move |register: Register| own.iter().any(|&(own, _)| own == register);
        let usual = self.model.special_words();
        let usual = usual.filter(move |&(register, _)| !changed(register));
        let fitted = self.fitted_words.clone();
        usual.chain(own.iter().copied()).chain(fitted)
    }

    /// Returns true if a device retains its value over power-off. A special device that does begins with its default
    /// only when the PLC is switched on for the first time.
    pub fn is_latched(&self, class: DeviceClass, number: u32) -> bool {
        let mut ranges = self.ranges_of(class);
        ranges.any(|r| r.latched && (r.first..=r.last).contains(&number))
    }

    /// The ranges of a class, in order.
    pub fn ranges_of(&self, class: DeviceClass) -> impl Iterator<Item = &Range> {
        self.ranges.iter().filter(move |r| r.class == class)
    }

    /// The expression of a handle.
    pub fn expr(&self, id: ExprId) -> &Expr {
        &self.exprs[id]
    }

    /// Returns true if a host has to report input edges and time.
    pub fn takes_events(&self) -> bool {
        let by_host = |f: &Function| f.kind.runs_between_scans();
        self.sends_pulses() || self.has_ports() || self.functions.iter().any(by_host)
    }

    /// The instruction at a step, if a fault can occur there.
    pub fn origin(&self, step: u32) -> Option<&Origin> {
        let found = self.origins.binary_search_by_key(&step, |o| o.step);
        found.ok().map(|i| &self.origins[i])
    }

    /// Returns true if it has pulse outputs.
    pub fn sends_pulses(&self) -> bool {
        !self.pulse_outputs.is_empty()
    }

    /// Its serial ports, and what each of them may speak.
    pub fn serial_ports(&self) -> impl Iterator<Item = (u8, Protocols)> {
        let protocols = self.port_protocols.iter().copied();
        self.ports.iter().copied().zip(protocols)
    }

    /// Codecs of all protocols that its serial ports may speak.
    pub fn codecs(&self) -> impl Iterator<Item = &'static Codec> {
        let all = self.port_protocols.iter().copied();
        let all = all.fold(Protocols::NONE, Protocols::or);
        let codecs = codec::ALL.iter().copied();
        codecs.filter(move |codec| codec.protocols().meets(all))
    }

    /// Devices served by Modbus, if a port may speak that.
    pub fn modbus(&self) -> Option<&'static Profile> {
        let mut all = self.port_protocols.iter();
        let speaks = all.any(|protocols| protocols.meets(Protocols::MODBUS));
        speaks.then(|| self.model.ports.modbus(self.model.type_code()))
    }

    /// Returns true if it has serial ports.
    pub fn has_ports(&self) -> bool {
        !self.ports.is_empty()
    }

    /// The flags with a period, and their periods in milliseconds.
    pub fn periods(&self) -> impl Iterator<Item = (&Flag, u32)> {
        let flags = self.flags.iter();
        flags.filter_map(|flag| flag.period_ms.map(|ms| (flag, ms)))
    }

    /// Returns true if the end of a millisecond only sets flags, so that it may be reported while a scan runs.
    pub fn ticks_only_note(&self) -> bool {
        !self.sends_pulses()
            && !self.has_ports()
            && !self.cells.iter().any(|cell| cell.follows_time)
    }

    /// Returns true if a host has to report the time between scans.
    pub fn takes_time(&self) -> bool {
        let taken = |f: &Function| f.kind == FunctionKind::TakeInterrupts;
        self.sends_pulses()
            || self.has_ports()
            || self.cells.iter().any(|cell| cell.follows_time)
            || self.functions.iter().any(taken)
    }

    /// The steps that a scan may repeat in loops and by jumps back, with this watchdog time (D8000, at least 1): each
    /// [`Stmt::Watch`] takes its share. They are given anew when a scan begins, and last until the next one does.
    pub fn scan_steps(watchdog_ms: i16) -> u32 {
        watchdog_ms.max(1).unsigned_abs() as u32 * STEPS_PER_MS
    }

    /// The watchdog time D8000 at power-on, in milliseconds: that of a program that does not look at D8000.
    pub fn watchdog_ms(&self) -> i16 {
        match self.model.word_at_power_on(D_WATCHDOG_MS) {
            0 => WATCHDOG_MS,
            ms => ms,
        }
    }

    /// Returns true if the watchdog may cut a scan short.
    pub fn has_watchdog(&self) -> bool {
        self.any_statement(|stmt| matches!(stmt, Stmt::Watch { .. }))
    }

    /// Returns true if an instruction may fault, or something in the program stops the PLC: then a host can query the
    /// error ([`rungc_rt::LastError`]).
    pub fn may_fail(&self) -> bool {
        self.any_statement(|stmt| {
            calls_runtime(stmt)
                || matches!(
                    stmt,
                    Stmt::Watch { .. } | Stmt::Do(Action::Fault { .. } | Action::Stop)
                )
        })
    }

    fn any_statement(&self, is_it: impl Fn(&Stmt) -> bool) -> bool {
        let mut found = false;
        for function in &self.functions {
            statements(&function.body, &mut |stmt| found |= is_it(stmt));
        }
        found
    }

    /// Adds an expression.
    pub fn add(&mut self, expr: Expr) -> ExprId {
        self.exprs.push_and_get_key(expr)
    }

    /// Type of an expression.
    pub fn ty(&self, id: ExprId) -> Ty {
        type_of(&self.exprs, &self.temps, id)
    }
}
