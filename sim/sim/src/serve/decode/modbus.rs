//! Frames of Modbus.

use super::{Decoded, Decoder, about, fault_name};
use crate::serve::probe::Probe;
use rungc_rt::comm::modbus::{self, Framing, Profile, Settings, tcp};
use rungc_rt::comm::{Cut, Frame, LineFault};
use std::fmt::Write;

/// The station that means all slaves.
const BROADCAST: u8 = 0;

/// Set in the function of an exception.
const EXCEPTION: u8 = 0x80;

/// Values that a text shows before it breaks off.
const MOST_VALUES: usize = 16;

/// Bytes before the unit of a Modbus TCP frame.
const TCP_HEADER: usize = 6;

impl Decoder {
    fn profile(&self) -> &'static Profile {
        self.family.modbus(self.type_code)
    }

    /// A frame of a serial slave.
    pub(super) fn modbus(
        &self,
        framing: Framing,
        is_request: bool,
        bytes: &[u8],
        before: Option<&[u8]>,
    ) -> Decoded {
        let decoded = master(framing, is_request, bytes, before);
        if !is_request || decoded.error.is_some() {
            return decoded;
        }
        let station = open(framing, bytes)
            .ok()
            .and_then(|body| body.first().copied());
        let settings = Settings {
            framing,
            station: station.filter(|&to| to != BROADCAST).unwrap_or(1).into(),
            profile: self.profile(),
        };
        self.with_devices(decoded, |map, reply| {
            modbus::answer(&settings, bytes, map, reply)
        })
    }

    pub(super) fn modbus_tcp(
        &self,
        is_request: bool,
        bytes: &[u8],
        before: Option<&[u8]>,
    ) -> Decoded {
        let decoded = over_tcp(is_request, bytes, before);
        if !is_request || decoded.error.is_some() {
            return decoded;
        }
        self.with_devices(decoded, |map, reply| {
            tcp::answer(self.profile(), bytes, map, reply)
        })
    }

    /// The same with the devices that the request is about.
    fn with_devices(
        &self,
        mut decoded: Decoded,
        answer: impl FnOnce(&mut Probe, &mut Frame) -> Result<(), LineFault>,
    ) -> Decoded {
        let mut probe = Probe::new(self.type_code);
        let mut bytes = [0; modbus::LONGEST_ASCII];
        // Errors of a request are in its answer.
        let _ = answer(&mut probe, &mut Frame::new(&mut bytes));
        let about = about(&probe);
        if !about.is_empty() {
            let _ = write!(decoded.text, ": {about}");
        }
        decoded.written = probe.written;
        decoded
    }
}

/// A frame over TCP, whose addresses are not devices of the PLC.
pub(super) fn over_tcp(is_request: bool, bytes: &[u8], before: Option<&[u8]>) -> Decoded {
    let body = |bytes: &[u8]| bytes.get(TCP_HEADER..).map(<[u8]>::to_vec);
    match body(bytes).filter(|_| tcp::cut(bytes) == Cut::Whole) {
        Some(own) => message("unit", is_request, &own, before.and_then(body).as_deref()),
        None => wrong(LineFault::Form),
    }
}

/// A frame on a line whose slave is somebody else: its addresses are not devices of the PLC.
pub(super) fn master(
    framing: Framing,
    is_request: bool,
    bytes: &[u8],
    before: Option<&[u8]>,
) -> Decoded {
    let request = before.and_then(|before| open(framing, before).ok());
    match open(framing, bytes) {
        Ok(body) => message("station", is_request, &body, request.as_deref()),
        Err(fault) => wrong(fault),
    }
}

fn wrong(fault: LineFault) -> Decoded {
    let why = fault_name(fault).to_string();
    Decoded {
        text: why.clone(),
        error: Some(why),
        ..Decoded::default()
    }
}

