// Registers of a CMSDK UART.
const OUT: usize = 0x00;
const IN: usize = 0x00;
const STATE: usize = 0x04;
const CONTROL: usize = 0x08;
const INTERRUPTS: usize = 0x0C;
const RATE: usize = 0x10;

/// CMSDK UART.
impl Uart {
    fn has_room(&self) -> bool {
        read(self.at + STATE) & 1 == 0
    }

    fn has_sent(&self) -> bool {
        self.has_room()
    }

    /// The interrupt comes whenever there is room again.
    fn expect(&self, _room: bool, _end: bool) {}

    fn next_character(&self) -> Option<(u8, CharFault)> {
        write(self.at + INTERRUPTS, 3); // those of both directions are seen to
        let state = read(self.at + STATE);
        if state & 1 << 1 == 0 {
            return None;
        }
        let byte = read(self.at + IN) as u8;
        write(self.at + STATE, 1 << 3);
        match state & 1 << 3 {
            0 => Some((byte, CharFault::None)),
            _ => Some((byte, CharFault::Overrun)),
        }
    }

    fn set_up(&self, format: LineFormat) {
        write(self.at + CONTROL, 0);
        write(self.at + RATE, self.clock_hz / format.bits_per_second);
        write(self.at + CONTROL, 0xF); // both directions, with their interrupts
    }
}

