//! Effects of a scan, STOP, power-off and the watchdog, beyond the program's functions.

use crate::plan::{Plan, statements};
use crate::storage::Storage;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_models::Model;
use rungc_models::special::{ConstantScan, RunCommand, SpecialDevice};
use rungc_rt::special::{
    D_ANY_ERROR, D_ERROR_STEP, D_FIRST_ERROR_STEP, D_LOGGED_CODES, D_REMOTE, D_WATCHDOG,
    D_WATCHDOG_MS, M_ANY_ERROR, M_FIRST_ERROR, M_FORCE_ENABLE, M_FORCED_RUN, M_LOCAL_CONTROL,
    M_OPERATION_ERROR, M_REMOTE_RUN, M_WATCHDOG, Relay, WATCHDOG_CODE,
};
use rungc_rt::{ErrorRules, RtFn, relay_in_bcd};
use rungc_syntax::DeviceClass;

/// Services that the statements of a program request.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub struct Services {
    /// Clears the general devices ([`Action::Clear`]).
    pub clears_general: bool,
    /// Clears the latched devices.
    pub clears_latched: bool,
    /// Reports operation errors that it finds itself ([`Action::Fault`]).
    pub faults: bool,
}

impl Services {
    /// Looks at all functions.
    pub fn of(plan: &Plan) -> Self {
        let mut services = Services::default();
        for function in &plan.functions {
            statements(&function.body, &mut |stmt| {
                services.clears_general |=
                    matches!(stmt, Stmt::Do(Action::Clear { latched: false }));
                services.clears_latched |=
                    matches!(stmt, Stmt::Do(Action::Clear { latched: true }));
                services.faults |= matches!(stmt, Stmt::Do(Action::Fault { .. }));
            });
        }
        services
    }
}

/// Returns true if a special relay is stored and has its usual meaning on the model.
pub fn keeps(module: &Module, storage: &Storage, relay: Relay) -> bool {
    is_stored(storage, relay) && module.model.scan_keeps(relay)
}

/// Devices that request scans of constant length, if all of them are stored.
pub fn constant_scan(module: &Module, storage: &Storage) -> Option<ConstantScan> {
    let devices = module.model.constant_scan()?;
    let relay = devices.relay.is_none_or(|relay| is_stored(storage, relay));
    (relay && is_stored(storage, devices.register)).then_some(devices)
}

/// Devices that put the PLC in RUN and STOP other than its switch, if all of them are stored.
pub fn run_command(module: &Module, storage: &Storage) -> Option<RunCommand> {
    let command = module.model.run_command()?;
    let stored = match command {
        RunCommand::Forced => [M_FORCE_ENABLE, M_FORCED_RUN].map(|m| is_stored(storage, m)),
        RunCommand::Remote => [
            is_stored(storage, M_REMOTE_RUN) && is_stored(storage, M_LOCAL_CONTROL),
            is_stored(storage, D_REMOTE),
        ],
    };
    (stored == [true; 2]).then_some(command)
}

fn is_stored<D: SpecialDevice>(storage: &Storage, device: D) -> bool {
    storage.find(D::CLASS, device.number()).is_some()
}

/// Returns true if a program reads or sets the real-time clock.
pub fn uses_clock(module: &Module) -> bool {
    calls_any(module, &CLOCK_FUNCTIONS)
}

/// Returns true if a program reads the state of the power supply or the battery.
pub fn uses_supply(module: &Module) -> bool {
    calls_any(module, &[RtFn::PowerSupply])
}

/// Returns true if a program calls one of these functions.
fn calls_any(module: &Module, functions: &[RtFn]) -> bool {
    let mut calls = false;
    for function in &module.functions {
        rungc_ir::walk::statements(&function.body, &mut |stmt| {
            calls |=
                matches!(stmt, Stmt::Do(Action::Call(call)) if functions.contains(&call.function));
        });
    }
    calls
}

/// Functions that read or set the real-time clock.
const CLOCK_FUNCTIONS: [RtFn; 6] = [
    RtFn::Trd,
    RtFn::TrdShort,
    RtFn::Twr,
    RtFn::TwrShort,
    RtFn::ClockRefresh,
    RtFn::ClockRefreshShort,
];

/// Treatment of latched devices at power-on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Latches {
    /// They keep their values.
    Retained,
    /// They are cleared unless this register D holds this key.
    RetainedIf(u32, i16),
    /// They are cleared, since this register D, which is not stored, does not hold this key.
    Lost(u32, i16),
}