/// The bytes of a serial frame from the station on.
fn open(framing: Framing, frame: &[u8]) -> Result<Vec<u8>, LineFault> {
    let bytes = match framing {
        Framing::Rtu => frame.to_vec(),
        Framing::Ascii => {
            let digits = frame.strip_prefix(b":");
            let digits = digits.and_then(|digits| digits.strip_suffix(b"\r\n"));
            let digits = digits.ok_or(LineFault::Form)?;
            let pair = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
            let bytes = digits.chunks(2).map(pair).collect::<Option<Vec<_>>>();
            bytes.ok_or(LineFault::Form)?
        }
    };
    let check = match framing {
        Framing::Rtu => 2,
        Framing::Ascii => 1,
    };
    let length = bytes.len().checked_sub(check).filter(|&length| length > 1);
    let (body, code) = bytes.split_at(length.ok_or(LineFault::Length)?);
    let right = match framing {
        Framing::Rtu => code == modbus::crc16(body).to_le_bytes(),
        Framing::Ascii => bytes.iter().fold(0u8, |sum, &byte| sum.wrapping_add(byte)) == 0,
    };
    if right {
        Ok(body.to_vec())
    } else {
        Err(LineFault::Sum)
    }
}

/// A request or an answer from the station on. `to` is what its first byte is called; `request` is what an answer
/// answers.
fn message(to: &str, is_request: bool, body: &[u8], request: Option<&[u8]>) -> Decoded {
    let [station, function, data @ ..] = body else {
        return wrong(LineFault::Length);
    };
    let (what, error) = match is_request {
        true => (request_text(*function, data), None),
        false => reply_text(*function, data, request),
    };
    Decoded {
        text: format!("{to} {station}: {what}"),
        error,
        broadcast: is_request && to == "station" && *station == BROADCAST,
        ..Decoded::default()
    }
}

fn word(data: &[u8], at: usize) -> u16 {
    let high = data.get(at).copied().unwrap_or(0);
    u16::from_be_bytes([high, data.get(at + 1).copied().unwrap_or(0)])
}

/// Words in decimal.
fn words(data: &[u8]) -> String {
    let values = data.chunks(2).map(|pair| word(pair, 0).to_string());
    let mut values: Vec<_> = values.take(MOST_VALUES + 1).collect();
    if values.len() > MOST_VALUES {
        values[MOST_VALUES] = "…".to_string();
    }
    values.join(" ")
}

/// Bits, the lowest first.
fn bits(data: &[u8], count: usize) -> String {
    let all = data
        .iter()
        .flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1));
    let shown = all.take(count.min(8 * MOST_VALUES));
    shown.map(|bit| if bit == 1 { '1' } else { '0' }).collect()
}

fn request_text(function: u8, data: &[u8]) -> String {
    let (address, second) = (word(data, 0), word(data, 2));
    let many = |what| format!("{what} {address}, count {second}");
    let values = data.get(5..).unwrap_or(&[]);
    match function {
        0x01 => many("01 read coils"),
        0x02 => many("02 read inputs"),
        0x03 => many("03 read registers"),
        0x04 => many("04 read input registers"),
        0x05 => format!("05 write coil {address} = {}", u8::from(second != 0)),
        0x06 => format!("06 write register {address} = {second}"),
        0x0f => {
            let values = bits(values, second.into());
            format!("{} = {values}", many("0F write coils"))
        }
        0x10 => format!("{} = {}", many("10 write registers"), words(values)),
        _ => format!("{function:02X}"),
    }
}

fn reply_text(function: u8, data: &[u8], request: Option<&[u8]>) -> (String, Option<String>) {
    let values = data.get(1..).unwrap_or(&[]);
    let what = match function {
        EXCEPTION.. => {
            let code = data.first().copied().unwrap_or(0);
            let error = format!("exception {code:02X} ({})", exception(code));
            return (
                format!("{:02X} {error}", function & !EXCEPTION),
                Some(error),
            );
        }
        0x01 | 0x02 => {
            let requested = request.map_or(usize::MAX, |request| word(request, 4).into());
            format!("{function:02X} = {}", bits(values, requested))
        }
        0x03 | 0x04 => format!("{function:02X} = {}", words(values)),
        _ => format!("{function:02X} done"),
    };
    (what, None)
}

/// Meaning of an exception (Modbus application protocol 1.1b3 §7).
fn exception(code: u8) -> &'static str {
    match code {
        1 => "illegal function",
        2 => "illegal data address",
        3 => "illegal data value",
        4 => "device failure",
        5 => "acknowledge",
        6 => "device busy",
        8 => "memory parity error",
        0x0a => "gateway path unavailable",
        0x0b => "gateway target does not respond",
        _ => "unknown",
    }
}
