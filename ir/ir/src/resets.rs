//! Memory of the reset states of timers and counters, for those who show them.

use crate::Module;
use crate::node::{FlagId, TableId};
use rungc_syntax::DeviceClass::{self, C, T};
use std::collections::BTreeMap;

/// End of the names of reset states.
const END: &str = "_reset";

/// Name of the flag that is on while RST holds a timer or counter at 0, or of the table of a class, whose entries are
/// not 0 then: `c100_reset`, `c_reset`.
pub fn reset_name(class: DeviceClass, number: Option<u32>) -> String {
    let number = number.map(|number| number.to_string());
    let class = class.prefix().to_lowercase();
    format!("{class}{}{END}", number.unwrap_or_default())
}

/// The reset states of a module that have a memory. Others show in the coil of a counter, or in the RST itself, which
/// is executed with the coil.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct ResetStates {
    flags: BTreeMap<(DeviceClass, u32), FlagId>,
    tables: BTreeMap<DeviceClass, TableId>,
}

/// Memory of a reset state.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ResetState {
    /// A flag that is on.
    Flag(FlagId),
    /// An entry of a table that is not 0.
    Entry(TableId, u32),
}

impl ResetStates {
    /// Those of a module.
    pub fn of(module: &Module) -> Self {
        let flags = module.flags.iter_enumerated();
        let tables = module.tables.iter_enumerated();
        let table = |class| {
            let name = reset_name(class, None);
            let mut tables = tables.clone();
            tables.find_map(|(id, table)| (table.name == name).then_some((class, id)))
        };
        ResetStates {
            flags: flags
                .filter_map(|(id, flag)| Some((named(&flag.name)?, id)))
                .collect(),
            tables: [T, C].into_iter().filter_map(table).collect(),
        }
    }

    /// Memory of the reset state of a device; `None` if it has none.
    pub fn get(&self, class: DeviceClass, number: u32) -> Option<ResetState> {
        let table = self.tables.get(&class);
        let entry = table.map(|&table| ResetState::Entry(table, number));
        let flag = self.flags.get(&(class, number)).copied();
        entry.or(flag.map(ResetState::Flag))
    }
}

impl Module {
    /// The flags that hold reset states over STOP and power-off ([`Flag::retained`](crate::node::Flag::retained)), with
    /// their timers and counters.
    pub fn retained_resets(&self) -> impl Iterator<Item = (DeviceClass, u32, FlagId)> {
        let flags = self.flags.iter_enumerated();
        flags
            .filter(|(_, flag)| flag.retained)
            .filter_map(|(id, flag)| {
                let (class, number) = named(&flag.name)?;
                Some((class, number, id))
            })
    }
}

/// The device of a flag's name.
fn named(name: &str) -> Option<(DeviceClass, u32)> {
    let device = name.strip_suffix(END)?;
    let number = device.get(1..)?.parse().ok()?;
    let is_named = |class: &DeviceClass| reset_name(*class, Some(number)) == name;
    Some(([T, C].into_iter().find(is_named)?, number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for device in [(T, 0), (C, 235)] {
            assert_eq!(named(&reset_name(device.0, Some(device.1))), Some(device));
        }
        for name in ["c_reset", "c007_reset", "m1_reset", "c1_rose", "_reset", ""] {
            assert_eq!(named(name), None, "{name}");
        }
    }
}
