//! The operation errors that a program meets while it runs.

use crate::machine::Machine;
use rungc_rt::{Class, Plc};

/// The classes of index registers.
const INDEX_CLASSES: [Class; 2] = [Class::Z, Class::V];

/// Number of index registers recorded of each class.
const INDEXES: usize = 8;

/// An operation error at one instruction, each time that it happened.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OperationError {
    /// Time of the first occurrence, in milliseconds since power-on.
    pub first_ms: u32,
    /// Step of the instruction.
    pub step: u32,
    /// The PLC's code: 6706.
    pub code: u16,
    /// Number of occurrences.
    pub times: u64,
    /// Z0 to Z7 and V0 to V7, as they were the first time.
    indexes: [[i16; INDEXES]; INDEX_CLASSES.len()],
}

impl OperationError {
    /// Value of an index register at the first occurrence.
    pub fn index(&self, class: Class, number: u32) -> Option<i16> {
        let i = INDEX_CLASSES.iter().position(|&index| index == class)?;
        self.indexes[i].get(number as usize).copied()
    }
}

impl Machine<'_> {
    /// The operation errors since power-on, by when they happened first, one for each instruction and code.
    pub fn errors(&self) -> &[OperationError] {
        &self.errors
    }

    /// Records an error.
    pub(crate) fn log_error(&mut self, code: u16, step: u32) {
        if let Some(&i) = self.errors_by_site.get(&(step, code)) {
            self.errors[i].times += 1;
            return;
        }
        self.errors_by_site.insert((step, code), self.errors.len());
        let register = |class, n: usize| self.word(class, n as u32).unwrap_or(0);
        let indexes = INDEX_CLASSES.map(|class| std::array::from_fn(|n| register(class, n)));
        self.errors.push(OperationError {
            first_ms: self.sys.now_ms,
            step,
            code,
            times: 1,
            indexes,
        });
    }
}
