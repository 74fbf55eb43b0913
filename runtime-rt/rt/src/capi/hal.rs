//! The host's hardware, as instructions ask it.

use super::HalTable;
use crate::comm::{CanFrame, LineFormat, Received};
use crate::hal::{CanBus, Clock, Hal, SerialPort};

/// The host's hardware.
pub(super) struct Board {
    table: *const HalTable,
    line: Line,
}

impl CanBus for Board {
    fn receive(&mut self) -> Option<CanFrame> {
        let table = self.table()?;
        let mut frame = CanFrame::new();
        (table.can_receive?)(table.context, &mut frame).then_some(frame)
    }

    fn send(&mut self, frame: &CanFrame) -> bool {
        let table = self.table().and_then(|t| t.can_send.map(|f| (t, f)));
        table.is_some_and(|(table, send)| send(table.context, frame))
    }

    fn is_sending(&mut self) -> bool {
        let table = self.table().and_then(|t| t.can_is_sending.map(|f| (t, f)));
        table.is_some_and(|(table, is_sending)| is_sending(table.context))
    }
}

/// One of its serial ports.
struct Line {
    table: *const HalTable,
    number: u8,
}

impl Line {
    fn table(&self) -> Option<&HalTable> {
        // SAFETY: NULL, or the host's table, which outlives the call.
        unsafe { self.table.as_ref() }
    }
}

impl SerialPort for Line {
    fn set_format(&mut self, format: LineFormat) {
        if let Some((table, set)) = self.table().and_then(|t| t.set_line.map(|f| (t, f))) {
            set(table.context, self.number, &format);
        }
    }

    fn receive(&mut self, now_us: u32) -> Option<Received> {
        let table = self.table()?;
        let mut received = Received::new();
        (table.receive?)(table.context, self.number, now_us, &mut received).then_some(received)
    }

    fn send(&mut self, byte: u8, now_us: u32) -> bool {
        let table = self.table().and_then(|t| t.send.map(|f| (t, f)));
        table.is_some_and(|(table, send)| send(table.context, self.number, byte, now_us))
    }

    fn unsent(&mut self, now_us: u32) -> u16 {
        let table = self.table().and_then(|t| t.unsent.map(|f| (t, f)));
        table.map_or(0, |(table, unsent)| {
            unsent(table.context, self.number, now_us)
        })
    }
}

impl Board {
    pub(super) fn new(table: *const HalTable) -> Self {
        Board {
            table,
            line: Line { table, number: 0 },
        }
    }

    fn table(&self) -> Option<&HalTable> {
        // SAFETY: NULL, or the host's table, which outlives the call.
        unsafe { self.table.as_ref() }
    }
}

/// The host's serial ports and its CAN bus, for what needs nothing else of its hardware.
pub(super) struct Lines(Board);

impl Lines {
    pub(super) fn new(table: *const HalTable) -> Self {
        Lines(Board::new(table))
    }
}

impl Hal for Lines {
    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        self.0.serial_port(number)
    }

    fn can_bus(&mut self) -> Option<&mut dyn CanBus> {
        self.0.can_bus()
    }
}

impl Hal for Board {
    fn clock(&mut self) -> Option<Clock> {
        let table = self.table()?;
        let mut clock = Clock::default();
        (table.clock?)(table.context, &mut clock).then_some(clock)
    }

    fn set_clock(&mut self, clock: Clock) -> Option<()> {
        let table = self.table()?;
        (table.set_clock?)(table.context, &clock).then_some(())
    }

    fn read_bfm(&mut self, unit: u16, address: u16) -> Option<i16> {
        let table = self.table()?;
        let mut value = 0;
        (table.read_bfm?)(table.context, unit, address, &mut value).then_some(value)
    }

    fn write_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
        let table = self.table()?;
        (table.write_bfm?)(table.context, unit, address, value).then_some(())
    }

    fn module_answers(&mut self, unit: u16, most_ms: u16) -> bool {
        let table = self.table();
        let asks = table.and_then(|table| Some((table.module_answers?, table.context)));
        asks.is_none_or(|(asks, context)| asks(context, unit, most_ms))
    }

    fn analog(&mut self, channel: u8) -> Option<i16> {
        let table = self.table()?;
        let mut value = 0;
        (table.analog?)(table.context, channel, &mut value).then_some(value)
    }

    fn power_fails(&mut self) -> Option<bool> {
        let table = self.table()?;
        Some((table.power_fails?)(table.context))
    }

    fn battery(&mut self) -> Option<u16> {
        let table = self.table()?;
        let mut tenths = 0;
        (table.battery?)(table.context, &mut tenths).then_some(tenths)
    }

    fn input(&mut self, number: u16) -> Option<bool> {
        let table = self.table()?;
        let mut on = false;
        (table.input?)(table.context, number, &mut on).then_some(on)
    }

    fn set_output(&mut self, number: u16, value: bool) {
        if let Some((table, set_output)) = self.table().and_then(|t| t.set_output.map(|f| (t, f))) {
            set_output(table.context, number, value);
        }
    }

    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        self.table()?.set_line?;
        self.line.number = number;
        Some(&mut self.line)
    }

    fn can_bus(&mut self) -> Option<&mut dyn CanBus> {
        self.table()?.can_send?;
        Some(self)
    }

    fn hold_pulses(&mut self, hold: bool) {
        if let Some((table, hold_pulses)) = self.table().and_then(|t| t.hold_pulses.map(|f| (t, f)))
        {
            hold_pulses(table.context, hold);
        }
    }
}
