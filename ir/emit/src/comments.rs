//! Comments on emitted code.

use rungc_ir::node::{Access, Count, Counter16Coil, Counter32Coil, Network, Stmt, TimerCoil};
use rungc_syntax::DeviceClass;

/// The heading of a network. `clean` makes a user's text safe in a comment.
pub fn heading(network: &Network, clean: impl Fn(&str) -> String) -> String {
    let step = network.step;
    let said = |text: &Option<String>| text.as_deref().map(&clean).filter(|text| !text.is_empty());
    match (said(&network.statement), said(&network.note)) {
        (Some(statement), Some(note)) => format!("step {step}: {statement} ({note})"),
        (Some(text), None) | (None, Some(text)) => format!("step {step}: {text}"),
        (None, None) => format!("step {step}"),
    }
}

/// Comment above the choice between parts.
pub const PARTS: &str = "The jumps here do not nest, so the stretches between labels are functions: each answers which one is next.";

/// Comment above a single part that jumps back to itself.
pub const ONE_PART: &str = "A jump back repeats it.";

/// The device that a statement writes, if it is known: its comment is beside the statement.
pub fn written(stmt: &Stmt) -> Option<(DeviceClass, u32)> {
    match stmt {
        Stmt::Timer(TimerCoil { number, .. }) | Stmt::TimerGoesOn { number, .. } => {
            Some((DeviceClass::T, *number))
        }
        Stmt::Counter16(Counter16Coil { number, .. })
        | Stmt::Counter32(Counter32Coil { number, .. })
        | Stmt::Count(Count { number, .. }) => Some((DeviceClass::C, *number)),
        Stmt::Write(Access { place, .. }, _) | Stmt::Reset(place) => {
            place.index.is_none().then_some((place.class, place.number))
        }
        Stmt::Network(_)
        | Stmt::Block(_)
        | Stmt::Let(..)
        | Stmt::Edge(_)
        | Stmt::SetFlag(..)
        | Stmt::SetCell(..)
        | Stmt::SetEntry(_)
        | Stmt::TimerAt(_)
        | Stmt::Counter16At(_)
        | Stmt::If(_)
        | Stmt::For { .. }
        | Stmt::Repeat(_)
        | Stmt::CallSub(_)
        | Stmt::Return
        | Stmt::Parts(_)
        | Stmt::Goto(_)
        | Stmt::Call(_)
        | Stmt::Fetch(_)
        | Stmt::Send(_)
        | Stmt::Fault { .. }
        | Stmt::Watch { .. }
        | Stmt::Stop
        | Stmt::Clear { .. } => None,
    }
}
