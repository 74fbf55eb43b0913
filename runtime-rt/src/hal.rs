//! The hardware as instructions see it.

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

/// What an instruction may ask of the hardware. Every method has a default that means "not fitted".
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
    /// Raw value of a built-in analog input.
    fn analog(&mut self, channel: u8) -> Option<i16> {
        let _ = channel;
        None
    }
    /// Reads the input terminals from X number `first` on now, outside the input refresh (REF); `None` where there is none.
    fn input(&mut self, number: u16) -> Option<bool> {
        let _ = number;
        None
    }
    /// Sets an output terminal now, outside the output refresh (REF).
    fn set_output(&mut self, number: u16, value: bool) {
        let _ = (number, value);
    }
}

/// Hardware with nothing fitted.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoHal;

impl Hal for NoHal {}
