//! Character strings: FNC 116, 117, 200–209, 260 and 261 of the FX3 programming manual, l01s-programming §4.2.
//!
//! A string lies two characters to a word, the first in the low byte, and ends with a byte 0.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::operand::OperandKind;
use crate::special::M_TEXT_OPEN;
use core::fmt::{self, Write};

/// Longest string.
const MAX_LENGTH: i32 = 32767;

/// Character `n` of the string at operand `i`; 0 after the end of a literal.
fn char_at(cx: &Cx, i: usize, n: i32) -> Result<u8, Fault> {
    let op = cx.ops.get(i).ok_or(Fault::DEVICE)?;
    if op.kind == OperandKind::Text {
        let text = cx.plc.text(op.value as u32);
        return Ok(usize::try_from(n)
            .ok()
            .and_then(|n| text.get(n))
            .copied()
            .unwrap_or(0));
    }
    let word = cx.word(i, n / 2)? as u16;
    Ok(if n % 2 == 0 {
        word as u8
    } else {
        (word >> 8) as u8
    })
}

/// Length of the string at operand `i`; a fault if it has no end.
fn length(cx: &Cx, i: usize) -> Result<i32, Fault> {
    for n in 0..MAX_LENGTH {
        if char_at(cx, i, n)? == 0 {
            return Ok(n);
        }
    }
    Err(Fault::DEVICE)
}

/// Sets one byte of the words at operand `i`.
fn set_byte(cx: &mut Cx, i: usize, n: i32, byte: u8) -> Done {
    let word = cx.word(i, n / 2)? as u16;
    let word = if n % 2 == 0 {
        word & 0xff00 | u16::from(byte)
    } else {
        word & 0x00ff | u16::from(byte) << 8
    };
    cx.set_word(i, n / 2, word as i16)
}

/// Writes `count` characters and the end to operand `i`; `source` gives character n. The last word is written whole.
fn write(
    cx: &mut Cx,
    i: usize,
    count: i32,
    source: impl Fn(&Cx, i32) -> Result<u8, Fault>,
) -> Done {
    cx.check_words(i, count / 2 + 1)?;
    for k in 0..=count / 2 {
        let byte = |cx: &Cx, n: i32| if n < count { source(cx, n) } else { Ok(0) };
        let word = u16::from(byte(cx, 2 * k)?) | u16::from(byte(cx, 2 * k + 1)?) << 8;
        cx.set_word(i, k, word as i16)?;
    }
    Ok(())
}

/// $MOV S D (FNC 209): copies a string with its end; the two may overlap.
pub fn str_mov(cx: &mut Cx) -> Done {
    let count = length(cx, 0)?;
    if !cx.begins_behind(0, 1) {
        return write(cx, 1, count, |cx, n| char_at(cx, 0, n));
    }
    cx.check_words(1, count / 2 + 1)?;
    for k in (0..=count / 2).rev() {
        let byte = |cx: &Cx, n: i32| if n < count { char_at(cx, 0, n) } else { Ok(0) };
        let word = u16::from(byte(cx, 2 * k)?) | u16::from(byte(cx, 2 * k + 1)?) << 8;
        cx.set_word(1, k, word as i16)?;
    }
    Ok(())
}

/// $+ S1 S2 D (FNC 202): S1 followed by S2.
pub fn str_add(cx: &mut Cx) -> Done {
    let (first, second) = (length(cx, 0)?, length(cx, 1)?);
    write(cx, 2, first + second, |cx, n| {
        if n < first {
            char_at(cx, 0, n)
        } else {
            char_at(cx, 1, n - first)
        }
    })
}

/// LEN S D (FNC 203): number of characters.
pub fn len(cx: &mut Cx) -> Done {
    let count = length(cx, 0)?;
    cx.set_word(1, 0, count as i16)
}

/// LEFT S D n (FNC 205): the first n characters; a fault if there are fewer.
pub fn left(cx: &mut Cx) -> Done {
    let n = part(cx, length(cx, 0)?)?;
    write(cx, 1, n, |cx, k| char_at(cx, 0, k))
}

/// RIGHT S D n (FNC 204): the last n characters; a fault if there are fewer.
pub fn right(cx: &mut Cx) -> Done {
    let count = length(cx, 0)?;
    let n = part(cx, count)?;
    write(cx, 1, n, |cx, k| char_at(cx, 0, count - n + k))
}

