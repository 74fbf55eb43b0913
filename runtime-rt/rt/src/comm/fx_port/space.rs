//! Addresses of devices in the protocol of the programming port.

use crate::plc::Class;

/// A numbering of devices by byte addresses; bit numbers count the bits of the same bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Space of the basic commands (`0 1 7 8`) of all PLCs.
    Basic,
    /// Space of the extended commands (`E…`) on FX1N and FX2N, and so on H1U, H2U and HM.
    Fx2n,
    /// Their space on FX3, and so on L01S and FX3U-compatible boards.
    Fx3,
}

/// Contents of a run of addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Area {
    /// Bit devices from this number on, eight to a byte, the lowest in bit 0.
    Bits(Class, u32),
    /// 16-bit words from this number on, the low byte first.
    Words(Class, u32),
    /// Values of the 32-bit counters from C200 on, the lowest byte first.
    Counters32,
    /// Coils of timers and counters: read as 0, since a compiled program does not show them.
    Coils,
    /// Resets of timers or counters: read as 0; forcing one on resets.
    Resets(Class),
    /// The monitor list.
    List,
    /// Current values of the devices of the monitor list.
    Sample,
}

/// Position of an address in an area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Number of the device, of the first of eight bits, or of the byte in the list or sample.
    pub(super) first: u32,
    /// Number of the byte in its value, from the lowest on.
    pub(super) byte: u32,
}

/// First and last byte address, and what lies there.
type Row = (u32, u32, Area);

/// Devices of the basic commands.
const BASIC: &[Row] = &[
    (0x0000, 0x007c, Area::Bits(Class::S, 0)),
    (0x0080, 0x009f, Area::Bits(Class::X, 0)),
    (0x00a0, 0x00bf, Area::Bits(Class::Y, 0)),
    (0x00c0, 0x00df, Area::Bits(Class::T, 0)),
    (0x0100, 0x01bf, Area::Bits(Class::M, 0)),
    (0x01c0, 0x01df, Area::Bits(Class::C, 0)),
    (0x01e0, 0x01ff, Area::Bits(Class::M, 8000)),
    (0x02c0, 0x02df, Area::Coils),
    (0x03c0, 0x03df, Area::Coils),
    (0x04c0, 0x04df, Area::Resets(Class::T)),
    (0x05c0, 0x05df, Area::Resets(Class::C)),
    (0x0800, 0x09ff, Area::Words(Class::T, 0)),
    (0x0a00, 0x0b8f, Area::Words(Class::C, 0)),
    (0x0c00, 0x0cdf, Area::Counters32),
    (0x0e00, 0x0fff, Area::Words(Class::D, 8000)),
    // D512 and up have no separate place here; some drivers continue.
    (0x1000, 0x3fff, Area::Words(Class::D, 0)),
];

/// Devices of the extended commands of FX1N and FX2N.
const FX2N: &[Row] = &[
    (0x0000, 0x017f, Area::Bits(Class::M, 0)),
    (0x0180, 0x019f, Area::Bits(Class::Y, 0)),
    (0x01c0, 0x01df, Area::Bits(Class::M, 8000)),
    (0x01e0, 0x01ff, Area::Bits(Class::C, 0)),
    (0x0200, 0x021f, Area::Bits(Class::T, 0)),
    (0x0240, 0x025f, Area::Bits(Class::X, 0)),
    (0x0280, 0x02fc, Area::Bits(Class::S, 0)),
    (0x04e0, 0x051f, Area::Coils),
    (0x06e0, 0x06ff, Area::Resets(Class::C)),
    (0x0700, 0x071f, Area::Resets(Class::T)),
    (0x0a00, 0x0b8f, Area::Words(Class::C, 0)),
    (0x0c00, 0x0cdf, Area::Counters32),
    (0x0e00, 0x0fff, Area::Words(Class::D, 8000)),
    (0x1000, 0x11ff, Area::Words(Class::T, 0)),
    (0x1400, 0x178f, Area::List),
    (0x1790, 0x1bff, Area::Sample),
    (0x4000, 0x7e7f, Area::Words(Class::D, 0)),
];

/// Devices of the extended commands of FX3.
const FX3: &[Row] = &[
    (0x0a00, 0x0b8f, Area::Words(Class::C, 0)),
    (0x0c00, 0x0cdf, Area::Counters32),
    // The place that FX2N has them at still works.
    (0x0e00, 0x0fff, Area::Words(Class::D, 8000)),
    (0x1000, 0x127f, Area::Words(Class::T, 0)),
    (0x1400, 0x178f, Area::List),
    (0x1790, 0x1bff, Area::Sample),
    (0x4000, 0x7e7f, Area::Words(Class::D, 0)),
    (0x8000, 0x83ff, Area::Words(Class::D, 8000)),
    (0x8800, 0x8bbf, Area::Bits(Class::M, 0)),
    (0x8bc0, 0x8bdf, Area::Bits(Class::Y, 0)),
    (0x8c00, 0x8c3f, Area::Bits(Class::M, 8000)),
    (0x8ca0, 0x8cbf, Area::Bits(Class::X, 0)),
    (0x8ce0, 0x8edf, Area::Bits(Class::S, 0)),
    (0x92e0, 0x9327, Area::Coils),
    (0x9340, 0x935f, Area::Bits(Class::C, 0)),
    (0x9360, 0x9387, Area::Bits(Class::T, 0)),
];

