//! N:N link and enhanced N:N link: up to 8 or 16 PLCs that show each other their blocks (h1u-h2u-programming §5.4,
//! §5.5).

use super::{Block, Link, set_relay, set_value, text, value};
use crate::comm::{Frame, LineFault, Map, hex_digits};
use core::ops::RangeInclusive;

/// Own station, number of slaves and mode, as accepted.
const D_ACCEPTED: u32 = 8173;
/// Own station.
const D_STATION: u32 = 8176;
/// Number of slaves (master).
const D_SLAVES: u32 = 8177;
/// Mode (master).
const D_MODE: u32 = 8178;
/// Number of retries for a slave (master).
const D_RETRIES: u32 = 8179;
/// Time-out in units of 10 ms (master).
const D_TIME_OUT: u32 = 8180;
/// The same if the register holds 0.
const USUAL_TIME_OUT: u32 = 5;
/// Time of a round in units of 10 ms, as on FX; the longest one follows.
const D_ROUND: u32 = 8201;
/// Count of the errors of station 0; those of the other stations follow.
const D_COUNTS: u32 = 8203;
/// Code of the last error of station 0; those of the slaves follow. Enhanced N:N has counts there.
const D_CODES: u32 = 8211;
/// Transfer error of station 0; those of stations 1 to 7 follow.
const M_FAULTS: u32 = 8183;
/// Transfer error of station 8; those of stations 9 to 15 follow.
const M_MORE_FAULTS: u32 = 8310;
/// Transfer in progress.
const M_ACTIVE: u32 = 8191;
/// Relays that a link writes.
pub(in crate::comm) const RELAYS: [RangeInclusive<u32>; 2] =
    [M_FAULTS..=M_ACTIVE, M_MORE_FAULTS..=M_MORE_FAULTS + 7];
/// Registers that a link writes.
pub(in crate::comm) const REGISTERS: [RangeInclusive<u32>; 2] =
    [D_ACCEPTED..=D_ACCEPTED + 2, D_ROUND..=D_CODES + 7];

/// A station has not answered, or the master is not received; the codes are FX's.
const CODE_TIME_OUT: u16 = 0x01;
/// A slave misses the master.
const CODE_NO_MASTER: u16 = 0x11;
/// After so long without the master a slave reports it; the longest time-out that it can set is shorter.
const NO_MASTER_US: u32 = 3_000_000;

/// Limit of the error counts.
const MOST_ERRORS: u16 = 10_000;

/// Kind of a frame with a station's block.
const BLOCK: u8 = b'D';
/// Kind of a frame that asks for one.
const ASK: u8 = b'P';

/// The state of stations on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Net {
    enhanced: bool,
    /// `0` to `2`, or `E`.
    mode: u8,
    /// Number of slaves.
    slaves: u8,
}

impl Net {
    fn most(enhanced: bool) -> u8 {
        if enhanced { 15 } else { 7 }
    }

    /// As the master's registers say.
    fn of_master(enhanced: bool, map: &dyn Map) -> Self {
        let mode = match value(D_MODE, map) {
            _ if enhanced => b'E',
            mode @ (1 | 2) => b'0' + mode as u8,
            _ => b'0',
        };
        let slaves = value(D_SLAVES, map).min(Self::most(enhanced).into());
        Net {
            enhanced,
            mode,
            slaves: slaves as u8,
        }
    }

    /// As a frame says.
    fn of_frame(enhanced: bool, slaves: u8, mode: u8) -> Option<Self> {
        let is_mode = match mode {
            b'E' => enhanced,
            b'0'..=b'2' => !enhanced,
            _ => false,
        };
        (is_mode && slaves <= Self::most(enhanced)).then_some(Net {
            enhanced,
            mode,
            slaves,
        })
    }

    /// Block of a station.
    fn block(self, station: u8) -> Block {
        let k = u32::from(station);
        let (bits, words) = match self.mode {
            b'0' => (0, 4),
            b'1' => (32, 4),
            b'2' => (64, 8),
            _ => (64, 32),
        };
        if self.enhanced {
            Block {
                bits: (500 + 70 * k, bits),
                words: (200 + 40 * k, words),
            }
        } else {
            Block {
                bits: (1000 + 64 * k, bits),
                words: (10 * k, words),
            }
        }
    }

    /// Kind of frame, a station, and the state of the stations.
    fn begin(self, kind: u8, station: u8, frame: &mut Frame) {
        text::begin(kind, frame);
        frame.push_hex(station.into(), 1);
        frame.push_hex(self.slaves.into(), 1);
        frame.push(self.mode);
    }

    /// Makes the frame with a station's block.
    fn send_block(self, station: u8, map: &dyn Map, frame: &mut Frame) {
        self.begin(BLOCK, station, frame);
        self.block(station).write(map, frame);
        text::end(frame);
    }

    /// Shows what is accepted.
    fn show(self, station: u8, map: &mut dyn Map) {
        set_value(D_ACCEPTED, station.into(), map);
        set_value(D_ACCEPTED + 1, self.slaves.into(), map);
        if !self.enhanced {
            set_value(D_ACCEPTED + 2, (self.mode - b'0').into(), map);
        }
        set_relay(M_ACTIVE, true, map);
    }
}