/// Operand 2 as a number of characters of a string that has `count`.
fn part(cx: &Cx, count: i32) -> Result<i32, Fault> {
    let n = i32::from(cx.word(2, 0)?);
    if (0..=count).contains(&n) {
        Ok(n)
    } else {
        Err(Fault::DEVICE)
    }
}

/// Start (from 0) and number of characters that the pair at operand 2 asks for; −1 stands for `all`.
fn middle(cx: &Cx, all: impl FnOnce(i32) -> i32) -> Result<(i32, i32), Fault> {
    let start = i32::from(cx.word(2, 0)?) - 1;
    match i32::from(cx.word(2, 1)?) {
        _ if start < 0 => Err(Fault::DEVICE),
        -1 => Ok((start, all(start))),
        n if n >= 0 => Ok((start, n)),
        _ => Err(Fault::DEVICE),
    }
}

/// MIDR S1 D S2 (FNC 206): S2+1 characters of S1 from number S2 (from 1) on; −1 takes the rest, 0 does nothing.
pub fn midr(cx: &mut Cx) -> Done {
    let count = length(cx, 0)?;
    let (start, n) = middle(cx, |start| count - start)?;
    if n == 0 {
        return Ok(());
    }
    if start >= count || start + n > count {
        return Err(Fault::DEVICE);
    }
    write(cx, 1, n, |cx, k| char_at(cx, 0, start + k))
}

/// MIDW S1 D S2 (FNC 207): the first S2+1 characters of S1 (−1: all) replace those of D from number S2 (from 1) on, as
/// far as D goes.
pub fn midw(cx: &mut Cx) -> Done {
    let (count, target) = (length(cx, 0)?, length(cx, 1)?);
    let (start, n) = middle(cx, |_| count)?;
    if start >= target || n > count {
        return Err(Fault::DEVICE);
    }
    for k in 0..n.min(target - start) {
        let byte = char_at(cx, 0, k)?;
        set_byte(cx, 1, start + k, byte)?;
    }
    Ok(())
}

/// INSTR S1 S2 D n (FNC 208): the position of S1 in S2, searched from character n (counted from 1); 0 if not found.
pub fn instr(cx: &mut Cx) -> Done {
    let (needle, hay) = (length(cx, 0)?, length(cx, 1)?);
    let from = i32::from(cx.word(3, 0)?);
    if !(1..=hay.max(1)).contains(&from) {
        return Err(Fault::DEVICE);
    }
    let mut found = 0;
    for start in from - 1..=hay - needle {
        let mut same = needle > 0;
        for k in 0..needle {
            same = same && char_at(cx, 0, k)? == char_at(cx, 1, start + k)?;
        }
        if same {
            found = start + 1;
            break;
        }
    }
    cx.set_word(2, 0, found as i16)
}

/// A few characters on the stack.
struct Buffer {
    bytes: [u8; 48],
    length: usize,
}

impl Buffer {
    const fn new() -> Self {
        Buffer {
            bytes: [0; 48],
            length: 0,
        }
    }

    fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or(&[])
    }

    fn push(&mut self, byte: u8) -> Done {
        *self.bytes.get_mut(self.length).ok_or(Fault::DEVICE)? = byte;
        self.length += 1;
        Ok(())
    }
}

impl Write for Buffer {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        s.bytes()
            .try_for_each(|byte| self.push(byte).map_err(|_| fmt::Error))
    }
}

/// Writes a buffer and the end to operand `i`.
fn write_buffer(cx: &mut Cx, i: usize, buffer: &Buffer) -> Done {
    let bytes = buffer.as_bytes();
    write(cx, i, bytes.len() as i32, |_, n| {
        Ok(bytes.get(n as usize).copied().unwrap_or(0))
    })
}

/// Limits of STR and VAL by form: most characters in all, most after the point.
fn decimal_limits(cx: &Cx) -> (i32, i32) {
    if cx.wide() { (13, 10) } else { (8, 5) }
}

/// Checks that `total` characters with `fraction` of them after a point make a number.
fn check_format(total: i32, fraction: i32, limits: (i32, i32)) -> Done {
    let fits = (2..=limits.0).contains(&total) && (0..=limits.1).contains(&fraction);
    if fits && (fraction == 0 || fraction <= total - 3) {
        Ok(())
    } else {
        Err(Fault::DEVICE)
    }
}

