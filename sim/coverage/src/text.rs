//! Coverage as text.

use crate::Covered;
use std::fmt::{self, Write};

/// Report on each program, network by network: the goals reached and missed.
pub fn text(programs: &[Covered]) -> String {
    let mut out = String::new();
    for program in programs {
        // Writing to a string does not fail.
        let _ = write(&mut out, program);
    }
    out
}

/// Share of goals reached: `12 of 17 (70 %)`.
pub fn share(reached: usize, all: usize) -> String {
    match all {
        0 => "nothing to reach".to_string(),
        _ => format!("{reached} of {all} ({} %)", 100 * reached / all),
    }
}

fn write(out: &mut String, program: &Covered) -> fmt::Result {
    let share = share(program.reached(), program.goals.len());
    writeln!(out, "{}: {share}", program.name)?;
    program.drawn(|_, ladder| {
        for (number, network) in (1..).zip(&ladder.networks) {
            for goal in program.missed(network.instrs.clone()) {
                let instr = &program.program.instrs[goal.instr];
                let line = program.line(goal.instr);
                writeln!(
                    out,
                    "  network {number}, line {line}: {instr} {}",
                    goal.what.missing()
                )?;
            }
        }
        Ok(())
    })
}
