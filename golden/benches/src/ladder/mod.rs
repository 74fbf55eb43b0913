//! Programs to measure: plausible ladders of any length, made of random numbers.
//!
//! | kind | what it is like |
//! |---|---|
//! | `contacts` | rungs of series and parallel contacts, each coil driven once; contacts are inputs, outputs, recent relays, a few mode flags, and relays from anywhere |
//! | `stations` | the same eight rungs again and again, each time with the devices of the next station, as machines of several equal stations are programmed |
//! | `mixed` | `contacts` with timers, counters, moves, arithmetic, SET and RST |
//! | `process` | `contacts` with moves of blocks, shifts, queues, conversions and floats |
//! | `control` | `contacts` with PID loops and limits, which emitted C calls the runtime for |
//! | `sequence` | step ladders: rings of states with coils, timers and interlocks |
//! | `index` | `contacts` with tables of words and long words with index registers |
//! | `recipe` | `contacts` with blocks that are copied, filled, cleared, shifted, many with index registers |
//! | `display` | `contacts` with digits for lamps and from thumbwheels, selections of lamps, words as bits |
//! | `compare` | `contacts` with comparison contacts, CMP, ZCP, limits with hysteresis |
//! | `float` | `contacts` with scaled analogue values, filters, arithmetic of floats, LIMIT |
//!
//! [`list`](Ladder::list) is the program as an instruction list, [`hand::source`] the C that an engineer would write
//! for it.

mod compare;
mod control;
mod display;
mod driven;
mod float;
mod generate;
pub mod hand;
mod index;
mod list;
mod process;
mod recipe;
mod sequence;

pub use control::{Called, Control};
pub use driven::Driven;
pub use process::Process;
pub use sequence::Sequence;

use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Inputs X000 to X177 and outputs Y000 to Y177.
pub const TERMINALS: u32 = 128;

/// Relays M0 to M7679.
pub const RELAYS: u32 = 7680;

/// Relays that no rung drives in `contacts`: the modes of a machine.
pub const FLAGS: u32 = 16;

/// Kind of a program.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, clap::ValueEnum)]
pub enum Kind {
    /// Contacts and coils.
    Contacts,
    /// Equal stations.
    Stations,
    /// Timers, counters and arithmetic as well.
    Mixed,
    /// Blocks, shifts, queues, conversions and floats as well.
    Process,
    /// PID loops and limits as well.
    Control,
    /// Step ladders.
    Sequence,
    /// Tables with index registers as well.
    Index,
    /// Blocks of words as well.
    Recipe,
    /// Digits and lamps as well.
    Display,
    /// Comparisons as well.
    Compare,
    /// Floats and limits as well.
    Float,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 11] = [
        Kind::Contacts,
        Kind::Stations,
        Kind::Mixed,
        Kind::Process,
        Kind::Control,
        Kind::Sequence,
        Kind::Index,
        Kind::Recipe,
        Kind::Display,
        Kind::Compare,
        Kind::Float,
    ];

    /// As written in tables and names of programs.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Contacts => "contacts",
            Kind::Stations => "stations",
            Kind::Mixed => "mixed",
            Kind::Process => "process",
            Kind::Control => "control",
            Kind::Sequence => "sequence",
            Kind::Index => "index",
            Kind::Recipe => "recipe",
            Kind::Display => "display",
            Kind::Compare => "compare",
            Kind::Float => "float",
        }
    }
}

/// A device: class and number.
pub type Device = (DeviceClass, u32);

/// A contact.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Contact {
    /// Of which device.
    pub device: Device,
    /// Closed while the device is off.
    pub negated: bool,
}

/// Contacts, each in series or in parallel with everything in front of it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Chain {
    /// The first contact.
    pub first: Contact,
    /// The others, and whether each is in parallel.
    pub rest: Vec<(Contact, bool)>,
}

impl Chain {
    fn contacts(&self) -> impl Iterator<Item = &Contact> {
        std::iter::once(&self.first).chain(self.rest.iter().map(|(contact, _)| contact))
    }
}

/// Instruction driven by a rung's contacts. Numbers are those of devices: T, C, D, M.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Action {
    /// OUT Y or M.
    Coil(Device),
    /// OUT T, in units of 100 ms.
    Timer(u32, u32),
    /// OUT C.
    Counter(u32, u32),
    /// MOV K D.
    Constant(u32, u32),
    /// MOVP D D.
    MoveOnce(u32, u32),
    /// INCP D.
    IncrementOnce(u32),
    /// CMP D K M: the relay and the two after it are on if the register is greater, equal, less.
    Compare(u32, u32, u32),
    /// ADD, SUB, WAND or DADD, D D D.
    Arithmetic(Operation, [u32; 3]),
    /// SET M.
    Set(u32),
    /// RST M.
    Reset(u32),
    /// Additional instructions of `process`.
    Process(Process),
    /// Additional instructions of `control`.
    Control(Control),
    /// Instructions of other kinds; the coil of those that are contacts.
    Driven(Driven, Option<Device>),
}

