//! The parts that the boot loader reports, by their product numbers (AN2606, tables of product IDs).

use std::ops::Range;

/// Start of flash in every part.
pub const FLASH: u32 = 0x0800_0000;

/// Division of flash into units that are erased at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pages {
    /// Pages of this many bytes.
    Equal(u32),
    /// Sectors of an STM32F2 or F4: four of 16 KiB, one of 64 KiB, the rest of 128 KiB.
    Sectors,
}

/// A part, or several that report the same number.
#[derive(Debug, PartialEq, Eq)]
pub struct Chip {
    /// The number that the boot loader reports.
    pub id: u16,
    /// Its name.
    pub name: &'static str,
    /// Bytes of flash of the largest of them.
    pub flash: u32,
    /// Address of the part's flash size register, in KiB (see the reference manuals).
    pub size_at: u32,
    /// Units that are erased at once.
    pub pages: Pages,
}

const KIB: u32 = 1024;
const F1_SIZE: u32 = 0x1FFF_F7E0;
const F0_SIZE: u32 = 0x1FFF_F7CC;
const F4_SIZE: u32 = 0x1FFF_7A22;

const fn chip(id: u16, name: &'static str, flash: u32, size_at: u32, pages: Pages) -> Chip {
    Chip {
        id,
        name,
        flash: flash * KIB,
        size_at,
        pages,
    }
}

/// All of them.
pub static ALL: [Chip; 16] = [
    chip(
        0x410,
        "STM32F103x8/xB (medium density)",
        128,
        F1_SIZE,
        Pages::Equal(KIB),
    ),
    chip(0x411, "STM32F2", 1024, F4_SIZE, Pages::Sectors),
    chip(
        0x412,
        "STM32F103x4/x6 (low density)",
        32,
        F1_SIZE,
        Pages::Equal(KIB),
    ),
    chip(0x413, "STM32F405/F407", 1024, F4_SIZE, Pages::Sectors),
    chip(
        0x414,
        "STM32F103xC/xD/xE (high density)",
        512,
        F1_SIZE,
        Pages::Equal(2 * KIB),
    ),
    chip(0x418, "STM32F105/F107", 256, F1_SIZE, Pages::Equal(2 * KIB)),
    chip(
        0x420,
        "STM32F100x4/x6/x8/xB",
        128,
        F1_SIZE,
        Pages::Equal(KIB),
    ),
    chip(0x423, "STM32F401xB/xC", 256, F4_SIZE, Pages::Sectors),
    chip(
        0x428,
        "STM32F100xC/xD/xE",
        512,
        F1_SIZE,
        Pages::Equal(2 * KIB),
    ),
    chip(0x431, "STM32F411", 512, F4_SIZE, Pages::Sectors),
    chip(0x433, "STM32F401xD/xE", 512, F4_SIZE, Pages::Sectors),
    chip(0x440, "STM32F030x8/F05x", 64, F0_SIZE, Pages::Equal(KIB)),
    chip(
        0x442,
        "STM32F030xC/F09x",
        256,
        F0_SIZE,
        Pages::Equal(2 * KIB),
    ),
    chip(0x444, "STM32F030x4/x6/F03x", 32, F0_SIZE, Pages::Equal(KIB)),
    chip(0x445, "STM32F04x/F070x6", 32, F0_SIZE, Pages::Equal(KIB)),
    chip(
        0x448,
        "STM32F070xB/F07x",
        128,
        F0_SIZE,
        Pages::Equal(2 * KIB),
    ),
];

/// The part of this number.
pub fn find(id: u16) -> Option<&'static Chip> {
    ALL.iter().find(|chip| chip.id == id)
}

impl Chip {
    /// The addresses of the pages of a part with this many bytes of flash, in order.
    pub fn pages(&self, flash: u32) -> impl Iterator<Item = Range<u32>> {
        let pages = self.pages;
        let length = move |number: u32| match (pages, number) {
            (Pages::Equal(length), _) => length,
            (Pages::Sectors, 0..4) => 16 * KIB,
            (Pages::Sectors, 4) => 64 * KIB,
            (Pages::Sectors, _) => 128 * KIB,
        };
        let mut at = FLASH;
        (0..).map_while(move |number| {
            let start = at;
            at += length(number);
            (start < FLASH + flash).then_some(start..at)
        })
    }
}