/// STR S1 S2 D (FNC 200): the integer S2 as S1 characters: a sign (space or −), spaces, and digits with S1+1 of them
/// after a point.
pub fn str(cx: &mut Cx) -> Done {
    let (total, fraction) = (i32::from(cx.word(0, 0)?), i32::from(cx.word(0, 1)?));
    check_format(total, fraction, decimal_limits(cx))?;
    let value = cx.read(1)?;
    let mut digits = Buffer::new();
    // At least one digit precedes the point.
    let _ = write!(
        digits,
        "{:0width$}",
        value.unsigned_abs(),
        width = fraction as usize + 1
    );
    let shown = digits.length as i32 + i32::from(fraction > 0);
    if shown > total - 1 {
        return Err(Fault::DEVICE);
    }
    let mut text = Buffer::new();
    text.push(if value < 0 { b'-' } else { b' ' })?;
    (0..total - 1 - shown).try_for_each(|_| text.push(b' '))?;
    for (i, &digit) in digits.as_bytes().iter().enumerate() {
        if fraction > 0 && digits.length - i == fraction as usize {
            text.push(b'.')?;
        }
        text.push(digit)?;
    }
    write_buffer(cx, 2, &text)
}

/// VAL S D1 D2 (FNC 201): a number in characters as an integer in D2, its number of characters in D1, of those after
/// the point in D1+1.
pub fn val(cx: &mut Cx) -> Done {
    let limits = decimal_limits(cx);
    let total = length(cx, 0)?;
    if !(2..=limits.0).contains(&total) {
        return Err(Fault::DEVICE);
    }
    let negative = match char_at(cx, 0, 0)? {
        b'-' => true,
        b' ' => false,
        _ => return Err(Fault::DEVICE),
    };
    let (mut value, mut fraction, mut point) = (0i64, 0, false);
    for n in 1..total {
        match char_at(cx, 0, n)? {
            digit @ b'0'..=b'9' => {
                value = value
                    .saturating_mul(10)
                    .saturating_add(i64::from(digit - b'0'));
                fraction += i32::from(point);
            }
            b'.' if !point && n + 1 < total => point = true,
            b' ' if value == 0 && !point => {}
            _ => return Err(Fault::DEVICE),
        }
    }
    let value = if negative { -value } else { value };
    let fits = if cx.wide() {
        i32::try_from(value).is_ok()
    } else {
        i16::try_from(value).is_ok()
    };
    if !fits || fraction > limits.1 {
        return Err(Fault::DEVICE);
    }
    cx.check_words(1, 2)?;
    cx.write(2, value as i32)?;
    cx.set_word(1, 0, total as i16)?;
    cx.set_word(1, 1, fraction as i16)
}

/// Digits of DABIN and BINDA by form.
fn decimal_digits(cx: &Cx) -> i32 {
    if cx.wide() { 10 } else { 5 }
}

/// DABIN S D (FNC 260): a sign (space or −) and 5 (32-bit: 10) digits as an integer; spaces and zero bytes count as 0.
pub fn dabin(cx: &mut Cx) -> Done {
    let negative = match char_at(cx, 0, 0)? {
        b'-' => true,
        b' ' => false,
        _ => return Err(Fault::DEVICE),
    };
    let mut value = 0i64;
    for n in 1..=decimal_digits(cx) {
        let digit = match char_at(cx, 0, n)? {
            digit @ b'0'..=b'9' => digit - b'0',
            b' ' | 0 => 0,
            _ => return Err(Fault::DEVICE),
        };
        value = value * 10 + i64::from(digit);
    }
    let value = if negative { -value } else { value };
    let fits = if cx.wide() {
        i32::try_from(value).is_ok()
    } else {
        i16::try_from(value).is_ok()
    };
    if fits {
        cx.write(1, value as i32)
    } else {
        Err(Fault::DEVICE)
    }
}

/// BINDA S D (FNC 261): an integer as a sign (space or −) and 5 (32-bit: 10) digits, leading zeros as spaces. M8091 off
/// ends the string with 0; on, the 16-bit form ends without, the 32-bit form with a space.
pub fn binda(cx: &mut Cx) -> Done {
    let value = cx.read(0)?;
    let digits = decimal_digits(cx);
    let mut text = Buffer::new();
    text.push(if value < 0 { b'-' } else { b' ' })?;
    let _ = write!(
        text,
        "{:>width$}",
        value.unsigned_abs(),
        width = digits as usize
    );
    let open = cx.special(M_TEXT_OPEN);
    if open && cx.wide() {
        text.push(b' ')?;
    }
    if !open {
        return write_buffer(cx, 1, &text);
    }
    cx.check_words(1, text.length as i32 / 2)?;
    for (n, &byte) in text.as_bytes().iter().enumerate() {
        set_byte(cx, 1, n as i32, byte)?;
    }
    Ok(())
}

