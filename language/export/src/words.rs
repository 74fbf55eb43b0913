//! Counterparts of instructions in IEC 61131-3: contacts, coils, functions, blocks and their variables.

use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{ArithOp, Basic, Form, Lower};
use rungc_frontend::iec_timer_unit;
use rungc_ladder::{Contact, InstrIndex, Item, Ladder, Node, Output, Shape};
use rungc_rt::CmpOp;
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind};
use std::collections::{BTreeMap, BTreeSet};

/// A contact or a comparison.
pub(super) enum Gate {
    /// A contact of a variable.
    Contact {
        variable: String,
        negated: bool,
        /// `rising`, `falling` or `none`.
        edge: &'static str,
    },
    /// A comparison of two words by a function of the standard.
    Compare {
        function: &'static str,
        words: [String; 2],
    },
    /// An instruction without a counterpart: its mnemonic as a contact at the rail, and its operands.
    Special {
        mnemonic: String,
        operands: Vec<String>,
    },
}

/// Output driven by contacts.
pub(super) enum Drive {
    /// A coil.
    Coil {
        variable: String,
        /// `set`, `reset` or `none`.
        storage: &'static str,
        /// `rising`, `falling` or `none`.
        edge: &'static str,
    },
    /// A TON that counts to a preset in milliseconds.
    Timer { timer: Device, preset: u64 },
    /// A jump.
    Jump(Device),
    /// A function of words whose result goes to a device.
    Compute {
        function: &'static str,
        words: Vec<String>,
        to: Device,
    },
    /// An instruction without a counterpart.
    Special {
        mnemonic: String,
        operands: Vec<String>,
    },
}

/// The words for the instructions of a program, and what has been named so far.
pub(super) struct Words<'a> {
    /// Devices that elements name, and the types of their variables.
    pub variables: BTreeMap<Device, &'static str>,
    /// Instructions that no function or block of the standard stands for.
    pub instructions: BTreeSet<String>,
    /// States that are steps of a chart.
    pub steps: BTreeSet<Device>,
    resolved: &'a Resolved<'a>,
    /// Timers that are TON, with the milliseconds that they count to.
    timers: BTreeMap<Device, u64>,
}

impl<'a> Words<'a> {
    pub fn new(resolved: &'a Resolved<'a>) -> Self {
        Words {
            variables: BTreeMap::new(),
            instructions: BTreeSet::new(),
            steps: BTreeSet::new(),
            resolved,
            timers: timers(resolved),
        }
    }

    pub fn resolved(&self) -> &'a Resolved<'a> {
        self.resolved
    }

