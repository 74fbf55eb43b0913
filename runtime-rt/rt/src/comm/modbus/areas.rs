//! Modbus addresses of devices: the map of each model as data.

use super::Profile;
use super::function::{
    READ_COILS, READ_INPUT_REGISTERS, READ_INPUTS, READ_REGISTERS, WRITE_COILS, WRITE_REGISTERS,
};
use crate::plc::Class;

/// Mapping of devices to addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// One bit to an address; for T and C the contact.
    Bits,
    /// Coils of timers and counters, one to an address.
    Coils,
    /// One word to an address; for T and C the current value.
    Words,
    /// 32-bit counters, two registers each, the low word first.
    Counters,
    /// Sixteen bits to a register, the first the lowest.
    Packed,
}

/// Addresses that stand for consecutive devices of one class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The first address, as in frames.
    pub address: u16,
    /// Number of addresses.
    pub count: u16,
    /// The class of the devices.
    pub class: Class,
    /// Number of the first device.
    pub first: u32,
    /// Mapping of the devices to the addresses.
    pub fill: Fill,
    /// True if a frame may write them.
    pub writable: bool,
}

impl Area {
    const fn new(address: u16, count: u16, class: Class, first: u32, fill: Fill) -> Self {
        Area {
            address,
            count,
            class,
            first,
            fill,
            writable: true,
        }
    }

    const fn read_only(mut self) -> Self {
        self.writable = false;
        self
    }

    /// Returns true if `address` is one of these.
    fn holds(&self, address: u16) -> bool {
        address.wrapping_sub(self.address) < self.count
    }

    /// Address of a device, or of the first half of a 32-bit counter; `None` if it is not among these, or shares a
    /// register with others.
    pub fn address_of(&self, class: Class, number: u32) -> Option<u16> {
        let offset = number.checked_sub(self.first)?;
        let offset = match self.fill {
            _ if class != self.class => return None,
            Fill::Bits | Fill::Words => offset,
            Fill::Counters => offset.checked_mul(2)?,
            Fill::Coils | Fill::Packed => return None,
        };
        let offset = u16::try_from(offset).ok()?;
        (offset < self.count).then(|| self.address.wrapping_add(offset))
    }

    /// The content of an address that is one of these.
    #[inline(always)]
    fn place(&self, address: u16) -> Place {
        let offset = u32::from(address.wrapping_sub(self.address));
        match self.fill {
            Fill::Bits => Place::Bits(self.class, self.first + offset, 1),
            Fill::Coils => Place::Coil(self.class, self.first + offset),
            Fill::Words => Place::Word(self.class, self.first + offset),
            Fill::Counters => Place::Half {
                counter: self.first + offset / 2,
                high: offset % 2 == 1,
            },
            Fill::Packed => Place::Bits(self.class, self.first + 16 * offset, 16),
        }
    }
}

/// The content of one address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A bit device, or 16 of them from this one on, the first the lowest.
    Bits(Class, u32, u32),
    /// The coil of a timer or counter.
    Coil(Class, u32),
    /// A word device.
    Word(Class, u32),
    /// Half of a 32-bit counter.
    Half {
        /// Its number.
        counter: u32,
        /// True for the high word.
        high: bool,
    },
}

/// The content of an address.
pub(in crate::comm) fn place(areas: &[Area], address: u16) -> Option<Place> {
    let area = areas.iter().find(|area| area.holds(address))?;
    Some(area.place(address))
}

/// Shows the content of the `count` addresses starting at `first`, with its index; `None` as soon as there is none, or
/// none that may be written, or `show` gives `None`.
pub(super) fn visit(
    areas: &[Area],
    first: u16,
    count: u16,
    writes: bool,
    mut show: impl FnMut(u16, Place) -> Option<()>,
) -> Option<()> {
    // Most ranges lie in one area: the last one is tried first.
    let mut area = areas.first()?;
    for index in 0..count {
        let address = first.checked_add(index)?;
        if !area.holds(address) {
            area = areas.iter().find(|area| area.holds(address))?;
        }
        if writes && !area.writable {
            return None;
        }
        show(index, area.place(address))?;
    }
    Some(())
}

