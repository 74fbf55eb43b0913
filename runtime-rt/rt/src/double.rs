//! A PLC for the tests of this crate: all devices, no layout.

use crate::comm::codec::{self, Codec};
use crate::comm::modbus::Profile;
use crate::comm::{Element, Elements, PortMut, PortWiring};
use crate::fault::ErrorRules;
use crate::{
    Axis, Class, Cx, Done, FIRST_COUNTER32, Hal, Operand, Plc, Port, Ports, Pulses, RtFn, Site,
    State, Sys, VirtualHal, d,
};
use std::collections::HashMap;
use std::vec::Vec;

/// Devices of a generous H2U, virtual hardware, and texts.
pub struct Double {
    bits: HashMap<(Class, u32), bool>,
    words: HashMap<(Class, u32), i16>,
    counters: HashMap<u32, i32>,
    states: Vec<State>,
    axes: [Axis; 3],
    /// Serial ports 0 to 3.
    ports: Vec<Port>,
    /// Of which family.
    pub family: Ports,
    /// Time and mode.
    pub sys: Sys,
    /// Hardware.
    pub hal: VirtualHal,
    /// Relay that shows errors.
    pub error_relay: u32,
    /// Code of an error in a value.
    pub value_error: u16,
    /// Consequences of errors.
    pub error_rules: ErrorRules,
    /// Code and step of the last error.
    pub error: (u16, u32),
    /// Texts.
    pub texts: Vec<Vec<u8>>,
    /// Form and drive of the next calls.
    pub site: Site,
}

/// A register as an operand.
pub fn reg(n: i32) -> Operand {
    d(Class::D, n)
}

/// A relay as an operand.
pub fn relay(n: i32) -> Operand {
    d(Class::M, n)
}

/// Number of devices of a class.
fn size(class: Class) -> u32 {
    match class {
        Class::X | Class::Y | Class::T | Class::C => 256,
        Class::M | Class::D => 8512,
        Class::S => 1000,
        Class::R | Class::ER => 32768,
        Class::V | Class::Z => 8,
    }
}

impl Double {
    /// A PLC in its first scan, everything 0, for the 16-bit form.
    pub fn new() -> Self {
        Double {
            bits: HashMap::new(),
            words: HashMap::new(),
            counters: HashMap::new(),
            states: std::vec![State::default(); 8],
            axes: [Axis::new(); 3],
            ports: std::vec![Port::new(); 5],
            family: Ports::Inovance,
            sys: Sys {
                running: true,
                first_scan: true,
                ..Sys::default()
            },
            hal: VirtualHal::new(),
            error_relay: 8067,
            value_error: 6707,
            error_rules: ErrorRules::NONE,
            error: (0, 0),
            texts: Vec::new(),
            site: Site::at(0).slot(1),
        }
    }

    /// The same for the 32-bit form.
    pub fn wide() -> Self {
        let mut plc = Self::new();
        plc.site = plc.site.wide();
        plc
    }

    /// Sets words from D`first` on.
    pub fn with_d(mut self, first: u32, values: &[i32]) -> Self {
        self.set_d(first, values);
        self
    }

    /// Sets words from D`first` on.
    pub fn set_d(&mut self, first: u32, values: &[i32]) {
        for (n, &value) in (first..).zip(values) {
            self.words.insert((Class::D, n), value as i16);
        }
    }

    /// `count` words from D`first` on.
    pub fn d(&self, first: u32, count: u32) -> Vec<i16> {
        (first..first + count)
            .map(|n| self.word(Class::D, n).unwrap())
            .collect()
    }

    /// The pair D`first`.
    pub fn dd(&self, first: u32) -> i32 {
        let words = self.d(first, 2);
        i32::from(words[1]) << 16 | i32::from(words[0] as u16)
    }

    /// Sets the pair D`first`.
    pub fn set_dd(&mut self, first: u32, value: i32) {
        self.set_d(first, &[value, value >> 16]);
    }

    /// The float D`first`.
    pub fn df(&self, first: u32) -> f32 {
        f32::from_bits(self.dd(first) as u32)
    }

    /// Sets the float D`first`.
    pub fn set_df(&mut self, first: u32, value: f32) {
        self.set_dd(first, value.to_bits() as i32);
    }

    /// Sets M bits from `first` on, the first character first.
    pub fn set_m(&mut self, first: u32, bits: &str) {
        for (n, c) in (first..).zip(bits.chars()) {
            self.bits.insert((Class::M, n), c == '1');
        }
    }

