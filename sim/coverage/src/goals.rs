//! Goals of test cases.

use crate::observe::{DECIDED_OFF, DECIDED_ON, EXECUTED, EXPIRED, OFF, ON};
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_catalogue::{Basic, Lower};
use rungc_ir::Module;
use rungc_ir::node::Expr;
use rungc_lower::marks::{Mark, Marks};
use rungc_models::Model;
use rungc_syntax::{DeviceClass, Program};

/// Something that a case can reach.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Goal {
    /// Of which instruction, a position in [`Program::instrs`].
    pub instr: usize,
    /// Kind of the goal.
    pub what: What,
    /// True if it is a contact that conducts while its device is off.
    pub inverted: bool,
}

/// Kind of goal that an instruction can have.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum What {
    /// The network that begins with it is executed.
    Executed,
    /// The contact conducts, and without it the logic would have another result.
    DecidedOn,
    /// It does not conduct, and the logic would have another result if it did.
    DecidedOff,
    /// The comparison holds.
    Holds,
    /// It does not hold.
    HoldsNot,
    /// The coil or box is driven.
    On,
    /// It is not driven.
    Off,
    /// The transition to the state is made.
    Taken,
    /// The timer expires.
    Expired,
}

impl What {
    /// Message about a goal that was not reached, after the instruction: `OUT Y000` "was never on".
    pub const fn missing(self) -> &'static str {
        match self {
            What::Executed => "was never executed",
            What::DecidedOn => "never decided while it conducted",
            What::DecidedOff => "never decided while it did not conduct",
            What::Holds => "never held",
            What::HoldsNot => "always held",
            What::On => "was never on",
            What::Off => "was never off",
            What::Taken => "was never taken",
            What::Expired => "never expired",
        }
    }

    const fn flag(self, inverted: bool) -> u8 {
        match self {
            What::Executed => EXECUTED,
            What::DecidedOn if inverted => DECIDED_OFF,
            What::DecidedOff if inverted => DECIDED_ON,
            What::DecidedOn => DECIDED_ON,
            What::DecidedOff => DECIDED_OFF,
            What::Holds | What::On | What::Taken => ON,
            What::HoldsNot | What::Off => OFF,
            What::Expired => EXPIRED,
        }
    }
}

impl Goal {
    pub(crate) fn is_reached(&self, seen: &[u8]) -> bool {
        seen[self.instr] & self.what.flag(self.inverted) != 0
    }
}

/// The relays that show RUN: M8000 is on and M8001 off in every scan, so their contacts decide in one way at most.
const RUN_MONITORS: [u32; 2] = [8000, 8001];

/// Goals of a program.
pub(crate) fn goals(
    program: &Program,
    model: &'static Model,
    marks: &Marks,
    module: &Module,
) -> Vec<Goal> {
    let (resolved, _) = resolve(program, model);
    let mut goals = Vec::new();
    for mark in &marks.places {
        match *mark {
            Mark::Network(instr) => goals.push(goal(instr, What::Executed)),
            Mark::Output { instr, drive } => {
                let always = matches!(module.expr(drive), Expr::Bit(true));
                outputs(&resolved, instr, always, &mut goals);
            }
        }
    }
    for (instr, resolution) in (0..).zip(&resolved.instrs) {
        let both = match resolution.lower {
            Some(Lower::Compare(..)) => [What::Holds, What::HoldsNot],
            Some(Lower::Basic(basic)) if is_contact(basic) && !is_monitor(program, instr) => {
                [What::DecidedOn, What::DecidedOff]
            }
            _ => continue,
        };
        let inverted = matches!(
            resolution.basic(),
            Some(Basic::Ldi | Basic::Ani | Basic::Ori)
        );
        goals.extend(both.map(|what| Goal {
            inverted,
            ..goal(instr, what)
        }));
    }
    goals.sort_by_key(|goal| (goal.instr, goal.what));
    goals.dedup();
    goals
}

fn goal(instr: u32, what: What) -> Goal {
    Goal {
        instr: instr as usize,
        what,
        inverted: false,
    }
}

/// The goals of an output, which is driven in every scan or not.
fn outputs(resolved: &Resolved, instr: u32, always: bool, goals: &mut Vec<Goal>) {
    let at = instr as usize;
    let class = resolved.program.instrs[at].operands.first();
    let class = class
        .and_then(|operand| operand.kind.device())
        .map(|device| device.class);
    let whats: &[What] = match (resolved.instrs[at].basic(), class) {
        (Some(Basic::Out | Basic::Set), Some(DeviceClass::S)) => &[What::Taken],
        (Some(Basic::Out), Some(DeviceClass::T)) => &[What::On, What::Off, What::Expired],
        _ => &[What::On, What::Off],
    };
    let whats = whats.iter().filter(|what| !always || **what != What::Off);
    goals.extend(whats.map(|&what| goal(instr, what)));
}

/// Returns true if it is a contact of a device.
pub(crate) fn is_contact(basic: Basic) -> bool {
    use Basic::{And, Andf, Andp, Ani, Ld, Ldf, Ldi, Ldp, Or, Orf, Ori, Orp};
    matches!(
        basic,
        Ld | Ldi | Ldp | Ldf | And | Ani | Andp | Andf | Or | Ori | Orp | Orf
    )
}

fn is_monitor(program: &Program, instr: u32) -> bool {
    let operand = program.instrs[instr as usize].operands.first();
    let device = operand.and_then(|operand| operand.kind.device());
    device.is_some_and(|d| d.class == DeviceClass::M && RUN_MONITORS.contains(&d.number))
}
