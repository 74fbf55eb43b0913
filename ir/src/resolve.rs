//! Gives every instruction of a program its catalogue row, form and step number.

use crate::catalogue::Inst;
use crate::model::Model;
use rungc_syntax::{Device, Program};

/// Which form of an instruction is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Form {
    /// 32-bit (prefix D).
    pub wide: bool,
    /// Pulse (suffix P): once per off-to-on change of the drive.
    pub pulse: bool,
}

/// What is known of one instruction.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Its catalogue row; `None` if it is unknown or the model does not have it (which was reported).
    pub inst: Option<&'static Inst>,
    /// Its form.
    pub form: Form,
    /// Step number of its first word.
    pub step: u32,
    /// The pointer, if it is a label.
    pub label: Option<Device>,
}

/// A program whose instructions are known.
#[derive(Debug)]
pub struct Resolved<'p> {
    /// The program.
    pub program: &'p Program,
    /// The model it is for.
    pub model: &'static Model,
    /// One for each of `program.instrs`.
    pub instrs: Vec<Resolution>,
    /// Length in steps.
    pub steps: u32,
}
