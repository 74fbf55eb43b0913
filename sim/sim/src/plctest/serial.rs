//! Communication in test files.

use rungc_rt::comm::{CAN_PORT, CanFrame, CharFault, Frame};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;

/// Expected output of a port: one text, or any of several.
#[derive(Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a string, or a list of strings of which one must match"
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
#[derive(Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "expected `run` or `stop`, or one of them for each named PLC"
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

/// Protocol of a server over TCP.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Protocol {
    /// Modbus TCP.
    Modbus,
    /// MC protocol, frames 1E and 3E in binary.
    Mc,
    /// The programming port's protocol.
    Fx,
}

/// Direction of a text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// `rx`.
    ToPlc,
    /// `expect_tx`.
    FromPlc,
}

/// A port of a case.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Port {
    /// Its PLC: 0 for that of the case, the others in their order.
    pub plc: usize,
    /// The port.
    pub id: PortId,
}

/// Identifier of a PLC's port.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PortId {
    /// `COM1`.
    Serial(u8),
    /// `CAN`.
    Can,
    /// A connection to a server: `TCP:502`, `TCP:502/b`.
    Tcp(u16, String),
}

impl fmt::Display for PortId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PortId::Serial(number) => write!(f, "COM{number}"),
            PortId::Can => write!(f, "CAN"),
            PortId::Tcp(number, connection) if connection == FIRST => write!(f, "TCP:{number}"),
            PortId::Tcp(number, connection) => write!(f, "TCP:{number}/{connection}"),
        }
    }
}

/// Name of a connection that has none.
const FIRST: &str = "a";

impl PortId {
    /// Port for a name: `COM1`, `CAN`, `TCP:502`, `TCP:502/b`.
    pub(super) fn parse(port: &str) -> Result<PortId, &'static str> {
        let id = match port.split_once(':') {
            None if port == "CAN" => Some(PortId::Can),
            None => {
                let serial = port.strip_prefix("COM").unwrap_or("");
                let number = serial.parse().ok().filter(|_| serial.len() == 1);
                number.map(PortId::Serial)
            }
            Some(("TCP", server)) => {
                let (number, connection) = server.split_once('/').unwrap_or((server, FIRST));
                let number = number.parse().ok().filter(|_| is_name(connection));
                number.map(|number| PortId::Tcp(number, connection.to_string()))
            }
            Some(_) => None,
        };
        id.ok_or("write a port as `COM1`, `CAN` or `TCP:502`")
    }

    /// Its number, if it is a port of the PLC.
    pub(super) fn number(&self) -> Option<u8> {
        match self {
            PortId::Serial(number) => Some(*number),
            PortId::Can => Some(CAN_PORT),
            PortId::Tcp(..) => None,
        }
    }

    /// Input of the port described by this text.
    pub(super) fn items(&self, text: &str) -> Vec<Item> {
        match self {
            PortId::Can => {
                let characters = text.split_whitespace().filter_map(characters).flatten();
                let items = characters.map(|byte| Item::Byte(byte, CharFault::None));
                items.collect()
            }
            PortId::Serial(_) | PortId::Tcp(..) => items(text),
        }
    }

    /// Output of the port described by this text.
    pub(super) fn sent(&self, text: &str) -> Sent {
        match self {
            PortId::Can => Sent {
                bytes: text
                    .split_whitespace()
                    .filter_map(characters)
                    .flatten()
                    .collect(),
                closed: false,
            },
            PortId::Serial(_) | PortId::Tcp(..) => sent(text),
        }
    }

    /// Output of the port in the notation of test files.
    pub(super) fn shown(&self, sent: &Sent) -> String {
        match self {
            PortId::Can => frames(&sent.bytes),
            PortId::Serial(_) | PortId::Tcp(..) => hex(sent),
        }
    }
}

/// Item of a port's input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Item {
    /// A byte.
    Byte(u8, CharFault),
    /// The line is idle for this many microseconds.
    Pause(u64),
    /// The client closes the connection.
    Close,
}

/// Output of a port in a step.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sent {
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// The PLC has closed the connection.
    pub closed: bool,
}

/// As a test file says it.
fn hex(sent: &Sent) -> String {
    let bytes = sent.bytes.iter().map(|byte| format!("{byte:02X}"));
    let words: Vec<_> = bytes
        .chain(sent.closed.then(|| CLOSED.to_string()))
        .collect();
    words.join(" ")
}

/// The longest idle time of a line in a step, in milliseconds: of times in 32 bits of microseconds, half are past.
const LONGEST_PAUSE_MS: f64 = 1_800_000.0;

/// The last words of what a client sends and of what it gets, when the connection ends.
const CLOSE: &str = "close";
const CLOSED: &str = "closed";

/// The characters with which a CAN frame goes to and from the card.
fn characters(word: &str) -> Option<Vec<u8>> {
    let (id, data) = word.split_once('#')?;
    let mark = if id.len() > 3 { CanFrame::EXTENDED } else { 0 };
    let mut frame = CanFrame::new();
    frame.id = u32::from_str_radix(id, 16).ok()? | mark;
    frame.len = (data.len() / 2) as u8;
    for (byte, at) in frame.data.iter_mut().zip((0..data.len()).step_by(2)) {
        *byte = u8::from_str_radix(data.get(at..at + 2)?, 16).ok()?;
    }
    let mut text = [0; 32];
    let mut writer = Frame::new(&mut text);
    frame.write(&mut writer);
    Some(writer.as_slice().to_vec())
}

