//! The second stage of the boot ROM of an RP2040, with which its flash begins: `templates/boot2.s` in machine code.
//! The boot ROM starts nothing if its checksum is wrong (RP2040 data sheet §2.8.1.3.1).

use crate::board::{Board, Chip};
use std::fmt::Write;

/// Size in words, the checksum included.
const WORDS: usize = 64;

/// The machine code.
const BOOT2: [u32; 19] = [
    0x2100_4B0C,
    0x2104_6099,
    0x490B_6159,
    0x490B_6019,
    0x6011_4A0B,
    0x6059_2100,
    0x6099_2101,
    0x2800_4670,
    0x4808_D106,
    0x6008_4908,
    0xF382_C80C,
    0x4718_8808,
    0x46C0_4700,
    0x1800_0000,
    0x001F_0300,
    0x0300_0218,
    0x1800_00F4,
    0x1000_0100,
    0xE000_ED08,
];

/// Section for the linker: before everything else.
const SECTION: &str = "    .boot2 : { KEEP(*(.boot2)) } > FLASH\n";

/// Code copied to RAM with the data, because flash cannot be read while it runs.
const IN_RAM: &str = " *(.ram_text)";

/// Returns true if flash of a board begins with it.
fn is_there(board: &Board) -> bool {
    board.chip == Some(Chip::Rp2040)
}

/// The code, what follows it, and the checksum.
fn words() -> [u32; WORDS] {
    let mut words = [0; WORDS];
    words[..BOOT2.len()].copy_from_slice(&BOOT2);
    let bytes = words[..WORDS - 1]
        .iter()
        .flat_map(|word| word.to_le_bytes());
    words[WORDS - 1] = checksum(bytes);
    words
}

/// CRC-32 with the polynomial 04C11DB7, from all ones on, highest bit first, without a last inversion.
fn checksum(bytes: impl Iterator<Item = u8>) -> u32 {
    bytes.fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(byte) << 24, |crc, _| {
            let shifted = crc << 1;
            if crc >> 31 == 0 {
                shifted
            } else {
                shifted ^ 0x04C1_1DB7
            }
        })
    })
}

/// The lines of a table of words.
fn table(prefix: &str, between: &str, suffix: &str) -> String {
    let mut text = String::new();
    for row in words().chunks(8) {
        let row: Vec<_> = row.iter().map(|word| format!("0x{word:08X}")).collect();
        // Writing to a String does not fail.
        let _ = writeln!(text, "{prefix}{}{suffix}", row.join(between));
    }
    text
}

/// It as a table in C; nothing for other boards.
pub(super) fn in_c(board: &Board) -> String {
    if !is_there(board) {
        return String::new();
    }
    format!(
        "/* Second stage of the boot: it lets flash be read at its addresses, and starts the image. The last word is \
         its checksum. */\n\
         __attribute__((section(\".boot2\"), used)) static const uint32_t boot2[{WORDS}] = {{\n{}}};\n\n",
        table("    ", "u, ", "u,")
    )
}

/// It in assembler, after the vectors.
pub(super) fn in_assembler(board: &Board) -> String {
    if !is_there(board) {
        return String::new();
    }
    format!(
        "\n@ What the boot ROM starts: it lets flash be read at its addresses, and starts the image. The last word is \
         its checksum.\n\
         .section .boot2, \"a\", %progbits\n{}",
        table("    .word ", ", ", "")
    )
}

/// The linker script's sections for it, and for code in RAM.
pub(super) fn sections(board: &Board) -> [&'static str; 2] {
    match is_there(board) {
        true => [SECTION, IN_RAM],
        false => ["", ""],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_data_sheet() {
        // CRC-32/MPEG-2 of the digits 1 to 9 (the catalogue of parametrised CRC algorithms).
        assert_eq!(checksum(b"123456789".iter().copied()), 0x0376_E6E7);
    }
}
