//! Agreement of the runtime and the rows about an instruction. The two cannot share it: the runtime stands alone in
//! emitted code and does not know the catalogue.

use rungc_catalogue::{Inst, Lower, all};
use rungc_models::ModelId;
use rungc_rt::RtFn;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The rows that a function implements, and the operands that they give it on some model.
fn implemented() -> BTreeMap<RtFn, Vec<(&'static Inst, Vec<&'static str>)>> {
    let mut rows: BTreeMap<RtFn, Vec<(&'static Inst, Vec<_>)>> = BTreeMap::new();
    for inst in all() {
        for model in ModelId::ALL {
            let Lower::Call(function) = inst.lower_on_model(model) else {
                continue;
            };
            if !inst.models.has(model) {
                continue;
            }
            let variants = inst.variants.iter().filter(|v| v.models.has(model));
            let lists = variants.filter_map(|v| v.params).chain([inst.params]);
            for params in lists {
                let names: Vec<_> = params.iter().map(|param| param.name).collect();
                let row = (inst, names);
                let rows = rows.entry(function).or_default();
                if !rows.iter().any(|(i, n)| i.name == inst.name && *n == row.1) {
                    rows.push(row);
                }
            }
        }
    }
    rows
}

#[test]
fn functions_name_their_operands_as_the_rows_do() {
    let mut wrong = Vec::new();
    for (function, rows) in implemented() {
        let operands = function.operands();
        let fits = |(inst, names): &(&Inst, Vec<&str>)| {
            // The devices of another class with the numbers of the first operand.
            let twin = inst.twin.map(|class| class.prefix().to_lowercase());
            let names = names.iter().map(|name| name.to_lowercase()).chain(twin);
            names.eq(operands.iter().copied())
        };
        if !rows.iter().any(fits) {
            let operands = operands.join(", ");
            wrong.push(format!(
                "{}({operands})   {}",
                function.name(),
                shown(&rows)
            ));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// The documentation of the functions of [`rungc_rt::fnc`], by module and name.
fn documentation() -> BTreeMap<(String, String), String> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("runtime-rt/rt/src/fnc");
    let mut all = BTreeMap::new();
    let mut files: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    for path in files {
        let module = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = fs::read_to_string(path).unwrap();
        let mut doc = String::new();
        for line in text.lines() {
            if let Some(line) = line.strip_prefix("///") {
                doc += line;
            } else if let Some(rest) = line.strip_prefix("pub fn ") {
                let name = rest.split(['(', '<']).next().unwrap().to_owned();
                all.insert((module.clone(), name), std::mem::take(&mut doc));
            } else if !line.starts_with("#[") {
                doc.clear();
            }
        }
    }
    all
}

/// Returns true if documentation names a row, its FNC number if it states one, and its operands if they follow the
/// mnemonic.
fn documents(doc: &str, inst: &Inst, names: &[&str]) -> bool {
    let mut words = doc.split(|c: char| c.is_whitespace() || ",:()".contains(c));
    let spellings = inst.spellings();
    let named = words.any(|word| spellings.iter().any(|(spelling, _)| spelling == word));
    let number = inst.fnc.map(|fnc| format!("(FNC {fnc})"));
    let numbered = number.is_none_or(|number| !doc.contains("(FNC ") || doc.contains(&number));
    let operands = doc
        .strip_prefix(inst.name)
        .and_then(|rest| rest.strip_prefix(' '));
    let operands = operands.filter(|rest| names.first().is_some_and(|name| rest.starts_with(name)));
    named && numbered && operands.is_none_or(|rest| rest.starts_with(&names.join(" ")))
}

#[test]
fn functions_are_documented_as_the_rows_say() {
    let documentation = documentation();
    let mut wrong = Vec::new();
    for (function, rows) in implemented() {
        let name = (function.module().to_owned(), function.name().to_owned());
        let doc = documentation.get(&name).map_or("", |doc| doc.trim());
        if !rows.iter().any(|(inst, names)| documents(doc, inst, names)) {
            wrong.push(format!("{}: {doc:.60}   {}", function.name(), shown(&rows)));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

fn shown(rows: &[(&Inst, Vec<&str>)]) -> String {
    let rows = rows.iter();
    let rows: Vec<_> = rows
        .map(|(inst, names)| format!("{} {}", inst.name, names.join(" ")))
        .collect();
    rows.join(" | ")
}
