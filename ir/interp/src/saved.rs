//! The state of a machine at one moment, to come back to.

use crate::devices::Cells;
use crate::errors::OperationError;
use crate::eval::Value;
use crate::machine::Machine;
use rungc_ir::node::{CellId, EdgeId, FlagId, TableId, TempId};
use rungc_rt::{Axis, LastError, Milliseconds, Port, State, Sys};
use std::collections::BTreeMap;
use typed_index_collections::TiVec;

/// The state of a [`Machine`] at one moment: its devices, and all that its program remembers.
#[derive(Clone)]
pub struct Saved {
    devices: Cells,
    temps: TiVec<TempId, Value>,
    edges: TiVec<EdgeId, bool>,
    flags: TiVec<FlagId, bool>,
    periods: Vec<Milliseconds>,
    cells: TiVec<CellId, i32>,
    tables: TiVec<TableId, Vec<i32>>,
    sys: Sys,
    steps_left: u32,
    last_error: LastError,
    errors: Vec<OperationError>,
    errors_by_site: BTreeMap<(u32, u16), usize>,
    states: Vec<State>,
    axes: Vec<Axis>,
    ports: Vec<Port>,
}

impl Machine<'_> {
    /// Its state now, to which [`restore`](Self::restore) comes back.
    pub fn save(&self) -> Saved {
        // All fields are named, so that none is forgotten.
        let Machine {
            module: _,
            entries: _,
            logic: _,
            devices,
            temps,
            edges,
            flags,
            periods,
            cells,
            tables,
            sys,
            steps_left,
            last_error,
            errors,
            errors_by_site,
            operands: _,
            states,
            axes,
            ports,
            type_code: _,
            retained: _,
            retained_resets: _,
            program_memory: _,
            // A scan begins with all.
            restarts_left: _,
            observer: _,
        } = self;
        Saved {
            devices: devices.cells(),
            temps: temps.clone(),
            edges: edges.clone(),
            flags: flags.clone(),
            periods: periods.clone(),
            cells: cells.clone(),
            tables: tables.clone(),
            sys: *sys,
            steps_left: *steps_left,
            last_error: *last_error,
            errors: errors.clone(),
            errors_by_site: errors_by_site.clone(),
            states: states.clone(),
            axes: axes.clone(),
            ports: ports.clone(),
        }
    }

    /// Comes back to a state that this machine, or another one of the same module, has had.
    pub fn restore(&mut self, saved: &Saved) {
        let Saved {
            devices,
            temps,
            edges,
            flags,
            periods,
            cells,
            tables,
            sys,
            steps_left,
            last_error,
            errors,
            errors_by_site,
            states,
            axes,
            ports,
        } = saved;
        self.devices.set_cells(devices);
        self.temps.clone_from(temps);
        self.edges.clone_from(edges);
        self.flags.clone_from(flags);
        self.periods.clone_from(periods);
        self.cells.clone_from(cells);
        self.tables.clone_from(tables);
        self.sys = *sys;
        self.steps_left = *steps_left;
        self.last_error = *last_error;
        self.errors.clone_from(errors);
        self.errors_by_site.clone_from(errors_by_site);
        self.states.clone_from(states);
        self.axes.clone_from(axes);
        self.ports.clone_from(ports);
    }
}