/// Treatment of a program's latched devices at power-on.
pub fn latches(module: &Module, storage: &Storage) -> Latches {
    let Some((register, key)) = module.model.latch_key else {
        return Latches::Retained;
    };
    if is_stored(storage, register) {
        Latches::RetainedIf(register.number(), key)
    } else if module.model.word_at_power_on(register) == key {
        Latches::Retained
    } else {
        Latches::Lost(register.number(), key)
    }
}

/// Returns true if a program retains data over power-off.
pub fn keeps_any(module: &Module) -> bool {
    let lost = matches!(latches(module, &Storage::new(module)), Latches::Lost(..));
    !lost && !module.retained().is_empty()
}

/// Number of steps that a scan may repeat ([`Stmt::Watch`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Budget {
    /// [`rungc_ir::node::STEPS_PER_MS`] for each millisecond in this register D, at least one.
    Register(u32),
    /// A constant number.
    Steps(u32),
}

/// Budget of the watchdog for each scan; `None` if it could not interrupt any part of the program.
pub fn budget(module: &Module, storage: &Storage) -> Option<Budget> {
    let register = D_WATCHDOG_MS.number();
    let is_stored = storage.find(DeviceClass::D, register).is_some();
    module.has_watchdog().then(|| match is_stored {
        true => Budget::Register(register),
        false => Budget::Steps(Module::scan_steps(module.watchdog_ms())),
    })
}

/// Effect of an error on a special device.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shown {
    /// A relay turns on.
    On,
    /// A register takes this value.
    Word(i16),
    /// A register takes the error's code.
    Code,
    /// A register takes the step at which it happened.
    Step,
}

/// A special device, and what it shows.
pub type Shows = (DeviceClass, u32, Shown);

/// Consequences of errors on the model, as far as a program stores the devices.
pub fn error_rules(module: &Module, storage: &Storage) -> ErrorRules {
    let rules = module.model.error_rules;
    let summary = is_stored(storage, M_ANY_ERROR) || is_stored(storage, D_ANY_ERROR);
    ErrorRules {
        sums_up_ports: rules.sums_up_ports && summary && module.has_ports(),
        logs: rules.logs && is_stored(storage, D_LOGGED_CODES),
    }
}

/// Effects on stored special devices when the watchdog stops the PLC ([`rungc_rt::trip_watchdog`]).
pub fn watchdog_shows(model: &Model, storage: &Storage) -> Vec<Shows> {
    use DeviceClass::{D, M};
    let shows = match model.error_relay {
        M_OPERATION_ERROR => vec![
            (M, M_WATCHDOG.number(), Shown::On),
            (M, M_ANY_ERROR.number(), Shown::On),
            (D, D_WATCHDOG.number(), Shown::Word(WATCHDOG_CODE as i16)),
            (
                D,
                D_ANY_ERROR.number(),
                Shown::Word(relay_in_bcd(M_WATCHDOG)),
            ),
        ],
        relay => vec![(M, relay.number(), Shown::On)],
    };
    stored(storage, shows)
}

/// Effects on stored special devices of the first operation error, while the first of them, a relay, is on; then their
/// effects of each error ([`rungc_rt::report`]).
pub fn fault_shows(model: &Model, storage: &Storage) -> [Vec<Shows>; 2] {
    use DeviceClass::{D, M};
    let relay = model.error_relay.number();
    let shows = match model.error_relay {
        M_OPERATION_ERROR => [
            vec![
                (M, M_FIRST_ERROR.number(), Shown::On),
                (D, D_FIRST_ERROR_STEP.number(), Shown::Step),
            ],
            vec![
                (M, relay, Shown::On),
                (D, relay, Shown::Code),
                (D, D_ERROR_STEP.number(), Shown::Step),
                (M, M_ANY_ERROR.number(), Shown::On),
                (
                    D,
                    D_ANY_ERROR.number(),
                    Shown::Word(relay_in_bcd(M_OPERATION_ERROR)),
                ),
            ],
        ],
        // On HM the other numbers are something else.
        _ => [
            Vec::new(),
            vec![(M, relay, Shown::On), (D, relay, Shown::Step)],
        ],
    };
    shows.map(|shows| stored(storage, shows))
}

fn stored(storage: &Storage, mut shows: Vec<Shows>) -> Vec<Shows> {
    shows.retain(|&(class, number, _)| storage.find(class, number).is_some());
    shows
}
