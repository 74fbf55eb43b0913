//! What a program does with its devices.
use super::Code;
use super::structure::Places;
use rungc_syntax::Diagnostics;

/// Warns of uses of devices that hurt in practice.
pub(super) fn check(code: &Code, places: &Places, out: &mut Diagnostics) {
    let _ = (code, places, out);
}
