//! Hardware for tests, simulation and `rungc run`: everything is memory, and time is virtual.

use crate::hal::{Clock, DAY_MS, Hal, SerialPort};
use crate::modules::{BOARD, Kind, Module, Quantity, Signal};
use crate::program::Program;
use crate::stopwatch::Milliseconds;
use crate::virtual_line::VirtualLine;

/// Words of buffer memory that all modules together may hold.
const BFM_WORDS: usize = 1024;

/// Special modules with numbers that may be fitted.
const NUMBERED: usize = 8;

/// All of them, with the analog boards and adapters, of which a PLC has at most four.
const MODULES: usize = NUMBERED + 4;

/// Built-in analog inputs.
const ANALOG_CHANNELS: usize = 16;

/// Serial ports: COM0 to COM3, and the CAN card.
const LINES: usize = 5;

/// A word of buffer memory.
#[derive(Clone, Copy, Debug, Default)]
struct BfmWord {
    unit: u16,
    address: u16,
    value: i16,
}

/// Virtual hardware without allocation.
///
/// A special module that is fitted ([`VirtualHal::fit`]) behaves as its kind does. Any other module is plain memory:
/// it exists as soon as one of its words has been set ([`VirtualHal::set_bfm`]); its other words are then 0. The
/// clock starts at 2000-01-01 (a Saturday) and follows the virtual time that [`VirtualHal::advance_to`] sets. Input
/// and output terminals are the images of the program, so immediate refreshes change nothing.
#[derive(Clone, Debug)]
pub struct VirtualHal {
    bfm: [BfmWord; BFM_WORDS],
    bfm_len: usize,
    modules: [Option<(u16, Module)>; MODULES],
    /// Modules that take time to answer, and how many milliseconds.
    delays_ms: [Option<(u16, u16)>; MODULES],
    analog: [Option<i16>; ANALOG_CHANNELS],
    /// The clock was `base` when it was set, `since_base_ms` ago.
    base: Clock,
    since_base_ms: u64,
    watch: Milliseconds,
    lines: [VirtualLine; LINES],
    power_fails: bool,
    battery: Option<u16>,
}

impl Default for VirtualHal {
    fn default() -> Self {
        Self::new()
    }
}

impl VirtualHal {
    /// Hardware without modules, at virtual time 0.
    pub const fn new() -> Self {
        VirtualHal {
            bfm: [BfmWord {
                unit: 0,
                address: 0,
                value: 0,
            }; BFM_WORDS],
            bfm_len: 0,
            modules: [None; MODULES],
            delays_ms: [None; MODULES],
            analog: [None; ANALOG_CHANNELS],
            base: Clock {
                year: 2000,
                month: 1,
                day: 1,
                hour: 0,
                minute: 0,
                second: 0,
                weekday: 6,
            },
            since_base_ms: 0,
            watch: Milliseconds::at(0),
            lines: [const { VirtualLine::new() }; LINES],
            power_fails: false,
            battery: None,
        }
    }

    /// The power supply fails from now on, or is back.
    pub fn set_power_fails(&mut self, fails: bool) {
        self.power_fails = fails;
    }

    /// Sets the voltage of the battery in tenths of a volt; `None`, as at first: nothing measures it.
    pub fn set_battery(&mut self, tenths: Option<u16>) {
        self.battery = tenths;
    }

    /// The other end of a serial port; `None` if the number is above 4.
    pub fn line(&mut self, number: u8) -> Option<&mut VirtualLine> {
        self.lines.get_mut(usize::from(number))
    }

    /// Virtual time is now `now_ms` milliseconds after power-on (wrapping); call it before each scan.
    pub fn advance_to(&mut self, now_ms: u32) {
        let passed = self.watch.advance(now_ms);
        self.since_base_ms = self.since_base_ms.saturating_add(passed.into());
        for (_, module) in self.modules.iter_mut().flatten() {
            module.pass(passed.saturating_mul(1000));
        }
    }

    /// The clock is put forward by this many milliseconds, or back; virtual time passes as before.
    pub fn move_clock(&mut self, ms: i64) {
        let passed = self.since_base_ms;
        self.since_base_ms = passed.saturating_add_signed(ms);
        let missing = ms.unsigned_abs().saturating_sub(passed);
        if ms < 0 && missing > 0 {
            let days = missing.div_ceil(DAY_MS);
            self.base = self.base.days_before(days);
            self.since_base_ms = days.saturating_mul(DAY_MS).saturating_sub(missing);
        }
    }

    /// Virtual time restarts at 0, as after power off and on; the clock continues where it is, and modules keep what
    /// they keep.
    pub fn restart(&mut self) {
        self.watch = Milliseconds::at(0);
        self.power_fails = false;
        self.lines = [const { VirtualLine::new() }; LINES];
        for (_, module) in self.modules.iter_mut().flatten() {
            module.power_cycle();
        }
    }

