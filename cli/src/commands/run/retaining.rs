//! `rungc run --retain`: latched devices that survive from run to run.

use super::super::{Failure, tell};
use rungc_interp::Machine;
use rungc_rt::retain::RetainFile;
use rungc_rt::{Class, Plc, Program};
use std::path::PathBuf;

/// How often a run in real time looks whether a latched device has changed.
const EVERY_MS: u32 = 1000;

/// Where a run keeps latched devices.
#[derive(Clone, Debug)]
pub struct Kept {
    /// The file.
    pub path: PathBuf,
    /// The bit that is on while they cannot be saved.
    pub fault: Option<(Class, u32)>,
}

/// The file of a run.
pub struct Retaining {
    file: RetainFile,
    /// Saving has failed, which was reported.
    fails: bool,
    /// The bit that is on then.
    fault: Option<(Class, u32)>,
}

impl Retaining {
    /// Opens a file, and gives a machine that was just switched on the values in it.
    pub fn begin(
        Kept { path, fault }: &Kept,
        machine: &mut Machine,
    ) -> std::result::Result<Self, Failure> {
        let shown = path.display();
        let because =
            |why: &dyn std::fmt::Display| Failure::Because(format!("--retain {shown}: {why}"));
        if machine.retained().runs.is_empty() {
            return Err(because(&"the program has no latched devices"));
        }
        let say = |text: String| tell(&format!("rungc: {text}"));
        let file = RetainFile::begin(path, machine, say).map_err(|why| because(&why))?;
        Ok(Retaining {
            file,
            fails: false,
            fault: *fault,
        })
    }

    /// Saves what has changed, once in a second. A disk that takes nothing does not stop the PLC: it is tried again.
    pub fn poll(&mut self, machine: &mut Machine, now_ms: u64) {
        self.save(machine, now_ms);
        if let Some((class, number)) = self.fault {
            // Every model that the settings fit has it.
            let _ = machine.set_bit(class, number, self.fails);
        }
    }

    fn save(&mut self, machine: &Machine, now_ms: u64) {
        match self.file.poll(machine, now_ms as u32, EVERY_MS) {
            Ok(saved) => {
                if saved && std::mem::take(&mut self.fails) {
                    let path = self.file.path().display();
                    tell(&format!("rungc: {path}: latched devices are saved again"));
                }
            }
            Err(error) if !self.fails => {
                self.fails = true;
                let path = self.file.path().display();
                tell(&format!(
                    "rungc: {path}: {error}; latched devices are not saved"
                ));
            }
            Err(_) => {}
        }
    }

    /// Saves what has changed since.
    pub fn end(mut self, machine: &Machine) -> std::result::Result<(), Failure> {
        let saved = self.file.save(machine);
        saved.map(drop).map_err(|error| self.failed(&error))
    }

    fn failed(&self, error: &std::io::Error) -> Failure {
        Failure::Because(format!("{}: {error}", self.file.path().display()))
    }
}
