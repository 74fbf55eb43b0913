//! `rungc run --retain`: latched devices that survive from run to run.

use super::super::{Failure, tell};
use rungc_interp::Machine;
use rungc_rt::Program;
use rungc_rt::retain::{Loaded, RetainFile};
use std::path::Path;

/// How often a run in real time looks whether a latched device has changed.
const EVERY_MS: u32 = 1000;

/// The file of a run.
pub struct Retaining {
    file: RetainFile,
}

impl Retaining {
    /// Opens a file, and gives a machine that was just switched on the values in it.
    pub fn begin(path: &Path, machine: &mut Machine) -> std::result::Result<Self, Failure> {
        let shown = path.display();
        let because =
            |why: &dyn std::fmt::Display| Failure::Because(format!("--retain {shown}: {why}"));
        if machine.retained().runs.is_empty() {
            return Err(because(&"the program has no latched devices"));
        }
        let (file, loaded) = RetainFile::open(path, machine).map_err(|error| because(&error))?;
        match loaded {
            Loaded::Nothing => tell(&format!(
                "rungc: {shown} does not exist yet: latched devices begin as the PLC leaves the factory"
            )),
            Loaded::Foreign(owner) => {
                let (owner, own) = (owner.as_str(), machine.retained().program);
                return Err(because(&format!(
                    "holds the latched devices of `{owner}`, and this program is `{own}`; name another file"
                )));
            }
            Loaded::Restored { dropped: 0 } => {}
            Loaded::Restored { dropped } => tell(&format!(
                "rungc: {shown}: {dropped} of its devices are dropped: the program does not use them as latched devices any more"
            )),
        }
        Ok(Retaining { file })
    }

    /// Saves what has changed, once in a second.
    pub fn poll(&mut self, machine: &Machine, now_ms: u64) -> std::result::Result<(), Failure> {
        let polled = self.file.poll(machine, now_ms as u32, EVERY_MS);
        polled.map(drop).map_err(|error| self.failed(&error))
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
