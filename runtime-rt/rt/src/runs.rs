//! Ranges of a model's devices, for code that knows devices by number only.

use crate::plc::{Class, StoredRun};

/// First special relay and first special register.
pub const FIRST_SPECIAL: u32 = 8000;

/// First 32-bit counter.
pub const FIRST_COUNTER32: u32 = 200;

/// Runs of devices that lie next to each other: class, first and last number.
#[derive(Clone, Copy, Debug)]
pub struct Runs(pub &'static [(Class, u32, u32)]);

impl Runs {
    /// Returns true if `count` devices from `first` on all exist, in one run.
    pub fn hold(self, class: Class, first: i32, count: u32) -> bool {
        let first = i64::from(first);
        let last = first + i64::from(count.max(1)) - 1;
        self.0
            .iter()
            .any(|&(c, from, to)| c == class && i64::from(from) <= first && last <= i64::from(to))
    }

    /// Returns true if a device is among them.
    pub fn has(self, class: Class, number: u32) -> bool {
        self.0
            .iter()
            .any(|&(c, from, to)| c == class && from <= number && number <= to)
    }

    /// Result of [`crate::Plc::stored_run`] if these are the stored devices.
    pub fn stored_run(self, class: Class, number: u32) -> Option<StoredRun> {
        let mut runs = self.0.iter();
        let holds = |run: &&(Class, u32, u32)| run.0 == class && (run.1..=run.2).contains(&number);
        let &(_, _, last) = runs.find(holds)?;
        Some(StoredRun {
            count: last - number + 1,
            area: 0,
        })
    }

    /// Result of [`crate::Plc::bit`] for a device that is not stored: off if the model has it.
    pub fn bit(self, class: Class, number: u32) -> Option<bool> {
        let is_bit = matches!(
            class,
            Class::X | Class::Y | Class::M | Class::S | Class::T | Class::C
        );
        (is_bit && self.has(class, number)).then_some(false)
    }

    /// Result of [`crate::Plc::word`] for a device that is not stored: 0 if the model has it.
    pub fn word(self, class: Class, number: u32) -> Option<i16> {
        let is_word = match class {
            Class::X | Class::Y | Class::M | Class::S => false,
            Class::C => number < FIRST_COUNTER32,
            Class::T | Class::D | Class::R | Class::V | Class::Z | Class::ER => true,
        };
        (is_word && self.has(class, number)).then_some(0)
    }

    /// Result of [`crate::Plc::counter32`] for a counter that is not stored: 0 if the model has it.
    pub fn counter32(self, number: u32) -> Option<i32> {
        (number >= FIRST_COUNTER32 && self.has(Class::C, number)).then_some(0)
    }

    /// Result of [`crate::Plc::reset`] for a timer or counter that is not stored.
    pub fn reset(self, class: Class, number: u32) -> Option<()> {
        (matches!(class, Class::T | Class::C) && self.has(class, number)).then_some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: Runs = Runs(&[
        (Class::M, 0, 99),
        (Class::D, 0, 199),
        (Class::D, 8000, 8255),
        (Class::C, 200, 234),
    ]);

    #[test]
    fn a_run_holds_what_lies_in_it_whole() {
        assert!(RUNS.hold(Class::D, 0, 200));
        assert!(!RUNS.hold(Class::D, 0, 201));
        assert!(!RUNS.hold(Class::D, -1, 1));
        assert!(!RUNS.hold(Class::D, i32::MAX, u32::MAX));
        assert!(RUNS.hold(Class::D, 8255, 1));
    }

    #[test]
    fn a_stored_run_ends_with_its_row() {
        let count = |class, number| RUNS.stored_run(class, number).map(|run| run.count);
        assert_eq!(count(Class::D, 0), Some(200));
        assert_eq!(count(Class::D, 199), Some(1));
        assert_eq!(count(Class::D, 200), None);
        assert_eq!(count(Class::C, 230), Some(5));
    }

    #[test]
    fn devices_that_are_not_stored_read_as_zero() {
        assert_eq!(RUNS.bit(Class::M, 99), Some(false));
        assert_eq!(RUNS.bit(Class::M, 100), None);
        assert_eq!(RUNS.bit(Class::D, 0), None);
        assert_eq!(RUNS.word(Class::D, 0), Some(0));
        assert_eq!(RUNS.word(Class::C, 200), None);
        assert_eq!(RUNS.counter32(200), Some(0));
        assert_eq!(RUNS.reset(Class::T, 0), None);
    }
}
