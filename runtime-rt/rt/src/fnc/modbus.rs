//! Modbus masters: MODBUS, MODBUS2 and RS of H1U and H2U (h1u-h2u-programming §5.7.1), RD3A, WR3A and ADPRW of L01S
//! (l01s-programming §8.1), MRDC to MWRDS of HM (hm-motion-controller §6.4.3), IVRD and IVWR of compatible boards.
//!
//! All hand a [`Job`] to the port when their turn comes, and learn in a later scan how the exchange has ended
//! ([`Exchange`]).
//!
//! [`Exchange`]: crate::comm::modbus::Exchange

use crate::comm::modbus::{Buffer, End, Exchange, Job, Layout, Visit};
use crate::comm::{D_ADPRW_PORT, PortWiring, Progress, Protocol};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::operand::OperandKind;
use crate::plc::Sys;
use crate::special::{M_COMPLETE, Relay};

/// State of an instruction that the scan has reached.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Turn {
    /// It has handed over its job.
    Begun,
    /// Its exchange has ended.
    Over(End),
    /// Neither.
    None,
}

/// Identifier of the instruction at a step for its port.
fn owner(step: u32) -> u32 {
    step + 1
}

/// Works on port `number`: hands over the job of the instruction if it is its turn, and learns how it ended.
fn work(cx: &mut Cx, number: u8, job: fn(&Cx) -> Result<Job, Fault>) -> Result<Turn, Fault> {
    let (owner, driven) = (owner(cx.site.step), cx.site.drive);
    let Sys {
        scan, first_scan, ..
    } = *cx.plc.sys();
    let Some(port) = cx.plc.port(number) else {
        return Ok(Turn::None);
    };
    if !port.status.protocol.is_master() {
        // The set-up of the first scan is bound at its end.
        if driven && (port.status.bound || !first_scan) {
            cx.note_other_protocol(number);
        }
        return Ok(Turn::None);
    }
    let Some(Progress { exchange, .. }) = port.progress else {
        return Ok(Turn::None);
    };
    match exchange.visit(owner, driven) {
        Visit::Pass => Ok(Turn::None),
        Visit::Over(end) => {
            exchange.reported_in = scan;
            Ok(Turn::Over(end))
        }
        Visit::Turn => {
            let reported_in = exchange.reported_in;
            let Some(wiring) = wiring(cx, number) else {
                return Ok(Turn::None);
            };
            let gap = wiring.gap_scans(cx.plc);
            // Scans are numbered by odd numbers.
            if reported_in != 0 && scan.wrapping_sub(reported_in) / 2 < gap {
                return Ok(Turn::None);
            }
            let job = job(cx)?;
            let modbus = wiring.modbus;
            let time_out_us = match job.is_answered() {
                true => wiring.answer_time_out_us(cx.plc),
                false => modbus.map_or(0, |modbus| modbus.after_broadcast_us(cx.plc)),
            };
            let retries = modbus.map_or(0, |modbus| modbus.retries(cx.plc));
            if let Some(exchange) = exchange_of(cx, number) {
                exchange.begin(owner, job, time_out_us, retries);
            }
            Ok(Turn::Begun)
        }
    }
}

/// Exchange of a port for the instructions of a master.
fn exchange_of<'a>(cx: &'a mut Cx, number: u8) -> Option<&'a mut Exchange> {
    let progress = cx.plc.port(number)?.progress?;
    Some(&mut progress.exchange)
}

/// The special devices that a port has now.
fn wiring(cx: &Cx, number: u8) -> Option<&'static PortWiring> {
    PortWiring::of(cx.plc, number)
}

/// A special relay of a port, by its number there; 0: there is none.
fn show(cx: &mut Cx, number: u8, relay: fn(&PortWiring) -> Option<Relay>, on: bool) {
    if let Some(relay) = wiring(cx, number).and_then(relay) {
        relay.set(cx.plc, on);
    }
}

/// Operand `i` as an unsigned word.
fn unsigned(cx: &Cx, i: usize) -> Result<u16, Fault> {
    Ok(cx.word(i, 0)? as u16)
}

