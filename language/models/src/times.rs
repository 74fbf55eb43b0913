//! Execution times of instructions on the real PLC, as far as its manuals give them.

/// The printed times of a model, in nanoseconds.
#[derive(Clone, Copy, Debug)]
pub struct InstructionTimes {
    /// A basic instruction: a contact, a coil, a connection.
    pub basic: u32,
    /// Basic instructions that take longer, by mnemonic; OUT with the class of its device.
    pub longer: &'static [(&'static str, u32)],
    /// The shortest applied instruction; `None` where nothing is printed of applied instructions.
    pub applied: Option<u32>,
    /// Source of the times.
    pub source: &'static str,
}
