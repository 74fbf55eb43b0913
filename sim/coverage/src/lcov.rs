//! Coverage in the format of lcov's tracefiles (geninfo(1)), which genhtml and services read.
//!
//! A line is executed if an instruction on it was; each thing to be reached of an instruction is a branch of its line.

use crate::Covered;
use crate::goals::What;
use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// The tracefile; programs without a file of lines are left out.
pub fn lcov(programs: &[Covered]) -> String {
    let mut out = String::new();
    for program in programs {
        // Writing to a string does not fail.
        let _ = write(&mut out, program);
    }
    out
}

/// Returns true if a program is a file of lines.
pub fn has_lines(program: &Covered) -> bool {
    program.path.is_some() && program.program.kind.is_list()
}

fn write(out: &mut String, program: &Covered) -> fmt::Result {
    let Some(path) = program.path.as_ref().filter(|_| has_lines(program)) else {
        return Ok(());
    };
    let mut lines: BTreeMap<u32, Vec<bool>> = BTreeMap::new();
    let mut executed: BTreeMap<u32, bool> = BTreeMap::new();
    for goal in &program.goals {
        let (line, reached) = (program.line(goal.instr), program.is_reached(goal));
        let was = executed.entry(line).or_default();
        *was |= reached;
        if goal.what != What::Executed {
            lines.entry(line).or_default().push(reached);
        }
    }
    writeln!(out, "TN:rungc\nSF:{}", path.display())?;
    for (line, branches) in &lines {
        for (number, taken) in branches.iter().enumerate() {
            writeln!(out, "BRDA:{line},0,{number},{}", u8::from(*taken))?;
        }
    }
    let branches = lines.values().flatten();
    let (found, hit) = (
        branches.clone().count(),
        branches.filter(|taken| **taken).count(),
    );
    writeln!(out, "BRF:{found}\nBRH:{hit}")?;
    for (line, executed) in &executed {
        writeln!(out, "DA:{line},{}", u8::from(*executed))?;
    }
    let hit = executed.values().filter(|executed| **executed).count();
    writeln!(out, "LF:{}\nLH:{hit}\nend_of_record", executed.len())
}
