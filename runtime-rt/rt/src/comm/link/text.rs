//! The frame around a text.

use crate::comm::{Cut, Frame, LineFault, hex_byte};

/// Start of text.
const STX: u8 = 0x02;
/// End of text; two digits of the sum follow.
const ETX: u8 = 0x03;
/// Maximum number of characters of a frame: the block of an enhanced N:N link.
const LONGEST: usize = 1 + 4 + 4 * 36 + 3;

/// Decides whether the characters received so far form a frame.
pub(super) fn cut(received: &[u8]) -> Cut {
    match received {
        [STX] => Cut::More,
        [STX, .., STX] => Cut::Restart,
        [STX, .., ETX, _, _] => Cut::Whole,
        [STX, ..] if received.len() < LONGEST => Cut::More,
        _ => Cut::Drop,
    }
}

/// Begins a frame.
pub(super) fn begin(kind: u8, frame: &mut Frame) {
    frame.clear();
    frame.extend(&[STX, kind]);
}

/// Ends a frame.
pub(super) fn end(frame: &mut Frame) {
    frame.push(ETX);
    frame.push_hex(frame.sum_from(1).into(), 2);
}

/// Kind and text of a frame whose sum is right.
pub(super) fn open(frame: &[u8]) -> Result<(u8, &[u8]), LineFault> {
    let [STX, summed @ .., high, low] = frame else {
        return Err(LineFault::Form);
    };
    let sum = summed.iter().fold(0u8, |sum, &c| sum.wrapping_add(c));
    if hex_byte(&[*high, *low], 0) != Some(sum) {
        return Err(LineFault::Sum);
    }
    match summed {
        [kind, text @ .., ETX] => Ok((*kind, text)),
        _ => Err(LineFault::Form),
    }
}
