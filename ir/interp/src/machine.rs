//! The reference interpreter: the machine that a [`Module`] runs on, and its scan cycle.
//!
//! It has every device of the model, so it answers for devices that compiled code leaves out. What statements and
//! expressions mean is in `exec` and `eval`, word for word as [`rungc_ir::node`] specifies it.

use crate::devices::Devices;
use crate::errors::OperationError;
use crate::eval::{Value, int};
use crate::logic::Logic;
use rungc_ir::node::{CellId, EdgeId, ExprId, FlagId, FunctionKind, Stmt, TableId, TempId};
use rungc_ir::{Module, ResetState};
use rungc_models::runs::rt_class;
use rungc_models::special::RunCommand;
use rungc_rt::comm::codec::{self, Codec};
use rungc_rt::comm::modbus::Profile;
use rungc_rt::comm::{PortMut, PortWiring};
use rungc_rt::retain::{Retained, RetainedRun};
use rungc_rt::special::{
    D_REMOTE, D_WATCHDOG_MS, M_FORCE_ENABLE, M_FORCED_RUN, M_KEEP_IN_STOP, M_LOCAL_CONTROL,
    M_OUTPUTS_OFF, M_REMOTE_RUN, REMOTE_KEY, Relay,
};
use rungc_rt::{
    Axis, Class, EdgeKind, ErrorRules, Hal, LastError, Milliseconds, Operand, Plc, Port, Ports,
    Program, Pulses, State, Stop, Sys,
};
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;
use typed_index_collections::TiVec;

/// Number of times that WDT restarts the watchdog in a scan: a loop with WDT that never ends must not hang its host.
pub const MOST_RESTARTS: u32 = 10_000_000;

/// The functions that a host calls, by their indexes in the module.
pub(crate) struct Entries {
    take_interrupts: Option<usize>,
    /// By input terminal: of its falling, and of its rising edge.
    edges: Vec<[Option<usize>; 2]>,
}

impl Entries {
    fn of(module: &Module) -> Self {
        let mut entries = Entries {
            take_interrupts: None,
            edges: Vec::new(),
        };
        for (i, function) in module.functions.iter().enumerate() {
            if function.kind == FunctionKind::TakeInterrupts {
                entries.take_interrupts = Some(i);
            } else if let FunctionKind::InputEdge { input, kind } = function.kind {
                let input = input as usize;
                if entries.edges.len() <= input {
                    entries.edges.resize(input + 1, [None; 2]);
                }
                entries.edges[input][usize::from(kind == EdgeKind::Rising)] = Some(i);
            }
        }
        entries
    }

    /// The function of an edge.
    fn edge(&self, input: u32, level: bool) -> Option<usize> {
        *self.edges.get(input as usize)?.get(usize::from(level))?
    }
}

/// A program and its devices, executed by reading the IR.
///
/// In STOP a scan runs only the function `Begin`, which brings the clocks up to date. A scan that repeats more than
/// 10,000 steps for each millisecond of the watchdog time D8000 counts as one that does not end: the machine sets M8061
/// and D8061 = 6105 and goes to STOP with all outputs off.
pub struct Machine<'m> {
    pub(crate) module: &'m Module,
    pub(crate) entries: Entries,
    pub(crate) logic: Logic,
    pub(crate) devices: Devices,
    pub(crate) temps: TiVec<TempId, Value>,
    pub(crate) edges: TiVec<EdgeId, bool>,
    pub(crate) flags: TiVec<FlagId, bool>,
    /// Start of the current period of each flag that has one.
    pub(crate) periods: Vec<Milliseconds>,
    pub(crate) cells: TiVec<CellId, i32>,
    pub(crate) tables: TiVec<TableId, Vec<i32>>,
    pub(crate) sys: Sys,
    /// Steps that this scan may still repeat.
    pub(crate) steps_left: u32,
    /// Number of times that WDT may restart the watchdog in this scan.
    pub(crate) restarts_left: u32,
    pub(crate) last_error: LastError,
    pub(crate) errors: Vec<OperationError>,
    /// By step and code: the index of the error in `errors`.
    pub(crate) errors_by_site: BTreeMap<(u32, u16), usize>,
    /// Operands of the call being executed; reused to save the allocation.
    pub(crate) operands: Vec<Operand>,
    pub(crate) states: Vec<State>,
    /// Of the module's pulse outputs, in their order.
    pub(crate) axes: Vec<Axis>,
    /// Of the module's serial ports, in their order.
    pub(crate) ports: Vec<Port>,
    pub(crate) type_code: u16,
    /// Data retained over power-off, and its name in records.
    pub(crate) retained: (String, Vec<RetainedRun>),
    /// Flags of the reset states that are retained, too.
    pub(crate) retained_resets: BTreeMap<(Class, u32), FlagId>,
    /// Program memory that partners on a line read, from 8000h on.
    pub(crate) program_memory: Option<&'m [u8]>,
    /// Observer of the execution.
    pub(crate) observer: Option<Box<dyn Observer>>,
}

