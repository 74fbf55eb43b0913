//! Characters on a line: how long they take, and what may go wrong with them.

/// The bit that makes a character odd or even.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Parity {
    /// There is none.
    #[default]
    None = 0,
    /// The ones of a character are odd.
    Odd = 1,
    /// The ones of a character are even.
    Even = 2,
}

/// The format of characters on a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct LineFormat {
    /// Bits per second; 0 before the port has been set up.
    pub bits_per_second: u32,
    /// 7 or 8.
    pub data_bits: u8,
    /// The bit after them.
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
    /// Sends and receives by turns, on one pair of wires (RS-485): the driver is on while it sends, and what comes then is not received.
    pub half_duplex: bool,
}

/// Bit rates by the digit of a format word, in hundreds of bits per second (h1u-h2u-programming §5.6, table of D8120; 13
/// is that of L01S for 115,200 bit/s, l01s-programming §9.2, and means nothing on other models); 0 stands for none.
const RATES: [u16; 16] = [
    0, 0, 0, 3, 6, 12, 24, 48, 96, 192, 384, 576, 1152, 1152, 0, 0,
];

/// Bit rates of HM by the high byte of UINIT's format word (hm-motion-controller §6.2).
const HM_RATES: [u32; 5] = [9600, 19_200, 38_400, 57_600, 115_200];

/// Bit of a format word: sends and receives by turns.
const HALF_DUPLEX: u16 = 1 << 10;

impl LineFormat {
    /// Before the port has been set up.
    pub const fn new() -> Self {
        LineFormat {
            bits_per_second: 0,
            data_bits: 8,
            parity: Parity::None,
            stop_bits: 1,
            half_duplex: false,
        }
    }

    /// 7 data bits, even parity, 1 stop bit: the programming port, and links between PLCs.
    pub const fn seven_even(bits_per_second: u32, half_duplex: bool) -> Self {
        LineFormat {
            bits_per_second,
            data_bits: 7,
            parity: Parity::Even,
            stop_bits: 1,
            half_duplex,
        }
    }

    /// The meaning of a format word (D8120 and similar registers). A rate that it does not name is 9600 bit/s.
    pub fn from_word(word: u16) -> Self {
        let rate = u32::from(RATES[usize::from(word >> 4 & 15)]) * 100;
        LineFormat {
            bits_per_second: if rate == 0 { 9600 } else { rate },
            data_bits: 7 + (word & 1) as u8,
            parity: Parity::from_bits(word),
            stop_bits: 1 + (word >> 3 & 1) as u8,
            half_duplex: word & HALF_DUPLEX != 0,
        }
    }

    /// Returns true if a format word selects a bit rate.
    pub fn has_rate(word: u16) -> bool {
        RATES[usize::from(word >> 4 & 15)] != 0
    }

    /// Returns true if the format word of HM's UINIT selects a bit rate.
    pub fn has_uinit_rate(word: u16) -> bool {
        HM_RATES.get(usize::from(word >> 8)).is_some()
    }

    /// Line format of a format word of HM's UINIT: 8 data bits and 2 stop bits where the others have 7 and 1.
    pub fn from_uinit(word: u16, half_duplex: bool) -> Self {
        let rate = HM_RATES.get(usize::from(word >> 8));
        LineFormat {
            bits_per_second: rate.copied().unwrap_or(HM_RATES[0]),
            data_bits: 8 - (word & 1) as u8,
            parity: Parity::from_bits(word),
            stop_bits: 2 - (word >> 3 & 1) as u8,
            half_duplex,
        }
    }

    /// The same with 8 data bits, which protocols of bytes need.
    #[must_use]
    pub const fn eight_bits(mut self) -> Self {
        self.data_bits = 8;
        self
    }

    /// The same on one pair of wires.
    #[must_use]
    pub const fn half_duplex(mut self) -> Self {
        self.half_duplex = true;
        self
    }

    /// Bits of a character, its start bit included.
    pub const fn bits(&self) -> u32 {
        let parity = match self.parity {
            Parity::None => 0,
            Parity::Odd | Parity::Even => 1,
        };
        1 + self.data_bits as u32 + parity + self.stop_bits as u32
    }

