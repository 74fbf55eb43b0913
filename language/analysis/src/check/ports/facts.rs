//! The constants that a program writes to the registers and relays of its ports.

use super::super::Code;
use super::first_scan::{First, first_scan};
use crate::accesses;
use rungc_catalogue::{Basic, Lower};
use rungc_models::Model;
use rungc_rt::comm::{Choice, LineFormat, PortWiring, Protocol};
use rungc_rt::{Class, FIRST_SPECIAL, Plc, Ports, Register, Relay, RtFn, State, Sys};
use rungc_syntax::{Device, DeviceClass, Span};
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Deref;

/// Programs that reach special registers through an index stay this near, and those that write runs of devices whose
/// length is not a constant.
const USUAL_INDEX: u32 = 256;

/// The same for relays.
const USUAL_RELAY: u32 = 31;

/// Station, number of slaves and mode of an N:N link (h1u-h2u-programming §5.4).
pub(super) const NETWORK: [Device; 3] = {
    const fn register(number: u32) -> Device {
        let class = DeviceClass::D;
        Device { class, number }
    }
    [register(8176), register(8177), register(8178)]
};

/// One write to a register or relay.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Write {
    /// The instruction.
    pub(super) at: usize,
    /// The value, if it is a constant.
    pub(super) value: Option<u16>,
    /// True if it is executed in the first scan, whatever the devices of the program hold.
    pub(super) first_scan: bool,
    /// The only contact on which that depends, and true if it is normally open.
    pub(super) contact: Option<(Device, bool)>,
}

/// Set-up by UINIT.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Uinit {
    /// The instruction.
    pub(super) at: usize,
    /// True if its port is a constant; else it may be about another one.
    pub(super) certain: bool,
    /// Protocol and station, if they are a constant.
    pub(super) protocol: Option<u16>,
    format: Option<u16>,
}

impl Uinit {
    /// Protocol with station, and format, if all is constant.
    pub(super) fn words(&self) -> Option<[u16; 2]> {
        let words = self.protocol.zip(self.format).filter(|_| self.certain);
        words.map(|(protocol, format)| [protocol, format])
    }
}

/// All that is written.
pub(in super::super) struct Facts {
    model: &'static Model,
    /// By the register's or relay's device, in the order of the first scan.
    writes: BTreeMap<Device, Vec<Write>>,
    /// Registers that are written through an index, each with a set-up register near it and the place of the operand.
    pub(super) indexed: Vec<(Device, Device, Span)>,
    /// Set-up relays that an index may reach.
    indexed_relays: BTreeSet<Device>,
    /// By port.
    pub(super) uinit: BTreeMap<u8, Vec<Uinit>>,
}

/// Value of a register once the program has set it up.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum RegisterValue {
    /// The value at power-on.
    Default(u16),
    /// A constant.
    Constant(u16),
    /// That depends on what happens.
    Unknown,
}

impl RegisterValue {
    pub(super) fn known(self) -> Option<u16> {
        match self {
            RegisterValue::Default(value) | RegisterValue::Constant(value) => Some(value),
            RegisterValue::Unknown => None,
        }
    }
}

/// The device that a register is.
pub(super) fn d(register: Register) -> Device {
    let (class, number) = (DeviceClass::D, register.number());
    Device { class, number }
}

/// The device that a relay is.
pub(super) fn m(relay: Relay) -> Device {
    let (class, number) = (DeviceClass::M, relay.number());
    Device { class, number }
}

impl Facts {
    pub(in super::super) fn new(code: &Code) -> Self {
        let ports = code.model().ports.all().iter();
        let devices = ports.flat_map(PortWiring::sets).flat_map(|set| {
            let registers = set.setup_registers().chain(set.station).map(d);
            registers.chain(set.setup_relays().map(m))
        });
        let named = (0..code.len).filter_map(|i| super::port_register(code, i));
        let watched = BTreeSet::from_iter(devices.chain(named));
        let captures = code.model().interrupts.captures.iter();
        let captures = captures.map(|capture| d(capture.register));
        let named = watched.iter().copied().chain(NETWORK);
        let named = named.chain(captures).collect();
        let mut facts = Facts {
            model: code.model(),
            writes: BTreeMap::new(),
            indexed: Vec::new(),
            indexed_relays: BTreeSet::new(),
            uinit: BTreeMap::new(),
        };
        // Most programs set up no port.
        let first_scan = LazyCell::new(|| first_scan(code));
        for i in 0..code.len {
            facts.note(code, i, &first_scan, (&named, &watched));
        }
        let order = |write: &Write| {
            let order = first_scan[write.at].order.clone();
            order.unwrap_or_else(|| vec![write.at as u32])
        };
        let writes = facts.writes.values_mut();
        writes.for_each(|writes| writes.sort_by_cached_key(order));
        facts
    }

