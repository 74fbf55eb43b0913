//! Parallel link: two PLCs that show each other an area (h1u-h2u-programming §5.3.2).

use super::{Block, Link, set_relay, text, value};
use crate::comm::{Frame, LineFault, Map};
use crate::plc::Class;

/// The link is running.
pub(in crate::comm) const M_RUNNING: u32 = 8072;
/// High-speed mode: two words each way.
const M_HIGH_SPEED: u32 = 8162;
/// Milliseconds after which a missing partner is an error.
const D_TIME_OUT: u32 = 8070;
/// The same if the register holds 0.
const USUAL_TIME_OUT_MS: u32 = 500;
/// After so long without an answer the master asks again; the manual states no time.
const ASK_AGAIN_US: u32 = 100_000;

/// Kind of the master's frames.
const FROM_MASTER: u8 = b'A';
/// Kind of the slave's frames.
const FROM_SLAVE: u8 = b'B';

fn is_fast(map: &dyn Map) -> bool {
    map.bit(Class::M, M_HIGH_SPEED) == Some(true)
}

/// The area of master or slave.
fn block(of_master: bool, fast: bool) -> Block {
    let (relay, register) = if of_master { (800, 490) } else { (900, 500) };
    let (bits, words) = if fast { (0, 2) } else { (100, 10) };
    Block {
        bits: (relay, bits),
        words: (register, words),
    }
}

fn send(master: bool, map: &dyn Map, frame: &mut Frame) {
    let fast = is_fast(map);
    text::begin(if master { FROM_MASTER } else { FROM_SLAVE }, frame);
    frame.push(b'0' + u8::from(fast));
    block(master, fast).write(map, frame);
    text::end(frame);
}

pub(super) fn receive(
    link: &mut Link,
    master: bool,
    frame: &[u8],
    now_us: u32,
    map: &mut dyn Map,
) -> Result<(), LineFault> {
    let (kind, text) = text::open(frame)?;
    let fast = is_fast(map);
    let partner = if master { FROM_SLAVE } else { FROM_MASTER };
    match text {
        [mode, digits @ ..] if kind == partner && *mode == b'0' + u8::from(fast) => {
            block(!master, fast).read(digits, map)?;
        }
        _ => return Err(LineFault::Form),
    }
    link.waiting = false;
    link.polled = true;
    link.last_frame_us = now_us;
    set_relay(M_RUNNING, true, map);
    Ok(())
}

/// Reports a missing partner. It is reported once in each of its times.
fn supervise(link: &mut Link, now_us: u32, map: &mut dyn Map) -> Result<(), LineFault> {
    let time_ms = match u32::from(value(D_TIME_OUT, map)) {
        0 => USUAL_TIME_OUT_MS,
        time => time,
    };
    if now_us.wrapping_sub(link.last_frame_us) < 1000 * time_ms {
        return Ok(());
    }
    link.last_frame_us = now_us;
    set_relay(M_RUNNING, false, map);
    Err(LineFault::TimeOut)
}

pub(super) fn poll_master(
    link: &mut Link,
    now_us: u32,
    map: &mut dyn Map,
    frame: &mut Frame,
) -> Result<(), LineFault> {
    if !link.waiting || link.is_overdue(now_us, ASK_AGAIN_US) {
        send(true, map, frame);
        link.wait();
    }
    supervise(link, now_us, map)
}

pub(super) fn poll_slave(
    link: &mut Link,
    now_us: u32,
    map: &mut dyn Map,
    frame: &mut Frame,
) -> Result<(), LineFault> {
    if core::mem::take(&mut link.polled) {
        send(false, map, frame);
    }
    supervise(link, now_us, map)
}