    /// Duration of `halves` halves of a character, in nanoseconds.
    pub const fn nanoseconds(&self, halves: u32) -> u64 {
        self.bits() as u64 * halves as u64 * 500_000_000 / self.rate() as u64
    }

    /// The same in microseconds, for fewer than 600 halves.
    #[inline(never)]
    const fn microseconds(&self, halves: u32) -> u32 {
        self.bits() * halves * 500_000 / self.rate()
    }

    const fn rate(&self) -> u32 {
        match self.bits_per_second {
            0 => 9600,
            rate => rate,
        }
    }

    /// Duration of a character, in microseconds.
    pub const fn character_us(&self) -> u32 {
        self.microseconds(2)
    }

    /// Silence that ends a frame of Modbus RTU, in microseconds: 3.5 characters, or 1750 µs above 19,200 bit/s (Modbus over serial
    /// line §2.5.1.1).
    pub const fn silence_us(&self) -> u32 {
        if self.bits_per_second > 19_200 {
            1750
        } else {
            self.microseconds(7)
        }
    }

    /// The parameters that partners have to agree on, packed into one number: bits per second, 8 bits of data bits, 4
    /// of parity, 4 of stop bits.
    pub const fn packed(&self) -> i64 {
        (self.bits_per_second as i64) << 16
            | (self.data_bits as i64) << 8
            | (self.parity as i64) << 4
            | self.stop_bits as i64
    }

    /// The bits of a byte that a character carries.
    pub const fn mask(&self) -> u8 {
        if self.data_bits == 7 { 0x7f } else { 0xff }
    }
}

impl Parity {
    /// Bits 2 and 1 of a format word.
    fn from_bits(word: u16) -> Self {
        match word >> 1 & 3 {
            1 => Parity::Odd,
            3 => Parity::Even,
            _ => Parity::None,
        }
    }
}

/// Fault of a character.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum CharFault {
    /// Nothing.
    #[default]
    None = 0,
    /// Its parity.
    Parity = 1,
    /// It has no stop bit.
    Framing = 2,
    /// A character before it was lost in the receiver.
    Overrun = 3,
    /// The line was held at 0 for longer than a character.
    Break = 4,
}

impl CharFault {
    /// The fault of a number; of another number none.
    pub const fn of(number: u8) -> Self {
        match number {
            1 => CharFault::Parity,
            2 => CharFault::Framing,
            3 => CharFault::Overrun,
            4 => CharFault::Break,
            _ => CharFault::None,
        }
    }
}

/// A character that came in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Received {
    /// Time of its last bit: microseconds since power-on, wrapping.
    pub at_us: u32,
    /// Its value.
    pub byte: u8,
    /// Fault of the character.
    pub fault: CharFault,
}

impl Received {
    /// A 0 at power-on.
    pub const fn new() -> Self {
        Received {
            at_us: 0,
            byte: 0,
            fault: CharFault::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn format_words_say_how_characters_stand() {
        let format = LineFormat::from_word(0x81);
        assert_eq!((format.bits_per_second, format.bits()), (9600, 10));
        assert_eq!(format.character_us(), 1041);
        assert_eq!(format.silence_us(), 3645);
        let format = LineFormat::from_word(0x6086);
        assert_eq!(format, LineFormat::seven_even(9600, false));
        assert_eq!(LineFormat::from_word(0xc9).bits(), 11);
        assert_eq!(LineFormat::from_word(0xc1).silence_us(), 1750);
        assert_eq!(LineFormat::from_word(0xd1).bits_per_second, 115_200);
        assert!(LineFormat::from_word(0x481).half_duplex);
        assert_eq!(LineFormat::from_word(0).bits_per_second, 9600);
    }

    #[test]
    fn uinit_turns_the_bits_around() {
        let format = LineFormat::from_uinit(0x0008, true);
        assert_eq!(format, LineFormat::from_word(0x481));
        let format = LineFormat::from_uinit(0x020f, false);
        assert_eq!(format, LineFormat::seven_even(38_400, false));
        assert_eq!(LineFormat::from_uinit(0x0900, true).stop_bits, 2);
    }
}