    /// Notes what instruction `i` writes, of devices that it names and of set-up registers and relays near an index.
    fn note(
        &mut self,
        code: &Code,
        i: usize,
        first_scan: &impl Deref<Target = Vec<First>>,
        (named, near): (&BTreeSet<Device>, &BTreeSet<Device>),
    ) {
        if matches!(code.lower(i), Some(Lower::Call(RtFn::Uinit))) {
            self.note_uinit(code, i);
        }
        let constants = LazyCell::new(|| constants(code, i));
        for access in accesses::of(code.resolved, i).filter(accesses::Access::writes) {
            let Device { class, number } = access.first;
            if access.indexed {
                self.note_index(&access, near);
                continue;
            }
            let further = match access.count {
                Some(count) => count.saturating_sub(1),
                None if number >= FIRST_SPECIAL => USUAL_INDEX,
                None => continue,
            };
            let last = Device {
                class,
                number: number.saturating_add(further),
            };
            for &device in named.range(access.first..=last) {
                let first = &first_scan[i];
                let value = constants.get(&device).copied();
                self.writes.entry(device).or_default().push(Write {
                    at: i,
                    value,
                    first_scan: first.order.is_some(),
                    contact: first.contact,
                });
            }
        }
    }

    /// Notes an access from a special device on, whose index may lead to a set-up device.
    fn note_index(&mut self, access: &accesses::Access, watched: &BTreeSet<Device>) {
        let Device { class, number } = access.first;
        let reached = |number| Device { class, number };
        if class == DeviceClass::M {
            let near = access.first..=reached(number.saturating_add(USUAL_RELAY));
            self.indexed_relays.extend(watched.range(near).copied());
        }
        if class != DeviceClass::D || number < FIRST_SPECIAL {
            return;
        }
        let above = reached(number.saturating_add(1))..=reached(number.saturating_add(USUAL_INDEX));
        let below = reached(number.saturating_sub(USUAL_INDEX))..=access.first;
        let near = watched.range(above).next();
        if let Some(&near) = near.or_else(|| watched.range(below).next_back()) {
            self.indexed.push((access.first, near, access.span));
        }
    }

    fn note_uinit(&mut self, code: &Code, i: usize) {
        let word = |n: usize| constant(code, i, n).map(|value| value as u16);
        let ports = code.model().ports;
        let operand = code.instr(i).operands.last();
        let operand = operand.and_then(|operand| operand.kind.constant());
        let named = operand.map(|port| ports.named(i32::try_from(port).ok()?));
        let uinit = Uinit {
            at: i,
            certain: named.is_some(),
            protocol: word(0),
            format: word(1),
        };
        let all = ports.all().iter();
        let set_up = all.filter(|wiring| wiring.choice == Choice::Uinit);
        let may_be = set_up.filter(|wiring| named.is_none_or(|port| port == Some(wiring.number)));
        for wiring in may_be {
            self.uinit.entry(wiring.number).or_default().push(uinit);
        }
    }

    /// Writes to a device.
    pub(super) fn writes(&self, device: Device) -> &[Write] {
        self.writes.get(&device).map_or(&[], Vec::as_slice)
    }

    /// Returns true if the program sets up a port.
    pub(super) fn touch(&self, wiring: &PortWiring) -> bool {
        let registers = wiring.setup_registers().map(d);
        let mut devices = registers.chain(wiring.setup_relays().map(m));
        devices.any(|device| !self.writes(device).is_empty())
    }

    /// Returns true if UINIT is certain to set up a port.
    pub(super) fn is_set_up(&self, port: u8) -> bool {
        let uinits = self.uinit.get(&port);
        uinits.is_some_and(|uinits| uinits.iter().any(|uinit| uinit.certain))
    }