    /// Executes a scan of a program at this time. Afterwards, modules see whether the PLC is in RUN, which programs,
    /// errors and partners on a line change, too.
    pub fn scan(&mut self, plc: &mut dyn Program, now_ms: u32, scan_us: u32) {
        self.advance_to(now_ms);
        plc.scan(self, now_ms, scan_us);
        self.set_running(plc.sys().running);
    }

    /// Puts the RUN/STOP switch; modules see it.
    pub fn set_running(&mut self, running: bool) {
        for (_, module) in self.modules.iter_mut().flatten() {
            module.set_running(running);
        }
    }

    /// Fits a special module with this number, a board or an adapter; `None` if there is one already, or if there are 8
    /// modules with numbers or 12 in all.
    pub fn fit(&mut self, unit: u16, kind: &'static Kind) -> Option<()> {
        let others = self.modules.iter().flatten();
        let modules = others.filter(|(own, _)| *own < BOARD).count();
        let is_full = unit < BOARD && modules == NUMBERED;
        if is_full || self.has_unit(unit) || self.module(unit).is_some() {
            return None;
        }
        let place = self.modules.iter_mut().find(|place| place.is_none())?;
        *place = Some((unit, Module::new(kind)));
        Some(())
    }

    fn module(&self, unit: u16) -> Option<&Module> {
        let mut modules = self.modules.iter().flatten();
        modules.find_map(|(own, module)| (*own == unit).then_some(module))
    }

    fn module_mut(&mut self, unit: u16) -> Option<&mut Module> {
        let mut modules = self.modules.iter_mut().flatten();
        modules.find_map(|(own, module)| (*own == unit).then_some(module))
    }

    /// A module answers after this many milliseconds from now on; `None` if too many are slow.
    pub fn delay_module(&mut self, unit: u16, ms: u16) -> Option<()> {
        let is_its = |place: &&mut Option<(u16, u16)>| place.is_none_or(|(own, _)| own == unit);
        *self.delays_ms.iter_mut().find(is_its)? = Some((unit, ms));
        Some(())
    }

    /// Connects a signal to an input of a fitted module; channels are counted from 1. `None` if there is no such input.
    pub fn set_signal(&mut self, unit: u16, channel: u8, signal: Signal) -> Option<()> {
        let channel = channel.checked_sub(1)?;
        self.module_mut(unit)?.connect(channel, signal)
    }

    /// Signal at a channel of a fitted module, in millionths of the quantity's unit: that connected to an input, or
    /// that of an output; 0 if it is another quantity. Channels are counted from 1. `None` if there is no such channel.
    pub fn signal(&self, unit: u16, channel: u8, quantity: Quantity) -> Option<i32> {
        let channel = channel.checked_sub(1)?;
        self.module(unit)?.signal(channel, quantity)
    }

    fn find(&self, unit: u16, address: u16) -> Option<usize> {
        let words = self.bfm.get(..self.bfm_len)?;
        words
            .iter()
            .position(|w| w.unit == unit && w.address == address)
    }

    fn has_unit(&self, unit: u16) -> bool {
        self.bfm.iter().take(self.bfm_len).any(|w| w.unit == unit)
    }

    /// Sets a word of buffer memory, fitting the module if need be; `None` if the table is full.
    pub fn set_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
        if let Some(module) = self.module_mut(unit) {
            return module.poke(address, value);
        }
        let at = self.find(unit, address).unwrap_or(self.bfm_len);
        *self.bfm.get_mut(at)? = BfmWord {
            unit,
            address,
            value,
        };
        self.bfm_len = self.bfm_len.max(at + 1);
        Some(())
    }

    /// A word of buffer memory; `None` if there is no such module.
    pub fn bfm(&self, unit: u16, address: u16) -> Option<i16> {
        if let Some(module) = self.module(unit) {
            return module.read(address);
        }
        match self.find(unit, address) {
            Some(at) => self.bfm.get(at).map(|w| w.value),
            None => self.has_unit(unit).then_some(0),
        }
    }

    /// Sets the raw value of a built-in analog input; `None` if the channel is above 15.
    pub fn set_analog(&mut self, channel: u8, value: i16) -> Option<()> {
        *self.analog.get_mut(usize::from(channel))? = Some(value);
        Some(())
    }
}

impl Hal for VirtualHal {
    fn clock(&mut self) -> Option<Clock> {
        Some(self.base.after(self.since_base_ms))
    }

    fn set_clock(&mut self, clock: Clock) -> Option<()> {
        clock.is_valid().then(|| {
            self.base = clock;
            self.since_base_ms = 0;
        })
    }