/// The largest numbers of coils and registers that one frame may be about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Coils or inputs read (01, 02).
    pub read_bits: u16,
    /// Coils written (0F).
    pub write_bits: u16,
    /// Registers read (03, 04).
    pub read_words: u16,
    /// Registers written (10).
    pub write_words: u16,
    /// True if a master supports 07, 08, 0B, 0C, 11 and 16.
    pub diagnosis: bool,
}

impl Limits {
    /// Those of the public standard.
    pub const STANDARD: Self = Limits {
        read_bits: 2000,
        write_bits: 1968,
        read_words: 125,
        write_words: 123,
        diagnosis: false,
    };
    /// ADPRW of FX3 (FX3U MODBUS manual JY997D26201 §7.1).
    pub const FX3: Self = Limits {
        diagnosis: true,
        ..Self::STANDARD
    };
    /// H2U writes at most 120 registers (h1u-h2u-programming §5.7).
    pub const H2U: Self = Limits {
        write_words: 120,
        ..Self::STANDARD
    };
    /// H1U (h1u-h2u-programming §5.7).
    pub const H1U: Self = Limits {
        read_bits: 800,
        write_bits: 800,
        read_words: 50,
        write_words: 50,
        ..Self::STANDARD
    };
    /// RD3A and WR3A of L01S over ASCII (l01s-programming §8.1.1).
    pub const L01S_ASCII: Self = Limits {
        read_words: 45,
        write_words: 45,
        ..Self::STANDARD
    };

    /// Largest number of coils or registers of a request; `None` if the function has no number.
    pub const fn most(&self, function: u8) -> Option<u16> {
        match function {
            READ_COILS | READ_INPUTS => Some(self.read_bits),
            READ_REGISTERS | READ_INPUT_REGISTERS => Some(self.read_words),
            WRITE_COILS => Some(self.write_bits),
            WRITE_REGISTERS => Some(self.write_words),
            _ => None,
        }
    }
}

const fn bits(address: u16, count: u16, class: Class, first: u32) -> Area {
    Area::new(address, count, class, first, Fill::Bits)
}

const fn words(address: u16, count: u16, class: Class, first: u32) -> Area {
    Area::new(address, count, class, first, Fill::Words)
}

const fn packed(address: u16, count: u16, class: Class) -> Area {
    Area::new(address, count, class, 0, Fill::Packed)
}

/// C200 to C255.
const fn counters(address: u16) -> Area {
    Area::new(address, 112, Class::C, 200, Fill::Counters)
}

/// h1u-h2u-programming §5.7.2; 02 reads what 01 reads.
const INOVANCE_BITS: &[Area] = &[
    bits(0x0000, 3072, Class::M, 0),
    bits(0x1f40, 256, Class::M, 8000),
    bits(0xe000, 1000, Class::S, 0),
    bits(0xf000, 256, Class::T, 0),
    bits(0xf400, 256, Class::C, 0),
    bits(0xf800, 256, Class::X, 0).read_only(),
    bits(0xfc00, 256, Class::Y, 0),
];

/// h1u-h2u-programming §5.7.2; 04 reads what 03 reads.
const INOVANCE_WORDS: &[Area] = &[
    words(0x0000, 8256, Class::D, 0),
    words(0xf000, 256, Class::T, 0),
    words(0xf400, 200, Class::C, 0),
    counters(0xf700),
];

/// A program without Modbus.
pub static NOTHING: Profile = Profile {
    name: "nothing",
    coils: &[],
    inputs: &[],
    registers: &[],
    input_registers: &[],
    limits: Limits::STANDARD,
    any_value_is_on: false,
    shortest: 5,
    counters_by_06: false,
};