/// CAN frames as a test file writes them.
fn frames(bytes: &[u8]) -> String {
    let written = bytes.split_inclusive(|&byte| byte == b'\r').map(|text| {
        let Some(frame) = CanFrame::parse(text) else {
            return "?".to_string();
        };
        let id = frame.id & !CanFrame::EXTENDED;
        let width = if frame.id == id { 3 } else { 8 };
        let data = frame.data.iter().take(frame.len.into());
        let data: String = data.map(|byte| format!("{byte:02X}")).collect();
        format!("{id:0width$X}#{data}")
    });
    written.collect::<Vec<_>>().join(" ")
}

/// The bytes that a text stands for, and the pauses between them; what holds to the format has no other words.
fn items(text: &str) -> Vec<Item> {
    let byte = |word: &str| u8::from_str_radix(word, 16).ok();
    let item = |word: &str| match (word.strip_prefix('/'), word.split_once('!')) {
        (Some(_), _) => Some(Item::Pause((pause(word)? * 1000.0) as u64)),
        (None, Some((word, fault))) => Some(Item::Byte(byte(word)?, fault_of(fault)?)),
        (None, None) if word == CLOSE => Some(Item::Close),
        (None, None) => Some(Item::Byte(byte(word)?, CharFault::None)),
    };
    text.split_whitespace().filter_map(item).collect()
}

/// Output of a port described by a text.
fn sent(text: &str) -> Sent {
    let bytes = items(text).into_iter().filter_map(|item| match item {
        Item::Byte(byte, _) => Some(byte),
        Item::Pause(_) | Item::Close => None,
    });
    Sent {
        bytes: bytes.collect(),
        closed: text.split_whitespace().last() == Some(CLOSED),
    }
}

/// Fault of a byte with this letter.
fn fault_of(letter: &str) -> Option<CharFault> {
    match letter {
        "p" => Some(CharFault::Parity),
        "f" => Some(CharFault::Framing),
        "o" => Some(CharFault::Overrun),
        "b" => Some(CharFault::Break),
        _ => None,
    }
}

/// Returns true if this is a valid name of a PLC or a connection.
pub(super) fn is_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric())
}

/// Error in the bytes or frames of a port.
pub(super) fn check_text(port: &str, way: Way, text: &str) -> Result<(), &'static str> {
    let mut words: Vec<&str> = text.split_whitespace().collect();
    if port == "CAN" {
        return words.iter().all(|word| is_frame(word)).then_some(()).ok_or(
            "write a CAN frame as `200#1234`: its identifier and up to 8 bytes in hexadecimal",
        );
    }
    let end = match way {
        Way::ToPlc => CLOSE,
        Way::FromPlc => CLOSED,
    };
    if port.starts_with("TCP:") && words.last() == Some(&end) {
        words.pop();
    }
    let fits = |word: &&str| match way {
        Way::ToPlc => is_byte(word) || pause(word).is_some() || is_bad_byte(word),
        Way::FromPlc => is_byte(word),
    };
    if !words.iter().all(fits) {
        return Err("write bytes as pairs of hexadecimal digits");
    }
    let idle: f64 = words.iter().filter_map(|word| pause(word)).sum();
    match idle <= LONGEST_PAUSE_MS {
        true => Ok(()),
        false => Err("a line is idle for at most 1800000 ms in a step"),
    }
}

fn is_hex(text: &str) -> bool {
    text.bytes().all(|b| b.is_ascii_hexdigit())
}

fn is_byte(word: &str) -> bool {
    word.len() == 2 && is_hex(word)
}

/// `/20`: milliseconds for which the line is idle.
fn pause(word: &str) -> Option<f64> {
    let ms: f64 = word.strip_prefix('/')?.parse().ok()?;
    (ms.is_finite() && ms >= 0.0).then_some(ms)
}

/// `41!p`: a byte with a fault, or a break.
fn is_bad_byte(word: &str) -> bool {
    let Some((byte, fault)) = word.split_once('!') else {
        return false;
    };
    is_byte(byte) && fault_of(fault).is_some()
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
    use super::{Item, PortId, Way, check_text, items};
    use rungc_rt::comm::CharFault;

    #[test]
    fn ports_are_named_as_the_format_says() {
        for port in ["COM0", "COM3", "CAN", "TCP:502", "TCP:5001/b"] {
            let id = PortId::parse(port).unwrap();
            assert_eq!(id.to_string(), port);
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
            assert!(PortId::parse(port).is_err(), "{port}");
        }
    }

    #[test]
    fn bytes_pauses_faults_and_frames_are_held_to_the_format() {
        use Way::{FromPlc, ToPlc};
        for (port, way, text) in [
            ("COM1", ToPlc, "01 03 /10 0A 41!p 41!f 41!o 00!b /2.5"),
            ("COM1", ToPlc, "/1800000 00"),
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
            ("COM1", ToPlc, "/1e300 00"),
            ("TCP:502", ToPlc, "/900000 00 /900000 00 /1"),
            ("COM1", ToPlc, "01 close"),
            ("COM1", FromPlc, "01 /10"),
            ("CAN", ToPlc, "20#12"),
            ("CAN", FromPlc, "200#123"),
            ("CAN", FromPlc, "200#112233445566778899"),
        ] {
            assert!(check_text(port, way, text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_text_is_bytes_and_pauses() {
        let of = items("41 /2.5 42!p");
        let wrong = Item::Byte(0x42, CharFault::Parity);
        assert_eq!(
            of,
            [Item::Byte(0x41, CharFault::None), Item::Pause(2500), wrong]
        );
    }
}
