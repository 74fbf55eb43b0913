//! CAM of HM (hm-motion-controller §8.4.2): an axis that follows a master along a curve while it is engaged.
//!
//! A cycle begins where the cam engages: there the master's phase is 0. It ends at the master's range, or earlier where
//! the cam disengages. The next cycle, or the travel before it, is measured from that place, so that no increment of
//! the master is lost.
//!
//! The manual leaves open, and this module chooses:
//! - A master that runs backwards takes the axis back along the curve, at most to the start of the cycle.
//! - The travel before a later cycle begins where the cycle before it ended: a disengage phase and a cycle offset
//!   together make the length of the material, as the manual's advice on cutting to length says.
//! - The auxiliary axis (+28 to +30) adds its own travel, times its gear, to the phase, as the phase compensation does.
//! - The state (+24) is shown while the instruction runs, and stays when its drive goes off, so that a program can
//!   resume from it.
//! - Output bits hold their state until the phase reaches the first row of the event table.
//!
//! Memory: words 0 and 1 see `axis_registers`, words 2 and 5 `axis_follow`; word 3 the master's value at phase 0, word
//! 4 the flags and the rest of the auxiliary gear, words 6 and 7 the phase compensation and the auxiliary axis before.

use super::axis_follow::{PENDING, PLACE, go_to, hand_over, long, word};
use super::axis_registers::{Registers, motion};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::plc::Class;

/// Words of the memory.
const ZERO: usize = 3;
const FLAGS: usize = 4;
const COMPENSATION: usize = 6;
const AUXILIARY: usize = 7;

/// Bits of [`FLAGS`]; the high half of the word is the rest of the auxiliary gear.
mod flag {
    pub const ENGAGED: i32 = 1;
    /// The first cycle is over.
    pub const LATER: i32 = 2;
    /// The engage input has come; what is left is the travel before the cycle.
    pub const ARMED: i32 = 4;
    /// The disengage input has come; what is left is the way to the disengage phase.
    pub const RELEASED: i32 = 8;
}

/// Operands.
const TABLE: usize = 1;
const MASTER: usize = 2;
const RANGE: usize = 3;
const BLOCK: usize = 4;

/// Words of the parameter block.
mod at {
    pub const COMPENSATION: i32 = 0;
    pub const FIRST_OFFSET: i32 = 2;
    pub const CYCLE_OFFSET: i32 = 4;
    pub const DISENGAGE_PHASE: i32 = 6;
    pub const PHASE: i32 = 12;
    pub const ENGAGE_MODE: i32 = 14;
    pub const ENGAGE_INPUT: i32 = 15;
    pub const ENGAGE_POLARITY: i32 = 16;
    pub const DISENGAGE_MODE: i32 = 17;
    pub const DISENGAGE_INPUT: i32 = 18;
    pub const DISENGAGE_POLARITY: i32 = 19;
    pub const EVENTS: i32 = 20;
    pub const EVENT_COUNT: i32 = 21;
    pub const EVENT_OUTPUT: i32 = 22;
    pub const EVENT_MASK: i32 = 23;
    pub const STATE: i32 = 24;
    pub const INITIAL_STATE: i32 = 25;
    pub const INITIAL_PHASE: i32 = 26;
    pub const GEAR_SOURCE: i32 = 28;
    pub const GEAR_TOP: i32 = 29;
    pub const GEAR_BOTTOM: i32 = 30;
}

/// Bits of an engage or disengage mode: it waits for an input, it goes by the travel or the phase.
const BY_INPUT: i16 = 1;
const BY_PHASE: i16 = 2;

/// Maximum number of cycles that may end in one scan; the distance of a master that has moved on further is made up in
/// the next scans.
const MOST_CYCLES: u32 = 16;

/// CAM D1 D2 D3 D4 D5: axis D1 follows the table D2 while the master D3 moves through the range D4, and engages and
/// disengages as the block D5 says. It stops at once with its drive.
pub fn axis_cam(cx: &mut Cx) -> Done {
    motion(cx, 0, true, &begin, &go_on)
}

