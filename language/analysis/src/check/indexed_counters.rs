//! Indexes that count the words of 32-bit counters.

use super::Code;
use rungc_models::runs::is_counter32;
use rungc_syntax::{Diagnostics, OperandKind, codes, phrase};

/// Warns of a 32-bit counter with an index on models where an index counts 16-bit words.
pub(super) fn check(code: &Code, i: usize, out: &mut Diagnostics) {
    if !code.model().index_counts_words || !code.wide(i) {
        return;
    }
    for operand in &code.instr(i).operands {
        if let OperandKind::Device(device, Some(index)) = operand.kind
            && is_counter32(device.class, device.number)
        {
            let message = phrase!(
                "`{index}` counts the words of `{device}`, not counters",
                index,
                device
            );
            let warning = codes::INDEXED_COUNTER
                .at(operand.span, message)
                .label(phrase!(
                    "1 leads to the high word of `{device}`, 2 to the next counter",
                    device
                ))
                .help("copy the counters to data registers, and index these");
            out.push(warning);
        }
    }
}
