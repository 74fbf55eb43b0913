//! Frames of the program's own on CAN: CANTX and CANRX (h1u-h2u-programming §4.3.9).

use crate::comm::can::{
    self, D_DATA, D_LENGTH, M_LATE, M_RECEIVED, M_SEND_FAILED, M_SENDS, M_WAITS, turn_us,
};
use crate::comm::{CAN_PORT, CanFrame, Progress, Protocol};
use crate::cx::Cx;
use crate::fault::{Done, Fault};

/// Bit 13 of S1 chooses an identifier of 29 bits, whose upper 13 are the bits below.
const EXTENDED: u32 = 1 << 13;
/// Largest identifier of 11 bits.
const MOST_STANDARD: u32 = 0x7ff;

/// The identifier in S1 and S2.
fn identifier(cx: &Cx) -> Result<u32, Fault> {
    let high = u32::from(cx.word(0, 0)? as u16);
    let low = u32::from(cx.word(1, 0)? as u16);
    if high & EXTENDED != 0 {
        Ok((high & (EXTENDED - 1)) << 16 | low | CanFrame::EXTENDED)
    } else if low <= MOST_STANDARD {
        Ok(low)
    } else {
        Err(Fault::VALUE)
    }
}

/// Returns true if the program has a CAN card that is on.
fn has_card(cx: &mut Cx) -> bool {
    let port = cx.plc.port(CAN_PORT);
    port.is_some_and(|port| port.status.protocol == Protocol::Can)
}

/// CANTX S1 S2 D n (FNC 90): sends n bytes from D on, the high byte of each word first.
pub fn cantx(cx: &mut Cx) -> Done {
    let id = identifier(cx)?;
    let len = cx.count(3, 0..=8)?;
    let mut frame = CanFrame {
        id,
        len: len as u8,
        ..CanFrame::new()
    };
    for (index, byte) in frame.data.iter_mut().enumerate().take(len as usize) {
        let [high, low] = (cx.word(2, index as i32 / 2)? as u16).to_be_bytes();
        *byte = if index % 2 == 0 { high } else { low };
    }
    if !has_card(cx) {
        return Ok(());
    }
    let now_us = cx.plc.sys().now_us();
    let sent = can::send(cx.hal(), &frame, now_us);
    M_SEND_FAILED.set(cx.plc, !sent);
    M_SENDS.set(cx.plc, sent);
    Ok(())
}

/// CANRX S1 S2 D n (FNC 91): receives up to n bytes to D and the words after it, the high byte of each word first.
pub fn canrx(cx: &mut Cx) -> Done {
    let id = identifier(cx)?;
    let most = cx.count(3, 0..=8)?;
    let (owner, now_us) = (cx.site.step + 1, cx.plc.sys().now_us());
    if !has_card(cx) {
        return Ok(());
    }
    let turn_us = turn_us(cx.plc);
    let port = cx.plc.port(CAN_PORT);
    let Some(Progress { can, .. }) = port.and_then(|port| port.progress) else {
        return Ok(());
    };
    let late = can.is_late(now_us, turn_us);
    let frame = can.visit(owner, id, now_us, turn_us);
    let waits = can.waits();
    M_WAITS.set(cx.plc, waits);
    let Some(frame) = frame else {
        if late {
            M_LATE.set(cx.plc, true);
            M_RECEIVED.set(cx.plc, false);
        }
        return Ok(());
    };
    M_RECEIVED.set(cx.plc, true);
    M_LATE.set(cx.plc, false);
    D_LENGTH.set(cx.plc, frame.len.into());
    let [a, b, c, d, e, f, g, h] = frame.data;
    let words = [[c, d], [a, b], [g, h], [e, f]].map(u16::from_be_bytes);
    for (register, word) in D_DATA.run::<4>().into_iter().zip(words) {
        register.set(cx.plc, word);
    }
    for index in 0..most.min(frame.len.into()) {
        let old = cx.word(2, index / 2)? as u16;
        let byte = u16::from(frame.data[index as usize]);
        let word = if index % 2 == 0 {
            old & 0x00ff | byte << 8
        } else {
            old & 0xff00 | byte
        };
        cx.set_word(2, index / 2, word as i16)?;
    }
    Ok(())
}