/// Operation of [`Action::Arithmetic`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Operation {
    /// 16-bit sum.
    Add,
    /// 16-bit difference.
    Sub,
    /// Bit by bit.
    And,
    /// 32-bit sum of pairs.
    AddLong,
}

/// Contacts and what they drive.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Rung {
    /// The contacts.
    pub chain: Chain,
    /// A second block of contacts, and whether it is in parallel with the first.
    pub block: Option<(Chain, bool)>,
    /// Driven instruction.
    pub action: Action,
}

/// A program.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Ladder {
    /// Kind of program.
    pub kind: Kind,
    /// Its rungs.
    pub rungs: Vec<Rung>,
    /// Its step ladders, before the rungs.
    pub sequences: Vec<Sequence>,
    /// Program steps, as these programs count them: one for each contact, coil and END, 3 to 13 for other instructions.
    pub steps: u32,
}

impl Ladder {
    /// A program of about this many steps. There is room for 766 stations and for 4000 states; programs of them do not
    /// get longer.
    pub fn new(kind: Kind, steps: u32) -> Self {
        Self::with_seed(kind, steps, 1)
    }

    /// Another one of the same kind.
    pub fn with_seed(kind: Kind, steps: u32, seed: u32) -> Self {
        generate::ladder(kind, steps, seed)
    }

    /// The program as an instruction list.
    pub fn list(&self) -> String {
        list::list(self)
    }

    /// Number of instructions in a scan for which emitted C calls the runtime.
    pub fn calls(&self) -> usize {
        let calls = |rung: &&Rung| matches!(rung.action, Action::Control(c) if !c.is_settings());
        self.rungs.iter().filter(calls).count()
    }

    /// Bytes that the devices in use take, one for each bit: what a program needs at least.
    pub fn device_bytes(&self) -> u32 {
        let bytes = |class| match class {
            DeviceClass::T => 8,
            DeviceClass::C => 4,
            // Active, before, and about to be left.
            DeviceClass::S => 3,
            DeviceClass::D => 2,
            _ => 1,
        };
        self.used().iter().map(|(class, _)| bytes(*class)).sum()
    }

    /// The devices that are compared between implementations, in order: all but inputs and those of the PLC itself, and
    /// of step ladders only what a machine sees, no states and no timers.
    pub fn devices(&self) -> Vec<Device> {
        let inner: &[DeviceClass] = match self.kind {
            Kind::Sequence => &[DeviceClass::S, DeviceClass::T],
            _ => &[],
        };
        let mut devices: BTreeSet<Device> = self.used();
        devices.retain(|device| device.0 != DeviceClass::X && !control::is_special(*device));
        devices.retain(|device| !inner.contains(&device.0));
        devices.into_iter().collect()
    }

    fn used(&self) -> BTreeSet<Device> {
        let mut devices: BTreeSet<Device> =
            self.sequences.iter().flat_map(Sequence::devices).collect();
        for rung in &self.rungs {
            let blocks = rung.block.iter().map(|(chain, _)| chain);
            let chains = std::iter::once(&rung.chain).chain(blocks);
            devices.extend(chains.flat_map(Chain::contacts).map(|c| c.device));
            devices.extend(rung.action.devices());
        }
        devices
    }
}

impl Action {
    /// The devices that it reads and writes.
    fn devices(&self) -> Vec<Device> {
        use DeviceClass::{C, D, M, T};
        match *self {
            Action::Driven(ref driven, coil) => {
                driven.devices.iter().copied().chain(coil).collect()
            }
            Action::Coil(device) => vec![device],
            Action::Timer(n, _) => vec![(T, n)],
            Action::Counter(n, _) => vec![(C, n)],
            Action::Constant(_, to) => vec![(D, to)],
            Action::MoveOnce(from, to) => vec![(D, from), (D, to)],
            Action::IncrementOnce(n) => vec![(D, n)],
            Action::Compare(register, _, relay) => {
                vec![(D, register), (M, relay), (M, relay + 1), (M, relay + 2)]
            }
            Action::Arithmetic(Operation::AddLong, registers) => registers
                .iter()
                .flat_map(|&n| [(D, n), (D, n + 1)])
                .collect(),
            Action::Arithmetic(_, registers) => registers.iter().map(|&n| (D, n)).collect(),
            Action::Set(n) | Action::Reset(n) => vec![(M, n)],
            Action::Process(process) => process.devices(),
            Action::Control(control) => control.devices(),
        }
    }
}
