//! Planted faults: each is found, with a run that the interpreter confirms, and the repaired program is proved.

use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_verify::model::World;
use rungc_verify::property::{Condition, Property, parse};
use rungc_verify::prove::{Options, Verdict, decide};
use serde::Deserialize;
use std::path::Path;
use std::time::Duration;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Faults {
    fault: Vec<Fault>,
}

/// A program with a fault, and the same without.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fault {
    name: String,
    why: String,
    never: Option<String>,
    always: Option<String>,
    whenever: Option<String>,
    then: Option<String>,
    within: Option<u32>,
    stays: Option<String>,
    until: Option<String>,
    #[serde(default)]
    assume: Vec<String>,
    faulty: String,
    repaired: String,
}

fn condition(text: &str) -> Condition {
    parse(text, &|_| Vec::new()).unwrap_or_else(|mistake| panic!("{text}: {mistake:?}"))
}

impl Fault {
    fn property(&self) -> Property {
        let read = |text: &Option<String>| text.as_deref().map(condition);
        let off = Condition::Constant(false);
        let property = (read(&self.never).map(Property::Never))
            .or_else(|| read(&self.always).map(Property::Always))
            .or_else(|| {
                Some(Property::Whenever {
                    when: read(&self.whenever)?,
                    then: read(&self.then)?,
                    within_ms: self.within.unwrap_or(0),
                })
            })
            .or_else(|| {
                Some(Property::Stays {
                    holds: read(&self.stays)?,
                    until: read(&self.until).unwrap_or(off),
                })
            });
        property.unwrap_or_else(|| panic!("{}: no property", self.name))
    }
}

fn module(text: &str, property: &Property) -> Module {
    let read = rungc_frontend::read_text("fault.il", text.trim_start());
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        observe: property
            .conditions()
            .into_iter()
            .flat_map(Condition::devices)
            .collect(),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let found = compiled.diagnostics.iter().map(|d| d.message.clone());
    let found: Vec<String> = found.collect();
    let module = compiled.module;
    let mut module = module.unwrap_or_else(|| panic!("does not compile: {found:?}\n{text}"));
    simplify(&mut module);
    module
}

#[test]
fn planted_faults_are_found_and_repaired_programs_are_proved() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("verify");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("golden/verify")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    let (mut count, mut undecided, mut wrong) = (0, Vec::new(), Vec::new());
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a readable file");
        let faults: Faults = toml::from_str(&text).unwrap_or_else(|e| panic!("{file:?}: {e}"));
        for fault in faults.fault {
            assert!(
                fault.why.len() > 20,
                "{}: say why it is a fault",
                fault.name
            );
            count += 1;
            let property = fault.property();
            let options = Options {
                world: World::default(),
                assumed: fault.assume.iter().map(|text| condition(text)).collect(),
                time: Duration::from_secs(30),
            };
            let found = decide(&module(&fault.faulty, &property), &property, &options);
            if !matches!(found.verdict, Verdict::Found(_)) {
                wrong.push(format!("{}: the fault is not found: {found:?}", fault.name));
            }
            let found = decide(&module(&fault.repaired, &property), &property, &options);
            match found.verdict {
                Verdict::Proved => {}
                Verdict::Undecided(_) => undecided.push(fault.name),
                Verdict::Found(_) => wrong.push(format!("{}: repaired, {found:?}", fault.name)),
            }
        }
    }
    println!("{count} faults; repaired, but not decided: {undecided:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(undecided.len() * 10 <= count, "{undecided:?} of {count}");
}
