//! Edges: what LDP, PLS and the P forms detect.

/// Memory of one edge: the state at the last execution, off at power-on and when RUN begins.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(transparent)]
pub struct Edge(pub bool);

impl Edge {
    /// Returns true if `input` came on since the last execution.
    pub fn rising(&mut self, input: bool) -> bool {
        let before = core::mem::replace(&mut self.0, input);
        input & !before
    }

    /// Returns true if `input` went off since the last execution.
    pub fn falling(&mut self, input: bool) -> bool {
        let before = core::mem::replace(&mut self.0, input);
        !input & before
    }
}

/// Returns true if any of some states of a step ladder, or of the memories of their blocks, is on.
#[inline]
pub fn any_active(states: &[bool], memories: &[Edge]) -> bool {
    // All are read: a fixed number of them are a word or two.
    let states = states.iter().fold(false, |any, on| any | on);
    memories.iter().fold(states, |any, memory| any | memory.0)
}

/// Finds the next block of a step ladder that runs, from number `at` on: its state is on, or has gone off since the
/// block ran. Each state has two memories: whether a transition left it, so that it goes off here, and whether it was
/// on. Sets `at` to the number of the block; false if none is left.
pub fn next_step(at: &mut usize, states: &mut [bool], memories: &mut [Edge]) -> bool {
    let blocks = states.iter_mut().zip(memories.chunks_exact_mut(2));
    for (number, (state, memory)) in blocks.enumerate().skip(*at) {
        if let [left, was_on] = memory
            && *state | left.0 | was_on.0
        {
            *state &= !core::mem::take(&mut left.0);
            if *state | core::mem::replace(&mut was_on.0, *state) {
                *at = number;
                return true;
            }
        }
    }
    false
}

/// A rising or a falling edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum EdgeKind {
    /// Off to on.
    Rising,
    /// On to off.
    Falling,
}

impl EdgeKind {
    /// Verb for the edge, for names: `rises`.
    pub fn verb(self) -> &'static str {
        match self {
            EdgeKind::Rising => "rises",
            EdgeKind::Falling => "falls",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Edge, next_step};
    use std::vec::Vec;

    #[test]
    fn blocks_run_while_their_states_are_on_and_once_more() {
        let mut states = [false, true, false, true, false];
        let mut memories = [Edge(false); 10];
        // The second state is left, the last block ran when its state was on.
        (memories[2].0, memories[9].0) = (true, true);
        for expected in [&[3, 4][..], &[3]] {
            let (mut at, mut found) = (0, Vec::new());
            while next_step(&mut at, &mut states, &mut memories) {
                found.push(at);
                at += 1;
            }
            assert_eq!(found, expected);
        }
        assert_eq!(states, [false, false, false, true, false]);
    }
}