/// Looks on while a program is executed.
pub trait Observer: Send {
    /// Changes devices before a statement is executed, and before [`before`](Self::before) sees it. By default, none.
    fn intervene(&mut self, machine: &mut Machine, stmt: &Stmt) {
        let _ = (machine, stmt);
    }

    /// A statement is about to be executed.
    fn before(&mut self, machine: &Machine, stmt: &Stmt);
}

impl<'m> Machine<'m> {
    /// The machine at power-on, in RUN.
    pub fn new(module: &'m Module) -> Self {
        let devices = Devices::new(module);
        let mut machine = Machine {
            module,
            entries: Entries::of(module),
            logic: Logic::new(module, &devices),
            devices,
            temps: module.temps.iter().map(|&ty| Value::zero(ty)).collect(),
            edges: vec![false; module.edges as usize].into(),
            flags: vec![false; module.flags.len()].into(),
            periods: vec![Milliseconds::at(0); module.flags.len()],
            cells: vec![0; module.cells.len()].into(),
            tables: module
                .tables
                .iter()
                .map(|t| vec![0; t.length as usize])
                .collect(),
            sys: Sys::power_on(),
            steps_left: 0,
            restarts_left: MOST_RESTARTS,
            last_error: LastError::NONE,
            errors: Vec::new(),
            errors_by_site: BTreeMap::new(),
            operands: Vec::new(),
            states: vec![State::default(); usize::from(module.states) + 1],
            axes: vec![Axis::new(); module.pulse_outputs.len()],
            ports: vec![Port::new(); module.ports.len()],
            type_code: module.model.type_code(),
            retained: (module.retained_as(), module.retained()),
            retained_resets: module
                .retained_resets()
                .filter_map(|(class, number, flag)| Some(((rt_class(class)?, number), flag)))
                .collect(),
            program_memory: None,
            observer: None,
        };
        machine.preset(true);
        machine.power_on();
        machine
    }

    /// Lets partners on a line read this as program memory, from 8000h on.
    pub fn set_program_memory(&mut self, memory: Option<&'m [u8]>) {
        self.program_memory = memory;
    }

    /// Gives special devices their defaults: latched ones, when the PLC is switched on for the first time, or all
    /// others.
    fn preset(&mut self, latched: bool) {
        let module = self.module;
        for (register, value) in module.special_words() {
            let number = register.number();
            if module.is_latched(DeviceClass::D, number) == latched {
                // A model's table names only devices that it has.
                let _ = self.set_word(Class::D, number, value);
            }
        }
        for relay in module.model.special_bits() {
            let number = relay.number();
            if module.is_latched(DeviceClass::M, number) == latched {
                let _ = self.set_bit(Class::M, number, true);
            }
        }
    }

    /// Lets someone look on, which takes time: a machine without observer is as fast as if there were none.
    pub fn observe(&mut self, observer: Box<dyn Observer>) {
        self.observer = Some(observer);
    }

    /// Removes the observer, and returns it.
    pub fn take_observer(&mut self) -> Option<Box<dyn Observer>> {
        self.observer.take()
    }

    /// Returns true if an edge memory holds a bit that was on.
    pub fn edge_memory(&self, memory: EdgeId) -> bool {
        self.edges.get(memory).copied().unwrap_or(false)
    }

    /// Returns true if a bit expression without `And`, `Or` and `Not` is on now.
    pub fn is_on(&self, id: ExprId) -> bool {
        self.eval(id) == Value::Bit(true)
    }

    /// Value of an integer expression now.
    pub fn integer(&self, id: ExprId) -> i32 {
        int(self.eval(id))
    }

