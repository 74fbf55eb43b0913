//! CANlink 3.0 (h1u-h2u-programming §5.9): the instructions that `[canlink]` of a project becomes. No PLC has them:
//! there, the configuration of the editor takes their place.

use crate::comm::CanFrame;
use crate::comm::can::{self, M_SEND_FAILED};
use crate::comm::canlink::{
    self, D_HEARTBEAT, D_STATES, D_STATION, Head, Kind, M_NETWORK, M_OWN_STATION, M_VERSION_1,
    M_WRONG_STATION, Network, STATIONS, TAKE_EFFECT, TOGETHER, WORDS,
};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::{Class, State, Sys};

/// Maximum number of registers of a CANPUT.
const MOST: i32 = 64;

/// A station, operand `i`.
fn station(cx: &Cx, i: usize) -> Result<u8, Fault> {
    let number = cx.count(i, 0..=STATIONS as i32 - 1)?;
    Ok(number as u8)
}

/// CANNET S1 S2 S3: this PLC is station S1 of a network whose master is station S2, with a heartbeat each S3 ms (0:
/// none). With M8284, D8284 is the station.
pub fn cannet(cx: &mut Cx) -> Done {
    let Sys {
        now_ms, first_scan, ..
    } = *cx.plc.sys();
    let master = station(cx, 1)?;
    let heartbeat_ms = cx.word(2, 0)? as u16;
    let own = match M_OWN_STATION.is_on(cx.plc) {
        true => D_STATION.value(cx.plc).try_into().unwrap_or(0),
        false => station(cx, 0)?,
    };
    let fits = (1..STATIONS).contains(&usize::from(own));
    M_WRONG_STATION.set(cx.plc, !fits);
    let own = match fits && !M_VERSION_1.is_on(cx.plc) {
        true => own,
        false => 0,
    };
    let Some(mut network) = Network::of(cx.plc) else {
        return Ok(());
    };
    if first_scan {
        network.begin();
    }
    network.set_up(own, master, heartbeat_ms);
    let beats = network.beats(now_ms) && own != 0;
    if first_scan && own == master {
        M_NETWORK.set(cx.plc, true);
    }
    D_HEARTBEAT.set(cx.plc, heartbeat_ms);
    if fits {
        D_STATION.set(cx.plc, own.into());
    }
    if beats {
        beat(cx, own, own == master);
    }
    show_states(cx, master, now_ms);
    Ok(())
}

/// Sends a heartbeat; one that the bus does not take is lost, and the next one follows.
fn beat(cx: &mut Cx, own: u8, is_master: bool) {
    let head = Head {
        kind: Kind::Heartbeat,
        sender: own,
        receiver: 0,
        register: 0,
    };
    let runs = !is_master || M_NETWORK.is_on(cx.plc);
    let frame = frame(head, &[u8::from(runs)]);
    let now_us = cx.plc.sys().now_us();
    let sent = can::send(cx.hal(), &frame, now_us);
    M_SEND_FAILED.set(cx.plc, !sent);
}

/// Shows which stations are there: the master all of its slaves, a slave its master.
fn show_states(cx: &mut Cx, master: u8, now_ms: u32) {
    for station in 1..STATIONS as u8 {
        let Some(network) = Network::of(cx.plc) else {
            return;
        };
        let Some(state) = network.state(station, now_ms) else {
            continue;
        };
        let of_master = !network.is_master() && station == master;
        let number = D_STATES + if of_master { 0 } else { station.into() };
        // A register that the program does not use shows nothing.
        let _ = cx.plc.set_word(Class::D, number, state);
    }
}

/// CANNODE S1 S2: what station S1 is to this one: bit 0, a slave that the master watches; bit 1, what it sends to all
/// is for this one, too.
pub fn cannode(cx: &mut Cx) -> Done {
    let (number, roles) = (station(cx, 0)?, cx.word(1, 0)? as u8);
    if let Some(mut network) = Network::of(cx.plc) {
        network.set_roles(number, roles);
    }
    Ok(())
}

/// CANPUT S1 D S2 S3 n: sends n registers from D on to register S3 of a station, each S1 ms while it is driven, or,
/// where S1 is 0, in each scan that drives it. The low byte of S2 is the station, 0 all that listen; its high byte is
/// 0, or 1: the words wait for the command that they take effect; 2: this command; 3: the command that all send what is
/// to be sent together.
pub fn canput(cx: &mut Cx) -> Done {
    let Sys { now_ms, scan, .. } = *cx.plc.sys();
    if !canlink::runs(cx.plc) {
        *cx.state() = State::new();
        return Ok(());
    }
    let drive = cx.drive();
    let every = u32::from(cx.word(0, 0)? as u16);
    let count = cx.count(4, 0..=MOST)?;
    let head = head(cx)?;
    let [next, last_ms, waits, ..] = &mut cx.state().0;
    let is_time = *waits == 0 || now_ms.wrapping_sub(*last_ms as u32) >= every;
    *waits = drive.into();
    if *next == 0 && drive && is_time {
        (*next, *last_ms) = (1, now_ms as i32);
    }
    // Frames rejected by the bus are sent in the next scan, whether or not that drives the instruction.
    while let Some(first) = cx.state().0[0].checked_sub(1).filter(|first| *first >= 0) {
        if !send(cx, head, first, count, scan)? {
            break;
        }
        let next = first + WORDS as i32;
        cx.state().0[0] = if next < count { next + 1 } else { 0 };
    }
    Ok(())
}

/// Head of a frame of CANPUT: its kind and receiver.
fn head(cx: &mut Cx) -> Result<Head, Fault> {
    let [what, receiver] = (cx.word(2, 0)? as u16).to_be_bytes();
    let register = cx.word(3, 0)? as u16;
    let own = Network::of(cx.plc).map_or(0, |network| network.station());
    let (kind, register) = match what {
        0 => (Kind::Words, register),
        1 => (Kind::Waits, register),
        2 => (Kind::Command, TAKE_EFFECT),
        3 => (Kind::Command, TOGETHER),
        _ => return Err(Fault::VALUE),
    };
    Ok(Head {
        kind,
        sender: own,
        receiver: if receiver == 0 { own } else { receiver & 0x3f },
        register,
    })
}

/// Sends up to four words from word `first` on; false if the bus does not take them now.
fn send(cx: &mut Cx, head: Head, first: i32, count: i32, scan: u16) -> Result<bool, Fault> {
    if Network::of(cx.plc).is_none_or(|network| network.has_refused(scan)) {
        return Ok(false);
    }
    let words = (count - first).clamp(0, WORDS as i32);
    let mut data = [0; 2 * WORDS];
    for (n, place) in (0..words).zip(data.chunks_exact_mut(2)) {
        place.copy_from_slice(&cx.word(1, first + n)?.to_be_bytes());
    }
    let head = Head {
        register: head.register.wrapping_add(first as u16),
        ..head
    };
    let data = data.get(..2 * words as usize).unwrap_or_default();
    let now_us = cx.plc.sys().now_us();
    let sent = can::send(cx.hal(), &frame(head, data), now_us);
    M_SEND_FAILED.set(cx.plc, !sent);
    if let (false, Some(mut network)) = (sent, Network::of(cx.plc)) {
        network.refuse(scan);
    }
    Ok(sent)
}

/// A frame with up to eight bytes.
fn frame(head: Head, bytes: &[u8]) -> CanFrame {
    let mut frame = CanFrame {
        id: head.id(),
        len: bytes.len() as u8,
        ..CanFrame::new()
    };
    for (place, &byte) in frame.data.iter_mut().zip(bytes) {
        *place = byte;
    }
    frame
}
