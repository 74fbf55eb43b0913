//! The hardware as instructions see it.

use crate::axis::Axis;
use crate::comm::{LineFormat, Received};

/// A moment of the real-time clock.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Clock {
    /// Four digits.
    pub year: u16,
    /// 1 to 12.
    pub month: u8,
    /// 1 to 31.
    pub day: u8,
    /// 0 to 23.
    pub hour: u8,
    /// 0 to 59.
    pub minute: u8,
    /// 0 to 59.
    pub second: u8,
    /// 0 = Sunday to 6 = Saturday.
    pub weekday: u8,
}

/// Days before each month of a common year.
const DAYS_BEFORE: [u16; 13] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334, 365];

/// Milliseconds of a day.
pub(crate) const DAY_MS: u64 = 86_400_000;

/// Days after which the calendar repeats, in weeks and leap years: 400 years.
const CYCLE_DAYS: u64 = 146_097;

/// Returns true if `year` of the Gregorian calendar has 366 days.
fn is_leap(year: u32) -> bool {
    year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
}

/// Days from 1 January of year 0 to 1 January of `year`.
fn days_before_year(year: u32) -> u64 {
    let past = u64::from(year).saturating_sub(1);
    if year == 0 {
        0
    } else {
        u64::from(year) * 365 + past / 4 - past / 100 + past / 400 + 1
    }
}

/// Days of `month` (1 to 12) of `year`; 0 for any other month.
fn days_in_month(year: u32, month: u8) -> u16 {
    let i = usize::from(month);
    match (
        i.checked_sub(1).and_then(|i| DAYS_BEFORE.get(i)),
        DAYS_BEFORE.get(i),
    ) {
        (Some(before), Some(end)) => end - before + u16::from(month == 2 && is_leap(year)),
        _ => 0,
    }
}

impl Clock {
    /// A moment with the weekday that the calendar gives; `None` if there is no such date or time.
    pub fn new(year: u16, month: u8, day: u8, hour: u8, minute: u8, second: u8) -> Option<Clock> {
        let mut clock = Clock {
            year,
            month,
            day,
            hour,
            minute,
            second,
            weekday: 0,
        };
        clock.is_valid().then(|| {
            // 1 January of year 0 was a Saturday.
            clock.weekday = ((clock.days() + 6) % 7) as u8;
            clock
        })
    }

    /// Returns true if every field is in its range and the month has such a day. The weekday need not agree with the
    /// date.
    pub fn is_valid(&self) -> bool {
        (1..=days_in_month(self.year.into(), self.month)).contains(&self.day.into())
            && self.hour < 24
            && self.minute < 60
            && self.second < 60
            && self.weekday < 7
    }

    /// Days since 1 January of year 0.
    fn days(&self) -> u64 {
        let year = u32::from(self.year);
        let before = usize::from(self.month)
            .checked_sub(1)
            .and_then(|i| DAYS_BEFORE.get(i))
            .map_or(0, |&days| u64::from(days));
        let leap_day = u64::from(self.month > 2 && is_leap(year));
        days_before_year(year) + before + leap_day + u64::from(self.day.max(1)) - 1
    }

    /// This time of the day, some days earlier. Years are counted modulo 65,536.
    #[must_use]
    pub(crate) fn days_before(&self, days: u64) -> Clock {
        let cycles = days.div_ceil(CYCLE_DAYS);
        let later = self.after((cycles * CYCLE_DAYS - days) * DAY_MS);
        Clock {
            year: later.year.wrapping_sub(cycles.wrapping_mul(400) as u16),
            ..later
        }
    }

    /// This moment, `ms` milliseconds later; the weekday continues from this one's. Fractions of a second are dropped.
    #[must_use]
    pub fn after(&self, ms: u64) -> Clock {
        let of_day =
            (u64::from(self.hour) * 60 + u64::from(self.minute)) * 60 + u64::from(self.second);
        let total = (of_day * 1000).saturating_add(ms);
        let days_passed = total / DAY_MS;
        let seconds = (total % DAY_MS) / 1000;
        let days = self.days() + days_passed;
        // 366 days a year never overshoots, and the loop makes up for the difference.
        let mut year = (days / 366) as u32;
        while days_before_year(year + 1) <= days {
            year += 1;
        }
        let mut day = (days - days_before_year(year)) as u16;
        let mut month = 1;
        while day >= days_in_month(year, month) && month < 12 {
            day -= days_in_month(year, month);
            month += 1;
        }
        Clock {
            year: year as u16,
            month,
            day: day as u8 + 1,
            hour: (seconds / 3600) as u8,
            minute: (seconds / 60 % 60) as u8,
            second: (seconds % 60) as u8,
            weekday: ((u64::from(self.weekday) + days_passed) % 7) as u8,
        }
    }
}

