//! What the serial ports of a program may speak, as far as its set-up is known: all values of the registers and relays
//! that choose are constants that the program moves there.

use super::Lowerer;
use rungc_ir::layout::Wanted;
use rungc_rt::RtFn;
use rungc_rt::comm::codec::Codec;
use rungc_rt::comm::{Choice, PortWiring, Protocol, Protocols};
use rungc_rt::special::Register;
use rungc_rt::{Class, Plc, Ports, State, Sys};
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind};
use std::collections::BTreeSet;

/// The station number of a master on L01S, and one of a slave.
const STATIONS: [u16; 2] = [1, 255];

/// No instruction writes more registers than this before the one that matters, or it is one that writes blocks.
const LONGEST_BLOCK: u32 = 256;

impl Lowerer<'_> {
    /// Finds what each port may speak.
    pub(super) fn find_protocols(&mut self, wanted: &Wanted) {
        let ports = self.module.ports.iter();
        let protocols = ports.map(|&number| match self.model.ports.get(number) {
            Some(wiring) => self.protocols(wiring, wanted),
            None => Protocols::NONE,
        });
        self.module.port_protocols = protocols.collect();
        self.module.slave_alone = self.slave_alone();
    }

    /// The only port, if it is nothing but a slave by Modbus RTU that no instruction uses.
    fn slave_alone(&self) -> Option<u8> {
        let [number] = self.module.ports[..] else {
            return None;
        };
        let known = self.model.ports.get(number)?.may_be_slave_alone();
        let mut codecs = self.module.codecs().map(Codec::protocols);
        let is_slave = codecs.next() == Some(Protocols::of(&[Protocol::ModbusRtu]));
        let alone = codecs.next().is_none() && self.port_functions.is_empty();
        (known && is_slave && alone).then_some(number)
    }

    /// What a port may speak.
    fn protocols(&self, wiring: &PortWiring, wanted: &Wanted) -> Protocols {
        let mut protocols = match self.model.ports {
            Ports::Inovance | Ports::L01s | Ports::Hm => self.chosen(wiring, wanted),
            // More devices choose on FX and on boards.
            Ports::Without | Ports::Fx | Ports::Fx3 | Ports::Fx3g => Protocols::ALL,
            Ports::Board2n | Ports::Board3u => Protocols::ALL,
        };
        if protocols.contains(Protocol::ModbusRtu) && !wanted.without_qlink {
            protocols = protocols.or(Protocols::QLINK);
        }
        protocols.without(self.unused())
    }

    /// What the values of its registers and relays can choose for a port.
    fn chosen(&self, wiring: &PortWiring, wanted: &Wanted) -> Protocols {
        if wiring.choice == Choice::Can {
            let canlink = match self.port_functions.contains(&RtFn::Cannet) {
                true => Protocols::CANLINK,
                false => Protocols::NONE,
            };
            return Protocols::of(&[Protocol::Can]).or(canlink);
        }
        let values = self.values(wiring.protocol, wanted);
        let Some((numbers, formats)) = values.zip(self.values(wiring.format, wanted)) else {
            return Protocols::ALL;
        };
        let uinits = self.uinits(wiring);
        let relays = self.relays(wiring, wanted);
        let mut spoken = Vec::new();
        let words = formats
            .iter()
            .flat_map(|f| numbers.iter().map(move |n| (*f, *n)));
        let words = words.flat_map(|(f, n)| STATIONS.map(|station| [f, n, station]));
        for values in words.flat_map(|words| relays.iter().map(move |relays| (words, *relays))) {
            for running in [false, true] {
                let set_up = SetUp::new(self, wiring, values, running);
                let spoken_now = uinits.iter();
                spoken.extend(spoken_now.map(|&word| wiring.protocol(&set_up, [word, 0, 0])));
            }
        }
        spoken.into_iter().collect()
    }

    /// Protocols in which a port does nothing without instructions that the program does not have.
    fn unused(&self) -> Protocols {
        let calls = |functions: &[RtFn]| {
            let called = &self.port_functions;
            called.iter().any(|function| functions.contains(function))
        };
        // After UINIT the bits of HM's control word send and receive without further instructions.
        let free = [RtFn::Rs, RtFn::Rs2, RtFn::Usend, RtFn::Urcv, RtFn::Uinit];
        let mut unused = Protocols::NONE;
        if !calls(&free) {
            unused = unused.or(Protocols::of(&[Protocol::Free]));
        }
        let other = [RtFn::Rs2, RtFn::Usend, RtFn::Urcv, RtFn::Uinit];
        if self
            .port_functions
            .iter()
            .all(|function| other.contains(function))
        {
            unused = unused.or(Protocols::of(&[
                Protocol::MasterRtu,
                Protocol::MasterAscii,
                Protocol::MasterTable,
            ]));
        }
        unused
    }

    /// All values that a register may have; `None` if they are not known.
    fn values(&self, register: Option<Register>, wanted: &Wanted) -> Option<BTreeSet<u16>> {
        let Some(register) = register else {
            return Some(BTreeSet::from_iter([0]));
        };
        let number = register.number();
        if wanted.observes(self.model, DeviceClass::D, number) {
            return None;
        }
        let initial = self.module.initial_words.iter();
        let initial = initial.filter(|(of, _)| *of == register);
        let mut values = BTreeSet::from_iter(initial.map(|&(_, value)| value as u16));
        values.insert(0);
        for instr in &self.resolved.program.instrs {
            match writes(instr, number) {
                Written::Nothing => {}
                Written::Value(value) => {
                    values.insert(value);
                }
                Written::Anything => return None,
            }
        }
        Some(values)
    }

    /// All states that the relays of a port may have.
    fn relays(&self, wiring: &PortWiring, wanted: &Wanted) -> Vec<[bool; 2]> {
        let mut states = vec![[false; 2]];
        for (i, relay) in wiring.setup_relays().enumerate().take(2) {
            let number = relay.number();
            let named = |kind: &OperandKind| match *kind {
                OperandKind::Device(device, _) | OperandKind::Nibbles(_, device, _) => {
                    device.class == DeviceClass::M
                        && device.number <= number
                        && device.number + 32 > number
                }
                OperandKind::WordBit(..)
                | OperandKind::Decimal(..)
                | OperandKind::Hex(..)
                | OperandKind::Float(_)
                | OperandKind::Text(_)
                | OperandKind::Buffer { .. }
                | OperandKind::Unreadable(_) => false,
            };
            let instrs = self.resolved.program.instrs.iter();
            let mut operands = instrs.flat_map(|instr| &instr.operands);
            if wanted.observes(self.model, DeviceClass::M, number)
                || operands.any(|operand| named(&operand.kind))
            {
                let with: Vec<_> = states
                    .iter()
                    .map(|state| {
                        let mut state = *state;
                        state[i] = true;
                        state
                    })
                    .collect();
                states.extend(with);
            }
        }
        states
    }

    /// What UINIT may choose for a port, and what it is without.
    fn uinits(&self, wiring: &PortWiring) -> Vec<u16> {
        let all = (0..8).flat_map(|protocol| [protocol << 8, protocol << 8 | 1]);
        let mut words = vec![0];
        if wiring.choice != Choice::Uinit {
            return words;
        }
        for instr in &self.resolved.program.instrs {
            if !instr.mnemonic.starts_with("UINIT") {
                continue;
            }
            let constant = |i: usize| instr.operands.get(i).and_then(|o| o.kind.constant());
            let port = constant(3).and_then(|port| i32::try_from(port).ok());
            if port.is_some_and(|port| self.model.ports.named(port) != Some(wiring.number)) {
                continue;
            }
            match constant(0) {
                Some(word) => words.push(word as u16),
                None => return all.collect(),
            }
        }
        words
    }
}

