//! Devices of a request: those that a codec reads and writes when it carries the request out on a PLC that has all of
//! them.

use rungc_rt::Class;
use rungc_rt::comm::Map;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Devices by class and number.
pub type Devices = BTreeSet<(Class, u32)>;

/// Devices that a text names before it breaks off.
const MOST_RUNS: usize = 8;

/// A PLC that has all devices, and notes which of them are requested.
#[derive(Debug, Default)]
pub struct Probe {
    read: RefCell<Devices>,
    /// Devices that are written.
    pub written: Devices,
    /// RUN or STOP, if requested.
    pub request: Option<bool>,
    type_code: u16,
}

impl Probe {
    /// A PLC whose D8001 shows `type_code`.
    pub fn new(type_code: u16) -> Self {
        Probe {
            type_code,
            ..Probe::default()
        }
    }

    /// Devices that are read. A codec also reads the devices that it will write, to check that they exist.
    pub fn read(&self) -> Devices {
        let read = self.read.borrow();
        read.difference(&self.written).copied().collect()
    }

    fn note(&self, class: Class, number: u32) {
        self.read.borrow_mut().insert((class, number));
    }

    fn write(&mut self, class: Class, number: u32) -> Option<()> {
        self.written.insert((class, number));
        Some(())
    }
}

impl Map for Probe {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.note(class, number);
        Some(false)
    }

    fn set_bit(&mut self, class: Class, number: u32, _: bool) -> Option<()> {
        self.write(class, number)
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.note(class, number);
        Some(0)
    }

    fn set_word(&mut self, class: Class, number: u32, _: i16) -> Option<()> {
        self.write(class, number)
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.note(Class::C, number);
        Some(0)
    }

    fn set_counter32(&mut self, number: u32, _: i32) -> Option<()> {
        self.write(Class::C, number)
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.write(class, number)
    }

    fn running(&self) -> bool {
        true
    }

    fn request_running(&mut self, running: bool) {
        self.request = Some(running);
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }
}

/// Devices as ranges: `D100-D102, M5`.
pub fn ranges(devices: &Devices) -> String {
    let mut runs: Vec<(Class, u32, u32)> = Vec::new();
    for &(class, number) in devices {
        match runs.last_mut() {
            Some(last) if (last.0, last.2 + 1) == (class, number) => last.2 = number,
            _ => runs.push((class, number, number)),
        }
    }
    let mut text = String::new();
    for (n, &(class, first, last)) in runs.iter().enumerate() {
        if n > 0 {
            text.push_str(", ");
        }
        if n == MOST_RUNS {
            text.push('…');
            break;
        }
        text.push_str(&name(class, first));
        if last > first {
            let _ = write!(text, "-{}", name(class, last));
        }
    }
    text
}

/// Name of a device.
fn name(class: Class, number: u32) -> String {
    match class {
        Class::X | Class::Y => format!("{class:?}{number:03o}"),
        _ => format!("{class:?}{number}"),
    }
}
