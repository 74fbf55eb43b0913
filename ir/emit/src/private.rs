//! The private fields of a program's struct: what it remembers from scan to scan in addition to its devices.

use crate::events::set_between_scans;
use crate::plan::Plan;
use crate::temps::{Home, Temp};
use rungc_ir::Module;
use rungc_ir::node::{Cell, Flag, Table, Ty};
use rungc_rt::comm::Protocols;

/// Contents of a private field.
#[derive(Clone, Copy, Debug)]
pub enum Private<'m> {
    /// Time and mode: [`rungc_rt::Sys`].
    Sys,
    /// The memories of edges: this many, at least 1.
    Edges(u32),
    /// The bits of ladders, [`crate::steps::Ladders`]: this many, at least 1.
    Steps(u32),
    /// A flag.
    Flag {
        /// The flag.
        flag: &'m Flag,
        /// It is set outside the scan, perhaps in an interrupt handler.
        outside: bool,
    },
    /// Time since the start of the current period of this flag: [`rungc_rt::Milliseconds`].
    PeriodStart(&'m Flag),
    /// A cell.
    Cell(&'m Cell),
    /// A table.
    Table(&'m Table),
    /// The last operation error and the cause of STOP: [`rungc_rt::LastError`].
    Error,
    /// The steps that a scan may still repeat.
    StepsLeft,
    /// A temporary that is found in one function and used in another.
    Temp(Temp, Ty),
    /// The generators of these outputs Y, at least one: [`rungc_rt::Axis`].
    Axes(&'m [u32]),
    /// The serial port of this number, which may speak these protocols: [`rungc_rt::Port`].
    Port(u8, Protocols),
    /// The memories of instructions that work over several scans: this many, perhaps none.
    States(u16),
}

impl Private<'_> {
    /// Returns true if RUN resets it to its power-on value, so that it is cleared when RUN begins.
    pub fn begins_with_run(self) -> bool {
        match self {
            Private::Edges(_)
            | Private::Steps(_)
            | Private::Flag { .. }
            | Private::PeriodStart(_) => true,
            Private::Sys
            | Private::Cell(_)
            | Private::Table(_)
            | Private::Error
            | Private::StepsLeft
            | Private::Temp(..)
            | Private::Axes(_)
            | Private::Port(..)
            | Private::States(_) => false,
        }
    }
}

/// The private fields of a program, in order.
pub fn fields<'m>(module: &'m Module, plan: &Plan) -> Vec<Private<'m>> {
    let outside = set_between_scans(module);
    let mut fields = vec![Private::Sys];
    let edges = plan.ladders.edges(module);
    fields.extend((edges > 0).then_some(Private::Edges(edges)));
    let ladders = plan.ladders.count();
    fields.extend((ladders > 0).then_some(Private::Steps(ladders)));
    let flags = module.flags.iter().enumerate();
    fields.extend(flags.map(|(i, flag)| Private::Flag {
        flag,
        outside: outside.contains(&i),
    }));
    fields.extend(module.periods().map(|(flag, _)| Private::PeriodStart(flag)));
    fields.extend(module.cells.iter().map(Private::Cell));
    fields.extend(module.tables.iter().map(Private::Table));
    fields.extend(module.may_fail().then_some(Private::Error));
    fields.extend(module.has_watchdog().then_some(Private::StepsLeft));
    let temps = plan.temps.iter().zip(&module.temps);
    let temps = temps.filter(|(temp, _)| temp.home() == Home::Field);
    fields.extend(temps.map(|(temp, ty)| Private::Temp(*temp, *ty)));
    if module.sends_pulses() {
        fields.push(Private::Axes(&module.pulse_outputs));
    }
    let ports = module.serial_ports();
    fields.extend(ports.map(|(number, protocols)| Private::Port(number, protocols)));
    fields.push(Private::States(module.states));
    fields
}