    pub fn instr(&self, at: InstrIndex) -> &'a Instr {
        &self.resolved.program.instrs[at]
    }

    /// Implementation of an instruction, whichever its form; `None` for one that was only guessed.
    pub fn lower(&self, at: InstrIndex) -> Option<Lower> {
        let resolution = &self.resolved.instrs[at];
        resolution.lower.filter(|_| !resolution.meant)
    }

    /// The basic instruction that this is, if it is one.
    pub fn basic(&self, at: InstrIndex) -> Option<Basic> {
        match self.lower(at)? {
            Lower::Basic(basic) => Some(basic),
            _ => None,
        }
    }

    /// Implementation of an instruction of 16 bits that acts in each scan.
    fn plain(&self, at: InstrIndex) -> Option<Lower> {
        let plain = self.resolved.instrs[at].form == Form::default();
        self.lower(at).filter(|_| plain)
    }

    /// The statements of instructions, a line each.
    pub fn remarks(&self, instrs: std::ops::Range<InstrIndex>) -> Vec<&'a str> {
        instrs
            .filter_map(|at| self.instr(at).statement())
            .flat_map(str::lines)
            .collect()
    }

    /// The comment lines below the last instruction, if the networks include it.
    pub fn closing(&self, networks: &Ladder) -> Vec<&'a str> {
        let program = self.resolved.program;
        let end = networks.networks.last().map(|last| last.instrs.end);
        let is_last = end == Some(program.instrs.len());
        let lines = program.closing.as_deref().filter(|_| is_last);
        lines.into_iter().flat_map(str::lines).collect()
    }

    /// Returns true if a network is the END of the program, which a project does not have.
    pub fn is_end(&self, node: &Node) -> bool {
        let last = self.resolved.program.instrs.len() - 1;
        matches!(&node.items[..], [Item::Output(output)]
            if output.instr == last && self.basic(last) == Some(Basic::End))
    }

    pub fn contact(&mut self, contact: Contact) -> Gate {
        let instr = self.instr(contact.instr);
        let device = instr.operands.first().and_then(|o| o.kind.device());
        let variable = device.and_then(|device| self.bit(device));
        if let (Some(variable), true) = (variable, contact.shape != Shape::Compare) {
            return Gate::Contact {
                variable,
                negated: contact.shape == Shape::Closed,
                edge: match contact.shape {
                    Shape::Rising => "rising",
                    Shape::Falling => "falling",
                    Shape::Open | Shape::Closed | Shape::Compare => "none",
                },
            };
        }
        let function = match self.plain(contact.instr) {
            Some(Lower::Compare(_, op)) => Some(function(op)),
            _ => None,
        };
        let words: Option<Vec<_>> = instr.operands.iter().map(|o| self.word(&o.kind)).collect();
        let words = words.and_then(|words| <[String; 2]>::try_from(words).ok());
        if let (Some(words), Some(function)) = (words, function) {
            return Gate::Compare { function, words };
        }
        let mnemonic = match contact.shape {
            Shape::Open => "LD",
            Shape::Closed => "LDI",
            Shape::Rising => "LDP",
            Shape::Falling => "LDF",
            Shape::Compare => how(instr),
        };
        let operands = instr.operands.iter().map(|o| o.kind.to_string());
        let operands = operands.collect();
        Gate::Special {
            mnemonic: self.special(mnemonic),
            operands,
        }
    }

    pub fn output(&mut self, output: Output) -> Drive {
        let instr = self.instr(output.instr);
        let plain = instr.operands.first().and_then(|o| o.kind.device());
        let is_relay = |device: &Device| {
            use DeviceClass::{M, S, Y};
            matches!(device.class, Y | M | S)
        };
        let relay = plain.filter(|_| instr.operands.len() == 1).filter(is_relay);
        let does = self.plain(output.instr);
        let coil = match does {
            Some(Lower::Basic(Basic::Out)) => Some(("none", "none")),
            Some(Lower::Basic(Basic::Set)) => Some(("set", "none")),
            Some(Lower::Basic(Basic::Rst)) => Some(("reset", "none")),
            Some(Lower::Basic(Basic::Pls)) => Some(("none", "rising")),
            Some(Lower::Basic(Basic::Plf)) => Some(("none", "falling")),
            _ => None,
        };
        if let (Some((storage, edge)), Some(device)) = (coil, relay)
            && let Some(variable) = self.bit(device)
        {
            return Drive::Coil {
                variable,
                storage,
                edge,
            };
        }
        let timer = plain.filter(|_| matches!(does, Some(Lower::Basic(Basic::Out))));
        if let Some((timer, preset)) = timer.and_then(|t| Some((t, *self.timers.get(&t)?))) {
            self.variables.insert(timer, "TON");
            return Drive::Timer { timer, preset };
        }
        if let (Some(Lower::Basic(Basic::Cj)), Some(device)) = (does, plain) {
            return Drive::Jump(device);
        }
        let (function, inputs) = match does {
            Some(Lower::Move) => ("MOVE", 1),
            Some(Lower::Arith(ArithOp::Add) | Lower::ArithSaturating(ArithOp::Add)) => ("ADD", 2),
            Some(Lower::Arith(ArithOp::Sub) | Lower::ArithSaturating(ArithOp::Sub)) => ("SUB", 2),
            _ => ("", 0),
        };
        let words: Option<Vec<_>> = instr.operands.iter().map(|o| self.word(&o.kind)).collect();
        let last = instr.operands.last().and_then(|o| o.kind.device());
        if let (Some(mut words), 1.., Some(to)) = (words, inputs, last)
            && words.len() == inputs + 1
        {
            words.pop();
            return Drive::Compute {
                function,
                words,
                to,
            };
        }
        let operands = instr.operands.iter().map(|o| quoted(&o.kind)).collect();
        Drive::Special {
            mnemonic: self.special(&instr.mnemonic),
            operands,
        }
    }

    /// Notes that an instruction has no counterpart in the standard.
    pub fn special(&mut self, mnemonic: &str) -> String {
        self.instructions.insert(mnemonic.to_owned());
        mnemonic.to_owned()
    }

    /// The name of the variable that a bit is.
    fn bit(&mut self, device: Device) -> Option<String> {
        use DeviceClass::{C, M, S, T, X, Y};
        if self.steps.contains(&device) {
            return Some(format!("{device}.X"));
        }
        if self.timers.contains_key(&device) {
            self.variables.insert(device, "TON");
            return Some(format!("{device}.Q"));
        }
        if !matches!(device.class, X | Y | M | S | T | C) {
            return None;
        }
        self.variables.entry(device).or_insert("BOOL");
        Some(device.to_string())
    }

    /// A number as the standard writes it; `None` if it is neither a register nor a constant of 16 bits.
    fn word(&mut self, operand: &OperandKind) -> Option<String> {
        match *operand {
            OperandKind::Device(device, None) if device.class == DeviceClass::D => {
                self.variables.insert(device, "INT");
                Some(device.to_string())
            }
            OperandKind::Decimal(value, None) if i16::try_from(value).is_ok() => {
                Some(value.to_string())
            }
            OperandKind::Hex(value, None) if value <= 0xffff => Some(format!("16#{value:X}")),
            _ => None,
        }
    }
}

