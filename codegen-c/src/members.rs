//! The members of an emitted struct, for a host that reads and writes devices itself.

use crate::fields::PrintStorage;
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use rungc_syntax::DeviceClass;

/// The members of an emitted program's struct that hold its devices.
pub struct Members<'m> {
    fields: Storage<'m>,
}

impl<'m> Members<'m> {
    /// Those of a program.
    pub fn new(module: &'m Module) -> Self {
        Members {
            fields: Storage::new(module),
        }
    }

    /// The member that holds a device: `M0`, `D[100]`, `M16[1][0]`; `None` if it is not stored. X, Y, M and S are bytes
    /// that are 0 or 1, D and the like `int16_t`, timers and counters structs (`rungc.h`).
    pub fn of(&self, class: DeviceClass, number: u32) -> Option<String> {
        let mut expression = String::new();
        let stored = self.fields.access(&mut expression, class, number);
        stored.then(|| expression.trim_start_matches("plc->").to_string())
    }
}