/// ESTR S1 S2 D (FNC 116): the float S1 as S2+1 characters, S2+2 of them after the point: a sign, spaces and digits if
/// S2 is 0, a sign, spaces, mantissa and `E±nn` if it is 1.
pub fn estr(cx: &mut Cx) -> Done {
    let value = cx.float(0, 0)?;
    let (mode, total, fraction) = (
        cx.word(1, 0)?,
        i32::from(cx.word(1, 1)?),
        i32::from(cx.word(1, 2)?),
    );
    let overhead = match mode {
        0 => 1,
        1 => 5,
        _ => return Err(Fault::DEVICE),
    };
    let room = total - overhead - i32::from(fraction > 0);
    if !value.is_finite()
        || !(2..=24).contains(&total)
        || !(0..=7).contains(&fraction)
        || room <= fraction
    {
        return Err(Fault::DEVICE);
    }
    let mut number = Buffer::new();
    let magnitude = half_up(value.abs());
    let fraction = fraction as usize;
    let written = if mode == 0 {
        write!(number, "{magnitude:.fraction$}")
    } else {
        // Rust writes the exponent without sign and padding.
        let mut plain = Buffer::new();
        write!(plain, "{magnitude:.fraction$e}")
            .and_then(|()| pad_exponent(plain.as_bytes(), &mut number))
    };
    let spaces = total - 1 - number.length as i32;
    if written.is_err() || spaces < 0 {
        return Err(Fault::DEVICE);
    }
    let mut text = Buffer::new();
    text.push(if value < 0.0 { b'-' } else { b' ' })?;
    (0..spaces).try_for_each(|_| text.push(b' '))?;
    number
        .as_bytes()
        .iter()
        .try_for_each(|&byte| text.push(byte))?;
    write_buffer(cx, 2, &text)
}

/// The same number, a last bit of the wider format larger: `write!` rounds an exact half to even, ESTR rounds it up.
fn half_up(magnitude: f32) -> f64 {
    let exact = f64::from(magnitude);
    if magnitude == 0.0 {
        exact
    } else {
        f64::from_bits(exact.to_bits() + 1)
    }
}

/// Turns `1.5e-3` into `1.5E-03`.
fn pad_exponent(plain: &[u8], out: &mut Buffer) -> fmt::Result {
    let at = plain.iter().position(|&b| b == b'e').ok_or(fmt::Error)?;
    let (mantissa, exponent) = plain.split_at(at);
    let exponent =
        core::str::from_utf8(exponent.get(1..).unwrap_or(&[])).map_err(|_| fmt::Error)?;
    let exponent: i32 = exponent.parse().map_err(|_| fmt::Error)?;
    out.write_str(core::str::from_utf8(mantissa).map_err(|_| fmt::Error)?)?;
    write!(
        out,
        "E{}{:02}",
        if exponent < 0 { '-' } else { '+' },
        exponent.abs()
    )
}