fn begin(cx: &mut Cx, axis: Registers) -> Done {
    let first = cx.dword(TABLE, 2)?;
    let phase = cx.dword(BLOCK, at::INITIAL_PHASE)?;
    let mode = cx.word(BLOCK, at::ENGAGE_MODE)?;
    let engaged = cx.word(BLOCK, at::INITIAL_STATE)? == 1 || (phase > 0 && mode & BY_PHASE == 0);
    let flags = match (engaged, phase > 0 && mode == BY_INPUT | BY_PHASE) {
        (true, _) => flag::ENGAGED,
        (false, true) => flag::ARMED,
        (false, false) => 0,
    };
    let zero = cx.dword(MASTER, 0)?.wrapping_sub(phase);
    let compensation = compensation(cx)?;
    let auxiliary = auxiliary(cx)?;
    let state = cx.state();
    state.0[PENDING] = 0;
    state.0[ZERO] = zero;
    state.0[FLAGS] = flags;
    state.0[PLACE] = first;
    state.0[COMPENSATION] = compensation;
    state.0[AUXILIARY] = auxiliary;
    if engaged {
        // The axis is where the curve is at this phase.
        follow(cx, phase.into())?;
    }
    axis.take(cx)
}

fn go_on(cx: &mut Cx, axis: Registers) -> Done {
    let added = added_phase(cx)?;
    let mut pulses = 0;
    let phase = match enters_by(cx, added)? {
        true => engage(cx).map(|()| 0)?,
        false => {
            let zero = &mut cx.state().0[ZERO];
            *zero = zero.wrapping_sub(added);
            advance(cx, axis, &mut pulses)?
        }
    };
    cx.set_dword(BLOCK, at::PHASE, phase)?;
    let engaged = has(cx, flag::ENGAGED);
    cx.set_word(BLOCK, at::STATE, engaged.into())?;
    let pulses = pulses.clamp(i64::from(i32::MIN), i64::from(i32::MAX));
    hand_over(cx, axis, pulses as i32)
}

/// Goes through the cycles that the master has passed, at most [`MOST_CYCLES`]; the phase that is to be shown.
fn advance(cx: &mut Cx, axis: Registers, pulses: &mut i64) -> Result<i32, Fault> {
    let range = cx.dword(RANGE, 0)?;
    for _ in 0..MOST_CYCLES {
        if !has(cx, flag::ENGAGED) {
            let travelled = travel(cx, axis)?;
            if let Some(travelled) = travelled {
                return Ok(travelled);
            }
            engage(cx)?;
        }
        let phase = phase(cx)?.max(0);
        let end = end_of_cycle(cx, axis, phase)?.min(range);
        *pulses += follow(cx, phase.min(end).into())?;
        if phase < end {
            return Ok(phase);
        }
        let state = cx.state();
        state.0[ZERO] = state.0[ZERO].wrapping_add(end);
        clear(cx, flag::ENGAGED | flag::RELEASED);
        set(cx, flag::LATER);
        if end == 0 {
            // A cycle without length would begin again and again.
            return Ok(0);
        }
    }
    Ok(0)
}

/// Distance that the master has travelled while the cam waits to engage; `None` once it engages.
fn travel(cx: &mut Cx, axis: Registers) -> Result<Option<i32>, Fault> {
    let mode = cx.word(BLOCK, at::ENGAGE_MODE)?;
    if mode & BY_INPUT != 0 && !has(cx, flag::ARMED) {
        // Travel of the master before the input comes does not count.
        cx.state().0[ZERO] = cx.dword(MASTER, 0)?;
        if !sees(cx, axis, at::ENGAGE_INPUT, at::ENGAGE_POLARITY)? {
            return Ok(Some(0));
        }
        set(cx, flag::ARMED);
    }
    if mode & BY_PHASE == 0 {
        return Ok(None);
    }
    let (offset, travelled) = (offset(cx)?, phase(cx)?);
    if travelled < offset {
        return Ok(Some(travelled));
    }
    let zero = &mut cx.state().0[ZERO];
    *zero = zero.wrapping_add(offset);
    Ok(None)
}

