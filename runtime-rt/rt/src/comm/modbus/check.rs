//! The check codes of Modbus frames.

/// CRC contributions of a nibble: polynomial A001h, lowest bit first.
const NIBBLES: [u16; 16] = {
    let mut table = [0; 16];
    let mut nibble = 0;
    while nibble < table.len() {
        let mut crc = nibble as u16;
        let mut bit = 0;
        while bit < 4 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xa001 } else { 0 };
            bit += 1;
        }
        table[nibble] = crc;
        nibble += 1;
    }
    table
};

/// The CRC of no characters.
pub const CRC_START: u16 = 0xffff;

/// The CRC of one character more.
pub fn crc_step(crc: u16, byte: u8) -> u16 {
    let nibble = |crc: u16| crc >> 4 ^ NIBBLES[usize::from(crc & 15)];
    nibble(nibble(crc ^ u16::from(byte)))
}

/// CRC-16 of an RTU frame. Its low byte is sent first (h1u-h2u-programming §5.7.2).
pub fn crc16(bytes: &[u8]) -> u16 {
    bytes
        .iter()
        .fold(CRC_START, |crc, &byte| crc_step(crc, byte))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn worked_frames_check() {
        assert_eq!(crc16(&[1, 3, 0, 0x64, 0, 1]).to_le_bytes(), [0xc5, 0xd5]);
        assert_eq!(crc16(&[1, 0x83, 2]).to_le_bytes(), [0xc0, 0xf1]);
        assert_eq!(crc16(b"123456789"), 0x4b37);
    }

    proptest! {
        /// The table says what the definition says: bit by bit.
        #[test]
        fn nibbles_equal_bits(bytes: std::vec::Vec<u8>) {
            let bitwise = bytes.iter().fold(0xffff_u16, |crc, &byte| {
                (0..8).fold(crc ^ u16::from(byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xa001 } else { 0 })
            });
            prop_assert_eq!(crc16(&bytes), bitwise);
        }
    }
}
