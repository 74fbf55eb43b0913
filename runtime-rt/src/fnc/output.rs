//! What the instructions for pulse outputs have in common: when one of them begins, and who has the output.
//!
//! Word 0 of an instruction's memory keeps whether it was driven, word 1 how far it is, word 2 the relay with which it begins anew.

use crate::axis::{Axis, Wiring, is_on, set_relays};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::pulse::Train;
use crate::special::M_COMPLETE;

/// How far an instruction is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(i32)]
pub(super) enum Phase {
    /// It has not begun, was stopped, or had the output taken from it.
    Idle = 0,
    /// It sends.
    Sends = 1,
    /// It is done.
    Done = 2,
    /// It is to begin; its operands may keep it from that.
    Begins = 3,
}

/// What is to be done in a scan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Turn {
    /// Nothing.
    Rest,
    /// The instruction begins.
    Start,
    /// It sends.
    Sends,
    /// It sent, and its drive has gone off.
    Released,
}

/// The output of an instruction.
#[derive(Clone, Copy)]
pub(super) struct Output {
    number: u32,
    /// Its special devices.
    pub wiring: &'static Wiring,
}

impl Output {
    /// That of operand `i`.
    pub fn of(cx: &Cx, i: usize) -> Result<Output, Fault> {
        let operand = cx.ops.get(i).ok_or(Fault::DEVICE)?;
        let number = u32::try_from(operand.value).map_err(|_| Fault::DEVICE)?;
        let wiring = cx.plc.pulses().outputs().get(number as usize);
        let wiring = wiring.ok_or(Fault::DEVICE)?;
        Ok(Output { number, wiring })
    }

    /// What it is doing.
    pub fn axis<'a>(self, cx: &'a mut Cx) -> Result<&'a mut Axis, Fault> {
        cx.plc.axis(self.number).ok_or(Fault::DEVICE)
    }

    /// A speed in the model's range, in millihertz; 0 remains 0.
    pub fn millihertz(self, cx: &Cx, hz: u32) -> u32 {
        1000 * hz.min(cx.plc.pulses().highest_hz())
    }

    /// What the instruction has to do in this scan. An output that another instruction uses is taken only while the relay for that is on.
    pub fn turn(self, cx: &mut Cx) -> Result<Turn, Fault> {
        let (drive, slot) = (cx.drive(), cx.site.slot);
        let was_driven = cx.was_driven(0);
        let restart = self.wiring.restart != 0 && cx.special(self.wiring.restart);
        let had_restart = core::mem::replace(&mut cx.state().0[2], restart.into()) != 0;
        let stops = is_on(cx.plc, &self.wiring.stop);
        let axis = self.axis(cx)?;
        let (mine, busy) = (axis.owner == slot, axis.generator.is_busy());
        let complete = axis.generator.is_complete();
        if !drive {
            return Ok(match (was_driven, mine) {
                (true, true) => Turn::Released,
                _ => Turn::Rest,
            });
        }
        let phase = cx.state().0[1];
        if !was_driven || (restart && !had_restart) || phase == Phase::Begins as i32 {
            self.enter(cx, Phase::Idle);
            cx.set_special(M_COMPLETE, false);
            if stops {
                return Ok(Turn::Rest);
            }
            if busy && !restart {
                return Err(Fault(cx.plc.pulses().conflict()));
            }
            self.enter(cx, Phase::Begins);
            return Ok(Turn::Start);
        }
        if phase != Phase::Sends as i32 {
            return Ok(Turn::Rest);
        }
        if mine && busy {
            return Ok(Turn::Sends);
        }
        let done = mine && complete;
        self.enter(cx, if done { Phase::Done } else { Phase::Idle });
        Ok(Turn::Rest)
    }

    /// The instruction gets so far.
    pub fn enter(self, cx: &mut Cx, phase: Phase) {
        cx.state().0[1] = phase as i32;
    }

    /// The instruction sends a train, whose pulses are counted in the pair of registers `counter`.
    pub fn start(self, cx: &mut Cx, train: Train, counter: u32) {
        let slot = cx.site.slot;
        self.enter(cx, Phase::Sends);
        if let Some(axis) = cx.plc.axis(self.number) {
            axis.generator.start(train);
            axis.owner = slot;
            axis.counter = counter as u16;
            axis.ended = false;
        }
    }

    /// Shows in the special relays how far the instruction is. One whose drive is off has nothing to show but that it has gone off.
    pub fn show(self, cx: &mut Cx) -> Done {
        let slot = cx.site.slot;
        let axis = self.axis(cx)?;
        let (busy, mine) = (axis.generator.millihertz() > 0, axis.owner == slot);
        set_relays(cx.plc, &self.wiring.busy, busy);
        let drive = cx.drive();
        let phase = cx.state().0[1];
        if drive {
            cx.set_special(M_COMPLETE, phase == Phase::Done as i32);
        } else if phase != Phase::Idle as i32 {
            self.enter(cx, Phase::Idle);
            cx.set_special(M_COMPLETE, false);
        }
        if !drive && mine {
            self.axis(cx)?.owner = 0;
        }
        Ok(())
    }
}