/// EVAL S D (FNC 117): a number in characters, plain or with exponent, as a float; spaces are passed over. M8020 is on
/// if it is 0, M8021 if it is too small for a float, M8022 if it is too large (FX3 programming manual §18.5).
pub fn eval(cx: &mut Cx) -> Done {
    let total = length(cx, 0)?;
    if total > 24 {
        return Err(Fault::DEVICE);
    }
    let mut text = Buffer::new();
    for n in 0..total {
        match char_at(cx, 0, n)? {
            b' ' => {}
            byte @ (b'0'..=b'9' | b'.' | b'-' | b'+' | b'E') => text.push(byte)?,
            _ => return Err(Fault::DEVICE),
        }
    }
    let text = core::str::from_utf8(text.as_bytes()).map_err(|_| Fault::DEVICE)?;
    let exact: f64 = text.parse().map_err(|_| Fault::DEVICE)?;
    super::float::write_result(cx, 1, exact)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Fault, RtFn, k};
    use std::string::{String, ToString};
    use std::vec::Vec;

    fn put(plc: &mut Double, first: u32, text: &str) {
        let mut bytes = text.as_bytes().to_vec();
        bytes.extend([0, 0]);
        let words: Vec<i32> = bytes
            .chunks_exact(2)
            .map(|p| i32::from(i16::from_le_bytes([p[0], p[1]])))
            .collect();
        plc.set_d(first, &words);
    }

    fn get(plc: &Double, first: u32) -> String {
        let bytes = plc
            .d(first, 20)
            .into_iter()
            .flat_map(i16::to_le_bytes)
            .take_while(|&b| b != 0)
            .collect::<Vec<_>>();
        String::from_utf8_lossy(&bytes).to_string()
    }

    #[test]
    fn strings_are_copied_joined_and_cut() {
        let mut plc = Double::new();
        put(&mut plc, 0, "PUMP");
        put(&mut plc, 10, " ON!!");
        plc.call(RtFn::StrAdd, &[reg(0), reg(10), reg(20)]).unwrap();
        assert_eq!(get(&plc, 20), "PUMP ON!!");
        plc.call(RtFn::StrMov, &[reg(20), reg(21)]).unwrap();
        assert_eq!(get(&plc, 21), "PUMP ON!!");
        plc.call(RtFn::Len, &[reg(21), reg(40)]).unwrap();
        assert_eq!(plc.d(40, 1), [9]);
        plc.call(RtFn::Left, &[reg(21), reg(50), k(3)]).unwrap();
        assert_eq!(get(&plc, 50), "PUM");
        plc.call(RtFn::Right, &[reg(21), reg(50), k(4)]).unwrap();
        assert_eq!(get(&plc, 50), "ON!!");
        assert_eq!(
            plc.call(RtFn::Left, &[reg(21), reg(50), k(10)]),
            Err(Fault::DEVICE)
        );
    }

    #[test]
    fn middles_are_read_replaced_and_found() {
        let mut plc = Double::new().with_d(100, &[2, 3]);
        put(&mut plc, 0, "ABCDEFG");
        plc.call(RtFn::Midr, &[reg(0), reg(20), reg(100)]).unwrap();
        assert_eq!(get(&plc, 20), "BCD");
        put(&mut plc, 40, "xyz");
        plc.call(RtFn::Midw, &[reg(40), reg(0), reg(100)]).unwrap();
        assert_eq!(get(&plc, 0), "AxyzEFG");
        put(&mut plc, 60, "zE");
        plc.call(RtFn::Instr, &[reg(60), reg(0), reg(80), k(1)])
            .unwrap();
        assert_eq!(plc.d(80, 1), [4]);
        plc.call(RtFn::Instr, &[reg(60), reg(0), reg(80), k(5)])
            .unwrap();
        assert_eq!(plc.d(80, 1), [0]);
    }

    #[test]
    fn integers_become_text_and_back() {
        let mut plc = Double::new().with_d(0, &[6, 2, -123]);
        plc.call(RtFn::Str, &[reg(0), reg(2), reg(10)]).unwrap();
        assert_eq!(get(&plc, 10), "- 1.23");
        plc.call(RtFn::Val, &[reg(10), reg(20), reg(30)]).unwrap();
        assert_eq!(
            (plc.d(20, 2), plc.d(30, 1)),
            ([6, 2].to_vec(), [-123].to_vec())
        );
        plc.set_d(0, &[5, 2, -1234]);
        assert_eq!(
            plc.call(RtFn::Str, &[reg(0), reg(2), reg(10)]),
            Err(Fault::DEVICE)
        );
        plc.call(RtFn::Binda, &[k(-276), reg(40)]).unwrap();
        assert_eq!(get(&plc, 40), "-  276");
        plc.call(RtFn::Dabin, &[reg(40), reg(50)]).unwrap();
        assert_eq!(plc.d(50, 1), [-276]);
        put(&mut plc, 40, "+00001");
        assert_eq!(
            plc.call(RtFn::Dabin, &[reg(40), reg(50)]),
            Err(Fault::DEVICE)
        );
    }

    #[test]
    fn floats_become_text_and_back() {
        let mut plc = Double::wide().with_d(10, &[0, 8, 3]);
        plc.set_df(0, -1.234_5);
        plc.call(RtFn::Estr, &[reg(0), reg(10), reg(20)]).unwrap();
        assert_eq!(get(&plc, 20), "-  1.235");
        plc.set_d(10, &[1, 12, 3]);
        plc.set_df(0, 0.001_25);
        plc.call(RtFn::Estr, &[reg(0), reg(10), reg(20)]).unwrap();
        assert_eq!(get(&plc, 20), "   1.250E-03");
        plc.call(RtFn::Eval, &[reg(20), reg(40)]).unwrap();
        assert_eq!(plc.df(40), 0.001_25);
        put(&mut plc, 20, "1.2.3");
        assert_eq!(
            plc.call(RtFn::Eval, &[reg(20), reg(40)]),
            Err(Fault::DEVICE)
        );
    }
}