    /// `count` M bits from `first` on, the first bit first.
    pub fn m(&self, first: u32, count: u32) -> std::string::String {
        (first..first + count)
            .map(|n| {
                if self.bit(Class::M, n).unwrap() {
                    '1'
                } else {
                    '0'
                }
            })
            .collect()
    }

    /// Calls a function.
    pub fn call(&mut self, function: RtFn, ops: &[Operand]) -> Done {
        let mut hal = core::mem::take(&mut self.hal);
        let site = self.site;
        let done = function.call(&mut Cx::new(self, &mut hal as &mut dyn Hal, ops, site));
        self.hal = hal;
        done
    }

    /// Brings the serial ports to this time.
    pub fn advance_ports(&mut self, now_us: u32) -> Option<bool> {
        let mut hal = core::mem::take(&mut self.hal);
        let request = crate::advance_ports(self, &mut hal, now_us);
        self.hal = hal;
        request
    }

    /// The same of COM1, which is nothing but a slave by Modbus RTU.
    pub fn advance_slave(&mut self, now_us: u32) {
        let mut hal = core::mem::take(&mut self.hal);
        crate::advance_slave::<{ Ports::Inovance as u8 }, 1>(self, &mut hal, now_us);
        self.hal = hal;
    }

    /// Calls a function that is called in every scan, with this drive, `dt_ms` after the last scan.
    pub fn scan(&mut self, dt_ms: u32, drive: bool, function: RtFn, ops: &[Operand]) -> Done {
        self.sys.dt_ms = dt_ms;
        self.sys.now_ms = self.sys.now_ms.wrapping_add(dt_ms);
        self.sys.scan = self.sys.scan.wrapping_add(2);
        self.sys.first_scan = false;
        self.hal.advance_to(self.sys.now_ms);
        self.site.drive = drive;
        self.call(function, ops)
    }
}

/// Without timers and counters, whose parts are stored apart here.
impl Elements for Double {
    fn element(&mut self, class: Class, number: u32) -> Option<Element<'_>> {
        let at = (class, number);
        match class {
            _ if number >= size(class) => None,
            Class::X | Class::Y | Class::M | Class::S => {
                Some(Element::Bit(self.bits.entry(at).or_default()))
            }
            Class::T | Class::C => None,
            _ => Some(Element::Word(self.words.entry(at).or_default())),
        }
    }
}

impl Plc for Double {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        (number < size(class)).then(|| self.bits.get(&(class, number)).copied().unwrap_or(false))
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.bit(class, number)?;
        self.bits.insert((class, number), value);
        Some(())
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        (number < size(class)).then(|| self.words.get(&(class, number)).copied().unwrap_or(0))
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        self.word(class, number)?;
        self.words.insert((class, number), value);
        Some(())
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        (FIRST_COUNTER32..256)
            .contains(&number)
            .then(|| self.counters.get(&number).copied().unwrap_or(0))
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.counter32(number)?;
        self.counters.insert(number, value);
        Some(())
    }

    fn state(&mut self, slot: u16) -> &mut State {
        &mut self.states[usize::from(slot)]
    }

    fn sys(&self) -> &Sys {
        &self.sys
    }

    fn axis(&mut self, output: u32) -> Option<&mut Axis> {
        self.axes.get_mut(output as usize)
    }

    fn port(&mut self, number: u8) -> Option<PortMut<'_>> {
        self.ports.get_mut(usize::from(number)).map(Port::parts)
    }

    fn codecs(&self) -> &'static [&'static Codec] {
        codec::ALL
    }

    fn port_wiring(&self, index: usize) -> Option<&'static PortWiring> {
        self.ports().all().get(index)
    }

    fn modbus(&self) -> &'static Profile {
        self.ports().modbus(self.type_code())
    }

    fn ports(&self) -> Ports {
        self.family
    }

    fn pulses(&self) -> Pulses {
        Pulses::Inovance
    }

    fn error_relay(&self) -> u32 {
        self.error_relay
    }

    fn value_error(&self) -> u16 {
        self.value_error
    }

    fn error_rules(&self) -> ErrorRules {
        self.error_rules
    }

    fn note_error(&mut self, code: u16, step: u32) {
        self.error = (code, step);
    }

    fn text(&self, index: u32) -> &[u8] {
        self.texts.get(index as usize).map_or(&[], |t| t)
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.set_bit(class, number, false)?;
        if class == Class::C && number >= FIRST_COUNTER32 {
            self.set_counter32(number, 0)
        } else {
            self.set_word(class, number, 0)
        }
    }
}
