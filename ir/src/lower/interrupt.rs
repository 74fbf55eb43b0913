//! Interrupt routines: which there are, and when they run.

use super::Lowerer;
use super::advanced::Section;
use super::operand::fixed;
use crate::catalogue::Basic;
use crate::interrupts::{self, Advanced, Capture, Gate, Interrupt, PulseCatch, Source};
use crate::node::{Body, CellId, EdgeKind, Expr, ExprId, FlagId, Function, FunctionKind, Stmt};
use rungc_syntax::{
    DeviceClass::{D, M},
    codes,
};

/// The register that starts the oscilloscope of HM.
const SCOPE_STATE: u32 = 8038;

/// Name of the flag that EI sets.
const ENABLED: &str = "interrupts_enabled";

/// What requests one thing to be done.
pub(super) struct Request {
    pub(super) source: Option<Source>,
    pub(super) what: What,
}

/// What is done on request.
pub(super) enum What {
    /// A routine runs.
    Routine { function: u32, interrupt: Interrupt },
    /// A routine runs, or goes on where it was left.
    Process {
        function: u32,
        interrupt: Advanced,
        at: CellId,
    },
    /// A relay catches the pulse.
    Catch(u32),
    /// The oscilloscope goes on, whether interrupts are enabled or not.
    Scope,
}

impl What {
    /// The relay that keeps a request.
    fn relay(&self) -> Option<u32> {
        match self {
            What::Routine { interrupt, .. } => interrupt.request,
            What::Process { interrupt, .. } => Some(interrupt.again),
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
    /// Registers of edges, and what they said when they were last read.
    pub(super) captures: Vec<(&'static Capture, CellId)>,
    /// The flag that EI sets, and the function that takes interrupts; `None` if there is nothing to take.
    function: Option<(FlagId, u32)>,
}

impl Lowerer<'_> {
    /// Finds the interrupts, when all functions but the one that takes them are there.
    pub(super) fn find_interrupts(&mut self) {
        let mut requests = Vec::new();
        for region in self.flow.interrupts() {
            if let Some(interrupt) = interrupts::find_advanced(self.model.id, region.number) {
                requests.push(self.section(region.number, region.function, interrupt));
                continue;
            }
            match interrupts::find(self.model.id, region.number) {
                Some(interrupt) => requests.push(Request {
                    source: interrupt.source,
                    what: What::Routine {
                        function: region.function,
                        interrupt,
                    },
                }),
                None => {
                    let instr = &self.resolved.program.instrs[region.start];
                    let message = format!("`{instr}` is not implemented yet: what requests it");
                    self.report(codes::NOT_IMPLEMENTED.at(instr.span, message));
                }
            }
        }
        // Of routines with one request relay (HM's, of one timer) the last one is known (hm-motion-controller §5.5.5).
        let mut relays = Vec::new();
        for i in (0..requests.len()).rev() {
            match requests[i].what.relay() {
                Some(relay) if relays.contains(&relay) => drop(requests.remove(i)),
                relay => relays.extend(relay),
            }
        }
        if let Some(catch) = interrupts::pulse_catch(self.model.id) {
            requests.extend(self.caught(catch));
        }
        if self.keeps(D, SCOPE_STATE) {
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
        let flags = self.request_flags(&requests);
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
                _ => None,
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
                    self.module.flags[flag.0 as usize].pulses_end = Some(output);
                }
                Source::Period { .. } | Source::Comparison { .. } => {}
            }
            flags.push((source, flag));
        }
        flags
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
    fn caught(&self, catch: &PulseCatch) -> Vec<Request> {
        let enables = (0..self.resolved.instrs.len()).any(|i| self.basic_at(i) == Some(Basic::Ei));
        let relays = (0..catch.inputs).map(|number| (number, catch.first + number));
        relays
            .filter(|&(_, relay)| enables && self.specials.has(M, relay))
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

    /// Here interrupts are taken.
    pub(super) fn interruptible(&mut self) {
        if let Some((_, function)) = self.interrupts.function {
            self.emit(Stmt::CallSub(function));
        }
    }

    /// The body of the function that takes interrupts: advanced ones first, then the others by their sources' ranks, those of the same
    /// rank in the order of their routines.
    pub(super) fn take_interrupts(&mut self) {
        let Some((enabled, function)) = self.interrupts.function else {
            return;
        };
        let Interrupts {
            requests,
            mut flags,
            ..
        } = std::mem::take(&mut self.interrupts);
        flags.sort_by_key(|&(source, _)| interrupts::rank(self.model.id, source));
        let body = self.body(|this| {
            for &(source, flag) in &flags {
                this.keep_requests(&requests, source, flag);
            }
            let on = this.add(Expr::Flag(enabled));
            this.when(on, |this| {
                for request in &requests {
                    this.serve_process(&request.what);
                }
                for &(source, flag) in &flags {
                    this.serve_source(&requests, source, flag);
                }
                for request in &requests {
                    this.serve_relay(&request.what);
                }
            });
        });
        self.module.functions[function as usize].body = body;
    }

    /// Relays keep the requests of a source, whether interrupts are enabled or not.
    fn keep_requests(&mut self, requests: &[Request], source: Source, flag: FlagId) {
        let relays: Vec<u32> = of(requests, source)
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
                this.write_device(M, relay, on);
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
                        this.write_device(M, relay, on);
                    }
                    What::Routine {
                        function,
                        interrupt,
                    } => {
                        let allowed = this.allowed(interrupt.gate);
                        this.when(allowed, |this| this.emit(Stmt::CallSub(function)));
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
        } = *what
        else {
            return;
        };
        let Some(relay) = interrupt.request else {
            return;
        };
        let asked = self.add(Expr::ReadBit(fixed(M, relay)));
        let allowed = self.allowed(interrupt.gate);
        let runs = self.and(asked, allowed);
        self.when(runs, |this| {
            let off = this.bit_const(false);
            this.write_device(M, relay, off);
            this.emit(Stmt::CallSub(function));
        });
    }

    /// Whether a routine may run; a relay that nothing looks at stays as it is at power-on.
    pub(super) fn allowed(&mut self, gate: Gate) -> ExprId {
        let (Gate::Forbids(relay) | Gate::Allows(relay)) = gate;
        let on = if self.specials.has(M, relay) {
            self.add(Expr::ReadBit(fixed(M, relay)))
        } else {
            let on = self.model.special_bits().any(|bit| bit == relay);
            self.bit_const(on)
        };
        match gate {
            Gate::Forbids(_) => self.not(on),
            Gate::Allows(_) => on,
        }
    }
}

/// What a source requests.
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
        Source::Comparison { pointer } => format!("i{pointer:03}_requested"),
        Source::PulsesEnd { output } => format!("y{output:03o}_ended"),
    }
}
