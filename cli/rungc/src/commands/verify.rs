//! `rungc verify`.

mod engines;
pub(super) mod evidence;
mod export;
pub(super) mod report;
pub(super) mod same;
pub(super) mod test_file;

use super::check::draw;
use super::properties::{
    ExternalWrites, Reader, RequestedProperty, at_writes, module, report_undriven,
};
use super::subject::{self, Subject};
use super::{Context, Failure, Outcome, Result, check_name, put, read};
use crate::args::VerifyArgs;
use crate::output::{file, spare, write_file};
use crate::report::Reporter;
use crate::report::junit::{Case, properties};
use evidence::{Basis, Grounds};
pub use export::SOLVER;
use rungc::location::named;
use rungc_evidence::Evidence;
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_sim::property::Condition;
use rungc_sim::threads::Threads;
use rungc_syntax::{Diagnostic, Diagnostics, Span, codes};
use rungc_verify::certificate::{Certificate, certificate};
use rungc_verify::model::World;
use rungc_verify::prove::{Decision, EFFORT, Options, Verdict, decide};
use rungc_verify::words::vacuous;
use std::time::{Duration, Instant};

/// Time limit of a proof by another solver.
fn solver_time(options: &Options) -> Duration {
    const USUAL: Duration = Duration::from_secs(60);
    options.time.unwrap_or(USUAL)
}

/// Message for a program without a property; those of a project without a program are about none.
fn no_property(subject: &Subject) -> String {
    let project = subject.project.as_deref();
    match project.filter(|project| project.has_properties()) {
        Some(project) => format!(
            "no property given: those of {} are about the program that its `[project]` names with `program = \"…\"`; \
             name this one there, or add --never, --always or --reachable",
            project.path.display()
        ),
        None => {
            "no property given: add --never, --always or --reachable, or [[property]] to rungc.toml"
                .to_string()
        }
    }
}

/// Decides properties of a program.
pub fn run(args: &VerifyArgs, cx: Context) -> Result {
    if let Some(old) = &args.same_as {
        return same::run(args, old, cx);
    }
    if let Some(path) = &args.write_test {
        spare(path, args.force)?;
    }
    evidence::check(args)?;
    let subject = subject::one(&args.input, cx)?;
    let mut written = args.write_test.iter();
    written.try_for_each(|_| check_name(&subject.file, "a test file"))?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let read = match read(&subject, &mut reporter) {
        Ok(read) => read,
        Err(failure) => return unread(args, failure, reporter, cx),
    };
    let reader = Reader {
        args: &args.properties,
        subject: &subject,
        program: &read.program,
        cx,
    };
    let (requested, assumed) = (reader.properties()?, reader.assumed()?);
    if requested.is_empty() {
        return Err(Failure::Because(no_property(&subject)));
    }
    let external = reader.external()?;
    let options = options(args, &reader, &assumed, &external)?;
    let assumed: Vec<String> = assumed.into_iter().map(|(text, _)| text).collect();
    let conditions = requested
        .iter()
        .flat_map(|requested| requested.property.conditions());
    let conditions = conditions.chain(&options.assumed);
    let Some(module) = module(&subject, &read, conditions, &external, &mut reporter)? else {
        deliver(args, reporter, String::new, UNUSABLE, cx)?;
        return Ok(Outcome::Unusable);
    };
    report_undriven(&requested, &read, &subject, &external, &mut reporter)?;
    export::questions(args, &module, &requested, &options, cx)?;
    let mut decided = decisions(&requested, &module, &options);
    withdraw(&mut decided, &module, &options, &assumed);
    let found = proofs(&requested, &decided);
    let certificates = export::proofs(args, found, solver_time(&options), cx)?;
    let runs = shown(&requested, &decided);
    let replayed = engines::replay(args.replay, std::slice::from_ref(&module), &runs, cx)?;
    for (number, why) in replayed.differing {
        decided[number].0.verdict = Verdict::Undecided(why);
    }
    let results: Vec<report::Result> = requested
        .iter()
        .zip(&decided)
        .map(|(requested, (decision, time))| report::Result {
            requested: &requested.text,
            property: &requested.property,
            decision,
            external: &external,
            time: *time,
        })
        .collect();
    let grounds = Grounds {
        basis: Basis {
            args,
            subject: &subject,
            read: &read,
            module: &module,
            options: &options,
            assumed: &assumed,
            external: &external,
            engines: &replayed.engines,
        },
        requested: &requested,
        results: &results,
        certificates: &certificates,
    };
    conclude(&grounds, reporter, cx)?;
    let outcomes = results.iter().map(report::Result::outcome);
    Ok(outcomes.max().unwrap_or(Outcome::Success))
}

/// Decides properties, each with the time that this takes.
fn decisions(
    requested: &[RequestedProperty],
    module: &Module,
    options: &Options,
) -> Vec<(Decision, Duration)> {
    Threads::usual().map(requested, |requested| {
        let begin = Instant::now();
        let decision = decide(module, &requested.property, options);
        (decision, begin.elapsed())
    })
}

