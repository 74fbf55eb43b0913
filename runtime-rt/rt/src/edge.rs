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