    /// Value of a register at power-on; relays are off.
    fn at_power_on(&self, device: Device) -> u16 {
        let row = self.model.special(device.class, device.number);
        let row = row.filter(|_| device.class == DeviceClass::D);
        row.map_or(0, |row| row.default as u16)
    }

    /// All values that a register has at some time; `None` if it may have any.
    pub(super) fn values(&self, register: Register) -> Option<BTreeSet<u16>> {
        let device = d(register);
        let written = self.writes(device).iter().map(|write| write.value);
        let values = std::iter::once(Some(self.at_power_on(device))).chain(written);
        values.collect()
    }

    /// The values that a register may have from the end of the first scan on, each with the instruction that writes
    /// it, or `None` at power-on. `None` if it may have any.
    pub(in super::super) fn settings(
        &self,
        register: Register,
    ) -> Option<Vec<(u16, Option<usize>)>> {
        let device = d(register);
        let writes = self.writes(device);
        let certain = writes.iter().any(|write| write.first_scan);
        let at_power_on = (!certain).then(|| Some((self.at_power_on(device), None)));
        let written = writes
            .iter()
            .map(|write| Some((write.value?, Some(write.at))));
        at_power_on.into_iter().chain(written).collect()
    }

    /// Returns true if a relay may be on at some time.
    pub(super) fn may_be_on(&self, relay: Relay) -> bool {
        let device = m(relay);
        let mut writes = self.writes(device).iter();
        writes.any(|write| write.value != Some(0)) || self.indexed_relays.contains(&device)
    }

    /// Value of a device after the set-up; bits are 0 and 1.
    pub(super) fn held(&self, device: Device) -> RegisterValue {
        let writes = self.writes(device);
        let Some(last) = writes.last() else {
            return RegisterValue::Default(self.at_power_on(device));
        };
        let same = writes.iter().all(|write| write.value == last.value);
        let ordered = writes.iter().all(|write| write.first_scan);
        match last
            .value
            .filter(|_| same || ordered && writes.iter().all(|w| w.value.is_some()))
        {
            Some(value) => RegisterValue::Constant(value),
            None => RegisterValue::Unknown,
        }
    }

    /// Set-up of a port by UINIT.
    fn uinit_words(&self, port: u8) -> Option<[u16; 3]> {
        match self.uinit.get(&port).map(Vec::as_slice) {
            None => Some([0; 3]),
            Some(uinits) => {
                let mut words = uinits.iter().map(Uinit::words);
                let [protocol, format] = words.next()??;
                let same = words.all(|other| other == Some([protocol, format]));
                same.then_some([protocol, format, 0])
            }
        }
    }

    /// Protocol of a port, if it is constant.
    pub(super) fn protocol(&self, wiring: &PortWiring) -> Option<Protocol> {
        // A format that is computed also chooses, where nothing else does.
        let number = wiring.protocol;
        let number = number.filter(|&number| self.held(d(number)).known() != Some(0));
        let chooses = wiring.setup_registers();
        let registers = chooses.filter(|&n| number.is_none_or(|number| n == number));
        let relays = wiring.setup_relays().map(m);
        let mut devices = registers.map(d).chain(relays);
        if devices.any(|device| self.held(device) == RegisterValue::Unknown) {
            return None;
        }
        let uinit = self.uinit_words(wiring.number)?;
        Some(wiring.protocol(&self.memory(wiring), uinit))
    }

    /// Protocol of a port once a device has a value, and the others have what the first scan is certain to write.
    pub(super) fn protocol_with(
        &self,
        wiring: &PortWiring,
        device: Device,
        value: u16,
    ) -> Option<Protocol> {
        let held = |other: Device| {
            let certain = self.writes(other).iter().all(|write| write.first_scan);
            match other == device {
                true => value,
                false if certain => self.held(other).known().unwrap_or(0),
                false => self.at_power_on(other),
            }
        };
        let memory = self.memory_of(wiring, held);
        Some(wiring.protocol(&memory, self.uinit_words(wiring.number)?))
    }

    /// The station of a port, if it is constant.
    pub(super) fn station(&self, wiring: &PortWiring) -> Option<u16> {
        match wiring.station {
            Some(register) => self.held(d(register)).known(),
            None => self.uinit_words(wiring.number).map(|words| words[0] & 0xff),
        }
    }

