//! Writes that do not last, because the system maintains what is written.

use super::Code;
use super::ports::Roles;
use crate::accesses::Access;
use rungc_models::runs::is_special;
use rungc_models::special::{self, PortRole};
use rungc_syntax::{Device, Diagnostic, Diagnostics, codes, phrase};

/// A longer run of devices is cleared or copied as a whole; only its first device is meant. (A run that begins before
/// the special devices ends before them, or check reports its length.)
const MAX_RUN: u32 = 32;

/// Warns of an instruction that writes special devices that are there to be read.
pub(super) fn check(code: &Code, i: usize, roles: &Roles, out: &mut Diagnostics) {
    let written = |access: Access| {
        let count = access.least.filter(|_| access.writes())?;
        let count = if count > MAX_RUN { 1 } else { count };
        let Device { class, number } = access.first;
        if !is_special(class, number) {
            return None;
        }
        let mut run = (number..number.saturating_add(count)).map(|n| Device { class, number: n });
        run.find_map(|device| maintained(code, (i, &access), device, roles))
    };
    out.extend(code.accesses(i).find_map(written));
}

/// The finding about one device.
fn maintained(
    code: &Code,
    (i, access): (usize, &Access),
    device: Device,
    roles: &Roles,
) -> Option<Diagnostic> {
    let special = code.model().special(device.class, device.number)?;
    let role = match special.access {
        special::Access::ReadWrite => return None,
        special::Access::Read => None,
        special::Access::ReadUnless(role) if roles.contain(role) == Some(false) => Some(role),
        special::Access::ReadUnless(_) => return None,
    };
    let mnemonic = &code.instr(i).mnemonic;
    let message = phrase!(
        "`{mnemonic}` writes `{device}`, which the system maintains",
        mnemonic,
        device
    );
    let diagnostic = codes::WRITES_READ_ONLY
        .at(access.span, message)
        .label(format!(
            "{device}: {number}",
            number = special.meaning(device.number)
        ));
    Some(match role {
        None => diagnostic,
        Some(PortRole { port, title, .. }) => diagnostic.help(phrase!(
            "programs write it while COM{port} is {title}",
            port,
            title
        )),
    })
}
