// Registers of a PL011, without its queues.
const OUT: usize = 0x00;
const IN: usize = 0x00;
const FAULTS: usize = 0x04;
const STATE: usize = 0x18;
const RATE: usize = 0x24;
const FRACTION: usize = 0x28;
const FORMAT: usize = 0x2C;
const CONTROL: usize = 0x30;
const MASK: usize = 0x38;

/// PL011.
impl Uart {
    fn has_room(&self) -> bool {
        read(self.at + STATE) & 1 << 5 == 0 // TXFF
    }

    fn has_sent(&self) -> bool {
        read(self.at + STATE) & 1 << 3 == 0 // BUSY
    }

    /// The interrupt comes when there is room; none signals the end of the last bit: the tick checks it.
    fn expect(&self, room: bool, _end: bool) {
        write(self.at + MASK, 1 << 4 | u32::from(room) << 5); // RXIM, TXIM
    }

    fn next_character(&self) -> Option<(u8, CharFault)> {
        if read(self.at + STATE) & 1 << 4 != 0 {
            return None; // RXFE
        }
        let data = read(self.at + IN);
        write(self.at + FAULTS, 0);
        let is = |bit: u32| data & 1 << bit != 0;
        let fault = match (is(11), is(10), is(8), is(9)) {
            (true, ..) => CharFault::Overrun,
            (_, true, ..) => CharFault::Break,
            (_, _, true, _) => CharFault::Framing,
            (.., true) => CharFault::Parity,
            _ => CharFault::None,
        };
        Some((data as u8, fault))
    }

    fn set_up(&self, format: LineFormat) {
        let rate = u64::from(format.bits_per_second);
        let divisor = ((u64::from(self.clock_hz) * 4 + rate / 2) / rate) as u32; // in 64ths
        // PEN, EPS
        let parity = match format.parity {
            Parity::None => 0,
            parity => 1 << 1 | u32::from(parity == Parity::Even) << 2,
        };
        // WLEN, STP2
        let bits = if format.data_bits == 7 { 2 } else { 3 };
        let line = bits << 5 | u32::from(format.stop_bits == 2) << 3 | parity;
        write(self.at + CONTROL, 0);
        write(self.at + RATE, divisor >> 6);
        write(self.at + FRACTION, divisor & 0x3F);
        write(self.at + FORMAT, line);
        write(self.at + MASK, 1 << 4); // RXIM
        write(self.at + CONTROL, 1 << 9 | 1 << 8 | 1); // RXE, TXE, UARTEN
    }
}

