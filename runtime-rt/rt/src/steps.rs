//! Blocks of a step ladder: which of them a scan executes.

/// Up to 32 blocks of a step ladder whose states are neighbours, a bit for each. A block is executed while its state is
/// on, and once more when it has gone off.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Steps {
    /// The states, as [`seen`] has read them.
    seen: u32,
    /// The same, a bit for each.
    on: u32,
    /// Blocks whose states were on when they were executed last.
    was_on: u32,
    /// States that a transition left: they go off in the next scan.
    left: u32,
}

/// Blocks that a scan executes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Run {
    /// Those that are still to be executed.
    later: u32,
    /// The one that is executed; none before the first.
    now: u32,
}

impl Run {
    /// Returns the number of the next block to execute, and whether its state is on; `None` if there is none.
    #[inline(always)]
    pub fn next(&mut self, states: &[bool]) -> Option<(usize, bool)> {
        let number = self.begin_next();
        Some((number, *states.get(number)?))
    }

    /// Takes the next block; its number, or 32 if there is none.
    #[inline(always)]
    fn begin_next(&mut self) -> usize {
        let number = self.later.trailing_zeros() as usize;
        self.now = self.later & self.later.wrapping_neg();
        self.later ^= self.now;
        number
    }
}

impl Steps {
    /// Nothing remembered.
    pub const fn new() -> Self {
        Steps {
            seen: 0,
            on: 0,
            was_on: 0,
            left: 0,
        }
    }

    /// Begins a scan of the blocks with these states, 4 to 32: states that were left go off.
    #[inline(always)]
    pub fn begin(&mut self, states: &mut [bool]) -> Run {
        if self.left != 0 {
            self.drop_left(states);
        }
        let on = self.states(states);
        let later = on | self.was_on;
        self.was_on = on;
        Run { later, now: 0 }
    }

    /// The same where a block reads states of later ones: [`Steps::next_in_turn`] switches states off.
    #[inline(always)]
    pub fn begin_in_turn(&mut self, states: &[bool]) -> Run {
        let on = self.states(states);
        let later = on | self.was_on;
        self.was_on = on & !self.left;
        Run { later, now: 0 }
    }

    /// The states that are on.
    #[inline(always)]
    fn states(&mut self, states: &[bool]) -> u32 {
        let seen = seen(states);
        if seen != self.seen {
            self.note(states, seen);
        }
        self.on
    }

    /// Returns the same as [`Run::next`], having switched the state off if it was left.
    #[inline]
    pub fn next_in_turn(&mut self, run: &mut Run, states: &mut [bool]) -> Option<(usize, bool)> {
        let number = run.begin_next();
        let state = states.get_mut(number)?;
        if self.left & run.now != 0 {
            self.left ^= run.now;
            *state = false;
        }
        Some((number, *state))
    }

    /// Switches states off that were left.
    #[inline(never)]
    fn drop_left(&mut self, states: &mut [bool]) {
        let mut run = Run {
            later: core::mem::take(&mut self.left),
            now: 0,
        };
        while let Some(state) = states.get_mut(run.begin_next()) {
            *state = false;
        }
    }

    /// Notes states that have changed.
    #[inline(never)]
    fn note(&mut self, states: &[bool], seen: u32) {
        (self.seen, self.on) = (seen, bits(states));
    }

    /// Switches a state on that is not left then.
    #[inline(never)]
    pub fn enter(&mut self, states: &mut [bool], number: usize) {
        if let Some(state) = states.get_mut(number) {
            *state = true;
        }
        self.left &= !bit(number);
    }

    /// The same from a block before its own, which is executed in this scan, too.
    #[inline(never)]
    #[must_use]
    pub fn enter_later(&mut self, states: &mut [bool], run: Run, number: usize) -> Run {
        self.enter(states, number);
        self.was_on |= bit(number);
        Run {
            later: run.later | bit(number),
            ..run
        }
    }

    /// Leaves the state of the block that is executed.
    #[inline]
    pub fn leave(&mut self, run: Run) {
        self.left |= run.now;
    }

    /// A transition: enters another state, and leaves the one of the block that is executed.
    #[inline(never)]
    pub fn transfer(&mut self, states: &mut [bool], run: Run, number: usize) {
        self.enter(states, number);
        self.leave(run);
    }

    /// The same to a state further down, whose block is executed in this scan, too.
    #[inline(never)]
    #[must_use]
    pub fn transfer_later(&mut self, states: &mut [bool], run: Run, number: usize) -> Run {
        self.leave(run);
        self.enter_later(states, run, number)
    }
}

/// The bit of a block.
fn bit(number: usize) -> u32 {
    1_u32.wrapping_shl(number as u32)
}

