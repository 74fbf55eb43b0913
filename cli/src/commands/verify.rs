//! `rungc verify`.

mod report;
mod settings;
mod test_file;

use super::check::draw;
use super::subject::{self, Subject};
use super::{Context, Failure, Outcome, Result, findings, read, say, write_file};
use crate::args::VerifyArgs;
use crate::report::Reporter;
use rungc_analysis::resolve::resolve;
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_syntax::{Diagnostic, Diagnostics, OperandKind, Span, codes};
use rungc_verify::aiger;
use rungc_verify::property::{Condition, Property};
use rungc_verify::prove::{Decision, Options, Verdict, decide, system};
use std::time::{Duration, Instant};

/// A property as it was asked for.
struct Asked {
    /// As it is written: `never Y000 & Y001`.
    text: String,
    property: Property,
}

/// Decides properties of a program.
pub fn run(args: &VerifyArgs, cx: Context) -> Result {
    let subject = subject::one(&args.input, cx)?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let read = read(&subject, &mut reporter)?;
    let reader = settings::Reader {
        args,
        subject: &subject,
        program: &read.program,
        cx,
    };
    let (asked, options) = (reader.properties()?, reader.options()?);
    let assumed = reader.assumed()?.into_iter().map(|(text, _)| text);
    let assumed: Vec<String> = assumed.collect();
    let Some(module) = module(&subject, &read, &asked, &options, &mut reporter)? else {
        reporter.finish()?;
        return Ok(Outcome::Unusable);
    };
    if let Some(path) = &args.aiger {
        let [only] = &asked[..] else {
            let why = "--aiger: name one property";
            return Err(Failure::Because(why.to_string()));
        };
        let (_, system) = system(&module, &only.property, &options);
        write_file(path, &aiger::binary(&system), args.force)?;
        cx.note(&format!("       Wrote {}", path.display()));
    }
    let decided: Vec<(Decision, Duration)> = asked
        .iter()
        .map(|asked| {
            let begin = Instant::now();
            (decide(&module, &asked.property, &options), begin.elapsed())
        })
        .collect();
    let results: Vec<report::Result> = asked
        .iter()
        .zip(&decided)
        .map(|(asked, (decision, time))| report::Result {
            asked: &asked.text,
            property: &asked.property,
            decision,
            time: *time,
        })
        .collect();
    let for_people = reporter.is_for_people();
    publish(&subject, &read, &results, reporter)?;
    if for_people {
        say(&report::human(&results, &module, &options, &assumed))?;
    }
    if let Some(path) = &args.write_test {
        let text = test_file::text(&subject.file, path, &module, &results);
        match text {
            Some(text) => {
                write_file(path, text.as_bytes(), args.force)?;
                cx.note(&format!("       Wrote {}", path.display()));
            }
            None => cx.note("     No run was found, so no test is written"),
        }
    }
    let outcomes = results.iter().map(report::Result::outcome);
    Ok(outcomes.max().unwrap_or(Outcome::Success))
}

/// Compiles the program with all devices that properties look at; reports why if that fails.
fn module(
    subject: &Subject,
    read: &Read,
    asked: &[Asked],
    options: &Options,
    reporter: &mut Reporter,
) -> std::result::Result<Option<Module>, Failure> {
    let conditions = asked.iter().flat_map(|asked| asked.property.conditions());
    let devices = conditions
        .chain(&options.assumed)
        .flat_map(Condition::devices);
    let mut compiling = subject.options();
    compiling.observe.extend(devices);
    let compiled = compile(
        &read.program,
        &CompileOptions {
            optimise: false,
            ..compiling
        },
    );
    let Some(mut module) = compiled.module else {
        let compiled = compile(&read.program, &subject.options());
        reporter.add(&findings(subject, read, &compiled))?;
        return Ok(None);
    };
    simplify(&mut module);
    Ok(Some(module))
}

/// Reports violated and undecided properties as diagnostics.
fn publish(
    subject: &Subject,
    read: &Read,
    results: &[report::Result],
    mut reporter: Reporter,
) -> std::result::Result<(), Failure> {
    let model = rungc_lower::compile::model(&read.program, &subject.options());
    let mut diagnostics = Diagnostics::new();
    for result in results {
        let code = match result.outcome() {
            Outcome::Success => continue,
            Outcome::Undecided => &codes::PROPERTY_UNDECIDED,
            _ => &codes::PROPERTY_VIOLATED,
        };
        diagnostics.push(located(
            code.at(Span::default(), result.sentence()),
            result,
            read,
            model,
        ));
    }
    let mut findings = crate::report::Findings::new(
        &subject.file,
        &read.program,
        diagnostics,
        &subject.reporting,
    );
    if reporter.is_for_people() {
        findings.drawn = draw::networks(&read.program, model, &findings.diagnostics);
    }
    reporter.add(&findings)?;
    Ok(reporter.finish()?)
}

/// A diagnostic at the outputs of which a property speaks.
fn located(
    mut diagnostic: Diagnostic,
    result: &report::Result,
    read: &Read,
    model: &'static rungc_models::Model,
) -> Diagnostic {
    let devices: Vec<_> = result
        .property
        .conditions()
        .into_iter()
        .flat_map(Condition::devices)
        .collect();
    let (resolved, _) = resolve(&read.program, model);
    let mut places = resolved.program.instrs.iter().filter_map(|instr| {
        let drives = matches!(
            instr.mnemonic.as_str(),
            "OUT" | "SET" | "RST" | "PLS" | "PLF" | "ALT"
        );
        let operand = instr.operands.first().filter(|_| drives)?;
        let OperandKind::Device(device, None) = operand.kind else {
            return None;
        };
        devices
            .contains(&(device.class, device.number))
            .then_some((instr.span, device))
    });
    if let Some((span, device)) = places.next() {
        diagnostic.span = span;
        diagnostic.label = format!("`{device}` is written here").into();
        diagnostic.others = places
            .map(|(span, device)| rungc_syntax::Label {
                span,
                text: format!("`{device}` is written here").into(),
            })
            .collect();
    }
    if let Verdict::Found(_) = result.decision.verdict {
        diagnostic.help = Some("the run is below; `--write-test FILE` writes it as a test".into());
    }
    diagnostic
}
