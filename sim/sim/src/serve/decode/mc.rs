//! Frames of MC protocol, in binary and in ASCII: the first character shows which.

use super::Decoded;
use std::ops::Range;

/// The command of a request, with its frame.
pub(super) fn command(bytes: &[u8]) -> String {
    let three = |command: Option<u16>, subcommand: Option<u16>| match (command, subcommand) {
        (Some(command), Some(subcommand)) => {
            format!("3E command {command:04X}, subcommand {subcommand:04X}")
        }
        _ => "3E".to_string(),
    };
    match bytes {
        [] => String::new(),
        [0x50, ..] => three(word(bytes, 11), word(bytes, 13)),
        [b'5', ..] => three(digits(bytes, 22..26), digits(bytes, 26..30)),
        [b'0' | b'1', ..] => match digits(bytes, 0..2) {
            Some(command) => format!("1E command {command:02X}"),
            None => "1E".to_string(),
        },
        [command, ..] => format!("1E command {command:02X}"),
    }
}

/// An answer.
pub(super) fn reply(bytes: &[u8]) -> Decoded {
    let code = match bytes {
        [0xd0, 0, ..] => word(bytes, 9),
        [b'D', b'0', ..] => digits(bytes, 18..22),
        [first, ..] if first.is_ascii() => digits(bytes, 2..4),
        [_, code, ..] => Some(u16::from(*code)),
        _ => None,
    };
    let error = code.filter(|&code| code != 0);
    let error = error.map(|code| format!("rejected with code {code:02X}H"));
    Decoded {
        text: error.clone().unwrap_or_else(|| "done".to_string()),
        error,
        ..Decoded::default()
    }
}

/// The word at a place, low byte first.
fn word(bytes: &[u8], at: usize) -> Option<u16> {
    let pair = bytes.get(at..at + 2)?;
    Some(u16::from_le_bytes([pair[0], pair[1]]))
}

/// Value of hexadecimal digits.
fn digits(bytes: &[u8], at: Range<usize>) -> Option<u16> {
    let digits = std::str::from_utf8(bytes.get(at)?).ok()?;
    u16::from_str_radix(digits, 16).ok()
}
