//! `rungc run --retain`: latched devices that survive from run to run.

use super::super::{Failure, eprint_line};
use rungc_host::retain::RetainFile;
use rungc_interp::Machine;
use rungc_rt::{Class, Plc, Program};
use std::path::PathBuf;

/// Storage of a run's latched devices.
#[derive(Clone, Debug)]
pub struct RetainStorage {
    /// The file.
    pub path: PathBuf,
    /// The bit that is on while they cannot be saved.
    pub fault: Option<(Class, u32)>,
}

/// The file of a run.
pub struct Retaining {
    file: RetainFile,
    /// The bit that is on while they cannot be saved.
    fault: Option<(Class, u32)>,
}

impl Retaining {
    /// Opens a file, and gives a machine that was just switched on the values in it.
    pub fn begin(
        RetainStorage { path, fault }: &RetainStorage,
        machine: &mut Machine,
    ) -> std::result::Result<Self, Failure> {
        let shown = path.display();
        let because =
            |why: &dyn std::fmt::Display| Failure::Because(format!("--retain {shown}: {why}"));
        if machine.retained().runs.is_empty() {
            return Err(because(&"the program has no latched devices"));
        }
        let say = |text: String| eprint_line(&format!("rungc: {text}"));
        let file = RetainFile::begin(path, machine, say).map_err(|why| because(&why))?;
        Ok(Retaining {
            file,
            fault: *fault,
        })
    }

    /// Saves what has changed, once in a second. A disk that takes nothing does not stop the PLC: it is tried again.
    pub fn poll(&mut self, machine: &mut Machine, now_ms: u64) {
        if let Some(message) = self.file.keep(machine, now_ms as u32) {
            eprint_line(&format!("rungc: {message}"));
        }
        if let Some((class, number)) = self.fault {
            // Every model that the settings fit has it.
            let _ = machine.set_bit(class, number, self.file.fails());
        }
    }

    /// Saves what has changed since; whether the disk has taken it.
    pub fn end(self, machine: &Machine) -> bool {
        let saved = self.file.end(machine);
        if let Err(why) = &saved {
            eprint_line(&format!("rungc: {why}"));
        }
        saved.is_ok()
    }
}