/// Reports what was decided, and writes what is requested about it.
fn conclude(
    grounds: &Grounds,
    mut reporter: Reporter,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let results = grounds.results;
    let Basis {
        args,
        subject,
        read,
        module,
        options,
        ..
    } = grounds.basis;
    let evidence = evidence::gather(grounds, cx)?;
    evidence::write(args, &evidence, cx)?;
    publish(subject, read, (module, results), evidence, &mut reporter)?;
    let supposed = (grounds.basis.assumed, grounds.basis.external);
    let text = || report::human(results, module, options, supposed);
    deliver(args, reporter, text, &report::summary(results), cx)?;
    let Some(path) = &args.write_test else {
        return Ok(());
    };
    match test_file::text(&subject.file, path, module, results, cx) {
        Some(text) => {
            write_file(path, text.as_bytes(), args.force)?;
            cx.note(&format!("       Wrote {}", path.display()));
        }
        None => cx.note("     No run was found, so no test is written"),
    }
    Ok(())
}

/// The certificate of each property, if it is proved, with its requirement.
fn proofs<'a>(
    requested: &'a [RequestedProperty],
    decided: &[(Decision, Duration)],
) -> Vec<(Option<&'a str>, Option<Certificate>)> {
    let pairs = requested.iter().zip(decided);
    let proofs = pairs.map(|(requested, (decision, _))| {
        let files = decision.proof.as_ref().map(certificate);
        (requested.requirement.as_deref(), files)
    });
    proofs.collect()
}

/// Takes proofs back if the program contradicts an assumption.
fn withdraw(
    decided: &mut [(Decision, Duration)],
    module: &Module,
    options: &Options,
    assumed: &[String],
) {
    let decisions = decided.iter_mut().map(|(decision, _)| decision);
    let proved = decisions.filter(|decision| decision.verdict == Verdict::Proved);
    let mut proved = proved.peekable();
    if proved.peek().is_none() {
        return;
    }
    if let Some(why) = vacuous([module], options, assumed) {
        for decision in proved {
            decision.proof = None;
            decision.verdict = Verdict::Undecided(why.clone());
        }
    }
}

/// The runs that were found, to be shown on other engines.
fn shown<'a>(
    requested: &'a [RequestedProperty],
    decided: &'a [(Decision, Duration)],
) -> Vec<engines::Shown<'a>> {
    let pairs = requested.iter().zip(decided).enumerate();
    let found = pairs.filter_map(|(what, (requested, (decision, _)))| {
        let Verdict::Found(trace) = &decision.verdict else {
            return None;
        };
        let conditions = requested.property.conditions().into_iter();
        Some(engines::Shown {
            what,
            program: 0,
            devices: conditions.flat_map(Condition::devices).collect(),
            trace,
        })
    });
    found.collect()
}

/// Assumptions about the environment of the program, and the limits.
fn options(
    args: &VerifyArgs,
    reader: &Reader,
    assumed: &[(String, Condition)],
    external: &ExternalWrites,
) -> std::result::Result<Options, Failure> {
    let settings = reader.project().map(|project| &project.verify);
    let timeout = settings.and_then(|verify| verify.timeout.as_ref());
    let effort = settings.and_then(|verify| verify.effort);
    let timeout = match (args.timeout, timeout) {
        (None, None) => None,
        (given, named) => Some(Duration::from_millis(reader.chosen(given, named, 0)?)),
    };
    Ok(Options {
        world: World {
            scan_ms: reader.scan_ms()?,
            fresh: args.cleared,
            free: external.devices.keys().copied().collect(),
            ..World::default()
        },
        assumed: assumed.iter().map(|(_, a)| a.clone()).collect(),
        effort: match (args.effort.or(effort.map(u64::from)), timeout) {
            (Some(effort), _) => effort,
            (None, Some(_)) => u64::MAX,
            (None, None) => EFFORT,
        },
        time: timeout,
    })
}

/// Reports violated and undecided properties as diagnostics.
fn publish(
    subject: &Subject,
    read: &Read,
    (module, results): (&Module, &[report::Result]),
    evidence: Evidence,
    reporter: &mut Reporter,
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
    let file = named(&subject.file);
    let cases = results.iter().zip(&evidence.properties);
    let cases = cases.map(|(result, verified)| Case {
        properties: properties(verified),
        ..result.case(&file, module)
    });
    let cases = cases.collect();
    findings.verification = Some(evidence);
    Ok(reporter.add_verdicts(&findings, cases)?)
}

/// Text of a report without verdicts.
const UNUSABLE: &str = "why the program cannot be used";

/// Reports that a program cannot be read, to tools too.
fn unread(args: &VerifyArgs, failure: Failure, reporter: Reporter, cx: Context) -> Result {
    deliver(args, reporter, String::new, UNUSABLE, cx)?;
    Err(failure)
}

/// Prints the verdicts, or writes them to the requested file: the document for tools, what people read as `text`, or
/// annotations and then that.
fn deliver(
    args: &VerifyArgs,
    reporter: Reporter,
    text: impl FnOnce() -> String,
    summary: &str,
    cx: Context,
) -> std::result::Result<(), Failure> {
    let in_words = reporter.has_text();
    let mut document = reporter.document()?.unwrap_or_default();
    if in_words {
        document.push_str(&text());
    }
    match document.is_empty() {
        true => Ok(()),
        false => put((file(&args.output), args.force), &document, summary, cx),
    }
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
    diagnostic = at_writes(diagnostic, &devices, read, model);
    if let Verdict::Found(_) = result.decision.verdict {
        diagnostic.help = Some("`--write-test FILE` writes the run that shows it as a test".into());
    }
    diagnostic
}