    /// The module it runs.
    pub fn module(&self) -> &'m Module {
        self.module
    }

    /// The pulse output Y `number`, if the program sends pulses there.
    pub fn pulse_output(&self, number: u32) -> Option<&Axis> {
        let i = self.module.pulse_outputs.binary_search(&number).ok()?;
        self.axes.get(i)
    }

    /// Returns true if a private bit of the module is on.
    pub fn flag(&self, flag: FlagId) -> bool {
        self.flags[flag]
    }

    /// Returns true if the memory of a timer's or counter's reset state says that RST holds it.
    pub fn is_held(&self, state: ResetState) -> bool {
        match state {
            ResetState::Flag(flag) => self.flags[flag],
            ResetState::Entry(table, number) => {
                let entries = self.tables.get(table);
                let entry = entries.and_then(|entries| entries.get(number as usize));
                entry.is_some_and(|&entry| entry != 0)
            }
        }
    }

    /// Returns true if the watchdog has stopped the program.
    pub fn watchdog_tripped(&self) -> bool {
        self.last_error.stop == Stop::Watchdog
    }

    fn power_on(&mut self) {
        self.preset(false);
        self.states.fill(State::default());
        self.axes.fill(Axis::new());
        self.ports.fill(Port::new());
        self.cells.fill(0);
        for table in &mut self.tables {
            table.fill(0);
        }
        self.sys = Sys::power_on();
        self.errors.clear();
        self.errors_by_site.clear();
        self.restart_watchdog();
        self.begin_run();
    }

    fn begin_run(&mut self) {
        self.last_error = LastError::NONE;
        self.edges.fill(false);
        for (state, flag) in self.flags.iter_mut().zip(&self.module.flags) {
            *state &= flag.retained;
        }
        self.periods.fill(Milliseconds::at(self.sys.clock.reading));
        let of_program = 1..=usize::from(self.module.run_states);
        if let Some(states) = self.states.get_mut(of_program) {
            states.fill(State::default());
        }
        self.devices.forget_coils();
    }

    /// Periods begin with the first scan.
    fn begin_periods(&mut self, now_ms: u32) {
        self.periods.fill(Milliseconds::at(now_ms));
        for (state, flag) in self.flags.iter_mut().zip(&self.module.flags) {
            *state &= flag.period_ms.is_none();
        }
    }

    /// Counts the pulses that have been sent, and sets the flags of the trains that have ended.
    fn count_pulses(&mut self, hal: &mut dyn Hal, now_us: u32) {
        if !self.module.sends_pulses() {
            return;
        }
        rungc_rt::count_pulses(self, hal, now_us);
        for (i, flag) in self.module.flags.iter_enumerated() {
            if let Some(axis) = flag.pulses_end.and_then(|output| self.axis(output)) {
                let ended = axis.take_end();
                self.flags[i] |= ended;
            }
        }
    }

    /// Brings the serial ports up to date, and changes over to RUN or STOP if a partner has requested it.
    fn advance_ports(&mut self, hal: &mut dyn Hal, now_us: u32) {
        if !self.module.has_ports() {
            return;
        }
        if let Some(running) = rungc_rt::advance_ports(self, hal, now_us) {
            self.set_running(running);
        }
    }

    fn special(&self, relay: Relay) -> bool {
        self.module.model.scan_keeps(relay)
            && self.devices.bit(Class::M, relay.number()).unwrap_or(false)
    }

    /// Obeys what puts the PLC in RUN and STOP other than its switch.
    fn obey_run_command(&mut self) {
        let bit = |devices: &Devices, m: Relay| devices.bit(Class::M, m.number()) == Some(true);
        let running = match self.module.model.run_command() {
            Some(RunCommand::Forced)
                if !self.sys.running
                    && bit(&self.devices, M_FORCE_ENABLE)
                    && bit(&self.devices, M_FORCED_RUN) =>
            {
                let _ = self.set_bit(Class::M, M_FORCED_RUN.number(), false);
                true
            }
            Some(RunCommand::Remote)
                if self.word(Class::D, D_REMOTE.number()) == Some(REMOTE_KEY)
                    && !bit(&self.devices, M_LOCAL_CONTROL) =>
            {
                bit(&self.devices, M_REMOTE_RUN)
            }
            Some(RunCommand::Forced | RunCommand::Remote) | None => return,
        };
        self.set_running(running);
    }

    /// Runs a function, if there is one.
    fn run_function(&mut self, hal: &mut dyn Hal, function: Option<usize>) {
        if let Some(function) = function.and_then(|i| self.module.functions.get(i)) {
            self.run(&function.body, hal);
        }
    }

    fn restart_watchdog(&mut self) {
        let watchdog_ms = self.word(Class::D, D_WATCHDOG_MS.number());
        self.steps_left = Module::scan_steps(watchdog_ms.unwrap_or(self.module.watchdog_ms()));
    }

    /// WDT, as often as a scan may.
    pub(crate) fn wdt(&mut self) {
        if let Some(left) = self.restarts_left.checked_sub(1) {
            self.restarts_left = left;
            self.restart_watchdog();
        }
    }

    /// Returns true if the watchdog has stopped a scan that WDT did not let end.
    pub fn is_endless(&self) -> bool {
        self.watchdog_tripped() && self.restarts_left == 0
    }

    /// [`Stmt::Watch`](rungc_ir::node::Stmt::Watch): whether the scan is cut short.
    pub(crate) fn out_of_time(&mut self, steps: u32, at: u32) -> bool {
        if let Some(left) = self.steps_left.checked_sub(steps) {
            self.steps_left = left;
            return false;
        }
        self.steps_left = 0;
        if self.sys.running {
            self.sys.running = false;
            self.last_error.stop = Stop::Watchdog;
            self.last_error.stop_step = at as u16;
            rungc_rt::trip_watchdog(self);
        }
        true
    }
}

