//! Analog boards in the slot of the main unit (h1u-h2u-programming §6.7.1, §6.7.4). Their buffer memory is what the PLC
//! exchanges with them: 0 to 9 are D8220 to D8229, 10 to 19 are D8230 to D8239.
//!
//! The manual does not state what the filter does; here it is taken over and shown, and the inputs follow at once.

use super::{Duty, Module, Role};

/// Reads inputs, and changes nothing.
const PAUSE: u16 = 0xc000;

/// Takes the word of the first output as the filter.
const FILTER: u16 = 0xc001;

impl Module {
    /// The command of a board; 0 for any other module.
    fn command(&self) -> u16 {
        self.get(Role::Command, 0) as u16
    }

    /// The word of an output is written.
    pub(super) fn output(&mut self, n: usize, value: i16) {
        self.set(Role::Output, n, value);
        match (self.kind().duty, self.command(), n) {
            (Duty::Board { .. }, PAUSE, _) => {}
            (Duty::Board { most_filter, .. }, FILTER, 0) => {
                let usual = if most_filter == i16::MAX {
                    1
                } else {
                    self.filter
                };
                let is_valid = (1..=most_filter).contains(&value);
                self.filter = if is_valid { value } else { usual };
            }
            (Duty::Board { .. }, FILTER, _) => {}
            _ => self.put(n, value.into()),
        }
    }

    /// Value of an input word: the measured one, or the filter in force while that is set.
    pub(super) fn answered(&self, n: usize) -> i16 {
        match (self.kind().duty, self.command(), n) {
            (Duty::Board { .. }, FILTER, 0) => self.filter,
            _ => self.get(Role::Present, n),
        }
    }

    /// Answer of a board to its command.
    pub(super) fn answer(&self) -> i16 {
        match (self.kind().duty, self.command()) {
            (Duty::Board { answer, .. }, 0) => answer,
            (_, command) => command as i16,
        }
    }

    /// Value output by an output of a board.
    pub(super) fn shown(&self, n: usize) -> i16 {
        self.given(n).clamp(0, i16::MAX.into()) as i16
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, Module, Quantity, Signal};
    use std::vec::Vec;

    fn board(name: &str) -> Module {
        Module::new(Kind::find(name).unwrap())
    }

    #[test]
    fn a_board_exchanges_inputs_and_outputs() {
        let mut board = board("H2U-6A-BD");
        for (channel, quantity, millionths) in [
            (0, Quantity::Volts, 5_000_000),
            (2, Quantity::Milliamperes, 20_000_000),
            // The first two inputs are for voltage only: a current drives them out of their range.
            (1, Quantity::Milliamperes, 1_000_000),
        ] {
            let signal = Signal {
                quantity,
                millionths,
            };
            board.connect(channel, signal).unwrap();
        }
        board.write(1, 5000).unwrap();
        board.pass(10_000);
        let words: Vec<_> = (10..17).map(|n| board.read(n).unwrap()).collect();
        assert_eq!(words, [0x6a42, 5000, 10_000, 10_000, 0, 5000, 0]);
        assert_eq!(board.signal(4, Quantity::Volts), Some(5_000_000));
        assert_eq!(board.signal(4, Quantity::Milliamperes), Some(10_000_000));
        // While it pauses, inputs can be read and outputs stay.
        board.write(0, 0xc000_u16 as i16).unwrap();
        board.write(1, 100).unwrap();
        assert_eq!(board.read(15), Some(5000));
        assert_eq!(board.read(10), Some(0xc000_u16 as i16));
    }

    #[test]
    fn filters_out_of_range_are_not_taken() {
        for (name, value, taken, shown) in [
            ("H2U-6B-BD", 100, 0, 1),
            ("H1U-4A-BD", 64, 257, 64),
            ("H1U-4A-BD", 256, 0, 256),
        ] {
            let mut board = board(name);
            board.write(0, 0xc001_u16 as i16).unwrap();
            board.write(1, value).unwrap();
            assert_eq!(board.read(11), Some(value));
            board.write(1, taken).unwrap();
            assert_eq!(board.read(11), Some(shown), "{name} {taken}");
            board.write(0, 0).unwrap();
            assert_eq!(board.read(11), Some(0));
        }
    }
}
