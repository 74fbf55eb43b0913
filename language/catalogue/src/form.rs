//! The forms of an instruction.

/// Form in which an instruction is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Form {
    /// 32-bit (prefix D).
    pub wide: bool,
    /// Pulse (suffix P): once per off-to-on change of the drive.
    pub pulse: bool,
}