/// Relay of a station's transfer error.
fn fault_relay(station: u8) -> u32 {
    match u32::from(station) {
        station @ 0..8 => M_FAULTS + station,
        station => M_MORE_FAULTS + station - 8,
    }
}

/// Counts an error of a station.
fn count(station: u8, enhanced: bool, code: u16, map: &mut dyn Map) {
    let counter = D_COUNTS + u32::from(station);
    let counted = value(counter, map).saturating_add(1).min(MOST_ERRORS);
    set_value(counter, counted, map);
    if !enhanced {
        set_value(D_CODES + u32::from(station), code, map);
    }
}

impl Link {
    fn is_missing(&self, station: u8) -> bool {
        self.missing >> station & 1 != 0
    }

    /// Notes whether a station answers.
    fn mark(&mut self, station: u8, missing: bool, map: &mut dyn Map) {
        self.missing = self.missing & !(1 << station) | u16::from(missing) << station;
        set_relay(fault_relay(station), missing, map);
    }
}

pub(super) fn receive(
    link: &mut Link,
    master: bool,
    enhanced: bool,
    frame: &[u8],
    now_us: u32,
    map: &mut dyn Map,
) -> Result<(), LineFault> {
    let (kind, text) = text::open(frame)?;
    let Some((head, rest)) = text.split_at_checked(3) else {
        return Err(LineFault::Form);
    };
    let digit = |at: usize| hex_digits(&head[at..at + 1]).map(|digit| digit as u8);
    let (Some(station), Some(slaves)) = (digit(0), digit(1)) else {
        return Err(LineFault::Unknown);
    };
    let net = Net::of_frame(enhanced, slaves, head[2]).ok_or(LineFault::Form)?;
    if station > Net::most(enhanced) {
        return Err(LineFault::Form);
    }
    if master {
        let is_expected = kind == BLOCK && link.waiting && station == link.station;
        // An answer that comes too late is not an error of the line.
        if !is_expected || net != Net::of_master(enhanced, map) {
            return Ok(());
        }
        net.block(station).read(rest, map)?;
        link.mark(station, false, map);
        link.waiting = false;
        link.station += 1;
        return Ok(());
    }
    let own = value(D_STATION, map);
    match kind {
        BLOCK if u16::from(station) != own => net.block(station).read(rest, map)?,
        ASK => {
            let faults = hex_digits(rest).filter(|_| rest.len() == 4);
            let faults = faults.ok_or(LineFault::Form)? as u16;
            for other in 0..=net.slaves {
                if u16::from(other) != own {
                    link.mark(other, faults >> other & 1 != 0, map);
                }
            }
            if own != 0 && u16::from(station) == own {
                link.polled = true;
                link.station = station;
                link.mode = net.mode;
                link.slaves = net.slaves;
                net.show(station, map);
            }
        }
        BLOCK => {}
        _ => return Err(LineFault::Form),
    }
    if kind == ASK || station == 0 {
        link.last_frame_us = now_us;
    }
    Ok(())
}

pub(super) fn poll_master(
    link: &mut Link,
    enhanced: bool,
    now_us: u32,
    map: &mut dyn Map,
    frame: &mut Frame,
) {
    let net = Net::of_master(enhanced, map);
    if link.waiting {
        let units = match u32::from(value(D_TIME_OUT, map)) {
            0 => USUAL_TIME_OUT,
            units => units,
        };
        if !link.is_overdue(now_us, 10_000 * units) {
            return;
        }
        let was_missing = link.is_missing(link.station);
        let retries = value(D_RETRIES, map);
        if !was_missing && u16::from(link.tries) < retries && link.tries < u8::MAX {
            link.tries += 1;
            return send_poll(link, net, frame);
        }
        if !was_missing {
            count(link.station, enhanced, CODE_TIME_OUT, map);
        }
        link.mark(link.station, true, map);
        link.waiting = false;
        link.station += 1;
    }
    if link.station == 0 || link.station > net.slaves {
        if link.station != 0 {
            let units = (now_us.wrapping_sub(link.round_us) / 10_000).min(0xffff) as u16;
            let longest = value(D_ROUND + 1, map).max(units);
            set_value(D_ROUND, units, map);
            set_value(D_ROUND + 1, longest, map);
        }
        link.round_us = now_us;
        link.station = 1;
        net.show(0, map);
        net.send_block(0, map, frame);
    } else {
        link.tries = 0;
        send_poll(link, net, frame);
    }
}

/// Asks the station whose turn it is.
fn send_poll(link: &mut Link, net: Net, frame: &mut Frame) {
    net.begin(ASK, link.station, frame);
    frame.push_hex(link.missing.into(), 4);
    text::end(frame);
    link.wait();
}

pub(super) fn poll_slave(
    link: &mut Link,
    enhanced: bool,
    now_us: u32,
    map: &mut dyn Map,
    frame: &mut Frame,
) {
    if core::mem::take(&mut link.polled) {
        if let Some(net) = Net::of_frame(enhanced, link.slaves, link.mode) {
            net.send_block(link.station, map, frame);
        }
        return;
    }
    if now_us.wrapping_sub(link.last_frame_us) >= NO_MASTER_US {
        link.last_frame_us = now_us;
        if !link.is_missing(0) {
            count(0, enhanced, CODE_NO_MASTER, map);
        }
        link.mark(0, true, map);
        set_relay(M_ACTIVE, false, map);
    }
}
