//! The conformance cases as judges of diagnostics: each program that must be rejected is, with the PLC's code and at
//! the line that the case names; no other program has an error.

use rungc_analysis::check::{check, variants};
use rungc_analysis::resolve::resolve;
use rungc_catalogue::Lower;
use rungc_frontend::read_text;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::{Model, ModelId, Plc};
use rungc_syntax::{Diagnostic, Severity, codes};
use std::path::{Path, PathBuf};

/// A program of a case and what is expected of it.
struct Case {
    /// `folder/file/name`.
    name: String,
    plc: Plc,
    program: String,
    /// The PLC's code (0: any) and the line (none: any) of the error; `None` if there must be no error.
    rejects: Option<(i64, Option<i64>)>,
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("folder of cases") {
        let path = entry.expect("entry of the folder").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.to_string_lossy().ends_with(".plctest.toml") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn cases() -> Vec<Case> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("golden/conformance");
    files(&folder)
        .iter()
        .flat_map(|path| cases_of(&folder, path))
        .collect()
}

fn cases_of(folder: &Path, path: &Path) -> Vec<Case> {
    let text = std::fs::read_to_string(path).expect("file of cases");
    let table: toml::Table = text.parse().expect("TOML");
    let file = path
        .strip_prefix(folder)
        .expect("inside the folder")
        .display()
        .to_string();
    let file = file.trim_end_matches(".plctest.toml").to_owned();
    let plc = |table: &toml::Table| {
        table
            .get("model")
            .and_then(toml::Value::as_str)
            .and_then(Plc::find)
    };
    let cases = table["case"].as_array().expect("cases").iter();
    // Programs in files are structured text, which another crate compiles.
    let lists = cases.filter(|case| case["program"].is_str());
    lists
        .map(|case| {
            let case = case.as_table().expect("a case");
            let text = |key: &str| case[key].as_str().expect("text").to_owned();
            let rejects = case.get("rejects").map(|rejects| {
                let number = |key: &str| rejects.get(key).and_then(toml::Value::as_integer);
                (number("code").unwrap_or(0), number("line"))
            });
            Case {
                name: format!("{file}/{}", text("name")),
                plc: plc(case).or_else(|| plc(&table)).expect("a model"),
                program: text("program"),
                rejects,
            }
        })
        .collect()
}

/// The errors of a program, with their lines. A model stands for compatible boards too.
fn errors(case: &Case) -> Vec<(u32, Diagnostic)> {
    let model = Model::get(case.plc.model);
    let found = errors_on(model, case);
    match model.boards {
        Some(boards) if case.rejects.is_none() && !found.is_empty() => {
            errors_on(Model::get(boards), case)
        }
        _ => found,
    }
}

fn errors_on(model: &'static Model, case: &Case) -> Vec<(u32, Diagnostic)> {
    let read = read_text("case", &case.program);
    let (resolved, mut diagnostics) = resolve(&read.program, model);
    diagnostics.extend(check(&resolved).sorted());
    if let Some(variant) = case.plc.variant {
        diagnostics.extend(variants::check(&resolved, variant).sorted());
    }
    diagnostics.extend(read.diagnostics.sorted());
    diagnostics
        .sorted()
        .into_iter()
        .filter(|diagnostic| diagnostic.severity == Severity::Error)
        // A missing feature of the compiler says nothing about the program.
        .filter(|diagnostic| diagnostic.code != codes::NOT_IMPLEMENTED.id)
        .map(|diagnostic| {
            (
                read.program.source.line_col(diagnostic.span.start).0,
                diagnostic,
            )
        })
        .collect()
}

/// Error in the verdict on a case, if any.
fn misjudged(case: &Case) -> Option<String> {
    let errors = errors(case);
    let listed: Vec<_> = errors
        .iter()
        .map(|(line, error)| {
            format!(
                "{line}: {} {} {:?}",
                error.code, error.message, error.plc_error
            )
        })
        .collect();
    let listed = listed.join("; ");
    let right = match case.rejects {
        None => errors.is_empty(),
        Some((code, at)) => errors.iter().any(|(line, error)| {
            (code == 0 || error.plc_error.map(i64::from) == Some(code))
                && at.is_none_or(|at| at == i64::from(*line))
        }),
    };
    (!right).then(|| format!("{}: expected {:?}, found {listed}", case.name, case.rejects))
}

#[test]
fn programs_are_rejected_where_the_cases_say_so() {
    let cases = cases();
    let rejecting = cases.iter().filter(|case| case.rejects.is_some());
    assert!(rejecting.count() >= 400, "the cases are not all there");
    let wrong: Vec<String> = cases.iter().filter_map(misjudged).collect();
    assert!(
        wrong.is_empty(),
        "{} of {} misjudged:\n{}",
        wrong.len(),
        cases.len(),
        wrong.join("\n")
    );
}

/// Checking and compiling reject the same programs, with the same words.
#[test]
fn checking_refuses_what_compiling_refuses() {
    let refusals = |compiled: compile::Compiled| -> Vec<String> {
        let errors = compiled.diagnostics.iter();
        errors
            .filter(|diagnostic| diagnostic.severity == Severity::Error)
            .map(|diagnostic| format!("{} {}", diagnostic.code, diagnostic.message))
            .collect()
    };
    let mut rejected = 0;
    for case in cases() {
        let read = read_text("case", &case.program);
        let options = CompileOptions {
            model: Some(case.plc.model),
            ..CompileOptions::default()
        };
        let checked = compile::check(&read.program, &options);
        let compiled = compile::compile(&read.program, &options);
        assert_eq!(
            checked.diagnostics.has_errors() || read.diagnostics.has_errors(),
            compiled.module.is_none(),
            "{}",
            case.name
        );
        rejected += u32::from(compiled.module.is_none());
        assert_eq!(refusals(checked), refusals(compiled), "{}", case.name);
    }
    assert!(rejected >= 400, "only {rejected} programs are rejected");
}

/// An instruction without implementation is an error of checking, whatever else is wrong with the program.
#[test]
fn instructions_without_implementation_are_errors() {
    let mut count = 0;
    for id in ModelId::ALL {
        let model = Model::get(id);
        let missing = rungc_catalogue::all().filter(|inst| {
            let todo = matches!(inst.lower_on_model(id), Lower::Todo(_));
            inst.models.has(id) && todo
        });
        for inst in missing {
            let example = inst.example_on(model);
            let read = read_text("case", &format!("OR X0\n{example}"));
            let (resolved, _) = resolve(&read.program, model);
            let found = check(&resolved);
            let listed = found.iter().any(|d| d.code == codes::NOT_IMPLEMENTED.id);
            assert!(listed, "{} on {}:\n{example}", inst.name, model.name);
            count += 1;
        }
    }
    assert!(count > 0, "everything is implemented: this test can go");
}
