//! UF2, the files that boot loaders with a mass-storage volume take (microsoft/uf2, "USB Flashing Format"): blocks of
//! 512 bytes, each with the address of 256 bytes of flash.

use super::{ERASED, LARGEST, Payload};
use std::ops::Range;

/// Bytes of a block.
const BLOCK: usize = 512;

/// Bytes of flash in a block.
const PIECE: usize = 256;

/// Offset of the data in a block.
const DATA: usize = 32;

/// Words at the beginning, and the word at the end of a block.
const MAGIC: [u32; 2] = [0x0A32_4655, 0x9E5D_5157];
const END: u32 = 0x0AB1_6F30;

/// The block is not for flash.
const NOT_FOR_FLASH: u32 = 1;

/// The block says whose it is.
const HAS_FAMILY: u32 = 0x2000;

/// The family of RP2040.
pub const RP2040: u32 = 0xE48B_FF56;

/// The file that a volume has, which says whose it is.
pub const INFO: &str = "INFO_UF2.TXT";

/// Name of an RP2040's boot drive, as set by its boot ROM.
pub const RP2040_BOARD: &str = "RPI-RP2";

/// Reason why a file is not UF2.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum Uf2Error {
    /// A block is cut off, or does not begin or end as one does.
    #[error("block {0} is not one of UF2")]
    Block(usize),
    /// There is another number of blocks than each of them says.
    #[error("block {block} declares {declared} blocks, the file has {found}")]
    Count {
        /// Number of the block, from 0.
        block: usize,
        /// Stated number of blocks.
        declared: u32,
        /// Actual number of blocks.
        found: usize,
    },
    /// It is for another family of microcontrollers.
    #[error("it is for the family 0x{0:08X}, not for RP2040 (0x{RP2040:08X})")]
    Family(u32),
    /// Its blocks are too far from each other to be in one flash memory.
    #[error("the image extends from 0x{:08X} to 0x{:X}, further than any flash", .0.start, .0.end)]
    Scattered(Range<u64>),
    /// It holds nothing for flash.
    #[error("it holds nothing for flash")]
    Empty,
}

/// Returns true if a file begins like UF2.
pub fn is_uf2(file: &[u8]) -> bool {
    file.starts_with(&MAGIC[0].to_le_bytes())
}

/// An image as UF2 for RP2040. Its first and last block are filled up with erased flash.
pub fn write(payload: &Payload) -> Vec<u8> {
    let begin = payload.origin - payload.origin % PIECE as u32;
    let pieces = (payload.end() - u64::from(begin)).div_ceil(PIECE as u64) as u32;
    let mut file = Vec::with_capacity(pieces as usize * BLOCK);
    for number in 0..pieces {
        let at = begin + number * PIECE as u32;
        let piece = payload.at(at..at + PIECE as u32);
        let [first, second] = MAGIC;
        let size = PIECE as u32;
        for word in [first, second, HAS_FAMILY, at, size, number, pieces, RP2040] {
            file.extend(word.to_le_bytes());
        }
        file.extend(piece);
        file.resize(file.len() + BLOCK - DATA - PIECE - 4, 0);
        file.extend(END.to_le_bytes());
    }
    file
}

fn word(block: &[u8], at: usize) -> u32 {
    let bytes = block
        .get(at..at + 4)
        .and_then(|bytes| bytes.try_into().ok());
    bytes.map_or(0, u32::from_le_bytes)
}

/// The image in a file for RP2040.
///
/// # Errors
/// The file is not UF2, is for another family, or its image does not fit one flash memory.
pub fn read(file: &[u8]) -> Result<Payload, Uf2Error> {
    let blocks: Vec<_> = file.chunks(BLOCK).enumerate().collect();
    let mut parts = Vec::new();
    for (number, block) in &blocks {
        let begins = [word(block, 0), word(block, 4)] == MAGIC;
        let size = word(block, 16) as usize;
        let data = block
            .get(DATA..DATA + size)
            .filter(|_| size <= BLOCK - DATA - 4);
        let (true, Some(data), END) = (begins, data, word(block, BLOCK - 4)) else {
            return Err(Uf2Error::Block(*number));
        };
        let (flags, declared) = (word(block, 8), word(block, 24));
        if declared as usize != blocks.len() {
            let (block, found) = (*number, blocks.len());
            return Err(Uf2Error::Count {
                block,
                declared,
                found,
            });
        }
        let family = word(block, 28);
        if flags & HAS_FAMILY != 0 && family != RP2040 {
            return Err(Uf2Error::Family(family));
        }
        if flags & NOT_FOR_FLASH == 0 {
            parts.push((word(block, 12), data));
        }
    }
    let end = |&(at, data): &(u32, &[u8])| u64::from(at) + data.len() as u64;
    let first = parts.iter().map(|part| part.0).min();
    let (Some(origin), Some(end)) = (first, parts.iter().map(end).max()) else {
        return Err(Uf2Error::Empty);
    };
    if end - u64::from(origin) > u64::from(LARGEST) || end > 1 << 32 {
        return Err(Uf2Error::Scattered(u64::from(origin)..end));
    }
    let mut bytes = vec![ERASED; (end - u64::from(origin)) as usize];
    for (at, data) in parts {
        let offset = (at - origin) as usize;
        bytes[offset..offset + data.len()].copy_from_slice(data);
    }
    Ok(Payload {
        origin,
        bytes,
        is_elf: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> Payload {
        Payload {
            origin: 0x1000_0000,
            bytes: (0..700u32).map(|n| n as u8).collect(),
            is_elf: true,
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let file = write(&image());
        assert!(is_uf2(&file));
        assert_eq!(file.len(), 3 * BLOCK);
        let again = read(&file).unwrap();
        assert_eq!(again.origin, 0x1000_0000);
        assert_eq!(again.bytes[..700], image().bytes);
        assert!(again.bytes[700..].iter().all(|byte| *byte == ERASED));
    }

    #[test]
    fn damaged_files_are_rejected() {
        let file = write(&image());
        assert_eq!(read(&file[..file.len() - 1]), Err(Uf2Error::Block(2)));
        let short = read(&file[..2 * BLOCK]);
        assert_eq!(
            short.unwrap_err().to_string(),
            "block 0 declares 3 blocks, the file has 2"
        );
        let mut other = file.clone();
        other[28] = 0;
        let family = read(&other).unwrap_err();
        assert_eq!(family, Uf2Error::Family(0xE48B_FF00));
        let mut long = file.clone();
        long[16..20].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(read(&long), Err(Uf2Error::Block(0)));
        let mut far = file.clone();
        far[12..16].copy_from_slice(&0u32.to_le_bytes());
        assert_eq!(read(&far), Err(Uf2Error::Scattered(0..0x1000_0300)));
        let mut nothing = file;
        nothing.chunks_mut(BLOCK).for_each(|block| block[8] = 1);
        assert_eq!(read(&nothing), Err(Uf2Error::Empty));
        assert_eq!(read(&[]), Err(Uf2Error::Empty));
    }
}