/// The travel before the cycle that is waited for.
fn offset(cx: &mut Cx) -> Result<i32, Fault> {
    let later = cx.state().0[FLAGS] & flag::LATER != 0;
    let place = if later {
        at::CYCLE_OFFSET
    } else {
        at::FIRST_OFFSET
    };
    cx.dword(BLOCK, place).map(|offset| offset.max(0))
}

/// Returns true if only the addition to the phase ends the travel before a cycle: then the cycle begins with phase 0,
/// whatever is left over.
fn enters_by(cx: &mut Cx, added: i32) -> Result<bool, Fault> {
    let mode = cx.word(BLOCK, at::ENGAGE_MODE)?;
    let waits = !has(cx, flag::ENGAGED) && mode & BY_PHASE != 0;
    if !waits || added <= 0 || (mode & BY_INPUT != 0 && !has(cx, flag::ARMED)) {
        return Ok(false);
    }
    let (offset, travelled) = (i64::from(offset(cx)?), i64::from(phase(cx)?));
    let enters = travelled < offset && travelled + i64::from(added) >= offset;
    if enters {
        cx.state().0[ZERO] = cx.dword(MASTER, 0)?;
    }
    Ok(enters)
}

/// A cycle begins, at the first point of the table.
fn engage(cx: &mut Cx) -> Done {
    cx.state().0[PLACE] = cx.dword(TABLE, 2)?;
    clear(cx, flag::ARMED);
    set(cx, flag::ENGAGED);
    Ok(())
}

/// The phase at which the cam disengages, as far as it is known; beyond the range the range counts.
fn end_of_cycle(cx: &mut Cx, axis: Registers, phase: i32) -> Result<i32, Fault> {
    let mode = cx.word(BLOCK, at::DISENGAGE_MODE)?;
    let by_phase = cx.dword(BLOCK, at::DISENGAGE_PHASE)?.max(0);
    let input =
        mode & BY_INPUT != 0 && sees(cx, axis, at::DISENGAGE_INPUT, at::DISENGAGE_POLARITY)?;
    Ok(match (mode & BY_PHASE != 0, mode & BY_INPUT != 0) {
        (false, true) if input => phase,
        (true, false) => by_phase,
        (true, true) if has(cx, flag::RELEASED) => by_phase,
        (true, true) if input => {
            set(cx, flag::RELEASED);
            by_phase.max(phase)
        }
        _ => i32::MAX,
    })
}

/// Takes the axis to this phase of the curve, and the outputs to that of the event table; the pulses on the way.
fn follow(cx: &mut Cx, phase: i64) -> Result<i64, Fault> {
    let steps = i64::from(cx.dword(TABLE, 0)?) - 1;
    let range = i64::from(cx.dword(RANGE, 0)?);
    if steps < 1 || range < 1 {
        return Err(Fault::VALUE);
    }
    let pulses = go_to(cx, steps, phase.clamp(0, range), range)?;
    events(cx, phase)?;
    Ok(pulses.into())
}

/// Writes the output word of the last row that the phase has reached.
fn events(cx: &mut Cx, phase: i64) -> Done {
    let first = register(cx.word(BLOCK, at::EVENTS)?)?;
    let count = u32::try_from(cx.word(BLOCK, at::EVENT_COUNT)?).unwrap_or(0);
    let mut reached = None;
    for row in (0..count).map(|row| first + 3 * row) {
        if i64::from(long(cx, row)?) <= phase {
            reached = Some(word(cx, row + 2)?);
        }
    }
    let Some(output) = reached else {
        return Ok(());
    };
    let mask = cx.word(BLOCK, at::EVENT_MASK)? as u16;
    let (class, number) = bits(cx.word(BLOCK, at::EVENT_OUTPUT)?)?;
    for n in (0..16).filter(|n| mask >> n & 1 == 1) {
        let on = output as u16 >> n & 1 == 1;
        cx.plc.set_bit(class, number + n, on).ok_or(Fault::DEVICE)?;
    }
    Ok(())
}

