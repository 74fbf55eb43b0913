//! A PLC that runs: a program in the interpreter with its hardware, the machine that it is wired to, and virtual time.
//!
//! A run is scans and the time between them. [`Session::scan`] executes a scan, [`Session::pass`] lets the time until
//! the next one pass, a millisecond at a time: the hardware and the machine advance, pulses and ports tick, and
//! interrupts are taken. A caller that has to do something within a millisecond calls its three parts:
//! [`advance`](Session::advance), [`tick`](Session::tick), [`take_interrupts`](Session::take_interrupts).

mod forced;
mod history;

pub use forced::Forced;
pub use history::History;

use crate::plant::{Plant, Wired};
use crate::record::{Reading, Seen};
use crate::target::Target;
use crate::wire::Change;
use rungc_interp::{Machine, Saved};
use rungc_ir::Module;
use rungc_rt::modules::Kind;
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_syntax::{DeviceClass, FittedModule};

/// Default duration of a scan, in milliseconds.
pub const USUAL_SCAN_MS: u64 = 10;

/// Hardware with these special modules.
pub fn hardware(fitted: &[FittedModule]) -> VirtualHal {
    let mut hal = VirtualHal::new();
    for module in fitted {
        // The settings name each number once, kinds that are known, and no more modules than there is room for.
        let _ = Kind::find(module.kind).and_then(|kind| hal.fit(module.unit, kind));
        let _ = hal.delay_module(module.unit, module.delay_ms);
    }
    hal
}

/// A PLC that runs.
pub struct Session<'m> {
    machine: Machine<'m>,
    /// Large, so not on the stack.
    hal: Box<VirtualHal>,
    plant: Option<Plant>,
    forced: Forced,
    /// Milliseconds since power-on.
    now_ms: u64,
    /// True once a scan has been executed since power-on: from then on, inputs that change have edges.
    has_scanned: bool,
}

/// A moment of a session, to come back to.
#[derive(Clone)]
pub struct Moment {
    machine: Saved,
    /// `None` if the program's effects do not depend on it.
    hal: Option<Box<VirtualHal>>,
    plant: Option<Plant>,
    forced: Forced,
    now_ms: u64,
    has_scanned: bool,
}

impl<'m> Session<'m> {
    /// A PLC at power-on, with this hardware.
    pub fn new(module: &'m Module, hal: VirtualHal) -> Self {
        Session {
            machine: Machine::new(module),
            hal: Box::new(hal),
            plant: None,
            forced: Forced::default(),
            now_ms: 0,
            has_scanned: false,
        }
    }

    /// Wires the PLC to a machine, before the first scan: its switches and sensors show where it is.
    ///
    /// # Errors
    /// A sensor at an input that the PLC does not have.
    pub fn connect(&mut self, plant: Plant) -> Result<(), String> {
        let plant = self.plant.insert(plant);
        let mut wired = Wired {
            machine: &mut self.machine,
            hal: &mut self.hal,
            changed: &mut |_| Ok::<_, String>(()),
        };
        wired.connect(plant)
    }

