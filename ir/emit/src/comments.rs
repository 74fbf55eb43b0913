//! Comments on emitted code.

use crate::storage::{At, Storage};
use rungc_ir::node::{
    Access, Action, Count, Counter16Coil, Counter32Coil, Network, Stmt, TimerCoil,
};
use rungc_syntax::{Device, DeviceClass};

/// The heading of a network. `clean` makes a user's text safe in a comment.
pub fn heading(network: &Network, clean: impl Fn(&str) -> String) -> String {
    let step = network.step;
    let words = |text: &Option<String>| text.as_deref().map(&clean).filter(|text| !text.is_empty());
    match (words(&network.statement), words(&network.note)) {
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
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "others write no device that is known"
)]
pub fn written(stmt: &Stmt) -> Option<(DeviceClass, u32)> {
    let Stmt::Do(action) = stmt else {
        return None;
    };
    match action {
        Action::Timer(TimerCoil { number, .. }) | Action::TimerGoesOn { number, .. } => {
            Some((DeviceClass::T, *number))
        }
        Action::Counter16(Counter16Coil { number, .. })
        | Action::Counter32(Counter32Coil { number, .. })
        | Action::Count(Count { number, .. }) => Some((DeviceClass::C, *number)),
        Action::Write(Access { place, .. }, _) | Action::Reset { place, .. } => {
            place.index.is_none().then_some((place.class, place.number))
        }
        _ => None,
    }
}

/// Comment beside a statement that writes a device: the one on the device, and its name if the statement does not show
/// that, since the device lies within an array that is named after another one.
pub fn beside(storage: &Storage, class: DeviceClass, number: u32) -> Option<String> {
    let slot = storage.slot(class, number);
    let within = slot.is_some_and(|(field, number)| {
        field.first > 0 && matches!(field.at(number), At::Element(1..))
    });
    match within {
        true => Some(device(storage, class, number)),
        false => storage.comment(class, number).map(String::from),
    }
}

/// The name of a device, and the comment on it: `S21: fill`.
pub fn device(storage: &Storage, class: DeviceClass, number: u32) -> String {
    let name = Device { class, number };
    match storage.comment(class, number) {
        Some(comment) => format!("{name}: {comment}"),
        None => name.to_string(),
    }
}
