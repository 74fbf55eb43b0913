//! Writes that do not last, because the system maintains what is written.

use super::Code;
use super::ports::Roles;
use crate::accesses::Access;
use rungc_catalogue::Role;
use rungc_models::runs::is_special;
use rungc_models::special::{self, PortRole};
use rungc_syntax::{Diagnostics, codes};

/// Warns of a write to a special device that is there to be read. An operand that is also read (BMOV goes either way)
/// says too little.
pub(super) fn check(code: &Code, i: usize, access: &Access, roles: &Roles, out: &mut Diagnostics) {
    let device = access.first;
    let special = is_special(device.class, device.number);
    if access.role != Role::Write || access.count.is_none() || !special {
        return;
    }
    let Some(special) = code.model().special(device.class, device.number) else {
        return;
    };
    let role = match special.access {
        special::Access::ReadWrite => return,
        special::Access::Read => None,
        special::Access::ReadUnless(role) if roles.contain(role) == Some(false) => Some(role),
        special::Access::ReadUnless(_) => return,
    };
    let mnemonic = &code.instr(i).mnemonic;
    let message = format!("`{mnemonic}` writes `{device}`, which the system maintains");
    let diagnostic = codes::WRITES_READ_ONLY
        .at(access.span, message)
        .label(format!("{device}: {}", special.meaning));
    out.push(match role {
        None => diagnostic,
        Some(PortRole { port, title, .. }) => {
            diagnostic.help(format!("programs write it while COM{port} is {title}"))
        }
    });
}
