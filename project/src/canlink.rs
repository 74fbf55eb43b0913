//! `[canlink]`: a PLC as a station of a CANlink 3.0 network (h1u-h2u-programming §5.9).
//!
//! The editor of H1U and H2U downloads the configuration of a whole network to its master, which passes it on; neither
//! the data nor the frames are published. Here each program has its own part of the configuration: it becomes
//! instructions at the end of the main program, CANNET, CANNODE and CANPUT, driven by their triggers.

use crate::{Error, Project};
use rungc_models::Model;
use rungc_rt::Ports;
use rungc_rt::comm::canlink::{HEARD, M_SYNCHRONOUS, WATCHED};
use rungc_rt::special::M_RUNNING;
use rungc_syntax::{Device, DeviceClass, Instr, Operand, OperandKind, Program, Span, codes};

/// Stations are 1 to 63.
pub(crate) const LAST_STATION: u32 = 63;
/// Entries of a master and of a slave at most.
pub(crate) const MOST_ENTRIES: [usize; 2] = [256, 16];
/// Stations whose words to all one station takes.
pub(crate) const MOST_HEARD: usize = 8;
/// Relays that send several entries together, and entries of each.
pub(crate) const MOST_TOGETHER: [usize; 2] = [8, 16];

/// This PLC in its network.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Station {
    /// Its number, as the switches of the card give it.
    pub station: u8,
    /// The number of the network's master.
    pub master: u8,
    /// Milliseconds between heartbeats; 0: there are none.
    pub heartbeat: u16,
    /// Slaves that the master watches.
    pub slaves: Vec<u8>,
    /// Stations whose words to all are for this one, too.
    pub listen: Vec<u8>,
    /// Entries that it sends.
    pub sends: Vec<Entry>,
    /// Position of the table.
    pub span: Span,
}

/// Entry that a station sends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Entry {
    /// Condition for sending.
    pub when: When,
    /// The first register D that is sent.
    pub from: u32,
    /// The receiver; 0: all that listen.
    pub to: u8,
    /// The first register D that the receiver writes.
    pub register: u16,
    /// Number of devices.
    pub count: u16,
    /// Position of the entry.
    pub span: Span,
}

/// Condition for sending an entry.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum When {
    /// Each time this many milliseconds have passed.
    Every(u16),
    /// A relay M is on, which is then switched off.
    Event(u32),
    /// M8291 of the master is on.
    Sync,
    /// The same as for a relay, and all receivers write at once.
    Together(u32),
}

/// Bits in the high byte of CANPUT's receiver.
const WAITS: u16 = 0x100;
const TAKE_EFFECT: u16 = 0x200;
const TOGETHER: u16 = 0x300;

/// Instructions that are at one place in the program.
struct Writer {
    span: Span,
    instrs: Vec<Instr>,
}

impl Writer {
    fn put(&mut self, mnemonic: &str, operands: &[OperandKind]) {
        let span = self.span;
        let operands = operands.iter().map(|kind| Operand {
            span,
            kind: kind.clone(),
        });
        self.instrs.push(Instr {
            mnemonic: mnemonic.into(),
            mnemonic_span: span,
            operands: operands.collect(),
            span,
            step: None,
            remarks: None,
        });
    }

    /// An instruction that a relay drives.
    fn driven(&mut self, relay: u32, mnemonic: &str, operands: &[OperandKind]) {
        self.put("LD", &[device(DeviceClass::M, relay)]);
        self.put(mnemonic, operands);
    }

    /// An entry that a relay drives; what the receiver does with it is in the high byte of the receiver.
    fn entry(&mut self, relay: u32, entry: &Entry, effect: u16) {
        let every = match entry.when {
            When::Every(ms) => ms,
            When::Event(_) | When::Sync | When::Together(_) => 0,
        };
        let operands = [
            decimal(every),
            device(DeviceClass::D, entry.from),
            OperandKind::Hex((effect | u16::from(entry.to)).into(), None),
            decimal(entry.register),
            decimal(entry.count),
        ];
        self.driven(relay, "CANPUT", &operands);
    }

    /// A command to all stations.
    fn command(&mut self, relay: u32, command: u16) {
        let none = decimal(0);
        let first = device(DeviceClass::D, 0);
        let command = OperandKind::Hex(command.into(), None);
        let operands = [none.clone(), first, command, none.clone(), none];
        self.driven(relay, "CANPUT", &operands);
    }

    fn reset(&mut self, relay: u32) {
        self.driven(relay, "RST", &[device(DeviceClass::M, relay)]);
    }
}

fn decimal(value: u16) -> OperandKind {
    OperandKind::Decimal(value.into(), None)
}

fn device(class: DeviceClass, number: u32) -> OperandKind {
    OperandKind::Device(Device { class, number }, None)
}

impl Station {
    /// Returns true if it is the master.
    pub fn is_master(&self) -> bool {
        self.station == self.master
    }

    /// The station as instructions that are at `span` in the program.
    fn instrs(&self, span: Span) -> Vec<Instr> {
        let always = M_RUNNING.number();
        let mut writer = Writer {
            span,
            instrs: Vec::new(),
        };
        let [station, master] = [self.station, self.master].map(|number| decimal(number.into()));
        writer.driven(
            always,
            "CANNET",
            &[station, master, decimal(self.heartbeat)],
        );
        for number in 1..=LAST_STATION as u8 {
            let role = |list: &[u8], role: u8| if list.contains(&number) { role } else { 0 };
            let roles = role(&self.slaves, WATCHED) | role(&self.listen, HEARD);
            if roles != 0 {
                let operands = [number, roles].map(|value| decimal(value.into()));
                writer.driven(always, "CANNODE", &operands);
            }
        }
        for entry in &self.sends {
            if matches!(entry.when, When::Every(_)) {
                writer.entry(always, entry, 0);
            }
        }
        self.triggered(&mut writer);
        writer.instrs
    }

    /// Writes the networks that relays trigger. Each is switched off after all that it drives.
    fn triggered(&self, writer: &mut Writer) {
        let mut triggers: Vec<_> = self.sends.iter().map(|entry| entry.when).collect();
        // The master passes M8291 on, whether or not it sends something itself.
        triggers.push(When::Sync);
        triggers.sort();
        triggers.dedup();
        for when in triggers {
            let (relay, effect, command) = match when {
                When::Every(_) => continue,
                When::Event(relay) => (relay, 0, None),
                When::Sync => {
                    let passes_on = self.is_master().then_some(TOGETHER);
                    (M_SYNCHRONOUS.number(), 0, passes_on)
                }
                When::Together(relay) => (relay, WAITS, Some(TAKE_EFFECT)),
            };
            for entry in self.sends.iter().filter(|entry| entry.when == when) {
                writer.entry(relay, entry, effect);
            }
            if let Some(command) = command {
                writer.command(relay, command);
            }
            writer.reset(relay);
        }
    }
}

impl Project {
    /// Makes a program a station of CANlink.
    pub(crate) fn add_station(&self, program: &mut Program, model: &Model) -> Result<(), Error> {
        let Some(station) = &self.canlink else {
            return Ok(());
        };
        if model.ports != Ports::Inovance {
            let message = format!("{} has no CANlink", model.title);
            let why = codes::PROJECT_VALUE.at(station.span, message);
            let help = "remove `[canlink]`, or choose the model h1u or h2u";
            return Err(self.error(why.help(help)));
        }
        self.add_at_end(program, |span| station.instrs(span));
        Ok(())
    }
}
