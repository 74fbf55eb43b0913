//! Influences on a PLC that a search does not vary.

use crate::task::Task;
use crate::trains::MOST_A_MS;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::{RtFn, Transfer};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Influences on the program that the search does not vary, a sentence each; empty if there are none.
pub fn unvaried(task: &Task) -> Vec<String> {
    let module = task.module;
    let mut found = Vec::new();
    let inputs = task.sources.iter().flat_map(|source| source.at.inputs());
    let inputs: BTreeSet<u32> = inputs.collect();
    if !inputs.is_empty() {
        let names = inputs.iter().map(|&n| DeviceClass::X.number(n).to_string());
        let names = names.collect::<Vec<_>>().join(", ");
        found.push(format!(
            "uneven pulses at {names}, and more than {MOST_A_MS} in a millisecond"
        ));
    }
    let ports = module.ports.iter().map(|number| format!("COM{number}"));
    let ports = ports.collect::<Vec<_>>().join(", ");
    if !ports.is_empty() {
        found.push(format!("characters that {ports} receives"));
    }
    let mut others = BTreeSet::new();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            if let Stmt::Do(Action::Call(call)) = stmt {
                others.extend(source(call.function));
            }
        });
    }
    found.extend(others.into_iter().map(str::to_string));
    found
}

/// Influence on a function of the runtime from outside the program and its devices.
fn source(function: RtFn) -> Option<&'static str> {
    use RtFn::{
        AnalogInputs, ClockRefresh, ClockRefreshShort, ExchangeAdapter, ExchangeBoard,
        ExchangeModule, Potentiometers, PowerSupply, Rd3a, Rd3aBoard, Trd, TrdShort, Vrrd, Vrsc,
    };
    const MODULES: &str = "what special modules measure and answer";
    if function.transfer() == Some(Transfer::FromModule) {
        return Some(MODULES);
    }
    Some(match function {
        Rd3a | Rd3aBoard | ExchangeModule | ExchangeBoard | ExchangeAdapter => MODULES,
        AnalogInputs => "analog inputs",
        Potentiometers | Vrrd | Vrsc => "potentiometers",
        Trd | TrdShort | ClockRefresh | ClockRefreshShort => {
            "the date and the time of day: they follow the run"
        }
        PowerSupply => "failures of the power supply that the PLC survives",
        _ => return None,
    })
}