/// A serial port: characters in with their times, characters out. Times are microseconds since power-on, wrapping.
///
/// An implementation buffers both ways: what comes in by interrupts waits until the program takes it, between two
/// scans.
pub trait SerialPort {
    /// The format of characters on the line from now on. It is called before anything else, and again when the format
    /// changes.
    fn set_format(&mut self, format: LineFormat);
    /// Takes the oldest character that was in by `now_us`.
    fn receive(&mut self, now_us: u32) -> Option<Received>;
    /// Takes a character to be sent after those before it, at `now_us` if there are none; false if there is no room for
    /// it now. On a half-duplex line the driver is on from the first of them to the stop bit of the last.
    fn send(&mut self, byte: u8, now_us: u32) -> bool;
    /// Number of characters accepted by [`SerialPort::send`] that are not out by `now_us`, to the end of their stop
    /// bits.
    fn unsent(&mut self, now_us: u32) -> u16;
}

/// A frame on a CAN bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct CanFrame {
    /// The identifier; bit 31 marks one of 29 bits.
    pub id: u32,
    /// Number of data bytes.
    pub len: u8,
    /// The data; 0 after its end.
    pub data: [u8; 8],
}

/// A CAN bus: frames in and out.
///
/// An implementation buffers both ways: what comes in by interrupts waits until the program takes it, between two
/// scans.
pub trait CanBus {
    /// Takes the oldest frame that has come.
    fn receive(&mut self) -> Option<CanFrame>;
    /// Takes a frame to be sent after those before it; false if there is no room for it now.
    fn send(&mut self, frame: &CanFrame) -> bool;
    /// Returns true while frames accepted by [`CanBus::send`] are not on the bus yet.
    fn is_sending(&mut self) -> bool;
}

/// Hardware services available to instructions. Every method has a default that means "not fitted".
pub trait Hal {
    /// Reads the real-time clock.
    fn clock(&mut self) -> Option<Clock> {
        None
    }
    /// Sets the real-time clock.
    fn set_clock(&mut self, clock: Clock) -> Option<()> {
        let _ = clock;
        None
    }
    /// Reads a word of the buffer memory of module `unit`.
    fn read_bfm(&mut self, unit: u16, address: u16) -> Option<i16> {
        let _ = (unit, address);
        None
    }
    /// Writes a word of the buffer memory of module `unit`.
    fn write_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
        let _ = (unit, address, value);
        None
    }
    /// Waits until remote module `unit` answers, `most_ms` milliseconds at most (h1u-h2u-programming §5.9.5, D8299);
    /// false if it has not. By default only its buffer memory shows whether it is there.
    fn module_answers(&mut self, unit: u16, most_ms: u16) -> bool {
        let _ = (unit, most_ms);
        true
    }
    /// Raw value of a built-in analog input.
    fn analog(&mut self, channel: u8) -> Option<i16> {
        let _ = channel;
        None
    }
    /// Returns true if the power supply fails now, so that the PLC runs on the charge of its capacitors; `None` if it
    /// is not monitored.
    fn power_fails(&mut self) -> Option<bool> {
        None
    }
    /// Voltage of the battery in tenths of a volt; `None` if nothing measures it.
    fn battery(&mut self) -> Option<u16> {
        None
    }
    /// Reads the input terminals from X number `first` on now, outside the input refresh (REF); `None` where there is
    /// none.
    fn input(&mut self, number: u16) -> Option<bool> {
        let _ = number;
        None
    }
    /// Sets an output terminal now, outside the output refresh: REF, and [`crate::Program::pulse_timer`] for the pins
    /// of pulse outputs.
    fn set_output(&mut self, number: u16, value: bool) {
        let _ = (number, value);
    }
    /// The CAN bus. Where there is none, frames go to and come from a serial port as SLCAN writes them
    /// ([`crate::comm::CAN_PORT`]).
    fn can_bus(&mut self) -> Option<&mut dyn CanBus> {
        None
    }
    /// The serial port that the model's manual numbers so.
    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        let _ = number;
        None
    }
    /// Keeps the interrupt from coming that calls [`crate::Program::pulse_timer`], or lets it come again, for the few
    /// microseconds in which an instruction changes what an output sends. For a host that has no such interrupt there
    /// is nothing to do.
    fn hold_pulses(&mut self, hold: bool) {
        let _ = hold;
    }
    /// Does `work` while the interrupt that sends pulses with separate outputs ([`crate::board::send_pulses`]) is held
    /// off, on these: they are copied, from and to the program's. A host without such an interrupt has none.
    fn with_pulses(&mut self, work: &mut dyn FnMut(&mut [Option<Axis>])) {
        work(&mut []);
    }
}

/// Hardware with nothing fitted.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoHal;

impl Hal for NoHal {}
