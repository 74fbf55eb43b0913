//! Writes that do not last: to inputs, and to special devices that the system maintains.

use super::Code;
use super::accesses::Access;
use crate::special;
use rungc_syntax::{DeviceClass, Diagnostics, codes};

/// Warns of a write that the system undoes.
pub(super) fn check(code: &Code, i: usize, access: &Access, out: &mut Diagnostics) {
    if !access.writes() {
        return;
    }
    let device = access.first;
    let mnemonic = &code.instr(i).mnemonic;
    if device.class == DeviceClass::X {
        let diagnostic = codes::WRITES_INPUT
            .at(access.span, format!("`{mnemonic}` writes inputs"))
            .label("overwritten by the next input refresh");
        out.push(diagnostic);
        return;
    }
    let meaning = access
        .count
        .and_then(|_| special::find(code.model().id, device.class, device.number));
    if let Some(special) = meaning.filter(|special| special.access == special::Access::Read) {
        let message = format!("`{mnemonic}` writes `{device}`, which the system maintains");
        let diagnostic = codes::WRITES_READ_ONLY
            .at(access.span, message)
            .label(format!("{device}: {}", special.meaning));
        out.push(diagnostic);
    }
}