    /// The format of characters on the line of a port, if that is constant.
    pub(super) fn format(&self, wiring: &PortWiring, protocol: Protocol) -> Option<LineFormat> {
        if wiring
            .format
            .is_some_and(|word| self.held(d(word)) == RegisterValue::Unknown)
        {
            return None;
        }
        let uinit = self.uinit_words(wiring.number)?;
        Some(wiring.line(&self.memory(wiring), protocol, uinit))
    }

    /// The devices of a PLC that has been set up.
    fn memory(&self, wiring: &PortWiring) -> Memory {
        self.memory_of(wiring, |device| self.held(device).known().unwrap_or(0))
    }

    /// The devices of a PLC whose set-up devices have these values.
    fn memory_of(&self, wiring: &PortWiring, held: impl Fn(Device) -> u16) -> Memory {
        let mut memory = self.cleared(true);
        for register in wiring.setup_registers().chain(wiring.station) {
            memory.set_register(register, held(d(register)));
        }
        for relay in wiring.setup_relays() {
            memory.set_relay(relay, held(m(relay)) != 0);
        }
        memory
    }

    /// Devices that are all 0, of a PLC in RUN or STOP.
    pub(super) fn cleared(&self, running: bool) -> Memory {
        Memory {
            words: BTreeMap::new(),
            relays: BTreeSet::new(),
            sys: Sys {
                running,
                ..Sys::power_on()
            },
            state: State::new(),
            ports: self.model.ports,
            type_code: self.model.type_code(),
        }
    }
}

/// A constant operand.
fn constant(code: &Code, i: usize, n: usize) -> Option<i64> {
    code.instr(i).operands.get(n)?.kind.constant()
}

/// The constants that an instruction writes, by device.
fn constants(code: &Code, i: usize) -> BTreeMap<Device, u16> {
    let mut found = BTreeMap::new();
    let device = |n: usize| code.device(i, n);
    let bit = |on: bool| device(0).map(|device| (device, u16::from(on)));
    match code.basic(i) {
        // A coil that is off again leaves the choice as it was when it was bound.
        Some(Basic::Out | Basic::Set) => found.extend(bit(true)),
        Some(Basic::Rst) => found.extend(bit(false)),
        _ => {}
    }
    let count = match code.lower(i) {
        Some(Lower::Move) => 1,
        Some(Lower::Call(RtFn::Fmov)) => constant(code, i, 2).unwrap_or(0),
        _ => return found,
    };
    let (Some(value), Some(first)) = (constant(code, i, 0), device(1)) else {
        return found;
    };
    let words: &[u16] = match code.wide(i) {
        true => &[value as u16, (value >> 16) as u16],
        false => &[value as u16],
    };
    // A number that does not exist may be the last one that can be written.
    let numbers = first.number..=u32::MAX;
    let each = words
        .iter()
        .cycle()
        .take(words.len() * count.clamp(0, 512) as usize);
    let device = |number| Device {
        class: first.class,
        number,
    };
    found.extend(numbers.zip(each).map(|(n, &word)| (device(n), word)));
    found
}

/// The special devices of a port; all others are 0.
#[derive(Clone)]
pub(super) struct Memory {
    words: BTreeMap<u32, u16>,
    relays: BTreeSet<u32>,
    sys: Sys,
    state: State,
    ports: Ports,
    type_code: u16,
}

impl Memory {
    pub(super) fn set_register(&mut self, register: Register, value: u16) {
        self.words.insert(register.number(), value);
    }

    pub(super) fn set_relay(&mut self, relay: Relay, on: bool) {
        match on {
            true => self.relays.insert(relay.number()),
            false => self.relays.remove(&relay.number()),
        };
    }
}

impl Plc for Memory {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        Some(class == Class::M && self.relays.contains(&number))
    }

    fn set_bit(&mut self, _: Class, _: u32, _: bool) -> Option<()> {
        None
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        let word = self.words.get(&number).filter(|_| class == Class::D);
        Some(word.map_or(0, |&word| word as i16))
    }

    fn set_word(&mut self, _: Class, _: u32, _: i16) -> Option<()> {
        None
    }

    fn counter32(&self, _: u32) -> Option<i32> {
        None
    }

    fn set_counter32(&mut self, _: u32, _: i32) -> Option<()> {
        None
    }

    fn state(&mut self, _: u16) -> &mut State {
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

    fn reset(&mut self, _: Class, _: u32) -> Option<()> {
        None
    }
}