/// The first of sixteen bit devices by its code.
fn bits(code: i16) -> Result<(Class, u32), Fault> {
    let code = u32::from(code as u16);
    let (class, number) = match code {
        0..=255 => (Class::Y, code),
        1000..=1255 => (Class::X, code - 1000),
        2000..=2255 => (Class::T, code - 2000),
        3000..=3255 => (Class::C, code - 3000),
        4000..=4255 => (Class::M, code + 4000),
        5000..=5999 => (Class::S, code - 5000),
        10000..=13071 => (Class::M, code - 10000),
        _ => return Err(Fault::VALUE),
    };
    match number % 16 {
        0 => Ok((class, number)),
        _ => Err(Fault::VALUE),
    }
}

/// Addition to the phase in this scan: by its compensation, and by the auxiliary axis times its gear.
fn added_phase(cx: &mut Cx) -> Result<i32, Fault> {
    let (compensation, auxiliary) = (compensation(cx)?, auxiliary(cx)?);
    let state = cx.state();
    let by_hand =
        compensation.wrapping_sub(core::mem::replace(&mut state.0[COMPENSATION], compensation));
    let moved = auxiliary.wrapping_sub(core::mem::replace(&mut state.0[AUXILIARY], auxiliary));
    let top = i64::from(cx.word(BLOCK, at::GEAR_TOP)?);
    let bottom = i64::from(cx.word(BLOCK, at::GEAR_BOTTOM)?);
    if bottom == 0 {
        return Ok(by_hand);
    }
    let whole = i64::from(moved) * top + i64::from(cx.state().0[FLAGS] >> 16);
    let flags = &mut cx.state().0[FLAGS];
    *flags = (whole.rem_euclid(bottom) as i32) << 16 | *flags & 0xFFFF;
    Ok(by_hand.wrapping_add(whole.div_euclid(bottom) as i32))
}

/// The value of the phase compensation, in the pair of registers that the block names.
fn compensation(cx: &Cx) -> Result<i32, Fault> {
    let named = register(cx.word(BLOCK, at::COMPENSATION)?)?;
    long(cx, named)
}

/// The position of the auxiliary axis, in the device that the block names by its code.
fn auxiliary(cx: &Cx) -> Result<i32, Fault> {
    let code = u32::from(cx.word(BLOCK, at::GEAR_SOURCE)? as u16);
    let counted = |class, number| cx.plc.word(class, number).map(i32::from);
    let value = match code {
        0..=8255 => return long(cx, code),
        9000..=9199 => counted(Class::C, code - 9000),
        9200..=9255 => cx.plc.counter32(code - 9000),
        10000..=10255 => counted(Class::T, code - 10000),
        _ => return Err(Fault::VALUE),
    };
    value.ok_or(Fault::DEVICE)
}

/// Number of a register that a word names.
fn register(named: i16) -> Result<u32, Fault> {
    u32::try_from(named).map_err(|_| Fault::DEVICE)
}

/// Distance of the master since phase 0.
fn phase(cx: &mut Cx) -> Result<i32, Fault> {
    Ok(cx.dword(MASTER, 0)?.wrapping_sub(cx.state().0[ZERO]))
}

/// Returns true if one of the inputs that a word of the block names is active; a second word selects those that are
/// active when off.
fn sees(cx: &Cx, axis: Registers, inputs: i32, polarity: i32) -> Result<bool, Fault> {
    let inputs = cx.word(BLOCK, inputs)? as u16;
    let polarity = cx.word(BLOCK, polarity)? as u16;
    Ok(axis.is_on(cx, inputs & !polarity, false) || axis.is_on(cx, inputs & polarity, true))
}

fn has(cx: &mut Cx, flag: i32) -> bool {
    cx.state().0[FLAGS] & flag != 0
}

fn set(cx: &mut Cx, flags: i32) {
    cx.state().0[FLAGS] |= flags;
}

fn clear(cx: &mut Cx, flags: i32) {
    cx.state().0[FLAGS] &= !flags;
}