/// Operand `i` as a number of one byte.
fn byte(cx: &Cx, i: usize) -> Result<u8, Fault> {
    u8::try_from(cx.word(i, 0)?).map_err(|_| Fault::VALUE)
}

/// Operand `i` and the devices after it.
fn buffer(cx: &Cx, i: usize) -> Result<Buffer, Fault> {
    let op = *cx.ops.get(i).ok_or(Fault::DEVICE)?;
    let first = op.value as u32;
    let layout = match op.kind {
        OperandKind::Const => Layout::Constant,
        OperandKind::Device if cx.is_bit(i) => Layout::Bits,
        OperandKind::Device => Layout::Words,
        _ => return Err(Fault::DEVICE),
    };
    Ok(Buffer {
        class: op.class,
        layout,
        first,
    })
}

/// Station and function are in one operand, address, number and data in the next three.
fn station_and_function(cx: &Cx) -> Result<Job, Fault> {
    let [station, function] = unsigned(cx, 0)?.to_be_bytes();
    Ok(Job {
        station,
        function,
        address: unsigned(cx, 1)?,
        count: unsigned(cx, 2)?,
        buffer: buffer(cx, 3)?,
    })
}

/// MODBUS S1 S2 n D (FNC 89): one exchange after the other while it is driven, on COM1.
pub fn modbus(cx: &mut Cx) -> Done {
    let number = cx.plc.ports().of_rs();
    inovance(cx, number)
}

/// MODBUS2 S1 S2 n D n1 (FNC 93): the same on port n1.
pub fn modbus2(cx: &mut Cx) -> Done {
    match cx.named_port(4)? {
        Some(number) => inovance(cx, number),
        None => Ok(()),
    }
}

/// Shows that an instruction is in work (M8122), and how it ended (M8123).
fn inovance(cx: &mut Cx, number: u8) -> Done {
    match work(cx, number, station_and_function)? {
        Turn::Begun => show(cx, number, |wiring| wiring.sends, true),
        Turn::Over(end) => {
            show(cx, number, |wiring| wiring.sends, false);
            show(cx, number, |wiring| wiring.done, end != End::Well);
        }
        Turn::None => {}
    }
    Ok(())
}

/// IVRD S1 S2 D n (FNC 272) of compatible boards: reads; of coils the first byte goes to the high half of D.
pub fn ivrd(cx: &mut Cx) -> Done {
    board(cx)
}

/// IVWR S1 S2 S3 n (FNC 273) of compatible boards: writes; the end resets the request to send.
pub fn ivwr(cx: &mut Cx) -> Done {
    board(cx)
}

fn board(cx: &mut Cx) -> Done {
    let number = cx.plc.ports().of_rs();
    let job = |cx: &Cx| {
        let [station, function] = unsigned(cx, 0)?.to_be_bytes();
        let buffer = buffer(cx, 2)?;
        let layout = match buffer.layout {
            Layout::Words => Layout::HighFirst,
            other => other,
        };
        Ok(Job {
            station,
            function,
            address: unsigned(cx, 1)?,
            count: unsigned(cx, 3)?,
            buffer: Buffer { layout, ..buffer },
        })
    };
    if let Turn::Over(end) = work(cx, number, job)? {
        show(cx, number, |wiring| wiring.sends, false);
        if end == End::Well {
            show(cx, number, |wiring| wiring.done, true);
        }
    }
    Ok(())
}

/// Station, function, address, number and data are in an operand each.
fn adprw_job(cx: &Cx) -> Result<Job, Fault> {
    Ok(Job {
        station: byte(cx, 0)?,
        function: byte(cx, 1)?,
        address: unsigned(cx, 2)?,
        count: unsigned(cx, 3)?,
        buffer: buffer(cx, 4)?,
    })
}

/// ADPRW S S1 S2 S3 D (FNC 276) of L01S, on the port that D8397 names. M8029 is on when it has ended, until the program
/// resets it or the next one is executed. A port that asks in ASCII does not serve it (l01s-programming §8.2.6,
/// §8.3.5).
pub fn adprw(cx: &mut Cx) -> Done {
    let port = D_ADPRW_PORT.value(cx.plc) as i16;
    let Some(number) = l01s_port(cx, port)? else {
        return Ok(());
    };
    let port = cx.plc.port(number);
    if port.is_some_and(|port| port.status.protocol == Protocol::MasterAscii) {
        return Ok(());
    }
    let turn = work(cx, number, adprw_job)?;
    let over = matches!(turn, Turn::Over(_));
    if over || cx.drive() {
        cx.set_special(M_COMPLETE, over);
    }
    Ok(())
}

