//! From a device to the answer.

use crate::answer::{Cause, Link, Moment, Why, Writer};
use crate::causes::{Now, Search};
use crate::graph::{Id, Node};
use crate::history::{History, contacts};
use crate::sites::Sites;
use crate::trace::{Fixed, Recorder, Scan, Trace};
use crate::words::{Words, on_off};
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::{CrossReference, Reach, Use};
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_ir::node::FunctionKind;
use rungc_ladder::build;
use rungc_lower::marks::Marks;
use rungc_models::runs::is_special;
use rungc_rt::Plc as _;
use rungc_rt::special::M_OUTPUTS_OFF;
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass, OperandKind, Phrase, Program, phrase};
use std::sync::{Arc, Mutex, PoisonError};

/// Explains devices of a program.
pub struct Explainer<'p> {
    pub(crate) words: Words<'p>,
    module: &'p Module,
    marks: Arc<Marks>,
    sites: Arc<Sites>,
    pub(crate) uses: Vec<Use>,
}

impl<'p> Explainer<'p> {
    /// Of a program, compiled with marks and not optimised, with all devices that are asked for.
    pub fn new(program: &'p Program, module: &'p Module, marks: &Marks) -> Self {
        let (resolved, _) = resolve(program, module.model);
        let uses = CrossReference::new(&resolved).uses;
        let ladder = build::ladder(&resolved);
        Explainer {
            marks: Arc::new(marks.clone()),
            sites: Arc::new(Sites::of(module, marks, &resolved)),
            words: Words { resolved, ladder },
            module,
            uses,
        }
    }

    /// Returns true if an instruction names a device, or an area that it is in.
    pub fn has(&self, device: Device) -> bool {
        let mut uses = self.uses.iter();
        uses.any(|one| {
            let numbers = one.first.number..one.end();
            one.first.class == device.class && numbers.contains(&device.number)
        })
    }

    /// Lists what can switch a device, by the program alone.
    pub fn of_program(&self, device: Device) -> Why {
        let trace = self.conditions(device);
        let writers = self.writers(device, &trace, false);
        Why {
            device: device.to_string(),
            comment: self.words.comment(device),
            moment: None,
            notes: self.notes(device, &writers),
            writers: writers.into_iter().map(|(_, writer)| writer).collect(),
            causes: Vec::new(),
            because: Vec::new(),
            how: None,
        }
    }

    /// The conditions of the whole program, without executing it.
    pub(crate) fn conditions(&self, device: Device) -> Trace {
        let machine = Machine::new(self.module);
        let fixed = self.fixed(device);
        let mut trace = Trace::default();
        Scan::new(&fixed, &mut trace, &machine).program();
        trace
    }

    /// Explains a device at a moment of a run: what the next scan makes of it, with all else as it is. Afterwards the
    /// session is as before.
    pub fn at_moment(
        &self,
        session: &mut Session<'_>,
        scan_ms: Option<u64>,
        device: Device,
        history: Option<&History>,
    ) -> Why {
        let trace = self.look(session, scan_ms, device);
        let now = Now {
            session,
            trace,
            history,
        };
        // In STOP no scan takes place: the program alone says what could switch it.
        let writers = match now.session.machine().sys().running {
            true => self.writers(device, &now.trace, true),
            false => self.writers(device, &self.conditions(device), false),
        };
        let (causes, because) = self.causes(device, &now, &writers);
        Why {
            device: device.to_string(),
            comment: self.words.comment(device),
            moment: Some(self.moment(device, &now)),
            notes: [self.terminals(device, &now), self.notes(device, &writers)].concat(),
            writers: writers.into_iter().map(|(_, writer)| writer).collect(),
            causes,
            because,
            how: None,
        }
    }

