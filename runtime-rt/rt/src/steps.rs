//! Blocks of a step ladder: which of them a scan executes.

/// Up to 32 blocks of a step ladder whose states are neighbours, a bit for each. A block is executed while its state is
/// on, and once more when it has gone off.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Steps {
    /// Blocks that are still to be executed.
    run: u32,
    /// The block that is executed; none outside of them.
    now: u32,
    /// Blocks whose states were on when they were executed last.
    was_on: u32,
    /// States that a transition left: they go off where their blocks begin.
    left: u32,
}

impl Steps {
    /// Nothing remembered.
    pub const fn new() -> Self {
        Steps {
            run: 0,
            now: 0,
            was_on: 0,
            left: 0,
        }
    }

    /// Begins a scan of the blocks with these states, at most 32.
    pub fn begin(&mut self, states: &[bool]) {
        let on = bits(states);
        self.run = on | self.was_on;
        self.was_on = on & !self.left;
    }

    /// Returns the number of the next block to execute, and whether its state is on; `None` if there is none.
    #[inline]
    pub fn next(&mut self, states: &mut [bool]) -> Option<(usize, bool)> {
        self.now = self.run & self.run.wrapping_neg();
        self.run ^= self.now;
        let number = self.now.trailing_zeros() as usize;
        let state = states.get_mut(number)?;
        if self.left & self.now != 0 {
            self.left ^= self.now;
            *state = false;
        }
        Some((number, *state))
    }

    /// Switches a state on that is not left then. If its block comes later in this scan, it is executed.
    #[inline(never)]
    pub fn enter(&mut self, states: &mut [bool], number: usize) {
        if let Some(state) = states.get_mut(number) {
            *state = true;
        }
        let bit = 1_u32.wrapping_shl(number as u32);
        self.left &= !bit;
        let later = !(self.now | self.now.wrapping_sub(1));
        self.run |= bit & later;
        self.was_on |= bit & later;
    }

    /// Leaves the state of the block that is executed.
    pub fn leave(&mut self) {
        self.left |= self.now;
    }

    /// A transition: enters another state, and leaves the one of the block that is executed.
    #[inline(never)]
    pub fn transfer(&mut self, states: &mut [bool], number: usize) {
        self.enter(states, number);
        self.leave();
    }
}

/// Up to 32 states as a number, the first one as bit 0.
fn bits(states: &[bool]) -> u32 {
    /// Moves the lowest bits of four bytes to bits 24 to 27, those 4 bits further up to bits 28 to 31.
    const GATHER: u32 = 0x0102_0408;
    let (first, eights) = states.as_rchunks::<8>();
    let word = |four: [bool; 4]| u32::from_le_bytes(four.map(u8::from));
    let high = eights
        .iter()
        .rev()
        .fold(0, |bits: u32, &[a, b, c, d, e, f, g, h]| {
            let both = word([a, b, c, d]) | word([e, f, g, h]) << 4;
            bits << 8 | both.wrapping_mul(GATHER) >> 24
        });
    first
        .iter()
        .rev()
        .fold(high, |bits, &on| bits << 1 | u32::from(on))
}

#[cfg(test)]
mod tests {
    use super::{Steps, bits};
    use std::vec::Vec;

    /// Executes the blocks of a scan, in which `step` sees the number of each and whether it is on.
    fn scan(
        steps: &mut Steps,
        states: &mut [bool],
        mut step: impl FnMut(&mut Steps, &mut [bool], usize),
    ) -> Vec<(usize, bool)> {
        let mut executed = Vec::new();
        steps.begin(states);
        while let Some((number, on)) = steps.next(states) {
            executed.push((number, on));
            step(steps, states, number);
        }
        executed
    }

    #[test]
    fn blocks_are_executed_while_their_states_are_on_and_once_more() {
        let (mut steps, mut states) = (Steps::new(), [false; 32]);
        (states[1], states[31]) = (true, true);
        assert_eq!(
            scan(&mut steps, &mut states, |_, _, _| {}),
            [(1, true), (31, true)]
        );
        states[1] = false;
        assert_eq!(
            scan(&mut steps, &mut states, |_, _, _| {}),
            [(1, false), (31, true)]
        );
        assert_eq!(scan(&mut steps, &mut states, |_, _, _| {}), [(31, true)]);
    }

    #[test]
    fn a_state_that_is_left_is_on_until_its_block_begins_in_the_next_scan() {
        let (mut steps, mut states) = (Steps::new(), [true, false, false]);
        // The next one begins in this scan, one before it in the next.
        let forward = scan(&mut steps, &mut states, |steps, states, number| {
            if number == 0 {
                steps.transfer(states, 2);
            }
        });
        assert_eq!(
            (&forward[..], states),
            (&[(0, true), (2, true)][..], [true, false, true])
        );
        let back = scan(&mut steps, &mut states, |steps, states, number| {
            if number == 2 {
                steps.transfer(states, 0);
            }
        });
        assert_eq!(
            (&back[..], states),
            (&[(0, false), (2, true)][..], [true, false, true])
        );
        let last = scan(&mut steps, &mut states, |_, _, _| {});
        assert_eq!(
            (&last[..], states),
            (&[(0, true), (2, false)][..], [true, false, false])
        );
    }

    #[test]
    fn a_state_that_is_entered_again_is_not_left() {
        let (mut steps, mut states) = (Steps::new(), [false, true]);
        scan(&mut steps, &mut states, |steps, _, _| steps.leave());
        steps.enter(&mut states, 1);
        assert_eq!(scan(&mut steps, &mut states, |_, _, _| {}), [(1, true)]);
        assert_eq!(states, [false, true]);
    }

    #[test]
    fn states_are_bits() {
        for count in 0..=32 {
            for on in 0..count {
                let mut states = [false; 32];
                (states[on], states[count - 1]) = (true, true);
                assert_eq!(
                    bits(&states[..count]),
                    1 << on | 1 << (count - 1),
                    "{on} of {count}"
                );
            }
        }
        assert_eq!(bits(&[true; 32]), u32::MAX);
    }
}