/// First 32-bit counter.
const FIRST_COUNTER32: u32 = 200;

impl Space {
    fn rows(self) -> &'static [Row] {
        match self {
            Space::Basic => BASIC,
            Space::Fx2n => FX2N,
            Space::Fx3 => FX3,
        }
    }

    /// The byte that holds this bit.
    pub(super) fn byte_of(self, bit: u16) -> u32 {
        let base = if self == Space::Fx3 { 0x8000 } else { 0 };
        base + u32::from(bit / 8)
    }

    /// The byte that holds a bit of a device, and the bit's position in it: of a timer or counter its contact. `None`
    /// if it has no address.
    pub fn bit_address(self, class: Class, number: u32) -> Option<(u32, u32)> {
        self.rows().iter().find_map(|&(start, end, area)| {
            let Area::Bits(of, first) = area else {
                return None;
            };
            let offset = number.checked_sub(first)?;
            let address = start + offset / 8;
            (of == class && address <= end).then_some((address, offset % 8))
        })
    }

    /// The first byte of a device's value: of a timer or counter its current value, which takes four bytes from C200
    /// on. `None` if it has no address.
    pub fn word_address(self, class: Class, number: u32) -> Option<u32> {
        self.rows().iter().find_map(|&(start, end, area)| {
            let (of, first, size) = match area {
                Area::Words(of, first) => (of, first, 2),
                Area::Counters32 => (Class::C, FIRST_COUNTER32, 4),
                _ => return None,
            };
            let address = start + number.checked_sub(first)? * size;
            (of == class && address < end).then_some(address)
        })
    }

    /// Area and position at a byte address.
    pub(super) fn find(self, address: u32) -> Option<(Area, Place)> {
        let &(start, _, area) = self
            .rows()
            .iter()
            .find(|&&(start, end, _)| (start..=end).contains(&address))?;
        let offset = address - start;
        let (first, byte) = match area {
            Area::Bits(_, base) => (base + 8 * offset, 0),
            Area::Resets(_) => (8 * offset, 0),
            Area::Words(_, base) => (base + offset / 2, offset % 2),
            Area::Counters32 => (FIRST_COUNTER32 + offset / 4, offset % 4),
            Area::Coils | Area::List | Area::Sample => (offset, 0),
        };
        Some((area, Place { first, byte }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_rise_and_do_not_overlap() {
        for space in [Space::Basic, Space::Fx2n, Space::Fx3] {
            for pair in space.rows().windows(2) {
                assert!(pair[0].0 <= pair[0].1 && pair[0].1 < pair[1].0, "{pair:?}");
            }
        }
    }

    /// The bit numbers that published drivers use.
    #[test]
    fn bit_numbers_of_drivers() {
        let bit = |space: Space, number: u16| {
            let (area, place) = space.find(space.byte_of(number)).unwrap();
            let Area::Bits(class, _) = area else {
                panic!("{area:?}");
            };
            (class, place.first + u32::from(number % 8))
        };
        assert_eq!(bit(Space::Basic, 0x0400), (Class::X, 0));
        assert_eq!(bit(Space::Basic, 0x0500), (Class::Y, 0));
        assert_eq!(bit(Space::Basic, 0x0600), (Class::T, 0));
        assert_eq!(bit(Space::Basic, 0x080a), (Class::M, 10));
        assert_eq!(bit(Space::Basic, 0x0e00), (Class::C, 0));
        assert_eq!(bit(Space::Basic, 0x0f25), (Class::M, 8037));
        assert_eq!(bit(Space::Fx2n, 0x0600), (Class::M, 1536));
        assert_eq!(bit(Space::Fx2n, 0x0c00), (Class::Y, 0));
        assert_eq!(bit(Space::Fx2n, 0x0e25), (Class::M, 8037));
        assert_eq!(bit(Space::Fx2n, 0x17e7), (Class::S, 999));
        assert_eq!(bit(Space::Fx3, 0x4000), (Class::M, 0));
        assert_eq!(bit(Space::Fx3, 0x5e00), (Class::Y, 0));
        assert_eq!(bit(Space::Fx3, 0x6025), (Class::M, 8037));
        assert_eq!(bit(Space::Fx3, 0x6500), (Class::X, 0));
        assert_eq!(bit(Space::Fx3, 0x6700), (Class::S, 0));
        assert_eq!(bit(Space::Fx3, 0x9a00), (Class::C, 0));
        assert_eq!(bit(Space::Fx3, 0x9b00), (Class::T, 0));
    }
}