/// ADPRW S S1 S2 S3 D (FNC 276) of FX3, on the channel that D8401 or D8421 makes a master. M8029 is on for
/// a scan when it has ended, well or not.
pub fn adprw_fx3(cx: &mut Cx) -> Done {
    let number = match master(cx) {
        Some(number) => number,
        None => return Ok(()),
    };
    let turn = work(cx, number, adprw_job)?;
    let modbus = wiring(cx, number).and_then(|wiring| wiring.modbus);
    let Some(modbus) = modbus else {
        return Ok(());
    };
    let step = cx.site.step as u16;
    match turn {
        Turn::Begun => {
            modbus.busy().set(cx.plc, true);
            for relay in [modbus.failed(), modbus.tried(), modbus.late()] {
                relay.set(cx.plc, false);
            }
            modbus.tries().set(cx.plc, 0);
            modbus.step().set(cx.plc, step);
        }
        Turn::Over(end) => {
            modbus.busy().set(cx.plc, false);
            modbus.late().set(cx.plc, end == End::Late);
        }
        Turn::None => {}
    }
    let scan = cx.plc.sys().scan;
    let reported_in = exchange_of(cx, number).map_or(0, |exchange| exchange.reported_in);
    // Scans are numbered by odd numbers.
    let ended_before = reported_in != 0 && scan.wrapping_sub(reported_in) == 2;
    match turn {
        Turn::Over(_) => cx.set_special(M_COMPLETE, true),
        _ if ended_before || cx.drive() && reported_in != scan => cx.set_special(M_COMPLETE, false),
        _ => {}
    }
    Ok(())
}

/// The channel of FX3 that is a master of Modbus; the first one if none is.
fn master(cx: &mut Cx) -> Option<u8> {
    let channels = cx.plc.ports().all().iter();
    let mut channels = channels.filter(|wiring| wiring.sets().any(|set| set.modbus.is_some()));
    let numbers = [channels.next(), channels.next()];
    let mut numbers = numbers.into_iter().flatten().map(|wiring| wiring.number);
    let first = numbers.next()?;
    let is_master = |cx: &mut Cx, number: u8| {
        let port = cx.plc.port(number);
        port.is_some_and(|port| port.status.protocol.is_master())
    };
    if is_master(cx, first) {
        return Some(first);
    }
    let other = numbers.find(|&number| is_master(cx, number));
    Some(other.unwrap_or(first))
}

/// The port that a register names: 0 for port 2, 1 for port 3. Another value is an error of an instruction that is
/// driven.
fn l01s_port(cx: &Cx, named: i16) -> Result<Option<u8>, Fault> {
    match cx.plc.ports().named(named.into()) {
        None if cx.drive() => Err(Fault::VALUE),
        number => Ok(number),
    }
}

/// Functions of RD3A and WR3A.
const READ: u8 = 0x03;
const WRITE_ONE: u8 = 0x06;
const WRITE: u8 = 0x10;

/// RD3A m1 m2 D (FNC 176) of L01S: reads as many registers as D says to the registers after it; the port precedes it.
pub fn rd3a_modbus(cx: &mut Cx) -> Done {
    l01s(cx, |cx| l01s_job(cx, READ))
}

/// WR3A m1 m2 S (FNC 177) of L01S: writes as many registers as S says from the registers after it; the port precedes
/// it.
pub fn wr3a_modbus(cx: &mut Cx) -> Done {
    l01s(cx, |cx| {
        let function = match cx.word(2, 0)? {
            1 => WRITE_ONE,
            _ => WRITE,
        };
        l01s_job(cx, function)
    })
}