impl Program for Machine<'_> {
    fn scan(&mut self, hal: &mut dyn Hal, now_ms: u32, scan_us: u32) {
        self.obey_run_command();
        if self.sys.scan == 0 {
            self.begin_periods(now_ms);
        }
        self.sys.begin_scan(now_ms, scan_us);
        let now_us = self.sys.now_us();
        self.count_pulses(hal, now_us);
        self.advance_ports(hal, now_us);
        self.restarts_left = MOST_RESTARTS;
        self.restart_watchdog();

        // A module's first functions are `Begin`, `Main`, `End`.
        let functions = if self.sys.running { 0..3 } else { 0..1 };
        for function in functions {
            self.run_function(hal, Some(function));
        }
        self.sys.end_scan();
        self.advance_ports(hal, now_us);
    }

    fn constant_scan_ms(&self) -> Option<u16> {
        let asks = self.module.model.constant_scan()?;
        let on = asks.relay.is_none_or(|relay| self.special(relay));
        let ms = self.word(Class::D, asks.register.number()).unwrap_or(0);
        u16::try_from(ms).ok().filter(|&ms| on && ms > 0)
    }

    fn input_edge(&mut self, hal: &mut dyn Hal, number: u32, level: bool) {
        self.run_function(hal, self.entries.edge(number, level));
    }

    fn tick(&mut self, hal: &mut dyn Hal, now_ms: u32) {
        let states = self.flags.iter_mut().zip(&mut self.periods);
        for (flag, (state, since)) in self.module.flags.iter().zip(states) {
            if let Some(ms) = flag.period_ms {
                *state |= since.ends_period(now_ms, ms);
            }
        }
        if !self.module.ticks_only_note() {
            self.sys.tick(now_ms);
        }
        let cells = self.module.cells.iter().zip(&mut self.cells);
        for (_, value) in cells.filter(|(cell, _)| cell.follows_time) {
            *value = self.sys.clock.elapsed as i32;
        }
        let now_us = self.sys.now_us();
        self.count_pulses(hal, now_us);
        self.advance_ports(hal, now_us);
    }

    fn take_interrupts(&mut self, hal: &mut dyn Hal) {
        if !self.sys.running || self.entries.take_interrupts.is_none() {
            return;
        }
        self.run_function(hal, self.entries.take_interrupts);
    }

    fn pulse_timer(&mut self, hal: &mut dyn Hal, now_us: u32) -> Option<u32> {
        rungc_rt::pulse_timer(self, hal, now_us)
    }

    fn set_running(&mut self, running: bool) {
        if !self.sys.set_running(running) {
            return;
        }
        if running {
            self.begin_run();
            return;
        }
        if self.module.model.run_command() == Some(RunCommand::Forced) {
            let _ = self.set_bit(Class::M, M_FORCED_RUN.number(), false);
        }
        if !self.special(M_KEEP_IN_STOP) {
            self.devices.clear(false);
        }
    }

    fn power_cycle(&mut self) {
        let keeps_latched = match self.module.model.latch_key {
            Some((register, key)) => self.word(Class::D, register.number()) == Some(key),
            None => true,
        };
        self.devices.power_off(keeps_latched);
        if !self.module.model.keeps_contacts {
            self.devices.open_contacts();
        }
        self.power_on();
    }

    fn retained(&self) -> Retained<'_> {
        let key = self.module.model.latch_key;
        Retained {
            program: &self.retained.0,
            runs: &self.retained.1,
            contacts: self.module.model.keeps_contacts,
            key: key.map(|(register, key)| (register.number(), key)),
        }
    }

    fn is_reset(&self, class: Class, number: u32) -> bool {
        let flag = self.retained_resets.get(&(class, number));
        flag.is_some_and(|&flag| self.flags[flag])
    }

    fn set_reset(&mut self, class: Class, number: u32, reset: bool) {
        if let Some(&flag) = self.retained_resets.get(&(class, number)) {
            self.flags[flag] = reset;
        }
    }

    fn last_error(&self) -> LastError {
        self.last_error
    }

    fn output(&self, number: u32) -> bool {
        let driven = self.sys.running || (self.special(M_KEEP_IN_STOP) && !self.watchdog_tripped());
        driven
            && !self.special(M_OUTPUTS_OFF)
            && (self.devices.bit(Class::Y, number).unwrap_or(false)
                || self.pulse_output(number).is_some_and(|axis| axis.on))
    }
}

