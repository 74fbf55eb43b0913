//! A comparison as JSON.

use super::{Compared, Failure};
use crate::commands::verify::evidence;
use crate::commands::verify::same::named;
use crate::report::to_json;
use rungc_ir::compare::Behaviour;
use rungc_ladder::compare::{Change, Differing, Drawn};
use serde_json::{Value, json};
use std::fmt::Display;

/// The object that `--format json` prints.
pub fn object(compared: &Compared, differs: bool) -> Result<String, Failure> {
    let comparison = &compared.comparison;
    let [old, new] = compared.names;
    let networks = comparison.networks.iter();
    let networks = networks.map(|change| network(compared, *change));
    let mut object = json!({
        "version": 1,
        "old": old,
        "new": new,
        "differs": differs,
        "networks": networks.collect::<Vec<_>>(),
        "comments": table("device", &comparison.comments),
        "settings": table("name", &comparison.parameters),
    });
    if let Some(found) = &compared.behaviour {
        object["behaviour"] = behaviour(found);
        let outputs = compared.proved.outputs.iter();
        let proved = outputs.clone().map(|output| named(output).to_string());
        object["behaviour"]["proved"] = proved.collect();
        let proofs = outputs.map(|output| {
            json!({
                "device": named(output).to_string(),
                "method": evidence::same::method(output),
                "gaps": evidence::gaps(&output.gaps),
            })
        });
        object["behaviour"]["proofs"] = proofs.collect();
        object["behaviour"]["assumptions"] = json!(compared.proved.assumptions);
        let vague = compared.vague().into_iter();
        let vague = vague.map(|(is_new, mnemonic, step)| {
            let program = if is_new { "new" } else { "old" };
            json!({ "program": program, "instruction": mnemonic, "step": step })
        });
        object["behaviour"]["vague"] = vague.collect();
    }
    Ok(to_json(&object)?)
}

fn network(compared: &Compared, change: Change) -> Value {
    let side = |of: Drawn, at: Option<usize>| {
        at.map(|at| {
            let first = of.network(at).instrs.start;
            json!({
                "number": at + 1,
                "step": of.resolved.instrs.get(first).map(|instr| instr.step),
                "instructions": of.instructions(at),
            })
        })
    };
    let [old, new] = change.places();
    json!({
        "change": change.verb(),
        "old": side(compared.old, old),
        "new": side(compared.new, new),
    })
}

fn table<K: Display>(name: &str, differing: &[Differing<K>]) -> Vec<Value> {
    let rows = differing.iter().map(
        |Differing { key, old, new }| json!({ name: key.to_string(), "old": old, "new": new }),
    );
    rows.collect()
}

fn behaviour(behaviour: &Behaviour) -> Value {
    match behaviour {
        Behaviour::Same => json!({ "verdict": "same" }),
        Behaviour::Undecided(why) => json!({ "verdict": "not_decided", "why": why }),
        Behaviour::CanDiffer {
            devices, hardware, ..
        } => {
            let numbers = devices.iter().flat_map(|run| {
                let numbers = run.first..run.first + run.count;
                numbers.map(|number| run.class.number(number).to_string())
            });
            json!({ "verdict": "can_differ", "devices": numbers.collect::<Vec<_>>(), "hardware": hardware })
        }
    }
}
