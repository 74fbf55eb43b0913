//! What test files say about communication. It is held to the rules of the format; no engine has ports yet, so a case that uses
//! it needs what engines lack ([`Step::needs`](super::Step)).

use serde::Deserialize;
use std::collections::BTreeMap;

/// Needed by a case that sends, receives or serves.
pub(super) const PORTS: &str = "serial ports";
/// Needed by a case that has several PLCs.
pub(super) const OTHER_PLCS: &str = "more than one PLC";

/// What a port is expected to send: one text, or any of several.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "what a port sends is a text, or a list of texts of which one is right"
)]
pub(super) enum RawSent {
    One(String),
    AnyOf(Vec<String>),
}

impl RawSent {
    /// The texts.
    pub(super) fn texts(&self) -> &[String] {
        match self {
            RawSent::One(text) => std::slice::from_ref(text),
            RawSent::AnyOf(texts) => texts,
        }
    }
}

/// The RUN/STOP switch of all PLCs, or of those that are named.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "`mode` is `run` or `stop`, or one of them for each PLC that is named"
)]
pub(super) enum RawMode {
    All(Switch),
    Of(BTreeMap<String, Switch>),
}

/// Positions of the RUN/STOP switch.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Switch {
    Run,
    Stop,
}

/// What a server over TCP speaks.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Protocol {
    Modbus,
    Mc,
    Fx,
}

/// Which way a text goes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// `rx`.
    ToPlc,
    /// `expect_tx`.
    FromPlc,
}

/// What is wrong with the name of a port (`COM1`, `CAN`, `TCP:502`, `TCP:502/b`).
pub(super) fn check_port(port: &str) -> Result<(), &'static str> {
    let fits = match port.split_once(':') {
        None => {
            let serial = port.strip_prefix("COM").unwrap_or("");
            port == "CAN" || serial.len() == 1 && serial.parse::<u8>().is_ok()
        }
        Some(("TCP", server)) => {
            let (number, connection) = server.split_once('/').unwrap_or((server, "a"));
            number.parse::<u16>().is_ok() && is_name(connection)
        }
        Some(_) => false,
    };
    fits.then_some(())
        .ok_or("a port is named `COM1`, `CAN` or `TCP:502`")
}

/// Whether this may name a PLC or a connection.
pub(super) fn is_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric())
}

/// What is wrong with the bytes or frames on a port.
pub(super) fn check_text(port: &str, way: Way, text: &str) -> Result<(), &'static str> {
    let mut words: Vec<&str> = text.split_whitespace().collect();
    if port == "CAN" {
        return words
            .iter()
            .all(|word| is_frame(word))
            .then_some(())
            .ok_or("a CAN frame is written `200#1234`: its identifier and up to 8 bytes in hexadecimal digits");
    }
    let end = match way {
        Way::ToPlc => "close",
        Way::FromPlc => "closed",
    };
    if port.starts_with("TCP:") && words.last() == Some(&end) {
        words.pop();
    }
    let fits = |word: &&str| match way {
        Way::ToPlc => is_byte(word) || is_pause(word) || is_bad_byte(word),
        Way::FromPlc => is_byte(word),
    };
    match words.iter().all(fits) {
        true => Ok(()),
        false => Err("bytes are written as pairs of hexadecimal digits"),
    }
}

fn is_hex(text: &str) -> bool {
    text.bytes().all(|b| b.is_ascii_hexdigit())
}

fn is_byte(word: &str) -> bool {
    word.len() == 2 && is_hex(word)
}

/// `/20`: milliseconds for which the line is idle.
fn is_pause(word: &str) -> bool {
    let ms = word.strip_prefix('/').and_then(|ms| ms.parse::<f64>().ok());
    ms.is_some_and(|ms| ms.is_finite() && ms >= 0.0)
}

/// `41!p`: a byte with a fault, or a break.
fn is_bad_byte(word: &str) -> bool {
    let Some((byte, fault)) = word.split_once('!') else {
        return false;
    };
    is_byte(byte) && matches!(fault, "p" | "f" | "o" | "b")
}

fn is_frame(word: &str) -> bool {
    let Some((id, data)) = word.split_once('#') else {
        return false;
    };
    matches!(id.len(), 3 | 8)
        && is_hex(id)
        && is_hex(data)
        && data.len() % 2 == 0
        && data.len() <= 16
}

#[cfg(test)]
mod tests {
    use super::{Way, check_port, check_text};

    #[test]
    fn ports_are_named_as_the_format_says() {
        for port in ["COM0", "COM3", "CAN", "TCP:502", "TCP:5001/b"] {
            assert_eq!(check_port(port), Ok(()), "{port}");
        }
        for port in [
            "COM",
            "COM10",
            "USB",
            "TCP:",
            "TCP:70000",
            "TCP:502/",
            "B:COM1",
        ] {
            assert!(check_port(port).is_err(), "{port}");
        }
    }

    #[test]
    fn bytes_pauses_faults_and_frames_are_held_to_the_format() {
        use Way::{FromPlc, ToPlc};
        for (port, way, text) in [
            ("COM1", ToPlc, "01 03 /10 0A 41!p 41!f 41!o 00!b /2.5"),
            ("COM1", FromPlc, ""),
            ("CAN", ToPlc, "200#1234 1301000A#"),
            ("TCP:502", ToPlc, "00 01 close"),
            ("TCP:502", FromPlc, "closed"),
        ] {
            assert_eq!(check_text(port, way, text), Ok(()), "{text}");
        }
        for (port, way, text) in [
            ("COM1", ToPlc, "1"),
            ("COM1", ToPlc, "41!x"),
            ("COM1", ToPlc, "/-1"),
            ("COM1", ToPlc, "01 close"),
            ("COM1", FromPlc, "01 /10"),
            ("CAN", ToPlc, "20#12"),
            ("CAN", FromPlc, "200#123"),
            ("CAN", FromPlc, "200#112233445566778899"),
        ] {
            assert!(check_text(port, way, text).is_err(), "{text}");
        }
    }
}