impl Plc for Machine<'_> {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.devices.bit(class, number)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        *self.devices.bit_mut(class, number)? = value;
        Some(())
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.devices.word(class, number)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        *self.devices.word_mut(class, number)? = value;
        Some(())
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.devices.counter32(number).map(|c| c.value)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.devices.counter32_mut(number)?.value = value;
        Some(())
    }

    fn state(&mut self, slot: u16) -> &mut State {
        // Slot 0 belongs to instructions without memory; a slot that the module does not have is treated as slot 0.
        let i = usize::from(slot);
        let i = if i < self.states.len() { i } else { 0 };
        &mut self.states[i]
    }

    fn sys(&self) -> &Sys {
        &self.sys
    }

    fn axis(&mut self, output: u32) -> Option<&mut Axis> {
        let i = self.module.pulse_outputs.binary_search(&output).ok()?;
        self.axes.get_mut(i)
    }

    fn port(&mut self, number: u8) -> Option<PortMut<'_>> {
        let i = self.module.ports.binary_search(&number).ok()?;
        self.ports.get_mut(i).map(Port::parts)
    }

    fn codecs(&self) -> &'static [&'static Codec] {
        codec::ALL
    }

    fn port_wiring(&self, index: usize) -> Option<&'static PortWiring> {
        self.ports().all().get(index)
    }

    fn modbus(&self) -> &'static Profile {
        self.ports().modbus(self.type_code())
    }

    fn ports(&self) -> Ports {
        self.module.model.ports
    }

    fn type_code(&self) -> u16 {
        self.type_code
    }

    fn program_byte(&self, offset: u32) -> Option<u8> {
        /// Value of erased memory.
        const ERASED: u8 = 0xff;
        let memory = self.program_memory?;
        Some(memory.get(offset as usize).copied().unwrap_or(ERASED))
    }

    fn pulses(&self) -> Pulses {
        self.module.model.pulses
    }

    fn text(&self, index: u32) -> &[u8] {
        self.module
            .texts
            .get(index as usize)
            .map_or(&[], |text| text.as_bytes())
    }

    fn z_pairs_with_v(&self) -> bool {
        self.module.model.z_pairs_with_v
    }

    fn error_relay(&self) -> u32 {
        self.module.model.error_relay.number()
    }

    fn value_error(&self) -> u16 {
        self.module.model.value_error
    }

    fn error_rules(&self) -> ErrorRules {
        self.module.model.error_rules
    }

    fn note_error(&mut self, code: u16, step: u32) {
        self.last_error.code = code;
        self.last_error.step = step as u16;
        self.log_error(code, step);
    }

    fn coil(&self, class: Class, number: u32) -> Option<bool> {
        let coil = self.devices.coil(class, number);
        coil.or_else(|| self.bit(class, number))
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        match class {
            Class::T => self.devices.timer(number)?.reset(),
            Class::C => match self.devices.counter16(number) {
                Some(counter) => counter.reset(),
                None => self.devices.counter32_mut(number)?.reset(),
            },
            Class::X
            | Class::Y
            | Class::M
            | Class::S
            | Class::D
            | Class::R
            | Class::V
            | Class::Z
            | Class::ER => {
                return None;
            }
        }
        Some(())
    }
}