/// What an instruction does to a register.
enum Written {
    Nothing,
    Value(u16),
    Anything,
}

/// What an instruction does to a special register. An index is taken to stay where it does not matter, as where ports
/// are found.
fn writes(instr: &Instr, register: u32) -> Written {
    let is = |i: usize, number: u32| {
        let operand = instr.operands.get(i).map(|operand| &operand.kind);
        matches!(operand, Some(OperandKind::Device(Device { class: DeviceClass::D, number: n }, None)) if *n == number)
    };
    let moves = matches!(instr.mnemonic.as_str(), "MOV" | "MOVP");
    if moves {
        let value = instr
            .operands
            .first()
            .and_then(|operand| operand.kind.constant());
        return match (is(1, register), value) {
            (false, _) => Written::Nothing,
            (true, Some(value)) => Written::Value(value as u16),
            (true, None) => Written::Anything,
        };
    }
    let compares = ["LD", "AND", "OR", "CMP"];
    if compares.iter().any(|name| instr.mnemonic.starts_with(name)) {
        return Written::Nothing;
    }
    let near = register.saturating_sub(LONGEST_BLOCK)..=register;
    let reaches = instr.operands.iter().any(|operand| match operand.kind {
        OperandKind::Device(device, None) | OperandKind::WordBit(device, _, None) => {
            device.class == DeviceClass::D
                && device.number >= rungc_rt::FIRST_SPECIAL
                && near.contains(&device.number)
        }
        OperandKind::Device(..)
        | OperandKind::WordBit(..)
        | OperandKind::Nibbles(..)
        | OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => false,
    });
    match reaches {
        true => Written::Anything,
        false => Written::Nothing,
    }
}