fn l01s_job(cx: &Cx, function: u8) -> Result<Job, Fault> {
    let counted = buffer(cx, 2)?;
    Ok(Job {
        station: byte(cx, 0)?,
        function,
        address: unsigned(cx, 1)?,
        count: unsigned(cx, 2)?,
        buffer: Buffer {
            first: counted.first.saturating_add(1),
            ..counted
        },
    })
}

/// Shows a good answer (M8128, M8408) or none (M8129, M8409) until the next scan.
fn l01s(cx: &mut Cx, job: fn(&Cx) -> Result<Job, Fault>) -> Done {
    let port = cx.word(2, -1)?;
    let Some(number) = l01s_port(cx, port)? else {
        return Ok(());
    };
    let scan = cx.plc.sys().scan;
    let reported_in = exchange_of(cx, number).map_or(0, |exchange| exchange.reported_in);
    if reported_in != 0 && reported_in != scan {
        show(cx, number, |wiring| wiring.answered, false);
        show(cx, number, |wiring| wiring.late, false);
    }
    if let Turn::Over(end) = work(cx, number, job)? {
        show(cx, number, |wiring| wiring.answered, end == End::Well);
        show(cx, number, |wiring| wiring.late, end == End::Late);
    }
    Ok(())
}

/// Job of an instruction of HM: station, address, number if there is one, data.
fn hm_job(cx: &Cx, function: u8, several: bool) -> Result<Job, Fault> {
    let data = if several { 3 } else { 2 };
    Ok(Job {
        station: byte(cx, 0)?,
        function,
        address: unsigned(cx, 1)?,
        count: if several { unsigned(cx, 2)? } else { 1 },
        buffer: buffer(cx, data)?,
    })
}

/// An instruction of HM that finds its port busy waits, however briefly it was driven.
fn hm(cx: &mut Cx, port: usize, job: fn(&Cx) -> Result<Job, Fault>) -> Done {
    const WAITS: usize = 0;
    let Some(number) = cx.named_port(port)? else {
        return Ok(());
    };
    let (step, driven) = (cx.site.step, cx.site.drive);
    cx.site.drive = driven || cx.state().0[WAITS] != 0;
    let turn = work(cx, number, job);
    let exchange = exchange_of(cx, number);
    let taken = exchange.is_some_and(|exchange| exchange.works_for_another(owner(step)));
    let waits = cx.site.drive && taken && turn == Ok(Turn::None);
    cx.site.drive = driven;
    cx.state().0[WAITS] = waits.into();
    turn.map(drop)
}

/// MRDC S1 S2 S3 D1 D2 (HM): reads coils.
pub fn mrdc(cx: &mut Cx) -> Done {
    hm(cx, 4, |cx| hm_job(cx, 0x01, true))
}

/// MRDI S1 S2 S3 D1 D2 (HM): reads inputs.
pub fn mrdi(cx: &mut Cx) -> Done {
    hm(cx, 4, |cx| hm_job(cx, 0x02, true))
}

/// MRDD S1 S2 S3 D1 D2 (HM): reads registers.
pub fn mrdd(cx: &mut Cx) -> Done {
    hm(cx, 4, |cx| hm_job(cx, 0x03, true))
}

/// MRDAI S1 S2 S3 D1 D2 (HM): reads input registers.
pub fn mrdai(cx: &mut Cx) -> Done {
    hm(cx, 4, |cx| hm_job(cx, 0x04, true))
}

/// MWRC S1 S2 D1 D2 (HM): writes a coil.
pub fn mwrc(cx: &mut Cx) -> Done {
    hm(cx, 3, |cx| hm_job(cx, 0x05, false))
}

/// MWRD S1 S2 D1 D2 (HM): writes a register.
pub fn mwrd(cx: &mut Cx) -> Done {
    hm(cx, 3, |cx| hm_job(cx, 0x06, false))
}

/// MWRCS S1 S2 S3 D1 D2 (HM): writes coils.
pub fn mwrcs(cx: &mut Cx) -> Done {
    hm(cx, 4, |cx| hm_job(cx, 0x0f, true))
}

/// MWRDS S1 S2 S3 D1 D2 (HM): writes registers.
pub fn mwrds(cx: &mut Cx) -> Done {
    hm(cx, 4, |cx| hm_job(cx, 0x10, true))
}
