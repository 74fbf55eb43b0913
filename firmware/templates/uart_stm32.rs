// Registers of a USART: /* KIND */.
/* REGISTERS */
/// USART.
impl Uart {
    fn has_room(&self) -> bool {
        read(self.at + STATE) & 1 << 7 != 0 // TXE
    }

    fn has_sent(&self) -> bool {
        read(self.at + STATE) & 1 << 6 != 0 // TC
    }

    /// The interrupt comes when there is room, or when the last bit is out.
    fn expect(&self, room: bool, end: bool) {
        let control = read(self.at + CONTROL_1) & !(3 << 6);
        let own = u32::from(room) << 7 | u32::from(end) << 6; // TXEIE, TCIE
        write(self.at + CONTROL_1, control | own);
    }

    fn next_character(&self) -> Option<(u8, CharFault)> {
        let state = read(self.at + STATE);
        if state & (1 << 5 | 1 << 3) == 0 {
            return None; // neither RXNE nor ORE
        }
        let byte = read(self.at + IN) as u8;
/* CLEAR */        let fault = match (state & 1 << 3 != 0, state & 1 << 1 != 0, state & 1 != 0) {
            (true, ..) => CharFault::Overrun,
            (_, true, _) if byte == 0 => CharFault::Break,
            (_, true, _) => CharFault::Framing,
            (_, _, true) => CharFault::Parity,
            _ => CharFault::None,
        };
        Some((byte, fault))
    }

    fn set_up(&self, format: LineFormat) {
        let parity = match (format.parity, format.data_bits) {
            (Parity::None, _) => 0,
            (parity, bits) => {
                // PCE, PS, M: the ninth bit is parity
                1 << 10 | u32::from(parity == Parity::Odd) << 9 | u32::from(bits == 8) << 12
            }
        };
        write(self.at + CONTROL_1, 0);
        write(self.at + CONTROL_2, u32::from(format.stop_bits == 2) << 13);
        let rate = format.bits_per_second;
        write(self.at + RATE, (self.clock_hz + rate / 2) / rate);
        // RXNEIE, TE, RE
        write(self.at + CONTROL_1, 1 << ENABLE | 1 << 5 | 1 << 3 | 1 << 2 | parity);
    }
}

