//! Interrupt routines: which there are, and when they run.

use super::Lowerer;
use super::advanced::Section;
use rungc_catalogue::Basic;
use rungc_ir::node::{
    Access, Action, BinOp, Body, Branch, CellId, Expr, ExprId, FlagId, Function, FunctionKind,
    Stmt, SysValue, Ty,
};
use rungc_models::interrupts::{Advanced, Capture, CountRows, Gate, Interrupt, PulseCatch, Source};
use rungc_rt::special::D_SCOPE_STATE;
use rungc_rt::{CmpOp, EdgeKind, Relay};
use rungc_syntax::DeviceClass::M;
use rungc_syntax::{Device, codes};

/// Name of the flag that EI sets.
const ENABLED: &str = "interrupts_enabled";

/// Source of a request and its action.
pub(super) struct Request {
    pub(super) source: Option<Source>,
    pub(super) what: What,
}

/// Action on a request.
pub(super) enum What {
    /// A routine runs.
    Routine {
        pointer: u32,
        function: u32,
        interrupt: Interrupt,
    },
    /// A routine runs, or continues where it was left.
    Process {
        pointer: u32,
        function: u32,
        interrupt: Advanced,
        at: CellId,
    },
    /// A relay catches the pulse.
    Catch(Relay),
    /// The oscilloscope continues, whether interrupts are enabled or not.
    Scope,
}

impl What {
    /// The relay that keeps a request.
    fn relay(&self) -> Option<Relay> {
        match self {
            What::Routine { interrupt, .. } => interrupt.request,
            What::Process { interrupt, .. } => Some(interrupt.again),
            What::Catch(_) | What::Scope => None,
        }
    }

    /// Returns true if a relay requests it or enables it, where relays keep requests.
    fn heeds(&self, relay: Relay) -> bool {
        match *self {
            What::Routine { interrupt, .. } => {
                let gate = match interrupt.gate {
                    Gate::Forbids(gate) | Gate::Allows(gate) => Some(gate),
                    Gate::Open => None,
                };
                interrupt
                    .request
                    .is_some_and(|request| request == relay || gate == Some(relay))
            }
            What::Process { interrupt, .. } => {
                [interrupt.request, interrupt.again, interrupt.mask].contains(&relay)
            }
            What::Catch(_) | What::Scope => false,
        }
    }

    /// The routine's pointer: of those that are requested together and have the same rank, the lower one runs first.
    fn pointer(&self) -> Option<u32> {
        match *self {
            What::Routine { pointer, .. } | What::Process { pointer, .. } => Some(pointer),
            What::Catch(_) | What::Scope => None,
        }
    }
}

