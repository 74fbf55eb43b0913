//! Writes that do not last: to inputs.

use super::Code;
use super::accesses::Access;
use rungc_syntax::{DeviceClass, Diagnostics, codes};

/// Warns of a write that something else undoes.
pub(super) fn check(code: &Code, i: usize, access: &Access, out: &mut Diagnostics) {
    if !access.writes() {
        return;
    }
    if access.first.class == DeviceClass::X {
        let message = format!("`{}` writes inputs", code.instr(i).mnemonic);
        let diagnostic = codes::WRITES_INPUT
            .at(access.span, message)
            .label("overwritten by the next input refresh");
        out.push(diagnostic);
    }
}