    fn read_bfm(&mut self, unit: u16, address: u16) -> Option<i16> {
        self.bfm(unit, address)
    }

    fn write_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
        if let Some(module) = self.module_mut(unit) {
            return module.write(address, value);
        }
        if self.has_unit(unit) {
            self.set_bfm(unit, address, value)
        } else {
            None
        }
    }

    fn module_answers(&mut self, unit: u16, most_ms: u16) -> bool {
        let mut delays = self.delays_ms.iter().flatten();
        delays.all(|&(own, ms)| own != unit || ms <= most_ms)
    }

    fn power_fails(&mut self) -> Option<bool> {
        Some(self.power_fails)
    }

    fn battery(&mut self) -> Option<u16> {
        self.battery
    }

    fn analog(&mut self, channel: u8) -> Option<i16> {
        self.analog.get(usize::from(channel)).copied().flatten()
    }

    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        let line = self.lines.get_mut(usize::from(number))?;
        Some(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_follows_virtual_time() {
        let mut hal = VirtualHal::new();
        let eve = Clock::new(2028, 2, 28, 23, 59, 59).unwrap();
        assert_eq!(eve.weekday, 1, "28 February 2028 is a Monday");
        hal.advance_to(500);
        hal.set_clock(eve).unwrap();
        hal.advance_to(1499);
        assert_eq!(hal.clock(), Some(eve));
        hal.advance_to(1500);
        assert_eq!(hal.clock(), Clock::new(2028, 2, 29, 0, 0, 0));
        hal.advance_to(1500 + 86_400_000);
        assert_eq!(hal.clock(), Clock::new(2028, 3, 1, 0, 0, 0));
        assert_eq!(hal.set_clock(Clock { month: 13, ..eve }), None);
        hal.move_clock(-1500);
        assert_eq!(hal.clock(), Clock::new(2028, 2, 29, 23, 59, 58));
        hal.move_clock(-366 * DAY_MS as i64);
        assert_eq!(hal.clock(), Clock::new(2027, 2, 28, 23, 59, 58));
        hal.move_clock(366 * DAY_MS as i64 + 1500);
        assert_eq!(hal.clock(), Clock::new(2028, 3, 1, 0, 0, 0));
        hal.move_clock(i64::MIN);
        hal.move_clock(i64::MAX);
    }

    #[test]
    fn every_day_of_four_centuries_follows_its_neighbour() {
        let mut day = Clock::new(1999, 12, 31, 12, 0, 0).unwrap();
        for _ in 0..146_097 {
            let next = day.after(DAY);
            assert_eq!(
                Clock::new(next.year, next.month, next.day, 12, 0, 0),
                Some(next)
            );
            day = next;
        }
        assert_eq!((day.year, day.month, day.day), (2399, 12, 31));
    }

    const DAY: u64 = 86_400_000;

    #[test]
    fn modules_exist_once_a_word_is_set() {
        let mut hal = VirtualHal::new();
        assert_eq!(hal.write_bfm(1, 5, 7), None);
        hal.set_bfm(1, 0, 3).unwrap();
        hal.write_bfm(1, 5, 7).unwrap();
        assert_eq!(
            (hal.read_bfm(1, 5), hal.read_bfm(1, 6), hal.read_bfm(2, 5)),
            (Some(7), Some(0), None)
        );
    }

    #[test]
    fn fitted_modules_behave_as_their_kind() {
        let mut hal = VirtualHal::new();
        hal.fit(1, Kind::find("FX2N-4AD").unwrap()).unwrap();
        let other = Kind::find("FX2N-4DA").unwrap();
        assert_eq!(hal.fit(1, other), None);
        let signal = Signal {
            quantity: Quantity::Volts,
            millionths: 5_000_000,
        };
        hal.set_signal(1, 1, signal).unwrap();
        assert_eq!(hal.set_signal(1, 0, signal), None);
        hal.advance_to(60);
        assert_eq!(
            (hal.read_bfm(1, 9), hal.read_bfm(1, 30)),
            (Some(1000), Some(2010))
        );
        assert_eq!(hal.read_bfm(1, 31), None);
        assert_eq!(hal.signal(1, 1, Quantity::Volts), Some(5_000_000));
        hal.restart();
        assert_eq!(hal.read_bfm(1, 9), Some(0));
        for unit in 2..9 {
            hal.fit(unit, other).unwrap();
        }
        assert_eq!(hal.fit(9, other), None);
    }

    #[test]
    fn a_full_table_refuses() {
        let mut hal = VirtualHal::new();
        for address in 0..1024 {
            hal.set_bfm(0, address, 1).unwrap();
        }
        assert_eq!(hal.set_bfm(0, 1024, 1), None);
        assert_eq!(hal.set_bfm(0, 7, 2), Some(()));
    }
}
