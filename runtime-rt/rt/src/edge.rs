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
