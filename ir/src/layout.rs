//! Which devices a compiled program stores, and how: decided once for both backends.
//!
//! A device that is only ever named directly becomes a field of its own; devices that are indexed, moved in blocks or handed to a
//! runtime function as a run become arrays. Special devices that the program never looks at are not stored.

use rungc_syntax::DeviceClass;

/// A run of stored devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Area {
    /// Class.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// An array (even of one) rather than a field of its own.
    pub array: bool,
    /// Kept over RUN/STOP and power-off. An area never mixes both.
    pub latched: bool,
}

/// First special relay and first special register.
const FIRST_SPECIAL: u32 = 8000;

impl Area {
    /// Whether M8031 (`latched` false) or M8032 (true) clears it ([`crate::node::Stmt::Clear`]); what M8031 clears, going to STOP
    /// clears as well. Inputs and special devices are never cleared (h1u-h2u-programming §8.9). Cleared timers and counters
    /// forget their coil, too.
    pub fn is_cleared(&self, latched: bool) -> bool {
        let special =
            matches!(self.class, DeviceClass::M | DeviceClass::D) && self.first >= FIRST_SPECIAL;
        self.class != DeviceClass::X && !special && self.latched == latched
    }
}

/// All stored devices, sorted by class and number, disjoint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// The areas.
    pub areas: Vec<Area>,
}

impl Layout {
    /// The area that holds a device.
    pub fn area(&self, class: DeviceClass, number: u32) -> Option<&Area> {
        let i = self
            .areas
            .partition_point(|a| (a.class, a.first) <= (class, number))
            .checked_sub(1)?;
        self.areas
            .get(i)
            .filter(|a| a.class == class && number - a.first < a.count)
    }
}
