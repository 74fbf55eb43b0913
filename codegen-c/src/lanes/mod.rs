//! Many instances of a program at once: a bit device is one bit in each of them, so that contacts and coils of all are
//! one operation.
//!
//! Beside the sliced bits stands an array of the program's usual structs, in which words, timers and counters live.
//! What is made of bits alone is printed on whole lanes (`slice`); all else runs in a loop over the instances that
//! execute it, as the code of one instance, with the bits that it meets copied in and out (`mirror`). `classify` says
//! which is which.

mod classify;
mod mirror;
mod slice;
mod text;
mod waiting;

pub use text::{header, source};

use rungc_emit::cycle;
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::{calls_runtime, statements};

/// Number of instances in a `plc_lanes` of `rungc_lanes.h`.
pub const LANES: u32 = 64;

/// Feature of a program that needs more than scans, as the end of "the program …"; `None` if there is none.
pub fn reaches_out(module: &Module) -> Option<&'static str> {
    let reasons = [
        (module.has_ports(), "uses serial ports"),
        (module.sends_pulses(), "sends pulses"),
        (
            module.takes_events(),
            "takes interrupts or high-speed counts",
        ),
    ];
    let found = reasons.into_iter().find(|(there, _)| *there);
    found.map(|(_, reason)| reason)
}

/// Reason why a program cannot run in lanes, as the end of "the program …"; `None` if there is none.
pub fn refusal(module: &Module) -> Option<&'static str> {
    let (mut calls, mut stops) = (false, false);
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            calls |= calls_runtime(stmt);
            stops |= matches!(stmt, Stmt::Do(Action::Stop));
        });
    }
    let commanded = cycle::run_command(module, &Storage::new(module)).is_some();
    let reasons = [
        (
            module.has_watchdog(),
            "has a loop or a jump back that only the watchdog may end",
        ),
        (calls, "calls the runtime library"),
        (stops || commanded, "changes between RUN and STOP by itself"),
    ];
    reaches_out(module).or_else(|| {
        let found = reasons.into_iter().find(|(there, _)| *there);
        found.map(|(_, reason)| reason)
    })
}
