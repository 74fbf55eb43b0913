//! `rungc run --retain`: latched devices that survive from run to run.

use super::super::{Failure, tell};
use rungc_interp::Machine;
use rungc_rt::Program;
use rungc_rt::retain::RetainFile;
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
        let say = |text: String| tell(&format!("rungc: {text}"));
        let file = RetainFile::begin(path, machine, say).map_err(|why| because(&why))?;
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