/// An operand as a list writes it.
fn quoted(operand: &OperandKind) -> String {
    match operand {
        OperandKind::Text(text) => format!("\"{}\"", text.replace('"', "\"\"")),
        other => other.to_string(),
    }
}

/// Suffix of a comparison's mnemonic: `=`, `D>=`.
fn how(instr: &Instr) -> &str {
    let mnemonic = instr.mnemonic.as_str();
    let joins = ["LD", "AND", "OR"].into_iter();
    joins
        .filter_map(|join| mnemonic.strip_prefix(join))
        .next()
        .unwrap_or(mnemonic)
}

/// The function of the standard that compares.
fn function(op: CmpOp) -> &'static str {
    match op {
        CmpOp::Eq => "EQ",
        CmpOp::Ne => "NE",
        CmpOp::Gt => "GT",
        CmpOp::Ge => "GE",
        CmpOp::Lt => "LT",
        CmpOp::Le => "LE",
    }
}

/// The timers that a TON stands for: driven once, by a constant, and of the same unit on all models.
fn timers(resolved: &Resolved) -> BTreeMap<Device, u64> {
    let mut found: BTreeMap<Device, Option<u64>> = BTreeMap::new();
    let instrs = resolved.program.instrs.iter().zip(&resolved.instrs);
    for (instr, resolution) in instrs {
        let operands = &instr.operands;
        let device = operands.first().and_then(|operand| operand.kind.device());
        let timer = device.filter(|device| device.class == DeviceClass::T);
        let (Some(timer), Some(Basic::Out)) = (timer, resolution.basic()) else {
            continue;
        };
        let count = operands.get(1).and_then(|preset| match preset.kind {
            OperandKind::Decimal(count, None) => u64::try_from(count).ok().filter(|n| *n > 0),
            _ => None,
        });
        let runs = resolved.model.timers.iter();
        let kind = runs.filter(|run| (run.first..=run.last).contains(&timer.number));
        let unit = kind.map(|run| u64::from(run.kind.unit_ms)).next();
        let same = unit.filter(|unit| iec_timer_unit(timer.number) == Some(*unit));
        let preset = same.and_then(|unit| Some(unit * count?));
        let entry = found.entry(timer);
        entry.and_modify(|preset| *preset = None).or_insert(preset);
    }
    let found = found.into_iter();
    found
        .filter_map(|(timer, preset)| Some((timer, preset?)))
        .collect()
}