/// The devices that choose what a port speaks.
struct SetUp {
    words: [(Option<Register>, u16); 3],
    relays: Vec<(u32, bool)>,
    sys: Sys,
    ports: Ports,
    type_code: u16,
    state: State,
}

impl SetUp {
    /// With these values of format, number and station, and these states of the relays that choose.
    fn new(
        lowerer: &Lowerer,
        wiring: &PortWiring,
        (words, relays): ([u16; 3], [bool; 2]),
        running: bool,
    ) -> Self {
        let [format, number, station] = words;
        let numbers = wiring.setup_relays().map(|relay| relay.number());
        SetUp {
            words: [
                (wiring.format, format),
                (wiring.protocol, number),
                (wiring.station, station),
            ],
            relays: numbers.zip(relays).collect(),
            sys: Sys {
                running,
                ..Sys::power_on()
            },
            ports: lowerer.model.ports,
            type_code: lowerer.model.type_code(),
            state: State::new(),
        }
    }
}

impl Plc for SetUp {
    fn bit(&self, _class: Class, number: u32) -> Option<bool> {
        let mut relays = self.relays.iter();
        relays.find(|relay| relay.0 == number).map(|relay| relay.1)
    }

    fn set_bit(&mut self, _class: Class, _number: u32, _value: bool) -> Option<()> {
        None
    }

    fn word(&self, _class: Class, number: u32) -> Option<i16> {
        let is = |register: Option<Register>| register.is_some_and(|r| r.number() == number);
        let mut words = self.words.iter();
        words.find(|word| is(word.0)).map(|word| word.1 as i16)
    }

    fn set_word(&mut self, _class: Class, _number: u32, _value: i16) -> Option<()> {
        None
    }

    fn counter32(&self, _number: u32) -> Option<i32> {
        None
    }

    fn set_counter32(&mut self, _number: u32, _value: i32) -> Option<()> {
        None
    }

    fn state(&mut self, _slot: u16) -> &mut State {
        &mut self.state
    }

    fn sys(&self) -> &Sys {
        &self.sys
    }

    fn ports(&self) -> Ports {
        self.ports
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }

    fn reset(&mut self, _class: Class, _number: u32) -> Option<()> {
        None
    }
}