/// H2U as a slave.
pub static H2U: Profile = Profile {
    name: "h2u",
    coils: INOVANCE_BITS,
    inputs: INOVANCE_BITS,
    registers: INOVANCE_WORDS,
    input_registers: INOVANCE_WORDS,
    limits: Limits::H2U,
    any_value_is_on: true,
    shortest: 5,
    counters_by_06: false,
};

impl Profile {
    /// Returns true if coils of timers and counters have separate addresses.
    pub fn serves_coils(&self) -> bool {
        self.coils.iter().any(|area| area.fill == Fill::Coils)
    }
}

/// H1U as a slave.
pub static H1U: Profile = Profile {
    name: "h1u",
    limits: Limits::H1U,
    ..H2U
};

/// L01S as a slave (l01s-programming §8.1.4): each device in one table alone.
pub static L01S: Profile = Profile {
    name: "l01s",
    coils: &[
        bits(0x0000, 7680, Class::M, 0),
        bits(0x1e00, 512, Class::M, 8000),
        bits(0x2000, 4096, Class::S, 0),
        bits(0x3000, 320, Class::T, 0),
        bits(0x3200, 256, Class::C, 0),
        bits(0x3300, 128, Class::Y, 0),
    ],
    inputs: &[bits(0x3400, 128, Class::X, 0)],
    registers: &[
        words(0x0000, 8000, Class::D, 0),
        words(0x1f40, 512, Class::D, 8000),
        words(0x2140, 24000, Class::R, 0),
        words(0xa140, 320, Class::T, 0),
        words(0xa340, 200, Class::C, 0),
        counters(0xa408),
        packed(0xa478, 480, Class::M),
        Area::new(0xa658, 32, Class::M, 8000, Fill::Packed),
        packed(0xa678, 256, Class::S),
        packed(0xa778, 20, Class::T),
        packed(0xa798, 16, Class::C),
        packed(0xa7a8, 8, Class::Y),
    ],
    input_registers: &[packed(0xa7b8, 8, Class::X)],
    limits: Limits::STANDARD,
    any_value_is_on: false,
    shortest: 4,
    counters_by_06: true,
};

/// FX3 with its Modbus adapter, and the boards that are compatible with it: the addresses of L01S with all of FX3's
/// devices (public knowledge of FX3U).
pub static FX3U: Profile = Profile {
    name: "fx3u",
    coils: &[
        bits(0x0000, 7680, Class::M, 0),
        bits(0x1e00, 512, Class::M, 8000),
        bits(0x2000, 4096, Class::S, 0),
        bits(0x3000, 512, Class::T, 0),
        bits(0x3200, 256, Class::C, 0),
        bits(0x3300, 256, Class::Y, 0),
    ],
    inputs: &[bits(0x3400, 256, Class::X, 0)],
    registers: &[
        words(0x0000, 8000, Class::D, 0),
        words(0x1f40, 512, Class::D, 8000),
        words(0x2140, 32768, Class::R, 0),
        words(0xa140, 512, Class::T, 0),
        words(0xa340, 200, Class::C, 0),
        counters(0xa408),
        packed(0xa478, 480, Class::M),
        Area::new(0xa658, 32, Class::M, 8000, Fill::Packed),
        packed(0xa678, 256, Class::S),
        packed(0xa778, 32, Class::T),
        packed(0xa798, 16, Class::C),
        packed(0xa7a8, 16, Class::Y),
    ],
    input_registers: &[packed(0xa7b8, 16, Class::X)],
    limits: Limits::STANDARD,
    any_value_is_on: false,
    shortest: 4,
    counters_by_06: true,
};

/// hm-motion-controller §6.4.2. S0 to S1023 end at 12FFh, where the timers begin; the manual prints 0FFFh. Coils of
/// timers and counters, which the program drives, are only read.
const HM_BITS: &[Area] = &[
    bits(0x0000, 256, Class::X, 0).read_only(),
    bits(0x0100, 256, Class::Y, 0),
    bits(0x0200, 3072, Class::M, 0),
    bits(0x0e00, 256, Class::M, 8000),
    bits(0x0f00, 1024, Class::S, 0),
    Area::new(0x1300, 256, Class::T, 0, Fill::Coils).read_only(),
    bits(0x1400, 256, Class::T, 0),
    Area::new(0x1500, 256, Class::C, 0, Fill::Coils).read_only(),
    bits(0x1600, 256, Class::C, 0),
];