    pub(crate) fn module(&self) -> &'p Module {
        self.module
    }

    fn fixed(&self, device: Device) -> Arc<Fixed> {
        let named = contacts(self.module).chain(self.sites.masters());
        Arc::new(Fixed {
            marks: Arc::clone(&self.marks),
            sites: Arc::clone(&self.sites),
            named: named.chain([device]).collect(),
        })
    }

    /// Looks on at the next scan, which does not take place.
    pub(crate) fn look(
        &self,
        session: &mut Session<'_>,
        scan_ms: Option<u64>,
        device: Device,
    ) -> Trace {
        let trace = Arc::new(Mutex::new(Trace::default()));
        let fixed = self.fixed(device);
        let recorder = Recorder {
            fixed: Arc::clone(&fixed),
            trace: Arc::clone(&trace),
        };
        let moment = session.save();
        let scan_ms = session.scan_ms(scan_ms);
        let other = session.machine_mut().take_observer();
        session.machine_mut().observe(Box::new(recorder));
        session.scan(scan_ms);
        session.machine_mut().take_observer();
        let mut trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
        let mut trace = std::mem::take(&mut *trace);
        Scan::new(&fixed, &mut trace, session.machine()).settle();
        session.restore(&moment);
        if let Some(other) = other {
            session.machine_mut().observe(other);
        }
        trace
    }

    fn moment(&self, device: Device, now: &Now) -> Moment {
        let value = self.value(device, now.session);
        let next = now.trace.bits.get(&device).filter(|_| is_bit(device));
        let next = next.map(|&id| on_off(now.trace.graph.value(id)));
        Moment {
            ms: Some(now.session.now_ms()),
            next: next.filter(|next| *next != value),
            value,
            running: now.session.machine().sys().running,
        }
    }

    /// Value of a device: `on`, `12`; of a timer or counter its contact.
    fn value(&self, device: Device, session: &Session) -> Phrase {
        if is_bit(device) {
            return on_off(state(session.machine(), device));
        }
        let reading = session.reading(Target::Word(device.class, device.number));
        reading.map_or_else(|| phrase!("unknown"), |reading| reading.to_string().into())
    }

    /// The instructions that may write a device, with their uses.
    pub(crate) fn writes(&self, device: Device) -> Vec<Use> {
        let writes = self.uses.iter().filter(|one| one.may_write(device));
        let mut found: Vec<Use> = writes.copied().collect();
        found.dedup_by_key(|one| one.instr);
        found
    }

    fn writers(&self, device: Device, trace: &Trace, moment: bool) -> Vec<(usize, Writer)> {
        let writes = self.writes(device).into_iter();
        let writer = |one: Use| {
            let drive = trace.drives.get(&one.instr);
            let text = |id: Id| self.words.condition(&trace.graph, id);
            let path = drive.map(|drive| drive.path);
            let path = path.filter(|&path| *trace.graph.node(path) != Node::Const(true));
            let mut notes = Vec::new();
            if drive.is_none() {
                notes.push(phrase!("No scan reaches it: nothing calls or jumps to it."));
            }
            match one.reach {
                Reach::Indexed => {
                    let index = self.words.index(one.instr).unwrap_or_default();
                    notes.push(phrase!(
                        "Index {index} selects the devices: it may be another one.",
                        index
                    ));
                }
                Reach::Open => notes.push(phrase!(
                    "A register decides how many devices it writes from {first} on.",
                    first = one.first
                )),
                Reach::Count(_) => {}
            }
            let on = |drive: &crate::trace::Drive| trace.graph.value(drive.on);
            let executed = trace.executed.contains(&one.instr);
            let writer = Writer {
                place: self.words.place(one.instr),
                effect: one.kind.word(),
                condition: drive.map_or_else(|| phrase!("unknown"), |drive| text(drive.on)),
                executed_if: path.map(text),
                notes,
                executed: moment.then_some(executed),
                driven: moment.then(|| executed && drive.is_some_and(on)),
            };
            (one.instr, writer)
        };
        writes.map(writer).collect()
    }

    /// What keeps the terminal of an output off though the output is on.
    fn terminals(&self, device: Device, now: &Now) -> Vec<Phrase> {
        let relay = Device {
            class: DeviceClass::M,
            number: M_OUTPUTS_OFF.number(),
        };
        let is_disabled = device.class == DeviceClass::Y && state(now.session.machine(), relay);
        let note = || {
            phrase!(
                "{relay} is on: the terminals of all outputs are off.",
                relay
            )
        };
        is_disabled.then(note).into_iter().collect()
    }

    /// Sentences about a device and its writers.
    fn notes(&self, device: Device, writers: &[(usize, Writer)]) -> Vec<Phrase> {
        let mut notes = Vec::new();
        let name = self.words.named(device);
        let of = |effect: &str| -> Vec<&Writer> {
            let writers = writers.iter().map(|(_, writer)| writer);
            writers.filter(|writer| writer.effect == effect).collect()
        };
        let coils = of("coil");
        if coils.len() > 1 {
            let steps: Vec<_> = coils.iter().map(|w| w.place.step.to_string()).collect();
            notes.push(phrase!(
                "{name} has {count} coils, at steps {steps}: the last one that is executed decides.",
                name,
                count = coils.len(),
                steps = steps.join(", ")
            ));
        }
        let is_bit = !matches!(device.class, DeviceClass::T | DeviceClass::C);
        let resets = of("reset").len();
        if !of("set").is_empty()
            && resets == 0
            && coils.is_empty()
            && is_bit
            && !self.is_step(device)
        {
            notes.push(phrase!("{name} is set, and no RST resets it.", name));
        } else if resets > 0 && resets == writers.len() && is_bit {
            notes.push(phrase!("{name} is reset, and nothing sets it.", name));
        }
        if self.sends_pulses(device) {
            notes.push(phrase!(
                "{name} sends pulses: whether it is on or off between two of them is not followed.",
                name
            ));
        }
        let latched = self.module.is_latched(device.class, device.number);
        if latched && !is_special(device.class, device.number) {
            notes.push(phrase!("{name} keeps its state over power-off.", name));
        }
        if writers.is_empty() {
            notes.push(match device.class {
                DeviceClass::X => phrase!("{name} is an input: its terminal decides.", name),
                _ if is_special(device.class, device.number) => phrase!(
                    "{name} is a special device: `rungc explain {device}` describes it.",
                    name,
                    device
                ),
                _ => phrase!(
                    "{name} is not written by any instruction: only something outside the program changes it.",
                    name
                ),
            });
        }
        notes
    }

    /// True for a state that has an STL, so that transitions to others reset it.
    fn is_step(&self, device: Device) -> bool {
        let program = self.words.resolved.program;
        let mut steps = program.instrs.iter();
        steps.any(|instr| {
            let operand = instr.operands.first().map(|operand| &operand.kind);
            instr.mnemonic == "STL"
                && matches!(operand, Some(OperandKind::Device(own, None)) if *own == device)
        })
    }

    /// The causes of a device's state, and the devices at which they end.
    fn causes(
        &self,
        device: Device,
        now: &Now,
        writers: &[(usize, Writer)],
    ) -> (Vec<Cause>, Vec<Link>) {
        let mut search = Search::new(self, now);
        // Pulses come between scans: what can be followed is the drive of the instructions that send them.
        let by_pulses = self.sends_pulses(device) && !now.trace.wrote.contains_key(&device);
        if is_bit(device) && !by_pulses {
            search.device(device, &mut Vec::new(), true);
        } else {
            for (instr, _) in writers {
                search.drive(device, *instr);
            }
        }
        let (causes, because) = search.found();
        let because = if by_pulses { Vec::new() } else { because };
        (causes, because)
    }

    /// Returns true for an output through which instructions send pulses.
    pub(crate) fn sends_pulses(&self, device: Device) -> bool {
        device.class == DeviceClass::Y && self.module.pulse_outputs.contains(&device.number)
    }
}

impl Scan<'_> {
    /// Follows all functions of the program without executing them.
    fn program(&mut self) {
        let yes = self.graph().constant(true);
        let module = self.module();
        for function in &module.functions {
            if is_program(&function.kind) {
                self.body(&function.body, yes, 0);
            }
        }
    }
}

fn is_program(kind: &FunctionKind) -> bool {
    matches!(
        kind,
        FunctionKind::Main | FunctionKind::Subroutine(_) | FunctionKind::Interrupt(_)
    )
}

/// Returns true if a device is a bit, or has a contact.
pub(crate) fn is_bit(device: Device) -> bool {
    use DeviceClass::{C, M, S, T, X, Y};
    matches!(device.class, X | Y | M | S | T | C)
}

/// State of a bit device.
pub(crate) fn state(machine: &Machine, device: Device) -> bool {
    let class = rt_class(device.class);
    class.and_then(|class| machine.bit(class, device.number)) == Some(true)
}
