//! The members of an emitted struct, for a host that reads and writes devices itself.

use crate::generate::type_name;
use crate::storage::PrintStorage;
use quote::quote;
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use rungc_syntax::DeviceClass;

/// The members of an emitted program's struct that hold its devices.
pub struct Members<'m> {
    storage: Storage<'m>,
    type_name: String,
}

impl<'m> Members<'m> {
    /// Those of a program.
    pub fn new(module: &'m Module) -> Self {
        Members {
            storage: Storage::new(module),
            type_name: type_name(&module.name).to_string(),
        }
    }

    /// Name of the struct.
    pub fn type_name(&self) -> &str {
        &self.type_name
    }

    /// The field that holds a device: `m0`, `d[100]`, `m16[1][0]`; `None` if it is not stored. X, Y, M and S are
    /// `bool`, or `u8` (0 or 1) where a loop over rungs goes through them, D and the like `i16`, timers and counters
    /// structs of `rungc_rt`.
    pub fn of(&self, class: DeviceClass, number: u32) -> Option<String> {
        let cell = self.storage.cell(&quote!(plc), class, number)?.to_string();
        let text: String = cell.split_whitespace().collect();
        Some(text.trim_start_matches("plc.").to_string())
    }
}
