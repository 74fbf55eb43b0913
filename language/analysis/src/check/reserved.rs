//! Registers that the system uses itself, and that a program writes.

use super::Code;
use crate::accesses::Access;
use rungc_syntax::{Device, DeviceClass, Diagnostics, Span, codes, phrase};
use std::collections::BTreeMap;

/// A longer run of registers is cleared or copied as a whole; it does not mean one of them.
const MAX_RUN: u32 = 32;

/// Reserved registers that a program writes, each with its first write.
#[derive(Default)]
pub(super) struct Reserved {
    written: BTreeMap<Device, Span>,
}

impl Reserved {
    /// Takes an access of instruction `i`.
    pub(super) fn note(&mut self, code: &Code, i: usize, access: &Access) {
        let known = access.count.is_some_and(|count| count <= MAX_RUN);
        // The last device of ZRST is one of those from its first on.
        let first = code.instr(i).operands.first();
        let is_end = code.inst(i).is_some_and(|inst| inst.name == "ZRST")
            && first.is_some_and(|first| first.span != access.span);
        if !access.writes() || is_end || !known || access.first.class != DeviceClass::D {
            return;
        }
        let (first, last) = access.devices().into_inner();
        let reserved = code.model().reserved;
        let meets = |run: &&(u32, u32)| run.0 <= last.number && first.number <= run.1;
        // One register stands for all that the operand names.
        if let Some(run) = reserved.iter().find(meets) {
            let number = first.number.max(run.0);
            let register = Device { number, ..first };
            self.written.entry(register).or_insert(access.span);
        }
    }

    /// Warns of them, in one diagnostic.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        let mut written: Vec<_> = self.written.into_iter().collect();
        written.sort_by_key(|&(register, span)| (span, register));
        let Some((&(first, span), others)) = written.split_first() else {
            return;
        };
        let title = code.model().title;
        let message = match others.len() {
            0 => phrase!(
                "`{first}` is reserved for the system of {title}",
                first,
                title
            ),
            n => phrase!(
                "`{first}` and {n} more registers are reserved for the system of {title}",
                first,
                n,
                title
            ),
        };
        let mut diagnostic = codes::RESERVED_REGISTER
            .at(span, message)
            .label("written here")
            .help("use a register that is free for programs, from D1000 on");
        if !others.is_empty() {
            diagnostic = diagnostic.devices(written.iter().map(|&(register, _)| register));
        }
        for (register, span) in others {
            diagnostic = diagnostic.other(*span, phrase!("`{register}` written here", register));
        }
        out.push(diagnostic);
    }
}
