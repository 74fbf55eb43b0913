//! `rungc check`.

use super::subject::{self, Subject};
use super::{Context, Result, conclude, counted, findings, read};
use crate::args::CheckArgs;
use crate::report::Reporter;
use rungc_ir::compile::{self, CompileOptions};
use rungc_syntax::{DeviceClass, OperandKind, Program};
use std::collections::BTreeSet;
use std::time::Instant;

/// Reports everything that is wrong with programs.
pub fn run(args: &CheckArgs, cx: Context) -> Result {
    subject::each(&args.inputs, cx, |subject, reporter| {
        check(subject, reporter, cx)
    })
}

fn check(subject: &Subject, reporter: &mut Reporter, cx: Context) -> Result {
    let start = Instant::now();
    let read = read(subject, reporter)?;
    let checked = compile::check(
        &read.program,
        &CompileOptions {
            model: subject.model,
            ..CompileOptions::default()
        },
    );
    let findings = findings(subject, &read, &checked);
    let elapsed = start.elapsed();
    let name = findings.name(reporter.many());
    conclude(&findings, reporter, cx, || {
        format!(
            "    Checked {name} ({}, {}, {}) in {} ms",
            checked.model.name.to_uppercase(),
            counted(checked.steps as usize, "step"),
            counted(devices(&read.program), "device"),
            elapsed.as_millis()
        )
    })
}

/// How many devices the program names; pointers and nesting levels are none.
fn devices(program: &Program) -> usize {
    let operands = program.instrs.iter().flat_map(|instr| &instr.operands);
    let named: BTreeSet<_> = operands
        .filter_map(|operand| match operand.kind {
            OperandKind::Device(device, _)
            | OperandKind::WordBit(device, ..)
            | OperandKind::Nibbles(_, device, _) => Some(device),
            _ => None,
        })
        .filter(|d| !matches!(d.class, DeviceClass::P | DeviceClass::I | DeviceClass::N))
        .collect();
    named.len()
}