/// A number that changes with each of 4 to 32 states: each byte of a state has seven free bits. Few instructions, in
/// contrast to [`bits`].
#[inline(always)]
fn seen(states: &[bool]) -> u32 {
    let four = |from: usize| {
        let from = from.min(states.len().saturating_sub(4));
        match states.get(from..).and_then(|states| states.first_chunk()) {
            Some(&[a, b, c, d]) => u32::from_le_bytes([a.into(), b.into(), c.into(), d.into()]),
            None => 0,
        }
    };
    four(0)
        | four(4) << 1
        | four(8) << 2
        | four(12) << 3
        | four(16) << 4
        | four(20) << 5
        | four(24) << 6
        | four(28) << 7
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
    use super::{Run, Steps, bits, seen};
    use std::vec::Vec;

    /// What happens in a block: of which ladder and run, with which states, and its number.
    type Block<'a> = &'a mut dyn FnMut(&mut Steps, &mut Run, &mut [bool], usize);

    /// How a scan is executed.
    type Scan = fn(&mut Steps, &mut [bool], Block) -> Vec<(usize, bool)>;

    /// Executes the blocks of a scan: their numbers, and whether they are on.
    fn scan(steps: &mut Steps, states: &mut [bool], block: Block) -> Vec<(usize, bool)> {
        let mut executed = Vec::new();
        let mut run = steps.begin(states);
        while let Some((number, on)) = run.next(states) {
            executed.push((number, on));
            block(steps, &mut run, states, number);
        }
        executed
    }

    /// The same, where states go off in turn.
    fn scan_in_turn(steps: &mut Steps, states: &mut [bool], block: Block) -> Vec<(usize, bool)> {
        let mut executed = Vec::new();
        let mut run = steps.begin_in_turn(states);
        while let Some((number, on)) = steps.next_in_turn(&mut run, states) {
            executed.push((number, on));
            block(steps, &mut run, states, number);
        }
        executed
    }

    /// A block that does nothing.
    fn idle(_: &mut Steps, _: &mut Run, _: &mut [bool], _: usize) {}

    #[test]
    fn blocks_are_executed_while_their_states_are_on_and_once_more() {
        let (mut steps, mut states) = (Steps::new(), [false; 32]);
        (states[1], states[31]) = (true, true);
        assert_eq!(
            scan(&mut steps, &mut states, &mut idle),
            [(1, true), (31, true)]
        );
        states[1] = false;
        assert_eq!(
            scan(&mut steps, &mut states, &mut idle),
            [(1, false), (31, true)]
        );
        assert_eq!(scan(&mut steps, &mut states, &mut idle), [(31, true)]);
    }

    #[test]
    fn a_state_that_is_left_is_on_until_its_block_begins_in_the_next_scan() {
        let (mut steps, mut states) = (Steps::new(), [true, false, false, false]);
        // The next one begins in this scan, one before it in the next.
        let forward = scan(
            &mut steps,
            &mut states,
            &mut |steps, run, states, number| {
                if number == 0 {
                    *run = steps.transfer_later(states, *run, 2);
                }
            },
        );
        assert_eq!(
            (&forward[..], states),
            (&[(0, true), (2, true)][..], [true, false, true, false])
        );
        let back = scan(
            &mut steps,
            &mut states,
            &mut |steps, run, states, number| {
                if number == 2 {
                    steps.transfer(states, *run, 0);
                }
            },
        );
        assert_eq!(
            (&back[..], states),
            (&[(0, false), (2, true)][..], [true, false, true, false])
        );
        let last = scan(&mut steps, &mut states, &mut idle);
        assert_eq!(
            (&last[..], states),
            (&[(0, true), (2, false)][..], [true, false, false, false])
        );
    }

    #[test]
    fn a_state_that_is_entered_again_is_not_left() {
        let (mut steps, mut states) = (Steps::new(), [false, true, false, false]);
        scan(&mut steps, &mut states, &mut |steps, run, _, _| {
            steps.leave(*run)
        });
        steps.enter(&mut states, 1);
        assert_eq!(scan(&mut steps, &mut states, &mut idle), [(1, true)]);
        assert_eq!(states, [false, true, false, false]);
    }

    #[test]
    fn states_go_off_before_the_first_block_or_in_turn() {
        // The first block sees whether the second state, which it left in the scan before, is on.
        for (execute, seen) in [(scan as Scan, false), (scan_in_turn, true)] {
            let (mut steps, mut states) = (Steps::new(), [true, true, false, false]);
            execute(&mut steps, &mut states, &mut |steps, run, _, number| {
                if number == 1 {
                    steps.leave(*run);
                }
            });
            let mut found = None;
            let executed = execute(&mut steps, &mut states, &mut |_, _, states, number| {
                if number == 0 {
                    found = Some(states[1]);
                }
            });
            assert_eq!(
                (found, &executed[..]),
                (Some(seen), &[(0, true), (1, false)][..])
            );
        }
    }

    #[test]
    fn each_state_is_seen() {
        for count in 4..=32 {
            let mut all = Vec::from([seen(&[false; 32][..count])]);
            for on in 0..count {
                let mut states = [false; 32];
                states[on] = true;
                let one = seen(&states[..count]);
                // No two states share a bit that only one of them has.
                let alone = seen(&states.map(|on| !on)[..count]);
                assert_ne!(alone, seen(&[true; 32][..count]), "{on} of {count}");
                all.push(one);
            }
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count + 1, "{count}");
        }
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
