//! Programs with planted faults and the same without, which `verify` and `explore` tell apart.

use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_sim::property::{Condition, Property, parse};
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Faults {
    fault: Vec<Fault>,
}

/// A program with a fault, and the same without.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// Name of the fault.
    pub name: String,
    /// Description of the fault.
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
    /// The program with the fault.
    pub faulty: String,
    /// And without.
    pub repaired: String,
}

fn condition(text: &str) -> Condition {
    parse(text, &|_| Vec::new()).unwrap_or_else(|mistake| panic!("{text}: {mistake:?}"))
}

impl Fault {
    /// Conditions that the machine guarantees.
    pub fn assumed(&self) -> Vec<Condition> {
        self.assume.iter().map(|text| condition(text)).collect()
    }

    /// Property that the program with the fault violates.
    pub fn property(&self) -> Property {
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
                    after: None,
                    holds: read(&self.stays)?,
                    until: read(&self.until).unwrap_or(off),
                })
            });
        property.unwrap_or_else(|| panic!("{}: no property", self.name))
    }
}

/// A program, with all devices that the property looks at.
pub fn module(text: &str, property: &Property) -> Module {
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
    let found = compiled.diagnostics.iter().map(|d| d.message.to_string());
    let found: Vec<String> = found.collect();
    let module = compiled.module;
    let mut module = module.unwrap_or_else(|| panic!("does not compile: {found:?}\n{text}"));
    simplify(&mut module);
    module
}

/// All of them.
pub fn all() -> Vec<Fault> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("golden/verify");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("golden/verify")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    let mut all = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a readable file");
        let faults: Faults = toml::from_str(&text).unwrap_or_else(|e| panic!("{file:?}: {e}"));
        for fault in faults.fault {
            let name = &fault.name;
            assert!(fault.why.len() > 20, "{name}: say why it is a fault");
            all.push(fault);
        }
    }
    all
}
