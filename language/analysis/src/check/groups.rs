//! Groups of bits that start where the manual does not want them, without being errors.

use super::Code;
use rungc_catalogue::Lower;
use rungc_rt::RtFn;
use rungc_syntax::{Diagnostics, OperandKind, codes, phrase};

/// The table of ABSD starts at a multiple of this.
const ALIGNED: u32 = 8;

/// Warns of a table of ABSD in bits that start elsewhere.
pub(super) fn check(code: &Code, i: usize, out: &mut Diagnostics) {
    if !matches!(code.lower(i), Some(Lower::Call(RtFn::Absd))) {
        return;
    }
    let Some(table) = code.instr(i).operands.first() else {
        return;
    };
    if let OperandKind::Nibbles(_, device, None) = table.kind
        && device.number % ALIGNED != 0
    {
        let message = phrase!(
            "the table of ABSD starts at `{device}`, no multiple of 8",
            device
        );
        let warning = codes::UNALIGNED_GROUP
            .at(table.span, message)
            .label("a PLC may reject it")
            .help("start the table at another device, or use data registers");
        out.push(warning);
    }
}
