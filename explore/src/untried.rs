//! What happens around a PLC and a search does not vary.

use crate::task::Task;
use rungc_ir::node::{FunctionKind, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// What the program of a search depends on and the search does not vary, a sentence each; nothing if that is all.
pub fn untried(task: &Task) -> Vec<String> {
    let module = task.module;
    let mut found = Vec::new();
    let edges = module.functions.iter().filter_map(|f| match f.kind {
        FunctionKind::InputEdge { input, .. } => Some(input),
        _ => None,
    });
    let edges: BTreeSet<u32> = edges.collect();
    if !edges.is_empty() {
        let names = edges.iter().map(|&n| DeviceClass::X.number(n).to_string());
        let names = names.collect::<Vec<_>>().join(", ");
        found.push(format!(
            "pulse trains at {names}: an input changes once between two scans at most"
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
            if let Stmt::Call(call) = stmt {
                others.extend(source(call.function));
            }
        });
    }
    found.extend(others.into_iter().map(str::to_string));
    found
}

/// What a function of the runtime takes from outside the program and its devices.
fn source(function: RtFn) -> Option<&'static str> {
    use RtFn::{
        AnalogInputs, ClockRefresh, ClockRefreshShort, ExchangeBoard, ExchangeModule, From,
        FromHost, FromRemote, Potentiometers, PowerSupply, Rbfm, Rd3a, Rd3aBoard, Trd, TrdShort,
        Vrrd, Vrsc,
    };
    Some(match function {
        From | FromHost | FromRemote | Rd3a | Rd3aBoard | Rbfm | ExchangeModule | ExchangeBoard => {
            "what special modules measure and answer"
        }
        AnalogInputs => "analog inputs",
        Potentiometers | Vrrd | Vrsc => "potentiometers",
        Trd | TrdShort | ClockRefresh | ClockRefreshShort => {
            "the date and the time of day: they follow the run"
        }
        PowerSupply => "failures of the power supply that the PLC survives",
        _ => return None,
    })
}