/// The interrupts of a program.
#[derive(Default)]
pub(super) struct Interrupts {
    requests: Vec<Request>,
    /// The flags that sources set.
    flags: Vec<(Source, FlagId)>,
    /// Routines that may be left in the middle.
    pub(super) sections: Vec<Section>,
    /// Registers of edges, and their values when last read.
    pub(super) captures: Vec<(&'static Capture, CellId)>,
    /// A table of counts, and which of its rows waits.
    pub(super) rows: Option<(&'static CountRows, CellId)>,
    /// Requests that DI keeps waiting, if they run in the order in which they came.
    stored: Option<Stored>,
    /// The flag that EI sets, and the function that takes interrupts; `None` if there is nothing to take.
    function: Option<(FlagId, u32)>,
}

/// Requests that wait for EI.
struct Stored {
    /// Number of requests.
    count: CellId,
    /// The place of each source's among them, from 1; 0: it has none.
    places: Vec<CellId>,
}

impl Lowerer<'_> {
    /// Finds the interrupts, when all functions but the one that takes them are there.
    pub(super) fn find_interrupts(&mut self) {
        let mut requests = Vec::new();
        for region in self.flow.interrupts() {
            if let Some(interrupt) = self.model.interrupts.find_advanced(region.number) {
                requests.push(self.section(region.number, region.function, interrupt));
                continue;
            }
            match self.model.interrupts.find(region.number) {
                Some(interrupt) => requests.push(Request {
                    source: interrupt.source,
                    what: What::Routine {
                        pointer: region.number,
                        function: region.function,
                        interrupt,
                    },
                }),
                None => {
                    let instr = &self.resolved.program.instrs[region.start];
                    let message = format!("`{instr}` cannot be compiled: nothing requests it");
                    self.report(codes::NOT_IMPLEMENTED.at(instr.span, message));
                }
            }
        }
        keep_last_of_relays(&mut requests);
        requests.sort_by_key(|request| request.what.pointer());
        if let Some(catch) = self.model.interrupts.pulse_catch {
            requests.extend(self.caught(catch));
        }
        if self.model.has_oscilloscope() && self.specials.has(D_SCOPE_STATE) {
            self.clock();
            requests.push(Request {
                source: Some(Source::Period { ms: 1 }),
                what: What::Scope,
            });
        }
        if requests.is_empty() {
            return;
        }
        let enabled = self.flag(ENABLED.to_string(), "EI was executed", None);
        self.find_captures(&requests);
        self.find_rows(&requests);
        let flags = self.request_flags(&requests);
        self.interrupts.stored = self.stored_requests(&requests, &flags);
        let function = self.module.functions.len() as u32;
        self.module.functions.push(Function {
            kind: FunctionKind::TakeInterrupts,
            body: Body::new(),
        });
        self.interrupts.requests = requests;
        self.interrupts.flags = flags;
        self.interrupts.function = Some((enabled, function));
    }

    /// A flag for each source, and what sets it.
    fn request_flags(&mut self, requests: &[Request]) -> Vec<(Source, FlagId)> {
        let mut flags: Vec<(Source, FlagId)> = Vec::new();
        for source in requests.iter().filter_map(|request| request.source) {
            if flags.iter().any(|&(known, _)| known == source) {
                continue;
            }
            let period = match source {
                Source::Period { ms } => Some(ms),
                Source::Interpolation => Some(1),
                Source::Input { .. }
                | Source::Comparison { .. }
                | Source::Row { .. }
                | Source::PulsesEnd { .. } => None,
            };
            let flag = self.flag(flag_name(source), "requests an interrupt", period);
            match source {
                Source::Input { number, kind } => {
                    let captured = self.captured(number, kind);
                    let interrupts = |this: &mut Self| {
                        this.set_flag_to(flag, true);
                        this.capture_count(number);
                    };
                    self.on_edge(number, kind, |this| match captured {
                        Some(captured) => this.when(captured, interrupts),
                        None => interrupts(this),
                    });
                }
                Source::PulsesEnd { output } => {
                    self.module.flags[flag].pulses_end = Some(output);
                }
                Source::Period { .. }
                | Source::Interpolation
                | Source::Comparison { .. }
                | Source::Row { .. } => {}
            }
            flags.push((source, flag));
        }
        let precedence = self.model.interrupts.precedence;
        // Those of one rank stay in the order of their pointers.
        flags.sort_by_key(|&(source, _)| precedence.rank(source));
        flags
    }

    /// Places of requests that wait for EI, in a program that has more than one and a DI.
    fn stored_requests(
        &mut self,
        requests: &[Request],
        flags: &[(Source, FlagId)],
    ) -> Option<Stored> {
        let mut instructions = 0..self.resolved.instrs.len();
        let waits = instructions.any(|i| self.basic_at(i) == Some(Basic::Di));
        let first_come = self.model.interrupts.precedence.first_come;
        let routines = requests.iter().filter(|r| r.what.pointer().is_some());
        if !waits || !first_come || routines.count() < 2 {
            return None;
        }
        let count = self.cell("stored".to_string(), "how many requests wait for EI");
        let places = flags.iter().map(|&(source, _)| {
            let name = format!("{}_at", flag_name(source));
            self.cell(name, "its place among the requests that wait")
        });
        Some(Stored {
            count,
            places: places.collect(),
        })
    }

    /// No request waits when RUN begins.
    pub(super) fn forget_stored(&mut self) {
        let Some(stored) = &self.interrupts.stored else {
            return;
        };
        let cells: Vec<CellId> = stored
            .places
            .iter()
            .copied()
            .chain([stored.count])
            .collect();
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        let none = self.add(Expr::I32(0));
        self.when(first, |this| {
            for cell in cells {
                this.emit(Action::SetCell(cell, none));
            }
        });
    }

    /// The flag that a source sets, if it requests something.
    pub(super) fn request_flag(&self, source: Source) -> Option<FlagId> {
        let flags = &self.interrupts.flags;
        flags
            .iter()
            .find(|flag| flag.0 == source)
            .map(|flag| flag.1)
    }

    /// The pulse catch relays that something looks at.
    fn caught(&self, catch: PulseCatch) -> Vec<Request> {
        let enables = (0..self.resolved.instrs.len()).any(|i| self.basic_at(i) == Some(Basic::Ei));
        let relays = (0..catch.inputs).map(|number| (number, catch.first.after(number)));
        relays
            .filter(|&(_, relay)| enables && self.specials.has(relay))
            .map(|(number, relay)| Request {
                source: Some(Source::Input {
                    number,
                    kind: EdgeKind::Rising,
                }),
                what: What::Catch(relay),
            })
            .collect()
    }

    /// EI, DI.
    pub(super) fn enable_interrupts(&mut self, on: bool) {
        if let Some((enabled, _)) = self.interrupts.function {
            self.set_flag_to(enabled, on);
        }
    }

    /// Returns true if interrupts are taken while the program runs.
    pub(super) fn takes_interrupts(&self) -> bool {
        self.interrupts.function.is_some()
    }

    /// Here interrupts are taken.
    pub(super) fn interruptible(&mut self) {
        if let Some((_, function)) = self.interrupts.function {
            self.emit(Stmt::CallSub(function));
        }
    }

    /// An interrupt that a relay now requests, or no longer forbids, does not wait for the end of the network.
    pub(super) fn relay_changed(&mut self, device: Device) {
        let heeded = |request: &Request| {
            u16::try_from(device.number).is_ok_and(|number| request.what.heeds(Relay(number)))
        };
        if device.class == M && self.flow.in_main() && self.interrupts.requests.iter().any(heeded) {
            self.interruptible();
        }
    }

    /// The body of the function that takes interrupts: advanced ones first, then those that waited for EI, then the
    /// others by their sources' ranks.
    pub(super) fn take_interrupts(&mut self) {
        let Some((enabled, function)) = self.interrupts.function else {
            return;
        };
        let Interrupts {
            requests,
            flags,
            stored,
            ..
        } = std::mem::take(&mut self.interrupts);
        let body = self.body(|this| {
            for &(source, flag) in &flags {
                this.keep_requests(&requests, source, flag);
            }
            let cond = this.add(Expr::Flag(enabled));
            let then = this.body(|this| {
                for request in &requests {
                    this.serve_process(&request.what);
                }
                if let Some(stored) = &stored {
                    this.serve_stored(stored, &requests, &flags);
                }
                for &(source, flag) in &flags {
                    this.serve_source(&requests, source, flag);
                }
                for request in &requests {
                    this.serve_relay(&request.what);
                }
            });
            let otherwise = this.body(|this| {
                if let Some(stored) = &stored {
                    this.store_requests(stored, &flags);
                }
            });
            this.emit(Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }));
        });
        self.module.functions[function as usize].body = body;
    }

    /// While interrupts are disabled, new requests take their places.
    fn store_requests(&mut self, stored: &Stored, flags: &[(Source, FlagId)]) {
        for (&(_, flag), &place) in flags.iter().zip(&stored.places) {
            let asked = self.add(Expr::Flag(flag));
            let zero = self.add(Expr::I32(0));
            let at = self.add(Expr::Cell(place));
            let has_none = self.add(Expr::Cmp(CmpOp::Eq, at, zero));
            let is_new = self.and(asked, has_none);
            self.when(is_new, |this| {
                let next = this.one_behind(stored.count);
                this.emit(Action::SetCell(stored.count, next));
                let next = this.add(Expr::Cell(stored.count));
                this.emit(Action::SetCell(place, next));
            });
        }
    }

    /// Requests that waited run in the order of their places.
    fn serve_stored(&mut self, stored: &Stored, requests: &[Request], flags: &[(Source, FlagId)]) {
        let zero = self.add(Expr::I32(0));
        let count = self.add(Expr::Cell(stored.count));
        let any = self.add(Expr::Cmp(CmpOp::Gt, count, zero));
        self.when(any, |this| {
            let turn = this.temp(Ty::I32);
            this.emit(Action::Let(turn, zero));
            let body = this.body(|this| {
                let one = this.add(Expr::I32(1));
                let before = this.add(Expr::Temp(turn));
                let next = this.add(Expr::Bin(BinOp::Add, before, one));
                this.emit(Action::Let(turn, next));
                for (&(source, flag), &place) in flags.iter().zip(&stored.places) {
                    let turn = this.add(Expr::Temp(turn));
                    let at = this.add(Expr::Cell(place));
                    let is_next = this.add(Expr::Cmp(CmpOp::Eq, at, turn));
                    this.when(is_next, |this| {
                        this.emit(Action::SetCell(place, zero));
                        this.serve_source(requests, source, flag);
                    });
                }
            });
            let count = this.add(Expr::Narrow(count));
            this.emit(Stmt::For { count, body });
            this.emit(Action::SetCell(stored.count, zero));
        });
    }

    /// One more than a cell holds.
    fn one_behind(&mut self, cell: CellId) -> ExprId {
        let value = self.add(Expr::Cell(cell));
        let one = self.add(Expr::I32(1));
        self.add(Expr::Bin(BinOp::Add, value, one))
    }

    /// Relays keep the requests of a source, whether interrupts are enabled or not.
    fn keep_requests(&mut self, requests: &[Request], source: Source, flag: FlagId) {
        let relays: Vec<Relay> = of(requests, source)
            .filter_map(|request| request.what.relay())
            .collect();
        let scope = of(requests, source).any(|request| matches!(request.what, What::Scope));
        if relays.is_empty() && !scope {
            return;
        }
        let asked = self.add(Expr::Flag(flag));
        self.when(asked, |this| {
            this.set_flag_to(flag, false);
            for relay in relays {
                let on = this.bit_const(true);
                this.write_relay(relay, on);
            }
            if scope {
                this.oscilloscope();
            }
        });
    }

    /// Does what a source requests directly.
    fn serve_source(&mut self, requests: &[Request], source: Source, flag: FlagId) {
        let direct: Vec<&What> = of(requests, source)
            .map(|request| &request.what)
            .filter(|what| what.relay().is_none() && !matches!(what, What::Scope))
            .collect();
        if direct.is_empty() {
            return;
        }
        let asked = self.add(Expr::Flag(flag));
        self.when(asked, |this| {
            this.set_flag_to(flag, false);
            for what in direct {
                match *what {
                    What::Catch(relay) => {
                        let on = this.bit_const(true);
                        this.write_relay(relay, on);
                    }
                    What::Routine {
                        function,
                        interrupt,
                        ..
                    } => {
                        let allowed = this.allowed(interrupt.gate);
                        this.when(allowed, |this| {
                            this.emit(Stmt::CallSub(function));
                            this.signals_of_relays();
                        });
                    }
                    What::Process { .. } | What::Scope => {}
                }
            }
        });
    }

    /// Runs a routine whose request a relay keeps.
    fn serve_relay(&mut self, what: &What) {
        let What::Routine {
            function,
            interrupt,
            ..
        } = *what
        else {
            return;
        };
        let Some(relay) = interrupt.request else {
            return;
        };
        let asked = self.add(Expr::Read(Access::bit(relay)));
        let allowed = self.allowed(interrupt.gate);
        let runs = self.and(asked, allowed);
        self.when(runs, |this| {
            let off = this.bit_const(false);
            this.write_relay(relay, off);
            this.emit(Stmt::CallSub(function));
        });
    }

    /// Condition that a routine may run; a relay that is not used keeps its state at power-on.
    pub(super) fn allowed(&mut self, gate: Gate) -> ExprId {
        let (Gate::Forbids(relay) | Gate::Allows(relay)) = gate else {
            return self.bit_const(true);
        };
        let on = if self.specials.has(relay) {
            self.add(Expr::Read(Access::bit(relay)))
        } else {
            self.bit_const(self.model.is_on_at_power_on(relay))
        };
        match gate {
            Gate::Forbids(_) => self.not(on),
            Gate::Allows(_) | Gate::Open => on,
        }
    }
}

/// Of routines with one request relay (HM's, of one timer) the last one is known (hm-motion-controller §5.5.5).
fn keep_last_of_relays(requests: &mut Vec<Request>) {
    let mut relays = Vec::new();
    for i in (0..requests.len()).rev() {
        match requests[i].what.relay() {
            Some(relay) if relays.contains(&relay) => drop(requests.remove(i)),
            relay => relays.extend(relay),
        }
    }
}

/// Requests of a source.
fn of(requests: &[Request], source: Source) -> impl Iterator<Item = &Request> {
    requests
        .iter()
        .filter(move |request| request.source == Some(source))
}

/// `x000_rose`, `passed_10ms`.
fn flag_name(source: Source) -> String {
    match source {
        Source::Input { number, kind } => {
            let what = match kind {
                EdgeKind::Rising => "rose",
                EdgeKind::Falling => "fell",
            };
            format!("x{number:03o}_{what}")
        }
        Source::Period { ms } => format!("passed_{ms}ms"),
        Source::Interpolation => "interpolation".to_string(),
        Source::Comparison { pointer } | Source::Row { pointer } => {
            format!("i{pointer:03}_requested")
        }
        Source::PulsesEnd { output } => format!("y{output:03o}_ended"),
    }
}
