//! Frames as the documents of their protocols describe them, written without the code that is tested.

/// A frame of text.
pub type Bytes = Vec<u8>;

/// STX.
pub const STX: u8 = 0x02;
/// ETX.
pub const ETX: u8 = 0x03;
/// ENQ.
pub const ENQ: u8 = 0x05;
/// ACK.
pub const ACK: u8 = 0x06;

/// The low byte of the sum, in two digits.
fn sum(bytes: &[u8]) -> String {
    let sum = bytes.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    format!("{sum:02X}")
}

/// A body with the CRC of Modbus RTU.
pub fn rtu(body: &[u8]) -> Bytes {
    let crc = body.iter().fold(0xffff_u16, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte), |crc, _| {
            crc >> 1 ^ if crc & 1 == 1 { 0xa001 } else { 0 }
        })
    });
    [body, &crc.to_le_bytes()].concat()
}

/// A body as Modbus ASCII.
pub fn ascii(body: &[u8]) -> Bytes {
    let total = body.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    let digits: String = body
        .iter()
        .chain([&total.wrapping_neg()])
        .map(|byte| format!("{byte:02X}"))
        .collect();
    format!(":{digits}\r\n").into_bytes()
}

/// STX, a text, ETX and a sum: the programming port, and links between PLCs.
pub fn stx(text: &str) -> Bytes {
    let summed = [text.as_bytes(), &[ETX]].concat();
    [&[STX], &summed[..], sum(&summed).as_bytes()].concat()
}

/// A request of a computer link, whose text ends with a sum and CR LF if there are any.
pub fn enq(text: &str, crlf: bool) -> Bytes {
    let end = if crlf { "\r\n" } else { "" };
    let sum = sum(text.as_bytes());
    [&[ENQ], format!("{text}{sum}{end}").as_bytes()].concat()
}

/// Data that a computer link answers.
pub fn data(text: &str, crlf: bool) -> Bytes {
    let end: &[u8] = if crlf { b"\r\n" } else { b"" };
    [&stx(text)[..], end].concat()
}

/// Words as hexadecimal digits.
pub fn words(words: &[u16]) -> String {
    words.iter().map(|word| format!("{word:04X}")).collect()
}
