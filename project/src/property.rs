//! `[[property]]` and `[verify]`: what a program must never do, and what is supposed of the machine around it.

use crate::{Named, Range};
use rungc_syntax::Span;

/// A property. Conditions are as written; what they mean is the caller's to know.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Row {
    /// What it is called, if it has a name.
    pub name: Option<String>,
    /// What it asks.
    pub asks: Asks,
    /// Where it is.
    pub span: Span,
}

/// What a property asks.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Asks {
    /// `never = "…"`
    Never(Named),
    /// `always = "…"`
    Always(Named),
    /// `reachable = "…"`
    Reachable(Named),
    /// `whenever = "…"`, `then = "…"`, and perhaps `within = "2s"`.
    Whenever {
        /// What begins.
        when: Named,
        /// What must follow.
        then: Named,
        /// How soon, a time; at once without it.
        within: Option<Named>,
    },
    /// `stays = "…"`, and perhaps `until = "…"`.
    Stays {
        /// What stays.
        holds: Named,
        /// What ends it.
        until: Option<Named>,
    },
}

/// `[verify]`
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Verify {
    /// Conditions that hold after every scan.
    pub assume: Vec<Named>,
    /// Devices that something other than the program may write.
    pub free: Vec<Range>,
    /// The longest time from one scan to the next.
    pub scan: Option<Named>,
    /// How long to try, for each property.
    pub timeout: Option<Named>,
}