/// hm-motion-controller §6.4.2.
const HM_WORDS: &[Area] = &[
    words(0x0170, 8000, Class::D, 0),
    words(0x20b0, 256, Class::D, 8000),
    words(0x21b0, 256, Class::T, 0),
    words(0x22b0, 200, Class::C, 0),
    counters(0x2378),
    words(0x23e8, 100, Class::R, 0),
];

/// HM as a slave. The manual names no refusals and no limit of a slave but the standard's.
pub static HM: Profile = Profile {
    name: "hm",
    coils: HM_BITS,
    inputs: HM_BITS,
    registers: HM_WORDS,
    input_registers: HM_WORDS,
    limits: Limits::STANDARD,
    any_value_is_on: false,
    shortest: 4,
    counters_by_06: true,
};

/// Profiles of all models.
pub static ALL: [&Profile; 5] = [&H1U, &H2U, &L01S, &HM, &FX3U];

#[cfg(test)]
mod tests {
    use super::*;

    /// The contents of addresses, as far as there are some.
    fn contents(areas: &[Area], first: u16, count: u16, writes: bool) -> std::vec::Vec<Place> {
        let mut found = std::vec::Vec::new();
        let all = visit(areas, first, count, writes, |index, place| {
            assert_eq!(usize::from(index), found.len());
            found.push(place);
            Some(())
        });
        assert_eq!(all.is_some(), found.len() == usize::from(count));
        found
    }

    /// The content of one address.
    fn at(areas: &[Area], address: u16) -> Option<Place> {
        let found = contents(areas, address, 1, false).first().copied();
        assert_eq!(found, place(areas, address));
        found
    }

    #[test]
    fn no_address_stands_for_two_places() {
        for profile in ALL {
            let tables = [
                profile.coils,
                profile.inputs,
                profile.registers,
                profile.input_registers,
            ];
            for areas in tables {
                for pair in areas.windows(2) {
                    let end = pair[0].address.checked_add(pair[0].count).unwrap();
                    assert!(end <= pair[1].address, "{pair:?}");
                }
            }
        }
    }

    #[test]
    fn addresses_that_the_manuals_print() {
        assert_eq!(at(H2U.registers, 0xf001), Some(Place::Word(Class::T, 1)));
        assert_eq!(at(H2U.registers, 0xf805), None);
        let c205 = Place::Half {
            counter: 205,
            high: false,
        };
        assert_eq!(at(H2U.registers, 0xf70a), Some(c205));
        assert_eq!(at(H2U.coils, 0xf808), Some(Place::Bits(Class::X, 8, 1)));
        assert_eq!(at(HM.registers, 0x20af), Some(Place::Word(Class::D, 7999)));
        assert_eq!(at(HM.coils, 0x12ff), Some(Place::Bits(Class::S, 1023, 1)));
        assert_eq!(
            at(L01S.registers, 0xa657),
            Some(Place::Bits(Class::M, 7664, 16))
        );
        assert_eq!(
            at(L01S.registers, 0x7eff),
            Some(Place::Word(Class::R, 23999))
        );
        assert_eq!(at(L01S.registers, 0x7f00), None);
    }

    #[test]
    fn ranges_run_on_into_the_next_area_and_over_the_end() {
        let words = [7999, 8000].map(|n| Place::Word(Class::D, n));
        assert_eq!(contents(L01S.registers, 0x1f3f, 2, true), words);
        assert_eq!(contents(H2U.coils, 0xffff, 2, false), []);
        assert_eq!(contents(H2U.coils, 0xf800, 1, true), []);
    }
}
