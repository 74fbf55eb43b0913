//! Planted faults: each is found, with a run that the interpreter confirms, and the repaired program is proved. Each
//! proof is a certificate that a SAT solver confirms, if cadical is installed.

use crate::faults::{self, Fault};
use rungc_verify::certificate::certificate;
use rungc_verify::proof::{Method, Proof};
use rungc_verify::prove::{Options, Verdict, decide};
use rungc_verify::written::{case, outcomes, quoted};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// Has a solver that others wrote confirm that no formula of a proof can be satisfied; what is wrong.
fn unconfirmed(proof: &Proof, folder: &Path) -> Vec<String> {
    let formulas = certificate(proof).into_iter();
    let wrong = formulas.filter_map(|(name, text)| {
        let path = folder.join(&name);
        std::fs::write(&path, text).unwrap();
        // The time for one is bounded; solvers agree on the exit code of what cannot be satisfied.
        let solver = Command::new("cadical")
            .args(["-q", "-t", "60"])
            .arg(&path)
            .output();
        let code = solver.unwrap().status.code();
        (code != Some(20)).then(|| format!("{name}: exit code {code:?}"))
    });
    wrong.collect()
}

/// Returns true if the solver is installed; where `.ci/run` has installed it, it must be.
fn has_solver() -> bool {
    let found = Command::new("cadical").arg("--version").output().is_ok();
    let required = std::env::var_os("RUNGC_REQUIRE_PEERS").is_some();
    assert!(
        found || !required,
        "RUNGC_REQUIRE_PEERS is set, but there is no cadical"
    );
    if !found {
        eprintln!("certificates are not confirmed: there is no cadical");
    }
    found
}

/// Runs the written test of a fault on both programs; what is wrong if it passes with the fault, or fails without.
fn misjudged(fault: &Fault, case: &str) -> Option<String> {
    let outcome = |list: &str| {
        let list = quoted(list.trim_start());
        let text = format!("topic = \"faults\"\nmodel = \"fx3u\"\nprogram = {list}\n{case}");
        let outcomes = outcomes("t.plctest.toml", &text).unwrap();
        outcomes.into_iter().next().flatten()
    };
    match (outcome(&fault.faulty), outcome(&fault.repaired)) {
        (Some(_), None) => None,
        // What the machine sees to may depend on the program, so that the run is none of the repaired one.
        (Some(_), Some(_)) if !fault.assumed().is_empty() => None,
        both => Some(format!(
            "{}: the written test says {both:?}\n{case}",
            fault.name
        )),
    }
}

/// Also: the test that is written of each run fails with the fault, and passes without.
#[test]
fn planted_faults_are_found_and_repaired_programs_are_proved() {
    let (mut count, mut undecided, mut wrong) = (0, Vec::new(), Vec::new());
    let (has_solver, folder) = (has_solver(), tempfile::tempdir().unwrap());
    let mut methods: BTreeMap<&str, usize> = BTreeMap::new();
    for fault in faults::all() {
        count += 1;
        let property = fault.property();
        // A tenth of the repaired programs may stay undecided.
        let options = |effort| Options {
            assumed: fault.assumed(),
            effort,
            ..Options::default()
        };
        let module = faults::module(&fault.faulty, &property);
        let found = decide(&module, &property, &options(300_000));
        match &found.verdict {
            Verdict::Found(trace) => {
                let case = case(&fault.name, &module, &property, trace);
                wrong.extend(misjudged(&fault, &case));
            }
            _ => wrong.push(format!("{}: the fault is not found: {found:?}", fault.name)),
        }
        let found = decide(
            &faults::module(&fault.repaired, &property),
            &property,
            &options(30_000),
        );
        match found.verdict {
            Verdict::Proved => match &found.proof {
                Some(proof) => {
                    let method = match proof.method {
                        Method::Induction(_) => "induction",
                        Method::Invariant(_) => "invariant",
                    };
                    *methods.entry(method).or_default() += 1;
                    if has_solver {
                        let unconfirmed = unconfirmed(proof, folder.path()).into_iter();
                        wrong.extend(unconfirmed.map(|why| format!("{}: {why}", fault.name)));
                    }
                }
                None => wrong.push(format!("{}: proved without a proof", fault.name)),
            },
            Verdict::Undecided(_) => undecided.push(fault.name),
            Verdict::Found(_) => wrong.push(format!("{}: repaired, {found:?}", fault.name)),
        }
    }
    println!("{count} faults; proofs: {methods:?}; repaired, but not decided: {undecided:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(undecided.len() * 10 <= count, "{undecided:?} of {count}");
}
