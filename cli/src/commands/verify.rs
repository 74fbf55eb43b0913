//! `rungc verify`.

mod report;
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
use rungc_sim::Target;
use rungc_syntax::{Diagnostic, Diagnostics, OperandKind, Program, Span, codes};
use rungc_verify::model::World;
use rungc_verify::property::{Condition, Property, parse};
use rungc_verify::prove::{Decision, Options, Verdict, decide};
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
    let asked = properties(args, &read.program)?;
    let assumed = conditions("--assume", &args.assume, &read.program)?;
    let options = options(args, assumed)?;
    let Some(module) = module(&subject, &read, &asked, &options, &mut reporter)? else {
        reporter.finish()?;
        return Ok(Outcome::Unusable);
    };
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
        say(&report::human(&results, &module, &options, &args.assume))?;
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

/// The properties of the command line.
fn properties(args: &VerifyArgs, program: &Program) -> std::result::Result<Vec<Asked>, Failure> {
    type Kind = fn(Condition) -> Property;
    let kinds: [(&str, &[String], Kind); 3] = [
        ("never", &args.never, Property::Never),
        ("always", &args.always, Property::Always),
        ("reachable", &args.reachable, Property::Reachable),
    ];
    let mut asked = Vec::new();
    for (name, texts, kind) in kinds {
        let conditions = conditions(&format!("--{name}"), texts, program)?;
        let properties = texts.iter().zip(conditions).map(|(text, condition)| Asked {
            text: format!("{name} {text}"),
            property: kind(condition),
        });
        asked.extend(properties);
    }
    match asked.is_empty() {
        true => Err(Failure::Because(
            "no property given: add --never, --always or --reachable".to_string(),
        )),
        false => Ok(asked),
    }
}

/// Reads conditions; an option says where they are from.
fn conditions(
    option: &str,
    texts: &[String],
    program: &Program,
) -> std::result::Result<Vec<Condition>, Failure> {
    let names = |name: &str| -> Vec<Target> {
        let plain = |text: &str| text.trim().to_lowercase();
        let named = program.comments.iter();
        let named = named.filter(|(_, comment)| plain(comment) == plain(name));
        named
            .filter_map(|(device, _)| Target::parse(&device.to_string()).ok())
            .collect()
    };
    let read = |text: &String| {
        parse(text, &names).map_err(|mistake| {
            let before = text[..mistake.at.min(text.len())].chars().count();
            let marker = " ".repeat(before);
            Failure::Because(format!("{option}: {}\n  {text}\n  {marker}^", mistake.why))
        })
    };
    texts.iter().map(read).collect()
}

fn options(args: &VerifyArgs, assumed: Vec<Condition>) -> std::result::Result<Options, Failure> {
    let scan_ms = u32::try_from(args.scan)
        .ok()
        .filter(|ms| (1..=32_767).contains(ms));
    let Some(scan_ms) = scan_ms else {
        return Err(Failure::Because("--scan: 1ms to 32767ms".to_string()));
    };
    let free = args.free.iter();
    let free = free.flat_map(|&(class, first, last)| (first..=last).map(move |n| (class, n)));
    Ok(Options {
        world: World {
            scan_ms,
            fresh: args.cleared,
            free: free.collect(),
            ..World::default()
        },
        assumed,
        time: Duration::from_millis(args.timeout),
    })
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
            .then(|| (instr.span, device))
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