    /// The PLC.
    pub fn machine(&self) -> &Machine<'m> {
        &self.machine
    }

    /// The PLC, to change it from outside.
    pub fn machine_mut(&mut self) -> &mut Machine<'m> {
        &mut self.machine
    }

    /// The PLC's hardware.
    pub fn hal(&self) -> &VirtualHal {
        &self.hal
    }

    /// The PLC and its hardware, to change them from outside.
    pub fn parts(&mut self) -> (&mut Machine<'m>, &mut VirtualHal) {
        (&mut self.machine, &mut self.hal)
    }

    /// The machine around the PLC.
    pub fn plant(&self) -> Option<&Plant> {
        self.plant.as_ref()
    }

    /// Milliseconds since power-on.
    pub fn now_ms(&self) -> u64 {
        self.now_ms
    }

    /// The PLC between two scans, with what is around it.
    pub fn seen(&self) -> Seen<'_> {
        Seen {
            machine: &self.machine,
            hal: &self.hal,
            plant: self.plant.as_ref(),
        }
    }

    /// Value of a device; `None` if the model or its hardware does not have it.
    pub fn reading(&self, target: Target) -> Option<Reading> {
        Reading::of(self.seen(), target)
    }

    /// Sets a device, or the signal at an input of a module; `None` if the model or its hardware does not have it. An
    /// input that changes between two scans has an edge; interrupts by it wait for
    /// [`take_interrupts`](Self::take_interrupts).
    pub fn set(&mut self, target: Target, value: f64) -> Option<()> {
        if let Target::Bit(DeviceClass::X, number) = target {
            return self.set_input(number, value != 0.0);
        }
        self.hal.advance_to(self.now_ms as u32);
        crate::set(&mut self.machine, &mut self.hal, target, value)
    }

    /// Turns an input terminal X on or off, as [`set`](Self::set) does; `None` if the model does not have it.
    pub fn set_input(&mut self, number: u32, on: bool) -> Option<()> {
        let before = self.machine.bit(Class::X, number)?;
        if self.has_scanned && before != on {
            self.hal.advance_to(self.now_ms as u32);
            // As in test files, what an edge runs sees X as it was.
            self.machine.input_edge(&mut *self.hal, number, on);
        }
        self.machine.set_bit(Class::X, number, on)
    }

    /// Sets a device, and gives it the same value before and after each scan until it is released.
    ///
    /// # Errors
    /// A device of which another name is forced, or that does not exist.
    pub fn force(&mut self, target: Target, value: f64) -> Result<(), String> {
        self.forced.check(target)?;
        let missing = || format!("`{target}` does not exist");
        self.set(target, value).ok_or_else(missing)?;
        self.forced.insert(target, value);
        Ok(())
    }

    /// Releases a device that is forced.
    ///
    /// # Errors
    /// It is not forced.
    pub fn release(&mut self, target: Target) -> Result<(), String> {
        self.forced.remove(target)
    }

    /// Releases all devices that are forced.
    pub fn release_all(&mut self) {
        self.forced = Forced::default();
    }

    /// The devices that are forced, with their values.
    pub fn forced(&self) -> &Forced {
        &self.forced
    }

    /// Duration of a scan in milliseconds, if one takes `given_ms` by itself: that, and the wait for the constant scan
    /// time (M8039).
    pub fn scan_ms(&self, given_ms: Option<u64>) -> u64 {
        let constant_ms = self.machine.constant_scan_ms().map(u64::from);
        match (given_ms, constant_ms) {
            (Some(given), Some(constant)) => given.max(constant),
            (given, constant) => given.or(constant).unwrap_or(USUAL_SCAN_MS),
        }
    }

    /// Executes a scan that takes this time. The time itself does not pass.
    pub fn scan(&mut self, scan_ms: u64) {
        self.scan_us(scan_ms.saturating_mul(1000).min(u64::from(u32::MAX)) as u32);
    }

    /// As [`scan`](Self::scan), with a time in microseconds.
    pub fn scan_us(&mut self, scan_us: u32) {
        self.give_forced();
        self.hal
            .scan(&mut self.machine, self.now_ms as u32, scan_us);
        self.give_forced();
        self.has_scanned = true;
    }

    fn give_forced(&mut self) {
        if self.forced.is_empty() {
            return;
        }
        self.hal.advance_to(self.now_ms as u32);
        for (target, value) in self.forced.iter() {
            // It exists: it was set when it was forced.
            let _ = crate::set(&mut self.machine, &mut self.hal, target, value);
        }
    }

    /// Lets time pass after a scan.
    pub fn pass(&mut self, ms: u64) {
        if self.plant.is_none() && !self.machine.module().takes_time() {
            self.skip(ms);
            return self.take_interrupts();
        }
        for _ in 0..ms {
            // Nothing can go wrong: all sensors were connected at power-on.
            let _ = self.advance(&[], &mut |_| Ok::<_, String>(()));
            self.tick();
            self.take_interrupts();
        }
    }

    /// Lets time pass in which neither the program, the hardware nor the machine does anything.
    pub fn skip(&mut self, ms: u64) {
        self.now_ms += ms;
    }

    /// First part of a millisecond: the hardware advances, the machine moves, and inputs change: those that the machine
    /// drives, and `others`. `changed` is called with each change, once the program has taken it.
    ///
    /// # Errors
    /// Those of `changed`.
    pub fn advance<E: From<String>>(
        &mut self,
        others: &[Change],
        changed: &mut dyn FnMut(Change) -> Result<(), E>,
    ) -> Result<(), E> {
        self.now_ms += 1;
        self.hal.advance_to(self.now_ms as u32);
        let mut bare = Plant::default();
        let plant = match &mut self.plant {
            None if others.is_empty() => return Ok(()),
            None => &mut bare,
            Some(plant) => plant,
        };
        let mut wired = Wired {
            machine: &mut self.machine,
            hal: &mut self.hal,
            changed,
        };
        plant.step(self.now_ms, others, &mut wired)
    }

    /// Second part of a millisecond: pulse outputs, ports and clocks tick.
    pub fn tick(&mut self) {
        self.machine.tick(&mut *self.hal, self.now_ms as u32);
    }

    /// Third part of a millisecond: pending interrupts are taken.
    pub fn take_interrupts(&mut self) {
        self.machine.take_interrupts(&mut *self.hal);
    }

    /// Turns the RUN/STOP switch.
    pub fn set_running(&mut self, running: bool) {
        self.machine.set_running(running);
        self.hal.set_running(running);
    }

    /// Switches the power supply off and on: latched devices, the clock and the machine stay as they are, and so do the
    /// states of input terminals.
    pub fn power_cycle(&mut self) {
        let areas = self.machine.module().layout.areas.iter();
        let inputs = areas.filter(|area| area.class == DeviceClass::X);
        let inputs = inputs.flat_map(|area| area.first..area.first + area.count);
        let is_on = |&input: &u32| self.machine.bit(Class::X, input) == Some(true);
        let on: Vec<u32> = inputs.filter(is_on).collect();
        self.hal.restart();
        self.machine.power_cycle();
        self.plant.iter_mut().for_each(Plant::power_cycle);
        for input in on {
            // It is there: it was on before.
            let _ = self.machine.set_bit(Class::X, input, true);
        }
        self.now_ms = 0;
        self.has_scanned = false;
    }

    /// The present moment.
    pub fn save(&self) -> Moment {
        Moment {
            hal: Some(self.hal.clone()),
            ..self.save_without_hardware()
        }
    }

    /// The present moment of a program whose effects depend on nothing of the hardware but the time.
    pub fn save_without_hardware(&self) -> Moment {
        Moment {
            machine: self.machine.save(),
            hal: None,
            plant: self.plant.clone(),
            forced: self.forced.clone(),
            now_ms: self.now_ms,
            has_scanned: self.has_scanned,
        }
    }

    /// Goes back to a moment of this session.
    pub fn restore(&mut self, moment: &Moment) {
        self.machine.restore(&moment.machine);
        if let Some(hal) = &moment.hal {
            self.hal.clone_from(hal);
        }
        self.plant.clone_from(&moment.plant);
        self.forced.clone_from(&moment.forced);
        self.now_ms = moment.now_ms;
        self.has_scanned = moment.has_scanned;
    }
}
